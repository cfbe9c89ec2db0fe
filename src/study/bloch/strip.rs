//! The strip of a study `bloch`: zero modes of a strip with free edges, their measured decay beside the roots of the
//! determinant, and what is bound to an interface between two cells; numbers of zero modes and self stresses.

use super::summary::StripSummary;
use crate::analysis::bloch::strip::{StripModes, fit};
use crate::analysis::bloch::{BlochError, Decay, Determinant, Rigidity, Root, Strip, ZeroModeCounts};
use crate::numerics::worst;
use crate::output::table::{Table, Value};
use crate::scene::build;
use crate::scene::spec::{BlochSpec, StripSpec};
use crate::sheet::Sheet;
use crate::study::{Context, StudyError};
use nalgebra::Complex;

/// Fewest cells across a strip; with an interface, of each half.
const FEWEST: u32 = 8;
/// Most displacements of a strip: its matrix is decomposed as a dense one.
const MOST_UNKNOWNS: usize = 6000;
/// Windows from which the rate at an interface is measured.
const SHIFTS: usize = 6;

/// Checks the keys of a strip.
pub(super) fn check(context: &Context<'_>, spec: &BlochSpec) -> Result<(), StudyError> {
    let Some(strip) = &spec.strip else { return Ok(()) };
    let wrong = |message: String, help: &str| Err(context.file.error_at(strip.span(), message, help).into());
    let fewest = if strip.other.is_some() { 2 * FEWEST } else { FEWEST };
    if strip.cells.0 < fewest {
        return wrong(format!("a strip of {} cells has no inside", strip.cells.0), "give at least 8, 16 with `other`");
    }
    let unknowns = (3 * context.assembly.sheet().vertices.len()).saturating_mul(strip.cells.0 as usize);
    if unknowns > MOST_UNKNOWNS {
        let message = format!("the strip has {unknowns} coordinates, more than {MOST_UNKNOWNS}");
        return wrong(message, "give fewer cells");
    }
    let Some(above) = other(context, strip)? else { return Ok(()) };
    if spec.start.is_some() {
        return wrong("both cells of an interface are as drawn".into(), "leave out `start` or `other`");
    }
    if let Some(reason) = fit(context.assembly.sheet(), &above) {
        let help = "both need equally many vertices, the same first lattice vector and the same edges between \
                    neighbouring rows of cells, by the numbers of their vertices";
        return wrong(format!("the cells of the interface do not fit: {reason}"), help);
    }
    Ok(())
}

/// Returns the cell of the upper half, if there is another.
fn other(context: &Context<'_>, strip: &StripSpec) -> Result<Option<Sheet>, StudyError> {
    let Some(path) = &strip.other else { return Ok(None) };
    Ok(Some(build::other_sheet(context.file, path)?))
}

/// Decay rates and counts of zero modes of a strip.
pub(super) struct FoundStrip {
    pub rows: Vec<StripRow>,
    /// The determinant of the cell above an interface.
    pub upper: Option<Determinant>,
    pub summary: StripSummary,
}

impl FoundStrip {
    /// Returns `(q1, kappa2)` of each rate that was measured.
    pub(super) fn measured(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.rows.iter().filter_map(|row| Some((row.q1, row.measured?)))
    }
}

/// A rate at a wavenumber.
pub(super) struct StripRow {
    found: [usize; 2],
    q1: f64,
    gap: f64,
    /// Where the mode is bound.
    place: &'static str,
    measured: Option<f64>,
    predicted: f64,
    condition: f64,
}

/// The determinants of the cells below and above, and their strip.
struct Halves {
    strip: Strip,
    cells: usize,
    interface: bool,
    clamped: bool,
    rigidity: [Rigidity; 2],
    /// `None` where there is no determinant: then no rates are predicted.
    determinant: [Option<Determinant>; 2],
}

/// Computes the strip at all wavenumbers; it ends as if interrupted where the other cell cannot be read any more.
pub(super) fn compute(
    context: &Context<'_>,
    spec: &StripSpec,
    (rigidity, rigid): (&Rigidity, bool),
    wavenumbers: &[f64],
) -> Result<FoundStrip, BlochError> {
    let cells = spec.cells.0 as usize;
    let above = other(context, spec).map_err(|_| BlochError::Interrupted)?;
    let upper = above.as_ref().map(|above| Rigidity::of_sheet(above, rigid)).transpose()?;
    let below = determinant_of(rigidity)?;
    let of_upper = upper.as_ref().map(determinant_of).transpose()?;
    let strip = match &above {
        Some(above) => Strip::with_interface([context.assembly.sheet(), above], rigid, cells)?,
        None => Strip::new(rigidity, cells)?,
    };
    let halves = Halves {
        strip: if spec.clamped { strip.clamped() } else { strip },
        cells,
        interface: above.is_some(),
        clamped: spec.clamped,
        rigidity: [rigidity.clone(), upper.unwrap_or_else(|| rigidity.clone())],
        determinant: [below.clone(), of_upper.clone().unwrap_or(below)],
    };
    let upper = of_upper.flatten();
    let mut found = FoundStrip { rows: Vec::new(), upper, summary: StripSummary { cells, ..StripSummary::default() } };
    for (k, q1) in wavenumbers.iter().enumerate() {
        BlochError::unless(context.step(k, Some(wavenumbers.len())))?;
        halves.add(*q1, &mut found)?;
    }
    let summary = &mut found.summary;
    summary.error = worst(found.rows.iter().filter_map(|row| Some((row.measured? - row.predicted).abs())));
    summary.compared = found.rows.iter().filter(|row| row.measured.is_some()).count();
    summary.unmatched = found.rows.len() - summary.compared;
    Ok(found)
}

/// The determinant of a cell; `None` where there is none to speak of.
fn determinant_of(rigidity: &Rigidity) -> Result<Option<Determinant>, BlochError> {
    match Determinant::new(rigidity) {
        Err(error) if error.is_of_determinant() => Ok(None),
        found => found.map(Some),
    }
}

impl Halves {
    fn decay(&self, half: usize, q1: f64) -> Result<Option<Decay>, BlochError> {
        let Some(determinant) = &self.determinant[half] else { return Ok(None) };
        Ok(Some(Decay::new(determinant, 0, q1)?.refined(determinant, &self.rigidity[half])))
    }

    fn add(&self, q1: f64, found: &mut FoundStrip) -> Result<(), BlochError> {
        let modes = self.strip.at(q1)?;
        let [below, above] = [self.decay(0, q1)?, self.decay(1, q1)?];
        let (last, middle) = (self.cells - 1, self.cells / 2);
        if !self.clamped {
            let lower = modes.factors(0, true, 1)?;
            let upper = modes.factors(last, false, 1)?;
            for (place, upwards, decay, factors) in [("lower", true, &below, lower), ("upper", false, &above, upper)] {
                let Some(decay) = decay else { continue };
                found.rows.extend(matched(&modes, place, bound_roots(decay, upwards), factors));
            }
        }
        found.summary.q1.push(q1);
        found.summary.zero_modes.push(modes.zero_modes);
        found.summary.self_stresses.push(modes.self_stresses);
        found.summary.gap.push(modes.gap);
        if self.interface {
            let bound = modes.bound(middle / 2..middle + (self.cells - middle) / 2)?;
            found.summary.interface_zero_modes.push(bound.zero_modes);
            found.summary.interface_self_stresses.push(bound.self_stresses);
            let inside = self.inside(0, q1)?.zip(self.inside(1, q1)?);
            found.summary.interface_predicted.push(inside.map(|(below, above)| above as i64 - below as i64));
            for (decay, upwards) in [(below, false), (above, true)] {
                if let Some(decay) = decay.filter(|_| bound.zero_modes > 0) {
                    found.rows.extend(self.slowest(&modes, &decay, upwards)?);
                }
            }
        }
        Ok(())
    }

    /// Number of roots inside the circle, those at zero too, where every row belongs to the lowest cell it touches;
    /// `None` without a determinant.
    fn inside(&self, half: usize, q1: f64) -> Result<Option<usize>, BlochError> {
        self.determinant[half].as_ref().map(|_| self.rigidity[half].roots_inside(q1)).transpose()
    }

    /// The slowest rate of what is bound to the interface, measured where faster modes are gone.
    fn slowest(&self, modes: &StripModes, decay: &Decay, upwards: bool) -> Result<Option<StripRow>, BlochError> {
        let slow = bound_roots(decay, upwards).min_by(|a, b| a.kappa().abs().total_cmp(&b.kappa().abs()));
        let Some(root) = slow else { return Ok(None) };
        let middle = self.cells / 2;
        let bound = modes.bound_to(middle / 2..middle + (self.cells - middle) / 2)?;
        let first = if upwards { middle + 1 } else { middle - 2 };
        let factors = bound.factors(first, upwards, SHIFTS)?;
        let away = |w: &Complex<f64>| (w / root.z).ln().norm();
        let nearest = factors.into_iter().min_by(|a, b| away(a).total_cmp(&away(b)));
        let place = if upwards { "above-interface" } else { "below-interface" };
        let measured = nearest.filter(|w| away(w) <= NEAR).map(|w| w.norm().ln());
        Ok(Some(StripRow { measured, ..row(modes, place, root) }))
    }
}

/// Factors farther from a root than this in `log z` do not belong to it.
const NEAR: f64 = 0.01;

fn row(modes: &StripModes, place: &'static str, root: &Root) -> StripRow {
    let StripModes { q1, gap, zero_modes, self_stresses, .. } = *modes;
    let (found, predicted, condition) = ([zero_modes, self_stresses], root.kappa(), root.condition);
    StripRow { found, q1, gap, place, measured: None, predicted, condition }
}

/// The roots of modes that decay away from a lower place, or from an upper one.
fn bound_roots(decay: &Decay, upwards: bool) -> impl Iterator<Item = &Root> {
    decay.roots.iter().filter(move |root| !root.on_circle() && (root.kappa() < 0.0) == upwards)
}

/// A row for every root, with the nearest factor that no other root has.
fn matched<'a>(
    modes: &StripModes,
    place: &'static str,
    roots: impl Iterator<Item = &'a Root>,
    mut factors: Vec<Complex<f64>>,
) -> Vec<StripRow> {
    let mut rows = Vec::new();
    for root in roots {
        let away = |w: &Complex<f64>| (w / root.z).ln().norm();
        let nearest = (0..factors.len()).min_by(|&a, &b| away(&factors[a]).total_cmp(&away(&factors[b])));
        let nearest = nearest.filter(|&k| away(&factors[k]) <= NEAR);
        let measured = nearest.map(|k| factors.swap_remove(k).norm().ln());
        rows.push(StripRow { measured, ..row(modes, place, root) });
    }
    rows
}

/// Returns a row for every root at every wavenumber and edge.
pub(super) fn table(found: &FoundStrip) -> Table {
    let table =
        Table::new("q1,zero_modes,self_stresses,gap,edge,kappa2_measured,kappa2_predicted,difference,condition");
    table.with_rows(found.rows.iter().map(|row| {
        let [modes, stresses] = row.found.map(Value::from);
        let difference = row.measured.map(|measured| measured - row.predicted);
        let first = [row.q1.into(), modes, stresses, row.gap.into(), Value::Word(row.place)];
        let rates = [row.measured.into(), row.predicted.into(), difference.into(), row.condition.into()];
        first.into_iter().chain(rates)
    }))
}

/// Returns a row for every wavenumber at which zero modes and self stresses were counted.
pub(super) fn count_table(counts: &[ZeroModeCounts]) -> Table {
    Table::new("q1,q2,zero_modes,self_stresses,self_stresses_opposite,gap").with_rows(counts.iter().map(|found| {
        let numbers = [found.zero_modes, found.self_stresses, found.self_stresses_opposite];
        let q = found.q.into_iter().map(Value::from);
        q.chain(numbers.map(Value::from)).chain([found.gap.into()])
    }))
}
