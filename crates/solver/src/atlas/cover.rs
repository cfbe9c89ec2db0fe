//! The charts of a surface, placed one after the other.

use super::grid::PointIndex;
use super::polygon::Polygon;
use super::seen::{MOST_DISTANCE_PER_RADII, Neighbour, see, separate, turn};
use super::surface::{AtlasError, Chart, CoverOptions, Coverage, KEPT, Surface};
use super::walk;
use crate::continuation::CurvePoint;
use crate::implicit::{CorrectedPoint, Corrector};
use foldwell_numerics::dense::null_space;
use foldwell_numerics::vector::{add_scaled, norm};
use foldwell_numerics::{DenseMatrix, GoOn};
use std::collections::{HashSet, VecDeque};

/// Smallest radius of a chart relative to the largest.
const LEAST_RADIUS_RATIO: f64 = 0.01;
/// Factor of the radius after a refusal, and the largest factor from a chart to the next.
const RADIUS_AFTER_REFUSAL: f64 = 0.7;
const MOST_RADIUS_GROWTH: f64 = 1.2;
/// Part of the largest turn of the tangent plane that radii aim at.
const WANTED_TURN_PART: f64 = 0.7;
/// Distance from a chart at which the turning of its tangent plane is measured, relative to its radius.
const PROBE_PER_RADIUS: f64 = 0.1;
/// Number of charts in a row beyond the limit that are followed further: those next to the inner ones.
const CHARTS_BEYOND_LIMIT: usize = 1;
/// Number of charts from one question of the observer to the next.
pub(super) const CHARTS_PER_QUESTION: usize = 256;
/// Distance from an open chart below which no further one is placed, relative to the radius of the chart from which it
/// would be.
const SAME_PLACE_PER_RADIUS: f64 = 0.2;
/// Number of times that a chart of a surface that crosses another is surrounded again, as when those around it are made
/// smaller, before it counts as one that cannot be.
const MOST_VISITS: usize = 20;
/// Number of charts at which the surface cannot be followed beyond which it is given up: smallest charts would be
/// placed for long along singular curves, and the covering stays open all the same.
const MOST_OPEN_CHARTS: usize = 512;
/// The same of a surface that crosses another, along sharp edges of which they lie.
const MOST_OPEN_BESIDE_CROSSINGS: usize = 1024;

/// Number of charts placed around one beyond which it counts as one that cannot be surrounded: around a regular one
/// there are a dozen, and as many again for every time that it is made smaller. Where the surface is singular new ones
/// would be placed without end.
const MOST_NEIGHBOURS: usize = 256;

pub(super) struct Cover<'a, S: Surface> {
    pub surface: &'a mut S,
    options: CoverOptions,
    corrector: Corrector,
    periods: Vec<Option<f64>>,
    pub charts: Vec<Chart>,
    /// Number of charts beyond the limit between each chart and the inner ones, itself included.
    beyond: Vec<usize>,
    grid: PointIndex,
    /// Charts that may be open.
    waiting: VecDeque<usize>,
    queued: Vec<bool>,
    /// Number of times that each chart was surrounded.
    visits: Vec<usize>,
    /// Charts at which the surface cannot be followed.
    open: HashSet<usize>,
    polygon: Polygon,
    pub oriented: bool,
    way: Vec<f64>,
}

/// A point before its chart.
struct Seed {
    residual: f64,
    start: usize,
    /// How much the tangent plane turns per distance, where that is known.
    bend: Option<f64>,
}

impl<'a, S: Surface> Cover<'a, S> {
    pub fn new(surface: &'a mut S, options: CoverOptions) -> Self {
        let periods: Vec<Option<f64>> = (0..surface.unknowns()).map(|unknown| surface.period(unknown)).collect();
        Self {
            corrector: Corrector::new(surface),
            grid: PointIndex::new(2.0 * MOST_DISTANCE_PER_RADII * options.radius, periods.clone()),
            way: vec![0.0; periods.len()],
            periods,
            charts: vec![],
            beyond: vec![],
            waiting: VecDeque::new(),
            queued: vec![],
            visits: vec![],
            open: HashSet::new(),
            polygon: Polygon::new(),
            oriented: true,
            surface,
            options,
        }
    }

    /// Places the chart of a start, unless it lies in one; returns the number of the start from which that one was
    /// reached.
    pub fn start(&mut self, number: usize, start: &[f64]) -> Result<usize, AtlasError> {
        let mut residual = vec![0.0; self.surface.equations()];
        let mut jacobian = DenseMatrix::zeros(residual.len(), start.len());
        self.surface.linearize(start, &mut residual, &mut jacobian);
        let tangents = null_space(&jacobian)?.basis;
        if tangents.ncols() != 2 {
            return Err(AtlasError::Singular { start: number, tangents: tangents.ncols() });
        }
        let (mut x, mut frame) = (start.to_vec(), tangents.as_slice().to_vec());
        let chart = self.correct(&mut x, &mut frame, 1e-3 * self.options.radius).and_then(|found| {
            let bend = self.surface.crosses().then_some(0.0);
            let place = Seed { residual: found.residual, start: number, bend };
            self.chart(x, frame, self.options.radius, place)
        });
        let chart = chart.ok_or(AtlasError::Start { start: number })?;
        if let Some(other) = self.covering(&chart) {
            return Ok(self.charts[other].start);
        }
        self.insert(chart, 0);
        Ok(number)
    }

    /// Places charts until none is open.
    pub fn run(&mut self, observe: GoOn<'_>) -> Coverage {
        let (mut seen, mut taken) = (0, 0);
        while let Some(number) = self.waiting.pop_front() {
            self.queued[number] = false;
            taken += 1;
            if taken % CHARTS_PER_QUESTION == 0 || self.charts.len() >= seen + CHARTS_PER_QUESTION {
                seen = self.charts.len();
                if !observe(seen) {
                    return Coverage::Interrupted;
                }
            }
            if self.charts.len() >= self.options.max_charts {
                return Coverage::TooManyCharts;
            }
            if self.beyond[number] <= CHARTS_BEYOND_LIMIT && !self.open.contains(&number) && !self.surround(number) {
                self.open.insert(number);
                let most = if self.surface.crosses() { MOST_OPEN_BESIDE_CROSSINGS } else { MOST_OPEN_CHARTS };
                if self.open.len() >= most {
                    return Coverage::GivenUp { charts: self.open.len() };
                }
            }
        }
        if self.open.is_empty() { Coverage::Complete } else { Coverage::Open { charts: self.open.len() } }
    }

    /// Places neighbours of a chart until its disc is covered; false where that does not succeed with the smallest
    /// radius.
    fn surround(&mut self, number: usize) -> bool {
        self.visits[number] += 1;
        if self.surface.crosses() && self.visits[number] > MOST_VISITS {
            return false;
        }
        self.shape(number);
        let mut placed = 0;
        while let Some(at) = self.polygon.uncovered() {
            match self.place(number, at) {
                Some(_) if placed == MOST_NEIGHBOURS => return false,
                Some(chart) if self.surface.crosses() && self.tried(number, &chart) => {
                    self.polygon.clip(at, self.charts[number].radius, number);
                }
                Some(chart) => {
                    placed += 1;
                    let beyond = if chart.limit > 0.0 { self.beyond[number] + 1 } else { 0 };
                    let added = self.insert(chart, beyond);
                    let at_rim = Neighbour { at, radius: self.charts[number].radius };
                    let Neighbour { at, radius } = self.neighbour(number, added).unwrap_or(at_rim);
                    self.polygon.clip(at, radius, added);
                }
                None => {
                    if self.charts[number].radius * RADIUS_AFTER_REFUSAL < LEAST_RADIUS_RATIO * self.options.radius {
                        return false;
                    }
                    self.shrink(number);
                }
            }
        }
        true
    }

    /// Whether a chart would lie so near to an open one that it would end as that did.
    fn tried(&mut self, from: usize, chart: &Chart) -> bool {
        let apart = SAME_PLACE_PER_RADIUS * self.charts[from].radius;
        let near = self.grid.near(&chart.x, apart);
        near.iter().any(|other| self.open.contains(other) && self.apart(&self.charts[*other].x, &chart.x) <= apart)
    }

    /// Brings a point onto the surface, no further than `reach`, and its frame into the tangents there.
    fn correct(&mut self, x: &mut [f64], frame: &mut [f64], reach: f64) -> Option<CorrectedPoint> {
        let found = self.corrector.correct(self.surface, x, frame, self.options.tolerance)?;
        (found.distance <= reach).then_some(found)
    }

    /// A chart from a place on the rim of another.
    fn place(&mut self, number: usize, at: [f64; 2]) -> Option<Chart> {
        if self.surface.crosses() {
            return self.walk(number, at);
        }
        let from = &self.charts[number];
        let (n, radius, start) = (from.x.len(), from.radius, from.start);
        let (mut x, mut frame) = (from.x.clone(), from.frame.clone());
        add_scaled(&mut x, at[0], &from.frame[..n]);
        add_scaled(&mut x, at[1], &from.frame[n..]);
        let found = self.correct(&mut x, &mut frame, self.options.max_turn * radius)?;
        if !(turn(&self.charts[number].frame, &frame) <= self.options.max_turn) {
            return None;
        }
        self.chart(x, frame, MOST_RADIUS_GROWTH * radius, Seed { residual: found.residual, start, bend: None })
    }

    /// The same where the surface crosses another.
    fn walk(&mut self, number: usize, at: [f64; 2]) -> Option<Chart> {
        let (from, tolerance) = (&self.charts[number], self.options.tolerance);
        let (radius, start) = (from.radius, from.start);
        let (CurvePoint { x, residual, .. }, frame) =
            walk::to_rim(self.surface, (from, at), &mut self.corrector, tolerance)?;
        separate(&from.x, &x, &self.periods, &mut self.way);
        let (first, second) = from.frame.split_at(x.len());
        add_scaled(&mut self.way, -at[0], first);
        add_scaled(&mut self.way, -at[1], second);
        let missed = norm(&self.way);
        if !(missed <= self.options.max_turn * radius) {
            return None;
        }
        let turned = turn(&from.frame, &frame);
        let bend = Some(turned / at[0].hypot(at[1]));
        let gentle = turned <= self.options.max_turn;
        gentle.then(|| self.chart(x, frame, MOST_RADIUS_GROWTH * radius, Seed { residual, start, bend }))?
    }

    /// A chart at a point of the surface, its radius at most `largest` and such that the tangent plane turns gently
    /// over it.
    ///
    /// `None` where that is less than the smallest radius. The turning is measured at two points beside, in the tangent
    /// plane, so that it is seen in all directions: towards the tip of a cone nothing turns, across it all does. Of a
    /// surface that crosses another it is that on the way to the point.
    fn chart(&mut self, x: Vec<f64>, frame: Vec<f64>, largest: f64, place: Seed) -> Option<Chart> {
        let bend = match place.bend {
            Some(bend) => bend,
            None => self.bend(&x, &frame, PROBE_PER_RADIUS * largest)?,
        };
        let gentle = WANTED_TURN_PART * self.options.max_turn / bend;
        if !(gentle >= LEAST_RADIUS_RATIO * self.options.radius) {
            return None;
        }
        let (limit, radius) = (self.surface.limit(&x), gentle.min(largest).min(self.options.radius));
        Some(Chart { x, frame, radius, limit, residual: place.residual, start: place.start })
    }

    /// How much the tangent plane turns per distance, measured at two points this far aside.
    fn bend(&mut self, x: &[f64], frame: &[f64], aside: f64) -> Option<f64> {
        let mut square = 0.0;
        for tangent in frame.chunks_exact(x.len()) {
            self.way.copy_from_slice(x);
            add_scaled(&mut self.way, aside, tangent);
            let mut turned = frame.to_vec();
            self.corrector.turn(self.surface, &self.way, &mut turned)?;
            square += (turn(frame, &turned) / aside).powi(2);
        }
        Some(square.sqrt())
    }

    fn insert(&mut self, chart: Chart, beyond: usize) -> usize {
        let number = self.charts.len();
        self.grid.insert(&chart.x, number);
        self.charts.push(chart);
        self.beyond.push(beyond);
        self.queued.push(false);
        self.visits.push(0);
        self.enqueue(number);
        number
    }

    fn enqueue(&mut self, number: usize) {
        self.queued[number] = true;
        self.waiting.push_back(number);
    }

    /// Makes a chart smaller, and looks again at those that counted on it.
    fn shrink(&mut self, number: usize) {
        for other in self.find_near(number) {
            if !self.queued[other] && self.neighbour(number, other).is_some() {
                self.enqueue(other);
            }
        }
        self.charts[number].radius *= RADIUS_AFTER_REFUSAL;
        self.shape(number);
    }

    /// Cuts the polygon of a chart.
    fn shape(&mut self, number: usize) {
        self.polygon.reset(self.charts[number].radius);
        for other in self.find_near(number).into_iter().filter(|other| *other != number) {
            if let Some(Neighbour { at, radius }) = self.neighbour(number, other) {
                self.polygon.clip(at, radius, other);
            }
        }
    }

    fn find_near(&mut self, number: usize) -> Vec<usize> {
        let chart = &self.charts[number];
        self.grid.near(&chart.x, MOST_DISTANCE_PER_RADII * (chart.radius + self.options.radius))
    }

    /// A chart seen from another, if they are neighbours on the surface; notes where their frames differ in sense.
    fn neighbour(&mut self, from: usize, to: usize) -> Option<Neighbour> {
        let [a, b] = [&self.charts[from], &self.charts[to]];
        let (found, sense) = see(a, b, &self.periods, &mut self.way)?;
        self.oriented &= sense > 0.0;
        Some(found)
    }

    /// The chart in which the centre of another lies.
    fn covering(&mut self, chart: &Chart) -> Option<usize> {
        let near = self.grid.near(&chart.x, MOST_DISTANCE_PER_RADII * (chart.radius + self.options.radius));
        let covers = |other: &usize, way: &mut [f64]| {
            let other = &self.charts[*other];
            see(other, chart, &self.periods, way)
                .is_some_and(|(found, _)| found.at[0].hypot(found.at[1]) < other.radius)
        };
        near.into_iter().find(|other| covers(other, &mut self.way))
    }

    /// The neighbours around a chart, counter-clockwise; `None` where it is open.
    pub fn ring(&mut self, number: usize) -> Vec<Option<usize>> {
        self.shape(number);
        self.polygon.ring()
    }

    /// The rings of all charts, or of the first ones of an interrupted covering.
    pub fn rings(&mut self, coverage: &mut Coverage, observe: GoOn<'_>) -> Vec<Vec<Option<usize>>> {
        let mut rings = Vec::new();
        for number in 0..self.charts.len() {
            let stopped = *coverage == Coverage::Interrupted;
            if stopped && number >= KEPT {
                break;
            }
            if !stopped && number % CHARTS_PER_QUESTION == 0 && !observe(self.charts.len()) {
                *coverage = Coverage::Interrupted;
            }
            rings.push(self.ring(number));
        }
        if *coverage == Coverage::Interrupted {
            rings.truncate(KEPT);
            let kept = rings.len();
            let beyond = |neighbour: &Option<usize>| neighbour.is_some_and(|number| number >= kept);
            rings.iter_mut().flatten().filter(|neighbour| beyond(neighbour)).for_each(|neighbour| *neighbour = None);
        }
        rings
    }

    /// Distance of two charts, modulo periods.
    pub fn distance(&self, a: usize, b: usize) -> f64 {
        self.apart(&self.charts[a].x, &self.charts[b].x)
    }

    /// Distance of two points, modulo periods.
    pub fn apart(&self, a: &[f64], b: &[f64]) -> f64 {
        let mut way = vec![0.0; self.periods.len()];
        separate(a, b, &self.periods, &mut way);
        norm(&way)
    }

    /// The chart of the point that lies `part` of the straight way from one chart to another, brought onto the surface.
    pub fn between(&mut self, a: usize, b: usize, part: f64) -> Option<Chart> {
        separate(&self.charts[a].x, &self.charts[b].x, &self.periods, &mut self.way);
        let mut chart = self.charts[a].clone();
        add_scaled(&mut chart.x, part, &self.way);
        chart.residual = self.correct(&mut chart.x, &mut chart.frame, self.charts[a].radius)?.residual;
        chart.limit = self.surface.limit(&chart.x);
        Some(chart)
    }
}
