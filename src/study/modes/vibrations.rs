//! The slowest vibrations of a study of kind `modes`: their table, series and picture.

use crate::analysis::modes::Vibrations;
use crate::output::figure::rounded;
use crate::output::table::Table;
use crate::study::{Answer, Context, states};

/// Adds a table of the frequencies and the state with each motion as displacement, and a picture of the slowest motion
/// after the rigid ones.
pub(super) fn add(
    answer: &mut Answer,
    context: &Context<'_>,
    (vibrations, rigid_motions): (&Vibrations, usize),
    coordinates: &[f64],
) {
    let (name, frequencies) = (context.name(), vibrations.frequencies());
    let mut table = Table::new("mode,frequency,growth_rate");
    for (k, (frequency, rate)) in frequencies.iter().zip(vibrations.growth_rates()).enumerate() {
        table.push([k.into(), (*frequency).into(), rate.into()]);
    }
    answer.add(format!("{name}-frequencies.csv"), table);
    if vibrations.vectors.is_empty() || context.study.draw.is_empty() {
        return;
    }
    let slowest = rigid_motions.min(vibrations.vectors.len() - 1);
    let pictures = states::moving(context, coordinates, &vibrations.vectors);
    let shown = pictures[slowest].displaced(0.1);
    states::add_motions(answer, context, ["_vibration", "-vibrations"], pictures);
    let value = match frequencies[slowest] {
        Some(frequency) => format!("frequency {}", rounded(frequency, 5)),
        None => "which grows".to_owned(),
    };
    let state = format!("vibration {slowest}, {value}, drawn with an amplitude of a tenth of the sheet");
    states::add_figure(answer, context, &shown, &state);
}
