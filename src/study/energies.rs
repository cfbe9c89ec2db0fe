//! The energies of a state as tables and summaries have them: empty where a term was not built.

use crate::analysis::state::State;
use crate::model::Terms;
use crate::output::summary::EnergySummary;

/// Energies of bars, creases, facets and all terms, the last one always known.
pub(crate) fn columns(terms: &Terms, state: &State) -> [Option<f64>; 4] {
    let EnergySummary { bars, creases, facets, total } = summary(terms, state);
    [bars, creases, facets, Some(total)]
}

/// The same; the last one is empty where neither bars nor creases were built.
pub(crate) fn columns_if_any(terms: &Terms, state: &State) -> [Option<f64>; 4] {
    let [bars, creases, facets, total] = columns(terms, state);
    let any = terms.bars.is_some() || terms.creases.is_some();
    [bars, creases, facets, total.filter(|_| any)]
}

/// Energies by terms.
pub fn summary(terms: &Terms, state: &State) -> EnergySummary {
    EnergySummary {
        bars: terms.bars.map(|_| state.energy_bars),
        creases: terms.creases.as_ref().map(|_| state.energy_creases),
        facets: terms.facets.as_ref().map(|_| state.energy_facets),
        total: state.total(),
    }
}
