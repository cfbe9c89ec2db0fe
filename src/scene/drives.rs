//! The quantities that paths drive: their checks, and their values for a sheet.

use std::ops::Range;

use super::places::{Places, motions};
use super::spec::{AxisSpec, DomainSpec, DriveSpec, DrivenTerm, VertexSet};
use super::values::{EdgeName, Motions};
use super::{Located, SceneError, SceneFile};
use crate::math::Vec3;
use crate::model::{Assembly, Drive, Driven, TermKind};
use crate::sheet::Sheet;
use crate::sheet::angle::Angle;
use crate::sheet::similar::there_are;

/// Part of a direction along which a vertex is held, up to which it counts as free to move along the direction.
const FREE: f64 = 1e-12;

/// Largest number of vertices of a patch of which a volume is driven: each of them is coupled with each other one, which
/// takes 1.2 GB and about ten seconds a step for as many.
const MOST_OF_VOLUME: usize = 2_000;

/// The one quantity that a drive names.
enum Quantity<'a> {
    Part(&'a Located<String>, &'a Located<AxisSpec>),
    Vertices(&'a Located<VertexSet>, &'a Located<AxisSpec>),
    Loads(Range<usize>),
    Pressure(&'a Located<String>),
    Volume(&'a Located<String>),
    Lock(&'a Located<EdgeName>),
    Rest(Range<usize>),
    Stiffness(&'a Located<DrivenTerm>),
}

/// Checks what is wrong in drives and parts without a sheet.
pub(super) fn check(file: &SceneFile) -> Result<(), SceneError> {
    let scene = &file.scene;
    let patch = scene.sheet.domain() == DomainSpec::Patch;
    let part = scene.parts.first().map(|part| ("part", part.name.span()));
    let tie = scene.ties.first().map(|tie| ("tie", tie.vertices.span()));
    if let Some((word, span)) = part.or(tie).filter(|_| !patch) {
        let help = format!("{word}s need domain = \"patch\"");
        return Err(file.error_at(span, format!("a {word} on a sheet that is no patch"), help));
    }
    for drive in &scene.drives {
        let quantity = quantity(file, drive)?;
        if let (Quantity::Vertices(_, axis), false) = (&quantity, patch) {
            let help = "a periodic sheet moves as a whole: drive a lock, the rest angles or a stiffness, or give \
                        domain = \"patch\"";
            return Err(file.error_at(axis.span(), "vertices are driven on a sheet that is no patch", help));
        }
        end(file, drive, &quantity)?;
    }
    Ok(())
}

/// Returns vertices, those of parts among them, with directions along which drives move them, and so support loads.
pub(crate) fn supported(file: &SceneFile, assembly: &Assembly) -> Result<Vec<(usize, Vec3)>, SceneError> {
    let mut directions = Vec::new();
    for spec in &file.scene.drives {
        match resolve(file, assembly, spec)?.quantity {
            Driven::Vertices { vertices, direction } => {
                directions.extend(vertices.into_iter().map(|vertex| (vertex, direction)));
            }
            Driven::Part { part, axis } if axis < 3 => {
                let vertices = &assembly.terms().parts[part].vertices;
                directions.extend(vertices.iter().map(|&vertex| (vertex, Vec3::ith(axis, 1.0))));
            }
            Driven::Part { .. } | Driven::Loads | Driven::Pressure(_) | Driven::Volume(_) => {}
            Driven::Lock(_) | Driven::Rest | Driven::Stiffness(_) => {}
        }
    }
    Ok(directions)
}

/// Returns the drive that a table of the scene describes.
pub(super) fn resolve(file: &SceneFile, assembly: &Assembly, spec: &DriveSpec) -> Result<Drive, SceneError> {
    let terms = assembly.terms();
    let nothing = |span: Range<usize>, message: &str, help: &str| Err(file.error_at(span, message, help));
    let quantity = match quantity(file, spec)? {
        Quantity::Part(name, axis) => part(file, name, axis)?,
        Quantity::Vertices(set, axis) => vertices(file, assembly, set, axis)?,
        Quantity::Loads(span) if !terms.is_loaded() => {
            return nothing(span, "the scene has no loads to drive", "add a [[load]] or [[pressure]]");
        }
        Quantity::Loads(_) => Driven::Loads,
        Quantity::Pressure(name) => Driven::Pressure(pressure(file, name)?),
        Quantity::Volume(name) => {
            let vertices = assembly.tiling().positions.len();
            if vertices > MOST_OF_VOLUME {
                let message = format!("the volume depends on {vertices} vertices at once");
                let help =
                    format!("a volume is driven of at most {MOST_OF_VOLUME} vertices; drive the pressure instead");
                return nothing(name.span(), &message, &help);
            }
            Driven::Volume(pressure(file, name)?)
        }
        Quantity::Lock(crease) => lock(file, assembly, spec, crease)?,
        Quantity::Rest(span) => rest(file, assembly, span)?,
        Quantity::Stiffness(term) => {
            let (there, kind, name) = match **term {
                DrivenTerm::Bars => (terms.bars.is_some(), TermKind::Bars, "bars"),
                DrivenTerm::Creases => (terms.creases.is_some(), TermKind::Creases, "creases"),
                DrivenTerm::Facets => (terms.facets.is_some(), TermKind::Facets, "facets"),
            };
            if !there {
                let message = format!("the sheet has no {name} whose stiffness could change");
                return nothing(term.span(), &message, &format!("give `{name}` a stiffness in [energy]"));
            }
            Driven::Stiffness(kind)
        }
    };
    Ok(Drive { quantity, to: spec.to.0[0].radians })
}

/// Returns the rest angles as a driven quantity, for the drive or study at this place of the scene.
pub(crate) fn rest(file: &SceneFile, assembly: &Assembly, span: Range<usize>) -> Result<Driven, SceneError> {
    let terms = assembly.terms();
    let soft_facets = terms.facets.is_some() && !terms.has_rigid_facets();
    if terms.creases.is_none() && !soft_facets {
        let help = "give creases, or facets, a stiffness in [energy]";
        let message = "the scene has no soft creases or facets whose rest angles could change";
        return Err(file.error_at(span, message, help));
    }
    Ok(Driven::Rest)
}

/// Returns the one quantity that a drive names.
fn quantity<'a>(file: &SceneFile, drive: &'a DriveSpec) -> Result<Quantity<'a>, SceneError> {
    let DriveSpec { name, part, vertices, axis, load, pressure, volume, lock, rest, stiffness, to: _ } = drive;
    let flag = |flag: &Located<bool>| if **flag { Ok(flag.span()) } else { Err(flag.span()) };
    let given = [
        part.as_ref().map(|part| part.span()),
        vertices.as_ref().map(|vertices| vertices.span()),
        load.as_ref().map(Located::span),
        pressure.as_ref().map(Located::span),
        volume.as_ref().map(Located::span),
        lock.as_ref().map(Located::span),
        rest.as_ref().map(Located::span),
        stiffness.as_ref().map(Located::span),
    ];
    let help = "give one of part, vertices, load = true, pressure, volume, lock, rest = true and stiffness";
    let mut given = given.into_iter().flatten();
    match (given.next(), given.next()) {
        (None, _) => return Err(file.error_at(name.span(), "the drive drives nothing", help)),
        (Some(_), Some(second)) => return Err(file.error_at(second, "the drive drives two quantities", help)),
        (Some(_), None) => {}
    }
    let moves = part.is_some() || vertices.is_some();
    match axis {
        Some(axis) if !moves => {
            return Err(file.error_at(axis.span(), "`axis` belongs to `part` or `vertices`", "leave it out here"));
        }
        None if moves => {
            let help =
                "add axis = \"z\", or another of \"x\", \"y\", \"rx\", \"ry\", \"rz\"; of vertices also [x, y, z]";
            return Err(file.error_at(name.span(), "the drive has no axis", help));
        }
        _ => {}
    }
    let not_driven = |span: Range<usize>| file.error_at(span, "false drives nothing", "write true, or leave it out");
    match drive {
        DriveSpec { part: Some(part), axis: Some(axis), .. } => Ok(Quantity::Part(part, axis)),
        DriveSpec { vertices: Some(vertices), axis: Some(axis), .. } => Ok(Quantity::Vertices(vertices, axis)),
        DriveSpec { load: Some(load), .. } => flag(load).map(Quantity::Loads).map_err(not_driven),
        DriveSpec { pressure: Some(pressure), .. } => Ok(Quantity::Pressure(pressure)),
        DriveSpec { volume: Some(volume), .. } => Ok(Quantity::Volume(volume)),
        DriveSpec { lock: Some(lock), .. } => Ok(Quantity::Lock(lock)),
        DriveSpec { rest: Some(rest), .. } => flag(rest).map(Quantity::Rest).map_err(not_driven),
        DriveSpec { stiffness: Some(stiffness), .. } => Ok(Quantity::Stiffness(stiffness)),
        _ => Err(file.error_at(name.span(), "the drive drives nothing", help)),
    }
}

/// Checks the values at the ends of a drive, as far as the scene alone says where it begins.
fn end(file: &SceneFile, drive: &DriveSpec, quantity: &Quantity<'_>) -> Result<(), SceneError> {
    let mut from = None;
    for &angle in &drive.to.0 {
        if from == Some(angle.radians) {
            let message = format!("the drive stays at {}", angle.radians);
            return Err(file.error_at(drive.to.span(), message, "each way ends elsewhere than the one before"));
        }
        end_of_way(file, drive, quantity, (angle, from.is_some()))?;
        from = Some(angle.radians);
    }
    Ok(())
}

/// Checks the value at the end of one way of a drive, the first one or a later one.
fn end_of_way(
    file: &SceneFile,
    drive: &DriveSpec,
    quantity: &Quantity<'_>,
    (Angle { radians: to, has_unit }, later): (Angle, bool),
) -> Result<(), SceneError> {
    let wrong = |message: String, help: &str| Err(file.error_at(drive.to.span(), message, help));
    let turns = match quantity {
        Quantity::Lock(_) => true,
        Quantity::Part(_, axis) => matches!(***axis, AxisSpec::Motion(3..)),
        _ => false,
    };
    match quantity {
        _ if has_unit && !turns => {
            wrong("an angle at the end of a drive that turns nothing".into(), "expected a number")
        }
        Quantity::Stiffness(_) if !(to > 0.0) => {
            wrong(format!("the stiffness is {to}"), "expected a positive number or `inf` (exactly rigid)")
        }
        Quantity::Stiffness(term) if to.is_infinite() && ***term != DrivenTerm::Bars => wrong(
            "only bars are driven to exactly rigid".into(),
            "give a finite stiffness; creases and facets have energies that the path would have to end without",
        ),
        Quantity::Stiffness(_) => Ok(()),
        _ if !to.is_finite() => wrong(format!("the number is {to}"), "expected a finite number"),
        Quantity::Part(..) | Quantity::Vertices(..) | Quantity::Volume(_) if to == 0.0 && !later => wrong(
            "the drive ends where it begins".into(),
            "`to` is a displacement, an angle or a volume from where a path begins",
        ),
        _ => Ok(()),
    }
}

/// Returns the name of the pressure that a drive names.
fn pressure(file: &SceneFile, name: &Located<String>) -> Result<String, SceneError> {
    let names = file.scene.pressures.iter().filter_map(|pressure| pressure.name.as_ref());
    let names: Vec<&str> = names.map(|name| name.0.as_str()).collect();
    if names.contains(&name.as_str()) {
        return Ok((**name).clone());
    }
    let help = match names.is_empty() {
        true => "no [[pressure]] of the scene has a name; give one `name`".to_owned(),
        false => there_are(name, names),
    };
    Err(file.error_at(name.span(), format!("no pressure is called `{}`", **name), help))
}

/// Returns the motion of a part that a drive names.
fn part(file: &SceneFile, name: &Located<String>, axis: &Located<AxisSpec>) -> Result<Driven, SceneError> {
    let parts = &file.scene.parts;
    let found = parts.iter().position(|part| part.name.0 == **name).ok_or_else(|| {
        let help = match parts.is_empty() {
            true => "the scene has no [[part]]; add one, or give vertices = .. instead".to_owned(),
            false => there_are(name, parts.iter().map(|part| part.name.0.as_str())),
        };
        file.error_at(name.span(), format!("no part is called `{}`", **name), help)
    })?;
    let AxisSpec::Motion(axis_number) = **axis else {
        let help = "a part moves along one of \"x\", \"y\", \"z\" or turns about \"rx\", \"ry\", \"rz\"";
        return Err(file.error_at(axis.span(), "a direction as the axis of a part", help));
    };
    if !motions(&parts[found])[axis_number] {
        let motion = Motions::NAMES[axis_number];
        let message = format!("part `{}` is held in \"{motion}\"", **name);
        return Err(file.error_at(axis.span(), message, format!("add \"{motion}\" to `free` of the part")));
    }
    Ok(Driven::Part { part: found, axis: axis_number })
}

/// Returns the motion of vertices that a drive names: they are in no part, and nothing holds them along the axis.
fn vertices(
    file: &SceneFile,
    assembly: &Assembly,
    set: &Located<VertexSet>,
    axis: &Located<AxisSpec>,
) -> Result<Driven, SceneError> {
    let direction = match **axis {
        AxisSpec::Motion(axis) if axis < 3 => Vec3::ith(axis, 1.0),
        AxisSpec::Direction(direction) => Vec3::from(direction).normalize(),
        AxisSpec::Motion(_) => {
            let help = "vertices move along \"x\", \"y\", \"z\" or a direction [x, y, z]; what turns is a [[part]]";
            return Err(file.error_at(axis.span(), "a rotation as the axis of vertices", help));
        }
    };
    let places = Places::new(file, assembly);
    let vertices = places.set(set)?;
    let terms = assembly.terms();
    for &vertex in &vertices {
        if let Some(part) = terms.parts.iter().position(|part| part.vertices.contains(&vertex)) {
            let Some(name) = file.scene.parts.get(part).map(|part| &part.name.0) else {
                let message = format!("{} is tied to another vertex", places.described(vertex));
                return Err(file.error_at(set.span(), message, "make the tied vertices a [[part]], and drive that"));
            };
            let message = format!("{} is in part `{name}`", places.described(vertex));
            return Err(file.error_at(set.span(), message, format!("drive part = \"{name}\" instead")));
        }
        let pinned = terms.pins.iter().filter(|(pin, _)| *pin == vertex).flat_map(|(_, axes)| {
            axes.iter().enumerate().filter(|(_, held)| **held).map(|(axis, _)| Vec3::ith(axis, 1.0))
        });
        let guided = terms.guides.iter().filter(|(guide, _)| *guide == vertex).map(|(_, normal)| *normal);
        if pinned.chain(guided).any(|held| held.dot(&direction).abs() > FREE) {
            let message = format!("{} is pinned along the axis of the drive", places.described(vertex));
            return Err(file.error_at(set.span(), message, "leave out the pin, or its axes along the drive"));
        }
    }
    Ok(Driven::Vertices { vertices, direction })
}

/// Checks that a crease has one hinge, which an angle means.
pub(super) fn one_hinge(file: &SceneFile, sheet: &Sheet, crease: &Located<EdgeName>) -> Result<(), SceneError> {
    let hinges = sheet.hinges_round(crease.0);
    if hinges < 2 {
        return Ok(());
    }
    let message = format!("the crease has {hinges} hinges, since more than two faces meet there");
    let help = "a lock without `angle` keeps all of them; `foldwell:glue` in the mesh welds or frees single ones";
    Err(file.error_at(crease.span(), message, help))
}

/// Returns the locked edges whose angle a drive changes.
fn lock(
    file: &SceneFile,
    assembly: &Assembly,
    spec: &DriveSpec,
    crease: &Located<EdgeName>,
) -> Result<Driven, SceneError> {
    let edges = &assembly.tiling().edges;
    let is_copy = |edge: usize| assembly.sheet().edges[edges[edge].edge].key.whole() == crease.0;
    let locks: Vec<_> = assembly.terms().locks.iter().filter(|(edge, _)| is_copy(*edge)).collect();
    if locks.is_empty() {
        let message = format!("crease {} is not locked", crease.0);
        let help = format!("add [[lock]] with crease = {}; the drive changes its angle", crease.0);
        return Err(file.error_at(crease.span(), message, help));
    }
    one_hinge(file, assembly.sheet(), crease)?;
    if locks.iter().all(|(_, angle)| *angle == spec.to.0[0].radians) {
        let message = format!("the crease is locked at {} already", spec.to.0[0].radians);
        let help = "give another angle, in radians, to which the lock is driven";
        return Err(file.error_at(spec.to.span(), message, help));
    }
    Ok(Driven::Lock(locks.iter().map(|(edge, _)| *edge).collect()))
}
