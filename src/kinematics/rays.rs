//! The rays along which folding leaves a state: the real solutions of the obstruction quadrics.
//!
//! If the number `m` of quadrics is one less than that of motions, the complex solutions are points, `2^m` with
//! multiplicity, and every real one is a line of motions: two rays, `v` and `-v`. With more quadrics there are fewer
//! solutions, mostly none. With fewer quadrics the solutions form curves or sets of higher dimension: their degree is
//! counted on a random linear space, and isolated rays exist only if a real point has no real points near it. Such a
//! point is singular, like the intersection of two conjugate lines. A simple real ray extends to a finite fold
//! (implicit function theorem after division by the square of the amplitude); for a multiple ray the second order does
//! not decide this.

use super::{KinematicsError, SecondOrder, signature};
use crate::numerics::DenseMatrix;
use crate::numerics::dense::symmetric_eigen;
use crate::numerics::homotopy::{Section, SingularPoint, Solution, meets_real_points, real_singular_points, solve_any};
use nalgebra::DVector;

/// Largest number of quadrics of a curve whose singular points are computed: `k 2^k` paths for more take minutes.
const MOST_QUADRICS: usize = 7;

/// Number of random linear spaces on which real points of curves of several quadrics are sought.
const SLICES: usize = 8;

/// Unit of rounding in which entries of directions are compared.
const GRAIN: f64 = 1e-6;

/// A direction in which folding leaves a state.
#[derive(Clone, Debug, PartialEq)]
pub struct Ray {
    /// Number of the branch, the same for the rays `v` and `-v`.
    pub branch: usize,
    /// 1 for the ray whose first entry beyond 1e-6 is positive, -1 for the other.
    pub sign: i8,
    /// Multiplicity of the solution.
    pub multiplicity: usize,
    /// Rates of the fold angles of all edges, of norm 1.
    pub direction: Vec<f64>,
    /// Estimated error of the direction.
    pub error: f64,
}

/// The completeness of the list of real directions in which folding leaves a state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RealDirections {
    /// Every real direction is a listed ray. If the list is empty, there is none.
    Listed,
    /// There are infinitely many real directions: they form curves, surfaces or more. Only isolated ones are listed.
    Continuum,
    /// Other directions than the listed rays were neither found nor excluded.
    NotEstablished,
}

/// The numbers of complex solutions, and the real rays.
#[derive(Clone, Debug, PartialEq)]
pub struct Rays {
    /// Dimension of the set of solutions in projective space: 0 if they are points.
    pub dimension: usize,
    /// Bezout's number of all solutions, of those on a random linear space, or of random combinations of the quadrics.
    pub expected: usize,
    /// Number of isolated complex solutions with multiplicity; if `dimension` is not 0, on the random linear space.
    pub complex_solutions: usize,
    /// Number of isolated complex solutions without multiplicity.
    pub distinct: usize,
    /// Number of paths that end on curves or larger sets of solutions, where isolated ones are expected.
    pub on_continua: usize,
    /// Number of solutions of random combinations that do not satisfy all quadrics.
    pub extraneous: usize,
    /// Number of real singular points of the set of solutions, computed for a curve of at most 7 quadrics and for one
    /// quadric; `None` in other cases, and if the singular points are not isolated.
    pub singular: Option<usize>,
    /// The completeness of the listed rays among all real directions.
    pub directions: RealDirections,
    /// The isolated real rays, by branch, sign 1 first. Branches are numbered from 0 by their directions of sign 1,
    /// rounded to 1e-6: the direction with the larger first entry comes first, among equal ones that with the larger
    /// second entry, and so on.
    pub rays: Vec<Ray>,
}

impl Rays {
    /// Solves the quadrics of a state.
    ///
    /// # Errors
    /// [`KinematicsError`] as the homotopy.
    pub fn new(second_order: &SecondOrder) -> Result<Self, KinematicsError> {
        let SecondOrder { modes, quadrics, .. } = second_order;
        let section = solve_any(quadrics, second_order.count())?;
        let directions = established(quadrics, second_order.count(), &section)?;
        let Section { dimension, expected, solutions, extraneous } = section;
        let line = |Solution { point, multiplicity, error, .. }: &Solution| {
            let x = DVector::from_iterator(point.len(), point.iter().map(|entry| entry.re));
            RealSolution { x, multiplicity: *multiplicity, error: *error }
        };
        let real: Vec<RealSolution> = solutions.isolated.iter().filter(|solution| solution.real).map(line).collect();
        let (real, singular) = match dimension {
            0 => (real, None),
            _ => among_continua(quadrics, dimension)?,
        };
        Ok(Self {
            dimension,
            expected,
            complex_solutions: solutions.count(),
            distinct: solutions.isolated.len(),
            on_continua: solutions.on_continua.len(),
            extraneous,
            singular,
            directions,
            rays: numbered(modes, &real),
        })
    }
}

/// Determines the completeness of the real solutions.
///
/// If the solutions are points, all are counted. For one quadric, the signature tells whether there are real points,
/// and whether these form one line. A curve, or a set of several quadrics, has infinitely many real points if a random
/// real linear space meets it in one; if none does, nothing follows.
fn established(
    quadrics: &[DenseMatrix],
    unknowns: usize,
    section: &Section,
) -> Result<RealDirections, KinematicsError> {
    if section.dimension == 0 {
        let all = section.solutions.on_continua.is_empty();
        return Ok(if all { RealDirections::Listed } else { RealDirections::NotEstablished });
    }
    match quadrics {
        [] => Ok(RealDirections::Continuum),
        [quadric] => {
            let [positive, negative, zero] = signature(quadric)?;
            let definite = positive == 0 || negative == 0;
            Ok(if definite && zero <= 1 { RealDirections::Listed } else { RealDirections::Continuum })
        }
        _ => {
            let real = meets_real_points(quadrics, unknowns, SLICES)?;
            Ok(if real { RealDirections::Continuum } else { RealDirections::NotEstablished })
        }
    }
}

/// A real solution.
struct RealSolution {
    x: DVector<f64>,
    multiplicity: usize,
    error: f64,
}

/// Returns the real solutions that are isolated among the complex solutions on a curve or larger set, and the number of
/// real singular points.
fn among_continua(
    quadrics: &[DenseMatrix],
    dimension: usize,
) -> Result<(Vec<RealSolution>, Option<usize>), KinematicsError> {
    if let [quadric] = quadrics {
        return vertex_of_cone(quadric);
    }
    if dimension > 1 || !(1..=MOST_QUADRICS).contains(&quadrics.len()) {
        return Ok((Vec::new(), None));
    }
    let Some(points) = real_singular_points(quadrics)? else { return Ok((Vec::new(), None)) };
    let line = |point: &SingularPoint| RealSolution {
        x: DVector::from_column_slice(&point.point),
        multiplicity: 2,
        error: point.error,
    };
    Ok((points.iter().filter(|point| point.isolated).map(line).collect(), Some(points.len())))
}

/// Returns the vertex of the cone of one quadric with one zero eigenvalue, which is isolated if the other eigenvalues
/// have one sign, and the number of singular points.
fn vertex_of_cone(quadric: &DenseMatrix) -> Result<(Vec<RealSolution>, Option<usize>), KinematicsError> {
    let [positive, negative, zero] = signature(quadric)?;
    if zero != 1 {
        return Ok((Vec::new(), (zero == 0).then_some(0)));
    }
    let found = symmetric_eigen(quadric)?;
    let smallest = (0..found.values.len()).min_by(|&a, &b| found.values[a].abs().total_cmp(&found.values[b].abs()));
    let line = |k: usize| RealSolution {
        x: found.vectors.column(k).into_owned(),
        multiplicity: 2,
        error: found.values[k].abs(),
    };
    let alone = positive == 0 || negative == 0;
    Ok((smallest.filter(|_| alone).map(line).into_iter().collect(), Some(1)))
}

/// Returns two rays for each line, in the order of their numbers.
fn numbered(modes: &DenseMatrix, lines: &[RealSolution]) -> Vec<Ray> {
    let grains =
        |direction: &DVector<f64>| -> Vec<i64> { direction.iter().map(|x| (x / GRAIN).round() as i64).collect() };
    let mut directed: Vec<(DVector<f64>, &RealSolution)> =
        lines.iter().map(|line| (positive(modes * &line.x), line)).collect();
    directed.sort_by_cached_key(|(direction, _)| std::cmp::Reverse(grains(direction)));
    let rays = directed.iter().enumerate().flat_map(|(branch, (direction, line))| {
        [1, -1].map(|sign| Ray {
            branch,
            sign,
            multiplicity: line.multiplicity,
            direction: (direction * f64::from(sign)).as_slice().to_vec(),
            error: line.error,
        })
    });
    rays.collect()
}

/// Returns the one of `v` and `-v`, scaled to norm 1, whose first entry beyond `GRAIN` is positive.
fn positive(direction: DVector<f64>) -> DVector<f64> {
    let first = direction.iter().find(|entry| entry.abs() > GRAIN).copied().unwrap_or(1.0);
    direction.normalize() * first.signum()
}

#[cfg(test)]
mod tests {
    use super::super::test_sheets::*;
    use super::super::{Closure, drawn_fold_angles};
    use super::*;
    use crate::sheet::generate::SquareTwist;
    use crate::sheet::{EdgeKind, Pattern, Sheet, generate};

    fn rays(sheet: &Sheet, locked: &[usize]) -> Rays {
        let closure = Closure::of_cell(sheet).unwrap().with_locked(locked);
        Rays::new(&SecondOrder::new(&closure, &drawn_fold_angles(sheet)).unwrap()).unwrap()
    }

    fn edge(sheet: &Sheet, [i, j, n1, n2]: [i32; 4]) -> usize {
        let named =
            |key: &crate::sheet::EdgeKey| [key.i as i32, key.j as i32, key.shift[0], key.shift[1]] == [i, j, n1, n2];
        sheet.edges.iter().position(|edge| named(&edge.key)).unwrap()
    }

    /// Claim: with edge (0, 1, 0, 0) locked four rays leave open-star, those along which an independent program started
    /// its trajectories. Tolerance 1e-8: its directions satisfy the quadratic condition to 7e-9.
    #[test]
    fn rays_of_open_star() {
        let sheet = open_star();
        let found = rays(&sheet, &[edge(&sheet, [0, 1, 0, 0])]);
        assert_eq!((found.dimension, found.expected, found.complex_solutions, found.distinct), (0, 2, 2, 2));
        let expected = open_star_reference().rays(&sheet);
        assert_eq!((found.rays.len(), expected.len()), (4, 4));
        for (start, _) in expected {
            let start = DVector::from_vec(start);
            let off = |ray: &Ray| (DVector::from_column_slice(&ray.direction) - &start).amax();
            assert_eq!(found.rays.iter().filter(|ray| off(ray) <= 1e-8).count(), 1);
        }
        for ray in &found.rays {
            assert!(ray.error <= 1e-14 && (DVector::from_column_slice(&ray.direction).norm() - 1.0).abs() <= 1e-14);
        }
    }

    /// Claim: rays are numbered in pairs; the ray of sign 1 has its first entry beyond 1e-6 positive, and comes first.
    #[test]
    fn rays_are_numbered() {
        let sheet = open_flat();
        let found = rays(&sheet, &[0]).rays;
        assert!(found.len() > 4);
        for (k, pair) in found.chunks_exact(2).enumerate() {
            assert_eq!([pair[0].branch, pair[1].branch], [k, k]);
            assert_eq!([pair[0].sign, pair[1].sign], [1, -1]);
            assert!(pair[0].direction.iter().zip(&pair[1].direction).all(|(a, b)| *a == -*b));
            assert!(*pair[0].direction.iter().find(|entry| entry.abs() > GRAIN).unwrap() > 0.0);
        }
        let first: Vec<f64> = found.iter().step_by(2).map(|ray| ray.direction[1]).collect();
        assert!(first.windows(2).all(|pair| pair[0] >= pair[1] - GRAIN), "{first:?}");
    }

    /// Claim: without a lock the solutions of open-star are a conic, of degree 2, and no ray is isolated. The same
    /// holds for triangulated Miura-ori, but its conic is a pair of conjugate lines, and the only real direction is
    /// their intersection: the folding of Miura-ori in which all diagonals keep their angle. Source: theory. Tolerance:
    /// rounding.
    #[test]
    fn without_a_lock_they_are_a_curve() {
        let star = rays(&open_star(), &[]);
        assert_eq!((star.dimension, star.expected, star.complex_solutions, star.rays.len()), (1, 2, 2, 0));
        let sheet = miura();
        let found = rays(&sheet, &[]);
        assert_eq!((found.dimension, found.expected, found.complex_solutions, found.rays.len()), (1, 2, 2, 2));
        assert_eq!((found.rays[0].multiplicity, found.singular, star.singular), (2, Some(1), Some(0)));
        let drawn = drawn_fold_angles(&sheet);
        let diagonals = (0..12).filter(|&edge| drawn[edge].abs() < 1e-12);
        assert_eq!(diagonals.clone().count(), 4);
        assert!(diagonals.map(|edge| found.rays[0].direction[edge].abs()).fold(0.0, f64::max) <= 1e-9);
    }

    /// Claim: without a lock the solutions of a flat cell are a curve of degree 2^Nv = 16, which is smooth for a
    /// generic cell.
    #[test]
    fn a_flat_cell_without_a_lock() {
        let flat = rays(&open_flat(), &[]);
        assert_eq!((flat.dimension, flat.expected, flat.complex_solutions, flat.distinct), (1, 16, 16, 16));
        assert_eq!((flat.singular, flat.rays.len()), (Some(0), 0));
    }

    /// Claim: the solutions of the flat square twist without a lock are a curve of degree 16 with two isolated real
    /// points: the two ways to fold it with rigid squares and trapezoids, which are simple solutions if all diagonals
    /// are locked. Tolerance: the error of a multiple solution, 1e-8.
    #[test]
    fn rays_alone_on_a_curve_of_several_quadrics() {
        let flat = generate(&Pattern::SquareTwist(SquareTwist { fold: 0.0, ..SquareTwist::default() })).unwrap();
        let facets: Vec<usize> = (0..flat.edges.len()).filter(|&e| flat.edges[e].kind == EdgeKind::Facet).collect();
        let (rigid, free) = (rays(&flat, &facets), rays(&flat, &[]));
        assert_eq!((rigid.dimension, rigid.complex_solutions, rigid.rays.len()), (0, 2, 4));
        assert_eq!((free.dimension, free.complex_solutions, free.singular, free.rays.len()), (1, 16, Some(2), 4));
        for (a, b) in free.rays.iter().zip(&rigid.rays) {
            let off = a.direction.iter().zip(&b.direction).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(off <= 1e-8, "{off:e}");
        }
    }

    /// Claim: a lock on a crease of Miura-ori leaves no real ray, one on a diagonal leaves its folding. Two locks of
    /// open-star leave one motion, which does not extend; three leave none. On a folded cylinder with its lock, the
    /// trajectory continues in both directions.
    #[test]
    fn locks() {
        let sheet = miura();
        let drawn = drawn_fold_angles(&sheet);
        let [diagonal, crease] = [true, false].map(|flat| (0..12).find(|&e| (drawn[e].abs() < 1e-12) == flat).unwrap());
        assert_eq!((rays(&sheet, &[crease]).complex_solutions, rays(&sheet, &[crease]).rays.len()), (2, 0));
        let folding = rays(&sheet, &[diagonal]);
        assert_eq!((folding.complex_solutions, folding.distinct, folding.rays.len()), (2, 1, 2));
        let star = open_star();
        let two = rays(&star, &[0, 1]);
        assert_eq!((two.expected, two.complex_solutions, two.extraneous, two.rays.len()), (1, 0, 1, 0));
        let three = rays(&star, &[0, 1, 2]);
        assert_eq!((three.expected, three.complex_solutions, three.rays.len()), (0, 0, 0));
        for folded in open_star_reference().cylinders(&star) {
            let closure = Closure::of_cell(&star).unwrap().with_locked(&[edge(&star, [0, 1, 0, 0])]);
            let on = Rays::new(&SecondOrder::new(&closure, &folded).unwrap()).unwrap();
            assert_eq!((on.complex_solutions, on.rays.len()), (1, 2));
        }
    }
}
