"""Whole scenes, and files."""

from __future__ import annotations

import json
import os
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from . import _foldwell
from .arrays import whole
from .progress import Progress, listener
from .results import Result, Run

__all__ = ["convert", "run", "schema"]


def run(
    scene: str | os.PathLike[str] | Mapping[str, Any],
    *,
    set: Mapping[str, Any] | None = None,
    base: str | os.PathLike[str] = "",
    out: str | os.PathLike[str] | None = None,
    resume: bool = False,
    threads: int | None = None,
    progress: Progress = None,
) -> Run:
    """Computes the studies of a scene.

    Args:
        scene: Path of a scene file, or its content as a dict.
        set: Keys that are set first, by their path: `{"energy.bars.stiffness": 1e4}`.
        base: Folder to which paths in a dict are relative; left out: the current one.
        out: Folder into which the files of `foldwell run` are written too. Left out: nothing is written.
        resume: With `out`, whether studies that an interrupted run finished are kept; their results are in the files only.
        threads, progress: As for every study, see `foldwell.compute`. If `progress` returns False, `interrupted` is true.

    Returns:
        The results by the names of the studies. A study that did not reach its answer raises nothing here: see `converged`.

    Raises:
        SceneError: the scene is wrong; nothing was computed.
        OutputError: a file cannot be written.

    Example:
        >>> import foldwell as fw
        >>> fw.run("meshes/star.toml", set={"sheet.cells": [2, 2]})["relaxed"].converged
        True
    """
    given: dict[str, Any] | Path = dict(scene) if isinstance(scene, Mapping) else Path(scene)
    folder = None if out is None else Path(out)
    with listener(progress) as callback:
        place, options = (Path(base), dict(set or {})), (folder, whole(threads, "threads", 1), resume)
        text, answers, interrupted = _foldwell.run_scene(given, place, options, callback)
    summary = json.loads(text)
    return Run(summary, [Result(answer, {}, summary.get("units")) for answer in answers], interrupted)


def convert(source: str | os.PathLike[str], target: str | os.PathLike[str], *, frame: int | None = None) -> None:
    """Converts a mesh between the formats that endings name, as `foldwell convert`. Warns of what the new file does not keep.

    Raises:
        SheetError: the mesh cannot be read or is wrong.
        SceneError: an ending is unknown.

    Example:
        >>> import foldwell as fw
        >>> fw.convert("meshes/crane.fold", "crane.obj")
        >>> fw.Sheet.read("crane.obj").vertices.shape == fw.Sheet.read("meshes/crane.fold").vertices.shape
        True
    """
    for note in _foldwell.convert(Path(source), Path(target), whole(frame, "frame", 0)):
        warnings.warn(note, stacklevel=2)


def schema(of: str = "scene") -> dict[str, Any]:
    """Returns the JSON schema of a scene ("scene"), of a summary ("summary") or of the summary of a sweep ("sweep").

    Example:
        >>> import foldwell as fw
        >>> "sheet" in fw.schema()["required"]
        True
    """
    found: dict[str, Any] = json.loads(_foldwell.schema(of))
    return found
