//! The slowest vibrations of a study of kind `modes`: their table, series and picture.

use crate::analysis::modes::Vibrations;
use crate::output::artifact::Artifact;
use crate::output::figure::rounded;
use crate::output::picture::Picture;
use crate::output::table::{Table, Value};
use crate::scene::spec::Draw;
use crate::study::answer::Answer;
use crate::study::context::Context;
use crate::study::states;

/// Adds a table of the frequencies and the state with each motion as displacement, and a picture of the slowest motion
/// after the rigid ones; `moving` makes a picture of velocities.
pub(super) fn add(
    answer: &mut Answer,
    context: &Context<'_>,
    (vibrations, rigid_motions): (&Vibrations, usize),
    moving: impl Fn(&Vec<f64>) -> Picture,
) {
    let (name, frequencies) = (context.name(), vibrations.frequencies());
    let mut table = Table::new(["mode", "frequency", "growth_rate"].map(str::to_owned).to_vec());
    for (k, (frequency, rate)) in (0..).zip(frequencies.iter().zip(vibrations.growth_rates())) {
        let numbers = [*frequency, rate].map(|number| Value::Number(number.unwrap_or(f64::NAN)));
        table.push([Value::Whole(k)].into_iter().chain(numbers).collect());
    }
    answer.add(format!("{name}-frequencies.csv"), table);
    if vibrations.vectors.is_empty() || context.study.draw.is_empty() {
        return;
    }
    let slowest = rigid_motions.min(vibrations.vectors.len() - 1);
    let shown = moving(&vibrations.vectors[slowest]).displaced(0.1);
    if context.draws(Draw::Vtk) {
        let mut entries = Vec::new();
        for (k, motion) in vibrations.vectors.iter().enumerate() {
            let file = format!("{name}/{name}_vibration_{k:04}.vtu");
            answer.add(&file, moving(motion));
            entries.push((k as f64, file));
        }
        answer.add(format!("{name}-vibrations.pvd"), Artifact::Series(entries));
    }
    let value = match frequencies[slowest] {
        Some(frequency) => format!("frequency {}", rounded(frequency, 5)),
        None => "which grows".to_owned(),
    };
    let state = format!("vibration {slowest}, {value}, drawn with an amplitude of a tenth of the sheet");
    states::add_figure(answer, context, &shown, &state);
}
