//! The command line: its arguments, the output of commands, and the exit status.
//!
//! | status | meaning |
//! |---|---|
//! | 0 | every study has its answer |
//! | 1 | a study failed; the computed files are written and `summary.json` names the study and the reason |
//! | 2 | the input is wrong; nothing is written |
//! | 3 | reading or writing an existing file or folder failed |
//! | 130 | stopped by Ctrl-C; finished studies are written |

mod ending;
mod runs;
mod scenes;

use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::error::{ContextKind, ContextValue};
use clap::{CommandFactory, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;
use foldwell::output::json::to_json;
use foldwell::run::{self, FilmOptions, RunOptions, Shard, Wanted};
use foldwell::scene::Setting;
use foldwell::sheet::pattern::Cleanup;
use foldwell::sheet::similar::most_similar;

use crate::parameters;
use ending::{CommandFailure, closed, report, say};
use runs::{Told, run_scenes};

/// Energy wells of folding sheets.
#[derive(Parser)]
#[command(version, about, arg_required_else_help = true)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Compute the studies of a scene and write their files
    Run {
        /// The scenes; `-` is a scene on standard input, whose paths are relative to the current folder
        #[arg(required = true)]
        scenes: Vec<PathBuf>,
        /// Folder for the files, of several scenes one below it for each [default: the scene's name without its ending]
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
        /// Set a key of the scenes, as in energy.bars.stiffness=1e4 or study.NAME.tolerance=1e-9; may be repeated
        #[arg(long, value_name = "KEY=VALUE")]
        set: Vec<Setting>,
        /// Number of threads [default: as many as the machine has]
        #[arg(long, value_name = "N", allow_negative_numbers = true)]
        #[arg(value_parser = clap::value_parser!(u16).range(1..))]
        threads: Option<u16>,
        /// Keep the studies that an interrupted run finished, of a sweep the points
        #[arg(long)]
        resume: bool,
        /// Compute part I of N of the points of a sweep: every Nth from the Ith
        #[arg(long, value_name = "I/N")]
        shard: Option<Shard>,
        /// Frame of the scene's FOLD file [default: that of the scene, or the first with a mesh]
        #[arg(long, value_name = "N", allow_negative_numbers = true)]
        frame: Option<usize>,
        /// Say nothing but errors
        #[arg(long)]
        quiet: bool,
        /// Print the summary as JSON on standard output, of several scenes a list
        #[arg(long)]
        json: bool,
    },
    /// Counts and measures of the sheet of a mesh or a scene, and of the energy of a scene
    Info {
        /// A mesh (.fold, .obj, .stl, .vtu, .svg, .cp, .opx, .ori, .dxf) or a scene (.toml): one cell of its mesh, and
        /// the energy of all cells
        mesh_or_scene: PathBuf,
        /// Set a key of the scene, as in energy.bars.stiffness=1e4; may be repeated
        #[arg(long, value_name = "KEY=VALUE")]
        set: Vec<Setting>,
        /// Frame of the FOLD file: 0 is its top, those of file_frames are 1, 2, ... [default: the first with a mesh]
        #[arg(long, value_name = "N", allow_negative_numbers = true)]
        frame: Option<usize>,
        /// Print JSON
        #[arg(long)]
        json: bool,
        /// Print the numbers and names of the edges, their kinds, letters, lengths and angles, as CSV
        #[arg(long, conflicts_with_all = ["json", "vertices"])]
        edges: bool,
        /// Print the numbers and coordinates of the vertices, as CSV
        #[arg(long, conflicts_with = "json")]
        vertices: bool,
    },
    /// Generate a pattern
    #[command(
        override_usage = "foldwell new <PATTERN> [--key value]... -o <FILE.fold>\n       foldwell new <PATTERN> --help"
    )]
    #[command(disable_help_flag = true)]
    New {
        /// The name of the pattern; without one, all names are listed
        #[arg(allow_hyphen_values = true, default_value = "--help", hide_default_value = true)]
        pattern: String,
        /// Parameters of the pattern, --key value (1.2 or "60 deg"; a list has commas; --closed alone), and -o
        /// FILE.fold
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        parameters: Vec<String>,
    },
    /// Convert a mesh: from FOLD, OBJ, STL, VTU, SVG, CP, OPX, ORI or DXF to FOLD, OBJ, STL, PLY, GLB, VTU, SVG, CP or
    /// DXF
    Convert {
        /// The file that is there
        from: PathBuf,
        /// The file to write
        to: PathBuf,
        /// Frame of the FOLD file: 0 is its top, those of file_frames are 1, 2, ... [default: the first with a mesh]
        #[arg(long, value_name = "N", allow_negative_numbers = true)]
        frame: Option<usize>,
        /// Merge vertices of a flat crease pattern within this distance, in units of the file [default: 1e-4 of the
        /// extent, or more where lines end beside each other otherwise]
        #[arg(long, value_name = "TOL", allow_negative_numbers = true)]
        merge: Option<f64>,
        /// Split edges of a flat crease pattern where they cross or touch
        #[arg(long)]
        split: bool,
        /// Unfold a developable sheet into the plane: the crease pattern of a folded state
        #[arg(long, conflicts_with_all = ["merge", "split"])]
        flatten: bool,
        /// Join pieces where they touch: vertices at one place, within 1e-9 of the extent, become one
        #[arg(long, conflicts_with_all = ["merge", "split", "flatten"])]
        weld: bool,
        /// Write the solid that the sheet is with this thickness, in units of the file, for printers
        #[arg(long, value_name = "T", allow_negative_numbers = true)]
        #[arg(conflicts_with_all = ["merge", "split", "flatten", "weld"])]
        thickness: Option<f64>,
    },
    /// Write a page of the studies in the folder of a run, to be looked at in a browser, and print its path
    View {
        /// The folder of the run
        folder: PathBuf,
        /// The page [default: view.html in the folder]
        #[arg(short, value_name = "FILE.html")]
        o: Option<PathBuf>,
    },
    /// Write a film of the states of a study, or of each study of a run that has some, and print the path
    Film {
        /// The folder of the run, or the series of one study (NAME.pvd)
        from: PathBuf,
        /// The film, a .gif, or a .mp4 where ffmpeg is [default: NAME.gif beside NAME.pvd]
        #[arg(short, value_name = "FILE")]
        o: Option<PathBuf>,
        /// Frames in a second
        #[arg(long, default_value_t = 12, allow_negative_numbers = true)]
        #[arg(value_parser = clap::value_parser!(u16).range(1..=50))]
        fps: u16,
        /// Width in pixels
        #[arg(long, default_value_t = 640, allow_negative_numbers = true)]
        #[arg(value_parser = clap::value_parser!(u16).range(64..=4096))]
        size: u16,
        /// Number of the branch [default: the first]
        #[arg(long, value_name = "N", allow_negative_numbers = true)]
        branch: Option<i64>,
    },
    /// Print the JSON schema of a scene, or of the summary that a run or a sweep writes
    Schema {
        /// Of what
        #[arg(value_enum, default_value_t)]
        of: Described,
    },
    /// Print a script that completes commands in a shell
    Completions {
        /// The shell
        shell: Shell,
    },
}

/// What has a JSON schema.
#[derive(Clone, Copy, Default, ValueEnum)]
enum Described {
    /// A scene file
    #[default]
    Scene,
    /// `summary.json`
    Summary,
    /// `sweep.json`
    Sweep,
}

/// Runs the command line.
pub(crate) fn main() -> ExitCode {
    let done = match Cli::try_parse() {
        Ok(cli) => dispatch(cli.command),
        // help and the version, which are asked for, are no errors of use
        Err(help) if !help.use_stderr() => {
            help.print().and_then(|()| io::stdout().flush()).map_or_else(closed, |()| Ok(0))
        }
        Err(wrong) => with_suggestion(wrong).exit(),
    };
    let status = done.unwrap_or_else(|failure| {
        report(&failure);
        failure.exit_status()
    });
    ExitCode::from(status)
}

/// Adds the command that is meant to the error about an unknown one, if clap finds none: it overlooks exchanged
/// letters.
fn with_suggestion(mut error: clap::Error) -> clap::Error {
    let (Some(ContextValue::String(word)), None) =
        (error.get(ContextKind::InvalidSubcommand), error.get(ContextKind::SuggestedSubcommand))
    else {
        return error;
    };
    let commands = Cli::command();
    if let Some(meant) = most_similar(word, commands.get_subcommands().map(clap::Command::get_name)) {
        error.insert(ContextKind::SuggestedSubcommand, ContextValue::Strings(vec![meant.to_owned()]));
    }
    error
}

fn dispatch(command: Command) -> Result<u8, CommandFailure> {
    match command {
        Command::Run { scenes, out, mut set, threads, resume, shard, frame, quiet, json } => {
            set.extend(frame.map(Setting::of_frame));
            let options = RunOptions { out, threads: threads.map(usize::from), resume };
            run_scenes(scenes::read(&scenes, &set, &options)?, shard, &Told { quiet, json })
        }
        Command::Info { mesh_or_scene, set, frame, json, edges, vertices } => {
            let wanted = Wanted { settings: set, frame };
            say(&match (edges, vertices) {
                (true, _) => run::list(&mesh_or_scene, &wanted, run::edges)?,
                (_, true) => run::list(&mesh_or_scene, &wanted, run::vertices)?,
                _ if json => to_json(&run::info(&mesh_or_scene, &wanted)?),
                _ => format!("{}\n", run::info(&mesh_or_scene, &wanted)?),
            })
        }
        Command::New { pattern, parameters } => {
            if parameters::ask_for_help(&pattern, &parameters) {
                return say(&parameters::help(&pattern)?);
            }
            let (table, out) = parameters::parse(&pattern, &parameters)?;
            remark(&out, &run::write_sheet(&run::new_sheet(&table)?, &out, None)?);
            Ok(0)
        }
        Command::Convert { from, to, frame, merge, split, flatten, weld, thickness } => {
            let cleanup = Cleanup { merge, split };
            let notes = if flatten {
                run::convert_flattened(&from, &to, frame)?
            } else if weld {
                run::convert_welded(&from, &to, frame)?
            } else if cleanup == Cleanup::default() {
                run::convert(&from, &to, frame, thickness)?
            } else {
                run::convert_cleaned(&from, &to, frame, &cleanup)?
            };
            remark(&to, &notes);
            Ok(0)
        }
        Command::View { folder, o } => say(&format!("{}\n", run::view(&folder, o.as_deref())?.display())),
        Command::Film { from, o, fps, size, branch } => {
            let options = FilmOptions { width: size, frames_per_second: fps };
            let films = run::film(&from, o.as_deref(), branch, options)?;
            say(&films.iter().map(|film| format!("{}\n", film.display())).collect::<String>())
        }
        Command::Schema { of: Described::Scene } => say(&foldwell::scene::schema()),
        Command::Schema { of: Described::Summary } => say(&run::schema::schema()),
        Command::Schema { of: Described::Sweep } => say(&run::schema::of_sweep()),
        Command::Completions { shell } => say(&completions(shell)),
    }
}

/// Prints remarks about a mesh that was written on standard error.
fn remark(to: &Path, notes: &[String]) {
    for note in notes {
        // an error is ignored: there is no other place for the message if standard error is closed
        let _ = writeln!(io::stderr(), "{}: {note}", to.display());
    }
}

fn completions(shell: Shell) -> String {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "foldwell", &mut script);
    String::from_utf8_lossy(&script).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: clap finds no error in the definition of the command line.
    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    /// Claim: parameters of patterns and `-o` reach the pattern at any position.
    #[test]
    fn parameters_pass_through() {
        let cli = Cli::try_parse_from("foldwell new miura --height -0.5 -o a.fold".split(' ')).ok().unwrap();
        let Command::New { pattern, parameters } = cli.command else { panic!("another command") };
        assert_eq!((pattern.as_str(), parameters.join(" ").as_str()), ("miura", "--height -0.5 -o a.fold"));
    }

    /// Claim: zero threads are refused.
    #[test]
    fn there_is_at_least_one_thread() {
        assert!(Cli::try_parse_from("foldwell run a.toml --threads 0".split(' ')).is_err());
    }
}
