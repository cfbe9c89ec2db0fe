//! The energies of a state as tables and summaries list them; entries of terms that the model does not have are empty.

use crate::analysis::state::State;
use crate::model::Terms;
use crate::output::table::Energies;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Energy by terms; null where the term is not there, or not finite after a relaxation that failed.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct EnergySummary {
    /// Stretching.
    pub bars: Option<f64>,
    /// Folding.
    pub creases: Option<f64>,
    /// Bending of polygons.
    pub facets: Option<f64>,
    /// The other terms, each by its name.
    #[serde(flatten)]
    pub others: BTreeMap<String, Option<f64>>,
    /// Their sum: the elastic energy.
    #[schemars(with = "Option<f64>")]
    pub total: f64,
}

/// Returns the energies of the terms and their sum, which is always given.
pub(crate) fn columns(terms: &Terms, state: &State) -> Energies {
    let EnergySummary { bars, creases, facets, others, total } = summary(terms, state);
    Energies { of_edges: [bars, creases, facets], others: others.into_iter().collect(), total: Some(total) }
}

/// Returns the same energies as [`columns`], without the last one if the model has neither bars nor creases.
pub(crate) fn columns_if_any(terms: &Terms, state: &State) -> Energies {
    let energies = columns(terms, state);
    let any = terms.bars.is_some() || terms.creases.is_some();
    Energies { total: energies.total.filter(|_| any), ..energies }
}

/// Returns the energies of the terms and their sum.
pub fn summary(terms: &Terms, state: &State) -> EnergySummary {
    let other = |name: &str| (name.to_owned(), Some(state.energy_of_term(name)).filter(|energy| energy.is_finite()));
    EnergySummary {
        bars: terms.bars.as_ref().map(|_| state.energy_bars),
        creases: terms.creases.as_ref().map(|_| state.energy_creases),
        facets: terms.facets.as_ref().map(|_| state.energy_facets),
        others: terms.own_names().into_iter().map(other).collect(),
        total: state.total(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Length, OwnTerm, Site, Spring};
    use crate::output::table::{EnergiesAndResiduals, Value};

    /// Claim: each energy of a term of one's own stands in the column of its name, in whatever order the terms were
    /// given, and terms of one name are one column.
    #[test]
    fn energies_stand_in_their_columns() {
        let ends = [0, 1].map(|vertex| Site { vertex, shift: [0, 0] });
        let term = |name: &str| OwnTerm::new(name, Length, [(ends, Spring { stiffness: 1.0, rest: 1.0 })]);
        let terms = Terms { own: ["z", "a", "z"].map(term).to_vec(), ..Terms::default() };
        let energy_own = vec![("z".to_owned(), 26.0), ("a".to_owned(), 1.0)];
        let state = State { energy_own, ..State::empty(vec![], 0) };
        let names = EnergiesAndResiduals::columns(terms.own_names());
        let solution = EnergiesAndResiduals { energy: columns(&terms, &state), ..EnergiesAndResiduals::default() };
        let values = solution.values();
        assert_eq!(names[3..6], ["energy_a", "energy_z", "energy_total"]);
        assert_eq!(values[3..6], [1.0, 26.0, 27.0].map(Value::Number));
        assert_eq!(names.len(), values.len());
    }
}
