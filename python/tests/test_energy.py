"""The energy, its derivatives, lengths, angles and closure, against finite differences and other programs."""

import foldwell as fw
import numpy as np
import pytest
from conftest import ROOT
from scipy.optimize import minimize
from scipy.sparse import issparse

#: Step of central differences of numbers of order 1: the error is about `step^2 + 1e-16 / step`, 1e-10.
STEP = 1e-5


def differences(function, x):
    """Returns the derivative of a function by central differences, a column for each unknown."""
    columns = []
    for k in range(len(x)):
        there, back = x.copy(), x.copy()
        there[k] += STEP
        back[k] -= STEP
        columns.append((function(there) - function(back)) / (there[k] - back[k]))
    return np.stack(columns, axis=-1)


def assemblies():
    """Yields assemblies of every kind of boundary condition and term, with a name."""
    miura, star = fw.generate("miura"), fw.generate("random", seed=3)
    terms = {"bars": 1e2, "creases": 1.3, "facets": 2.0, "rest": 0.3}
    yield "patch", fw.Assembly.patch(miura, (2, 2), **terms)
    yield "torus", fw.Assembly.torus(miura, (2, 1), **terms)
    yield "fixed torus", fw.Assembly.torus(miura, (1, 2), lattice="fixed", **terms)
    yield "screw", fw.Assembly.screw(star, bars=1e2, creases=1.0, rest=0.3)
    yield "tube", fw.Assembly.tube(fw.Sheet.read(ROOT / "meshes/kresling-cell.fold"), (6, 0), bars=1e2, creases=1.0, rest="flat")
    pins = [{"vertex": 0, "axes": "xyz"}, {"vertex": 1, "axes": "yz"}]
    loads = [{"vertex": 3, "cell": (1, 1), "force": (0.0, 0.1, -0.2)}]
    held = [*pins, {"vertex": 2, "axes": "z"}]
    yield "pins and loads", fw.Assembly.patch(miura, (2, 2), pins=held, loads=loads, **terms)
    drum = fw.generate("kresling", closed=True)
    yield "pressure", fw.Assembly.patch(drum, pressures=[{"value": 0.3}], loads=[{"weight": (0, 0.02, -0.1)}], mass={"area": 1.0}, pins=held, **terms)
    laws = {"bars": {"kind": "ogden", "exponents": [5.0, 1.0]}, "creases": {"kind": "stiffening", "limits": [-0.9, "40 deg"]}}
    springs = [{"vertices": [0, (3, 1, 1)], "stiffness": 2.0}, {"vertices": [1, 2], "stiffness": 3.0, "rest": 0.7}]
    yield "laws and springs", fw.Assembly.patch(miura, (2, 2), laws=laws, springs=springs, **terms)
    curve = {"kind": "table", "points": [[-0.1, -0.2], [0.0, 0.0], [0.02, 0.02], [0.1, 0.12]]}
    laws = {"bars": curve, "creases": {"kind": "formula", "torque": "k*sinh(2*(m - m0))/2"}}
    yield "curves and formulas", fw.Assembly.patch(miura, (2, 2), laws=laws, **terms)
    yields = {"creases": {"moment": 0.05, "hardening": 0.2}, "bars": {"force": 0.5, "hardening": 0.1, "isotropic": 0.5}}
    yield "what yields", fw.Assembly.patch(miura, (2, 2), yields=yields, **terms)
    yield "rigid bars", fw.Assembly.patch(miura, (2, 2), bars=fw.RIGID, creases=1.0, rest="flat")


CASES = dict(assemblies())


@pytest.fixture(params=CASES.items(), ids=CASES)
def case(request):
    """An assembly at unknowns near the drawn state."""
    assembly = request.param[1]
    random = np.random.default_rng(5)
    return assembly, assembly.start + 1e-2 * random.standard_normal(len(assembly.start))


def test_gradient_and_hessian_are_derivatives_entry_by_entry(case):
    assembly, x = case
    gradient, hessian = assembly.gradient(x), assembly.hessian(x)
    assert issparse(hessian) and hessian.shape == (len(x), len(x))
    size = abs(hessian).max()  # of the derivatives, which the differences lose in part
    assert np.abs(gradient - differences(assembly.energy, x)).max() < 1e-8 * size
    assert np.abs(hessian.toarray() - differences(assembly.gradient, x)).max() < 1e-6 * size
    assert abs(hessian - hessian.T).max() == 0.0


def test_lengths_angles_and_constraints_have_their_derivatives(case):
    assembly, x = case
    for function, derivative in [
        (assembly.lengths, assembly.lengths_jacobian),
        (assembly.fold_angles, assembly.fold_angles_jacobian),
        (assembly.constraints, assembly.constraint_jacobian),
    ]:
        expected = differences(function, x)
        found = derivative(x).toarray()
        assert found.shape == expected.shape
        known = ~np.isnan(expected)
        # angles turn up to a hundred times faster than points of small triangles move
        assert np.abs(found - expected)[known].max(initial=0.0) < 1e-6
        assert (found[~known] == 0.0).all()


def test_measures_are_those_of_the_state(soft):
    x = soft.start + 1e-2 * np.random.default_rng(1).standard_normal(len(soft.start))
    state = soft.state(x)
    assert np.array_equal(state.positions, x.reshape(-1, 3))
    ends = state.positions[state.edges]
    lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    assert np.abs(lengths - soft.lengths(x)).max() < 1e-14
    angles = soft.fold_angles(x)
    assert np.array_equal(np.isnan(angles), soft.kinds == "boundary")
    inner = ~np.isnan(angles)
    assert np.abs(state.fold_angles - angles)[inner].max() < 1e-14
    assert state.energies.sum() == pytest.approx(soft.energy(x), rel=1e-13)


def test_energy_is_the_formula_of_the_book(soft):
    """The energy from lengths and angles alone: bars EA L e^2 / 2, hinges k L (angle - rest)^2 / 2."""
    x = soft.start + 1e-2 * np.random.default_rng(2).standard_normal(len(soft.start))
    rest = soft.lengths(soft.start)
    bars = 0.5 * 1e2 * rest * (soft.lengths(x) / rest - 1.0) ** 2
    angles, drawn = soft.fold_angles(x), soft.fold_angles(soft.start)
    creases = 0.5 * 1.0 * rest * (angles - 0.5) ** 2
    facets = 0.5 * 3.0 * rest * (angles - drawn) ** 2
    kinds = soft.kinds
    total = bars.sum() + creases[kinds == "crease"].sum() + facets[kinds == "facet"].sum()
    assert soft.energy(x) == pytest.approx(total, rel=1e-13)


def test_an_optimizer_of_scipy_reaches_the_same_minimum(soft):
    relaxed = fw.relax(soft)
    start = soft.start + 1e-3 * np.random.default_rng(7).standard_normal(len(soft.start))
    found = minimize(
        soft.energy, start, jac=soft.gradient, hess=lambda x: soft.hessian(x).toarray(), method="trust-exact",
        options={"gtol": 1e-9, "maxiter": 500},
    )
    # both have gradients below 1e-9, and the energy is quadratic in them
    assert found.fun == pytest.approx(relaxed.summary["energy"]["total"], rel=1e-12)
    lengths = soft.lengths(soft.unknowns(relaxed))
    assert np.abs(soft.lengths(found.x) - lengths).max() < 1e-8
    assert np.abs(soft.gradient(soft.unknowns(relaxed))).max() < 1e-8


def test_an_equilibrium_with_rigid_bars_is_a_constrained_one():
    """With rigid bars the gradient is balanced by the constraints: it lies in the span of their derivatives."""
    sheet = fw.generate("random", seed=1)
    assembly = fw.Assembly.patch(sheet, (2, 2), bars=fw.RIGID, creases=1.0, rest=0.2)
    relaxed = fw.relax(assembly, start={"random": 1e-3, "seed": 1})
    x = assembly.unknowns(relaxed)
    assert np.abs(assembly.constraints(x)).max() < 1e-12
    jacobian = assembly.constraint_jacobian(x).toarray()
    gradient = assembly.gradient(x)
    tension = np.linalg.lstsq(jacobian.T, -gradient, rcond=None)[0]
    assert np.abs(jacobian.T @ tension + gradient).max() < 1e-8 * np.abs(gradient).max()


def test_closure_is_zero_where_a_sheet_folds_rigidly():
    sheet = fw.generate("random", seed=4)
    assembly = fw.Assembly.screw(sheet, bars=fw.RIGID, creases=1.0)
    rho = sheet.fold_angles
    residual, jacobian = assembly.closure(rho)
    assert np.abs(residual).max() < 1e-14 and jacobian.shape == (len(residual), len(rho))
    off = rho + 1e-2 * np.random.default_rng(0).standard_normal(len(rho))
    residual, jacobian = assembly.closure(off)
    assert np.abs(residual).max() > 1e-3
    assert np.abs(jacobian - differences(lambda angles: assembly.closure(angles)[0], off)).max() < 1e-8


@pytest.mark.parametrize(
    ("x", "error", "words"),
    [
        (lambda x: x[:-1], ValueError, r"x has shape \(\d+,\), expected"),
        (lambda x: x.reshape(-1, 3), ValueError, r"x has shape \(\d+, 3\)"),
        (lambda x: np.where(np.arange(len(x)) == 4, np.nan, x), ValueError, r"x\[4\] is not finite"),
        (lambda x: np.where(np.arange(len(x)) == 4, np.inf, x), ValueError, r"x\[4\] is not finite"),
        (lambda x: x + 0j, TypeError, "complex128"),
        (lambda x: np.array(["a"] * len(x)), TypeError, "expected real numbers"),
        (lambda x: None, TypeError, "expected real numbers"),
    ],
)
def test_wrong_unknowns_are_refused(soft, x, error, words):
    for function in (soft.energy, soft.gradient, soft.hessian, soft.lengths, soft.fold_angles, soft.constraints, soft.state):
        with pytest.raises(error, match=words):
            function(x(soft.start))


def test_the_start_stays_and_collapsed_positions_are_refused(soft):
    """The drawn unknowns cannot be changed in place; where edges have no length there are no derivatives; NaN is refused."""
    with pytest.raises(ValueError, match="read-only"):
        x = soft.start
        x += 1.0
    with pytest.raises(ValueError, match="read-only"):
        soft._inner.forms().start[0] = 1.0
    for work in (soft.gradient, soft.hessian):
        with pytest.raises(ValueError, match="an edge has no length or a face no area"):
            work(0.0 * soft.start)
    with pytest.raises(ValueError, match=r"coordinates\[0\] is not finite"):
        soft.unknowns(np.full(len(soft.start), np.nan))


def test_other_types_of_numbers_are_converted(soft):
    x = np.round(soft.start, 3).astype(np.float32)
    assert soft.energy(x) == soft.energy(x.astype(float)) == soft.energy(list(map(float, x)))
    assert soft.energy(np.asfortranarray(np.stack([x, x]))[0]) == soft.energy(x)


def test_formulas_and_curves_have_their_energies():
    """Source: the closed form of the energy, summed over the creases; a spring. Tolerance: rounding errors."""
    sheet = fw.generate("miura")
    formula = {"creases": {"kind": "formula", "torque": "k*sin(m - m0)"}}
    curve = {"creases": {"kind": "table", "points": np.outer(np.linspace(-2.0, 2.0, 9), (1.0, 0.7))}}
    bent = fw.Assembly.patch(sheet, (2, 2), creases=0.7, rest=0.3, laws=formula)
    x = bent.start + 0.01 * np.sin(np.arange(len(bent.start)))
    creases = bent.kinds == "crease"
    off, lengths = bent.fold_angles(x)[creases] - 0.3, bent.lengths(bent.start)[creases]
    assert abs(bent.energy(x) - 0.7 * lengths @ (1.0 - np.cos(off))) < 1e-13 * bent.energy(x)
    letters = {"creases": dict.fromkeys("MV", formula["creases"])}
    by_letter = fw.Assembly.patch(sheet, (2, 2), creases=0.7, rest=0.3, laws=letters)
    assert abs(by_letter.energy(x) - bent.energy(x)) < 1e-13 * bent.energy(x)
    measured = fw.Assembly.patch(sheet, (2, 2), rest=0.3, laws=curve)
    assert abs(measured.energy(x) - 0.35 * lengths @ off**2) < 1e-13 * measured.energy(x)
    with pytest.raises(fw.SceneError, match="(?s)laws.creases.*`x` at character 7"):
        fw.Assembly.patch(sheet, creases=0.7, laws={"creases": {"kind": "formula", "torque": "k*sin(x)"}})
