//! The tables of the grid: what is known of points that do not keep the claim, and the energies of the others.

use super::points::{BARS, PARTS, Point};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Name of the drawing of the scene itself.
pub const BASE: &str = "base";

/// The reason of an exception.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason {
    /// A triangle that is named loses its height, and the independent minimizer finds no equilibrium either.
    Collapse,
    /// No answer, and another reason, or none that is confirmed: a defect.
    Fails,
    /// Another drawing reaches another minimum.
    OtherMinimum,
    /// Stiffer bars reach a lower energy, so that there is a lower minimum than the one that is reached.
    Higher,
}

const REASONS: [(Reason, &str); 4] = [
    (Reason::Collapse, "collapse"),
    (Reason::Fails, "fails"),
    (Reason::OtherMinimum, "other-minimum"),
    (Reason::Higher, "higher"),
];

impl Reason {
    pub fn name(self) -> &'static str {
        REASONS.iter().find(|(reason, _)| *reason == self).unwrap().1
    }
}

/// A point and a drawing of it: scene, stiffness and part as they are written, and the drawing or [`BASE`].
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Place {
    pub scene: String,
    pub bars: String,
    pub part: String,
    pub drawing: String,
}

impl Place {
    pub fn new(point: &Point, drawing: &str) -> Self {
        let (bars, part) = (point.bars.to_string(), point.part.to_string());
        Self { scene: point.scene.clone(), bars, part, drawing: drawing.to_owned() }
    }
}

/// An exception: why, and what is known. `energy` is that of the scene's own drawing, left out where that fails;
/// `other` that of the other drawing, or of the stiffer bars; `independent` the lowest that the independent minimizer
/// found.
#[derive(Clone, Debug, PartialEq)]
pub struct Exception {
    pub reason: Reason,
    pub energy: Option<f64>,
    pub other: Option<f64>,
    pub independent: Option<f64>,
    pub note: String,
}

impl Exception {
    /// Whether an exception that is found is the one that is known: only the independent minimizer tells a collapse
    /// from a failure, but the triangle has to be named.
    pub fn is_as(&self, known: &Self) -> bool {
        match known.reason {
            Reason::Collapse => self.note.contains("has collapsed"),
            reason => self.reason == reason,
        }
    }
}

const HEADER: &str = "scene,bars,part,drawing,reason,energy,other,independent,note";

fn path(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/cases").join(name)
}

fn lines(name: &str) -> Vec<Vec<String>> {
    let text = std::fs::read_to_string(path(name)).unwrap_or_default();
    text.lines().skip(1).map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

fn number(text: &str) -> Option<f64> {
    (!text.is_empty()).then(|| text.parse().unwrap())
}

/// Returns the exceptions that are known.
pub fn exceptions() -> BTreeMap<Place, Exception> {
    let read = |row: Vec<String>| {
        let [scene, bars, part, drawing, reason, energy, other, independent, note] =
            <[String; 9]>::try_from(row).unwrap();
        let reason = REASONS.iter().find(|(_, name)| *name == reason).unwrap().0;
        let [energy, other, independent] = [energy, other, independent].map(|text| number(&text));
        let exception = Exception { reason, energy, other, independent, note };
        (Place { scene, bars, part, drawing }, exception)
    };
    lines("grid.csv").into_iter().map(read).collect()
}

/// Writes the exceptions.
pub fn write_exceptions(exceptions: &BTreeMap<Place, Exception>) {
    let value = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:.10e}"));
    let row = |(place, e): (&Place, &Exception)| {
        let Place { scene, bars, part, drawing } = place;
        let [energy, other, independent] = [e.energy, e.other, e.independent].map(value);
        let (reason, note) = (e.reason.name(), &e.note);
        format!("{scene},{bars},{part},{drawing},{reason},{energy},{other},{independent},{note}\n")
    };
    let rows: String = exceptions.iter().map(row).collect();
    std::fs::write(path("grid.csv"), format!("{HEADER}\n{rows}")).unwrap();
}

/// Returns the energies that are known, by scene, stiffness and part.
pub fn energies() -> BTreeMap<[String; 3], f64> {
    let mut found = BTreeMap::new();
    for row in lines("grid-energies.csv") {
        for (part, text) in PARTS.iter().zip(&row[2..]) {
            let place = [row[0].clone(), row[1].clone(), part.to_string()];
            found.extend(number(text).map(|energy| (place, energy)));
        }
    }
    found
}

/// Writes the energies, a row for each scene and stiffness.
pub fn write_energies(energies: &BTreeMap<[String; 3], f64>) {
    let mut scenes: Vec<&String> = energies.keys().map(|[scene, ..]| scene).collect();
    scenes.dedup();
    let parts: String = PARTS.iter().map(|part| format!(",{part}")).collect();
    let mut text = format!("scene,bars{parts}\n");
    for scene in scenes {
        for bars in BARS {
            let energy = |part: &f64| energies.get(&[scene.clone(), bars.to_string(), part.to_string()]);
            let row: String =
                PARTS.iter().map(|part| energy(part).map_or(",".to_owned(), |e| format!(",{e:.10e}"))).collect();
            text += &format!("{scene},{bars}{row}\n");
        }
    }
    std::fs::write(path("grid-energies.csv"), text).unwrap();
}
