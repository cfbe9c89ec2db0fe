//! A hundred thousand cells: triangulated Miura-ori opened along its folding mode, against the closed form.

use super::super::experiment::{Bench, ExperimentError, Findings, Grid};
use super::super::report::figure;
use super::super::star::size;
use super::large::memory;
use super::miura::{first_zigzag, fold_angles};
use super::trial::distance;
use crate::analysis::relax::{Relaxed, relax};
use crate::model::Gauge;
use crate::model::Model;
use crate::model::assemble::{Drawn, Hinges, Recipe, Surroundings, assemble, drawn_angles};
use crate::sheet::generate::Miura;
use crate::sheet::{EdgeKind, Pattern, Sheet, generate, tile};
use crate::solver::Options;
use serde_json::json;
use std::time::Instant;

/// The last has 100,172 cells.
const CELLS: [[usize; 2]; 4] = [[10, 10], [32, 32], [100, 100], [316, 317]];
/// How much further than drawn the zigzags rest, in radians.
const FURTHER: f64 = 0.1;
const TOLERANCE: f64 = 1e-10;

/// A patch of Miura-ori with hinges at all edges, diagonals of quadrilaterals included.
struct Patch {
    model: Model,
    /// Rest angle of every edge, in radians: those of the closed form, and 0 of diagonals; NaN where there is no hinge.
    rest: Vec<f64>,
}

/// A patch that was relaxed.
struct Size {
    cells: [usize; 2],
    unknowns: usize,
    found: Relaxed,
    /// Largest difference of a fold angle to the closed form, in radians.
    error: f64,
    seconds: f64,
    memory: f64,
}

/// Relaxes patches whose bars are rigid and whose hinges rest where the closed form has them, further folded than drawn: they
/// have to end there, without any energy.
pub fn measure(bench: &Bench) -> Result<Findings, ExperimentError> {
    let mut sizes = Vec::new();
    for (step, cells) in CELLS.into_iter().enumerate() {
        bench.step(step, CELLS.len())?;
        sizes.push(relaxed(cells)?);
    }
    let last = &sizes[sizes.len() - 1];
    let values = json!({
        "cells": last.cells[0] * last.cells[1],
        "errors": sizes.iter().map(|size| size.error).collect::<Vec<_>>(),
        "residuals": sizes.iter().map(residual).collect::<Vec<_>>(),
        "iterations": sizes.iter().map(|size| size.found.iterations).collect::<Vec<_>>(),
        "seconds": last.seconds,
        "memory": last.memory,
    });
    Ok(Findings { values, tables: vec![table(&sizes)], ..Findings::default() })
}

fn relaxed(cells: [usize; 2]) -> Result<Size, ExperimentError> {
    let mut patch = Patch::new(cells)?;
    let (start, clock) = (patch.model.start(), Instant::now());
    let options = Options { tolerance: TOLERANCE, ..Options::default() };
    let found = relax(&mut patch.model, start, options, patch.rest.len(), &mut |_| true)?;
    let seconds = clock.elapsed().as_secs_f64();
    let error = distance(&found.state.fold_angle, &patch.rest);
    Ok(Size { cells, unknowns: size(&patch.model).0, found, error, seconds, memory: memory().unwrap_or(f64::NAN) })
}

fn residual(size: &Size) -> f64 {
    size.found.residual_force.max(size.found.residual_length)
}

impl Patch {
    fn new(cells: [usize; 2]) -> Result<Self, ExperimentError> {
        let pattern = Miura::default();
        let sheet = generate(&Pattern::Miura(pattern.clone()))
            .map_err(|_| ExperimentError::Other("Miura-ori cannot be generated".into()))?;
        let wanted = further(&sheet, pattern.sector)?;
        let tiling = tile(&sheet, cells, false);
        let drawn = Drawn::new(&sheet, &tiling, Surroundings::Patch);
        let hinged = drawn_angles(&drawn, &tiling);
        let rest: Vec<f64> = hinged
            .iter()
            .zip(&tiling.edges)
            .map(|(angle, edge)| if angle.is_nan() { *angle } else { wanted[edge.edge] })
            .collect();
        let hinges = || Some(Hinges { stiffness: 1.0, rest: rest.clone() });
        let recipe = Recipe { bars: Some(f64::INFINITY), creases: hinges(), facets: hinges(), ..Recipe::default() };
        Ok(Self { model: assemble(&drawn, &tiling, &recipe, Gauge::Held), rest })
    }
}

/// Angles of the edges of a cell that is folded further than drawn, its faces flat.
fn further(sheet: &Sheet, sector: f64) -> Result<Vec<f64>, ExperimentError> {
    let drawn = first_zigzag(sheet).and_then(|edge| sheet.drawn_angle(&sheet.edges[edge]));
    let drawn = drawn.ok_or(ExperimentError::Other("Miura-ori has no zigzag".into()))?;
    let mut angles = fold_angles(sheet, sector, drawn.abs() + FURTHER);
    let diagonals = sheet.edges.iter().zip(&mut angles).filter(|(edge, _)| edge.kind == EdgeKind::Facet);
    diagonals.for_each(|(_, angle)| *angle = 0.0);
    Ok(angles)
}

fn table(sizes: &[Size]) -> Grid {
    let row = |s: &Size| {
        let counts = [s.unknowns, s.found.iterations, s.found.factorizations].map(|count| count.to_string());
        let numbers = [residual(s), s.error, s.seconds, s.memory].map(figure);
        [format!("{} x {}", s.cells[0], s.cells[1])].into_iter().chain(counts).chain(numbers).collect()
    };
    let names = [
        "cells",
        "unknowns",
        "iterations",
        "factorizations",
        "residual",
        "off the closed form (rad)",
        "seconds",
        "most memory so far (MB)",
    ];
    Grid {
        title: "Triangulated Miura-ori with rigid bars, folded further by 0.1 rad".into(),
        header: names.map(str::to_owned).to_vec(),
        rows: sizes.iter().map(row).collect(),
    }
}
