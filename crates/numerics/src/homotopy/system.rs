//! Systems of homogeneous quadrics, and the homotopy that deforms one with known solutions into them.

use super::error::HomotopyError;
use crate::DenseMatrix;
use crate::random::symmetric;
use nalgebra::Complex;
use rand_chacha::ChaCha8Rng;

pub(super) type C = Complex<f64>;

/// Homogeneous quadrics `F_k(x) = x^T A_k x` with symmetric `A_k`, each of Frobenius norm 1.
#[derive(Clone, Debug)]
pub(super) struct Quadrics {
    pub unknowns: usize,
    pub matrices: Vec<DenseMatrix>,
}

/// Values of a homotopy with their derivatives at one place.
pub(super) struct HomotopyDerivatives {
    /// `H`, one entry for each equation.
    pub value: Vec<C>,
    /// `dH/dx`, a row of all unknowns for each equation.
    pub jacobian: Vec<C>,
    /// `dH/dt`.
    pub rate: Vec<C>,
}

/// `H(x, t)`: one homogeneous equation fewer than unknowns, polynomial in `t`.
pub(super) trait Homotopy {
    /// The quadrics that it leads to.
    fn quadrics(&self) -> &Quadrics;
    fn evaluate(&self, x: &[C], t: C, at: &mut HomotopyDerivatives);
}

/// `H(x, t) = (1 - t) F(x) + t G(x)`, `G_k = g_k (x_k^2 - b_k x_0^2)`, with random `g_k` and `b_k` of modulus 1.
///
/// At `t = 1` the `2^m` solutions are known. For almost all `g` the paths from them are smooth down to every `t > 0`,
/// and their ends are all isolated solutions of `F`, each as often as its multiplicity says (A. J. Sommese and C. W.
/// Wampler, "The numerical solution of systems of polynomials", 2005, theorem 8.4.1).
pub(super) struct TotalDegree<'a> {
    quadrics: &'a Quadrics,
    factors: Vec<C>,
    squares: Vec<C>,
}

impl Quadrics {
    /// Refuses matrices that are not square, not of one size, without entries, or zero.
    pub fn new(matrices: &[DenseMatrix], unknowns: usize) -> Result<Self, HomotopyError> {
        let scaled = matrices.iter().enumerate().map(|(number, matrix)| {
            let norm = if matrix.shape() == (unknowns, unknowns) { matrix.norm() } else { f64::NAN };
            let good = norm > 0.0 && norm.is_finite();
            if good { Ok((matrix + matrix.transpose()) / (2.0 * norm)) } else { Err(HomotopyError::Quadric { number }) }
        });
        Ok(Self { unknowns, matrices: scaled.collect::<Result<_, _>>()? })
    }

    pub fn count(&self) -> usize {
        self.matrices.len()
    }

    /// `F` and its derivative, `2 A_k x` in row `k`.
    pub fn evaluate(&self, x: &[C], value: &mut [C], jacobian: &mut [C]) {
        for (number, matrix) in self.matrices.iter().enumerate() {
            let row = &mut jacobian[number * self.unknowns..][..self.unknowns];
            row.fill(C::default());
            for (column, entry) in matrix.as_slice().chunks_exact(self.unknowns).zip(x) {
                row.iter_mut().zip(column).for_each(|(sum, a)| *sum += entry * *a);
            }
            value[number] = row.iter().zip(x).map(|(a, b)| a * b).sum();
            row.iter_mut().for_each(|entry| *entry *= 2.0);
        }
    }

    /// Largest `|F_k|` at a vector of norm 1.
    pub fn residual(&self, x: &[C]) -> f64 {
        let mut value = vec![C::default(); self.count()];
        let mut jacobian = vec![C::default(); self.count() * self.unknowns];
        self.evaluate(x, &mut value, &mut jacobian);
        value.iter().map(|value| value.norm()).fold(0.0, f64::max)
    }
}

impl HomotopyDerivatives {
    pub fn new(unknowns: usize) -> Self {
        let zeros = |count| vec![C::default(); count];
        Self { value: zeros(unknowns - 1), jacobian: zeros((unknowns - 1) * unknowns), rate: zeros(unknowns - 1) }
    }
}

impl<'a> TotalDegree<'a> {
    pub fn new(quadrics: &'a Quadrics, random: &mut ChaCha8Rng) -> Self {
        let mut units = |_| unit(random);
        let factors = (0..quadrics.count()).map(&mut units).collect();
        Self { quadrics, factors, squares: (0..quadrics.count()).map(units).collect() }
    }

    /// The start of path `number`: the roots of `b_k`, their signs the binary digits of the number.
    pub fn start(&self, number: usize) -> Vec<C> {
        let roots =
            self.squares.iter().enumerate().map(|(k, b)| if number >> k & 1 == 0 { b.sqrt() } else { -b.sqrt() });
        let mut point: Vec<C> = [C::new(1.0, 0.0)].into_iter().chain(roots).collect();
        normalize(&mut point);
        point
    }
}

impl Homotopy for TotalDegree<'_> {
    fn quadrics(&self) -> &Quadrics {
        self.quadrics
    }

    fn evaluate(&self, x: &[C], t: C, at: &mut HomotopyDerivatives) {
        self.quadrics.evaluate(x, &mut at.value, &mut at.jacobian);
        let rest = C::new(1.0, 0.0) - t;
        at.jacobian.iter_mut().for_each(|entry| *entry *= rest);
        for (k, (g, b)) in self.factors.iter().zip(&self.squares).enumerate() {
            let start = g * (x[k + 1] * x[k + 1] - b * x[0] * x[0]);
            at.rate[k] = start - at.value[k];
            at.value[k] = rest * at.value[k] + t * start;
            let row = &mut at.jacobian[k * x.len()..][..x.len()];
            row[k + 1] += 2.0 * t * g * x[k + 1];
            row[0] -= 2.0 * t * g * b * x[0];
        }
    }
}

/// A complex number of modulus 1.
pub(super) fn unit(random: &mut ChaCha8Rng) -> C {
    loop {
        let number = C::new(symmetric(random), symmetric(random));
        let modulus = number.norm();
        if (0.1..=1.0).contains(&modulus) {
            return number / modulus;
        }
    }
}

pub(super) fn norm(x: &[C]) -> f64 {
    x.iter().map(C::norm_sqr).sum::<f64>().sqrt()
}

pub(super) fn normalize(x: &mut [C]) {
    let norm = norm(x);
    x.iter_mut().for_each(|entry| *entry /= norm);
}

/// `x^H y`.
pub(super) fn inner(x: &[C], y: &[C]) -> C {
    x.iter().zip(y).map(|(a, b)| a.conj() * b).sum()
}

/// The multiple of `y` that lies in the affine patch `x^H y = 1` of a vector of norm 1.
pub(super) fn in_patch(x: &[C], y: &[C]) -> Vec<C> {
    let scale = inner(x, y);
    y.iter().map(|entry| entry / scale).collect()
}

/// Distance of two points of projective space in the affine patch of the first, which has norm 1: the tangent of their
/// angle.
pub(super) fn distance(x: &[C], y: &[C]) -> f64 {
    in_patch(x, y).iter().zip(x).map(|(a, b)| (a - b).norm_sqr()).sum::<f64>().sqrt()
}
