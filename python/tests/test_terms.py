"""Terms whose energy is a function in Python."""

import pickle

import foldwell as fw
import numpy as np
import pytest

STRENGTH = 0.05


def poles(points):
    """Two like poles: STRENGTH over their distance, with gradient and Hessian."""
    along = points[1] - points[0]
    near = 1.0 / np.linalg.norm(along)
    block = STRENGTH * (3.0 * near**5 * np.outer(along, along) - near**3 * np.eye(3))
    force = STRENGTH * near**3 * along
    return STRENGTH * near, [force, -force], np.block([[block, -block], [-block, block]])


def dipoles(points):
    """Two magnets, each with a pole at either end: the first two points, and the others."""
    energy, gradient, hessian = 0.0, np.zeros((4, 3)), np.zeros((4, 3, 4, 3))
    for a, b, sign in [(0, 2, 1), (1, 3, 1), (0, 3, -1), (1, 2, -1)]:
        of, [force, _], block = poles(points[[a, b]])
        energy += sign * of
        gradient[a] += sign * force
        gradient[b] -= sign * force
        block = block.reshape(2, 3, 2, 3)
        for i, j in [(0, 0), (0, 1), (1, 0), (1, 1)]:
            hessian[(a, b)[i], :, (a, b)[j]] += sign * block[i, :, j]
    return energy, gradient, hessian.reshape(12, 12)


def test_dipoles_are_a_term(soft):
    """Far apart they have the energy `(m n - 3 (m e) (n e)) / r^3` of two dipoles, and a sheet with two of them relaxes."""
    m, n, along = 1e-3 * np.array([[0.3, -0.5, 0.8], [0.6, 0.7, -0.2], [1000.0, 2000.0, -500.0]])
    r = np.linalg.norm(along)
    expected = STRENGTH * (m @ n - 3.0 * (m @ along) * (n @ along) / r**2) / r**3
    assert dipoles(np.array([m / 2, -m / 2, along + n / 2, along - n / 2]))[0] == pytest.approx(expected, rel=1e-5)
    magnets = soft.with_term("magnets", [[0, 1, 12, 13]], dipoles)
    found = fw.relax(magnets)
    own = dipoles(found.state.positions[[0, 1, 12, 13]])[0]
    assert found.converged and found.summary["energy"]["magnets"] == pytest.approx(own, rel=1e-12)


@pytest.fixture
def magnets(soft):
    """Poles on two pairs of vertices of nine cells."""
    return soft.with_term("magnets", [[0, 12], [5, 30]], poles)


def test_its_energy_and_derivatives_are_those_of_the_function(soft, magnets):
    x = soft.start + 1e-2 * np.random.default_rng(3).standard_normal(len(soft.start))
    points = x.reshape(-1, 3)
    own = sum(poles(points[pair])[0] for pair in ([0, 12], [5, 30]))
    assert magnets.energy(x) - soft.energy(x) == pytest.approx(own, rel=1e-9)
    step = 1e-5
    for function, derivative in [(magnets.energy, magnets.gradient(x)), (magnets.gradient, magnets.hessian(x).toarray())]:
        differences = np.array([(function(x + step * e) - function(x - step * e)) / (2.0 * step) for e in np.eye(len(x))])
        assert np.abs(differences - derivative).max() < 1e-6 * np.abs(derivative).max()


def test_studies_know_it(soft, magnets):
    """Relaxations push the poles apart, list the energy by name, and are equilibria; wells and paths go on as before."""
    without, found = fw.relax(soft), fw.relax(magnets)
    distance = [np.linalg.norm(result.state.positions[12] - result.state.positions[0]) for result in (without, found)]
    assert distance[1] > distance[0] + 1e-4
    points = found.state.positions
    assert found.summary["energy"]["magnets"] == pytest.approx(sum(poles(points[p])[0] for p in ([0, 12], [5, 30])), rel=1e-12)
    assert found.table["energy_magnets"][-1] == found.summary["energy"]["magnets"]
    assert np.abs(magnets.gradient(magnets.unknowns(found))).max() < 1e-8
    assert fw.relax(magnets, start=found).summary["iterations"] == 0
    assert np.array_equal(fw.relax(magnets, threads=1).state.positions, points)
    assert fw.wells(magnets, starts=2, threads=2).summary["wells"]
    miura = fw.generate("miura")
    driven = fw.Assembly.patch(miura, (2, 2), bars=1e2, creases=1.0, rest=0.5, drives=[{"name": "fold", "rest": True, "to": 1.0}])
    followed = fw.path(driven.with_term("magnets", [[0, 12]], poles))
    assert np.isfinite(followed.table["energy_magnets"]).all() and (followed.table["energy_magnets"] > 0.0).all()


def test_energies_that_are_no_numbers_are_refused(soft):
    """A term that has none as drawn is refused by name; one that has none on the way ends a path before it."""

    def nothing(points):
        return np.nan, np.zeros((2, 3)), np.zeros((6, 6))

    with pytest.raises(ValueError, match=r"energy of `magnets` at the vertices \[0, 12\] is not a number"):
        soft.with_term("magnets", [[0, 12]], nothing)
    pins = [{"vertex": 0}, {"vertex": 2}, {"vertex": 1, "axes": "y"}]
    drives = [{"name": "d", "vertices": [1], "axis": "z", "to": -0.6}]
    truss = fw.Assembly.patch(fw.generate("truss"), bars=1.0, pins=pins, drives=drives)
    followed = fw.path(truss.with_term("magnets", [[0, 1]], lambda p: poles(p) if p[1, 2] > -0.05 else nothing(p)), must_converge=False)
    assert not followed.converged and np.isfinite(followed.table["energy_total"]).all()


def test_it_is_pickled_if_its_function_is(magnets):
    x = magnets.start + 1e-2
    assert pickle.loads(pickle.dumps(magnets)).energy(x) == magnets.energy(x)
    with pytest.raises((AttributeError, pickle.PicklingError)):
        pickle.dumps(magnets.with_term("other", [[0]], lambda points: (0.0, np.zeros(3), np.zeros((3, 3)))))


def test_what_is_wrong_with_it_is_said(soft, magnets, miura):
    def fails(points):
        raise ZeroDivisionError("in the function")

    for work in (fw.relax, lambda assembly: assembly.energy(assembly.start), lambda assembly: assembly.drawn):
        with pytest.raises(ZeroDivisionError, match="in the function"):
            work(soft.with_term("wrong", [[0, 1]], fails))
    for wrong, words in [((1.0, np.zeros(5), np.zeros(36)), r"gradient of wrong has shape \(5,\)"), ((1.0, np.zeros(6), [["a"]]), "real numbers")]:
        with pytest.raises((ValueError, TypeError), match=words):
            fw.relax(soft.with_term("wrong", [[0, 1]], lambda points, wrong=wrong: wrong))
    for name, vertices, words in [
        ("magnets", [[0, 1]], "already"),
        ("creases", [[0, 1]], "already"),
        ("far", [[0, 99]], "names vertex 99"),
        ("many", [list(range(7))], "1 to 6"),
        ("flat", [0, 1], r"vertices\[0\] is 0, expected a list of vertex numbers"),
        ("halves", [[0.0, 1.0]], r"vertices\[0\] is \[0.0, 1.0\], expected a list of vertex numbers"),
        ("ragged", [[0, 1], [2]], r"vertices\[1\] is \[2\], expected different numbers, .* as many as"),
        ("twice", [[4, 4]], "expected different numbers"),
        ("none", [], "vertices is empty"),
        ("a b", [[0, 1]], "name is 'a b', expected letters"),
        ("before", [[0, -1]], r"vertices\[0\] is \[0, -1\], expected different numbers, 0 or more"),
    ]:
        with pytest.raises(ValueError, match=words):
            magnets.with_term(name, vertices, poles)
    with pytest.raises(TypeError, match="energy is 3, expected a function"):
        soft.with_term("number", [[0, 1]], 3)
    with pytest.raises(TypeError, match="the function of one returned a float, expected energy, gradient and Hessian"):
        soft.with_term("one", [[0, 1]], lambda points: 1.0)
    with pytest.raises(fw.SceneError, match="patches"):
        fw.Assembly.torus(miura, bars=1.0).with_term("magnets", [[0, 1]], poles)
    with pytest.raises(fw.SceneError, match="studies of kind landscape do not know the term `magnets`"):
        fw.landscape(magnets, [(1.0, 0.0, 0.0)], [0.1])


def test_wrong_derivatives_are_refused_by_name(soft):
    """A gradient without a factor, a Hessian with a wrong sign, in all elements; what is only rough is taken."""

    def wrong(points, gradient=1.0, hessian=1.0):
        value, force, stiffness = poles(points)
        return value, gradient * np.ravel(force), hessian * stiffness

    with pytest.raises(fw.SceneError, match="the gradient of `half` is wrong"):
        soft.with_term("half", [[0, 12]], lambda points: wrong(points, gradient=0.5))
    with pytest.raises(fw.SceneError, match="the Hessian of `turned` is wrong"):
        soft.with_term("turned", [[0, 12]], lambda points: wrong(points, hessian=-1.0))
    with pytest.raises(fw.SceneError, match="the gradient of `upper` is wrong"):
        soft.with_term("upper", [[0]], lambda points: (points[0, 2] ** 3, [0, 0, points[0, 2] ** 2], np.diag([0, 0, 2 * points[0, 2]])))
    single = soft.with_term("single", [[0, 12]], lambda points: poles(np.float32(points)))
    assert fw.relax(single, must_converge=False).summary["energy"]["single"] > 0.0


def spring(stiffness, rest):
    """A spring between two vertices, as `springs` has it."""

    def energy(points):
        along = points[1] - points[0]
        length = np.linalg.norm(along)
        unit = along / length
        block = stiffness * np.outer(unit, unit) + stiffness * (1.0 - rest / length) * (np.eye(3) - np.outer(unit, unit))
        pull = stiffness * (length - rest) * unit
        return 0.5 * stiffness * (length - rest) ** 2, [-pull, pull], np.block([[block, -block], [-block, block]])

    return energy


def test_relaxations_know_its_curvature():
    """Strong springs from a stiff sheet's corner to another, as terms: each relaxes in at most 60 steps, and one of `springs` from there
    has the same energy. Source: the springs of the program."""
    sheet, rng = fw.generate("miura", fold=0.5), np.random.default_rng(3)
    for _ in range(12):
        cells, thickness, stiffness, rest = int(rng.integers(2, 4)), 10 ** rng.uniform(-2, -0.5), 10 ** rng.uniform(-1, 1), rng.uniform(0.5, 2)
        material = {"young": 1400.0, "poisson": 0.3, "thickness": thickness, "crease_length": 20.0}
        terms = {"material": material, "rest": 0.2}
        last = 4 * cells * cells - 3
        term = fw.Assembly.patch(sheet, (cells, cells), **terms).with_term("own", [[0, last]], spring(stiffness, rest))
        ends = [0, (1, cells - 1, cells - 1)]
        springs = fw.Assembly.patch(sheet, (cells, cells), **terms, springs=[{"vertices": ends, "stiffness": stiffness, "rest": rest}])
        found = fw.relax(term)
        assert found.summary["iterations"] <= 60
        again = fw.relax(springs, start=found)
        assert again.summary["energy"]["total"] == pytest.approx(found.summary["energy"]["total"], rel=1e-9)


def test_what_pulls_a_free_sheet_is_refused(soft):
    """A field, a pull at one vertex and one that turns an edge have no equilibrium on a free sheet, and have one on a pinned one."""

    def field(points):
        return points[0, 2], [0.0, 0.0, 1.0], np.zeros((3, 3))

    def turning(points):
        along = points[1] - points[0]
        return along[2], [0.0, 0.0, -1.0, 0.0, 0.0, 1.0], np.zeros((6, 6))

    for function, vertices, how in [(field, [[5]], "moves along z"), (turning, [[0, 12]], "turns about")]:
        with pytest.raises(fw.SceneError, match=f"the energy of the term `pull` changes where the sheet {how}"):
            fw.relax(soft.with_term("pull", vertices, function))
        pins = [{"vertex": vertex} for vertex in range(3)]
        pinned = fw.Assembly.patch(fw.generate("miura"), (3, 3), bars=1e3, creases=1.0, facets=10.0, pins=pins).with_term("pull", vertices, function)
        assert np.abs(pinned.gradient(pinned.unknowns(fw.relax(pinned)))).max() < 1e-8
