//! Fold angles of a file that are not the drawn ones: targets, as crease pattern editors and simulators write them, and
//! the rest angles that follow from them and from letters.

use std::f64::consts::PI;

use crate::common::Scene;
use foldwell::scene::SceneError;
use foldwell::sheet::{Assignment, Info, Sheet, fold, obj};
use foldwell::{Assembly, Rest};

/// A half-folded sheet as Origami Simulator exports it: drawn at 109.84 degrees with 6 digits, target 180.
pub(crate) const HALF_FOLDED: &str = include_str!("../../cases/fold/simulator-half-folded.fold");
/// A waterbomb base as Origami Simulator exports it before folding, in the plane y = 0.
pub(crate) const FLAT: &str = include_str!("../../cases/fold/simulator-flat.fold");

/// Returns two triangles with the crease [0, 1] between them, folded by `degrees`; the edges [0, 1] and [1, 2], their
/// letters and their angles are on lines 4, 5 and 6. The second edge has one face.
fn hinge(degrees: f64, letter: &str, angle: &str) -> String {
    hinge_and_rim(degrees, [letter, "B"], [angle, "null"])
}

fn hinge_and_rim(degrees: f64, letters: [&str; 2], angles: [&str; 2]) -> String {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let angles = angles.join(",");
    format!(
        "{{\"vertices_coords\": [[0,0,0],[1,0,0],[0.2,1,0],[0,{:?},{sin:?}]],\n\"faces_vertices\": [[0,1,2],[1,0,3]],\n\
         \"edges_vertices\": [\n[0,1],[1,2]],\n\"edges_assignment\": {letters:?},\n\"edges_foldAngle\": [{angles}]}}",
        -cos
    )
}

fn read(text: &str) -> Sheet {
    fold::parse(text, "a.fold").unwrap()
}

/// Claim: fold angles that differ from the drawn ones are targets and are counted; those that agree, up to full turns
/// and 1e-3 degrees, say nothing that the drawing does not, so that nothing is kept. Source: FOLD 1.2,
/// `edges_foldAngle`; Origami Simulator writes its targets there while the sheet is folded.
#[test]
fn angles_that_are_not_drawn_are_targets() {
    let half = read(HALF_FOLDED);
    let crease = half.edges.iter().find(|edge| (edge.key.i, edge.key.j) == (1, 4)).unwrap();
    assert_eq!(half.targets[&crease.key], PI);
    // six digits of the coordinates
    assert!((half.drawn_angle(crease).unwrap() - 109.84f64.to_radians()).abs() < 2e-6);
    let info = Info::new(&half);
    assert_eq!((info.target_angles, half.targets.len()), (1, 3), "two flat diagonals are drawn as their targets");
    assert!(info.to_string().contains("target angles          1 fold angle of the file differs"), "{info}");
    let flat = read(FLAT);
    assert_eq!(Info::new(&flat).target_angles, 6);
    assert!(flat.edges.iter().all(|edge| flat.drawn_angle(edge).unwrap_or(0.0).abs() < 1e-15));
    for drawn in ["30", "390", "-330.0", "30.0009", "null"] {
        assert!(read(&hinge(30.0, "V", drawn)).targets.is_empty(), "{drawn}");
    }
    assert_eq!(read(&hinge(30.0, "V", "30.002")).targets.len(), 1);
}

/// Claim: an angle on the other side than its letter, or beyond a flat fold, is refused at its place. Source: FOLD 1.2:
/// angles lie in [-180, 180], and their sign should match the letter.
#[test]
fn angles_that_no_edge_can_have_are_refused() {
    let cases = [
        (hinge(0.0, "M", "90"), "is assigned M and has the fold angle 90 degrees; mountains have negative angles"),
        (hinge(0.0, "V", "-180"), "is assigned V and has the fold angle -180 degrees"),
        (hinge(180.0, "V", "-180"), "is assigned V and has the fold angle -180 degrees"),
        (hinge(0.0, "V", "200"), "has the fold angle 200 degrees; a target angle should be between -180 and 180"),
    ];
    for (text, words) in cases {
        let message = fold::parse(&text, "a.fold").unwrap_err().to_string();
        assert!(
            message.starts_with("a.fold:6:21: edge 0 of the list, [0, 1],") && message.contains(words),
            "{message}"
        );
    }
    // a drawn mountain and a full turn is no valley, though its number is positive
    let turned = fold::parse(&hinge(-30.0, "V", "330"), "a.fold").unwrap_err().to_string();
    assert!(turned.contains("is assigned V, but the vertices draw"), "{turned}");
    // an edge of one face has no fold angle
    read(&hinge_and_rim(0.0, ["V", "B"], ["90", "-90"]));
    let copies = "{\"vertices_coords\": [[0,0],[1,0],[1,1],[0,1]],\n\"faces_vertices\": [[0,1,2],[0,2,3]],\n\
                  \"foldwell:lattice\": [[1,0,0],[0,1,0]],\n\"edges_vertices\": [[0,1],[3,2]],\n\
                  \"edges_foldAngle\": [20, 30]}";
    let message = fold::parse(copies, "a.fold").unwrap_err().to_string();
    assert!(
        message.starts_with("a.fold:5:25:") && message.contains("another copy of it in the drawing has 20"),
        "{message}"
    );
    assert_eq!(read(&copies.replace("30", "null")).targets.len(), 1);
}

/// Claim: creases that a simulator left on the other side than letter and target are accepted and counted, one of them
/// or, where the pattern is folded backwards, all; without targets they are refused.
#[test]
fn creases_may_be_drawn_on_the_other_side_than_their_targets() {
    let strip = |folds: [f64; 3]| {
        let (mut at, mut heading) = ([0.0, 0.0], 0.0);
        let mut points = Vec::new();
        for k in 0..5 {
            points.extend([0, 1].map(|y| format!("[{:?},{y},{:?}]", at[0], at[1])));
            heading += if (1..4).contains(&k) { folds[k - 1] } else { 0.0 };
            at = [at[0] + f64::cos(heading), at[1] + f64::sin(heading)];
        }
        format!(
            "{{\"vertices_coords\": [{}], \"faces_vertices\": [[0,2,3,1],[2,4,5,3],[4,6,7,5],[6,8,9,7]],\n\
             \"edges_vertices\": [[2,3],[4,5],[6,7]], \"edges_assignment\": [\"V\",\"V\",\"V\"],\
             \"edges_foldAngle\": [180,180,180]}}",
            points.join(",")
        )
    };
    let one_off = read(&strip([0.5, -0.1, 0.5]));
    assert_eq!(one_off.targets.len(), 3);
    assert_eq!(one_off.edges.iter().filter(|edge| one_off.assignment(edge) == Assignment::Valley).count(), 3);
    assert_eq!(one_off.drawn_against_targets(), [1, 3]);
    let backwards = Info::new(&read(&strip([-0.5, -0.1, -0.5])));
    assert_eq!((backwards.drawn_against_targets, backwards.target_angles), (3, 3));
    assert!(backwards.to_string().contains("3 creases are drawn on the other side than their targets"), "{backwards}");
    let plain = strip([-0.5, 0.1, -0.5]).replace("edges_foldAngle", "old:foldAngle");
    let message = fold::parse(&plain, "a.fold").unwrap_err().to_string();
    assert!(message.contains("turn all faces over"), "{message}");
}

/// Claim: a sheet with targets is written and read again as the same sheet, bit by bit, in FOLD and in OBJ.
#[test]
fn targets_come_back() {
    let odd = hinge(10.0, "V", "33.333333333333336");
    for text in [HALF_FOLDED, FLAT, &odd, &hinge(0.0, "U", "1e-2")] {
        let sheet = read(text);
        let written = fold::write(&sheet);
        assert_eq!(read(&written), sheet, "{written}");
        assert_eq!(obj::parse(&obj::write(&sheet), "b.obj").unwrap().targets, sheet.targets);
    }
    assert!(fold::write(&read(&odd)).contains("33.333333333333336"));
}

fn assembly(mesh: &str, energy: &str) -> Result<Assembly, String> {
    let scene = format!("[sheet]\nmesh = \"a.fold\"\n[energy]\nbars = {{ stiffness = 1e4 }}\n{energy}\n");
    let said = |error: SceneError| {
        let help = miette::Diagnostic::help(&error).map(|help| help.to_string());
        format!("{error}; {}", help.unwrap_or_default())
    };
    Scene::new(scene).with("a.fold", mesh).assembled().map(|(_, assembly)| assembly).map_err(said)
}

/// Returns the rest angles of the creases, by the ends of their edges.
fn rest(mesh: &str, rest: &str) -> Result<Vec<([usize; 2], f64)>, String> {
    let assembly = assembly(mesh, &format!("creases = {{ stiffness = 1.0, rest = {rest} }}"))?;
    let rest = &assembly.terms().creases.as_ref().unwrap().rest;
    let edges = assembly.tiling().edges.iter().zip(rest).zip(assembly.drawn_angles());
    let hinges = edges.filter(|(_, drawn)| !drawn.is_nan());
    Ok(hinges.map(|((edge, rest), _)| (edge.ends.map(|site| site.vertex), *rest)).collect())
}

/// Claim: rest angles are the targets, the angles of the letters, or the given angles by letter, times the fraction;
/// for a flat pattern whose targets are 180 degrees all three agree. Source: the definition; bit by bit.
#[test]
fn rest_angles_follow_targets_and_letters() {
    let target = rest(FLAT, "\"target\", fraction = 0.2").unwrap();
    assert_eq!(target, rest(FLAT, "\"assigned\", fraction = 0.2").unwrap());
    let by_letter = format!("{{ M = {:?}, V = {PI:?} }}, fraction = 0.2", -PI);
    assert_eq!(target, rest(FLAT, &by_letter).unwrap());
    let signs = target.iter().filter(|(_, angle)| *angle == 0.2 * PI).count();
    assert_eq!((signs, target.len()), (4, 6));
    assert_eq!(rest(FLAT, "\"assigned\"").unwrap()[0].1, PI);
    for form in [Rest::Target(0.2), Rest::Assigned(0.2)] {
        let built = Assembly::patch(read(FLAT), [1, 1]).creases(1.0).rest(form).build().unwrap();
        let angles = built.terms().creases.as_ref().unwrap().rest.iter().zip(built.drawn_angles());
        let hinges = angles.filter(|(_, drawn)| !drawn.is_nan()).map(|(rest, _)| *rest);
        assert!(hinges.eq(target.iter().map(|(_, angle)| *angle)));
    }
    // linear from the flat state, not from the drawn one
    let half = rest(HALF_FOLDED, "\"target\", fraction = 0.5").unwrap();
    let valley = half.iter().find(|(ends, _)| *ends == [1, 4]).unwrap();
    assert_eq!(valley.1, PI / 2.0);
    // without an angle in the file: as drawn
    let without = FLAT.replacen("180", "null", 1);
    assert!(rest(&without, "\"target\"").unwrap().iter().any(|(_, angle)| *angle == 0.0));
    let unassigned = FLAT.replacen("\"M\"", "\"U\"", 1).replace("-180", "0");
    assert!(rest(&unassigned, "{ V = 1.0, M = -1.0 }").unwrap().iter().any(|(_, angle)| *angle == 0.0));
    assert!(rest(&unassigned, "{ V = 1.0, M = -1.0, U = 0.5 }").unwrap().iter().any(|(_, angle)| *angle == 0.5));
}

/// Claim: diagonals have target angles too, if the file gives them: here a joined edge with 20 degrees.
#[test]
fn facets_have_targets() {
    let joined = hinge(0.0, "J", "20");
    let facets = assembly(&joined, "facets = { stiffness = 1.0, rest = \"target\", fraction = 0.5 }").unwrap();
    let rest = &facets.terms().facets.as_ref().unwrap().rest;
    assert!(rest.iter().any(|angle| *angle == 0.5 * 20f64.to_radians()), "{rest:?}");
    let flat = assembly(&joined, "facets = { stiffness = 1.0, rest = \"assigned\" }").unwrap();
    assert!(flat.terms().facets.as_ref().unwrap().rest.iter().all(|angle| *angle == 0.0));
}

/// Claim: what cannot be meant is refused at its place, with what would be right.
#[test]
fn wrong_rest_angles_are_refused() {
    let creases = |mesh: &str, given: &str| rest(mesh, given).unwrap_err();
    let plain = FLAT.replace("edges_foldAngle", "old:foldAngle");
    let no_letters = plain.replace("edges_assignment", "old:assignment");
    let cases = [
        (creases(FLAT, "0.1, fraction = 0.5"), "5:53: `fraction` is given without angles"),
        (creases(FLAT, "\"assigned\", fraction = 2"), "the fraction is 2"),
        (creases(FLAT, "{ M = 1.0, V = 1.0 }"), "the rest angle of mountains (M) is positive"),
        (creases(FLAT, "{ V = -1.0 }"), "the rest angle of valleys (V) is negative"),
        (creases(FLAT, "{ V = 1.0 }"), "the table has no angle for the letters M (2 creases)"),
        (creases(FLAT, "{ V = 90.0, M = -90.0 }"), "angles are radians"),
        (creases(FLAT, "{ B = 1.0 }"), "unknown key `B`"),
        (creases(FLAT, "{ J = 1.0, M = -1, V = 1 }"), "no crease has the letter J"),
        (creases(FLAT, "{ V = 1.0, file = \"a.csv\" }"), "more than one of letters"),
        (creases(&plain, "\"target\""), "the mesh gives no target angles"),
        (creases(&no_letters, "\"assigned\""), "no crease has the letter M or V"),
        (creases(FLAT, "\"aimed\""), "\"target\""),
    ];
    for (said, words) in cases {
        assert!(said.contains(words), "{words}\n{said}");
    }
}

/// Claim: one rest angle for mountains and valleys, and targets that nothing uses, are said on standard error and in
/// the summary; where targets are used nothing is said.
#[test]
fn remarks_are_made() {
    let scene = |rest: &str| {
        let scene = format!(
            "[sheet]\nmesh = \"a.fold\"\n[energy]\nbars = {{ stiffness = 1e4 }}\ncreases = {{ stiffness = 1.0, rest = {rest} }}\n\
             [[study]]\nname = \"a\"\nkind = \"modes\"\n"
        );
        Scene::new(scene).with("a.fold", FLAT)
    };
    let notes = |rest: &str| scene(rest).ran().report.summary.notes;
    let said = notes("0.3");
    assert!(said[0].contains("one angle for 2 mountains and 4 valleys") && said[0].contains("{ M = -0.3, V = 0.3 }"));
    assert!(said[1].contains("6 fold angles of the file differ from the drawn ones; rest = \"target\" uses them"));
    assert_eq!((said.len(), notes("\"target\"").len(), notes("\"assigned\"").len()), (2, 0, 1));
    let told = scene("\"assigned\"").program("");
    assert!(told.err.contains("note: 6 fold angles"), "{told:?}");
    let summary = told.folder.text("summary.json");
    assert!(summary.contains("6 fold angles of the file"), "{summary}");
}

/// Claim: where a patch has lost the polygons of vertices that still have bars, it is said how many hang loose. Source: of
/// thick Miura-ori in 2 x 2 cells, 64 vertices, two of the four panels of a cell reach over the rim on either side.
#[test]
fn loose_bars_are_said() {
    let notes = |pattern: &str| {
        let sheet = format!("generate = {{ pattern = \"{pattern}\" }}\ncells = [2, 2]");
        Scene::on(&sheet, "[[study]]\nname = \"a\"\nkind = \"modes\"\n").ran().report.summary.notes
    };
    assert!(
        notes("thick-miura").iter().any(|note| note.contains("vertices on no face: 16")),
        "{:?}",
        notes("thick-miura")
    );
    assert!(notes("miura").is_empty());
}

/// Claim: an edge that is drawn folded flat has the side of its letter or its target, also in the model: at rest there
/// its energy is zero. Source: pi and -pi are drawn alike. Tolerance: rounding of the coordinates of the drawing, a
/// sine of 1e-16, squared.
#[test]
fn flat_folds_have_the_side_of_their_letter() {
    for (letter, angle, side) in [("M", "null", -PI), ("V", "null", PI), ("U", "-180", -PI), ("M", "-180", -PI)] {
        let mesh = hinge(180.0, letter, angle);
        let sheet = read(&mesh);
        let drawn = sheet.drawn_angle(&sheet.edges[0]).unwrap();
        assert!((drawn - side).abs() < 1e-14, "{letter} {angle}: {drawn}");
        let rest = if angle == "null" { "\"assigned\"" } else { "\"drawn\"" };
        let assembly = assembly(&mesh, &format!("creases = {{ stiffness = 1.0, rest = {rest} }}"));
        let relaxed = foldwell::relax(&assembly.unwrap()).unwrap();
        assert!(relaxed.state.total() < 1e-28, "{letter} {angle}: {}", relaxed.state.total());
        assert!((relaxed.state.fold_angle[0] - side).abs() < 1e-14);
    }
}
