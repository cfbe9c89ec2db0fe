//! The numbers of a page: arrays in base64, each stored once.
//!
//! Trajectories of one cell repeat most of their arrays (rest angles, strains of rigid bars), so that equal arrays have
//! one place. Numbers are little-endian and of single precision, in the order of `Float32Array` and `Uint32Array`.

use std::collections::HashMap;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::Serialize;

/// The arrays of a page.
#[derive(Debug, Default)]
pub(super) struct Arrays {
    places: HashMap<String, usize>,
}

/// Numbers divided by a scale, so that single precision holds them whatever their unit is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(super) struct Scaled {
    /// The number that a stored 1 stands for.
    pub scale: f64,
    /// Place of the array of single-precision numbers; those that are not known are NaN.
    pub array: usize,
}

impl Arrays {
    /// Stores whole numbers as `Uint32Array`; returns their place.
    pub(super) fn indices(&mut self, numbers: impl Iterator<Item = usize>) -> usize {
        self.keep(numbers.flat_map(|number| (number as u32).to_le_bytes()).collect())
    }

    /// Stores single-precision numbers as `Float32Array`; returns their place.
    pub(super) fn floats(&mut self, numbers: impl Iterator<Item = f32>) -> usize {
        self.keep(numbers.flat_map(f32::to_le_bytes).collect())
    }

    /// Stores marks (0 or 1) as `Uint8Array`; returns their place.
    pub(super) fn marks(&mut self, marks: &[u8]) -> usize {
        self.keep(marks.to_vec())
    }

    /// Stores numbers divided by the largest of their magnitudes.
    pub(super) fn scaled(&mut self, numbers: &[f64]) -> Scaled {
        let scale = scale(numbers.iter().copied());
        Scaled { scale, array: self.floats(numbers.iter().map(|number| (number / scale) as f32)) }
    }

    fn keep(&mut self, bytes: Vec<u8>) -> usize {
        let next = self.places.len();
        *self.places.entry(STANDARD.encode(bytes)).or_insert(next)
    }

    /// Returns the texts of all arrays in the order of their places.
    pub(super) fn into_texts(self) -> Vec<String> {
        let mut texts: Vec<(usize, String)> = self.places.into_iter().map(|(text, place)| (place, text)).collect();
        texts.sort_unstable_by_key(|(place, _)| *place);
        texts.into_iter().map(|(_, text)| text).collect()
    }
}

/// Returns the largest finite magnitude; 1 if there is none, or if all numbers are zero.
pub(super) fn scale(numbers: impl Iterator<Item = f64>) -> f64 {
    let largest = numbers.map(f64::abs).filter(|number| number.is_finite()).fold(0.0, f64::max);
    if largest > 0.0 { largest } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: equal arrays have one place, whatever their numbers mean; places are counted from 0 in the order of the
    /// first use. Exact.
    #[test]
    fn equal_arrays_are_stored_once() {
        let mut arrays = Arrays::default();
        let first = arrays.floats([1.0, f32::NAN].into_iter());
        let second = arrays.indices([1, 2, 3].into_iter());
        assert_eq!([first, second, arrays.floats([1.0, f32::NAN].into_iter())], [0, 1, 0]);
        assert_eq!(arrays.into_texts(), ["AACAPwAAwH8=", "AQAAAAIAAAADAAAA"]);
    }

    /// Claim: numbers beyond the range of single precision are kept by their scale; those that are not finite stay so.
    #[test]
    fn numbers_of_any_size() {
        let mut arrays = Arrays::default();
        let found = arrays.scaled(&[1e300, -5e299, f64::NAN]);
        assert_eq!((found.scale, found.array), (1e300, 0));
        let same = arrays.scaled(&[1e-300, -5e-301, f64::NAN]);
        assert_eq!((same.scale, same.array), (1e-300, 0));
        assert_eq!([scale([0.0, f64::NAN].into_iter()), scale([].into_iter())], [1.0, 1.0]);
    }
}
