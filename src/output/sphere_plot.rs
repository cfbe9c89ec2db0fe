//! Energies over the sphere of curvature tensors as a picture: two discs, one for each sign of the mean curvature.
//!
//! A disc is its half of the sphere in Lambert's projection, which keeps areas: in the middle bending alike in all directions, at
//! the rim saddles of opposite curvatures, in between the cone of cylinders. The colour is the square root of the energy over
//! the largest, which is as smooth as the curvature that the energy comes from. The SVG is written directly, see
//! [`super::plot`]: the same map gives the same bytes.

use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2};
use std::fmt::Write;
use std::path::Path;

use super::strain_plot::hexadecimal;
use super::{OutputError, files};
use crate::math::Vec3;

const WIDTH: f64 = 1200.0;
const HEIGHT: f64 = 700.0;
const RADIUS: f64 = 230.0;
/// Middles of the discs: positive and negative mean curvature.
const MIDDLES: [[f64; 2]; 2] = [[262.0, 330.0], [826.0, 330.0]];
const PAPER: &str = "#fcfbf8";
const INK: &str = "#2e3238";
/// Colours from no energy to the largest, evenly.
const COLOURS: [[f64; 3]; 4] = [[250.0, 247.0, 240.0], [244.0, 196.0, 120.0], [209.0, 96.0, 62.0], [88.0, 24.0, 69.0]];
/// Left, right, top and bottom of the colour bar.
const BAR: [f64; 4] = [1112.0, 1134.0, 130.0, 530.0];
/// What belongs to both discs may be this much beyond the rim.
const RIM: f64 = 1e-9;

/// Energies on a sphere, its points given by `(k11 + k22, k11 - k22, 2 k12) / sqrt(2)`.
pub struct Sphere<'a> {
    /// Points of norm 1.
    pub points: &'a [Vec3],
    /// Triangles of them.
    pub triangles: &'a [[usize; 3]],
    /// Energies at the points; not a number where not found.
    pub energies: &'a [f64],
    /// Closed curves on which the energy vanishes.
    pub cone: &'a [Vec<Vec3>],
}

/// Appends formatted text; writing to a string does not fail.
macro_rules! put {
    ($text:expr, $($format:tt)*) => { let _ = write!($text, $($format)*); };
}

/// Writes the picture; the cone of small amplitudes, a circle at this polar angle, is dashed.
///
/// # Errors
/// [`OutputError::Write`].
pub fn write_svg(path: &Path, sphere: &Sphere<'_>, linear: f64, title: &str) -> Result<(), OutputError> {
    files::write(path, svg(sphere, linear, title))
}

fn svg(sphere: &Sphere<'_>, linear: f64, title: &str) -> String {
    let title = title.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" width=\"{WIDTH}\" height=\"{HEIGHT}\" \
         font-family=\"Helvetica, Arial, sans-serif\" font-size=\"19\" fill=\"{INK}\">\n<title>{title}</title>\n\
         <rect width=\"{WIDTH}\" height=\"{HEIGHT}\" rx=\"14\" fill=\"{PAPER}\"/>\n"
    );
    let largest = sphere.energies.iter().copied().filter(|e| e.is_finite()).fold(f64::MIN_POSITIVE, f64::max);
    for (disc, name) in ["positive mean curvature", "negative mean curvature"].into_iter().enumerate() {
        paint(&mut text, sphere, disc, largest);
        frame(&mut text, disc, linear, name);
        curves(&mut text, sphere, disc);
    }
    legend(&mut text);
    bar(&mut text, largest);
    text.push_str("</svg>\n");
    text
}

/// Place of a point on a disc; `None` on the other half of the sphere.
fn place(point: &Vec3, disc: usize) -> Option<[f64; 2]> {
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

/// Distance from the middle of a disc at a polar angle.
fn radius(polar: f64) -> f64 {
    RADIUS * (0.5 * polar).sin() / FRAC_1_SQRT_2
}

fn paint(text: &mut String, sphere: &Sphere<'_>, disc: usize, largest: f64) {
    text.push_str("<g stroke-width=\".6\" stroke-linejoin=\"round\">\n");
    for triangle in sphere.triangles {
        let [Some(a), Some(b), Some(c)] = triangle.map(|point| place(&sphere.points[point], disc)) else { continue };
        let mean = triangle.iter().map(|&point| (sphere.energies[point] / largest).max(0.0).sqrt()).sum::<f64>() / 3.0;
        let fill = hexadecimal(colour(mean));
        put!(text, "<path d=\"M{:.1} {:.1} {:.1} {:.1} {:.1} {:.1}Z\"", a[0], a[1], b[0], b[1], c[0], c[1]);
        put!(text, " fill=\"{fill}\" stroke=\"{fill}\"/>\n");
    }
    text.push_str("</g>\n");
}

/// The rim, the cone of small amplitudes, and what is where.
fn frame(text: &mut String, disc: usize, linear: f64, name: &str) {
    let [x, y] = MIDDLES[disc];
    let circle = |text: &mut String, polar: f64, style: &str| {
        put!(
            text,
            "<circle cx=\"{x}\" cy=\"{y}\" r=\"{:.1}\" fill=\"none\" stroke=\"{INK}\" {style}/>\n",
            radius(polar)
        );
    };
    circle(text, FRAC_PI_2, "stroke-width=\"1.2\"");
    circle(text, linear, "stroke-width=\"1.2\" stroke-dasharray=\"2 7\" stroke-linecap=\"round\"");
    put!(
        text,
        "<text x=\"{x}\" y=\"{}\" text-anchor=\"middle\" font-weight=\"bold\">{name}</text>\n",
        y - RADIUS - 32.0
    );
    let mut label = |dx: f64, dy: f64, anchor: &str, label: &str| {
        put!(
            text,
            "<text x=\"{}\" y=\"{}\" font-size=\"16\" text-anchor=\"{anchor}\">{label}</text>\n",
            x + dx,
            y + dy
        );
    };
    label(0.0, -RADIUS - 8.0, "middle", "k12 &gt; 0");
    label(0.0, RADIUS + 24.0, "middle", "k12 &lt; 0");
    if disc == 0 {
        label(RADIUS + 8.0, 6.0, "start", "k11 &gt; k22");
    }
}

fn curves(text: &mut String, sphere: &Sphere<'_>, disc: usize) {
    for curve in sphere.cone {
        let places: Vec<[f64; 2]> = curve.iter().filter_map(|point| place(point, disc)).collect();
        if places.len() < curve.len() || places.is_empty() {
            continue;
        }
        text.push_str("<path fill=\"none\" stroke-width=\"2.6\" stroke=\"#1d62b0\" d=\"M");
        for [x, y] in places {
            put!(text, "{x:.1} {y:.1} ");
        }
        text.push_str("Z\"/>\n");
    }
}

/// What the two lines are.
fn legend(text: &mut String) {
    let y = HEIGHT - 46.0;
    put!(text, "<path d=\"M240 {y}h44\" stroke=\"#1d62b0\" stroke-width=\"2.6\"/>\n");
    put!(text, "<text x=\"296\" y=\"{}\">exact cylinders (kinematics)</text>\n", y + 6.0);
    put!(
        text,
        "<path d=\"M660 {y}h44\" stroke=\"{INK}\" stroke-width=\"1.2\" stroke-dasharray=\"2 7\" stroke-linecap=\"round\"/>\n"
    );
    put!(text, "<text x=\"716\" y=\"{}\">k11 k22 = k12\u{b2}</text>\n", y + 6.0);
}

/// The scale of colours.
fn bar(text: &mut String, largest: f64) {
    let [left, right, top, bottom] = BAR;
    text.push_str("<defs><linearGradient id=\"energy\" x1=\"0\" y1=\"1\" x2=\"0\" y2=\"0\">");
    for (k, colour) in COLOURS.iter().enumerate() {
        let offset = k as f64 / (COLOURS.len() - 1) as f64;
        put!(text, "<stop offset=\"{offset:.3}\" stop-color=\"{}\"/>", hexadecimal(*colour));
    }
    text.push_str("</linearGradient></defs>\n");
    put!(
        text,
        "<rect x=\"{left}\" y=\"{top}\" width=\"{}\" height=\"{}\" fill=\"url(#energy)\"/>\n",
        right - left,
        bottom - top
    );
    put!(
        text,
        "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\" font-weight=\"bold\">energy</text>\n",
        left + 8.0,
        top - 22.0
    );
    for part in [0.0, 0.25, 0.5, 0.75, 1.0] {
        let y = bottom - part * (bottom - top) + 5.0;
        put!(text, "<text x=\"{}\" y=\"{y:.1}\" font-size=\"14\">{:.1e}</text>\n", right + 6.0, part * part * largest);
    }
}

/// The colour of a square root of the energy between 0 and 1; grey where it is not known.
fn colour(part: f64) -> [f64; 3] {
    if part.is_nan() {
        return [200.0; 3];
    }
    let at = part.clamp(0.0, 1.0) * (COLOURS.len() - 1) as f64;
    let low = (at as usize).min(COLOURS.len() - 2);
    let within = at - low as f64;
    std::array::from_fn(|k| COLOURS[low][k] + within * (COLOURS[low + 1][k] - COLOURS[low][k]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: every triangle is painted on the half it belongs to, each curve once, the rim is at the radius of the disc, and the same map
    /// gives the same bytes; a missing energy is grey and spoils nothing.
    #[test]
    fn two_halves() {
        let points = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0]].map(Vec3::from);
        let energies = [1.0, f64::NAN, 0.0, 0.5];
        let cone = [points[..3].to_vec()];
        let sphere = Sphere { points: &points, triangles: &[[0, 1, 2], [3, 2, 1]], energies: &energies, cone: &cone };
        let text = svg(&sphere, 0.5, "a < b");
        assert!(text.contains("a &lt; b") && !text.contains("NaN"), "{text}");
        assert_eq!(text.matches("Z\" fill").count(), 2);
        assert_eq!(text.matches("stroke-width=\"2.6\" stroke").count(), 1);
        assert_eq!(text, svg(&sphere, 0.5, "a < b"));
        let [x, y] = place(&points[1], 0).unwrap_or_default();
        assert!((x - MIDDLES[0][0] - RADIUS).abs() <= 1e-9 && (y - MIDDLES[0][1]).abs() <= 1e-9);
        assert_eq!(place(&points[0], 1), None);
    }
}
