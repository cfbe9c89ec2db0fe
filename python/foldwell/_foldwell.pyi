from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Sparse = tuple[Floats, Ints, Ints]
Callback = Callable[[str, int, int | None, float | None], bool | None] | None

__version__: str

class Answer:
    summary: str
    table_names: list[str]
    states: list[State]
    coordinates: Floats | None
    drawings: list[tuple[str, str]]
    def table(self, name: str) -> dict[str, NDArray[Any] | list[str]] | None: ...
    def state(self) -> State | None: ...
    def save(self, folder: Path) -> list[str]: ...

class Assembly:
    sheet: Sheet
    edges: Ints
    kinds: list[str]
    cells: list[int]
    scene: str
    def __new__(
        cls, scene: dict[str, Any] | Path, base: Path, settings: list[str], sheet: Sheet | None
    ) -> Assembly: ...
    def compute(
        self,
        studies: list[dict[str, Any]],
        earlier: Sequence[tuple[str, Answer]],
        threads: int | None,
        progress: Callback,
    ) -> tuple[str, list[Answer], bool]: ...
    def forms(self) -> Forms: ...

class Forms:
    start: Floats
    def unknowns_at(self, coordinates: Floats) -> Floats: ...
    def state_at(self, x: Floats) -> State: ...
    def energy(self, x: Floats) -> float: ...
    def gradient(self, x: Floats) -> Floats: ...
    def hessian(self, x: Floats) -> Sparse: ...
    def constraints(self, x: Floats) -> Floats: ...
    def constraint_jacobian(self, x: Floats) -> Sparse: ...
    def measures(self, x: Floats, angles: bool) -> Floats: ...
    def measures_jacobian(self, x: Floats, angles: bool) -> Sparse: ...

class Sheet:
    title: str
    vertices: Floats
    lattice: Floats | None
    edges: Ints
    kinds: list[str]
    letters: list[str]
    fold_angles: Floats
    polygons: list[list[tuple[int, int, int]]]
    @staticmethod
    def read(path: Path, frame: int | None) -> Sheet: ...
    @staticmethod
    def parse(text: str, name: str, frame: int | None) -> Sheet: ...
    @staticmethod
    def generate(pattern: dict[str, Any]) -> Sheet: ...
    def write(self, path: Path) -> list[str]: ...
    def to_fold(self) -> str: ...
    def info(self) -> str: ...

class State:
    positions: Floats
    displacements: Floats
    places: Ints
    faces: Ints
    self_intersecting: NDArray[np.uint8]
    edges: Ints
    kinds: list[str]
    letters: list[str]
    cell_edges: NDArray[np.int32]
    fold_angles: Floats
    rest_angles: Floats
    strains: Floats
    energies: Floats
    tensions: Floats
    torques: Floats
    def addresses(self) -> list[int]: ...
    def save(self, path: Path) -> None: ...

def closure(sheet: Sheet, rho: Floats) -> tuple[Floats, Floats]: ...
def run_scene(
    scene: dict[str, Any] | Path,
    place: tuple[Path, list[str]],
    options: tuple[Path | None, int | None, bool],
    progress: Callback,
) -> tuple[str, list[Answer], bool]: ...
def convert(source: Path, target: Path, frame: int | None) -> list[str]: ...
def patterns() -> list[str]: ...
def pattern_help(name: str) -> str: ...
def schema(of: str) -> str: ...
def stop_all() -> None: ...
