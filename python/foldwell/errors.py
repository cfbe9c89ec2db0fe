"""The exceptions of foldwell."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .results import Result
    from .state import State

__all__ = ["DidNotConverge", "FoldwellError", "OutputError", "SceneError", "SheetError"]


class FoldwellError(Exception):
    """Base of the exceptions of foldwell.

    Attributes:
        message: What is wrong.
        help: What would be right, if the program can say.
        file: Name of the file or scene with the mistake, if it is known.
        line: Its line there, from 1, if it is known.

    Example:
        >>> import foldwell as fw
        >>> try:
        ...     fw.Assembly.patch(fw.generate("miura"), bars=-1.0)
        ... except fw.FoldwellError as error:
        ...     print(type(error).__name__)
        SceneError
    """

    def __init__(
        self, message: str, help: str | None = None, file: str | None = None, line: int | None = None
    ) -> None:
        super().__init__(message)
        self.message = message
        self.help = help
        self.file = file
        self.line = line

    def __reduce__(self) -> tuple[type[FoldwellError], tuple[Any, ...]]:
        return (type(self), (self.message, self.help, self.file, self.line))

    def __str__(self) -> str:
        return f"{self.message}\n  help: {self.help}" if self.help else self.message


class SceneError(FoldwellError, ValueError):
    """Something that was given is wrong: a key of a scene, an argument, or a combination of them. Nothing was computed.

    Example:
        >>> import foldwell as fw
        >>> try:
        ...     fw.Assembly.patch(fw.generate("miura"), bars=-1.0)
        ... except fw.SceneError as error:
        ...     print(error.help)
        expected a positive number or `foldwell.RIGID` (exactly rigid), 1e-300 at least
    """


class SheetError(SceneError):
    """A mesh is wrong, or cannot be read.

    Example:
        >>> import foldwell as fw
        >>> try:
        ...     fw.Sheet.read("nothing.fold")
        ... except fw.SheetError as error:
        ...     print("nothing.fold" in str(error))
        True
    """


class OutputError(FoldwellError):
    """A file cannot be read or written: no space, no permission, another process at work in the folder.

    Example:
        >>> import foldwell as fw
        >>> relaxed = fw.relax(fw.Assembly.patch(fw.generate("miura"), bars=1e3, creases=1.0))
        >>> try:
        ...     relaxed.state.save("meshes/star.toml/state.vtu")  # in a file, which is no folder
        ... except fw.OutputError as error:
        ...     print("state.vtu" in str(error))
        True
    """


class DidNotConverge(FoldwellError):
    """A study did not reach its answer. What it reached is in `result`.

    Attributes:
        result: The study as far as it came; `result.summary["reason"]` says why it ended.

    Example:
        >>> import foldwell as fw
        >>> held = fw.Assembly.patch(fw.generate("miura"), (2, 2), bars=1e3, creases=1.0, rest="flat")
        >>> try:
        ...     fw.relax(held, tolerance=1e-40)
        ... except fw.DidNotConverge as error:
        ...     print(error.result.converged, error.state.positions.shape, len(error.history) > 0)
        False (16, 3) True
    """

    def __init__(self, message: str, result: Result) -> None:
        super().__init__(message)
        self.result = result

    def __reduce__(self) -> tuple[type[FoldwellError], tuple[Any, ...]]:
        return (type(self), (self.message, self.result))

    @property
    def state(self) -> State | None:
        """The last state, if the study kept it."""
        states = self.result.states
        return states[-1] if states else None

    @property
    def history(self) -> list[dict[str, Any]]:
        """The steps of a relaxation, each a dict as in `summary.json`; empty for other studies."""
        found: list[dict[str, Any]] = self.result.summary.get("history", [])
        return found
