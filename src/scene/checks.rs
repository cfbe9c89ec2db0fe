//! Checks of combinations of values of a scene that need no more than the scene itself.

use std::collections::HashMap;
use std::hash::Hash;
use std::ops::Range;

use super::forms::StartSpec;
use super::outputs::outputs;
use super::rest::RestSpec;
use super::spec::{
    CreasesSpec, DomainSpec, LandscapeSpec, PathSpec, PinSpec, StopSpec, StudyKind, StudySpec, VertexSet, WellsSpec,
};
use super::values::CellIndex;
use super::{Located, SceneError, SceneFile, loads};
use crate::sheet::similar::{did_you_mean, there_are};

/// Largest length of the name of a study: names of files, which add to it, stay under 255 bytes.
const LONGEST_NAME: usize = 200;

type Checked = Result<(), SceneError>;

/// Checks a scene; returns an error for the first invalid combination of values.
pub(super) fn check(file: &SceneFile) -> Checked {
    sheet(file)?;
    super::material::check_mass(file)?;
    super::material::check(file)?;
    locks(file)?;
    super::turns::check(file)?;
    fractions(file)?;
    places(file)?;
    names(file)?;
    super::drives::check(file)?;
    studies(file)
}

fn sheet(file: &SceneFile) -> Checked {
    let sheet = &file.scene.sheet;
    let help = "give one of mesh = \"file.fold\" and generate = { pattern = \"miura\", .. }";
    match (&sheet.mesh, &sheet.generate) {
        (Some(_), Some(both)) => {
            return Err(file.error_at(both.span(), "the sheet has both a mesh and a pattern", help));
        }
        (None, None) => {
            return Err(file.error_at(sheet_header(file), "the sheet has neither a mesh nor a pattern", help));
        }
        _ => {}
    }
    let of_files =
        [("frame", sheet.frame.as_ref().map(Located::span)), ("merge", sheet.merge.as_ref().map(Located::span))];
    for (key, span) in of_files {
        if let Some(span) = span.filter(|_| sheet.mesh.is_none()) {
            let help = "it belongs to mesh = \"file.fold\"; leave it out otherwise";
            return Err(file.error_at(span, format!("`{key}` is given for a pattern"), help));
        }
    }
    of_tube(file)?;
    let misplaced = sheet.lattice.as_ref().filter(|_| sheet.domain() != DomainSpec::Torus);
    let Some(lattice) = misplaced else { return Ok(()) };
    let help = "it belongs to domain = \"torus\"; leave it out otherwise";
    Err(file.error_at(lattice.span(), format!("`lattice` is given for a {}", domain_name(file)), help))
}

/// Checks that a tube has a seam and shows no more strands than it has, and that the keys of tubes are given for tubes
/// only.
fn of_tube(file: &SceneFile) -> Checked {
    let sheet = &file.scene.sheet;
    if sheet.domain() != DomainSpec::Tube {
        let given = [
            ("seam", sheet.seam.as_ref().map(Located::span)),
            ("closing", sheet.closing.as_ref().map(Located::span)),
            ("inwards", sheet.inwards.as_ref().map(Located::span)),
        ];
        let Some((key, span)) = given.into_iter().find_map(|(key, span)| Some((key, span?))) else { return Ok(()) };
        let help = "it belongs to domain = \"tube\"; leave it out otherwise";
        return Err(file.error_at(span, format!("`{key}` is given for a {}", domain_name(file)), help));
    }
    let Some(seam) = sheet.seam.as_ref() else {
        let span = sheet.domain.as_ref().map_or(0..0, Located::span);
        let help = "give seam = [n1, n2], the cell that lies on cell [0, 0] when the sheet is rolled up";
        return Err(file.error_at(span, "a tube without a seam", help));
    };
    let strands = seam.usual_cells()[0];
    let Some(cells) = sheet.cells.as_ref().filter(|cells| cells.0[0] > strands) else { return Ok(()) };
    let [n1, n2] = seam.0;
    let message = format!("a tube with the seam [{n1}, {n2}] has no {} strands", cells.0[0]);
    let help = format!("the first number is at most {strands}, the greatest common divisor of the seam");
    Err(file.error_at(cells.span(), message, help))
}

/// Returns the bytes of the header `[sheet]`, the place of errors of the whole table.
fn sheet_header(file: &SceneFile) -> Range<usize> {
    let start = file.text().find("[sheet]").unwrap_or(0);
    start..(start + "[sheet]".len()).min(file.text().len())
}

fn domain_name(file: &SceneFile) -> &'static str {
    match file.scene.sheet.domain() {
        DomainSpec::Screw => "screw domain",
        DomainSpec::Patch => "patch",
        DomainSpec::Torus => "torus",
        DomainSpec::Tube => "tube",
    }
}

/// Checks that the keys differ from each other; returns an error at the second of two equal keys, with the message for
/// that key.
fn unique<K: Eq + Hash>(
    file: &SceneFile,
    keys: impl Iterator<Item = (K, Range<usize>)>,
    fault: impl Fn(&K, usize) -> [String; 2],
) -> Checked {
    let mut first = HashMap::new();
    for (key, span) in keys {
        if let Some(&before) = first.get(&key) {
            let [message, help] = fault(&key, file.line_of(before));
            return Err(file.error_at(span, message, help));
        }
        first.insert(key, span.start);
    }
    Ok(())
}

fn locks(file: &SceneFile) -> Checked {
    let keys = file.scene.locks.iter().map(|lock| (*lock.crease, lock.crease.span()));
    unique(file, keys, |_, line| {
        [
            "the crease is locked twice".into(),
            format!("it is locked in line {line} already; [i, j, n1, n2] and [j, i, -n1, -n2] are the same crease"),
        ]
    })
}

/// Checks that fractions are given only where there are angles of which they can be a part.
fn fractions(file: &SceneFile) -> Checked {
    for CreasesSpec { rest, fraction, .. } in file.scene.energy.hinges().into_iter().flatten() {
        let Some(fraction) = fraction else { continue };
        let folded = matches!(rest.as_deref(), Some(RestSpec::Target | RestSpec::Assigned | RestSpec::Letters(_)));
        let help = "it belongs to rest = \"target\", \"assigned\" or { M = .., V = .. }; leave it out otherwise";
        file.error_if(!folded, fraction.span(), "`fraction` is given without angles of a folded sheet", help)?;
    }
    Ok(())
}

fn places(file: &SceneFile) -> Checked {
    loads::check(file)?;
    let scene = &file.scene;
    for load in scene.loads.iter().filter(|load| load.weight.is_none()) {
        place(file, "a load", (load.vertex.as_ref(), load.vertices.as_ref()), load.cell.as_ref())?;
    }
    for pin in &scene.pins {
        place(file, "a pin", (pin.vertex.as_ref(), pin.vertices.as_ref()), pin.cell.as_ref())?;
    }
    for spring in &scene.springs {
        place(file, "a spring", (None, Some(&spring.vertices)), None)?;
    }
    let cell = |pin: &PinSpec| pin.cell.as_deref().copied().unwrap_or_default().0;
    let axes = scene.pins.iter().filter(|pin| pin.normal.is_none());
    let keys = axes.filter_map(|pin| pin.vertex.as_ref().map(|vertex| ((**vertex, cell(pin)), vertex.span())));
    unique(file, keys, |(vertex, cell), line| {
        [
            format!("vertex {vertex} of cell {cell:?} is pinned twice"),
            format!("name all its axes in the pin of line {line}"),
        ]
    })
}

/// Checks that no two parts, no two pressures and no two drives have one name.
fn names(file: &SceneFile) -> Checked {
    let fault = |what: &'static str| {
        move |name: &&str, line: usize| {
            [format!("two {what} have the name `{name}`"), format!("choose another: line {line} has it")]
        }
    };
    let parts = file.scene.parts.iter().map(|part| (part.name.0.as_str(), part.name.span()));
    unique(file, parts, fault("parts"))?;
    let pressures = file.scene.pressures.iter().filter_map(|pressure| pressure.name.as_ref());
    unique(file, pressures.map(|name| (name.0.as_str(), name.span())), fault("pressures"))?;
    unique(file, file.scene.drives.iter().map(|drive| (drive.name.0.as_str(), drive.name.span())), fault("drives"))
}

fn place(
    file: &SceneFile,
    what: &str,
    (vertex, vertices): (Option<&Located<usize>>, Option<&Located<VertexSet>>),
    cell: Option<&Located<CellIndex>>,
) -> Checked {
    let sheet = &file.scene.sheet;
    let (periodic, help) = (sheet.domain() != DomainSpec::Patch, "loads, pins and springs need domain = \"patch\"");
    let span = vertex.map(Located::span).or(vertices.map(Located::span)).unwrap_or(0..0);
    file.error_if(periodic, span, format!("{what} on a {}", domain_name(file)), help)?;
    let cells = sheet.cells();
    let outside = cell.filter(|cell| cell.0[0] >= cells[0] || cell.0[1] >= cells[1]);
    let Some(cell) = outside else { return Ok(()) };
    let help = format!("cells of this patch run from [0, 0] to [{}, {}]", cells[0] - 1, cells[1] - 1);
    Err(file.error_at(cell.span(), format!("there is no cell {:?}", cell.0), help))
}

fn studies(file: &SceneFile) -> Checked {
    let studies = &file.scene.studies;
    let names = studies.iter().map(|study| (&*study.name, study.name.span()));
    unique(file, names, |name, line| {
        [
            format!("two studies have the name `{}`", name.0),
            format!("choose another: line {line} has it, and it names files"),
        ]
    })?;
    if let Some(long) = studies.iter().find(|study| study.name.0.len() > LONGEST_NAME) {
        let message = format!("the name of this study has {} characters", long.name.0.len());
        let help = format!("it becomes the name of files: {LONGEST_NAME} at most");
        return Err(file.error_at(long.name.span(), message, help));
    }
    files(file)?;
    studies.iter().enumerate().try_for_each(|(at, study)| kind(file, study, &studies[..at]))
}

/// Checks that no two studies would write the same file, also on systems where capital letters make no difference.
fn files(file: &SceneFile) -> Checked {
    let of_study = |study: &StudySpec| {
        let span = study.name.span();
        outputs(study).into_iter().map(move |name| (name.to_ascii_lowercase(), span.clone())).collect::<Vec<_>>()
    };
    unique(file, file.scene.studies.iter().flat_map(of_study), |name, line| {
        [
            format!("this study and the one named in line {line} would both write `{name}`"),
            "choose another name; capital and small letters are the same on some systems".into(),
        ]
    })
}

fn kind(file: &SceneFile, study: &StudySpec, earlier: &[StudySpec]) -> Checked {
    study.kind.start().map_or(Ok(()), |start| earlier_study(file, start, earlier))?;
    match &*study.kind {
        StudyKind::Path(path) => driven(file, study, path),
        StudyKind::Fold(path) => folded(file, path),
        StudyKind::Trace(trace) => trace.stop.as_ref().map_or(Ok(()), |stop| trace_stop(file, stop)),
        StudyKind::Landscape(landscape) => not_empty(file, landscape),
        StudyKind::Relax(_) | StudyKind::Bloch(_) | StudyKind::Response(_) => Ok(()),
        StudyKind::Surface(_) | StudyKind::Modes(_) | StudyKind::Branches(_) => Ok(()),
        StudyKind::Wells(wells) => of_rigid(file, wells),
    }
}

fn earlier_study(file: &SceneFile, start: &Located<StartSpec>, earlier: &[StudySpec]) -> Checked {
    let StartSpec::Study(name) = &**start else { return Ok(()) };
    let with_states: Vec<_> = earlier.iter().filter(|study| has_states(&study.kind)).collect();
    if with_states.iter().any(|study| study.name.0 == *name) {
        return Ok(());
    }
    let question = did_you_mean(name, with_states.iter().map(|study| study.name.0.as_str()));
    let names: Vec<_> = with_states.iter().map(|study| format!("\"{}\"", study.name.0)).collect();
    let known = if names.is_empty() { "there are none".into() } else { format!("here {}", names.join(", ")) };
    let help = format!(
        "{question}\"drawn\", the name of an earlier study with states ({known}), {{ random, seed }} or a .vtu file"
    );
    let message = match earlier.iter().find(|study| study.name.0 == *name) {
        Some(study) => format!("`{name}` is a study of kind {}, which ends in no state", study.kind.name()),
        None => format!("no earlier study is called `{name}`"),
    };
    Err(file.error_at(start.span(), message, help))
}

/// Whether studies of a kind end in a state from which another study can start.
fn has_states(kind: &StudyKind) -> bool {
    let follows = matches!(kind, StudyKind::Trace(_) | StudyKind::Path(_) | StudyKind::Fold(_));
    follows || matches!(kind, StudyKind::Relax(_) | StudyKind::Surface(_))
}

/// Checks that a path has a drive.
fn driven(file: &SceneFile, study: &StudySpec, path: &PathSpec) -> Checked {
    let drives = &file.scene.drives;
    let names = drives.iter().map(|drive| drive.name.0.as_str());
    match &path.drive {
        _ if drives.is_empty() => {
            let help = "add a [[drive]]: what is driven, and the value `to` which it goes";
            return Err(file.error_at(study.kind.span(), "a path follows a drive, and there is none", help));
        }
        Some(name) if names.clone().all(|known| known != **name) => {
            return Err(file.error_at(name.span(), format!("no drive is called `{}`", **name), there_are(name, names)));
        }
        None if drives.len() > 1 => {
            let message = format!("there are {} drives, and this path names none", drives.len());
            return Err(file.error_at(study.kind.span(), message, format!("give `drive`; {}", there_are("", names))));
        }
        _ => {}
    }
    path_stop(file, path)
}

/// Checks that a study of kind `fold` names no drive.
fn folded(file: &SceneFile, path: &PathSpec) -> Checked {
    let Some(name) = &path.drive else { return path_stop(file, path) };
    let help = "leave it out: what is driven are the rest angles; kind = \"path\" drives other quantities";
    Err(file.error_at(name.span(), "a study of kind fold has no drive of the scene", help))
}

/// Checks that the sheet of a path has the quantities at which it stops.
fn path_stop(file: &SceneFile, path: &PathSpec) -> Checked {
    let Some(stop) = &path.stop else { return Ok(()) };
    let rolls = matches!(file.scene.sheet.domain(), DomainSpec::Screw | DomainSpec::Tube);
    if let Some(curvature) = stop.curvature.as_ref().filter(|_| !rolls) {
        let help = "a patch or torus has no curvature of its own: stop at an arc length or at the angle of a crease";
        return Err(file.error_at(curvature.span(), "a path of this sheet does not stop at a curvature", help));
    }
    some_condition(file, stop)
}

/// Checks that a trace stops at what it has.
fn trace_stop(file: &SceneFile, stop: &Located<StopSpec>) -> Checked {
    let Some(span) = stop.of_path() else { return some_condition(file, stop) };
    let help = "a trace follows rigid foldings, without a drive and forces; kind = \"path\" has this condition";
    Err(file.error_at(span, "a trace does not stop there", help))
}

fn some_condition(file: &SceneFile, stop: &Located<StopSpec>) -> Checked {
    let help = "give one of arc_length, curvature, crease_angle = { crease, angle }, self_intersection = true; a path \
                also has drive, displacement = { probe, value }, reaction, states and limit_points";
    if stop.is_empty() { Err(file.error_at(stop.span(), "no condition to stop at", help)) } else { Ok(()) }
}

/// Checks that keys about the sampling of rigid states are given only together with `rigid`.
fn of_rigid(file: &SceneFile, wells: &WellsSpec) -> Checked {
    let given = [
        ("resolution", wells.resolution.as_ref().map(Located::span)),
        ("max_curvature", wells.max_curvature.as_ref().map(Located::span)),
    ];
    let given = given.into_iter().find_map(|(key, span)| Some((key, span?)));
    let Some((key, span)) = given.filter(|_| !wells.rigid) else { return Ok(()) };
    let message = format!("`{key}` is given, but the rigid states are not asked for");
    Err(file.error_at(span, message, "add rigid = true, or leave it out"))
}

fn not_empty(file: &SceneFile, landscape: &LandscapeSpec) -> Checked {
    let LandscapeSpec { modes, amplitudes, .. } = landscape;
    file.error_if(modes.is_empty(), modes.span(), "no modes", "give at least one, as in [[1, 0, 0]]")?;
    file.error_if(amplitudes.is_empty(), amplitudes.span(), "no amplitudes", "give at least one, as in [0.01]")
}
