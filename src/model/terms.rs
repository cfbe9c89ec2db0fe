//! The terms of the energy and the conditions on a sheet: stiffnesses, rest angles, locks, pins and loads.

use crate::math::Vec3;

/// The stiffness of a term that is exactly rigid.
pub const RIGID: f64 = f64::INFINITY;

/// Sum of the loads, relative to the largest, up to which they balance.
const BALANCED: f64 = 1e-12;

/// The hinges of one kind.
#[derive(Clone, Debug, PartialEq)]
pub struct Hinges {
    /// Torque per radian and unit length; infinite: rigid.
    pub stiffness: f64,
    /// Rest angle of every edge of the tiling, in radians; read where there is a hinge of this kind.
    pub rest: Vec<f64>,
}

/// The terms of the energy of a sheet and the conditions on it. A term that is absent is not built.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Terms {
    /// Stiffness `EA` of all bars; infinite: rigid.
    pub bars: Option<f64>,
    /// The creases.
    pub creases: Option<Hinges>,
    /// The diagonals of polygons.
    pub facets: Option<Hinges>,
    /// Edges of the tiling whose fold angle is kept, and that angle in radians.
    pub locks: Vec<(usize, f64)>,
    /// Vertices of the tiling and the axes (x, y, z) that are held.
    pub pins: Vec<(usize, [bool; 3])>,
    /// Vertices of the tiling and the forces on them.
    pub loads: Vec<(usize, Vec3)>,
}

impl Terms {
    /// Bars of stiffness `EA` and creases of a torque per radian and length, at rest at these angles, one for each edge of the
    /// tiling in radians.
    pub fn bars_and_creases(bars: f64, creases: f64, rest: Vec<f64>) -> Self {
        Self { bars: Some(bars), creases: Some(Hinges { stiffness: creases, rest }), ..Self::default() }
    }

    /// Whether bars and facets are rigid, as far as there are any.
    pub fn is_rigid(&self) -> bool {
        let facets = self.facets.as_ref().map(|facets| facets.stiffness);
        [self.bars, facets].into_iter().flatten().all(f64::is_infinite)
    }

    /// Whether polygons keep their shape.
    pub fn has_rigid_facets(&self) -> bool {
        self.facets.as_ref().is_some_and(|facets| facets.stiffness.is_infinite())
    }

    /// Whether any term stores energy, keeps an angle, or does work.
    pub fn has_energy(&self) -> bool {
        let Self { bars, creases, facets, locks, pins: _, loads } = self;
        bars.is_some() || creases.is_some() || facets.is_some() || !locks.is_empty() || !loads.is_empty()
    }

    /// The number of coordinates that pins hold.
    pub fn pinned(&self) -> usize {
        self.pins.iter().map(|(_, axes)| axes.iter().filter(|held| **held).count()).sum()
    }

    /// The first axis (0, 1, 2) along which the loads push the whole sheet and no vertex is pinned, and their sum: along
    /// it there is no equilibrium.
    pub fn unbalanced_axis(&self) -> Option<(usize, f64)> {
        let total: Vec3 = self.loads.iter().map(|(_, force)| force).sum();
        let largest = self.loads.iter().map(|(_, force)| force.amax()).fold(0.0, f64::max);
        let pinned = |axis: usize| self.pins.iter().any(|(_, axes)| axes[axis]);
        let axis = (0..3).find(|&axis| !pinned(axis) && total[axis].abs() > BALANCED * largest)?;
        Some((axis, total[axis]))
    }

    /// The same terms with every hinge at rest at these angles, one for each edge of the tiling, in radians.
    pub fn resting_at(&self, angles: &[f64]) -> Self {
        let mut terms = self.clone();
        for hinges in [&mut terms.creases, &mut terms.facets].into_iter().flatten() {
            hinges.rest = angles.to_vec();
        }
        terms
    }
}
