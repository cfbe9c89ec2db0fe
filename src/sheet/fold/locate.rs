//! Reading JSON values with their position in the text, for messages that give line and column.

use serde_json::value::RawValue;

use crate::sheet::error::{MeshProblem, SheetError};
use crate::sheet::serde_message::without_place;
use crate::sheet::text::{line_and_column, shortened};

/// A text and the name of its file.
pub(super) struct Source<'a> {
    pub name: &'a str,
    pub text: &'a str,
}

impl<'a> Source<'a> {
    /// Returns the error that a value of the text has this problem.
    pub(crate) fn at(&self, value: &RawValue, problem: MeshProblem) -> SheetError {
        self.at_value(Some(value), problem)
    }

    /// Returns the error that a value has this problem, or the text as a whole where no value is given.
    pub(crate) fn at_value(&self, value: Option<&RawValue>, problem: MeshProblem) -> SheetError {
        let offset = |value: &RawValue| (value.get().as_ptr() as usize).wrapping_sub(self.text.as_ptr() as usize);
        SheetError::bad(self.name, line_and_column(self.text, value.map_or(0, offset)), problem)
    }

    /// Returns the error of the JSON parser, without the position in its message.
    pub(crate) fn syntax(&self, error: &serde_json::Error) -> SheetError {
        SheetError::bad(
            self.name,
            [error.line(), error.column()],
            MeshProblem::Syntax { message: without_place(error) },
        )
    }

    /// Reads the value as a `T`; `what` is the name of the value in messages, and `right` describes what it should
    /// be.
    pub(crate) fn typed<T: serde::Deserialize<'a>>(
        &self,
        value: &'a RawValue,
        what: impl Fn() -> String,
        right: &'static str,
    ) -> Result<T, SheetError> {
        serde_json::from_str(value.get()).map_err(|_| self.mistyped(value, what(), right))
    }

    /// Returns the error that `value` is not what it should be, although its JSON type may be right.
    pub(crate) fn mistyped(&self, value: &RawValue, what: String, right: &'static str) -> SheetError {
        self.at(value, MeshProblem::Type { what, found: on_one_line(value.get()), right })
    }

    /// Reads a list of vertex numbers below `count`.
    pub(crate) fn indices(
        &self,
        value: &'a RawValue,
        what: impl Fn() -> String,
        count: usize,
    ) -> Result<Vec<usize>, SheetError> {
        let entries: Vec<&RawValue> = self.typed(value, &what, "a list of vertex numbers")?;
        entries.into_iter().map(|entry| self.index(entry, &what, count)).collect()
    }

    fn index(&self, entry: &RawValue, what: impl Fn() -> String, count: usize) -> Result<usize, SheetError> {
        let text = entry.get();
        match text.parse::<usize>() {
            Ok(number) if number < count => Ok(number),
            _ if !text.is_empty() && text.trim_start_matches('-').bytes().all(|b| b.is_ascii_digit()) => {
                let last = count.saturating_sub(1);
                Err(self.at(entry, MeshProblem::Index { what: what(), found: on_one_line(text), first: 0, last }))
            }
            _ => {
                let what = format!("a vertex number of {}", what());
                Err(self.at(entry, MeshProblem::Type { what, found: on_one_line(text), right: "a whole number" }))
            }
        }
    }
}

/// Returns a value's text on one line, cut after 40 characters.
fn on_one_line(text: &str) -> String {
    shortened(&text.split_whitespace().collect::<Vec<_>>().join(" "), 40)
}
