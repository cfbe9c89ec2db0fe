//! The ends of a command: exit statuses, failures and what is printed about them.

use std::io::{self, Write};

use foldwell::run::RunError;
use miette::{Diagnostic, GraphicalReportHandler};

use crate::parameters::ParameterError;
use crate::scenes::ScenesError;

/// A study did not converge.
pub(super) const FAILED: u8 = 1;
/// The input is wrong.
pub(super) const WRONG_INPUT: u8 = 2;
/// The system failed: a file, a thread, standard output.
pub(super) const BROKEN_PLACE: u8 = 3;
/// The run was interrupted.
pub(super) const INTERRUPTED: u8 = 130;

/// Most characters of a line of a message, in which a name of a file may be long.
const LONGEST_LINE: usize = 1000;

/// The reasons for which a command failed.
pub(super) enum Failure {
    Run(RunError),
    Parameters(ParameterError),
    Scenes(ScenesError),
    StandardOutput(io::Error),
    Thread(io::Error),
}

impl From<ScenesError> for Failure {
    fn from(error: ScenesError) -> Self {
        match error {
            ScenesError::Run(error) => Self::Run(error),
            error => Self::Scenes(error),
        }
    }
}

impl From<RunError> for Failure {
    fn from(error: RunError) -> Self {
        Self::Run(error)
    }
}

impl Failure {
    /// Returns the exit status.
    pub(super) fn exit_status(&self) -> u8 {
        match self {
            Self::Run(error) => error.exit_status(),
            Self::Parameters(_) | Self::Scenes(_) => WRONG_INPUT,
            Self::StandardOutput(_) | Self::Thread(_) => BROKEN_PLACE,
        }
    }
}

/// Prints on standard output; it is not an error if the reader has closed it.
pub(super) fn say(text: &str) -> Result<u8, Failure> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes()).and_then(|()| out.flush()).map_or_else(closed, |()| Ok(0))
}

/// Returns the end of a command whose text could not be printed.
pub(super) fn closed(error: io::Error) -> Result<u8, Failure> {
    if error.kind() == io::ErrorKind::BrokenPipe { Ok(0) } else { Err(Failure::StandardOutput(error)) }
}

/// Prints a failure on standard error: description, place in the scene and proposed correction.
pub(super) fn report(failure: &Failure) {
    let text = match failure {
        Failure::Run(error) => fancy(error),
        Failure::Parameters(error) => format!("Error: {error}\n"),
        Failure::Scenes(error) => format!("Error: {error}\n"),
        Failure::StandardOutput(error) => format!("Error: standard output: {error}\n"),
        Failure::Thread(error) => format!("Error: no thread can be had for the work: {error}\n"),
    };
    let cut = |line: &str| line.char_indices().nth(LONGEST_LINE).map_or(line.len(), |(end, _)| end);
    let text: Vec<&str> = text.lines().map(|line| &line[..cut(line)]).collect();
    // an error is ignored: there is no other place for the message if standard error is closed
    let _ = writeln!(io::stderr(), "{}", text.join("\n"));
}

/// Returns the description of an error with an excerpt of the scene at its place. Lines are not wrapped, so that
/// `file:line:column` stays in one piece.
fn fancy(error: &dyn Diagnostic) -> String {
    let terminal = io::IsTerminal::is_terminal(&io::stderr()) && std::env::var_os("NO_COLOR").is_none();
    let theme = if terminal { miette::GraphicalTheme::unicode() } else { miette::GraphicalTheme::unicode_nocolor() };
    let handler = GraphicalReportHandler::new_themed(theme).with_wrap_lines(false).without_cause_chain();
    let mut text = String::from("Error:");
    match handler.render_report(&mut text, error) {
        Ok(()) => text + "\n",
        Err(_) => format!("Error: {error}\n"),
    }
}
