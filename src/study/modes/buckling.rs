//! The critical loads of a study of kind `modes`: their table, series and picture.

use crate::analysis::modes::{ModesError, buckling};
use crate::model::Configuration;
use crate::output::figure::rounded;
use crate::output::table::Table;
use crate::scene::spec::ModesSpec;
use crate::study::{Answer, Context, StudyError, start, states};

/// Checks that there are loads that could grow.
pub(super) fn check(context: &Context<'_>, spec: &ModesSpec) -> Result<(), StudyError> {
    let Some(wanted) = &spec.buckling else { return Ok(()) };
    if context.assembly.terms().is_loaded() {
        return Ok(());
    }
    let message = "there are no loads under which the sheet could buckle";
    Err(context.file.error_at(wanted.span(), message, "add a [[load]] or [[pressure]]").into())
}

/// Adds a table of the critical factors, and the state with each motion as displacement; the picture is that of the first.
/// Returns the factors, if the study asks for them.
pub(super) fn factors(
    answer: &mut Answer,
    context: &Context<'_>,
    spec: &ModesSpec,
    state: &Configuration,
) -> Result<Option<Vec<f64>>, ModesError> {
    let Some(wanted) = &spec.buckling else { return Ok(None) };
    let loaded = (!start::is_drawn(spec.start.as_ref())).then_some(state);
    let found = buckling(context.assembly, loaded, wanted.0 as usize, &mut || context.step(0, None))?;
    let name = context.name();
    let mut table = Table::new("mode,factor");
    found.factors.iter().enumerate().for_each(|(k, factor)| table.push([k.into(), (*factor).into()]));
    answer.add(format!("{name}-buckling.csv"), table);
    let motions = (&state.coordinates[..], &found.vectors[..]);
    let shown = states::add_moving(answer, context, ["_buckling", "-buckling"], motions, 0);
    if let (Some(factor), Some(shown)) = (found.factors.first(), shown) {
        let factor = rounded(*factor, 5);
        let words = format!("buckles at {factor} times the loads, drawn with an amplitude of a tenth of the sheet");
        states::add_figure_as(&format!("{name}-buckling"), answer, context, (&shown, &words));
    }
    Ok(Some(found.factors))
}
