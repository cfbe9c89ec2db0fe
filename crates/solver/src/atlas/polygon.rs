//! The polygon of a chart: what of its disc no neighbour covers better, in tangent coordinates.
//!
//! It begins as a square around the disc. A neighbour at `u` with radius `r` takes away the half-plane behind the line
//! in which the two balls meet, `u . p > (|u|^2 + R^2 - r^2) / 2`. While a corner lies outside the disc, part of the
//! disc's rim is covered by no other (M. E. Henderson, International Journal of Bifurcation and Chaos 12 (2002)
//! 451-476, section 3).

/// Half the side of the square relative to the radius of the disc.
const SQUARE_PER_RADIUS: f64 = 1.1;
/// Distance of a corner from the centre, relative to the radius, beyond which it gets a chart though it is within the
/// disc, unless a neighbour is within the second part of the radius. So no triangle with an angle near 120 degrees is
/// left.
const COVERED: f64 = 0.9;
const CROWDED: f64 = 0.7;

/// A convex polygon, counter-clockwise.
#[derive(Clone, Debug)]
pub(super) struct Polygon {
    radius: f64,
    corners: Vec<PolygonCorner>,
    clipped: Vec<PolygonCorner>,
    neighbours: Vec<[f64; 2]>,
}

/// A corner with the side that follows it.
#[derive(Clone, Copy, Debug)]
struct PolygonCorner {
    at: [f64; 2],
    /// The neighbour behind the side; `None` for a side of the square.
    beyond: Option<usize>,
}

impl Polygon {
    pub fn new() -> Self {
        Self { radius: 0.0, corners: Vec::new(), clipped: Vec::new(), neighbours: Vec::new() }
    }

    /// Starts from the square around a disc.
    pub fn reset(&mut self, radius: f64) {
        self.radius = radius;
        self.neighbours.clear();
        self.corners.clear();
        let signs = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        self.corners.extend(
            signs.map(|at| PolygonCorner { at: at.map(|s: f64| s * SQUARE_PER_RADIUS * radius), beyond: None }),
        );
    }

    /// Cuts off the part that neighbour `number` at `u`, of this radius, covers better.
    pub fn clip(&mut self, u: [f64; 2], radius: f64, number: usize) {
        self.neighbours.push(u);
        let limit = 0.5 * (u[0] * u[0] + u[1] * u[1] + self.radius * self.radius - radius * radius);
        let beyond = |corner: &PolygonCorner| corner.at[0] * u[0] + corner.at[1] * u[1] - limit;
        if self.corners.iter().all(|corner| beyond(corner) <= 0.0) {
            return;
        }
        self.clipped.clear();
        for (k, corner) in self.corners.iter().enumerate() {
            let next = &self.corners[(k + 1) % self.corners.len()];
            let [from, to] = [beyond(corner), beyond(next)];
            if from <= 0.0 {
                self.clipped.push(*corner);
            }
            if (from <= 0.0) != (to <= 0.0) {
                let part = from / (from - to);
                let at = [0, 1].map(|axis| corner.at[axis] + part * (next.at[axis] - corner.at[axis]));
                let behind = if from <= 0.0 { Some(number) } else { corner.beyond };
                self.clipped.push(PolygonCorner { at, beyond: behind });
            }
        }
        std::mem::swap(&mut self.corners, &mut self.clipped);
    }

    /// A place for a new chart where the disc is not covered well; `None` where it is.
    ///
    /// It is on the rim of the disc and of a neighbour where that can be: discs placed there are one radius apart. A
    /// corner within the disc but close to its rim is itself the place.
    pub fn uncovered(&self) -> Option<[f64; 2]> {
        let count = self.corners.len();
        let apart = |a: [f64; 2], b: [f64; 2]| length([a[0] - b[0], a[1] - b[1]]);
        let crowded = |at| self.neighbours.iter().any(|other| apart(*other, at) < CROWDED * self.radius);
        let outside = |corner: &PolygonCorner| {
            let out = length(corner.at) / self.radius;
            out > 1.0 || (out > COVERED && !crowded(corner.at))
        };
        let mut any = None;
        for k in (0..count).filter(|k| outside(&self.corners[*k])) {
            let corner = self.corners[k];
            let sides = [(k, (k + 1) % count), ((k + count - 1) % count, (k + count - 1) % count)];
            for (side, end) in sides {
                if self.corners[side].beyond.is_some() {
                    let found = rim(corner.at, self.corners[end].at, self.radius);
                    if found.is_some() {
                        return found;
                    }
                }
            }
            let shorter = (self.radius / length(corner.at)).min(1.0);
            any = any.or(Some(corner.at.map(|x| x * shorter)));
        }
        any
    }

    /// The neighbours behind the sides, counter-clockwise; `None` where the disc is open.
    pub fn ring(&self) -> Vec<Option<usize>> {
        self.corners.iter().map(|corner| corner.beyond).collect()
    }
}

fn length(at: [f64; 2]) -> f64 {
    at[0].hypot(at[1])
}

/// The part of the way from a point outside a circle to another at which it first meets the circle.
fn rim(from: [f64; 2], to: [f64; 2], radius: f64) -> Option<[f64; 2]> {
    let way = [to[0] - from[0], to[1] - from[1]];
    let (a, b) = (way[0] * way[0] + way[1] * way[1], from[0] * way[0] + from[1] * way[1]);
    let c = from[0] * from[0] + from[1] * from[1] - radius * radius;
    let discriminant = b * b - a * c;
    if !(discriminant >= 0.0 && b < 0.0 && c > 0.0) {
        return None;
    }
    let part = c / (discriminant.sqrt() - b);
    (part <= 1.0).then(|| [0, 1].map(|axis| from[axis] + part * way[axis]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: six equal discs are placed around one at the distance of its radius, each found by the one before: the
    /// places are the corners of a regular hexagon. Tolerance: rounding.
    #[test]
    fn six_discs_around_one() {
        let mut polygon = Polygon::new();
        polygon.reset(2.0);
        let mut found: Vec<[f64; 2]> = Vec::new();
        while let Some(at) = polygon.uncovered() {
            assert!((length(at) - 2.0).abs() <= 1e-14 && found.len() < 6, "{found:?}");
            for other in &found {
                assert!(length([at[0] - other[0], at[1] - other[1]]) >= 2.0 - 1e-14, "{found:?}");
            }
            polygon.clip(at, 2.0, found.len());
            found.push(at);
        }
        assert_eq!(found.len(), 6);
        let mut ring: Vec<usize> = polygon.ring().into_iter().flatten().collect();
        ring.sort();
        assert_eq!(ring, [0, 1, 2, 3, 4, 5]);
    }

    /// Claim: a larger neighbour takes more, and lines lie where the two circles meet.
    #[test]
    fn balls_meet_in_lines() {
        let mut polygon = Polygon::new();
        polygon.reset(1.0);
        polygon.clip([1.0, 0.0], 1.2, 7);
        let at = polygon.uncovered().unwrap();
        assert!((length(at) - 1.0).abs() <= 1e-15 && (length([at[0] - 1.0, at[1]]) - 1.2).abs() <= 1e-15, "{at:?}");
        assert_eq!(polygon.ring().iter().flatten().collect::<Vec<_>>(), [&7]);
    }
}
