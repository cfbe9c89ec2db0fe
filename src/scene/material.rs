//! The material of a scene, and the stiffnesses that follow from it; its mass.

use super::spec::{FacetModel, MaterialSpec};
use super::{Located, SceneError, SceneFile};
use crate::model::{Assembly, Mass, Material, OwnTerm, Stiffness};
use crate::sheet::{Sheet, with_centres};

/// Checks that every term of the energy has a stiffness, or the material one for it.
pub(super) fn check(file: &SceneFile) -> Result<(), SceneError> {
    let (energy, material) = (&file.scene.energy, file.scene.material.as_ref());
    let bars = energy.bars.as_ref().filter(|bars| bars.stiffness.is_none()).map(Located::span);
    let creases = energy.creases.as_ref().filter(|creases| creases.stiffness.is_none()).map(Located::span);
    let facets = energy.facets.as_ref().filter(|facets| facets.hinges.stiffness.is_none()).map(Located::span);
    let creases_follow = material.is_some_and(|material| material.crease_length.is_some());
    let terms = [(bars, material.is_some()), (creases, creases_follow), (facets, material.is_some())];
    for ((without, follows), of_curve) in terms.into_iter().zip(energy.stiffness_of_curve()) {
        let Some(span) = without.filter(|_| !follows && !of_curve) else { continue };
        let help = "`stiffness` has to be given here, or follow from [material], for creases with `crease_length`";
        return Err(file.error_at(span, "missing key `stiffness`", help));
    }
    if let Some(membrane) = energy.membrane.as_ref().filter(|_| energy.has_membrane() && material.is_none()) {
        let help = "give [material] with `young`, `poisson` and `thickness`";
        return Err(file.error_at(membrane.span(), "a membrane needs a material", help));
    }
    Ok(())
}

/// Returns the material of the sheet; `None` if the scene gives none.
pub(super) fn material(file: &SceneFile) -> Option<Material> {
    let MaterialSpec { young, poisson, thickness, crease_length } = **file.scene.material.as_ref()?;
    let (young, poisson, thickness) = (young.0, poisson.0, thickness.0);
    Some(Material { young, poisson, thickness, crease_length: crease_length.map(|length| length.0) })
}

/// Returns the sheet with a vertex at the centre of every quadrilateral, if the scene asks for it.
pub(super) fn with_panels(file: &SceneFile, sheet: Sheet) -> Result<Sheet, SceneError> {
    let facets = file.scene.energy.facets.as_ref().filter(|facets| facets.model == Some(FacetModel::N5B8));
    let Some(facets) = facets else { return Ok(sheet) };
    let help =
        "N5B8 gives quadrilaterals a vertex where their diagonals cross; draw faces as quadrilaterals, or leave it out";
    match with_centres(&sheet) {
        Ok(sheet) if sheet.panels.is_empty() => {
            Err(file.error_at(facets.span(), "the sheet has no quadrilateral whose diagonals cross", help))
        }
        Ok(sheet) => Ok(sheet),
        Err(defect) => Err(file.error_at(facets.span(), defect.to_string(), help)),
    }
}

/// Returns the stiffness of the bars that follows from the material.
pub(super) fn bars(file: &SceneFile, assembly: &Assembly, material: &Material) -> Result<Stiffness, SceneError> {
    let span = file.scene.material.as_ref().map(Located::span).unwrap_or_default();
    let sheet = assembly.sheet();
    if let Some(bar) = sheet.bars_alone().next() {
        let message = format!("the material says nothing of the bar {}, which has no face", bar.key);
        let help = "give the bars `stiffness`: a number, or \"mesh\" with `foldwell:bar_stiffness` in the mesh file";
        return Err(file.error_at(span, message, help));
    }
    let bars = material.bars(assembly);
    if let Some(bar) = (0..assembly.edges()).find(|&bar| !(bars.of(bar) > 0.0)) {
        let bar = sheet.edges[assembly.tiling().edges[bar].edge].key;
        let message = format!("with N5B8 the material leaves no stiffness for the bar {bar}");
        let help = "give a Poisson's ratio nu above 0, panels that are not just 1/sqrt(nu) times as long as wide, or \
                    `stiffness` to the bars";
        return Err(file.error_at(span, message, help));
    }
    Ok(bars)
}

/// Returns the membrane of the sheet; `None` if the scene asks for none.
pub(super) fn membrane(file: &SceneFile, assembly: &Assembly) -> Option<OwnTerm> {
    let material = material(file).filter(|_| file.scene.energy.has_membrane())?;
    Some(OwnTerm::membrane(assembly, &material))
}

/// Checks that a mass is given in one way.
pub(super) fn check_mass(file: &SceneFile) -> Result<(), SceneError> {
    let Some(mass) = &file.scene.mass else { return Ok(()) };
    let help = "give one of { vertex = 1.0 }, the mass of each vertex, and { area = 1.0 }, a mass per area";
    match (&mass.vertex, &mass.area) {
        (Some(_), Some(both)) => {
            Err(file.error_at(both.span(), "the sheet has both a mass per vertex and per area", help))
        }
        (None, None) => Err(file.error_at(mass.span(), "the mass has neither `vertex` nor `area`", help)),
        _ => Ok(()),
    }
}

/// Returns the mass of the sheet; `None` if the scene gives none.
pub(super) fn mass(file: &SceneFile) -> Option<Mass> {
    let spec = file.scene.mass.as_ref()?;
    let vertex = spec.vertex.as_ref().map(|mass| Mass::Vertex(mass.0));
    vertex.or(spec.area.as_ref().map(|mass| Mass::Area(mass.0)))
}

/// Checks that a study of the scene reads its mass.
pub(crate) fn mass_is_read(file: &SceneFile) -> Result<(), SceneError> {
    let span = file.scene.mass.as_ref().map(Located::span);
    let weighs = file.scene.loads.iter().any(|load| load.weight.is_some());
    let unread = span.filter(|_| !weighs && !file.scene.studies.iter().any(|study| study.kind.reads_mass()));
    let Some(span) = unread else { return Ok(()) };
    let help = "frequencies are those of kind = \"modes\" with `eigenvalues` and kind = \"bloch\" with `path` or \
                `density`, weight is that of [[load]]; leave `mass` out otherwise";
    Err(file.error_at(span, "no study of this scene reads the mass", help))
}
