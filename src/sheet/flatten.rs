//! Unfolding a developable sheet into the plane: the crease pattern of a folded state.
//!
//! Triangles are laid into the plane one beside the other, breadth first, each by the lengths of its sides; nothing is
//! fitted. A triangle that is reached over another edge too must lie where it is. It does where the angles at every
//! inner vertex sum to `2 pi` and the sheet has no opening that its faces go round.

use std::collections::{BTreeMap, VecDeque};
use std::f64::consts::TAU;

use super::assignment::Assignment;
use super::cell::{EdgeKey, EdgeKind, Sheet};
use super::info::{angle_defects, pieces};
use super::record::FileRecord;
use crate::math::{Vec2, Vec3};

/// Largest angle defect of an inner vertex of a developable sheet, in radians: that of coordinates with seven digits.
const DEFECT_RAD: f64 = 1e-6;
/// Largest distance between two places of a vertex, relative to the extent of the unfolded sheet.
const CLOSED: f64 = 1e-6;
/// Largest magnitude of a fold angle, in radians, of an edge that has no letter of its own and is not folded.
const UNFOLDED_RAD: f64 = 1e-6;

/// The reason why a sheet has no crease pattern.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum NotDevelopable {
    #[error(
        "the sheet cannot be unfolded: the angles at vertex {vertex} sum to {:.6} rad, {defect:.2e} less than a full turn",
        TAU - defect
    )]
    Defect {
        vertex: usize,
        /// Full turn less the sum of the angles, in radians.
        defect: f64,
    },
    #[error(
        "the sheet cannot be unfolded: its faces close round an opening, and in the plane vertex {vertex} comes to lie at two \
         places, {distance:.2e} apart"
    )]
    Tube { vertex: usize, distance: f64 },
    #[error("the sheet cannot be unfolded: it consists of {pieces} pieces; unfold each alone")]
    Pieces { pieces: usize },
    #[error("the sheet cannot be unfolded: it is cut along lines, whose two sides may come apart in the plane")]
    Cut,
    #[error("the sheet cannot be unfolded: an edge has more than two faces or none, or the faces have one side")]
    NoSurface,
    #[error("the sheet cannot be unfolded: it is periodic; unfold a finite patch of it")]
    Periodic,
}

/// Returns a developable sheet laid into the plane, its faces upwards, turned and moved as close to the drawn one, seen
/// from above, as it can be. Creases have the letters of the folded sheet, and its fold angles as their targets where
/// the file gives no others. It is not checked whether distant faces come to lie on each other.
///
/// ```
/// use foldwell::sheet::{Assignment, flatten, generate::MiuraPatch};
/// use foldwell::{Pattern, generate};
///
/// let folded = generate(&Pattern::MiuraPatch(MiuraPatch { cells: [2, 2], ..MiuraPatch::default() }))?;
/// let pattern = flatten(&folded)?;
/// assert!(pattern.vertices.iter().all(|point| point.z == 0.0));
/// assert_eq!(pattern.assignment(&pattern.edges[1]), Assignment::Valley);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`NotDevelopable`] with the vertex at which it fails.
pub fn flatten(sheet: &Sheet) -> Result<Sheet, NotDevelopable> {
    check(sheet)?;
    let plane = moved_beneath(&unfolded(sheet)?, &sheet.vertices);
    let (mut assignments, mut targets) = (sheet.assignments.clone(), sheet.targets.clone());
    for edge in sheet.edges.iter().filter(|edge| edge.kind == EdgeKind::Crease) {
        let angle = sheet.drawn_angle(edge).unwrap_or_default();
        let shown = if angle.abs() <= UNFOLDED_RAD { Assignment::Flat } else { sheet.assignment(edge) };
        assignments.entry(edge.key).or_insert(shown);
        targets.entry(edge.key).or_insert(if angle.abs() <= UNFOLDED_RAD { 0.0 } else { angle });
    }
    let mut record = FileRecord { frames: None, ..sheet.record.clone() };
    for (_, classes) in record.metadata.iter_mut().filter(|(key, _)| key == "frame_classes") {
        *classes = "[\"creasePattern\"]".into();
    }
    Ok(Sheet { vertices: plane, assignments, targets, record, ..sheet.clone() })
}

fn check(sheet: &Sheet) -> Result<(), NotDevelopable> {
    if sheet.is_repeated() {
        return Err(NotDevelopable::Periodic);
    }
    if !sheet.is_surface() {
        return Err(NotDevelopable::NoSurface);
    }
    if !sheet.cut_from.is_empty() {
        return Err(NotDevelopable::Cut);
    }
    let pieces = pieces(sheet).len();
    if pieces > 1 {
        return Err(NotDevelopable::Pieces { pieces });
    }
    match angle_defects(sheet).max_by(|(_, a), (_, b)| a.abs().total_cmp(&b.abs())) {
        Some((vertex, defect)) if !(defect.abs() <= DEFECT_RAD) => Err(NotDevelopable::Defect { vertex, defect }),
        _ => Ok(()),
    }
}

/// Returns the places of all vertices in the plane; the first triangle begins at the origin.
fn unfolded(sheet: &Sheet) -> Result<Vec<Vec2>, NotDevelopable> {
    let mut beside: BTreeMap<EdgeKey, Vec<usize>> = BTreeMap::new();
    for (number, triangle) in sheet.triangles.iter().enumerate() {
        triangle.sides().iter().for_each(|side| beside.entry(side.key).or_default().push(number));
    }
    let mut places: Vec<Option<Vec2>> = vec![None; sheet.vertices.len()];
    let mut laid: Vec<Option<[Vec2; 3]>> = vec![None; sheet.triangles.len()];
    let (mut queue, mut worst) = (VecDeque::new(), (0, 0.0));
    if let Some(shape) = sheet.triangles.first().map(|_| shape(sheet, 0)) {
        (laid[0], queue) = (Some(shape), VecDeque::from([0]));
    }
    while let Some(number) = queue.pop_front() {
        let Some(corners) = laid[number] else { continue };
        let triangle = &sheet.triangles[number];
        for (corner, place) in triangle.corners.iter().zip(corners) {
            let known = *places[corner.vertex].get_or_insert(place);
            let distance = (known - place).norm();
            worst = if distance > worst.1 { (corner.vertex, distance) } else { worst };
        }
        for side in triangle.sides() {
            for &next in beside[&side.key].iter().filter(|&&next| next != number) {
                if laid[next].is_none() {
                    laid[next] = Some(beside_edge(sheet, next, [side.key.i, side.key.j], number, &corners));
                    queue.push_back(next);
                }
            }
        }
    }
    // vertices of no triangle hang on nothing and stay where they are drawn
    let places: Vec<Vec2> = places.iter().zip(&sheet.vertices).map(|(p, x)| p.unwrap_or(x.xy())).collect();
    let [low, high] = places.iter().fold([Vec2::zeros(); 2], |[low, high], x| [low.inf(x), high.sup(x)]);
    let (vertex, distance) = worst;
    if distance > CLOSED * (high - low).max() {
        return Err(NotDevelopable::Tube { vertex, distance });
    }
    Ok(places)
}

/// Returns the corners of a triangle in a plane of its own: the first at the origin, the second on the axis of x, and
/// the third above it.
fn shape(sheet: &Sheet, number: usize) -> [Vec2; 3] {
    let [a, b, c] = sheet.triangles[number].corners.map(|corner| sheet.position(corner));
    let (side, other) = (b - a, c - a);
    let length = side.norm();
    [Vec2::zeros(), Vec2::new(length, 0.0), Vec2::new(side.dot(&other), side.cross(&other).norm()) / length]
}

/// Returns the corners of a triangle laid beside an edge that it shares with a triangle whose corners lie already. The
/// edge keeps the place that it has there.
fn beside_edge(sheet: &Sheet, next: usize, ends: [usize; 2], number: usize, corners: &[Vec2; 3]) -> [Vec2; 3] {
    let at = |triangle: usize, vertex: usize| {
        sheet.triangles[triangle].corners.iter().position(|corner| corner.vertex == vertex).unwrap_or_default()
    };
    let shape = shape(sheet, next);
    let [to, from] = [ends.map(|vertex| corners[at(number, vertex)]), ends.map(|vertex| shape[at(next, vertex)])];
    let (along, own) = (to[1] - to[0], from[1] - from[0]);
    // the turn from one direction to the other, as a complex number of length one
    let turn = Vec2::new(own.dot(&along), own.perp(&along)).normalize();
    shape.map(|x| to[0] + turned(turn, x - from[0]))
}

fn turned(turn: Vec2, x: Vec2) -> Vec2 {
    Vec2::new(turn.x * x.x - turn.y * x.y, turn.y * x.x + turn.x * x.y)
}

/// Returns places in the plane, turned and moved as close to the drawn vertices, seen from above, as they can be.
fn moved_beneath(places: &[Vec2], drawn: &[Vec3]) -> Vec<Vec3> {
    let count = places.len().max(1) as f64;
    let from: Vec2 = places.iter().sum::<Vec2>() / count;
    let to: Vec2 = drawn.iter().map(|x| x.xy()).sum::<Vec2>() / count;
    let pairs = || places.iter().zip(drawn).map(|(p, x)| (p - from, x.xy() - to));
    let sums = pairs().map(|(p, x)| Vec2::new(p.dot(&x), p.perp(&x))).sum::<Vec2>();
    let turn = sums.try_normalize(0.0).unwrap_or(Vec2::x());
    places.iter().map(|p| to + turned(turn, p - from)).map(|p| Vec3::new(p.x, p.y, 0.0)).collect()
}
