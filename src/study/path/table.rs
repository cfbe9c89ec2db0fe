//! The table of a path: one row for each state.

use super::drive::yields;
use super::plot::event_word;
use crate::analysis::intersections::Marks;
use crate::analysis::path::{PathBranch, PathPoint, Probe};
use crate::analysis::state::{Cylinder, cylinder};
use crate::output::table::{CYLINDER, EnergiesAndResiduals, RATIOS, Table, Value};
use crate::scene::spec::PathSpec;
use crate::study::{Context, energies, ratios, states};

/// Returns the table of all states. That of a periodic sheet has the columns of a cylinder; where the study asks for
/// them, there are the columns of self-intersections and of Poisson's ratios.
pub(crate) fn table(
    context: &Context<'_>,
    (spec, probes): (&PathSpec, &[(&str, Probe)]),
    branches: &[PathBranch],
    marks: Option<&[Vec<Marks>]>,
) -> Table {
    let asked = |given: bool, columns: &'static [&'static str]| if given { columns } else { &[] }.iter().copied();
    let drawn = context.assembly.drawn().coordinates.clone();
    let mut table = Table::new("branch,step,arc_length,drive,reaction,work")
        .with(EnergiesAndResiduals::columns(context.assembly.terms().own_names()))
        .with(["negative_eigenvalues", "event"])
        .with(asked(marks.is_some(), &["self_intersecting"]))
        .with(asked(context.assembly.domain().is_periodic(), &CYLINDER))
        .with(asked(spec.response.is_some(), &RATIOS))
        .with(asked(yields(context), &["dissipated"]))
        .with(probes.iter().map(|(name, _)| format!("probe_{name}")))
        .with(volumes(context, &drawn).map(|(name, _)| format!("volume_{name}")))
        .with(["state"])
        .with_edges("fold", context.assembly.sheet().edges.iter().map(|edge| &edge.key));
    for (number, branch) in branches.iter().enumerate() {
        for (step, point) in branch.points.iter().enumerate() {
            let crossing = marks.map(|marks| marks[number].get(step).map(|marks| i64::from(marks.any)).into());
            let state = table.len();
            table.push(row(context, (spec, probes), [number, step, state], point, crossing));
        }
    }
    table
}

fn row(
    context: &Context<'_>,
    (spec, probes): (&PathSpec, &[(&str, Probe)]),
    [branch, step, number]: [usize; 3],
    point: &PathPoint,
    crossing: Option<Value>,
) -> Vec<Value> {
    let (assembly, coordinates) = (context.assembly, &point.state.coordinates);
    let numbers = [point.arc_length, point.drive, point.reaction, point.work].map(Value::Number);
    let shape = cylinder(assembly.drawn(), coordinates);
    let shape = shape.map(|Cylinder { curvature, theta, strain }| [&[curvature][..], &theta, &strain].concat());
    let residuals = [point.residual_force, point.residual_length];
    let solution = EnergiesAndResiduals::new(energies::columns(assembly.terms(), &point.state), Some(residuals));
    // a column of words, also where no state is an event
    let event = Value::Word(point.event.map_or("", event_word));
    let ratios = ratios::of_state(assembly, spec.response.as_ref(), coordinates);
    let state = states::with_all_angles(context, &point.state);
    let fold = states::cell_angles(context, &state).into_iter().map(Value::Number);
    let [branch, step, number] = [branch, step, number].map(Value::from);
    let own = [branch, step].into_iter().chain(numbers).chain(solution.values());
    let own = own.chain([point.negative_eigenvalues.into(), event]);
    let shape = shape.into_iter().flatten().map(Value::Number);
    let asked = crossing.into_iter().chain(shape).chain(ratios.into_iter().flatten().map(Value::from));
    let moved = probes.iter().map(|(_, probe)| probe.displacement(assembly, coordinates).into());
    let volumes = volumes(context, coordinates).map(|(_, volume)| volume.into());
    let dissipated = yields(context).then_some(Value::Number(point.state.dissipated));
    own.chain(asked).chain(dissipated).chain(moved).chain(volumes).chain([number]).chain(fold).collect()
}

/// The names of pressures, and the volumes that their faces enclose in a state.
fn volumes<'a>(context: &Context<'a>, coordinates: &'a [f64]) -> impl Iterator<Item = (&'a str, f64)> {
    context.assembly.terms().own.iter().filter_map(|term| term.volume(coordinates))
}
