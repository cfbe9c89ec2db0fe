//! Linear folding modes of a periodic sheet, and the curvature tensor of each mode.
//!
//! A mode is a null vector of the closure Jacobian at the drawn state: a rate of the fold angle of every edge of the
//! cell. On a walk over the faces, each crossing of an edge from its right to its left face adds a rotation about the
//! edge at that rate (valley positive); after one lattice vector `l_a` the faces rotate at `Omega_a` relative to those
//! at the start. The sheet as a whole then bends with the curvature tensor
//!
//! `K = a^-T M a^-1`, `M_ab = (Omega_a x l_b) . n`, `a` upper triangular with `a^T a` the metric of the lattice,
//!
//! which is symmetric because the lattice motions commute to first order. `K` refers to x along the first lattice
//! vector and y in the plane of the lattice towards the second; the displacement along the unit normal `n`, on the side
//! of the face normals, is `(k11 x^2 + k22 y^2 + 2 k12 x y)/2`.

use super::metric::LatticeFrame;
use super::{Closure, Displacement, Embedding, KinematicsError};
use crate::math::Vec3;
use crate::numerics::DenseMatrix;
use crate::numerics::dense::singular_values;
use crate::numerics::dense::small::solve_3;
use crate::sheet::Sheet;
use nalgebra::{DVector, Matrix2, Matrix3};

/// Largest condition number of the map from modes to curvature tensors for which curvatures name a mode.
const LARGEST_CONDITION: f64 = 1e8;

/// Largest difference between two paths over the faces, for a mode of norm 1.
const LARGEST_DIFFERENCE: f64 = 1e-9;

/// The linear folding modes of one cell of a periodic sheet in the drawn state.
#[derive(Clone, Debug)]
pub struct FoldingModes {
    /// Orthonormal modes as columns, `Ne x m`: rates of the fold angles of the cell's edges, including diagonals.
    pub basis: DenseMatrix,
    /// Curvature tensors of the modes as columns, `3 x m`: `k11`, `k22`, `k12`, each per unit of the mode's amplitude,
    /// in radians per length.
    pub curvatures: DenseMatrix,
    /// Angular velocities of the faces relative to those of the previous cell, along the two lattice vectors, for each
    /// mode.
    pub lattice_rotations: Vec<[Vec3; 2]>,
}

/// Computes the linear folding modes of a sheet with a lattice, without locked edges.
///
/// There are three modes at a generic spatially periodic state, `Nv + 2` at a flat developable one.
///
/// # Errors
/// [`KinematicsError`] for a finite sheet, for one with openings, and if the number of modes is not clear.
pub fn folding_modes(sheet: &Sheet) -> Result<FoldingModes, KinematicsError> {
    folding_modes_with_locked(sheet, &[])
}

/// Computes the linear folding modes in which the `locked` edges keep their angles; a rigid polygon has its diagonals
/// locked.
///
/// The rates of locked edges are zero.
///
/// # Errors
/// [`KinematicsError`] as [`folding_modes`].
pub fn folding_modes_with_locked(sheet: &Sheet, locked: &[usize]) -> Result<FoldingModes, KinematicsError> {
    let lattice = sheet.lattice.ok_or(KinematicsError::NoLattice)?;
    let closure = Closure::of_cell(sheet)?.with_locked(locked);
    match closure.unchecked_loops {
        0 if sheet.holes.is_empty() => {}
        loops => return Err(KinematicsError::Openings { loops: loops.max(sheet.holes.len()) }),
    }
    let embedding = Embedding::new(sheet)?;
    let folding = closure.motions(embedding.drawn_angles())?.basis;
    let basis = with_zero_rates(sheet.edges.len(), closure.folding_edges(), &folding);
    let modes = basis.column_iter().map(|mode| lattice_rotations(&embedding, mode.as_slice()));
    let lattice_rotations = modes.collect::<Result<Vec<_>, _>>()?;
    let tensors = curvatures(&embedding, &lattice, &lattice_rotations);
    let curvatures = DenseMatrix::from_fn(3, tensors.len(), |row, mode| tensors[mode][row]);
    Ok(FoldingModes { basis, curvatures, lattice_rotations })
}

/// Returns the rates of all edges, from a row for each edge in `folding`; zero for the others.
pub(super) fn with_zero_rates(edges: usize, folding: &[usize], rates: &DenseMatrix) -> DenseMatrix {
    let mut all = DenseMatrix::zeros(edges, rates.ncols());
    folding.iter().enumerate().for_each(|(row, &edge)| all.set_row(edge, &rates.row(row)));
    all
}

impl FoldingModes {
    /// Number of modes.
    pub fn count(&self) -> usize {
        self.basis.ncols()
    }

    /// Returns the fold rates of the mode with the curvature tensor `[k11, k22, k12]`.
    ///
    /// # Errors
    /// [`KinematicsError`] if the number of modes is not three, or if the modes do not map one to one onto curvature
    /// tensors.
    pub fn named(&self, curvature: [f64; 3]) -> Result<Vec<f64>, KinematicsError> {
        if self.count() != 3 {
            return Err(KinematicsError::NotThreeModes { modes: self.count() });
        }
        let condition = condition(&self.curvatures)?;
        let invertible = condition <= LARGEST_CONDITION;
        let map = Matrix3::from_fn(|row, mode| self.curvatures[(row, mode)]);
        let amplitudes = solve_3(map, &Vec3::from(curvature)).filter(|_| invertible);
        let amplitudes = amplitudes.ok_or(KinematicsError::SingularCurvatures { condition })?;
        Ok((&self.basis * DVector::from_column_slice(amplitudes.as_slice())).as_slice().to_vec())
    }
}

fn condition(map: &DenseMatrix) -> Result<f64, KinematicsError> {
    let values = singular_values(map)?;
    Ok(values[0] / values[values.len() - 1])
}

/// Returns the curvature tensors `[k11, k22, k12]` of modes with these lattice rotations.
fn curvatures(embedding: &Embedding, lattice: &[Vec3; 2], rotations: &[[Vec3; 2]]) -> Vec<[f64; 3]> {
    let (upwards, area) = (lattice[0].cross(&lattice[1]), embedding.drawn_area);
    let normal = upwards.normalize() * area.dot(&upwards).signum();
    let frame = LatticeFrame::new(lattice);
    let tensor = |omega: &[Vec3; 2]| frame.tensor(&Matrix2::from_fn(|a, b| omega[a].cross(&lattice[b]).dot(&normal)));
    rotations.iter().map(tensor).collect()
}

/// Returns the angular velocities from a cell to the next, along both lattice vectors, for fold rates at the drawn
/// state.
fn lattice_rotations(embedding: &Embedding, rates: &[f64]) -> Result<[Vec3; 2], KinematicsError> {
    let Displacement { lattice, disagreement, .. } = Displacement::new(embedding, embedding.drawn_angles(), rates);
    let closes = disagreement <= LARGEST_DIFFERENCE;
    if !closes {
        return Err(KinematicsError::WaysDisagree { difference: disagreement });
    }
    lattice.map(|moving| moving.map(|lattice| lattice.twist.angular)).ok_or(KinematicsError::NoLattice)
}

#[cfg(test)]
mod tests {
    use super::super::test_sheets::*;
    use super::*;
    use crate::kinematics::drawn_fold_angles;
    use crate::numerics::dense::{least_squares, null_space};
    use crate::sheet::{Corner, EdgeKey};

    /// Returns the curvature tensor from a fit of `c + bx + dy + (k11 x^2 + k22 y^2 + 2 k12 xy)/2` to the normal
    /// displacements of the copies of vertex 0, and the largest residual of the fit.
    fn fitted_curvature(sheet: &Sheet, rates: &[f64]) -> (Vec3, f64) {
        let step = 1e-4;
        let drawn = drawn_fold_angles(sheet);
        let moved = [-step, step].map(|step| {
            let angles: Vec<f64> = drawn.iter().zip(rates).map(|(angle, rate)| angle + step * rate).collect();
            put_together(sheet, &angles)
        });
        let [l1, l2] = sheet.lattice.unwrap();
        let (x, n) = (l1.normalize(), l1.cross(&l2).normalize());
        let y = n.cross(&x);
        let copies: Vec<Corner> = (-2..=2)
            .flat_map(|n1| (-2..=2).map(move |n2| [n1, n2]))
            .map(|shift| Corner { vertex: 0, shift })
            .filter(|c| moved[0].contains_key(c))
            .collect();
        assert!(copies.len() >= 20);
        let heights = copies.iter().map(|c| (moved[1][c] - moved[0][c]).dot(&n) / (2.0 * step));
        let heights = DenseMatrix::from_iterator(copies.len(), 1, heights);
        let terms = DenseMatrix::from_fn(copies.len(), 6, |row, term| {
            let place = sheet.position(copies[row]) - sheet.position(copies[0]);
            let (x, y) = (place.dot(&x), place.dot(&y));
            [0.5 * x * x, 0.5 * y * y, x * y, x, y, 1.0][term]
        });
        let fit = least_squares(&terms, &heights).unwrap();
        (Vec3::new(fit.solution[0], fit.solution[1], fit.solution[2]), fit.residual.amax())
    }

    fn random_modes(modes: &FoldingModes, count: u64) -> impl Iterator<Item = (Vec<f64>, Vec3)> + '_ {
        (0..count).map(|seed| {
            let amplitudes = DVector::from_vec(random_numbers(seed, modes.count()));
            let rates = &modes.basis * &amplitudes;
            (rates.as_slice().to_vec(), Vec3::from_column_slice((&modes.curvatures * amplitudes).as_slice()))
        })
    }

    /// Claim: curvature tensors have the documented sign and factor: if faces are attached one by one with fold angles
    /// close to the drawn ones, the displacements of the copies of vertex 0 are the quadratic form. Tolerance 1e-5: the
    /// step is 1e-4, the error of central differences its square times the size of the patch.
    #[test]
    fn curvature_is_that_of_faces_put_together() {
        let sheet = open_star();
        let modes = folding_modes(&sheet).unwrap();
        assert_eq!(modes.count(), 3);
        for (rates, curvature) in random_modes(&modes, 3) {
            let (fitted, misfit) = fitted_curvature(&sheet, &rates);
            assert!((fitted - curvature).norm() <= 1e-5 * curvature.norm(), "{fitted} for {curvature}");
            assert!(misfit <= 1e-5 * curvature.norm());
        }
    }

    /// Claim: the lattice motions of a mode commute to first order, `Omega_1 x l_2 = Omega_2 x l_1`, so that the
    /// curvature tensor is symmetric. Tolerance: rounding.
    #[test]
    fn lattice_motions_commute() {
        for sheet in [open_star(), open_flat(), miura()] {
            let [l1, l2] = sheet.lattice.unwrap();
            for [omega1, omega2] in folding_modes(&sheet).unwrap().lattice_rotations {
                assert!((omega1.cross(&l2) - omega2.cross(&l1)).norm() <= 1e-12);
            }
        }
    }

    /// Claim: the rays along which an independent program left the drawn state are linear modes with curvature tensors
    /// of rank one, with the sign of the curvature that the program found later on the ray. Tolerance 1e-8: its
    /// directions satisfy the quadratic condition to 7e-9.
    #[test]
    fn rays_are_on_the_cone_of_cylinders() {
        let sheet = open_star();
        let modes = folding_modes(&sheet).unwrap();
        let rays = open_star_reference().rays(&sheet);
        assert_eq!(rays.len(), 4);
        for (start, kappa) in rays {
            let amplitudes = modes.basis.transpose() * DVector::from_vec(start.clone());
            assert!((&modes.basis * &amplitudes - DVector::from_vec(start)).amax() <= 1e-12);
            let k = &modes.curvatures * amplitudes;
            let (determinant, trace) = (k[0] * k[1] - k[2] * k[2], k[0] + k[1]);
            assert!(determinant.abs() <= 1e-8 * trace * trace, "{k}");
            assert!(trace * kappa > 0.0);
        }
    }

    /// Claim: a named mode is a null vector of closure and has the curvature tensor of its name.
    #[test]
    fn named_modes_have_their_curvature() {
        let sheet = open_star();
        let modes = folding_modes(&sheet).unwrap();
        let jacobian = Closure::of_cell(&sheet).unwrap().jacobian(&drawn_fold_angles(&sheet));
        for name in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.25, 1.0, 0.5], [1.0, -1.0, 0.0]] {
            let rates = DVector::from_vec(modes.named(name).unwrap());
            assert!((&jacobian * &rates).amax() <= 1e-13 * rates.norm());
            let curvature = &modes.curvatures * (modes.basis.transpose() * rates);
            assert!((curvature - DVector::from_row_slice(&name)).amax() <= 1e-12);
        }
    }

    /// Returns the edges that are drawn flat: in [`miura`] the diagonals of its parallelograms.
    fn flat_edges(sheet: &Sheet) -> Vec<usize> {
        let angles = drawn_fold_angles(sheet);
        (0..angles.len()).filter(|&edge| angles[edge].abs() < 1e-9).collect()
    }

    /// Claim: with rigid parallelograms Miura-ori has one mode (M. Schenk, S. D. Guest, PNAS 110, 3276 (2013)). Its two
    /// fold angles satisfy `tan(a/2) = cos(sector) tan(b/2)`, so that `a' sin(b) = b' sin(a)`. The sheet stays
    /// periodic: cells do not rotate relative to each other, and the mode has no name. Tolerance: rounding.
    #[test]
    fn rigid_parallelograms_leave_miura_ori_one_mode() {
        let sheet = miura();
        let (diagonals, angles) = (flat_edges(&sheet), drawn_fold_angles(&sheet));
        assert_eq!(diagonals.len(), 4);
        let modes = folding_modes_with_locked(&sheet, &diagonals).unwrap();
        assert_eq!(modes.count(), 1);
        let rates = modes.basis.column(0);
        assert!(diagonals.iter().all(|&edge| rates[edge] == 0.0));
        let creases = (0..rates.len()).filter(|edge| !diagonals.contains(edge));
        let ratios: Vec<f64> = creases.map(|edge| rates[edge] / angles[edge].sin()).collect();
        assert!(ratios.iter().all(|ratio| (ratio - ratios[0]).abs() <= 1e-12 * ratios[0].abs()), "{ratios:?}");
        assert!(modes.lattice_rotations[0].iter().all(|omega| omega.norm() <= 1e-12));
        assert_eq!(modes.named([1.0, 0.0, 0.0]).unwrap_err(), KinematicsError::NotThreeModes { modes: 1 });
    }

    /// Claim: the modes of the locked sheet are the modes of the free sheet that keep the angles of the locked edges. A
    /// flat cell of 4 vertices has 6 modes; three locks leave three, which name all curvatures, and the named mode is
    /// one of the free sheet. Source: the free modes and linear algebra. Tolerance: rounding.
    #[test]
    fn locked_modes_are_free_modes() {
        let sheet = open_flat();
        let (free, locked) = (folding_modes(&sheet).unwrap(), [1, 4, 8]);
        let modes = folding_modes_with_locked(&sheet, &locked).unwrap();
        let conditions = free.basis.select_rows(&locked);
        let kept = &free.basis * null_space(&conditions).unwrap().basis;
        assert_eq!((free.count(), modes.count(), kept.ncols()), (6, 3, 3));
        assert!((&kept * kept.transpose() - &modes.basis * modes.basis.transpose()).amax() <= 1e-12);
        let rates = modes.named([0.3, -0.2, 0.9]).unwrap();
        let amplitudes = free.basis.transpose() * DVector::from_column_slice(&rates);
        assert!(locked.iter().all(|&edge| rates[edge] == 0.0) && rates.iter().any(|rate| rate.abs() > 0.1));
        assert!((&free.curvatures * amplitudes - DVector::from_row_slice(&[0.3, -0.2, 0.9])).amax() <= 1e-10);
    }

    /// Claim: names do not depend on the side from which the sheet is seen. Reversing the order of corners of all faces
    /// reverses all fold angles and the normal, so that valleys still bend the sheet positively: the same rates have
    /// the same name. With the lattice vectors `l1, -l2` x stays and y is reversed: only `k12` changes sign.
    #[test]
    fn names_follow_the_face_normals() {
        let sheet = open_star();
        let named = |sheet: &Sheet, name| DVector::from_vec(folding_modes(sheet).unwrap().named(name).unwrap());
        let rates = named(&sheet, [0.3, -0.2, 0.9]);
        let mut over = sheet.clone();
        over.triangles.iter_mut().for_each(|face| face.corners.reverse());
        over.edges.iter_mut().for_each(|edge| edge.wings.reverse());
        assert!((named(&over, [0.3, -0.2, 0.9]) - &rates).amax() <= 1e-12 * rates.norm());
        let mirrored = with_second_lattice_vector_reversed(&sheet);
        assert!((named(&mirrored, [0.3, -0.2, -0.9]) - &rates).amax() <= 1e-12 * rates.norm());
    }

    fn with_second_lattice_vector_reversed(sheet: &Sheet) -> Sheet {
        let [l1, l2] = sheet.lattice.unwrap();
        let turn = |corner: Corner| Corner { shift: [corner.shift[0], -corner.shift[1]], ..corner };
        let mut turned = sheet.clone();
        turned.lattice = Some([l1, -l2]);
        turned.triangles.iter_mut().for_each(|face| face.corners = face.corners.map(turn));
        for edge in &mut turned.edges {
            let [i, j] = edge.key.ends().map(turn);
            let (key, reversed) = EdgeKey::new(i, j);
            let back = if reversed { j.shift } else { i.shift }.map(|n| -n);
            edge.key = key;
            edge.wings = edge.wings.map(|wing| wing.map(|corner| turn(corner).translated(back)));
            if reversed {
                edge.wings.reverse();
            }
        }
        turned
    }

    /// Claim: errors name the reason for which a mode cannot be named: a flat sheet has Nv + 2 modes, the three modes
    /// of triangulated Miura-ori do not give all curvature tensors, a finite sheet and one with openings have no modes
    /// of this kind.
    #[test]
    fn what_cannot_be_named() {
        let flat = folding_modes(&open_flat()).unwrap();
        assert_eq!(flat.named([1.0, 0.0, 0.0]).unwrap_err(), KinematicsError::NotThreeModes { modes: 6 });
        let miura = folding_modes(&miura()).unwrap();
        assert_eq!(miura.count(), 3);
        match miura.named([1.0, 0.0, 0.0]).unwrap_err() {
            KinematicsError::SingularCurvatures { condition } => assert!(condition > 1e8),
            other => panic!("{other:?}"),
        }
        assert_eq!(folding_modes(&finite_grid(2, 2, 0.3)).unwrap_err(), KinematicsError::NoLattice);
        let whole = open_star();
        let kept: Vec<[Corner; 3]> = whole.triangles[1..].iter().map(|face| face.corners).collect();
        let torn = sheet("torn", whole.vertices, whole.lattice, &kept);
        assert_eq!(folding_modes(&torn).unwrap_err(), KinematicsError::Openings { loops: 1 });
    }
}
