//! Checks that several kinds of study share: which stiffnesses and rest values they support, and which a tube has.

use super::{Context, StudyError};
use crate::model::{Domain, Gauge};
use crate::scene::Located;
use crate::scene::drives::supported;
use crate::scene::spec::StudyKind::{
    Bloch, Branches, Fold, Landscape, Modes, Path, Relax, Response, Surface, Trace, Wells,
};
use crate::scene::values::Positive;

/// Help for a study that does not support stiffnesses and rest values of single elements.
const SUPPORTED: &str = "`relax` supports stiffnesses and rest values of single elements";
/// Largest tolerance of relative residuals with which events and stability still mean something.
const LARGEST_TOLERANCE: f64 = 1e-3;
/// Advice for a study of the ways in which a tube folds.
const MOTIONS_OF_A_TUBE: &str = "use domain = \"screw\"; `modes` counts the motions of a tube";

/// Checks that there are no rigid parts, which modes know too, no pins along a direction and no terms of one's own, as
/// springs between vertices are, which relaxations, paths and wells alone know.
pub(super) fn no_parts(context: &Context<'_>) -> Result<(), StudyError> {
    let (terms, kind) = (context.assembly.terms(), context.study.kind.name());
    let knows_parts = matches!(*context.study.kind, Modes(_));
    let what = match terms.own_names().first() {
        _ if !terms.parts.is_empty() && !knows_parts => "rigid parts, which [[part]] and [[tie]] give".to_owned(),
        _ if !terms.guides.is_empty() => "pins along a direction, the key `normal` of [[pin]]".to_owned(),
        Some(name) => format!("the term `{name}`"),
        None => return Ok(()),
    };
    let message = format!("studies of kind {kind} do not know {what}");
    Err(context.refuse(message, "leave them out, or ask for relax, path, fold or wells").into())
}

/// Checks that the sheet is a surface with two sides, whose exact folding the study asks for.
pub(super) fn a_surface(context: &Context<'_>) -> Result<(), StudyError> {
    if context.assembly.sheet().is_surface() {
        return Ok(());
    }
    let kind = context.study.kind.name();
    let message = format!("studies of kind {kind} fold surfaces with two sides exactly, and this sheet is none");
    let help = "an edge has more than two faces or none, or the faces have one side: relax, path, fold, wells, modes, \
                response and bands of bloch know such assemblies";
    Err(context.refuse(message, help).into())
}

/// Checks that a tolerance bounds residuals, which are relative to the largest force and the mean edge.
pub(super) fn small_tolerance(context: &Context<'_>, given: Option<&Located<Positive>>) -> Result<(), StudyError> {
    let Some(wrong) = given.filter(|given| given.0 > LARGEST_TOLERANCE) else { return Ok(()) };
    let message = format!("the tolerance is {}, and states are no equilibria then", wrong.0);
    let help = format!("expected a number up to {LARGEST_TOLERANCE}; leave it out for the usual one");
    Err(context.file.error_at(wrong.span(), message, help).into())
}

/// Checks that terms of one's own keep their energy where the sheet moves as a whole, but along what a driven path moves.
pub(super) fn own_terms(context: &Context<'_>) -> Result<(), StudyError> {
    let drives = matches!(*context.study.kind, Path(_));
    let driven = if drives { supported(context.file, context.assembly)? } else { vec![] };
    let help =
        "pin vertices where the term pulls the sheet, or let its energy depend on where vertices are to each other";
    context.assembly.check_own_terms(&driven).map_err(|error| context.refuse(error.to_string(), help).into())
}

/// Checks that each term has one stiffness.
pub(super) fn one_stiffness_each(context: &Context<'_>, what: &str) -> Result<(), StudyError> {
    let Some(term) = context.assembly.terms().uneven_term() else { return Ok(()) };
    let message = format!("{what} need one stiffness for all {term}, and here they differ");
    Err(context.refuse(message, format!("give the {term} one number; {SUPPORTED}")).into())
}

/// Checks that all elements are linear springs along edges.
pub(super) fn linear_springs(context: &Context<'_>, what: &str) -> Result<(), StudyError> {
    let Some(term) = context.assembly.terms().first_not_linear() else { return Ok(()) };
    let message = format!("{what} need linear bars and hinges and no other terms, and here is another: {term}");
    Err(context.refuse(message, "leave out `law` of bars, creases and facets, and terms of your own").into())
}

/// Checks that all elements are springs in their own states of rest, whatever their laws beyond them.
pub(super) fn springs_at_rest(context: &Context<'_>, what: &str) -> Result<(), StudyError> {
    let model = context.assembly.model(Gauge::Free);
    let Some(other) = model.elements().find(|element| !element.is_spring_at_rest()) else { return Ok(()) };
    let message = format!("{what} need springs at rest, and the law of the {} is none there", other.kind().name());
    Err(context.refuse(message, "leave out `law`, or `start` from a study that relaxes").into())
}

/// Checks that nothing yields: what does has other states where it comes on another way.
pub(super) fn no_memory(context: &Context<'_>) -> Result<(), StudyError> {
    let Some(term) = context.assembly.terms().laws.first_with_memory() else { return Ok(()) };
    let kind = context.study.kind.name();
    let message =
        format!("the states of {kind} do not depend on how they are reached, and those of {term} that yield do");
    Err(context.refuse(message, "leave out `yield`, or ask for relax, path or fold").into())
}

/// Checks that the bars are at rest as drawn.
pub(super) fn drawn_lengths(context: &Context<'_>, what: &str) -> Result<(), StudyError> {
    let bars = context.assembly.bars_off_rest();
    if bars == 0 {
        return Ok(());
    }
    let message = format!("{what} need bars at rest as drawn, and {bars} have other rest lengths");
    Err(context.refuse(message, format!("leave out `rest` of the bars; {SUPPORTED}")).into())
}

/// Checks that rigid creases and facets keep their drawn angles: exact folding moves no others.
pub(super) fn drawn_rigid_hinges(context: &Context<'_>, what: &str) -> Result<(), StudyError> {
    let assembly = context.assembly;
    let Some(edge) = assembly.rigid_hinge_off_rest() else { return Ok(()) };
    let tiled = &assembly.tiling().edges[edge];
    let key = assembly.sheet().edges[tiled.edge].key;
    let message = format!("{what} leave the drawn state, and the rigid hinge {key} has another rest angle");
    Err(context.refuse(message, format!("give rigid hinges the drawn rest angles; {SUPPORTED}")).into())
}

/// Checks that the study is one of those that a tube has.
pub(super) fn of_a_tube(context: &Context<'_>) -> Result<(), StudyError> {
    let Domain::Tube { .. } = context.assembly.domain() else { return Ok(()) };
    let (message, help) = match &*context.study.kind {
        Wells(wells) if wells.rigid => ("the rigid states of a closed tube are single points", "leave out `rigid`"),
        Relax(_) | Modes(_) | Trace(_) | Wells(_) | Path(_) | Fold(_) => return Ok(()),
        Surface(_) => (
            "the folded states of a tube are no surface: its closing conditions leave one motion or none",
            MOTIONS_OF_A_TUBE,
        ),
        Branches(_) => ("branches leave the drawn state, and a tube is another one", MOTIONS_OF_A_TUBE),
        Landscape(_) => (
            "a landscape is the energy along folding modes of a periodic sheet, and a tube has none",
            "use domain = \"patch\" or \"torus\"",
        ),
        Bloch(_) => (
            "wavenumbers around a closed tube are whole numbers, and bloch asks for all",
            "use domain = \"screw\", and start from a relaxation or a trajectory",
        ),
        Response(_) => {
            ("strains and curvatures of a closed tube are fixed by its seam", "use domain = \"screw\" or \"torus\"")
        }
    };
    Err(context.refuse(message, help).into())
}
