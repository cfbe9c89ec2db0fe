//! Forces and angles of an earlier state, so that an equilibrium is one again when a relaxation starts from it.
//!
//! Where a state was kept with its tensions they are taken as they are. Where they are missing, or belong to another
//! stiffness, those of finite stiffness follow from the geometry, and those of rigid measures from the balance of
//! forces.

use super::state::{REMEMBERED, State};
use crate::model::{Assembly, Configuration, Element, Gauge, Memory, Model, TermKind};
use crate::solver::{HessianKind, Linearization, Problem, Residuals, Start, Tangent};

/// Scaled disagreement of a measure and its tension up to which the tension is taken.
const AGREES: f64 = 1e-10;
/// Scaled gaps of this size may be rounding error of the coordinates: no tension follows from them.
const ROUNDING: f64 = 1e-13;
/// Scaled force of a state that needs no other tensions, and the relative residual of the system that finds them.
const BALANCED: f64 = 1e-12;
const EXACT: f64 = 1e-14;
/// Scaled force up to which tensions are those of a state near an equilibrium, and help.
const NEARLY_BALANCED_FORCE: f64 = 0.1;

/// What is known of the forces of a state.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Forces {
    /// Nothing.
    Unknown,
    /// The tension of every stiff measure of the same model.
    OfMeasures(Vec<f64>),
    /// The force along every bar, and the torque of all hinges over every edge; NaN where it is not known.
    OfEdges {
        /// Force along the bar of every edge.
        tension: Vec<f64>,
        /// Torque of the hinges over every edge.
        torque: Vec<f64>,
    },
}

/// The drawn state of an assembly, with the tensions that follow from it.
pub(crate) fn drawn(assembly: &Assembly) -> Configuration {
    let model = assembly.model(Gauge::Free);
    let tension = tensions(&model, &model.start(), &Forces::Unknown);
    Configuration::new(assembly.drawn().coordinates.clone(), model.angles(), Some(tension))
}

/// The tensions of all stiff measures at `x`: those that are known, where they agree with the geometry; else what
/// follows from it.
pub(crate) fn tensions(model: &Model, x: &[f64], known: &Forces) -> Vec<f64> {
    let gaps = model.gaps(x);
    let by_law = by_law(model, &gaps);
    let known = match known {
        Forces::OfMeasures(tension) if tension.len() == by_law.len() => tension.clone(),
        Forces::Unknown | Forces::OfMeasures(_) => return by_law,
        Forces::OfEdges { tension, torque } => of_edges(model, x, (tension, torque), &by_law),
    };
    let scales = model.compliance().iter().zip(model.gap_scale());
    let measures = gaps.iter().zip(scales).zip(known.into_iter().zip(by_law));
    let agrees = |gap: f64, c: f64, scale: f64, t: f64| (gap - c * t).abs() <= AGREES * scale || c == 0.0;
    let agreed = measures.map(
        |((gap, (c, scale)), (known, law))| {
            if known.is_finite() && agrees(*gap, *c, *scale, known) { known } else { law }
        },
    );
    agreed.collect()
}

/// Returns the state with the quantities of every edge; angles of edges that are not hinges of the assembly are in
/// (-pi, pi]. `None` if the configuration is not one of this assembly.
pub fn state(configuration: &Configuration, assembly: &Assembly) -> Option<State> {
    let mut model = assembly.model(Gauge::Held);
    let fits = configuration.coordinates.len() == assembly.drawn().coordinates.len();
    if !(fits && configuration.angles.len() == model.angles().len()) {
        return None;
    }
    let x = model.enter(configuration).x;
    let forces = configuration.tension.clone().map_or(Forces::Unknown, Forces::OfMeasures);
    let tension = tensions(&model, &x, &forces);
    let coordinates = configuration.coordinates.clone();
    let angles = assembly.fold_angles_at(&coordinates);
    Some(State { coordinates, ..State::new(&model, &x, &tension) }.with_angles(angles))
}

/// Returns the state of a start. Where its tensions are not known they follow from the geometry.
pub(crate) fn state_at(model: &Model, start: &Start) -> State {
    let by_law = || tensions(model, &start.x, &Forces::Unknown);
    State::new(model, &start.x, &start.tension.clone().unwrap_or_else(by_law))
}

/// Where a relaxation starts that knows these forces, completed by those of rigid measures: with them near an
/// equilibrium, without them elsewhere.
pub(crate) fn start(model: &Model, x: Vec<f64>, known: &Forces) -> Start {
    let mut tensions = tensions(model, &x, known);
    let mut force = unbalanced(model, &x, &tensions);
    while force > BALANCED && model.compliance().contains(&0.0) {
        let Some(better) = completed(model, &x, &tensions) else { break };
        let left = unbalanced(model, &x, &better);
        if !(left < 0.5 * force) {
            break;
        }
        (force, tensions) = (left, better);
    }
    let helps = force <= NEARLY_BALANCED_FORCE && tensions.iter().any(|t| *t != 0.0);
    Start { x, tension: helps.then_some(tensions) }
}

/// The scaled unbalanced force.
fn unbalanced(model: &Model, x: &[f64], tensions: &[f64]) -> f64 {
    let mut at = Linearization::new(model.layout());
    model.linearize(x, tensions, HessianKind::GaussNewton, &mut at);
    Residuals::new(model, &at, tensions).force
}

/// The tensions, with those of rigid measures that leave the least unbalanced force; `None` where they cannot be found.
fn completed(model: &Model, x: &[f64], tensions: &[f64]) -> Option<Vec<f64>> {
    let mut tangent = Tangent::at_state(model, x, tensions, HessianKind::GaussNewton).ok()?;
    model.hold(tensions, &mut tangent.at);
    tangent.factor_shortest().ok()?;
    // the shortest motion that the forces can make: what keeps it from being longer are the tensions
    let (force, nothing) = (tangent.at.force(tensions), vec![0.0; tensions.len()]);
    let more = tangent.solve(&force, &nothing, EXACT).dt;
    let rigid = |((t, dt), c): ((&f64, &f64), &f64)| if *c == 0.0 { t + dt } else { *t };
    Some(tensions.iter().zip(&more).zip(model.compliance()).map(rigid).collect())
}

/// Tensions of finite stiffness from the gaps; zero where all gaps of a term are rounding error, and for rigid
/// measures.
fn by_law(model: &Model, gaps: &[f64]) -> Vec<f64> {
    let (compliance, scale) = (model.compliance(), model.gap_scale());
    let mut tension = vec![0.0; gaps.len()];
    for kind in TermKind::ALL {
        let measures = model.stiff().enumerate().filter(|(_, element)| element.kind() == kind).map(|(k, _)| k);
        let measures: Vec<usize> = measures.collect();
        if measures.iter().any(|&k| gaps[k].abs() > ROUNDING * scale[k]) {
            let elastic = measures.into_iter().filter(|&k| compliance[k] > 0.0);
            elastic.for_each(|k| tension[k] = gaps[k] / compliance[k]);
        }
    }
    tension
}

/// Tensions of the stiff measures from forces on edges. Of several hinges over one edge the last one has what the
/// others leave.
fn of_edges(model: &Model, x: &[f64], (tension, torque): (&[f64], &[f64]), by_law: &[f64]) -> Vec<f64> {
    let coordinates = model.coordinates(x);
    let (mut left, mut along) = (torque.to_vec(), tension.to_vec());
    for element in model.soft() {
        let of_edges = if element.is_angle() { &mut left } else { &mut along };
        let Some(edge) = element.edge() else { continue };
        of_edges[edge] -= element.response(element.value(&coordinates))[1];
    }
    let measures: Vec<(bool, Option<usize>)> =
        model.stiff().map(|element| (element.is_angle(), element.edge())).collect();
    let mut last = vec![usize::MAX; torque.len()];
    for (row, (_, edge)) in measures.iter().enumerate().filter(|(_, (angle, _))| *angle) {
        edge.iter().for_each(|&edge| last[edge] = row);
    }
    let mut tensions = Vec::with_capacity(measures.len());
    for (row, &(angle, edge)) in measures.iter().enumerate() {
        tensions.push(match (edge, angle) {
            (None, _) => by_law[row],
            (Some(edge), false) => along[edge],
            (Some(edge), true) if last[edge] == row => left[edge],
            (Some(edge), true) => {
                left[edge] -= by_law[row];
                by_law[row]
            }
        });
    }
    // what supports carry stands on no edge
    tensions.resize(by_law.len(), 0.0);
    tensions
}

/// The memories of the elements of a model. `on_edges` gives one number of them for every edge, by its name in
/// [`REMEMBERED`]; a number that is not finite counts as zero.
pub fn memory(model: &Model, on_edges: impl Fn(&str) -> Vec<f64>) -> Vec<Memory> {
    let known = REMEMBERED.map(|names| names.map(&on_edges));
    let number = |values: &[f64], edge: usize| Some(values[edge]).filter(|number| number.is_finite()).unwrap_or(0.0);
    let remembered = model.elements().filter(Element::remembers).map(|element| {
        let [kept, gone] = &known[usize::from(element.is_angle())];
        let at = |edge| Memory { kept: number(kept, edge), gone: number(gone, edge) };
        element.edge().map_or_else(Memory::default, at)
    });
    remembered.collect()
}

/// The angles from which those of the model continue: those of the edges where they are known, its own elsewhere.
pub fn angles(model: &Model, fold_angle: &[f64]) -> Vec<f64> {
    let known = |(own, angle): (f64, f64)| if angle.is_finite() { angle } else { own };
    model.angles().into_iter().zip(model.angles_among(fold_angle)).map(known).collect()
}
