//! The condensation of the springs of a cell: its energy under strains and bendings of the lattice, minimised over the
//! motions of its vertices, for any stiffness of the bars.
//!
//! The unit of length is `length`, the square root of the cell's area. The vector `y` is a motion: the velocities of
//! the vertices, and the strain and curvature `m` in the norm of [`Principal`]. Rigid elements restrict it to
//! `R y = 0`. What is left is split into the motions that change no bar's length, among them the rigid modes with
//! strains and curvatures `T`, and the others, `c`. Of these
//!
//! - a part is given by the strains and curvatures across `T`: `c = G^+ x + Y d` with `G Y = 0`, and
//! - `d` minimises the energy, `Y^T Q (G^+ x + Y d) + Y^T A^T B t = 0`, for the amplitude `t` of the rigid modes,
//!
//! where `Q` is the stiffness of bars and hinges along `c`, and `A` and `B` the rates of the hinges along `c` and along
//! the rigid modes, weighted by the roots of their stiffnesses and without what motions that neither strain nor bend
//! make of them. Along the rigid modes the stiffness is `B^T B` less what `d` relaxes, which falls as the inverse of
//! the stiffness of the bars: no large number is subtracted from another, and rigid bars are the limit.

use super::cell::{CellElement, PeriodicCell};
use super::compatibility::{MACROSCOPIC, rates, units};
use super::error::ResponseError;
use crate::numerics::dense::small::{CholeskyFactor, cholesky};
use crate::numerics::dense::{DenseError, full_svd, null_space_of_sums, symmetric_eigen};
use crate::numerics::{DenseMatrix, larger};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Singular value that counts as zero, of rates in units of the cell.
const ZERO: f64 = 1e-10;
/// Eigenvalue that is rounding, relative to the largest one.
const ROUNDING: f64 = 1e-14;

/// Second derivatives of the energy per area, by the components 11, 22, 12: force per length, force, and force times
/// length; in the limit of stiff bars over `EA`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "RigidLimitSummary")]
pub struct ModuliMatrices {
    /// Second derivatives of the energy per area by two components of the strain.
    pub stretching: [[f64; 3]; 3],
    /// Second derivatives by a component of the strain (row) and one of the curvature (column).
    pub coupling: [[f64; 3]; 3],
    /// Second derivatives by two components of the curvature.
    pub bending: [[f64; 3]; 3],
}

/// A principal strain and bending, of norm 1 in `e11^2 + e22^2 + 2 e12^2 + A (k11^2 + k22^2 + 2 k12^2)`, `A` the area
/// of the cell: an eigenvector of the moduli.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "PrincipalSummary")]
pub struct Principal {
    /// Strain `[e11, e22, e12]`.
    pub strain: [f64; 3],
    /// Curvature tensor `[k11, k22, k12]`.
    pub curvature: [f64; 3],
    /// Its stiffness, twice its energy per area: force per length.
    pub stiffness: f64,
    /// Its stiffness over that of the rigid mode of the same number; null where that is 0.
    pub ratio: Option<f64>,
}

/// Rates of some elements by the motions of a cell, with their spring constants.
#[derive(Clone)]
struct Weighted {
    rates: DenseMatrix,
    stiffness: Vec<f64>,
}

/// The springs of a cell at rest.
#[derive(Clone)]
pub(super) struct CellSprings {
    rigid: Weighted,
    bars: Weighted,
    hinges: Weighted,
    /// All bars, with the stiffest of `EA = 1`.
    limit: Weighted,
    /// Rigid elements other than bars.
    rigid_hinges: Weighted,
    area: f64,
    /// Magnitude of the terms of which the rates are sums.
    terms: f64,
}

impl Weighted {
    fn of(rows: &DenseMatrix, chosen: &[(usize, f64)]) -> Self {
        Self {
            rates: DenseMatrix::from_fn(chosen.len(), rows.ncols(), |row, column| rows[(chosen[row].0, column)]),
            stiffness: chosen.iter().map(|(_, stiffness)| *stiffness).collect(),
        }
    }

    /// Returns the rates along these motions, each times the root of its spring constant.
    fn rooted(&self, motions: &DenseMatrix) -> DenseMatrix {
        let mut rows = &self.rates * motions;
        rows.row_iter_mut().zip(&self.stiffness).for_each(|(mut row, stiffness)| row *= stiffness.sqrt());
        rows
    }
}

impl CellSprings {
    /// Collects the springs of these elements.
    pub(super) fn new(cell: &PeriodicCell, elements: &[CellElement<'_>]) -> Self {
        let (area, found) = (cell.area(), rates(cell, elements));
        let (angle, rows) = (|row: usize| elements[row].element.is_angle(), found.by_motions(area.sqrt()));
        let spring = |row: usize| {
            let spring = elements[row].element.spring;
            let unit = if angle(row) { 1.0 } else { area };
            (row, unit * spring.stiffness, unit * spring.rest.recip())
        };
        let springs: Vec<(usize, f64, f64)> = (0..elements.len()).map(spring).collect();
        let chosen = |wanted: &dyn Fn(usize, f64) -> bool| -> Vec<(usize, f64)> {
            springs.iter().filter(|(row, k, _)| wanted(*row, *k)).map(|(row, k, _)| (*row, *k)).collect()
        };
        let axial = |(_, k, per_axial): &(usize, f64, f64)| k / per_axial;
        let stiffest = springs.iter().filter(|spring| !angle(spring.0)).map(axial).fold(0.0, f64::max);
        let limit = springs.iter().filter(|spring| !angle(spring.0)).map(|spring| {
            let part = if stiffest.is_infinite() {
                f64::from(u8::from(spring.1.is_infinite()))
            } else {
                axial(spring) / stiffest
            };
            (spring.0, part * spring.2)
        });
        Self {
            rigid: Weighted::of(&rows, &chosen(&|_, k| k.is_infinite())),
            bars: Weighted::of(&rows, &chosen(&|row, k| k.is_finite() && !angle(row))),
            hinges: Weighted::of(&rows, &chosen(&|row, k| k.is_finite() && angle(row))),
            limit: Weighted::of(&rows, &limit.collect::<Vec<_>>()),
            rigid_hinges: Weighted::of(&rows, &chosen(&|row, k| k.is_infinite() && angle(row))),
            area,
            terms: found.terms,
        }
    }

    /// Returns the bars alone, the stiffest of them with `EA = 1`.
    pub(super) fn of_bars(&self) -> Self {
        let hinges = Weighted { rates: self.hinges.rates.rows(0, 0).into_owned(), stiffness: vec![] };
        Self { rigid: self.rigid_hinges.clone(), bars: self.limit.clone(), hinges, ..self.clone() }
    }
}

/// The energy of a cell as a function of its strain and curvature.
pub(super) struct Condensed {
    area: f64,
    /// Strains and curvatures of the rigid modes, orthonormal columns.
    rigid: DenseMatrix,
    /// The others that no rigid element forbids, orthonormal columns.
    others: DenseMatrix,
    /// Second derivatives of the energy: rigid and rigid, others and rigid, others and others.
    blocks: [DenseMatrix; 3],
    /// Those of the rigid modes with rigid bars.
    limit: DenseMatrix,
}

impl Condensed {
    /// Minimises the energy of springs over the motions of the vertices.
    pub(super) fn new(springs: &CellSprings) -> Result<Self, ResponseError> {
        let allowed = null_space_of_sums(&springs.rigid.rates, springs.terms)?.basis;
        let lattice = allowed.rows(allowed.nrows() - MACROSCOPIC, MACROSCOPIC).into_owned();
        // motions that change a bar's length, and the others
        let (stretching, still) = split(&springs.bars.rates, &allowed)?;
        // the others: those of the rigid modes, scaled so that their strains and curvatures are orthonormal, and those
        // that neither strain nor bend
        let of_still = full_svd(&(&lattice * &still))?;
        let count = of_still.singular_values.iter().filter(|value| **value > ZERO).count();
        let rigid = of_still.u.columns(0, count).into_owned();
        let mut modes = &still * of_still.v.columns(0, count);
        modes.column_iter_mut().zip(&of_still.singular_values).for_each(|(mut mode, value)| mode /= *value);
        let local = &still * of_still.v.columns(count, still.ncols() - count);
        // of the motions that stretch, what they strain and bend across the rigid modes
        let across = of_still.u.columns(count, MACROSCOPIC - count);
        let reach = full_svd(&(across.transpose() * &lattice * &stretching))?;
        let reached = reach.singular_values.iter().filter(|value| **value > ZERO).count();
        let others = across * reach.u.columns(0, reached);
        let mut given = reach.v.columns(0, reached).into_owned();
        given.column_iter_mut().zip(&reach.singular_values).for_each(|(mut column, value)| column /= *value);
        let free = reach.v.columns(reached, stretching.ncols() - reached).into_owned();
        // along those motions the rigid modes are taken back
        let along = &stretching - &modes * (rigid.transpose() * &lattice * &stretching);
        let terms = springs.hinges.stiffness.iter().fold(0.0, |most, k| larger(most, springs.terms * k.sqrt()));
        let relaxed = without(&springs.hinges.rooted(&(&allowed * &local)), terms)?;
        let a = &relaxed * springs.hinges.rooted(&(&allowed * &along));
        let b = &relaxed * springs.hinges.rooted(&(&allowed * &modes));
        let bars = springs.bars.rooted(&(&allowed * &along));
        let stiffness = bars.tr_mul(&bars) + a.tr_mul(&a);
        let pull = a.tr_mul(&b);
        let limit = b.tr_mul(&b);
        let [given_free, pull_free] = [given.tr_mul(&stiffness) * &free, free.tr_mul(&pull)];
        let solve = Solve::new(free.tr_mul(&stiffness) * &free)?;
        let blocks = [
            &limit - pull_free.tr_mul(&solve.of(&pull_free)),
            given.tr_mul(&pull) - &given_free * solve.of(&pull_free),
            given.tr_mul(&stiffness) * &given - &given_free * solve.of(&given_free.transpose()),
        ];
        Ok(Self { area: springs.area, rigid, others, blocks, limit })
    }

    /// Returns the moduli; `None` where rigid elements make some of them infinite.
    pub(super) fn matrices(&self) -> Option<ModuliMatrices> {
        let frame = joined(&[&self.rigid, &self.others]);
        if frame.ncols() != MACROSCOPIC {
            return None;
        }
        let (matrix, units) = (&frame * assembled(&self.blocks) * frame.transpose(), units(self.area.sqrt()));
        let entry = |row: usize, column: usize| {
            0.5 * (matrix[(row, column)] + matrix[(column, row)]) * units[row] * units[column] / self.area
        };
        let block = |row: usize, column: usize| [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(row + i, column + j)));
        Some(ModuliMatrices { stretching: block(0, 0), coupling: block(0, 3), bending: block(3, 3) })
    }

    /// Returns the principal strains and bendings of the rigid modes with rigid bars, by rising stiffness.
    pub(super) fn rigid_modes(&self) -> Result<Vec<Principal>, ResponseError> {
        self.principal(&self.limit, &self.rigid, |value| value)
    }

    /// Returns the softest principal strains and bendings of all, as many as there are rigid modes, by rising
    /// stiffness. They are the largest eigenvalues of the compliance, which keeps their digits beside stiff bars.
    pub(super) fn softest(&self) -> Result<Vec<Principal>, ResponseError> {
        let frame = joined(&[&self.rigid, &self.others]);
        let count = self.rigid.ncols();
        let found = match self.compliance() {
            Some(compliance) => {
                let mut found = self.principal(&compliance, &frame, f64::recip)?;
                found.reverse();
                found
            }
            None => self.principal(&assembled(&self.blocks), &frame, |value| value)?,
        };
        Ok(found.into_iter().take(count).collect())
    }

    /// Returns the inverse of the second derivatives; `None` where a strain or bending costs nothing.
    fn compliance(&self) -> Option<DenseMatrix> {
        let [rigid, mixed, others] = &self.blocks;
        let of_others = cholesky(others.clone())?;
        let carried = of_others.solve(mixed);
        let along = rigid - mixed.tr_mul(&carried);
        if !(along.diagonal().min() > ROUNDING * self.limit.amax()) {
            return None;
        }
        let along = cholesky(along)?.inverse();
        let corner = -(&carried * &along);
        let rest = of_others.inverse() - &corner * carried.transpose();
        Some(assembled(&[along, corner, rest]))
    }

    /// Returns the eigenvectors of a matrix in a frame of strains and curvatures, by rising eigenvalues, with the
    /// stiffness that belongs to each eigenvalue.
    fn principal(
        &self,
        matrix: &DenseMatrix,
        frame: &DenseMatrix,
        stiffness: impl Fn(f64) -> f64,
    ) -> Result<Vec<Principal>, ResponseError> {
        if matrix.nrows() == 0 {
            return Ok(vec![]);
        }
        let found = symmetric_eigen(matrix)?;
        let largest = found.values.iter().fold(0.0, |most, value| f64::max(most, value.abs()));
        let (units, vectors) = (units(self.area.sqrt()), frame * &found.vectors);
        let one = |(k, value): (usize, &f64)| {
            let vector = vectors.column(k);
            let sign = if vector[vector.iamax()] < 0.0 { -1.0 } else { 1.0 };
            let part = |component: usize| sign * vector[component] / units[component];
            let value = if value.abs() <= ROUNDING * largest { 0.0 } else { *value };
            Principal {
                strain: [0, 1, 2].map(part),
                curvature: [3, 4, 5].map(part),
                stiffness: stiffness(value) / self.area,
                ratio: None,
            }
        };
        Ok(found.values.iter().enumerate().map(one).collect())
    }
}

/// Solutions of a system that may have no unknowns.
struct Solve(Option<CholeskyFactor>);

impl Solve {
    fn new(matrix: DenseMatrix) -> Result<Self, ResponseError> {
        let size = matrix.nrows();
        match cholesky(matrix) {
            None if size > 0 => Err(DenseError::NoConvergence { rows: size, columns: size }.into()),
            factor => Ok(Self(factor.filter(|_| size > 0))),
        }
    }

    fn of(&self, right: &DenseMatrix) -> DenseMatrix {
        self.0.as_ref().map_or_else(|| right.clone(), |factor| factor.solve(right))
    }
}

/// Returns motions of an orthonormal basis, as combinations of it, that rows change, and those that they do not.
fn split(rows: &DenseMatrix, basis: &DenseMatrix) -> Result<(DenseMatrix, DenseMatrix), ResponseError> {
    let found = full_svd(&(rows * basis))?;
    let rank = found.singular_values.iter().filter(|value| **value > ZERO).count();
    let columns = |first: usize, count: usize| found.v.columns(first, count).into_owned();
    Ok((columns(0, rank), columns(rank, basis.ncols() - rank)))
}

/// Returns the projection onto what is orthogonal to all columns, whose entries are sums of terms of this magnitude.
fn without(columns: &DenseMatrix, terms: f64) -> Result<DenseMatrix, ResponseError> {
    let found = full_svd(columns)?;
    let rank = found.singular_values.iter().filter(|value| **value > ZERO * terms).count();
    let span = found.u.columns(0, rank);
    Ok(DenseMatrix::identity(columns.nrows(), columns.nrows()) - span * span.transpose())
}

/// Returns the matrix with these blocks: by the rigid modes, mixed, and by the others.
fn assembled([rigid, mixed, others]: &[DenseMatrix; 3]) -> DenseMatrix {
    let count = rigid.nrows();
    DenseMatrix::from_fn(count + others.nrows(), count + others.nrows(), |row, column| {
        match (row.checked_sub(count), column.checked_sub(count)) {
            (None, None) => rigid[(row, column)],
            (Some(row), None) => mixed[(row, column)],
            (None, Some(column)) => mixed[(column, row)],
            (Some(row), Some(column)) => others[(row, column)],
        }
    })
}

/// Returns the columns of matrices beside each other.
fn joined(parts: &[&DenseMatrix]) -> DenseMatrix {
    let columns: Vec<_> = parts.iter().flat_map(|part| part.column_iter()).collect();
    DenseMatrix::from_fn(MACROSCOPIC, columns.len(), |row, column| columns[column][row])
}
