//! Driven paths of periodic sheets: one cell of a torus, a cylinder, a tube.
//!
//! Sources: the fold angles of a Miura-ori (zigzag creases `2 g` at the angle `g` between faces and plane) and its
//! Poisson's ratios, in its plane `-cos^2(g) tan^2(t)` with the sector angle `t`, of bending the opposite (M. Schenk,
//! S. D. Guest, PNAS 110, 3276 (2013)); relaxations with the lock held at another angle, which share neither tangents
//! nor steps with a path.

use crate::common::{Scene, mesh, mesh_folder, turned};
use foldwell::analysis::path::{PathEnd, PathFailure, PathOptions, PathPoint, follow_path};
use foldwell::analysis::relax::relax_from;
use foldwell::math::Vec3;
use foldwell::model::{Assembly, Builder, Drive, DriveError, Driven, Gauge};
use foldwell::scene::{build, parse};
use foldwell::sheet::EdgeKind;
use foldwell::solver::Options;
use foldwell::{Pattern, RIGID, generate, relax};
use nalgebra::Rotation3;
use std::f64::consts::FRAC_PI_3;

/// The fold angle as drawn of the crease [0, 1, 0, 0], which is locked and driven.
const DRAWN: f64 = -0.5433931680006628;

/// The reference cell, rolled up by its rest angles, with these tables in its scene.
fn rolled(tables: &str) -> Assembly {
    let text = format!(
        "[sheet]\nmesh = \"open-star.fold\"\ndomain = \"screw\"\ncells = [4, 4]\n[energy]\nbars = {{ stiffness = inf }}\n\
         creases = {{ stiffness = 1.0, rest = {{ mode = [0.0, 0.3, 0.0], amplitude = 1.0 }} }}\n{tables}"
    );
    build::assembly(&parse(&text, mesh_folder().join("s.toml")).unwrap()).unwrap()
}

/// The same with one crease locked at an angle.
fn locked(angle: f64) -> Assembly {
    rolled(&format!("[[lock]]\ncrease = [0, 1, 0, 0]\nangle = {angle:?}\n"))
}

/// The path of the cylinder to which the reference cell relaxes, while its lock is turned.
fn path_of_cylinder(to: f64) -> Vec<PathPoint> {
    let assembly = locked(DRAWN);
    let start = relax(&assembly).unwrap().configuration;
    let drive = Drive { quantity: Driven::Lock(vec![0]), to };
    let mut branches = follow_path(&assembly, &drive, Some(start), &PathOptions::default(), &mut |_, _| true).unwrap();
    branches.remove(0).points
}

/// Claim: the states of a path of a cylinder are those to which the sheet relaxes with its lock at their angles, and
/// the torque of the lock is the slope of their energy. Tolerances: 1e-10 of energies of size 1 from residuals of
/// 1e-12; the slope by central differences over 1e-4, whose error is 1e-8 times a third derivative of size 10.
#[test]
fn cylinder_along_a_lock() {
    let points = path_of_cylinder(-0.2);
    let last = points.last().unwrap();
    assert!((last.drive + 0.2).abs() < 1e-12 && points.len() > 10, "{} to {}", points.len(), last.drive);
    for point in points.iter().step_by(6) {
        let relaxed = |shift: f64| {
            let assembly = locked(point.drive + shift);
            let mut model = assembly.model(Gauge::Held);
            let start = model.enter(&point.configuration().without_tension());
            relax_from(&model, start, Options::default(), &mut |_| true).unwrap().state
        };
        let here = relaxed(0.0);
        assert!((here.total() - point.state.total()).abs() < 1e-10, "{} for {}", point.state.total(), here.total());
        let step = 1e-4;
        let slope = (relaxed(step).total() - relaxed(-step).total()) / (2.0 * step);
        assert!((slope - point.reaction).abs() < 1e-6, "{slope} for {} at {}", point.reaction, point.drive);
        assert_eq!(point.negative_eigenvalues, Some(0));
    }
    let work = last.state.total() - points[0].state.total();
    assert!((last.work - work).abs() < 1e-5 && work > 0.1, "{} for {work}", last.work);
}

/// Claim: the path of a straight cell whose lock is turned begins about an axis about which rigid faces let it bend,
/// both ways and however the cell lies in its plane; its states have no residual forces, its end is a state in which a
/// relaxation stays, and stiff bars go the same way. A relaxation from the drawn state, without a path, chooses the
/// same axis. Tolerances: 1e-10 of forces and energies of size 1, of which rounding errors in bars of 1e9 are 1e-11;
/// such bars under forces of 7 change the energy by 1e-8, and by much more where the cell becomes compliant.
#[test]
fn straight_cells_begin_to_bend() {
    let cell = |by: f64, bars: f64, angle: Option<f64>| {
        let sheet = turned(mesh("open-star"), Rotation3::from_axis_angle(&Vec3::z_axis(), by).matrix());
        let lock = sheet.edges[0].key;
        Assembly::screw(sheet, [1, 1]).bars(bars).creases(1.0).lock(lock, angle).build().unwrap()
    };
    for to in [-0.2, -0.9] {
        let end = |assembly: &Assembly| {
            let drive = Drive { quantity: Driven::Lock(vec![0]), to };
            let mut branches = follow_path(assembly, &drive, None, &PathOptions::default(), &mut |_, _| true).unwrap();
            let points = branches.remove(0).points;
            let most = points.iter().map(|point| point.residual_force).fold(0.0, f64::max);
            assert!(most <= 1e-10, "{to}: {most:e}");
            points.into_iter().next_back().unwrap()
        };
        let [rigid, stiff] = [RIGID, 1e9].map(|bars| end(&cell(0.0, bars, None)));
        assert!((rigid.drive - to).abs() < 1e-12, "to {to}: {}", rigid.drive);
        assert_eq!(rigid.negative_eigenvalues, Some(0));
        let energy = rigid.state.total();
        let turned = end(&cell(0.7, RIGID, None)).state.total();
        assert!((turned / energy - 1.0).abs() < 1e-10, "{to}: {turned} for {energy}");
        assert!((stiff.state.total() / energy - 1.0).abs() < 1e-4, "{to}: {} for {energy}", stiff.state.total());
        let mut model = cell(0.0, RIGID, Some(to)).model(Gauge::Held);
        let start = model.enter(&rigid.configuration().without_tension());
        let relaxed = relax_from(&model, start, Options::default(), &mut |_| true).unwrap().state.total();
        assert!((relaxed / energy - 1.0).abs() < 1e-10, "{to}: {relaxed} for {energy}");
        for by in [0.0, 0.7] {
            let relaxed = relax(&cell(by, RIGID, Some(to))).unwrap().state.total();
            assert!((relaxed / energy - 1.0).abs() < 1e-10, "{to}, turned by {by}: {relaxed} for {energy}");
        }
    }
}

const MIURA: &str = r#"
[sheet]
generate = { pattern = "miura", fold = 0.6 }
domain = "torus"
cells = [1, 1]
[energy]
bars = { stiffness = inf }
creases = { stiffness = 1.0 }
facets = { stiffness = 10.0 }
[[lock]]
crease = [0, 1, 0, 0]
[[drive]]
name = "fold"
lock = [0, 1, 0, 0]
to = 0.3
[[study]]
name = "press"
kind = "path"
response = "bending"
"#;

/// Claim: the path of a Miura-ori whose zigzag crease is unfolded is its rigid folding: `tan(r/2) = tan(r'/2) cos t`
/// joins the two fold angles, facets stay flat, both Poisson's ratios are those of the closed form, the energy is that
/// of the creases, and so is the torque, although the bars have self stresses. Tolerance 1e-9: residuals of 1e-12 over
/// the least singular value.
#[test]
fn folding_of_a_miura_ori() {
    let ran = Scene::new(MIURA).converged();
    assert_eq!(ran.path("press").branches[0].end, "arrived");
    let table = ran.out.table("press.csv");
    let tan = |angle: f64| (0.5 * angle).tan();
    for row in 0..table.len() {
        let at = |name: &str| table.at(row, name);
        let (zigzag, straight) = (at("fold_0_1_0_0"), at("fold_1_3_0_0"));
        assert!((tan(straight) - FRAC_PI_3.cos() * tan(zigzag)).abs() < 1e-9, "{zigzag} {straight}");
        assert!(at("fold_1_2_0_0").abs() < 1e-9 && at("curvature") == 0.0);
        let ratio = (0.5 * zigzag).cos().powi(2) * FRAC_PI_3.tan().powi(2);
        let [in_plane, bending] = ["poisson_in_plane", "poisson_bending"].map(at);
        assert!((in_plane + ratio).abs() < 1e-9 && (bending - ratio).abs() < 1e-9, "{in_plane} {bending} for {ratio}");
        // four creases of each kind, of length 1, from 1.2 and the angle that belongs to it
        let rest = 2.0 * (FRAC_PI_3.cos() * tan(1.2)).atan();
        let energy = 2.0 * ((zigzag - 1.2).powi(2) + (straight - rest).powi(2));
        assert!((at("energy_total") - energy).abs() < 1e-9 * (1.0 + energy), "{} for {energy}", at("energy_total"));
        let rate = FRAC_PI_3.cos() * (1.0 + tan(zigzag).powi(2)) / (1.0 + tan(straight).powi(2));
        let torque = 4.0 * (zigzag - 1.2 + (straight - rest) * rate);
        assert!((at("reaction") - torque).abs() < 1e-9, "{} for {torque}", at("reaction"));
    }
    assert!(table.len() > 15 && (table.last("drive") - 0.3).abs() < 1e-12);
}

const CYLINDER: &str = r#"
[sheet]
mesh = "open-star.fold"
domain = "screw"
cells = [4, 4]
[energy]
bars = { stiffness = 1e4 }
creases = { stiffness = 1.0, rest = { mode = [0.0, 0.3, 0.0], amplitude = 1.0 } }
[[drive]]
name = "roll"
rest = true
to = 1.0
[[drive]]
name = "stiffen"
stiffness = "bars"
to = inf
[[study]]
name = "rolling"
kind = "path"
drive = "roll"
stop = { curvature = 0.25 }
[[study]]
name = "full"
kind = "path"
drive = "roll"
[[study]]
name = "rigid"
kind = "path"
drive = "stiffen"
start = "full"
"#;

/// Claim: while rest angles are driven a straight sheet rolls up, and the path ends exactly at the curvature where it
/// is told to stop; a driven stiffness goes on to rigid bars, where the state is the one to which rigid bars relax.
/// Tolerances: those of located states; 1e-9 for energies from residuals of 1e-12.
#[test]
fn rolling_and_stiffening() {
    let ran = Scene::new(CYLINDER).converged();
    let rolling = ran.out.table("rolling.csv");
    assert_eq!(ran.path("rolling").branches[0].end, "stop");
    assert!((rolling.last("curvature").abs() - 0.25).abs() < 1e-9, "{}", rolling.last("curvature"));
    assert_eq!(rolling.at(0, "curvature"), 0.0);
    let rigid = ran.out.table("rigid.csv").last("energy_total");
    let relaxed = relax(&rolled("")).unwrap().state.total();
    assert!((rigid - relaxed).abs() < 1e-9, "{rigid} for {relaxed}");
}

/// Claim: the path of a tube along its rest angles ends where the tube relaxes to, with its energy; the work is the
/// energy. A tube of rigid panels stays, with energies that grow as the square of the way, so that the reaction is twice
/// the energy: its bars have four self stresses, of which none is left in it. Tolerance: 1e-9, of residuals of 1e-12;
/// the work of the rigid one is known to 1e-6, since rates of its tensions are not.
#[test]
fn tubes_along_their_rest_angles() {
    for (mesh, seam, bars) in [
        ("kresling-cell", "[6, 0]", "1e2"),
        ("kresling-cell", "[6, 0]", "inf"),
        ("open-star", "[1, 8]", "1e2"),
        ("helical-miura", "[1, 8]", "inf"),
    ] {
        let energy = format!(
            "[energy]\nbars = {{ stiffness = {bars} }}\ncreases = {{ stiffness = 1.0, rest = \"flat\" }}\n\
             [[drive]]\nname = \"rest\"\nrest = true\nto = 1.0\n\
             [[study]]\nname = \"path\"\nkind = \"path\"\ndraw = []\n\
             [[study]]\nname = \"relaxed\"\nkind = \"relax\"\ndraw = []\n"
        );
        let ran = Scene::on(&format!("mesh = \"{mesh}.fold\"\ndomain = \"tube\"\nseam = {seam}"), &energy).converged();
        let (relaxed, path) = (ran.relaxed("relaxed").energy.total, ran.out.table("path.csv"));
        let [found, work, reaction] = ["energy_total", "work", "reaction"].map(|column| path.last(column));
        assert!((found - relaxed).abs() <= 1e-9, "{mesh}, {bars}: {found} for {relaxed}");
        let known = if mesh == "helical-miura" { 1e-6 } else { 1e-9 };
        assert!((work - (found - path.at(0, "energy_total"))).abs() <= known, "{mesh}, {bars}: work {work}");
        if mesh == "helical-miura" {
            assert!((reaction - 2.0 * relaxed).abs() <= 1e-6, "{reaction} for {relaxed}");
        }
    }
}

/// Claim: the angle of one crease drives a cell of rigid bars and rigid panels, of which many depend on each other, to
/// wherever its single mechanism leads, in some tens of states; on a cylinder, about whose axis it does not bend, its path is
/// refused. Source: a relaxation with the lock at that angle. Tolerance: 1e-9 of energies of size 1 from residuals of 1e-12.
#[test]
fn locks_drive_redundant_panels() {
    for name in ["miura", "thick-miura", "square-twist", "eggbox"] {
        let sheet = generate(&Pattern::named(name).unwrap()).unwrap();
        let drawn: Vec<f64> = sheet.edges.iter().map(|edge| sheet.drawn_angle(edge).unwrap_or(0.0)).collect();
        let is_driven = |k: &usize| sheet.edges[*k].kind == EdgeKind::Crease && drawn[*k].abs() > 0.05;
        let crease = (0..sheet.edges.len()).find(is_driven).unwrap();
        let rigid = |builder: Builder, angle: f64| {
            builder.bars(RIGID).creases(1.0).lock(sheet.edges[crease].key, Some(angle)).build().unwrap()
        };
        let followed = |assembly: &Assembly, to: f64| {
            let drive = Drive { quantity: Driven::Lock(vec![crease]), to };
            follow_path(assembly, &drive, None, &PathOptions::default(), &mut |_, _| true)
        };
        for factor in [0.5, 0.7, 0.9, 1.1, 1.3] {
            let to = factor * drawn[crease];
            let assembly = rigid(Assembly::torus(sheet.clone(), [1, 1]), drawn[crease]);
            let branch = followed(&assembly, to).unwrap().remove(0);
            let what = format!("{name} to {factor}: {:?}", branch.end);
            assert!(branch.end == PathEnd::Arrived && branch.points.len() <= 60, "{what}, {}", branch.points.len());
            let expected = relax(&rigid(Assembly::torus(sheet.clone(), [1, 1]), to)).unwrap().state.total();
            let found = branch.points.last().unwrap().state.total();
            assert!((found - expected).abs() <= 1e-9, "{what}: {found} {expected}");
        }
        let screw = rigid(Assembly::screw(sheet.clone(), [1, 1]), drawn[crease]);
        let refused = followed(&screw, 0.9 * drawn[crease]).err();
        assert_eq!(refused, Some(PathFailure::Drive(DriveError::StaysStraight)), "{name}");
    }
}
