//! The border of a surface at its limit: triangles cut where the limit is zero.

use super::cover::{CHARTS_PER_QUESTION, Cover};
use super::surface::{Chart, Coverage, Surface};
use foldwell_numerics::GoOn;
use std::collections::HashMap;

/// Part of an edge below which a chart at its end is moved onto the border, so that no thin triangle is left.
const SNAPPED_PART: f64 = 0.25;
/// Largest number of evaluations for a point of the border, and its accuracy relative to the edge.
const MOST_EVALUATIONS: usize = 40;
const ACCURACY_PER_EDGE: f64 = 1e-13;

/// Charts within the limit and on it, and their triangles.
pub(super) fn at_limit<S: Surface>(
    cover: &mut Cover<S>,
    triangles: Vec<[usize; 3]>,
    coverage: &mut Coverage,
    observe: GoOn<'_>,
) -> (Vec<Chart>, Vec<[usize; 3]>) {
    let mut border = Border { points: HashMap::new(), snapped: HashMap::new() };
    let charts = cover.charts.len();
    if !border.find(cover, &triangles, &mut || *coverage == Coverage::Interrupted || observe(charts)) {
        *coverage = Coverage::Interrupted;
    }
    let mut pieces = Vec::new();
    for triangle in triangles {
        border.cut(cover, triangle, &mut pieces);
    }
    border.gather(cover, pieces)
}

/// A corner of a cut triangle: a chart, or the border's point on the edge from an inner chart to an outer one.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum CutCorner {
    Chart(usize),
    Edge(usize, usize),
}

struct Border {
    points: HashMap<(usize, usize), Chart>,
    /// Charts that are moved onto the border, and to where.
    snapped: HashMap<usize, Chart>,
}

impl Border {
    /// Finds the border on every edge that crosses it, and moves charts close to it; false where that was stopped.
    fn find<S: Surface>(
        &mut self,
        cover: &mut Cover<S>,
        triangles: &[[usize; 3]],
        go_on: &mut dyn FnMut() -> bool,
    ) -> bool {
        let mut nearest: HashMap<usize, (f64, (usize, usize))> = HashMap::new();
        let (mut whole, mut asked) = (true, 0);
        for [a, b, c] in triangles {
            if self.points.len() >= asked + CHARTS_PER_QUESTION / 8 {
                asked = self.points.len();
                if !go_on() {
                    whole = false;
                    break;
                }
            }
            for (from, to) in [(*a, *b), (*b, *c), (*c, *a), (*b, *a), (*c, *b), (*a, *c)] {
                let crosses = inside(cover, from) && !inside(cover, to);
                if !crosses || self.points.contains_key(&(from, to)) {
                    continue;
                }
                if let Some((part, point)) = crossing(cover, from, to) {
                    self.points.insert((from, to), point);
                    for (chart, part) in [(from, part), (to, 1.0 - part)] {
                        let best = nearest.entry(chart).or_insert((part, (from, to)));
                        if part < best.0 {
                            *best = (part, (from, to));
                        }
                    }
                }
            }
        }
        for (chart, (part, edge)) in nearest {
            if part < SNAPPED_PART {
                self.snapped.extend(self.points.get(&edge).map(|point| (chart, point.clone())));
            }
        }
        whole
    }

    /// The part of a triangle that is inside, as triangles, counter-clockwise.
    fn cut<S: Surface>(&self, cover: &Cover<S>, triangle: [usize; 3], pieces: &mut Vec<[CutCorner; 3]>) {
        let moved = |chart: usize| self.snapped.contains_key(&chart);
        let inner = |chart: usize| inside(cover, chart) && !moved(chart);
        let outer = |chart: usize| !inside(cover, chart) && !moved(chart);
        if !triangle.iter().any(|chart| inner(*chart)) {
            return;
        }
        let mut corners = Vec::new();
        for k in 0..3 {
            let [from, to] = [triangle[k], triangle[(k + 1) % 3]];
            if !outer(from) {
                corners.push(CutCorner::Chart(from));
            }
            if inner(from) && outer(to) {
                corners.push(CutCorner::Edge(from, to));
            }
            if inner(to) && outer(from) {
                corners.push(CutCorner::Edge(to, from));
            }
        }
        match corners[..] {
            [a, b, c] => pieces.push([a, b, c]),
            [a, b, c, d] => {
                let [first, second] = [self.distance(cover, a, c), self.distance(cover, b, d)];
                pieces.extend(if first <= second { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] });
            }
            _ => {}
        }
    }

    fn chart<'a, S: Surface>(&'a self, cover: &'a Cover<S>, corner: CutCorner) -> Option<&'a Chart> {
        match corner {
            CutCorner::Chart(chart) => Some(self.snapped.get(&chart).unwrap_or(&cover.charts[chart])),
            CutCorner::Edge(from, to) => self.points.get(&(from, to)),
        }
    }

    fn distance<S: Surface>(&self, cover: &Cover<S>, a: CutCorner, b: CutCorner) -> f64 {
        match (self.chart(cover, a), self.chart(cover, b)) {
            (Some(a), Some(b)) => cover.apart(&a.x, &b.x),
            _ => f64::INFINITY,
        }
    }

    /// Numbers the corners: charts in their order, then the border's points; drops pieces at edges without point.
    fn gather<S: Surface>(&self, cover: &Cover<S>, pieces: Vec<[CutCorner; 3]>) -> (Vec<Chart>, Vec<[usize; 3]>) {
        let known = |piece: &[CutCorner; 3]| piece.iter().all(|corner| self.chart(cover, *corner).is_some());
        let pieces: Vec<[CutCorner; 3]> = pieces.into_iter().filter(known).collect();
        let mut corners: Vec<CutCorner> = pieces.iter().flatten().copied().collect();
        let border = |corner: &CutCorner| match *corner {
            CutCorner::Chart(chart) => (self.snapped.contains_key(&chart), chart, 0),
            CutCorner::Edge(from, to) => (true, from, to + 1),
        };
        corners.sort_unstable_by_key(border);
        corners.dedup();
        let numbers: HashMap<CutCorner, usize> = corners.iter().enumerate().map(|(number, c)| (*c, number)).collect();
        let charts = corners.iter().filter_map(|corner| self.chart(cover, *corner).cloned()).collect();
        (charts, pieces.iter().map(|piece| piece.map(|corner| numbers[&corner])).collect())
    }
}

fn inside<S: Surface>(cover: &Cover<S>, chart: usize) -> bool {
    cover.charts[chart].limit <= 0.0
}

/// The zero of the limit on the way from an inner to an outer chart: the part of the way, and the point on the surface.
/// Found by false position with halved values, and bisection in between.
fn crossing<S: Surface>(cover: &mut Cover<S>, from: usize, to: usize) -> Option<(f64, Chart)> {
    let [mut a, mut b] = [0.0, 1.0];
    let [mut fa, mut fb] = [from, to].map(|chart| cover.charts[chart].limit);
    let mut found = None;
    for evaluation in 0..MOST_EVALUATIONS {
        let straight = (a * fb - b * fa) / (fb - fa);
        let part = if evaluation % 4 == 3 || !straight.is_finite() { 0.5 * (a + b) } else { straight };
        let point = cover.between(from, to, part)?;
        let value = point.limit;
        found = Some((part, point));
        if value == 0.0 || b - a <= ACCURACY_PER_EDGE {
            break;
        }
        if value < 0.0 {
            (a, fa, fb) = (part, value, 0.5 * fb);
        } else {
            (b, fb, fa) = (part, value, 0.5 * fa);
        }
    }
    found
}
