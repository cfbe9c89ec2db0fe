//! The summary of a run (`summary.json`) and of a sheet (`foldwell info`).
//!
//! Numbers that were not computed, NaN and infinity are written as `null`. The doc comments of the keys are the
//! descriptions in the JSON schema ([`super::schema`]); for a key that can be `null`, they say when.

use crate::scene::spec::UnitsSpec;
use crate::study::StudySummary;
use schemars::JsonSchema;
use serde::Serialize;

/// What a run of `foldwell` found: `summary.json`. Angles are radians; lengths and energies have the units of the
/// scene.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[schemars(title = "foldwell summary")]
pub struct Summary {
    /// Version of the program.
    pub version: &'static str,
    /// The scene file, as it was named.
    pub scene: String,
    /// Keys that were set in the scene from outside, as `key=value`; left out where there are none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub settings: Vec<String>,
    /// The title of the scene; the name of its file where it has none.
    pub title: String,
    /// The names of units that the scene gives; left out where it gives none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub units: Option<UnitsSpec>,
    /// A fingerprint of the scene and of every file that it names.
    pub digest: String,
    /// The sheet.
    pub sheet: SheetSummary,
    /// The terms of the energy, and the locks, that were built.
    pub terms: Vec<String>,
    /// What the scene made unnecessary.
    pub left_out: Vec<String>,
    /// Remarks about the scene: what is allowed, but may not be what was meant.
    pub notes: Vec<String>,
    /// The studies, in the order of the scene.
    pub studies: Vec<StudySummary>,
}

/// Counts of one cell, and of the model.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct SheetSummary {
    /// Vertices of a cell.
    pub vertices: usize,
    /// Edges of a cell, diagonals of polygons included; one of more than two faces counts for each of its hinges.
    pub edges: usize,
    /// Triangles of a cell.
    pub faces: usize,
    /// Polygons of a cell, as the mesh has them.
    pub polygons: usize,
    /// Whether the sheet can be laid flat: no angle defect at any vertex.
    pub developable: bool,
    /// Cells of the model.
    pub cells: [usize; 2],
    /// Unknowns of the model.
    pub degrees_of_freedom: usize,
}

impl Summary {
    /// Whether every study gave a result.
    pub fn converged(&self) -> bool {
        self.studies.iter().all(|study| study.converged)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::json::to_json;
    use crate::study::StudyResult;
    use crate::study::branches::BranchesSummary;
    use crate::study::modes::ModesSummary;
    use crate::study::relax::RelaxSummary;
    use serde_json::{Value, json};

    fn sample() -> Summary {
        let study = |name: &str, kind: &str, result| StudySummary {
            name: name.into(),
            kind: kind.into(),
            converged: true,
            seconds: 0.25,
            error: Some(1e-13),
            reason: None,
            files: None,
            result,
        };
        let relax = RelaxSummary { residual_force: f64::NAN, history: vec![<_>::default()], ..<_>::default() };
        let branches = BranchesSummary { rays: vec![<_>::default()], ..<_>::default() };
        let modes = ModesSummary { gap: Some(f64::INFINITY), eigenvalues: vec![0.1, 1e-300], ..<_>::default() };
        Summary {
            version: "0",
            scene: "scene.toml".into(),
            title: "scene".into(),
            digest: "0".into(),
            settings: vec![],
            units: None,
            sheet: SheetSummary {
                vertices: 4,
                edges: 12,
                faces: 8,
                polygons: 8,
                developable: false,
                cells: [6, 6],
                degrees_of_freedom: 432,
            },
            terms: vec!["bars".into()],
            left_out: vec!["facets".into()],
            notes: vec!["note".into()],
            studies: vec![
                study("a", "relax", Some(StudyResult::Relax(relax))),
                study("b", "modes", Some(StudyResult::Modes(modes))),
                study("d", "branches", Some(StudyResult::Branches(branches))),
                StudySummary { converged: false, reason: Some("why".into()), ..study("c", "relax", None) },
            ],
        }
    }

    fn keys(value: &Value) -> Vec<&str> {
        value.as_object().unwrap().keys().map(String::as_str).collect()
    }

    /// The keys that readers of summaries rely on are present.
    #[test]
    fn the_summary_has_its_keys() {
        let json: Value = serde_json::from_str(&to_json(&sample())).unwrap();
        assert_eq!(
            keys(&json),
            ["digest", "left_out", "notes", "scene", "sheet", "studies", "terms", "title", "version"]
        );
        let sheet = ["cells", "degrees_of_freedom", "developable", "edges", "faces", "polygons", "vertices"];
        assert_eq!(keys(&json["sheet"]), sheet);
        for key in ["name", "kind", "converged", "seconds", "error", "energy", "iterations", "factorizations"] {
            assert!(json["studies"][0].get(key).is_some(), "{key}");
        }
        for key in ["residual_force", "residual_length", "negative_eigenvalues", "error_to_kinematic", "history"] {
            assert!(json["studies"][0].get(key).is_some(), "{key}");
        }
        for key in ["zero_modes", "self_stresses", "rigid_motions", "folding_modes", "maxwell_count", "gap"] {
            assert!(json["studies"][1].get(key).is_some(), "{key}");
        }
        assert_eq!(keys(&json["studies"][0]["energy"]), ["bars", "creases", "facets", "total"]);
        for key in ["complex_solutions", "distinct", "expected", "real_rays", "rays"] {
            assert!(json["studies"][2].get(key).is_some(), "{key}");
        }
        let ray = ["branch", "curvature_sign", "direction", "multiplicity", "sign"];
        assert_eq!(keys(&json["studies"][2]["rays"][0]), ray);
        assert_eq!(keys(&json["studies"][3]), ["converged", "error", "kind", "name", "reason", "seconds"]);
    }

    /// NaN and infinity are written as null; finite numbers are read back exactly.
    #[test]
    fn numbers_that_json_lacks_are_null() {
        let json: Value = serde_json::from_str(&to_json(&sample())).unwrap();
        assert!(json["studies"][0]["residual_force"].is_null());
        assert!(json["studies"][1]["gap"].is_null());
        assert_eq!(json["studies"][1]["eigenvalues"], json!([0.1, 1e-300]));
    }

    /// A run has converged only if all its studies have.
    #[test]
    fn one_failed_study_fails_the_run() {
        let mut summary = sample();
        assert!(!summary.converged());
        summary.studies.pop();
        assert!(summary.converged());
    }
}
