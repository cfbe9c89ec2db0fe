//! `kind = "bloch"`: spatially varying modes of the drawn state, or of a state that an earlier study found.

mod bands;
mod strip;
mod summary;

use self::bands::{FoundBands, facet_stiffness};
use self::strip::FoundStrip;
use super::{Answer, Context, NoAnswer, StudyError, StudyResult, start, states};
use crate::analysis::bloch::laurent::wavenumber;
use crate::analysis::bloch::rigidity::cell_rotation;
use crate::analysis::bloch::zero_lines::ZeroLine;
use crate::analysis::bloch::{
    self, BlochError, Decay, Determinant, ModeShape, Rigidity, Survey, SurveyOptions, ZeroModeCounts, Zone,
};
use crate::analysis::state::cylinder;
use crate::math::Vec3;
use crate::model::{Assembly, Configuration, Domain, Drawn};
use crate::numerics::worst;
use crate::output::Picture;
use crate::output::artifact::Artifact;
use crate::output::figure::bloch::{self as figure, BlochPlot};
use crate::output::figure::rounded;
use crate::output::net::{Grid, Net};
use crate::output::table::{Table, Value};
use crate::scene::forms::StartSpec;
use crate::scene::spec::{BlochSpec, Draw, StripSpec};
use crate::scene::{Located, SceneFile};
use std::f64::consts::TAU;
pub use summary::{BlochSummary, DecaySummary, StripSummary};

/// Numbers of wavenumbers along the two directions, unless the scene gives others.
const GRID: [usize; 2] = [256, 256];
/// Number of wavenumbers at which decay rates are computed, unless the scene gives a list.
const DECAYS: usize = 32;
/// Number of wavenumbers over which the polarization is averaged.
const AVERAGED: usize = 64;
/// Number of wavenumbers at which the picture shows decay rates.
const DRAWN: usize = 240;

/// Checks that the sheet has a lattice, and as many constraints as coordinates unless bands alone are asked for.
pub(crate) fn check(context: &Context<'_>, spec: &BlochSpec) -> Result<(), StudyError> {
    let (file, assembly) = (context.file, context.assembly);
    spec.start.as_ref().map_or(Ok(()), |start| check_start(context, start))?;
    let stiffness = context.assembly.terms().facets.as_ref().map(|facets| &facets.stiffness);
    if stiffness.is_some_and(|stiffness| stiffness.has_rigid() && !stiffness.is_rigid()) {
        let message = "spatially varying modes are those of polygons that are all rigid or all soft";
        return Err(context.refuse(message, "give all facets a finite stiffness, or leave them out").into());
    }
    bands::check(context, spec)?;
    strip::check(context, spec)?;
    let square = rigidity(file, assembly).and_then(|rigidity| rigidity.require_square());
    let Err(error) = square else { return Ok(()) };
    let has_bands = spec.path.is_some() || spec.density.is_some();
    let asks_for_more = spec.strip.is_some() || spec.zero_modes_at.is_some() || spec.modes.is_some();
    let help = match error {
        BlochError::NoLattice => "a periodic sheet has the key `foldwell:lattice` in its mesh",
        _ if has_bands && !asks_for_more => return Ok(()),
        _ if assembly.sheet().is_surface() => {
            "give facets a stiffness, so that polygons bend: bars alone make as many conditions as coordinates"
        }
        _ => "of assemblies with other numbers of bars ask for bands alone: give `path` or `density`",
    };
    Err(context.refuse(error.to_string(), help).into())
}

/// Checks that the start is the drawn state, or a state of one cell that an earlier study found.
fn check_start(context: &Context<'_>, start: &Located<StartSpec>) -> Result<(), StudyError> {
    let wrong = |message: &str, help: &str| Err(context.file.error_at(start.span(), message, help).into());
    let assembly = context.assembly;
    match &**start {
        StartSpec::Drawn => Ok(()),
        StartSpec::Study(_)
            if matches!(assembly.drawn().domain, Domain::Patch) || assembly.tiling().cells != [1, 1] =>
        {
            let help = "give domain = \"screw\", or \"torus\" with cells = [1, 1]";
            wrong("spatially varying modes are those of a state of one cell", help)
        }
        StartSpec::Study(_) => Ok(()),
        StartSpec::Random(_) | StartSpec::File(_) => {
            wrong("spatially varying modes need a state that an earlier study found", "give the name of that study")
        }
    }
}

/// The state whose modes are computed.
struct Ground {
    /// The bars, and the locks of rigid polygons.
    rigidity: Rigidity,
    /// All coordinates of the state of an earlier study; `None` for the drawn state.
    folded: Option<Vec<f64>>,
}

/// Returns the state that the scene names, unless the study that should have found it did not.
fn ground(context: &Context<'_>, spec: &BlochSpec) -> Result<Ground, NoAnswer> {
    let assembly = context.assembly;
    let Some(StartSpec::Study(name)) = spec.start.as_deref() else {
        let rigidity = rigidity(context.file, assembly).map_err(NoAnswer::because)?;
        return Ok(Ground { rigidity, folded: None });
    };
    let (sheet, drawn) = (assembly.sheet(), assembly.drawn());
    let fits = |saved: &&Configuration| saved.coordinates.len() == drawn.coordinates.len();
    let saved = context.earlier.states.get(name).filter(fits).ok_or_else(start::unavailable)?;
    let rigid = facets_are_rigid(context.file, assembly);
    let rigidity = Rigidity::of_state(sheet, rigid, &drawn.domain, &saved.coordinates).map_err(NoAnswer::because)?;
    Ok(Ground { rigidity, folded: Some(saved.coordinates.clone()) })
}

/// Whether polygons are rigid. Polygons that are rigid in part only are refused by [`check`].
fn facets_are_rigid(file: &SceneFile, assembly: &Assembly) -> bool {
    facet_stiffness(file, assembly).is_some_and(f64::is_infinite)
}

/// Returns the bars of the drawn state, and the locks of rigid polygons.
fn rigidity(file: &SceneFile, assembly: &Assembly) -> Result<Rigidity, BlochError> {
    Rigidity::of_sheet(assembly.sheet(), facets_are_rigid(file, assembly))
}

/// The results of the analysis.
struct FoundModes {
    ground: Ground,
    /// The results that are read off the determinant, or the reason for which there is no determinant.
    survey: Result<Survey, BlochError>,
    grid: [usize; 2],
    bands: FoundBands,
    strip: Option<FoundStrip>,
    counts: Vec<ZeroModeCounts>,
}

/// Computes the modes of the state that the scene names.
pub(crate) fn compute(context: &Context<'_>, spec: &BlochSpec) -> Result<Answer, NoAnswer> {
    let found = find(context, spec, ground(context, spec)?).map_err(NoAnswer::because)?;
    let (name, mut answer) = (context.name(), Answer::empty(context.study));
    let survey = found.survey.as_ref().ok();
    answer.add(format!("{name}.csv"), table(survey.map_or(&[], |survey| &survey.decays)));
    bands::add(&mut answer, context, spec.start.as_deref(), &found.bands);
    if !found.counts.is_empty() {
        answer.add(format!("{name}-modes.csv"), strip::count_table(&found.counts));
    }
    if let Some(found) = &found.strip {
        answer.add(format!("{name}-strip.csv"), strip::table(found));
    }
    if let Some(survey) = survey {
        add_maps(&mut answer, context, (&found, survey));
        add_figure(&mut answer, context, (&found, survey));
    }
    let theta = theta(context.assembly, &found.ground);
    let result = BlochSummary {
        no_determinant: found.survey.as_ref().err().map(ToString::to_string),
        theta,
        strip: found.strip.as_ref().map(|strip| strip.summary.clone()),
        ..survey.map_or_else(BlochSummary::default, |survey| summary(survey, found.grid, theta))
    };
    answer.conclude(StudyResult::Bloch(Box::new(result)), survey.map(|survey| survey.determinant.error), None);
    Ok(answer)
}

/// Computes the survey and the bands, unless the observer asks to stop.
fn find(context: &Context<'_>, spec: &BlochSpec, ground: Ground) -> Result<FoundModes, BlochError> {
    let options = SurveyOptions {
        wavenumbers: wavenumbers(spec),
        averaged: AVERAGED,
        grid: spec.grid.as_ref().map_or(GRID, |grid| grid.0),
        modes: spec.modes.iter().flat_map(|modes| modes.iter()).map(|pair| pair.0).collect(),
    };
    let mut go_on = |step: usize| context.step(step, Some(bloch::STEPS));
    let survey = match bloch::survey(&ground.rigidity, &options, &mut go_on) {
        // counts and bands need no determinant
        Err(error) if error.is_of_determinant() => Err(error),
        found => Ok(found?),
    };
    let wanted = spec.zero_modes_at.iter().flat_map(|list| list.iter());
    let counts = wanted.map(|pair| ZeroModeCounts::at(&ground.rigidity, pair.0)).collect::<Result<_, _>>()?;
    let strip = |strip: &Located<StripSpec>| {
        let rigid = facets_are_rigid(context.file, context.assembly);
        strip::compute(context, strip, (&ground.rigidity, rigid), &options.wavenumbers)
    };
    let strip = spec.strip.as_ref().map(strip).transpose()?;
    let bands = bands::compute(context, spec)?;
    Ok(FoundModes { ground, survey, grid: options.grid, bands, strip, counts })
}

fn wavenumbers(spec: &BlochSpec) -> Vec<f64> {
    match &spec.q1 {
        Some(list) => list.iter().map(|q1| q1.0).collect(),
        None => (0..DECAYS).map(|k| wavenumber(k, DECAYS)).collect(),
    }
}

/// Returns a row for every root at every wavenumber.
fn table(decays: &[Decay]) -> Table {
    let all = decays.iter().flat_map(|decay| decay.roots.iter().enumerate().map(|(k, root)| (decay.q, k, root)));
    Table::new("q1,root,kappa2,q2,condition,on_circle,multiplicity").with_rows(all.map(|(q, k, root)| {
        let numbers = [root.kappa(), root.wavenumber(), root.condition].map(Value::Number);
        let last = [i64::from(root.on_circle()).into(), root.multiplicity.into()];
        [q.into(), k.into()].into_iter().chain(numbers).chain(last)
    }))
}

/// Adds the map of the determinant, the lines of zero modes and the displacements of modes, if the study asks for them.
fn add_maps(answer: &mut Answer, context: &Context<'_>, (found, survey): (&FoundModes, &Survey)) {
    if !context.draws(Draw::Vtk) {
        return;
    }
    let (name, mut files) = (context.name(), Vec::new());
    let mut add = |file: String, artifact: Artifact| {
        files.push((files.len() as f64, file.clone()));
        answer.add(file, artifact);
    };
    let [real, imaginary] = survey.map.clone();
    let map = Grid {
        size: found.grid,
        origin: found.grid.map(|n| wavenumber(0, n)),
        spacing: found.grid.map(|n| TAU / n as f64),
        arrays: vec![("determinant", real), ("imaginary_part", imaginary)],
    };
    add(format!("{name}/{name}_determinant.vti"), Artifact::Grid(map));
    if let Some(lines) = survey.lines() {
        let winding = |a: usize| lines.lines.iter().map(|line| line.winding[a]).collect();
        let passes = lines.lines.iter().map(|line| line.passes as i32).collect();
        let mut net = Net {
            of_curves: vec![("winding1", winding(0)), ("winding2", winding(1)), ("passes", passes)],
            ..Net::default()
        };
        for line in &lines.lines {
            let first = net.points.len();
            net.points.extend(line.points.iter().map(|[q1, q2]| Vec3::new(*q1, *q2, 0.0)));
            net.curves.push((first..net.points.len()).collect());
        }
        add(format!("{name}/{name}_zero_lines.vtp"), Artifact::Net(net));
    }
    for (k, mode) in survey.modes.iter().enumerate() {
        let picture = moving_picture(context, found.ground.folded.as_ref(), mode);
        add(format!("{name}/{name}_mode_{k:04}.vtu"), picture.into());
    }
    answer.add(format!("{name}.pvd"), Artifact::Series(files));
}

/// Adds the picture of determinant and decay rates, if the study asks for it.
fn add_figure(answer: &mut Answer, context: &Context<'_>, (found, survey): (&FoundModes, &Survey)) {
    if !context.draws(Draw::Svg) {
        return;
    }
    let lines = survey.lines().iter().flat_map(|lines| &lines.lines).map(|line| line.points.clone()).collect();
    let theta = theta(context.assembly, &found.ground);
    let marks = theta.map_or(vec![], |theta| vec![theta, theta.map(|angle| -angle)]);
    let state = theta.map_or("modes of the drawn state".to_owned(), |[theta1, theta2]| {
        format!("modes of a cylinder with rotations of {} and {} rad per cell", rounded(theta1, 4), rounded(theta2, 4))
    });
    let measured = found.strip.iter().flat_map(FoundStrip::measured).collect();
    let upper = found.strip.iter().filter_map(|strip| strip.upper.as_ref());
    let other = upper.flat_map(rates).map(|(q, kappa, _)| (q, kappa)).collect();
    let rates = rates(&survey.determinant);
    let plot = BlochPlot { rates, polynomial: &survey.determinant.polynomial, lines, marks, other, measured };
    answer.add(format!("{}.svg", context.name()), figure::svg(&plot, &context.caption(state)));
}

/// Returns the picture of a mode on the cells that are shown, in the frame of the mesh file, as velocities of its
/// state.
fn moving_picture(context: &Context<'_>, folded: Option<&Vec<f64>>, mode: &ModeShape) -> Picture {
    let (drawn, places) = (context.assembly.drawn(), &context.view.places);
    let displacement = mode.at(places);
    let Some(x) = folded else {
        return Picture { displacement, ..states::picture_at(context, drawn.coordinates.clone()) };
    };
    let Drawn { domain, frame, .. } = drawn;
    let turned = |((_, cell), u): (&(usize, [i32; 2]), Vec3)| frame.transpose() * cell_rotation(domain, x, *cell) * u;
    let displacement = places.iter().zip(displacement).map(turned).collect();
    Picture { displacement, ..states::picture_at(context, x.clone()) }
}

/// Returns the rotation angles from a cell of the state to the next along the two lattice vectors, in radians; `None`
/// for the drawn state.
fn theta(assembly: &Assembly, ground: &Ground) -> Option<[f64; 2]> {
    let x = ground.folded.as_ref()?;
    cylinder(assembly.drawn(), x).map(|cylinder| cylinder.theta)
}

/// Returns `(q1, kappa2, whether on the circle)` of all roots at many wavenumbers, without those at which the
/// determinant vanishes for all `z2`.
fn rates(determinant: &Determinant) -> Vec<(f64, f64, bool)> {
    let decays = (0..DRAWN).filter_map(|k| Decay::new(determinant, 0, wavenumber(k, DRAWN)).ok());
    decays
        .flat_map(|decay| decay.roots.into_iter().map(move |root| (decay.q, root.kappa(), root.on_circle())))
        .collect()
}

/// Returns what is read off the determinant of a state with these rotation angles from a cell to the next.
fn summary(survey: &Survey, grid: [usize; 2], theta: Option<[f64; 2]>) -> BlochSummary {
    let Survey { determinant, decays, polarization, real, .. } = survey;
    let pairings: Vec<_> = decays.iter().map(Decay::pairing).collect();
    let decay = |decay: &Decay| DecaySummary {
        q1: decay.q,
        kappa2: decay.roots.iter().map(|root| root.kappa()).collect(),
        condition: decay.roots.iter().map(|root| root.condition.min(f64::MAX)).collect(),
        multiplicity: decay.roots.iter().map(|root| root.multiplicity).collect(),
        vanishes: decay.vanishes,
    };
    let traced = survey.lines();
    let summarized = |line: &ZeroLine| ZeroLine { points: vec![], ..line.clone() };
    let to_zero = |(zone, q): (&Zone, [f64; 2])| {
        let (value, gradient) = zone.at(q);
        value.abs() / gradient[0].hypot(gradient[1])
    };
    BlochSummary {
        determinant: determinant.polynomial.terms().map(|(m, n, c)| [m, n, c]).collect(),
        symmetry_error: Some(determinant.symmetry_error),
        imaginary_part: Some(determinant.imaginary_part),
        decay: decays.iter().map(decay).collect(),
        pairing_error: worst(pairings.iter().filter_map(|pairing| pairing.error)),
        pairing_condition: worst(pairings.iter().filter_map(|pairing| pairing.condition)),
        ill_conditioned: pairings.iter().map(|pairing| pairing.left_out).sum(),
        polarization: Some(polarization.polarization),
        on_circle: Some(polarization.on_circle),
        positive_fraction: real.as_ref().map(|(zone, _)| zone.positive_fraction(grid)),
        zero_lines: traced.map(|lines| lines.lines.len()),
        no_zero_lines: real.as_ref().and_then(|(_, lines)| Some(lines.as_ref().err()?.to_string())),
        lines: traced.iter().flat_map(|traced| traced.lines.iter().map(summarized)).collect(),
        regions: traced.map_or(vec![], |traced| traced.regions.clone()),
        order_at_origin: real.as_ref().map(|(zone, _)| zone.order),
        directions: real.iter().flat_map(|(zone, _)| zone.directions().unwrap_or_default()).collect(),
        theta_to_zero: real.as_ref().map(|(zone, _)| zone).zip(theta).map(to_zero),
        ..BlochSummary::default()
    }
}
