//! The energies of a state as tables and summaries list them; entries of terms that the model does not have are empty.

use crate::analysis::state::State;
use crate::model::Terms;
use crate::output::summary::EnergySummary;

/// Returns the energies of bars, creases, facets and all terms together; the last one is always given.
pub(crate) fn columns(terms: &Terms, state: &State) -> [Option<f64>; 4] {
    let EnergySummary { bars, creases, facets, total } = summary(terms, state);
    [bars, creases, facets, Some(total)]
}

/// Returns the same energies as [`columns`], without the last one if the model has neither bars nor creases.
pub(crate) fn columns_if_any(terms: &Terms, state: &State) -> [Option<f64>; 4] {
    let [bars, creases, facets, total] = columns(terms, state);
    let any = terms.bars.is_some() || terms.creases.is_some();
    [bars, creases, facets, total.filter(|_| any)]
}

/// Returns the energies of the terms and their sum.
pub fn summary(terms: &Terms, state: &State) -> EnergySummary {
    EnergySummary {
        bars: terms.bars.as_ref().map(|_| state.energy_bars),
        creases: terms.creases.as_ref().map(|_| state.energy_creases),
        facets: terms.facets.as_ref().map(|_| state.energy_facets),
        total: state.total(),
    }
}
