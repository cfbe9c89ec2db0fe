//! Sheets with a zero mode at a wanted wavenumber, by moving one vertex along the normal of the sheet.
//!
//! The determinant of the rigidity matrix is real on the Brillouin zone, up to a factor that does not depend on the shape
//! of the cell, and changes sign on lines. So its ratio to the drawn sheet's is real; where it crosses zero as a vertex rises or
//! sinks, a line of zero modes has come to the wavenumber.

use super::Predicted;
use foldwell::analysis::bloch::Rigidity;
use foldwell::math::Vec3;
use foldwell::sheet::Sheet;
use nalgebra::Complex;

/// How far the vertex may go, in parts of the square root of the cell's area, and in how many steps each way.
const FARTHEST: f64 = 0.5;
const STEPS: usize = 100;
/// Most steps of the regula falsi.
const MOST_STEPS: usize = 200;

/// The sheet with this vertex moved by the least height that makes a zero mode at wavenumbers `q`, in radians per cell.
///
/// Fails for finite sheets, where the rigidity matrix is not square, and where no height does it.
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

/// A zero between two places where the function has different signs: regula falsi in the form of Illinois.
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
