"""Names of columns in words, for data sets and axes."""

from __future__ import annotations

__all__: list[str] = []

#: Columns that say of what a row is, and are coordinates of a data set.
PLACES = ("branch", "sign", "step", "mode", "amplitude", "well", "state", "event")
#: Columns in radians; those that begin with `fold_` too.
RADIANS = ("arc_length", "theta1", "theta2", "seam_turn", "error_to_kinematic", "fold_angle")
#: Names that their columns do not say.
WORDS = {
    "theta1": "turn from cell to cell along the first lattice vector",
    "theta2": "turn from cell to cell along the second lattice vector",
    "strain11": "lattice strain, component 11",
    "strain22": "lattice strain, component 22",
    "strain12": "lattice strain, component 12",
    "energy_total": "energy",
    "arc_length": "arc length of the fold angles",
    "curvature": "curvature of the cylinder of vertex 0",
}


def described(column: str) -> dict[str, str]:
    """Returns the attributes `long_name` and `units` of a column, as far as they are known; lengths and forces are in the user's units."""
    words = WORDS.get(column) or column.replace("energy_", "energy of ").replace("_", " ").replace(".", " ")
    return {"long_name": words, **({"units": "rad"} if column in RADIANS else {})}
