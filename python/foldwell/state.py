"""States of a sheet."""

from __future__ import annotations

import os
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _foldwell

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["State"]


class State:
    """A sheet in one state, as ParaView shows it: points, faces, and quantities on the edges.

    Arrays of numbers are views of the memory of the program, without a copy, and cannot be written. `n` is the number of
    points, `m` of edges and `f` of faces. A patch has its vertices cell by cell. A torus also has the points of the neighbouring
    cells that its edges end at, and a screw all points of the cells that are shown.

    Example:
        >>> import foldwell as fw
        >>> state = fw.relax(fw.Assembly.patch(fw.generate("miura"), bars=1e3, creases=1.0, rest="flat")).state
        >>> len(state.positions), len(state.edges), len(state.fold_angles)
        (4, 5, 5)
    """

    def __init__(self, inner: _foldwell.State) -> None:
        self._inner = inner

    def __reduce__(self) -> tuple[type[State], tuple[_foldwell.State]]:
        return (type(self), (self._inner,))

    @property
    def positions(self) -> NDArray[np.float64]:
        """Positions of the points, shape (n, 3), in the unit of length of the sheet."""
        return self._inner.positions

    @property
    def displacements(self) -> NDArray[np.float64]:
        """Positions minus those of the drawn state, shape (n, 3)."""
        return self._inner.displacements

    @property
    def places(self) -> NDArray[np.int64]:
        """Vertex of the cell, and the two numbers of the cell, of which each point is a copy, shape (n, 3)."""
        return self._inner.places

    @property
    def faces(self) -> NDArray[np.int64]:
        """Points at the corners of each triangle, counter-clockwise seen from the side of the normals, shape (f, 3)."""
        return self._inner.faces

    @property
    def self_intersecting(self) -> NDArray[np.uint8]:
        """1 for triangles that pass through others, shape (f,); all 0 unless the study has `check=["self-intersection"]`."""
        return self._inner.self_intersecting

    @property
    def edges(self) -> NDArray[np.int64]:
        """Points at the ends of each edge, shape (m, 2)."""
        return self._inner.edges

    @property
    def kinds(self) -> NDArray[np.str_]:
        """Kind of each edge, "crease", "facet" or "boundary", shape (m,)."""
        return np.array(self._inner.kinds)

    @property
    def letters(self) -> NDArray[np.str_]:
        """Letter of each edge in the FOLD format, "M", "V", "F", "B", ..., shape (m,)."""
        return np.array(self._inner.letters)

    @property
    def cell_edges(self) -> NDArray[np.int32]:
        """Number of the edge of the sheet's cell of which each edge is a copy, shape (m,)."""
        return self._inner.cell_edges

    @property
    def fold_angles(self) -> NDArray[np.float64]:
        """Fold angle of each edge in radians, positive for valleys, shape (m,); NaN at the rim."""
        return self._inner.on_edges["fold_angle"]

    @property
    def rest_angles(self) -> NDArray[np.float64]:
        """Fold angle in radians at which each hinge has no torque, shape (m,)."""
        return self._inner.on_edges["rest_angle"]

    @property
    def strains(self) -> NDArray[np.float64]:
        """Strain `L / L0 - 1` of each bar, shape (m,)."""
        return self._inner.on_edges["strain"]

    @property
    def energies(self) -> NDArray[np.float64]:
        """Energy of the bar and the hinge of each edge together, shape (m,)."""
        return self._inner.on_edges["energy"]

    @property
    def tensions(self) -> NDArray[np.float64]:
        """Force along each bar, positive in tension, shape (m,)."""
        return self._inner.on_edges["tension"]

    @property
    def torques(self) -> NDArray[np.float64]:
        """Torque of the hinge of each edge, the derivative of its energy by the fold angle, shape (m,)."""
        return self._inner.on_edges["torque"]

    @property
    def memory(self) -> dict[str, NDArray[np.float64]]:
        """What edges keep that have yielded, each of shape (m,): `plastic_angle` of hinges in radians, `plastic_strain` of bars, and
        how far these have gone in all, `plastic_angle_total` and `plastic_strain_total`. Empty where nothing yields.

        Example:
            >>> import foldwell as fw
            >>> sheet = fw.Assembly.patch(fw.generate("miura"), (2, 2), creases=1.0, rest="flat", yields={"creases": {"moment": 0.1}})
            >>> sorted(fw.relax(sheet).state.memory)
            ['plastic_angle', 'plastic_angle_total']
        """
        return self._inner.memory

    def save(self, path: str | os.PathLike[str], *, thickness: float | None = None) -> None:
        """Writes the state in the format of the ending.

        `.vtu` has everything, for ParaView, PyVista, meshio and `start`; `.glb` (binary glTF) faces and coloured edges, for viewers and
        slides; `.stl` and `.ply` triangles, for printers; `.obj` and `.fold` the sheet as this state draws it, with its polygons and letters.
        Warns of what the file does not keep.

        Args:
            path: The file.
            thickness: Thickness of the sheet: the file has the closed surface of the solid, which can be printed. Left out: the faces alone.

        Raises:
            SceneError: the ending is another one, the faces are no sheet: one has no area; or the thickness is not above 0. Nothing is
                written.
            OutputError: the file cannot be written.

        Example:
            >>> import foldwell as fw
            >>> from pathlib import Path
            >>> state = fw.Assembly.patch(fw.generate("miura"), (2, 2), bars=1e3, creases=1.0).drawn
            >>> state.save("drawn.vtu")
            >>> Path("drawn.vtu").exists()
            True
        """
        for note in self._inner.save(Path(path), thickness):
            warnings.warn(note, stacklevel=2)

    def to_pyvista(self) -> Any:
        """Returns the state as a `pyvista.UnstructuredGrid` with the arrays of the VTU files, coloured by the fold angle.

        Needs PyVista.

        Example:
            >>> import foldwell as fw
            >>> state = fw.Assembly.patch(fw.generate("miura"), (2, 2), bars=1e3, creases=1.0).drawn
            >>> state.to_pyvista().n_points
            16
        """
        import pyvista

        cells = {pyvista.CellType.TRIANGLE: self.faces, pyvista.CellType.LINE: self.edges}
        grid = pyvista.UnstructuredGrid(cells, self.positions.copy())
        grid.point_data["displacement"] = self.displacements.copy()
        for name, numbers in zip(("vertex", "cell1", "cell2"), self.places.T.astype(np.int32), strict=True):
            grid.point_data[name] = numbers
        faces, inner = len(self.faces), self._inner
        for name, values in (inner.on_edges | inner.memory).items():
            grid.cell_data[name] = np.concatenate([np.full(faces, np.nan), values])
        grid.cell_data["self_intersecting"] = np.concatenate([self.self_intersecting, np.zeros(len(self.edges), np.uint8)])
        letters = np.array(["BMVFUCJ".index(letter) for letter in inner.letters], np.int32)
        for name, wholes in (("edge", self.cell_edges), ("assignment", letters)):
            grid.cell_data[name] = np.concatenate([np.full(faces, -1, np.int32), wholes])
        grid.set_active_scalars("fold_angle", preference="cell")
        return grid

    def plot(self, ax: Axes | None = None, *, paper: str = "#e8e2d4", numbers: bool = False) -> Axes:
        """Draws the sheet in 3D: faces in the colour `paper`, valleys blue, mountains red, other edges grey. Needs Matplotlib.

        Args:
            ax: Axes with `projection="3d"`; new ones if left out.
            paper: Colour of the faces.
            numbers: Whether each point has its vertex number beside it, and the two numbers of its cell if that is not (0, 0), as
                pins and loads name them.

        Returns:
            The axes.

        Example:
            >>> import foldwell as fw
            >>> axes = fw.Assembly.patch(fw.generate("miura"), (2, 2), bars=1e3, creases=1.0).drawn.plot()
        """
        from .plots import draw_state

        return draw_state(self, ax, paper, numbers)

    def _repr_svg_(self) -> str:
        """The drawing of the program, which notebooks show."""
        return self._inner.svg()

    def __repr__(self) -> str:
        return f"<foldwell.State: {len(self.positions)} points, {len(self._inner.kinds)} edges, {len(self.faces)} faces>"
