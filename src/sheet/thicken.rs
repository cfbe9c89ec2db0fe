//! The solid that a sheet with a thickness is, for printers.

use std::collections::BTreeMap;

use nalgebra::Matrix3;

use super::build::{Drawing, build};
use super::cell::{Corner, Sheet};
use super::error::{Defect, MeshPart, MeshProblem};
use super::sides::open_sides;
use crate::math::Vec3;
use crate::numerics::dense::small::solve_3;

/// Largest distance of a vertex of the solid from that of the sheet, in half thicknesses, beyond which corners are blunt:
/// that of a fold of 151 degrees, where pens that draw a line with corners end them too (`stroke-miterlimit` of SVG).
const FARTHEST: f64 = 4.0;
/// Part of the weights of the faces at a vertex that holds its offset where their normals leave it free.
const HELD: f64 = 1e-9;

/// The solid that a sheet with a thickness is.
#[derive(Clone, Debug)]
pub struct Solid {
    /// Its closed surface.
    pub surface: Sheet,
    /// Its least thickness, as a part of that asked for. It is below 1 at vertices whose moved faces have no common point,
    /// as most with Gaussian curvature and more than three planes, and where that point is far: at folds beyond 151 degrees.
    pub thinnest: f64,
}

/// Returns the solid whose faces are those of the cell of a sheet, moved by half of `thickness` to both sides, with walls
/// along the boundary.
///
/// ```
/// use foldwell::sheet::{Pattern, generate, thickened};
///
/// let cell = generate(&Pattern::named("miura")?)?;
/// let solid = thickened(&cell, 0.05)?;
/// // both sides of the 8 triangles, and walls of two triangles at the 8 sides of the cell
/// assert_eq!(solid.surface.triangles.len(), 2 * cell.triangles.len() + 2 * 8);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Defect`] if the sheet is not one surface with two sides, or if the surface of the solid is none: layers that lie on each
/// other leave no room for it, or a face of it has no area, as with a thickness that is zero or no number.
pub fn thickened(sheet: &Sheet, thickness: f64) -> Result<Solid, Defect> {
    if !sheet.is_surface() {
        return Err(Defect::new(MeshPart::Mesh, MeshProblem::NoSurface));
    }
    let (coords, triangles) = points(sheet);
    let offsets = offsets(&coords, &triangles);
    let moved = |half: f64| coords.iter().zip(&offsets).map(move |(x, offset)| x + offset * half).collect::<Vec<_>>();
    let count = coords.len();
    let layers = triangles.iter().flat_map(|&[a, b, c]| [[a, b, c], [c + count, b + count, a + count]]);
    let rim = open_sides(&triangles).into_iter().flat_map(|[a, b]| [[a + count, b + count, b], [a + count, b, a]]);
    let faces = layers.chain(rim).map(Vec::from).collect();
    let height = |corners: &[usize; 3]| {
        let normal = normal(corners.map(|point| coords[point]));
        corners.map(|point| offsets[point].dot(&normal)).into_iter().fold(1.0, f64::min)
    };
    let thinnest = triangles.iter().map(height).fold(1.0, f64::min);
    let coords = [moved(thickness / 2.0), moved(-thickness / 2.0)].concat();
    let surface = build(&Drawing { title: sheet.title.clone(), coords, faces, ..Drawing::default() })?;
    Ok(Solid { surface, thinnest })
}

/// Returns the unit normal of a triangle.
fn normal([a, b, c]: [Vec3; 3]) -> Vec3 {
    (b - a).cross(&(c - a)).normalize()
}

/// Returns the points of the cell's triangles, and which of them are the corners of each.
fn points(sheet: &Sheet) -> (Vec<Vec3>, Vec<[usize; 3]>) {
    let mut numbers: BTreeMap<Corner, usize> = BTreeMap::new();
    let mut coords = Vec::new();
    let mut number = |corner: Corner| {
        *numbers.entry(corner).or_insert_with(|| {
            coords.push(sheet.position(corner));
            coords.len() - 1
        })
    };
    let triangles = sheet.triangles.iter().map(|triangle| triangle.corners.map(&mut number)).collect();
    (coords, triangles)
}

/// Returns where each point goes when all faces move by one along their normals: the point that lies on the moved
/// planes of its faces, in the sense of least squares weighted by their angles there, and then the nearest one.
fn offsets(coords: &[Vec3], triangles: &[[usize; 3]]) -> Vec<Vec3> {
    let mut planes = vec![(Matrix3::zeros(), Vec3::zeros(), 0.0); coords.len()];
    for corners in triangles {
        let normal = normal(corners.map(|point| coords[point]));
        for (k, point) in corners.iter().enumerate() {
            let [before, here, after] = [2, 0, 1].map(|step| coords[corners[(k + step) % 3]]);
            let angle = (before - here).angle(&(after - here));
            let (products, sum, weight) = &mut planes[*point];
            *products += normal * normal.transpose() * angle;
            *sum += normal * angle;
            *weight += angle;
        }
    }
    let offset = |(products, sum, weight): (Matrix3<f64>, Vec3, f64)| {
        let held = products + Matrix3::identity() * (HELD * weight);
        let solved = solve_3(held, &sum).unwrap_or(sum);
        solved.cap_magnitude(FARTHEST)
    };
    planes.into_iter().map(offset).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sheet::{Pattern, generate};

    /// The volume that triangles enclose.
    fn volume(sheet: &Sheet) -> f64 {
        let part = |corners: [Vec3; 3]| corners[0].cross(&corners[1]).dot(&corners[2]) / 6.0;
        sheet.triangles.iter().map(|triangle| part(triangle.corners.map(|corner| sheet.position(corner)))).sum()
    }

    /// Claim: every face of the solid of a folded sheet lies at half of the thickness from its own, no edge of the
    /// solid has one face only, and the solid of a flat sheet has the volume area times thickness. Tolerance: 1e-8,
    /// since 1e-9 of the weights hold the offset.
    #[test]
    fn faces_lie_at_half_of_the_thickness() {
        let thickness = 0.02;
        for [pattern, fold] in [["miura", "0.4"], ["miura-patch", "0.4"], ["miura-patch", "0.0"]] {
            let table = format!("pattern = \"{pattern}\"\nfold = {fold}").parse().unwrap();
            let sheet = generate(&Pattern::of(&table).unwrap()).unwrap();
            let Solid { surface: solid, thinnest } = thickened(&sheet, thickness).unwrap();
            assert!((thinnest - 1.0).abs() < 1e-8, "{pattern}: {thinnest}");
            assert!(solid.edges.iter().all(|edge| edge.wings.iter().all(Option::is_some)), "{pattern} is open");
            let mut area = 0.0;
            for (k, triangle) in sheet.triangles.iter().enumerate() {
                let [a, b, c] = triangle.corners.map(|corner| sheet.position(corner));
                let normal = (b - a).cross(&(c - a));
                area += normal.norm() / 2.0;
                for (side, half) in [(0, 0.5), (1, -0.5)] {
                    for corner in solid.triangles[2 * k + side].corners {
                        let height = (solid.position(corner) - a).dot(&normal.normalize());
                        assert!((height / thickness - half).abs() < 1e-8, "{pattern}: {height}");
                    }
                }
            }
            let ratio = volume(&solid) / (area * thickness);
            assert!((ratio - 1.0).abs() < if fold == "0.0" { 1e-8 } else { 0.1 }, "{pattern}: {ratio}");
        }
    }

    /// Claim: a thickness of nothing has no solid.
    #[test]
    fn a_solid_has_a_thickness() {
        let sheet = generate(&Pattern::named("miura").unwrap()).unwrap();
        assert!([0.0, f64::NAN].iter().all(|none| thickened(&sheet, *none).is_err()));
    }
}
