//! The kinds of study: each module computes the [`Answer`] to one kind of study of a scene. No file is written here.
//!
//! | kind | module | result |
//! |---|---|---|
//! | `relax` | [`relax`] | the equilibrium that is reached from a start |
//! | `modes` | [`modes`] | zero modes and self-stresses of the bars, the spectrum of the energy |
//! | `branches` | [`branches`] | the rays along which rigid folding leaves the drawn state |
//! | `trace` | [`trace`] | trajectories of rigid folding, and relaxations along them |
//! | `surface` | [`surface`] | the two-dimensional surface of folded states of one cell |
//! | `landscape` | [`landscape`] | the energy along folding modes, and a map over all of them |
//! | `bloch` | [`bloch`] | spatially varying modes |
//! | `wells` | [`wells`] | minima, and the barriers between them |
//! | `path`, `fold` | [`path`] | equilibria along a driven quantity, or along the rest angles |
//! | `response` | [`response`] | linear modes, Poisson's ratios and moduli |
//!
//! [`check`] refuses a study that does not fit its sheet before anything is computed; [`compute`] returns its answer.

pub mod answer;
pub mod bloch;
pub mod branches;
pub mod context;
pub mod energies;
mod error;
pub mod landscape;
pub mod modes;
mod page;
pub mod path;
mod ratios;
pub mod relax;
pub mod response;
mod sides;
mod start;
mod states;
mod summary;
mod supported;
pub mod surface;
pub mod trace;
pub mod wells;

use crate::scene::spec::StudyKind;
pub use answer::Answer;
pub use context::{Checkpoints, Context, Observer, PreviousAnswers, Progress};
pub(crate) use error::NoAnswer;
pub use error::StudyError;
pub use summary::{Files, StudyResult, StudySummary};
pub use surface::left_out;

/// Calls a function of the module that has the kind of a study.
macro_rules! of_kind {
    ($function:ident($context:ident)) => {
        match &*$context.study.kind {
            StudyKind::Relax(spec) => relax::$function($context, spec),
            StudyKind::Modes(spec) => modes::$function($context, spec),
            StudyKind::Branches(_) => branches::$function($context),
            StudyKind::Trace(spec) => trace::$function($context, spec),
            StudyKind::Surface(spec) => surface::$function($context, spec),
            StudyKind::Landscape(spec) => landscape::$function($context, spec),
            StudyKind::Bloch(spec) => bloch::$function($context, spec),
            StudyKind::Wells(spec) => wells::$function($context, spec),
            StudyKind::Path(spec) | StudyKind::Fold(spec) => path::$function($context, spec),
            StudyKind::Response(spec) => response::$function($context, spec),
        }
    };
}

/// Checks that the settings of a study fit its sheet.
///
/// # Errors
/// [`StudyError`] with the place in the scene and a proposed correction.
pub fn check(context: &Context<'_>) -> Result<(), StudyError> {
    use StudyKind::{Branches, Fold, Landscape, Path, Relax, Surface, Trace, Wells};
    let kind = &*context.study.kind;
    supported::of_a_tube(context)?;
    if !matches!(kind, Relax(_) | Wells(_) | Path(_) | Fold(_)) {
        supported::no_parts(context)?;
    }
    if matches!(kind, Branches(_) | Landscape(_) | Surface(_) | Trace(_)) {
        supported::a_surface(context)?;
    }
    if matches!(kind, Wells(_) | Trace(_) | Surface(_)) {
        supported::no_memory(context)?;
    }
    supported::own_terms(context)?;
    of_kind!(check(context))
}

/// Computes the answer of a study. A study that finds no answer is not an error: its summary gives the reason.
///
/// # Errors
/// [`StudyError`] if the scene is wrong in a way that [`check`] does not detect, or if files cannot be read or kept.
pub fn compute(context: &Context<'_>) -> Result<Answer, StudyError> {
    let mut answer = match of_kind!(compute(context)) {
        Ok(answer) => answer,
        Err(NoAnswer::Reason(reason)) => Answer::failed(context.study, reason),
        Err(NoAnswer::Error(error)) => return Err(error),
    };
    page::add(&mut answer, context);
    Ok(answer)
}
