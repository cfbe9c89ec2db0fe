//! stub until merge
#![allow(missing_docs)]
use nalgebra::Complex;
pub struct Phi {
    pub value: Complex<f64>,
    pub first: Complex<f64>,
    pub second: Complex<f64>,
}
pub fn phi(_t: f64) -> Phi {
    let z = Complex::new(0., 0.);
    Phi { value: z, first: z, second: z }
}
