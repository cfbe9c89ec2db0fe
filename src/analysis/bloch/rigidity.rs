//! The rigidity matrix of one cell at Bloch factors `z1`, `z2`.
//!
//! In a Bloch mode vertex `j` of cell `(n1, n2)` moves by `z1^n1 z2^n2 u_j`. The bar `(i, j, n1, n2)` with unit
//! direction `r` then stretches by `r . (z1^n1 z2^n2 u_j - u_i)`: its row has `+r z1^n1 z2^n2` at `j` and `-r` at `i`.
//! A facet that is locked has the gradient of its fold angle as a row, scaled to the norm of a bar's. On a cylinder
//! cells are turned by the lattice rotations `S`, the copy moves by `z1^n1 z2^n2 S u_j`, and `r` is replaced by `S^T r`
//! at `j`.
//!
//! Forces of tensions `t` that are multiplied in the same way are balanced where `R(1/z1, 1/z2)^T t = 0`.

use super::BlochError;
use super::double_double::DoubleDouble;
use crate::kinematics::Shape;
use crate::math::Vec3;
use crate::math::fold_angle::fold_angle_gradient;
use crate::model::Domain;
use crate::numerics::complex::{ComplexMatrix, determinant};
use crate::sheet::{Corner, EdgeKey, EdgeKind, Sheet};
use nalgebra::{Complex, Matrix3, Rotation3};

/// Magnitude of the terms of which entries of the matrix are sums at real wavenumbers: directions, which cancel where
/// both ends of a bar are copies of one vertex.
pub(crate) const TERM: f64 = 1.0;

/// One condition on the displacements: the sum of `direction . u` over some corners is zero.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Corners and the direction that each contributes; no unit.
    pub terms: Vec<(Corner, Vec3)>,
    /// What the rounding of the directions has left out; zero where they are known no better, as on a cylinder.
    pub rests: Vec<Vec3>,
}

impl Row {
    fn rounded(terms: Vec<(Corner, Vec3)>) -> Self {
        let rests = vec![Vec3::zeros(); terms.len()];
        Self { terms, rests }
    }

    /// Returns the lowest and the highest shift of the corners along a lattice vector.
    pub(super) fn span(&self, a: usize) -> [i32; 2] {
        let shifts = self.terms.iter().map(|(corner, _)| corner.shift[a]);
        shifts.fold([i32::MAX, i32::MIN], |[low, high], s| [low.min(s), high.max(s)])
    }
}

/// The rigidity matrix between two vectors.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct RigidityProduct {
    /// `left^H R right`.
    pub value: Complex<f64>,
    /// Its derivatives by `log z1` and `log z2`.
    pub slopes: [Complex<f64>; 2],
    /// Sum of the magnitudes of the products that make the value.
    pub size: f64,
}

/// The rigidity matrix as a function of the Bloch factors.
#[derive(Clone, Debug, PartialEq)]
pub struct Rigidity {
    /// Vertices of a cell.
    pub vertices: usize,
    /// Bars in their order among the sheet's edges, then locked facets.
    pub rows: Vec<Row>,
}

impl Rigidity {
    /// The bars of a spatially periodic sheet as drawn; with `rigid_facets` also the locks of the diagonals of
    /// polygons.
    ///
    /// # Errors
    /// [`BlochError`] for a finite sheet.
    pub fn of_sheet(sheet: &Sheet, rigid_facets: bool) -> Result<Self, BlochError> {
        let lattice = sheet.lattice.ok_or(BlochError::NoLattice)?;
        let mut found = Self::placed(sheet, rigid_facets, |corner| sheet.position(corner), |_| Matrix3::identity());
        for (row, edge) in found.rows.iter_mut().zip(sheet.bars()) {
            let (direction, rest) = precise_direction(sheet, &edge.key, &lattice);
            let [i, j] = edge.key.ends();
            *row = Row { terms: vec![(i, -direction), (j, direction)], rests: vec![-rest, rest] };
        }
        Ok(found)
    }

    /// The bars of a cylinder: a state of the sheet whose cells are moved by screw motions.
    pub fn of_cylinder(sheet: &Sheet, shape: &Shape) -> Self {
        let place = |corner: Corner| shape.screw.motion(corner.shift).apply(&shape.positions[corner.vertex]);
        Self::placed(sheet, false, place, |shift| shape.screw.motion(shift).rotation)
    }

    /// The bars of a state of one cell, periodic or screw-periodic as its domain says, with all coordinates of the
    /// state in the domain's frame; with `rigid_facets` also the locks of the diagonals of polygons.
    pub(crate) fn of_state(sheet: &Sheet, rigid_facets: bool, domain: &Domain, x: &[f64]) -> Result<Self, BlochError> {
        if matches!(domain, Domain::Patch | Domain::Own(_)) {
            return Err(BlochError::NoLattice);
        }
        Ok(Self::placed(sheet, rigid_facets, |corner| domain.point(x, corner), |shift| cell_rotation(domain, x, shift)))
    }

    /// The bars, and locks of facets, of a sheet whose corners are at some places, with the rotations of its cells.
    pub(crate) fn placed(
        sheet: &Sheet,
        rigid_facets: bool,
        place: impl Fn(Corner) -> Vec3,
        turn: impl Fn([i32; 2]) -> Matrix3<f64>,
    ) -> Self {
        // the direction as seen from the cell of the corner
        let term = |corner: Corner, direction: Vec3| (corner, turn(corner.shift).transpose() * direction);
        let bars = sheet.bars().map(|edge| {
            let [i, j] = edge.key.ends();
            let along = (place(j) - place(i)).normalize();
            Row::rounded(vec![term(i, -along), term(j, along)])
        });
        let locks = sheet.edges.iter().filter(|edge| rigid_facets && edge.kind == EdgeKind::Facet).filter_map(|edge| {
            let [i, j] = edge.key.ends();
            let corners = [i, j, edge.wings[0]?, edge.wings[1]?];
            let directions = lock(&corners.map(&place));
            Some(Row::rounded((0..4).map(|k| term(corners[k], directions[k])).collect()))
        });
        Self { vertices: sheet.vertices.len(), rows: bars.chain(locks).collect() }
    }

    /// Number of columns: three coordinates of every vertex.
    pub fn columns(&self) -> usize {
        3 * self.vertices
    }

    /// Refuses what has no determinant.
    pub(crate) fn require_square(&self) -> Result<(), BlochError> {
        let (rows, columns) = (self.rows.len(), self.columns());
        if rows == columns { Ok(()) } else { Err(BlochError::NotSquare { rows, columns }) }
    }

    /// `R(z1, z2)`, rows by columns: stretches of a displacement `(u_0x, u_0y, u_0z, u_1x, ..)`.
    pub fn at(&self, z: [Complex<f64>; 2]) -> ComplexMatrix {
        self.sum_of(|shift| power(z, shift))
    }

    /// Factors that give the rows of `R(z1, z2)` one size: one for each row, the reciprocal of the magnitude of its largest
    /// term. Sizes of the rows themselves would hide roots, at which all terms of a row may cancel, as those of a bar
    /// between copies of one vertex do where `z = 1`.
    pub(crate) fn scales(&self, z: [Complex<f64>; 2]) -> Vec<f64> {
        let size = |(corner, direction): &(Corner, Vec3)| power(z, corner.shift).norm() * direction.norm();
        self.rows.iter().map(|row| row.terms.iter().map(size).fold(0.0, f64::max).recip()).collect()
    }

    /// `dR/dz_a`, for the direction `a` of 0 and 1.
    pub fn derivative(&self, z: [Complex<f64>; 2], a: usize) -> ComplexMatrix {
        self.sum_of(|shift| {
            let mut lower = shift;
            lower[a] -= 1;
            power(z, lower) * f64::from(shift[a])
        })
    }

    /// `left^H R(z1, z2) right`, its derivatives by `log z1` and `log z2`, and the sum of the magnitudes of the
    /// products that make it; rows by `left`, columns by `right`.
    pub(crate) fn pairing(
        &self,
        z: [Complex<f64>; 2],
        left: &[Complex<f64>],
        right: &[Complex<f64>],
    ) -> RigidityProduct {
        let mut found = RigidityProduct::default();
        for (row, weight) in self.rows.iter().zip(left) {
            for (corner, direction) in &row.terms {
                let moved = &right[3 * corner.vertex..][..3];
                let along: Complex<f64> = (0..3).map(|axis| moved[axis] * direction[axis]).sum();
                let product = weight.conj() * power(z, corner.shift) * along;
                found.value += product;
                found.slopes = [0, 1].map(|a| found.slopes[a] + product * f64::from(corner.shift[a]));
                let size: f64 = (0..3).map(|axis| (moved[axis] * direction[axis]).norm()).sum();
                found.size += weight.norm() * power(z, corner.shift).norm() * size;
            }
        }
        found
    }

    /// `R(1/z1, 1/z2)^T`: forces on the vertices of tensions multiplied by `z1`, `z2` from a cell to the next.
    pub fn equilibrium(&self, z: [Complex<f64>; 2]) -> ComplexMatrix {
        self.at(z.map(|z| z.inv())).transpose()
    }

    /// `det R(z1, z2)`, not centred.
    ///
    /// # Errors
    /// [`BlochError`] where the matrix is not square.
    pub fn determinant(&self, z: [Complex<f64>; 2]) -> Result<Complex<f64>, BlochError> {
        self.require_square()?;
        Ok(determinant(self.at(z)))
    }

    /// Lowest and highest power of `z1` (`a` = 0) or `z2` (1) that the determinant can have: every row contributes one
    /// of its terms.
    pub(crate) fn powers(&self, a: usize) -> [i32; 2] {
        self.rows.iter().map(|row| row.span(a)).fold([0, 0], |[low, high], [l, h]| [low + l, high + h])
    }

    fn sum_of(&self, factor: impl Fn([i32; 2]) -> Complex<f64>) -> ComplexMatrix {
        let mut matrix = ComplexMatrix::zeros(self.rows.len(), self.columns());
        for (k, row) in self.rows.iter().enumerate() {
            for (corner, direction) in &row.terms {
                let factor = factor(corner.shift);
                for axis in 0..3 {
                    matrix[(k, 3 * corner.vertex + axis)] += factor * direction[axis];
                }
            }
        }
        matrix
    }
}

/// The direction of an edge, of length one but for rounding, as a sum of two vectors: differences of coordinates are
/// taken without rounding, and all divided by one number.
fn precise_direction(sheet: &Sheet, key: &EdgeKey, lattice: &[Vec3; 2]) -> (Vec3, Vec3) {
    let [from, to] = [sheet.vertices[key.i], sheet.vertices[key.j]];
    let along = [0, 1, 2].map(|axis| {
        let shifted = [0, 1].map(|a| DoubleDouble::product(f64::from(key.shift[a]), lattice[a][axis]));
        DoubleDouble::sum(to[axis], -from[axis]).plus(shifted[0]).plus(shifted[1])
    });
    let scale = DoubleDouble { high: Vec3::from(along.map(|x| x.high)).norm().recip(), low: 0.0 };
    let unit = along.map(|x| x.times(scale));
    (Vec3::from(unit.map(|x| x.high)), Vec3::from(unit.map(|x| x.low)))
}

/// The gradient of a fold angle, scaled to the norm of a bar's row.
fn lock(points: &[Vec3; 4]) -> [Vec3; 4] {
    let gradient = fold_angle_gradient(points).1;
    let scale = std::f64::consts::SQRT_2 / gradient.norm();
    [0, 1, 2, 3].map(|k| gradient.fixed_rows::<3>(3 * k) * scale)
}

/// How cell `(n1, n2)` of a state is turned against cell `(0, 0)`, from all coordinates of the state.
pub(crate) fn cell_rotation(domain: &Domain, x: &[f64], [n1, n2]: [i32; 2]) -> Matrix3<f64> {
    domain.turns(x).map_or(Matrix3::identity(), |turns| {
        let angle = f64::from(n1) * turns.theta[0] + f64::from(n2) * turns.theta[1];
        Rotation3::new(turns.axis() * angle).into_inner()
    })
}

/// `z1^n1 z2^n2`.
pub(crate) fn power(z: [Complex<f64>; 2], [n1, n2]: [i32; 2]) -> Complex<f64> {
    z[0].powi(n1) * z[1].powi(n2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::{Embedding, Placement};
    use crate::sheet::build::{Drawing, build};
    use crate::sheet::generate;
    use crate::sheet::generate::{Pattern, Random};

    fn random(seed: u64) -> Sheet {
        generate(&Pattern::Random(Random { seed, ..Random::default() })).unwrap()
    }

    const Z: [Complex<f64>; 2] = [Complex::new(0.7, -0.4), Complex::new(-1.1, 0.3)];

    /// Claim: the row of a bar is the derivative of its length when all cells of a patch move as the mode says (central
    /// differences of the drawn patch; real and imaginary part apart, since lengths are those of real displacements).
    /// Tolerance: 1e-8 for second order differences with a step of 1e-5.
    #[test]
    fn rows_are_derivatives_of_lengths() {
        let sheet = random(3);
        let rigidity = Rigidity::of_sheet(&sheet, false).unwrap();
        assert!(rigidity.require_square().is_ok());
        let matrix = rigidity.at(Z);
        for column in 0..rigidity.columns() {
            for (k, edge) in sheet.edges.iter().enumerate() {
                let part = |phase: fn(Complex<f64>) -> f64| {
                    let length = |step: f64| {
                        let [i, j] = edge.key.ends().map(|corner| {
                            let mut moved = sheet.position(corner);
                            if corner.vertex == column / 3 {
                                moved[column % 3] += step * phase(power(Z, corner.shift));
                            }
                            moved
                        });
                        (j - i).norm()
                    };
                    (length(1e-5) - length(-1e-5)) / 2e-5
                };
                let expected = Complex::new(part(|z| z.re), part(|z| z.im));
                let error = (matrix[(k, column)] - expected).norm();
                assert!(error <= 1e-8, "{error:e}");
            }
        }
    }

    /// Claim: at real wavenumbers the row of every bar has the size 1, also where the terms of a bar between copies of one
    /// vertex cancel. Tolerance: rounding of a direction.
    #[test]
    fn rows_have_the_size_of_their_terms() {
        let corners = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 1.7, 0.0], [0.0, 1.7, 0.0], [1.0, 0.8, 0.5]];
        let coords = corners.map(Vec3::from).to_vec();
        let (faces, lattice) = ([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]], Some([coords[1], coords[3]]));
        let faces = faces.map(|face| face.to_vec()).to_vec();
        let sheet = build(&Drawing { coords, faces, lattice, ..Drawing::default() }).unwrap();
        let rigidity = Rigidity::of_sheet(&sheet, false).unwrap();
        let copies = |row: &Row| row.terms[0].0.vertex == row.terms[1].0.vertex;
        assert!(rigidity.rows.iter().any(copies));
        for z in [[Complex::ONE; 2], [Complex::new(0.6, 0.8), Complex::ONE]] {
            assert!(rigidity.scales(z).iter().all(|scale| (scale - 1.0).abs() <= 1e-14));
        }
    }

    /// Claim: `dR/dz` is the derivative of `R`. Tolerance: as above.
    #[test]
    fn derivative_in_the_factors() {
        let rigidity = Rigidity::of_sheet(&random(4), false).unwrap();
        for a in 0..2 {
            let moved = |step: f64| {
                let mut z = Z;
                z[a] += step;
                rigidity.at(z)
            };
            let difference = (moved(1e-5) - moved(-1e-5)) * Complex::new(0.5e5, 0.0);
            let error = (difference - rigidity.derivative(Z, a)).norm();
            assert!(error <= 1e-8, "{error:e}");
        }
    }

    /// Claim: the row of a locked facet is the derivative of the fold angle, up to its scale, so that a rigid motion of
    /// the whole sheet (`z = 1`) changes no row; and locked polygons of an origami sheet make more rows than columns.
    #[test]
    fn locks_keep_rigid_motions() {
        let sheet = generate(&Pattern::Miura(Default::default())).unwrap();
        let rigidity = Rigidity::of_sheet(&sheet, true).unwrap();
        let facets = sheet.edges.iter().filter(|edge| edge.kind == EdgeKind::Facet).count();
        assert_eq!(rigidity.rows.len(), rigidity.columns() + facets);
        assert!(matches!(rigidity.determinant(Z), Err(BlochError::NotSquare { .. })));
        for row in &rigidity.rows {
            let sum: Vec3 = row.terms.iter().map(|(_, direction)| direction).sum();
            let moment: Vec3 = row.terms.iter().map(|(corner, d)| sheet.position(*corner).cross(d)).sum();
            let size: f64 = row.terms.iter().map(|(_, direction)| direction.norm_squared()).sum();
            assert!(sum.amax() <= 1e-14 && moment.amax() <= 1e-14 && (size - 2.0).abs() <= 1e-14);
        }
    }

    /// Claim: a state that is not bent is its own cylinder: the two constructions give the same determinant, in
    /// whichever frame the state is embedded. Tolerance: rounding of a 12 x 12 determinant.
    #[test]
    fn flat_cylinders_are_periodic() {
        let sheet = random(5);
        let embedding = Embedding::new(&sheet).unwrap();
        let placement: Placement = embedding.place(embedding.drawn_angles());
        let shape = Shape::of(&embedding, placement).unwrap();
        let straight = Rigidity::of_sheet(&sheet, false).unwrap().determinant(Z).unwrap();
        let screw = Rigidity::of_cylinder(&sheet, &shape).determinant(Z).unwrap();
        assert!((straight - screw).norm() <= 1e-12 * straight.norm(), "{straight} {screw}");
    }

    /// Claim: every power of the determinant lies within the bounds: along a circle of radius `R` the determinant times
    /// `R^-highest` stays bounded for large `R`, and times `R^-lowest` for small ones.
    #[test]
    fn powers_bound_the_determinant() {
        let rigidity = Rigidity::of_sheet(&random(6), false).unwrap();
        let size = |radius: f64, a: usize| {
            let mut z = Z;
            z[a] = Complex::new(0.6, 0.8) * radius;
            rigidity.determinant(z).unwrap().norm()
        };
        for a in 0..2 {
            let [low, high] = rigidity.powers(a);
            assert!(low < high);
            assert!(size(1e3, a) * 1e-3f64.powi(high) <= 10.0 && size(1e-3, a) * 1e3f64.powi(low) <= 10.0);
        }
    }
}
