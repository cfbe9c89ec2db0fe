//! DXF drawings of CAD programs and laser cutters: lines, polylines, arcs, ellipses and splines as text.
//!
//! A layer whose name says what its lines are gives their letters, as the layers `MountainLine`, `ValleyLine`,
//! `CutLine` and `AuxiliaryLine` of ORIPA and Oriedita do; other layers have the letters of their colours, which are
//! those of SVG drawings. A contour is a boundary where one face is, and a cut between two faces. y points upwards.
//!
//! Numbers of the parts of entities are those of Autodesk, "DXF Reference", 2012.

use std::collections::{HashMap, HashSet};
use std::f64::consts::TAU;

use kurbo::{Affine, Arc, BezPath, Circle, Point, Shape, Vec2};

use super::bspline::BSpline;
use super::colour;
use super::cp::number;
use super::dxf_entity::{Entity, FLAT, LAYER, LEVEL, entities};
use super::line::{DrawnLines, Lines, PatternLine};
use super::outline::{self, Outline};
use crate::sheet::assignment::Assignment;
use crate::sheet::pattern_fault::PatternFault;
use crate::sheet::text::line_and_column;

/// Parts of names of layers in small letters, and what the lines of such a layer are; `None` for auxiliary lines. The
/// first part that is found counts.
const LAYERS: [(&str, Option<Assignment>); 14] = [
    ("mountain", Some(Assignment::Mountain)),
    ("valley", Some(Assignment::Valley)),
    ("auxiliary", None),
    ("construction", None),
    ("facet", Some(Assignment::Flat)),
    ("flat", Some(Assignment::Flat)),
    ("hinge", Some(Assignment::Unassigned)),
    ("unassigned", Some(Assignment::Unassigned)),
    ("joint", Some(Assignment::Join)),
    ("cut", Some(Assignment::Boundary)),
    ("border", Some(Assignment::Boundary)),
    ("boundary", Some(Assignment::Boundary)),
    ("contour", Some(Assignment::Boundary)),
    ("outline", Some(Assignment::Boundary)),
];

/// Entities that draw nothing to fold along.
const IGNORED: [&str; 9] = ["ATTDEF", "ATTRIB", "DIMENSION", "HATCH", "LEADER", "MTEXT", "POINT", "TEXT", "VIEWPORT"];

/// Numbers of the parts of an entity, as the DXF reference gives them.
const COLOUR: i32 = 62;
const TRUE_COLOUR: i32 = 420;
const BULGE: i32 = 42;
const RADIUS: i32 = 40;
const ANGLES: [i32; 2] = [50, 51];
const PARAMETERS: [i32; 2] = [41, 42];
const DEGREE: i32 = 71;
const KNOT: i32 = 40;
const WEIGHT: i32 = 41;
const FIRST: [i32; 2] = [10, 20];
const SECOND: [i32; 2] = [11, 21];
const HEIGHT: i32 = 30;
/// Flag of a polyline that is closed.
const CLOSED: u32 = 1;
/// Flag of a layer that is frozen, and of a corner that only shapes the curve through others.
const FROZEN: u32 = 1;
const OF_FRAME: u32 = 16;

/// Largest distance of the cubic curves of an arc from it, relative to its radius.
const ROUND: f64 = 1e-6;

/// Reads the lines of a text.
pub(super) fn lines(text: &str) -> Lines {
    let entities = entities(text)?;
    let mut layers: HashMap<String, &Entity> = HashMap::new();
    let mut hidden: HashSet<String> = HashSet::new();
    let mut outlines: Vec<Outline> = Vec::new();
    let mut grey = 0;
    let (mut section, mut open) = ("", None);
    for entity in &entities {
        let located = |fault: PatternFault| (line_and_column(text, entity.at), fault.into());
        match (entity.name, section) {
            ("SECTION", _) => section = entity.first(2).unwrap_or_default(),
            ("ENDSEC", _) => section = "",
            ("LAYER", "TABLES") => {
                let name = entity.first(2).unwrap_or_default().to_lowercase();
                if entity.has_flag(FROZEN) || entity.first(COLOUR).is_some_and(|colour| colour.starts_with('-')) {
                    hidden.insert(name.clone());
                }
                layers.insert(name, entity);
            }
            ("VERTEX", "ENTITIES") if entity.has_flag(OF_FRAME) => {}
            ("VERTEX", "ENTITIES") => {
                let corner = entity.corners().map_err(located)?;
                open.iter_mut().for_each(|polyline: &mut Polyline| polyline.corners.extend(corner.iter()));
            }
            ("SEQEND", "ENTITIES") => outlines.extend(open.take().map(Polyline::outline).transpose().map_err(located)?),
            (_, "ENTITIES") if entity.is_hidden(&hidden) => {}
            (name, "ENTITIES") if !IGNORED.contains(&name) => {
                let (line, named) = entity.meaning(&layers).map_err(located)?;
                grey += usize::from(line.auxiliary && !named);
                let placed = entity.placed().map_err(located)?;
                if name == "POLYLINE" {
                    open = Some(Polyline { corners: vec![], closed: entity.has_flag(CLOSED), placed, line, named });
                } else {
                    outlines.push(Outline { path: placed * entity.outline().map_err(located)?, line, named });
                }
            }
            _ => {}
        }
    }
    let mut drawn = DrawnLines::default();
    drawn.redrawing.grey = grey;
    outline::draw(&outlines, &mut drawn);
    Ok(drawn)
}

/// A corner, the bulge of the side that begins there, and its height z.
type Corner = (Point, f64, f64);

/// A polyline whose corners follow as entities of their own.
struct Polyline {
    corners: Vec<Corner>,
    closed: bool,
    placed: Affine,
    line: PatternLine,
    named: bool,
}

impl Polyline {
    fn outline(self) -> Result<Outline, PatternFault> {
        let path = self.placed * polyline(&self.corners, self.closed)?;
        Ok(Outline { path, line: self.line, named: self.named })
    }
}

impl Entity<'_> {
    /// Returns the map from the plane in which the entity lies to the drawing.
    fn placed(&self) -> Result<Affine, PatternFault> {
        let [across, z] = self.normal()?;
        if across > LEVEL * z.abs() && !["LINE", "SPLINE"].contains(&self.name) {
            return Err(tilted(format!("a {} in a plane that is tilted", self.name)));
        }
        // x is the other way where the normal points away from who looks
        let turned = FLAT.contains(&self.name) && z < 0.0;
        Ok(if turned { Affine::FLIP_X } else { Affine::IDENTITY })
    }

    /// Returns the corners of a polyline, each with the bulge of the side that begins there: the tangent of a quarter
    /// of the angle of its arc, 0 for a straight side.
    fn corners(&self) -> Result<Vec<Corner>, PatternFault> {
        let mut corners: Vec<Corner> = Vec::new();
        for (code, part) in &self.parts {
            match (*code, corners.last_mut()) {
                (10, _) => corners.push((Point::new(number(part)?, 0.0), 0.0, 0.0)),
                (20, Some(corner)) => corner.0.y = number(part)?,
                (BULGE, Some(corner)) => corner.1 = number(part)?,
                (HEIGHT, Some(corner)) => corner.2 = number(part)?,
                _ => {}
            }
        }
        Ok(corners)
    }

    fn outline(&self) -> Result<BezPath, PatternFault> {
        match self.name {
            "LINE" => {
                let [low, high] = [self.number(HEIGHT)?, self.number(HEIGHT + 1)?];
                polyline(&[(self.point(FIRST)?, 0.0, low), (self.point(SECOND)?, 0.0, high)], false)
            }
            "LWPOLYLINE" => polyline(&self.corners()?, self.has_flag(CLOSED)),
            "CIRCLE" => {
                let radius = self.number(RADIUS)?;
                Ok(Circle::new(self.point(FIRST)?, radius).to_path(ROUND * radius.abs()))
            }
            "ARC" => {
                let (radius, [from, to]) = (self.number(RADIUS)?, [self.number(ANGLES[0])?, self.number(ANGLES[1])?]);
                let sweep = (to - from).rem_euclid(360.0).to_radians();
                let arc = Arc::new(self.point(FIRST)?, (radius, radius), from.to_radians(), sweep, 0.0);
                Ok(arc.to_path(ROUND * radius.abs()))
            }
            "ELLIPSE" => self.ellipse(),
            "SPLINE" => self.spline(),
            name => {
                let right = "LINE, LWPOLYLINE, POLYLINE, ARC, CIRCLE, ELLIPSE and SPLINE are read; explode blocks";
                Err(PatternFault::Element { element: format!("an entity `{name}`"), right })
            }
        }
    }

    /// Returns an arc of an ellipse; its parameters count from the end of the long half axis.
    fn ellipse(&self) -> Result<BezPath, PatternFault> {
        let long = self.point(SECOND)?.to_vec2();
        let [from, to] = [self.number(PARAMETERS[0])?, self.number(PARAMETERS[1])?];
        let sweep = (to - from).rem_euclid(TAU);
        // seen from below, the short half axis and the parameters go the other way round
        let side = if self.normal()?[1] < 0.0 { -1.0 } else { 1.0 };
        let radii = (long.hypot(), self.number(RADIUS)? * long.hypot());
        // a whole ellipse goes from 0 to 2 pi, whose remainder may be a rounding error
        let sweep = if sweep < ROUND { TAU } else { sweep };
        Ok(Arc::new(self.point(FIRST)?, radii, side * from, side * sweep, long.atan2()).to_path(ROUND * long.hypot()))
    }

    /// Returns the curve of control points, which have no weights or equal ones.
    fn spline(&self) -> Result<BezPath, PatternFault> {
        let all = |code: i32| -> Result<Vec<f64>, PatternFault> {
            self.parts.iter().filter(|(known, _)| *known == code).map(|(_, part)| number(part)).collect()
        };
        let weights = all(WEIGHT)?;
        let control = level(&self.corners()?)?.iter().map(|(point, ..)| *point).collect();
        let spline = BSpline::new(self.number(DEGREE)? as usize, all(KNOT)?, control);
        match spline.filter(|_| weights.iter().all(|weight| *weight == weights[0])) {
            Some(spline) => Ok(spline.path()),
            None => Err(PatternFault::Element {
                element: "this SPLINE".into(),
                right: "splines of degree 1 to 3 with control points and equal weights are read; explode others",
            }),
        }
    }

    /// Returns the line that this entity draws, without its ends, and whether the name of its layer says its letter.
    fn meaning(&self, layers: &HashMap<String, &Entity>) -> Result<(PatternLine, bool), PatternFault> {
        let layer = self.first(LAYER).unwrap_or_default().to_lowercase();
        let known = LAYERS.iter().find(|(part, _)| layer.contains(part)).map(|(_, letter)| *letter);
        let letter = match known {
            Some(letter) => letter,
            None => {
                // what has no colour of its own has that of its layer, and white, which is drawn on black, is black
                let of_layer = layers.get(&layer).map_or(Ok(None), |layer| layer.colour())?;
                let rgb = self.colour()?.or(of_layer).filter(|rgb| *rgb != [255; 3]).unwrap_or_default();
                let name = || format!("{} of layer {layer}", self.first(COLOUR).unwrap_or("256"));
                match colour::letter(rgb) {
                    None if !colour::is_grey(rgb) => {
                        return Err(PatternFault::value(&name(), "colour of a line", colour::RIGHT));
                    }
                    letter => letter,
                }
            }
        };
        let auxiliary = letter.is_none();
        let letter = letter.unwrap_or(Assignment::Flat);
        let angle = letter.flat_folded_angle().map(f64::to_degrees).or((letter == Assignment::Flat).then_some(0.0));
        let (contour, ends) = (letter == Assignment::Boundary, Default::default());
        Ok((PatternLine { ends, letter, angle, auxiliary, contour, at: self.at, flipped: false }, known.is_some()))
    }

    /// Returns the colour that this entity, or layer, says.
    fn colour(&self) -> Result<Option<[u8; 3]>, PatternFault> {
        if let Some(text) = self.first(TRUE_COLOUR) {
            let [_, red, green, blue] = (number(text)? as u32).to_be_bytes();
            return Ok(Some([red, green, blue]));
        }
        let index = self.first(COLOUR).filter(|index| *index != "256").map(number).transpose()?;
        Ok(index.map(|index| rgb(if index.abs() < 256.0 { index.abs() as u8 } else { 7 })))
    }
}

/// Returns the colour of a number of AutoCAD's index of colours.
fn rgb(index: u8) -> [u8; 3] {
    match index {
        0 | 7 | 255 => [255; 3],
        1 => [255, 0, 0],
        2 => [255, 255, 0],
        3 => [0, 255, 0],
        4 => [0, 255, 255],
        5 => [0, 0, 255],
        6 => [255, 0, 255],
        8 => [128; 3],
        9 => [192; 3],
        250..=254 => [51 + 40 * (index - 250); 3],
        10..=249 => {
            // ten shades of each of 24 hues
            let hue = f64::from(index / 10 - 1) / 4.0;
            let channel = |shift: f64| {
                let k = (shift + hue).rem_euclid(6.0);
                (255.0 * (1.0 - k.min(4.0 - k).clamp(0.0, 1.0))) as u8
            };
            [channel(5.0), channel(3.0), channel(1.0)]
        }
    }
}

/// Returns corners if all have one height.
fn level(corners: &[Corner]) -> Result<&[Corner], PatternFault> {
    let sloping = |[a, b]: &[Corner; 2]| (b.2 - a.2).abs() > LEVEL * (b.0 - a.0).hypot();
    match corners.array_windows().find(|side| sloping(side)) {
        Some([a, b]) => Err(tilted(format!("a line from the height z = {} to {}", a.2, b.2))),
        None => Ok(corners),
    }
}

fn tilted(element: String) -> PatternFault {
    PatternFault::Element { element, right: "draw all of it in one plane, of x and y, of x and z or of y and z" }
}

/// Returns the path along corners with the bulges of the sides that begin there.
fn polyline(corners: &[Corner], closed: bool) -> Result<BezPath, PatternFault> {
    let mut path = BezPath::new();
    let corners = level(corners)?;
    let next = corners.iter().skip(1).chain(corners.first().filter(|_| closed));
    for (k, (&(from, bulge, _), &(to, ..))) in corners.iter().zip(next).enumerate() {
        if k == 0 {
            path.move_to(from);
        }
        if bulge == 0.0 || !bulge.is_finite() {
            path.line_to(to);
            continue;
        }
        let chord = to - from;
        let centre = from.midpoint(to) + Vec2::new(-chord.y, chord.x) * ((1.0 - bulge * bulge) / (4.0 * bulge));
        let (spoke, sweep) = (from - centre, 4.0 * bulge.atan());
        let arc = Arc::new(centre, (spoke.hypot(), spoke.hypot()), spoke.atan2(), sweep, 0.0);
        path.extend(arc.append_iter(ROUND * spoke.hypot()));
    }
    Ok(path)
}
