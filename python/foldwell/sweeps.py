"""Sweeps: a scene computed for many values of its keys, on the threads of this process or on the workers of an executor."""

from __future__ import annotations

import csv
import io
import json
import os
from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _foldwell
from .arrays import whole
from .errors import FoldwellError
from .names import unit
from .progress import Callback, Progress, listener

if TYPE_CHECKING:
    from xarray import Dataset

__all__ = ["open_sweep", "sweep"]

#: Pieces of work for an executor: enough that its workers end at about the same time, and that little is lost with one of them.
PIECES = 128

#: How points are computed: the folder of the sweep or None, the number of threads, and whether points that are there already are kept.
How = tuple[Path | None, int, bool]


def sweep(
    scene: str | os.PathLike[str] | Mapping[str, Any],
    axes: Mapping[str, Sequence[Any] | NDArray[Any] | Mapping[str, Any]] | None = None,
    *,
    zip: bool = False,
    set: Mapping[str, Any] | None = None,
    base: str | os.PathLike[str] = "",
    out: str | os.PathLike[str] | None = None,
    resume: bool = True,
    executor: Executor | None = None,
    threads: int | None = None,
    progress: Progress = None,
) -> Dataset:
    """Computes a scene for all values of some of its keys. Needs xarray.

    Args:
        scene: Path of a scene file, or its content as a dict. Its table `[sweep]`, if it has one, has axes too.
        axes: Values of keys by their paths: `{"energy.bars.stiffness": np.logspace(2, 10, 17), "sheet.generate.seed": range(200)}`, or
            forms of `[sweep]` such as `{"log": [1e2, 1e10, 17]}`. The points are the product, the first axis the slowest.
        zip: Whether the axes, which then have equal lengths, run together.
        set: Other keys that are set first, by their path.
        base: Folder to which paths in a dict are relative; left out: the current one.
        out: Folder for the files of `foldwell run`, a folder for each point beside the table; left out: they are not kept.
        resume: With `out`, whether points that are there already are kept.
        executor: Where the points are computed: any executor of `concurrent.futures`, or of Dask: `Client(...).get_executor()`. Its
            workers must see the folder `out`, if there is one. A piece of work that is lost with its worker
            is handed out once more; if the sweep fails all the same, call the function again with the same `out`: only missing points
            are computed. Left out: the threads of this process.
        threads: Number of threads of this process; with an executor, of each point there, 1 if left out.
        progress: As for every study; the steps are points.

    Returns:
        A data set. Its dimensions are the keys of the axes, or `point` if they run together. Its variables are `status` ("converged",
        "not-converged", "failed"), `reason` and every number of the summaries of the studies, NaN where there is none. Points in keys
        and in columns `NAME.KEY` become `_`, unless that makes two names one: `data.relaxed_energy_total`.

    Raises:
        SceneError: the scene, an axis or the scene of a point is wrong; nothing was computed.
        OutputError: a file cannot be written.

    Example:
        >>> import foldwell as fw
        >>> data = fw.sweep("meshes/star.toml", {"energy.creases.stiffness": [1.0, 2.0]}, set={"sheet.cells": [2, 2]})
        >>> data.status.values.tolist()
        ['converged', 'converged']
    """
    threads = whole(threads, "threads", 1)
    given: dict[str, Any] | Path = dict(scene) if isinstance(scene, Mapping) else Path(scene)
    wanted = {f"sweep.{json.dumps(key)}": values for key, values in (axes or {}).items()}
    points = _foldwell.Sweep(given, Path(base).absolute(), {**(set or {}), **wanted, **({"sweep.zip": True} if zip else {})})
    folder = None if out is None else Path(out).absolute()
    with listener(progress) as callback:
        if executor is not None:
            points.check(folder or Path())
            found = _submit(points, executor, (folder, threads or 1, resume), callback)
            rows = [found.get(index) for index in range(len(points))]
        elif folder is None:
            points.check_scenes()
            rows = points.rows(range(len(points)), threads, callback)
        else:
            points.run(folder, threads, resume, callback)
    if folder is None:
        table, summary = points.table(rows)
        return _dataset(io.StringIO(table, newline=""), points.shape, json.loads(summary))
    if executor is not None:
        points.assemble(folder)
    return _of_folder(folder, points.shape)


def open_sweep(folder: str | os.PathLike[str]) -> Dataset:
    """Reads the table of a sweep that `foldwell run` or `sweep` wrote, with dimension `point`. Needs xarray.

    Raises:
        FileNotFoundError: the folder has no `sweep.csv`.

    Example:
        >>> import foldwell as fw
        >>> axes = {"energy.creases.stiffness": [1.0, 2.0]}
        >>> data = fw.sweep("meshes/star.toml", axes, set={"sheet.cells": [2, 2]}, out="creases")
        >>> fw.open_sweep("creases").sizes["point"]
        2
    """
    if not (Path(folder) / "sweep.csv").is_file():
        raise FileNotFoundError(f"{folder}: not the folder of a sweep, it has no sweep.csv")
    return _of_folder(Path(folder), [])


def _submit(
    points: _foldwell.Sweep, executor: Executor, how: How, callback: Callback | None
) -> dict[int, str | None]:
    """Computes the points on the workers of an executor, in pieces, and returns the row of each. When it ends early, pieces that have not begun are
    cancelled, and those that have begun are waited for, because they write files.

    A piece that the executor lost is handed out once more, since Dask may report an error for a piece whose worker ended while its
    result was on the way, though another worker computes it.
    """

    def submit(piece: range) -> Future[dict[int, str | None]]:
        return executor.submit(_compute, points, piece, how)

    count = len(points)
    pieces = [range(first, count, PIECES) for first in range(min(PIECES, count))]
    work = {submit(piece): piece for piece in pieces}
    handed_out_again: set[range] = set()
    found: dict[int, str | None] = {}
    try:
        while work:
            for future in wait(work, return_when=FIRST_COMPLETED).done:
                piece = work.pop(future)
                if _is_lost(future) and piece not in handed_out_again:
                    handed_out_again.add(piece)
                    work[submit(piece)] = piece
                    continue
                found |= future.result()
                if callback is not None and callback("points", len(found), count, None) is False:
                    return found
    finally:
        wait([future for future in work if not future.cancel()])
    return found


def _is_lost(future: Future[Any]) -> bool:
    """Returns whether an ended piece failed by its executor and not by an error of foldwell, which would only be repeated."""
    return future.cancelled() or not isinstance(future.exception(), FoldwellError | None)


def _compute(points: _foldwell.Sweep, piece: Sequence[int], how: How) -> dict[int, str | None]:
    """Computes some points in this process, which may be a worker; returns the row of each, None where it is in its folder."""
    folder, threads, resume = how
    if folder is None:
        return dict(zip(piece, points.rows(piece, threads, None), strict=True))
    return {index: None for index in piece if points.run_point(index, folder, threads, resume) is not None}


def _of_folder(folder: Path, shape: list[int]) -> Dataset:
    """Returns the table in the folder of a sweep as a data set."""
    summary = json.loads((folder / "sweep.json").read_text())
    with open(folder / "sweep.csv", newline="") as file:
        return _dataset(file, shape, summary)


def _dataset(table: Iterable[str], shape: list[int], summary: dict[str, Any]) -> Dataset:
    """Returns the table of a sweep as a data set."""
    import xarray

    header, *rows = csv.reader(table)
    names = {column: column.replace(".", "_") for column in header}
    names = names if len(set(names.values())) == len(header) else dict(zip(header, header, strict=True))
    columns = {names[column]: _column(column, [row[k] for row in rows]) for k, column in enumerate(header) if column != "point"}
    keys = [names[key] for key in summary["keys"]]
    about = {key: summary[key] for key in ("title", "scene", "version", "digest")}
    grid = tuple(shape) if shape and int(np.prod(shape)) == len(rows) else ()
    if grid:
        along = {
            key: _whole(columns.pop(key)).reshape(grid)[tuple(slice(None) if a == k else 0 for a in range(len(grid)))]
            for k, key in enumerate(keys)
        }
        data = {name: (tuple(keys), values.reshape(grid)) for name, values in columns.items()}
        found = xarray.Dataset(data, coords=along, attrs=about)
    else:
        coordinates = {key: ("point", _whole(columns.pop(key))) for key in keys}
        found = xarray.Dataset({name: ("point", values) for name, values in columns.items()}, coordinates, about)
    for column, name in names.items():
        if name in found:
            found[name].attrs |= {"key": column, "long_name": column.replace("_", " ").replace(".", " ")}
            if named := unit(column, summary.get("units", {})):
                found[name].attrs["units"] = named
    return found


def _column(name: str, texts: list[str]) -> NDArray[Any]:
    """Returns the fields of a column as numbers, truth values or texts, whatever all of them are."""
    if name in ("status", "reason"):
        return np.array(texts, dtype=object)
    filled = {text for text in texts if text}
    if filled and filled <= {"true", "false"} and all(texts):
        return np.array([text == "true" for text in texts])
    try:
        return np.array([float(text or "nan") for text in texts])
    except ValueError:
        return np.array(texts, dtype=object)


def _whole(values: NDArray[Any]) -> NDArray[Any]:
    """Returns the values of an axis as integers if all of them are whole, as seeds and numbers of cells are."""
    whole = values.dtype.kind == "f" and bool((np.abs(values) < 2**53).all() and (values == np.rint(values)).all())
    return values.astype(np.int64) if whole else values
