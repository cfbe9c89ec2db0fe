//! The rank of the bars and rigid polygons of a model.

use super::error::{LEAST_GAP, ModesError};
use super::spectrum::{DENSE_LIMIT, Observer, go_on, linearized};
use crate::model::{Hinges, Model, RIGID, Terms};
use crate::numerics::sparse::Rows;
use crate::numerics::vector::max_abs;
use crate::numerics::{dense, rank};
use crate::solver::Problem;

/// Bars and rigid polygons only, all rigid; pins and parts as they are.
pub(super) fn rigid_part(terms: &Terms) -> Terms {
    let rigid = |hinges: &Hinges| Some(Hinges { stiffness: hinges.stiffness.rigid_part()?, rest: hinges.rest.clone() });
    let facets = terms.facets.as_ref().and_then(rigid);
    Terms { bars: Some(RIGID.into()), facets, pins: terms.pins.clone(), parts: terms.parts.clone(), ..Terms::default() }
}

/// Rank of the Jacobian of a model's stiff measures at its reference state, and the gap.
pub(super) fn rank_of(model: &Model, observe: &mut Observer<'_>) -> Result<(usize, Option<f64>), ModesError> {
    let layout = model.layout();
    let at = linearized(model, &vec![0.0; layout.stiff.len()]);
    let values = at.scaled_jacobian();
    let rows = Rows { cliques: at.rows().cliques, values: &values };
    if layout.unknowns.max(layout.stiff.len()) > DENSE_LIMIT {
        return rank_by_counting(&rows, layout.unknowns, &layout.node, observe);
    }
    go_on(observe)?;
    let values = dense::singular_values(&dense::from_rows(&rows, layout.unknowns))?;
    let largest = max_abs(rows.values);
    let found = dense::rank_of_sums(&values, largest)?;
    if found.rank == 0 {
        return Ok((0, None));
    }
    let threshold = threshold(&values, found.rank) / largest;
    go_on(observe)?;
    let by_inertia = rank::count_above(&rows, layout.unknowns, &layout.node, threshold)?;
    if by_inertia == found.rank {
        Ok((found.rank, Some(found.gap)))
    } else {
        Err(ModesError::RankDisagrees { by_values: found.rank, by_inertia })
    }
}

/// A threshold between the last kept and the first dropped singular value, far from both where it can be.
fn threshold(values: &[f64], rank: usize) -> f64 {
    let kept = values[rank - 1];
    let dropped = values.get(rank).copied().unwrap_or(0.0);
    (kept * dropped.max(1e-8 * kept)).sqrt()
}

/// Counts singular values above thresholds a decade apart; the longest run of equal counts is the gap.
fn rank_by_counting(
    rows: &Rows<'_>,
    columns: usize,
    node: &[u32],
    observe: &mut Observer<'_>,
) -> Result<(usize, Option<f64>), ModesError> {
    let mut counts = Vec::new();
    for decade in 1..=8 {
        go_on(observe)?;
        counts.push(rank::count_above(rows, columns, node, 10f64.powi(-decade))?);
    }
    let runs = counts.chunk_by(|count, next| count == next).map(|run| (run[0], run.len()));
    let (rank, length) = runs.fold((0, 0), |longest, run| if run.1 > longest.1 { run } else { longest });
    let gap = 10f64.powi(length as i32 - 1);
    if gap >= LEAST_GAP { Ok((rank, (rank > 0).then_some(gap))) } else { Err(ModesError::NoGap { gap }) }
}
