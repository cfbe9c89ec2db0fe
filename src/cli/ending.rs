//! The ends of a command: exit statuses, failures and what is printed about them.

use std::io::{self, Write};
use std::path::PathBuf;

use foldwell::run::RunError;
use miette::{Diagnostic, GraphicalReportHandler};
use thiserror::Error;

use crate::parameters::ParameterError;

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
#[derive(Debug, Error)]
pub(super) enum CommandFailure {
    #[error(transparent)]
    Run(#[from] RunError),
    #[error(transparent)]
    Parameters(#[from] ParameterError),
    #[error("standard input: {0}")]
    StandardInput(io::Error),
    #[error(
        "{} and {} would write into the same folder, {}; run them apart, each with its --out", first.display(),
        second.display(), out.display()
    )]
    SameFolder { first: PathBuf, second: PathBuf, out: PathBuf },
    #[error("the folder of this run would be {}, which is a file; name another one with --out", .0.display())]
    NoFolder(PathBuf),
    #[error("standard output: {0}")]
    StandardOutput(io::Error),
    #[error("no thread can be had for the work: {0}")]
    Thread(io::Error),
}

impl CommandFailure {
    /// Returns the exit status.
    pub(super) fn exit_status(&self) -> u8 {
        match self {
            Self::Run(error) => error.exit_status(),
            Self::Parameters(_) | Self::StandardInput(_) | Self::SameFolder { .. } | Self::NoFolder(_) => WRONG_INPUT,
            Self::StandardOutput(_) | Self::Thread(_) => BROKEN_PLACE,
        }
    }
}

/// Prints on standard output; it is not an error if the reader has closed it.
pub(super) fn say(text: &str) -> Result<u8, CommandFailure> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes()).and_then(|()| out.flush()).map_or_else(closed, |()| Ok(0))
}

/// Returns the end of a command whose text could not be printed.
pub(super) fn closed(error: io::Error) -> Result<u8, CommandFailure> {
    if error.kind() == io::ErrorKind::BrokenPipe { Ok(0) } else { Err(CommandFailure::StandardOutput(error)) }
}

/// Prints a failure on standard error: description, place in the scene and proposed correction.
pub(super) fn report(failure: &CommandFailure) {
    let text = match failure {
        CommandFailure::Run(error) => fancy(error),
        other => format!("Error: {other}\n"),
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
