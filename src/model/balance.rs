//! Whether loads balance on the pieces of a sheet that nothing supports along them, and terms of one's own keep their energy
//! where such a piece moves as a whole.

use super::assembly::Assembly;
use super::assembly_error::AssemblyError;
use super::domain::Domain;
use super::element::Local;
use super::own_term::OwnTerm;
use super::problem::Gauge;
use crate::math::Vec3;
use crate::numerics::random::numbers;
use nalgebra::SVector;

/// Largest component of the sum of the loads on a piece, relative to the largest of any load, that counts as balanced.
const BALANCED: f64 = 1e-12;
/// Part of a direction that is not among others, relative to its length, below which it counts as one of them.
const SAME_DIRECTION: f64 = 1e-9;
/// Sum of the forces and moments of an element, relative to its forces, below which they balance: functions of a user's own
/// may round to single precision.
const OWN_BALANCED: f64 = 1e-5;
/// How far vertices are moved, in mean edges, to ask for forces: a symmetric state may hide some.
const MOVED: f64 = 0.05;
/// Seed of the directions in which they are moved.
const SEED: u64 = 1;

/// A motion of a piece as a whole, or what acts along it: a translation, then a rotation.
type Motion = SVector<f64, 6>;

impl Assembly {
    /// Checks that the loads on every connected piece balance along each direction in which it is free: otherwise there is
    /// no equilibrium. Pins, guides and parts that are held along an axis support loads, and so do `driven` vertices along
    /// unit vectors.
    ///
    /// # Errors
    /// [`AssemblyError::Unbalanced`] for the first piece on which loads are neither balanced nor supported, with the axis
    /// along which most of them is left.
    pub fn check_balance(&self, driven: &[(usize, Vec3)]) -> Result<(), AssemblyError> {
        let terms = self.terms();
        if terms.loads.is_empty() {
            return Ok(());
        }
        let supports = self.supports(driven);
        let largest = terms.loads.iter().map(|(_, force)| force.amax()).fold(0.0, f64::max);
        let pieces = self.model(Gauge::Held).vertices_of_pieces();
        for piece in &pieces {
            let here = |vertex: &usize| piece.binary_search(vertex).is_ok();
            let load: Vec3 = terms.loads.iter().filter(|(vertex, _)| here(vertex)).map(|(_, force)| force).sum();
            let directions = supports.iter().filter(|(vertex, _)| here(vertex)).map(|(_, direction)| *direction);
            let left = across(load, directions);
            let (axis, piece) = (left.iamax(), piece.first().copied().filter(|_| pieces.len() > 1));
            if left[axis].abs() > BALANCED * largest {
                return Err(AssemblyError::Unbalanced { piece, axis, force: left[axis] });
            }
        }
        Ok(())
    }

    /// Checks that the energy of every term of one's own stays the same where the piece of the sheet on which it acts moves
    /// as a rigid body, along each motion that nothing supports: coordinates are held against such motions, and would carry
    /// its forces unseen. Supports are those of [`check_balance`](Assembly::check_balance); only patches are asked.
    ///
    /// # Errors
    /// [`AssemblyError::Moving`] for the first term that has another energy there.
    pub fn check_own_terms(&self, driven: &[(usize, Vec3)]) -> Result<(), AssemblyError> {
        if self.terms().own.iter().all(OwnTerm::is_load) || *self.domain() != Domain::Patch {
            return Ok(());
        }
        let supports = self.supports(driven);
        let pieces = self.model(Gauge::Held).vertices_of_pieces();
        let far = MOVED * self.mean_edge();
        let x: Vec<f64> =
            self.drawn().coordinates.iter().zip(numbers(SEED)).map(|(x, number)| x + far * number).collect();
        let own = self.terms().own.iter().filter(|own| !own.is_load());
        for (own, k) in own.flat_map(|own| (0..own.elements.len()).map(move |k| (own, k))) {
            let is_on = |piece: &&Vec<usize>| piece.binary_search(&own.elements.sites(k)[0].vertex).is_ok();
            let piece = pieces.iter().find(is_on).map_or(&[][..], Vec::as_slice);
            if let Some(motion) = self.changes_along(own, k, &x, (piece, &supports)) {
                return Err(AssemblyError::Moving { term: own.name().to_owned(), motion });
            }
        }
        Ok(())
    }

    /// The motion of a piece along which the energy of an element changes most and nothing supports the piece: 0 to 2 for a
    /// translation, 3 to 5 for a rotation; `None` if it stays the same along all.
    fn changes_along(
        &self,
        own: &OwnTerm,
        element: usize,
        x: &[f64],
        (piece, supports): (&[usize], &[(usize, Vec3)]),
    ) -> Option<usize> {
        let (mut local, sites) = (Local::default(), own.elements.sites(element));
        own.elements.local(element, self.domain(), x, false, &mut local);
        let place = |vertex: usize| Vec3::from_column_slice(&x[3 * vertex..][..3]);
        let motion = |vertex: usize, along: Vec3| -> Motion {
            let moment = (place(vertex) - place(sites[0].vertex)).cross(&along) / self.mean_edge();
            Motion::from_fn(|k, _| if k < 3 { along[k] } else { moment[k - 3] })
        };
        let forces = sites.iter().zip(local.gradient.chunks_exact(3).map(Vec3::from_column_slice));
        let forces: Vec<Motion> = forces.map(|(site, force)| motion(site.vertex, force)).collect();
        let largest = forces.iter().map(Motion::amax).fold(0.0, f64::max);
        let here = |vertex: &usize| piece.binary_search(vertex).is_ok();
        let turning = self.terms().parts.iter().filter(|part| part.vertices.iter().any(here));
        let held = turning.flat_map(|part| (3..6).filter(|k| !part.free[*k]).map(|k| Motion::ith(k, 1.0)));
        let along = supports.iter().filter(|(vertex, _)| here(vertex)).map(|(vertex, along)| motion(*vertex, *along));
        let left = across(forces.into_iter().sum(), along.chain(held));
        (left.amax() > OWN_BALANCED * largest).then(|| left.iamax())
    }

    /// The vertices that pins, guides, held parts and these drives support, each along a direction.
    fn supports(&self, driven: &[(usize, Vec3)]) -> Vec<(usize, Vec3)> {
        let terms = self.terms();
        let along = |vertex: usize, held: [bool; 3]| {
            (0..3).filter(move |axis| held[*axis]).map(move |axis| (vertex, Vec3::ith(axis, 1.0)))
        };
        let parts =
            terms.parts.iter().filter_map(|part| Some((*part.vertices.first()?, [0, 1, 2].map(|k| !part.free[k]))));
        let held = terms.pins.iter().copied().chain(parts).flat_map(|(vertex, held)| along(vertex, held));
        held.chain(terms.guides.iter().copied()).chain(driven.iter().copied()).collect()
    }
}

/// The part of a force that is across all of these directions, which may depend on each other.
fn across<const N: usize>(
    mut force: SVector<f64, N>,
    directions: impl Iterator<Item = SVector<f64, N>>,
) -> SVector<f64, N> {
    let mut known: Vec<SVector<f64, N>> = Vec::new();
    for direction in directions {
        let own = known.iter().fold(direction, |own, other| own - other * other.dot(&own));
        let Some(own) = own.try_normalize(SAME_DIRECTION * direction.norm()) else { continue };
        force -= own * own.dot(&force);
        known.push(own);
    }
    force
}
