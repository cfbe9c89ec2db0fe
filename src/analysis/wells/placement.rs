//! Pins, guides and rigid parts: whether they say more about a state than its shape, and whether two states of one
//! shape are one for them.
//!
//! Pins that only take rigid motions away, such as three, two and one coordinate of three vertices, hold no shape:
//! every shape of the free sheet can be placed on them. Then states of one shape count as one. Other pins hold the
//! shape too, and one shape can be held by them in several places, between which the sheet has to bend: a triangle on
//! two pinned vertices, whose third one is kept in a plane, stands on either side of that plane's zero line. Two states
//! of one shape then are one if a rigid motion that the pins leave free leads from one to the other. Guides, and the
//! coordinates of parts that are not free, count as pins do. Where fold angles do not determine the shape, as those of
//! trusses, states are compared so always.

use crate::math::{Vec3, rotation};
use crate::model::gauge::{self, Motion};
use crate::model::{Assembly, Domain, Gauge, Model, Terms};
use crate::numerics::dense::small::shortest_solution;
use nalgebra::{DMatrix, DVector};

/// Most steps from one state to the other, and the longest turn in a step, in radians.
const STEPS: usize = 60;
const LONGEST_TURN_RAD: f64 = 0.5;
/// Distance of two vertices, over the mean edge, up to which they are in the same place.
const SAME_PLACE: f64 = 1e-4;
/// Weight of what is kept against the coordinates of vertices.
const WEIGHT: f64 = 1e6;
/// Singular values, relative, of motions that are none.
const DEPENDENT: f64 = 1e-12;

/// The conditions that pins, guides and parts impose on the position of a sheet as a whole.
#[derive(Clone, Debug)]
pub(crate) struct PlacementConditions(Assembly);

impl PlacementConditions {
    /// Returns the conditions for the pins, guides and parts of a patch; `None` if two states of the same fold angles are
    /// always one.
    pub(crate) fn new(assembly: &Assembly) -> Option<Self> {
        let model = assembly.model(Gauge::Free);
        let kept = kept(&model);
        let shapes = kept == 0 || (only_against_motions(&model, kept) && !assembly.terms().is_loaded());
        (!shapes || !angles_determine_shape(assembly)).then(|| Self(assembly.clone()))
    }

    /// Whether a rigid motion that is left free leads from one state to another.
    ///
    /// The sheet is moved towards the other state by rigid motions, step by step, each the one that brings all vertices
    /// closest and leaves where it is what is kept.
    pub(crate) fn leads(&self, from: &[f64], to: &[f64]) -> bool {
        let (model, edge) = (self.0.model(Gauge::Free), self.0.mean_edge());
        let mut at = from.to_vec();
        for _ in 0..STEPS {
            let apart = at.iter().zip(to).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            if apart <= SAME_PLACE * edge {
                return true;
            }
            let Some(step) = step(&model, &at, to) else { return false };
            moved(&mut at, &step);
        }
        false
    }
}

/// Returns the best rigid motion: a translation and then a rotation vector about the centroid.
fn step(model: &Model, at: &[f64], to: &[f64]) -> Option<[Vec3; 2]> {
    let motions = gauge::rigid_motions(model.domain(), at, true);
    let free = motions.iter().zip(to.iter().zip(at)).map(|(rates, (to, at))| (*rates, to - at));
    let kept = model.kept(at).into_iter().zip(model.kept(to));
    let kept = kept.map(|(at, to)| (WEIGHT * at.rates, WEIGHT * (to.value - at.value)));
    let rows: Vec<(Motion, f64)> = free.chain(kept).collect();
    let matrix = DMatrix::from_fn(rows.len(), 6, |row, motion| rows[row].0[motion]);
    let right = DVector::from_fn(rows.len(), |row, _| rows[row].1);
    let found = shortest_solution(matrix, &right, DEPENDENT)?;
    let (points, centre) = (points(at), centre(at));
    let size = points.map(|p| (p - centre).norm()).fold(f64::MIN_POSITIVE, f64::max);
    let [shift, turn] = [Vec3::new(found[0], found[1], found[2]), Vec3::new(found[3], found[4], found[5]) / size];
    let part = (LONGEST_TURN_RAD / turn.norm().max(LONGEST_TURN_RAD)).min(1.0);
    Some([part * shift, part * turn])
}

/// Whether pins, guides and parts hold more than rigid motions.
pub(crate) fn holds_shape(assembly: &Assembly) -> bool {
    let model = assembly.model(Gauge::Free);
    let kept = kept(&model);
    model.has_parts() || (kept > 0 && !only_against_motions(&model, kept))
}

/// Returns the number of rigid motions that pins, guides and parts leave free.
pub fn free_rigid_motions(assembly: &Assembly) -> usize {
    assembly.model(Gauge::Free).rigid_motion_counts()[1]
}

/// Whether this number of coordinates that are kept only prevent rigid motions, each another one.
fn only_against_motions(model: &Model, kept: usize) -> bool {
    let [all, free] = model.rigid_motion_counts();
    all - free == kept
}

/// Whether the fold angles determine the shape: not of patches without creases, as trusses, with bars that have no face,
/// at which vertices hang, or with springs that join pieces.
pub(super) fn angles_determine_shape(assembly: &Assembly) -> bool {
    let terms = assembly.terms();
    let pieces = |terms: Terms| assembly.with_terms(terms).model(Gauge::Free).rigid_motion_counts()[0];
    let joined = || !terms.own.is_empty() && pieces(terms.clone()) < pieces(Terms { own: Vec::new(), ..terms.clone() });
    let of_patch = || terms.creases.is_some() && !assembly.tiling().has_bars_alone() && !joined();
    *assembly.domain() != Domain::Patch || of_patch()
}

/// Number of coordinates that pins and parts of a patch, and guides, keep.
fn kept(model: &Model) -> usize {
    if matches!(model.domain(), Domain::Patch) { model.kept(&model.coordinates(&model.start())).len() } else { 0 }
}

fn points(coordinates: &[f64]) -> impl Iterator<Item = Vec3> {
    coordinates.chunks_exact(3).map(Vec3::from_column_slice)
}

fn centre(coordinates: &[f64]) -> Vec3 {
    points(coordinates).sum::<Vec3>() / (coordinates.len() / 3) as f64
}

/// Moves a sheet by a translation and a rotation vector about its centroid.
fn moved(coordinates: &mut [f64], [shift, turn]: &[Vec3; 2]) {
    let (centre, turn) = (centre(coordinates), rotation::exp(turn));
    for point in coordinates.chunks_exact_mut(3) {
        let to = centre + shift + turn * (Vec3::from_column_slice(point) - centre);
        point.copy_from_slice(to.as_slice());
    }
}
