"""Pictures by Matplotlib."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .results import Result
    from .state import State

__all__: list[str] = []

MOUNTAIN, VALLEY, OTHER = "#c0392b", "#2166ac", "#8a8578"
#: Fold angle in radians from which an edge counts as mountain or valley.
FOLDED = 1e-6


def draw_state(state: State, ax: Axes | None, paper: str, numbers: bool) -> Axes:
    """Draws a sheet in 3D; see `State.plot`."""
    import matplotlib.pyplot as plt
    from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection

    axes: Any = plt.figure().add_subplot(projection="3d") if ax is None else ax
    points, angles = state.positions, np.nan_to_num(state.fold_angles)
    paint = {"facecolors": paper, "edgecolors": paper, "linewidths": 0, "shade": True}
    if len(state.faces):  # bars alone have none; from some sides the sheet is wider than the axes
        axes.add_collection3d(Poly3DCollection(points[state.faces], **paint, clip_on=False))
    colours = np.where(angles > FOLDED, VALLEY, np.where(angles < -FOLDED, MOUNTAIN, OTHER))
    shown = state.kinds != "facet"
    axes.add_collection3d(Line3DCollection(points[state.edges[shown]], colors=colours[shown], linewidths=1.2, clip_on=False))
    low, high = points.min(axis=0), points.max(axis=0)
    size = np.maximum(high - low, 1e-3 * max(float((high - low).max()), 1e-300))
    axes.set(xlim=(low[0], low[0] + size[0]), ylim=(low[1], low[1] + size[1]), zlim=(low[2], low[2] + size[2]))
    axes.set_box_aspect(size, zoom=1.1)
    axes.set_axis_off()
    if numbers:
        for point, (vertex, n1, n2) in zip(points, state.places.tolist(), strict=True):
            axes.text(*point, f"{vertex}" if n1 == n2 == 0 else f"{vertex} ({n1}, {n2})", fontsize=8)
    drawn: Axes = axes
    return drawn


#: For each kind with curves: pairs of columns across and upwards, of which the first that the table has is drawn.
CURVES = {
    "path": [("drive", "reaction")],
    "fold": [("drive", "energy_total")],
    "trace": [("arc_length", "curvature"), ("arc_length", "energy_total"), ("arc_length", "strain11")],
    "landscape": [("amplitude", "energy_total")],
}
#: What the driven value of a path and its reaction are, by what is driven.
DRIVEN = {
    "displacement": ("displacement", "force"),
    "rotation": ("rotation (rad)", "torque"),
    "load": ("factor of the loads", "displacement of the loads"),
    "pressure": ("pressure", "growth of the volume"),
    "volume": ("growth of the volume", "pressure"),
    "lock": ("fold angle of the lock (rad)", "torque"),
    "rest": ("folded (1: as given)", "derivative of the energy"),
    "stiffness": ("stiffness", "derivative of the energy"),
}
EVENTS = {"limit-load": "o", "limit-displacement": "s", "branch-point": "D", "self-intersection": "X", "snap": "^", "stop": "|"}
WORDS = {"energy_total": "energy", "arc_length": "arc length (rad)"}


def _with_unit(words: str, unit: str | None) -> str:
    """Returns the name of an axis with its unit, unless it says one."""
    return f"{words} ({unit})" if unit and "(" not in words else words


def draw_result(result: Result, ax: Axes | None) -> Axes:
    """Draws a result; see `Result.plot`."""
    table = result.table
    known = [(x, y) for x, y in CURVES.get(result.kind, []) if x in table and np.isfinite(table.get(y, np.nan)).any()]
    if not known and result._inner.coordinates is None and not result.states:
        raise ValueError(f"this study of kind {result.kind} has neither curves nor states to plot; its numbers are in `tables`")
    if not known:
        return result._shown().plot(ax)
    import matplotlib.pyplot as plt

    axes: Any = plt.figure(layout="constrained").add_subplot() if ax is None else ax
    columns = known[0]
    if result.kind == "landscape":
        _draw_landscape(result, axes, columns)
    elif result.kind == "trace":
        _draw_trace(result, axes, columns)
    else:
        _draw_path(result, axes, columns)
    words = [WORDS.get(name, name.replace("_", " ")) for name in columns]
    title = result.name
    if "driven" in result.summary:
        driven = dict(zip(("drive", "reaction"), DRIVEN[result.summary["driven"]], strict=True))
        words = [driven.get(name, word) for name, word in zip(columns, words, strict=True)]
        title = f"{result.summary['drive']}: {words[1]} against {words[0]}"
    units = [result._unit(name) for name in columns]
    axes.set(xlabel=_with_unit(words[0], units[0]), ylabel=_with_unit(words[1], units[1]), title=title)
    if axes.get_legend_handles_labels()[0]:
        axes.legend()
    drawn: Axes = axes
    return drawn


def _draw_path(result: Result, axes: Any, columns: tuple[str, str]) -> None:
    """Branches, dashed where states are not stable, with a mark of its own for each kind of event."""
    table = result.table
    across, upwards = (table[name] for name in columns)
    # at an event an eigenvalue is zero, and its sign is rounding
    stable = (table["negative_eigenvalues"] == 0) | (table["event"] != "")
    branches = np.unique(table["branch"])
    for number, branch in enumerate(branches):
        rows = np.flatnonzero(table["branch"] == branch)
        solid = stable[rows][:-1] & stable[rows][1:]
        label = f"branch {branch}" if len(branches) > 1 else None
        for part, style in ((solid, "-"), (~solid, "--")):
            for run in np.split(np.flatnonzero(part), 1 + np.flatnonzero(np.diff(np.flatnonzero(part)) > 1)):
                if len(run):
                    here = rows[run[0] : run[-1] + 2]
                    axes.plot(across[here], upwards[here], style, color=f"C{number}", label=label)
                    label = None
    for event, mark in EVENTS.items():
        here = table["event"] == event
        if here.any():
            axes.plot(across[here], upwards[here], mark, color="black", markerfacecolor="white", label=event)


def _draw_trace(result: Result, axes: Any, columns: tuple[str, str]) -> None:
    """Branches, each with its two directions to the two sides of the drawn state."""
    table = result.table
    across, upwards = (table[name] for name in columns)
    for number, branch in enumerate(np.unique(table["branch"])):
        for sign in (1, -1):
            here = (table["branch"] == branch) & (table["sign"] == sign)
            label = f"branch {branch}" if sign == 1 else None
            axes.plot(sign * across[here], upwards[here], color=f"C{number}", label=label)


def _draw_landscape(result: Result, axes: Any, columns: tuple[str, str]) -> None:
    """Energies against amplitudes on logarithmic axes, where a power law is a straight line."""
    table = result.table
    across, upwards = (table[name] for name in columns)
    for number, mode in enumerate(result.summary["modes"]):
        here = (table["mode"] == number) & (upwards > 0.0)
        tensor = ", ".join(f"{k:g}" for k in mode["mode"]) if isinstance(mode["mode"], list) else str(mode["mode"])
        slope = "" if mode["exponent"] is None else f", slope {mode['exponent']:.2f}"
        axes.plot(across[here], upwards[here], marker=".", label=f"k11, k22, k12 = {tensor}{slope}")
    axes.set(xscale="log", yscale="log")
