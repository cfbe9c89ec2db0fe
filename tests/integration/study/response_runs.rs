//! Studies of kind `response` as a user runs them: files, summary, starts and refusals.

use crate::common::{Scene, Table};
use foldwell::output::vtk::read_vtu;

/// Claim: the scenes of the book give what their chapter says: Miura-ori and the eggbox opposite ratios of the closed
/// forms in every direction of the table, the reference cell none; every mode is a state whose displacement is its
/// velocity, on several cells. Closed forms as in `response.rs`; tolerance 1e-10.
#[test]
fn scenes_of_the_book() {
    for (scene, cells, expected) in [("miura", 25, -2.043536631715009), ("eggbox", 16, 0.4329769047953801)] {
        let ran = Scene::of(&format!("{scene}-response")).converged();
        let (found, out) = (ran.response("elastic"), &ran.out);
        let [in_plane, bending] = [found.poisson.in_plane.unwrap(), found.poisson.bending.unwrap()];
        assert!((in_plane - expected).abs() <= 1e-10 && (in_plane + bending).abs() <= 1e-10, "{in_plane} {bending}");
        assert_eq!((found.poisson.opposite, found.table_rank), (Some(true), 3));
        assert!(ran.study("elastic").error.unwrap() <= 1e-12);
        let moduli = found.moduli.as_ref().unwrap();
        assert_eq!((moduli.rigid_modes.len(), moduli.softest.len(), &found.no_moduli), (3, 3, &None));
        assert_eq!(moduli.stretching.is_some(), scene == "miura", "rigid bars make them infinite");
        for (soft, rigid) in moduli.softest.iter().zip(&moduli.rigid_modes) {
            assert!((soft.ratio.unwrap() - soft.stiffness / rigid.stiffness).abs() <= 1e-14);
            assert!(soft.ratio.unwrap() <= 1.0 + 1e-12 && soft.ratio.unwrap() > 0.5);
        }
        let table = out.table("elastic-ratios.csv");
        assert_eq!(
            (table.header.join(","), table.len()),
            ("direction,in_plane,bending,no_in_plane,no_bending".to_owned(), 72)
        );
        for row in table.numbers() {
            let (s, c) = row[0].sin_cos();
            let expected = -(s * s - c * c * in_plane) / (c * c - s * s * in_plane);
            assert!((row[1] - expected).abs() <= 1e-10 * expected.abs().max(1.0), "{row:?} for {expected}");
            assert!((row[1] + row[2]).abs() <= 1e-10 * expected.abs().max(1.0));
        }
        let table = out.table("elastic.csv");
        assert_eq!((table.header.len(), table.len()), (1 + 6 + 6 + 12, 3));
        for (mode, row) in found.linear_modes.iter().zip(table.numbers()) {
            assert_eq!(&row[1..7], &[mode.strain, mode.curvature].concat()[..]);
        }
        let stresses = out.table("elastic-stresses.csv");
        assert_eq!((stresses.len(), stresses.rows[0].len()), (3, 1 + 6 + 24));
        for mode in 0..3 {
            let picture = read_vtu(&out.file(format!("elastic/elastic_{mode:04}.vtu"))).unwrap();
            assert!(picture.points.len() >= 4 * cells, "{} points", picture.points.len());
        }
        let picture = out.text("elastic.svg");
        assert!(picture.contains("mode 2 with curvature [0, 0, 1], drawn"), "rounding is not shown as curvature");
        for file in ["elastic.svg", "elastic-ratios.svg", "elastic.pvd"] {
            assert!(out.has(file), "{file}");
        }
    }
}

/// Claim: a study can start from a relaxation: on a cylinder the sheet has two modes and no ratio, and the lattice is
/// that of the relaxed state; the curvature is that of its table.
#[test]
fn a_rolled_up_state() {
    let ran = Scene::of("star-response").converged();
    let [periodic, cylinder] = ["periodic", "cylinder"].map(|name| ran.response(name));
    assert_eq!((periodic.linear_modes.len(), periodic.table_rank, periodic.lattice.axis), (3, 3, None));
    assert_eq!((cylinder.linear_modes.len(), cylinder.table_rank), (2, 2));
    assert_eq!(cylinder.no_moduli.as_deref(), Some("the sheet is rolled up"));
    assert!(periodic.moduli.is_none(), "its creases rest elsewhere");
    assert!(cylinder.poisson.in_plane.is_none() && cylinder.poisson.because.contains("rolled up"));
    let table = ran.out.table("rolled.csv");
    assert!((cylinder.lattice.curvature - table.last("curvature")).abs() <= 1e-12);
    assert!((cylinder.lattice.theta[1] - table.last("theta2")).abs() <= 1e-12);
    let axis = cylinder.lattice.axis.unwrap();
    assert!((axis.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() <= 1e-14);
}

/// Claim: a state whose bars are stretched has modes of its own lengths: an eggbox with soft bars, pushed by creases
/// that rest flat, has other edges than drawn, three modes, and opposite ratios. Source: the theorem holds in every
/// state.
#[test]
fn a_stretched_state() {
    let text = "[sheet]\ngenerate = { pattern = \"eggbox\", fold = 0.9 }\ndomain = \"torus\"\n[energy]\n\
                bars = { stiffness = 50.0 }\ncreases = { stiffness = 1.0, rest = \"flat\" }\nfacets = { stiffness = 5.0 }\n\
                [[study]]\nname = \"on\"\nkind = \"relax\"\ndraw = []\n\
                [[study]]\nname = \"there\"\nkind = \"response\"\nstart = \"on\"\ndraw = []\n";
    let ran = Scene::new(text).converged();
    let found = ran.response("there");
    assert_eq!((found.linear_modes.len(), found.poisson.opposite), (3, Some(true)));
    assert!(found.moduli.is_none() && found.no_moduli.as_ref().unwrap().contains("under stress"));
    assert!((found.poisson.in_plane.unwrap() - 0.43297691).abs() > 1e-2, "another state than the drawn one");
    assert!(ran.study("there").error.unwrap() <= 1e-12);
}

/// Claim: sheets without a response are refused before anything is computed, with what would be right.
#[test]
fn what_has_no_response_is_refused() {
    let refused = |sheet: &str, more: &str, expected: &str| {
        let study = format!("[[study]]\nname = \"a\"\nkind = \"response\"\n{more}");
        Scene::on(sheet, &study).refused(expected);
    };
    let miura = "generate = { pattern = \"miura\" }\n";
    refused(&format!("{miura}domain = \"patch\""), "", "that of a periodic sheet");
    let torus = format!("{miura}domain = \"torus\"\ncells = [2, 2]");
    refused(&torus, "start = { random = 0.1, seed = 1 }\n", "one cell");
    refused(&torus, "directions = 0\n", "the number is 0");
    refused(&torus, "grid = [2, 2]\n", "grid");
}

/// Returns the fold angle of a zigzag crease of Miura-ori (which runs in the plane of the sheet, along x and y), and
/// both ratios, of every row of a table.
fn ratios_along(table: &Table) -> Vec<[f64; 3]> {
    let columns = ["fold_0_1_0_0", "poisson_in_plane", "poisson_bending"];
    (0..table.len()).map(|row| columns.map(|name| table.at(row, name))).collect()
}

/// Claim: a trace has both ratios of every state as columns: those of the closed form `-(cos g tan t)^2` with
/// half the fold angle of the zigzags as `g`, which the first vertex's crease has; with rigid polygons there is none of
/// bending. The flat state, which the trace passes, has no ratio. Tolerance 1e-9: states close to 1e-13, over the least
/// singular value.
#[test]
fn ratios_along_trajectories() {
    let closed = |fold: f64| -((0.5 * fold).cos() * std::f64::consts::FRAC_PI_3.tan()).powi(2);
    let check = |rows: &[[f64; 3]], bends: bool| {
        let mut known = 0;
        for [fold, in_plane, bending] in rows {
            if in_plane.is_nan() {
                assert!(fold.abs() < 1e-3, "only next to the flat state: {fold}");
                continue;
            }
            let expected = closed(*fold);
            assert!((in_plane - expected).abs() <= 1e-9, "{fold}: {in_plane} for {expected}");
            assert!(if bends { (bending + expected).abs() <= 1e-9 } else { bending.is_nan() }, "{fold}: {bending}");
            known += 1;
        }
        known
    };
    let trace = ratios_along(&Scene::of("miura-poisson").ran().out.table("folding.csv"));
    assert!(check(&trace, true) > 50, "{} rows", trace.len());
    let folds = trace.iter().map(|row| row[0].abs());
    assert!(folds.clone().fold(0.0, f64::max) > 2.0 && folds.fold(9.0, f64::min) < 0.3);
    let rigid = Scene::of("miura-poisson").replaced("\"bending\"", "\"rigid\"").ran();
    assert!(check(&ratios_along(&rigid.out.table("folding.csv")), false) > 50);
    let study = "[[study]]\nname = \"a\"\nkind = \"trace\"\nresponse = \"rigid\"\n";
    Scene::on("generate = { pattern = \"miura-patch\" }", study).refused("one cell of a periodic sheet");
}
