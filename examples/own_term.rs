//! A term of one's own: magnets on two vertices of a sheet.
//!
//! A term is a measure of some points with its derivatives, on chosen vertices, which is an energy but for a factor or has
//! a law: here `1 / d` of two points at the distance `d`, so that two like poles of strength `q` have the energy `q / d`.
//! Everything else, relaxations, paths, wells, files, goes on as before, and the term's energy is listed by its name.
//!
//! ```text
//! cargo run --release --example own_term
//! ```

mod common;

use foldwell::math::Vec3;
use foldwell::model::{Drive, Driven, Measure, OwnTerm, RIGID, Site};
use foldwell::{Assembly, Pattern, Rest, generate, relax};
use nalgebra::{Matrix3, SVector};
use std::error::Error;

/// The reciprocal of the distance between two points.
struct InverseDistance;

impl Measure<2, 6> for InverseDistance {
    fn value(&self, [a, b]: &[Vec3; 2]) -> f64 {
        (b - a).norm().recip()
    }

    fn gradient(&self, points: &[Vec3; 2]) -> (f64, SVector<f64, 6>) {
        let (along, value) = (points[1] - points[0], self.value(points));
        let by_second = -value.powi(3) * along;
        let mut gradient = SVector::<f64, 6>::zeros();
        gradient.fixed_rows_mut::<3>(0).copy_from(&-by_second);
        gradient.fixed_rows_mut::<3>(3).copy_from(&by_second);
        (value, gradient)
    }

    fn hessian(&self, points: &[Vec3; 2], lower: &mut Vec<f64>) -> (f64, SVector<f64, 6>) {
        let (along, value) = (points[1] - points[0], self.value(points));
        let block = 3.0 * value.powi(5) * along * along.transpose() - value.powi(3) * Matrix3::identity();
        let entry = |row: usize, column: usize| {
            let sign = if (row < 3) == (column < 3) { 1.0 } else { -1.0 };
            sign * block[(row % 3, column % 3)]
        };
        lower.clear();
        (0..6).for_each(|row| lower.extend((0..=row).map(|column| entry(row, column))));
        self.gradient(points)
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let sheet = generate(&Pattern::named("miura")?)?;
    let without = Assembly::patch(sheet, [2, 2]).bars(RIGID).creases(1.0).rest(Rest::Assigned(0.6)).build()?;
    let poles = [0, 3 * without.sheet().vertices.len()].map(|vertex| Site { vertex, shift: [0, 0] });
    let magnets = without.with_own_term(OwnTerm::energy("magnets", InverseDistance, [(poles, 5.0)]));
    println!("the magnets store {:.9}", relax(&magnets)?.state.energy_of_term("magnets"));
    common::use_it("magnets", &magnets, &Drive { quantity: Driven::Rest, to: 1.0 })
}
