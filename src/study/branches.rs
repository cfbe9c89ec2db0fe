//! `kind = "branches"`: the rays along which rigid folding leaves the drawn state.

mod summary;

use super::{Answer, Context, NoAnswer, StudyError, StudyResult, supported};
use crate::analysis::branches::{Branches, branches};
use crate::kinematics::{Rays, RealDirections};
use crate::model::{Assembly, Domain};
use crate::output::table::{Table, Value};
pub use summary::{BranchesSummary, RaySummary};

/// Largest difference between the angle of a lock and the drawn angle, in radians, at which both count as equal.
const AS_DRAWN: f64 = 1e-9;

/// Checks that the sheet is a screw or a patch, that bars are at rest as drawn, and that locks and rigid hinges hold
/// the drawn angles.
pub(crate) fn check(context: &Context<'_>) -> Result<(), StudyError> {
    let assembly = context.assembly;
    if assembly.domain().is_torus() {
        let message = "branches of a torus are not known: its lattice has conditions of its own";
        return Err(context.refuse(message, "use domain = \"screw\" or \"patch\"").into());
    }
    supported::drawn_lengths(context, "branches of rigid folding")?;
    supported::drawn_rigid_hinges(context, "branches of rigid folding")?;
    let angles = assembly.start_angles();
    let moved = |(edge, angle): &&(usize, f64)| (angle - angles[*edge]).abs() > AS_DRAWN;
    let Some((edge, angle)) = assembly.terms().locks.iter().find(moved) else { return Ok(()) };
    let message = format!("a lock holds a crease at {angle} that starts at {}", angles[*edge]);
    let help = "rigid folding leaves the drawn state, of a tube the closed one: leave out the angle of the lock";
    Err(context.refuse(message, help).into())
}

/// Returns the number of rays that leave the drawn state of a rigid cell with locks, if it is larger than two. Then
/// more than one motion passes through the drawn state, and a relaxation that starts there may reach one of several
/// equilibria.
///
/// The second value tells whether all real directions are known; `None` if they were not computed.
pub(crate) fn branch_point(assembly: &Assembly) -> (Option<usize>, Option<RealDirections>) {
    let rigid = assembly.terms().has_rigid_bars() && assembly.has_drawn_lengths();
    if !rigid || *assembly.domain() != Domain::Screw || assembly.terms().locks.is_empty() {
        return (None, None);
    }
    match branches(assembly) {
        Ok(Branches { rays: Rays { rays, directions, .. }, .. }) => {
            (Some(rays.len()).filter(|count| *count > 2), Some(directions))
        }
        Err(_) => (None, Some(RealDirections::NotEstablished)),
    }
}

/// Returns the word of the summary for the completeness of the directions.
pub(crate) fn word(directions: RealDirections) -> String {
    let word = match directions {
        RealDirections::Listed => "listed",
        RealDirections::Continuum => "continuum",
        RealDirections::NotEstablished => "not-established",
    };
    word.to_owned()
}

/// Computes the branches.
pub(crate) fn compute(context: &Context<'_>) -> Result<Answer, NoAnswer> {
    let mut answer = Answer::empty(context.study);
    context.step(0, None);
    let branches = branches(context.assembly).map_err(NoAnswer::because)?;
    answer.add(format!("{}.csv", context.name()), table(context.assembly, &branches));
    let error = branches.rays.rays.iter().map(|ray| ray.error).max_by(f64::total_cmp);
    answer.conclude(StudyResult::Branches(summary(&branches)), error, None);
    Ok(answer)
}

/// Returns a row for each ray, with the rate of every fold angle. On a patch of several cells the names of columns
/// contain the cell.
fn table(assembly: &Assembly, branches: &Branches) -> Table {
    let several = assembly.tiling().cells != [1, 1];
    let rate = assembly.tiling().edges.iter().map(|edge| {
        let key = assembly.sheet().edges[edge.edge].key;
        let cell = if several { format!("_{}_{}", edge.cell[0], edge.cell[1]) } else { String::new() };
        format!("rate_{}_{}_{}_{}{cell}", key.i, key.j, key.shift[0], key.shift[1])
    });
    let rows = branches.rays.rays.iter().zip(&branches.curvature_signs).map(|(ray, curvature)| {
        let counts = [ray.branch.into(), i64::from(ray.sign).into(), ray.multiplicity.into()];
        let others = [curvature.map(i64::from).into(), ray.error.into()];
        let rates = ray.direction.iter().map(|rate| Value::Number(*rate));
        counts.into_iter().chain(others).chain(rates)
    });
    Table::new("branch,sign,multiplicity,curvature_sign,error").with(rate).with_rows(rows)
}

fn summary(branches: &Branches) -> BranchesSummary {
    let Branches { modes, quadrics, signature, rays, curvature_signs, .. } = branches;
    let listed = rays.rays.iter().zip(curvature_signs).map(|(ray, curvature_sign)| RaySummary {
        branch: ray.branch,
        sign: ray.sign,
        multiplicity: ray.multiplicity,
        direction: ray.direction.clone(),
        curvature_sign: *curvature_sign,
    });
    BranchesSummary {
        modes: *modes,
        quadrics: *quadrics,
        signature: *signature,
        dimension: rays.dimension,
        complex_solutions: rays.complex_solutions,
        distinct: rays.distinct,
        expected: rays.expected,
        on_continua: rays.on_continua,
        extraneous: rays.extraneous,
        singular: rays.singular,
        directions: word(rays.directions),
        real_rays: rays.rays.len(),
        rays: listed.collect(),
    }
}
