"""Terms whose energy is a function in Python."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .arrays import numbers

__all__ = ["Energy"]

Floats = NDArray[np.float64]
#: Energy of an element, with gradient and Hessian, of the positions of its vertices, shape (n, 3).
Energy = Callable[[Floats], tuple[float, ArrayLike, ArrayLike]]


class Called:
    """A function whose results are checked before the program takes them."""

    def __init__(self, name: str, energy: Energy) -> None:
        self._name = name
        self._energy = energy

    def __call__(self, points: list[list[float]]) -> tuple[float, Floats, Floats]:
        found = self._energy(np.array(points))
        try:
            value, gradient, hessian = found
        except (TypeError, ValueError) as error:
            kind = type(found).__name__
            raise TypeError(f"the function of {self._name} returned a {kind}, expected energy, gradient and Hessian") from error
        size = 3 * len(points)
        return float(value), self._vector(gradient, "gradient", size), self._vector(hessian, "Hessian", size * size)

    def _vector(self, given: Any, what: str, size: int) -> Floats:
        found = numbers(given, f"the {what} of {self._name}")
        if found.size != size:
            raise ValueError(f"the {what} of {self._name} has shape {found.shape}, expected {size} numbers")
        return found.ravel()
