"""Arguments: what they take, what they refuse, and in which words."""

import inspect
import itertools
import re

import foldwell as fw
import numpy as np
import pytest
from conftest import without_times


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
    with pytest.raises(TypeError, match="unexpected keyword argument 'loads'"):
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
    with pytest.raises(fw.SceneError, match=r"^modes.0 has shape \(11,\), expected \(12,\)"):
        fw.landscape(assembly, [rates[:-1]], [0.1])
    with pytest.raises(fw.SceneError, match=r"^modes.0\[\d+\]: `NaN` in column `rate`"):
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
        ({"bar": 1.0}, TypeError, "unexpected keyword argument 'bar'"),
        ({"bars": object()}, TypeError, "a object is no value of a scene"),
        ({"creases": 1.0, "locks": {(0, 9, 0, 0): 1.0}}, fw.SceneError, r"no crease \[0, 9, 0, 0\]"),
        ({"creases": 1.0, "locks": {(0, 1, 0, 0): "sixty"}}, fw.SceneError, "angle"),
        ({"bars": 1.0, "pins": [{"vertex": 99}]}, fw.SceneError, "99"),
    ],
)
def test_wrong_terms_are_refused(miura, terms, error, words):
    with pytest.raises(error, match=words):
        fw.Assembly.patch(miura, (2, 2), **terms)


def test_wrong_scenes_name_key_and_correction(tmp_path):
    """A scene that is a dict has keys, one that is a file has lines."""
    with pytest.raises(fw.SceneError, match="^energy.bars.stifness: unknown key `stifness`") as caught:
        fw.run({"sheet": {"generate": {"pattern": "miura"}}, "energy": {"bars": {"stifness": 1.0}}})
    assert caught.value.help.startswith("did you mean `stiffness`?") and caught.value.line is None
    (tmp_path / "a.toml").write_text("[sheet]\nmash = 3\n")
    with pytest.raises(fw.SceneError, match=r"a\.toml:2:1: unknown key `mash`") as caught:
        fw.run(tmp_path / "a.toml")
    assert (caught.value.line, caught.value.file) == (2, str(tmp_path / "a.toml"))
    with pytest.raises(fw.SceneError, match="nothing to compute"):
        fw.run({"sheet": {"generate": {"pattern": "miura"}}, "study": []})
    with pytest.raises(fw.SceneError, match="no-such"):
        fw.run("no-such.toml")
    with pytest.raises(TypeError, match=r"sheet\.mesh: a object"):
        fw.run({"sheet": {"mesh": object()}})
    with pytest.raises(TypeError, match="keys of a scene are str"):
        fw.run({3: 4})


PINS = [{"vertex": 0}, {"vertex": 1, "axis": "x"}]


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda sheet: fw.relax(sheet), "assembly is a Sheet, expected a foldwell.Assembly, made of the sheet: Assembly.patch"),
        (lambda sheet: fw.relax(3), "assembly is a int, expected"),
        (lambda sheet: fw.relax(fw.Assembly.patch(sheet, bars=1.0), tol=1e-3), r"relax\(\) got an unexpected keyword argument 'tol'"),
        (lambda sheet: fw.relax(fw.Assembly.patch(sheet, bars=1.0), progress="yes"), "progress is 'yes', expected True, False or a function"),
        (lambda sheet: fw.Assembly.patch(sheet, bars="inf"), r"(?s)^bars: .*foldwell\.RIGID"),
        (lambda sheet: fw.Assembly.patch(sheet, bars=-1.0), r"(?s)^bars: the stiffness is -1.*foldwell\.RIGID"),
        (lambda sheet: fw.Assembly.patch(sheet, creases=1.0, rest=60.0), "^rest: "),
        (lambda sheet: fw.Assembly.patch(sheet, bars=1.0, rest_lengths=-2.0), "^rest_lengths: "),
        (lambda sheet: fw.Assembly.patch(sheet, facets=1.0, facet_rest="bent"), "^facet_rest: "),
        (lambda sheet: fw.Assembly.patch(sheet, bars=1.0, laws={"bars": {"kind": "ogdan"}}), "(?s)^laws.bars: .*did you mean `ogden`"),
        (lambda sheet: fw.Assembly.patch(sheet, (0, 2), bars=1.0), "^cells: "),
        (lambda sheet: fw.Assembly.patch(sheet, bars=1.0, pins=PINS), "(?s)^pins.1.axis: .*did you mean `axes`"),
        (lambda sheet: fw.relax(fw.Assembly.patch(sheet, bars=1.0), tolerance=-1.0), "^tolerance: "),
        (lambda sheet: fw.path(fw.Assembly.patch(sheet, bars=1.0, creases=1.0)), "(?s)a path follows a drive.*add a `drive`"),
        (lambda sheet: fw.modes(fw.Assembly.patch(sheet, bars=1.0), check=["self_intersektion"]), "(?s)^check.0: .*did you mean"),
        (lambda sheet: fw.modes(fw.Assembly.patch(sheet, bars=1.0), draw="vtk"), r"draw is 'vtk', expected a list such as \['vtk'\]"),
        (lambda sheet: fw.Assembly.patch(sheet, 3, bars=1.0), "(?s)^cells: .*expected a list$"),
        (lambda sheet: fw.Assembly.patch(sheet, creases="stiff"), r'(?s)^creases: .*\{ "M": 1.0, "V": 2.0, .. \} or an array$'),
        (lambda sheet: fw.Assembly.patch(sheet, bars=1.0, laws=3), "laws is 3, expected a dict by terms"),
        (lambda sheet: fw.Assembly.patch(sheet, bars=1.0, locks=5), "locks is 5, expected lists of the numbers of a crease"),
        (lambda sheet: fw.Assembly.patch(sheet, creases=1.0, laws={"creases": len}), "a law is .*formula.*table.*with_term"),
        (lambda sheet: fw.Sheet.read(3), "source is 3, expected a path or an open text file"),
        (lambda sheet: fw.Sheet.read(""), "source is '', expected a path"),
        (lambda sheet: fw.generate("miura", a=-1), r"(?s)`a` is -1; .*foldwell\.pattern_help"),
        (lambda sheet: fw.sweep({"sheet": {"generate": {"pattern": "miura"}}}), "the scene has no `sweep`"),
        (lambda sheet: fw.modes(fw.Assembly.patch(sheet, bars=1.0), eigenvalues=10**9), "too many for a model of 12 coordinates"),
        (lambda sheet: fw.relax(fw.Assembly.patch(sheet, (2, 2))), "there is no energy to relax"),
    ],
)
def test_messages_are_in_the_words_of_python(miura, call, words):
    """Messages name arguments; none names a place in a text that the caller has not written, tables of TOML or commands."""
    with pytest.raises((TypeError, fw.SceneError), match=words) as caught:
        call(miura)
    said = str(caught.value)
    assert not re.search(r"\[\[|:\d+:\d+|`foldwell |--\w|\bset-up\b", said), said


def test_numbers_that_count_something_are_checked(miura):
    """Numbers of threads and frames are refused by name where they are negative, zero threads or no whole numbers."""
    soft, scene = fw.Assembly.patch(miura, bars=1.0), {"sheet": {"generate": {"pattern": "miura"}}}
    for threads, error, words in [(-1, ValueError, "threads is -1, expected 1 or more"), (0, ValueError, "threads is 0"), (1.5, TypeError, "threads is 1.5")]:
        for work in (lambda n: fw.relax(soft, threads=n), lambda n: fw.run(scene, threads=n), lambda n: fw.sweep(scene, threads=n)):
            with pytest.raises(error, match=words):
                work(threads)
    for work in (lambda: fw.Sheet.read("meshes/crane.fold", frame=-1), lambda: fw.convert("meshes/crane.fold", "a.obj", frame=-1)):
        with pytest.raises(ValueError, match="frame is -1, expected 0 or more"):
            work()


def test_the_package_shows_its_names_only():
    assert sorted(dir(fw)) == sorted(fw.__all__) and all(hasattr(fw, name) for name in fw.__all__)


def test_arrays_in_scenes_are_those_of_arguments(miura, tmp_path):
    """Arrays in the dict of a scene, of any kind and with an output folder too, are the arrays of `Assembly.patch`."""
    count = len(miura.edges)
    rest = np.where(miura.kinds == "crease", np.linspace(0.1, 0.4, count), 0.0)
    stiff, rates = np.arange(1.0, count + 1), np.where(miura.kinds == "crease", 1.0, 0.0)
    pins = [{"vertex": k} for k in range(3)]
    forces = np.zeros((16, 3))
    forces[15, 2] = 1e-3
    assembly = fw.Assembly.patch(miura, (2, 2), bars=1e3, creases=stiff, rest=rest, facets=5.0, pins=pins, loads=forces)
    scene = {
        "sheet": {"generate": {"pattern": "miura"}, "cells": np.array([2, 2])},
        "energy": {"bars": {"stiffness": 1e3}, "creases": {"stiffness": stiff, "rest": rest.tolist()}, "facets": {"stiffness": 5.0}},
        "pin": pins,
        "load": forces,
        "study": [{"name": "relax", "kind": "relax"}],
    }
    expected = fw.relax(assembly)
    for run in (fw.run(scene), fw.run(scene, out=tmp_path / "a"), fw.run(scene, set={"study.relax.draw": ["vtk"]})):
        assert without_times(run["relax"].summary) == without_times(expected.summary)
    assert fw.relax(fw.Assembly.from_scene(scene)).summary["energy"] == expected.summary["energy"]
    # other numbers are another scene: nothing is kept
    again = fw.run(scene, out=tmp_path / "a", resume=True)
    assert "relax" not in again
    scene["energy"]["creases"]["rest"] = 1.1 * rest
    assert "relax" in fw.run(scene, out=tmp_path / "a", resume=True)
    with pytest.raises(fw.SceneError, match=r"^energy.creases.rest has shape \(3,\)"):
        fw.run({**scene, "energy": {"creases": {"stiffness": 1.0, "rest": rest[:3]}}, "load": None})
    bent = {"sheet": scene["sheet"], "energy": {"bars": {"stiffness": 1e3}, "creases": {"stiffness": 1.0, "rest": {"mode": rates, "amplitude": 0.1}}}}
    bent["study"] = [{"name": "cost", "kind": "landscape", "modes": [rates, [1.0, 0.0, 0.0]], "amplitudes": np.array([0.1])}]
    with pytest.raises(fw.SceneError, match="^study.0.modes.0 has shape"):
        fw.run({**bent, "study": [{**bent["study"][0], "modes": [rates[1:]]}]})


def test_terms_are_spelled_out():
    """`help` and notebooks show every term as an argument, and each is described."""
    for make in (fw.Assembly.patch, fw.Assembly.torus, fw.Assembly.screw, fw.Assembly.tube):
        parameters = inspect.signature(make).parameters
        assert {"sheet", "cells", "bars", "creases", "rest", "laws", "mass"} <= set(parameters) and "terms" not in parameters
        assert all(parameter.kind is not parameter.VAR_KEYWORD for parameter in parameters.values())
    terms = list(inspect.signature(fw.Assembly.patch).parameters)[2:]
    assert all(f"            {name}: " in fw.Assembly.patch.__doc__ for name in terms)


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
        with pytest.raises(fw.SceneError, match="a scene has at most 2000000 values"):
            fw.run({**scene(), "x": value})
    for value in (10**30, "\ud800"):
        with pytest.raises(fw.SceneError, match="^title: "):
            fw.run({**scene(), "title": value})
    assembly = fw.Assembly.patch(fw.generate("miura"), bars=1e3, creases=1.0)
    endless = {
        "faces": lambda: fw.Sheet.from_arrays(np.eye(3), itertools.repeat((0, 1, 2))),
        r"faces\[0\]": lambda: fw.Sheet.from_arrays(np.eye(3), [itertools.count()]),
        "letters": lambda: fw.Sheet.from_arrays(np.eye(3), [(0, 1, 2)], letters=itertools.repeat("M")),
        "draw": lambda: fw.relax(assembly, draw=itertools.repeat("vtk")),
    }
    for name, call in endless.items():
        with pytest.raises(ValueError, match=f"{name} has more than 2000000 entries"):
            call()
    with pytest.raises(TypeError, match="is of no term, expected bars, creases or facets"):
        fw.Assembly.patch(fw.generate("miura"), bars=1e3, laws={"crease": {"kind": "linear"}})
