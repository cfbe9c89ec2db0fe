//! Pressure on faces: a force that stays normal to them.
//!
//! A pressure `p` pushes every triangle of area `A` along its normal with the force `p A`, a third of it at each
//! corner. Its potential is `-p V`, `V` the volume that the faces enclose with their normals outwards, a sum over
//! triangles of the volumes between them and one point, whichever it is. There is a potential only where the faces
//! close, or their rim is held. Source: J. Bonet, R. D. Wood, Nonlinear Continuum Mechanics for Finite Element Analysis
//! (2008), section 8.6, the enclosed boundary case.

use super::assembly::Assembly;
use super::assembly_error::AssemblyError;
use super::domain::Domain;
use super::element::{Head, Term, TermKind};
use super::law::{Law, Spring, Stored};
use super::measure::Measure;
use super::own_term::OwnTerm;
use super::terms::Part;
use crate::math::{Vec3, lower_triangle};
use crate::sheet::sides::open_sides;
use crate::sheet::tiling::Site;
use nalgebra::{Matrix3, SVector};
use std::sync::Arc;

/// The volume between a triangle and a point, positive where the triangle turns its back to the point.
#[derive(Clone, Copy, Debug)]
struct VolumeFrom(Vec3);

impl VolumeFrom {
    fn spokes(&self, points: &[Vec3; 3]) -> [Vec3; 3] {
        points.map(|point| point - self.0)
    }
}

impl Measure<3, 9> for VolumeFrom {
    fn value(&self, points: &[Vec3; 3]) -> f64 {
        let [a, b, c] = self.spokes(points);
        a.dot(&b.cross(&c)) / 6.0
    }

    fn gradient(&self, points: &[Vec3; 3]) -> (f64, SVector<f64, 9>) {
        let [a, b, c] = self.spokes(points);
        let normals = [b.cross(&c), c.cross(&a), a.cross(&b)];
        (self.value(points), SVector::from_fn(|k, _| normals[k / 3][k % 3] / 6.0))
    }

    /// The Hessian has zero blocks of each corner with itself: the volume is linear in each.
    fn hessian(&self, points: &[Vec3; 3], lower: &mut Vec<f64>) -> (f64, SVector<f64, 9>) {
        let [of_a, of_b, of_c] = self.spokes(points).map(|spoke| spoke.cross_matrix() / 6.0);
        let nothing = Matrix3::zeros();
        // d2V = dc . (da x b) + .. : rows are the later corner, columns the earlier one
        let rows = [[nothing; 3], [of_c, nothing, nothing], [-of_b, of_a, nothing]];
        lower.clear();
        lower.extend(lower_triangle(9).map(|(row, column)| rows[row / 3][column / 3][(row % 3, column % 3)]));
        self.gradient(points)
    }
}

/// The law of a constant force, the spring constant, that lets the measure grow: that of a load.
#[derive(Debug)]
pub(super) struct Push;

impl Law for Push {
    fn at(&self, value: f64, _rest: f64) -> [f64; 3] {
        [-value, -1.0, 0.0]
    }

    fn by_rest(&self, _value: f64, _rest: f64) -> [f64; 3] {
        [0.0; 3]
    }
}

impl OwnTerm {
    /// Makes the pressure of this name, empty where no drive refers to it, on the polygons of a patch whose numbers in the
    /// sheet `on` accepts, in all cells: a force per area, positive along the face normals. A rim whose vertices are one
    /// rigid part is that of a plate, which has the pressure too. As a load it has no energy in tables, and a drive of the
    /// loads drives it.
    ///
    /// ```
    /// use foldwell::model::OwnTerm;
    /// use foldwell::sheet::{Pattern, generate};
    /// use foldwell::{Assembly, relax};
    ///
    /// // a drum with both ends, stretched by the air in it
    /// let drum = generate(&Pattern::of(&"pattern = \"kresling\"\nclosed = true".parse()?)?)?;
    /// let assembly = Assembly::patch(drum, [1, 1]).bars(100.0).creases(0.1).build()?;
    /// let blown_up = assembly.with_own_term(OwnTerm::pressure(&assembly, "air", 0.5, |_| true)?);
    /// assert!(relax(&blown_up)?.state.energy_bars > 1e-3);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`AssemblyError::Open`] if these faces enclose no volume: at a side that is not pinned more of them have it in one
    /// direction than in the other. [`AssemblyError::NoPatch`] for other boundary conditions.
    pub fn pressure(
        assembly: &Assembly,
        name: &str,
        value: f64,
        on: impl Fn(usize) -> bool,
    ) -> Result<Self, AssemblyError> {
        let tiling = assembly.tiling();
        if *assembly.domain() != Domain::Patch {
            return Err(AssemblyError::NoPatch);
        }
        let polygon = |triangle: usize| assembly.sheet().triangles[triangle].polygon;
        let faces = tiling.triangles.iter().filter(|triangle| on(polygon(triangle.triangle)));
        let mut faces: Vec<[usize; 3]> = faces.map(|triangle| triangle.corners.map(|site| site.vertex)).collect();
        faces.extend(lids(&open_sides(&faces), &assembly.terms().parts));
        let pins = &assembly.terms().pins;
        let held = |vertex: &usize| pins.iter().any(|(pinned, axes)| pinned == vertex && *axes == [true; 3]);
        if let Some(&vertices) = open_sides(&faces).iter().find(|ends| !ends.iter().all(held)) {
            return Err(AssemblyError::Open { vertices });
        }
        let drawn = assembly.drawn().coordinates.chunks_exact(3).map(Vec3::from_column_slice);
        let centre = drawn.sum::<Vec3>() / tiling.positions.len().max(1) as f64;
        let springs = vec![Spring { stiffness: value, rest: 0.0 }; faces.len()];
        let site = |vertex: usize| Site { vertex, shift: [0, 0] };
        let elements = faces.into_iter().map(|corners| (corners.map(site), None)).collect();
        let push: Arc<dyn Law> = Arc::new(Push);
        let term = Term::new((TermKind::Pressure, name), VolumeFrom(centre), elements, |_| Stored::Law(push.clone()));
        Ok(Self::of(Arc::new(term), springs))
    }

    /// Returns the name of the pressure and the volume that its faces enclose in the state with these coordinates of a
    /// patch, where only a rim is pinned that between the faces and the centre of the drawn vertices; `None` if it is no
    /// pressure with a name.
    pub fn volume(&self, coordinates: &[f64]) -> Option<(&str, f64)> {
        let Head { kind, name, .. } = self.elements.head();
        let of = |k| self.elements.value(k, &Domain::Patch, coordinates);
        let is_named = *kind == TermKind::Pressure && !name.is_empty();
        is_named.then(|| (name.as_str(), (0..self.elements.len()).map(of).sum()))
    }
}

/// Returns triangles that close the rims of rigid parts, one over each open side between two vertices of a part:
/// whatever the shape of a plate, the pressure on it is the same.
fn lids(open: &[[usize; 2]], parts: &[Part]) -> Vec<[usize; 3]> {
    let mut lids = Vec::new();
    for part in parts {
        let rim: Vec<_> = open.iter().filter(|side| side.iter().all(|end| part.vertices.contains(end))).collect();
        let Some([top, _]) = rim.first() else { continue };
        lids.extend(rim.iter().filter(|side| !side.contains(top)).map(|[a, b]| [*b, *a, *top]));
    }
    lids
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::tests::check_derivatives;

    /// Claim: the volumes between the faces of a tetrahedron and any point, inside it or not, sum to a sixth of the
    /// product of its edges at the right angle. Tolerance: rounding.
    #[test]
    fn volumes_sum_to_that_of_the_body() {
        let corners = [Vec3::zeros(), Vec3::x(), Vec3::y() * 2.0, Vec3::z() * 3.0];
        let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]].map(|face| face.map(|corner: usize| corners[corner]));
        for from in [Vec3::new(0.1, 0.2, 0.3), Vec3::new(-5.0, 2.0, 9.0)] {
            let sum: f64 = faces.iter().map(|face| VolumeFrom(from).value(face)).sum();
            assert!((sum - 1.0).abs() < 1e-13, "{sum}");
        }
    }

    /// Claim: gradient and Hessian of the volume are its differences.
    #[test]
    fn volumes_have_their_derivatives() {
        let measure = VolumeFrom(Vec3::new(0.3, -0.2, 0.7));
        let points = [Vec3::new(1.0, 0.1, 0.2), Vec3::new(-0.3, 1.2, 0.4), Vec3::new(0.2, -0.5, 1.9)];
        check_derivatives(&measure, &points);
    }
}
