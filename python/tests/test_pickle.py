"""Sheets, assemblies, states and results that are pickled and copied."""

import copy
import pickle
import subprocess
import sys
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import dask
import foldwell as fw
import joblib
import numpy as np
import pytest
from conftest import ROOT

WAYS = {"pickle": lambda value: pickle.loads(pickle.dumps(value)), "copy": copy.copy, "deepcopy": copy.deepcopy}
#: The arrays of a state.
ARRAYS = (
    *("positions", "displacements", "places", "faces", "self_intersecting", "edges", "kinds", "letters", "cell_edges"),
    *("fold_angles", "rest_angles", "strains", "energies", "tensions", "torques"),
)


@pytest.fixture(params=WAYS.values(), ids=WAYS)
def again(request):
    """A function that makes a copy."""
    return request.param


def same(one, other):
    """Whether all arrays of two states are equal."""
    both = [(getattr(one, name), getattr(other, name)) for name in ARRAYS]
    return all(a.dtype == b.dtype and np.array_equal(a, b, equal_nan=a.dtype.kind == "f") for a, b in both)


def test_sheets(again):
    files = [ROOT / f"meshes/{name}.fold" for name in ("open-star", "crane", "kresling-cell", "near-cross")]
    for sheet in [*map(fw.generate, fw.patterns()), *map(fw.Sheet.read, files)]:
        found = again(sheet)
        assert found.to_fold() == sheet.to_fold() and found.title == sheet.title
        for name in ("vertices", "edges", "kinds", "letters", "fold_angles"):
            assert np.array_equal(getattr(found, name), getattr(sheet, name)), (sheet, name)


def test_assemblies(again, miura):
    """Energies are equal to the last bit, with arrays, pins, laws and screws, and from a scene that is not there any more."""
    rest = np.where(miura.kinds == "facet", 0.0, np.linspace(0.1, 0.3, len(miura.edges)))
    terms = {"bars": 1e2 * np.arange(1.0, 13.0), "rest": rest, "creases": 1.3, "facets": 2.0}
    laws = {"creases": {"kind": "stiffening", "limits": [-0.9, "40 deg"]}}
    held = [{"vertex": 0}, {"vertex": 1, "axes": "yz"}]
    star = fw.generate("random", seed=3)
    for assembly in [
        fw.Assembly.patch(miura, (2, 2), pins=held, **terms),
        fw.Assembly.torus(miura, (2, 1), laws=laws, bars=1e2, creases=1.3, facets=2.0),
        fw.Assembly.screw(star, bars=fw.RIGID, creases=1.0, rest=0.3),
        fw.Assembly.patch(miura, (2, 2), facets="N5B8", material={"young": 1e3, "poisson": 0.3, "thickness": 0.1}),
        fw.Assembly.from_scene(ROOT / "meshes/two-bars-push.toml"),
    ]:
        x = assembly.start + 1e-2 * np.random.default_rng(1).standard_normal(len(assembly.start))
        found = again(assembly)
        assert np.array_equal(found.edges, assembly.edges) and np.array_equal(found.start, assembly.start)
        assert found.energy(x) == assembly.energy(x) and np.array_equal(found.constraints(x), assembly.constraints(x))


def test_results(again, soft, tmp_path):
    """Tables, states and files are equal; a relaxation that starts from the copy takes the steps of one from the original."""
    relaxed = fw.relax(soft, start={"random": 0.1, "seed": 4}, draw=["vtk", "svg", "html"], tolerance=1e-4, keep_every=1)
    found = again(relaxed)
    assert found.summary == relaxed.summary and found._repr_svg_() == relaxed._repr_svg_() and repr(found) == repr(relaxed)
    assert same(found.state, relaxed.state) and len(found.states) == len(relaxed.states) > 1
    assert all(map(same, found.states, relaxed.states))
    assert found.table.keys() == relaxed.table.keys()
    for column, values in relaxed.table.items():
        assert found.table[column].dtype == values.dtype and np.array_equal(found.table[column], values, equal_nan=values.dtype.kind == "f")
    names = [[path.relative_to(tmp_path / way) for path in result.save(tmp_path / way)] for way, result in (("a", relaxed), ("b", found))]
    assert names[0] == names[1]
    assert all((tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes() for name in names[0])
    steps = [fw.relax(soft, start=start, name="on").summary["history"] for start in (relaxed, found)]
    assert steps[0] == steps[1] and len(steps[0]) > 0


@pytest.mark.parametrize("scene", ["star-surface", "star-bloch", "star-trace", "drum-path"])
def test_results_of_other_kinds(scene, tmp_path):
    """Surfaces, maps, curves, series and scripts are written by the copy as by the original."""
    run = fw.run(ROOT / f"meshes/{scene}.toml")
    for name, result in pickle.loads(pickle.dumps(run)).items():
        assert result.summary == run[name].summary
        for one, other in zip(result.save(tmp_path / "a"), run[name].save(tmp_path / "b"), strict=True):
            assert one.read_bytes() == other.read_bytes(), one


def test_results_remember(again, miura):
    """A path that goes on from a copied result, or from the state that it has written, is that from the result itself: what has
    yielded is kept."""
    crease = tuple(miura.edges[miura.kinds == "crease"][0])

    def driven(to):
        yields = {"creases": {"moment": 0.1, "hardening": 0.1, "isotropic": 0.3}}
        terms = {"bars": fw.RIGID, "creases": 1.0, "facets": 5.0, "yields": yields, "locks": {crease: None}}
        return fw.Assembly.patch(miura, (2, 2), **terms, drives=[{"name": "turn", "lock": crease, "to": to}])

    there = fw.path(driven([0.2, 0.6]))
    assert there.summary["branches"][0]["dissipated"] > 0.01 and np.nanmax(there.state.memory["plastic_angle_total"]) > 0.01
    back, other = [fw.path(driven(0.4), start=start).summary["branches"][0] for start in (there, again(there))]
    assert back == other and back["dissipated"] >= there.summary["branches"][0]["dissipated"]


def test_a_result_goes_to_another_process(soft, tmp_path):
    relaxed = fw.relax(soft)
    (tmp_path / "kept").write_bytes(pickle.dumps((soft, relaxed)))
    code = "import pickle, foldwell as fw; soft, relaxed = pickle.load(open('kept', 'rb'))\n"
    code += "print(fw.relax(soft, start=relaxed).summary['iterations'], relaxed.state.energies.sum())"
    told = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, check=True, capture_output=True, text=True).stdout
    assert told.split() == ["0", str(relaxed.state.energies.sum())]


def with_processes(function, assemblies):
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        return list(pool.map(function, assemblies))


def with_joblib(function, assemblies):
    return joblib.Parallel(2)(joblib.delayed(function)(assembly) for assembly in assemblies)


def with_dask(function, assemblies):
    return dask.compute(*(dask.delayed(function)(assembly) for assembly in assemblies), scheduler="processes", num_workers=2)


@pytest.mark.parametrize("pool", [with_processes, with_joblib, with_dask])
def test_assemblies_go_to_the_workers_of_pools(pool, miura):
    """Relaxations of assemblies with arrays on other processes have the results of those here."""
    creases = np.linspace(1.0, 2.0, len(miura.edges))
    assemblies = [fw.Assembly.patch(miura, (2, 2), bars=1e2, creases=creases, facets=3.0, rest=angle) for angle in (0.3, 0.5, 0.7)]
    for found, expected in zip(pool(fw.relax, assemblies), map(fw.relax, assemblies), strict=True):
        assert np.array_equal(found.state.positions, expected.state.positions)
        assert found.summary["energy"] == expected.summary["energy"]
