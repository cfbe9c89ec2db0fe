"""Energy wells of folding sheets: bar-and-hinge origami relaxed at every stiffness, from soft to exactly rigid.

The following program relaxes nine cells of Miura-ori with rigid bars whose creases are flat at rest, and draws them:

    import foldwell as fw

    sheet = fw.generate("miura")
    assembly = fw.Assembly.patch(sheet, (3, 3), bars=fw.RIGID, creases=1.0, rest="flat")
    relaxed = fw.relax(assembly)
    print(relaxed.summary["energy"], relaxed.state.fold_angles)
    relaxed.plot()

Lengths are in the unit of the sheet, angles in radians, valley folds positive. A crease of stiffness `k` and length `l` has the
energy `k l (angle - rest)^2 / 2`, a bar of stiffness `EA` and rest length `L` the energy `EA L strain^2 / 2`.
"""

import atexit

from . import _foldwell, errors
from ._foldwell import __version__
from .assembly import RIGID, Assembly
from .errors import DidNotConverge, FoldwellError, OutputError, SceneError, SheetError
from .results import Result, Run
from .runs import convert, run, schema
from .sheet import Sheet, generate, pattern_help, patterns
from .state import State
from .sweeps import open_sweep, sweep
from .studies import bloch, branches, compute, fold, landscape, modes, path, relax, response, surface, trace, wells

__all__ = [
    "RIGID",
    "Assembly",
    "DidNotConverge",
    "FoldwellError",
    "OutputError",
    "Result",
    "Run",
    "SceneError",
    "Sheet",
    "SheetError",
    "State",
    "__version__",
    "bloch",
    "branches",
    "compute",
    "convert",
    "errors",
    "fold",
    "generate",
    "landscape",
    "modes",
    "open_sweep",
    "path",
    "pattern_help",
    "patterns",
    "relax",
    "response",
    "run",
    "schema",
    "surface",
    "sweep",
    "trace",
    "wells",
]


def __dir__() -> list[str]:
    return __all__


# work of threads that are still going on ends before the interpreter does
atexit.register(_foldwell.stop_all)
