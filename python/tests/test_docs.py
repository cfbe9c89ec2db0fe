"""The programs of README, book and docstring run as they are shown."""

import doctest
import importlib.util
import inspect
import os
import re
import subprocess
import sys
from functools import cached_property
from pathlib import Path

import foldwell as fw
import matplotlib.pyplot as plt
import pytest
from conftest import ROOT

#: A block, with the package that it needs besides, if the line before it says so.
BLOCK = re.compile(r"(?:^<!-- needs (\w+) -->\n)?^```python\n(.*?)^```$", re.M | re.S)
PAGES = [page for page in [ROOT / "README.md", *sorted((ROOT / "docs/src").glob("*.md"))] if "```python" in page.read_text()]
#: The commands that a page shows before its Python: scenes that are run into folders.
SCENES = {"tutorial.md": ["star"], "outputs.md": ["star", "star-trace"]}
#: The scheduler as far as dask-jobqueue knows it: a job is a process. Like Slurm it keeps a copy of the script, which dask-jobqueue
#: deletes as soon as it is submitted; a job that has lost its script never starts, and the sweep would wait for it for ever.
SLURM = {
    "sbatch": 'script=$(cat "$1"); bash -c "$script" > {log}.$$ 2>&1 & echo "Submitted batch job $!"; echo $! >> {log}',
    "scancel": 'kill "$@" 2> /dev/null',
}


def source_of(page: Path) -> str:
    """Returns the Python blocks of a page, each at its line, without those whose packages are not installed."""
    text, lines = page.read_text(), []
    for block in BLOCK.finditer(text):
        package, code = block.groups()
        if package is None or importlib.util.find_spec(package):
            lines += [""] * (text.count("\n", 0, block.start(2)) - len(lines)) + code.splitlines()
    return "\n".join(lines) + "\n"


def run(name: str, source: str, folder: Path, monkeypatch) -> dict:
    """Executes a program in a folder, as the main program of an interpreter, and returns its names."""
    (folder / "meshes").symlink_to(ROOT / "meshes")
    monkeypatch.chdir(folder)
    names = {"__name__": "__main__"}
    exec(compile(source, name, "exec"), names)
    plt.close("all")
    return names


@pytest.fixture
def scheduler(program, tmp_path, monkeypatch):
    """The program, and commands of Slurm that run jobs on this machine; the numbers of the jobs come into a file."""
    folder, log = tmp_path / "commands", tmp_path / "jobs"
    folder.mkdir()
    log.touch()
    (folder / "foldwell").symlink_to(Path(program).resolve())
    for name, command in SLURM.items():
        (folder / name).write_text("#!/bin/bash\n" + command.replace("{log}", str(log)) + "\n")
        (folder / name).chmod(0o755)
    monkeypatch.setenv("PATH", f"{folder}{os.pathsep}{os.environ['PATH']}")
    return log


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_python_of_the_pages_runs(page, scheduler, tmp_path, monkeypatch):
    monkeypatch.setattr("pyvista.OFF_SCREEN", True)
    for scene in SCENES.get(page.name, []):
        fw.run(ROOT / f"meshes/{scene}.toml", out=tmp_path / scene)
    if page.name == "sweep.md":
        fw.sweep(ROOT / "meshes/stiffness-sweep.toml", out=tmp_path / "stiffness-sweep")
    if page.name == "tutorial.md":
        scene = next(block for block in re.findall(r"^```toml\n(.*?)^```$", page.read_text(), re.M | re.S))
        (tmp_path / "my.toml").write_text(scene)
        fw.run(tmp_path / "my.toml", out=tmp_path / "my")
    names = run(str(page), source_of(page), tmp_path, monkeypatch)
    if page.name == "python.md":
        assert (tmp_path / "miura.png").stat().st_size > 10_000
        assert names["data"].sizes == {"sheet_generate_fold": 8}
        if importlib.util.find_spec("dask_jobqueue"):
            assert len(scheduler.read_text().split()) == 2  # jobs were submitted, and the sweep ran on them
    if page.name == "sweep.md":
        assert names["energies"].shape == (5, 2) and names["energies"].notna().all(axis=None)


def test_the_page_about_python_says_the_names_of_the_package():
    """All that `foldwell` exports is in the page, and has a docstring."""
    text = (ROOT / "docs/src/python.md").read_text()
    for name in fw.__all__:
        assert getattr(fw, name).__doc__ or name.startswith("__"), name
    studies = {"bloch", "branches", "landscape", "modes", "path", "relax", "response", "surface", "trace", "wells"}
    for name in studies | {"run", "sweep", "open_sweep", "generate", "patterns", "pattern_help", "Sheet", "Assembly"}:
        assert name in text, name


def examples():
    """The functions and classes of the package, and the methods of the classes, by name."""
    named = {name: getattr(fw, name) for name in fw.__all__}
    named = {name: found for name, found in named.items() if inspect.isclass(found) or inspect.isfunction(found)}
    for name, found in list(named.items()):
        if inspect.isclass(found):
            inner = {key: getattr(found, key) for key, kind in vars(found).items() if not isinstance(kind, cached_property)}
            inner = {key: method for key, method in inner.items() if not key.startswith("_")}
            named |= {f"{name}.{key}": method for key, method in inner.items() if inspect.isroutine(method)}
    return named


@pytest.mark.parametrize("name", examples())
def test_every_function_and_class_has_an_example_that_runs(name, tmp_path, monkeypatch):
    (tmp_path / "meshes").symlink_to(ROOT / "meshes")
    monkeypatch.chdir(tmp_path)
    test = doctest.DocTestParser().get_doctest(inspect.getdoc(examples()[name]), {}, name, None, 0)
    assert test.examples, f"{name} has no example"
    assert doctest.DocTestRunner().run(test).failed == 0
    plt.close("all")


def test_the_example_of_the_docstring_runs(tmp_path, monkeypatch):
    code = re.search(r"\n\n((?:    .*\n|\n)+)", fw.__doc__).group(1)
    names = run("foldwell.__doc__", re.sub("^    ", "", code, flags=re.M), tmp_path, monkeypatch)
    # nine cells of a rigid Miura-ori with flat rest angles come to rest flat
    assert names["relaxed"].summary["energy"]["total"] < 1e-20


def test_a_script_needs_nothing_but_numpy(tmp_path):
    """The package and a relaxation work without the packages of the extra `all`."""
    blocked = "import sys\nfor name in ('matplotlib', 'pandas', 'pyvista', 'scipy', 'tqdm', 'xarray'): sys.modules[name] = None\n"
    script = blocked + "import foldwell as fw\nfw.relax(fw.Assembly.patch(fw.generate('miura'), bars=1e3, creases=1.0)).state.save('a.vtu')"
    subprocess.run([sys.executable, "-c", script], check=True, cwd=tmp_path)
    assert (tmp_path / "a.vtu").exists()
