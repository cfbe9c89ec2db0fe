//! Whether loads balance on the pieces of a sheet that nothing supports along them.

use super::assembly::Assembly;
use super::assembly_error::AssemblyError;
use super::problem::Gauge;
use crate::math::Vec3;

/// Part of the largest load up to which the sum of loads is rounding error.
const BALANCED: f64 = 1e-12;
/// Length of what a unit vector has across others below which it depends on them.
const SAME_DIRECTION: f64 = 1e-9;

impl Assembly {
    /// Checks that the loads on every connected piece balance along each direction in which it is free: otherwise there is
    /// no equilibrium. Pins, guides and parts that are held along an axis support loads, and so do `driven` vertices along
    /// unit vectors.
    ///
    /// # Errors
    /// [`AssemblyError::Unbalanced`] with the axis along which most of the loads on a piece is neither balanced nor
    /// supported, and their sum along it.
    pub fn check_balance(&self, driven: &[(usize, Vec3)]) -> Result<(), AssemblyError> {
        let terms = self.terms();
        if terms.loads.is_empty() {
            return Ok(());
        }
        let pieces = self.model(Gauge::Held).pieces_of_vertices();
        let mut piece_of = vec![0; self.tiling().positions.len()];
        pieces
            .iter()
            .enumerate()
            .for_each(|(number, piece)| piece.iter().for_each(|&vertex| piece_of[vertex] = number));
        let along = |vertex: usize, held: [bool; 3]| {
            (0..3).filter(move |axis| held[*axis]).map(move |axis| (vertex, Vec3::ith(axis, 1.0)))
        };
        let parts =
            terms.parts.iter().filter_map(|part| Some((*part.vertices.first()?, [0, 1, 2].map(|k| !part.free[k]))));
        let held = terms.pins.iter().copied().chain(parts).flat_map(|(vertex, held)| along(vertex, held));
        let supports = held.chain(terms.guides.iter().copied()).chain(driven.iter().copied());
        let mut left = vec![Vec3::zeros(); pieces.len()];
        terms.loads.iter().for_each(|(vertex, force)| left[piece_of[*vertex]] += force);
        let mut supported: Vec<Vec<Vec3>> = vec![vec![]; pieces.len()];
        for (vertex, direction) in supports {
            let (left, supported) = (&mut left[piece_of[vertex]], &mut supported[piece_of[vertex]]);
            let own = supported.iter().fold(direction, |own, other| own - other * other.dot(&own));
            let Some(own) = own.try_normalize(SAME_DIRECTION) else { continue };
            *left -= own * own.dot(left);
            supported.push(own);
        }
        let most = (0..pieces.len()).max_by(|a, b| left[*a].amax().total_cmp(&left[*b].amax())).unwrap_or_default();
        let (axis, largest) =
            (left[most].iamax(), terms.loads.iter().map(|(_, force)| force.amax()).fold(0.0, f64::max));
        let force = left[most][axis];
        if force.abs() <= BALANCED * largest {
            return Ok(());
        }
        let piece = pieces[most].first().copied().filter(|_| pieces.len() > 1);
        Err(AssemblyError::Unbalanced { piece, axis, force })
    }
}
