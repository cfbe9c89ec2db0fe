//! A state on every piece of the surface, near the drawn one.
//!
//! The drawn state is the tip of a cone, the zeros of the obstruction quadrics. Of one quadric with eigenvalues of both
//! signs the cone has two nappes, `v` and `-v`, with `v` in the plane of the eigenvector whose sign is alone and
//! another. Of several it is met by hyperplanes in general position, on each of which the real rays are known with
//! multiplicity ([`crate::kinematics::Rays`]); as many hyperplanes are taken as make it unlikely that a piece meets
//! none. On such a hyperplane the surface is a curve, followed from the drawn state along its ray.

use super::folding::{Folding, Section};
use super::{Question, SurfaceError};
use crate::kinematics::{KinematicsError, Rays, SecondOrder};
use crate::numerics::DenseMatrix;
use crate::numerics::dense::{null_space, symmetric_eigen};
use crate::solver::atlas::Atlas;
use crate::solver::continuation::{Options, follow};
use nalgebra::DVector;
use rand::{RngExt, SeedableRng};

/// Hyperplanes on which rays are looked for where there is more than one quadric.
const SECTIONS: u64 = 6;
/// Eigenvalues below this part of the largest are zero.
const ZERO: f64 = 1e-9;

/// A state on the surface.
pub(super) struct Start {
    /// Angles of the folding edges.
    pub x: Vec<f64>,
    /// Sign of its curvature; 1 where that is 0.
    pub sign: i8,
    /// Number of the line through the drawn state from which it comes.
    pub line: usize,
}

/// A real direction, and the normal of a hyperplane on which it is a simple solution; both in the basis of the modes.
struct Direction {
    along: DVector<f64>,
    normal: DVector<f64>,
}

/// States near the drawn one along every direction found, both ways.
pub(super) fn starts(
    folding: &mut Folding<'_>,
    second_order: &SecondOrder,
    question: &Question<'_>,
) -> Result<Vec<Start>, SurfaceError> {
    let drawn = folding.drawn();
    let directions = match &second_order.quadrics[..] {
        [] => return Ok(vec![Start { x: drawn, sign: 1, line: 0 }]),
        [quadric] => nappes(quadric)?,
        _ => on_sections(second_order)?,
    };
    let mut starts = Vec::new();
    for (line, Direction { along, normal }) in directions.iter().enumerate() {
        let [along, normal] = [along, normal].map(|v| folding.folding((&second_order.modes * v).as_slice()));
        for sign in [1.0, -1.0] {
            let tangent = along.iter().map(|entry| sign * entry).collect();
            if let Some(x) = follow_out(folding, question, tangent, &normal) {
                let sign = if folding.shape(&x)?.curvature < 0.0 { -1 } else { 1 };
                starts.push(Start { x, sign, line });
            }
        }
    }
    if starts.is_empty() && !directions.is_empty() {
        return Err(SurfaceError::NoStart { rays: 2 * directions.len() });
    }
    Ok(starts)
}

/// The state a chart's radius away on the hyperplane, or where half of the largest curvature is met.
fn follow_out(
    folding: &mut Folding<'_>,
    question: &Question<'_>,
    tangent: Vec<f64>,
    normal: &[f64],
) -> Option<Vec<f64>> {
    let options =
        Options { tolerance: question.tolerance, length: question.radius, stops: vec![0], ..Options::default() };
    let drawn = folding.drawn();
    let mut section = Section::new(folding, drawn.clone(), normal.to_vec());
    let found = follow(&mut section, drawn, tangent, &options, &mut |_| true);
    let last = found.points.into_iter().next_back()?;
    (last.arc_length > 0.0).then_some(last.x)
}

/// One line on the cone of a quadric whose eigenvalues have both signs; none otherwise.
fn nappes(quadric: &DenseMatrix) -> Result<Vec<Direction>, KinematicsError> {
    let found = symmetric_eigen(quadric)?;
    let zero = ZERO * found.values.iter().fold(0.0f64, |most, value| most.max(value.abs()));
    let [positive, negative] =
        [1.0, -1.0].map(|sign| (0..found.values.len()).filter(|&k| sign * found.values[k] > zero).collect::<Vec<_>>());
    let (alone, other, normal) = match (&positive[..], &negative[..]) {
        (&[alone], &[other, normal]) | (&[other, normal], &[alone]) => (alone, other, normal),
        _ => return Ok(Vec::new()),
    };
    let [alone_size, other_size] = [alone, other].map(|k| found.values[k].abs().sqrt());
    let vector = |k: usize| found.vectors.column(k).into_owned();
    let along = (vector(alone) * other_size + vector(other) * alone_size).normalize();
    Ok(vec![Direction { along, normal: vector(normal) }])
}

/// The simple real rays on hyperplanes in general position.
fn on_sections(second_order: &SecondOrder) -> Result<Vec<Direction>, KinematicsError> {
    let count = second_order.count();
    let mut found = Vec::new();
    for seed in 0..SECTIONS {
        let mut numbers = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
        let normal = DVector::from_fn(count, |_, _| numbers.random_range(-1.0..1.0)).normalize();
        let inside = null_space(&DenseMatrix::from_row_slice(1, count, normal.as_slice()))?.basis;
        let section = SecondOrder {
            modes: inside.clone(),
            forms: Vec::new(),
            quadrics: second_order.quadrics.iter().map(|quadric| inside.tr_mul(&(quadric * &inside))).collect(),
            gaps: second_order.gaps,
        };
        let rays = Rays::new(&section)?.rays.into_iter();
        let simple = rays.filter(|ray| ray.sign == 1 && ray.multiplicity == 1);
        found.extend(simple.map(|ray| Direction { along: ray.direction.into(), normal: normal.clone() }));
    }
    Ok(found)
}

/// Branch and sign of every start. Starts on one line through the drawn state, and on one piece of the surface, have
/// one number.
pub(super) fn branches(atlas: &Atlas, starts: &[Start]) -> Vec<(usize, i8)> {
    let mut piece = pieces(atlas, starts.len());
    for (k, start) in starts.iter().enumerate() {
        for opposite in (0..k).filter(|&other| starts[other].line == start.line) {
            join(&mut piece, opposite, k);
        }
    }
    let mut seen: Vec<usize> = Vec::new();
    let numbers = piece.iter().map(|piece| {
        seen.iter().position(|other| other == piece).unwrap_or_else(|| {
            seen.push(*piece);
            seen.len() - 1
        })
    });
    numbers.collect::<Vec<_>>().into_iter().zip(starts).map(|(number, start)| (number, start.sign)).collect()
}

/// Gives the classes of two members one number.
fn join(class: &mut [usize], a: usize, b: usize) {
    let (one, two) = (class[a], class[b]);
    class.iter_mut().filter(|number| **number == two).for_each(|number| *number = one);
}

/// For each start a number that it shares with the starts on the same piece.
fn pieces(atlas: &Atlas, starts: usize) -> Vec<usize> {
    let mut piece: Vec<usize> = (0..starts).collect();
    for [a, b, c] in &atlas.triangles {
        for other in [b, c] {
            join(&mut piece, atlas.charts[*a].start, atlas.charts[*other].start);
        }
    }
    piece
}
