//! Counts and measures of a sheet, available before anything is computed with it.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use serde::Serialize;

use super::assignment::Assignment;
use super::build::coincident;
use super::cell::{Corner, EdgeKind, Sheet};
use crate::math::{Vec3, short};

/// Largest angle defect, in radians, of a sheet that is called developable.
const DEVELOPABLE: f64 = 1e-9;

/// Quality below which a triangle is thin: relaxations reach their tolerance on triangles of 2e-4 and, in tests of
/// single thin triangles, fail on most of 2e-5, because rounding of their corners turns them by an angle of its own.
const THIN_QUALITY: f64 = 1e-3;
/// Number of thin triangles that are named.
const NAMED: usize = 3;

/// Remark about a mesh whose faces were turned over.
pub(crate) const TURNED_OVER: &str =
    "all faces of the file are turned over, to the side from which its letters M and V are seen";

/// A triangle, and its quality as in [`Info::worst_triangle_quality`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ThinTriangle {
    /// Numbers of its corners in the cell.
    pub vertices: [usize; 3],
    /// Its quality.
    pub quality: f64,
}

/// Counts and measures of one cell, or of a finite sheet.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Info {
    /// Name of the sheet.
    pub title: String,
    /// Whether the sheet has lattice vectors.
    pub periodic: bool,
    /// Number of vertices `Nv`.
    pub vertices: usize,
    /// Number of edges `Ne`, diagonals of polygons included.
    pub edges: usize,
    /// Number of creases, the edges that fold.
    pub creases: usize,
    /// Number of diagonals of polygons.
    pub facets: usize,
    /// Number of edges of one face.
    pub boundary: usize,
    /// Number of edges of no face, which are bars alone.
    pub bars_alone: usize,
    /// Number of edges of more than two faces with several hinges.
    pub joints: usize,
    /// Number of edges of one face that cuts have made, two for each cut edge.
    pub cut: usize,
    /// Number of edges of each letter of FOLD: that of the file, or what the drawing shows.
    pub letters: BTreeMap<&'static str, usize>,
    /// Number of triangles.
    pub faces: usize,
    /// Number of polygons.
    pub polygons: usize,
    /// Number of connected pieces.
    pub pieces: usize,
    /// `vertices - edges + faces`: 0 for a cell of a periodic sheet without openings, 1 for a disc, 0 for a ring.
    pub euler_characteristic: i64,
    /// Columns minus rows of the bars' rigidity matrix, `3 Nv - Ne`, with a fixed lattice or free edges.
    pub maxwell_count: i64,
    /// The same count for screw boundary conditions with vertex 0 held, `3 (Nv - 1) + 5 - Ne`; `None` for a finite
    /// sheet.
    pub maxwell_count_screw: Option<i64>,
    /// The same count for a torus with free lattice vectors, `3 Nv + 6 - Ne`; `None` for a finite sheet.
    pub maxwell_count_free_torus: Option<i64>,
    /// Whether no inner vertex has an angle defect above 1e-9, so that the sheet can be flattened without stretching.
    pub developable: bool,
    /// Largest `|2 pi - sum of the angles of triangles|` over inner vertices, in radians.
    pub largest_angle_defect: f64,
    /// Length of the shortest edge.
    pub shortest_edge: f64,
    /// Length of the longest edge.
    pub longest_edge: f64,
    /// Least `4 sqrt(3) area / (sum of squared sides)` of a triangle: 1 for equilateral triangles, 0 for those
    /// without area.
    pub worst_triangle_quality: f64,
    /// Number of triangles of a quality below 1e-3, on which a relaxation may not reach its tolerance.
    pub thin_triangles: usize,
    /// The thinnest of them, up to three.
    pub thinnest: Vec<ThinTriangle>,
    /// Number of creases and diagonals whose fold angle in the file is not the drawn one: a target of folding.
    pub target_angles: usize,
    /// Number of creases that are drawn folded to the other side than their target angle.
    pub drawn_against_targets: usize,
    /// Whether all faces of the file were turned over, since its letters are those of the other side.
    pub turned_over: bool,
    /// Number of vertices that stand where another one stands, as those of layers that touch; ends of cuts are not
    /// counted.
    pub touching_vertices: usize,
    /// Number of the frame that is read: 0 is the top of the file.
    pub frame: usize,
    /// Number of the other frames of the file.
    pub further_frames: usize,
    /// Remarks on a drawing of lines: each change that was made to read it, and each doubt.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub remarks: Vec<String>,
}

impl Info {
    /// Counts and measures `sheet`.
    pub fn new(sheet: &Sheet) -> Self {
        let count = |kind| sheet.edges.iter().filter(|e| e.kind == kind).count();
        let edges = sheet.bars().count();
        let free = 3 * sheet.vertices.len() as i64 - edges as i64;
        let bars_alone = sheet.bars_alone().count();
        let lengths = || sheet.edges.iter().map(|edge| sheet.length(edge.key));
        let defect = angle_defects(sheet).fold(0.0, |largest: f64, (_, defect)| largest.max(defect.abs()));
        let thin = thin_triangles(sheet);
        let mut letters = BTreeMap::new();
        sheet.edges.iter().for_each(|edge| *letters.entry(sheet.assignment(edge).letter()).or_default() += 1);
        Self {
            title: sheet.title.clone(),
            periodic: sheet.is_repeated(),
            vertices: sheet.vertices.len(),
            edges,
            creases: count(EdgeKind::Crease),
            facets: count(EdgeKind::Facet),
            boundary: count(EdgeKind::Boundary) - bars_alone,
            bars_alone,
            joints: sheet.edges.iter().filter(|edge| edge.key.round == 1).count(),
            cut: sheet.edges.iter().filter(|edge| sheet.assignment(edge) == Assignment::Cut).count(),
            letters,
            faces: sheet.triangles.len(),
            polygons: sheet.polygons.len(),
            pieces: pieces(sheet).len(),
            euler_characteristic: (sheet.vertices.len() + sheet.triangles.len()) as i64 - edges as i64,
            maxwell_count: free,
            maxwell_count_screw: sheet.chords().map(|_| free + 2),
            maxwell_count_free_torus: sheet.lattice.map(|_| free + 6),
            developable: defect < DEVELOPABLE,
            largest_angle_defect: defect,
            shortest_edge: lengths().fold(f64::INFINITY, f64::min),
            longest_edge: lengths().fold(0.0, f64::max),
            worst_triangle_quality: points(sheet).map(quality).fold(1.0, f64::min),
            thin_triangles: thin.len(),
            thinnest: thin.iter().take(NAMED).copied().collect(),
            target_angles: sheet.targets_not_drawn(),
            drawn_against_targets: sheet.drawn_against_targets()[0],
            turned_over: sheet.record.turned_over,
            touching_vertices: touching(sheet),
            frame: sheet.record.frame,
            further_frames: sheet.record.further_frames,
            remarks: remarks(sheet),
        }
    }
}

/// Returns the thin triangles, the thinnest first.
fn thin_triangles(sheet: &Sheet) -> Vec<ThinTriangle> {
    let all = sheet.triangles.iter().zip(points(sheet));
    let all = all.map(|(t, x)| ThinTriangle { vertices: t.corners.map(|corner| corner.vertex), quality: quality(x) });
    let mut thin: Vec<ThinTriangle> = all.filter(|triangle| triangle.quality < THIN_QUALITY).collect();
    thin.sort_by(|a, b| a.quality.total_cmp(&b.quality));
    thin
}

/// Returns the number of drawn vertices that share their place with another one.
fn touching(sheet: &Sheet) -> usize {
    let pairs = coincident(&sheet.vertices[..sheet.vertices.len() - sheet.cut_from.len()]);
    pairs.into_iter().flatten().collect::<BTreeSet<_>>().len()
}

/// Says that so many fold angles of a file are targets.
pub(crate) fn targets_said(count: usize) -> String {
    let (angles, differ) = if count == 1 { ("angle", "differs") } else { ("angles", "differ") };
    format!("{count} fold {angles} of the file {differ} from the drawn ones; rest = \"target\" uses them")
}

/// Returns the vertices of each piece of a sheet.
pub(super) fn pieces(sheet: &Sheet) -> Vec<Vec<usize>> {
    let edges = sheet.edges.iter().map(|edge| edge.key.ends().map(|end| end.vertex));
    super::pieces(sheet.vertices.len(), edges, sheet.triangles.iter().map(|t| t.corners[0].vertex))
}

fn points(sheet: &Sheet) -> impl Iterator<Item = [Vec3; 3]> + '_ {
    sheet.triangles.iter().map(|t| t.corners.map(|c: Corner| sheet.position(c)))
}

fn quality([a, b, c]: [Vec3; 3]) -> f64 {
    let doubled = (b - a).cross(&(c - a)).norm();
    let squares = (b - a).norm_squared() + (c - b).norm_squared() + (a - c).norm_squared();
    2.0 * 3.0f64.sqrt() * doubled / squares
}

/// Returns the inner vertices, each with its angle defect, a full turn less the sum of the angles of its faces, in
/// radians.
pub(super) fn angle_defects(sheet: &Sheet) -> impl Iterator<Item = (usize, f64)> {
    let mut sums = vec![0.0; sheet.vertices.len()];
    for (triangle, x) in sheet.triangles.iter().zip(points(sheet)) {
        for k in 0..3 {
            let (u, v) = (x[(k + 1) % 3] - x[k], x[(k + 2) % 3] - x[k]);
            sums[triangle.corners[k].vertex] += u.cross(&v).norm().atan2(u.dot(&v));
        }
    }
    let mut inside = vec![true; sheet.vertices.len()];
    for edge in sheet.edges.iter().filter(|e| e.kind == EdgeKind::Boundary) {
        inside[edge.key.i] = false;
        inside[edge.key.j] = false;
    }
    let inner = sums.into_iter().zip(inside).enumerate().filter(|(_, (_, inside))| *inside);
    inner.map(|(vertex, (sum, _))| (vertex, std::f64::consts::TAU - sum))
}

impl fmt::Display for Info {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { creases, facets, boundary, bars_alone, joints, faces, polygons, .. } = self;
        let cut = if self.cut == 0 { String::new() } else { format!(", {} of them along cuts", self.cut) };
        let further_counts = match (self.maxwell_count_screw, self.maxwell_count_free_torus) {
            (Some(screw), Some(free)) => format!(" (fixed torus), {screw} (screw), {free} (free torus)"),
            _ => String::new(),
        };
        let developable = if self.developable { "yes" } else { "no" };
        let thinnest = self.thinnest.iter().map(|thin| format!("{:?} of {:.1e}", thin.vertices, thin.quality));
        let thinnest = thinnest.collect::<Vec<_>>().join(", ");
        let (thin, more) = (self.thin_triangles, if self.thin_triangles > self.thinnest.len() { ", .." } else { "" });
        let (against, touching) = (self.drawn_against_targets, self.touching_vertices);
        let letters = self.letters.iter().map(|(letter, count)| format!("{count} {letter}")).collect::<Vec<_>>();
        // the name of each line, whether it is written, and what it says
        let lines = [
            ("vertices", true, self.vertices.to_string()),
            ("edges", true, format!("{} ({creases} creases, {facets} facets, {boundary} boundary{cut})", self.edges)),
            ("letters", true, letters.join(", ")),
            ("bars without faces", *bars_alone > 0, bars_alone.to_string()),
            ("joints", *joints > 0, format!("{joints} edges of more than two faces")),
            ("triangles", true, format!("{faces} (of {polygons} polygons)")),
            ("pieces", true, self.pieces.to_string()),
            ("Euler characteristic", true, self.euler_characteristic.to_string()),
            ("Maxwell count", true, format!("{}{further_counts}", self.maxwell_count)),
            ("developable", true, format!("{developable}, largest angle defect {:.3e} rad", self.largest_angle_defect)),
            ("edge lengths", true, format!("{} to {}", short(self.shortest_edge), short(self.longest_edge))),
            ("worst triangle", true, format!("quality {:.4} (1: equilateral)", self.worst_triangle_quality)),
            ("thin triangles", thin > 0, format!("{thin} of quality under {THIN_QUALITY:?}: {thinnest}{more}")),
            ("target angles", self.target_angles > 0, targets_said(self.target_angles)),
            ("", against > 0, format!("{against} creases are drawn on the other side than their targets")),
            ("turned over", self.turned_over, TURNED_OVER.to_owned()),
            ("touching layers", touching > 0, format!("{touching} vertices stand where others stand")),
        ];
        let written = lines.into_iter().filter(|(_, is_written, _)| *is_written).map(|(name, _, said)| (name, said));
        let remarks = self.remarks.iter().map(|said| ("remark", said.clone()));
        let frames = frames_said(self.frame, self.further_frames).map(|said| ("frames", said));
        let surface = if self.periodic { "one cell of a periodic sheet" } else { "a finite sheet" };
        write!(f, "{}: {surface}", self.title)?;
        written.chain(remarks).chain(frames).try_for_each(|(name, said)| write!(f, "\n{name:<23}{said}"))
    }
}

/// Returns a sentence for each thing that was done to the file of a sheet, or that may not be what was meant.
pub(crate) fn remarks(sheet: &Sheet) -> Vec<String> {
    let mut said = sheet.record.redrawing.said();
    let rims = sheet.edges.iter().filter(|edge| edge.kind == EdgeKind::Boundary);
    let letters = rims.filter_map(|edge| sheet.assignments.get(&edge.key));
    let folding = letters.filter(|letter| matches!(letter, Assignment::Mountain | Assignment::Valley)).count();
    if folding > 0 && sheet.triangles.is_empty() {
        said.push(
            "`faces_vertices` is empty, so that there are bars only; leave it out to have the faces found".into(),
        );
    } else if folding > 0 {
        said.push(format!("{folding} edges of the rim have the letter M or V; an edge of one face does not fold"));
    }
    said
}

/// Says which frame of a file is read, if it has several.
pub(crate) fn frames_said(frame: usize, others: usize) -> Option<String> {
    let (more, are) = if others == 1 { ("other is", "it") } else { ("others are", "another") };
    (others > 0).then(|| format!("frame {frame} is read; {others} {more} not, `--frame n` reads {are}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sheet::{Pattern, fold, generate};

    /// Claim: the counts of a triangulated cell are right, and an unfolded star has angle defects. Source: Ne = 3 Nv,
    /// Nf = 2 Nv, Maxwell counts 0, 2, 6.
    #[test]
    fn triangulated_cell() {
        let star = fold::parse(include_str!("../../tests/cases/open-star.fold"), "open-star.fold").unwrap();
        let info = Info::new(&star);
        assert_eq!((info.vertices, info.edges, info.faces, info.euler_characteristic), (4, 12, 8, 0));
        assert_eq!(
            (info.maxwell_count, info.maxwell_count_screw, info.maxwell_count_free_torus),
            (0, Some(2), Some(6))
        );
        assert!(!info.developable && info.largest_angle_defect > 0.1);
        assert!(info.to_string().contains("fixed torus"));
    }

    /// Claim: a folded Miura-ori is developable and an eggbox is not. Source: four angles of 60 degrees at the tops
    /// of the eggbox leave a defect of 2 pi / 3. Tolerance: rounding of a sum of eight angles.
    #[test]
    fn developable_or_not() {
        let miura = Info::new(&generate(&Pattern::named("miura").unwrap()).unwrap());
        assert!(miura.developable && miura.largest_angle_defect < 1e-14, "{miura}");
        assert_eq!((miura.polygons, miura.facets, miura.creases), (4, 4, 8));
        let eggbox = Info::new(&generate(&Pattern::named("eggbox").unwrap()).unwrap());
        assert!((eggbox.largest_angle_defect - std::f64::consts::TAU / 3.0).abs() < 1e-14, "{eggbox}");
    }

    /// Claim: the quality is 1 for an equilateral triangle and sqrt(3)/2 for a right isosceles one.
    #[test]
    fn qualities() {
        let h = 3.0f64.sqrt() / 2.0;
        assert!((quality([Vec3::zeros(), Vec3::x(), Vec3::new(0.5, h, 0.0)]) - 1.0).abs() < 1e-15);
        assert!((quality([Vec3::zeros(), Vec3::x(), Vec3::y()]) - h).abs() < 1e-15);
    }
}
