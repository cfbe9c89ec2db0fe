//! A waterbomb base: its two wells, the flat state between them, and the force that drives it there, in closed form.
//!
//! Eight creases of length 1 and stiffness 1 meet at sectors of 45 degrees, mountains and valleys by turns; they rest
//! in the drawn state, in which the mountains slope down by [`SLOPE`]. On the symmetric path a mountain at the
//! elevation `-s` and a valley at `t` enclose a sector, `cos 45 = sin(-s) sin t + cos s cos t cos 45`; the fold angles
//! follow from the normals of the faces. Source of the device: B. H. Hanna et al., Smart Materials and Structures 23
//! (2014) 094009.

use crate::common::{ForceCurve, Ran, Scene};
use approx::{abs_diff_eq, assert_relative_eq};
use foldwell::math::Vec3;
use std::f64::consts::FRAC_PI_4;

/// Slope of the mountains in the drawn state, and energy of the flat state and of the second well in that of rigid
/// faces, from the closed form in 17 digits; the digits of an independent computation are 1.2921304 and 0.6394808.
const SLOPE: f64 = 0.155_053_046_863_648_2;
const FLAT: f64 = 1.292_130_4;
const SECOND_WELL: f64 = 0.639_480_8;

/// Elevations of mountains and valleys: with mountains that slope down, valleys do so too, more; inverted, both rise,
/// and valleys less.
fn elevations(slope: f64) -> [f64; 2] {
    let (rise, along) = (-slope.sin(), slope.cos() * FRAC_PI_4.cos());
    let turn = (FRAC_PI_4.cos() / rise.hypot(along)).min(1.0).acos();
    [-slope, rise.atan2(along) - turn]
}

/// Unit vectors along the creases.
fn creases([mountain, valley]: [f64; 2]) -> [Vec3; 8] {
    std::array::from_fn(|k| {
        let (elevation, azimuth) = (if k % 2 == 0 { mountain } else { valley }, k as f64 * FRAC_PI_4);
        Vec3::new(elevation.cos() * azimuth.cos(), elevation.cos() * azimuth.sin(), elevation.sin())
    })
}

/// Fold angles of mountains and valleys.
fn angles(slope: f64) -> [f64; 2] {
    let along = creases(elevations(slope));
    [0, 1].map(|k| {
        let [left, right] = [along[(k + 7) % 8].cross(&along[k]), along[k].cross(&along[(k + 1) % 8])];
        left.cross(&right).dot(&along[k]).atan2(left.dot(&right))
    })
}

fn energy(slope: f64) -> f64 {
    let [now, rest] = [slope, SLOPE].map(angles);
    2.0 * ((now[0] - rest[0]).powi(2) + (now[1] - rest[1]).powi(2))
}

/// Runs the studies of wells and of the path of the base, its corners on a table, its centre on its axis.
fn run(bars: &str) -> Ran {
    let apex = Vec3::new(0.0, 0.0, SLOPE.sin());
    let points: Vec<[f64; 3]> = std::iter::once(apex)
        .chain(creases(elevations(SLOPE)).map(|along| apex + along))
        .map(<[f64; 3]>::from)
        .collect();
    let faces: Vec<[usize; 3]> = (0..8).map(|k| [0, k + 1, (k + 1) % 8 + 1]).collect();
    let mesh = serde_json::json!({ "file_spec": 1.2, "vertices_coords": points, "faces_vertices": faces });
    let pins = "[[pin]]\nvertices = [1, 3, 5, 7]\naxes = \"z\"\n[[pin]]\nvertex = 0\naxes = \"xy\"\n";
    let drive = "[[drive]]\nname = \"push\"\nvertices = [0]\naxis = \"z\"\nto = -0.3\n";
    let energy = format!("[energy]\nbars = {{ stiffness = {bars} }}\ncreases = {{ stiffness = 1.0 }}\n");
    let scene = Scene::on("mesh = \"base.fold\"", &[&energy, pins, drive, WELLS, PATH].concat());
    scene.with("base.fold", mesh.to_string()).converged()
}

const WELLS: &str = "[[study]]\nname = \"w\"\nkind = \"wells\"\nstarts = 32\nspread = 1.5\nbarriers = [[0, 1]]\n";
const PATH: &str = "[[study]]\nname = \"p\"\nkind = \"path\"\nmax_step = 0.005\ndraw = []\n";

/// Claim: with rigid faces the base has two wells, the drawn state and the inverted one, and the barrier between them
/// is the flat state, in which branches cross: it is singular, and its energy is the limit of passes in ever stiffer
/// bars. The path of a centre that is pushed down passes the flat state with that energy, and takes the force of the
/// closed form, which is the larger the nearer to the flat state. Source: the closed form above. Tolerance: the energy
/// of the flat state is exact, to the digits of the source; the limit is extrapolated from a law with a power of 1/3,
/// to 3e-6 and to five times its own error; states of the path are exact to 1e-10, and derivatives of the closed form
/// by fourth-order differences to 1e-8.
#[test]
fn a_rigid_base_passes_the_flat_state() {
    assert!(abs_diff_eq!(energy(1e-9), FLAT, epsilon = 1e-8) && abs_diff_eq!(energy(SLOPE), 0.0, epsilon = 1e-20));
    let ran = run("inf");
    let found = ran.wells("w");
    let lowest = (1..4000).map(|k| energy(-1e-4 * f64::from(k))).fold(f64::INFINITY, f64::min);
    assert!(abs_diff_eq!(lowest, SECOND_WELL, epsilon = 1e-7), "{lowest}");
    let energies: Vec<f64> = found.wells.iter().map(|well| well.energy).collect();
    assert!(energies.len() == 2 && energies[0] < 1e-20, "{energies:?}");
    assert!(abs_diff_eq!(energies[1], lowest, epsilon = 1e-7), "{energies:?} {lowest}");
    let barrier = &found.barriers[0];
    assert!(
        barrier.singular && barrier.flat && abs_diff_eq!(barrier.energy.unwrap(), FLAT, epsilon = 5e-8),
        "{barrier:?}"
    );
    let off = (barrier.limit.unwrap() - FLAT).abs();
    assert!(off <= 3e-6 && off <= 5.0 * barrier.limit_error.unwrap() && off > 0.0, "{barrier:?}");
    assert!(abs_diff_eq!(barrier.exponent.unwrap(), 1.0 / 3.0, epsilon = 1e-3));
    let path = ForceCurve::of(&ran.out.table("p.csv"));
    assert!(abs_diff_eq!(path.energy_at(-SLOPE.sin()), FLAT, epsilon = 1e-7), "{}", path.energy_at(-SLOPE.sin()));
    let height = |drive: f64| SLOPE.sin() + drive;
    let of_height = |z: f64| energy(z.asin());
    let before: Vec<_> = path.states.iter().filter(|state| height(state[0]) > 0.01).collect();
    assert!(before.len() > 10);
    for [drive, reaction, found] in before.iter().copied() {
        let (z, d) = (height(*drive), 1e-3);
        assert!(abs_diff_eq!(*found, of_height(z), epsilon = 1e-9), "{drive} {found} {}", of_height(z));
        let slope = 8.0 * (of_height(z + d) - of_height(z - d)) - (of_height(z + 2.0 * d) - of_height(z - 2.0 * d));
        assert!(
            abs_diff_eq!(*reaction, slope / (12.0 * d), epsilon = 1e-6),
            "{drive} {reaction} {}",
            slope / (12.0 * d)
        );
    }
    assert!(before.windows(2).all(|pair| pair[1][1] < pair[0][1]), "the force grows on the way to the flat state");
}

/// Claim: with bars of finite stiffness the pass is the state of the path at which the centre needs no force, so that
/// `wells` and `path` find one energy, and the largest force grows towards that of rigid faces at the flat state.
/// Source: a symmetric pass lies on the symmetric path; the closed form. Tolerance: interpolation of the energy between
/// states 0.005 apart, where it is steep.
#[test]
fn a_soft_base_snaps_over_its_pass() {
    let near_flat = 1e-4;
    let rigid = (energy(f64::asin(near_flat)) - energy(f64::asin(2.0 * near_flat))) / near_flat;
    let mut forces = vec![];
    for bars in ["1e4", "1e6", "1e8"] {
        let ran = run(bars);
        let barrier = &ran.wells("w").barriers[0];
        let path = ForceCurve::of(&ran.out.table("p.csv"));
        assert!(!barrier.singular && barrier.energy.unwrap() < FLAT);
        assert_relative_eq!(barrier.energy.unwrap(), path.energy_without_force(), max_relative = 1e-6);
        forces.push(path.states.iter().map(|state| -state[1]).fold(0.0, f64::max));
    }
    let below = |force: f64| force < rigid;
    assert!(forces.is_sorted() && forces.iter().copied().all(below) && forces[2] > 0.9 * rigid, "{forces:?} {rigid}");
}
