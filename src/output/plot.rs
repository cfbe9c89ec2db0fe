//! A state as a picture: the sheet seen obliquely, faces shaded, creases drawn by their fold angles.
//!
//! Faces are painted from back to front; each edge goes onto the paper right after the nearer of its faces, so that
//! whatever is in front of it covers it. Mountains are red and valleys blue, the wider the sharper they are folded. The
//! SVG is written directly: it needs round joints, dashes and one outline for every face in the colour of its filling
//! (otherwise hairlines show between them), which general plotting crates do not offer. The same picture gives the same
//! bytes.

use std::collections::HashMap;
use std::fmt::Write;
use std::path::Path;

use super::picture::Picture;
use super::projection::View;
use super::{OutputError, files};
use crate::math::Vec3;
use crate::sheet::EdgeKind;

const WIDTH: f64 = 1200.0;
const MARGIN: f64 = 60.0;
const LEGEND: f64 = 64.0;
const PAPER: &str = "#fcfbf8";
const SHADOW: &str = "#e7e4dd";
const INK: &str = "#2e3238";
const MOUNTAIN: &str = "#c8372d";
const VALLEY: &str = "#1d62b0";
/// Creases folded by less are drawn as flat ones.
const FLAT: f64 = 1e-6;
const FACET: &str = "#7d7a72";

/// Colours of a side of the sheet in full light and away from it.
struct Side {
    light: [f64; 3],
    dark: [f64; 3],
}

const FRONT: Side = Side { light: [255.0, 251.0, 240.0], dark: [124.0, 136.0, 164.0] };
const BACK: Side = Side { light: [240.0, 214.0, 168.0], dark: [150.0, 118.0, 92.0] };
const CROSSING: Side = Side { light: [246.0, 154.0, 138.0], dark: [158.0, 72.0, 66.0] };

/// Writes a picture of a state.
///
/// # Errors
/// [`OutputError::Shape`] where the picture's arrays do not fit together, [`OutputError::Write`].
pub fn write_svg(path: &Path, picture: &Picture, title: &str) -> Result<(), OutputError> {
    picture.check().map_err(|fault| OutputError::Shape { path: path.into(), fault })?;
    files::write(path, svg(picture, title))
}

/// The text of the picture; all indices of `picture` are right.
fn svg(picture: &Picture, title: &str) -> String {
    let view = View::of(&picture.points, &picture.triangles);
    let sheet: Vec<[f64; 3]> = picture.points.iter().map(|point| view.place(point)).collect();
    let shadow: Vec<[f64; 3]> = shadow_on_floor(picture, &view).iter().map(|point| view.place(point)).collect();
    let frame = Frame::around(sheet.iter().chain(&shadow));
    let mut text = header(&frame, title);
    paint_shadow(&mut text, picture, &frame, &shadow);
    paint_sheet(&mut text, picture, &frame, &view, &sheet);
    legend(&mut text, picture, &frame);
    text.push_str("</svg>\n");
    text
}

/// Appends formatted text; writing to a string does not fail.
macro_rules! put {
    ($text:expr, $($format:tt)*) => { let _ = write!($text, $($format)*); };
}

/// The part of the paper that the sheet takes.
struct Frame {
    left: f64,
    top: f64,
    scale: f64,
    height: f64,
}

impl Frame {
    /// Fits the places into the width of the paper and at most three quarters of it in height.
    fn around<'a>(places: impl Iterator<Item = &'a [f64; 3]>) -> Self {
        let mut low = [f64::INFINITY; 2];
        let mut high = [f64::NEG_INFINITY; 2];
        for place in places.filter(|place| finite(place)) {
            for axis in 0..2 {
                low[axis] = low[axis].min(place[axis]);
                high[axis] = high[axis].max(place[axis]);
            }
        }
        let extent = [0, 1].map(|axis| (high[axis] - low[axis]).max(f64::MIN_POSITIVE));
        let room = WIDTH - 2.0 * MARGIN;
        let scale = (room / extent[0]).min(0.75 * room / extent[1]).min(f64::MAX);
        let left = 0.5 * (low[0] + high[0]) - 0.5 * WIDTH / scale;
        Self { left, top: high[1] + MARGIN / scale, scale, height: extent[1] * scale + 2.0 * MARGIN }
    }

    fn on_paper(&self, place: &[f64; 3]) -> [f64; 2] {
        [(place[0] - self.left) * self.scale, (self.top - place[1]) * self.scale]
    }
}

fn finite(place: &[f64; 3]) -> bool {
    place.iter().all(|x| x.is_finite())
}

fn header(frame: &Frame, title: &str) -> String {
    let height = frame.height + LEGEND;
    let title = title.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height:.0}\" width=\"{WIDTH}\" \
         height=\"{height:.0}\" font-family=\"Helvetica, Arial, sans-serif\" font-size=\"19\" fill=\"{INK}\">\n\
         <title>{title}</title>\n\
         <defs><filter id=\"soft\"><feGaussianBlur stdDeviation=\"7\"/></filter></defs>\n\
         <rect width=\"{WIDTH}\" height=\"{height:.0}\" rx=\"14\" fill=\"{PAPER}\"/>\n"
    )
}

/// Where the light comes from: from the upper left, a little in front of the sheet.
fn light(view: &View) -> Vec3 {
    (view.toward * 0.45 + view.up * 0.75 - view.right * 0.62).normalize()
}

/// The points moved along the light onto a floor just below the sheet.
fn shadow_on_floor(picture: &Picture, view: &View) -> Vec<Vec3> {
    let light = light(view);
    let heights = picture.points.iter().map(|point| point.dot(&view.normal)).filter(|height| height.is_finite());
    let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), h| (low.min(h), high.max(h)));
    let floor = low - 0.15 * (high - low);
    let drop = |point: &Vec3| point - light * ((point.dot(&view.normal) - floor) / light.dot(&view.normal));
    picture.points.iter().map(drop).collect()
}

fn paint_shadow(text: &mut String, picture: &Picture, frame: &Frame, shadow: &[[f64; 3]]) {
    put!(text, "<path filter=\"url(#soft)\" fill=\"{SHADOW}\" stroke=\"{SHADOW}\" d=\"");
    for triangle in picture.triangles.iter().filter(|t| t.iter().all(|&point| finite(&shadow[point]))) {
        let [a, b, c] = triangle.map(|point| frame.on_paper(&shadow[point]));
        // all the same way round, so that overlaps are filled
        let turn = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        let [b, c] = if turn < 0.0 { [c, b] } else { [b, c] };
        put!(text, "M{:.1} {:.1} {:.1} {:.1} {:.1} {:.1}Z", a[0], a[1], b[0], b[1], c[0], c[1]);
    }
    text.push_str("\"/>\n");
}

fn paint_sheet(text: &mut String, picture: &Picture, frame: &Frame, view: &View, sheet: &[[f64; 3]]) {
    let depth = |triangle: &[usize; 3]| triangle.iter().map(|&point| sheet[point][2]).sum::<f64>();
    let mut order: Vec<usize> = (0..picture.triangles.len())
        .filter(|&face| picture.triangles[face].iter().all(|&point| finite(&sheet[point])))
        .collect();
    order.sort_by(|&a, &b| depth(&picture.triangles[a]).total_cmp(&depth(&picture.triangles[b])));
    let lines = lines_on_faces(picture, &order);
    let pen = Pen::new(picture, frame, sheet);
    text.push_str("<g stroke-width=\".7\" stroke-linejoin=\"round\" stroke-linecap=\"round\">\n");
    for (face, lines) in order.into_iter().zip(lines) {
        let [a, b, c] = picture.triangles[face].map(|point| frame.on_paper(&sheet[point]));
        let colour = shade(picture, view, face);
        put!(text, "<path d=\"M{:.1} {:.1} {:.1} {:.1} {:.1} {:.1}Z\"", a[0], a[1], b[0], b[1], c[0], c[1]);
        put!(text, " fill=\"{colour}\" stroke=\"{colour}\"/>\n");
        for line in lines {
            let [a, b] = picture.lines[line].map(|point| frame.on_paper(&sheet[point]));
            let style = pen.style(picture, line);
            put!(text, "<path d=\"M{:.1} {:.1} {:.1} {:.1}\" {style}/>\n", a[0], a[1], b[0], b[1]);
        }
    }
    text.push_str("</g>\n");
}

/// For each place in the order of painting, the lines whose last face is painted there.
fn lines_on_faces(picture: &Picture, order: &[usize]) -> Vec<Vec<usize>> {
    let mut last: HashMap<[usize; 2], usize> = HashMap::new();
    for (place, &face) in order.iter().enumerate() {
        let [a, b, c] = picture.triangles[face];
        for [i, j] in [[a, b], [b, c], [c, a]] {
            last.insert([i.min(j), i.max(j)], place);
        }
    }
    let mut lines = vec![Vec::new(); order.len()];
    for (line, &[i, j]) in picture.lines.iter().enumerate() {
        if let Some(&place) = last.get(&[i.min(j), i.max(j)]) {
            lines[place].push(line);
        }
    }
    lines
}

/// The colour of a face: its side towards the eye, between dark and light.
fn shade(picture: &Picture, view: &View, face: usize) -> String {
    let [a, b, c] = picture.triangles[face].map(|point| picture.points[point]);
    let normal = (b - a).cross(&(c - a)).normalize();
    let front = normal.dot(&view.toward) >= 0.0;
    let side = match (picture.self_intersecting[face], front) {
        (1.., _) => &CROSSING,
        (0, true) => &FRONT,
        (0, false) => &BACK,
    };
    let facing = if front { normal } else { -normal };
    let lit = ((facing.dot(&light(view)) + 0.25) / 1.25).clamp(0.0, 1.0);
    let [red, green, blue] = [0, 1, 2].map(|i| (side.dark[i] + (side.light[i] - side.dark[i]) * lit).round() as u8);
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// How edges are drawn: widths in proportion to the sharpest fold, and to the size of the faces on the paper.
struct Pen {
    sharpest: f64,
    unit: f64,
}

impl Pen {
    fn new(picture: &Picture, frame: &Frame, sheet: &[[f64; 3]]) -> Self {
        let length =
            |&[a, b]: &[usize; 2]| (0..2).map(|x| sheet[a][x] - sheet[b][x]).map(|d| d * d).sum::<f64>().sqrt();
        let lengths = picture.lines.iter().map(length).filter(|length| length.is_finite());
        let mean = lengths.sum::<f64>() / picture.lines.len().max(1) as f64;
        Self { sharpest: sharpest(picture), unit: (0.022 * mean * frame.scale).clamp(0.25, 2.0) }
    }

    fn style(&self, picture: &Picture, line: usize) -> String {
        let angle = picture.fold_angle[line];
        let solid = |colour: &str, width: f64| format!("stroke=\"{colour}\" stroke-width=\"{:.2}\"", width * self.unit);
        match picture.line_kinds[line] {
            EdgeKind::Boundary => solid(INK, 1.0),
            EdgeKind::Facet => {
                let dash = 3.0 * self.unit;
                format!("{} stroke-dasharray=\"{dash:.1} {dash:.1}\" stroke-opacity=\".55\"", solid(FACET, 0.45))
            }
            EdgeKind::Crease if angle.abs() > FLAT => {
                let colour = if angle < 0.0 { MOUNTAIN } else { VALLEY };
                solid(colour, 0.5 + 1.3 * (angle.abs() / self.sharpest).min(1.0))
            }
            EdgeKind::Crease => solid(FACET, 0.5),
        }
    }
}

/// The largest fold angle of a crease in magnitude.
fn sharpest(picture: &Picture) -> f64 {
    let [mountain, valley] = fold_range(picture);
    valley.max(-mountain)
}

/// Sharpest mountain and sharpest valley; 0 where there is none.
fn fold_range(picture: &Picture) -> [f64; 2] {
    let creases = picture.line_kinds.iter().zip(&picture.fold_angle).filter(|(kind, _)| **kind == EdgeKind::Crease);
    let angles = creases.map(|(_, &angle)| angle).filter(|angle| angle.is_finite());
    angles.fold([0.0, 0.0], |[low, high], angle| [f64::min(low, angle), f64::max(high, angle)])
}

/// The scale of fold angles: from the sharpest mountain over flat to the sharpest valley, as wide as the lines.
fn legend(text: &mut String, picture: &Picture, frame: &Frame) {
    let (middle, level) = (WIDTH / 2.0, frame.height + LEGEND / 2.0 - 14.0);
    let sharpest = sharpest(picture);
    let [mountain, valley] = fold_range(picture);
    for (angle, colour, word, side) in [(mountain, MOUNTAIN, "mountain", -1.0), (valley, VALLEY, "valley", 1.0)] {
        if angle.abs() <= FLAT {
            continue;
        }
        let share = angle.abs() / sharpest;
        let (end, thick) = (middle + side * 170.0 * share, 0.8 + 3.7 * share);
        put!(text, "<path fill=\"{colour}\" d=\"M{middle:.0} {:.1}V{:.1}", level - 0.8, level + 0.8);
        put!(text, "L{end:.1} {:.1}V{:.1}Z\"/>\n", level + thick, level - thick);
        let anchor = if side < 0.0 { "end" } else { "start" };
        put!(text, "<text x=\"{:.0}\" y=\"{:.0}\" text-anchor=\"{anchor}\">", end + side * 14.0, level + 6.5);
        put!(text, "{word} {}{:.2} rad</text>\n", if side < 0.0 { '\u{2212}' } else { '+' }, angle.abs());
    }
}

#[cfg(test)]
mod tests {
    use super::super::picture::samples;
    use super::*;

    fn paths(text: &str) -> Vec<&str> {
        text.lines().filter(|line| line.starts_with("<path")).collect()
    }

    /// A shadow, each face and edge once, and one wedge of the legend.
    #[test]
    fn everything_is_drawn_once() {
        let text = svg(&samples::hinge(0.8), "a & b < c");
        assert!(text.contains("<title>a &amp; b &lt; c</title>"));
        assert_eq!(paths(&text).len(), 1 + 2 + 5 + 1);
        assert_eq!(text, svg(&samples::hinge(0.8), "a & b < c"));
    }

    /// Valleys are blue and mountains red, on the sheet and in the legend; the legend gives the angle.
    #[test]
    fn the_sign_of_a_fold_is_its_colour() {
        let valley = svg(&samples::hinge(0.8), "");
        assert!(valley.contains(VALLEY) && !valley.contains(MOUNTAIN) && valley.contains("valley +0.80 rad"));
        let mountain = svg(&samples::hinge(-0.8), "");
        assert!(mountain.contains(MOUNTAIN) && !mountain.contains(VALLEY));
        assert!(mountain.contains("mountain \u{2212}0.80 rad"));
        let flat = svg(&samples::hinge(0.0), "");
        assert!(!flat.contains(MOUNTAIN) && !flat.contains(VALLEY));
    }

    /// The face nearer to the eye is painted later, and the crease between the two faces after both.
    #[test]
    fn near_faces_cover_far_ones() {
        let mut picture = samples::hinge(1.0);
        picture.self_intersecting = vec![0, 0];
        let view = View::of(&picture.points, &picture.triangles);
        let depth =
            |face: usize| picture.triangles[face].map(|p| picture.points[p].dot(&view.toward)).iter().sum::<f64>();
        let near = if depth(0) > depth(1) { 0 } else { 1 };
        let text = svg(&picture, "");
        let drawn = paths(&text);
        let place = |face: usize| {
            let colour = format!("fill=\"{}\"", shade(&picture, &view, face));
            drawn.iter().position(|path| path.contains(&colour)).unwrap()
        };
        let crease = drawn.iter().position(|path| path.contains(VALLEY)).unwrap();
        assert!(place(1 - near) < place(near) && place(near) < crease, "{text}");
    }

    /// Points that are not finite leave their faces out and spoil nothing else.
    #[test]
    fn states_that_are_not_finite() {
        let mut picture = samples::hinge(0.8);
        picture.points[3].x = f64::NAN;
        let text = svg(&picture, "");
        assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
        assert_eq!(paths(&text).len(), 1 + 1 + 3 + 1);
        picture.points = vec![Vec3::repeat(f64::INFINITY); 4];
        for picture in [picture, Picture::default()] {
            let text = svg(&picture, "");
            assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
        }
    }
}
