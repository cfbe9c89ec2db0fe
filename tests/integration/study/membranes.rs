//! Membranes against plates in plane stress.

use crate::common::{Numbers, Scene};
use foldwell::model::{Assembly, Builder, Material, OwnTerm};
use foldwell::relax;
use foldwell::sheet::{Sheet, fold};

const PAPER: Material = Material { young: 3000.0, poisson: 0.3, thickness: 0.1, crease_length: None };
/// Length and width of the rectangle, and the squares of its mesh along each.
const SIDES: [f64; 2] = [2.0, 1.2];
const SQUARES: [usize; 2] = [4, 3];

/// A rectangle of triangles, whose vertices inside it and whose diagonals are random.
fn rectangle(seed: u64) -> Sheet {
    let (mut numbers, [n, m]) = (Numbers::new(seed), SQUARES);
    let [w, h] = [SIDES[0] / n as f64, SIDES[1] / m as f64];
    let mut points = Vec::new();
    for j in 0..=m {
        for i in 0..=n {
            let inside = i > 0 && i < n && j > 0 && j < m;
            let [x, y] = if inside { [numbers.within(0.3), numbers.within(0.3)] } else { [0.0; 2] };
            points.push([w * (i as f64 + x), h * (j as f64 + y), 0.0]);
        }
    }
    let mut faces = Vec::new();
    for j in 0..m {
        for i in 0..n {
            let [a, b, c, d] = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]].map(|[i, j]| j * (n + 1) + i);
            let rising = numbers.within(1.0) > 0.0;
            faces.extend(if rising { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] });
        }
    }
    let text = format!("{{\"vertices_coords\": {points:?}, \"faces_vertices\": {faces:?}}}");
    fold::parse(&text, "rectangle.fold").unwrap()
}

/// Returns the length and the width of the rectangle that is pulled along its length by this force, its sides free to
/// approach each other or held; and what its vertices are off an affine map.
fn pulled(seed: u64, force: f64, held: bool) -> ([f64; 2], f64) {
    let (sheet, [n, m]) = (rectangle(seed), SQUARES);
    let drawn = sheet.vertices.clone();
    let pins = |builder: Builder, (vertex, at): (usize, &nalgebra::Vector3<f64>)| {
        let [left, side] = [at.x == 0.0, at.y == 0.0 || (held && at.y == SIDES[1])];
        builder.pin(vertex, [0, 0], [left, side, true])
    };
    let mut builder = drawn.iter().enumerate().fold(Assembly::patch(sheet, [1, 1]), pins);
    for j in 0..=m {
        let part = if j == 0 || j == m { 0.5 } else { 1.0 } / m as f64;
        builder = builder.load(j * (n + 1) + n, [0, 0], [part * force, 0.0, 0.0]);
    }
    let plate = builder.build().unwrap();
    let state = relax(&plate.with_own_term(OwnTerm::membrane(&plate, &PAPER))).unwrap().state;
    let found = |vertex: usize| [state.coordinates[3 * vertex], state.coordinates[3 * vertex + 1]];
    let sizes = found(drawn.len() - 1);
    let off = |(vertex, at): (usize, &nalgebra::Vector3<f64>)| {
        let [x, y] = found(vertex);
        (x - at.x * sizes[0] / SIDES[0]).abs().max((y - at.y * sizes[1] / SIDES[1]).abs())
    };
    (sizes, drawn.iter().enumerate().map(off).fold(0.0, f64::max))
}

/// Claim: a rectangle that is pulled has the modulus and the ratio of its material on every mesh, and is stretched
/// evenly; with its sides held its modulus is `E / (1 - nu^2)`. Source: St. Venant and Kirchhoff's law, `F = E t h l
/// (l^2 - 1) / 2` at the stretch `l`, and the strain `-nu (l^2 - 1) / 2` across. Tolerance: 1e-12 of the sizes, as
/// relaxed.
#[test]
fn a_rectangle_has_its_modulus_and_its_ratio_on_every_mesh() {
    let Material { young, poisson: nu, thickness, .. } = PAPER;
    for seed in 0..4 {
        for (force, held) in [(1e-3, false), (1e-3, true), (30.0, false), (-10.0, false), (30.0, true)] {
            let ([length, width], off) = pulled(seed, force, held);
            let modulus = if held { young / (1.0 - nu * nu) } else { young };
            let stretch = length / SIDES[0];
            let green = 0.5 * (stretch + 1.0) * (length - SIDES[0]) / SIDES[0];
            let expected = modulus * thickness * SIDES[1] * stretch * green;
            let known = 1e-12 * modulus * thickness * SIDES[1];
            assert!((force - expected).abs() <= known, "{seed} {force} {held}: {expected}");
            let across = if held { 0.0 } else { -nu * green };
            let found = 0.5 * (width / SIDES[1] + 1.0) * (width - SIDES[1]) / SIDES[1];
            assert!((found - across).abs() <= 1e-12 && off <= 1e-12, "{seed} {force} {held}: {found} {across} {off}");
        }
    }
}

/// A patch of Miura-ori whose panels are triangles of a membrane, with this thickness.
fn scene(thickness: f64, energy: &str, study: &str) -> Scene {
    Scene::new(format!(
        "[sheet]\ngenerate = {{ pattern = \"miura\", fold = 0.4 }}\ncells = [2, 2]\n\
         [material]\nyoung = 1e4\npoisson = 0.3\nthickness = {thickness:?}\n\
         [energy]\n{energy}\ncreases = {{ stiffness = 1.0, rest = \"assigned\", fraction = 0.4 }}\n\
         facets = {{ stiffness = 10.0 }}\n\
         [[drive]]\nname = \"fold\"\nrest = true\nto = 1.0\n{study}"
    ))
}

/// Claim: a scene with a membrane relaxes, and follows a path to the state that it relaxes to, with its
/// energy in a column of its own; the thicker it is the nearer is its energy to that of rigid bars, by a part that
/// falls as the stiffness grows. Tolerance: that of relaxations; a fifth of the ratio, which the next order changes.
#[test]
fn scenes_have_membranes() {
    let studies = "[[study]]\nname = \"relaxed\"\nkind = \"relax\"\n[[study]]\nname = \"path\"\nkind = \"path\"\n\
                   drive = \"fold\"\n";
    let ran = scene(1.0, "membrane = true", studies).converged();
    let energy = &ran.relaxed("relaxed").energy;
    let (membrane, total) = (energy.others["membrane"].unwrap(), energy.total);
    assert!(membrane > 0.0 && energy.bars.is_none(), "{membrane}");
    let path = ran.out.table("path.csv");
    for (column, expected) in [("energy_membrane", membrane), ("energy_total", total)] {
        assert!((path.last(column) - expected).abs() <= 1e-9 * total, "{column}: {} {expected}", path.last(column));
    }
    let relaxed = |thickness: f64, energy: &str| {
        let ran = scene(thickness, energy, "[[study]]\nname = \"relaxed\"\nkind = \"relax\"\n").converged();
        ran.relaxed("relaxed").energy.total
    };
    let rigid = relaxed(1.0, "bars = { stiffness = inf }");
    let [thin, thick] = [1.0, 10.0].map(|thickness| rigid - relaxed(thickness, "membrane = true"));
    assert!(thick > 0.0 && (thin / thick - 10.0).abs() < 2.0, "{thin} {thick} of {rigid}");
}

/// Claim: a membrane takes as many iterations at every stiffness, its tensions being unknowns, and tends to rigid bars.
/// Source: Young's modulus over the stiffness of the creases up to 1e8; without tensions the stiffest took hundreds.
#[test]
fn membranes_of_every_stiffness_relax() {
    let relax = "[[study]]\nname = \"relaxed\"\nkind = \"relax\"\n";
    for thickness in [1.0, 1e2, 1e4] {
        let ran = scene(thickness, "membrane = true", relax).converged();
        let relaxed = ran.relaxed("relaxed");
        assert!(relaxed.iterations <= 20, "{thickness}: {}", relaxed.iterations);
        assert!(relaxed.residual_force < 1e-12, "{thickness}: {}", relaxed.residual_force);
    }
}

/// Claim: the wells of a sheet of membranes are those of the sheet with rigid bars but for a part of their energies that
/// falls as the stiffness grows. Tolerance: a tenth of the ratio, which the next order changes (0.4 per cent here).
#[test]
fn wells_of_stiff_membranes_are_those_of_rigid_bars() {
    let lowest = |bars: &str| {
        let energy = format!(
            "{bars}\ncreases = {{ stiffness = 1.0, rest = {{ file = \"near-cross-rest.csv\" }} }}\n\
             [[study]]\nname = \"a\"\nkind = \"wells\"\nstarts = 40\ndraw = []"
        );
        let wells = Scene::on("mesh = \"near-cross.fold\"", &energy).converged().wells("a").wells.clone();
        [wells[0].energy, wells[1].energy]
    };
    let rigid = lowest("[energy]\nbars = { stiffness = inf }");
    let [thin, thick] = [1.0, 10.0].map(|thickness| {
        let plate = format!("[material]\nyoung = 1e6\npoisson = 0.3\nthickness = {thickness:?}");
        lowest(&format!("{plate}\n[energy]\nmembrane = true"))
    });
    for well in 0..2 {
        let [thin, thick] = [thin, thick].map(|found| rigid[well] - found[well]);
        assert!(thick > 0.0 && (thin / thick - 10.0).abs() < 1.0, "{well}: {thin} {thick}");
    }
}

/// Claim: a membrane without a material, and studies that need bars, are refused by name.
#[test]
fn membranes_are_refused_by_name() {
    for (study, said) in [
        ("kind = \"trace\"", "do not know the term `membrane`"),
        ("kind = \"landscape\"\nmodes = [[1.0, 0.0, 0.0]]\namplitudes = [0.1]", "do not know the term `membrane`"),
        ("kind = \"wells\"\nbarriers = [[0, 1]]", "barriers and rigid wells need linear bars and hinges"),
    ] {
        scene(1.0, "membrane = true", &format!("[[study]]\nname = \"a\"\n{study}\n")).refused(said);
    }
    let relax = "[[study]]\nname = \"a\"\nkind = \"relax\"\n";
    let without =
        scene(1.0, "membrane = true", relax).replaced("[material]\nyoung = 1e4\npoisson = 0.3\nthickness = 1.0\n", "");
    without.refused("a membrane needs a material");
}
