//! The figure of a path: the reaction as a function of the driven value, with stable and unstable pieces told apart.

use super::axes::{Axis, Scale, rounded};
use super::canvas::{Canvas, Caption, MARGIN, Mark, WIDTH};
use super::chart::{beside, grid};
use super::palette::{Colour, GREY, INK, MOUNTAIN, PAPER, SERIES};
use super::style::{Area, PaperPoint, Style};

const HEIGHT: f64 = 720.0;
/// Frame of the chart: left, upper, right and lower side.
const FRAME: [f64; 4] = [MARGIN + 104.0, 150.0, WIDTH - 40.0, HEIGHT - 84.0];
/// Base line of the legend.
const LEGEND: f64 = 108.0;
const CURVE: f64 = 2.6;
const RADIUS: f64 = 6.0;
/// Largest number of events with their values beside them.
const LABELS: usize = 12;

/// Reactions along the branches of a path.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReactionPlot {
    /// Quantity and unit along the horizontal axis, the driven one.
    pub drive: String,
    /// Quantity and unit along the vertical axis.
    pub reaction: String,
    /// Whether the horizontal axis is logarithmic.
    pub logarithmic: bool,
    /// The branches.
    pub branches: Vec<Vec<PlottedState>>,
}

/// A state of a path in the plot.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PlottedState {
    /// Driven value; states without a position on the axis are left out.
    pub drive: f64,
    /// Reaction.
    pub reaction: f64,
    /// Whether the state is stable while the driven value is held.
    pub stable: bool,
    /// The word for what is special about the state.
    pub event: Option<&'static str>,
}

/// Returns the figure.
pub(crate) fn svg(plot: &ReactionPlot, caption: &Caption) -> Canvas {
    let mut canvas = Canvas::new(HEIGHT, caption);
    let [left, top, right, bottom] = FRAME;
    let frame = Area { low: [left, top], high: [right, bottom] };
    let scale = if plot.logarithmic { Scale::Logarithmic } else { Scale::Linear };
    let probe = Axis::around(scale, std::iter::empty(), 0.0);
    let has = |state: &&PlottedState| probe.has(state.drive) && state.reaction.is_finite();
    let shown = || plot.branches.iter().flatten().filter(has);
    let axes = [
        Axis::around(scale, shown().map(|state| state.drive), 0.0),
        Axis::around(Scale::Linear, shown().map(|state| state.reaction), 0.0),
    ];
    let place = |state: &PlottedState| -> PaperPoint {
        let [x, y] = [axes[0].part(state.drive), axes[1].part(state.reaction)];
        [left + x * (right - left), bottom - y * (bottom - top)]
    };
    legend(&mut canvas, plot);
    grid(&mut canvas, frame, &axes, [&plot.drive, &plot.reaction]);
    let zero = bottom - axes[1].part(0.0) * (bottom - top);
    if (top..=bottom).contains(&zero) {
        canvas.line(&[[left, zero], [right, zero]], Style::line(GREY, 1.2));
    }
    for (number, branch) in plot.branches.iter().enumerate() {
        let states: Vec<PlottedState> = branch.iter().filter(has).copied().collect();
        for (piece, stable) in pieces(&states) {
            let places: Vec<PaperPoint> = piece.iter().map(place).collect();
            canvas.line(&places, curve(number, stable));
            places.windows(2).for_each(|ends| canvas.take_line(ends[0], ends[1], 3.0));
        }
    }
    events(&mut canvas, plot, frame, &|state| has(&state).then(|| place(state)));
    canvas
}

/// Returns the pieces of a branch whose states are all stable, or all not; neighbours have their common state, but where
/// the sheet snaps from one to the other.
///
/// The state of an event is singular, so that its own inertia is a matter of rounding: what lies between an event and
/// another state is as stable as the other.
fn pieces(states: &[PlottedState]) -> Vec<(&[PlottedState], bool)> {
    states.chunk_by(|_, next| next.event != Some("snap")).flat_map(pieces_between_snaps).collect()
}

fn pieces_between_snaps(states: &[PlottedState]) -> Vec<(&[PlottedState], bool)> {
    let stable = |k: usize| {
        let ends = [states[k], states[k + 1]];
        let mut regular = ends.iter().filter(|state| state.event.is_none());
        if ends.iter().all(|state| state.event.is_some()) {
            ends.iter().all(|state| state.stable)
        } else {
            regular.all(|state| state.stable)
        }
    };
    let segments: Vec<usize> = (0..states.len().saturating_sub(1)).collect();
    let runs = segments.chunk_by(|a, b| stable(*a) == stable(*b));
    runs.map(|run| (&states[run[0]..run[run.len() - 1] + 2], stable(run[0]))).collect()
}

fn curve(branch: usize, stable: bool) -> Style {
    let style = Style::line(SERIES[branch % SERIES.len()], CURVE);
    if stable { style } else { style.dashed(9.0, 6.0) }
}

/// Returns the style of the mark of an event.
fn mark(event: &str) -> Style {
    const BRANCHES: Colour = Colour(217, 138, 31);
    match event {
        "limit-load" => Style::area(INK).outlined(PAPER, 1.0),
        "limit-displacement" => Style::area(PAPER).outlined(INK, 2.2),
        "branch-point" => Style::area(BRANCHES).outlined(INK, 1.4),
        "self-intersection" => Style::area(PAPER).outlined(MOUNTAIN, 2.4),
        "snap" => Style::area(MOUNTAIN).outlined(PAPER, 1.0),
        _ => Style::area(GREY).outlined(PAPER, 1.0),
    }
}

/// Draws the marks of events, and their values where there is room.
fn events(canvas: &mut Canvas, plot: &ReactionPlot, frame: Area, place: &dyn Fn(&PlottedState) -> Option<PaperPoint>) {
    let all = plot.branches.iter().flatten().filter_map(|state| Some((state, state.event?, place(state)?)));
    let all: Vec<_> = all.collect();
    for (state, event, at) in &all {
        canvas.told(&format!("{event}: {} at {}", rounded(state.reaction, 6), rounded(state.drive, 6)));
        canvas.circle(*at, RADIUS, mark(event));
        canvas.end();
        canvas.take(Area::around(*at, RADIUS));
    }
    for (state, _, at) in all.iter().take(LABELS) {
        beside(canvas, frame, *at, &format!("{} at {}", rounded(state.reaction, 4), rounded(state.drive, 4)), INK);
    }
}

/// Draws the legend: what lines and marks mean, as far as they occur, and the colours of several branches.
fn legend(canvas: &mut Canvas, plot: &ReactionPlot) {
    let all = || plot.branches.iter().flatten();
    let mut entries = Vec::new();
    for (stable, words) in [(true, "stable"), (false, "not stable")] {
        if all().any(|state| state.event.is_none() && state.stable == stable) {
            let line = Style::line(INK, CURVE);
            entries.push((Mark::Line(if stable { line } else { line.dashed(9.0, 6.0) }), words.to_owned()));
        }
    }
    if plot.branches.len() > 1 {
        let named = plot.branches.iter().enumerate().take(SERIES.len());
        entries.extend(named.map(|(number, _)| (Mark::Line(curve(number, true)), format!("branch {number}"))));
    }
    for event in ["limit-load", "limit-displacement", "branch-point", "self-intersection", "snap", "stop"] {
        if all().any(|state| state.event == Some(event)) {
            entries.push((Mark::Circle(RADIUS, mark(event)), event.replace('-', " ")));
        }
    }
    canvas.legend([MARGIN, LEGEND], &entries);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state(drive: f64, reaction: f64, stable: bool, event: Option<&'static str>) -> PlottedState {
        PlottedState { drive, reaction, stable, event }
    }

    /// A rise to a limit load, a fall that is not stable to a second one, and a rise again.
    fn snap() -> Vec<PlottedState> {
        vec![
            state(0.0, 0.0, true, None),
            state(0.1, 0.8, true, None),
            state(0.13, 1.0, false, Some("limit-load")),
            state(0.3, 0.0, false, None),
            state(0.47, -1.0, true, Some("limit-load")),
            state(0.6, 0.0, true, None),
        ]
    }

    fn plot(branches: Vec<Vec<PlottedState>>) -> ReactionPlot {
        ReactionPlot { drive: "displacement".into(), reaction: "force".into(), logarithmic: false, branches }
    }

    /// Claim: pieces change at events, whose own inertia does not matter, and share their states; none goes over a snap.
    /// Source: by hand.
    #[test]
    fn pieces_change_at_events() {
        let states = snap();
        let found: Vec<_> = pieces(&states).into_iter().map(|(piece, stable)| (piece.len(), stable)).collect();
        assert_eq!(found, [(3, true), (3, false), (2, true)]);
        assert!(pieces(&states[..1]).is_empty() && pieces(&[]).is_empty());
        let behind = [state(0.14, -0.5, true, Some("snap")), state(0.2, -0.3, true, None)];
        let snapping = [&states[..3], &behind].concat();
        let lengths: Vec<usize> = pieces(&snapping).iter().map(|(piece, _)| piece.len()).collect();
        assert_eq!(lengths, [3, 2]);
    }

    /// Claim: what is not stable is dashed, every event has its mark and is in the legend once, and text overlaps
    /// nothing.
    #[test]
    fn lines_and_marks() {
        let caption = Caption { title: "t".into(), state: "s".into() };
        let other = vec![state(0.3, 0.0, true, Some("branch-point")), state(0.5, 0.5, true, None)];
        let canvas = svg(&plot(vec![snap(), other]), &caption);
        assert_eq!(canvas.crowded(), 0);
        let text = canvas.finish();
        assert_eq!(text.matches("<g><title>limit-load").count(), 2);
        assert_eq!(text.matches(">limit load</text>").count(), 1);
        assert_eq!([text.matches(">branch 0<").count(), text.matches(">branch 1<").count()], [1, 1]);
        // one piece of the curve and the sample of the legend
        assert_eq!(text.matches("stroke-dasharray=\"9 6\"").count(), 2);
        assert!(text.contains(">\u{2212}1 at 0.47<"), "{text}");
    }

    /// Claim: infinite stiffness has no place on a logarithmic axis and is left out, equal ratios have equal distances,
    /// and a path without states can be drawn.
    #[test]
    fn stiffness_is_logarithmic() {
        let rising = [1.0, 1e3, 1e6, f64::INFINITY].map(|k| state(k, 1.0 / k, true, Some("stop")));
        let text =
            svg(&ReactionPlot { logarithmic: true, ..plot(vec![rising.to_vec()]) }, &Caption::default()).finish();
        let marks = text.split("<g><title>stop").skip(1);
        let x: Vec<f64> =
            marks.map(|mark| mark.split("cx=\"").nth(1).unwrap().split('"').next().unwrap().parse().unwrap()).collect();
        assert!(x.len() == 3 && (x[1] - x[0] - (x[2] - x[1])).abs() <= 0.21, "{x:?}");
        for empty in [vec![], vec![vec![]]] {
            let text = svg(&plot(empty), &Caption::default()).finish();
            assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
        }
    }
}
