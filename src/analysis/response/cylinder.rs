//! The linear modes of a sheet that is rolled up to a cylinder.
//!
//! They are the null space of the bars and of the locked hinges in the coordinates of a screw (see
//! [`crate::model::Domain`]): the sheet stays a cylinder, and at a generic state there are two of them. Its curvature
//! tensor is `theta_a theta_b / kappa` in the components of the lattice, of rank one, with the curvature `kappa` of the
//! cylinder of vertex 0; a mode changes it.

use super::error::ResponseError;
use super::mode::{Field, LinearMode, RawTable};
use super::result::{LatticeMotions, Response};
use crate::analysis::state::cylinder;
use crate::kinematics::metric::LatticeFrame;
use crate::math::Vec3;
use crate::model::{Assembly, Domain, Gauge, Local, Model, ScrewTurns, Site, Terms};
use crate::numerics::dense;
use crate::solver::{HessianKind, Linearization, Problem};
use nalgebra::{DVector, Matrix2};
use std::f64::consts::TAU;

/// Computes the response of a rolled up state; `self_stresses` is left to be counted. `assembly` has rigid terms alone.
pub(super) fn response(assembly: &Assembly, coordinates: &[f64]) -> Result<Response, ResponseError> {
    let mut model = assembly.model(Gauge::Held);
    let x = model.start_from(coordinates.to_vec());
    let mut at = Linearization::new(model.layout());
    model.linearize(&x, &vec![0.0; model.layout().stiff.len()], HessianKind::GaussNewton, &mut at);
    let null = dense::null_space_of_rows(&at.rows(), model.layout().unknowns)?;
    let state = Rolled::new(assembly, model.coordinates(&x));
    let basis: Vec<LinearMode> =
        null.basis.column_iter().map(|rates| state.mode(model.velocity(rates.as_slice()))).collect();
    let raw = RawTable {
        strains: basis.iter().map(|mode| mode.strain).collect(),
        curvatures: basis.iter().map(|mode| mode.curvature).collect(),
        length: state.area().sqrt(),
    };
    let error = null.gap.recip();
    let amplitudes = raw.arranged(error)?.amplitudes;
    let mixed = |mix: DVector<f64>| state.mode(model.velocity((&null.basis * mix).as_slice()));
    let modes = amplitudes.column_iter().map(|mix| mixed(mix.into_owned())).collect();
    Ok(Response { modes, table: raw.ranks()?, lattice: state.lattice(), error, ..Response::default() })
}

/// A rolled up state.
struct Rolled<'a> {
    assembly: &'a Assembly,
    /// Coordinates of the state.
    coordinates: Vec<f64>,
    /// Hinges of all edges, which measure fold angles.
    hinges: Model,
    /// Chords from vertex 0 in the frame of the coordinates.
    chords: [Vec3; 2],
    /// The screw motions.
    turns: ScrewTurns,
    /// Translations of the two lattice vectors along and across the axis at height 0.
    steps: [[f64; 2]; 2],
}

impl<'a> Rolled<'a> {
    fn new(assembly: &'a Assembly, coordinates: Vec<f64>) -> Self {
        let hinges = hinges_of(assembly);
        let at = |shift| assembly.drawn().domain.point(&coordinates, Site { vertex: 0, shift });
        let chords = [[1, 0], [0, 1]].map(|shift| at(shift) - at([0, 0]));
        let shared = &coordinates[coordinates.len() - 6..];
        let (turns, steps) =
            (ScrewTurns::new(shared), [0, 1].map(|a| along_and_across(shared[0], [shared[4 + a], shared[2 + a]])));
        Self { assembly, coordinates, hinges, chords, turns, steps }
    }

    fn domain(&self) -> &Domain {
        &self.assembly.drawn().domain
    }

    fn area(&self) -> f64 {
        self.chords[0].cross(&self.chords[1]).norm()
    }

    /// Returns the mode with these rates of all coordinates.
    fn mode(&self, velocity: Vec<f64>) -> LinearMode {
        let at = |shift| self.domain().velocity(&self.coordinates, Site { vertex: 0, shift }, &velocity);
        let still = at([0, 0]);
        let chords = [[1, 0], [0, 1]].map(|shift| at(shift) - still);
        LinearMode {
            rates: self.fold_rates(&velocity),
            strain: LatticeFrame::new(&self.chords).strain_rate(&self.chords, &chords),
            curvature: self.curvature_rate(&velocity),
            lattice_rotations: self.lattice_rotations(&velocity),
            field: Field::OfCoordinates(velocity),
        }
    }

    /// Returns the rates of the fold angles of the cell's edges.
    fn fold_rates(&self, velocity: &[f64]) -> Vec<f64> {
        let mut rates = vec![0.0; self.assembly.sheet().edges.len()];
        let mut local = Local::default();
        let shared = &velocity[velocity.len() - self.domain().shared()..];
        for hinge in self.hinges.elements() {
            let Some(edge) = hinge.edge() else { continue };
            hinge.local(&self.coordinates, false, &mut local);
            let points = hinge.sites().iter().flat_map(|site| &velocity[3 * site.vertex..3 * site.vertex + 3]);
            let rate = points.chain(shared).zip(&local.gradient).map(|(v, g)| v * g).sum();
            rates[self.assembly.tiling().edges[edge].edge] = rate;
        }
        rates
    }

    /// Returns the rates of direction, curvature and of the steps along and across the axis.
    fn screw_rates(&self, velocity: &[f64]) -> ([f64; 2], [[f64; 2]; 2]) {
        let shared = &velocity[velocity.len() - 6..];
        let steps = [0, 1].map(|a| {
            let [along, across] = along_and_across(self.turns.direction, [shared[4 + a], shared[2 + a]]);
            let [h, b] = self.steps[a];
            [along + shared[0] * b, across - shared[0] * h]
        });
        ([shared[0], shared[1]], steps)
    }

    /// Returns the rate of the curvature tensor in the frame of the lattice as it lies on the cylinder of vertex 0. In
    /// the components of the lattice the tensor is `kappa (1 - kappa z) b_a b_b`, with the height `z` of vertex 0.
    fn curvature_rate(&self, velocity: &[f64]) -> [f64; 3] {
        let ([_, bending], rates) = self.screw_rates(velocity);
        let (kappa, height) = (self.turns.kappa, self.coordinates[2]);
        let (factor, factor_rate) = (kappa * (1.0 - kappa * height), (1.0 - 2.0 * kappa * height) * bending);
        let b = self.steps.map(|[_, b]| b);
        let rate =
            Matrix2::from_fn(|i, j| factor_rate * b[i] * b[j] + factor * (rates[i][1] * b[j] + b[i] * rates[j][1]));
        let flat = self.steps.map(|[h, b]| Vec3::new(h, b * (1.0 - kappa * height), 0.0));
        LatticeFrame::new(&flat).tensor(&rate)
    }

    /// Returns the angular velocities of the two lattice rotations, in the frame of the mesh file.
    fn lattice_rotations(&self, velocity: &[f64]) -> [Vec3; 2] {
        let ([turning, bending], rates) = self.screw_rates(velocity);
        let axis = self.turns.axis();
        let axis_rate = turning * Vec3::z().cross(&axis);
        [0, 1].map(|a| {
            let (sin, cos) = self.turns.theta[a].sin_cos();
            let theta_rate = bending * self.steps[a][1] + self.turns.kappa * rates[a][1];
            let omega = theta_rate * axis + sin * axis_rate + (1.0 - cos) * axis.cross(&axis_rate);
            self.assembly.drawn().frame.transpose() * omega
        })
    }

    fn lattice(&self) -> LatticeMotions {
        let drawn = self.assembly.drawn();
        let back = drawn.frame.transpose();
        let [curvature, theta1, theta2] = cylinder(drawn, &self.coordinates)
            .map_or([0.0; 3], |found| [found.curvature, found.theta[0], found.theta[1]]);
        let larger = usize::from(theta2.abs() > theta1.abs());
        let turned = (self.turns.theta[larger] / TAU).round() * TAU;
        let side = if self.turns.theta[larger] - turned < 0.0 { -1.0 } else { 1.0 };
        let axis = Some((back * self.turns.axis() * side).into());
        let chords = self.chords.map(|chord| (back * chord).into());
        LatticeMotions { chords, theta: [theta1, theta2], axis, curvature }
    }
}

/// Returns a model with a lock for every hinge, which measures fold angles.
pub(super) fn hinges_of(assembly: &Assembly) -> Model {
    let angles = assembly.drawn_angles().iter().copied().enumerate();
    let locks = angles.filter(|(_, angle)| !angle.is_nan()).collect();
    assembly.with_terms(Terms { locks, ..Terms::default() }).model(Gauge::Free)
}

/// Returns the components of a vector `[x, y]` along and across an axis at an angle from x.
fn along_and_across(direction: f64, [x, y]: [f64; 2]) -> [f64; 2] {
    let (sin, cos) = direction.sin_cos();
    [cos * x + sin * y, cos * y - sin * x]
}
