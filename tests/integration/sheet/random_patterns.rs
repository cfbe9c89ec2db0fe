//! Random flat-foldable crease patterns with their letters, as FOLD texts of points and edges without faces.

use std::f64::consts::PI;

use crate::common::Numbers;

/// Distance below which two points are one.
const SAME_POINT: f64 = 1e-9;
/// Shortest edge of a pattern, and least distance of a fold line from the corners that it does not go through. A folded
/// sheet is about 1 wide.
const SHORTEST_EDGE: f64 = 0.02;

type Point = [f64; 2];

/// A family of patterns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// A square, folded flat 3 to 6 times along random lines through all its layers, some of them through a corner of
    /// the folded stack. The letters are those of these folds, one after the other; few of these patterns fold rigidly
    /// by all creases at once.
    SimpleFolds,
    /// Parallel lines at random distances, crossed by zigzags, each with its own angle and lean: a generalized
    /// Miura-ori, which folds rigidly by all creases at once.
    Zigzags,
    /// A vertex with 4, 6 or 8 creases at random angles that fulfil Kawasaki's condition; the letters are those of
    /// crimping it flat.
    Vertex,
}

impl Family {
    pub const ALL: [Self; 3] = [Self::SimpleFolds, Self::Zigzags, Self::Vertex];

    /// Returns the FOLD text of a pattern of this family.
    pub fn pattern(self, seed: u64) -> String {
        let numbers = &mut Numbers::new(seed);
        let drawing = match self {
            Self::SimpleFolds => simple_folds(numbers),
            Self::Zigzags => Zigzags::random(numbers).drawing(),
            Self::Vertex => vertex(numbers),
        };
        drawing.text()
    }
}

/// Points and edges with letters.
#[derive(Default)]
struct Drawing {
    points: Vec<Point>,
    edges: Vec<([usize; 2], char)>,
}

impl Drawing {
    fn point(&mut self, at: Point) -> usize {
        if let Some(known) = self.points.iter().position(|p| distance(*p, at) < SAME_POINT) {
            return known;
        }
        self.points.push(at);
        self.points.len() - 1
    }

    /// Adds an edge unless it is there.
    fn edge(&mut self, ends: [Point; 2], letter: char) {
        let [i, j] = ends.map(|end| self.point(end));
        let key = [i.min(j), i.max(j)];
        if self.edges.iter().all(|(known, _)| *known != key) {
            self.edges.push((key, letter));
        }
    }

    fn shortest_edge(&self) -> f64 {
        let lengths = self.edges.iter().map(|([i, j], _)| distance(self.points[*i], self.points[*j]));
        lengths.fold(f64::INFINITY, f64::min)
    }

    fn text(&self) -> String {
        let list = |each: Vec<String>| each.join(",");
        let points = list(self.points.iter().map(|p| format!("{p:?}")).collect());
        let ends = list(self.edges.iter().map(|(ends, _)| format!("{ends:?}")).collect());
        let letters = list(self.edges.iter().map(|(_, letter)| format!("\"{letter}\"")).collect());
        format!(
            "{{\"vertices_coords\": [{points}],\n\"edges_vertices\": [{ends}],\n\"edges_assignment\": [{letters}]}}"
        )
    }
}

fn distance(a: Point, b: Point) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Returns a number between these bounds.
fn between(numbers: &mut Numbers, low: f64, high: f64) -> f64 {
    0.5 * (low + high) + numbers.within(0.5 * (high - low))
}

/// Returns a whole number from 0 to `count - 1`.
fn below(numbers: &mut Numbers, count: usize) -> usize {
    (between(numbers, 0.0, count as f64) as usize).min(count - 1)
}

fn letter(valley: bool) -> char {
    if valley { 'V' } else { 'M' }
}

/// A corner of a face on the paper, and where it is now.
type Corner = (Point, Point);

/// A face of a sheet that is folded flat.
struct Layer {
    corners: Vec<Corner>,
    faces_up: bool,
}

/// The line `normal . x = offset`.
struct Line {
    normal: Point,
    offset: f64,
}

impl Line {
    /// Returns the distance of a point from the line, positive on the side of the normal, 0 if it is on it.
    fn distance(&self, at: Point) -> f64 {
        let distance = self.normal[0] * at[0] + self.normal[1] * at[1] - self.offset;
        if distance.abs() < SAME_POINT { 0.0 } else { distance }
    }

    fn mirrored(&self, at: Point) -> Point {
        let twice = 2.0 * self.distance(at);
        [at[0] - twice * self.normal[0], at[1] - twice * self.normal[1]]
    }
}

/// A crease on the paper with its letter.
type Crease = ([Point; 2], char);

impl Layer {
    /// Returns the parts on the negative and on the positive side of a line, and the crease between them.
    fn split(&self, line: &Line) -> ([Vec<Corner>; 2], Option<[Point; 2]>) {
        let (mut parts, mut on_line) = ([vec![], vec![]], vec![]);
        for (k, &corner) in self.corners.iter().enumerate() {
            let next = self.corners[(k + 1) % self.corners.len()];
            let [here, there] = [corner, next].map(|(_, now)| line.distance(now));
            if here <= 0.0 {
                parts[0].push(corner);
            }
            if here >= 0.0 {
                parts[1].push(corner);
            }
            if here == 0.0 {
                on_line.push(corner.0);
            }
            if here * there < 0.0 {
                let part = here / (here - there);
                let mix = |a: Point, b: Point| [a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1])];
                let cut = (mix(corner.0, next.0), mix(corner.1, next.1));
                parts.iter_mut().for_each(|list| list.push(cut));
                on_line.push(cut.0);
            }
        }
        let crossed = parts.iter().all(|part| part.len() > 2) && on_line.len() == 2;
        (parts, crossed.then(|| [on_line[0], on_line[1]]))
    }
}

/// Folds all layers on the positive side of a line over to the other side, on top of the stack or under it.
fn fold_over(layers: &[Layer], line: &Line, on_top: bool, creases: &mut Vec<Crease>) -> Vec<Layer> {
    let mut folded = vec![];
    for layer in layers {
        let (parts, crease) = layer.split(line);
        creases.extend(crease.map(|ends| (ends, letter(layer.faces_up == on_top))));
        for (mut corners, moves) in parts.into_iter().zip([false, true]) {
            if corners.len() > 2 {
                if moves {
                    corners.iter_mut().for_each(|(_, now)| *now = line.mirrored(*now));
                }
                folded.push(Layer { corners, faces_up: layer.faces_up != moves });
            }
        }
    }
    folded
}

/// Returns a random line through the stack, in one of two cases through one of its corners.
fn random_line(numbers: &mut Numbers, layers: &[Layer]) -> Line {
    let corners: Vec<Point> = layers.iter().flat_map(|layer| layer.corners.iter().map(|(_, now)| *now)).collect();
    let [a, b] = [0, 1].map(|_| corners[below(numbers, corners.len())]);
    let part = if numbers.within(1.0) > 0.0 { 0.0 } else { between(numbers, 0.2, 0.8) };
    let direction = between(numbers, 0.0, 2.0 * PI);
    let normal = [direction.cos(), direction.sin()];
    let through = [a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1])];
    Line { normal, offset: normal[0] * through[0] + normal[1] * through[1] }
}

/// Returns the drawing of all faces; creases are those of the list, other edges are on the boundary.
fn unfolded(layers: &[Layer], creases: &[Crease]) -> Drawing {
    let mut drawing = Drawing::default();
    for layer in layers {
        for (k, &(a, _)) in layer.corners.iter().enumerate() {
            let b = layer.corners[(k + 1) % layer.corners.len()].0;
            let middle = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
            let through = |&&([p, q], _): &&Crease| {
                (distance(p, middle) + distance(middle, q) - distance(p, q)).abs() < SAME_POINT
            };
            drawing.edge([a, b], creases.iter().find(through).map_or('B', |crease| crease.1));
        }
    }
    drawing
}

fn simple_folds(numbers: &mut Numbers) -> Drawing {
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let mut layers = vec![Layer { corners: square.map(|p| (p, p)).to_vec(), faces_up: true }];
    let (mut creases, folds) = (vec![], 3 + below(numbers, 4));
    let mut done = 0;
    while done < folds {
        let (line, on_top) = (random_line(numbers, &layers), numbers.within(1.0) > 0.0);
        let before = creases.len();
        let folded = fold_over(&layers, &line, on_top, &mut creases);
        let near = layers.iter().flat_map(|layer| &layer.corners).any(|(_, now)| {
            let distance = line.distance(*now).abs();
            distance > 0.0 && distance < SHORTEST_EDGE
        });
        if near || creases.len() == before || unfolded(&folded, &creases).shortest_edge() < SHORTEST_EDGE {
            creases.truncate(before);
            continue;
        }
        (layers, done) = (folded, done + 1);
    }
    unfolded(&layers, &creases)
}

/// Zigzags across parallel lines.
struct Zigzags {
    /// Where the lines are; the first and the last one are rims.
    x: Vec<f64>,
    /// The height of each zigzag at each line, from the lower rim to the upper one.
    heights: Vec<Vec<f64>>,
    /// For each zigzag, whether it goes up first, and whether it is a valley.
    ups: Vec<bool>,
    valleys: Vec<bool>,
}

impl Zigzags {
    /// Where a zigzag has a peak, the line above has its letter and the line below the other one. So the letters of all
    /// zigzags follow from that of the first one.
    fn random(numbers: &mut Numbers) -> Self {
        let [lines, rows] = [0, 1].map(|_| 1 + below(numbers, 4));
        let mut x = vec![0.0];
        (0..=lines).for_each(|j| x.push(x[j] + between(numbers, 0.5, 1.2)));
        let mut heights = vec![vec![0.0; x.len()]];
        let (mut ups, mut valleys) = (vec![], vec![numbers.within(1.0) > 0.0]);
        for row in 0..=rows {
            let (angle, up) = (between(numbers, 20.0, 55.0f64).to_radians(), numbers.within(1.0) > 0.0);
            let steep = if row < rows { angle.tan() } else { 0.0 };
            let mut height = vec![0.0];
            (0..=lines).for_each(|j| {
                let rise = if (j % 2 == 0) == up { steep } else { -steep };
                height.push(height[j] + rise * (x[j + 1] - x[j]));
            });
            let least = height.iter().zip(&heights[row]).map(|(a, b)| a - b).fold(f64::INFINITY, f64::min);
            let gap = between(numbers, 0.4, 0.9) - least;
            heights.push(height.iter().map(|y| y + gap).collect());
            ups.push(up);
            if row > 0 && row < rows {
                valleys.push(valleys[row - 1] != (ups[row] == ups[row - 1]));
            }
        }
        Self { x, heights, ups, valleys }
    }

    /// Returns the letter of a line between a row, counted from the lower rim, and the next one.
    fn line_letter(&self, line: usize, row: usize) -> char {
        let peak = |zigzag: usize| (line % 2 == 1) == self.ups[zigzag];
        letter(if row == 0 { self.valleys[0] != peak(0) } else { self.valleys[row - 1] == peak(row - 1) })
    }

    fn drawing(&self) -> Drawing {
        let mut drawing = Drawing::default();
        let (last_row, last_line) = (self.heights.len() - 1, self.x.len() - 1);
        let at = |row: usize, line: usize| [self.x[line], self.heights[row][line]];
        for row in 0..=last_row {
            let rim = row == 0 || row == last_row;
            let letter = if rim { 'B' } else { letter(self.valleys[row - 1]) };
            (0..last_line).for_each(|line| drawing.edge([at(row, line), at(row, line + 1)], letter));
        }
        for line in 0..=last_line {
            let rim = line == 0 || line == last_line;
            for row in 0..last_row {
                let letter = if rim { 'B' } else { self.line_letter(line, row) };
                drawing.edge([at(row, line), at(row + 1, line)], letter);
            }
        }
        drawing
    }
}

/// Returns `count` sectors, at least 20 degrees wide, that add up to pi.
fn half_of_the_sectors(numbers: &mut Numbers, count: usize) -> Vec<f64> {
    let least = 20f64.to_radians();
    let parts: Vec<f64> = (0..count).map(|_| between(numbers, 0.05, 1.0)).collect();
    let whole: f64 = parts.iter().sum();
    parts.iter().map(|part| least + (PI - count as f64 * least) * part / whole).collect()
}

/// Returns the letters, true for valleys, of a vertex with these sectors; sector `k` is between the creases `k` and
/// `k + 1`. Source: crimps of the narrowest sector, T. Hull, "The combinatorics of flat folds: a survey", Origami3
/// (2002).
fn crimped(numbers: &mut Numbers, sectors: &[f64]) -> Vec<bool> {
    let mut letters = vec![false; sectors.len()];
    let mut left: Vec<(usize, f64)> = sectors.iter().copied().enumerate().collect();
    while left.len() > 2 {
        let count = left.len();
        let narrowest = (0..count).min_by(|a, b| left[*a].1.total_cmp(&left[*b].1)).unwrap();
        left.rotate_left((narrowest + count - 1) % count);
        let valley = numbers.within(1.0) > 0.0;
        (letters[left[1].0], letters[left[2].0]) = (valley, !valley);
        left[0].1 += left[2].1 - left[1].1;
        left.drain(1..3);
    }
    let valley = numbers.within(1.0) > 0.0;
    left.iter().for_each(|(crease, _)| letters[*crease] = valley);
    letters
}

fn vertex(numbers: &mut Numbers) -> Drawing {
    let half = 2 + below(numbers, 3);
    let [even, odd] = [0, 1].map(|_| half_of_the_sectors(numbers, half));
    let sectors: Vec<f64> = even.iter().zip(&odd).flat_map(|(a, b)| [*a, *b]).collect();
    let letters = crimped(numbers, &sectors);
    let mut direction = between(numbers, 0.0, 2.0 * PI);
    let mut rim = vec![];
    for sector in &sectors {
        rim.push([direction.cos(), direction.sin()]);
        direction += sector;
    }
    let mut drawing = Drawing::default();
    for (k, &end) in rim.iter().enumerate() {
        drawing.edge([[0.0, 0.0], end], letter(letters[k]));
        drawing.edge([end, rim[(k + 1) % rim.len()]], 'B');
    }
    drawing
}
