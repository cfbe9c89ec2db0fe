//! Membranes: triangles that are stretched and sheared as a whole, where bars are too coarse.
//!
//! A triangle whose corners move has one strain of Green and Lagrange, `e = (F^T F - 1) / 2`, which is linear in the
//! squares of its sides. With Young's modulus `E`, Poisson's ratio `nu`, the thickness `t` and the drawn area `A` it
//! stores, as St. Venant and Kirchhoff have it in plane stress,
//!
//! `A t / 2 (E / (2 (1 - nu)) (e11 + e22)^2 + E / (2 (1 + nu)) ((e11 - e22)^2 + (2 e12)^2))`:
//!
//! three springs whose measures, three parts of the strain times the root of `A`, are lengths that are zero as drawn. With the gradients `g` of the
//! barycentric coordinates, `e = -sum (l^2 - L^2) (g_i g_j^T + g_j g_i^T) / 4` over the sides `ij` of length `l`, drawn
//! `L`. Source: O. C. Zienkiewicz and R. L. Taylor, The finite element method for solid and structural mechanics
//! (2005), the triangle of constant strain.

use super::assembly::Assembly;
use super::element::{Term, TermKind};
use super::law::Spring;
use super::material::Material;
use super::measure::Measure;
use super::own_term::{MEMBRANE, OwnTerm};
use crate::math::{Vec3, lower_triangle};
use nalgebra::{SVector, Vector2};
use std::sync::Arc;

/// A part of the strain of a triangle times the root of its drawn area, a length: a sum over its sides, from each corner
/// to the next, of a weight times what the square of the length is more than that of the drawn one.
#[derive(Clone, Copy, Debug)]
struct Strain {
    weights: [f64; 3],
    drawn: [f64; 3],
}

/// Returns the sides of a triangle, from each corner to the next.
fn sides(points: &[Vec3; 3]) -> [Vec3; 3] {
    [0, 1, 2].map(|k| points[(k + 1) % 3] - points[k])
}

impl Strain {
    /// Returns `e11 + e22`, `e11 - e22` and `2 e12` of a triangle that is drawn with these corners, times the root of its
    /// area.
    fn parts(corners: &[Vec3; 3]) -> [Self; 3] {
        let [first, second, third] = sides(corners);
        let (length, along) = (first.norm(), -third.dot(&first) / first.norm());
        let height = first.cross(&third).norm() / length;
        let size = (0.5 * length * height).sqrt();
        let places = [Vector2::zeros(), Vector2::new(length, 0.0), Vector2::new(along, height)];
        let gradient = |k: usize| {
            let opposite: Vector2<f64> = places[(k + 2) % 3] - places[(k + 1) % 3];
            Vector2::new(-opposite.y, opposite.x) / (length * height)
        };
        let drawn = [first, second, third].map(|side| side.norm_squared());
        let part = |of: fn(Vector2<f64>, Vector2<f64>) -> f64| Self {
            weights: [0, 1, 2].map(|k| -0.5 * size * of(gradient(k), gradient((k + 1) % 3))),
            drawn,
        };
        let dilation = part(|g, h| g.dot(&h));
        let shears = [part(|g, h| g.x * h.x - g.y * h.y), part(|g, h| g.x * h.y + g.y * h.x)];
        [dilation, shears[0], shears[1]]
    }
}

impl Measure<3, 9> for Strain {
    fn value(&self, points: &[Vec3; 3]) -> f64 {
        let sides = sides(points);
        (0..3).map(|k| self.weights[k] * (sides[k].norm_squared() - self.drawn[k])).sum()
    }

    fn gradient(&self, points: &[Vec3; 3]) -> (f64, SVector<f64, 9>) {
        let mut gradient = SVector::<f64, 9>::zeros();
        for (k, side) in sides(points).into_iter().enumerate() {
            let slope = 2.0 * self.weights[k] * side;
            let next = (k + 1) % 3;
            gradient.fixed_rows_mut::<3>(3 * next).axpy(1.0, &slope, 1.0);
            gradient.fixed_rows_mut::<3>(3 * k).axpy(-1.0, &slope, 1.0);
        }
        (self.value(points), gradient)
    }

    /// The Hessian does not depend on the points: each side couples its ends axis by axis.
    fn hessian(&self, points: &[Vec3; 3], lower: &mut Vec<f64>) -> (f64, SVector<f64, 9>) {
        let between = |i: usize, j: usize| {
            let side = if (i + 1) % 3 == j { i } else { j };
            if i == j { 2.0 * (self.weights[i] + self.weights[(i + 2) % 3]) } else { -2.0 * self.weights[side] }
        };
        lower.clear();
        let entry = |(row, column)| if row % 3 == column % 3 { between(row / 3, column / 3) } else { 0.0 };
        lower.extend(lower_triangle(9).map(entry));
        self.gradient(points)
    }
}

impl OwnTerm {
    /// Makes the membrane of a sheet, in the place of its bars: every triangle is stretched and sheared as a plate in
    /// plane stress, without force as drawn. Its energy is listed as `membrane`.
    ///
    /// ```
    /// use foldwell::model::{Material, OwnTerm};
    /// use foldwell::{Assembly, Pattern, Rest, generate, relax};
    ///
    /// let sheet = generate(&Pattern::named("miura")?)?;
    /// let hinges = Assembly::patch(sheet, [2, 2]).creases(1.0).facets(10.0).rest(Rest::Angle(0.5)).build()?;
    /// let paper = Material { young: 3000.0, poisson: 0.3, thickness: 0.1, crease_length: None };
    /// let state = relax(&hinges.with_own_term(OwnTerm::membrane(&hinges, &paper)))?.state;
    /// assert!(state.energy_of_term("membrane") > 0.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn membrane(assembly: &Assembly, material: &Material) -> Self {
        let Material { young, poisson, thickness, .. } = *material;
        let moduli = [1.0 - poisson, 1.0 + poisson, 1.0 + poisson].map(|part| 0.5 * young * thickness / part);
        let (mut elements, mut springs) = (Vec::new(), Vec::new());
        for triangle in &assembly.tiling().triangles {
            let sites = triangle.corners;
            let drawn = assembly.drawn();
            let parts = Strain::parts(&drawn.domain.points(&drawn.coordinates, &sites));
            elements.extend(parts.map(|part| (part, sites)));
            springs.extend(moduli.map(|stiffness| Spring { stiffness, rest: 0.0 }));
        }
        let elements = Arc::new(Term::of_each((TermKind::Own, MEMBRANE), elements));
        Self { has_tensions: true, ..Self::of(elements, springs) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::DenseMatrix;
    use crate::numerics::derivatives::{TOLERANCE, check_gradient, check_jacobian};
    use nalgebra::{Matrix2, Matrix3x2};

    const DRAWN: [Vec3; 3] = [Vec3::new(0.3, -0.2, 0.5), Vec3::new(1.4, 0.1, 0.2), Vec3::new(0.6, 1.1, -0.4)];

    fn points(x: &[f64]) -> [Vec3; 3] {
        [0, 1, 2].map(|k| Vec3::from_column_slice(&x[3 * k..3 * k + 3]))
    }

    /// Claim: every entry of gradient and Hessian is that of the value. Source: differences.
    #[test]
    fn strains_have_their_derivatives() {
        let x = [0.1, -0.4, 0.2, 1.3, 0.5, -0.3, 0.2, 1.0, 0.6];
        for part in Strain::parts(&DRAWN) {
            let mut lower = vec![f64::NAN; 2];
            let (value, gradient) = part.hessian(&points(&x), &mut lower);
            assert_eq!((value, gradient), part.gradient(&points(&x)));
            assert_eq!(value, part.value(&points(&x)));
            check_gradient(|x| part.value(&points(x)), &x, gradient.as_slice(), TOLERANCE).unwrap();
            let entry = |row: usize, column: usize| {
                let (row, column) = (row.max(column), row.min(column));
                lower[row * (row + 1) / 2 + column]
            };
            let hessian = DenseMatrix::from_fn(9, 9, entry);
            let slope = |x: &[f64]| part.gradient(&points(x)).1.as_slice().to_vec();
            check_jacobian(slope, &x, &hessian, TOLERANCE).unwrap();
        }
    }

    /// Claim: the three measures are the parts of Green's strain of any affine map of the plane of the triangle into
    /// space, in axes of which the first is along its first side. Source: `(F^T F - 1) / 2`. Tolerance: rounding.
    #[test]
    fn strains_are_those_of_affine_maps() {
        let first = sides(&DRAWN)[0].normalize();
        let normal = sides(&DRAWN)[0].cross(&sides(&DRAWN)[1]).normalize();
        let axes = Matrix3x2::from_columns(&[first, normal.cross(&first)]);
        let map = Matrix3x2::new(1.2, 0.3, -0.1, 0.8, 0.4, 0.2);
        let strain: Matrix2<f64> = 0.5 * (map.transpose() * map - Matrix2::identity());
        let moved = DRAWN.map(|corner| map * (axes.transpose() * corner));
        let area = 0.5 * sides(&DRAWN)[0].cross(&sides(&DRAWN)[1]).norm();
        let expected = [strain.trace(), strain[(0, 0)] - strain[(1, 1)], 2.0 * strain[(0, 1)]];
        for (part, strain) in Strain::parts(&DRAWN).iter().zip(expected) {
            let expected = strain * area.sqrt();
            assert!((part.value(&moved) - expected).abs() < 1e-14, "{} {expected}", part.value(&moved));
            assert_eq!(part.value(&DRAWN), 0.0);
        }
    }
}
