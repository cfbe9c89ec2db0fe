//! A page to look at (`.html`): one file that holds everything it shows and asks no network for anything.
//!
//! A page has the states of studies in space, with a slider through them, and their tables as plots, their results and
//! their drawings beside. It is made from the files of a study, either before they are written or read back, so that a
//! study and `foldwell view` make the same page. Equal data give equal bytes.
//!
//! The page is `page.html` with `page.css`; its scripts are ES modules, which the page itself holds as `data:`
//! addresses under the names of an import map. Space is drawn by three.js, see `vendor/README.md`. What is user-given,
//! such as a title, is only in the data, where `<` is escaped, and in the title of the page.

mod content;
mod numbers;
mod sheet;
mod study;
mod table;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::Serialize;
use serde_json::json;

use super::figure::escaped;
use super::figure::palette::{CURVATURE, Colour, ENERGY, GREY, INK, MOUNTAIN, PAPER, Ramp, SERIES, SIGNED, VALLEY};
use super::figure::sheet::{BACK, CROSSING, FRONT};
pub(crate) use content::Content;
use numbers::Arrays;
use study::StudyData;
pub(crate) use study::{MODES, StudyFiles, own_table, put_in_order, row_of};

/// The modules of the page: their names in its import map, and their texts.
const MODULES: [(&str, &str); 5] = [
    ("three", include_str!("vendor/three.js")),
    ("foldwell/data", include_str!("data.js")),
    ("foldwell/chart", include_str!("chart.js")),
    ("foldwell/view", include_str!("view.js")),
    ("foldwell/page", include_str!("page.js")),
];

/// Everything that a page shows.
#[derive(Serialize)]
struct PageData<'a> {
    title: &'a str,
    palette: serde_json::Value,
    studies: Vec<StudyData>,
    arrays: Vec<String>,
}

/// Returns the page of studies, with the title of their scene.
pub(crate) fn page(title: &str, studies: &[StudyFiles<'_>]) -> String {
    let mut arrays = Arrays::default();
    let studies = studies.iter().map(|study| StudyData::new(&mut arrays, study)).collect();
    let data = PageData { title, palette: palette(), studies, arrays: arrays.into_texts() };
    // serialization cannot fail: the types above have string keys and derived serializers
    let data = serde_json::to_string(&data).unwrap_or_default().replace('<', "\\u003c");
    let address = |text: &str| format!("data:text/javascript;base64,{}", STANDARD.encode(text));
    let imports: serde_json::Map<String, serde_json::Value> =
        MODULES.iter().map(|(name, text)| ((*name).to_owned(), address(text).into())).collect();
    let parts = [
        ("{{title}}", escaped(title)),
        ("{{licence}}", include_str!("vendor/three-LICENSE.txt").trim().to_owned()),
        ("{{style}}", include_str!("page.css").to_owned()),
        ("{{modules}}", json!({ "imports": imports }).to_string()),
        ("{{data}}", data),
    ];
    filled(include_str!("page.html"), &parts)
}

/// Returns a template with each placeholder replaced; what is put in is not searched for placeholders.
fn filled(template: &str, parts: &[(&str, String)]) -> String {
    let (mut text, mut rest) = (String::new(), template);
    while let Some((at, (key, part))) =
        parts.iter().filter_map(|part| Some((rest.find(part.0)?, part))).min_by_key(|(at, _)| *at)
    {
        text += &rest[..at];
        text += part;
        rest = &rest[at + key.len()..];
    }
    text + rest
}

/// Returns the colours of the drawings, by which pages draw too.
fn palette() -> serde_json::Value {
    let ramp = |ramp: &Ramp| ramp.stops().map(|(_, colour)| colour.to_string()).collect::<Vec<_>>();
    let colour = |colour: Colour| colour.to_string();
    json!({
        "paper": colour(PAPER),
        "ink": colour(INK),
        "grey": colour(GREY),
        "mountain": colour(MOUNTAIN),
        "valley": colour(VALLEY),
        "front": colour(FRONT.light),
        "back": colour(BACK.light),
        "crossing": colour(CROSSING.light),
        "series": SERIES.map(colour),
        "curvature": ramp(&CURVATURE),
        "energy": ramp(&ENERGY),
        "signed": ramp(&SIGNED),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::picture::Picture;
    use crate::output::test_samples as samples;
    use serde_json::{Map, Value};

    fn study<'a>(name: &str, files: Vec<(String, Content<'a>)>) -> StudyFiles<'a> {
        let summary: Map<String, Value> =
            json!({ "name": name, "kind": "relax", "converged": true, "seconds": 0.5, "iterations": 3 })
                .as_object()
                .unwrap()
                .clone();
        StudyFiles::new(summary, files)
    }

    fn states(name: &str, angles: &[f64]) -> Vec<(String, Content<'static>)> {
        let rows: String = angles.iter().enumerate().map(|(k, angle)| format!("{k},{angle}\n")).collect();
        let mut files = vec![(format!("{name}.csv"), Content::Table(format!("step,curvature\n{rows}").into()))];
        for (k, angle) in angles.iter().enumerate() {
            let picture = Box::new(samples::hinge(*angle));
            files.push((format!("{name}/{name}_{k:04}.vtu"), Content::StateRead(picture)));
        }
        files
    }

    fn data(page: &str) -> Value {
        let (_, rest) = page.split_once("id=\"data\">").unwrap();
        serde_json::from_str(rest.split_once("</script>").unwrap().0).unwrap()
    }

    /// Claim: a page has all states of all studies, each with the row of its table.
    #[test]
    fn all_states_are_there() {
        let studies = [study("a", states("a", &[0.1, 0.2, 0.3])), study("b", states("b", &[0.5]))];
        let data = data(&page("t", &studies));
        let rows = |k: usize| -> Vec<u64> {
            let states = data["studies"][k]["sheet"]["states"].as_array().unwrap();
            states.iter().map(|state| state["row"].as_u64().unwrap()).collect()
        };
        assert_eq!((rows(0), rows(1)), (vec![0, 1, 2], vec![0]));
        assert_eq!(data["studies"][0]["facts"], json!([["iterations", 3]]));
    }

    /// Claim: equal data give equal bytes, and the seconds that a study took are not among them.
    #[test]
    fn equal_data_give_equal_bytes() {
        let make = |seconds: f64| {
            let summary = json!({ "name": "a", "kind": "relax", "converged": true, "seconds": seconds });
            page("t", &[StudyFiles::new(summary.as_object().unwrap().clone(), states("a", &[0.1, 0.2]))])
        };
        assert_eq!(make(0.5), make(0.7));
    }

    /// Claim: no text of the user ends a script or begins a tag, in a title, a name, a reason or a drawing, and the
    /// data have these texts unchanged.
    #[test]
    fn texts_of_the_user_are_escaped() {
        let wild = "</script><script>alert(1)</script><!-- & \" {{data}} {{modules}} \u{2028}";
        let summary = json!({ "name": wild, "kind": "relax", "converged": false, "reason": wild });
        let svg = Content::Figure(format!("<svg><title>{wild}</title></svg>").into());
        let study = StudyFiles::new(summary.as_object().unwrap().clone(), [("a.svg".into(), svg)]);
        let plain = page("", &[]);
        let page = page(wild, &[study]);
        for tag in ["<script", "</script", "<!--", "<svg"] {
            assert_eq!(page.matches(tag).count(), plain.matches(tag).count(), "{tag}");
        }
        let data = data(&page);
        assert_eq!([&data["title"], &data["studies"][0]["name"], &data["studies"][0]["reason"]], [wild; 3]);
        assert!(data["studies"][0]["figures"][0]["svg"].as_str().unwrap().contains(wild));
    }

    /// Claim: a page names no address on a network besides those of name spaces, licences and comments: nothing is
    /// loaded.
    #[test]
    fn nothing_is_loaded() {
        let page = page("t", &[]);
        for place in ["src=\"http", "href=\"http", "url(http", "@import", "fetch(", "XMLHttpRequest"] {
            let own = MODULES[1..].iter().any(|(_, text)| text.contains(place));
            assert!(!own && !page.contains(place), "{place}");
        }
        assert!(
            page.contains("Content-Security-Policy") && page.contains("Copyright \u{a9} 2010-2026 three.js authors")
        );
    }

    /// Claim: a page of a trajectory with 200 states of 6 x 6 cells has less than 5 MB, three.js included. The sheet
    /// has the points, triangles and lines of 6 x 6 cells of four vertices, twelve edges and eight faces; positions
    /// differ in every state, and so do the fold angles and energies, which are the same in every cell.
    #[test]
    fn long_trajectories_are_small() {
        let [points, triangles, lines] = [7 * 7 * 4, 6 * 6 * 8, 6 * 6 * 12];
        let picture = |state: usize| {
            let wave = |k: usize| ((state * 7919 + k * 104_729) as f64).sin();
            let on_edges: Vec<f64> = (0..lines).map(|line| wave(line % 12)).collect();
            Picture {
                points: (0..points)
                    .map(|k| crate::math::Vec3::new(wave(3 * k), wave(3 * k + 1), wave(3 * k + 2)))
                    .collect(),
                displacement: vec![crate::math::Vec3::zeros(); points],
                places: vec![(0, [0, 0]); points],
                letters: vec![crate::sheet::Assignment::Valley; lines],
                triangles: (0..triangles).map(|k| [k % points, (k + 1) % points, (k + 5) % points]).collect(),
                self_intersecting: vec![0; triangles],
                lines: (0..lines).map(|k| [k % points, (k + 1) % points]).collect(),
                line_kinds: vec![crate::sheet::EdgeKind::Crease; lines],
                line_edges: (0..lines).map(|line| (line % 12) as i32).collect(),
                fold_angle: on_edges.clone(),
                rest_angle: on_edges.clone(),
                strain: on_edges.clone(),
                energy: on_edges.clone(),
                tension: on_edges.clone(),
                torque: on_edges,
                memory: std::collections::BTreeMap::new(),
            }
        };
        let file = |state: usize| (format!("a/a_{state:04}.vtu"), Content::StateRead(Box::new(picture(state))));
        let bytes = page("t", &[study("a", (0..200).map(file).collect())]).len();
        assert!(bytes < 5_000_000, "{bytes}");
    }
}
