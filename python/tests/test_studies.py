"""Studies, their results, and the same numbers as the program's."""

import csv
import inspect
import itertools
import json
import pickle
import re
import subprocess

import foldwell as fw
import numpy as np
import pytest
import pyvista
from conftest import ROOT

#: Scenes of every kind of study and of every kind of boundary condition.
SCENES = [
    *("star", "star-torus", "star-trace", "star-landscape", "star-surface"),
    *("flat-branches", "miura-spectrum", "miura-frequencies", "kirigami-bloch", "near-cross-wells", "two-bars-push", "drum-path", "degree-four"),
]
KINDS = ["bloch", "branches", "landscape", "modes", "path", "relax", "response", "surface", "trace", "wells"]


def without_times(summary):
    """Returns a study's part of the summary without what belongs to the files of a run."""
    return {key: value for key, value in summary.items() if key not in ("seconds", "files")}


@pytest.mark.parametrize("scene", SCENES)
def test_results_are_those_of_the_program_to_the_last_bit(scene, program, tmp_path):
    path = ROOT / f"meshes/{scene}.toml"
    ended = subprocess.run([program, "run", path, "--out", tmp_path / "run", "--quiet"], check=False)
    run = fw.run(path)
    assert ended.returncode == (0 if run.converged else 1)
    summary = json.loads((tmp_path / "run/summary.json").read_text())
    assert [without_times(study) for study in summary["studies"]] == [without_times(run[name].summary) for name in run]
    for name in run:
        written = run[name].save(tmp_path / "python")
        assert written
        for file in written:
            there = tmp_path / "run" / file.relative_to(tmp_path / "python")
            assert file.read_bytes() == there.read_bytes(), file
        for table, columns in run[name].tables.items():
            with open(tmp_path / "run" / table) as text:
                rows = list(csv.DictReader(text))
            for column, values in columns.items():
                as_text = [row[column] for row in rows]
                if values.dtype.kind in "fi":
                    as_numbers = np.array([float(text or "nan") for text in as_text])
                    assert np.array_equal(values.astype(float), as_numbers, equal_nan=True), (table, column)
                else:
                    assert values.tolist() == as_text


def test_a_run_into_a_folder_is_that_of_the_program(program, tmp_path):
    path = ROOT / "meshes/star-landscape.toml"
    subprocess.run([program, "run", path, "--out", tmp_path / "a", "--quiet"], check=True)
    run = fw.run(path, out=tmp_path / "b")
    assert run.converged and len(run) == 0 and run.summary["studies"]
    for file in (tmp_path / "a").rglob("*.csv"):
        assert file.read_bytes() == (tmp_path / "b" / file.relative_to(tmp_path / "a")).read_bytes()
    again = fw.run(path, out=tmp_path / "b", resume=True)
    assert [study["seconds"] for study in again.summary["studies"]] == [s["seconds"] for s in run.summary["studies"]]


def test_keyword_arguments_build_the_assembly_of_the_scene():
    scene = {
        "sheet": {"generate": {"pattern": "miura"}, "cells": [3, 3]},
        "energy": {"bars": {"stiffness": fw.RIGID}, "creases": {"stiffness": 1.0, "rest": "flat"}},
        "study": [{"name": "relax", "kind": "relax"}],
    }
    assembly = fw.Assembly.patch(fw.generate("miura"), (3, 3), bars=fw.RIGID, creases=1.0, rest="flat")
    by_scene, by_arguments = fw.run(scene)["relax"], fw.relax(assembly)
    by_other = fw.relax(fw.Assembly.from_scene(scene))
    for other in (by_arguments, by_other):
        assert without_times(other.summary) == without_times(by_scene.summary)
        assert np.array_equal(other.state.positions, by_scene.state.positions)


def test_arrays_are_the_tables_of_a_scene(miura):
    """Values for each edge of the cell, for each edge of the model, and one number for all give the same energy."""
    uniform = fw.Assembly.patch(miura, (3, 2), bars=1e3, creases=2.0, facets=5.0, rest=0.25)
    x = uniform.start + 1e-2 * np.random.default_rng(3).standard_normal(len(uniform.start))
    model, cell = np.ones(len(uniform.edges)), np.ones(len(miura.edges))
    for ones in (model, cell):
        arrays = fw.Assembly.patch(miura, (3, 2), bars=1e3 * ones, creases=2 * ones, facets=5 * ones, rest=0.25 * ones)
        assert arrays.energy(x) == uniform.energy(x)
    varied = fw.Assembly.patch(miura, (3, 2), bars=1e3, creases=np.arange(1.0, len(model) + 1), facets=5.0, rest=0.25)
    crease = uniform.kinds == "crease"
    per_length = 0.5 * uniform.lengths(uniform.start)[crease] * (uniform.fold_angles(x)[crease] - 0.25) ** 2
    more = ((np.arange(1.0, len(model) + 1)[crease] - 2.0) * per_length).sum()
    assert varied.energy(x) - uniform.energy(x) == pytest.approx(more, rel=1e-11)
    lengths = fw.Assembly.patch(miura, (3, 2), bars=1e3, rest_lengths=uniform.lengths(x))
    assert lengths.energy(x) == pytest.approx(0.0, abs=1e-24)


def test_loads_of_all_vertices_are_an_array(miura):
    """Forces as an array are the same loads as those that are named one by one, and do the same work."""
    force = np.zeros((16, 3))
    force[7], force[15] = (0.0, 0.1, -0.2), (0.3, 0.0, 0.0)
    terms = {"bars": 1e2, "creases": 1.0, "pins": [{"vertex": k} for k in range(3)]}
    named = [{"vertex": 3, "cell": (1, 0), "force": force[7]}, {"vertex": 3, "cell": (1, 1), "force": force[15]}]
    array, one_by_one = (fw.Assembly.patch(miura, (2, 2), loads=loads, **terms) for loads in (force, named))
    x = array.start + 1e-2
    assert array.energy(x) == one_by_one.energy(x) != fw.Assembly.patch(miura, (2, 2), **terms).energy(x)
    assert np.array_equal(fw.relax(array).state.positions, fw.relax(one_by_one).state.positions)
    for wrong, words in [(force[1:], r"loads has shape \(15, 3\), expected \(16, 3\)"), (force[:, 1:], r"\(16, 2\), expected \(n, 3\)")]:
        with pytest.raises(ValueError, match=words):
            fw.Assembly.patch(miura, (2, 2), loads=wrong, **terms)
    with pytest.raises(fw.SceneError, match="vertices of a patch"):
        fw.Assembly.torus(miura, (2, 2), bars=1.0, loads=force)
    with pytest.raises(fw.SceneError, match="balance"):
        fw.Assembly.patch(miura, (2, 2), bars=1.0, loads=force)


def test_arrays_are_not_written_anywhere(miura, monkeypatch):
    """Arrays come to the same assembly without a file: there is no folder for temporary ones, and a mode is an array too."""
    monkeypatch.setattr("tempfile.tempdir", "/no/such/folder")
    monkeypatch.setenv("TMPDIR", "/no/such/folder")
    ones = np.ones(len(miura.edges))
    assembly = fw.Assembly.patch(miura, (2, 2), bars=1e3 * ones, creases=ones, facets=ones, rest=0.25 * ones, facet_rest=0 * ones)
    rates = np.where(miura.kinds == "crease", 1.0, np.nan)  # only creases have to have one
    with pytest.raises(fw.SceneError, match=r"modes\[0\] has shape \(11,\), expected \(12,\)"):
        fw.landscape(assembly, [rates[:-1]], [0.1])
    with pytest.raises(fw.SceneError, match=r"modes\[0\]\[\d+\]: `NaN` in column `rate`"):
        fw.landscape(assembly, [np.full(len(rates), np.nan)], [0.1])
    assert fw.relax(assembly).to_pyvista().n_cells == len(assembly.edges) + 18


def test_rest_angles_of_rigid_facets(miura):
    """A rest angle at a facet is refused by its place where facets are rigid, and 0, nan or an angle of a soft facet is not."""
    facet = int(np.flatnonzero(miura.kinds == "facet")[0])
    edge = list(map(int, miura.edges[facet]))
    for angle, facets, wrong in [(0.0, None, False), (np.nan, None, False), (0.1, 5.0, False), (0.1, None, True), (0.1, fw.RIGID, True)]:
        rest = np.full(len(miura.edges), 0.25)
        rest[miura.kinds == "facet"] = 0.0
        rest[facet] = angle
        if wrong:
            with pytest.raises(ValueError, match=re.escape(f"rest[{facet}] is 0.1, but edge {edge} is a facet, which is rigid")):
                fw.Assembly.patch(miura, (3, 2), bars=1e3, creases=2.0, facets=facets, rest=rest)
        else:
            fw.Assembly.patch(miura, (3, 2), bars=1e3, creases=2.0, facets=facets, rest=rest)


@pytest.mark.parametrize(
    ("terms", "error", "words"),
    [
        ({"bars": -1.0}, fw.SceneError, "stiffness is -1"),
        ({"bars": 1.0, "rest": "flat"}, TypeError, "rest is given without creases"),
        ({"bars": np.ones(5)}, ValueError, r"bars has shape \(5,\), expected \(12,\) or"),
        ({"bars": np.ones((12, 2))}, ValueError, r"bars has shape \(12, 2\)"),
        ({"creases": np.full(12, np.nan)}, ValueError, r"creases\[0\]: `NaN` in column `stiffness`"),
        ({"creases": 1.0, "rest": np.full(12, np.inf)}, ValueError, r"rest\[0\]: `inf` in column `angle` is not a finite"),
        ({"creases": 1.0, "rest": np.full(12, 40.0)}, ValueError, r"rest\[0\]: the angle 40 is more than a whole turn"),
        ({"bars": 1.0, "rest_lengths": np.zeros(12)}, ValueError, r"rest_lengths\[0\]: `0` in column `length`"),
        ({"bars": np.array(["a"] * 12)}, TypeError, "expected real numbers"),
        ({"bars": np.full(12, -2.0)}, fw.SceneError, r"bars\[0\]: `-2` in column `stiffness` is not a positive number"),
        ({"bar": 1.0}, TypeError, "unknown argument 'bar'"),
        ({"bars": object()}, TypeError, "a object is no value of a scene"),
        ({"creases": 1.0, "locks": {(0, 9, 0, 0): 1.0}}, fw.SceneError, r"no crease \[0, 9, 0, 0\]"),
        ({"creases": 1.0, "locks": {(0, 1, 0, 0): "sixty"}}, fw.SceneError, "angle"),
        ({"bars": 1.0, "pins": [{"vertex": 99}]}, fw.SceneError, "99"),
    ],
)
def test_wrong_terms_are_refused(miura, terms, error, words):
    with pytest.raises(error, match=words):
        fw.Assembly.patch(miura, (2, 2), **terms)


def test_wrong_scenes_name_line_and_correction():
    with pytest.raises(fw.SceneError, match="unknown key `stifness`") as caught:
        fw.run({"sheet": {"generate": {"pattern": "miura"}}, "energy": {"bars": {"stifness": 1.0}}})
    assert "stiffness" in caught.value.help and caught.value.line is not None
    with pytest.raises(fw.SceneError, match="nothing to compute"):
        fw.run({"sheet": {"generate": {"pattern": "miura"}}, "study": []})
    with pytest.raises(fw.SceneError, match="no-such"):
        fw.run("no-such.toml")
    with pytest.raises(TypeError, match=r"sheet\.mesh: a object"):
        fw.run({"sheet": {"mesh": object()}})
    with pytest.raises(TypeError, match="keys of a scene are str"):
        fw.run({3: 4})


def test_keys_are_set(tmp_path):
    path = ROOT / "meshes/star.toml"
    soft, rigid = (fw.run(path, set={"energy.bars.stiffness": k, "title": 'a "b"'}) for k in (1e2, fw.RIGID))
    assert soft.summary["settings"][0] == "energy.bars.stiffness=100.0"
    assert soft.summary["title"] == 'a "b"'
    assert soft["relaxed"].summary["energy"]["bars"] > 0.0 == rigid["relaxed"].summary["energy"]["bars"]
    with pytest.raises(fw.SceneError, match="no element `nobody`"):
        fw.run(path, set={"study.nobody.tolerance": 1e-3})


def test_studies_start_from_results(soft):
    first = fw.relax(soft)
    again = fw.relax(soft, start=first)
    assert again.summary["iterations"] == 0
    assert np.array_equal(again.state.positions, first.state.positions)
    assert fw.modes(soft, start=first, eigenvalues=8).summary["eigenvalues"][6] > 1e-3
    away = fw.relax(soft, start={"random": 1e-3, "seed": 3}, name="away")
    assert np.abs(soft.lengths(soft.unknowns(away)) - soft.lengths(soft.unknowns(first))).max() < 1e-8
    other = fw.Assembly.patch(fw.generate("miura"), (2, 2), bars=1.0)
    with pytest.raises(ValueError, match="coordinates"):
        other.unknowns(first)
    with pytest.raises(fw.SceneError, match="another assembly"):
        fw.relax(other, start=first)


def test_a_result_that_did_not_converge_is_raised_with_all_it_has():
    sheet = fw.Sheet.read(ROOT / "meshes/degree-four.fold")
    locks = {(0, 1, 0, 0): 2.0, (0, 2, 0, 0): -2.0, (0, 3, 0, 0): 0.5}
    assembly = fw.Assembly.patch(sheet, bars=fw.RIGID, creases=1.0, locks=locks)
    with pytest.raises(fw.DidNotConverge, match="relax: ") as caught:
        fw.relax(assembly)
    error = caught.value
    assert error.history == error.result.summary["history"]
    assert error.state.positions.shape == (len(sheet.vertices), 3)
    assert not error.result.converged and "did not converge" in repr(error.result)
    again = pickle.loads(pickle.dumps(error))
    assert isinstance(again, fw.DidNotConverge) and again.history == error.history
    with pytest.raises(fw.DidNotConverge, match="relax: ") as caught:
        fw.relax(fw.Assembly.patch(sheet, bars=1e3, creases=1.0, rest=0.3), tolerance=1e-40)  # below rounding
    assert caught.value.history[-1]["residual_force"] > 0.0
    quiet = fw.relax(assembly, must_converge=False)
    assert not quiet.converged
    with pytest.raises(ValueError, match="no final state"):
        quiet.state  # noqa: B018


def test_results_go_to_other_libraries(soft, tmp_path):
    relaxed = fw.relax(soft, draw=["vtk", "svg"])
    frame = relaxed.to_pandas()
    assert list(frame.columns) == list(relaxed.table) and len(frame) == 2
    mesh = relaxed.to_pyvista()
    assert np.array_equal(np.asarray(mesh.points), relaxed.state.positions)
    relaxed.state.save(tmp_path / "a.vtu")
    read = pyvista.read(tmp_path / "a.vtu")
    assert np.array_equal(read.cells, mesh.cells) and np.array_equal(read.celltypes, mesh.celltypes)
    for there, here in [(read.point_data, mesh.point_data), (read.cell_data, mesh.cell_data)]:
        assert list(there) == list(here)
        for name in there:
            assert there[name].dtype == here[name].dtype and np.array_equal(there[name], here[name], equal_nan=True), name
    assert relaxed._repr_svg_().startswith("<svg")
    axes = relaxed.plot()
    axes.figure.savefig(tmp_path / "a.png")
    sheet = fw.generate("random", seed=1)
    screw = fw.Assembly.patch(sheet, (3, 3), bars=fw.RIGID, creases=1.0)
    land = fw.landscape(screw, [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0)], [0.01, 0.02])
    assert len(land.plot().lines) == 2


def test_tables_go_to_xarray():
    """Fold angles are one variable, by the names of the edges; the rest angle of a lock is kept along a trace."""
    star = fw.Sheet.read(ROOT / "meshes/open-star.fold")
    traced = fw.trace(fw.Assembly.screw(star, bars=fw.RIGID, creases=1.0, locks=[(0, 1, -1, 0)]), stop={"arc_length": 0.5})
    data = traced.to_xarray()
    assert data.sizes == {"row": len(traced.table["step"]), "edge": 12}
    assert [tuple(map(int, name.split(","))) for name in data.edge.values.tolist()] == list(map(tuple, star.edges.tolist()))
    locked = data.fold_angle.sel(edge="0,1,-1,0")
    assert np.allclose(locked, star.fold_angles[star.edges.tolist().index([0, 1, -1, 0])], rtol=0.0, atol=1e-12)
    assert np.array_equal(data.curvature, traced.table["curvature"])
    assert "fold_angle" not in fw.modes(fw.Assembly.patch(star, bars=1.0, creases=1.0), eigenvalues=3).to_xarray()


def test_numbers_of_plots_are_those_of_pins(miura):
    texts = {text.get_text() for text in miura.plot(numbers=True).texts}
    assert {"0", "1", "2", "3", "0 (1, 0)", "0 (0, 1)"} <= texts
    assert not miura.plot().texts
    axes = miura.plot()
    axes.figure.canvas.draw()
    assert len(axes.collections[0].get_paths()) == 8  # four parallelograms, each of two triangles


def test_modes_by_rates_are_those_by_curvature():
    """The rates of a folding mode of unit curvature name the same mode as its curvature tensor does."""
    sheet = fw.generate("random", seed=1)
    patch = fw.Assembly.patch(sheet, (3, 3), bars=fw.RIGID, creases=1.0)
    small = 1e-7
    bent = fw.Assembly.patch(sheet, (3, 3), bars=fw.RIGID, creases=1.0, rest={"mode": (1.0, 0.0, 0.0), "amplitude": small})
    drawn = bent.drawn
    inner = ~np.isnan(drawn.rest_angles)
    first = np.zeros(len(sheet.edges))
    first[drawn.cell_edges[inner]] = (drawn.rest_angles - drawn.fold_angles)[inner] / small
    named = fw.landscape(patch, [(1.0, 0.0, 0.0)], [0.05])
    rated = fw.landscape(patch, [first], [0.05])
    assert rated.table["energy_total"] == pytest.approx(named.table["energy_total"], rel=1e-6)


def test_frequencies_follow_from_a_mass(miura):
    """With one mass for all vertices, squared frequencies are the eigenvalues over it, rigid motions exactly 0."""
    terms = {"bars": 1e3, "creases": 1.0, "facets": 10.0}
    found = fw.modes(fw.Assembly.patch(miura, (2, 2), mass={"vertex": 4.0}, **terms), eigenvalues=12).summary
    assert found["frequencies"][:6] == [0.0] * 6
    expected = np.sqrt(np.array(found["eigenvalues"][6:]) / 4.0)
    assert found["frequencies"][6:] == pytest.approx(expected, rel=1e-12)
    assert "frequencies" not in fw.modes(fw.Assembly.patch(miura, (2, 2), **terms), eigenvalues=12).summary


def test_terms_are_spelled_out():
    """`help` and notebooks show every term as an argument, and each is described."""
    for make in (fw.Assembly.patch, fw.Assembly.torus, fw.Assembly.screw, fw.Assembly.tube):
        parameters = inspect.signature(make).parameters
        assert {"sheet", "cells", "bars", "creases", "rest", "laws", "mass"} <= set(parameters) and "terms" not in parameters
    terms = list(inspect.signature(fw.Assembly.patch).parameters)[2:]
    assert all(f"            {name}: " in fw.Assembly.patch.__doc__ for name in terms)


def test_every_key_of_every_kind_is_an_argument():
    """The functions of the package have the keys of the schema, no more and no less."""
    schema = fw.schema()
    variants = {}
    for variant in schema["$defs"]["StudySpec"]["oneOf"] if "oneOf" in schema["$defs"]["StudySpec"] else []:
        variants[variant["properties"]["kind"]["const"]] = set(variant["properties"])
    assert set(variants) == set(KINDS)
    for kind in KINDS:
        signature = inspect.signature(getattr(fw, kind))
        arguments = set(signature.parameters) - {"assembly", "name", "draw", "check", "threads", "progress", "must_converge"}
        assert arguments == variants[kind] - {"name", "kind", "draw", "check"}, kind
        of_all = inspect.signature(fw.compute).parameters
        for name in ("name", "draw", "check", "threads", "progress", "must_converge"):
            assert signature.parameters[name] == of_all[name], (kind, name)


def test_arrays_are_views_of_the_memory_of_the_program(soft):
    state = fw.relax(soft).state
    positions, angles = state._inner.addresses()
    for _ in range(2):
        assert state.positions.__array_interface__["data"] == (positions, True)
        assert state.fold_angles.__array_interface__["data"] == (angles, True)
    with pytest.raises(ValueError, match="read-only"):
        state.positions[0, 0] = 1.0
    kept = state.positions
    before = kept.copy()
    del state
    fw.relax(soft)
    assert np.array_equal(kept, before)  # the array keeps the memory alive


def test_values_without_end_are_refused():
    """Values that contain themselves, are very deep, never end or multiply raise, and do not end the interpreter."""

    class Same:
        def tolist(self):
            return self

    def scene():
        return {"sheet": {"generate": {"pattern": "miura"}}, "study": [{"name": "a", "kind": "modes"}]}

    itself = []
    itself.append(itself)
    deep = []
    for _ in range(10_000):
        deep = [deep]
    doubled = [1]
    for _ in range(60):
        doubled = [doubled, doubled]
    around = scene()
    around["x"] = around
    for value in (itself, deep, Same(), around):
        with pytest.raises(fw.SceneError, match="more than 100 dicts and lists within each other"):
            fw.run({**scene(), "x": value})
    for value in (doubled, itertools.count()):
        with pytest.raises(fw.SceneError, match="a scene has at most 10000000 values"):
            fw.run({**scene(), "x": value})
    for value in (10**30, "\ud800"):
        with pytest.raises(fw.SceneError, match="^title: "):
            fw.run({**scene(), "title": value})


def test_a_start_belongs_to_the_same_assembly(miura):
    """A result of another sheet or of other cells is no start, also where it has as many coordinates; other stiffnesses are."""
    make = fw.Assembly.patch
    result = fw.relax(make(miura, (3, 3), bars=1e4, creases=1.0))
    assert fw.relax(make(miura, (3, 3), bars=1e3, creases=2.0), start=result).converged
    eggbox = fw.generate("eggbox")
    assert len(eggbox.vertices) == len(miura.vertices)
    for other in (make(eggbox, (3, 3), bars=1e4, creases=1.0), make(miura, (2, 2), bars=1e4, creases=1.0)):
        with pytest.raises(fw.SceneError, match="the start is a state of another assembly"):
            fw.relax(other, start=result)
    with pytest.raises(fw.SceneError, match="another assembly"):
        fw.relax(fw.Assembly.torus(miura, (3, 3), bars=1e4, creases=1.0), start=result)
