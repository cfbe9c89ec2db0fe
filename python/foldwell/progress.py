"""Progress of long work."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

__all__ = ["Callback", "Progress"]

Callback = Callable[[str, int, "int | None", "float | None"], "bool | None"]
Progress = Callback | bool | None


@contextmanager
def listener(progress: Progress) -> Iterator[Callback | None]:
    """Yields the function that hears of every step: the given one, one that moves a bar of tqdm, or none."""
    if progress is None or progress is False:
        yield None
    elif progress is True:
        try:
            from tqdm.auto import tqdm
        except ModuleNotFoundError as error:
            raise ModuleNotFoundError("progress=True needs tqdm: pip install tqdm", name="tqdm") from error

        with tqdm(unit=" steps") as bar:
            yield lambda study, step, of, residual: _move(bar, study, step, of, residual)
    elif callable(progress):
        yield progress
    else:
        raise TypeError(f"progress is {progress!r}, expected True, False or a function progress(study, step, of, residual)")


def _move(bar: Any, study: str, step: int, of: int | None, residual: float | None) -> None:
    if bar.desc != study or bar.total != of:
        bar.reset(of)
        bar.set_description_str(study, refresh=False)
    if residual is not None:
        bar.set_postfix_str(f"residual {residual:.1e}", refresh=False)
    bar.update(step - bar.n)
