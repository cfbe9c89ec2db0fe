//! The landscape coefficient of a large patch, from the three modes of one cell only.
//!
//! A large patch that is bent by `a K` at every point has a strain of second order, of its Gaussian curvature `a^2
//! K_G`, that is not the strain of any displacement. Linear modes whose amplitudes `a^2 lambda` vary over the patch
//! compensate it: their curvature `B lambda = grad grad w` is that of a normal displacement `w`, and their lattice
//! strain `T lambda` satisfies
//!
//! `curl curl (T B^-1 grad grad w) = -K_G`.
//!
//! These modes fold the creases. The energy is the minimum of `1/2 int lambda^T M lambda` over the patch, with the
//! stiffness `M` of the creases of a cell in the space of modes. All lengths scale: the energy of `n x n` cells is
//! `n^6` times that of one parallelogram of the size of a cell. Here `w` is a polynomial, a sum of products of Legendre
//! polynomials in the coordinates of the lattice, and satisfies the condition exactly (theory: curvature and strain of
//! linear modes, compatibility of small strains).

use super::Predicted;
use foldwell::analysis::landscape::HeldSheet;
use foldwell::kinematics::metric::LatticeFrame;
use foldwell::kinematics::{Displacement, Embedding};
use foldwell::numerics::DenseMatrix;
use foldwell::numerics::dense::full_svd;
use foldwell::sheet::{Corner, Sheet};
use nalgebra::{DVector, Matrix2, Matrix3};

/// Singular values below this fraction of the largest one count as zero.
const ZERO: f64 = 1e-11;

/// Returns the limit of the coefficient divided by `n^6 K_G^2` for `n x n` cells, with polynomials `w` of this total
/// degree (at least 4).
///
/// `patch` is any patch of the sheet; its modes and the stiffness of its creases are used, and bars are rigid. Fails if
/// the sheet does not have three modes that are determined by their curvatures.
pub fn coefficient(sheet: &Sheet, patch: &HeldSheet, degree: usize) -> Predicted<f64> {
    let cell = Cell::new(sheet, patch)?;
    let basis = Basis::new(degree);
    let curvature = cell.second_derivatives(&basis);
    let combined = |map: &Matrix3<f64>, of: &[DenseMatrix; 3], row: usize| -> DenseMatrix {
        &of[0] * map[(row, 0)] + &of[1] * map[(row, 1)] + &of[2] * map[(row, 2)]
    };
    let modes: [DenseMatrix; 3] = std::array::from_fn(|mode| combined(&cell.modes, &curvature, mode));
    let strain: [DenseMatrix; 3] = std::array::from_fn(|component| combined(&cell.strain, &modes, component));
    let [xx, yy, xy] = &curvature;
    let condition = yy * &strain[0] + xx * &strain[1] - xy * &strain[2] * 2.0;
    let mut source = DVector::zeros(basis.count());
    source[0] = -1.0;
    let norms: Vec<f64> = basis.norms().collect();
    let weigh = |rows: &DenseMatrix| DenseMatrix::from_fn(rows.nrows(), rows.ncols(), |i, j| norms[i] * rows[(i, j)]);
    let mut energy = DenseMatrix::zeros(3 * basis.count(), basis.count());
    for mode in 0..3 {
        let part = weigh(&combined(&cell.stiffness_root, &modes, mode));
        energy.rows_mut(mode * basis.count(), basis.count()).copy_from(&part);
    }
    // scaled to columns of norm 1; columns of linear functions, which do not bend, are left out
    let sizes: Vec<f64> = energy.column_iter().map(|column| column.norm()).collect();
    let bending: Vec<usize> = (0..basis.count()).filter(|&k| sizes[k] > 0.0).collect();
    let unit = |of: &DenseMatrix| {
        DenseMatrix::from_fn(of.nrows(), bending.len(), |row, k| of[(row, bending[k])] / sizes[bending[k]])
    };
    let (energy, condition) = (unit(&energy), unit(&weigh(&condition)));
    Ok(0.5 * least_square(&energy, &condition, &source)?)
}

/// The properties of one cell in the continuum.
struct Cell {
    /// Map from lattice coordinates to the plane.
    frame: LatticeFrame,
    /// Amplitudes of the modes for a curvature tensor, `B^-1`.
    modes: Matrix3<f64>,
    /// Lattice strains of the modes, `T`: components 11, 22, 12.
    strain: Matrix3<f64>,
    /// Upper triangular matrix `U` with `U^T U = M`.
    stiffness_root: Matrix3<f64>,
}

impl Cell {
    fn new(sheet: &Sheet, patch: &HeldSheet) -> Predicted<Self> {
        let modes = patch.bending.as_ref().ok_or("curvatures name no modes")?;
        if modes.count() != 3 {
            return Err("there are not three modes".into());
        }
        let lattice = sheet.lattice.ok_or("no lattice")?;
        let (embedding, frame) = (Embedding::new(sheet)?, LatticeFrame::new(&lattice));
        let curvatures = Matrix3::from_fn(|component, mode| modes.curvatures[(component, mode)]);
        let strains: Vec<[f64; 3]> = modes
            .basis
            .column_iter()
            .map(|mode| {
                let moving = Displacement::new(&embedding, embedding.drawn_angles(), mode.as_slice());
                let velocity = |shift: [i32; 2]| moving.corner(Corner { vertex: 0, shift }).1;
                frame.strain_rate(&lattice, &[[1, 0], [0, 1]].map(|shift| velocity(shift) - velocity([0, 0])))
            })
            .collect();
        let weighed = DenseMatrix::from_diagonal(&DVector::from_vec(patch.stiffness())) * &modes.basis;
        let stiffness = modes.basis.tr_mul(&weighed).fixed_view::<3, 3>(0, 0).into_owned();
        let root = stiffness.cholesky().map(|factor| factor.l().transpose());
        Ok(Self {
            frame,
            modes: curvatures.try_inverse().ok_or("singular curvatures")?,
            strain: Matrix3::from_fn(|component, mode| 0.5 * strains[mode][component]),
            stiffness_root: root.ok_or("singular stiffness")?,
        })
    }

    /// Returns the second derivatives 11, 22, 12 of the basis by lengths in the plane.
    fn second_derivatives(&self, basis: &Basis) -> [DenseMatrix; 3] {
        let along = [0, 1].map(|axis| basis.derivative(axis));
        let inverse: Matrix2<f64> = self.frame.inverse;
        let first = [0, 1].map(|i| &along[0] * inverse[(0, i)] + &along[1] * inverse[(1, i)]);
        [(0, 0), (1, 1), (0, 1)].map(|(i, j)| &first[i] * &first[j])
    }
}

/// The products `P_i(2 s - 1) P_j(2 t - 1)` of Legendre polynomials with `i + j` at most the degree; the constant
/// first.
struct Basis {
    powers: Vec<[usize; 2]>,
}

impl Basis {
    fn new(degree: usize) -> Self {
        Self { powers: (0..=degree).flat_map(|total| (0..=total).map(move |i| [i, total - i])).collect() }
    }

    fn count(&self) -> usize {
        self.powers.len()
    }

    /// Returns the root mean squares over the unit square.
    fn norms(&self) -> impl Iterator<Item = f64> + '_ {
        self.powers.iter().map(|[i, j]| ((2 * i + 1) as f64 * (2 * j + 1) as f64).sqrt().recip())
    }

    /// Returns the matrix of `d/ds` or `d/dt`: `P_n' = sum (2k + 1) P_k` over `k = n - 1, n - 3, ...`.
    fn derivative(&self, axis: usize) -> DenseMatrix {
        let entry = |row: usize, column: usize| {
            let (to, from) = (self.powers[row], self.powers[column]);
            let lower = to[axis] < from[axis] && (from[axis] - to[axis]) % 2 == 1;
            if lower && to[1 - axis] == from[1 - axis] { 2.0 * (2 * to[axis] + 1) as f64 } else { 0.0 }
        };
        DenseMatrix::from_fn(self.count(), self.count(), entry)
    }
}

/// Returns the least `|energy c|^2` of all `c` with `condition c = source`.
fn least_square(energy: &DenseMatrix, condition: &DenseMatrix, source: &DVector<f64>) -> Predicted<f64> {
    let svd = full_svd(condition)?;
    let rank = rank(&svd.singular_values);
    let parts = svd.u.columns(0, rank).tr_mul(source);
    let scaled = DVector::from_fn(rank, |k, _| parts[k] / svd.singular_values[k]);
    let particular = energy * (svd.v.columns(0, rank) * scaled);
    let free = energy * svd.v.columns(rank, svd.v.ncols() - rank);
    let range = full_svd(&free)?;
    let kept = range.u.columns(0, self::rank(&range.singular_values)).into_owned();
    Ok((&particular - &kept * kept.tr_mul(&particular)).norm_squared())
}

fn rank(singular_values: &[f64]) -> usize {
    let largest = singular_values.first().copied().unwrap_or(0.0);
    singular_values.iter().take_while(|value| **value > ZERO * largest).count()
}
