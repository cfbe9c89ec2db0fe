//! The entities of a DXF file, seen from the side from which they are drawn.
//!
//! The file is pairs of lines, a number that says what follows and a value (Autodesk, "DXF Reference", 2012). A drawing lies
//! in the plane of x and y, or stands upright as in the front view and in the view from the right of CAD programs: then
//! coordinates are exchanged, so that it lies in the plane of x and y too.

use std::collections::HashSet;

use kurbo::Point;

use super::cp::number;
use super::line::{Misread, offset};
use crate::sheet::pattern_fault::PatternFault;

/// Numbers of the parts of an entity, as the DXF reference gives them.
pub(super) const LAYER: i32 = 8;
const FLAGS: i32 = 70;
/// Number that is 1 for entities that are not drawn, and for those of a page beside the drawing.
const INVISIBLE: i32 = 60;
const ON_PAGE: i32 = 67;
/// The entities that lie in a plane and have coordinates of their own there; others have those of the drawing.
pub(super) const FLAT: [&str; 4] = ["ARC", "CIRCLE", "LWPOLYLINE", "POLYLINE"];
/// The normal of that plane.
const NORMAL: [i32; 3] = [210, 220, 230];
/// Flags of a polyline, and of a corner of one, that has coordinates of the drawing.
const IN_SPACE: u32 = 8;
const CORNER_IN_SPACE: u32 = 32;
/// Largest slope of a line, or of the plane of a flat entity, that is taken for a rounding error.
pub(super) const LEVEL: f64 = 1e-4;

/// The views of a drawing from the top, the front and the right: which coordinates point to the right, up and to who looks
/// or, for `-1.0`, away.
const VIEWS: [([usize; 3], f64); 3] = [([0, 1, 2], 1.0), ([0, 2, 1], -1.0), ([1, 2, 0], 1.0)];

/// An entity or another thing that begins with the number 0: its name, the place of the name, its parts, and the sign of
/// the view from which they are seen.
pub(super) struct Entity<'t> {
    pub name: &'t str,
    pub at: usize,
    pub parts: Vec<(i32, &'t str)>,
    sign: f64,
}

/// Returns the entities of a text.
pub(super) fn entities(text: &str) -> Result<Vec<Entity<'_>>, Misread> {
    let syntax = |line: usize, message: &str| {
        ([line, 1], PatternFault::Syntax { format: "a DXF file of text", message: message.into() }.into())
    };
    if text.starts_with("AutoCAD Binary DXF") {
        return Err(syntax(1, "it is a binary one; save it as text (ASCII)"));
    }
    let mut entities: Vec<Entity> = Vec::new();
    let mut rows = text.lines().enumerate();
    while let Some((row, code)) = rows.next() {
        if code.trim().is_empty() && rows.clone().all(|(_, rest)| rest.trim().is_empty()) {
            break;
        }
        let Ok(code) = code.trim().parse() else {
            return Err(syntax(row + 1, "every second line should be a whole number, from the first on"));
        };
        let Some((_, part)) = rows.next() else { return Err(syntax(row + 1, "its last value is missing")) };
        let part = part.trim();
        match (code, entities.last_mut()) {
            (0, _) => entities.push(Entity { name: part, at: offset(text, part), parts: vec![], sign: 1.0 }),
            (_, Some(entity)) => entity.parts.push((code, part)),
            (_, None) => {}
        }
    }
    let view = view(&entities);
    entities.iter_mut().for_each(|entity| entity.turn(view));
    Ok(entities)
}

/// Returns the first view in which all that is drawn is seen from the front.
fn view(entities: &[Entity]) -> ([usize; 3], f64) {
    let is_drawn = |entity: &&Entity| entity.is_in_space() || FLAT.contains(&entity.name);
    let from = entities.iter().position(|entity| entity.name == "SECTION" && entity.first(2) == Some("ENTITIES"));
    let drawn: Vec<&Entity> = entities.iter().skip(from.unwrap_or(0)).filter(is_drawn).collect();
    let extents = [0, 1, 2].map(|axis| {
        let places = drawn.iter().filter(|entity| entity.is_in_space()).flat_map(|entity| entity.places(axis));
        let [low, high] = places.fold([f64::MAX, f64::MIN], |[low, high], x| [low.min(x), high.max(x)]);
        (high - low).max(0.0)
    });
    let largest = extents.into_iter().fold(0.0, f64::max);
    let is_seen = |axis: usize| {
        let mut flat = drawn.iter().filter(|entity| !entity.is_in_space());
        let normal = |entity: &Entity| NORMAL.map(|code| entity.number(code).unwrap_or(0.0));
        extents[axis] <= LEVEL * largest
            && flat.all(|entity| match normal(entity) {
                [0.0, 0.0, 0.0] => axis == 2,
                normal => (0..3).all(|other| other == axis || normal[other].abs() <= LEVEL * normal[axis].abs()),
            })
    };
    VIEWS.into_iter().find(|([.., axis], _)| is_seen(*axis)).unwrap_or(VIEWS[0])
}

impl<'t> Entity<'t> {
    /// Whether the entity has coordinates of the drawing.
    fn is_in_space(&self) -> bool {
        match self.name {
            "LINE" | "SPLINE" | "ELLIPSE" => true,
            "POLYLINE" => self.has_flag(IN_SPACE),
            "VERTEX" => self.has_flag(CORNER_IN_SPACE),
            _ => false,
        }
    }

    /// Returns the coordinates of the entity's points along an axis. The second point of an ellipse is a difference.
    fn places(&self, axis: usize) -> impl Iterator<Item = f64> {
        let first = 10 * (axis as i32 + 1);
        let codes = if self.name == "LINE" { first..first + 2 } else { first..first + 1 };
        let is_set = self.name != "POLYLINE";
        self.parts
            .iter()
            .filter(move |(code, _)| is_set && codes.contains(code))
            .filter_map(|(_, part)| number(part).ok())
    }

    /// Renumbers the parts that are coordinates so that x and y are those of a view.
    fn turn(&mut self, (axes, sign): ([usize; 3], f64)) {
        self.sign = sign;
        let (is_in_space, place) = (self.is_in_space(), |axis: i32| axes.iter().position(|seen| *seen as i32 == axis));
        for (code, _) in &mut self.parts {
            let (hundreds, axis, rest) = (*code / 200 * 200, *code % 200 / 10 - 1, *code % 10);
            let is_coordinate = if hundreds == 0 { is_in_space && rest < 4 } else { NORMAL.contains(code) };
            if let Some(place) = place(axis).filter(|_| is_coordinate) {
                *code = hundreds + 10 * (place as i32 + 1) + rest;
            }
        }
    }

    /// Returns the first part of this number.
    pub(super) fn first(&self, code: i32) -> Option<&'t str> {
        self.parts.iter().find(|(known, _)| *known == code).map(|(_, part)| *part)
    }

    /// Returns the first part of this number as one, 0 if there is none.
    pub(super) fn number(&self, code: i32) -> Result<f64, PatternFault> {
        self.first(code).map_or(Ok(0.0), number)
    }

    /// Returns the point of these two numbers.
    pub(super) fn point(&self, at: [i32; 2]) -> Result<Point, PatternFault> {
        if let Some(code) = at.into_iter().find(|code| self.first(*code).is_none()) {
            let element = format!("a {} without the number {code}", self.name);
            return Err(PatternFault::Element { element, right: "every point should have its x and its y" });
        }
        Ok(Point::new(self.number(at[0])?, self.number(at[1])?))
    }

    /// Returns the normal of the entity's plane: its part across the view, and that towards who looks.
    pub(super) fn normal(&self) -> Result<[f64; 2], PatternFault> {
        let [x, y, z] = NORMAL.map(|code| self.number(code));
        Ok([x?.hypot(y?), self.sign * z?])
    }

    /// Whether the flags of the entity have this one.
    pub(super) fn has_flag(&self, flag: u32) -> bool {
        self.first(FLAGS).and_then(|flags| flags.parse::<u32>().ok()).is_some_and(|flags| flags & flag != 0)
    }

    /// Whether the entity is not displayed: by itself, on a page, or on a layer that is frozen or off.
    pub(super) fn is_hidden(&self, layers: &HashSet<String>) -> bool {
        let layer = self.first(LAYER).unwrap_or_default().to_lowercase();
        layers.contains(&layer) || [INVISIBLE, ON_PAGE].iter().any(|code| self.first(*code) == Some("1"))
    }
}
