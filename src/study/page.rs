//! The page of a study, made of its other files: those are written too only where the study asks for them.

use super::{Answer, Context};
use crate::output::artifact::Artifact::{self, Grid, Net, Page, Script, Series, State, Surface, Svg, Table};
use crate::output::html::{Content, StudyFiles, page};
use crate::scene::spec::Draw;

/// Adds the page of a study if it asks for one, and takes away the pictures that were made for the page alone.
pub(crate) fn add(answer: &mut Answer, context: &Context<'_>) {
    if !context.study.draw.contains(&Draw::Html) {
        return;
    }
    let summary = serde_json::to_value(&answer.summary).ok().and_then(|summary| summary.as_object().cloned());
    let shown = answer.files.iter().filter_map(|(name, artifact)| Some((name.clone(), Content::of(artifact)?)));
    let study = StudyFiles::new(summary.unwrap_or_default(), shown);
    let text = page(&context.file.title(), &[study]);
    answer.files.retain(|(_, artifact)| draw(artifact).is_none_or(|draw| context.study.draw.contains(&draw)));
    answer.add(format!("{}.html", context.name()), Page(text));
}

/// Returns the kind of picture that a file is; `None` for tables.
fn draw(artifact: &Artifact) -> Option<Draw> {
    match artifact {
        Table(_) => None,
        State(_) | Surface(_) | Net(_) | Grid(_) | Script(_) | Series(_) => Some(Draw::Vtk),
        Svg(_) => Some(Draw::Svg),
        Page(_) => Some(Draw::Html),
    }
}
