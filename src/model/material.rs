//! The stiffnesses of bars and hinges that stand for an elastic sheet of uniform thickness.
//!
//! The formulas below have Young's modulus `E`, Poisson's ratio `nu`, the thickness `t`, and the bending stiffness of a
//! plate `D = E t^3 / (12 (1 - nu^2))`:
//!
//! - **Bars.** A triangle of area `S` and perimeter `P` gives each of its edges the cross section `A = 2 S t / ((1 -
//!   nu) P)`; an edge of two triangles has the sum. Where all lengths grow by the strain `e`, its bars store `E A P e^2
//!   / 2 = E S t e^2 / (1 - nu)`, which is what the sheet stores: a stretch that is the same in all directions is exact
//!   on every mesh. Other stretches are where the bars make an isotropic sheet of the right Poisson's ratio, as
//!   equilateral triangles do at `nu = 1/3`. Source: K. Liu and G. H. Paulino, Highly efficient nonlinear structural
//!   analysis of origami assemblages using the MERLIN2 software, Origami 7 (2018), triangular panels.
//! - **Facets.** A polygon with straight sides bends in a ridge along its diagonal of length `L`, with the moment `0.55
//!   D (L / t)^(1/3)` for each radian; for each length of the diagonal this is `0.55 D (L / t)^(1/3) / L`. Source: E.
//!   T. Filipov, K. Liu, T. Tachi, M. Schenk and G. H. Paulino, Int. J. Solids Struct. 124, 26 (2017), model N4B5 with
//!   right angles; the power of a third: A. Lobkovsky et al., Science 270, 1482 (1995).
//! - **Creases.** `D / L*` for each length of crease, with the length scale `L*` of the crease: as a strip of the sheet
//!   of this width bends. Source: F. Lechenault, B. Thiria and M. Adda-Bedia, Phys. Rev. Lett. 112, 244301 (2014), and
//!   Filipov et al. (2017).

use super::assembly::Assembly;
use super::stiffness::Stiffness;
use crate::math::Vec3;
use crate::sheet::cell::TriangleSide;
use crate::sheet::{EdgeKey, EdgeKind, TiledEdge, Triangle};
use std::collections::HashMap;

/// The moment of a ridge for each radian, over `D (L / t)^(1/3)`.
const RIDGE: f64 = 0.55;

/// An elastic sheet of uniform thickness, in the units of the scene.
///
/// ```
/// use foldwell::{Assembly, Pattern, generate, model::Material};
///
/// // polypropylene in newtons and millimetres
/// let sheet = generate(&Pattern::named("miura")?)?;
/// let material = Material { young: 1400.0, poisson: 0.4, thickness: 0.3, crease_length: Some(10.0) };
/// let assembly = Assembly::patch(sheet, [2, 2]).material(material).build()?;
/// let creases = assembly.terms().creases.as_ref().ok_or("the material has creases")?;
/// assert!((creases.stiffness.of(0) - 1400.0 * 0.027 / (12.0 * 0.84) / 10.0).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Young's modulus, force per area.
    pub young: f64,
    /// Poisson's ratio, above -1 and below 1.
    pub poisson: f64,
    /// Thickness of the sheet.
    pub thickness: f64,
    /// Length scale of the creases, the width of the strip of sheet that bends as one of them; `None`: it says nothing
    /// of creases.
    pub crease_length: Option<f64>,
}

impl Material {
    /// Returns the bending stiffness of the sheet, `E t^3 / (12 (1 - nu^2))`, force times length.
    pub fn bending_stiffness(&self) -> f64 {
        self.young * self.thickness.powi(3) / (12.0 * (1.0 - self.poisson * self.poisson))
    }

    /// Returns the stiffness `EA` of the bar of every edge of the tiling, from the drawn triangles at it. An edge at
    /// the rim of a patch whose triangles are all beyond it has that of the cell.
    pub fn bars(&self, assembly: &Assembly) -> Stiffness {
        let (sheet, tiling, drawn) = (assembly.sheet(), assembly.tiling(), assembly.drawn());
        let mut of_patch: HashMap<(EdgeKey, [usize; 2]), f64> = HashMap::new();
        for tiled in &tiling.triangles {
            let points = tiled.corners.map(|site| drawn.domain.point(&drawn.coordinates, site));
            for (side, section) in self.sections(&sheet.triangles[tiled.triangle], points) {
                let at = [0, 1].map(|a| tiled.cell[a] + side.base.shift[a]);
                let cell = [0, 1].map(|a| at[a].rem_euclid(tiling.cells[a] as i32) as usize);
                *of_patch.entry((side.key, cell)).or_default() += section;
            }
        }
        let mut of_cell: HashMap<EdgeKey, f64> = HashMap::new();
        for triangle in &sheet.triangles {
            for (side, section) in self.sections(triangle, triangle.corners.map(|corner| sheet.position(corner))) {
                *of_cell.entry(side.key).or_default() += section;
            }
        }
        let section = |tiled: &TiledEdge| {
            let key = sheet.edges[tiled.edge].key.whole();
            of_patch.get(&(key, tiled.cell)).or(of_cell.get(&key)).copied().unwrap_or(f64::NAN)
        };
        tiling.edges.iter().map(|tiled| self.young * section(tiled)).collect::<Vec<f64>>().into()
    }

    /// Returns the sides of a triangle with these corners, each with the cross section that it gives to that edge.
    fn sections(&self, triangle: &Triangle, points: [Vec3; 3]) -> [(TriangleSide, f64); 3] {
        let sides = triangle.sides();
        std::array::from_fn(|k| (sides[k], self.section([points[k], points[(k + 1) % 3]], points[(k + 2) % 3])))
    }

    /// Returns the cross section that the triangle of an edge and this third corner gives to the edge.
    fn section(&self, [a, b]: [Vec3; 2], wing: Vec3) -> f64 {
        let perimeter = (b - a).norm() + (wing - b).norm() + (a - wing).norm();
        (b - a).cross(&(wing - a)).norm() * self.thickness / ((1.0 - self.poisson) * perimeter)
    }

    /// Returns the stiffness of the diagonal of a polygon of every edge of the tiling, moment per radian and length;
    /// NaN for other edges.
    pub fn facets(&self, assembly: &Assembly) -> Stiffness {
        let mut each = Vec::with_capacity(assembly.edges());
        for tiled in &assembly.tiling().edges {
            let length = assembly.drawn().distance(&tiled.ends);
            let stiffness = RIDGE * self.bending_stiffness() * (length / self.thickness).cbrt() / length;
            each.push(if tiled.kind == EdgeKind::Facet { stiffness } else { f64::NAN });
        }
        each.into()
    }

    /// Returns the stiffness of all creases, moment per radian and length; `None` without their length scale.
    pub fn creases(&self) -> Option<Stiffness> {
        Some((self.bending_stiffness() / self.crease_length?).into())
    }
}
