//! The `foldwell` command.

mod cli;
mod describe;
mod parameters;
mod progress;

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::main()
}
