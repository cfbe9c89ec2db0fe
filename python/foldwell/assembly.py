"""Assemblies: a sheet with boundary conditions and terms, and its energy as a function."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _foldwell
from .arrays import polygons, vector
from .sheet import Sheet
from .state import State
from .terms import Called, Energy

if TYPE_CHECKING:
    from scipy.sparse import csc_array, csr_array

__all__ = ["RIGID", "Assembly"]

#: The stiffness of exactly rigid bars and hinges.
RIGID = math.inf

Table = Mapping[str, Any]
Tables = Iterable[Table]
#: A number, a word, a dict as in a scene, or an array with a number for each edge.
Stiffness = float | str | Table | ArrayLike
Rest = float | str | Table | ArrayLike
Laws = Mapping[str, Table]
EdgeName = Sequence[int]
Locks = Mapping[EdgeName, float | str | None] | Iterable[EdgeName]

#: Keys of a scene that say how a sheet becomes a model.
PLACE = ("cells", "lattice", "seam", "closing", "inwards")


class Assembly:
    """A sheet with its boundary conditions and terms: what studies are about.

    The terms are those of a scene, with the names and forms of its keys; the book describes them. Wherever a scene takes a table
    in a file, an array is taken here: one number for each edge of the sheet's cell (`sheet.edges`), or for each edge of the model
    (`assembly.edges`); numbers at edges that are no element of the term are not read.

    Example:
        >>> import foldwell as fw
        >>> held = fw.Assembly.patch(fw.generate("miura"), (2, 2), bars=1e3, creases=1.0)
        >>> held.cells, len(held.edges), sorted(set(held.kinds.tolist()))
        ((2, 2), 33, ['boundary', 'crease', 'facet'])
        >>> bool(held.energy(held.start) < 1e-20), held.drawn.positions.shape
        (True, (16, 3))
    """

    def __init__(self, inner: _foldwell.Assembly) -> None:
        self._inner = inner

    def __reduce__(self) -> tuple[type[Assembly], tuple[_foldwell.Assembly]]:
        return (type(self), (self._inner,))

    @classmethod
    def patch(
        cls,
        sheet: Sheet,
        cells: tuple[int, int] = (1, 1),
        *,
        bars: Stiffness | None = None, rest_lengths: Rest | None = None, creases: Stiffness | None = None, rest: Rest | None = None,
        fraction: float | None = None, facets: Stiffness | None = None, facet_rest: Rest | None = None,
        laws: Laws | None = None, yields: Laws | None = None, locks: Locks | None = None, drives: Tables | None = None,
        mass: Table | None = None, material: Table | None = None, membrane: bool | None = None, units: Table | None = None,
        pins: Tables | None = None, loads: Tables | ArrayLike | None = None, pressures: Tables | None = None,
        parts: Tables | None = None, ties: Tables | None = None, springs: Tables | None = None,
    ) -> Assembly:
        """Makes a patch: `cells[0]` times `cells[1]` cells with free edges, or a finite sheet.

        Args:
            sheet: The sheet.
            cells: Numbers of cells along the two lattice vectors.
            bars: Stiffness of the bars `EA`, a force, of every edge: a number, `RIGID`, a dict by letters, "mesh", or an array.
                Left out: no bars.
            rest_lengths: Rest lengths of the bars: "drawn", a factor on the drawn ones, or an array. Left out: drawn.
            creases: Stiffness of the creases: torque per radian and per length. Forms as for `bars`.
            rest: Rest angles of the creases in radians: a number, "drawn", "flat", "assigned", "target", a dict by letters
                (`{"M": -1.0, "V": 1.0}`), a mode (`{"mode": [k11, k22, k12], "amplitude": a}`), or an array. Left out: drawn.
            fraction: Factor on the rest angles "assigned", "target" and by letters, from -1 (folded to the other side) to 1 (folded).
            facets: Stiffness of the diagonals of polygons, or a model with the stiffness of `material`: "N5B8" gives quadrilaterals a
                vertex where their diagonals cross. Left out: rigid, or as `material` has it.
            facet_rest: Rest angles of the facets, as `rest`.
            locks: Creases that keep their angle: a dict from names `(i, j, n1, n2)` to angles in radians (None: the drawn one),
                or names alone.
            pins: Vertices that are held, each a dict as `[[pin]]`: `{"vertex": 3, "cell": (0, 0), "axes": "xyz"}`.
            loads: Forces on vertices, each a dict as `[[load]]`: `{"vertex": 3, "cell": (0, 0), "force": (0, 0, -1.0)}`; or an array with
                a force for each vertex, cell by cell, shape (n, 3); or the weight of the sheet, `{"weight": (0, 0, -9.81)}`.
            pressures: Pressures on faces, each a dict as `[[pressure]]`: `{"value": 0.1}` on all, positive along their normals;
                `{"name": "air"}` for drives of the pressure, `{"name": "p", "pressure": "air", "to": 0.1}`, or of the volume.
            parts: Vertices that move as rigid bodies, each a dict as `[[part]]`.
            ties: Vertices that are drawn in one place and stay together, each a dict as `[[tie]]`: `{"vertices": "coincident"}`.
            springs: Springs between two vertices, each a dict as `[[spring]]`: `{"vertices": [3, (7, 0, 1)], "stiffness": 2.0}`.
            drives: Quantities that `path` drives, each a dict as `[[drive]]`.
            laws: Laws other than that of a spring, by term: `{"bars": {"kind": "ogden", "exponents": [5.0, 1.0]},
                "creases": {"kind": "stiffening", "limits": [-2.5, 2.5]}}`; a formula, `{"kind": "formula", "torque":
                "k*sinh(m - m0)"}`; a measured curve, `{"kind": "table", "points": np.column_stack([angle, torque])}`, angles in
                radians off rest. By letters of FOLD: `{"creases": {"M": {"kind": "stiffening", ..}, "V": ..}}`; others are springs.
            yields: Where elements yield, by term: `{"creases": {"moment": 0.2, "hardening": 0.05}, "bars": {"force": 3.0}}`.
            mass: Mass, from which frequencies and weight follow: `{"vertex": m}` of every vertex, or `{"area": rho}` per area. Left out: none.
            material: The elastic sheet from which stiffnesses follow that are not given: `{"young": 1400.0, "poisson": 0.4,
                "thickness": 0.3, "crease_length": 20.0}`; without `crease_length` there are no creases. Left out: none.
            membrane: Whether triangles are stretched and sheared as a plate of the `material`, in the place of bars that are not
                given. Left out: no.
            units: Names of units for axes and xarray, `{"length": "mm", "force": "N"}`; they change no number.

        Raises:
            SceneError: a value is wrong, or does not fit the sheet.
            ValueError, TypeError: an array has the wrong length, type or numbers.

        Example:
            >>> import foldwell as fw
            >>> sheet = fw.generate("miura")
            >>> held = fw.Assembly.patch(sheet, (3, 3), bars=fw.RIGID, creases=1.0, rest={"M": -1.2, "V": 1.2})
            >>> fw.relax(held).converged
            True
        """
        return _built("patch", **locals())

    @classmethod
    def torus(
        cls,
        sheet: Sheet,
        cells: tuple[int, int] = (1, 1),
        *,
        lattice: str = "free",
        bars: Stiffness | None = None, rest_lengths: Rest | None = None, creases: Stiffness | None = None, rest: Rest | None = None,
        fraction: float | None = None, facets: Stiffness | None = None, facet_rest: Rest | None = None,
        laws: Laws | None = None, yields: Laws | None = None, locks: Locks | None = None, drives: Tables | None = None,
        mass: Table | None = None, material: Table | None = None, membrane: bool | None = None, units: Table | None = None,
    ) -> Assembly:
        """Makes a torus: cells that repeat, whose lattice vectors are unknowns (`lattice="free"`) or stay as drawn ("fixed").

        Terms as in `patch`, without pins, loads, pressures, parts, ties and springs.

        Example:
            >>> import foldwell as fw
            >>> fw.Assembly.torus(fw.generate("miura"), bars=1e3, creases=1.0, lattice="fixed").cells
            (1, 1)
        """
        return _built("torus", **locals())

    @classmethod
    def screw(
        cls,
        sheet: Sheet,
        cells: tuple[int, int] = (6, 6),
        *,
        bars: Stiffness | None = None, rest_lengths: Rest | None = None, creases: Stiffness | None = None, rest: Rest | None = None,
        fraction: float | None = None, facets: Stiffness | None = None, facet_rest: Rest | None = None,
        laws: Laws | None = None, yields: Laws | None = None, locks: Locks | None = None, drives: Tables | None = None,
        mass: Table | None = None, material: Table | None = None, membrane: bool | None = None, units: Table | None = None,
    ) -> Assembly:
        """Makes a screw: one cell repeated by two commuting screw motions, so that the sheet can be a cylinder.

        Args:
            sheet: The sheet.
            cells: Cells of pictures; they have no influence on numbers.
            bars, ...: Terms as in `patch`, without pins, loads, pressures, parts, ties and springs.

        Example:
            >>> import foldwell as fw
            >>> star = fw.Sheet.read("meshes/open-star.fold")
            >>> rolled = fw.Assembly.screw(star, bars=fw.RIGID, creases=1.0, rest="flat")
            >>> rolled.cells
            (1, 1)
        """
        return _built("screw", **locals())

    @classmethod
    def tube(
        cls,
        sheet: Sheet,
        seam: tuple[int, int],
        cells: tuple[int, int] | None = None,
        *,
        closing: str = "both",
        inwards: bool | None = None,
        bars: Stiffness | None = None, rest_lengths: Rest | None = None, creases: Stiffness | None = None, rest: Rest | None = None,
        fraction: float | None = None, facets: Stiffness | None = None, facet_rest: Rest | None = None,
        laws: Laws | None = None, yields: Laws | None = None, locks: Locks | None = None, drives: Tables | None = None,
        mass: Table | None = None, material: Table | None = None, membrane: bool | None = None, units: Table | None = None,
    ) -> Assembly:
        """Makes a tube: the sheet rolled up, or drawn as a tube, and closed so that the cell `seam` lies on cell (0, 0).

        Args:
            sheet: The sheet, drawn spatially periodic and folded, or as one cell that screw motions repeat.
            seam: The cell (n1, n2).
            cells: Strands and rows of cells of pictures. Left out: all strands, and rows for about the width of the tube.
            closing: The closing conditions that hold: "both", "turn" (the seam slips) or "rise" (the tube opens or overlaps).
            inwards: Whether the sheet is rolled up towards its face normals, which it is if this is left out. Not for a sheet that is
                drawn as a tube.
            bars, ...: Terms as in `patch`, without pins, loads, pressures, parts, ties and springs.

        Raises:
            SceneError: the sheet cannot be rolled up until it closes, or is drawn as a tube that does not close there.

        Example:
            >>> import foldwell as fw
            >>> cell = fw.Sheet.read("meshes/kresling-cell.fold")
            >>> fw.Assembly.tube(cell, (6, 0), bars=1e3, creases=1.0).cells
            (1, 1)
        """
        return _built("tube", **locals())

    @classmethod
    def from_scene(
        cls, scene: str | os.PathLike[str] | Table, *, set: Table | None = None, base: str | os.PathLike[str] = ""
    ) -> Assembly:
        """Builds the assembly of a scene, whose studies are ignored.

        Args:
            scene: Path of a scene file, or its content as a dict.
            set: Keys that are set first, by their path: `{"energy.bars.stiffness": 1e4}`.
            base: Folder to which paths in a dict are relative; left out: the current one.

        Raises:
            SceneError: the scene is wrong.

        Example:
            >>> import foldwell as fw
            >>> held = fw.Assembly.from_scene("meshes/star.toml", set={"sheet.cells": [2, 2]})
            >>> held.cells
            (2, 2)
        """
        given = dict(scene) if isinstance(scene, Mapping) else Path(scene)
        return cls(_foldwell.Assembly(given, Path(base), dict(set or {})))

    def with_term(self, name: str, vertices: ArrayLike, energy: Energy) -> Assembly:
        """Returns the same patch with a term of your own, whose energy is listed as `energy_NAME`; see the book.

        Args:
            name: Name of the term.
            vertices: Vertices of each element, shape (elements, n), n from 1 to 6, numbered cell by cell as `state.positions`.
            energy: Function of the positions of the vertices of an element, shape (n, 3), that returns its energy, gradient (3 n numbers)
                and Hessian (3 n times 3 n), vertex by vertex. It is called for one element at a time, on any thread. An exception in it
                ends the study and is raised.

        Raises:
            SceneError: the assembly is no patch, has a term of this name, or lacks a vertex.
            ValueError, TypeError: the name has other signs than letters, digits, `_` and `-`, vertices are no such numbers, or the
                energy is no function.

        Example:
            >>> import foldwell as fw
            >>> import numpy as np
            >>> def pull(points):  # vertex 0 to the plane z = 0
            ...     z = points[0, 2]
            ...     return z**2 / 2, [0, 0, z], np.diag([0, 0, 1.0])
            >>> held = fw.Assembly.patch(fw.generate("miura"), bars=1e3, creases=1.0, pins=[{"vertex": v} for v in (1, 2, 3)])
            >>> fw.relax(held.with_term("pull", [[0]], pull)).converged
            True
        """
        if not re.fullmatch("[A-Za-z0-9_-]+", name):
            raise ValueError(f"name is {name!r}, expected letters, digits, `_` and `-`")
        if not callable(energy):
            raise TypeError(f"energy is {energy!r}, expected a function of the positions of the vertices of an element")
        elements = polygons(vertices, "vertices", "vertex numbers such as [0, 12]")  # type: ignore[arg-type]
        if not elements:
            raise ValueError("vertices is empty, expected a list of vertex numbers for each element")
        for number, element in enumerate(elements):
            if min(element, default=-1) < 0 or len(set(element)) < len(element) or len(element) != len(elements[0]):
                expected = "different numbers, 0 or more, as many as in vertices[0]"
                raise ValueError(f"vertices[{number}] is {element}, expected {expected}")
        return Assembly(self._inner.with_term(name, elements, Called(name, energy)))

    @property
    def sheet(self) -> Sheet:
        """The sheet."""
        return Sheet(self._inner.sheet)

    @property
    def cells(self) -> tuple[int, int]:
        """Numbers of cells of the model."""
        first, second = self._inner.cells
        return (first, second)

    @property
    def edges(self) -> NDArray[np.int64]:
        """The edges of the model: the two numbers of the cell and the name `i, j, n1, n2` of each, shape (m, 6)."""
        return self._inner.edges

    @property
    def kinds(self) -> NDArray[np.str_]:
        """Kind of each edge of the model: "crease", "facet" or "boundary", shape (m,)."""
        return np.array(self._inner.kinds)

    @property
    def drawn(self) -> State:
        """The drawn state."""
        return self.state(self.start)

    @cached_property
    def _forms(self) -> _foldwell.Forms:
        return self._inner.forms()

    @cached_property
    def start(self) -> NDArray[np.float64]:
        """The unknowns `x` of the drawn state; the array cannot be written, `start.copy()` can.

        The unknowns are the coordinates of the vertices, `x.reshape(-1, 3)` on a patch without pins and parts; those that pins hold
        are left out. A torus with free lattice and a screw have unknowns of the lattice after them.
        """
        return self._forms.start

    def _x(self, x: ArrayLike) -> NDArray[np.float64]:
        return vector(x, "x", len(self.start))

    def unknowns(self, result: Any) -> NDArray[np.float64]:
        """Returns the unknowns `x` of the final state of a result, or of its `coordinates`.

        Raises:
            ValueError: the result has no final state, or is one of another assembly.

        Example:
            >>> import foldwell as fw
            >>> held = fw.Assembly.patch(fw.generate("miura"), (2, 2), bars=1e3, creases=1.0, rest="flat")
            >>> held.unknowns(fw.relax(held)).shape
            (48,)
        """
        coordinates = getattr(result, "coordinates", result)
        return self._forms.unknowns_at(vector(coordinates, "coordinates", np.size(coordinates)))

    def state(self, x: ArrayLike) -> State:
        """Returns the state with these unknowns: positions, angles, strains, forces and energies.

        Example:
            >>> import foldwell as fw
            >>> held = fw.Assembly.patch(fw.generate("miura"), (2, 2), bars=1e3, creases=1.0)
            >>> held.state(held.start * 1.01).strains[:2].round(6).tolist()
            [0.01, 0.01]
        """
        return State(self._forms.state_at(self._x(x)))

    def energy(self, x: ArrayLike) -> float:
        """Returns the energy of the springs, for elements that yield with what they dissipate on the way from the drawn state to `x`,
        minus each force of a load times the unknown that it pushes: differences between states have the work of the loads in them.
        Rigid elements have no energy: see `constraints`.

        Fold angles continue from those of the drawn state, so that the energy is smooth while no angle goes further than pi from it.

        Raises:
            ValueError, TypeError: `x` has the wrong length or type, or a number in it is not finite.

        Example:
            >>> import foldwell as fw
            >>> held = fw.Assembly.patch(fw.generate("miura"), (2, 2), bars=1e3, creases=1.0)
            >>> held.energy(held.start * 1.01) > held.energy(held.start)
            True
        """
        return self._forms.energy(self._x(x))

    def gradient(self, x: ArrayLike) -> NDArray[np.float64]:
        """Returns the derivative of the energy by the unknowns, shape of `x`.

        Example:
            >>> import foldwell as fw
            >>> held = fw.Assembly.patch(fw.generate("miura"), (2, 2), bars=1e3, creases=1.0)
            >>> bool(abs(held.gradient(held.start)).max() < 1e-9)
            True
        """
        return self._forms.gradient(self._x(x))

    def hessian(self, x: ArrayLike) -> csc_array[Any]:
        """Returns the second derivative of the energy, a symmetric `scipy.sparse.csc_array`. Needs SciPy.

        Example:
            >>> import foldwell as fw
            >>> held = fw.Assembly.patch(fw.generate("miura"), (2, 2), bars=1e3, creases=1.0)
            >>> held.hessian(held.start).shape
            (48, 48)
        """
        from scipy.sparse import csc_array, tril

        values, rows, begins = self._forms.hessian(self._x(x))
        lower = csc_array((values, rows, begins), shape=(len(self.start), len(self.start)))
        return csc_array(lower + tril(lower, -1).T)

    def constraints(self, x: ArrayLike) -> NDArray[np.float64]:
        """Returns the lengths and angles of rigid elements minus their rest values; zero where the constraints hold.

        Example:
            >>> import foldwell as fw
            >>> rigid = fw.Assembly.patch(fw.generate("miura"), (2, 2), bars=fw.RIGID, creases=1.0)
            >>> bool(abs(rigid.constraints(rigid.start)).max() < 1e-12)
            True
        """
        return self._forms.constraints(self._x(x))

    def constraint_jacobian(self, x: ArrayLike) -> csr_array[Any, Any]:
        """Returns the derivative of the constraints, a `scipy.sparse.csr_array`. Needs SciPy.

        Example:
            >>> import foldwell as fw
            >>> rigid = fw.Assembly.patch(fw.generate("miura"), (2, 2), bars=fw.RIGID, creases=1.0)
            >>> rigid.constraint_jacobian(rigid.start).shape == (len(rigid.constraints(rigid.start)), 48)
            True
        """
        return self._rows(self._forms.constraint_jacobian(self._x(x)))

    def lengths(self, x: ArrayLike) -> NDArray[np.float64]:
        """Returns the length of each edge of the model; NaN inside rigid parts.

        Example:
            >>> import foldwell as fw
            >>> held = fw.Assembly.patch(fw.generate("miura"), (2, 2), bars=1e3, creases=1.0)
            >>> held.lengths(held.start).shape
            (33,)
        """
        return self._forms.measures(self._x(x), False)

    def lengths_jacobian(self, x: ArrayLike) -> csr_array[Any, Any]:
        """Returns the derivative of `lengths`, a `scipy.sparse.csr_array`. Needs SciPy.

        Example:
            >>> import foldwell as fw
            >>> held = fw.Assembly.patch(fw.generate("miura"), (2, 2), bars=1e3, creases=1.0)
            >>> held.lengths_jacobian(held.start).shape
            (33, 48)
        """
        return self._rows(self._forms.measures_jacobian(self._x(x), False))

    def fold_angles(self, x: ArrayLike) -> NDArray[np.float64]:
        """Returns the fold angle of each edge of the model in radians, valley positive; NaN where there is no hinge.

        Angles continue from those of the drawn state, as in `energy`.

        Example:
            >>> import foldwell as fw
            >>> held = fw.Assembly.patch(fw.generate("miura"), (2, 2), bars=1e3, creases=1.0)
            >>> held.fold_angles(held.start).shape
            (33,)
        """
        return self._forms.measures(self._x(x), True)

    def fold_angles_jacobian(self, x: ArrayLike) -> csr_array[Any, Any]:
        """Returns the derivative of `fold_angles`, a `scipy.sparse.csr_array`; rows of edges without a hinge are empty.

        Example:
            >>> import foldwell as fw
            >>> held = fw.Assembly.patch(fw.generate("miura"), (2, 2), bars=1e3, creases=1.0)
            >>> held.fold_angles_jacobian(held.start).shape
            (33, 48)
        """
        return self._rows(self._forms.measures_jacobian(self._x(x), True))

    def _rows(self, sparse: tuple[NDArray[Any], NDArray[Any], NDArray[Any]]) -> csr_array[Any, Any]:
        from scipy.sparse import csr_array

        found = csr_array(sparse, shape=(len(sparse[2]) - 1, len(self.start)))
        found.sum_duplicates()
        return found

    def closure(self, rho: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Returns the closure of the faces around the interior vertices of the cell: the exact conditions on fold angles.

        Args:
            rho: Fold angle of each edge of the cell in radians, valley positive, shape (m,), as `sheet.edges`; those at the rim
                are not read.

        Returns:
            The residual, the rotation vector of the product of rotations around each vertex, three numbers for each interior
            vertex, and its derivative by the angles, shape (3 v, m). A set of angles folds rigidly if the residual is zero.

        Example:
            >>> import foldwell as fw
            >>> sheet = fw.generate("miura")
            >>> residual, derivative = fw.Assembly.torus(sheet).closure(sheet.fold_angles)
            >>> bool(abs(residual).max() < 1e-12), derivative.shape
            (True, (12, 12))
        """
        sheet = self._inner.sheet
        return _foldwell.closure(sheet, vector(rho, "rho", len(sheet.edges)))

    def __repr__(self) -> str:
        return f"<foldwell.Assembly of {self.sheet.title!r}: {self.cells[0]} x {self.cells[1]} cells>"


def _built(domain: str, cls: type[Assembly], sheet: Sheet, **given: Any) -> Assembly:
    """Builds the assembly of these arguments of `Assembly.patch`, `torus`, `screw` or `tube`."""
    if not isinstance(sheet, Sheet):
        raise TypeError(f"sheet is a {type(sheet).__name__}, expected a foldwell.Sheet")
    given = {name: value for name, value in given.items() if value is not None}
    for name in ("laws", "yields"):
        if not isinstance(given.get(name, {}), Mapping):
            raise TypeError(f"{name} is {given[name]!r}, expected a dict by terms such as {{\"creases\": {{..}}}}")
        if (other := next((term for term in given.get(name, {}) if term not in ("bars", "creases", "facets")), None)) is not None:
            raise TypeError(f"{name}[{other!r}] is of no term, expected bars, creases or facets")
    energy: dict[str, Any] = {term: {"stiffness": given[term]} for term in ("bars", "creases", "facets") if term in given}
    if isinstance(given.get("facets"), str) and given["facets"] != "mesh":
        energy["facets"] = {"model": given["facets"]}
    own = {"bars": ("rest", "rest_lengths"), "creases": ("rest", "rest"), "facets": ("rest", "facet_rest")}
    keys = [(term, key, given.get(name), name) for term, (key, name) in own.items()]
    keys += [("creases", "fraction", given.get("fraction"), "fraction")]
    keys += [(term, "law", law, f"laws[{term!r}]") for term, law in given.get("laws", {}).items()]
    keys += [(term, "yield", bound, f"yields[{term!r}]") for term, bound in given.get("yields", {}).items()]
    curves = {term for term, law in given.get("laws", {}).items() if isinstance(law, Mapping) and law.get("kind") == "table"}
    for term, key, value, name in keys:
        if value is not None and term not in {*energy, *curves} and "material" not in given:
            raise TypeError(f"{name} is given without {term}")
        if value is not None:
            energy.setdefault(term, {})[key] = value
    if "membrane" in given:
        energy["membrane"] = given["membrane"]
    title = sheet.title or "sheet"
    place = {"mesh": title, "domain": domain, **{key: given[key] for key in PLACE if key in given}}
    scene: dict[str, Any] = {"title": title, "sheet": place, "energy": energy, "lock": _locks(given.get("locks", ()))}
    scene |= {name: given.get(name) for name in ("mass", "material", "units")}
    scene |= {name: given.get(f"{name}s") for name in ("pin", "load", "pressure", "part", "tie", "spring", "drive")}
    return cls(_foldwell.Assembly.of_arguments(scene, sheet._inner))


def _locks(locks: Mapping[Any, Any] | Iterable[EdgeName]) -> list[dict[str, Any]]:
    creases = polygons(locks, "locks", "the numbers of a crease such as (0, 1, 0, 0)")
    angles = locks.values() if isinstance(locks, Mapping) else [None] * len(creases)
    return [{"crease": crease, "angle": angle} for crease, angle in zip(creases, angles, strict=True)]
