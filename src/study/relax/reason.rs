//! The reasons for which a relaxation did not converge, in the terms of the scene.

use crate::analysis::state::State;
use crate::model::Assembly;
use crate::sheet::Info;
use crate::solver::Failure;

/// Quality of a triangle below which rounding errors of its shape can matter; 1 for an equilateral triangle.
const THIN: f64 = 1e-2;
/// Largest difference between a locked angle and its prescribed value that counts as rounding, in radians.
const MET: f64 = 1e-9;

/// Returns a description of the failure, with its possible cause: a lock that is not satisfied or a thin triangle.
pub(crate) fn reason(assembly: &Assembly, failure: Failure, state: &State) -> String {
    let cause = match failure {
        Failure::Infeasible { .. } => unmet_lock(assembly, state),
        Failure::Uncertain { force, tolerance, .. } if !(force <= tolerance) => thin_triangle(assembly),
        Failure::Stuck { .. } | Failure::TooManySteps { .. } => thin_triangle(assembly),
        _ => None,
    };
    match cause {
        Some(cause) => format!("{failure}; {cause}"),
        None => failure.to_string(),
    }
}

/// Describes the lock whose crease has the largest difference from its prescribed angle in the last state.
fn unmet_lock(assembly: &Assembly, state: &State) -> Option<String> {
    let off = |&(edge, angle): &(usize, f64)| {
        let here = *state.fold_angle.get(edge)?;
        Some((edge, angle, here)).filter(|_| (angle - here).abs() > MET)
    };
    let farther = |a: &(usize, f64, f64), b: &(usize, f64, f64)| (a.1 - a.2).abs().total_cmp(&(b.1 - b.2).abs());
    let (edge, angle, here) = assembly.terms().locks.iter().filter_map(off).max_by(farther)?;
    let key = assembly.sheet().edges[assembly.tiling().edges[edge].edge].key;
    Some(format!("the lock of crease {key} at {angle} rad stays at {here:.6} rad"))
}

fn thin_triangle(assembly: &Assembly) -> Option<String> {
    let info = Info::new(assembly.sheet());
    let quality = info.worst_triangle_quality;
    let named = info.thinnest.first().map_or(String::new(), |thin| format!(", with the vertices {:?}", thin.vertices));
    (quality < THIN)
        .then(|| format!("the worst triangle of the sheet is thin, of quality {quality:.1e} (1: equilateral){named}"))
}
