//! Polarization: whether more modes are bound to one edge than to the opposite one.
//!
//! At a real wavenumber along an edge every root of the determinant inside the unit circle is a mode bound to one edge,
//! every root outside one bound to the opposite edge. Half their difference, averaged over the wavenumber, is the
//! polarization of the centred determinant. Where no root is on the circle it is the winding number of the determinant
//! round the zone; roots on it (zero modes of the bulk) make that ill-defined, and are counted apart.

use super::laurent::wavenumber;
use super::{BlochError, Decay, Determinant};

/// Counts of roots, averaged over the other wavenumber.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Polarization {
    /// Half the difference of the numbers of roots `z_a` inside and outside, for `a` = 1, 2.
    pub polarization: [f64; 2],
    /// Roots on the circle.
    pub on_circle: [f64; 2],
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
                known += usize::from(!decay.vanishes);
                found.polarization[a] += 0.5 * (decay.at_zero as f64 - decay.at_infinity as f64);
                for root in &decay.roots {
                    match (root.on_circle(), root.kappa() < 0.0) {
                        (true, _) => found.on_circle[a] += 1.0,
                        (false, true) => found.polarization[a] += 0.5,
                        (false, false) => found.polarization[a] -= 0.5,
                    }
                }
            }
            found.polarization[a] /= known.max(1) as f64;
            found.on_circle[a] /= known.max(1) as f64;
        }
        Ok(found)
    }
}
