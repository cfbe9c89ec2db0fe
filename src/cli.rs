//! The words of the command line and the exit status.
//!
//! | status | meaning |
//! |---|---|
//! | 0 | every study gave its answer |
//! | 1 | a study failed; what was computed is on disk and `summary.json` says which and why |
//! | 2 | the input is wrong; nothing is written |
//! | 3 | reading or writing an existing place failed |
//! | 130 | stopped by Ctrl-C; what is finished is on disk |

use std::fmt::Write as _;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;

use crate::validate::report::Case;
use crate::validate::{self, ValidateOptions, ValidationError};
use clap::{CommandFactory, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;
use foldwell::output;
use foldwell::output::summary::{
    BranchesSummary, ModesSummary, RelaxSummary, StudyResult, StudySummary, SurfaceSummary, TraceSummary, WellsSummary,
    to_json,
};
use foldwell::run::{self, Ledger, RunError, RunOptions, RunReport};
use miette::{Diagnostic, GraphicalReportHandler};

use crate::parameters::{self, ParameterError};
use crate::progress::Watch;

const FAILED: u8 = 1;
const WRONG_INPUT: u8 = 2;
const BROKEN_PLACE: u8 = 3;
const INTERRUPTED: u8 = 130;

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
        /// The scene
        scene: PathBuf,
        /// Folder for the files [default: the scene's name without its ending]
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
        /// Number of threads [default: as many as the machine has]
        #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
        threads: Option<u16>,
        /// Keep the studies that an interrupted run finished
        #[arg(long)]
        resume: bool,
        /// Say nothing but errors
        #[arg(long)]
        quiet: bool,
        /// Print the summary as JSON on standard output
        #[arg(long)]
        json: bool,
    },
    /// Counts and measures of the sheet of a mesh or a scene
    Info {
        /// A mesh (.fold, .obj, .vtu) or a scene (.toml), of which the mesh is counted, not its cells
        mesh_or_scene: PathBuf,
        /// Print JSON
        #[arg(long)]
        json: bool,
    },
    /// Generate a pattern
    #[command(override_usage = "foldwell new <PATTERN> [--key value]... -o <FILE.fold>")]
    New {
        /// miura, miura-patch, eggbox, waterbomb, yoshimura, kresling, square-twist, random, random-developable
        pattern: String,
        /// Parameters of the pattern, --key value (radians; a list has commas), and -o FILE.fold for the mesh
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        parameters: Vec<String>,
    },
    /// Convert a mesh between FOLD, OBJ and VTU
    Convert {
        /// The file that is there
        from: PathBuf,
        /// The file to write
        to: PathBuf,
    },
    /// Check the claims about this program, and write a report
    Validate {
        /// Only these claims [default: all]
        claims: Vec<String>,
        /// Leave out what takes long
        #[arg(long)]
        quick: bool,
        /// Folder for the reports
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
    },
    /// Print the JSON schema of a scene, or of the summary that a run writes
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
}

/// Why a command did not give its answer.
enum Failure {
    Run(RunError),
    Validation(ValidationError),
    Parameters(ParameterError),
    StandardOutput(io::Error),
    Thread(io::Error),
}

impl From<RunError> for Failure {
    fn from(error: RunError) -> Self {
        Self::Run(error)
    }
}

impl Failure {
    fn exit_status(&self) -> u8 {
        match self {
            Self::Run(error) => error.exit_status(),
            Self::Validation(error) => error.exit_status(),
            Self::Parameters(_) => WRONG_INPUT,
            Self::StandardOutput(_) | Self::Thread(_) => BROKEN_PLACE,
        }
    }
}

/// Runs the command line.
pub fn main() -> ExitCode {
    let status = dispatch(Cli::parse().command).unwrap_or_else(|failure| {
        report(&failure);
        failure.exit_status()
    });
    ExitCode::from(status)
}

fn dispatch(command: Command) -> Result<u8, Failure> {
    match command {
        Command::Run { scene, out, threads, resume, quiet, json } => {
            let options = RunOptions { out, threads: threads.map(usize::from), resume };
            run_scene(&scene, &options, quiet, json)
        }
        Command::Info { mesh_or_scene, json } => {
            let info = run::info(&mesh_or_scene)?;
            say(&if json { to_json(&info) } else { format!("{info}\n") })
        }
        Command::New { pattern, parameters } => {
            let (table, out) = parameters::parse(&pattern, &parameters).map_err(Failure::Parameters)?;
            run::new_mesh(&table, &out)?;
            Ok(0)
        }
        Command::Convert { from, to } => {
            for note in run::convert(&from, &to)? {
                // there is nobody left to tell where standard error is closed
                let _ = writeln!(io::stderr(), "{}: {note}", to.display());
            }
            Ok(0)
        }
        Command::Validate { claims, quick, out } => validate(&ValidateOptions { quick, out, only: claims }),
        Command::Schema { of: Described::Scene } => say(&foldwell::scene::schema()),
        Command::Schema { of: Described::Summary } => say(&output::schema::schema()),
        Command::Completions { shell } => say(&completions(shell)),
    }
}

fn run_scene(scene: &Path, options: &RunOptions, quiet: bool, json: bool) -> Result<u8, Failure> {
    let watch = Arc::new(Watch::new(quiet));
    let ledger = Ledger::default();
    let (scene, options, books) = (scene.to_owned(), options.clone(), ledger.clone());
    let found = watch.over(move |watch| run::run_with_ledger(&scene, &options, &|step| watch.step(step), &books));
    watch.finish();
    let report = match found.map_err(Failure::Thread)? {
        Some(report) => report?,
        None => match ledger.close()? {
            Some(report) => report,
            None => return Ok(INTERRUPTED),
        },
    };
    for note in report.notes.iter().filter(|_| !quiet) {
        // there is nobody left to tell where standard error is closed
        let _ = writeln!(io::stderr(), "note: {note}");
    }
    if json {
        say(&report.summary.to_json())?;
    } else if !quiet {
        say(&describe_run(&report))?;
    }
    Ok(match (report.interrupted, report.summary.converged()) {
        (true, _) => INTERRUPTED,
        (false, true) => 0,
        (false, false) => FAILED,
    })
}

/// Checks the claims; each is a line on standard error once it is decided.
fn validate(options: &ValidateOptions) -> Result<u8, Failure> {
    let watch = Arc::new(Watch::new(false));
    let options = options.clone();
    let found = watch.over(move |watch| validate::validate(&options, &|step| watch.step(step), &mut announce));
    watch.finish();
    let Some(report) = found.map_err(Failure::Thread)? else { return Ok(INTERRUPTED) };
    let report = report.map_err(Failure::Validation)?;
    say(&format!("{}\n", report.verdict()))?;
    Ok(match (report.interrupted, report.all_passed()) {
        (true, _) => INTERRUPTED,
        (false, true) => 0,
        (false, false) => FAILED,
    })
}

fn announce(case: &Case) {
    let mark = if case.passed { "holds" } else { "FAILS" };
    eprintln!("{mark}  {}: {} ({:.2} s)", case.name, case.distance(), case.seconds);
    case.failure.iter().for_each(|failure| eprintln!("       {failure}"));
}

/// Prints on standard output; a reader that has gone away is no failure.
fn say(text: &str) -> Result<u8, Failure> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(Failure::StandardOutput(error)),
        _ => Ok(0),
    }
}

fn completions(shell: Shell) -> String {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "foldwell", &mut script);
    String::from_utf8_lossy(&script).into_owned()
}

/// Prints a failure on standard error: what is wrong, the place in the scene, what would be right.
fn report(failure: &Failure) {
    let text = match failure {
        Failure::Run(error) => fancy(error),
        Failure::Validation(error) => fancy(error),
        Failure::Parameters(error) => format!("Error: {error}\n"),
        Failure::StandardOutput(error) => format!("Error: standard output: {error}\n"),
        Failure::Thread(error) => format!("Error: no thread can be had for the work: {error}\n"),
    };
    // there is nobody left to tell where standard error is closed
    let _ = io::stderr().write_all(text.as_bytes());
}

/// With a drawing of the place; lines are not wrapped, so that `file:line:column` stays in one piece.
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

fn describe_run(report: &RunReport) -> String {
    let mut text = String::new();
    for study in &report.summary.studies {
        // writing to a string does not fail
        let kept = if report.kept.contains(&study.name) { " (kept)" } else { "" };
        let _ = writeln!(text, "{}{kept}", describe_study(study));
    }
    let _ = writeln!(text, "files in {}", report.out.display());
    text
}

/// Energy and residuals, and what is easily overlooked: that the state is not stable, that faces pass through each other.
fn describe_relaxation(relax: &RelaxSummary) -> String {
    let unstable = match relax.negative_eigenvalues {
        None | Some(0) => String::new(),
        Some(count) => format!(", not stable ({})", counted(count, "negative eigenvalue")),
    };
    let crossing = if relax.self_intersecting == Some(true) { ", faces pass through each other" } else { "" };
    let residuals = match [relax.residual_force, relax.residual_length] {
        [force, length] if force.is_nan() && length.is_nan() => "no residuals".to_owned(),
        [force, length] => format!("residuals {force:.1e} (force) {length:.1e} (length)"),
    };
    let iterations = counted(relax.iterations, "iteration");
    let branching = match (relax.branch_point_start, relax.directions_at_start.as_deref()) {
        (_, Some("continuum")) => {
            ", infinitely many directions leave the start: others may lead to other equilibria".into()
        }
        (Some(rays), _) => {
            format!(", the start is a branch point with {rays} rays: other branches may have other equilibria")
        }
        (None, Some("not-established")) => ", it is not known whether the start is a branch point".into(),
        (None, _) => String::new(),
    };
    format!("energy {:.9e}, {iterations}, {residuals}{unstable}{crossing}{branching}", relax.energy.total)
}

/// The folding modes have their own count, by fold angles: it is not a part of that of the zero modes.
fn describe_modes(modes: &ModesSummary) -> String {
    format!(
        "{}, of which {} {} rigid; {}; {}",
        counted(modes.zero_modes, "zero mode"),
        modes.rigid_motions,
        if modes.rigid_motions == 1 { "is" } else { "are" },
        if modes.self_stresses == 1 {
            "1 self stress".into()
        } else {
            format!("{} self stresses", modes.self_stresses)
        },
        modes.folding_modes.map_or("folding modes unknown".into(), |count| counted(count, "folding mode")),
    )
}

/// `1 well`, `2 wells`.
fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

/// Number of rays, and whether these are all directions in which the sheet folds.
fn describe_branches(branches: &BranchesSummary) -> String {
    let rays = match branches.directions.as_str() {
        "continuum" => {
            format!(
                "{}, and infinitely many directions that fill a curve or more",
                counted(branches.real_rays, "single real ray")
            )
        }
        "not-established" => format!("{} found, others not excluded", counted(branches.real_rays, "real ray")),
        _ => counted(branches.real_rays, "real ray"),
    };
    format!("{rays}, {} complex solutions of {}", branches.complex_solutions, branches.expected)
}

/// How many random starts ended in no minimum, and how many failed and why, where some did.
fn describe_failures(found: &WellsSummary) -> String {
    let saddles = match found.saddles {
        0 => String::new(),
        count => format!("; {count} of {} ended in no minimum", counted(found.starts, "start")),
    };
    if found.failed == 0 {
        return saddles;
    }
    let reasons: Vec<String> = found.failures.iter().map(|one| format!("{}: {}", one.starts, one.reason)).collect();
    format!("{saddles}; {} of {} failed ({})", found.failed, counted(found.starts, "start"), reasons.join("; "))
}

/// How every trajectory ended, and whether there are directions that none follows.
fn describe_trace(traced: &TraceSummary) -> String {
    let ends = traced.branches.iter().map(|one| match one.branch {
        Some(_) => format!("{} at {:.6}", one.end, one.arc_length),
        None => "no real direction to fold along".to_owned(),
    });
    let others = match traced.directions.as_str() {
        "continuum" => "; infinitely many other directions are not followed",
        "not-established" => "; other directions are not excluded",
        _ => "",
    };
    ends.collect::<Vec<_>>().join(", ") + others
}

fn describe_surface(surface: &SurfaceSummary) -> String {
    let SurfaceSummary { points, triangles, coverage, gaps, .. } = surface;
    let established = surface.established.iter().map(|established| format!(": {established}"));
    let gaps = (*gaps > 0).then(|| format!(", but triangles are missing beside {gaps} states"));
    format!("{points} states, {triangles} triangles, {coverage}") + &established.chain(gaps).collect::<String>()
}

fn describe_study(study: &StudySummary) -> String {
    let what = match &study.result {
        Some(StudyResult::Relax(relax)) => describe_relaxation(relax),
        Some(StudyResult::Modes(modes)) => describe_modes(modes),
        Some(StudyResult::Branches(branches)) => describe_branches(branches),
        Some(StudyResult::Trace(traced)) => describe_trace(traced),
        Some(StudyResult::Surface(surface)) => describe_surface(surface),
        Some(StudyResult::Landscape(landscape)) => {
            let modes = landscape.modes.iter().map(|one| {
                let mode = match (one.wave, one.mode) {
                    (Some(wave), _) => format!("wave {wave:?}"),
                    (_, mode) => format!("{:?}", mode.unwrap_or([f64::NAN; 3])),
                };
                let exponent = one.exponent.map_or("?".into(), |exponent| format!("{exponent:.3}"));
                let [c4, c6] = [one.predicted_coefficient, one.predicted_sixth].map(|c| c.unwrap_or(f64::NAN));
                let below = match one.below_rounding {
                    0 => String::new(),
                    count => format!(" ({} below rounding left out)", counted(count, "sample")),
                };
                let agrees = if one.fit_agrees == Some(false) { "; THE FIT DISAGREES" } else { "" };
                format!("{mode}: exponent {exponent}{below}, predicted {c4:.6e} a^4, {c6:.6e} a^6{agrees}")
            });
            modes.collect::<Vec<_>>().join("; ")
        }
        Some(StudyResult::Bloch(bloch)) => {
            let [p1, p2] = bloch.polarization;
            let lines = bloch.zero_lines.map(|count| counted(count, "zero line"));
            let lines = lines.unwrap_or("no real determinant, so that zero lines are not looked for".to_owned());
            let pairing = bloch.pairing_error.map_or("no root known well enough to be paired".to_owned(), |error| {
                format!("pairing error {error:.1e}")
            });
            format!("{lines}, {pairing}, polarization ({p1}, {p2})")
        }
        Some(StudyResult::Wells(found)) => {
            let energies = found.wells.iter().map(|well| format!("{:.6e}", well.energy)).collect::<Vec<_>>().join(", ");
            let barriers = found.barriers.iter().map(|barrier| {
                let bars = barrier.bars.map_or("rigid bars".to_owned(), |bars| format!("bars of {bars:e}"));
                let energy =
                    barrier.energy.map_or("not found".to_owned(), |energy| format!("{energy:.6e} with {bars}"));
                format!("; pass {:?} {energy}", barrier.between)
            });
            let count = counted(found.wells.len(), "well");
            format!("{count} ({energies}){}{}", barriers.collect::<String>(), describe_failures(found))
        }
        None => String::from("no result"),
    };
    let failed = study.reason.as_ref().map(|reason| format!("\n  not converged: {reason}")).unwrap_or_default();
    format!("{} ({}): {what}, {:.2} s{failed}", study.name, study.kind, study.seconds)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// clap finds nothing to complain about in the definition itself.
    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    /// Parameters of patterns and `-o` reach the pattern wherever they stand.
    #[test]
    fn parameters_pass_through() {
        let cli = Cli::try_parse_from("foldwell new miura --height -0.5 -o a.fold".split(' ')).ok().unwrap();
        let Command::New { pattern, parameters } = cli.command else { panic!("another command") };
        assert_eq!((pattern.as_str(), parameters.join(" ").as_str()), ("miura", "--height -0.5 -o a.fold"));
    }

    /// No threads at all cannot be asked for.
    #[test]
    fn there_is_at_least_one_thread() {
        assert!(Cli::try_parse_from("foldwell run a.toml --threads 0".split(' ')).is_err());
    }
}
