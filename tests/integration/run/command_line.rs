//! The command line: exit statuses, and the contents of standard output and standard error.

use crate::common::{Folder, Scene};

/// A malformed scene gives status 2 and its position on standard error, nothing on standard output, and writes nothing.
#[test]
fn a_wrong_scene_writes_nothing() {
    let folder = Folder::new().with("my-scene.toml", "[sheet]\nmesh = \"a.fold\"\ncells = [0, 1]\n");
    for words in ["run my-scene.toml", "run my-scene.toml --json --threads 2"] {
        let said = folder.foldwell(words).refused("my-scene.toml:3:9: there are 0 x 1 cells");
        assert_eq!(said.refused("cells = [0, 1]").refused("help: expected at least 1").out, "");
    }
    assert_eq!(folder.names().len(), 1);
}

/// A missing scene, and an invalid command line, are input errors.
#[test]
fn wrong_words_are_wrong_input() {
    let folder = Folder::new();
    for words in [
        "run none.toml",
        "run",
        "fold",
        "run a.toml --threads 0",
        "new miura",
        "new miura --seed -o",
        "new mira --help",
    ] {
        let said = folder.foldwell(words).ends(2);
        assert!(!said.err.is_empty() && said.out.is_empty(), "{words}");
    }
}

/// Claim: negative numbers after options are read as their values and refused by the range that is right; so are lists
/// of a pattern with another sign than a comma, and the name of a scene as that of the folder.
#[test]
fn wrong_values_of_options_are_refused() {
    let text = "sheet = { generate = { pattern = \"miura\" } }\nenergy = { creases = { stiffness = 1.0 } }\n\
                study = [{ name = \"a\", kind = \"relax\" }]\n";
    let folder = Folder::new().with("noending", text);
    folder.foldwell("new miura -o m.fold").well();
    for (words, said) in [
        ("run noending --threads -1", "-1 is not in 1..=65535"),
        ("info m.fold --frame -1", "invalid value '-1' for '--frame <N>'"),
        ("convert m.fold m.stl --thickness -1", "the thickness is -1, expected a number above 0"),
        ("convert m.fold n.fold --merge -1", "merge"),
        ("film a --branch -1", "a: not the folder of a run"),
        ("new miura-patch --cells 2x2 -o a.fold", "two numbers, [2, 2] in a scene and 2,2 after"),
        ("run noending", "the folder of this run would be noending, which is a file; name another one with --out"),
    ] {
        folder.foldwell(words).refused(said);
    }
    assert_eq!(folder.names().len(), 2);
}

/// Claim: a slip in a command, a pattern, a parameter, a key, a word of a scene or a name is answered by the word that
/// is meant. Source: slips that users made.
#[test]
fn slips_are_answered_by_what_is_meant() {
    let study = "name = \"a\"\nkind = \"relax\"\n";
    let scene = |change: (&str, &str)| {
        let text = format!(
            "[sheet]\ngenerate = {{ pattern = \"miura\" }}\ndomain = \"patch\"\n[energy]\nbars = {{ stiffness = 1 }}\n\
             [[part]]\nname = \"lid\"\nvertices = [0, 1, 2]\n[[drive]]\nname = \"press\"\npart = \"lid\"\naxis = \"z\"\n\
             to = 1\n[[study]]\n{study}[[study]]\nname = \"b\"\nkind = \"path\"\ndrive = \"press\"\nstart = \"a\"\n"
        );
        assert!(text.contains(change.0));
        text.replacen(change.0, change.1, 1)
    };
    let folder = Folder::new()
        .with("key.toml", scene(("stiffness", "stifness")))
        .with("pattern.toml", scene(("\"miura\"", "\"muira\"")))
        .with("parameter.toml", scene(("\"miura\" }", "\"kresling\", sids = 5 }")))
        .with("word.toml", scene(("\"patch\"", "\"path\"")))
        .with("kind.toml", scene(("\"relax\"", "\"relaxx\"")))
        .with("part.toml", scene(("part = \"lid\"", "part = \"lit\"")))
        .with("drive.toml", scene(("drive = \"press\"", "drive = \"pres\"")))
        .with(
            "start.toml",
            scene((study, &study.replace("\"a\"", "\"warm-up\""))).replace("start = \"a\"", "start = \"warm-op\""),
        );
    for (words, meant) in [
        ("rnu a.toml", "'run'"),
        ("convret a b", "'convert'"),
        ("new muira --help", "`miura`"),
        ("new kresling --sids 5 -o a.fold", "`sides`"),
        ("run key.toml", "`stiffness`"),
        ("run pattern.toml", "`miura`"),
        ("run parameter.toml", "`sides`"),
        ("run word.toml", "`patch`"),
        ("run kind.toml", "`relax`"),
        ("run part.toml", "`lid`"),
        ("run drive.toml", "`press`"),
        ("run start.toml", "`warm-up`"),
        ("run drive.toml --set study.c.drive=press", "there are `a`, `b`"),
    ] {
        let said = folder.foldwell(words).refused(meant);
        assert!(
            said.err.contains("did you mean") || said.err.contains("similar") || meant.contains("there"),
            "{}",
            said.err
        );
    }
}

/// Claim: a name of 50,000 characters is not printed in full.
#[test]
fn long_names_are_cut() {
    let said = Folder::new().program(&["info", &format!("{}.fold", "x".repeat(50_000))]);
    assert!(said.status == Some(3) && said.err.len() < 2000, "{:?}: {}", said.status, said.err.len());
}

/// A mesh instead of a scene, and a file that is neither, are refused with a remedy.
#[test]
fn files_of_the_wrong_kind() {
    let folder = Folder::new();
    folder.foldwell("new miura -o m.fold").well();
    for (words, parts) in [
        ("run m.fold", ["m.fold: this is a mesh, not a scene", "under [sheet], mesh = \"m.fold\""]),
        (
            "info m",
            [
                "m: a file without an ending",
                "expected one of .fold, .obj, .stl, .vtu, .svg, .cp, .opx, .ori, .dxf or .toml",
            ],
        ),
        (
            "convert m.fold m.step",
            [
                "m.step: files ending in `step` are not known here",
                "expected one of .fold, .obj, .vtu, .stl, .ply, .glb, .svg, .cp or .dxf",
            ],
        ),
    ] {
        parts.into_iter().fold(folder.foldwell(words), |said, part| said.refused(part));
    }
    assert_eq!(folder.names().len(), 1);
}

/// The schema is JSON and the completions are a script, both on standard output.
#[test]
fn schema_and_completions() {
    let folder = Folder::new();
    for (words, title) in [("schema", "foldwell scene"), ("schema summary", "foldwell summary")] {
        assert_eq!(folder.foldwell(words).well().json()["title"], title);
    }
    assert!(folder.foldwell("completions bash").well().out.contains("_foldwell()"));
}

/// Claim: `new --help` lists every pattern, `new PATTERN --help` draws one and gives its parameters, wherever the word
/// stands; nothing is written.
#[test]
fn patterns_have_help() {
    let folder = Folder::new();
    let said = |words: &str| {
        let said = folder.foldwell(words).well();
        assert_eq!(said.err, "", "{words}");
        said.out
    };
    let all = said("new --help");
    assert!(foldwell::Pattern::names().all(|name| all.contains(&format!("  {name} "))), "{all}");
    assert!(all == said("new -h") && all == said("new"));
    let miura = said("new miura --help");
    for part in ["One cell of Miura-ori", "--sector ANGLE", "[default: 60 deg]", "Usage: foldwell new miura"] {
        assert!(miura.contains(part), "{miura}");
    }
    assert_eq!(miura, said("new miura --fold 3 --help -o a.fold"));
    assert_eq!(folder.names().len(), 0);
}

/// Claim: `info --edges` names every edge as the table of a run does, in the same order, with its length and the drawn
/// angle of the mesh; `--vertices` lists the coordinates. Source: a Miura-ori cell, whose sides are 1. Tolerance:
/// rounding.
#[test]
fn elements_are_listed() {
    let folder = Folder::new();
    let said = |words: &str| folder.foldwell(words).well().out;
    said("new miura --fold 0.3 -o m.fold");
    let table = Scene::new(
        "sheet = { mesh = \"m.fold\" }\nenergy = { bars = { stiffness = 1.0 }, creases = { stiffness = 1.0 } }\n\
         [[study]]\nname = \"a\"\nkind = \"relax\"\ndraw = []\n",
    );
    let table = table.within(&folder).program("").well().folder.table("a.csv");
    let columns: Vec<&String> = table.header.iter().filter(|name| name.starts_with("fold_")).collect();
    let listed = said("info m.fold --edges");
    assert_eq!(listed, said("info scene.toml --edges"));
    let mut lines = listed.lines();
    assert_eq!(lines.next(), Some("edge,i,j,n1,n2,kind,assignment,length,angle"));
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    let names: Vec<String> = rows.iter().map(|row| format!("fold_{}", row[1..5].join("_"))).collect();
    assert!(names.iter().eq(columns), "{names:?}");
    for (number, row) in rows.iter().enumerate() {
        assert_eq!(row[0], number.to_string());
        let [length, angle] = [row[7], row[8]].map(|field| field.parse::<f64>().unwrap());
        let crease = row[5] == "crease";
        assert_eq!(crease, row[6] == "M" || row[6] == "V", "{row:?}");
        assert!(!crease || ((length - 1.0).abs() < 1e-14 && (angle > 0.0) == (row[6] == "V")), "{row:?}");
    }
    let vertices = said("info m.fold --vertices");
    assert!(vertices.starts_with("vertex,x,y,z\n0,0.0,0.0,0.0\n1,") && vertices.lines().count() == 5, "{vertices}");
    folder.foldwell("info m.fold --edges --vertices").ends(2);
}
