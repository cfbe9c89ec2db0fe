"""Sheets: one cell of a periodic sheet, or a finite sheet."""

from __future__ import annotations

import json
import os
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TextIO

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _foldwell
from .arrays import entries, integers, matrix, of_edges, polygons, whole

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["Sheet", "generate", "pattern_help", "patterns"]

Angle = float | str
Pair = Sequence[int] | NDArray[np.integer[Any]]


class Sheet:
    """A sheet: vertices, polygons and the edges between them; one cell and two lattice vectors if it is periodic.

    Sheets come from files (`Sheet.read`), from arrays (`Sheet.from_arrays`) and from patterns (`generate`), all through the same
    checks. They do not change.

    Example:
        >>> import foldwell as fw
        >>> sheet = fw.generate("miura")
        >>> sheet.vertices.shape, sheet.edges.shape, len(sheet.polygons)
        ((4, 3), (12, 4), 4)
        >>> sorted(set(sheet.kinds.tolist())), sorted(set(sheet.letters.tolist()))
        (['crease', 'facet'], ['J', 'M', 'V'])
    """

    def __init__(self, inner: _foldwell.Sheet) -> None:
        self._inner = inner

    def __reduce__(self) -> tuple[type[Sheet], tuple[_foldwell.Sheet]]:
        return (type(self), (self._inner,))

    @classmethod
    def read(
        cls, source: str | os.PathLike[str] | TextIO, *, frame: int | None = None, merge: float | None = None
    ) -> Sheet:
        """Reads a mesh.

        Args:
            source: Path of a .fold, .obj, .stl, .vtu, .svg, .cp, .opx, .ori or .dxf file, or an open text file in the FOLD format.
            frame: Frame of a FOLD file: 0 is its top, those of `file_frames` are 1, 2, ...; left out: the first with a mesh.
            merge: Distance, in units of the file, up to which line ends of a drawing are one point; left out: 1e-4 of its extent,
                or more where lines end beside each other otherwise. For paths of drawings and flat FOLD files.

        Raises:
            SheetError: the file cannot be read or draws no sheet; the message names the place.
            ValueError, TypeError: the open file is closed, `merge` is given for an open file, or there is neither path nor file.

        Example:
            >>> import foldwell as fw
            >>> fw.Sheet.read("meshes/crane.fold").lattice is None
            True
        """
        frame = whole(frame, "frame", 0)
        if not (os.fspath(source) if isinstance(source, (str, os.PathLike)) else hasattr(source, "read")):
            raise TypeError(f"source is {source!r}, expected a path or an open text file")
        if isinstance(source, (str, os.PathLike)):
            return cls(_foldwell.Sheet.read(Path(source), frame, merge))
        if merge is not None:
            raise ValueError("`merge` is for files that are given by their path")
        return cls(_foldwell.Sheet.parse(source.read(), str(getattr(source, "name", "<text>")), frame))

    @classmethod
    def from_arrays(
        cls,
        vertices: ArrayLike,
        faces: Sequence[Sequence[int]] | NDArray[np.integer[Any]],
        *,
        lattice: ArrayLike | None = None,
        edges: ArrayLike | None = None,
        letters: Sequence[str] | None = None,
        fold_angles: ArrayLike | None = None,
        title: str = "",
    ) -> Sheet:
        """Makes a sheet from arrays.

        Args:
            vertices: Positions, shape (n, 3), or (n, 2) in the plane.
            faces: Polygons as vertex numbers, counter-clockwise. In a periodic sheet the vertices include the copies in
                neighbouring cells that the faces of one cell need; they are found by the lattice vectors.
            lattice: The two lattice vectors, shape (2, 3); left out: the sheet is finite.
            edges: Ends of edges, shape (m, 2), to which `letters` and `fold_angles` belong. In space an edge of no face is a bar, as
                cables and struts are; three faces and more may share an edge.
            letters: Letter of each edge as in FOLD: "M" mountain, "V" valley, "F" flat, "B" boundary, "C" cut, "U" unassigned.
            fold_angles: Fold angle of each edge in radians, positive for valleys; where they differ from the drawn ones they are
                targets (`rest="target"`). NaN: none.
            title: Name of the sheet.

        Raises:
            ValueError: an array has the wrong shape, or numbers that are not finite.
            SheetError: the arrays draw no sheet; the message names the vertex, edge or face.

        Example:
            >>> import foldwell as fw
            >>> square = fw.Sheet.from_arrays([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1, 2), (0, 2, 3)])
            >>> square.info["creases"]
            1

            A cell of two triangles that repeats: the copies of its vertex are in the list too.

            >>> corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
            >>> cell = fw.Sheet.from_arrays(corners, [(0, 1, 2), (0, 2, 3)], lattice=[(1, 0, 0), (0, 1, 0)])
            >>> cell.vertices.shape, cell.edges.tolist()
            ((1, 3), [[0, 0, 1, 0], [0, 0, 0, 1], [0, 0, 1, 1]])
        """
        points = matrix(vertices, "vertices", (2, 3))
        vectors = None if lattice is None else matrix(lattice, "lattice", (2, 3), rows=2)
        ends = [] if edges is None else integers(edges, "edges", "two vertex numbers for each edge").tolist()
        words = [] if letters is None else [str(letter) for letter in entries(letters, "letters")]
        given = [] if fold_angles is None else np.atleast_1d(np.asarray(fold_angles, dtype=object)).tolist()
        angles = of_edges([np.nan if angle is None else angle for angle in given], "fold_angles").tolist()
        for name, values in (("letters", words), ("fold_angles", angles)):
            if values and len(values) != len(ends):
                raise ValueError(f"{name} has shape ({len(values)},), expected ({len(ends)},), one for each of `edges`")
        corners = polygons(faces)
        for name, lists in (("faces", corners), ("edges", ends)):
            if (wrong := next((k for k, numbers in enumerate(lists) if min(numbers, default=0) < 0), None)) is not None:
                raise ValueError(f"{name}[{wrong}] names vertex {min(lists[wrong])}, expected 0 or more")
        return cls(_foldwell.Sheet.of_arrays(title, (points, corners, vectors), (ends, words, angles)))

    @property
    def title(self) -> str:
        """Name of the sheet."""
        return self._inner.title

    @property
    def vertices(self) -> NDArray[np.float64]:
        """Drawn positions of the vertices of the cell, shape (n, 3)."""
        return self._inner.vertices

    @property
    def lattice(self) -> NDArray[np.float64] | None:
        """The two lattice vectors, shape (2, 3); None for a finite sheet and for the cell of a tube."""
        return self._inner.lattice

    @property
    def screws(self) -> NDArray[np.float64] | None:
        """Turns about z in radians and translations along it of the two screw motions that repeat the cell of a tube, shape (2, 2), a row
        for each; None for other sheets."""
        return self._inner.screws

    @property
    def edges(self) -> NDArray[np.int64]:
        """Names `i, j, n1, n2` of the edges of the cell, diagonals of polygons included: from vertex `i` to vertex `j` of the cell
        `(n1, n2)`; shape (m, 4)."""
        return self._inner.edges

    @property
    def kinds(self) -> NDArray[np.str_]:
        """Kind of each edge: "crease", "facet" (a diagonal of a polygon) or "boundary", shape (m,)."""
        return np.array(self._inner.kinds)

    @property
    def letters(self) -> NDArray[np.str_]:
        """Letter of each edge: that of the file, or what the drawing shows, shape (m,)."""
        return np.array(self._inner.letters)

    @property
    def fold_angles(self) -> NDArray[np.float64]:
        """Drawn fold angle of each edge in radians, positive for valleys, 0 at the rim, shape (m,)."""
        return self._inner.fold_angles

    @property
    def polygons(self) -> list[list[tuple[int, int, int]]]:
        """Corners of the polygons of the cell, counter-clockwise: vertex and the two numbers of its cell."""
        return self._inner.polygons

    @property
    def info(self) -> dict[str, Any]:
        """Counts and measures, as `foldwell info --json` prints them."""
        found: dict[str, Any] = json.loads(self._inner.info())
        return found

    def save(self, path: str | os.PathLike[str], *, thickness: float | None = None) -> None:
        """Writes the sheet in the format of the ending: .fold, .obj, .vtu, .stl, .ply, .glb, .svg, .cp or .dxf. Warns of what the file
        does not keep.

        Args:
            path: The file.
            thickness: As in `State.save`.

        Raises:
            SceneError: the ending is unknown, a flat format is asked for and the sheet is not flat, or the thickness is not above 0.
            OutputError: the file cannot be written.

        Example:
            >>> import foldwell as fw
            >>> fw.generate("miura").save("miura.fold")
            >>> fw.Sheet.read("miura.fold").vertices.shape
            (4, 3)
        """
        for note in self._inner.write(Path(path), thickness):
            warnings.warn(note, stacklevel=2)

    def to_fold(self) -> dict[str, Any]:
        """Returns the content of a FOLD file of the sheet.

        Example:
            >>> import foldwell as fw
            >>> sorted(set(fw.generate("miura").to_fold()["edges_assignment"]))
            ['M', 'V']
        """
        found: dict[str, Any] = json.loads(self._inner.to_fold())
        return found

    def plot(self, ax: Axes | None = None, *, paper: str = "#e8e2d4", numbers: bool = False) -> Axes:
        """Draws all faces of one cell as they are drawn, of the cell of a tube with its neighbours, with the options of `State.plot`. Needs
        Matplotlib.

        Example:
            >>> import foldwell as fw
            >>> axes = fw.generate("miura").plot(numbers=True)
        """
        from .assembly import Assembly

        if self.screws is not None:
            return Assembly.patch(self, (8, 4)).drawn.plot(ax, paper=paper, numbers=numbers)
        make = Assembly.patch if self.lattice is None else Assembly.torus
        return make(self).drawn.plot(ax, paper=paper, numbers=numbers)

    def __repr__(self) -> str:
        tube = "finite sheet" if self.screws is None else "cell of a tube"
        kind = tube if self.lattice is None else "periodic cell"
        return f"<foldwell.Sheet {self.title!r}: {kind}, {len(self.vertices)} vertices, {len(self.edges)} edges>"


def generate(
    pattern: str,
    *,
    a: float | None = None, b: float | None = None, c: float | None = None, d: float | None = None,
    width: float | None = None, height: float | None = None, radius: float | None = None, half_span: float | None = None,
    fold: Angle | None = None, sector: Angle | None = None, twist: Angle | None = None, thickness: float | None = None, gap: float | None = None,
    ac: Angle | None = None, ad: Angle | None = None, bc: Angle | None = None, bd: Angle | None = None,
    cells: Pair | None = None, tubes: Pair | None = None, size: Pair | None = None, sides: int | None = None, levels: int | None = None, pleats: int | None = None,
    skew: float | None = None, jitter: float | None = None, seed: int | None = None, symmetry: str | None = None, closed: bool | None = None,
) -> Sheet:
    """Makes the sheet of a pattern.

    Args:
        pattern: One of `patterns()`.
        a, ...: The parameters that `pattern_help(pattern)` lists, with `_` for `-`. Angles are radians, or texts such as "60 deg".

    Raises:
        SceneError: there is no such pattern, or it has no such parameter, or one is outside its range.

    Example:
        >>> import foldwell as fw
        >>> fw.generate("miura", fold="15 deg").lattice.shape
        (2, 3)
    """
    return Sheet(_foldwell.Sheet.generate(locals()))


def patterns() -> list[str]:
    """Returns the names of the patterns.

    Example:
        >>> import foldwell as fw
        >>> "kresling" in fw.patterns()
        True
    """
    return _foldwell.patterns()


def pattern_help(pattern: str) -> str:
    """Returns a page about a pattern: what it is, a drawing, and meaning, range and default of each parameter.

    Raises:
        ValueError: there is no such pattern.

    Example:
        >>> import foldwell as fw
        >>> "fold" in fw.pattern_help("miura")
        True
    """
    return _foldwell.pattern_help(pattern)
