//! Fold rates of displacements, and displacements with given fold rates, at Bloch factors.
//!
//! The rate `phi` of an edge of direction `r` is the difference of the angular velocities of its faces, `w_left -
//! w_right = phi r`. Around a vertex these add up to zero: the fold rates of a displacement are a self stress of the
//! bars at the same Bloch factors, and a self stress gives the fold rates of a displacement that stretches no bar (H.
//! Crapo, W. Whiteley 1982; the paper's mapping at finite wavenumber). Hence there are as many zero modes as self
//! stresses at `z`; those of the transposed matrix are at `1/z`; and zero modes come in pairs `z`, `1/z`.

use super::Predicted;
use foldwell::math::Vec3;
use foldwell::math::fold_angle::fold_angle_gradient;
use foldwell::sheet::{EdgeKey, Sheet};
use nalgebra::{Complex, Vector3};
use std::collections::{HashMap, VecDeque};

/// A complex vector in space.
type ComplexVec3 = Vector3<Complex<f64>>;
/// Index of a vertex or a face, and the cell of its copy.
type Placed = (usize, [i32; 2]);

/// Least difference of a phase factor from 1 that determines the constant of an integration.
const LEAST_PHASE: f64 = 1e-6;

/// Returns the rates of the fold angles of all edges for a displacement `(u_0x, u_0y, u_0z, u_1x, ..)` at Bloch factors
/// `z`; zero for boundary edges.
pub fn fold_rates(sheet: &Sheet, z: [Complex<f64>; 2], displacement: &[Complex<f64>]) -> Vec<Complex<f64>> {
    let rate = |edge: &foldwell::sheet::Edge| {
        let [left, right] = [edge.wings[0]?, edge.wings[1]?];
        let [i, j] = edge.key.ends();
        let corners = [i, j, left, right];
        let gradient = fold_angle_gradient(&corners.map(|corner| sheet.position(corner))).1;
        let term = |k: usize| {
            let moved = &displacement[3 * corners[k].vertex..][..3];
            let along: Complex<f64> = (0..3).map(|axis| moved[axis] * gradient[3 * k + axis]).sum();
            along * power(z, corners[k].shift)
        };
        Some((0..4).map(term).sum())
    };
    sheet.edges.iter().map(|edge| rate(edge).unwrap_or_default()).collect()
}

/// Returns the displacement with given fold rates at Bloch factors `z`; the rates must close around every vertex.
///
/// Fails if both factors are 1 to six digits, or if the faces are not all connected by edges, because the rates do not
/// determine the displacement then.
pub fn displacement(sheet: &Sheet, z: [Complex<f64>; 2], rates: &[Complex<f64>]) -> Predicted<Vec<Complex<f64>>> {
    let along = |key: &EdgeKey| {
        let [i, j] = key.ends();
        sheet.position(j) - sheet.position(i)
    };
    let numbers: HashMap<EdgeKey, usize> = sheet.edges.iter().enumerate().map(|(k, edge)| (edge.key, k)).collect();
    // the face on each side of every edge, and its cell if the first vertex of the edge is in cell (0, 0)
    let mut sides: Vec<[Option<Placed>; 2]> = vec![[None; 2]; sheet.edges.len()];
    for (face, triangle) in sheet.triangles.iter().enumerate() {
        for side in triangle.sides() {
            sides[numbers[&side.key]][side.side] = Some((face, side.base.shift.map(|n| -n)));
        }
    }
    let crossings = sides.iter().zip(&sheet.edges).zip(rates).filter_map(|((sides, edge), rate)| {
        let [left, right] = [sides[0]?, sides[1]?];
        Some(Difference { from: right, to: left, by: complex(along(&edge.key).normalize()) * *rate })
    });
    let spins = integrate(sheet.triangles.len(), &crossings.collect::<Vec<_>>(), z)?;
    let bars = sheet.edges.iter().zip(&sides).filter_map(|(edge, sides)| {
        let (face, shift) = sides[0].or(sides[1])?;
        let spin = spins[face] * power(z, shift);
        let by = spin.cross(&complex(along(&edge.key)));
        Some(Difference { from: (edge.key.i, [0, 0]), to: (edge.key.j, edge.key.shift), by })
    });
    let moved = integrate(sheet.vertices.len(), &bars.collect::<Vec<_>>(), z)?;
    Ok(moved.iter().flat_map(|u| [u.x, u.y, u.z]).collect())
}

fn power(z: [Complex<f64>; 2], [n1, n2]: [i32; 2]) -> Complex<f64> {
    z[0].powi(n1) * z[1].powi(n2)
}

fn complex(v: Vec3) -> ComplexVec3 {
    v.map(|x| Complex::new(x, 0.0))
}

/// The condition that `z^shift w` at `to` minus `z^shift w` at `from` is `by`.
struct Difference {
    from: Placed,
    to: Placed,
    by: ComplexVec3,
}

/// Returns the vectors with given differences. All of them are expressed by the first one along a spanning tree; the
/// first one follows from the difference whose phase factor differs most from that along the tree.
fn integrate(count: usize, differences: &[Difference], z: [Complex<f64>; 2]) -> Predicted<Vec<ComplexVec3>> {
    // w = factor * first + offset
    let mut found: Vec<Option<(Complex<f64>, ComplexVec3)>> = vec![None; count];
    found[0] = Some((Complex::ONE, ComplexVec3::zeros()));
    let mut touching = vec![Vec::new(); count];
    for (k, difference) in differences.iter().enumerate() {
        touching[difference.from.0].push(k);
        touching[difference.to.0].push(k);
    }
    let mut queue = VecDeque::from([0]);
    while let Some(node) = queue.pop_front() {
        for difference in touching[node].iter().map(|&k| &differences[k]) {
            let forward = difference.from.0 == node;
            let (here, there) =
                if forward { (difference.from, difference.to) } else { (difference.to, difference.from) };
            if let (Some((factor, offset)), None) = (found[node], found[there.0]) {
                let by = if forward { difference.by } else { -difference.by };
                let (out, back) = (power(z, here.1), power(z, there.1).inv());
                found[there.0] = Some((factor * out * back, (offset * out + by) * back));
                queue.push_back(there.0);
            }
        }
    }
    let all: Option<Vec<(Complex<f64>, ComplexVec3)>> = found.into_iter().collect();
    let all = all.ok_or("the faces do not hang together at their edges")?;
    let mismatch = |difference: &Difference| {
        let [from, to] = [difference.from, difference.to].map(|(node, shift)| {
            let (factor, offset) = all[node];
            (factor * power(z, shift), offset * power(z, shift))
        });
        (to.0 - from.0, difference.by - to.1 + from.1)
    };
    let best = differences.iter().map(mismatch).max_by(|a, b| a.0.norm().total_cmp(&b.0.norm()));
    let (phase, rest) =
        best.filter(|(phase, _)| phase.norm() > LEAST_PHASE).ok_or("nothing changes from a cell to the next")?;
    let first = rest / phase;
    Ok(all.into_iter().map(|(factor, offset)| first * factor + offset).collect())
}
