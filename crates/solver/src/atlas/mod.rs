//! Surfaces `F(x) = 0` covered by an atlas of charts.
//!
//! A chart is a point of the surface with two orthonormal tangents and a radius; its ball is cut by those of its
//! neighbours to a `polygon`. While a corner of the polygon lies outside the ball, a new chart is placed on the rim and
//! corrected onto the surface (M. E. Henderson, "Multiple parameter continuation: computing implicitly defined
//! k-manifolds", International Journal of Bifurcation and Chaos 12 (2002) 451-476; here the place is where the rims of
//! two balls meet, so that centres are no closer than a radius). Points are neighbours modulo the periods of the
//! unknowns, so that a surface can close. The triangles are dual to the polygons, see `mesh`, and are cut where the
//! surface's limit is met, see `cut`.
//!
//! A radius follows the turning of the tangent plane. Towards a singular point, as the tip of a cone, radii shrink with
//! the distance, so that no chart reaches across it; below a hundredth of the largest radius a chart stays open.
//!
//! A surface that crosses another, where tangents are not determined, is followed from a chart to the next, see `walk`;
//! the turning of its tangent plane is that on the way. Next to an edge sharper than the smallest chart such a chart is
//! given up after some visits, and none is placed where one was given up.

mod cover;
mod cut;
mod grid;
mod mesh;
mod polygon;
mod seen;
mod surface;
#[cfg(test)]
mod tests;
mod walk;

pub use surface::{Atlas, AtlasError, Chart, CoverOptions, Coverage, KEPT, Surface};
pub use walk::HyperplaneSection;

/// Finds further starts from the charts and triangles placed so far: points on parts of the surface that meet these in
/// singular points only.
pub type Further<'a, S> = &'a mut dyn FnMut(&mut S, &[Chart], &[[usize; 3]]) -> Vec<Vec<f64>>;

/// Covers the parts of a surface that hold the `starts`: points on it, or within a thousandth of the radius of it, at
/// which it is not singular. A start that lies in a chart already is passed over. Once all that is reached from them is
/// covered,
/// `further` is asked for more, until it has none.
///
/// `observe` is told the number of charts from time to time and returns false to stop. What is kept then are the first
/// [`KEPT`] charts and their triangles, so that stopping is quick however many there are.
///
/// # Errors
/// [`AtlasError`] where a start is not a regular point of the surface.
pub fn cover<S: Surface>(
    surface: &mut S,
    starts: &[Vec<f64>],
    options: CoverOptions,
    further: Further<'_, S>,
    observe: &mut dyn FnMut(usize) -> bool,
) -> Result<Atlas, AtlasError> {
    let mut cover = cover::Cover::new(surface, options);
    let mut reached = Vec::new();
    for (number, start) in starts.iter().enumerate() {
        reached.push(Some(cover.start(number, start)?));
    }
    let (mut coverage, triangles) = loop {
        let mut coverage = cover.run(observe);
        let rings = cover.rings(&mut coverage, observe);
        let triangles = mesh::triangles(&rings, &|a, b| cover.distance(a, b));
        let more = if coverage.is_whole() { further(cover.surface, &cover.charts, &triangles) } else { Vec::new() };
        if more.is_empty() {
            break (coverage, triangles);
        }
        for start in more {
            reached.push(cover.start(reached.len(), &start).ok());
        }
    };
    let oriented = cover.oriented;
    let (charts, triangles) = cut::at_limit(&mut cover, triangles, &mut coverage, observe);
    Ok(Atlas { charts, triangles, reached, coverage, oriented })
}
