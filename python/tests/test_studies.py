"""Studies, their results, and the same numbers as the program's."""

import csv
import inspect
import json
import pickle
import subprocess

import foldwell as fw
import numpy as np
import pytest
import pyvista
from conftest import ROOT, without_times

#: Scenes of every kind of study and of every kind of boundary condition.
SCENES = [
    *("star", "star-torus", "star-trace", "star-landscape", "star-surface"),
    *("flat-branches", "miura-spectrum", "miura-frequencies", "kirigami-bloch", "near-cross-wells", "two-bars-push", "drum-path", "degree-four"),
]
KINDS = ["bloch", "branches", "fold", "landscape", "modes", "path", "relax", "response", "surface", "trace", "wells"]


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
    assert run.converged and list(run) == [study["name"] for study in run.summary["studies"]]
    for file in (tmp_path / "a").rglob("*.csv"):
        assert file.read_bytes() == (tmp_path / "b" / file.relative_to(tmp_path / "a")).read_bytes()
    alone = fw.run(path)
    for name, result in run.items():
        assert without_times(result.summary) == without_times(alone[name].summary)
        for file in result.save(tmp_path / "c"):
            assert file.read_bytes() == (tmp_path / "b" / file.relative_to(tmp_path / "c")).read_bytes()
    again = fw.run(path, out=tmp_path / "b", resume=True)
    for name, words in [(next(iter(run)), "kept from an earlier run"), ("nobody", "there is no such study; there are")]:
        with pytest.raises(KeyError, match=words):
            again[name]
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
    assert land.plot().get_xscale() == land.plot().get_yscale() == "log"
    assert mesh.active_scalars_name == "fold_angle"


def test_plots_say_what_they_show(miura):
    """A path has words for what is driven, marks at events and dashes where it is not stable; a trace has both directions on their own
    sides of the drawn state; states draw themselves, also where a study made no drawing."""
    pins = [{"vertex": 0, "axes": "xyz"}, {"vertex": 2, "axes": "xyz"}, {"vertex": 1, "axes": "xy"}]
    loads, drives = [{"vertex": 1, "force": (0.0, 0.0, -0.02)}], [{"name": "push", "load": True, "to": 1.0}]
    truss = fw.Assembly.patch(fw.generate("truss"), bars=1.0, pins=pins, loads=loads, drives=drives)
    bars = fw.Sheet.from_arrays([(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (2.0, 0.0, 0.5)], [], edges=[(0, 1), (1, 2)])
    assert bars.plot() is not None
    axes = fw.path(truss).plot()
    assert (axes.get_xlabel(), axes.get_title()) == ("factor of the loads", "push: displacement of the loads against factor of the loads")
    assert {line.get_linestyle() for line in axes.lines} >= {"-", "--"}
    assert "limit-load" in {text.get_text() for text in axes.get_legend().get_texts()}
    star = fw.Sheet.read(ROOT / "meshes/open-star.fold")
    traced = fw.trace(fw.Assembly.screw(star, bars=fw.RIGID, creases=1.0, locks=[(0, 1, -1, 0)]), stop={"arc_length": 0.5})
    ends = [line.get_xdata() for line in traced.plot().lines]
    assert all((x >= 0.0).all() or (x <= 0.0).all() for x in ends) and any(x.min() < 0.0 for x in ends)
    base = fw.Assembly.patch(fw.Sheet.read(ROOT / "meshes/waterbomb-base.fold"), bars=1e3, creases=1.0, facets=10.0, rest="assigned")
    folded = fw.fold(base)
    assert folded.kind == "fold" and folded.table["drive"][-1] == 1.0 and folded.plot().get_ylabel() == "energy"
    assert folded._repr_svg_().startswith("<svg") and folded._repr_svg_() == folded.state._repr_svg_()


def test_axes_have_the_units_that_the_assembly_names():
    units = {"length": "mm", "force": "N"}
    star = fw.Sheet.read(ROOT / "meshes/open-star.fold")
    land = fw.landscape(fw.Assembly.patch(star, (3, 3), bars=fw.RIGID, creases=1.0, units=units), [(1, 0, 0)], [0.1, 0.05])
    assert land.plot().get_ylabel() == "energy (N mm)"
    held = {"pins": [{"vertices": [0, 1]}, {"vertex": 2, "axes": "xy"}], "drives": [{"name": "push", "vertices": [2], "axis": "z", "to": -0.1}]}
    path = fw.path(fw.Assembly.patch(fw.generate("truss"), bars=1.0, units=units, **held), drive="push")
    assert (path.plot().get_xlabel(), path.plot().get_ylabel()) == ("displacement (mm)", "force (N)")


def test_paths_of_an_array_of_forces_are_drawn_as_such():
    loads = np.array([[0, 0, 0], [0, 0, 0], [0, 0, -1e-3]])
    held = {"pins": [{"vertices": [0, 1]}, {"vertex": 2, "axes": "xy"}], "drives": [{"name": "push", "load": True, "to": 1.0}]}
    path = fw.path(fw.Assembly.patch(fw.generate("truss"), bars=1.0, loads=loads, **held), drive="push", draw=["svg"])
    assert "factor of the loads" in path._repr_svg_() and "pressure" not in path._repr_svg_()


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
    assert set(data.coords) == {"edge", "branch", "sign", "step", "state"} and np.array_equal(data.step, traced.table["step"])
    assert data.arc_length.attrs == {"long_name": "arc length of the fold angles", "units": "rad"}
    assert all(variable.attrs["long_name"] for name, variable in data.variables.items() if name != "edge")
    land = fw.landscape(fw.Assembly.patch(star, (3, 3), bars=fw.RIGID, creases=1.0), [(1, 0, 0), (0, 1, 0), (1, 1, 0)], [0.1, 0.05])
    energy = land.to_xarray().energy_total
    assert energy.dims == ("mode", "amplitude") and energy.amplitude.values.tolist() == [0.05, 0.1]
    assert energy.sel(mode=energy.mode[2], amplitude=0.05) == land.table["energy_total"][4]
    assert "fold_angle" not in fw.modes(fw.Assembly.patch(star, bars=1.0, creases=1.0), eigenvalues=3).to_xarray()


def test_what_a_result_lacks_is_said(miura, soft):
    """Names of columns, plots of studies without curves and states; a start may have the name of the study that follows it."""
    first = fw.relax(soft, name="start")
    assert fw.relax(soft, start=first, name="start").summary["iterations"] == 0
    with pytest.raises(KeyError, match="foo: there is no such column; there are .*energy_total"):
        first.table["foo"]
    waves = fw.bloch(fw.Assembly.torus(fw.Sheet.read(ROOT / "meshes/open-star.fold")), grid=(8, 8), q1=[0.5])
    with pytest.raises(ValueError, match="this study of kind bloch has neither curves nor states to plot"):
        waves.plot()
    folded = fw.fold(fw.Assembly.patch(miura, (2, 2), bars=1e3, creases=1.0, rest=0.9))
    assert folded.to_xarray().arc_length.attrs == {"long_name": "arc length of the path"}
    assert fw.schema("sweep")["title"] == "foldwell sweep"


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
        implied = {"drive"} if kind == "fold" else set()  # what is folded is not driven by anything else
        assert arguments == variants[kind] - {"name", "kind", "draw", "check"} - implied, kind
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


def test_a_start_may_have_other_locks_and_drives():
    """A state found with a lock, or along a path, is one of the assembly without; the ratio is that of the sheet drawn there."""
    edge = (0, 1, 0, 0)
    drawn = fw.Assembly.torus(fw.generate("miura", fold=0.36), bars=fw.RIGID, creases=1.0, facets=2.0)
    at = fw.response(drawn).summary["poisson"]["in_plane"]
    miura = fw.generate("miura", fold=0.3)
    free = fw.Assembly.torus(miura, bars=fw.RIGID, creases=1.0, facets=2.0)
    locked = fw.Assembly.torus(miura, bars=fw.RIGID, creases=1.0, facets=2.0, locks={edge: 0.72})
    held = fw.relax(locked)
    assert fw.response(free, start=held).summary["poisson"]["in_plane"] == pytest.approx(at, rel=1e-9)
    back = fw.relax(free, start=held)
    assert back.summary["energy"]["total"] < 1e-12 < held.summary["energy"]["total"]
    assert fw.relax(locked, start=back).summary["energy"]["total"] == pytest.approx(held.summary["energy"]["total"], rel=1e-9)
    drives = [{"name": "angle", "lock": edge, "to": 0.72}]
    begun = {edge: float(free.drawn.fold_angles[list(map(tuple, miura.edges)).index(edge)])}
    driven = fw.path(fw.Assembly.torus(miura, bars=fw.RIGID, creases=1.0, facets=2.0, locks=begun, drives=drives))
    assert fw.response(free, start=driven).summary["poisson"]["in_plane"] == pytest.approx(at, rel=1e-9)
    waves = fw.bloch(free, grid=(8, 8), q1=[0.5])
    with pytest.raises(fw.SceneError, match="a study that ended in no state"):
        fw.relax(free, start=waves)


def test_words_stay_words_without_an_event(soft):
    """The column of events is one of texts in a path without any, in the table and in xarray."""
    pytest.importorskip("xarray")
    folded = fw.fold(soft)
    assert not folded.summary["branches"][0]["events"]
    for found in (folded.table["event"], folded.to_xarray()["event"].values):
        assert found.dtype.kind == "U" and set(found) == {""}


def test_barriers_are_pairs(soft):
    with pytest.raises(ValueError, match=r"barriers has shape \(\) and type bool, expected .* pairs of wells such as \[\(0, 1\)\]"):
        fw.wells(soft, barriers=True)
