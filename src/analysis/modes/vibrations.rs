//! Small vibrations about a state: the eigenvalues of the energy's Hessian `H` against the masses `M` of the vertices.
//!
//! `H u = omega^2 M u`. `M` is diagonal but for the motions of a rigid part, which are coupled where its middle is not its
//! centre of mass or the axes of its turns are not principal ones. With `u = M^(-1/2) y` the eigenvalues are those of the
//! symmetric matrix `M^(-1/2) H M^(-1/2)`. Masses enter relative to the largest one: multiplying all of them by a number divides
//! every `omega^2` by it and changes nothing else.

use super::error::ModesError;
use super::spectrum::{Coupling, Observer, Spectrum, lowest};
use crate::model::{Assembly, Domain, Model};
use crate::numerics::DenseMatrix;
use crate::numerics::dense::small::{CholeskyFactor, cholesky, inverse};

/// Largest product of two motions of a rigid part with the mass, over those of each with itself, that is rounding error.
const COUPLED: f64 = 1e-12;

/// The slowest vibrations of a sheet about a state.
#[derive(Clone, Debug, PartialEq)]
pub struct Vibrations {
    /// Squares of the angular frequencies, ascending, in stiffness over mass; negative where the motion grows. Those of
    /// at most `rounding` in magnitude are exactly 0.
    pub squares: Vec<f64>,
    /// Bound on the rounding error of a square: `4 sqrt(n) epsilon d`, with `n` unknowns, the machine epsilon, and the
    /// largest diagonal entry `d` of `M^(-1/2) H M^(-1/2)`.
    pub rounding: f64,
    /// Velocities `u` of all coordinates, one list for each square, with `u^T M u = 1`.
    pub vectors: Vec<Vec<f64>>,
}

impl Vibrations {
    /// Returns the angular frequencies, in radians per time; `None` for motions that grow.
    ///
    /// ```
    /// use foldwell::analysis::modes::modes;
    /// use foldwell::model::Mass;
    /// use foldwell::{Assembly, Pattern, generate};
    ///
    /// let sheet = generate(&Pattern::named("miura")?)?;
    /// let assembly = Assembly::patch(sheet, [2, 2]).bars(1e3).creases(1.0).facets(10.0).mass(Mass::Area(0.1)).build()?;
    /// let found = modes(&assembly, 7, &mut || true)?.vibrations.expect("the sheet has a mass");
    /// assert_eq!(found.frequencies()[..6], [Some(0.0); 6]); // rigid motions
    /// assert!(found.frequencies()[6] > Some(0.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn frequencies(&self) -> Vec<Option<f64>> {
        self.squares.iter().map(|&square| (square >= 0.0).then(|| square.sqrt())).collect()
    }

    /// Returns the rates, per time, at which motions grow as `exp(rate t)`; `None` for motions that do not.
    pub fn growth_rates(&self) -> Vec<Option<f64>> {
        self.squares.iter().map(|&square| (square < 0.0).then(|| (-square).sqrt())).collect()
    }

    /// Finds the slowest vibrations of a model at its reference state with these tensions; `None` if the sheet has no
    /// mass.
    pub(super) fn lowest(
        assembly: &Assembly,
        (model, tension): (&Model, &[f64]),
        (wanted, free): (usize, usize),
        observe: &mut Observer<'_>,
    ) -> Result<Option<Self>, ModesError> {
        let Some(masses) = assembly.masses() else { return Ok(None) };
        check_masses(assembly)?;
        if free == 0 {
            return Ok(Some(Self { squares: vec![], rounding: 0.0, vectors: vec![] }));
        }
        let largest = masses.iter().copied().fold(0.0, f64::max);
        let (masses, couplings) = of_unknowns(model, &masses)?;
        let factors: Vec<f64> = masses.iter().map(|mass| (largest / mass).sqrt()).collect();
        let Spectrum { values, mut vectors, rounding } =
            lowest((model, tension), (&factors, &couplings), (wanted, free), observe)?;
        let squares = values.iter().map(|value| if value.abs() <= rounding { 0.0 } else { value / largest }).collect();
        vectors.iter_mut().flatten().for_each(|rate| *rate /= largest.sqrt());
        Ok(Some(Self { squares, rounding: rounding / largest, vectors }))
    }
}

/// Returns the mass of every unknown of a model, given those of the vertices, and what of the motions of rigid parts is
/// coupled.
fn of_unknowns(model: &Model, masses: &[f64]) -> Result<(Vec<f64>, Vec<Coupling>), ModesError> {
    let of_coordinates: Vec<f64> = masses.iter().flat_map(|mass| [*mass; 3]).collect();
    let (mut found, mut couplings) = (model.unknowns(&of_coordinates), vec![]);
    for (part, motions) in model.poses().into_iter().enumerate() {
        let only = |unknown: usize| (0..found.len()).map(|k| f64::from(u8::from(k == unknown))).collect::<Vec<f64>>();
        let rates: Vec<Vec<f64>> = motions.iter().map(|&unknown| model.velocity(&only(unknown))).collect();
        let product = |i: usize, j: usize| -> f64 {
            of_coordinates.iter().zip(rates[i].iter().zip(&rates[j])).map(|(mass, (a, b))| mass * a * b).sum()
        };
        let own: Vec<f64> = (0..motions.len()).map(|i| product(i, i)).collect();
        let relative = |i: usize, j: usize| product(i, j) / (own[i] * own[j]).sqrt();
        let matrix = DenseMatrix::from_fn(motions.len(), motions.len(), relative);
        // not a number, or singular, where a motion moves no mass, as the turns of two vertices about their line
        let moves_mass = |factor: &CholeskyFactor| factor.l_dirty().diagonal().iter().all(|root| root * root > COUPLED);
        let root = cholesky(matrix.clone()).filter(moves_mass).and_then(|factor| inverse(factor.l()));
        let map = root.ok_or(ModesError::MasslessMotion { part })?.transpose();
        motions.iter().zip(own).for_each(|(&unknown, mass)| found[unknown] = mass);
        if (&matrix - DenseMatrix::identity(motions.len(), motions.len())).amax() > COUPLED {
            couplings.push(Coupling { unknowns: motions, map });
        }
    }
    Ok((found, couplings))
}

/// Checks that every coordinate of an assembly is one of a vertex that has a mass, or of a rigid part.
pub(crate) fn check_masses(assembly: &Assembly) -> Result<(), ModesError> {
    let of = match assembly.domain() {
        Domain::Patch | Domain::FixedTorus(_) => None,
        Domain::FreeTorus => Some("the vectors of a free lattice"),
        Domain::Screw | Domain::Tube { .. } => Some("the turns of a cylinder"),
        Domain::Own(_) => Some("the shared coordinates of a domain of one's own"),
    };
    if let Some(of) = of {
        return Err(ModesError::NoMassMatrix { of });
    }
    let held = &assembly.drawn().held;
    let moves = |vertex: usize| !held.contains(&(3 * vertex));
    let without =
        assembly.masses().and_then(|masses| (0..masses.len()).find(|&vertex| masses[vertex] <= 0.0 && moves(vertex)));
    without.map_or(Ok(()), |number| {
        let (count, [n1, _]) = (assembly.sheet().vertices.len(), assembly.tiling().cells);
        let cell = number / count;
        Err(ModesError::Massless { vertex: number % count, cell: [cell % n1, cell / n1] })
    })
}
