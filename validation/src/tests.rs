//! Tests of the validation: claims pass or fail correctly with their distance.

use super::claim::Numbers;
use super::*;
use serde_json::Value;
use std::path::Path;

fn claims(texts: &[(&str, &str)]) -> Vec<Claim> {
    texts.iter().map(|(name, text)| Claim::parse(name, text).unwrap()).collect()
}

fn options(folder: &Path) -> Options {
    Options { out: folder.into(), ..Options::default() }
}

fn about_rays(wanted: &str) -> String {
    format!(
        "claim = \"rays & more\"\nsource = \"s\"\nquick = true\nscene = \"flat-branches.toml\"\n\
         value = \"studies.branches.real_rays\"\n{wanted}\nreason = \"r\""
    )
}

/// Claim: a claim with a wrong expected value fails with its distance in all three reports, while a correct one passes;
/// a value that does not exist fails too.
#[test]
fn a_wrong_claim_fails_by_what_it_is_off() {
    let folder = tempfile::tempdir().unwrap();
    let right = about_rays("expected = 28\ntolerance = 0");
    let wrong = about_rays("expected = 30.5\ntolerance = 1.0");
    let none = right.replace("real_rays", "imaginary_rays");
    let claims = claims(&[("right", &right), ("wrong", &wrong), ("none", &none)]);
    let mut seen = Vec::new();
    let report = check(claims, &options(folder.path()), &mut |case| seen.push(case.name.clone())).unwrap();
    assert_eq!(seen, ["right", "wrong", "none"]);
    assert_eq!((report.passed, report.all_passed(), report.interrupted), (1, false, false));
    assert_eq!(report.cases[1].miss, Some(2.5));
    assert_eq!(report.cases[1].found, Some(Numbers::One(28.0)));
    let json: Value = serde_json::from_slice(&std::fs::read(folder.path().join("report.json")).unwrap()).unwrap();
    for key in ["name", "claim", "expected", "found", "tolerance", "passed", "seconds"] {
        assert!(json["cases"][1].get(key).is_some(), "{key}");
    }
    assert_eq!((&json["cases"][1]["miss"], &json["cases"][2]["passed"]), (&Value::from(2.5), &Value::from(false)));
    for file in ["report.md", "report.html"] {
        let text = std::fs::read_to_string(folder.path().join(file)).unwrap();
        for part in ["1 of 3 claims hold, 2 fail", "off by 2.5, allowed 1", "no value"] {
            assert!(text.contains(part), "{file}: {part}\n{text}");
        }
    }
    let page = std::fs::read_to_string(folder.path().join("report.html")).unwrap();
    assert!(page.contains("rays &amp; more") && !page.contains("http://www.w3.org/1999") && !page.contains("<script"));
}

/// Claim: an experiment is performed once for all claims that use it.
#[test]
fn claims_share_an_experiment() {
    let folder = tempfile::tempdir().unwrap();
    let right = about_rays("expected = 28\ntolerance = 0");
    let report = check(claims(&[("a", &right), ("b", &right)]), &options(folder.path()), &mut |_| ()).unwrap();
    assert!(report.all_passed());
    assert_eq!(report.cases[0].seconds, report.cases[1].seconds);
    assert_eq!(report.seconds, report.cases[0].seconds);
}

/// Claim: names select claims, `quick` leaves the long ones out, and an unknown name is an input error.
#[test]
fn claims_are_chosen() {
    let quick = about_rays("at_most = 30");
    let long = quick.replace("quick = true", "quick = false");
    let all = claims(&[("a", &quick), ("b", &long)]);
    let names = |quick: bool, only: &[&str]| {
        let only = only.iter().map(|name| (*name).to_owned()).collect();
        let options = Options { quick, claims: only, ..Options::default() };
        chosen(all.clone(), &options).map(|claims| claims.into_iter().map(|c| c.name).collect::<Vec<_>>())
    };
    assert_eq!(names(false, &[]).unwrap(), ["a", "b"]);
    assert_eq!(names(true, &[]).unwrap(), ["a"]);
    assert_eq!(names(true, &["b"]).unwrap(), ["b"]);
    let error = names(false, &["c"]).unwrap_err();
    assert_eq!((error.exit_status(), error.to_string().as_str()), (2, "there is no claim `c`; the claims are a, b"));
}
