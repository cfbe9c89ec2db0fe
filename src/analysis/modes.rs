//! Modes of the drawn state: motions and stresses of its bars, linear foldings, and the spectrum of its energy.
//!
//! The rank of the rigidity matrix is found by singular values (dense, small sheets) or by counting them against
//! thresholds (sparse, large sheets), and is believed only when a second way agrees: the count of eigenvalues of one
//! sign of a factorization, and, where the topology allows it, the null space of the closure conditions in fold angles,
//! which share no equation with the bars.

use crate::kinematics::KinematicsError;
use crate::kinematics::closure::{Closure, HingedEdge};
use crate::model::{Assembly, Boundary, Domain, Drawn, Gauge, Model, RIGID, Terms, gauge};
use crate::numerics::dense::{self, DenseError};
use crate::numerics::eigen::{self, EigenError};
use crate::numerics::factor::FactorError;
use crate::numerics::sparse::{Rows, symmetric_product};
use crate::numerics::vector::{dot, normalize};
use crate::numerics::{DenseMatrix, rank};
use crate::sheet::{Corner, Site, Tiling, pieces};
use crate::solver::{HessianKind, Linearization, Problem, Tangent};
use thiserror::Error;

/// Rigidity matrices of more rows or columns than this are not decomposed dense.
pub const DENSE_LIMIT: usize = 1200;
/// Models of up to this number of unknowns are decomposed dense where that gives eigenvalues that the iteration cannot give.
pub(crate) const DENSE_EIGENVALUES: usize = 2000;
/// Most eigenvalues that are asked of the iteration.
pub const SPARSE_EIGENVALUES: usize = 256;
/// Most shifts of the Hessian that are tried, each four times the last.
const SHIFTS: i32 = 30;
/// Smallest ratio of kept to dropped singular values at which a rank is believed.
pub(crate) const LEAST_GAP: f64 = 1e3;

/// Modes of a drawn state.
#[derive(Clone, Debug, PartialEq)]
pub struct Modes {
    /// Motions that change no bar's length (and no rigid polygon's shape), rigid motions included.
    pub zero_modes: usize,
    /// Tensions in equilibrium without load.
    pub self_stresses: usize,
    /// Rigid motions that the domain and the pins allow.
    pub rigid_motions: usize,
    /// Null space of the closure conditions; `None` where they are too many to decompose or do not say all.
    pub folding_modes: Option<usize>,
    /// Columns less rows of the rigidity matrix.
    pub maxwell_count: i64,
    /// Smallest kept over largest dropped singular value; a lower bound by a factor of ten for large sheets. `None` where none is kept:
    /// the rank is 0.
    pub gap: Option<f64>,
    /// Lowest eigenvalues of the energy's Hessian on what rigid terms leave free, ascending.
    pub eigenvalues: Vec<f64>,
    /// The eigenvectors, as velocities of all coordinates, one for each eigenvalue.
    pub vectors: Vec<Vec<f64>>,
}

/// Why there are no modes.
#[derive(Debug, Error)]
pub enum ModesError {
    /// A dense decomposition failed.
    #[error(transparent)]
    Dense(#[from] DenseError),
    /// A factorization failed.
    #[error(transparent)]
    Factor(#[from] FactorError),
    /// The closure conditions could not be set up.
    #[error(transparent)]
    Kinematics(#[from] KinematicsError),
    /// The observer asked to stop.
    #[error("stopped on request")]
    Interrupted,
    /// No rank stands out.
    #[error(
        "the rank of the rigidity matrix is not certain: kept over dropped singular value {gap:.1e}, less than {LEAST_GAP:e}"
    )]
    NoGap {
        /// Smallest kept over largest dropped singular value.
        gap: f64,
    },
    /// The iteration cannot give so many eigenvalues, and the model is too large to be decomposed dense.
    #[error(
        "{wanted} eigenvalues are too many for a model of {unknowns} coordinates: at most {SPARSE_EIGENVALUES} beyond {DENSE_EIGENVALUES}"
    )]
    TooManyEigenvalues {
        /// Asked for.
        wanted: usize,
        /// Coordinates that nothing holds.
        unknowns: usize,
    },
    /// Two ways to the rank disagree.
    #[error("the rank of the rigidity matrix is {by_values} by singular values and {by_inertia} by counting signs")]
    RankDisagrees {
        /// Rank by singular values.
        by_values: usize,
        /// Rank by inertia.
        by_inertia: usize,
    },
    /// Bars and closure disagree.
    #[error("{bars} motions or stresses of the bars, but {closure} by the closure of the vertices")]
    ClosureDisagrees {
        /// From the rigidity matrix.
        bars: usize,
        /// From the closure conditions.
        closure: usize,
    },
}

impl From<EigenError> for ModesError {
    fn from(error: EigenError) -> Self {
        match error {
            EigenError::Factor(error) => error.into(),
            EigenError::Stopped => Self::Interrupted,
        }
    }
}

/// Called between the parts of the work; returns false to stop.
pub type Observer<'a> = dyn FnMut() -> bool + Send + 'a;

/// Finds the modes. `observe` is asked before every decomposition and factorization, and before every product of the
/// iteration for eigenpairs; between them, at most for the time of one decomposition, nothing stops the work.
///
/// # Errors
/// [`ModesError`] where a factorization fails, ranks by two ways disagree, or `observe` returned false.
pub fn modes(assembly: &Assembly, eigenvalues: usize, observe: &mut Observer<'_>) -> Result<Modes, ModesError> {
    let assembly = assembly.with_axis(0.0);
    let (tiling, boundary, terms, drawn) = (assembly.tiling(), assembly.boundary(), assembly.terms(), assembly.drawn());
    let bars = assembly.with_terms(rigid_part(terms)).model(Gauge::Free);
    let (rank, gap) = rank_of(&bars, observe)?;
    let (columns, rows) = (bars.layout().unknowns, bars.layout().stiff.len());
    let rigid_motions = rigid_motions(drawn, tiling, &bars);
    let (zero_modes, self_stresses) = (columns - rank, rows - rank);
    go_on(observe)?;
    let folding_modes = folding_modes(&assembly)?;
    if let Some(closure) = folding_modes {
        let predicted = match boundary {
            Boundary::Patch if terms.pins.is_empty() => Some(zero_modes.saturating_sub(rigid_motions)),
            Boundary::FixedTorus if terms.pins.is_empty() && !terms.has_rigid_facets() => Some(self_stresses),
            _ => None,
        };
        if let Some(bars) = predicted.filter(|&bars| bars != closure) {
            return Err(ModesError::ClosureDisagrees { bars, closure });
        }
    }
    // rigid bars leave their zero modes free, and no more
    let free = if terms.bars.is_some_and(f64::is_infinite) { zero_modes } else { columns };
    let (eigenvalues, vectors) = if eigenvalues.min(free) > 0 {
        lowest(&assembly.model(Gauge::Free), eigenvalues, free, observe)?
    } else {
        (vec![], vec![])
    };
    Ok(Modes {
        zero_modes,
        self_stresses,
        rigid_motions,
        folding_modes,
        maxwell_count: columns as i64 - rows as i64,
        gap,
        eigenvalues,
        vectors,
    })
}

fn go_on(observe: &mut Observer<'_>) -> Result<(), ModesError> {
    if observe() { Ok(()) } else { Err(ModesError::Interrupted) }
}

/// Bars and rigid polygons only, all rigid; pins as they are.
fn rigid_part(terms: &Terms) -> Terms {
    let facets = terms.facets.as_ref().filter(|hinges| hinges.stiffness.is_infinite()).cloned();
    Terms { bars: Some(RIGID), facets, pins: terms.pins.clone(), ..Terms::default() }
}

/// Rigid motions of the sheet; where a patch has several pieces with faces, of each of them.
fn rigid_motions(drawn: &Drawn, tiling: &Tiling, bars: &Model) -> usize {
    let of = |coordinates: &[f64], held: &[bool]| {
        gauge::choose(&gauge::rigid_motions(&drawn.domain, coordinates, true), held).len()
    };
    let (pieces, held) = (pieces_of(tiling), bars.held());
    if pieces.len() < 2 || !matches!(drawn.domain, Domain::Patch) {
        return of(&drawn.coordinates, &held);
    }
    let of_piece = |piece: &Vec<usize>| {
        let members: Vec<usize> = piece.iter().flat_map(|vertex| 3 * vertex..3 * vertex + 3).collect();
        let coordinates: Vec<f64> = members.iter().map(|&k| drawn.coordinates[k]).collect();
        of(&coordinates, &members.iter().map(|&k| held[k]).collect::<Vec<_>>())
    };
    pieces.iter().map(of_piece).sum()
}

/// The vertices of the pieces of a tiling.
fn pieces_of(tiling: &Tiling) -> Vec<Vec<usize>> {
    let edges = tiling.edges.iter().map(|edge| edge.ends.map(|end| end.vertex));
    pieces(tiling.positions.len(), edges, tiling.triangles.iter().map(|triangle| triangle.corners[0].vertex))
}

/// Whether a patch of several pieces has openings, about which the closure of its vertices says nothing.
fn pieces_with_openings(tiling: &Tiling) -> bool {
    let pieces = pieces_of(tiling);
    let vertices: usize = pieces.iter().map(Vec::len).sum();
    !tiling.periodic && pieces.len() > 1 && pieces.len() + tiling.edges.len() > vertices + tiling.triangles.len()
}

/// Rank of the Jacobian of a model's stiff measures at the drawn state, and the gap.
fn rank_of(model: &Model, observe: &mut Observer<'_>) -> Result<(usize, Option<f64>), ModesError> {
    let (layout, at) = (model.layout(), linearized(model));
    let rows = at.rows();
    if layout.unknowns.max(layout.stiff.len()) > DENSE_LIMIT {
        return rank_by_counting(&rows, layout.unknowns, &layout.node, observe);
    }
    go_on(observe)?;
    let values = dense::singular_values(&dense::from_rows(&rows, layout.unknowns))?;
    let found = dense::rank_at_largest_gap(&values)?;
    if found.rank == 0 {
        return Ok((0, None));
    }
    let largest = rows.values.iter().fold(0.0f64, |m, v| m.max(v.abs()));
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
    let mut best = (0, 0);
    for start in 0..counts.len() {
        let run = counts[start..].iter().take_while(|count| **count == counts[start]).count();
        if run > best.1 {
            best = (counts[start], run);
        }
    }
    let gap = 10f64.powi(best.1 as i32 - 1);
    if gap >= LEAST_GAP { Ok((best.0, (best.0 > 0).then_some(gap))) } else { Err(ModesError::NoGap { gap }) }
}

fn linearized(model: &Model) -> Linearization {
    let mut at = Linearization::new(model.layout());
    model.linearize(&model.start(), &vec![0.0; model.layout().stiff.len()], HessianKind::Full, &mut at);
    at
}

/// Null space of the closure conditions of the tiling, rigid facets locked.
fn folding_modes(assembly: &Assembly) -> Result<Option<usize>, ModesError> {
    let (tiling, drawn) = (assembly.tiling(), assembly.drawn());
    let corner = |site: Site| Corner { vertex: site.vertex, shift: site.shift };
    let hinged: Vec<HingedEdge> = tiling
        .edges
        .iter()
        .map(|edge| HingedEdge { ends: edge.ends.map(corner), wings: edge.wings.map(|wing| wing.map(corner)) })
        .collect();
    let at =
        |corner: Corner| drawn.domain.point(&drawn.coordinates, Site { vertex: corner.vertex, shift: corner.shift });
    let closure = Closure::of_edges(&hinged, at)?;
    let unchecked = closure.unchecked_loops() > 0 || pieces_with_openings(tiling) || dangling(tiling);
    if unchecked || closure.folding_edges().len() > DENSE_LIMIT {
        return Ok(None);
    }
    let locked: Vec<usize> = tiling.facets().filter(|_| assembly.terms().has_rigid_facets()).collect();
    let angles = assembly.drawn_angles_or_zero();
    let null = dense::null_space(&closure.with_locked(&locked).jacobian(&angles))?;
    Ok(Some(null.basis.ncols()))
}

/// Whether an edge of a patch has no face: then vertices hang on the sheet that no fold angle moves.
fn dangling(tiling: &Tiling) -> bool {
    tiling.edges.iter().any(|edge| edge.wings == [None, None])
}

/// Eigenvalues and eigenvectors.
type Pairs = (Vec<f64>, Vec<Vec<f64>>);

/// Whether the dense way finds this number of eigenpairs of a model, of which at most `free` are finite: else the iteration does.
///
/// # Errors
/// [`ModesError::TooManyEigenvalues`] where neither does.
pub fn decomposed_dense(unknowns: usize, wanted: usize, free: usize) -> Result<bool, ModesError> {
    // the iteration works on 4 wanted + 64 vectors, of which there must be so many; and it cannot find more than there are
    let iterated = wanted <= SPARSE_EIGENVALUES && 4 * wanted + 64 <= unknowns;
    if unknowns <= DENSE_LIMIT {
        Ok(true)
    } else if unknowns <= DENSE_EIGENVALUES {
        Ok(!iterated || wanted >= free)
    } else if iterated {
        Ok(false)
    } else {
        Err(ModesError::TooManyEigenvalues { wanted, unknowns })
    }
}

/// Lowest eigenvalues and eigenvectors of the energy's Hessian on what the rigid terms leave free, which is at most `free`.
fn lowest(model: &Model, wanted: usize, free: usize, observe: &mut Observer<'_>) -> Result<Pairs, ModesError> {
    let dense = decomposed_dense(model.layout().unknowns, wanted.min(free), free)?;
    let way = if dense { lowest_dense } else { lowest_sparse };
    let (values, vectors) = way(model, wanted.min(free), observe)?;
    Ok((values, vectors.iter().map(|v| model.velocity(v)).collect()))
}

fn lowest_dense(model: &Model, count: usize, observe: &mut Observer<'_>) -> Result<Pairs, ModesError> {
    go_on(observe)?;
    let (layout, mut at) = (model.layout(), linearized(model));
    let compliance = model.compliance();
    let mut values = std::mem::take(&mut at.hessian);
    for (row, c) in compliance.iter().enumerate().filter(|(_, c)| **c > 0.0) {
        at.add_outer(row, 1.0 / c, &mut values);
    }
    let hessian = at.pattern().to_dense(&values);
    let full = dense::from_rows(&at.rows(), layout.unknowns);
    let rigid: Vec<usize> = (0..compliance.len()).filter(|&row| compliance[row] == 0.0).collect();
    let free = if rigid.is_empty() {
        DenseMatrix::identity(layout.unknowns, layout.unknowns)
    } else {
        dense::null_space(&full.select_rows(&rigid))?.basis
    };
    go_on(observe)?;
    let found = dense::symmetric_eigen(&(free.transpose() * hessian * &free))?;
    let count = count.min(found.values.len());
    let vectors = (0..count).map(|k| (&free * found.vectors.column(k)).as_slice().to_vec()).collect();
    Ok((found.values[..count].to_vec(), vectors))
}

/// By shift and invert: the largest eigenvalues of `(H + shift)^-1` on the null space of the rigid measures.
fn lowest_sparse(model: &Model, count: usize, observe: &mut Observer<'_>) -> Result<Pairs, ModesError> {
    let layout = model.layout();
    let zero = vec![0.0; layout.stiff.len()];
    let mut tangent = Tangent::at_state(model, &model.start(), &zero, HessianKind::Full)?;
    let unit = tangent.at.pattern().largest_diagonal(&tangent.at.hessian);
    let (mut shift, mut powers) = (0.0, 0..SHIFTS);
    loop {
        // without a shift that makes the Hessian positive, the largest eigenvalues of its inverse are not the lowest of its own
        let power = powers.next().ok_or(FactorError::Singular { ratio: 0.0 })?;
        let next = 1e-7 * unit * 4f64.powi(power);
        go_on(observe)?;
        tangent.at.add_identity(next - shift);
        shift = next;
        if tangent.factor(0.0).is_ok_and(|inertia| inertia.negative == 0) {
            break;
        }
    }
    let mut inverse = |v: &[f64]| tangent.solve(v, &zero, 1e-13).dx;
    let (_, vectors) = eigen::largest(layout.unknowns, count, |v| observe().then(|| inverse(v)))?;
    // once more, since Lanczos vectors are only as good as the largest eigenvalue of the inverse allows
    let vectors: Vec<Vec<f64>> = vectors.iter().map(|v| normalized(inverse(v))).collect();
    tangent.at.add_identity(-shift);
    let quotient = |v: &[f64]| rayleigh_quotient(model, &tangent.at, v);
    let mut pairs: Vec<(f64, Vec<f64>)> = vectors.into_iter().map(|v| (quotient(&v), v)).collect();
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    Ok(pairs.into_iter().unzip())
}

fn normalized(mut v: Vec<f64>) -> Vec<f64> {
    normalize(&mut v);
    v
}

/// `v^T H v / v^T v` with the Hessian of the whole energy: its error is that of the vector squared.
fn rayleigh_quotient(model: &Model, at: &Linearization, v: &[f64]) -> f64 {
    let mut product = vec![0.0; v.len()];
    symmetric_product(at.pattern(), &at.hessian, v, &mut product);
    let mut stretch = vec![0.0; model.compliance().len()];
    at.rows().product(v, &mut stretch);
    let finite = stretch.iter().zip(model.compliance()).filter(|(_, c)| **c > 0.0);
    (dot(v, &product) + finite.map(|(s, c)| s * s / c).sum::<f64>()) / dot(v, v)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sheet::generate;
    use crate::sheet::generate::{Pattern, Random};

    /// Asks for modes of a patch of random cells and stops at the `stop`-th question; the answer, and how many
    /// questions there were.
    fn asked(cells: usize, eigenvalues: usize, stop: usize) -> (Result<Modes, ModesError>, usize) {
        let sheet = generate(&Pattern::Random(Random::default())).unwrap();
        let assembly = Assembly::patch(sheet, [cells; 2]).bars(1e3).creases(1.0).build().unwrap();
        let mut asked = 0;
        let found = modes(&assembly, eigenvalues, &mut || {
            asked += 1;
            asked != stop
        });
        (found, asked)
    }

    /// Claim: modes can be stopped at every question, and nothing is asked, so nothing is begun, after that; on the
    /// dense and on the sparse way, where a question comes before every product: more of them than eigenvalues.
    #[test]
    fn modes_can_be_stopped() {
        for (cells, eigenvalues, least) in [(3, 4, 5), (11, 4, 8 + 1 + 4)] {
            let (found, total) = asked(cells, eigenvalues, usize::MAX);
            assert_eq!(found.unwrap().eigenvalues.len(), eigenvalues);
            assert!(total >= least, "{total} questions");
            for stop in (1..=5).chain([total / 2, total]) {
                let (found, asked) = asked(cells, eigenvalues, stop);
                assert!(matches!(found, Err(ModesError::Interrupted)) && asked == stop, "{stop} of {total}: {asked}");
            }
        }
    }
}
