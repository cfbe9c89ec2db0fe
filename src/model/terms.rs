//! The terms of a sheet: stiffnesses, rest angles, locks, pins and loads.

use crate::math::Vec3;

/// The stiffness of a term that is exactly rigid: infinity.
pub const RIGID: f64 = f64::INFINITY;

/// Largest component of the sum of the loads, relative to the largest component of any load, that counts as balanced.
const BALANCED: f64 = 1e-12;

/// Stiffness and rest angles of the creases, or of the facets.
#[derive(Clone, Debug, PartialEq)]
pub struct Hinges {
    /// Torque per radian and unit length; infinite for rigid hinges.
    pub stiffness: f64,
    /// Rest angle of every edge of the tiling, in radians; only those of hinges of this kind are used.
    pub rest: Vec<f64>,
}

/// The terms of the energy of a sheet, and the locks, pins and loads on it. `None` means that the term is not built.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Terms {
    /// Stiffness `EA` of all bars, a force; infinite for rigid bars.
    pub bars: Option<f64>,
    /// The creases.
    pub creases: Option<Hinges>,
    /// The diagonals of polygons.
    pub facets: Option<Hinges>,
    /// Numbers of the tiling's edges whose fold angle is kept, and that angle in radians.
    pub locks: Vec<(usize, f64)>,
    /// Numbers of the tiling's vertices that are pinned, and the axes (x, y, z) along which they are.
    pub pins: Vec<(usize, [bool; 3])>,
    /// Numbers of the tiling's vertices that carry loads, and the forces on them.
    pub loads: Vec<(usize, Vec3)>,
}

impl Terms {
    /// Makes terms of bars of stiffness `EA` and of creases, whose stiffness is a torque per radian and length and
    /// whose rest angles are one for each edge of the tiling, in radians.
    pub fn bars_and_creases(bars: f64, creases: f64, rest: Vec<f64>) -> Self {
        Self { bars: Some(bars), creases: Some(Hinges { stiffness: creases, rest }), ..Self::default() }
    }

    /// Whether all bars and facets of the terms are rigid; also true if there are none.
    pub fn is_rigid(&self) -> bool {
        let facets = self.facets.as_ref().map(|facets| facets.stiffness);
        [self.bars, facets].into_iter().flatten().all(f64::is_infinite)
    }

    /// Whether facets are rigid, so that polygons keep their shape.
    pub fn has_rigid_facets(&self) -> bool {
        self.facets.as_ref().is_some_and(|facets| facets.stiffness.is_infinite())
    }

    /// Whether there is any bar, crease, facet, lock or load. Pins alone give no energy.
    pub fn has_energy(&self) -> bool {
        let Self { bars, creases, facets, locks, pins: _, loads } = self;
        bars.is_some() || creases.is_some() || facets.is_some() || !locks.is_empty() || !loads.is_empty()
    }

    /// Returns the number of coordinates that pins hold.
    pub fn pinned(&self) -> usize {
        self.pins.iter().map(|(_, axes)| axes.iter().filter(|held| **held).count()).sum()
    }

    /// Returns the first axis (0, 1, 2 for x, y, z) along which the loads do not balance and no vertex is pinned, and
    /// the sum of the loads along it; there is no equilibrium then. `None` if the loads balance along every axis
    /// without pins.
    pub fn unbalanced_axis(&self) -> Option<(usize, f64)> {
        let total: Vec3 = self.loads.iter().map(|(_, force)| force).sum();
        let largest = self.loads.iter().map(|(_, force)| force.amax()).fold(0.0, f64::max);
        let pinned = |axis: usize| self.pins.iter().any(|(_, axes)| axes[axis]);
        let axis = (0..3).find(|&axis| !pinned(axis) && total[axis].abs() > BALANCED * largest)?;
        Some((axis, total[axis]))
    }

    /// Returns the same terms with the rest angles of all creases and facets replaced by `angles`, one for each edge
    /// of the tiling, in radians.
    pub fn resting_at(&self, angles: &[f64]) -> Self {
        let mut terms = self.clone();
        for hinges in [&mut terms.creases, &mut terms.facets].into_iter().flatten() {
            hinges.rest = angles.to_vec();
        }
        terms
    }
}
