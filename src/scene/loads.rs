//! The loads of a scene: forces on vertices, weight, and pressure on faces.

use std::path::Path;

use super::places::Places;
use super::spec::{LoadSpec, PressureSpec};
use super::values::{Motions, Triple};
use super::{Located, SceneError, SceneFile, drives};
use crate::math::Vec3;
use crate::model::{Assembly, AssemblyError, Domain, OwnTerm, Part};

/// Name of an array with the forces on all vertices.
const LOADS: &str = "loads";

/// Checks that every load is a force or the weight.
pub(super) fn check(file: &SceneFile) -> Result<(), SceneError> {
    for load in &file.scene.loads {
        let LoadSpec { vertex, cell, vertices, force, turns, weight } = &**load;
        let given = [vertex.is_some(), cell.is_some(), vertices.is_some(), force.is_some(), turns.is_some()];
        let on_vertices = given.contains(&true);
        match (weight, force) {
            (Some(weight), _) if on_vertices => {
                let help = "it is that of the whole sheet; give forces on vertices in a [[load]] of their own";
                return Err(file.error_at(weight.span(), "`weight` stands alone in its load", help));
            }
            (None, None) => {
                let help = "give force = [x, y, z] with vertex or vertices, or weight = [x, y, z], the acceleration of \
                            gravity";
                return Err(file.error_at(load.span(), "the load has neither `force` nor `weight`", help));
            }
            _ => {}
        }
    }
    Ok(())
}

/// Returns the assembly with the loads of the scene.
pub(super) fn loaded(file: &SceneFile, assembly: &Assembly) -> Result<Assembly, SceneError> {
    let mut terms = assembly.terms().clone();
    terms.loads = forces(file, assembly, &mut terms.own)?;
    for spec in &file.scene.pressures {
        terms.own.push(pressure(file, assembly, spec)?);
    }
    let loaded = assembly.with_terms(terms);
    balance(file, &loaded)?;
    Ok(loaded)
}

/// Returns vertices and the forces on them, and adds the torques of those that turn with parts.
fn forces(file: &SceneFile, assembly: &Assembly, own: &mut Vec<OwnTerm>) -> Result<Vec<(usize, Vec3)>, SceneError> {
    let places = Places::new(file, assembly);
    let mut loads = Vec::new();
    for load in &file.scene.loads {
        let LoadSpec { vertex, cell, vertices, force, turns, weight } = &**load;
        if let Some(gravity) = weight {
            loads.extend(weights(file, assembly, gravity)?);
        }
        let Some(force) = force else { continue };
        let on = places.of_entry(("the load", load.span()), vertex.as_ref(), cell.as_ref(), vertices.as_ref())?;
        let forces = on.into_iter().map(|vertex| (vertex, Vec3::from(force.0)));
        match turns.as_ref().filter(|turns| ***turns) {
            None => loads.extend(forces),
            Some(turns) => {
                for (vertex, force) in forces {
                    let (along, torque) = turning(file, assembly, turns, (vertex, force))?;
                    loads.extend((along != Vec3::zeros()).then_some((vertex, along)));
                    own.extend(torque);
                }
            }
        }
    }
    if let Some(array) = file.array(Path::new(LOADS)) {
        loads.extend(of_array(file, assembly, array)?);
    }
    Ok(loads)
}

/// Returns what a force does that turns with the part of its vertex: the force along the axis about which the part turns,
/// and a torque about it. Nothing turns a force on a part that does not turn.
fn turning(
    file: &SceneFile,
    assembly: &Assembly,
    turns: &Located<bool>,
    (vertex, force): (usize, Vec3),
) -> Result<(Vec3, Option<OwnTerm>), SceneError> {
    let refused = |message: String, help: &str| Err(file.error_at(turns.span(), message, help));
    let parts = &assembly.terms().parts;
    let Some(part) = parts.iter().position(|part| part.vertices.contains(&vertex)) else {
        return refused(format!("vertex {vertex} belongs to no part that turns"), "make its vertices a [[part]]");
    };
    let Part { vertices, free } = &parts[part];
    let Some(axis) = (0..3).find(|axis| free[3 + axis]) else { return Ok((force, None)) };
    let along = Vec3::ith(axis, force[axis]);
    let across = (0..3).find(|other| free[*other] && *other != axis && force != along);
    let potential = "the work of a force that turns depends on the way, so that there is no equilibrium of least energy: \
                     it is known on parts that turn about one axis, along which alone they move";
    if let Some(across) = across {
        let across = Motions::NAMES[across];
        return refused(format!("a force turns with a part that moves along \"{across}\" too"), potential);
    }
    let positions = &assembly.tiling().positions;
    let centroid = vertices.iter().map(|vertex| positions[*vertex]).sum::<Vec3>() / vertices.len() as f64;
    let torque = (positions[vertex] - centroid).cross(&force)[axis];
    let found = OwnTerm::torque(assembly, part, axis, torque).map(|torque| (along, Some(torque)));
    found.or_else(|error| {
        let help = if error == AssemblyError::Loose { "pin a vertex, or hold another part" } else { potential };
        refused(error.to_string(), help)
    })
}

/// Returns the weight of every vertex.
fn weights(file: &SceneFile, assembly: &Assembly, gravity: &Located<Triple>) -> Result<Vec<(usize, Vec3)>, SceneError> {
    let is_patch = *assembly.domain() == Domain::Patch;
    file.error_if(!is_patch, gravity.span(), "only a patch has weight", "give domain = \"patch\"")?;
    let Some(masses) = assembly.masses() else {
        let help = "give mass = { area = 1.0 }, a mass per area, or { vertex = 1.0 }";
        return Err(file.error_at(gravity.span(), "the sheet has weight and no mass", help));
    };
    Ok(masses.into_iter().map(|mass| Vec3::from(gravity.0) * mass).enumerate().collect())
}

/// Returns the loads of an array: three numbers for each vertex of the patch.
fn of_array(file: &SceneFile, assembly: &Assembly, array: &[f64]) -> Result<Vec<(usize, Vec3)>, SceneError> {
    let (forces, vertices) = (array.len() / 3, assembly.tiling().positions.len());
    let refused = |message: String, help: &str| Err(file.error_at(0..0, message, help));
    if assembly.tiling().periodic {
        return refused("loads are on the vertices of a patch".into(), "leave them out");
    }
    if forces != vertices {
        let message = format!("{LOADS} has shape ({forces}, 3), expected ({vertices}, 3)");
        return refused(message, "give a force for each vertex, cell by cell");
    }
    if let Some(k) = array.iter().position(|component| !component.is_finite()) {
        return refused(format!("{LOADS}[{}] is not finite", k / 3), "give finite forces, 0 where there is none");
    }
    let loads = array.chunks_exact(3).map(Vec3::from_column_slice).enumerate();
    Ok(loads.filter(|(_, force)| *force != Vec3::zeros()).collect())
}

/// Returns the pressure on the faces of an entry.
fn pressure(file: &SceneFile, assembly: &Assembly, spec: &Located<PressureSpec>) -> Result<OwnTerm, SceneError> {
    let face_of = assembly.sheet().faces();
    let count = face_of.iter().max().map_or(0, |last| last + 1);
    let span = || spec.faces.as_ref().map_or(spec.span(), Located::span);
    if let Some(face) = spec.faces.as_ref().and_then(|faces| faces.iter().find(|face| **face >= count)) {
        let help = format!("the faces of the mesh are 0 to {}", count - 1);
        return Err(file.error_at(span(), format!("there is no face {face}"), help));
    }
    let on_none = spec.faces.as_ref().is_some_and(|faces| faces.is_empty());
    let help = "name faces that close, or leave the key out: all faces have the pressure then";
    file.error_if(on_none, span(), "the pressure is on no face", help)?;
    let (value, name) = match (&spec.value, &spec.name) {
        (None, None) => {
            let help = "give value = .., or name = \"..\" for a drive to refer to";
            return Err(file.error_at(spec.span(), "the pressure has neither `value` nor `name`", help));
        }
        (value, name) => (value.map_or(0.0, |value| value.0), name.as_ref().map_or("", |name| &name.0)),
    };
    let on = |polygon: usize| spec.faces.as_ref().is_none_or(|faces| faces.contains(&face_of[polygon]));
    OwnTerm::pressure(assembly, name, value, on).map_err(|error| {
        let help = match error {
            AssemblyError::NoPatch => "give domain = \"patch\"",
            _ => "a pressure has a potential where its faces enclose a volume: name faces that close, or pin their rim",
        };
        file.error_at(span(), error.to_string(), help)
    })
}

/// Checks that the loads balance along every direction in which nothing holds or drives the sheet: otherwise there is
/// no equilibrium.
fn balance(file: &SceneFile, assembly: &Assembly) -> Result<(), SceneError> {
    let driven = drives::supported(file, assembly)?;
    let Err(error) = assembly.check_balance(&driven) else { return Ok(()) };
    let place = |load: &Located<LoadSpec>| load.force.as_ref().or(load.weight.as_ref()).map_or(0..0, Located::span);
    let span = file.scene.loads.first().map_or(0..0, place);
    let help = "balance the loads, or pin a vertex along that axis; a sheet with fewer than three pinned vertices \
                still turns as a whole, until its loads pull straight";
    Err(file.error_at(span, error.to_string(), help))
}
