//! Sheets with a zero mode at a given wavenumber, made by moving one vertex along the normal of the sheet.
//!
//! The determinant of the rigidity matrix is real on the Brillouin zone, up to a factor that does not depend on the
//! shape of the cell, and changes sign on lines. Hence its ratio to that of the drawn sheet is real; if the ratio
//! crosses zero while a vertex is moved, a line of zero modes passes the wavenumber.

use super::Predicted;
use foldwell::analysis::bloch::Rigidity;
use foldwell::math::Vec3;
use foldwell::sheet::Sheet;
use nalgebra::Complex;

/// Largest displacement of the vertex relative to the square root of the area of the cell, and number of steps in each
/// direction.
const FARTHEST: f64 = 0.5;
const STEPS: usize = 100;
/// Largest number of steps of the regula falsi.
const MOST_STEPS: usize = 200;

/// Returns the sheet with the vertex moved by the least height that makes a zero mode at the wavenumbers `q`, in
/// radians per cell.
///
/// Fails for finite sheets, whose rigidity matrix is not square, and if there is no such height.
pub fn tuned(sheet: &Sheet, vertex: usize, q: [f64; 2]) -> Predicted<Sheet> {
    let [l1, l2] = sheet.lattice.ok_or("no lattice")?;
    let (size, normal) = (l1.cross(&l2).norm().sqrt(), l1.cross(&l2).normalize());
    let drawn = determinant(sheet, q)?;
    let at =
        |height: f64| -> Predicted<f64> { Ok((determinant(&moved(sheet, vertex, height * normal), q)? / drawn).re) };
    let step = FARTHEST * size / STEPS as f64;
    let mut ends = [(0.0, 1.0); 2];
    for k in 1..=STEPS {
        for (end, sign) in ends.iter_mut().zip([1.0, -1.0]) {
            let next = sign * step * k as f64;
            let value = at(next)?;
            if value * end.1 <= 0.0 {
                let height = zero(*end, (next, value), at)?;
                return Ok(moved(sheet, vertex, height * normal));
            }
            *end = (next, value);
        }
    }
    Err("no height of the vertex makes a zero mode".into())
}

fn determinant(sheet: &Sheet, q: [f64; 2]) -> Predicted<Complex<f64>> {
    Ok(Rigidity::of_sheet(sheet, false)?.determinant(q.map(|q| Complex::from_polar(1.0, q)))?)
}

fn moved(sheet: &Sheet, vertex: usize, by: Vec3) -> Sheet {
    let mut sheet = sheet.clone();
    sheet.vertices[vertex] += by;
    sheet
}

/// Finds a zero between two points where the function has different signs, by the Illinois form of regula falsi.
fn zero(mut a: (f64, f64), mut b: (f64, f64), at: impl Fn(f64) -> Predicted<f64>) -> Predicted<f64> {
    for _ in 0..MOST_STEPS {
        let next = b.0 - b.1 * (b.0 - a.0) / (b.1 - a.1);
        let value = at(next)?;
        if value == 0.0 || next == b.0 || next == a.0 {
            return Ok(next);
        }
        a = if value * b.1 < 0.0 { b } else { (a.0, 0.5 * a.1) };
        b = (next, value);
    }
    Ok(b.0)
}
