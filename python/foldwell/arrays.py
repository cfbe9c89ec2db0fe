"""Checks of arrays that callers give."""

from __future__ import annotations

import operator
from collections.abc import Iterable
from itertools import islice
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__: list[str] = []

#: Most entries of a list: an iterator without end has more.
MOST_ENTRIES = 2_000_000

Entry = TypeVar("Entry")


def entries(values: Iterable[Entry], name: str) -> list[Entry]:
    """Returns the entries of a list or iterator as a list.

    Raises:
        ValueError: there are more than two million, or there is no end of them.
    """
    found = list(islice(values, MOST_ENTRIES + 1))
    if len(found) > MOST_ENTRIES:
        raise ValueError(f"{name} has more than {MOST_ENTRIES} entries")
    return found


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


def integers(values: ArrayLike, name: str, form: str) -> NDArray[np.int64]:
    """Returns `values` as a matrix of two columns of whole numbers; `form` says in messages what is right.

    Raises:
        ValueError: they are no such matrix.
    """
    expected = f"expected whole numbers of shape (m, 2), {form}"
    try:
        found = np.asarray(values)
    except ValueError as error:
        raise ValueError(f"{name} has rows of different lengths, {expected}") from error
    if found.size == 0:
        return np.zeros((0, 2), dtype=np.int64)
    if found.dtype.kind not in "iu" or found.ndim != 2 or found.shape[1] != 2:
        raise ValueError(f"{name} has shape {found.shape} and type {found.dtype}, {expected}")
    return found.astype(np.int64)


def polygons(lists: Iterable[Iterable[int]], name: str = "faces", form: str = "vertex numbers such as (0, 1, 2)") -> list[list[int]]:
    """Returns faces, or other lists of whole numbers, as lists; `form` says in messages what each is.

    Raises:
        TypeError: there are no lists.
        ValueError: one is no list of whole numbers.
    """
    if not isinstance(lists, Iterable):
        raise TypeError(f"{name} is {lists!r}, expected lists of {form}")
    found = []
    for number, each in enumerate(entries(lists, name)):
        try:
            found.append([operator.index(entry) for entry in entries(each, f"{name}[{number}]")])
        except TypeError as error:
            raise ValueError(f"{name}[{number}] is {each!r}, expected a list of {form}") from error
    return found


def whole(number: Any, name: str, least: int) -> int | None:
    """Returns a whole number; None if none is given.

    Raises:
        TypeError: it is no whole number.
        ValueError: it is below `least`.
    """
    if number is None:
        return None
    try:
        found = operator.index(number)
    except TypeError as error:
        raise TypeError(f"{name} is {number!r}, expected a whole number") from error
    if found < least:
        raise ValueError(f"{name} is {found}, expected {least} or more")
    return found


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
