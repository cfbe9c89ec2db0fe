//! The program: exit statuses, reports, and a wrong claim.
#![allow(clippy::unwrap_used)]

use approx::abs_diff_eq;
use assert_cmd::Command;
use serde_json::Value;
use std::path::Path;
use std::process::Output;

fn validate(folder: &Path, words: &[&str]) -> Output {
    Command::cargo_bin("foldwell-validation").unwrap().current_dir(folder).args(words).output().unwrap()
}

fn report(folder: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(folder.join("report.json")).unwrap()).unwrap()
}

/// Claim: claims that hold give status 0 and three reports with the keys that others rely on, also outside of the
/// repository.
#[test]
fn claims_that_hold() {
    let folder = tempfile::tempdir().unwrap();
    let output = validate(folder.path(), &["loops-close", "sixteen-solutions", "--out", "r"]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    assert!(String::from_utf8_lossy(&output.stdout).starts_with("2 of 2 claims hold, 0 fail"), "{output:?}");
    let json = report(&folder.path().join("r"));
    assert_eq!(json["cases"].as_array().unwrap().len(), 2);
    for case in json["cases"].as_array().unwrap() {
        for key in
            ["name", "claim", "expected", "found", "tolerance", "passed", "seconds", "source", "reason", "command"]
        {
            assert!(!case[key].is_null(), "{key}");
        }
        assert_eq!(case["passed"], true);
    }
    for file in ["report.md", "report.html"] {
        let text = std::fs::read_to_string(folder.path().join("r").join(file)).unwrap();
        assert!(text.contains("2 of 2 claims hold"), "{file}");
    }
}

/// Claim: every value that a claim expects is checked. Planted values a little beyond the tolerance of a claim that
/// holds give status 1, and the distance is in the report and on standard error.
#[test]
fn a_wrong_claim_gives_status_one() {
    let folder = tempfile::tempdir().unwrap();
    let claims = Path::new(env!("CARGO_MANIFEST_DIR")).join("claims");
    let text = std::fs::read_to_string(claims.join("loops-of-open-star.toml")).unwrap();
    let wrong = text.replace("[50.2037156, 9.9314250, 50", "[50.2037156, 9.9314270, 50");
    assert_ne!(text, wrong, "the claim has other words now: plant the fault elsewhere");
    std::fs::write(folder.path().join("wrong.toml"), wrong).unwrap();
    let output = validate(folder.path(), &["wrong.toml", "loops-close", "--out", "r"]);
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    let json = report(&folder.path().join("r"));
    let case = json["cases"].as_array().unwrap().iter().find(|case| case["name"] == "wrong.toml").unwrap();
    let miss = case["miss"].as_f64().unwrap();
    assert!(case["passed"] == false && abs_diff_eq!(miss, 2e-6, epsilon = 1e-7), "{case}");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(said.contains("FAILS  wrong.toml: off by 2.0") && said.contains("holds  loops-close"), "{said}");
}

/// Claim: a missing claim is an input error, and a destination that cannot be written gives status 3; nothing is
/// checked then.
#[test]
fn wrong_words_and_places() {
    let folder = tempfile::tempdir().unwrap();
    for words in [&["no-such-claim"][..], &["none.toml"]] {
        let output = validate(folder.path(), words);
        assert_eq!(output.status.code(), Some(2), "{output:?}");
    }
    std::fs::write(folder.path().join("bad.toml"), "claim = 3").unwrap();
    assert_eq!(validate(folder.path(), &["bad.toml"]).status.code(), Some(2));
    std::fs::write(folder.path().join("file"), "").unwrap();
    let output = validate(folder.path(), &["loops-close", "--out", "file/below"]);
    assert_eq!(output.status.code(), Some(3), "{output:?}");
}
