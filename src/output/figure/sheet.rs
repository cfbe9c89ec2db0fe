//! Figure of a state of a sheet: an oblique view with shaded faces, creases coloured by their fold angles, and a scale
//! bar.
//!
//! Mountains (negative fold angles) are red and valleys blue; the line width increases with the fold angle. Every face
//! has an outline in the colour of its filling, because otherwise thin gaps would show between faces.

use super::annotations::{self, Annotations};
use super::axes::{number, round_step};
use super::canvas::{Canvas, Caption, HEAD, MARGIN, WIDTH};
use super::hidden::{Piece, back_to_front};
use super::palette::{Colour, GREY, INK, MOUNTAIN, SHADOW, VALLEY};
use super::projection::Projection;
use super::style::{Font, PaperPoint, Style};
use crate::math::{Vec3, bounds};
use crate::output::Picture;
use crate::output::error::ShapeError;
use crate::sheet::{Assignment, EdgeKind};
use std::f64::consts::{PI, TAU};

/// Margin around the sheet, and height of the legend below it.
pub(super) const ROOM: f64 = 60.0;
const LEGEND: f64 = 64.0;
/// Width of the outlines by which faces meet without gaps.
pub(crate) const TILE: f64 = 0.7;
/// Fold angle in radians below which a crease is drawn as flat.
const FLAT: f64 = 1e-6;
/// Length of the longest wedge of the legend.
const WEDGE: f64 = 150.0;

/// Colours of one side of the sheet in full light and away from the light.
pub(crate) struct SideColours {
    pub light: Colour,
    dark: Colour,
}

pub(crate) const FRONT: SideColours = SideColours { light: Colour(255, 251, 240), dark: Colour(124, 136, 164) };
pub(crate) const BACK: SideColours = SideColours { light: Colour(240, 214, 168), dark: Colour(150, 118, 92) };
pub(crate) const CROSSING: SideColours = SideColours { light: Colour(246, 154, 138), dark: Colour(158, 72, 66) };

/// Returns the figure of a state, with annotations.
///
/// # Errors
/// The first inconsistent array or index of the picture.
pub fn svg(picture: &Picture, added: &Annotations, caption: &Caption) -> Result<String, ShapeError> {
    picture.check()?;
    ShapeError::check([], added.loads.iter().map(|(point, _)| point), picture.points.len())?;
    Ok(drawn(picture, added, caption).finish())
}

fn drawn(picture: &Picture, added: &Annotations, caption: &Caption) -> Canvas {
    let view = Projection::of(&picture.points, &picture.triangles);
    let place = |point: &Vec3| Vec3::from(view.place(point));
    let sheet: Vec<Vec3> = picture.points.iter().map(place).collect();
    let shadow: Vec<Vec3> = shadow_on_floor(picture, &view).iter().map(place).collect();
    let arrows: Vec<[Vec3; 2]> = added.arrows(&picture.points).iter().map(|ends| ends.map(|end| place(&end))).collect();
    let frame = FigureFrame::around(sheet.iter().chain(&shadow).chain(arrows.iter().flatten()), HEAD);
    let mut canvas = Canvas::new(frame.height + LEGEND, caption);
    paint_shadow(&mut canvas, picture, &frame, &shadow);
    paint_sheet(&mut canvas, picture, &frame, &view, &sheet);
    scale_bar(&mut canvas, &frame);
    legend(&mut canvas, picture, &frame);
    for ends in &arrows {
        annotations::arrow(&mut canvas, ends.each_ref().map(|end| frame.on_paper(end)));
    }
    if added.largest() > 0.0 {
        annotations::key(&mut canvas, [MARGIN, frame.height + LEGEND / 2.0 + 12.0], added.largest());
    }
    if added.numbers {
        let numbers = picture.places.iter().map(|(vertex, _)| *vertex);
        annotations::vertex_numbers(&mut canvas, numbers.zip(sheet.iter().map(|place| frame.on_paper(place))));
    }
    canvas
}

/// The mapping from the plane of projection to the figure.
pub(super) struct FigureFrame {
    left: f64,
    top: f64,
    scale: f64,
    pub(super) height: f64,
    /// Whether there is any finite point.
    filled: bool,
}

impl FigureFrame {
    /// Fits the points into the width of the figure, and into a height of at most three quarters of the width, below a
    /// head of this height.
    pub(super) fn around<'a>(places: impl Iterator<Item = &'a Vec3>, head: f64) -> Self {
        let [low, high] = bounds(places.filter(|place| is_finite(place)));
        let extent = (high - low).map(|length| length.max(f64::MIN_POSITIVE));
        let room = WIDTH - 2.0 * ROOM;
        let scale = (room / extent.x).min(0.75 * room / extent.y).min(f64::MAX);
        let left = 0.5 * (low.x + high.x) - 0.5 * WIDTH / scale;
        let filled = low.x <= high.x;
        Self { left, top: high.y + head / scale, scale, height: extent.y * scale + head + ROOM, filled }
    }

    fn on_paper(&self, place: &Vec3) -> PaperPoint {
        [(place.x - self.left) * self.scale, (self.top - place.y) * self.scale]
    }
}

fn is_finite(place: &Vec3) -> bool {
    place.iter().all(|x| x.is_finite())
}

/// Returns the direction towards the light: from the upper left, a little in front of the sheet.
fn light(view: &Projection) -> Vec3 {
    (view.toward * 0.45 + view.up * 0.75 - view.right * 0.62).normalize()
}

/// Returns the points projected along the light onto a floor just below the sheet.
fn shadow_on_floor(picture: &Picture, view: &Projection) -> Vec<Vec3> {
    let light = light(view);
    let heights = picture.points.iter().map(|point| point.dot(&view.normal)).filter(|height| height.is_finite());
    let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), h| (low.min(h), high.max(h)));
    let floor = low - 0.15 * (high - low);
    let drop = |point: &Vec3| point - light * ((point.dot(&view.normal) - floor) / light.dot(&view.normal));
    picture.points.iter().map(drop).collect()
}

fn paint_shadow(canvas: &mut Canvas, picture: &Picture, frame: &FigureFrame, shadow: &[Vec3]) {
    let finite = picture.triangles.iter().filter(|triangle| triangle.iter().all(|&point| is_finite(&shadow[point])));
    let alike = |triangle: &[usize; 3]| {
        let [a, b, c] = triangle.map(|point| frame.on_paper(&shadow[point]));
        // all triangles get the same orientation, so that overlaps are filled
        let turn = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if turn < 0.0 { [a, c, b] } else { [a, b, c] }
    };
    canvas.shadow(&finite.map(alike).collect::<Vec<_>>(), SHADOW);
}

fn paint_sheet(canvas: &mut Canvas, picture: &Picture, frame: &FigureFrame, view: &Projection, sheet: &[Vec3]) {
    canvas.group(TILE);
    for FigureShape { places, closed, style } in shapes(picture, frame, view, &Pen::new(picture, frame, sheet), sheet) {
        if closed { canvas.polygon(&places, style) } else { canvas.line(&places, style) }
    }
    canvas.end();
}

/// A polygon or a line of a figure.
pub(crate) struct FigureShape {
    /// Its corners.
    pub places: Vec<PaperPoint>,
    /// Whether it is a polygon.
    pub closed: bool,
    /// Its style.
    pub style: Style,
}

/// Returns the faces and edges of a state from back to front; `sheet` are its points as the projection places them.
pub(super) fn shapes(
    picture: &Picture,
    frame: &FigureFrame,
    view: &Projection,
    pen: &Pen,
    sheet: &[Vec3],
) -> Vec<FigureShape> {
    let corners = |points: &[usize]| points.iter().map(|&point| sheet[point]).collect();
    let faces = picture.triangles.iter().map(|triangle| corners(triangle));
    let lines = picture.lines.iter().map(|line| corners(line));
    let pieces = faces.chain(lines).enumerate().map(|(item, corners)| Piece::new(corners, item));
    let shape = |Piece { corners, item, .. }: &Piece| {
        let line = item.checked_sub(picture.triangles.len());
        FigureShape {
            places: corners.iter().map(|corner| frame.on_paper(corner)).collect(),
            closed: line.is_none(),
            style: line.map_or_else(|| Style::tile(shade(picture, view, *item)), |line| pen.style(picture, line)),
        }
    };
    back_to_front(pieces.collect()).iter().map(shape).collect()
}

/// Returns the colour of a face: that of its visible side, between dark and light.
fn shade(picture: &Picture, view: &Projection, face: usize) -> Colour {
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
    side.dark.towards(side.light, lit)
}

/// The style of edges: line widths increase with the fold angle relative to the largest one, and scale with the size of
/// the faces in the figure.
pub(super) struct Pen {
    pub(super) sharpest: f64,
    pub(super) unit: f64,
}

impl Pen {
    pub(super) fn new(picture: &Picture, frame: &FigureFrame, sheet: &[Vec3]) -> Self {
        let length = |&[a, b]: &[usize; 2]| (sheet[a] - sheet[b]).xy().norm();
        let lengths = picture.lines.iter().map(length).filter(|length| length.is_finite());
        let mean = lengths.sum::<f64>() / picture.lines.len().max(1) as f64;
        let [mountain, valley] = fold_range(picture);
        Self { sharpest: valley.max(-mountain), unit: (0.022 * mean * frame.scale).clamp(0.25, 2.0) }
    }

    fn style(&self, picture: &Picture, line: usize) -> Style {
        let angle = picture.fold_angle[line];
        let solid = |colour: Colour, width: f64| Style::line(colour, width * self.unit);
        match picture.line_kinds[line] {
            EdgeKind::Boundary => solid(INK, 1.0),
            EdgeKind::Facet => solid(GREY, 0.45).dashed(3.0 * self.unit, 3.0 * self.unit).opacity(0.55),
            EdgeKind::Crease if angle.abs() > FLAT => {
                let colour = if angle < 0.0 { MOUNTAIN } else { VALLEY };
                solid(colour, 0.5 + 1.3 * (angle.abs() / self.sharpest).min(1.0))
            }
            EdgeKind::Crease => solid(letter_colour(picture.letters[line]), 0.6),
        }
    }
}

/// Returns the colour of a crease that is still flat: the one it will have by its letter.
fn letter_colour(letter: Assignment) -> Colour {
    match letter {
        Assignment::Mountain => MOUNTAIN,
        Assignment::Valley => VALLEY,
        _ => GREY,
    }
}

/// Returns what a fold angle beyond pi means: the faces beside the crease have passed through each other.
fn turns(angle: f64) -> &'static str {
    match angle.abs() - FLAT {
        ..=PI => "",
        ..=TAU => "more than half a turn",
        _ => "more than a turn",
    }
}

/// Returns the fold angles of the sharpest mountain and the sharpest valley; 0 if there is none.
fn fold_range(picture: &Picture) -> [f64; 2] {
    let creases = picture.line_kinds.iter().zip(&picture.fold_angle).filter(|(kind, _)| **kind == EdgeKind::Crease);
    let angles = creases.map(|(_, &angle)| angle).filter(|angle| angle.is_finite());
    angles.fold([0.0, 0.0], |[low, high], angle| [f64::min(low, angle), f64::max(high, angle)])
}

/// Draws a bar of a round length. In a parallel projection, lines parallel to the paper have this scale everywhere.
fn scale_bar(canvas: &mut Canvas, frame: &FigureFrame) {
    if !frame.filled {
        return;
    }
    let length = round_step(0.7 * WIDTH / frame.scale);
    let (level, right) = (frame.height + LEGEND / 2.0 - 14.0, MARGIN + length * frame.scale);
    let ends = [[MARGIN, level - 6.0], [MARGIN, level + 6.0], [MARGIN, level], [right, level]];
    canvas.line(&ends, Style::line(INK, 1.6));
    canvas.line(&[[right, level - 6.0], [right, level + 6.0]], Style::line(INK, 1.6));
    canvas.text([right + 12.0, level + 6.5], &number(length, length), Font::LABEL);
}

/// Draws the scale of fold angles, from the sharpest mountain to the sharpest valley, as wedges; of a flat sheet, what
/// the colours of its letters mean.
fn legend(canvas: &mut Canvas, picture: &Picture, frame: &FigureFrame) {
    let [mountain, valley] = fold_range(picture);
    let sharpest = valley.max(-mountain);
    let level = frame.height + LEGEND / 2.0 - 14.0;
    let mut sides = vec![(mountain, MOUNTAIN, "mountain", '\u{2212}'), (valley, VALLEY, "valley", '+')];
    sides.retain(|(angle, ..)| angle.abs() > FLAT);
    if sides.is_empty() {
        letters(canvas, picture, level);
    }
    let words = |angle: f64, word: &str, sign: char| format!("{word} {sign}{:.2} rad", angle.abs());
    let width = |&(angle, _, word, sign): &(f64, Colour, &str, char)| {
        let text = Font::LABEL.width(&words(angle, word, sign)).max(Font::LABEL.width(turns(angle)));
        WEDGE * angle.abs() / sharpest + 14.0 + text
    };
    // the legend with its text ends at the right margin
    let after = sides.last().filter(|(angle, ..)| *angle > 0.0).map_or(0.0, width);
    let zero = WIDTH - MARGIN - after;
    for (angle, colour, word, sign) in sides {
        let share = angle / sharpest;
        let (end, thick) = (zero + WEDGE * share, 0.8 + 3.7 * share.abs());
        let wedge = [[zero, level - 0.8], [zero, level + 0.8], [end, level + thick], [end, level - thick]];
        canvas.polygon(&wedge, Style::area(colour));
        let font = if angle < 0.0 { Font::LABEL.end() } else { Font::LABEL };
        let beside = end + 14.0 * angle.signum();
        canvas.text([beside, level + 6.5], &words(angle, word, sign), font);
        if !turns(angle).is_empty() {
            canvas.text([beside, level + 29.5], turns(angle), font);
        }
    }
}

/// Draws a line and a word for each letter of creases that has a colour, at the right margin.
fn letters(canvas: &mut Canvas, picture: &Picture, level: f64) {
    let mut right = WIDTH - MARGIN;
    for (letter, word) in [(Assignment::Valley, "valley (V)"), (Assignment::Mountain, "mountain (M)")] {
        let lettered = picture.line_kinds.iter().zip(&picture.letters);
        if lettered.into_iter().any(|crease| crease == (&EdgeKind::Crease, &letter)) {
            canvas.text([right, level + 6.5], word, Font::LABEL.end());
            right -= Font::LABEL.width(word) + 12.0;
            canvas.line(&[[right - 38.0, level], [right, level]], Style::line(letter_colour(letter), 2.4));
            right -= 68.0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::test_samples as samples;

    fn caption(title: &str) -> Caption {
        Caption { title: title.into(), state: "relaxed".into() }
    }

    fn drawing(picture: &Picture) -> String {
        svg(picture, &Annotations::default(), &caption("")).unwrap()
    }

    fn paths(text: &str) -> Vec<&str> {
        text.lines().filter(|line| line.starts_with("<path")).collect()
    }

    /// Claim: the figure has a shadow, each face and edge once, two parts of the scale bar and one wedge of the legend;
    /// title and state are in the caption; equal pictures give equal bytes.
    #[test]
    fn everything_is_drawn_once() {
        let text = svg(&samples::hinge(0.8), &Annotations::default(), &caption("a & b < c")).unwrap();
        assert!(text.contains("<title>a &amp; b &lt; c</title>") && text.contains(">relaxed<"));
        assert_eq!(paths(&text).len(), 1 + 2 + 5 + 2 + 1);
        assert_eq!(text, svg(&samples::hinge(0.8), &Annotations::default(), &caption("a & b < c")).unwrap());
        assert_eq!(drawn(&samples::hinge(0.8), &Annotations::default(), &caption("a")).crowded(), 0);
    }

    /// Claim: valleys (positive fold angles) are blue and mountains red, on the sheet and in the legend, which gives
    /// the angle, and says where it is beyond pi or 2 pi; a flat crease has the colour of its letter.
    #[test]
    fn the_sign_of_a_fold_is_its_colour() {
        let [mountain_red, valley_blue] = [MOUNTAIN, VALLEY].map(|colour| colour.to_string());
        let valley = drawing(&samples::hinge(0.8));
        assert!(
            valley.contains(&valley_blue) && !valley.contains(&mountain_red) && valley.contains("valley +0.80 rad")
        );
        let mountain = drawing(&samples::hinge(-0.8));
        assert!(mountain.contains(&mountain_red) && !mountain.contains(&valley_blue));
        assert!(mountain.contains("mountain \u{2212}0.80 rad"));
        let flat = samples::hinge(0.0);
        let lettered = |letter: Assignment| {
            let letters = flat.letters.iter().map(|kept| if *kept == Assignment::Valley { letter } else { *kept });
            let text = drawing(&Picture { letters: letters.collect(), ..flat.clone() });
            ["valley (V)", "mountain (M)", &valley_blue, &mountain_red].map(|words| text.contains(words))
        };
        assert_eq!(lettered(Assignment::Valley), [true, false, true, false]);
        assert_eq!(lettered(Assignment::Mountain), [false, true, false, true]);
        assert_eq!(lettered(Assignment::Unassigned), [false; 4]);
        for (angle, side, turns) in [
            (4.0, "valley +4.00 rad", "more than half a turn"),
            (-7.0, "mountain \u{2212}7.00 rad", "more than a turn"),
            (3.0, "valley +3.00 rad", ""),
        ] {
            let text = drawing(&samples::hinge(angle));
            let said = ["more than half a turn", "more than a turn"].map(|words| text.contains(&format!(">{words}<")));
            assert!(text.contains(&format!(">{side}<")), "{angle}");
            assert_eq!(said, ["more than half a turn", "more than a turn"].map(|words| words == turns), "{angle}");
        }
    }

    /// Claim: the face nearer to the eye is painted later, and the crease between the two faces after both.
    #[test]
    fn near_faces_cover_far_ones() {
        let mut picture = samples::hinge(2.5);
        picture.self_intersecting = vec![0, 0];
        let view = Projection::of(&picture.points, &picture.triangles);
        let depth =
            |face: usize| picture.triangles[face].map(|p| picture.points[p].dot(&view.toward)).iter().sum::<f64>();
        let near = if depth(0) > depth(1) { 0 } else { 1 };
        let text = drawing(&picture);
        let drawn = paths(&text);
        let place = |face: usize| {
            let colour = format!("fill=\"{}\"", shade(&picture, &view, face));
            drawn.iter().position(|path| path.contains(&colour)).unwrap()
        };
        let crease = drawn.iter().position(|path| path.contains(&VALLEY.to_string())).unwrap();
        assert!(place(1 - near) < place(near) && place(near) < crease, "{text}");
    }

    /// Claim: the scale bar is as long as an edge of this length parallel to the paper.
    #[test]
    fn scale() {
        let places = [Vec3::zeros(), Vec3::new(8.0, 4.0, 0.0)];
        let frame = FigureFrame::around(places.iter(), HEAD);
        let mut canvas = Canvas::new(100.0, &Caption::default());
        scale_bar(&mut canvas, &frame);
        let [a, b] = places.map(|place| frame.on_paper(&place));
        assert!(((b[0] - a[0]) / 8.0 - frame.scale).abs() <= 1e-9);
        let text = canvas.finish();
        assert!(text.contains(">2<") && text.contains(&format!("{:.0} ", MARGIN + 2.0 * frame.scale)), "{text}");
    }

    /// Claim: faces with points that are not finite are left out, and the rest is drawn; inconsistent arrays are
    /// refused.
    #[test]
    fn states_that_are_not_finite() {
        let mut picture = samples::hinge(0.8);
        picture.points[3].x = f64::NAN;
        let text = drawing(&picture);
        assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
        assert_eq!(paths(&text).len(), 1 + 1 + 3 + 2 + 1);
        picture.points = vec![Vec3::repeat(f64::INFINITY); 4];
        for picture in [&picture, &Picture::default()] {
            let text = drawing(picture);
            assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
        }
        picture.strain.pop();
        assert!(svg(&picture, &Annotations::default(), &caption("")).is_err());
    }
}
