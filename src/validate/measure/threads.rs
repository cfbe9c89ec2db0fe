//! What more threads buy: the program starts itself, so that what is timed is what its user waits for.

use super::super::experiment::{Bench, ExperimentError, Findings, Grid};
use super::super::precision::Setting;
use super::super::report::figure;
use super::super::star::Star;
use super::super::{library, star};
use foldwell::numerics::worst;
use foldwell::output::OutputError;
use foldwell::output::files;
use serde_json::{Value, json};
use std::path::Path;
use std::process::Command;

const THREADS: [usize; 3] = [1, 2, 4];
const ROUNDS: usize = 3;
const SCENE: &str = "[sheet]\nmesh = \"open-star.fold\"\ndomain = \"patch\"\ncells = [32, 32]\n[energy]\n\
    bars = { stiffness = inf }\ncreases = { stiffness = 1.0, rest = { file = \"cylinder.csv\" } }\n\
    [[study]]\nname = \"rolled\"\nkind = \"relax\"\ndraw = []\n";
/// Arc length along which the cell is folded.
const FOLDED: f64 = 0.1;

/// Rolls a patch of 32 x 32 rigid cells up to an exact cylinder by `foldwell run --threads N`. The time is the study's `seconds`,
/// the shortest of three, the error the largest difference of a fold angle of the cell in the middle to the kinematics. The
/// tables must be the same bytes for any number of threads.
pub fn measure(bench: &Bench) -> Result<Findings, ExperimentError> {
    let exact = Star::cylinder(FOLDED)?;
    let mut table = String::from("i,j,n1,n2,angle\n");
    for (edge, angle) in star::cell()?.edges.iter().zip(&exact) {
        let key = edge.key;
        table += &format!("{},{},{},{},{angle:e}\n", key.i, key.j, key.shift[0], key.shift[1]);
    }
    files::write(&bench.folder.join("cylinder.csv"), table)?;
    files::write(&bench.folder.join("open-star.fold"), library::mesh("open-star.fold").unwrap_or_default())?;
    files::write(&bench.folder.join("scene.toml"), SCENE)?;
    let mut settings: Vec<Setting> = Vec::new();
    let mut tables = Vec::new();
    for round in 0..ROUNDS {
        for (k, threads) in THREADS.into_iter().enumerate() {
            bench.step(round * THREADS.len() + k, ROUNDS * THREADS.len())?;
            let (seconds, table) = run(&bench.folder, threads)?;
            if round == 0 {
                let label = format!("{threads} thread{}", if threads > 1 { "s" } else { "" });
                settings.push(Setting { label, error: error(&table, &exact), seconds });
                tables.push(table);
            }
            settings[k].seconds = settings[k].seconds.min(seconds);
        }
    }
    let values = json!({
        "errors": settings.iter().map(|setting| setting.error).collect::<Vec<_>>(),
        "different tables": tables.iter().filter(|table| **table != tables[0]).count(),
        "two over one": settings[1].seconds / settings[0].seconds,
    });
    let row = |s: &Setting| vec![s.label.clone(), figure(s.error), figure(s.seconds)];
    let grid = Grid {
        title: "Number of threads, 32 x 32 rigid cells rolled up to an exact cylinder".into(),
        header: ["", "error (rad)", "seconds"].map(str::to_owned).to_vec(),
        rows: settings.iter().map(row).collect(),
    };
    Ok(Findings { values, tables: vec![grid], ..Findings::default() })
}

/// Seconds of the study, and its table.
fn run(folder: &Path, threads: usize) -> Result<(f64, String), ExperimentError> {
    let words = format!("run scene.toml --out out --quiet --json --threads {threads}");
    let failed = |message: String| ExperimentError::Child { words: words.clone(), message };
    let program = std::env::current_exe().map_err(|error| failed(error.to_string()))?;
    let output = Command::new(program).current_dir(folder).args(words.split(' ')).output();
    let output = output.map_err(|error| failed(error.to_string()))?;
    let summary: Value = serde_json::from_slice(&output.stdout)
        .map_err(|_| failed(String::from_utf8_lossy(&output.stderr).trim().to_owned()))?;
    let path = folder.join("out/rolled.csv");
    let table = std::fs::read_to_string(&path).map_err(|source| OutputError::Read { path, source })?;
    let seconds = summary["studies"][0]["seconds"].as_f64().filter(|_| output.status.success());
    Ok((seconds.ok_or_else(|| failed("the study did not converge".into()))?, table))
}

/// Largest difference of the last row's fold angles, its last columns, to the exact ones.
fn error(table: &str, exact: &[f64]) -> f64 {
    let fields: Vec<&str> = table.lines().last().unwrap_or_default().split(',').collect();
    let angles = fields.iter().rev().zip(exact.iter().rev());
    let off = angles.map(|(field, exact)| field.parse::<f64>().map_or(f64::INFINITY, |angle| (angle - exact).abs()));
    worst(off).unwrap_or(f64::NAN)
}
