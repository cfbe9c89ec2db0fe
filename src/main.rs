//! The `foldwell` command.

mod cli;
mod describe;
mod parameters;
mod progress;
mod scenes;
mod validate;

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::main()
}
