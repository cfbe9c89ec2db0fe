"""Sweeps: on threads, on processes, on Dask, interrupted and resumed."""

import os
import shutil
import signal
import subprocess
import sys
import time
from collections import Counter
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import nullcontext
from multiprocessing import get_context
from pathlib import Path

import foldwell as fw
import numpy as np
import pytest
from conftest import ROOT
from foldwell.sweeps import _dataset

SCENE = {
    "sheet": {"generate": {"pattern": "random", "seed": 0}, "cells": [2, 2]},
    "energy": {"bars": {"stiffness": 1e3}, "creases": {"stiffness": 1.0, "rest": 0.1}},
    "study": [{"name": "bent", "kind": "relax", "draw": []}],
}
AXES = {"sheet.generate.seed": range(6), "energy.bars.stiffness": np.logspace(2, 4, 3)}


@pytest.fixture(scope="module")
def expected(tmp_path_factory):
    """The data set of the sweep, and the bytes of its table."""
    folder = tmp_path_factory.mktemp("expected")
    data = fw.sweep(SCENE, AXES, out=folder)
    return data, (folder / "sweep.csv").read_bytes()


def test_a_point_is_the_study_that_it_would_be_alone(expected):
    data, _ = expected
    assert dict(data.sizes) == {"sheet_generate_seed": 6, "energy_bars_stiffness": 3}
    assert data.sheet_generate_seed.values.tolist() == list(range(6)) and data.sheet_generate_seed.dtype == int
    assert (data.status == "converged").all() and (data.reason == "").all() and data.bent_converged.all()
    for seed, stiffness in [(0, 1e2), (1, 1e4), (4, 1e2)]:  # off the diagonal: the axes are not swapped
        run = fw.run(SCENE, set={"sheet.generate.seed": seed, "energy.bars.stiffness": stiffness})
        point = data.sel(sheet_generate_seed=seed, energy_bars_stiffness=stiffness)
        assert float(point.bent_energy_total) == run["bent"].summary["energy"]["total"]


@pytest.mark.parametrize("executor", [None, ThreadPoolExecutor, ProcessPoolExecutor])
def test_a_sweep_in_memory_has_the_same_table(executor, expected, monkeypatch):
    """Without a folder nothing is written, and where points are computed makes no difference."""
    monkeypatch.setattr("tempfile.tempdir", "/no/such/folder")
    heard = []
    spawned = {"mp_context": get_context("spawn")} if executor is ProcessPoolExecutor else {}
    with nullcontext() if executor is None else executor(2, **spawned) as pool:
        found = fw.sweep(SCENE, AXES, executor=pool, progress=lambda *step: heard.append(step))
    assert found.identical(expected[0])
    assert heard[-1][:3] == ("points", 18, 18)


def test_a_sweep_in_memory_stops():
    """Points that were not computed are missing, however slow who stops it is; a wrong scene is refused before."""

    def stops_after_three(study, step, of, residual):
        time.sleep(0.1)  # longer than a point
        return step < 3

    found = fw.sweep(SCENE, AXES, threads=1, progress=stops_after_three)
    assert found.status.values.ravel().tolist().count("missing") == 15
    with pytest.raises(fw.SceneError, match="point 1"):
        fw.sweep(SCENE, {"energy.bars.stiffness": [1.0, -2.0]})


@pytest.mark.parametrize("executor", [ThreadPoolExecutor, ProcessPoolExecutor])
def test_executors_make_the_same_table(executor, expected, tmp_path):
    data, table = expected
    spawned = {"mp_context": get_context("spawn")} if executor is ProcessPoolExecutor else {}
    heard = []
    with executor(2, **spawned) as pool:
        found = fw.sweep(SCENE, AXES, out=tmp_path, executor=pool, progress=lambda *step: heard.append(step))
    assert found.identical(data) and (tmp_path / "sweep.csv").read_bytes() == table
    assert heard[-1][:3] == ("points", 18, 18)
    assert fw.open_sweep(tmp_path).sizes["point"] == 18


def test_dask_makes_the_same_table(expected, tmp_path):
    distributed = pytest.importorskip("distributed")
    data, table = expected
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        with distributed.Client(cluster) as client:
            assert fw.sweep(SCENE, AXES, out=tmp_path, executor=client.get_executor()).identical(data)
    assert (tmp_path / "sweep.csv").read_bytes() == table


def test_points_are_kept_or_computed_anew_as_asked(tmp_path):
    """With an executor and without one, `resume` alone decides whether points that are there are computed again."""
    axes = {"sheet.generate.seed": range(3)}
    with ThreadPoolExecutor(2) as pool:
        for executor in (None, pool):
            fw.sweep(SCENE, axes, out=tmp_path, resume=False, executor=executor)
            first = finished(tmp_path)
            fw.sweep(SCENE, axes, out=tmp_path, executor=executor)
            assert finished(tmp_path) == first
            fw.sweep(SCENE, axes, out=tmp_path, resume=False, executor=executor)
            assert all(finished(tmp_path)[point] > time for point, time in first.items())


def failing(*step):
    raise ValueError(step)


def test_a_callback_stops_a_sweep(tmp_path):
    """No piece of the sweep begins after a callback has said so, or has failed; the next call computes what is missing, and that alone."""
    axes = {"sheet.generate.seed": range(200)}

    with ThreadPoolExecutor(1) as pool:
        stopped = fw.sweep(SCENE, axes, out=tmp_path, executor=pool, progress=lambda *step: False)
    assert "missing" in stopped.status.values and "converged" in stopped.status.values
    first = finished(tmp_path)
    assert 0 < len(first) < 200
    with pytest.raises(ValueError), ThreadPoolExecutor(1) as pool:
        fw.sweep(SCENE, axes, out=tmp_path, executor=pool, progress=failing)
    assert len(finished(tmp_path)) < 200
    with ThreadPoolExecutor(2) as pool:
        whole = fw.sweep(SCENE, axes, out=tmp_path, executor=pool)
    assert (whole.status == "converged").all()
    assert {point: finished(tmp_path)[point] for point in first} == first


def test_forms_of_axes(expected):
    data, _ = expected
    forms = {"sheet.generate.seed": {"seeds": [0, 6]}, "energy.bars.stiffness": {"log": [1e2, 1e4, 3]}}
    other = fw.sweep(SCENE, forms)
    assert np.array_equal(other.bent_energy_total, data.bent_energy_total)
    together = fw.sweep(SCENE, {"sheet.generate.seed": [0, 1], "energy.bars.stiffness": [1e2, 1e3]}, zip=True)
    assert dict(together.sizes) == {"point": 2}
    assert float(together.bent_energy_total[1]) == float(data.bent_energy_total[1, 1])


@pytest.mark.parametrize("folder", [False, True])
def test_scenes_of_sweeps_have_arrays(folder, tmp_path):
    """Arrays in the dict of a scene go to the points, also on other processes and into folders; other numbers are another sweep."""
    rest = np.linspace(0.0, 0.2, len(fw.generate("random", seed=0).edges))
    scene = {**SCENE, "energy": {"bars": {"stiffness": 1e3}, "creases": {"stiffness": 1.0, "rest": rest}}}
    axes, out = {"energy.bars.stiffness": np.array([1e2, 1e3])}, tmp_path / "sweep" if folder else None
    expected = [fw.run(scene, set={"energy.bars.stiffness": k})["bent"].summary["energy"]["total"] for k in axes["energy.bars.stiffness"]]
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        for executor in (None, pool):
            assert fw.sweep(scene, axes, out=out, executor=executor).bent_energy_total.values.tolist() == expected
    scene["energy"]["creases"]["rest"] = 2.0 * rest
    assert (fw.sweep(scene, axes, out=out).bent_energy_total.values != expected).all()


def test_names_of_data_sets():
    """Points in names become `_`, with the key as an attribute; where two names would be one, all keep their points."""
    data = fw.sweep(SCENE, {"energy.bars.stiffness": [1e2, 1e3]})
    assert data.bent_energy_total.attrs == {"key": "bent.energy.total", "long_name": "bent energy total"}
    assert data.energy_bars_stiffness.attrs["key"] == "energy.bars.stiffness"
    about = {"title": "t", "scene": "s", "version": "0", "digest": "", "keys": ["x.y"]}
    both = _dataset(["point,x.y,status,reason,a.folding_modes,a_folding.modes", "0,1.5,converged,,2,3"], [1], about)
    assert (both["a.folding_modes"].item(), both["a_folding.modes"].item()) == (2.0, 3.0) and dict(both.sizes) == {"x.y": 1}


def test_points_that_fail_are_listed(tmp_path):
    """Seven locked angles that no sheet has: points that do not converge keep their reason."""
    scene = {
        "sheet": {"mesh": "degree-four.fold"},
        "energy": {"bars": {"stiffness": fw.RIGID}, "creases": {"stiffness": 1.0}},
        "lock": [{"crease": [0, 1, 0, 0], "angle": 2.0}, {"crease": [0, 2, 0, 0], "angle": -2.0}],
        "study": [{"name": "held", "kind": "relax", "draw": []}],
    }
    data = fw.sweep(scene, {"lock.0.angle": [0.1, 2.0], "lock.1.angle": [-2.0]}, base=ROOT / "meshes")
    status = set(data.status.values.ravel().tolist())
    assert "not-converged" in status
    assert all(bool(why) == (word != "converged") for word, why in zip(data.status.values.ravel(), data.reason.values.ravel(), strict=True))


def test_a_folder_of_no_sweep_is_said(tmp_path):
    with pytest.raises(FileNotFoundError, match="not the folder of a sweep, it has no sweep.csv"):
        fw.open_sweep(tmp_path)


def test_mistakes_are_said_before_anything_is_computed(tmp_path):
    for axes, words in [
        ({"energy.bars.stiffnes": [1.0, 2.0]}, "unknown key `stiffnes`"),
        ({"energy.bars.stiffness": [1.0, -2.0]}, "point 1"),
        ({"energy.bars.stiffness": []}, "sweep|values"),
        (None, "no `sweep`"),
    ]:
        with pytest.raises(fw.SceneError, match=words):
            fw.sweep(SCENE, axes, out=tmp_path / "none")
    assert not (tmp_path / "none").exists()


#: A sweep of 40 points in a process of its own, which says when it begins.
PROCESS = """
import sys, foldwell as fw
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
SCENE, AXES = {scene!r}, {{"sheet.generate.seed": range(40)}}
if __name__ == "__main__":
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        fw.sweep(SCENE, AXES, out={out!r}, executor=pool)
"""


def finished(folder: Path) -> dict[str, float]:
    """Returns the times at which points were finished."""
    return {path.parent.name: path.stat().st_mtime for path in folder.glob("points/*/summary.json")}


def test_a_sweep_that_was_killed_goes_on(tmp_path):
    """All processes are killed by -9 in the middle; the next call computes only what is missing and has the same table."""
    killed, whole = tmp_path / "killed", tmp_path / "whole"
    script = tmp_path / "sweep.py"
    script.write_text(PROCESS.format(scene=SCENE, out=str(killed)))
    process = subprocess.Popen([sys.executable, script], start_new_session=True)
    while len(finished(killed)) < 8 and process.poll() is None:
        time.sleep(0.01)
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    before = finished(killed)
    assert 8 <= len(before) < 40
    axes = {"sheet.generate.seed": range(40)}
    resumed, at_once = fw.sweep(SCENE, axes, out=killed), fw.sweep(SCENE, axes, out=whole)
    after = finished(killed)
    # a point that was being written when it was killed is computed again: one for each of the two workers
    assert sum(after[point] != time for point, time in before.items()) <= 2
    assert resumed.identical(at_once)
    assert (killed / "sweep.csv").read_bytes() == (whole / "sweep.csv").read_bytes()


class Losing(ThreadPoolExecutor):
    """An executor that computes each piece and then loses its result, as often as told, as Dask does with a lost worker."""

    def __init__(self, times):
        super().__init__(2)
        self.times = times
        self.lost = Counter()

    def submit(self, function, scene, piece, how):
        self.lost[piece] += 1
        lose = self.lost[piece] <= self.times

        def computed():
            result = function(scene, piece, how)
            if lose:
                raise TypeError("cannot unpack non-iterable int object")
            return result

        return super().submit(computed)


def test_a_piece_that_its_executor_lost_is_handed_out_once_more(expected, tmp_path):
    """One loss of each piece changes neither the table nor the count of points; a second one is reported."""
    data, table = expected
    heard = []
    with Losing(1) as pool:
        assert fw.sweep(SCENE, AXES, out=tmp_path, executor=pool, progress=lambda *step: heard.append(step)).identical(data)
    assert set(pool.lost.values()) == {2} and (tmp_path / "sweep.csv").read_bytes() == table
    assert [step[1] for step in heard] == list(range(1, 19))
    with pytest.raises(TypeError), Losing(2) as pool:
        fw.sweep(SCENE, AXES, executor=pool)
    assert max(pool.lost.values()) == 2


def test_an_error_of_foldwell_is_not_repeated(tmp_path):
    """A folder in which no point can be written fails at once."""
    with ThreadPoolExecutor(2) as pool:
        fw.sweep(SCENE, AXES, out=tmp_path, executor=pool)
    for point in (tmp_path / "points").iterdir():
        shutil.rmtree(point)
        point.write_text("no folder")
    with pytest.raises(fw.OutputError), Losing(0) as pool:
        fw.sweep(SCENE, AXES, out=tmp_path, executor=pool)
    assert set(pool.lost.values()) == {1}


def test_nothing_is_written_after_a_sweep_has_failed(tmp_path):
    """Pieces that run when another one fails have ended when the error is reported, and no other has begun."""
    with ThreadPoolExecutor(2) as pool:
        with pytest.raises(ValueError):
            fw.sweep(SCENE, {"sheet.generate.seed": range(200)}, out=tmp_path, executor=pool, progress=failing)
        at_once = finished(tmp_path)
        time.sleep(0.2)
        assert finished(tmp_path) == at_once and len(at_once) < 200


def test_a_lost_worker_of_dask_loses_nothing(tmp_path):
    """One of two workers is killed by -9 in the middle: its points are computed by the other, and the table is the same."""
    distributed = pytest.importorskip("distributed")
    killed, whole = tmp_path / "killed", tmp_path / "whole"
    axes = {"sheet.generate.seed": range(40)}
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
        ThreadPoolExecutor(1) as aside,
    ):
        sweeping = aside.submit(fw.sweep, SCENE, axes, out=killed, executor=client.get_executor())
        while len(finished(killed)) < 8:
            assert not sweeping.done(), "the sweep ended without its points"
            time.sleep(0.01)
        os.kill(next(iter(client.run(os.getpid).values())), signal.SIGKILL)
        assert len(finished(killed)) < 40
        found = sweeping.result(timeout=300)
    assert found.identical(fw.sweep(SCENE, axes, out=whole))
    assert (killed / "sweep.csv").read_bytes() == (whole / "sweep.csv").read_bytes()


def test_columns_have_the_units_that_the_scene_names(tmp_path):
    scene = SCENE | {"units": {"length": "mm", "force": "N"}}
    axes = {"sheet.generate.seed": range(2)}
    for data in (fw.sweep(scene, axes), fw.sweep(scene, axes, out=tmp_path / "kept"), fw.open_sweep(tmp_path / "kept")):
        assert data.bent_energy_total.attrs["units"] == data.bent_energy_bars.attrs["units"] == "N mm"
        assert "units" not in data.bent_iterations.attrs
    assert "units" not in fw.sweep(SCENE, axes).bent_energy_total.attrs
