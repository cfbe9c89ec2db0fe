//! A law of one's own: creases that harden.
//!
//! A law says how the energy of an element grows with its measure, here the fold angle: one function of three lines.
//! Everything else, relaxations, paths, wells, files, goes on as before.
//!
//! ```text
//! cargo run --release --example own_law
//! ```

mod common;

use foldwell::model::{Drive, Driven, Law, RIGID};
use foldwell::{Assembly, Pattern, Rest, generate};
use std::error::Error;

/// A torque that grows with the third power of the angle too.
#[derive(Debug)]
struct Hardening;

impl Law for Hardening {
    fn at(&self, angle: f64, rest: f64) -> [f64; 3] {
        let off = angle - rest;
        [0.5 * off.powi(2) + 0.25 * off.powi(4), off + off.powi(3), 1.0 + 3.0 * off.powi(2)]
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let sheet = generate(&Pattern::named("miura")?)?;
    let springs = Assembly::patch(sheet, [2, 2]).bars(RIGID).creases(1.0).rest(Rest::Assigned(0.6));
    let hardening = springs.crease_law(Hardening).build()?;
    common::use_it("hardening", &hardening, &Drive { quantity: Driven::Rest, to: 1.0 })
}
