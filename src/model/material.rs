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
//! - **Panels with a vertex at their centre** ([`with_centres`](crate::sheet::with_centres), model N5B8 of the same
//!   paper). Of sides `W` and `H`, means of opposite ones, a side of length `W` gets the cross section `A = t |H^2 - nu
//!   W^2| / (2 H (1 - nu^2))`, and every half diagonal `A = t nu (W^2 + H^2)^(3/2) / (2 W H (1 - nu^2))`. A rectangle
//!   that is stretched along its sides then stores what the sheet stores, for every `nu`, as long as `H^2 > nu W^2`;
//!   sheared, `2 nu / (1 - nu)` of it, all of it at `nu = 1/3`. Half of a diagonal of length `L` has the moment `D (L /
//!   t)^(1/3) / L` for each radian and length, without the factor 0.55.
//! - **Creases.** `D / L*` for each length of crease, with the length scale `L*` of the crease: as a strip of the sheet
//!   of this width bends. Source: F. Lechenault, B. Thiria and M. Adda-Bedia, Phys. Rev. Lett. 112, 244301 (2014), and
//!   Filipov et al. (2017).

use super::assembly::Assembly;
use super::stiffness::Stiffness;
use crate::math::Vec3;
use crate::sheet::cell::TriangleSide;
use crate::sheet::{EdgeKey, EdgeKind, Sheet, TiledEdge};
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
        let panels = self.of_panels(sheet);
        let mut of_patch: HashMap<(EdgeKey, [usize; 2]), f64> = HashMap::new();
        for tiled in &tiling.triangles {
            let points = tiled.corners.map(|site| drawn.domain.point(&drawn.coordinates, site));
            for (side, section) in self.sections((sheet, &panels), tiled.triangle, points) {
                let at = [0, 1].map(|a| tiled.cell[a] + side.base.shift[a]);
                let cell = [0, 1].map(|a| at[a].rem_euclid(tiling.cells[a] as i32) as usize);
                *of_patch.entry((side.key, cell)).or_default() += section;
            }
        }
        let mut of_cell: HashMap<EdgeKey, f64> = HashMap::new();
        for (number, triangle) in sheet.triangles.iter().enumerate() {
            let points = triangle.corners.map(|corner| sheet.position(corner));
            for (side, section) in self.sections((sheet, &panels), number, points) {
                *of_cell.entry(side.key).or_default() += section;
            }
        }
        let section = |tiled: &TiledEdge| {
            let key = sheet.edges[tiled.edge].key.whole();
            of_patch.get(&(key, tiled.cell)).or(of_cell.get(&key)).copied().unwrap_or(f64::NAN)
        };
        tiling.edges.iter().map(|tiled| self.young * section(tiled)).collect::<Vec<f64>>().into()
    }

    /// Returns the sides of a triangle with these corners, each with the cross section that it gives to that edge: as a
    /// part of its panel, if it is one.
    fn sections(
        &self,
        (sheet, panels): (&Sheet, &HashMap<usize, HashMap<EdgeKey, f64>>),
        triangle: usize,
        points: [Vec3; 3],
    ) -> [(TriangleSide, f64); 3] {
        let sides = sheet.triangles[triangle].sides();
        let alone = |k: usize| self.section([points[k], points[(k + 1) % 3]], points[(k + 2) % 3]);
        let section = |k: usize| panels.get(&triangle).map_or_else(|| alone(k), |panel| panel[&sides[k].key]);
        std::array::from_fn(|k| (sides[k], section(k)))
    }

    /// Returns the cross sections that each triangle of a panel gives to its sides, by its number.
    fn of_panels(&self, sheet: &Sheet) -> HashMap<usize, HashMap<EdgeKey, f64>> {
        let (mut found, nu) = (HashMap::new(), self.poisson);
        let plane = self.thickness / (2.0 * (1.0 - nu * nu));
        for panel in &sheet.panels {
            let edges = panel.edges(sheet);
            let rim = edges.map(|[_, rim]| sheet.length(rim));
            let mean = |k: usize| (rim[k % 4] + rim[(k + 2) % 4]) / 2.0;
            for (k, triangle) in panel.triangles.into_iter().enumerate() {
                let (w, h) = (mean(k), mean(k + 1));
                // a half diagonal lies between two triangles of its panel
                let spoke = plane * nu * (w * w + h * h).powf(1.5) / (w * h) / 2.0;
                let side = plane * (h * h - nu * w * w).abs() / h;
                let [[from, rim], [to, _]] = [edges[k], edges[(k + 1) % 4]];
                found.insert(triangle, HashMap::from([(from, spoke), (to, spoke), (rim, side)]));
            }
        }
        found
    }

    /// Returns the cross section that the triangle of an edge and this third corner gives to the edge.
    fn section(&self, [a, b]: [Vec3; 2], wing: Vec3) -> f64 {
        let perimeter = (b - a).norm() + (wing - b).norm() + (a - wing).norm();
        (b - a).cross(&(wing - a)).norm() * self.thickness / ((1.0 - self.poisson) * perimeter)
    }

    /// Returns the stiffness of the diagonal of a polygon, or of half of one, of every edge of the tiling, moment per
    /// radian and length; NaN for other edges.
    pub fn facets(&self, assembly: &Assembly) -> Stiffness {
        let (mut each, sheet) = (Vec::with_capacity(assembly.edges()), assembly.sheet());
        let mut diagonals = HashMap::new();
        for spokes in sheet.panels.iter().map(|panel| panel.edges(sheet).map(|[spoke, _]| spoke)) {
            let length = |k: usize| sheet.length(spokes[k % 4]);
            diagonals.extend((0..4).map(|k| (spokes[k], length(k) + length(k + 2))));
        }
        for tiled in &assembly.tiling().edges {
            let of_panel = diagonals.get(&sheet.edges[tiled.edge].key).map(|&length| (length, 1.0));
            let (length, factor) = of_panel.unwrap_or_else(|| (assembly.drawn().distance(&tiled.ends), RIDGE));
            let stiffness = factor * self.bending_stiffness() * (length / self.thickness).cbrt() / length;
            each.push(if tiled.kind == EdgeKind::Facet { stiffness } else { f64::NAN });
        }
        each.into()
    }

    /// Returns the stiffness of all creases, moment per radian and length; `None` without their length scale.
    pub fn creases(&self) -> Option<Stiffness> {
        Some((self.bending_stiffness() / self.crease_length?).into())
    }
}
