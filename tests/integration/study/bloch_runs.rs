//! The study `bloch`, from a scene to its files.

use crate::common::{Scene, mesh_folder};
use approx::{abs_diff_eq, assert_abs_diff_eq};
use foldwell::analysis::bloch::{Decay, Determinant, Rigidity};
use foldwell::sheet::generate::{Pattern, Random, generate};

/// Claim: the scene of the reference cell writes all its files, its decay rates are the stored ones, and the
/// polarization is zero; a resumed run keeps the study, and its summary is read back.
#[test]
fn reference_cell() {
    let scene = Scene::of("star-bloch");
    let ran = scene.converged();
    let found = ran.bloch("modes");
    assert!(found.symmetry_error.unwrap() <= 1e-14 && found.pairing_error.unwrap() <= 1e-12);
    let decay = &found.decay[2];
    assert_eq!((decay.q1, decay.kappa2.len()), (0.9, 4));
    // the stored number, see tests/cases/open-star.json
    assert!(abs_diff_eq!(decay.kappa2[3], 0.137_712_570_259_862, epsilon = 1e-12), "{decay:?}");
    assert_eq!((found.polarization, found.order_at_origin, found.directions.len()), (Some([0.0, 0.0]), Some(4), 2));
    assert_eq!((found.zero_lines, found.lines[0].passes), (Some(1), 2));
    let positive: f64 = found.regions.iter().filter(|region| region.sign > 0).map(|region| region.fraction).sum();
    assert_abs_diff_eq!(positive, found.positive_fraction.unwrap(), epsilon = 0.01);
    let names = ["modes.csv", "modes_bands.csv", "modes.pvd", "modes.svg", "modes/modes_determinant.vti"];
    let pictures = ["modes/modes_zero_lines.vtp", "modes/modes_mode_0000.vtu", "modes/modes_mode_0001.vtu"];
    for name in names.iter().chain(&pictures) {
        assert!(ran.out.has(name), "{name}");
    }
    assert_eq!((ran.out.table("modes.csv").len(), ran.out.table("modes_bands.csv").len()), (7 * 4, 151));
    let again = scene.resumed().ran();
    assert_eq!(again.report.kept, ["modes"]);
    assert_eq!(again.bloch("modes"), found);
}

/// Claim: on the kirigami cell the study reports by how much the decay rates fail to pair; it has no zero lines.
#[test]
fn kirigami_cell() {
    let ran = Scene::of("kirigami-bloch").ran();
    let found = ran.bloch("modes");
    assert!(
        found.pairing_error.unwrap() > 0.1
            && found.symmetry_error.unwrap() > 0.1
            && found.imaginary_part.unwrap() > 0.1,
        "{found:?}"
    );
    assert_eq!((found.polarization, found.on_circle), (Some([0.5, 0.5]), Some([0.0, 0.0])));
    assert_eq!((found.zero_lines, found.positive_fraction, found.order_at_origin), (None, None, None));
}

/// Claim: a rigid polygon that is cut by the rim of the drawn cell is rigid like any other: the second kirigami scene
/// has a determinant, and the polarization that the scan of random cells found.
#[test]
fn polygons_cut_by_the_rim_are_rigid() {
    let ran = Scene::of("kirigami-polarized-bloch").ran();
    let found = ran.bloch("modes");
    assert_eq!((found.polarization, found.on_circle), (Some([-1.0, 1.5]), Some([0.0, 0.0])));
}

/// Claim: the scene of the cylinder gives modes of the rolled state: a determinant that vanishes to second order at `q
/// = 0` and at the rotation angles of the lattice to 1e-12 (theory, section 8), symmetric, with rates that pair; mode
/// shapes are velocities of the rolled cells; the rings are drawn; and a resumed run still has the state.
#[test]
fn cylinder() {
    let scene = Scene::of("star-cylinder-bloch");
    let ran = scene.converged();
    let found = ran.bloch("modes");
    assert!(found.symmetry_error.unwrap() <= 1e-12 && found.pairing_error.unwrap() <= 1e-9);
    println!("theta {:?}, from a zero {:e}", found.theta, found.theta_to_zero.unwrap());
    assert_eq!((found.order_at_origin, found.polarization), (Some(2), Some([0.0, 0.0])));
    assert!(found.theta.unwrap().iter().all(|theta| theta.abs() > 0.01));
    assert!(found.theta_to_zero.unwrap() <= 1e-12, "{:?}", found.theta_to_zero);
    assert_eq!(ran.out.text("modes.svg").matches("r=\"9\"").count(), 2);
    let points = |file: &str| foldwell::output::vtk::read_vtu(&ran.out.file(file)).unwrap().points;
    let [mode, rolled] = ["modes/modes_mode_0000.vtu", "rolled/rolled_0001.vtu"].map(points);
    let apart = mode.iter().zip(&rolled).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    assert!(mode.len() == rolled.len() && apart <= 1e-12, "{apart:e}");
    std::fs::remove_file(ran.out.file("modes.csv")).unwrap();
    let again = scene.resumed().ran();
    assert_eq!(again.report.kept, ["rolled"]);
    assert_eq!(again.bloch("modes"), found);
}

/// Claim: on triangulated Miura-ori at `q1 = 0.5` all four roots are double, which the study reports; their rates are
/// those of the double zeros of the determinant (found separately, by elimination with 60 digits on the same mesh) and
/// pair. Tolerance: 1e-13, although a double root of the polynomial is known only to 4e-8.
#[test]
fn double_roots() {
    let scene = Scene::new(include_str!("../../cases/miura-double-roots.toml"));
    let ran = scene.replaced("miura-double-roots.fold", "cases/miura-double-roots.fold").ran();
    let found = ran.bloch("modes");
    let decay = &found.decay[0];
    assert_eq!((decay.multiplicity.as_slice(), found.ill_conditioned), ([2; 4].as_slice(), 0));
    let expected = 0.736_241_605_026_287_8;
    for (kappa, sign) in decay.kappa2.iter().zip([-1.0, -1.0, 1.0, 1.0]) {
        assert_abs_diff_eq!(*kappa, sign * expected, epsilon = 1e-13);
    }
    assert!(found.pairing_error.unwrap() <= 1e-13 && found.pairing_condition.unwrap() <= 1e3, "{found:?}");
}

/// Claim: the scene of the strip writes its two tables, its edge modes decay as predicted to 1e-6, and the scene of the
/// interface finds the three modes that the windings predict, with rates of the slowest that agree too.
#[test]
fn strips_and_interfaces() {
    let ran = Scene::of("star-strip").ran();
    let strip = ran.bloch("modes").strip.as_ref().unwrap();
    assert_eq!((&strip.zero_modes, &strip.self_stresses), (&vec![4; 6], &vec![0; 6]));
    assert_eq!((strip.compared, strip.unmatched, strip.interface_predicted.len()), (12, 0, 0));
    assert!(strip.error.unwrap() <= 1e-6, "{:?}", strip.error);
    assert_eq!(ran.out.table("modes-strip.csv").len(), 12);
    let counts = ran.out.text("modes-modes.csv");
    assert!(counts.lines().nth(1).unwrap().starts_with("0.0,0.0,3,3,3,"), "{counts}");
    let ran = Scene::of("kirigami-interface").ran();
    let strip = ran.bloch("modes").strip.as_ref().unwrap();
    assert_eq!((&strip.interface_zero_modes, &strip.interface_predicted), (&vec![3; 3], &vec![Some(3); 3]));
    assert_eq!((&strip.interface_self_stresses, strip.unmatched), (&vec![0; 3], 0));
    assert!(strip.error.unwrap() <= 1e-6, "{:?}", strip.error);
}

/// Claim: at `q1 = 0` the determinant has a root of multiplicity four at 1, where the matrix has three null vectors: it
/// is found to all digits, with its multiplicity. The coefficients alone know such roots to four digits, and where no
/// root is known accurately enough to be compared the pairing error is null instead of zero. Tolerance: rounding times
/// the condition, below 1e3.
#[test]
fn fourfold_roots() {
    let ran = scene("generate = { pattern = \"random\" }", "q1 = [0]").ran();
    let found = ran.bloch("a");
    assert!(found.ill_conditioned == 0 && found.decay[0].multiplicity == [4; 4], "{found:?}");
    assert!(found.decay[0].kappa2.iter().all(|kappa| kappa.abs() <= 1e-12) && found.pairing_error.unwrap() <= 1e-12);
    let rigidity = Rigidity::of_sheet(&generate(&Pattern::Random(Random::default())).unwrap(), false).unwrap();
    let alone = Decay::new(&Determinant::new(&rigidity).unwrap(), 0, 0.0).unwrap().pairing();
    assert!(alone.error.is_none() && alone.condition.is_none() && alone.left_out > 0, "{alone:?}");
}

/// Claim: on a triangulated eggbox the determinant touches zero on lines without changing its sign, which is said
/// instead of a number of lines; its roots are all double, and their rates pair. Tolerance: rounding times the largest
/// condition of the roots, below 1e3.
#[test]
fn rates_without_zero_lines() {
    let energy = "generate = { pattern = \"eggbox\" }\n[energy]\nfacets = { stiffness = 1.0 }";
    let ran = scene(energy, "").converged();
    let found = ran.bloch("a");
    assert!(found.zero_lines.is_none() && found.lines.is_empty(), "{found:?}");
    assert!(found.no_zero_lines.as_ref().unwrap().contains("touches zero along a line"), "{found:?}");
    assert!(found.pairing_error.unwrap() < 1e-12 && found.pairing_condition.unwrap() < 1e3, "{found:?}");
    let away = found.decay.iter().filter(|decay| decay.q1.abs() > 0.1);
    assert!(away.flat_map(|decay| &decay.multiplicity).all(|&count| count == 2), "{found:?}");
}

/// Returns a scene with a study `a` of a sheet.
fn scene(sheet: &str, keys: &str) -> Scene {
    Scene::on(sheet, &format!("[[study]]\nname = \"a\"\nkind = \"bloch\"\ndraw = []\n{keys}"))
}

/// Claim: strips that cannot be, and wavenumbers that are no numbers, are refused before anything is written.
#[test]
fn strips_that_cannot_be() {
    let misfit = format!("strip = {{ cells = 20, other = '{}' }}", mesh_folder().join("kirigami.fold").display());
    let cases = [
        ("strip = { cells = 4 }", "has no inside"),
        ("strip = { cells = 100000 }", "coordinates, more than"),
        ("strip = { cells = 20, width = 1 }", "width"),
        ("strip = { cells = 20, other = \"none.fold\" }", "none.fold"),
        (&misfit, "do not fit"),
        ("zero_modes_at = [[nan, 0]]", "the number is NaN"),
    ];
    for (keys, expected) in cases {
        scene("generate = { pattern = \"random\" }", keys).refused(expected);
    }
}

/// Claim: an impossible study is refused before anything is written.
#[test]
fn what_cannot_be_done() {
    let cases = [
        ("generate = { pattern = \"miura\" }", "", "conditions (bars and rigid facets)"),
        ("generate = { pattern = \"kresling\" }", "", "without lattice vectors"),
        ("generate = { pattern = \"random\" }", "path = [[0, 0], [1, 0]]", "bands need an energy of springs"),
        ("generate = { pattern = \"random\" }", "density = {}", "bands need an energy of springs"),
        ("generate = { pattern = \"random\" }", "density = { bins = 0 }", "the number is 0"),
        ("generate = { pattern = \"random\" }", "modes = [[0.1, inf]]", "the number is inf"),
        ("generate = { pattern = \"random\" }", "q1 = [nan]", "the number is NaN"),
        ("generate = { pattern = \"random\" }", "grid = [0, 8]", "0"),
        ("generate = { pattern = \"random\" }", "modes = [[0.1]]", "the list has 1 value"),
        ("generate = { pattern = \"random\" }", "kappa = 1", "kappa"),
        ("generate = { pattern = \"random\" }", "start = \"rolled\"", "no earlier study is called"),
        (
            "generate = { pattern = \"random\" }",
            "start = { random = 0.1, seed = 1 }",
            "a state that an earlier study found",
        ),
        ("generate = { pattern = \"random\" }", "start = \"a.vtu\"", "a state that an earlier study found"),
    ];
    for (sheet, keys, expected) in cases {
        scene(sheet, keys).refused(expected);
    }
}

/// Claim: a state that is not of one cell is refused, and bands of one with a lock, or of the drawn one with a law that is
/// no spring at rest; a state of springs has bands; a
/// sheet without a determinant is a study that failed, and polygons that bend have one.
#[test]
fn states_that_cannot_be_asked() {
    let relaxed = |domain: &str, keys: &str| {
        let energy = "[energy]\nbars = { stiffness = 100.0 }\ncreases = { stiffness = 1.0 }\n[[study]]\nname = \"r\"\nkind = \
                      \"relax\"\ntolerance = 1e-9";
        scene(&format!("generate = {{ pattern = \"random\" }}\n{domain}\n{energy}"), &format!("start = \"r\"\n{keys}"))
    };
    let cases = [
        ("domain = \"patch\"", "", "those of a state of one cell"),
        ("domain = \"torus\"\ncells = [2, 1]", "", "those of a state of one cell"),
        (
            "domain = \"torus\"",
            "path = [[0, 0], [1, 0]]\n[[lock]]\ncrease = [0, 1, 0, 0]",
            "bands need an energy of springs",
        ),
    ];
    for (domain, keys, expected) in cases {
        relaxed(domain, keys).refused(expected);
    }
    let with_law = |law: &str| {
        let bars = format!("bars = {{ stiffness = 100.0, law = {law} }}\ncreases = {{ stiffness = 1.0 }}");
        scene(&format!("generate = {{ pattern = \"random\" }}\n[energy]\n{bars}"), "path = [[0, 0], [1, 0]]")
    };
    let cable = "{ kind = \"bilinear\", ratio = 0.0, at = [0.0, inf] }";
    with_law(cable).refused("bands of the drawn state need springs at rest, and the law of the bars is none there");
    with_law("{ kind = \"green-lagrange\" }").converged();
    let ran = relaxed("domain = \"torus\"", "").ran();
    let still = ran.bloch("a");
    assert_eq!((still.theta, still.order_at_origin), (Some([0.0; 2]), Some(4)));
    assert!(relaxed("domain = \"torus\"", "path = [[0, 0], [1, 0]]").converged().out.has("a_bands.csv"));
    let ran = scene("generate = { pattern = \"random-developable\" }", "").converged();
    let reason = ran.bloch("a").no_determinant.as_ref().unwrap();
    assert!(reason.contains("vanishes at all wavenumbers"), "{reason}");
    let bending = "generate = { pattern = \"miura\" }\n[energy]\nfacets = { stiffness = 1.0 }";
    let out = scene(bending, "").converged().out;
    assert!(out.has("a.csv") && !out.has("a.svg") && !out.has("a.pvd"));
}

/// Claim: cells with three faces at an edge, whose bars are more than the coordinates, have bands, though no determinant: at
/// `q = 0` mass times the squares of the frequencies of one cell on a torus, and at `q1 = pi` those that two cells have besides. Asked
/// for more they are refused. Tolerance: 1e-9 of the largest.
#[test]
fn bands_of_assemblies_need_no_determinant() {
    let mesh = "{\"vertices_coords\": [[0, 0, 0], [1, 0.1, 0.05], [0.5, 0.4, 0.8], [0.2, 1.1, 0], [1.2, 1.2, 0.05], [2, 0.1, 0], \
                [2.2, 1.2, 0], [0.7, 1.5, 0.8]], \"faces_vertices\": [[0, 1, 4], [0, 4, 3], [1, 5, 6], [1, 6, 4], [0, 2, 7], [0, 7, 3], \
                [2, 1, 4], [2, 4, 7]], \"foldwell:lattice\": [[2, 0.1, 0], [0.2, 1.1, 0]]}";
    let text = |cells: &str, study: &str| {
        let sheet = format!("mesh = \"sandwich.fold\"\ndomain = \"torus\"\nlattice = \"fixed\"\ncells = {cells}");
        let energy = "[mass]\nvertex = 0.5\n[energy]\nbars = { stiffness = 30.0 }\ncreases = { stiffness = 1.0 }";
        Scene::on(&sheet, &format!("{energy}\n[[study]]\nname = \"a\"\ndraw = []\n{study}")).with("sandwich.fold", mesh)
    };
    let bands = text("[1, 1]", "kind = \"bloch\"\npath = [[0, 0], [3.141592653589793, 0]]").converged();
    assert!(bands.bloch("a").no_determinant.as_ref().is_some_and(|why| why.contains("11 conditions")));
    let table = bands.out.table("a_bands.csv");
    let at = |row: usize| (0..9).map(move |band| (row, band));
    let both = at(0).chain(at(table.len() - 1)).map(|(row, band)| table.at(row, &format!("band_{band}")));
    let mut both: Vec<f64> = both.collect();
    both.sort_by(f64::total_cmp);
    let two = text("[2, 1]", "kind = \"modes\"\neigenvalues = 18").converged();
    let squares: Vec<f64> =
        two.modes("a").frequencies.iter().flatten().flatten().map(|frequency| frequency * frequency).collect();
    assert_eq!(squares.len(), 18);
    for (band, square) in both.iter().zip(&squares) {
        assert!((band - 0.5 * square).abs() <= 1e-9 * squares[17], "{both:?} {squares:?}");
    }
    text("[1, 1]", "kind = \"bloch\"\npath = [[0, 0], [1, 0]]\nzero_modes_at = [[0, 0]]").refused("no determinant");
}
