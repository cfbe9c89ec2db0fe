"""Results of studies and runs."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterator, Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _foldwell
from .names import PLACES, described, unit
from .state import State

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["Result", "Run"]

Column = NDArray[Any]
#: Name of a column with the fold angle of an edge.
FOLD = re.compile(r"fold(_-?\d+){4}")


class Table(dict[str, Column]):
    """The columns of a table by their names."""

    def __missing__(self, column: str) -> Column:
        raise KeyError(f"{column}: there is no such column; there are {', '.join(self)}")


class Result:
    """The answer of a study.

    Attributes:
        summary: What `summary.json` says of the study, a dict; the keys of each kind are described in the book.

    Example:
        >>> import foldwell as fw
        >>> held = fw.Assembly.patch(fw.generate("miura"), (2, 2), bars=1e3, creases=1.0, rest="flat")
        >>> relaxed = fw.relax(held, name="flattened")
        >>> relaxed.name, relaxed.kind, relaxed.converged, relaxed.summary["negative_eigenvalues"]
        ('flattened', 'relax', True, 0)
        >>> len(relaxed.table["energy_total"]) == len(relaxed.states)
        True
    """

    def __init__(self, inner: _foldwell.Answer, study: Mapping[str, Any], units: Mapping[str, str] | None = None) -> None:
        self._inner = inner
        self._study = dict(study)
        self._units = dict(units or {})
        self.summary: dict[str, Any] = json.loads(inner.summary)

    def __reduce__(self) -> tuple[type[Result], tuple[Any, ...]]:
        return (type(self), (self._inner, self._study, self._units))

    @property
    def name(self) -> str:
        """Name of the study."""
        return str(self.summary["name"])

    @property
    def kind(self) -> str:
        """Kind of the study."""
        return str(self.summary["kind"])

    @property
    def converged(self) -> bool:
        """Whether the study reached its answer."""
        return bool(self.summary["converged"])

    @cached_property
    def tables(self) -> dict[str, dict[str, Column]]:
        """The tables of the study, by the names of their files: for each column its values, one for each row.

        Numbers that were not computed are NaN.
        """
        return {name: Table({column: np.asarray(values) for column, values in table.items()}) for name, table in self._inner.tables()}

    @property
    def table(self) -> dict[str, Column]:
        """The table `NAME.csv` of the study; the first of its tables if it has none of that name, empty if it has none at all."""
        named = self.tables.get(f"{self.name}.csv")
        return named if named is not None else next(iter(self.tables.values()), Table())

    @cached_property
    def states(self) -> list[State]:
        """The states that the study kept, in the order of its table; empty if `draw` lacks "vtk"."""
        return [State(state) for state in self._inner.states]

    @cached_property
    def state(self) -> State:
        """The final state.

        Raises:
            ValueError: the study has none.
        """
        found = self._inner.state()
        if found is None:
            raise ValueError(f"a study of kind {self.kind} that ended like this has no final state; see `states`")
        return State(found)

    @property
    def coordinates(self) -> NDArray[np.float64]:
        """All coordinates of the final state, as `Assembly.unknowns` takes them.

        Raises:
            ValueError: the study has no final state.
        """
        found = self._inner.coordinates
        if found is None:
            raise ValueError(f"a study of kind {self.kind} that ended like this has no final state")
        return found

    def to_pandas(self) -> Any:
        """Returns `table` as a `pandas.DataFrame`, with the units of its columns, where they have named ones, in `attrs["units"]`. Needs pandas.

        Example:
            >>> import foldwell as fw
            >>> "energy_bars" in fw.relax(fw.Assembly.patch(fw.generate("miura"), bars=1e3, creases=1.0)).to_pandas()
            True
        """
        import pandas

        frame = pandas.DataFrame(self.table)
        frame.attrs["units"] = {name: named for name in self.table if (named := self._unit(name))}
        return frame

    def to_xarray(self) -> Any:
        """Returns `table` as an `xarray.Dataset` with dimension `row`, or `mode` and `amplitude` of a landscape. Needs xarray.

        Numbers of branches, steps and so on are coordinates of the rows. Fold angles of edges are one variable, `fold_angle` (`row`,
        `edge`); the coordinate `edge` is the name of an edge of the cell as a text, "i,j,n1,n2". Variables have the attribute
        `long_name`, and `units` where the assembly or scene names them; angles are in radians.

        Example:
            >>> import foldwell as fw
            >>> "fold_angle" in fw.relax(fw.Assembly.patch(fw.generate("miura"), bars=1e3, creases=1.0)).to_xarray()
            True
        """
        import xarray

        folds = {name: ",".join(name.split("_")[1:]) for name in self.table if FOLD.fullmatch(name)}
        data: dict[str, Any] = {name: ("row", values, described(name)) for name, values in self.table.items() if name not in folds}
        if folds:
            angles = np.stack([self.table[name] for name in folds], axis=1)
            data["fold_angle"] = (("row", "edge"), angles, described("fold_angle"))
        if self.kind != "trace" and "arc_length" in data:
            # that of a path is a number: of its unknowns in mean edges and the part of its way
            data["arc_length"] = (*data["arc_length"][:2], {"long_name": "arc length of the path"})
        for name, (_, _, attributes) in data.items():
            if named := self._unit(name):
                attributes["units"] = named
        places = {name: data.pop(name) for name in PLACES if name in data}
        edges = {"edge": list(folds.values())} if folds else {}
        found = xarray.Dataset(data, {**places, **edges}, {"name": self.name, "kind": self.kind})
        return found.set_index(row=["mode", "amplitude"]).unstack("row") if self.kind == "landscape" else found

    def _unit(self, column: str) -> str | None:
        """The unit of a column; None if it has none, or none that is named."""
        return unit(column, self._units, self.summary.get("driven"))

    def to_pyvista(self) -> Any:
        """Returns the final state, or else the last one that was kept, as a `pyvista.UnstructuredGrid`. Needs PyVista.

        Example:
            >>> import foldwell as fw
            >>> fw.relax(fw.Assembly.patch(fw.generate("miura"), bars=1e3, creases=1.0)).to_pyvista().n_points
            4
        """
        return self._shown().to_pyvista()

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draws what the study is about: the curves of a path, trace or landscape, otherwise its state. Needs Matplotlib.

        Paths are dashed where states are not stable, with marks at events. Both directions of a trace begin at 0. Landscapes have
        logarithmic axes.

        Example:
            >>> import foldwell as fw
            >>> axes = fw.relax(fw.Assembly.patch(fw.generate("miura"), bars=1e3, creases=1.0)).plot()
        """
        from .plots import draw_result

        return draw_result(self, ax)

    def _shown(self) -> State:
        if self._inner.coordinates is None and self.states:
            return self.states[-1]
        return self.state

    def save(self, folder: str | os.PathLike[str]) -> list[Path]:
        """Writes the files of the study, as `foldwell run` does, into a folder. Returns their paths.

        Raises:
            OutputError: a file cannot be written.

        Example:
            >>> import foldwell as fw
            >>> relaxed = fw.relax(fw.Assembly.patch(fw.generate("miura"), bars=1e3, creases=1.0))
            >>> "relax.csv" in [path.name for path in relaxed.save("relaxed")]
            True
        """
        return [Path(folder) / name for name in self._inner.save(Path(folder))]

    def _repr_svg_(self) -> str | None:
        """The drawing of the study, which notebooks show; without "svg" in `draw` that of its state, if it has one."""
        drawings = self._inner.drawings
        if drawings:
            return str(drawings[0][1])
        has_state = self._inner.coordinates is not None or self.states
        return self._shown()._repr_svg_() if has_state else None

    def __repr__(self) -> str:
        end = "converged" if self.converged else f"did not converge: {self.summary.get('reason')}"
        return f"<foldwell.Result {self.name!r}: {self.kind}, {end}>"


class Run(Mapping[str, Result]):
    """The results of a scene, by the names of its studies.

    Attributes:
        summary: The content of `summary.json`, a dict.
        interrupted: Whether the callback stopped the run; studies after that are missing.

    Example:
        >>> import foldwell as fw
        >>> found = fw.run("meshes/star.toml", set={"sheet.cells": [2, 2]})
        >>> list(found), found.converged, found["relaxed"].kind
        (['relaxed'], True, 'relax')
    """

    def __init__(self, summary: dict[str, Any], results: list[Result], interrupted: bool) -> None:
        self.summary = summary
        self.interrupted = interrupted
        self._results = {result.name: result for result in results}

    @property
    def converged(self) -> bool:
        """Whether all studies reached their answers."""
        return not self.interrupted and all(study["converged"] for study in self.summary["studies"])

    def __getitem__(self, name: str) -> Result:
        if name in self._results:
            return self._results[name]
        known = [study["name"] for study in self.summary["studies"]]
        if name in known:
            raise KeyError(f"{name}: it is kept from an earlier run, in the folder of this one; resume=False computes it again")
        raise KeyError(f"{name}: there is no such study; there are {', '.join(known)}")

    def __iter__(self) -> Iterator[str]:
        return iter(self._results)

    def __len__(self) -> int:
        return len(self._results)

    def __repr__(self) -> str:
        studies = ", ".join(f"{study['name']} ({study['kind']})" for study in self.summary["studies"])
        return f"<foldwell.Run {self.summary['title']!r}: {studies}>"
