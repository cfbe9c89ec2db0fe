//! Sweeps: every point has the bytes that its scene has alone, on any number of threads; sweeps that are killed,
//! stopped or shared out end with the same table.
#![cfg(unix)]

use crate::common::{Folder, Said, Scene, Table, signal};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Child;
use std::thread::sleep;
use std::time::{Duration, Instant};

/// The table of a sweep, whose last columns may have commas in quotes.
fn table(folder: &Folder) -> String {
    folder.text("scene/sweep.csv")
}

/// A folder with a scene of this text.
fn with_scene(text: &str) -> Folder {
    Scene::new(text).placed()
}

const STAR: &str = "[sheet]\nmesh = \"open-star.fold\"\ncells = [2, 2]\n\n[energy]\nbars = { stiffness = 1e3 }\n\
    creases = { stiffness = 1.0, rest = { mode = [0, 0.1, 0], amplitude = 1.0 } }\n\n\
    [[study]]\nname = \"relaxed\"\nkind = \"relax\"\n";
const RANDOM: &str = "[sheet]\ngenerate = { pattern = \"random\", seed = 7 }\ncells = [2, 2]\n\n[energy]\n\
    bars = { stiffness = inf }\ncreases = { stiffness = 1.0 }\n\n\
    [[study]]\nname = \"cost\"\nkind = \"landscape\"\ndraw = [\"svg\"]\nmodes = [[1, 0, 0], [0, 0, 1]]\n\
    amplitudes = [0.001, 0.002, 0.004]\n";
const SCREW: &str = "[sheet]\nmesh = \"open-star.fold\"\ndomain = \"screw\"\ncells = [3, 2]\n\n[energy]\n\
    bars = { stiffness = 1e8 }\ncreases = { stiffness = 1.0 }\n\n[[lock]]\ncrease = [0, 1, 0, 0]\n\n[[study]]\nname = \"loops\"\nkind = \"trace\"\n\
    stop = { arc_length = 0.5 }\n\n[[study]]\nname = \"last\"\nkind = \"relax\"\nstart = { random = 0.01, seed = 3 }\n\
    draw = []\n";
/// Twelve points that take a moment each.
const TWELVE: &str = "\n[sweep]\n\"energy.bars.stiffness\" = { log = [1e2, 1e5, 4] }\n\
    \"energy.creases.rest.amplitude\" = [0.5, 1, 1.5]\n";

/// Claim: every point has the files, byte for byte, that `foldwell run` writes for the scene without its sweep with the
/// settings of the point, on one thread and on three; only times differ. Scenes: relaxations with pictures and VTU
/// files, a generated sheet over its seed, trajectories over the start of a relaxation, numbered elements of lists.
#[test]
fn points_are_what_they_are_alone() {
    let cases: [(&str, &str, &[&[&str]]); 3] = [
        (
            STAR,
            "\"energy.bars.stiffness\" = { log = [1e2, 1e4, 2] }\n\"energy.creases.rest\" = [\"flat\", { mode = [0.1, 0, 0], amplitude = 1 }]\n",
            &[
                &["energy.bars.stiffness=100.0", "energy.creases.rest=\"flat\""],
                &["energy.bars.stiffness=100.0", "energy.creases.rest={ mode = [0.1, 0, 0], amplitude = 1 }"],
                &["energy.bars.stiffness=10000.0", "energy.creases.rest=\"flat\""],
                &["energy.bars.stiffness=10000.0", "energy.creases.rest={ mode = [0.1, 0, 0], amplitude = 1 }"],
            ],
        ),
        (
            RANDOM,
            "zip = true\n\"sheet.generate.seed\" = { seeds = [7, 2] }\n\"study.cost.modes.1\" = [[0, 0, 1], [1, 1, 0]]\n",
            &[
                &["sheet.generate.seed=7", "study.cost.modes.1=[0, 0, 1]"],
                &["sheet.generate.seed=8", "study.cost.modes.1=[1, 1, 0]"],
            ],
        ),
        (
            SCREW,
            "\"study.last.start.random\" = { linear = [0.01, 0.03, 3] }\n",
            &[&["study.last.start.random=0.01"], &["study.last.start.random=0.02"], &["study.last.start.random=0.03"]],
        ),
    ];
    for (scene, axes, points) in cases {
        let swept = with_scene(&format!("{scene}\n[sweep]\n{axes}"));
        let alone = with_scene(scene);
        swept.foldwell("run scene.toml --quiet --threads 1 --out one").ends(0);
        swept.foldwell("run scene.toml --quiet --threads 3 --out three").ends(0);
        let points_of_one = swept.inner("one/points");
        assert!(swept.inner("one").files() == swept.inner("three").files(), "{axes}");
        assert_eq!(points_of_one.names().len(), points.len());
        for (k, settings) in points.iter().enumerate() {
            let number = format!("{k:04}");
            let words = ["run", "scene.toml", "--quiet", "--out", &number].into_iter();
            alone
                .program(&words.chain(settings.iter().flat_map(|setting| ["--set", setting])).collect::<Vec<_>>())
                .well();
            let alone = alone.inner(&number);
            assert!(alone.files().len() >= 2, "{settings:?}");
            points_of_one.inner(&number).assert_same(&alone, &format!("{settings:?}"));
        }
    }
}

/// Claim: the table has a row for each point, the first axis the slowest, with the values of the keys and the scalars
/// of every study, those of `summary.json`; the summary of the sweep agrees with its schema's keys.
#[test]
fn the_table_has_what_the_summaries_have() {
    let folder = with_scene(&format!(
        "{SCREW}\n[sweep]\n\"title\" = [\"a, b\"]\n\"study.last.start.seed\" = {{ seeds = [4, 2] }}\n"
    ));
    let printed = folder.foldwell("run scene.toml --json").ends(0).out;
    assert_eq!(printed, folder.text("scene/sweep.json"));
    let whole: Value = serde_json::from_str(&printed).unwrap();
    assert_eq!((&whole["points"], &whole["converged"], &whole["missing"]), (&json!(2), &json!(2), &json!([])));
    assert_eq!(whole["keys"], json!(["title", "study.last.start.seed"]));
    let table = table(&folder);
    assert!(table.starts_with("point,title,study.last.start.seed,status,reason,loops."), "{table}");
    let table = table.replace("\"a, b\"", "a b");
    assert!(table.lines().nth(2).unwrap().starts_with("1,a b,5,converged,,"), "{table}");
    let columns = Table::new(&table);
    for (k, point) in ["0000", "0001"].into_iter().enumerate() {
        let found = folder.json(&format!("scene/points/{point}/summary.json"));
        assert_eq!(found["settings"], json!(["title=\"a, b\"", format!("study.last.start.seed={}", 4 + k)]));
        let [loops, last] = [0, 1].map(|study| &found["studies"][study]);
        let number = |column: &str| columns.field(k, column).parse::<f64>().unwrap();
        assert_eq!(json!(number("last.energy.total")), last["energy"]["total"]);
        assert_eq!(json!(number("last.residual_force")), last["residual_force"]);
        assert_eq!(json!(number("loops.branches.1.arc_length")), loops["branches"][1]["arc_length"]);
        assert_eq!(columns.field(k, "loops.branches.0.end"), loops["branches"][0]["end"].as_str().unwrap());
        assert_eq!(columns.field(k, "last.converged"), "true");
    }
    assert!(
        columns.header.iter().all(|name| !name.ends_with("seconds") && !name.ends_with("reason") || name == "reason")
    );
}

/// Claim: points that do not converge, and points whose scene only its sheet shows to be wrong, are rows with their
/// status and reason; they are told at the end, the others are computed, and the status is that of a failed study.
#[test]
fn failed_points_are_listed_and_not_lost() {
    let axes = "[sweep]\nzip = true\n\"study.relaxed.tolerance\" = [1e-10, 1e-300, 1e-10]\n\"lock.0.crease\" = [[0, 1, 0, 0], [0, 1, 0, 0], [0, 9, 0, 0]]\n";
    let folder = with_scene(&format!("{STAR}\n[[lock]]\ncrease = [0, 1, 0, 0]\n\n{axes}"));
    for words in ["run scene.toml", "run scene.toml --resume"] {
        let told = folder.foldwell(words).ends(1).out;
        for part in [
            "3 points along study.relaxed.tolerance, lock.0.crease: 1 converged",
            "1 not converged, 1 failed",
            "point 1 (study.relaxed.tolerance=1e-300, lock.0.crease=[0, 1, 0, 0]) not converged: relaxed: ",
            "point 2 (study.relaxed.tolerance=1e-10, lock.0.crease=[0, 9, 0, 0]) failed: ",
            "the sheet has no crease [0, 9, 0, 0]",
        ] {
            assert!(told.contains(part), "{part}: {told}");
        }
        // the points that were computed are kept, also the one that did not converge; the failed one is tried again
        assert_eq!(told.contains("(2 kept)"), words.ends_with("--resume"), "{told}");
    }
    let rows: Vec<String> = table(&folder).lines().map(str::to_owned).collect();
    assert!(rows[1].contains(",converged,,"), "{rows:?}");
    assert!(rows[2].contains(",not-converged,relaxed: ") || rows[2].contains(",not-converged,\"relaxed: "), "{rows:?}");
    assert!(rows[3].contains(",failed,"), "{rows:?}");
    let failed = folder.inner("scene/points/0002");
    assert!(failed.has("failed.json") && !failed.has("summary.json"));
    // a point that failed and now is right loses its record of failure
    let scene = folder.text("scene.toml").replace("1e-300", "1e-10").replace("[0, 9,", "[0, 2,");
    folder.write("scene.toml", scene);
    folder.foldwell("run scene.toml --resume").ends(0);
    assert!(!failed.has("failed.json") && failed.has("summary.json"));
    assert_eq!(table(&folder).lines().count(), 1 + 3);
    assert!(table(&folder).lines().next().unwrap().contains("relaxed.converged"));
}

/// Claim: a table of points is an axis: its rows are points, its header their keys; its values are those of TOML.
#[test]
fn points_come_from_a_table() {
    let points = "energy.bars.stiffness, sheet.cells, energy.creases.rest\n1e3,\"[1, 2]\",flat\ninf,\"[2, 1]\",drawn\n";
    for form in ["\"points.csv\"", "{ file = \"points.csv\" }"] {
        let folder = with_scene(&format!("{STAR}\n[sweep]\npoints = {form}\n"));
        folder.write("points.csv", points);
        folder.foldwell("run scene.toml --quiet").ends(0);
        let table = table(&folder);
        let rows: Vec<&str> = table.lines().collect();
        assert!(rows[0].starts_with("point,energy.bars.stiffness,sheet.cells,energy.creases.rest,status,"), "{table}");
        assert!(rows[1].starts_with("0,1000.0,\"[1, 2]\",flat,converged,"), "{table}");
        assert!(rows[2].starts_with("1,inf,\"[2, 1]\",drawn,converged,"), "{table}");
        // another table is another sweep
        folder.write("points.csv", points.replace("1e3", "2e3"));
        assert!(folder.foldwell("run scene.toml --resume").ends(0).out.contains("2 converged (1 kept)"));
    }
}

/// Claim: what is wrong in a sweep is said with file, line and point, with status 2, and nothing is written.
#[test]
fn wrong_sweeps_are_refused() {
    let lines = STAR.lines().count() + 2;
    for (axes, parts) in [
        ("\"energy.bar.stiffness\" = [1e2]", [":1: point 0 (energy.bar.stiffness=1e2): unknown key `bar`", "bars"]),
        (
            "\"energy.bars.stiffness\" = [1e2, -1]",
            [":1: point 1 (energy.bars.stiffness=-1): the stiffness is -1", "positive"],
        ),
        (
            "\"title\" = [\"a\"]\n\"study.pull.kind\" = [\"relax\"]",
            [": point 0 (title=\"a\", study.pull.kind=\"relax\")", "no element `pull`"],
        ),
        ("\"sweep.zip\" = [true]", [":1: `sweep.zip` is a key of the sweep itself", "energy.bars.stiffness"]),
        ("\"a b\" = [1]", [":1: `a b` is no path of a key", "in quotes"]),
        ("\"energy.bars.stiffness\" = []", ["`energy.bars.stiffness` has no values", "[1e2]"]),
        ("energy.bars.stiffness = [1e2, 1e4]", ["`bars` is no form of values", "a key in quotes"]),
        ("\"energy.bars.stiffness\" = { log = [0, 1, 3] }", ["a logarithmic range has an end at 0", "above 0"]),
        ("\"energy.bars.stiffness\" = { linear = [1, 2, 1] }", ["the range has 1 values", "from 2"]),
        ("\"sheet.frame\" = { seeds = [-1, 3] }", ["there are 3 seeds from -1", "0 or more"]),
        ("\"sheet.frame\" = { seeds = [0, 2000000] }", ["the sweep has 2000000 points", "1000000"]),
        (
            "\"title\" = { linear = [0, 1, 1000000] }\n\"sheet.frame\" = { seeds = [0, 1000000] }",
            ["the sweep has 1000000 x 1000000 points", "1000000"],
        ),
        (
            "\"sheet.frame\" = { seeds = [0, 2000] }\n\"title\" = { seeds = [0, 2000] }",
            ["the sweep has 2000 x 2000 points", "1000000"],
        ),
        ("\"title\" = [\"a\"]\n\" title\" = [\"b\"]", ["two axes set the key `title`", "leave out"]),
        (
            "zip = true\n\"title\" = [\"a\"]\n\"sheet.cells\" = [[1, 1], [2, 2]]",
            ["this one has 2 values, the first 1", "zip"],
        ),
        ("", ["the sweep has no axes", "energy.bars.stiffness"]),
        ("zip = 3", ["the value is `3`", "true or false"]),
        ("points = [1, 2]", ["`points` has no values", "points.csv"]),
        ("points = \"none.csv\"", ["there is no file", "none.csv"]),
        ("points = \"points.csv\"", ["points.csv:3: point 1 (energy.bars.stiffness=x): ", "the value is \"x\""]),
    ] {
        let folder = with_scene(&format!("{STAR}\n[sweep]\n{axes}\n"));
        folder.write("points.csv", "energy.bars.stiffness\n1e3\nx\n");
        let message = folder.foldwell("run scene.toml").ends(2).all();
        assert!(parts.iter().all(|part| message.contains(part)), "{axes}: {message}");
        if !axes.contains("points.csv") {
            let line = (lines..lines + 4).find(|line| message.contains(&format!("scene.toml:{line}:")));
            assert!(line.is_some(), "{axes}: {message}");
        }
        assert!(!folder.has("scene"), "{axes}");
    }
    let folder = with_scene(STAR);
    folder.foldwell("run scene.toml --shard 1/2").refused("the scene has no [sweep]");
    folder.foldwell("run scene.toml --shard 3/2").refused("`3/2` names no shard");
    // several scenes are checked before the first is computed, with all points of their sweeps
    let axes = "\n[[lock]]\ncrease = [0, 1, 0, 0]\n\n[sweep]\n\"lock.0.crease\" = [[0, 1, 0, 0], [0, 9, 0, 0]]\n";
    folder.write("swept.toml", format!("{STAR}{axes}"));
    folder.foldwell("run scene.toml swept.toml").refused("no crease [0, 9, 0, 0]");
    assert!(!folder.has("scene"));
}

fn spawned(folder: &Folder, words: &str) -> Child {
    folder.command(&words.split(' ').collect::<Vec<_>>()).spawn().unwrap()
}

/// Starts a sweep and waits until this number of points is finished.
fn started(folder: &Folder, words: &str, finished: usize) -> Child {
    let child = spawned(folder, words);
    let clock = Instant::now();
    while finished_points(&folder.file("scene")) < finished {
        assert!(clock.elapsed() < Duration::from_secs(120), "no point is finished");
        sleep(Duration::from_millis(5));
    }
    child
}

/// Number of points whose only study is in their summary with its files.
fn finished_points(out: &Path) -> usize {
    let folders = fs::read_dir(out.join("points")).into_iter().flatten().flatten();
    let finished = |folder: PathBuf| {
        let text = fs::read_to_string(folder.join("summary.json")).unwrap_or_default();
        let summary: Value = serde_json::from_str(&text).unwrap_or_default();
        summary["studies"][0]["files"].is_object() && summary["studies"][0]["reason"] != "interrupted"
    };
    folders.filter(|folder| finished(folder.path())).count()
}

/// The inodes of the tables of points: a file that is written again is another one.
fn inodes(out: &Path) -> BTreeMap<PathBuf, u64> {
    use std::os::unix::fs::MetadataExt;
    let folders = fs::read_dir(out.join("points")).into_iter().flatten().flatten();
    let tables = folders.map(|folder| folder.path().join("relaxed.csv")).filter(|table| table.exists());
    tables.map(|table| (table.clone(), fs::metadata(&table).unwrap().ino())).collect()
}

/// Claim: a sweep that is killed (SIGKILL) loses at most the points in flight: resumed, it computes those that have no
/// result, writes no file of the others again, and ends with the bytes of an undisturbed sweep. A scene that was
/// changed is computed anew.
#[test]
fn a_killed_sweep_goes_on_with_the_missing_points() {
    let scene = format!("{STAR}draw = []\n{TWELVE}");
    let undisturbed = with_scene(&scene);
    undisturbed.foldwell("run scene.toml --quiet").ends(0);
    let folder = with_scene(&scene);
    let out = folder.file("scene");
    for (words, finished) in [("run scene.toml --threads 2", 2), ("run scene.toml --threads 2 --resume", 5)] {
        let mut child = started(&folder, words, finished);
        child.kill().unwrap();
        child.wait().unwrap();
    }
    let (done, before) = (finished_points(&out), inodes(&out));
    assert!((5..12).contains(&done), "{done} points were finished");
    let told = folder.foldwell("run scene.toml --resume").ends(0).out;
    assert!(told.contains(&format!("12 converged ({done} kept)")), "{told}");
    let after = inodes(&out);
    let same = before.iter().filter(|(table, inode)| after[*table] == **inode).count();
    assert!(same >= done && after.len() == 12, "{same} of {done} were not written again");
    folder.inner("scene").assert_same(&undisturbed.inner("scene"), "killed twice");
    folder.write("scene.toml", scene.replace("[0, 0.1, 0]", "[0, 0.2, 0]"));
    let told = folder.foldwell("run scene.toml --resume").ends(0).out;
    assert!(told.contains("12 converged\n"), "{told}");
    assert!(table(&folder) != table(&undisturbed));
    // points of an earlier, longer sweep are not taken for those of this one
    folder.write("scene.toml", scene.replace("[0.5, 1, 1.5]", "[0.5]"));
    folder.foldwell("run scene.toml").ends(0);
    assert_eq!(table(&folder).lines().count(), 5);
    assert_eq!(finished_points(&out), 4);
}

/// Claim: Ctrl-C ends a sweep with status 130, the finished points in the table, and the number of those that are
/// missing. The program does not wait for a long step, so that the point in flight may be finished after the table was
/// written.
#[test]
fn a_stopped_sweep_says_what_is_left() {
    let folder = with_scene(&format!("{STAR}draw = []\n{TWELVE}"));
    let child = started(&folder, "run scene.toml --threads 1", 2);
    signal(&child, "-INT");
    let said = Said::last(child, &folder).ends(130).all();
    let out = folder.file("scene");
    let columns = Table::new(&table(&folder));
    let count = |status: &str| (0..columns.len()).filter(|&k| columns.field(k, "status") == status).count();
    let (told, done) = (count("converged"), finished_points(&out));
    assert!((2..12).contains(&told) && (told..=told + 1).contains(&done), "{told} {done}");
    assert_eq!(count("missing"), 12 - told);
    assert!(said.contains(&format!("{} points are missing: ", 12 - told)), "{said}");
    assert!(folder.foldwell("run scene.toml --resume").ends(0).out.contains(&format!("12 converged ({done} kept)")));
}

/// Claim: shards that run at the same time into one folder compute every point once; the last one to end leaves the
/// table of a sweep in one piece, byte for byte, and while a shard is missing its points are said to be.
#[test]
fn shards_share_a_folder() {
    let scene = format!("{STAR}draw = []\n{TWELVE}");
    let whole = with_scene(&scene);
    whole.foldwell("run scene.toml --quiet").ends(0);
    let folder = with_scene(&scene);
    let told = folder.foldwell("run scene.toml --shard 2/3 --threads 1").ends(0).out;
    assert!(told.contains("12 points") && told.contains("4 converged"), "{told}");
    assert!(told.contains("8 points are missing: 0, 2-3, 5-6, 8-9, 11"), "{told}");
    let shards = [1, 2, 3].map(|k| spawned(&folder, &format!("run scene.toml --shard {k}/3 --threads 1")));
    for shard in shards {
        Said::last(shard, &folder).well();
    }
    folder.inner("scene").assert_same(&whole.inner("scene"), "shards");
}

/// Claim: the library computes points one by one, in any order, and assembles the same table; a point that was finished
/// is left as it is.
#[test]
fn the_library_runs_single_points() {
    use foldwell::run::PointStatus;
    use foldwell::run::{RunOptions, assemble, points, read_scene, run_point};
    use std::ops::ControlFlow;

    let folder = with_scene(&format!("{STAR}draw = []\n\n[sweep]\n\"energy.bars.stiffness\" = [1e2, 1e3]\n"));
    let path = folder.file("scene.toml");
    let sweep = points(&read_scene(&path, &[]).unwrap()).unwrap();
    let out = folder.file("library");
    let options = RunOptions { out: Some(out.clone()), threads: Some(1), resume: true };
    let observer = |_: &foldwell::run::Progress| ControlFlow::Continue(());
    assert_eq!(run_point(&sweep, 1, &options, &observer).unwrap(), Some(PointStatus::Converged));
    assert_eq!(assemble(&sweep, &out).unwrap().missing, [0]);
    let before = inodes(&out);
    for index in [0, 1] {
        assert_eq!(run_point(&sweep, index, &options, &observer).unwrap(), Some(PointStatus::Converged));
    }
    assert!(before.iter().all(|(table, inode)| inodes(&out)[table] == *inode));
    assert!(assemble(&sweep, &out).unwrap().missing.is_empty());
    let scene = path.to_str().unwrap();
    folder.foldwell(&format!("run {scene} --quiet --out program")).ends(0);
    folder.inner("library").assert_same(&folder.inner("program"), "library");
    assert_eq!(run_point(&sweep, 0, &options, &|_| ControlFlow::Break(())).unwrap(), Some(PointStatus::Converged));
    let anew = RunOptions { resume: false, ..options };
    assert_eq!(run_point(&sweep, 0, &anew, &|_| ControlFlow::Break(())).unwrap(), None);
}

/// Claim: while a sweep writes into a folder, a sweep of another scene there ends with status 3 and changes nothing,
/// and so does a run without a sweep; the first one ends as if it were alone.
#[test]
fn a_folder_has_one_sweep_at_a_time() {
    let scene = format!("{STAR}draw = []\n{TWELVE}");
    let alone = with_scene(&scene);
    alone.foldwell("run scene.toml --quiet").ends(0);
    let folder = with_scene(&scene);
    folder.write("other.toml", scene.replace("[0, 0.1, 0]", "[0, 0.2, 0]"));
    folder.write("single.toml", STAR);
    let first = started(&folder, "run scene.toml --threads 1", 1);
    signal(&first, "-STOP");
    for words in
        ["run other.toml --out scene", "run other.toml --out scene --resume --shard 1/2", "run single.toml --out scene"]
    {
        let said = folder.foldwell(words).ends(3);
        assert!(said.all().contains("scene: another run (process"), "{words}: {said:?}");
    }
    signal(&first, "-CONT");
    Said::last(first, &folder).well();
    folder.inner("scene").assert_same(&alone.inner("scene"), "alone");
}

/// Claim: a sweep that the observer stops while its points are checked ends at that call, with all points missing, and
/// writes nothing. Counted and not timed: a sweep of twenty thousand points once called its observer after all checks.
#[test]
fn checks_of_points_are_interrupted() {
    use foldwell::run::{RunOptions, read_scene, sweep};
    use std::ops::ControlFlow;
    use std::sync::atomic::{AtomicUsize, Ordering};

    let folder =
        with_scene(&format!("{STAR}draw = []\n\n[sweep]\n\"energy.bars.stiffness\" = {{ linear = [1, 2, 20000] }}\n"));
    let options = RunOptions { out: Some(folder.file("out")), threads: Some(1), resume: false };
    let calls = AtomicUsize::new(0);
    let observer = |progress: &foldwell::run::Progress| {
        calls.fetch_add(1, Ordering::Relaxed);
        assert!(progress.step < 1000, "it was called early");
        ControlFlow::Break(())
    };
    let report = sweep(&read_scene(&folder.file("scene.toml"), &[]).unwrap(), &options, None, &observer).unwrap();
    assert!(report.interrupted && !report.converged && report.kept == 0);
    assert_eq!((report.summary.missing.len(), calls.into_inner()), (20000, 1));
    assert!(!folder.has("out"));
}
