//! The plot of a path, and the words for what a drive drives.

use crate::analysis::path::{PathBranch, PathEvent};
use crate::model::{Drive, Driven};
use crate::output::figure::canvas::Canvas;
use crate::output::figure::reaction::{self, PlottedState, ReactionPlot};
use crate::study::Context;

/// The words for a driven quantity and its conjugate.
pub(crate) struct Words {
    /// One word, for the summary.
    pub driven: &'static str,
    /// The quantity, for an axis.
    pub quantity: String,
    /// Its conjugate, for an axis.
    pub reaction: String,
}

impl Words {
    /// Returns the words for a drive of this scene.
    pub(crate) fn new(context: &Context<'_>, drive: &Drive) -> Self {
        let units = context.units();
        let words = |driven, quantity, reaction| Self { driven, quantity, reaction };
        let moved = |quantity: String| words("displacement", units.label(&quantity, 0, 1), units.label("force", 1, 0));
        let energy = || units.label("derivative of the energy", 1, 1);
        let torque = || units.label("torque", 1, 1);
        match &drive.quantity {
            Driven::Part { part, axis } => {
                let name = context.file.scene.parts.get(*part).map_or("", |part| &part.name.0);
                let along = ["x", "y", "z"][axis % 3];
                if *axis < 3 {
                    moved(format!("displacement of part {name} along {along}"))
                } else {
                    words("rotation", format!("rotation of part {name} about {along} (rad)"), torque())
                }
            }
            Driven::Vertices { vertices, direction: d } => {
                let which =
                    if vertices.len() == 1 { "a vertex".into() } else { format!("{} vertices", vertices.len()) };
                let axis = (0..3).find(|&axis| d[axis] == 1.0);
                let along =
                    axis.map_or_else(|| format!("({:.3}, {:.3}, {:.3})", d.x, d.y, d.z), |k| ["x", "y", "z"][k].into());
                moved(format!("displacement of {which} along {along}"))
            }
            Driven::Loads if context.assembly.terms().loads.is_empty() && context.file.scene.loads.is_empty() => {
                let reaction = "growth of the volume times the pressure at 1".to_owned();
                words("load", "factor of the pressure".into(), reaction)
            }
            Driven::Loads => {
                let conjugate = "displacement of the loads";
                let named = Some(units.label(conjugate, 1, 1)).filter(|label| label != conjugate);
                let conjugate = named.unwrap_or_else(|| format!("{conjugate} (force times length)"));
                words("load", "factor of the loads".into(), conjugate)
            }
            Driven::Pressure(name) => words(
                "pressure",
                units.label(&format!("pressure {name}"), 1, -2),
                units.label("growth of the volume", 0, 3),
            ),
            Driven::Volume(name) => words(
                "volume",
                units.label(&format!("growth of the volume {name}"), 0, 3),
                units.label("pressure", 1, -2),
            ),
            Driven::Lock(_) => words("lock", "fold angle of the lock (rad)".into(), torque()),
            Driven::Rest => words("rest", "rest angles (0: as drawn, 1: as given)".into(), energy()),
            Driven::Stiffness(kind) => words("stiffness", format!("stiffness of {}", kind.name()), energy()),
        }
    }
}

/// Returns the word for an event in tables and summaries.
pub(crate) fn event_word(event: PathEvent) -> &'static str {
    match event {
        PathEvent::LimitLoad => "limit-load",
        PathEvent::LimitDisplacement => "limit-displacement",
        PathEvent::BranchPoint => "branch-point",
        PathEvent::SelfIntersection => "self-intersection",
        PathEvent::Snap => "snap",
        PathEvent::Stop => "stop",
    }
}

/// Returns the figure of the reaction as a function of the driven value.
pub(crate) fn figure(context: &Context<'_>, drive: &Drive, branches: &[PathBranch]) -> Canvas {
    let Words { quantity, reaction, .. } = Words::new(context, drive);
    let state = format!("{reaction} against {quantity}");
    let branch = |branch: &PathBranch| {
        let states = branch.points.iter().map(|point| PlottedState {
            drive: point.drive,
            reaction: point.reaction,
            stable: point.negative_eigenvalues == Some(0),
            event: point.event.map(event_word),
        });
        states.collect()
    };
    let plot = ReactionPlot {
        drive: quantity,
        reaction,
        logarithmic: matches!(drive.quantity, Driven::Stiffness(_)),
        branches: branches.iter().map(branch).collect(),
    };
    reaction::svg(&plot, &context.caption(state))
}
