//! The scenes of driven paths that the gallery shows: what each of them is there to show.

use crate::common::{Ran, Scene, Table};
use foldwell::output::vtk::read_vtu;
use foldwell::study::path::PathSummary;

/// A run of a scene of `meshes`, whose only study is a path.
struct Path {
    ran: Ran,
    name: String,
    table: Table,
}

impl Path {
    fn of(scene: Scene) -> Self {
        let ran = scene.converged();
        let name = ran.report.summary.studies[0].name.clone();
        Self { table: ran.out.table(&format!("{name}.csv")), ran, name }
    }

    /// The values of a column on a branch.
    fn column(&self, branch: usize, name: &str) -> Vec<f64> {
        let rows = (0..self.table.len()).filter(|&row| self.table.field(row, "branch") == branch.to_string());
        rows.map(|row| self.table.at(row, name)).collect()
    }

    /// Vertices of the state in this row of the table.
    fn vertices(&self, row: usize) -> Vec<[f64; 3]> {
        let picture = read_vtu(&self.ran.out.file(format!("{0}/{0}_{row:04}.vtu", self.name))).unwrap();
        picture.points.iter().map(|v| [v.x, v.y, v.z]).collect()
    }

    fn result(&self) -> &PathSummary {
        self.ran.path(&self.name)
    }

    /// Claim: on every branch the work of the drive is the change of the energy, here to 1e-8 of its largest value: the
    /// work is a quadrature of the reaction along the path that refines itself to 1e-9.
    fn works(&self) {
        for branch in 0..self.result().branches.len() {
            let (work, energy) = (self.column(branch, "work"), self.column(branch, "energy_total"));
            let largest = energy.iter().copied().fold(0.0, f64::max);
            for (w, e) in work.iter().zip(&energy) {
                assert!((w - work[0] - (e - energy[0])).abs() < 1e-8 * largest, "branch {branch}: {w} {e}");
            }
        }
    }
}

/// Lowest and highest value of a coordinate.
fn range(vertices: &[[f64; 3]], axis: usize) -> [f64; 2] {
    let values = || vertices.iter().map(|v| v[axis]);
    [values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max)]
}

fn sign_changes(values: &[f64]) -> usize {
    values.windows(2).filter(|pair| pair[0] * pair[1] < 0.0).count()
}

/// Claim: a pulled Miura-ori widens as its cells do when their faces are rigid. Source: M. Schenk and S. D. Guest, PNAS
/// 110 (2013) 3276: with `t = cos(fold) tan(sector)` the half periods are `S = t / sqrt(1 + t^2)` along and
/// `L = sqrt(1 - sin(fold)^2 sin(sector)^2)` across, with steps of `V = 1 / sqrt(1 + t^2)` between neighbouring
/// vertices; this patch has the length `9 S` and the width `9 L + V`. Tolerance: 3% with the soft facets and bars of
/// the scene, which take a part of the strain, and 1.5% where both are a hundred times as stiff.
#[test]
fn a_pulled_miura_widens() {
    let runs = [
        Path::of(Scene::of("miura-pull")),
        Path::of(
            Scene::of("miura-pull")
                .replaced("stiffness = 10.0", "stiffness = 1e3")
                .replaced("stiffness = 1e4", "stiffness = 1e6"),
        ),
    ];
    for (run, [least, most]) in runs.iter().zip([[0.97, 1.03], [0.985, 1.015]]) {
        run.works();
        let (found, expected) = widened(run);
        assert!((least * expected..most * expected).contains(&found), "{found} {expected}");
    }
}

/// Strain across of a pulled Miura-ori, and that of cells with rigid faces of the same length.
fn widened(run: &Path) -> (f64, f64) {
    let (fold, sector) = (0.9_f64, std::f64::consts::FRAC_PI_3);
    let step = |fold: f64| 1.0 / (fold.cos() * sector.tan()).hypot(1.0);
    let width = |fold: f64| 9.0 * (1.0 - (fold.sin() * sector.sin()).powi(2)).sqrt() + step(fold);
    let length = |fold: f64| (fold.cos() * sector.tan()) / (fold.cos() * sector.tan()).hypot(1.0);
    let first = run.vertices(0);
    let last = run.vertices(run.table.len() - 1);
    let stretched = |axis: usize| {
        let [a, b] = [&first, &last].map(|state| range(state, axis)).map(|[low, high]| high - low);
        b / a
    };
    // the fold at which cells have this length, by bisection
    let [mut low, mut high] = [0.0, fold];
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if length(middle) > stretched(0) * length(fold) { low = middle } else { high = middle }
    }
    (stretched(1) - 1.0, width(low) / width(fold) - 1.0)
}

/// Claim: a Miura-ori that is bent along x bends the other way along y, since its Poisson's ratio of bending is
/// positive where that of stretching is negative; source as above. The sheet has no exact shape to compare with, since
/// its ends are flat: along y the rows in the middle sag by more than a tenth of their width.
#[test]
fn a_bent_miura_is_a_saddle() {
    let run = Path::of(Scene::of("miura-bend"));
    run.works();
    assert!(run.result().branches[0].stable);
    let [flat, bent] = [0, run.table.len() - 1].map(|row| run.vertices(row));
    // heights of vertices of the lower layer, off the height of the corners of their line
    let sag = |along: usize, near: [f64; 2]| {
        let across = 1 - along;
        let line: Vec<usize> = (0..flat.len())
            .filter(|&k| flat[k][2] < 1e-9 && flat[k][across] > near[0] && flat[k][across] < near[1])
            .collect();
        let by = |a: &&usize, b: &&usize| flat[**a][along].total_cmp(&flat[**b][along]);
        let ends = [line.iter().min_by(by).unwrap(), line.iter().max_by(by).unwrap()];
        let middle = 0.5 * (flat[*ends[0]][along] + flat[*ends[1]][along]);
        let off = |k: &usize| (flat[*k][along] - middle).abs();
        let centre = line.iter().min_by(|a, b| off(a).total_cmp(&off(b))).unwrap();
        bent[*centre][2] - 0.5 * (bent[*ends[0]][2] + bent[*ends[1]][2])
    };
    let [_, x] = range(&flat, 0);
    let [_, y] = range(&flat, 1);
    let [along_x, along_y] = [sag(0, [0.4 * y, 0.55 * y]), sag(1, [0.42 * x, 0.52 * x])];
    assert!(along_x * along_y < 0.0 && along_x.abs() > 0.3 && along_y.abs() > 0.1, "{along_x} {along_y}");
}

/// Claim: a waterbomb base that is pushed through has two stable states and a state between them at the top of a
/// barrier. Source: B. H. Hanna et al., Smart Materials and Structures 23 (2014) 094009. Signs have no tolerance.
#[test]
fn a_waterbomb_base_snaps() {
    let run = Path::of(Scene::of("waterbomb-push"));
    run.works();
    let (reaction, energy) = (run.column(0, "reaction"), run.column(0, "energy_total"));
    assert_eq!(sign_changes(&reaction[1..]), 2, "{reaction:?}");
    assert_eq!(run.result().branches[0].events.iter().filter(|event| event.event == "limit-load").count(), 2);
    let top = (0..energy.len()).max_by(|&a, &b| energy[a].total_cmp(&energy[b])).unwrap();
    let after = energy[top..].iter().copied().fold(f64::INFINITY, f64::min);
    assert!(energy[0] < 1e-12 && after < 0.7 * energy[top] && energy[energy.len() - 1] > after, "{energy:?}");
}

/// Claim: equal storeys snap one after the other: where both do the same the bellows is unstable between two branch
/// points, which two mirrored branches join, with less energy at the same displacement; on them the plate in the middle
/// is far off the middle. Source: two equal elements in series, whose forces fall with displacement, at fixed sum.
/// Branches are mirror images, so that their extrema agree to the 1e-9 to which they are located.
#[test]
fn storeys_snap_one_after_the_other() {
    let run = Path::of(Scene::of("bellows"));
    run.works();
    let branches = &run.result().branches;
    assert_eq!(
        branches.iter().map(|branch| branch.end.as_str()).collect::<Vec<_>>(),
        ["arrived", "returned", "returned"]
    );
    let points = |branch: usize| -> Vec<f64> {
        branches[branch].events.iter().filter(|e| e.event == "branch-point").map(|e| e.drive.unwrap()).collect()
    };
    let extrema = |branch: usize| -> Vec<f64> {
        branches[branch].events.iter().filter(|e| e.event == "limit-load").map(|e| e.reaction).collect()
    };
    for branch in [1, 2] {
        assert!(points(branch).len() == 2 && extrema(branch).len() == 2);
        for (a, b) in points(branch).iter().zip(points(0)) {
            assert!((a - b).abs() < 1e-9, "{a} {b}");
        }
        for (a, b) in extrema(branch).iter().zip(extrema(1)) {
            assert!((a - b).abs() < 1e-9, "{a} {b}");
        }
    }
    let [path, energy] = ["drive", "energy_total"].map(|name| run.column(0, name));
    let below = |drive: f64| {
        let k = path.iter().rposition(|&d| d >= drive).unwrap();
        let part = (drive - path[k]) / (path[k + 1] - path[k]);
        energy[k] + part * (energy[k + 1] - energy[k])
    };
    let (drive, lower) = (run.column(1, "drive"), run.column(1, "energy_total"));
    let middle = drive.iter().zip(&lower).filter(|(d, _)| (-0.4..-0.2).contains(*d));
    assert!(middle.clone().count() > 3);
    for (d, e) in middle {
        assert!(*e < 0.95 * below(*d), "{d}: {e}");
    }
}
