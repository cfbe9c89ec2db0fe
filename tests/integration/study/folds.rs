//! Studies of kind `fold`: sheets from 0 to 100 % of their rest angles.

use crate::common::Scene;
use foldwell::scene::parse;
use foldwell::study::StudyResult;

/// Soft bars and facets, so that sheets fold which do not fold rigidly.
const ENERGY: &str = "[energy]\nbars = { stiffness = 1e3 }\nfacets = { stiffness = 10.0 }\n";

/// Returns a scene in which this sheet folds to these rest angles.
fn folding(sheet: &str, rest: &str) -> Scene {
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

/// Claim: a sheet that turns back on its way ends where it folds the other way, in words, and not after thousands of
/// states wound round and round; with bars nearer to rigid it arrives. Sheet: a preliminary base of 80 units, whose
/// bars are soft beside its creases.
#[test]
fn a_sheet_that_turns_back_ends() {
    let base = "<svg xmlns=\"http://www.w3.org/2000/svg\"><rect width=\"80\" height=\"80\" stroke=\"#000\"/>\
                <path d=\"M40 0V80M0 40H80\" stroke=\"#00f\"/><path d=\"M0 0L80 80\" stroke=\"#f00\"/></svg>";
    let scene = folding("mesh = \"base.svg\"", "target").with("base.svg", base);
    let turned = scene.ran();
    let study = &turned.report.summary.studies[0];
    let reason = study.reason.as_deref().unwrap_or_default();
    assert!(
        !study.converged && reason.contains("turned back at 56.4") && reason.contains("at \u{2212}2 %"),
        "{reason}"
    );
    assert!(turned.out.table("fold.csv").len() < 500);
    // a stop that was asked for is one, before the sheet has moved and on the other side
    for (stop, out) in [("states = 1", "first"), ("drive = -0.05", "beyond")] {
        let stopped = scene.clone().then(&format!("\nstop = {{ {stop} }}\n")).out(out).converged();
        let said = stopped.report.summary.studies[0].sentence();
        assert!(said.contains("stop at fold"), "{stop}: {said}");
    }
    scene.replaced("bars = { stiffness = 1e3 }", "bars = { stiffness = 1e4 }").out("stiff").converged();
}
