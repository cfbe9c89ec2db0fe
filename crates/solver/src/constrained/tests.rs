//! Textbook problems.

use super::*;
use foldwell_numerics::parallel::Threads;

/// A problem given by closures: the variables of each block, and its value, gradient and Hessian.
struct TextbookConstraint<F> {
    blocks: Blocks,
    target: Vec<f64>,
    compliance: Vec<f64>,
    constraint: F,
}

/// Value, gradient, and lower triangle of the Hessian of one constraint.
type Value = (f64, Vec<f64>, Vec<f64>);

impl<F: Fn(usize, &[f64]) -> Value + Sync> ConstrainedProblem for TextbookConstraint<F> {
    fn blocks(&self) -> &Blocks {
        &self.blocks
    }

    fn target(&self) -> &[f64] {
        &self.target
    }

    fn compliance(&self) -> &[f64] {
        &self.compliance
    }

    fn linearize(&self, number: usize, z: &[f64], multipliers: Option<&[f64]>, out: &mut Block) {
        let local: Vec<f64> = self.blocks.variables.members(number).iter().map(|&k| z[k as usize]).collect();
        let (value, gradient, hessian) = (self.constraint)(number, &local);
        out.values = vec![value];
        out.jacobian = gradient;
        out.hessian = multipliers.map_or(vec![], |m| hessian.iter().map(|entry| m[0] * entry).collect());
    }
}

fn of_lists<F>(lists: &[Vec<u32>], target: Vec<f64>, compliance: Vec<f64>, constraint: F) -> TextbookConstraint<F> {
    let mut blocks = Blocks::default();
    lists.iter().for_each(|list| blocks.push(1, list));
    TextbookConstraint { blocks, target, compliance, constraint }
}

fn solve<F: Fn(usize, &[f64]) -> Value + Sync>(
    problem: &TextbookConstraint<F>,
    start: Vec<f64>,
) -> Result<Minimum, ConstrainedError> {
    minimize_constrained(problem, start, &mut |_| true)
}

/// `x^2 + y^2 - 1`.
fn circle(_: usize, z: &[f64]) -> Value {
    (z[0] * z[0] + z[1] * z[1] - 1.0, vec![2.0 * z[0], 2.0 * z[1]], vec![2.0, 0.0, 2.0])
}

/// Claim: the point of a circle closest to (2, 1) lies in its direction, and the multiplier is that of the equation
/// `(z - a)/c + 2 l z = 0`; the last steps converge quadratically. By hand. Tolerance: rounding.
#[test]
fn closest_point_of_a_circle() {
    for compliance in [1e-9, 1.0, 1e6] {
        let problem = of_lists(&[vec![0, 1]], vec![2.0, 1.0], vec![compliance; 2], circle);
        let found = solve(&problem, vec![0.6, 0.9]).unwrap();
        let length = f64::sqrt(5.0);
        assert!((found.z[0] - 2.0 / length).abs() <= 1e-14 && (found.z[1] - 1.0 / length).abs() <= 1e-14);
        let multiplier = (length - 1.0) / (2.0 * compliance);
        assert!((found.multipliers[0] / multiplier - 1.0).abs() <= 1e-12, "{}", found.multipliers[0]);
        let forces: Vec<f64> = found.history.iter().map(|step| step.residual_force).collect();
        let quadratic = forces.windows(2).any(|pair| pair[0] < 1e-2 && pair[1] < pair[0].powf(1.7));
        assert!(quadratic && found.history.len() <= 9, "{forces:?}");
    }
}

/// Claim: points on a chain of rods of length 1, pulled to targets beside it: the equations of a stationary point hold
/// (definition), for compliances over four decades, and the multipliers are the forces of the rods. Tolerance: rounding
/// of some hundred terms, relative to the largest force.
#[test]
fn a_chain_of_rods() {
    let count = 200u32;
    let lists: Vec<Vec<u32>> = (0..count - 1).map(|k| (2 * k..2 * k + 4).collect()).collect();
    let rod = |_: usize, z: &[f64]| {
        let (dx, dy) = (z[2] - z[0], z[3] - z[1]);
        let gradient = vec![-dx, -dy, dx, dy];
        (0.5 * (dx * dx + dy * dy - 1.0), gradient, vec![1.0, 0.0, 1.0, -1.0, 0.0, 1.0, 0.0, -1.0, 0.0, 1.0])
    };
    let (mut start, mut end) = (vec![], [0.0, 0.0]);
    for k in 0..count {
        start.extend(end);
        let direction = 0.5 * (0.3 * f64::from(k)).sin();
        end = [end[0] + direction.cos(), end[1] + direction.sin()];
    }
    let target = (0..).zip(&start).map(|(k, z)| z + 0.01 * f64::from(k * k % 17).sin()).collect();
    let compliance: Vec<f64> = (0..2 * count).map(|k| 10f64.powi((k / 2 % 5) as i32 - 4)).collect();
    let problem = of_lists(&lists, target, compliance, rod);
    let found = solve(&problem, start).unwrap();
    let mut left: Vec<f64> =
        (0..found.z.len()).map(|i| (found.z[i] - problem.target[i]) / problem.compliance[i]).collect();
    let largest = left.iter().fold(0.0f64, |most, force| most.max(force.abs()));
    for (k, list) in lists.iter().enumerate() {
        let local: Vec<f64> = list.iter().map(|&i| found.z[i as usize]).collect();
        let (value, gradient, _) = rod(k, &local);
        assert!(value.abs() <= 1e-13, "rod {k}: {value:e}");
        list.iter().zip(gradient).for_each(|(&i, g)| left[i as usize] += found.multipliers[k] * g);
    }
    assert!(left.iter().all(|force| force.abs() <= 1e-9 * largest), "{largest:e}: {left:?}");
}

/// Claim: results have the same bits for any number of threads: a chain of 5,000 rods, which loops share out.
#[test]
fn same_bits_for_any_number_of_threads() {
    let count = 5000u32;
    let lists: Vec<Vec<u32>> = (0..count - 1).map(|k| vec![k, k + 1]).collect();
    let product = |_: usize, z: &[f64]| (z[0] * z[1] - 1.0, vec![z[1], z[0]], vec![0.0, 1.0, 0.0]);
    let target = (0..count).map(|k| if k % 2 == 0 { 2.0 } else { 0.4 + 1e-3 * f64::from(k % 7) }).collect();
    let problem = of_lists(&lists, target, vec![1.0; count as usize], product);
    let run = |threads| Threads::new(Some(threads)).install(|| solve(&problem, vec![1.0; count as usize]).unwrap());
    let [one, two] = [run(1), run(2)];
    assert!(one.z == two.z && one.multipliers == two.multipliers && one.history == two.history);
}

/// Claim: constraints that depend on each other, that no state meets, or that are not numbers are told apart from a
/// result, and an observer stops the iteration. By definition.
#[test]
fn failures_have_their_reasons() {
    let failure = |problem: &TextbookConstraint<fn(usize, &[f64]) -> Value>, start: Vec<f64>| {
        solve(problem, start).unwrap_err().failure
    };
    let two: fn(usize, &[f64]) -> Value = circle;
    let twice = of_lists(&[vec![0, 1], vec![0, 1]], vec![2.0, 1.0], vec![1.0; 2], two);
    assert!(matches!(failure(&twice, vec![0.6, 0.9]), ConstrainedFailure::Factor(_)));
    let never: fn(usize, &[f64]) -> Value = |_, z| (z[0] * z[0] + 1.0, vec![2.0 * z[0]], vec![2.0]);
    let impossible = of_lists(&[vec![0]], vec![2.0], vec![1.0], never);
    let found = failure(&impossible, vec![0.7]);
    assert!(matches!(found, ConstrainedFailure::Stuck { .. } | ConstrainedFailure::TooManySteps { .. }), "{found}");
    let undefined: fn(usize, &[f64]) -> Value = |_, _| (f64::NAN, vec![1.0], vec![0.0]);
    let nothing = of_lists(&[vec![0]], vec![2.0], vec![1.0], undefined);
    assert_eq!(failure(&nothing, vec![0.7]), ConstrainedFailure::NotFinite);
    let one = of_lists(&[vec![0, 1]], vec![2.0, 1.0], vec![1.0; 2], circle);
    let stopped = minimize_constrained(&one, vec![0.6, 0.9], &mut |_| false).unwrap_err();
    assert!(stopped.failure == ConstrainedFailure::Interrupted && stopped.history.len() == 1);
}

/// Claim: without constraints the targets are the minimum, found in one step.
#[test]
fn no_constraint() {
    let none = of_lists(&[], vec![2.0, 1.0], vec![1.0; 2], circle);
    let found = solve(&none, vec![0.0, 0.0]).unwrap();
    assert!(found.z == [2.0, 1.0] && found.history.len() == 2);
}
