//! The bands of a study `bloch`: eigenvalues of the energy against waves along a path, and with a mass their
//! frequencies and the density of states.

use crate::analysis::bloch::bands::{DynamicalMatrix, Stiffnesses, along_path};
use crate::analysis::bloch::laurent::wavenumber;
use crate::analysis::bloch::{BlochError, Density};
use crate::model::{Assembly, Gauge, Hinges};
use crate::output::figure::bands::{self as figure, BandPlot};
use crate::output::table::{Table, Value};
use crate::scene::forms::StartSpec;
use crate::scene::spec::{BlochSpec, DensitySpec, Draw};
use crate::scene::stiffness::StiffnessSpec;
use crate::scene::{Located, SceneFile};
use crate::sheet::EdgeKind;
use crate::study::{Answer, Context, StudyError, supported};

/// Number of wavenumbers from each corner of a path to the next.
const STEPS: usize = 50;
/// Numbers of wavenumbers of the density of states along the two directions, and number of its bins, unless the scene
/// gives others.
const GRID: [usize; 2] = [64, 64];
const BINS: usize = 100;

/// Bands along the path of a study, and the density of states over the Brillouin zone.
pub(super) struct FoundBands {
    path: Vec<Bands>,
    density: Option<Density>,
}

/// The bands at a wavenumber of the path.
struct Bands {
    q: [f64; 2],
    values: Vec<f64>,
    /// Empty without mass.
    frequencies: Vec<f64>,
}

/// Checks that bands have an energy of springs in the drawn state, and a density of states masses.
pub(super) fn check(context: &Context<'_>, spec: &BlochSpec) -> Result<(), StudyError> {
    let (file, assembly) = (context.file, context.assembly);
    let path = spec.path.as_ref().map(|path| ("path", path.span()));
    let Some((key, span)) = path.or(spec.density.as_ref().map(|density| ("density", density.span()))) else {
        return Ok(());
    };
    let in_state = matches!(spec.start.as_deref(), Some(StartSpec::Study(_)));
    if !in_state {
        supported::one_stiffness_each(context, "bands")?;
        supported::drawn_lengths(context, "bands")?;
        supported::springs_at_rest(context, "bands of the drawn state")?;
    }
    let springs = if in_state { all_springs(assembly) } else { stiffnesses(file, assembly).is_some() };
    let help = format!("give bars a finite stiffness and facets too, or leave out `{key}`");
    file.error_if(!springs, span, "bands need an energy of springs", help)?;
    let Some(mass) = &file.scene.mass else {
        let Some(density) = &spec.density else { return Ok(()) };
        let help = "give the sheet a mass, mass = { vertex = 1.0 } above [sheet], or leave out `density`";
        return Err(file.error_at(density.span(), "a density of states is one of frequencies", help).into());
    };
    let massless = masses(assembly).and_then(|masses| masses.iter().position(|mass| *mass <= 0.0));
    let Some(vertex) = massless else { return Ok(()) };
    let message = format!("vertex {vertex} of the cell belongs to no face: a mass per area gives it none");
    Err(file.error_at(mass.span(), message, "give every vertex a mass, mass = { vertex = 1.0 }").into())
}

/// Returns the mass of every vertex of the cell; `None` without mass.
fn masses(assembly: &Assembly) -> Option<Vec<f64>> {
    Some(assembly.terms().mass?.of_cell(assembly.sheet()))
}

/// Returns the stiffness of the diagonals of polygons; infinite, that is rigid, unless the scene gives one, and `None`
/// if they differ. One number is read from the scene since the model of a patch lacks the diagonals that are cut by its
/// rim.
pub(super) fn facet_stiffness(file: &SceneFile, assembly: &Assembly) -> Option<f64> {
    let given = file.scene.energy.hinges()[1].and_then(|facets| facets.stiffness.as_deref());
    match given {
        Some(StiffnessSpec::Number(stiffness)) => Some(*stiffness),
        None if file.scene.material.is_none() => Some(f64::INFINITY),
        _ => assembly.terms().facets.as_ref()?.stiffness.uniform(),
    }
}

/// Returns the stiffnesses of the energy; `None` if it has no bars or a term is rigid.
fn stiffnesses(file: &SceneFile, assembly: &Assembly) -> Option<Stiffnesses> {
    let terms = assembly.terms();
    let creases = terms.creases.as_ref().map_or(Some(0.0), |creases| creases.stiffness.uniform())?;
    let has_facets = assembly.sheet().edges.iter().any(|edge| edge.kind == EdgeKind::Facet);
    let facets = if has_facets { facet_stiffness(file, assembly)? } else { 0.0 };
    let found = Stiffnesses { bars: terms.bar_stiffness()?.uniform()?, creases, facets };
    [found.bars, found.creases, found.facets].iter().all(|k| k.is_finite()).then_some(found)
}

/// Whether bars, creases and facets are springs, none of them rigid, and nothing is locked.
fn all_springs(assembly: &Assembly) -> bool {
    let terms = assembly.terms();
    let has_facets = assembly.sheet().edges.iter().any(|edge| edge.kind == EdgeKind::Facet);
    let soft = |hinges: &Option<Hinges>| hinges.as_ref().is_none_or(|hinges| !hinges.stiffness.has_rigid());
    let bars = terms.bars.is_some() && !terms.has_rigid_bars();
    bars && soft(&terms.creases)
        && soft(&terms.facets)
        && !(has_facets && terms.facets.is_none())
        && terms.locks.is_empty()
}

/// Returns the dynamical matrix of the drawn state, or of the one that the study starts from; `None` without springs.
fn matrix(context: &Context<'_>, spec: &BlochSpec) -> Result<Option<DynamicalMatrix>, BlochError> {
    let assembly = context.assembly;
    if let Some(StartSpec::Study(name)) = spec.start.as_deref() {
        let mut model = assembly.model(Gauge::Free);
        let Some(saved) = context.earlier.states.get(name).filter(|_| all_springs(assembly)) else { return Ok(None) };
        model.enter(saved);
        return DynamicalMatrix::of_state(&model, &saved.coordinates).map(Some);
    }
    let Some(stiffnesses) = stiffnesses(context.file, assembly) else { return Ok(None) };
    DynamicalMatrix::new(assembly.sheet(), stiffnesses).map(Some)
}

/// Computes the bands along the path of the scene and the density of states.
pub(super) fn compute(context: &Context<'_>, spec: &BlochSpec) -> Result<FoundBands, BlochError> {
    let mut found = FoundBands { path: vec![], density: None };
    if spec.path.is_none() && spec.density.is_none() {
        return Ok(found);
    }
    let Some(matrix) = matrix(context, spec)? else { return Ok(found) };
    let heavy = masses(context.assembly).map(|masses| matrix.clone().with_masses(&masses));
    let corners: Vec<[f64; 2]> = spec.path.iter().flat_map(|path| path.iter()).map(|corner| corner.0).collect();
    for q in along_path(&corners, STEPS) {
        let frequencies = heavy.as_ref().map_or(Ok(vec![]), |heavy| heavy.frequencies(q))?;
        found.path.push(Bands { q, values: matrix.bands(q)?, frequencies });
    }
    if let (Some(density), Some(heavy)) = (&spec.density, &heavy) {
        let (grid, bins) = (grid(density), density.bins.as_ref().map_or(BINS, |bins| bins.0 as usize));
        let total = grid[0] * grid[1];
        let all = heavy.on_grid(grid, |step| context.step(step, Some(total)))?;
        stable(&all, grid)?;
        found.density = Some(Density::new(&all, grid, bins));
    }
    Ok(found)
}

/// Checks that no wave grows: a density of states counts frequencies.
fn stable(all: &[Vec<f64>], [n1, n2]: [usize; 2]) -> Result<(), BlochError> {
    let lowest = all.iter().map(|frequencies| frequencies.first().copied().unwrap_or(0.0));
    let lowest = lowest.enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
    let Some((number, rate)) = lowest.filter(|(_, rate)| *rate < 0.0) else { return Ok(()) };
    let q = [wavenumber(number % n1, n1), wavenumber(number / n1, n2)];
    Err(BlochError::Unstable { rate: -rate, q })
}

fn grid(density: &Located<DensitySpec>) -> [usize; 2] {
    density.grid.as_ref().map_or(GRID, |grid| grid.0)
}

/// Adds the tables of the bands and of the density of states, and their picture if the study asks for it.
pub(super) fn add(answer: &mut Answer, context: &Context<'_>, start: Option<&StartSpec>, found: &FoundBands) {
    let name = context.name();
    if !found.path.is_empty() {
        answer.add(format!("{name}_bands.csv"), band_table(&found.path));
    }
    if let Some(density) = &found.density {
        answer.add(format!("{name}-density.csv"), density_table(density));
    }
    let with_frequencies = found.density.is_some() || found.path.iter().any(|at| !at.frequencies.is_empty());
    if with_frequencies && context.draws(Draw::Svg) {
        let path = lengths(&found.path).into_iter().zip(&found.path);
        let plot = BandPlot {
            bands: path.clone().map(|(length, at)| (length, at.frequencies.clone())).collect(),
            corners: path.step_by(STEPS).map(|(length, at)| (length, at.q)).collect(),
            density: found.density.as_ref().map(|density| (density.edges.clone(), density.values.clone())),
        };
        let state = match start {
            Some(StartSpec::Study(name)) => format!("the state of {name}"),
            _ => "the drawn state".to_owned(),
        };
        let caption = context.caption(format!("frequencies of waves in {state}"));
        answer.add(format!("{name}-bands.svg"), figure::svg(&plot, &caption));
    }
}

/// Returns the length of the path up to each wavenumber.
fn lengths(path: &[Bands]) -> Vec<f64> {
    let mut length = 0.0;
    (0..path.len())
        .map(|k| {
            let [before, here] = [path[k.saturating_sub(1)].q, path[k].q];
            length += (here[0] - before[0]).hypot(here[1] - before[1]);
            length
        })
        .collect()
}

/// Returns a row for every wavenumber of the path: the length of the path up to it, the wavenumber, the bands, and with
/// a mass the frequencies.
fn band_table(path: &[Bands]) -> Table {
    let count = |of: fn(&Bands) -> &Vec<f64>| path.iter().map(|at| of(at).len()).max().unwrap_or(0);
    let bands = (0..count(|at| &at.values)).map(|k| format!("band_{k}"));
    let frequencies = (0..count(|at| &at.frequencies)).map(|k| format!("frequency_{k}"));
    let rows = lengths(path).into_iter().zip(path).map(|(length, Bands { q, values, frequencies })| {
        [length, q[0], q[1]].into_iter().chain(values.iter().chain(frequencies).copied()).map(Value::Number)
    });
    Table::new("length,q1,q2").with(bands).with(frequencies).with_rows(rows)
}

/// Returns a row for every bin: its lower and its upper edge, the density in it, and the number of states up to the
/// upper edge.
fn density_table(density: &Density) -> Table {
    let mut states = 0.0;
    let rows = density.edges.windows(2).zip(&density.values).map(|(ends, value)| {
        states += value * (ends[1] - ends[0]);
        [ends[0], ends[1], *value, states].map(Value::Number)
    });
    Table::new("frequency_low,frequency_high,density,states_below").with_rows(rows)
}
