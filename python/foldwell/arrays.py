"""Checks of arrays that callers give."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__: list[str] = []


def vector(values: ArrayLike, name: str, length: int | tuple[int, ...]) -> NDArray[np.float64]:
    """Returns `values` as a contiguous vector of finite numbers with one of these lengths.

    Raises:
        TypeError: they are no real numbers.
        ValueError: there are too many or too few of them, or one is not finite.
    """
    found = numbers(values, name)
    lengths = (length,) if isinstance(length, int) else length
    if found.ndim != 1 or found.shape[0] not in lengths:
        expected = " or ".join(f"({n},)" for n in dict.fromkeys(lengths))
        raise ValueError(f"{name} has shape {found.shape}, expected {expected}")
    if not np.isfinite(found).all():
        raise ValueError(f"{name}[{int(np.flatnonzero(~np.isfinite(found))[0])}] is not finite")
    return found


def matrix(values: ArrayLike, name: str, columns: tuple[int, ...], rows: int | None = None) -> NDArray[np.float64]:
    """Returns `values` as a matrix of finite numbers with one of these numbers of columns.

    Raises:
        TypeError: they are no real numbers.
        ValueError: the shape is wrong, or a number is not finite.
    """
    found = numbers(values, name)
    if found.ndim != 2 or found.shape[1] not in columns or (rows is not None and found.shape[0] != rows):
        expected = " or ".join(f"({'n' if rows is None else rows}, {width})" for width in columns)
        raise ValueError(f"{name} has shape {found.shape}, expected {expected}")
    if not np.isfinite(found).all():
        row = int(np.flatnonzero(~np.isfinite(found).all(axis=1))[0])
        raise ValueError(f"{name}[{row}] is not finite")
    return found


def numbers(values: ArrayLike, name: str) -> NDArray[np.float64]:
    """Returns `values` as a contiguous array of doubles.

    Raises:
        TypeError: they are no real numbers.
    """
    given = np.asarray(values)
    if given.dtype.kind not in "fiub":
        raise TypeError(f"{name} has numbers of type {given.dtype}, expected real numbers")
    return np.ascontiguousarray(given, dtype=np.float64)


def of_edges(values: ArrayLike, name: str) -> NDArray[np.float64]:
    """Returns `values` of edges as a contiguous vector; how many there are, and which are not finite, is seen elsewhere.

    Raises:
        TypeError: they are no real numbers.
        ValueError: they are no vector.
    """
    found = numbers(values, name)
    if found.ndim != 1:
        raise ValueError(f"{name} has shape {found.shape}, expected an array of 1 dimension")
    return found


def forces(values: ArrayLike, name: str) -> NDArray[np.float64]:
    """Returns forces, shape (n, 3), as a contiguous vector.

    Raises:
        TypeError, ValueError: as `matrix`.
    """
    return matrix(values, name, (3,)).ravel()
