//! Modes of a state, the drawn one or another: motions and stresses of its bars, linear foldings, and the spectrum of
//! its energy.
//!
//! The rank of the rigidity matrix is found by singular values (dense, small sheets) or by counting them against
//! thresholds (sparse, large sheets), and is believed only when a second way agrees: the count of eigenvalues of one
//! sign of a factorization, and, where the topology allows it, the null space of the closure conditions in fold angles,
//! which share no equation with the bars.

mod buckling;
mod error;
mod rank;
mod seam;
mod spectrum;
mod vibrations;

use super::restored::{self, Forces};
use crate::kinematics::closure::Closure;
use crate::model::{Assembly, Bars, Configuration, Domain, Drawn, Gauge, Model, Stiffness, Terms, gauge};
use crate::sheet::{Tiling, pieces};
use crate::solver::{Problem, Start};
pub use buckling::{Buckling, buckling};
pub use error::{ModesError, SPARSE_EIGENVALUES};
use rank::{rank_of, rigid_part};
pub use seam::SeamMotions;
use seam::seam_motions;
pub use spectrum::{DENSE_LIMIT, Observer, decomposed_dense};
use spectrum::{Spectrum, go_on, lowest};
pub use vibrations::Vibrations;
pub(crate) use vibrations::check_masses;

/// Modes of a state.
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
    /// Smallest kept over largest dropped singular value; a lower bound by a factor of ten for large sheets. `None`
    /// where none is kept: the rank is 0.
    pub gap: Option<f64>,
    /// Lowest eigenvalues of the energy's Hessian on what rigid terms leave free, ascending. The unknowns of a rigid part
    /// are the displacement of its centroid, and the components of its rotation vector times the mean edge.
    pub eigenvalues: Vec<f64>,
    /// The eigenvectors, as velocities of all coordinates, one for each eigenvalue.
    pub vectors: Vec<Vec<f64>>,
    /// Small vibrations, as many as eigenvalues; `None` where the sheet has no mass or no eigenvalues are wanted.
    pub vibrations: Option<Vibrations>,
    /// Motions of the bars that each set of closing conditions leaves free, on a tube.
    pub seam: Option<SeamMotions>,
}

/// Finds the modes of the drawn state; see [`modes_at`].
///
/// # Errors
/// As [`modes_at`].
pub fn modes(assembly: &Assembly, eigenvalues: usize, observe: &mut Observer<'_>) -> Result<Modes, ModesError> {
    let assembly = assembly.with_axis(0.0);
    modes_at(&assembly, &restored::drawn(&assembly), eigenvalues, observe)
}

/// Finds the modes of a state of an assembly. `observe` is asked before every decomposition and factorization, and
/// before every product of the iteration for eigenpairs; between them, at most for the time of one decomposition,
/// nothing stops the work.
///
/// # Errors
/// [`ModesError`] where a factorization fails, ranks by two ways disagree, a coordinate has no mass although the sheet
/// has, or `observe` returned false.
pub fn modes_at(
    assembly: &Assembly,
    state: &Configuration,
    eigenvalues: usize,
    observe: &mut Observer<'_>,
) -> Result<Modes, ModesError> {
    let (tiling, terms) = (assembly.tiling(), assembly.terms());
    let place = Drawn { coordinates: state.coordinates.clone(), ..assembly.drawn().clone() };
    let mut bars = assembly.with_terms(rigid_part(terms)).model(Gauge::Free);
    bars.start_from(state.coordinates.clone());
    let (rank, gap) = rank_of(&bars, observe)?;
    let (columns, rows) = (bars.layout().unknowns, bars.layout().stiff.len());
    let rigid_motions = rigid_motions(&place, tiling, &bars);
    let (zero_modes, self_stresses) = (columns - rank, rows - rank);
    go_on(observe)?;
    let folding_modes = folding_modes(assembly, &place)?;
    if let Some(closure) = folding_modes {
        agree(assembly, closure, [zero_modes.saturating_sub(rigid_motions), self_stresses])?;
    }
    // rigid bars leave their zero modes free, and no more
    // rigid bars alone, where others are springs
    let free = match terms.bar_stiffness().and_then(Stiffness::rigid_part).map(Bars::from) {
        None => columns,
        Some(Bars { stiffness: Stiffness::Uniform(_), .. }) => zero_modes,
        Some(some) => {
            let some = Terms { bars: Some(some), ..rigid_part(terms) };
            columns - rank_of(&assembly.with_terms(some).model(Gauge::Free), observe)?.0
        }
    };
    let (mut spectrum, mut vibrations) = (Spectrum::default(), None);
    if eigenvalues > 0 {
        let mut model = assembly.model(Gauge::Free);
        let Start { x, tension } = model.enter(state);
        let tension = tension.unwrap_or_else(|| restored::tensions(&model, &x, &Forces::Unknown));
        let (at, wanted) = ((&model, &tension[..]), (eigenvalues, free));
        vibrations = Vibrations::lowest(assembly, at, wanted, observe)?;
        if free > 0 {
            spectrum = lowest(at, (&model.units_of_length(), &[]), wanted, observe)?;
        }
    }
    let seam = seam_motions(assembly, &state.coordinates, observe)?;
    Ok(Modes {
        zero_modes,
        self_stresses,
        rigid_motions,
        folding_modes,
        maxwell_count: columns as i64 - rows as i64,
        gap,
        eigenvalues: spectrum.values,
        vectors: spectrum.vectors,
        vibrations,
        seam,
    })
}

/// Checks that the number of motions or of stresses of the bars is the one that closure predicts.
fn agree(assembly: &Assembly, closure: usize, [motions, stresses]: [usize; 2]) -> Result<(), ModesError> {
    let terms = assembly.terms();
    let predicted = match assembly.domain() {
        Domain::Patch if terms.pins.is_empty() => Some(motions),
        Domain::FixedTorus(_) if terms.pins.is_empty() && !terms.has_rigid_facets() => Some(stresses),
        _ => None,
    };
    match predicted {
        Some(bars) if bars != closure => Err(ModesError::ClosureDisagrees { bars, closure }),
        _ => Ok(()),
    }
}

/// Rigid motions of the sheet, of a patch of each of its pieces with faces, or of those that parts join.
fn rigid_motions(drawn: &Drawn, tiling: &Tiling, bars: &Model) -> usize {
    if bars.has_parts() {
        return bars.rigid_motion_counts()[1];
    }
    let of = |coordinates: &[f64], held: &[bool]| {
        gauge::choose(&gauge::rigid_motions(&drawn.domain, coordinates, true), held).len()
    };
    let (pieces, held) = (pieces_of(tiling), bars.held());
    if pieces.is_empty() || !matches!(drawn.domain, Domain::Patch) {
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

/// Null space of the closure conditions of the tiling in this state, rigid facets locked.
fn folding_modes(assembly: &Assembly, state: &Drawn) -> Result<Option<usize>, ModesError> {
    let tiling = assembly.tiling();
    if !assembly.sheet().is_surface() || !assembly.terms().parts.is_empty() {
        return Ok(None);
    }
    let closure = Closure::of_edges(&tiling.edges, |site| state.domain.point(&state.coordinates, site))?;
    let tube = matches!(assembly.domain(), Domain::Tube { .. } | Domain::Own(_));
    let unchecked = tube || closure.unchecked_loops > 0 || pieces_with_openings(tiling) || tiling.has_bars_alone();
    if unchecked || closure.folding_edges().len() > DENSE_LIMIT {
        return Ok(None);
    }
    let locked = assembly.rigid_facet_edges();
    let angles = assembly.fold_angles_at(&state.coordinates);
    let angles: Vec<f64> = angles.iter().map(|angle| if angle.is_nan() { 0.0 } else { *angle }).collect();
    let null = closure.with_locked(&locked).motions(&angles)?;
    Ok(Some(null.basis.ncols()))
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
