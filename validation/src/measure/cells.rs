//! A hundred thousand cells: a pleated Yoshimura pattern that is folded further, compared with its closed form.
//!
//! The cell has two vertices, the fewest of a cell that is not flat; Miura-ori, with four, takes several times as long.

use super::super::findings::{ExperimentError, Findings, ReportTable};
use super::super::report::figure;
use super::super::star::size;
use super::trial::distance;
use foldwell::analysis::relax::{Relaxed, relax_from};
use foldwell::model::{Assembly, Gauge, Model, RIGID, Terms};
use foldwell::numerics::larger;
use foldwell::sheet::generate::Yoshimura;
use foldwell::sheet::{EdgeKind, Pattern, Sheet, TiledEdge, generate};
use foldwell::solver::Options;
use serde_json::json;
use std::time::Instant;

/// Sizes; the last one has 100,172 cells.
const CELLS: [[usize; 2]; 4] = [[10, 10], [32, 32], [100, 100], [316, 317]];
/// Slopes of the rows in radians, in the drawn state and in the state of rest.
const DRAWN: f64 = 0.5;
const RESTING: f64 = 0.55;
/// Tolerance, relative to the force of a milliradian. In coordinates of up to 632 the last digit, 1e-13, gives 1e-10 of
/// it.
const TOLERANCE: f64 = 1e-9;

/// A patch with rigid bars whose rest angles are those of steeper pleats.
struct Pleats {
    model: Model,
    /// Rest angle of every edge, in radians; NaN for edges without a hinge.
    rest: Vec<f64>,
}

/// A patch that was relaxed.
struct Size {
    cells: [usize; 2],
    unknowns: usize,
    found: Relaxed,
    /// Largest difference of a fold angle from the closed form, in radians.
    error: f64,
    seconds: f64,
}

/// Relaxes patches whose rest angles are those of steeper pleats. These can be reached without a change of the length
/// of any bar, so that the patches must end there with zero energy.
pub fn measure(_quick: bool) -> Result<Findings, ExperimentError> {
    let mut sizes = Vec::new();
    for cells in CELLS {
        sizes.push(relaxed(cells)?);
    }
    let last = &sizes[sizes.len() - 1];
    let values = json!({
        "errors": sizes.iter().map(|size| size.error).collect::<Vec<_>>(),
        "residuals": sizes.iter().map(residual).collect::<Vec<_>>(),
        "iterations": sizes.iter().map(|size| size.found.iterations).collect::<Vec<_>>(),
        "seconds": last.seconds,
    });
    Ok(Findings { values, tables: vec![table(&sizes)], ..Findings::default() })
}

fn relaxed(cells: [usize; 2]) -> Result<Size, ExperimentError> {
    let pleats = Pleats::new(cells)?;
    let (start, clock) = (pleats.model.start(), Instant::now());
    let options = Options { tolerance: TOLERANCE, ..Options::default() };
    let found = relax_from(&pleats.model, start, options, &mut |_| true)?;
    let seconds = clock.elapsed().as_secs_f64();
    let error = distance(&found.state.fold_angle, &pleats.rest);
    Ok(Size { cells, unknowns: size(&pleats.model).0, found, error, seconds })
}

fn residual(size: &Size) -> f64 {
    larger(size.found.residual_force, size.found.residual_length)
}

impl Pleats {
    fn new(cells: [usize; 2]) -> Result<Self, ExperimentError> {
        let pattern = Pattern::Yoshimura(Yoshimura { fold: DRAWN, ..Yoshimura::default() });
        let sheet = generate(&pattern).map_err(|_| ExperimentError::Other("the pattern cannot be generated".into()))?;
        let angles = closed_form(&sheet, RESTING);
        let drawn = Assembly::patch(sheet, cells).build()?;
        let angle = |edge: &TiledEdge| if edge.kind == EdgeKind::Crease { angles[edge.edge] } else { f64::NAN };
        let rest: Vec<f64> = drawn.tiling().edges.iter().map(angle).collect();
        let terms = Terms::bars_and_creases(RIGID, 1.0, rest.clone());
        Ok(Self { model: drawn.with_terms(terms).model(Gauge::Held), rest })
    }
}

/// Returns the fold angles of a cell whose rows have this slope: twice the slope for the bases of the triangles (edges
/// from a vertex to its own copy), with the signs of the drawn state; zero for the legs.
fn closed_form(sheet: &Sheet, slope: f64) -> Vec<f64> {
    let drawn = |edge| sheet.drawn_angle(edge).map_or(f64::NAN, f64::signum);
    let angle = |edge| 2.0 * slope * drawn(edge);
    sheet.edges.iter().map(|edge| if edge.key.i == edge.key.j { angle(edge) } else { 0.0 }).collect()
}

fn table(sizes: &[Size]) -> ReportTable {
    let row = |s: &Size| {
        let counts = [s.unknowns, s.found.iterations, s.found.factorizations].map(|count| count.to_string());
        let numbers = [residual(s), s.error, s.seconds].map(figure);
        [format!("{} x {}", s.cells[0], s.cells[1])].into_iter().chain(counts).chain(numbers).collect()
    };
    let names =
        ["cells", "unknowns", "iterations", "factorizations", "residual", "off the closed form (rad)", "seconds"];
    ReportTable {
        title: "Pleated Yoshimura patterns with rigid bars, their rows folded from a slope of 0.5 to 0.55".into(),
        header: names.map(str::to_owned).to_vec(),
        rows: sizes.iter().map(row).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: at any slope, the closed form gives the angles of the generated coordinates, to rounding errors; and a
    /// small patch ends there.
    #[test]
    fn pleats_rest_where_steeper_ones_are_drawn() {
        for fold in [0.05, 0.5, 1.5] {
            let sheet = generate(&Pattern::Yoshimura(Yoshimura { fold, ..Yoshimura::default() })).unwrap();
            let drawn: Vec<f64> = sheet.edges.iter().map(|edge| sheet.drawn_angle(edge).unwrap()).collect();
            assert!(drawn.len() == 6 && distance(&drawn, &closed_form(&sheet, fold)) <= 1e-14, "{fold}: {drawn:?}");
        }
        let found = relaxed([3, 3]).unwrap();
        assert!(found.error <= 1e-12 && found.found.iterations > 1, "{}", found.error);
    }
}
