"""Sheets and assemblies of the tests."""

import os
import shutil
from pathlib import Path

import foldwell as fw
import matplotlib
import pytest

matplotlib.use("agg")
ROOT = Path(__file__).parents[2]


def without_times(summary):
    """Returns a study's part of the summary without what belongs to the files of a run."""
    return {key: value for key, value in summary.items() if key not in ("seconds", "files")}


@pytest.fixture(scope="session")
def program() -> str:
    """The command-line program, which these tests compare with: `$FOLDWELL`, that of a build, or one on the path."""
    built = ROOT / "target/release/foldwell"
    found = os.environ.get("FOLDWELL") or (str(built) if built.exists() else shutil.which("foldwell"))
    assert found, "build the program first: cargo build --release"
    return found


@pytest.fixture
def miura() -> fw.Sheet:
    return fw.generate("miura")


@pytest.fixture
def soft(miura: fw.Sheet) -> fw.Assembly:
    """Nine cells of Miura-ori in which everything is soft."""
    return fw.Assembly.patch(miura, (3, 3), bars=1e2, creases=1.0, facets=3.0, rest=0.5)
