//! Studies of kind `fold`: sheets from 0 to 100 % of their rest angles.

use crate::common::Scene;
use foldwell::scene::parse;
use foldwell::study::StudyResult;

/// Soft bars and facets, so that sheets fold which do not fold rigidly.
const ENERGY: &str = "[energy]\nbars = { stiffness = 1e3 }\nfacets = { stiffness = 10.0 }\n";

/// Returns a scene in which this sheet folds to these rest angles.
pub(super) fn folding(sheet: &str, rest: &str) -> Scene {
    let creases = format!("creases = {{ stiffness = 1.0, rest = \"{rest}\" }}\n");
    Scene::on(sheet, &format!("{ENERGY}{creases}[[study]]\nname = \"fold\"\nkind = \"fold\"\ndraw = []"))
}

/// Claim: a study of kind `fold` has the table of a path along the driven rest angles, to the last digit, from the
/// drawn sheet without energy to 100 %.
#[test]
fn folding_is_a_path_along_the_rest_angles() {
    let scene = folding("mesh = \"waterbomb-base.fold\"", "assigned");
    let driven = "[[drive]]\nname = \"fold\"\nrest = true\nto = 1\n[[study]]\nname = \"fold\"\nkind = \"path\"";
    let path = scene.clone().replaced("[[study]]\nname = \"fold\"\nkind = \"fold\"", driven).out("path");
    let (fold, path) = (scene.converged(), path.converged());
    assert_eq!(fold.out.text("fold.csv"), path.out.text("fold.csv"));
    let table = fold.out.table("fold.csv");
    let last = table.len() - 1;
    assert!(table.at(0, "drive") == 0.0 && table.at(0, "energy_total") < 1e-20, "{}", table.at(0, "energy_total"));
    assert_eq!(table.at(last, "drive"), 1.0);
    let study = &fold.report.summary.studies[0];
    assert!(study.kind == "fold" && study.sentence().contains("arrived at fold 100 %"), "{}", study.sentence());
    assert_eq!(study.result, path.report.summary.studies[0].result);
}

/// Claim: the patterns of the generators that fold, and crease patterns of `meshes` and `tests`, fold to 100 % of their
/// letters or target angles; the book's chapter of `fold` lists them.
#[test]
fn patterns_fold_to_the_end() {
    let sheets = [
        ("generate = { pattern = \"eggbox\" }\ncells = [3, 3]", "assigned"),
        ("generate = { pattern = \"four-parallelogram\" }\ncells = [2, 2]", "assigned"),
        ("generate = { pattern = \"kresling\" }", "assigned"),
        ("generate = { pattern = \"hypar\", pleats = 4 }", "assigned"),
        ("generate = { pattern = \"resch\" }\ncells = [2, 2]", "target"),
        ("mesh = \"waterbomb-base.fold\"", "assigned"),
        ("mesh = \"cases/fold/square-twist-rigid.fold\"", "assigned"),
        ("mesh = \"cases/fold/simulator-flat.fold\"", "assigned"),
    ];
    for (sheet, rest) in sheets {
        let ran = folding(sheet, rest).ran();
        let study = &ran.report.summary.studies[0];
        let Some(StudyResult::Path(path)) = &study.result else { panic!("{sheet}: {:?}", study.reason) };
        assert_eq!((path.branches[0].end.as_str(), path.branches[0].drive), ("arrived", Some(1.0)), "{sheet}");
    }
}

/// Claim: a drive, creases that rest as drawn, and a start in a state that is folded already are refused at their
/// place, with what would be right.
#[test]
fn what_does_not_fold_is_refused() {
    let sheet = "mesh = \"waterbomb-base.fold\"";
    let scene = folding(sheet, "assigned");
    let text = "[sheet]\nmesh = \"a.fold\"\n[[study]]\nname = \"f\"\nkind = \"fold\"\ndrive = \"d\"\n";
    let refused = parse(text, "s.toml").unwrap_err().to_string();
    assert!(refused.contains("6:9") && refused.contains("a study of kind fold has no drive"), "{refused}");
    folding(sheet, "drawn").refused("the creases rest as they are drawn, so that nothing folds");
    let later = "[[study]]\nname = \"again\"\nkind = \"fold\"\nstart = \"fold\"\n";
    scene.then(later).refused("the path of study `again` ends where it begins");
    Scene::on(
        sheet,
        "[energy]\nbars = { stiffness = 1.0 }\nfacets = { stiffness = inf }\n[[study]]\nname = \"f\"\nkind = \"fold\"",
    )
    .refused("the scene has no soft creases or facets");
}

/// A square of 80 units with these lines on it.
pub(super) fn square(lines: &str) -> String {
    format!("<svg xmlns=\"http://www.w3.org/2000/svg\"><rect width=\"80\" height=\"80\" stroke=\"#000\"/>{lines}</svg>")
}

/// Claim: a preliminary base folds to its target angles, whose energy is 0, without a limit point, a branch point or a
/// turn on the way: where the coordinates that are held against rotations would come to hold the shape, others are
/// held. With others than these the path seemed to turn back at 56.43 %.
#[test]
fn held_coordinates_do_not_turn_a_path_back() {
    let lines = "<path d=\"M40 0V80M0 40H80\" stroke=\"#00f\"/><path d=\"M0 0L80 80\" stroke=\"#f00\"/>";
    let scene = folding("mesh = \"base.svg\"", "target").with("base.svg", square(lines));
    for (bars, out) in [("1e1", "soft"), ("1e3", "usual"), ("1e4", "stiff")] {
        let scene = scene.clone().replaced("bars = { stiffness = 1e3 }", &format!("bars = {{ stiffness = {bars} }}"));
        let folded = scene.then("\nswitch = true\n").out(out).converged();
        let branch = &folded.path("fold").branches[0];
        assert_eq!((branch.end.as_str(), branch.events.len()), ("arrived", 0), "{bars}: {:?}", branch.events);
        assert!(branch.energy.is_some_and(|energy| energy < 1e-20), "{bars}: {:?}", branch.energy);
        let said = folded.report.summary.studies[0].sentence();
        assert!(said.contains("6 of 6 hinges on the side of their rest angles"), "{said}");
    }
    // a stop that was asked for is one, before the sheet has moved
    let stopped = scene.then("\nstop = { states = 1 }\n").out("first").converged();
    assert!(stopped.report.summary.studies[0].sentence().contains("stop at fold"));
}

/// Claim: a sheet with motions that cost nothing, faces of Ron Resch's pattern that hang at vertices, is stable at rest,
/// and its path has no branch points and no negative eigenvalues, which would be those of rounding errors; that it has
/// no path is said. Source: its energy is a sum of squares that vanishes along the way.
#[test]
fn motions_that_cost_nothing_are_no_branch_points() {
    let ran = folding("generate = { pattern = \"resch\" }\ncells = [2, 1]", "target").ran();
    let (table, study) = (ran.out.table("fold.csv"), &ran.report.summary.studies[0]);
    assert!((0..table.len()).all(|row| table.at(row, "negative_eigenvalues") == 0.0));
    let Some(StudyResult::Path(path)) = &study.result else { panic!("{:?}", study.reason) };
    assert_eq!(path.branches[0].events, vec![]);
    assert!(study.reason.as_ref().is_some_and(|reason| reason.contains("has motions that cost nothing")), "{study:?}");
}

/// Claim: a fold that arrives says how many hinges end on the side of their rest angles, and the energy that is left.
/// Source: one of four creases at a vertex folds to the other side than the three others (Maekawa's theorem), here the
/// one that is to fold least.
#[test]
fn hinges_on_the_other_side_are_said() {
    let lines = "<path d=\"M0 30L40 40L80 30M40 40V80\" stroke=\"#00f\"/><path d=\"M40 0V40\" stroke=\"#00f\" opacity=\"0.1\"/>";
    let folded = folding("mesh = \"four.svg\"", "target").with("four.svg", square(lines)).converged();
    let branch = &folded.path("fold").branches[0];
    let sides = branch.rest_sides.unwrap();
    assert_eq!((branch.end.as_str(), sides.hinges, sides.on_rest_side), ("arrived", 4, 3));
    let said = folded.report.summary.studies[0].sentence();
    let words = format!("energy {:.9e}, 3 of 4 hinges on the side of their rest angles", branch.energy.unwrap());
    assert!(branch.energy > Some(1.0) && said.contains(&words), "{said}");
    // the one on the other side is off by more than its own rest angle, 18 degrees
    assert!(sides.farthest > 18f64.to_radians() && said.contains(" degrees off"), "{said}");
}

/// Claim: facets, whose rest angles are 0 but for rounding errors, are not counted among the hinges that fold to a side.
/// Source: 3 x 3 cells of Miura-ori have 40 creases inside, as they are drawn.
#[test]
fn hinges_that_rest_flat_have_no_side() {
    let folded = folding("generate = { pattern = \"miura\" }\ncells = [3, 3]", "assigned").converged();
    let sides = folded.path("fold").branches[0].rest_sides.unwrap();
    assert_eq!((sides.hinges, sides.on_rest_side), (40, 40));
    assert!(sides.farthest < 1e-6, "{}", sides.farthest);
}

/// Claim: two sheets in one drawing fold to 100 % as one of them does: where what is held against rotations is chosen anew,
/// each turns back by its own motion. Source: they do not touch each other.
#[test]
fn two_sheets_fold_beside_each_other() {
    let square = |x: f64, letter: &str| {
        let side = [[0.0, 0.0], [100.0, 0.0], [100.0, 100.0], [0.0, 100.0]].map(|[u, v]| [x + u, v]);
        let rim: String = (0..4)
            .map(|k| {
                let ([a, b], [c, d]) = (side[k], side[(k + 1) % 4]);
                format!("<line x1=\"{a}\" y1=\"{b}\" x2=\"{c}\" y2=\"{d}\" stroke=\"#000000\"/>")
            })
            .collect();
        let end = x + 100.0;
        format!("{rim}<line x1=\"{x}\" y1=\"50\" x2=\"{end}\" y2=\"50\" stroke=\"{letter}\"/>")
    };
    let drawing = square(0.0, "#ff0000") + &square(200.0, "#0000ff");
    let svg = format!("<svg xmlns=\"http://www.w3.org/2000/svg\">{drawing}</svg>");
    let energy =
        "bars = { stiffness = 1e3 }\ncreases = { stiffness = 1.0, rest = \"assigned\" }\nfacets = { stiffness = 10.0 }";
    let study = format!("[energy]\n{energy}\n[[study]]\nname = \"f\"\nkind = \"fold\"\ndraw = []");
    let ran = Scene::on("mesh = \"two.svg\"", &study).with("two.svg", svg).converged();
    let branch = &ran.path("f").branches[0];
    assert!(branch.end == "arrived" && branch.energy.is_some_and(|energy| energy < 1e-20), "{branch:?}");
}
