//! The standard output of `foldwell run`: a line or a few for every study.

mod counted;
mod sweep;

use foldwell::output::summary::{
    BranchChoiceSummary, BranchesSummary, HalfBranchesSummary, ModesSummary, PathSummary, RelaxSummary,
    ResponseSummary, SeamMotionsSummary, StudyResult, StudySummary, SurfaceSummary, TraceSummary, WellsSummary,
};
use foldwell::run::RunReport;
use std::fmt::Write as _;

use counted::counted;
pub(crate) use sweep::describe_sweep;

/// Returns the descriptions of the studies of a run, one after the other.
pub(crate) fn describe_run(report: &RunReport) -> String {
    let mut text = String::new();
    for study in &report.summary.studies {
        // writing to a string does not fail
        let kept = if report.kept.contains(&study.name) { " (kept)" } else { "" };
        let _ = writeln!(text, "{}{kept}", describe_study(study));
    }
    let _ = writeln!(text, "files in {}", report.out.display());
    text
}

/// Describes energy and residuals, and warns if the state is unstable, if faces pass through each other, or if other
/// branches leave the start.
fn describe_relaxation(relax: &RelaxSummary, converged: bool) -> String {
    let unstable = match relax.negative_eigenvalues {
        None if converged => ", whether it is stable is not known".to_owned(),
        None | Some(0) => String::new(),
        Some(count) => format!(", not stable ({})", counted(count, "negative eigenvalue")),
    };
    let crossing = if relax.self_intersecting == Some(true) { ", faces pass through each other" } else { "" };
    let residuals = match [relax.residual_force, relax.residual_length] {
        [force, length] if force.is_nan() && length.is_nan() => "no residuals".to_owned(),
        [force, length] => format!("residuals {force:.1e} (force) {length:.1e} (length)"),
    };
    let iterations = counted(relax.iterations, "iteration");
    let by_way_of: Vec<&str> =
        relax.routes.iter().skip(1).filter(|route| route.iterations > 0).map(|route| route.name.as_str()).collect();
    let by_way_of = if by_way_of.is_empty() { String::new() } else { format!(", by way of {}", by_way_of.join(", ")) };
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
    let left = relax.branch_choice.map_or(String::new(), |BranchChoiceSummary { hinges, on_rest_side, soft_bars }| {
        let by = if soft_bars { ", by bars that stretch at first" } else { "" };
        format!(", the start was left with {on_rest_side} of {hinges} hinges on the side of their rest angles{by}")
    });
    format!(
        "energy {:.9e}, {iterations}, {residuals}{by_way_of}{unstable}{crossing}{branching}{left}",
        relax.energy.total
    )
}

/// Describes the linear modes. Folding modes are counted separately, by fold angles: they are not a part of the zero
/// modes.
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
        match (modes.folding_modes, &modes.seam) {
            (Some(count), _) => counted(count, "folding mode"),
            (None, Some(SeamMotionsSummary { free, turn, rise, both, .. })) => format!(
                "{} of the closed tube, {turn} if the seam may slip, {rise} if it may open, {free} without conditions",
                counted(*both, "folding mode")
            ),
            (None, None) => "folding modes unknown".into(),
        },
    ) + &describe_frequencies(modes)
}

/// Describes the lowest frequency above zero and the number of motions that grow; empty without mass.
fn describe_frequencies(modes: &ModesSummary) -> String {
    let Some(frequencies) = &modes.frequencies else { return String::new() };
    let lowest = frequencies.iter().flatten().find(|frequency| **frequency > 0.0);
    let lowest =
        lowest.map_or("; no frequency above 0".to_owned(), |lowest| format!("; lowest frequency {lowest:.6e}"));
    match modes.growth_rates.len() {
        0 => lowest,
        count => format!("{lowest}, {} without frequency that grow", counted(count, "motion")),
    }
}

/// Describes the number of rays, and whether these are all directions in which the sheet folds.
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

/// Describes how many random starts ended in no minimum, and how many failed with the reasons; empty if there are none.
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

/// Describes the end of every trajectory, and whether there are directions that no trajectory follows.
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

/// Describes the end of every branch of a path, and its events.
fn describe_path(path: &PathSummary) -> String {
    let value = |value: Option<f64>| value.map_or("inf".to_owned(), |value| format!("{value:.6}"));
    let branches = path.branches.iter().map(|branch| {
        let events = branch.events.iter().map(|event| {
            let eigenvalues = event.multiplicity.filter(|count| *count > 1);
            let eigenvalues = eigenvalues.map_or(String::new(), |count| format!(" of {count} eigenvalues"));
            let place = format!("{}{eigenvalues} at {}", event.event, value(event.drive));
            format!(
                "; {place}, reaction {:.6e}{}",
                event.reaction,
                describe_half_branches(event.half_branches.as_ref())
            )
        });
        let number = if path.branches.len() > 1 { format!("branch {}: ", branch.branch) } else { String::new() };
        let end = format!("{number}{} at {} {}", branch.end, path.drive, value(branch.drive));
        format!("{end}, {}{}", counted(branch.steps, "state"), events.collect::<String>())
    });
    branches.collect::<Vec<_>>().join("; ")
}

/// Describes how many half branches were found; empty where none were sought.
fn describe_half_branches(sought: Option<&HalfBranchesSummary>) -> String {
    match sought {
        None => String::new(),
        Some(HalfBranchesSummary { found, expected: Some(expected), .. }) => {
            format!(", {found} of {expected} half branches")
        }
        Some(HalfBranchesSummary { found, .. }) => format!(", {found} half branches, not all directions sought"),
    }
}

fn describe_surface(surface: &SurfaceSummary) -> String {
    let SurfaceSummary { points, dimension, triangles, coverage, gaps, .. } = surface;
    let shape = if *dimension == 1 { "a curve".to_owned() } else { format!("{triangles} triangles") };
    let established = surface.established.iter().map(|established| format!(": {established}"));
    let gaps = (*gaps > 0).then(|| format!(", but triangles are missing beside {gaps} states"));
    format!("{points} states, {shape}, {coverage}") + &established.chain(gaps).collect::<String>()
}

/// Describes the modes and Poisson's ratios along the first lattice vector.
fn describe_response(response: &ResponseSummary) -> String {
    let poisson = &response.poisson;
    let ratio = |ratio: Option<f64>, reason: &Option<String>| {
        let reason = reason.iter().map(|reason| format!(" [{reason}]")).collect::<String>();
        ratio.map_or_else(|| format!("none{reason}"), |ratio| format!("{ratio:.6}"))
    };
    let opposite = match poisson.opposite {
        Some(true) => ", opposite in every direction",
        Some(false) => ", not opposite in every direction",
        None => "",
    };
    format!(
        "{}, table of rank {}; Poisson's ratio {} in the plane, {} of bending{opposite} ({})",
        counted(response.linear_modes.len(), "linear mode"),
        response.table_rank,
        ratio(poisson.in_plane, &poisson.no_in_plane),
        ratio(poisson.bending, &poisson.no_bending),
        poisson.because
    )
}

fn describe_study(study: &StudySummary) -> String {
    let what = match &study.result {
        Some(StudyResult::Relax(relax)) => describe_relaxation(relax, study.converged),
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
            let lines = bloch.zero_lines.map(|count| counted(count, "zero line"));
            let lines = lines
                .or_else(|| bloch.no_determinant.clone())
                .or_else(|| bloch.no_zero_lines.clone())
                .unwrap_or_else(|| "no real determinant, so that zero lines are not looked for".to_owned());
            let pairing = bloch.pairing_error.map_or("no root known well enough to be paired".to_owned(), |error| {
                format!("pairing error {error:.1e}")
            });
            let decays = bloch.polarization.map(|[p1, p2]| format!(", {pairing}, polarization ({p1}, {p2})"));
            lines + &decays.unwrap_or_default()
        }
        Some(StudyResult::Wells(found)) => {
            let energies = found.wells.iter().map(|well| format!("{:.6e}", well.energy)).collect::<Vec<_>>().join(", ");
            let barriers = found.barriers.iter().map(|barrier| {
                let bars = barrier.bars.map_or("rigid bars".to_owned(), |bars| format!("bars of {bars:e}"));
                let known = match (barrier.singular, barrier.flat, barrier.limit_error) {
                    (true, true, _) => ", the flat state".to_owned(),
                    (true, false, Some(error)) => format!(", extrapolated with an error of about {error:.0e}"),
                    _ => String::new(),
                };
                let energy =
                    barrier.energy.map_or("not found".to_owned(), |energy| format!("{energy:.6e} with {bars}{known}"));
                format!("; pass {:?} {energy}", barrier.between)
            });
            let count = counted(found.wells.len(), "well");
            format!("{count} ({energies}){}{}", barriers.collect::<String>(), describe_failures(found))
        }
        Some(StudyResult::Path(path)) => describe_path(path),
        Some(StudyResult::Response(response)) => describe_response(response),
        None => String::from("no result"),
    };
    let failed = study.reason.as_ref().map(|reason| format!("\n  not converged: {reason}")).unwrap_or_default();
    format!("{} ({}): {what}, {:.2} s{failed}", study.name, study.kind, study.seconds)
}
