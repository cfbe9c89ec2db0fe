//! The energy of an assembly as a function of its unknowns, with derivatives.

use crate::arrays::{Array1, Array2, rows, vector};
use crate::errors::bug;
use crate::state::State;
use crate::term::CalledTerm;
use foldwell::kinematics::Closure;
use foldwell::model::{Bars, Gauge, Hinges, Model, RestLengths, Terms};
use foldwell::numerics::sparse::FIXED;
use foldwell::solver::{HessianKind, Linearization, Problem};
use foldwell::{Picture, RIGID};
use numpy::{PyArrayMethods, PyReadonlyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// A sparse matrix: values, column or row of each, and where each row or column begins.
type Sparse<'py> = (Array1<'py, f64>, Array1<'py, i64>, Array1<'py, i64>);

/// The functions of the unknowns of an assembly: its energy, its lengths and its fold angles.
#[pyclass(frozen, module = "foldwell._foldwell")]
pub(crate) struct Forms {
    assembly: foldwell::Assembly,
    /// The model of the assembly, in which only pins hold coordinates.
    model: Model,
    /// The same unknowns with every length and angle as a measure.
    measures: Model,
    /// Edge of every measure of `measures`, lengths first.
    edges: Vec<usize>,
    /// Number of the measures that are lengths.
    lengths: usize,
    /// The terms whose energy is a function in Python.
    called: Vec<CalledTerm>,
}

impl Forms {
    pub(crate) fn new(assembly: &foldwell::Assembly, called: Vec<CalledTerm>) -> Self {
        let angles = assembly.drawn_angles_or_zero();
        let hinges = || Some(Hinges { stiffness: RIGID.into(), rest: angles.clone() });
        let bars = Some(Bars { stiffness: RIGID.into(), rest: RestLengths::Drawn });
        let given = assembly.terms();
        let (pins, guides, parts) = (given.pins.clone(), given.guides.clone(), given.parts.clone());
        let facets = given.facets.as_ref().and_then(|_| hinges());
        let terms = Terms { bars, creases: hinges(), facets, pins, guides, parts, ..Terms::default() };
        let measures = assembly.with_terms(terms).model(Gauge::Free);
        let of = |angle: bool| {
            let elements = measures.stiff().filter(move |element| element.is_angle() == angle);
            elements.filter_map(|element| element.edge()).collect::<Vec<_>>()
        };
        let (lengths, hinges) = (of(false), of(true));
        let count = lengths.len();
        let edges = [lengths, hinges].concat();
        let model = assembly.model(Gauge::Free);
        Self { assembly: assembly.clone(), model, edges, lengths: count, measures, called }
    }
}

impl Forms {
    /// Returns the unknowns as a slice.
    fn unknowns<'a>(&self, x: &'a PyReadonlyArray1<'_, f64>) -> PyResult<&'a [f64]> {
        let (x, expected) = (x.as_slice()?, self.model.layout().unknowns);
        if x.len() == expected {
            return Ok(x);
        }
        Err(PyValueError::new_err(format!("x has {} numbers, and the assembly {expected} unknowns", x.len())))
    }

    /// Evaluates something that may call functions in Python, perhaps on other threads; raises what they have raised.
    fn evaluated<R: Send>(&self, py: Python<'_>, work: impl FnOnce() -> R + Send) -> PyResult<R> {
        let found = py.detach(work);
        self.called.iter().try_for_each(CalledTerm::raise).map(|()| found)
    }

    /// Returns the linearization at `x` and the tensions of the stiff measures, which are zero in rigid ones.
    fn linearized(&self, py: Python<'_>, x: &[f64]) -> PyResult<(Linearization, Vec<f64>)> {
        let (at, tension) = self.evaluated(py, || self.linearization(x))?;
        if at.force(&tension).iter().any(|force| force.is_nan()) {
            let message = "at this x an edge has no length or a face no area: the energy has no derivatives there";
            return Err(PyValueError::new_err(message));
        }
        Ok((at, tension))
    }

    fn linearization(&self, x: &[f64]) -> (Linearization, Vec<f64>) {
        let tension = |(gap, c): (f64, &f64)| if *c > 0.0 { gap / c } else { 0.0 };
        let tension: Vec<f64> = self.model.gaps(x).into_iter().zip(self.model.compliance()).map(tension).collect();
        let mut out = Linearization::new(self.model.layout());
        self.model.linearize(x, &tension, HessianKind::Full, &mut out);
        (out, tension)
    }

    /// Returns the numbers of the rigid measures, which are constraints.
    fn rigid(&self) -> Vec<usize> {
        let compliance = self.model.compliance().iter().enumerate();
        compliance.filter(|(_, c)| **c == 0.0).map(|(row, _)| row).collect()
    }

    /// Scatters measures onto the edges of the assembly; NaN where there is none.
    fn on_edges(&self, values: &[f64], angles: bool) -> Vec<f64> {
        let mut all = vec![f64::NAN; self.assembly.edges()];
        let wanted = if angles { self.lengths..self.edges.len() } else { 0..self.lengths };
        wanted.for_each(|k| all[self.edges[k]] = values[k]);
        all
    }
}

/// Returns rows of the Jacobian of stiff measures, each put at a new place, in compressed rows of which there are
/// `count`.
fn jacobian<'py>(py: Python<'py>, at: &Linearization, places: &[(usize, usize)], count: usize) -> Sparse<'py> {
    let (mut values, mut columns, mut begins) = (Vec::new(), Vec::new(), vec![0i64; count + 1]);
    let rows = at.rows();
    let mut places = places.to_vec();
    places.sort_unstable_by_key(|(_, to)| *to);
    for (from, to) in places {
        let entries = rows.cliques.members(from).iter().zip(&rows.values[rows.cliques.range(from)]);
        for (member, value) in entries.filter(|(member, _)| **member != FIXED) {
            columns.push(i64::from(*member));
            values.push(*value);
        }
        begins[to + 1] = values.len() as i64;
    }
    for row in 0..count {
        begins[row + 1] = begins[row + 1].max(begins[row]);
    }
    (vector(py, values), vector(py, columns), vector(py, begins))
}

#[pymethods]
impl Forms {
    /// The unknowns of the drawn state.
    #[getter]
    fn start<'py>(&self, py: Python<'py>) -> Array1<'py, f64> {
        let start = vector(py, self.model.start());
        start.readwrite().make_nonwriteable();
        start
    }

    /// Returns the unknowns of a state, given all coordinates.
    fn unknowns_at<'py>(&self, py: Python<'py>, coordinates: PyReadonlyArray1<'py, f64>) -> PyResult<Array1<'py, f64>> {
        let (all, expected) = (coordinates.as_slice()?, self.assembly.drawn().coordinates.len());
        if all.len() != expected {
            let message = format!("there are {} coordinates, and the assembly has {expected}", all.len());
            return Err(PyValueError::new_err(message));
        }
        Ok(vector(py, self.model.unknowns(all)))
    }

    /// Returns the state with these unknowns: positions and fold angles.
    fn state_at(&self, py: Python<'_>, x: PyReadonlyArray1<'_, f64>) -> PyResult<State> {
        let x = self.unknowns(&x)?;
        let tension = self.evaluated(py, || self.linearization(x))?.1;
        let state = self.evaluated(py, || foldwell::analysis::state::State::new(&self.model, x, &tension))?;
        let state = state.with_angles(self.assembly.fold_angles_at(&self.model.coordinates(x)));
        Ok(State { picture: Picture::new(&self.assembly, &state) })
    }

    fn energy(&self, py: Python<'_>, x: PyReadonlyArray1<'_, f64>) -> PyResult<f64> {
        let x = self.unknowns(&x)?;
        let stiff = self.model.gaps(x).into_iter().zip(self.model.compliance());
        let stiff: f64 = stiff.filter(|(_, c)| **c > 0.0).map(|(gap, c)| 0.5 * gap * gap / c).sum();
        Ok(self.evaluated(py, || self.model.energy(x))? + stiff)
    }

    fn gradient<'py>(&self, py: Python<'py>, x: PyReadonlyArray1<'py, f64>) -> PyResult<Array1<'py, f64>> {
        let (at, tension) = self.linearized(py, self.unknowns(&x)?)?;
        Ok(vector(py, at.force(&tension).into_iter().map(|force| -force).collect()))
    }

    /// Returns the lower triangle of the Hessian in compressed columns.
    fn hessian<'py>(&self, py: Python<'py>, x: PyReadonlyArray1<'py, f64>) -> PyResult<Sparse<'py>> {
        let (at, _) = self.linearized(py, self.unknowns(&x)?)?;
        let mut values = at.hessian.clone();
        for (row, compliance) in self.model.compliance().iter().enumerate().filter(|(_, c)| **c > 0.0) {
            at.add_outer(row, 1.0 / compliance, &mut values);
        }
        let columns = (0..at.pattern().size()).map(|k| at.pattern().column(k));
        let mut begins = vec![0i64];
        let mut rows: Vec<i64> = Vec::with_capacity(values.len());
        for column in columns {
            rows.extend(column.iter().map(|row| i64::from(*row)));
            begins.push(rows.len() as i64);
        }
        Ok((vector(py, values), vector(py, rows), vector(py, begins)))
    }

    /// Returns the values of the constraints, which are zero where rigid elements have their lengths and angles.
    fn constraints<'py>(&self, py: Python<'py>, x: PyReadonlyArray1<'py, f64>) -> PyResult<Array1<'py, f64>> {
        let gaps = self.model.gaps(self.unknowns(&x)?);
        Ok(vector(py, self.rigid().into_iter().map(|row| gaps[row]).collect()))
    }

    /// Returns the derivative of the constraints in compressed rows.
    fn constraint_jacobian<'py>(&self, py: Python<'py>, x: PyReadonlyArray1<'py, f64>) -> PyResult<Sparse<'py>> {
        let (at, _) = self.linearized(py, self.unknowns(&x)?)?;
        let places: Vec<(usize, usize)> = self.rigid().into_iter().enumerate().map(|(to, from)| (from, to)).collect();
        Ok(jacobian(py, &at, &places, places.len()))
    }

    /// Returns the lengths, or the fold angles, of all edges.
    fn measures<'py>(
        &self,
        py: Python<'py>,
        x: PyReadonlyArray1<'py, f64>,
        angles: bool,
    ) -> PyResult<Array1<'py, f64>> {
        let values = self.measures.values(self.unknowns(&x)?);
        Ok(vector(py, self.on_edges(&values, angles)))
    }

    /// Returns their derivative in compressed rows.
    fn measures_jacobian<'py>(
        &self,
        py: Python<'py>,
        x: PyReadonlyArray1<'py, f64>,
        angles: bool,
    ) -> PyResult<Sparse<'py>> {
        let x = self.unknowns(&x)?;
        let mut at = Linearization::new(self.measures.layout());
        let none = vec![0.0; self.measures.compliance().len()];
        self.measures.linearize(x, &none, HessianKind::GaussNewton, &mut at);
        let wanted = if angles { self.lengths..self.edges.len() } else { 0..self.lengths };
        let places: Vec<(usize, usize)> = wanted.map(|k| (k, self.edges[k])).collect();
        Ok(jacobian(py, &at, &places, self.assembly.edges()))
    }
}

/// Returns the closure of the cell of a sheet with these fold angles: the residual, and its derivative by the angle of
/// each edge.
#[pyfunction]
pub(crate) fn closure<'py>(
    py: Python<'py>,
    sheet: &crate::sheet::Sheet,
    rho: PyReadonlyArray1<'py, f64>,
) -> PyResult<(Array1<'py, f64>, Array2<'py, f64>)> {
    let (angles, edges) = (rho.as_slice()?, sheet.sheet.edges.len());
    if angles.len() != edges {
        let message = format!("rho has {} angles, and the cell {edges} edges", angles.len());
        return Err(PyValueError::new_err(message));
    }
    let closure = Closure::of_cell(&sheet.sheet).map_err(|error| bug(py, error.to_string()))?;
    let (residual, small) = (closure.residual(angles), closure.jacobian(angles));
    let mut all = vec![0.0; residual.len() * edges];
    for (column, &edge) in closure.folding_edges().iter().enumerate() {
        (0..residual.len()).for_each(|row| all[row * edges + edge] = small[(row, column)]);
    }
    Ok((vector(py, residual.as_slice().to_vec()), rows(py, all, edges)?))
}
