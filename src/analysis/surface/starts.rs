//! A state on every piece of the surface, near the drawn one.
//!
//! The drawn state is the tip of a cone, the zeros of the obstruction quadrics. Of one quadric with eigenvalues of both
//! signs the cone has two nappes, `v` and `-v`, with `v` in the plane of the eigenvector whose sign is alone and
//! another. With one eigenvalue of either sign and one zero the cone is two planes, and the folded states are two
//! surfaces that cross along a curve of spatially periodic states: planar folding, as of the eggbox. Each is smooth
//! across it, so that charts go over the curve. Of several quadrics the cone is met by hyperplanes in general position,
//! on each of which the real rays are known with multiplicity ([`crate::kinematics::Rays`]); as many hyperplanes are
//! taken as make it unlikely that a piece meets none. On such a hyperplane the surface is a curve, followed from the
//! drawn state along its ray.

use super::folding::SurfaceClosure;
use super::{Negative, SurfaceError, SurfaceOptions};
use crate::kinematics::{KinematicsError, Rays, RealDirections, SecondOrder};
use crate::numerics::DenseMatrix;
use crate::numerics::dense::{null_space, symmetric_eigen};
use crate::sheet::pieces;
use crate::solver::atlas::{Atlas, HyperplaneSection, Surface as _};
use crate::solver::continuation::{CurveOptions, CurvePoint, follow};
use nalgebra::DVector;
use rand::{RngExt, SeedableRng};

/// Hyperplanes on which rays are looked for where there is more than one quadric.
const SECTIONS: u64 = 6;
/// Eigenvalues below this part of the largest are zero.
const ZERO: f64 = 1e-9;

/// Least distance from the drawn state, in fold angles, at which the surface can be told from its singular point:
/// closure to 3e-14 fixes a state to that over the distance, and charts are a hundredth of the distance wide.
const NEAREST: f64 = 2e-5;

/// A state on the surface.
pub(super) struct SurfaceStart {
    /// Angles of the folding edges.
    pub x: Vec<f64>,
    /// Sign of its curvature; 1 where that is 0.
    pub sign: i8,
    /// Number of the line through the drawn state from which it comes; of a state behind another tip a number of its
    /// own.
    pub line: usize,
}

/// States from which the surface is begun.
pub(super) struct SurfaceStarts {
    pub list: Vec<SurfaceStart>,
    /// Distance from the drawn state, in fold angles, of the nearest one; infinite where the drawn state is itself the
    /// start.
    pub reach: f64,
    /// Ways along which no state was found, or that are not known themselves.
    pub lost: usize,
    /// Spatially periodic states whose nappes are among the starts: the drawn one first.
    pub tips: Vec<Vec<f64>>,
    /// Whether they lie on surfaces that cross along a curve through the drawn state.
    pub crossing: bool,
}

/// A real direction, and the normal of a hyperplane on which it is a simple solution; both in the basis of the modes.
struct FoldingDirection {
    along: DVector<f64>,
    normal: DVector<f64>,
}

/// States near the drawn one along every direction found, both ways; or what is established instead.
pub(super) fn starts(
    folding: &mut SurfaceClosure<'_>,
    second_order: &SecondOrder,
    settings: &SurfaceOptions,
) -> Result<Result<SurfaceStarts, Negative>, SurfaceError> {
    let (directions, unknown) = match &second_order.quadrics[..] {
        [] => {
            let list = vec![SurfaceStart { x: folding.drawn.clone(), sign: 1, line: 0 }];
            return Ok(Ok(SurfaceStarts { list, reach: f64::INFINITY, lost: 0, tips: Vec::new(), crossing: false }));
        }
        [quadric] => match of_one_quadric(quadric)? {
            Ok(directions) => (directions, 0),
            Err(negative) => return Ok(Err(negative)),
        },
        _ => on_sections(second_order)?,
    };
    let crossing = second_order.quadrics.len() == 1 && directions.len() == 2;
    let mut found = SurfaceStarts {
        list: Vec::new(),
        reach: f64::INFINITY,
        lost: unknown,
        tips: vec![folding.drawn.clone()],
        crossing,
    };
    for (line, FoldingDirection { along, normal }) in directions.iter().enumerate() {
        let [along, normal] = [along, normal].map(|v| folding.folding((&second_order.modes * v).as_slice()));
        for sign in [1.0, -1.0] {
            let tangent = along.iter().map(|entry| sign * entry).collect();
            // surfaces that cross: half a chart away, so that the next chart on the other side is so too
            let part = if crossing { 0.5 } else { 1.0 };
            match follow_out(folding, settings, tangent, (&normal, part)) {
                Some(CurvePoint { x, arc_length, .. }) => {
                    let sign = if folding.shape(&x)?.curvature < 0.0 { -1 } else { 1 };
                    // beyond the limit: half of it is met so near that it could not be located
                    let reach = if folding.limit(&x) > 0.0 { 0.0 } else { arc_length };
                    found.reach = found.reach.min(reach);
                    found.list.push(SurfaceStart { x, sign, line });
                }
                None => found.lost += 1,
            }
        }
    }
    match found.reach {
        _ if found.list.is_empty() => Err(SurfaceError::NoStart { rays: 2 * directions.len() }),
        reach if reach < NEAREST => Err(SurfaceError::NothingWithin { max_curvature: settings.max_curvature, reach }),
        _ => Ok(Ok(found)),
    }
}

/// The state this part of a chart's radius away on the hyperplane, or where half of the largest curvature is met.
fn follow_out(
    folding: &mut SurfaceClosure<'_>,
    settings: &SurfaceOptions,
    tangent: Vec<f64>,
    (normal, part): (&[f64], f64),
) -> Option<CurvePoint> {
    let SurfaceOptions { tolerance, radius, .. } = *settings;
    let options = CurveOptions { tolerance, length: part * radius, stops: vec![0], ..CurveOptions::default() };
    let drawn = folding.drawn.clone();
    let mut section = HyperplaneSection::new(folding, drawn.clone(), normal.to_vec());
    let found = follow(
        &mut section,
        drawn,
        tangent,
        &options,
        &mut |section, point, out| out.push(section.surface.limit(&point.x) + 0.5 * settings.max_curvature),
        &mut |_| true,
    );
    found.points.into_iter().next_back().filter(|last| last.arc_length > 0.0)
}

/// Simple directions on the zeros of one quadric of three motions: one line on a cone, one on each of two planes that
/// meet in the null direction, on the plane across it. What is established where no plane of directions is real.
fn of_one_quadric(quadric: &DenseMatrix) -> Result<Result<Vec<FoldingDirection>, Negative>, SurfaceError> {
    let found = symmetric_eigen(quadric).map_err(KinematicsError::from)?;
    let zero = ZERO * found.values.iter().fold(0.0f64, |most, value| most.max(value.abs()));
    let [positive, negative] =
        [1.0, -1.0].map(|sign| (0..found.values.len()).filter(|&k| sign * found.values[k] > zero).collect::<Vec<_>>());
    let vector = |k: usize| found.vectors.column(k).into_owned();
    let directions = |[one, other, across]: [usize; 3], ways: &[f64]| {
        let [one_size, other_size] = [one, other].map(|k| found.values[k].abs().sqrt());
        let along = |way: &f64| (vector(one) * other_size + vector(other) * (way * one_size)).normalize();
        ways.iter().map(|way| FoldingDirection { along: along(way), normal: vector(across) }).collect()
    };
    let none = (0..found.values.len()).find(|k| !positive.contains(k) && !negative.contains(k));
    match (&positive[..], &negative[..], none) {
        (&[alone], &[other, normal], _) | (&[other, normal], &[alone], _) => {
            Ok(Ok(directions([alone, other, normal], &[1.0])))
        }
        (&[one], &[other], Some(shared)) => Ok(Ok(directions([one, other, shared], &[1.0, -1.0]))),
        ([_, _, _], [], _) | ([], [_, _, _], _) => Ok(Err(Negative::NoDirection)),
        ([_, _], [], _) | ([], [_, _], _) => Ok(Err(Negative::OneDirection)),
        _ => {
            let signature = [positive.len(), negative.len(), found.values.len() - positive.len() - negative.len()];
            Err(SurfaceError::Degenerate { signature })
        }
    }
}

/// The simple real rays on hyperplanes in general position.
///
/// That every hyperplane has none does not say that there are none: a small curve of directions is missed by most.
/// Beside them the number of those that are multiple, of which second order says no more, and of hyperplanes on which
/// not all are known.
fn on_sections(second_order: &SecondOrder) -> Result<(Vec<FoldingDirection>, usize), SurfaceError> {
    let count = second_order.count();
    let (mut found, mut multiple, mut unknown) = (Vec::new(), 0, 0);
    for seed in 0..SECTIONS {
        let mut numbers = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
        let normal = DVector::from_fn(count, |_, _| numbers.random_range(-1.0..1.0)).normalize();
        let inside =
            null_space(&DenseMatrix::from_row_slice(1, count, normal.as_slice())).map_err(KinematicsError::from)?.basis;
        let section = SecondOrder {
            modes: inside.clone(),
            forms: Vec::new(),
            quadrics: second_order.quadrics.iter().map(|quadric| inside.tr_mul(&(quadric * &inside))).collect(),
            gaps: second_order.gaps,
        };
        let Rays { rays, directions, .. } = Rays::new(&section)?;
        multiple += rays.iter().filter(|ray| ray.sign == 1 && ray.multiplicity > 1).count();
        unknown += usize::from(directions != RealDirections::Listed);
        let simple = rays.into_iter().filter(|ray| ray.sign == 1 && ray.multiplicity == 1);
        found.extend(simple.map(|ray| FoldingDirection { along: ray.direction.into(), normal: normal.clone() }));
    }
    if found.is_empty() {
        return Err(SurfaceError::NoneMet { sections: SECTIONS as usize, multiple });
    }
    Ok((found, multiple + unknown))
}

/// Branch and sign of every start. Starts on one line through the drawn state, and on one piece of the surface, have
/// one number.
pub(super) fn branches(atlas: &Atlas, starts: &[SurfaceStart]) -> Vec<(usize, i8)> {
    let reached = atlas.reached.iter().enumerate().filter_map(|(start, other)| Some([(*other)?, start]));
    let sides =
        atlas.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [a, c]]).map(|side| side.map(|k| atlas.charts[k].start));
    let on_line =
        |k: usize| (0..k).filter(move |&other| starts[other].line == starts[k].line).map(move |other| [other, k]);
    let joined = reached.chain(sides).chain((0..starts.len()).flat_map(on_line));
    let pieces = pieces(starts.len(), joined, 0..starts.len());
    let number = |k: usize| pieces.iter().position(|piece| piece.contains(&k)).unwrap_or(0);
    starts.iter().enumerate().map(|(k, start)| (number(k), start.sign)).collect()
}
