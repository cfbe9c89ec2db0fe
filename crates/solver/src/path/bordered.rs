//! The bordered linear system of a path: Newton's system with the parameter as one more unknown, and one more equation.
//!
//! `[ H   R^T  g ] [dx]   [a]`
//! `[ R   -C   m ] [dt] = [b]`
//! `[ n^T  0   p ] [dl]   [s]`
//!
//! Here `g` and `m` are the rates by the parameter `l`, and `(n, p)` is the normal of a plane. The system is regular
//! where Newton's own is singular with a simple null space that the border meets: at limit points. It is solved by
//! elimination of the parameter with the factorization of Newton's system, and conjugate residuals of the bordered
//! system take back what that loses where Newton's system is nearly singular. The parameter is counted in units in
//! which its scale is the unit of length. Next to a branch point there may be more unknowns, forces along given
//! directions, and as many more planes.

use super::problem::{ParametrizedProblem, Rates};
use crate::corrections::{self, IMPATIENT, NearlySolved, Pair};
use crate::kkt::{divided, multiplied, stiffness_size};
use crate::linearization::HessianKind;
use crate::tangent::Tangent;
use foldwell_numerics::DenseMatrix;
use foldwell_numerics::dense::small::solve_square;
use foldwell_numerics::factor::{FactorError, Inertia};
use foldwell_numerics::random::numbers;
use foldwell_numerics::sparse::symmetric_product;
use foldwell_numerics::vector::{add_scaled, dot, max_abs, moved, norm_blocked};

/// Relative residual to which bordered systems are solved, and the one above which a solution is not used.
const WANTED_RESIDUAL: f64 = 1e-12;
pub(super) const REFUSED_RESIDUAL: f64 = 1e-3;
/// Part of the tensions above which what balances no force is a self stress, and not rounding.
const SELF_STRESS: f64 = 1e-6;
/// Part of the largest force up to which tensions are rounding errors.
const NO_FORCE: f64 = 1e-14;
/// Seed of the random part of tensions with which a self stress is sought.
const SEED: u64 = 1;
/// Shift of the Hessian where a pivot of the factorization without shift vanishes.
const SINGULAR_SHIFT: f64 = 1e-6;
/// Pivots up to this, relative to the largest one, are rounding errors of zero, as of motions that cost nothing.
const ZERO_PIVOT: f64 = 1e-15;
/// Rounds of inverse iteration.
const SOFTEST_ROUNDS: usize = 5;
/// Rate of a quantity, relative to that of a motion of unit arc length along all of the rates by the parameter, that is
/// an error of the linear system from which tangents come.
const RATE_ERROR: f64 = 1e-11;

/// A plane in the space of unknowns and parameter: its normal, the parameter's part in units of length.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Hyperplane {
    pub x: Vec<f64>,
    pub parameter: f64,
}

/// The bordered system at one state.
pub(super) struct Bordered {
    /// The problem linearized at the state, and its factorization.
    pub tangent: Tangent,
    rates: [Vec<f64>; 2],
    /// Length of a change of all unknowns by their natural size: arc lengths are in this unit.
    pub length: f64,
    /// One unit of length of the parameter.
    pub unit: f64,
    /// Inertia of the last factorization; `None` where it needed a shift, or has a pivot that may be zero.
    inertia: Option<Inertia>,
    /// Response to the rates by the parameter, by the last factorization.
    response: Pair,
}

impl Bordered {
    /// Makes room for the systems of a problem.
    pub fn new<P: ParametrizedProblem>(problem: &P) -> Result<Self, FactorError> {
        let layout = problem.layout();
        let length = problem.unit_of_length() * (layout.unknowns.max(1) as f64).sqrt();
        Ok(Self {
            tangent: Tangent::new(problem)?,
            rates: [vec![], vec![]],
            length,
            unit: problem.parameter_scale() / length,
            inertia: None,
            response: Pair(vec![], vec![]),
        })
    }

    /// Linearizes at a state, with the problem's present parameter.
    pub fn linearize<P: ParametrizedProblem>(&mut self, problem: &P, x: &[f64], tension: &[f64]) {
        problem.linearize(x, tension, HessianKind::Full, &mut self.tangent.at);
        self.tangent.compliance = problem.compliance().to_vec();
        self.rates = problem.parameter_rates(&self.tangent.at, x, tension).map(|rates| scaled(rates, self.unit));
    }

    /// Factors Newton's system where it was linearized, shifted a little where it is singular.
    pub fn factor(&mut self) -> Result<(), FactorError> {
        let found = self.tangent.factor(0.0);
        self.inertia = match found {
            Ok(inertia) => Some(inertia).filter(|inertia| inertia.ratio > ZERO_PIVOT),
            Err(FactorError::Singular { .. }) => {
                self.tangent.factor(SINGULAR_SHIFT)?;
                None
            }
            Err(error) => return Err(error),
        };
        let [force, gap] = &self.rates;
        let (dx, dt) = self.tangent.system.apply(force, gap);
        self.response = Pair(dx, dt);
        Ok(())
    }

    /// Number of negative eigenvalues of the Hessian at fixed parameter, on what the rigid measures leave free; `None`
    /// where it cannot be established.
    pub fn negative_eigenvalues(&mut self) -> Result<Option<usize>, FactorError> {
        match self.inertia {
            Some(inertia) if inertia.negative == 0 || self.tangent.system.weights_are_exact() => {
                Ok(Some(inertia.negative))
            }
            // nothing stores energy
            _ if max_abs(&self.tangent.at.hessian) == 0.0 => Ok(Some(0)),
            _ => {
                let counted = self.tangent.negative_eigenvalues()?;
                self.factor()?;
                Ok(counted)
            }
        }
    }

    /// Work of the rates by the parameter along a tangent. Where the parameter turns, the eigenvalue that passes zero
    /// has the sign of the negative product of this work and the tangent's parameter: `t^T K t = -(g.t) t_l`.
    pub fn work_along(&self, tangent: &Rates) -> f64 {
        let [force, gap] = &self.rates;
        (dot(force, &tangent.x) + dot(gap, &tangent.tension)) / self.unit
    }

    /// The largest rates that are errors of tangents of unit arc length: of the parameter, and of its conjugate.
    pub fn rate_errors(&self) -> [f64; 2] {
        let [force, gap] = &self.rates;
        let stiffness = stiffness_size(&self.tangent.at, &self.tangent.compliance);
        let pull = norm_blocked(&divided(gap, &self.tangent.at.sizes)) * stiffness + norm_blocked(force);
        [RATE_ERROR * self.unit * self.length, RATE_ERROR * self.length * pull / self.unit]
    }

    /// Solves for a force on every unknown, a stretch of every measure and a distance from the plane. Returns the
    /// changes, and the relative residual.
    pub fn solve(&mut self, force: &[f64], stretch: &[f64], distance: f64, plane: &Hyperplane) -> (Rates, f64) {
        let planes = Planes { planes: &[plane], distances: &[distance], pulls: &[] };
        let (rates, _, residual) = self.solve_across(force, stretch, &planes);
        (rates, residual)
    }

    /// Solves as [`Bordered::solve`] does with several planes. Returns the changes, the pulls times a length, and the
    /// relative residual.
    pub fn solve_across(&mut self, force: &[f64], stretch: &[f64], planes: &Planes<'_>) -> (Rates, Vec<f64>, f64) {
        let stiffness = stiffness_size(&self.tangent.at, &self.tangent.compliance);
        let mut forces = force.to_vec();
        forces.extend(planes.distances.iter().map(|distance| stiffness * distance));
        let right = Pair(forces, divided(stretch, &self.tangent.at.sizes));
        let mut responses = vec![self.response.clone()];
        for pull in planes.pulls {
            let (dx, dt) = self.tangent.system.apply(pull, &vec![0.0; stretch.len()]);
            responses.push(Pair(scaled(dx, stiffness), scaled(dt, stiffness)));
        }
        let mut equations = BorderedSystem { bordered: self, planes, responses, stiffness };
        let found = equations.solve(&right);
        let pull = equations.bordered.pull(&found.1);
        let units = [
            norm_blocked(&right.0).max(1e-9 * pull),
            norm_blocked(&right.1).max(1e-6 * norm_blocked(&found.0)).max(f64::MIN_POSITIVE),
        ];
        let refined = corrections::correct(&mut equations, &right, found, units, (WANTED_RESIDUAL, IMPATIENT));
        let Pair(mut x, tension) = refined.found;
        let more = x.split_off(force.len());
        let tension = divided(&tension, &self.tangent.at.sizes);
        let pulls = scaled(more[1..].to_vec(), stiffness);
        (Rates { x, tension, parameter: more[0] * self.unit }, pulls, refined.residual)
    }

    /// Whether forces balance with other tensions too, so that rigid measures have a self stress: with those that the
    /// system finds when it begins with a part of these, taken at random.
    pub fn has_self_stress(&mut self, tension: &[f64]) -> bool {
        let others: Vec<f64> = tension.iter().zip(numbers(SEED)).map(|(tension, number)| tension * number).collect();
        let (force, missing) =
            (self.tangent.at.force(&others), self.tangent.at.missing(&others, &self.tangent.compliance));
        let found = moved(&others, 1.0, &self.tangent.solve(&force, &missing, WANTED_RESIDUAL).dt);
        norm_blocked(&moved(&found, -1.0, tension)) > SELF_STRESS * norm_blocked(tension)
    }

    /// Whether all tensions are rounding errors beside the largest force, as where nothing pulls.
    pub fn is_unstressed(&self, tension: &[f64]) -> bool {
        self.pull(&multiplied(tension, &self.tangent.at.sizes)) <= NO_FORCE * self.tangent.at.largest_force
    }

    /// The softest motion in a plane, and across the motions in `others`, by inverse iteration from `guess`: rates whose
    /// part of the unknowns has length 1, and its stiffness. Where the system is singular it is a null vector. Across a
    /// path only branch points have one: where the parameter turns, the motion without stiffness is the path's own.
    pub fn softest(&mut self, guess: &[f64], plane: &Hyperplane, others: &[Rates]) -> (Rates, f64) {
        let nothing = vec![0.0; self.tangent.compliance.len()];
        let mut found = Rates { x: guess.to_vec(), tension: nothing.clone(), parameter: 0.0 };
        let mut stiffness = f64::NAN;
        for _ in 0..SOFTEST_ROUNDS {
            let (answer, _) = self.solve(&found.x, &nothing, 0.0, plane);
            stiffness = dot(&answer.x, &found.x) / dot(&answer.x, &answer.x);
            found = answer;
            for other in others {
                let part = dot(&found.x, &other.x);
                found.add(-part, other);
            }
            let per_length = 1.0 / norm_blocked(&found.x).max(f64::MIN_POSITIVE);
            found = found.scaled(per_length);
        }
        (found, stiffness)
    }

    /// The scaled force that rounding of unknowns of this size makes: a last place of them times the largest stiffness
    /// that is not infinite. It is large only where nearly all forces vanish.
    pub fn rounding_force(&self, size: f64) -> f64 {
        let finite = self.tangent.compliance.iter().enumerate().filter(|(_, c)| **c > 0.0);
        let stiffest = finite.map(|(row, c)| max_abs(self.tangent.at.stiff_gradient(row)).powi(2) / c);
        let stiffest = stiffest.fold(self.tangent.at.pattern().largest_diagonal(&self.tangent.at.hessian), f64::max);
        f64::EPSILON * size * stiffest / self.tangent.at.largest_force
    }

    /// Norm of the forces of these tensions, in units of force, before they balance.
    fn pull(&self, tensions: &[f64]) -> f64 {
        let largest = |row: usize| max_abs(self.tangent.at.stiff_gradient(row)) / self.tangent.at.sizes[row];
        tensions.iter().enumerate().map(|(row, t)| (t * largest(row)).powi(2)).sum::<f64>().sqrt()
    }
}

fn scaled(mut values: Vec<f64>, factor: f64) -> Vec<f64> {
    values.iter_mut().for_each(|v| *v *= factor);
    values
}

/// The equations of a bordered system beyond Newton's own: distances from planes; and its unknowns beyond the
/// parameter, forces along given directions, one less than planes.
pub(super) struct Planes<'a> {
    pub planes: &'a [&'a Hyperplane],
    pub distances: &'a [f64],
    pub pulls: &'a [Vec<f64>],
}

/// The bordered system and its elimination. Stretches and tensions are scaled as in [`KktSystem`]; the parameter and
/// the pulls, divided by a stiffness so that they are lengths, are the last unknowns, and the equations of the planes
/// are multiplied by that stiffness, so that they are forces.
struct BorderedSystem<'a> {
    bordered: &'a mut Bordered,
    planes: &'a Planes<'a>,
    /// Response to the rates by the parameter and to each pull.
    responses: Vec<Pair>,
    stiffness: f64,
}

impl BorderedSystem<'_> {
    /// Distance from a plane that a unit of the parameter makes (number 0), or of a pull (others).
    fn corner(plane: &Hyperplane, number: usize) -> f64 {
        if number == 0 { plane.parameter } else { 0.0 }
    }
}

impl NearlySolved for BorderedSystem<'_> {
    fn product(&self, Pair(x, t): &Pair) -> Pair {
        let Bordered { tangent: Tangent { at, compliance, .. }, rates: [force, gap], .. } = &*self.bordered;
        let (dx, more) = x.split_at(force.len());
        let dt = divided(t, &at.sizes);
        let (mut a, mut b) = (vec![0.0; dx.len()], vec![0.0; dt.len()]);
        let rows = at.rows();
        symmetric_product(at.pattern(), &at.hessian, dx, &mut a);
        rows.add_transpose_product(&dt, &mut a);
        rows.product(dx, &mut b);
        add_scaled(&mut a, more[0], force);
        for (pull, along) in more[1..].iter().zip(self.planes.pulls) {
            add_scaled(&mut a, self.stiffness * pull, along);
        }
        for (k, b) in b.iter_mut().enumerate() {
            *b = (*b - compliance[k] * dt[k] + more[0] * gap[k]) / at.sizes[k];
        }
        let off = |plane: &&Hyperplane| self.stiffness * (dot(&plane.x, dx) + plane.parameter * more[0]);
        a.extend(self.planes.planes.iter().map(off));
        Pair(a, b)
    }

    fn solve(&mut self, Pair(a, b): &Pair) -> Pair {
        let sizes = self.bordered.tangent.at.sizes.clone();
        let planes = self.planes.planes;
        let (force, distances) = a.split_at(a.len() - planes.len());
        let (mut dx, mut dt) = self.bordered.tangent.system.apply(force, &multiplied(b, &sizes));
        let left = DenseMatrix::from_fn(planes.len(), planes.len(), |row, column| {
            dot(&planes[row].x, &self.responses[column].0) - Self::corner(planes[row], column)
        });
        let right =
            DenseMatrix::from_fn(planes.len(), 1, |row, _| dot(&planes[row].x, &dx) - distances[row] / self.stiffness);
        let more = solve_square(left, &right).unwrap_or(right.map(|_| f64::NAN));
        for (part, Pair(by_x, by_t)) in more.iter().zip(&self.responses) {
            add_scaled(&mut dx, -part, by_x);
            add_scaled(&mut dt, -part, by_t);
        }
        dx.extend(more.iter());
        Pair(dx, multiplied(&dt, &sizes))
    }

    fn most_slow(&self) -> usize {
        self.bordered.tangent.system.most_slow()
    }
}
