"""Studies: one function for each kind."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from numpy.typing import ArrayLike, NDArray

from . import _foldwell
from .arrays import entries, integers, whole
from .assembly import Assembly
from .errors import DidNotConverge
from .progress import Progress, listener
from .results import Result
from .sheet import Sheet

__all__ = ["bloch", "branches", "compute", "fold", "landscape", "modes", "path", "relax", "response", "surface", "trace", "wells"]

Start = str | Result | Mapping[str, Any] | None
Mode = Sequence[float] | NDArray[Any] | Mapping[str, Any]


def relax(
    assembly: Assembly,
    *,
    start: Start = None,
    tolerance: float | None = None,
    method: str | None = None,
    keep_every: int | None = None,
    name: str | None = None, draw: Sequence[str] = ("vtk",), check: Sequence[str] = (),
    threads: int | None = None, progress: Progress = None, must_converge: bool = True,
) -> Result:
    """Finds an equilibrium of the energy by Newton's method.

    Args:
        assembly: The sheet and its energy.
        start: The state where it starts: the result of a study of the same assembly, also with other stiffnesses, rest angles and
            locks, a .vtu file, or `{"random": amplitude, "seed": n}`. Left out: as drawn.
        tolerance: Bound on both scaled residuals.
        method: The unknowns: "vertices", "intrinsic" (fold angles), or "auto", the default.
        keep_every: Steps between the states on the way that are kept; left out: none are.
        name, draw, check, threads, progress, must_converge: As for every study, see `compute`.

    Example:
        >>> import foldwell as fw
        >>> held = fw.Assembly.patch(fw.generate("miura"), (3, 3), bars=fw.RIGID, creases=1.0, rest="flat")
        >>> fw.relax(held).summary["negative_eigenvalues"]
        0
    """
    return _study("relax", **locals())


def modes(
    assembly: Assembly,
    *,
    start: Start = None,
    eigenvalues: int | None = None,
    buckling: int | None = None,
    name: str | None = None, draw: Sequence[str] = ("vtk",), check: Sequence[str] = (),
    threads: int | None = None, progress: Progress = None, must_converge: bool = True,
) -> Result:
    """Counts zero modes and self stresses, and finds the lowest eigenvalues of the energy's Hessian, with a mass also frequencies.

    Args:
        assembly: The sheet and its energy.
        start: The state whose modes are wanted, as in `relax`.
        eigenvalues: How many, and how many frequencies where the assembly has a mass; left out: none.
        buckling: How many of the lowest critical factors of the loads, the last one as often as it has independent motions;
            left out: none.
        name, draw, check, threads, progress, must_converge: As for every study, see `compute`.

    Example:
        >>> import foldwell as fw
        >>> summary = fw.modes(fw.Assembly.patch(fw.generate("miura"), (2, 2), bars=fw.RIGID, creases=1.0)).summary
        >>> summary["rigid_motions"], summary["folding_modes"]
        (6, 1)
    """
    return _study("modes", **locals())


def branches(
    assembly: Assembly,
    *,
    name: str | None = None, draw: Sequence[str] = ("vtk",), check: Sequence[str] = (),
    threads: int | None = None, progress: Progress = None, must_converge: bool = True,
) -> Result:
    """Finds the directions in which rigid folding leaves the drawn state.

    Args:
        assembly: The sheet.
        name, draw, check, threads, progress, must_converge: As for every study, see `compute`.

    Example:
        >>> import foldwell as fw
        >>> star = fw.Sheet.read("meshes/open-star.fold")
        >>> fw.branches(fw.Assembly.screw(star)).summary["expected"] > 0
        True
    """
    return _study("branches", **locals())


def trace(
    assembly: Assembly,
    *,
    engine: str | None = None,
    branch: int | str | None = None,
    max_step: float | None = None,
    tolerance: float | None = None,
    stop: Mapping[str, Any] | None = None,
    response: str | None = None,
    name: str | None = None, draw: Sequence[str] = ("vtk",), check: Sequence[str] = (),
    threads: int | None = None, progress: Progress = None, must_converge: bool = True,
) -> Result:
    """Follows the trajectories along which the sheet folds.

    Args:
        assembly: The sheet, with locks so that its folded states are curves.
        engine: What is solved at every step: "kinematic" (closure of the fold angles, the default), "energy" (relaxation) or "both".
        branch: Number of the branch that is followed; left out: all.
        max_step: Longest step in arc length of fold angles, radians.
        tolerance: Bound on the residual.
        stop: Conditions of which the first ends a trajectory: `arc_length`, `curvature`, `crease_angle`
            (`{"crease": (i, j, n1, n2), "angle": a}`), `self_intersection` (bool).
        response: Whether the table has Poisson's ratios of every state: "rigid" of the assembly's modes, "bending" of those with
            polygons that bend and without locks.
        name, draw, check, threads, progress, must_converge: As for every study, see `compute`.

    Example:
        >>> import foldwell as fw
        >>> star = fw.Sheet.read("meshes/open-star.fold")
        >>> driven = fw.Assembly.screw(star, bars=fw.RIGID, creases=1.0, locks=[(0, 1, 0, 0)])
        >>> {branch["end"] for branch in fw.trace(driven, stop={"arc_length": 0.5}).summary["branches"]}
        {'stop'}
    """
    return _study("trace", **locals())


def response(
    assembly: Assembly,
    *,
    start: Start = None,
    directions: int | None = None,
    name: str | None = None, draw: Sequence[str] = ("vtk",), check: Sequence[str] = (),
    threads: int | None = None, progress: Progress = None, must_converge: bool = True,
) -> Result:
    """Describes a periodic sheet as a material: linear folding modes, Poisson's ratios, self stresses and effective moduli.

    Args:
        assembly: The sheet as a screw or a torus of one cell.
        start: The state whose response is wanted, as in `relax`.
        directions: Number of directions over half a turn at which Poisson's ratios are given; left out: 72.
        name, draw, check, threads, progress, must_converge: As for every study, see `compute`.

    Example:
        >>> import foldwell as fw
        >>> miura = fw.Assembly.torus(fw.generate("miura"), bars=fw.RIGID, creases=1.0)
        >>> fw.response(miura).summary["poisson"]["in_plane"] < 0
        True
    """
    return _study("response", **locals())


def surface(
    assembly: Assembly,
    *,
    resolution: int | None = None,
    max_curvature: float | None = None,
    name: str | None = None, draw: Sequence[str] = ("vtk",), check: Sequence[str] = (),
    threads: int | None = None, progress: Progress = None, must_converge: bool = True,
) -> Result:
    """Finds the surface of folded states of one cell.

    Args:
        assembly: The sheet as a screw or a torus of one cell; locks do not apply.
        resolution: States along each direction over a whole turn of fold angles; left out: 32.
        max_curvature: Curvature at which the surface ends, 1/length; left out: one over the square root of the cell's area.
        name, draw, check, threads, progress, must_converge: As for every study, see `compute`.

    Example:
        >>> import foldwell as fw
        >>> star = fw.Sheet.read("meshes/open-star.fold")
        >>> fw.surface(fw.Assembly.screw(star), resolution=8, max_curvature=0.2).kind
        'surface'
    """
    return _study("surface", **locals())


def landscape(
    assembly: Assembly,
    modes: Iterable[Mode],
    amplitudes: Sequence[float] | NDArray[Any],
    *,
    map: Mapping[str, Any] | None = None,
    name: str | None = None, draw: Sequence[str] = ("vtk",), check: Sequence[str] = (),
    threads: int | None = None, progress: Progress = None, must_converge: bool = True,
) -> Result:
    """Measures the energy along folding modes.

    Args:
        assembly: The sheet and its energy.
        modes: Curvature tensors `(k11, k22, k12)` that the modes make at unit amplitude, or arrays with the rate of the fold angle of
            each edge of the cell, or `{"wave": (m1, m2)}` on a torus.
        amplitudes: Amplitudes along each mode, positive.
        map: Energies in all directions: `{"amplitude": a, "rings": n}`.
        name, draw, check, threads, progress, must_converge: As for every study, see `compute`.

    Example:
        >>> import foldwell as fw
        >>> star = fw.Sheet.read("meshes/open-star.fold")
        >>> patch = fw.Assembly.patch(star, (2, 2), bars=1e4, creases=1.0)
        >>> measured = fw.landscape(patch, [(1, 1, 0)], [0.001, 0.002, 0.004])
        >>> round(measured.summary["modes"][0]["exponent"])
        4
    """
    return _study("landscape", **locals())


def bloch(
    assembly: Assembly,
    *,
    start: Start = None,
    grid: tuple[int, int] | None = None,
    q1: Sequence[float] | NDArray[Any] | None = None,
    modes: Sequence[tuple[float, float]] | None = None,
    path: Sequence[tuple[float, float]] | None = None,
    density: Mapping[str, Any] | None = None,
    strip: Mapping[str, Any] | None = None,
    zero_modes_at: Sequence[tuple[float, float]] | NDArray[Any] | None = None,
    name: str | None = None, draw: Sequence[str] = ("vtk",), check: Sequence[str] = (),
    threads: int | None = None, progress: Progress = None, must_converge: bool = True,
) -> Result:
    """Finds the modes of nonzero wavenumber of a periodic sheet.

    Args:
        assembly: The sheet.
        start: The state whose modes are wanted: the result of a study of one cell. Left out: as drawn.
        grid: Wavenumbers sampled along each direction; left out: (256, 256).
        q1: First wavenumbers at which decay rates are wanted, radians per cell; left out: 32 that divide the zone evenly.
        modes: Modes of which the displacement is kept, each `(q1, kappa2)`.
        path: Corners `(q1, q2)` of a path through the zone along which the bands of the energy are wanted, with a mass also
            frequencies.
        density: The density of states of a sheet with mass: `{"grid": (64, 64), "bins": 100}`.
        strip: A strip with free edges whose zero modes are wanted at every `q1`: `{"cells": 60}`, with `"other"` the mesh of
            the upper half, with `"clamped": True` clamped edges.
        zero_modes_at: Wavenumbers `(q1, q2)` at which zero modes and self stresses are counted.
        name, draw, check, threads, progress, must_converge: As for every study, see `compute`.

    Example:
        >>> import foldwell as fw
        >>> star = fw.Sheet.read("meshes/open-star.fold")
        >>> fw.bloch(fw.Assembly.torus(star), grid=(16, 16), q1=[0.5]).summary["pairing_error"] < 1e-6
        True
    """
    return _study("bloch", **locals())


def wells(
    assembly: Assembly,
    *,
    start: Start = None,
    starts: int | None = None,
    seed: int | None = None,
    spread: float | None = None,
    barriers: Sequence[tuple[int, int]] | None = None,
    rigid: bool | None = None,
    resolution: int | None = None,
    max_curvature: float | None = None,
    name: str | None = None, draw: Sequence[str] = ("vtk",), check: Sequence[str] = (),
    threads: int | None = None, progress: Progress = None, must_converge: bool = True,
) -> Result:
    """Finds stable states and the barriers between them.

    Args:
        assembly: The sheet and its energy.
        start: The state around which random starts are crumpled, as in `relax`.
        starts: Number of random starts; left out: 64.
        seed: Seed of their random numbers; left out: 0.
        spread: Largest distance of their fold angles from those of the start, radians; of a truss without creases
            that of a coordinate, of which pi is two mean edges. Left out: pi.
        barriers: Pairs of wells, numbered by rising energy from 0, between which the barrier is wanted.
        rigid: Whether wells and passes are also sought in fold angles alone.
        resolution: With `rigid`, states over a whole turn of fold angles; left out: 64.
        max_curvature: With `rigid`, curvature up to which the states of a screw are sought, 1/length.
        name, draw, check, threads, progress, must_converge: As for every study, see `compute`.

    Example:
        >>> import foldwell as fw
        >>> held = fw.Assembly.patch(fw.generate("miura"), (2, 2), bars=1e3, creases=1.0)
        >>> len(fw.wells(held, starts=4, spread=0.3).summary["wells"])
        1
    """
    barriers = None if barriers is None else integers(barriers, "barriers", "pairs of wells such as [(0, 1)]").tolist()
    return _study("wells", **locals())


def path(
    assembly: Assembly,
    *,
    drive: str | None = None,
    start: Start = None,
    tolerance: float | None = None,
    max_step: float | None = None,
    switch: bool | None = None,
    snap: bool | None = None,
    stop: Mapping[str, Any] | None = None,
    at: ArrayLike | None = None,
    probe: Sequence[Mapping[str, Any]] | None = None,
    response: str | None = None,
    name: str | None = None, draw: Sequence[str] = ("vtk",), check: Sequence[str] = (),
    threads: int | None = None, progress: Progress = None, must_converge: bool = True,
) -> Result:
    """Follows equilibria along a driven quantity.

    Args:
        assembly: The sheet with its energy and `drives`.
        drive: Name of the drive; may be left out where there is one.
        start: Where it starts: the result of a study; left out: as drawn.
        tolerance: Bound on both scaled residuals.
        max_step: Longest step in arc length.
        switch: Whether branches that leave at branch points are followed too.
        snap: Whether the sheet goes to the minimum beyond where the driven value cannot grow, instead of along the path,
            on which it turns back; left out: no.
        stop: Conditions of which the first ends a branch: those of `trace`, and `{"drive": v}`, `{"reaction": r}`,
            `{"displacement": {"probe": name, "value": d}}`, `{"states": n}`, `{"limit_points": n}`.
        at: Values of the drive of which the states are rows of their own, wherever the path passes them.
        probe: Columns `probe_NAME` with the mean displacement of vertices of a patch along an axis since they were drawn:
            `[{"name": "lid", "vertices": "top", "axis": "z"}]`.
        response: Whether the table has Poisson's ratios of every state of a periodic sheet, as in `trace`.
        name, draw, check, threads, progress, must_converge: As for every study, see `compute`.

    Example:
        >>> import foldwell as fw
        >>> drum = fw.generate("kresling", closed=True)
        >>> bottom, top = ({"where": {"z": end}} for end in ("min", "max"))
        >>> parts = [{"name": "floor", "vertices": bottom, "free": []}, {"name": "lid", "vertices": top, "free": ["z", "rz"]}]
        >>> drives = [{"name": "press", "part": "lid", "axis": "z", "to": -0.1}]
        >>> pressed = fw.path(fw.Assembly.patch(drum, bars=1.0, parts=parts, drives=drives))
        >>> pressed.summary["branches"][0]["end"], float(pressed.table["drive"][-1])
        ('arrived', -0.1)
    """
    return _study("path", **locals())


def _study(
    kind: str,
    assembly: Assembly,
    name: str | None, draw: Sequence[str], check: Sequence[str],
    threads: int | None, progress: Progress, must_converge: bool,
    start: Start = None,
    **keys: Any,
) -> Result:
    """Computes a study with the arguments of its function."""
    return compute(
        assembly, kind, keys, start=start,
        name=name, draw=draw, check=check, threads=threads, progress=progress, must_converge=must_converge,
    )


def fold(
    assembly: Assembly,
    *,
    start: Start = None,
    tolerance: float | None = None,
    max_step: float | None = None,
    switch: bool | None = None,
    snap: bool | None = None,
    stop: Mapping[str, Any] | None = None,
    at: ArrayLike | None = None,
    probe: Sequence[Mapping[str, Any]] | None = None,
    response: str | None = None,
    name: str | None = None, draw: Sequence[str] = ("vtk",), check: Sequence[str] = (),
    threads: int | None = None, progress: Progress = None, must_converge: bool = True,
) -> Result:
    """Folds the sheet from 0 to 100 %: a path along the rest angles, from those drawn to those of the assembly.

    Args:
        assembly: The sheet with its energy, with rest angles such as `rest="assigned"`.
        start, tolerance, max_step, switch, stop, probe, response: As in `path`.
        snap: As in `path`; left out: yes, without `switch`.
        at: Parts of the way, from 0 to 1, of which the states are rows of their own.
        name, draw, check, threads, progress, must_converge: As for every study, see `compute`.

    Example:
        >>> import foldwell as fw
        >>> base = fw.Sheet.read("meshes/waterbomb-base.fold")
        >>> folded = fw.fold(fw.Assembly.patch(base, bars=1e3, creases=1.0, facets=10.0, rest="assigned"))
        >>> float(folded.table["drive"][-1])
        1.0
    """
    return _study("fold", **locals())


def compute(
    assembly: Assembly,
    kind: str,
    keys: Mapping[str, Any],
    *,
    start: Start = None,
    name: str | None = None,
    draw: Sequence[str] = ("vtk",),
    check: Sequence[str] = (),
    threads: int | None = None,
    progress: Progress = None,
    must_converge: bool = True,
) -> Result:
    """Computes a study of any kind, given by the keys of its table in a scene.

    Args:
        assembly: The sheet with its boundary conditions and terms.
        kind: Kind of the study.
        keys: Its keys; those with the value None are left out.
        start: The state where it starts, for kinds that have one.
        name: Name of the study; left out: its kind.
        draw: What is kept to be drawn, a list: "vtk" for states and maps, "svg" for a drawing, "html" for a page.
        check: What is checked at every state: `["self-intersection"]`.
        threads: Number of threads; left out: as many as there are processors. Numbers do not depend on it.
        progress: True for a bar by tqdm, or a function `progress(study, step, of, residual)` that is called after every step; if it
            returns False, the study stops.
        must_converge: Whether a study that did not reach its answer raises `DidNotConverge`; otherwise look at `result.converged`.

    Returns:
        The result.

    Raises:
        SceneError: the study does not fit the sheet, or a key is wrong.
        DidNotConverge: it did not reach its answer; the exception has what it reached.
        KeyboardInterrupt: at Ctrl-C, soon after the key.

    Example:
        >>> import foldwell as fw
        >>> held = fw.Assembly.patch(fw.generate("miura"), bars=1e3, creases=1.0)
        >>> fw.compute(held, "relax", {"tolerance": 1e-8}).converged
        True
    """
    if not isinstance(assembly, Assembly):
        hint = ", made of the sheet: Assembly.patch(sheet, bars=..., creases=...)" if isinstance(assembly, Sheet) else ""
        raise TypeError(f"assembly is a {type(assembly).__name__}, expected a foldwell.Assembly{hint}")
    for words, given in (("draw", draw), ("check", check)):
        if isinstance(given, str):
            raise TypeError(f"{words} is {given!r}, expected a list such as [{given!r}]")
    draw, check = entries(draw, "draw"), entries(check, "check")
    study = {"name": name or kind, "kind": kind, "draw": draw, "check": check, **keys}
    earlier: list[tuple[str, _foldwell.Answer]] = []
    if isinstance(start, Result):
        study["start"] = f"{start.name}-start" if start.name == study["name"] else start.name
        earlier.append((study["start"], start._inner))
    elif start is not None:
        study["start"] = start
    # of an earlier study its state is all that is asked for
    studies = {"study": [{"name": name, "kind": "relax"} for name, _ in earlier] + [study]}
    with listener(progress) as callback:
        _, answers, _ = assembly._inner.compute(studies, earlier, whole(threads, "threads", 1), callback)
    result = Result(answers[0], study, assembly._inner.units)
    if must_converge and not result.converged:
        raise DidNotConverge(f"{result.name}: {result.summary.get('reason', 'no answer')}", result)
    return result
