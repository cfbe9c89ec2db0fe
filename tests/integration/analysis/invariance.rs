//! Results do not depend on the number of threads, and nothing is computed that a scene does not need.

use crate::common::{self, Scene, Testing, on, patch};
use foldwell::analysis::relax::relax_from;
use foldwell::model::Gauge;
use foldwell::model::{Assembly, Boundary, Terms};
use foldwell::numerics::parallel::{FEWEST_SHARED_ELEMENTS, Threads};
use foldwell::solver::Options;
use std::path::Path;

/// Returns a scene with `open-star`.
fn scene(sheet: &str, energy: &str, studies: &str) -> Scene {
    Scene::on(&format!("mesh = \"open-star.fold\"\n{sheet}"), &format!("[energy]\n{energy}\n{studies}"))
}

const RELAX: &str = "[[study]]\nname = \"a\"\nkind = \"relax\"";
const BENT: &str =
    "bars = { stiffness = 1e6 }\ncreases = { stiffness = 1.0, rest = { mode = [0.06, 0.0, 0.0], amplitude = 1.0 } }";

const SHALLOW: &str = "bars = { stiffness = 1e6 }\ncreases = { stiffness = 1.0, rest = { file = \"rest.csv\" } }";

/// Claim: 16 x 16 cells, enough for elements to be shared between threads, with rest angles up to 0.1 rad from the
/// drawn ones, relaxed and with their modes, with 1, 2 and 3 threads: every file has the same bytes, and the summary
/// except for its times.
#[test]
fn the_same_bits_for_any_number_of_threads() {
    let case = patch("open-star", [16, 16]);
    assert!(case.edges() > FEWEST_SHARED_ELEMENTS, "the case is too small to show anything");
    let sheet = "domain = \"patch\"\ncells = [16, 16]";
    let mut table = String::from("i,j,n1,n2,angle\n");
    let mut numbers = common::Numbers::new(1);
    for edge in &case.sheet().edges {
        let (key, angle) = (edge.key, case.sheet().drawn_angle(edge).unwrap() + numbers.within(0.1));
        table += &format!("{},{},{},{},{angle:e}\n", key.i, key.j, key.shift[0], key.shift[1]);
    }
    let studies = format!("{RELAX}\n[[study]]\nname = \"b\"\nkind = \"modes\"\neigenvalues = 8\n");
    let scene = scene(sheet, SHALLOW, &studies).with("rest.csv", table);
    let runs = ["1", "2", "3"].map(|n| scene.clone().out(n).program(&format!("--quiet --threads {n}")).well().folder);
    for wanted in ["a.csv", "a.pvd", "a.svg", "b.csv", "b.pvd", "b.svg", "summary.json"] {
        assert!(runs[0].has(wanted), "{wanted} is not among {:?}", runs[0].names());
    }
    let pictures = runs[0].files().into_keys().filter(|path| path.extension().is_some_and(|ending| ending == "vtu"));
    assert!(pictures.count() >= 10, "{:?}", runs[0].names());
    runs[1..].iter().for_each(|other| other.assert_same(&runs[0], "threads"));
}

/// Claim: `draw = []` writes tables only, and changes neither the relaxation nor its table.
#[test]
fn nothing_is_drawn_where_nothing_is_wanted() {
    let run = |draw: &str| {
        let scene = scene("domain = \"patch\"\ncells = [3, 3]", BENT, &format!("{RELAX}\n{draw}"));
        scene.program("--quiet").well().folder.files()
    };
    let (drawn, bare) = (run(""), run("draw = []"));
    let names: Vec<_> = bare.keys().map(|path| path.to_str().unwrap()).collect();
    assert_eq!(names, ["a.csv", "summary.json"]);
    assert!(drawn.len() > 4);
    assert_eq!(bare[Path::new("a.csv")], drawn[Path::new("a.csv")]);
    let only = run("draw = [\"svg\"]");
    assert!(only.keys().all(|path| ["csv", "json", "svg"].contains(&path.extension().unwrap().to_str().unwrap())));
}

/// Claim: a cell, and a patch below the threshold, start no threads; a large patch does (which shows that the test can
/// detect threads).
#[test]
fn small_sheets_start_no_threads() {
    let threads = Threads::new(Some(2));
    let rigid = |case: &Assembly| {
        let terms = Terms::bars_and_creases(f64::INFINITY, 1.0, case.rest_per_hinge(0.05, 1));
        let model = case.model_of(&terms, Gauge::Held);
        threads.install(|| relax_from(&model, model.start(), Options::default(), &mut |_| true)).unwrap();
    };
    for boundary in [Boundary::Screw, Boundary::FreeTorus, Boundary::FixedTorus] {
        rigid(&on(common::mesh("open-star"), [1, 1], boundary));
    }
    rigid(&patch("open-star", [12, 12]));
    assert!(!threads.started(), "a small sheet started threads");
    let case = patch("open-star", [14, 14]);
    assert!(case.edges() > FEWEST_SHARED_ELEMENTS);
    rigid(&case);
    assert!(threads.started(), "a large sheet started none: the test shows nothing");
}

/// Returns names and sizes of a model's terms, soft and stiff.
fn terms(case: &Assembly, terms: &Terms) -> [Vec<(&'static str, usize)>; 2] {
    let model = case.model_of(terms, Gauge::Held);
    let names = [true, false].map(|soft| {
        let of_list = model.elements().filter(|element| (element.number < model.soft_elements()) == soft);
        of_list.map(|element| element.kind().name()).collect::<Vec<_>>()
    });
    names.map(|names| names.chunk_by(|a, b| a == b).map(|chunk| (chunk[0], chunk.len())).collect())
}

/// Claim: a model has the requested terms and no others: no hinges for bars only, no bars for hinges only, no facets
/// without polygons, and locks only for locked edges.
#[test]
fn only_what_is_asked_for_is_built() {
    let star = patch("open-star", [3, 3]);
    let edges = star.edges();
    let bars = Terms { bars: Some(1.0f64.into()), ..Terms::default() };
    assert_eq!(terms(&star, &bars), [vec![], vec![("bars", edges)]]);
    let creases = star.drawn_angles().iter().filter(|angle| !angle.is_nan()).count();
    let both = Terms::bars_and_creases(1.0, 1.0, star.drawn_angles().to_vec());
    assert_eq!(terms(&star, &both), [vec![("creases", creases)], vec![("bars", edges)]]);
    let hinges = Terms { bars: None, ..both.clone() };
    assert_eq!(terms(&star, &hinges), [vec![("creases", creases)], vec![]]);
    let facets = Terms { facets: star.facets(f64::INFINITY), ..both.clone() };
    assert_eq!(terms(&star, &facets), terms(&star, &both));
    let hinge = (0..edges).find(|&edge| !star.drawn_angles()[edge].is_nan()).unwrap();
    let locked = Terms { locks: vec![(hinge, 0.1)], ..bars };
    assert_eq!(terms(&star, &locked), [vec![], vec![("bars", edges), ("locks", 1)]]);
}

/// Claim: the terms that a scene leaves out are reported, each with the reason, and so are the terms that are built.
#[test]
fn what_is_left_out_is_said() {
    let sheet = "domain = \"torus\"\ncells = [2, 2]";
    let scene = scene(sheet, "bars = { stiffness = 1e3 }", "[[study]]\nname = \"m\"\nkind = \"modes\"");
    let found = scene.program("--quiet").well().folder.json("summary.json");
    assert_eq!(found["terms"], serde_json::json!(["bars"]));
    let left_out: Vec<&str> = found["left_out"].as_array().unwrap().iter().map(|text| text.as_str().unwrap()).collect();
    for part in ["creases: not in [energy]", "facets: every face is a triangle", "locks", "pins", "loads"] {
        assert!(left_out.iter().any(|text| text.contains(part)), "{part} is not among {left_out:?}");
    }
}
