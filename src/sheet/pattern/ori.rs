//! Oriedita's `.ori` files: JSON whose `lineSegments` are the lines, in the directions and with the meaning of `.cp`.
//!
//! ```text
//! {"@version": "v1.1", "title": "..",
//!  "lineSegments": [{"a": "-200.0,-200.0", "b": "-200.0,200.0", "color": "BLACK_0", ..}, ..], ..}
//! ```
//!
//! Lines of `auxLineSegments`, circles and texts are construction, which the program does not fold either.

use serde::Deserialize;
use serde_json::value::RawValue;

use super::cp::{self, LineType, typed};
use super::line::{DrawnLines, Lines, PatternLine, offset};
use crate::sheet::pattern_fault::PatternFault;
use crate::sheet::serde_message::without_place;
use crate::sheet::text::line_and_column;

/// The format as messages name it.
const FORMAT: &str = "an ORI file of Oriedita, which is JSON";

/// The numbers at the ends of colours; all others are auxiliary.
const TYPES: [LineType; 4] = {
    let [_, (_, b, no_angle, _), (_, m, mountain, _), (_, v, valley, _), (_, f, flat, auxiliary)] = cp::TYPES;
    [(0, b, no_angle, false), (1, m, mountain, false), (2, v, valley, false), (3, f, flat, auxiliary)]
};

/// The colours as messages name them.
const RIGHT: &str = "BLACK_0 (boundary), RED_1 (mountain), BLUE_2 (valley) or CYAN_3 (auxiliary)";

#[derive(Deserialize)]
struct Save<'a> {
    title: Option<String>,
    #[serde(borrow, rename = "lineSegments")]
    segments: Vec<&'a RawValue>,
}

#[derive(Deserialize)]
struct Segment {
    a: String,
    b: String,
    color: String,
}

/// Reads the lines of a text.
pub(super) fn lines(text: &str) -> Lines {
    let syntax =
        |error: &serde_json::Error| PatternFault::Syntax { format: FORMAT, message: without_place(error) }.into();
    let save: Save =
        serde_json::from_str(text).map_err(|error| ([error.line().max(1), error.column().max(1)], syntax(&error)))?;
    let mut drawn =
        DrawnLines { title: save.title.filter(|title| title != "_").unwrap_or_default(), ..DrawnLines::default() };
    for raw in save.segments {
        let at = offset(text, raw.get());
        let segment: Segment =
            serde_json::from_str(raw.get()).map_err(|error| (line_and_column(text, at), syntax(&error)))?;
        drawn.push(line(&segment, at).map_err(|fault| (line_and_column(text, at), fault.into()))?);
    }
    Ok(drawn)
}

fn line(segment: &Segment, at: usize) -> Result<PatternLine, PatternFault> {
    let right = "two numbers, `-200.0,200.0`";
    let [a, b] = [&segment.a, &segment.b]
        .map(|point| point.split_once(',').ok_or_else(|| PatternFault::value(point, "point", right)));
    let ((x1, y1), (x2, y2)) = (a?, b?);
    let ends = cp::numbers([x1, y1, x2, y2].map(str::trim))?;
    let number = segment.color.rsplit_once('_').map_or("", |(_, number)| number);
    let is_colour = number.parse::<usize>().is_ok_and(|number| number > 3);
    let found = if is_colour { "3" } else { number };
    typed(found, (&TYPES, RIGHT), ends, at).map_err(|_| PatternFault::value(&segment.color, "colour of a line", RIGHT))
}
