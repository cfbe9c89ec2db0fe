//! Strips: sheets that are periodic along the first lattice vector and some cells wide along the second, with free
//! edges.
//!
//! At a wavenumber `q1` the displacements of the cells `0 .. N` across the strip are the unknowns. A row of the
//! rigidity matrix belongs to the lowest cell that it touches; rows that stick out of the strip are left out. So a
//! strip has as many zero modes less self stresses as rows stick out, whatever its cells are.
//!
//! The lower half of a strip may be of another cell than the upper half. Cells are joined by the numbers of their
//! vertices: a row of the last cell below the interface holds the vertices of the first cell above it. If `w` is the
//! number of roots `z2` of `det R` inside the unit circle, rows counted as said and zero roots too, the zero modes
//! bound to the interface less the self stresses bound to it are `w(above) - w(below)`: the index of half a sheet of
//! the upper cell is `w`, that of half a sheet of the lower one, with all its rows, `-w` (C. L. Kane, T. C. Lubensky,
//! Nature Physics 10, 39 (2014)).

use super::counts::rank_and_gap;
use super::rigidity::Row;
use super::{BlochError, Rigidity};
use crate::numerics::complex::{ComplexMatrix, eigenvalues};
use crate::numerics::dense::{Svd, full_svd};
use crate::sheet::{Corner, Sheet};
use nalgebra::{Complex, Matrix3};
use std::f64::consts::TAU;
use std::ops::Range;

/// Smallest ratio between the smallest singular value that is kept and the largest that is dropped.
const SMALLEST_GAP: f64 = 1e3;
/// Singular values of what is seen of the zero modes in a window, below this part of the largest, are rounding.
const UNSEEN: f64 = 1e-12;
/// Wavenumbers at which the winding of a determinant is followed.
const TURNS: usize = 4096;
/// Largest turn of a determinant between neighbours of them, in radians.
const LARGEST_TURN: f64 = 1.0;
/// Cells in a window.
const WINDOW: usize = 2;
/// Most of the squared amplitude of a bound mode is on its side.
const MAJORITY: f64 = 0.5;

/// A strip across the second lattice vector.
#[derive(Clone, Debug)]
pub struct Strip {
    cells: usize,
    /// Cells below the interface; all without one.
    half: usize,
    /// Whether the cells beyond the edges are held, so that the rows that stick out stay.
    clamped: bool,
    below: Rigidity,
    above: Rigidity,
    /// The rows of the lower cell where corners of this shift and larger ones are of the upper cell, by the shift.
    across: Vec<(i32, Rigidity)>,
}

/// Zero modes and self stresses of a strip at a wavenumber.
#[derive(Clone, Debug)]
pub struct StripModes {
    /// The wavenumber along the strip, radians per cell.
    pub q1: f64,
    /// Number of zero modes.
    pub zero_modes: usize,
    /// Number of self stresses.
    pub self_stresses: usize,
    /// Smallest singular value that is not zero over the largest that is, the latter no less than rounding.
    pub gap: f64,
    /// Zero modes as columns, cell after cell: orthonormal, but for columns of zeros.
    modes: ComplexMatrix,
    /// Self stresses as columns, row after row.
    stresses: ComplexMatrix,
    /// The cell to which each row belongs.
    owners: Vec<i32>,
    width: usize,
}

/// How many modes are bound to a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bound {
    /// Zero modes.
    pub zero_modes: usize,
    /// Self stresses.
    pub self_stresses: usize,
}

impl Strip {
    /// A strip of equal cells.
    ///
    /// # Errors
    /// [`BlochError`] where the matrix of a cell is not square.
    pub fn new(rigidity: &Rigidity, cells: usize) -> Result<Self, BlochError> {
        rigidity.require_square()?;
        let own = rigidity.clone();
        Ok(Self { cells, half: cells, clamped: false, below: own.clone(), above: own, across: Vec::new() })
    }

    /// A strip whose lower half (rounded down) is of one sheet and whose upper half of another, as drawn; `rigid` says
    /// whether polygons are. The sheets must [fit].
    ///
    /// # Errors
    /// [`BlochError`] for finite sheets, and where the matrix of a cell is not square.
    pub fn with_interface([below, above]: [&Sheet; 2], rigid: bool, cells: usize) -> Result<Self, BlochError> {
        let own = [below, above].map(|sheet| Rigidity::of_sheet(sheet, rigid));
        let [first, second] = own;
        let (first, second) = (first?, second?);
        first.require_square()?;
        second.require_square()?;
        let [lowest, highest] =
            first.rows.iter().map(|row| row.span(1)).fold([0, 0], |[a, b], [low, high]| [a.min(low), b.max(high)]);
        let step = below.lattice.ok_or(BlochError::NoLattice)?[1];
        let across = (lowest + 1..=highest).map(|first_above| {
            let place = |corner: Corner| {
                if corner.shift[1] < first_above {
                    return below.position(corner);
                }
                let shift = [corner.shift[0], corner.shift[1] - first_above];
                above.position(Corner { shift, ..corner }) + step * f64::from(first_above)
            };
            (first_above, Rigidity::placed(below, rigid, place, |_| Matrix3::identity()))
        });
        let across = across.collect();
        Ok(Self { cells, half: cells / 2, clamped: false, below: first, above: second, across })
    }

    /// The same strip with clamped edges: the cells beyond them are held, so that no row is left out. Where free edges
    /// have zero modes clamped ones have self stresses, which the self stresses bound to an interface cannot cancel.
    pub fn clamped(self) -> Self {
        Self { clamped: true, ..self }
    }

    /// The row of a cell, in the numbers of its own cell's rows.
    fn row(&self, cell: i32, number: usize) -> &Row {
        let half = self.half as i32;
        if cell >= half {
            return &self.above.rows[number];
        }
        let own = &self.below.rows[number];
        let [low, high] = own.span(1);
        let first_above = half - cell + low;
        let mixed = self.across.iter().find(|(shift, _)| *shift == first_above && first_above <= high);
        mixed.map_or(own, |(_, rigidity)| &rigidity.rows[number])
    }

    /// The rows of the strip: the cell to which each belongs, and its number there.
    fn rows(&self) -> Vec<(i32, usize)> {
        let reach = self.below.rows.iter().map(|row| row.span(1)[1] - row.span(1)[0]).max().unwrap_or(0);
        let cells = self.cells as i32;
        let all = (-reach..cells).flat_map(|cell| (0..self.below.columns()).map(move |number| (cell, number)));
        let wanted = |&(cell, number): &(i32, usize)| {
            let [low, high] = self.row(cell, number).span(1);
            let last = cell + high - low;
            if self.clamped { last >= 0 } else { cell >= 0 && last < cells }
        };
        all.filter(wanted).collect()
    }

    /// The matrix of these rows at a wavenumber, made square by zeros.
    fn matrix(&self, q1: f64, rows: &[(i32, usize)]) -> ComplexMatrix {
        let (width, z1) = (self.below.columns(), Complex::from_polar(1.0, q1));
        let size = rows.len().max(width * self.cells);
        let mut matrix = ComplexMatrix::zeros(size, size);
        for (at, &(cell, number)) in rows.iter().enumerate() {
            let row = self.row(cell, number);
            let low = row.span(1)[0];
            for (corner, direction) in &row.terms {
                let place = cell + corner.shift[1] - low;
                if (0..self.cells as i32).contains(&place) {
                    let (column, phase) = (place as usize * width + 3 * corner.vertex, z1.powi(corner.shift[0]));
                    (0..3).for_each(|axis| matrix[(at, column + axis)] += phase * direction[axis]);
                }
            }
        }
        matrix
    }

    /// Zero modes and self stresses at a wavenumber along the strip.
    ///
    /// # Errors
    /// [`BlochError`] where a decomposition fails, and where zero and nonzero singular values are not apart.
    pub fn at(&self, q1: f64) -> Result<StripModes, BlochError> {
        let rows = self.rows();
        let matrix = self.matrix(q1, &rows);
        let (size, width) = (matrix.ncols(), self.below.columns());
        let columns = width * self.cells;
        let Svd { u, singular_values, v } = full_svd(&matrix)?;
        let (rank, gap) = rank_and_gap(&singular_values);
        if !(gap >= SMALLEST_GAP) {
            return Err(BlochError::StripRank { q1, gap });
        }
        // rows and columns of zeros are no self stresses and no zero modes
        let (zero_modes, self_stresses) = (columns - rank, rows.len() - rank);
        let modes = v.view((0, rank), (columns, size - rank)).into_owned();
        let stresses = u.view((0, rank), (rows.len(), size - rank)).into_owned();
        let owners = rows.iter().map(|&(cell, _)| cell).collect();
        Ok(StripModes { q1, zero_modes, self_stresses, gap, modes, stresses, owners, width })
    }
}

impl StripModes {
    /// How many zero modes and self stresses have most of their squared amplitude in some cells.
    ///
    /// # Errors
    /// [`BlochError`] where a decomposition fails.
    pub fn bound(&self, cells: Range<usize>) -> Result<Bound, BlochError> {
        let columns = self.modes.rows(cells.start * self.width, cells.len() * self.width).into_owned();
        let mut rows = self.stresses.clone();
        let inside = |owner: &i32| usize::try_from(*owner).is_ok_and(|owner| cells.contains(&owner));
        let elsewhere = self.owners.iter().enumerate().filter(|(_, owner)| !inside(owner));
        elsewhere.for_each(|(row, _)| rows.row_mut(row).fill(Complex::ZERO));
        Ok(Bound { zero_modes: majority(&columns)?, self_stresses: majority(&rows)? })
    }

    /// The zero modes that have most of their squared amplitude in some cells, by themselves.
    pub(crate) fn bound_to(&self, cells: Range<usize>) -> Result<Self, BlochError> {
        let part = self.modes.rows(cells.start * self.width, cells.len() * self.width).into_owned();
        let Svd { singular_values, v, .. } = full_svd(&(part.adjoint() * part))?;
        let count = singular_values.iter().filter(|value| **value > MAJORITY).count();
        Ok(Self { modes: &self.modes * v.columns(0, count), ..self.clone() })
    }

    /// The factors by which zero modes are multiplied from a cell to the next upwards, or downwards, from a first cell
    /// on.
    ///
    /// Where all cells ahead are equal, what the zero modes are in a window of cells spans a space that the step to the
    /// next window maps into itself: its eigenvalues are the factors. `shifts` windows are taken from the first on; one
    /// is enough at a free edge, where every mode that the cell allows is there.
    ///
    /// # Errors
    /// [`BlochError`] where a decomposition fails.
    pub fn factors(&self, first: usize, upwards: bool, shifts: usize) -> Result<Vec<Complex<f64>>, BlochError> {
        let count = self.modes.ncols();
        let window = |shift: usize| {
            let mut found = ComplexMatrix::zeros(WINDOW * self.width, count * shifts);
            for start in 0..shifts {
                for k in 0..WINDOW {
                    let away = shift + start + k;
                    let cell = if upwards { first + away } else { first - away };
                    let part = self.modes.rows(cell * self.width, self.width);
                    found.view_mut((k * self.width, start * count), (self.width, count)).copy_from(&part);
                }
            }
            found
        };
        let (here, next) = (window(0), window(1));
        let size = here.nrows().max(here.ncols());
        let Svd { u, singular_values, v } = full_svd(&here.clone().resize(size, size, Complex::ZERO))?;
        let seen = singular_values.iter().filter(|value| **value > UNSEEN * singular_values[0]).count();
        let u = u.view((0, 0), (here.nrows(), seen));
        let v = v.view((0, 0), (here.ncols(), seen));
        let mut step = u.adjoint() * next * v;
        for (k, value) in singular_values.iter().take(seen).enumerate() {
            step.column_mut(k).scale_mut(value.recip());
        }
        let found = eigenvalues(&step)?;
        Ok(if upwards { found } else { found.into_iter().map(|z| z.inv()).collect() })
    }
}

impl Rigidity {
    /// The number of roots `z2` inside the unit circle at a real `q1`, those at zero too, where every row belongs to
    /// the lowest cell it touches: how often the determinant goes round zero.
    ///
    /// # Errors
    /// [`BlochError`] where the matrix is not square, and where the determinant comes too near to zero on the circle.
    pub fn roots_inside(&self, q1: f64) -> Result<usize, BlochError> {
        let lowest: i32 = self.rows.iter().map(|row| row.span(1)[0]).sum();
        let at = |k: usize| {
            let q2 = TAU * k as f64 / TURNS as f64;
            let value = self.determinant([q1, q2].map(|q| Complex::from_polar(1.0, q)))?;
            Ok(value * Complex::from_polar(1.0, -f64::from(lowest) * q2))
        };
        let values = (0..TURNS).map(at).collect::<Result<Vec<_>, BlochError>>()?;
        let turn = |k: usize| (values[(k + 1) % TURNS] / values[k]).arg();
        let largest = (0..TURNS).map(|k| turn(k).abs()).fold(0.0, f64::max);
        if !(largest < LARGEST_TURN) {
            return Err(BlochError::NoWinding { q1 });
        }
        Ok(((0..TURNS).map(turn).sum::<f64>() / TAU).round() as usize)
    }
}

/// The number of directions among orthonormal columns of which these rows hold most of the square.
fn majority(rows: &ComplexMatrix) -> Result<usize, BlochError> {
    let gram = rows.adjoint() * rows;
    let values = full_svd(&gram)?.singular_values;
    Ok(values.iter().filter(|value| **value > MAJORITY).count())
}

/// Why two sheets cannot be joined along the first lattice vector; `None` where they fit: as many vertices, one first
/// lattice vector, and the same edges across the cut between cells.
pub fn fit(below: &Sheet, above: &Sheet) -> Option<String> {
    let [Some(first), Some(second)] = [below.lattice, above.lattice] else { return Some("a sheet is finite".into()) };
    let [m, n] = [below, above].map(|sheet| sheet.vertices.len());
    if m != n {
        return Some(format!("the cells have {m} and {n} vertices"));
    }
    if !((first[0] - second[0]).norm() <= 1e-9 * first[0].norm()) {
        return Some("the first lattice vectors of the cells differ".into());
    }
    let [a, b] = [below, above].map(crossing);
    let other = a.iter().find(|edge| !b.contains(edge)).or_else(|| b.iter().find(|edge| !a.contains(edge)));
    other.map(|[from, to, n1, n2]| {
        format!("the edge [{from}, {to}, {n1}, {n2}] across the cut between cells is there in one cell only")
    })
}

/// The edges between cells of different `n2`, from the lower cell to the upper one.
fn crossing(sheet: &Sheet) -> Vec<[i64; 4]> {
    let keys = sheet.edges.iter().map(|edge| edge.key).filter(|key| key.shift[1] != 0);
    let upwards = |key: crate::sheet::EdgeKey| {
        let [n1, n2] = key.shift.map(i64::from);
        if n2 > 0 { [key.i as i64, key.j as i64, n1, n2] } else { [key.j as i64, key.i as i64, -n1, -n2] }
    };
    keys.map(upwards).collect()
}
