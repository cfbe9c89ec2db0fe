//! Paths where curves of equilibria are not apart from each other.

use super::*;
use crate::model::{Driven, RIGID};
use crate::sheet::{EdgeKind, Pattern, generate};
use std::f64::consts::FRAC_PI_2;

/// Claim: a path ends where every direction of an axis is an equilibrium, so that no two states are on one curve: steps
/// that are taken anew become shorter, though states may be farther apart than they are long. Paths of such sheets are
/// refused for that; this one is followed all the same.
#[test]
fn steps_taken_anew_become_shorter() {
    let sheet = generate(&Pattern::named("miura").unwrap()).unwrap();
    let angle = |k: &usize| sheet.drawn_angle(&sheet.edges[*k]).unwrap_or(0.0).abs();
    let is_folded = |k: &usize| sheet.edges[*k].kind == EdgeKind::Crease && (0.05..FRAC_PI_2).contains(&angle(k));
    let crease = (0..sheet.edges.len()).find(is_folded).unwrap();
    let drawn = sheet.drawn_angle(&sheet.edges[crease]);
    let builder = Assembly::screw(sheet.clone(), [1, 1]).bars(RIGID).creases(1.0);
    let assembly = builder.lock(sheet.edges[crease].key, drawn).build().unwrap();
    let options = PathOptions { stop: PathStop { states: Some(400), ..PathStop::default() }, ..PathOptions::default() };
    for factor in [0.9, 1.3] {
        let drive = Drive { quantity: Driven::Lock(vec![crease]), to: factor * drawn.unwrap() };
        let begun = begin(assembly.model(Gauge::Held), &drive, None, &options).unwrap();
        assert!(begun.0.stays_straight(&begun.1));
        let callbacks = PathCallbacks { observe: &mut |_, _| true, keep: &mut |_| true };
        let branches = follow_from(&assembly, begun, &options, PathRecord::default(), callbacks).unwrap();
        assert!(branches[0].points.len() <= 400);
    }
}
