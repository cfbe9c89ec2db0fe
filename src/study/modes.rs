//! `kind = "modes"`: zero modes and self-stresses of the bars, linear folding modes, the spectrum of the energy.

mod summary;

use super::{Answer, Context, NoAnswer, StudyError, StudyResult, start, states, supported};
use crate::analysis::modes::{
    Modes, ModesError, SPARSE_EIGENVALUES, Vibrations, buckling, check_masses, decomposed_dense, modes_at,
};
use crate::model::{Configuration, Gauge};
use crate::output::figure::rounded;
use crate::output::table::Table;
use crate::scene::spec::ModesSpec;
pub use summary::ModesSummary;

/// Checks that a start file fits the sheet, and that the model is not too large for the number of eigenvalues that the
/// study asks for.
pub(crate) fn check(context: &Context<'_>, spec: &ModesSpec) -> Result<(), StudyError> {
    start::check(context, spec.start.as_ref())?;
    check_loads(context, spec)?;
    let Some(count) = &spec.eigenvalues else { return Ok(()) };
    supported::drawn_lengths(context, "eigenvalues")?;
    if **count > 0 {
        masses(context)?;
    }
    let (drawn, terms) = (context.assembly.drawn(), context.assembly.terms());
    let unknowns = drawn.coordinates.len().saturating_sub(drawn.held.len() + terms.pinned());
    if **count > unknowns {
        let message = format!("{} eigenvalues are too many for a model of {unknowns} coordinates", **count);
        return Err(context.file.error_at(count.span(), message, format!("ask for at most {unknowns}")).into());
    }
    let Err(error) = decomposed_dense(unknowns, **count, unknowns) else { return Ok(()) };
    let help = format!("ask for at most {SPARSE_EIGENVALUES}, or take fewer cells");
    Err(context.file.error_at(count.span(), error.to_string(), help).into())
}

/// Checks that every coordinate has a mass, if the scene gives one.
fn masses(context: &Context<'_>) -> Result<(), StudyError> {
    let Some(mass) = &context.file.scene.mass else { return Ok(()) };
    check_masses(context.assembly).map_err(|error| {
        let help = match error {
            ModesError::Massless { .. } => "give every vertex a mass, mass = { vertex = 1.0 }",
            _ => {
                "give domain = \"patch\", or \"torus\" with lattice = \"fixed\"; leave out `mass` for eigenvalues alone"
            }
        };
        context.file.error_at(mass.span(), error.to_string(), help).into()
    })
}

/// Computes the modes of the state that the scene names.
pub(crate) fn compute(context: &Context<'_>, spec: &ModesSpec) -> Result<Answer, NoAnswer> {
    let (mut step, mut answer) = (0, Answer::empty(context.study));
    let eigenvalues = spec.eigenvalues.as_ref().map_or(0, |n| **n);
    let mut model = context.assembly.model(Gauge::Held);
    let start = start::initial_state(context, spec.start.as_ref(), &mut model)?;
    let state = model.configuration(&start.x, start.tension);
    let found = modes_at(context.assembly, &state, eigenvalues, &mut || {
        step += 1;
        context.step(step, None)
    });
    let modes = found.map_err(NoAnswer::because)?;
    add_files(&mut answer, context, &modes, &state.coordinates);
    let critical_factors = add_buckling(&mut answer, context, spec, &state).map_err(NoAnswer::because)?;
    let result = StudyResult::Modes(ModesSummary { critical_factors, ..summary(&modes) });
    answer.conclude(result, modes.gap.map(f64::recip), None);
    Ok(answer)
}

fn summary(modes: &Modes) -> ModesSummary {
    ModesSummary {
        zero_modes: modes.zero_modes,
        self_stresses: modes.self_stresses,
        rigid_motions: modes.rigid_motions,
        folding_modes: modes.folding_modes,
        maxwell_count: modes.maxwell_count,
        gap: modes.gap,
        eigenvalues: modes.eigenvalues.clone(),
        frequencies: modes.vibrations.as_ref().map(Vibrations::frequencies),
        growth_rates: modes.vibrations.iter().flat_map(Vibrations::growth_rates).flatten().collect(),
        seam: modes.seam,
        critical_factors: None,
    }
}

/// Adds a table of the eigenvalues, the state with each mode as displacement, and a picture of the softest mode that is
/// not a rigid motion, drawn with an amplitude of a tenth of the sheet's size; of a sheet with mass also the
/// vibrations, of which the picture is then.
fn add_files(answer: &mut Answer, context: &Context<'_>, modes: &Modes, coordinates: &[f64]) {
    let table = Table::new("mode,eigenvalue").with_numbered(modes.eigenvalues.iter().map(|value| [*value]));
    answer.add(format!("{}.csv", context.name()), table);
    let softest = modes.rigid_motions.min(modes.vectors.len().saturating_sub(1));
    let shown = states::add_moving(answer, context, [""; 2], (coordinates, &modes.vectors), softest);
    if let Some(found) = &modes.vibrations {
        add_vibrations(answer, context, (found, modes.rigid_motions), coordinates);
    } else if let Some(shown) = shown {
        let value = rounded(modes.eigenvalues.get(softest).copied().unwrap_or(f64::NAN), 5);
        let state = format!("mode {softest}, eigenvalue {value}, drawn with an amplitude of a tenth of the sheet");
        states::add_figure(answer, context, &shown, &state);
    }
}

/// Adds a table of the frequencies and the state with each motion as displacement, and a picture of the slowest motion
/// after the rigid ones.
fn add_vibrations(
    answer: &mut Answer,
    context: &Context<'_>,
    (vibrations, rigid_motions): (&Vibrations, usize),
    coordinates: &[f64],
) {
    let frequencies = vibrations.frequencies();
    let motions = frequencies.iter().zip(vibrations.growth_rates()).map(|(frequency, rate)| [*frequency, rate]);
    let table = Table::new("mode,frequency,growth_rate").with_numbered(motions);
    answer.add(format!("{}-frequencies.csv", context.name()), table);
    let slowest = rigid_motions.min(vibrations.vectors.len().saturating_sub(1));
    let motions = (coordinates, &vibrations.vectors[..]);
    let shown = states::add_moving(answer, context, ["_vibration", "-vibrations"], motions, slowest);
    let Some(shown) = shown else { return };
    let value = match frequencies[slowest] {
        Some(frequency) => format!("frequency {}", rounded(frequency, 5)),
        None => "which grows".to_owned(),
    };
    let state = format!("vibration {slowest}, {value}, drawn with an amplitude of a tenth of the sheet");
    states::add_figure(answer, context, &shown, &state);
}

/// Checks that there are loads that could grow.
fn check_loads(context: &Context<'_>, spec: &ModesSpec) -> Result<(), StudyError> {
    let Some(wanted) = &spec.buckling else { return Ok(()) };
    if context.assembly.terms().is_loaded() {
        return Ok(());
    }
    let message = "there are no loads under which the sheet could buckle";
    Err(context.file.error_at(wanted.span(), message, "add a [[load]] or [[pressure]]").into())
}

/// Adds a table of the critical factors, and the state with each motion as displacement; the picture is that of the first.
/// Returns the factors, if the study asks for them.
fn add_buckling(
    answer: &mut Answer,
    context: &Context<'_>,
    spec: &ModesSpec,
    state: &Configuration,
) -> Result<Option<Vec<f64>>, ModesError> {
    let Some(wanted) = &spec.buckling else { return Ok(None) };
    let loaded = (!start::is_drawn(spec.start.as_ref())).then_some(state);
    let found = buckling(context.assembly, loaded, wanted.0 as usize, &mut || context.step(0, None))?;
    let name = context.name();
    let table = Table::new("mode,factor").with_numbered(found.factors.iter().map(|factor| [*factor]));
    answer.add(format!("{name}-buckling.csv"), table);
    let motions = (&state.coordinates[..], &found.vectors[..]);
    let shown = states::add_moving(answer, context, ["_buckling", "-buckling"], motions, 0);
    if let (Some(factor), Some(shown)) = (found.factors.first(), shown) {
        let factor = rounded(*factor, 5);
        let words = format!("buckles at {factor} times the loads, drawn with an amplitude of a tenth of the sheet");
        states::add_figure_as(&format!("{name}-buckling"), answer, context, (&shown, &*words, 1.0));
    }
    Ok(Some(found.factors))
}
