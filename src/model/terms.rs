//! The terms of a sheet: stiffnesses, rest angles, locks, pins, loads and mass.

use super::assembly_error::AssemblyError;
use super::law::Laws;
use super::mass::Mass;
use super::own_term::{MEMBRANE, OwnTerm};
use super::stiffness::Stiffness;
use crate::math::Vec3;
use std::collections::BTreeSet;

/// The stiffness of a term that is exactly rigid: infinity.
pub const RIGID: f64 = f64::INFINITY;

/// Stiffness and rest lengths of the bars.
#[derive(Clone, Debug, PartialEq)]
pub struct Bars {
    /// `EA`, a force; infinite for rigid bars. The spring constant is `EA / L0` with the rest length `L0`.
    pub stiffness: Stiffness,
    /// Lengths without force.
    pub rest: RestLengths,
}

/// The rest lengths of the bars.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum RestLengths {
    /// The drawn lengths.
    #[default]
    Drawn,
    /// The drawn lengths times a factor: every bar is to be this much longer.
    Factor(f64),
    /// One length for each edge of the tiling.
    PerEdge(Vec<f64>),
}

impl RestLengths {
    /// Returns the rest length of the bar at an edge with this drawn length.
    pub fn of(&self, edge: usize, drawn: f64) -> f64 {
        match self {
            Self::Drawn => drawn,
            Self::Factor(factor) => factor * drawn,
            Self::PerEdge(lengths) => lengths[edge],
        }
    }
}

impl<S: Into<Stiffness>> From<S> for Bars {
    fn from(stiffness: S) -> Self {
        Self { stiffness: stiffness.into(), rest: RestLengths::Drawn }
    }
}

/// Stiffness and rest angles of the creases, or of the facets.
#[derive(Clone, Debug, PartialEq)]
pub struct Hinges {
    /// Torque per radian and unit length; infinite for rigid hinges.
    pub stiffness: Stiffness,
    /// Rest angle of every edge of the tiling, in radians; only those of hinges of this kind are used.
    pub rest: Vec<f64>,
}

/// Vertices of a patch that move as one rigid body, and the motions that the body keeps.
///
/// The body turns about the centroid of its vertices in the drawn state. Its rotation is described by the rotation
/// vector from the drawn state, of which components that are not free stay zero.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Numbers of the tiling's vertices that belong to the part.
    pub vertices: Vec<usize>,
    /// Whether the part can move along x, y, z and turn about x, y, z.
    pub free: [bool; 6],
}

/// The terms of the energy of a sheet, the locks, pins and loads on it, and its mass. `None` means that the term is not
/// built.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Terms {
    /// The bars, one along every edge.
    pub bars: Option<Bars>,
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
    /// Numbers of the tiling's vertices that keep their coordinate along a direction, and that direction, a unit
    /// vector: rollers, and vertices in a plane of symmetry.
    pub guides: Vec<(usize, Vec3)>,
    /// Vertices that move as rigid bodies; a vertex belongs to one part at most.
    pub parts: Vec<Part>,
    /// The mass of the sheet, which gives frequencies; its weight is a load.
    pub mass: Option<Mass>,
    /// Laws of bars, creases and facets other than that of a spring.
    pub laws: Laws,
    /// Terms of one's own, the pressure on faces, and torques on parts.
    pub own: Vec<OwnTerm>,
}

impl Terms {
    /// Makes terms of bars of stiffness `EA` and of creases, whose stiffness is a torque per radian and length and
    /// whose rest angles are one for each edge of the tiling, in radians.
    pub fn bars_and_creases(bars: f64, creases: f64, rest: Vec<f64>) -> Self {
        let creases = Hinges { stiffness: creases.into(), rest };
        Self { bars: Some(bars.into()), creases: Some(creases), ..Self::default() }
    }

    /// Checks that no law lets a rigid element be slack.
    pub(super) fn check_laws(&self) -> Result<(), AssemblyError> {
        let [creases, facets] = [&self.creases, &self.facets].map(|given| given.as_ref().map(|given| &given.stiffness));
        for ((term, law), stiffness) in self.laws.all().into_iter().zip([self.bar_stiffness(), creases, facets]) {
            if let (Some(law), Some(stiffness)) = (law, stiffness)
                && law.slackens_rigid(stiffness)
            {
                return Err(AssemblyError::RigidSlack { term });
            }
        }
        Ok(())
    }

    /// Whether all bars and facets of the terms are rigid; also true if there are none.
    pub fn is_rigid(&self) -> bool {
        let [bars, facets] = [self.bar_stiffness(), self.facets.as_ref().map(|facets| &facets.stiffness)];
        [bars, facets].into_iter().flatten().all(Stiffness::is_rigid)
    }

    /// Returns the stiffness of the bars; `None` if there are none.
    pub fn bar_stiffness(&self) -> Option<&Stiffness> {
        self.bars.as_ref().map(|bars| &bars.stiffness)
    }

    /// Whether there are bars and all of them are rigid.
    pub fn has_rigid_bars(&self) -> bool {
        self.bar_stiffness().is_some_and(Stiffness::is_rigid)
    }

    /// Whether any facet is rigid, so that a polygon keeps its shape along it.
    pub fn has_rigid_facets(&self) -> bool {
        self.facets.as_ref().is_some_and(|facets| facets.stiffness.has_rigid())
    }

    /// Returns the name of the first term whose elements have different stiffness; `None` if each term has one.
    pub fn uneven_term(&self) -> Option<&'static str> {
        let hinges =
            |hinges: &Option<Hinges>| hinges.as_ref().is_some_and(|hinges| hinges.stiffness.uniform().is_none());
        let bars = self.bar_stiffness().is_some_and(|bars| bars.uniform().is_none());
        let terms = [("bars", bars), ("creases", hinges(&self.creases)), ("facets", hinges(&self.facets))];
        terms.into_iter().find(|(_, uneven)| *uneven).map(|(term, _)| term)
    }

    /// Returns the names of the terms of one's own, in the order in which tables and summaries list them.
    pub fn own_names(&self) -> BTreeSet<&str> {
        self.own.iter().filter(|term| !term.is_load()).map(OwnTerm::name).collect()
    }

    /// Returns the name of the first term that is not made of linear springs along edges: one with a law, or one of
    /// one's own; `None` if there is none.
    pub fn first_not_linear(&self) -> Option<&str> {
        self.laws.first().or_else(|| self.own.first().map(OwnTerm::name))
    }

    /// Whether there are loads, forces or pressures that are not zero.
    pub fn is_loaded(&self) -> bool {
        let acts = |term: &OwnTerm| term.is_load() && term.springs.iter().any(|spring| spring.stiffness != 0.0);
        !self.loads.is_empty() || self.own.iter().any(acts)
    }

    /// Returns the same terms without loads.
    pub fn unloaded(&self) -> Self {
        let own = self.own.iter().filter(|term| !term.is_load()).cloned().collect();
        Self { loads: vec![], own, ..self.clone() }
    }

    /// Returns the same terms with no bar stiffer than this `EA` (a force): softer ones keep their stiffness, and all
    /// their rest lengths. Such bars take the place of membranes.
    pub fn with_bars_at_most(&self, stiffness: f64) -> Self {
        let mut terms = self.clone();
        if self.has_membranes() {
            terms.own.retain(|term| term.name() != MEMBRANE);
            terms.bars.get_or_insert(stiffness.into());
        }
        if let Some(bars) = &mut terms.bars {
            bars.stiffness = bars.stiffness.at_most(stiffness);
        }
        terms
    }

    /// Whether triangles are stretched and sheared as [membranes](OwnTerm::membrane).
    pub fn has_membranes(&self) -> bool {
        self.own.iter().any(|term| term.name() == MEMBRANE)
    }

    /// Whether there is any bar, crease, facet that is not rigid, lock or load. Rigid facets, pins and mass give no
    /// energy.
    pub fn has_energy(&self) -> bool {
        let Self { bars, creases, facets, locks, loads, pins: _, guides: _, parts: _, mass: _, laws: _, own } = self;
        !own.is_empty()
            || bars.is_some()
            || creases.is_some()
            || facets.as_ref().is_some_and(|facets| !facets.stiffness.is_rigid())
            || !locks.is_empty()
            || !loads.is_empty()
    }

    /// Returns the number of coordinates that pins hold.
    pub fn pinned(&self) -> usize {
        self.pins.iter().map(|(_, axes)| axes.iter().filter(|held| **held).count()).sum()
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
