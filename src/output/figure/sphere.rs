//! Figure of the energies over the sphere of curvature tensors: two discs, one for each sign of the mean curvature.
//!
//! Each disc is a half of the sphere in Lambert's azimuthal projection, which preserves areas. At its centre the sheet
//! bends equally in all directions, at its rim with opposite curvatures (a saddle), and the cone of cylinders lies in
//! between. The colour is the square root of the energy relative to the largest one, which is as smooth as the
//! curvature that causes the energy.

use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_4};

use super::axes::{rounded, unit};
use super::canvas::{Canvas, Caption, Mark};
use super::contour::regions;
use super::palette::{Colour, ENERGY, INK, VALLEY};
use super::style::{Area, Font, PaperPoint, Style};
use crate::math::Vec3;

const HEIGHT: f64 = 712.0;
const RADIUS: f64 = 222.0;
/// Centres of the discs of positive and of negative mean curvature.
const MIDDLES: [PaperPoint; 2] = [[298.0, 386.0], [816.0, 386.0]];
const BAR: Area = Area { low: [1096.0, 200.0], high: [1116.0, 572.0] };
/// Tolerance within which points on the rim belong to both discs.
const RIM: f64 = 1e-9;
/// Number of shades of the map.
const SHADES: usize = 32;
/// Colour where the energy is not known.
const UNKNOWN: Colour = Colour(200, 200, 200);
/// Colour and line width of the exact cone.
const EXACT: (Colour, f64) = (VALLEY, 2.6);

/// Energies on the unit sphere, with coordinates `(k11 + k22, k11 - k22, 2 k12) / sqrt(2)` for a curvature tensor `k`.
pub struct Sphere<'a> {
    /// Points of norm 1.
    pub points: &'a [Vec3],
    /// Points at the corners of each triangle.
    pub triangles: &'a [[usize; 3]],
    /// Energies at the points; NaN where they were not found.
    pub energies: &'a [f64],
    /// Closed curves on which the energy vanishes.
    pub cone: &'a [Vec<Vec3>],
}

/// Returns the figure of energies on a sphere.
pub(crate) fn svg(sphere: &Sphere<'_>, caption: &Caption) -> Canvas {
    let mut canvas = Canvas::new(HEIGHT, caption);
    let largest = sphere.energies.iter().copied().filter(|e| e.is_finite()).fold(f64::MIN_POSITIVE, f64::max);
    for (disc, name) in ["positive mean curvature", "negative mean curvature"].into_iter().enumerate() {
        paint(&mut canvas, sphere, disc, largest);
        frame(&mut canvas, disc, name);
        curves(&mut canvas, sphere, disc);
    }
    let (colour, width) = EXACT;
    let entries = [
        (Mark::Line(Style::line(colour, width)), "exact cylinders (kinematics)"),
        (Mark::Line(linear()), "k\u{2081}\u{2081}k\u{2082}\u{2082} = k\u{2081}\u{2082}\u{b2} (small amplitudes)"),
        (Mark::None, "colour: square root of the energy"),
    ];
    canvas.legend([80.0, HEIGHT - 26.0], &entries);
    let (unit, words) = unit(largest);
    let ticks = [0.0, 0.25, 0.5, 0.75, 1.0].map(|part| (part, rounded(part * part * largest / unit, 3)));
    canvas.colour_bar(BAR, ENERGY, &format!("energy{words}"), &ticks);
    canvas
}

/// Returns the style of the cone of small amplitudes, which is a circle on both discs.
fn linear() -> Style {
    Style::line(INK, 1.8).dashed(7.0, 5.0)
}

/// Returns the position of a point on a disc; `None` if it is on the other half of the sphere.
fn place(point: &Vec3, disc: usize) -> Option<PaperPoint> {
    let sign = if disc == 0 { 1.0 } else { -1.0 };
    if !(sign * point.x >= -RIM) {
        return None;
    }
    let across = point.y.hypot(point.z);
    let polar = across.atan2(sign * point.x);
    let part = if across > 0.0 { radius(polar) / across } else { 0.0 };
    let [x, y] = MIDDLES[disc];
    Some([x + part * point.y, y - part * point.z])
}

/// Returns the distance from the centre of a disc for a polar angle in radians.
fn radius(polar: f64) -> f64 {
    RADIUS * (0.5 * polar).sin() / FRAC_1_SQRT_2
}

/// Draws the map on a disc, grey where the energy is not known.
fn paint(canvas: &mut Canvas, sphere: &Sphere<'_>, disc: usize, largest: f64) {
    let places: Vec<Option<PaperPoint>> = sphere.points.iter().map(|point| place(point, disc)).collect();
    let here = |triangle: &&[usize; 3]| triangle.iter().all(|&point| places[point].is_some());
    let triangles: Vec<[usize; 3]> = sphere.triangles.iter().filter(here).copied().collect();
    let points: Vec<PaperPoint> = places.iter().map(|place| place.unwrap_or_default()).collect();
    let roots: Vec<f64> = sphere.energies.iter().map(|energy| (energy / largest).max(0.0).sqrt()).collect();
    let roots: Vec<f64> = roots.iter().zip(sphere.energies).map(|(r, e)| if e.is_nan() { *e } else { *r }).collect();
    canvas.group(0.8);
    if sphere.energies.iter().any(|energy| energy.is_nan()) {
        canvas.circle(MIDDLES[disc], RADIUS, Style::area(UNKNOWN));
    }
    for shade in 0..SHADES {
        let level = if shade == 0 { f64::NEG_INFINITY } else { shade as f64 / SHADES as f64 };
        let areas = regions(&points, &triangles, &roots, level);
        if !areas.is_empty() {
            canvas.polygons(&areas, Style::tile(ENERGY.at((shade as f64 + 0.5) / SHADES as f64)));
        }
    }
    canvas.end();
}

/// Draws the rim of a disc, the cone of small amplitudes, and the names of the directions.
fn frame(canvas: &mut Canvas, disc: usize, name: &str) {
    let middle @ [x, y] = MIDDLES[disc];
    canvas.circle(middle, RADIUS, Style::line(INK, 1.6));
    canvas.circle(middle, radius(FRAC_PI_4), linear());
    canvas.text([x, y - RADIUS - 40.0], name, Font::LABEL.bold().middle());
    let small = Font::SMALL.middle();
    canvas.text([x, y - RADIUS - 12.0], "k\u{2081}\u{2082} > 0", small);
    canvas.text([x, y + RADIUS + 24.0], "k\u{2081}\u{2082} < 0", small);
    canvas.text([x - RADIUS - 14.0, y], "k\u{2081}\u{2081} < k\u{2082}\u{2082}", small.turned());
    canvas.text([x + RADIUS + 24.0, y], "k\u{2081}\u{2081} > k\u{2082}\u{2082}", small.turned());
}

fn curves(canvas: &mut Canvas, sphere: &Sphere<'_>, disc: usize) {
    let (colour, width) = EXACT;
    for curve in sphere.cone {
        let places: Vec<PaperPoint> = curve.iter().filter_map(|point| place(point, disc)).collect();
        if places.len() == curve.len() && !places.is_empty() {
            canvas.polygon(&places, Style::line(colour, width));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: the map is painted on both discs, each curve once, points of the rim are at the radius of the disc, and
    /// equal data give equal bytes; where an energy is missing the disc is grey, and the rest is drawn; texts do not
    /// overlap.
    #[test]
    fn two_halves() {
        let points = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0]].map(Vec3::from);
        let cone = [points[..3].to_vec()];
        let triangles = [[0, 1, 2], [3, 2, 1]];
        let sphere = |energies| Sphere { points: &points, triangles: &triangles, energies, cone: &cone };
        let caption = Caption { title: "a < b".into(), state: "amplitude 0.02".into() };
        let text = svg(&sphere(&[1.0, 0.25, 0.0, 0.5]), &caption).finish();
        assert!(text.contains("a &lt; b") && !text.contains("NaN") && !text.contains(&UNKNOWN.to_string()), "{text}");
        assert_eq!(text.matches("stroke-width=\"2.6\"").count(), 1 + 1, "the curve, and the legend");
        let lowest = format!("Z\" fill=\"{0}\" stroke=\"{0}\"", ENERGY.at(0.5 / SHADES as f64));
        assert_eq!(text.matches(&lowest).count(), 2);
        assert_eq!(text, svg(&sphere(&[1.0, 0.25, 0.0, 0.5]), &caption).finish());
        assert_eq!(svg(&sphere(&[1.0, 0.25, 0.0, 0.5]), &caption).crowded(), 0);
        let missing = svg(&sphere(&[1.0, f64::NAN, 0.0, 0.5]), &caption).finish();
        assert!(
            missing.contains(&UNKNOWN.to_string()) && !missing.contains("NaN") && missing.matches(&lowest).count() == 0
        );
        let [x, y] = place(&points[1], 0).unwrap_or_default();
        assert!((x - MIDDLES[0][0] - RADIUS).abs() <= 1e-9 && (y - MIDDLES[0][1]).abs() <= 1e-9);
        assert_eq!(place(&points[0], 1), None);
    }
}
