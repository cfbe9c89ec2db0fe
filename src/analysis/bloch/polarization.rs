//! Polarization: whether more modes are bound to one edge than to the opposite one.
//!
//! At a real wavenumber along an edge every root of the determinant inside the unit circle is a mode bound to one edge,
//! every root outside one bound to the opposite edge. Half their difference, averaged over the wavenumber, is the
//! polarization of the centred determinant. Where no root is on the circle it is the winding number of the determinant
//! round the zone; roots on it (zero modes of the bulk) make that ill-defined, and are counted apart.

use super::laurent::wavenumber;
use super::{BlochError, Decay, Determinant};

/// Roots at one wavenumber, by where they are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Count {
    /// Bound to the lower edge: `|z| < 1`.
    pub inside: usize,
    /// On the circle.
    pub on_circle: usize,
    /// Bound to the upper edge: `|z| > 1`.
    pub outside: usize,
}

/// Counts of roots, averaged over the other wavenumber.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Polarization {
    /// Half the difference of the numbers of roots `z_a` inside and outside, for `a` = 1, 2.
    pub polarization: [f64; 2],
    /// Roots on the circle.
    pub on_circle: [f64; 2],
}

impl Count {
    /// The roots at one wavenumber.
    pub(crate) fn of(decay: &Decay) -> Self {
        let mut count = Self { inside: decay.at_zero, on_circle: 0, outside: decay.at_infinity };
        for root in &decay.roots {
            match (root.on_circle(), root.kappa() < 0.0) {
                (true, _) => count.on_circle += 1,
                (false, true) => count.inside += 1,
                (false, false) => count.outside += 1,
            }
        }
        count
    }
}

impl Polarization {
    /// The polarization, from this many wavenumbers along each direction; those at which the determinant vanishes for
    /// every other factor are left out.
    ///
    /// # Errors
    /// [`BlochError`] where the determinant cannot be computed.
    pub fn new(determinant: &Determinant, samples: usize) -> Result<Self, BlochError> {
        let mut found = Self::default();
        for a in 0..2 {
            let mut known = 0;
            for k in 0..samples {
                let decay = Decay::new(determinant, 1 - a, wavenumber(k, samples))?;
                let count = Count::of(&decay);
                known += usize::from(!decay.vanishes);
                found.polarization[a] += 0.5 * (count.inside as f64 - count.outside as f64);
                found.on_circle[a] += count.on_circle as f64;
            }
            found.polarization[a] /= known.max(1) as f64;
            found.on_circle[a] /= known.max(1) as f64;
        }
        Ok(found)
    }
}
