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


def draw_state(state: State, ax: Axes | None, paper: str) -> Axes:
    """Draws a sheet in 3D; see `State.plot`."""
    import matplotlib.pyplot as plt
    from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection

    axes: Any = plt.figure().add_subplot(projection="3d") if ax is None else ax
    points, angles = state.positions, np.nan_to_num(state.fold_angles)
    paint = {"facecolors": paper, "edgecolors": paper, "linewidths": 0, "shade": True}
    axes.add_collection3d(Poly3DCollection(points[state.faces], **paint, clip_on=False))  # from some sides it is wider than the axes
    colours = np.where(angles > FOLDED, VALLEY, np.where(angles < -FOLDED, MOUNTAIN, OTHER))
    shown = state.kinds != "facet"
    axes.add_collection3d(Line3DCollection(points[state.edges[shown]], colors=colours[shown], linewidths=1.2, clip_on=False))
    low, high = points.min(axis=0), points.max(axis=0)
    size = np.maximum(high - low, 1e-3 * max(float((high - low).max()), 1e-300))
    axes.set(xlim=(low[0], low[0] + size[0]), ylim=(low[1], low[1] + size[1]), zlim=(low[2], low[2] + size[2]))
    axes.set_box_aspect(size, zoom=1.1)
    axes.set_axis_off()
    drawn: Axes = axes
    return drawn


#: For each kind with curves: columns of the abscissa and the ordinate, and the column that tells curves apart.
CURVES = {
    "path": ("drive", "reaction", "branch"),
    "trace": ("arc_length", "curvature", "branch"),
    "landscape": ("amplitude", "energy_total", "mode"),
}


def draw_result(result: Result, ax: Axes | None) -> Axes:
    """Draws a result; see `Result.plot`."""
    columns = CURVES.get(result.kind)
    if columns is None or not {columns[0], columns[1]} <= result.table.keys():
        return result._shown().plot(ax)
    import matplotlib.pyplot as plt

    axes: Any = plt.figure().add_subplot() if ax is None else ax
    along, value, apart = columns
    table = result.table
    curves = table.get(apart, np.zeros(len(table[along])))
    for curve in np.unique(curves):
        here = curves == curve
        axes.plot(table[along][here], table[value][here], marker=".", label=f"{apart} {curve}")
    axes.set(xlabel=along.replace("_", " "), ylabel=value.replace("_", " "), title=result.name)
    if len(np.unique(curves)) > 1:
        axes.legend()
    drawn: Axes = axes
    return drawn
