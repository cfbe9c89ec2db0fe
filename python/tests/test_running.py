"""Work beside Python: progress, threads, signals, memory and the end of the interpreter."""

import os
import resource
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import foldwell as fw
import numpy as np
import pytest

#: A search for wells that takes minutes.
LONG = """
import foldwell as fw
sheet = fw.generate("random", seed=2)
assembly = fw.Assembly.patch(sheet, (6, 6), bars=1e4, creases=1.0)
def search():
    fw.wells(assembly, starts=100000)
"""


def test_a_callback_hears_of_every_step_in_order(soft):
    heard = []
    fw.relax(soft, progress=lambda *step: heard.append(step), name="here")
    assert [step for _, step, _, _ in heard] == list(range(1, len(heard) + 1))
    assert {(study, of) for study, _, of, _ in heard} == {("here", None)}
    assert heard[-1][3] < 1e-9 < heard[0][3]


def test_a_callback_stops_a_study(soft):
    with pytest.raises(fw.DidNotConverge, match="interrupted") as caught:
        fw.wells(soft, starts=100000, progress=lambda study, step, of, residual: False)
    assert not caught.value.result.converged
    run = fw.run(
        {
            "sheet": {"generate": {"pattern": "miura"}, "cells": [4, 4]},
            "energy": {"bars": {"stiffness": 1e3}, "creases": {"stiffness": 1.0}},
            "study": [{"name": "many", "kind": "wells", "starts": 100000}, {"name": "after", "kind": "relax"}],
        },
        progress=lambda *step: False,
    )
    assert run.interrupted and not run.converged and list(run) == ["many"]


def test_an_exception_in_a_callback_is_raised(soft):
    def fail(*step):
        raise ZeroDivisionError("in the callback")

    with pytest.raises(ZeroDivisionError, match="in the callback"):
        fw.wells(soft, starts=100000, progress=fail)


def test_a_bar_is_shown_when_asked(soft, capsys):
    fw.relax(soft, progress=True)
    assert "relax" in capsys.readouterr().err
    fw.relax(soft)
    assert capsys.readouterr().err == ""


def test_a_bar_without_tqdm_is_refused_by_name(soft, monkeypatch):
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    with pytest.raises(ModuleNotFoundError, match="progress=True needs tqdm: pip install tqdm"):
        fw.relax(soft, progress=True)


def test_other_threads_go_on(soft):
    """While a study runs, a thread of Python counts."""
    count, done = [0], threading.Event()

    def counts():
        while not done.is_set():
            count[0] += 1
            time.sleep(1e-3)

    thread = threading.Thread(target=counts)
    thread.start()
    fw.wells(soft, starts=40)
    done.set()
    thread.join()
    assert count[0] > 10


def test_a_pool_of_four_threads_gets_the_same_numbers(miura):
    """Studies in threads of Python, each with threads of its own, have the results of studies one after the other."""

    def study(seed):
        assembly = fw.Assembly.patch(miura, (12, 12), bars=1e3, creases=1.0, facets=2.0)
        return fw.relax(assembly, start={"random": 1e-2, "seed": seed}).state.positions.copy()

    alone = [study(seed) for seed in range(8)]
    with ThreadPoolExecutor(4) as pool:
        together = list(pool.map(study, range(8)))
    assert all(np.array_equal(a, b) for a, b in zip(alone, together, strict=True))


def test_memory_does_not_grow():
    """The resident memory after 10,000 calls is that after the first 2,000, up to a few pages of the allocator."""
    sheet = fw.generate("miura")
    assembly = fw.Assembly.patch(sheet, (1, 1), bars=1e2, creases=1.0, rest=0.5)
    x = assembly.start + 1e-2

    def calls(count):
        for call in range(count):
            result = fw.relax(assembly, draw=[], threads=1)
            result.state.positions.sum()
            result.table["energy_total"].sum()
            assembly.energy(x)
            if call % 10 == 0:
                assembly.hessian(x)
                fw.Assembly.patch(sheet, (1, 1), bars=1.0).start.sum()

    def resident():
        with open("/proc/self/statm") as file:
            return int(file.read().split()[1]) * resource.getpagesize()

    calls(2000)
    before = resident()
    calls(8000)
    # one leaked result a call would be tens of megabytes
    assert resident() - before < 4 << 20


def run_python(code, **more):
    environment = {**os.environ, "PYTHONFAULTHANDLER": "1"}
    return subprocess.Popen([sys.executable, "-c", code], stdout=-1, stderr=-1, text=True, env=environment, **more)


def test_ctrl_c_stops_a_study():
    process = run_python(LONG + "print('begun', flush=True)\nsearch()\n")
    assert process.stdout.readline() == "begun\n"
    time.sleep(1.0)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=60)  # of the minutes that the search would take
    assert process.returncode in (1, -signal.SIGINT) and errors.rstrip().endswith("KeyboardInterrupt"), errors


@pytest.mark.parametrize(
    "work",
    [
        'fw.generate("kresling", sides=1000, levels=700)',
        "fw.Sheet.read(path)",
        "fw.convert(path, path.with_suffix('.obj'))",
    ],
)
def test_ctrl_c_stops_work_on_sheets(work, tmp_path):
    """Reading, converting and generating take many seconds here; Ctrl-C raises at once, and threads of Python go on."""
    path = tmp_path / "long.fold"
    code = f"import foldwell as fw, threading, time\nfrom pathlib import Path\npath = Path({str(path)!r})\n"
    code += "ticks = [0]\ndef tick():\n    while True:\n        time.sleep(0.01)\n        ticks[0] += 1\n"
    code += "threading.Thread(target=tick, daemon=True).start()\nprint('begun', flush=True)\n"
    code += f"try:\n    {work}\nexcept KeyboardInterrupt:\n    print(ticks[0])\n"
    if "path" in work:
        side = 1000
        points = ", ".join(f"[{k % side}, {k // side}, 0]" for k in range(side * side))
        rows = (y * side + x for y in range(side - 1) for x in range(side - 1))
        faces = ", ".join(f"[{k}, {k + 1}, {k + side + 1}, {k + side}]" for k in rows)
        path.write_text(f'{{"vertices_coords": [{points}], "faces_vertices": [{faces}]}}')
    process = run_python(code)
    assert process.stdout.readline() == "begun\n"
    time.sleep(1.0)
    process.send_signal(signal.SIGINT)
    told, errors = process.communicate(timeout=30)
    assert process.returncode == 0 and int(told) > 10, errors
    assert not path.with_suffix(".obj").exists()


@pytest.mark.parametrize(
    "ending",
    [
        "",  # the main thread ends
        "sys.exit(3)",
        "raise ZeroDivisionError",
    ],
)
def test_an_interpreter_that_ends_in_the_middle_ends_cleanly(ending):
    """A study in a daemon thread, which Python does not wait for, neither aborts the process nor keeps it."""
    code = LONG + "import sys, threading, time\n"
    code += "thread = threading.Thread(target=search, daemon=True)\nthread.start()\ntime.sleep(0.5)\n" + ending
    process = run_python(code)
    _, errors = process.communicate(timeout=60)
    assert process.returncode == {"": 0, "sys.exit(3)": 3}.get(ending, 1), errors
    assert "Fatal" not in errors and "panic" not in errors, errors


def test_a_forked_process_computes_too(soft):
    """A process forked after work with threads has no lock of another thread to wait for."""
    expected = fw.relax(soft).state.positions
    child = os.fork()
    if child == 0:
        same = np.array_equal(fw.relax(soft).state.positions, expected)
        os._exit(0 if same else 1)
    assert os.waitpid(child, 0)[1] == 0


def test_a_run_follows_one_that_was_broken_off(tmp_path):
    """A run into the folder of one that still ends its step in the background waits for it, and has the files of one alone."""
    scene = {
        "sheet": {"generate": {"pattern": "miura"}, "cells": [12, 12]},
        "energy": {"bars": {"stiffness": 1e3}, "creases": {"stiffness": 1.0, "rest": 0.5}},
        "study": [{"name": "relaxed", "kind": "relax", "draw": ["vtk"]}],
    }

    def fail(study, step, of, residual):
        raise ZeroDivisionError

    fw.run(scene, out=tmp_path / "alone")
    with pytest.raises(ZeroDivisionError):
        fw.run(scene, out=tmp_path / "twice", progress=fail)
    assert fw.run(scene, out=tmp_path / "twice").converged
    for name in ("relaxed.csv", "relaxed.pvd"):
        assert (tmp_path / "twice" / name).read_bytes() == (tmp_path / "alone" / name).read_bytes()
    assert not list((tmp_path / "twice").glob("*.part")) and not list((tmp_path / "twice").glob(".*"))
