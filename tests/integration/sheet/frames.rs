//! Frames of FOLD files, and what conversions keep of a file: frames, order of edges, other programs' keys, facets.

use crate::common::{Folder, Scene, case_folder};
use foldwell::run::{Ledger, Progress, Wanted, convert, info, read_scene};
use foldwell::scene::Setting;
use foldwell::sheet::{Assignment, EdgeKind, Info, fold};
use serde_json::Value;
use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::path::PathBuf;

const FRAMES: &str = include_str!("../../cases/fold/frames.fold");
const BELOW: &str = include_str!("../../cases/fold/frames-below.fold");

fn path(name: &str) -> PathBuf {
    case_folder().join("fold").join(name)
}

fn drawn_valley(text: &str, frame: Option<usize>) -> f64 {
    let sheet = fold::parse_frame(text, "a.fold", frame, None).unwrap();
    let crease = sheet.edges.iter().find(|edge| edge.kind == EdgeKind::Crease).unwrap();
    assert_eq!(sheet.assignment(crease), Assignment::Valley);
    sheet.drawn_angle(crease).unwrap()
}

/// Claim: frame 0 is the top of the file, and others inherit the keys that they do not have from their parents, along
/// chains; the other frames are counted and said. Source: FOLD 1.2, `frame_inherit` and `frame_parent`.
#[test]
fn frames_inherit() {
    assert_eq!(drawn_valley(FRAMES, None), 0.0);
    assert_eq!(drawn_valley(FRAMES, Some(1)), PI);
    assert!((drawn_valley(FRAMES, Some(2)) - PI / 2.0).abs() < 1e-15);
    let targets = [0, 1, 2]
        .map(|frame| Info::new(&fold::parse_frame(FRAMES, "a.fold", Some(frame), None).unwrap()).target_angles);
    assert_eq!(targets, [1, 0, 0]);
    assert_eq!(fold::parse_frame(FRAMES, "a.fold", Some(3), None).unwrap().vertices.len(), 3);
    let found = Info::new(&fold::parse_frame(FRAMES, "a.fold", Some(2), None).unwrap());
    assert_eq!((found.frame, found.further_frames), (2, 3));
    assert!(found.to_string().contains("frame 2 is read; 3 others are not"), "{found}");
}

/// Claim: without a mesh at the top the first frame that has one is read, and this is said.
#[test]
fn the_first_frame_with_a_mesh_is_read() {
    let sheet = fold::parse(BELOW, "a.fold").unwrap();
    let found = Info::new(&sheet);
    assert_eq!((found.frame, found.further_frames, sheet.vertices.len(), sheet.title.as_str()), (2, 2, 4, "steps"));
    assert_eq!(fold::parse_frame(BELOW, "a.fold", Some(3), None).unwrap().vertices, sheet.vertices);
    let message = fold::parse_frame(BELOW, "a.fold", Some(1), None).unwrap_err().to_string();
    assert!(message.contains("`vertices_coords` is missing"), "{message}");
}

/// Claim: frames that do not exist, or whose parents lead back to them, are refused at their place.
#[test]
fn wrong_frames_are_refused() {
    let circle = BELOW.replace("\"frame_parent\": 2", "\"frame_parent\": 3");
    let cases = [
        (BELOW.to_owned(), 9, "a.fold:1:1: there is no frame 9; frames are 0, the top of the file, and 1 to 3"),
        ("{}".to_owned(), 1, "there is no frame 1; the file has frame 0 only"),
        (circle, 3, "a.fold:7:41: frame 3 inherits from itself"),
        (BELOW.replace("_parent\": 2", "_parent\": 7"), 3, "a.fold:7:41: `frame_parent` of frame 3 is 7; frames are 0"),
        (
            BELOW.replace("_parent\": 2", "_parent\": \"a\""),
            3,
            "`frame_parent` is `\"a\"`; it should be the number of a frame",
        ),
        (BELOW.replace("_inherit\": true", "_inherit\": 1"), 3, "`frame_inherit` is `1`; it should be true or false"),
        ("{\"file_frames\": {}}".to_owned(), 0, "`file_frames` is `{}`; it should be a list of frames"),
        ("{\"file_frames\": [1]}".to_owned(), 0, "frame 1 of `file_frames` is `1`; it should be an object"),
    ];
    for (text, frame, words) in cases {
        let message = fold::parse_frame(&text, "a.fold", Some(frame), None).unwrap_err().to_string();
        assert!(message.contains(words), "{words}\n{message}");
    }
}

/// Claim: a scene and every command take the number of a frame; a run without one says which frame it reads, and files
/// without frames refuse it with status 2.
#[test]
fn commands_take_frames() {
    let folder = Folder::new().with("a.fold", FRAMES);
    let run = |sheet: &str, frame: Option<usize>| {
        let scene = format!(
            "[sheet]\nmesh = \"a.fold\"\n{sheet}[energy]\nbars = {{ stiffness = 1e3 }}\ncreases = {{ stiffness = 1.0 }}\n\
             [[study]]\nname = \"a\"\nkind = \"relax\"\n"
        );
        let scene = folder.scene(scene);
        let settings: Vec<Setting> = frame.map(Setting::of_frame).into_iter().collect();
        let file = read_scene(&scene.written(), &settings).unwrap();
        let go_on = |_: &Progress| ControlFlow::Continue(());
        let summary = foldwell::run::run(&file, &scene.options(), &go_on, &Ledger::default()).unwrap().summary;
        let angle = folder.table("out/a.csv").at(0, "fold_0_2_0_0");
        (angle, summary.notes, summary.digest)
    };
    let (angle, notes, first) = run("", None);
    assert_eq!(angle, 0.0);
    assert!(notes.iter().any(|note| note.starts_with("frame 0 is read; 3 others are not")), "{notes:?}");
    let (angle, notes, second) = run("frame = 2\n", None);
    assert!((angle - PI / 2.0).abs() < 1e-15 && notes.is_empty() && second != first, "{angle} {notes:?}");
    assert_eq!(run("frame = 2\n", Some(1)).0, PI);
    for file in ["a.fold", "scene.toml"] {
        let wanted = Wanted { frame: Some(3), ..Wanted::default() };
        assert_eq!(info(&folder.file(file), &wanted).unwrap().sheet.vertices, 3);
    }
    convert(&folder.file("a.fold"), &folder.file("b.obj"), Some(3), None).unwrap();
    for words in ["info b.obj --frame 1", "convert b.obj c.fold --frame 0"] {
        folder.foldwell(words).refused("this file has no frames");
    }
    assert!(!folder.has("c.fold"));
    folder.foldwell("info a.fold --frame 3").well();
    folder.foldwell("convert a.fold d.fold --frame 4").refused("there is no frame 4");
}

/// Claim: a finite sheet keeps order and direction of its edges, its letters and target angles, and the keys of other
/// programs and frames word for word; the result is the same when it is converted again. What cannot be kept is said.
#[test]
fn conversion_keeps_the_file() {
    let folder = Folder::new();
    let place = |name: &str| folder.file(name);
    assert_eq!(convert(&path("frames.fold"), &place("b.fold"), None, None).unwrap(), Vec::<String>::new());
    let text = folder.text("b.fold");
    let [before, after]: [Value; 2] = [FRAMES, &text].map(|text| serde_json::from_str(text).unwrap());
    let kept = [
        "file_author",
        "file_classes",
        "frame_title",
        "frame_classes",
        "edges_vertices",
        "edges_assignment",
        "faces_vertices",
        "faceOrders",
        "vertices_re:weight",
        "re:scene",
        "file_frames",
    ];
    for key in kept {
        assert_eq!(before[key], after[key], "{key}");
    }
    assert!(text.contains("[1, 2, 3, 4.50]"), "numbers are kept as they are written");
    assert_eq!(after["edges_foldAngle"], serde_json::json!([180.0, 0.0, 0.0, 0.0, 0.0]));
    convert(&place("b.fold"), &place("c.fold"), None, None).unwrap();
    assert_eq!(folder.text("c.fold"), text);
    // another frame alone is not the file with all of them
    let notes = convert(&path("frames.fold"), &place("d.fold"), Some(1), None).unwrap();
    assert_eq!(notes, ["3 other frames in `file_frames` are not kept, only frame 1 is"]);
    let notes = convert(&path("frames.fold"), &place("d.obj"), None, None).unwrap();
    assert!(notes[0].contains("3 other frames") && notes[1].contains("OBJ has no list of edges"), "{notes:?}");
    // edges that are not listed get numbers of their own, so that lists by number have no meaning any more
    let partial =
        FRAMES.replace(",\n[3, 0]\n]", "\n]").replace(", \"B\"],", "],").replace("180, 0, 0, 0, 0", "180, 0, 0, 0");
    folder.write("e.fold", partial);
    let notes = convert(&place("e.fold"), &place("f.fold"), None, None).unwrap();
    assert!(notes[1].contains("`faceOrders`") && notes[1].contains("`re:scene`"), "{notes:?}");
}

/// Claim: a state keeps its facets and letters on the way from FOLD to VTU and back to FOLD: the diagonals of polygons
/// are joined edges, and a crease that the state has folded over is what the state shows.
#[test]
fn facets_and_letters_survive_vtu() {
    let scene = Scene::on(
        "mesh = \"cases/fold/square-twist-rigid.fold\"",
        "[energy]\nbars = { stiffness = 1e4 }\nfacets = { stiffness = 10 }\n\
         creases = { stiffness = 1.0, rest = \"assigned\", fraction = 0.2 }\n[[study]]\nname = \"a\"\nkind = \"relax\"\n",
    );
    let folder = scene.converged().folder;
    let place = |name: &str| folder.file(name);
    let flat = fold::read(&path("square-twist-rigid.fold")).unwrap();
    for state in ["out/a/a_0000.vtu", "out/a/a_0001.vtu"] {
        convert(&place(state), &place("b.fold"), None, None).unwrap();
        convert(&place("b.fold"), &place("c.vtu"), None, None).unwrap();
        convert(&place("c.vtu"), &place("d.fold"), None, None).unwrap();
        for name in ["b.fold", "d.fold"] {
            let sheet = fold::read(&place(name)).unwrap();
            let count = |sheet: &foldwell::Sheet, letter| {
                sheet.edges.iter().filter(|edge| sheet.assignment(edge) == letter).count()
            };
            for letter in [Assignment::Join, Assignment::Mountain, Assignment::Valley, Assignment::Boundary] {
                assert_eq!(count(&sheet, letter), count(&flat, letter), "{state} {name} {letter}");
            }
            assert_eq!(Info::new(&sheet).facets, Info::new(&flat).facets);
        }
    }
}
