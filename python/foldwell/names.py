"""Names of columns in words, for data sets and axes."""

from __future__ import annotations

from collections.abc import Mapping

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


def unit(column: str, units: Mapping[str, str], driven: str | None = None) -> str | None:
    """Returns the unit of a column, of the table of a study or of a sweep; None if it has none, or none that is named.

    Args:
        column: The column. That of a sweep begins with the name of its study and a dot.
        units: Names of the units of lengths and forces, as far as there are some.
        driven: What the drive of a path drives, as its summary says.
    """
    length, force = units.get("length"), units.get("force")
    energy = f"{force} {length}" if force and length else None
    name = column.split(".", 1)[-1]
    if name.startswith(("energy", "work")) or name.endswith(".energy"):
        return energy
    if name == "curvature":
        return f"1/{length}" if length else None
    if name.startswith("probe_"):
        return length
    volume = f"{length}^3" if length else None
    pressure = f"{force}/{length}^2" if force and length else None
    if name.startswith("volume_"):
        return volume
    known = {
        "displacement": (length, force), "rotation": ("rad", energy), "lock": ("rad", energy),
        "pressure": (pressure, volume), "volume": (volume, pressure),
    }
    drive, reaction = known.get(driven or "", (None, energy))
    return {"drive": drive, "reaction": reaction}.get(name)
