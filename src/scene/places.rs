//! The vertices that a scene names, by number, by the names of the mesh or by their drawn positions; and the pins,
//! parts and springs on them.

use std::collections::HashMap;
use std::ops::Range;

use super::spec::{Coordinate, PartSpec, PinSpec, SpringSpec, VertexName, VertexSet};
use super::values::CellIndex;
use super::{Located, SceneError, SceneFile};
use crate::math::{Vec3, bounds};
use crate::model::{Assembly, Length, OwnTerm, Part, Site, Spring};
use crate::sheet::similar::there_are;
use crate::sheet::{Sheet, Tiling};

/// Distance, relative to the mean edge, up to which a drawn coordinate has a given value.
const SAME_COORDINATE: f64 = 1e-6;
/// Part of a direction outside a space, relative to its length, up to which it lies in the space.
const DEPENDENT: f64 = 1e-9;

/// The vertices of a patch, as a scene refers to them.
pub(crate) struct Places<'a> {
    file: &'a SceneFile,
    sheet: &'a Sheet,
    tiling: &'a Tiling,
    /// Distance up to which a coordinate has a given value.
    tolerance: f64,
}

/// The pinned axes, and the guides, of vertices.
pub(super) struct Held {
    /// Vertices and the axes along which each is pinned.
    pub pins: Vec<(usize, [bool; 3])>,
    /// Vertices and the unit vectors along which each keeps its coordinate.
    pub guides: Vec<(usize, Vec3)>,
}

impl<'a> Places<'a> {
    pub(crate) fn new(file: &'a SceneFile, assembly: &'a Assembly) -> Self {
        let tolerance = SAME_COORDINATE * assembly.mean_edge();
        Self { file, sheet: assembly.sheet(), tiling: assembly.tiling(), tolerance }
    }

    /// Returns the numbers of the vertices of a set, in the order of a list, otherwise in increasing order.
    pub(crate) fn set(&self, set: &Located<VertexSet>) -> Result<Vec<usize>, SceneError> {
        let span = || set.span();
        let found = match &**set {
            VertexSet::List(names) => {
                names.iter().map(|name| self.vertex(*name, span(), span())).collect::<Result<Vec<_>, _>>()?
            }
            VertexSet::Name(name) => self.named(name, span())?,
            VertexSet::Where(values) => self.at(values),
            VertexSet::Box(corners) => self.within(corners),
        };
        self.file.error_if(found.is_empty(), span(), "this set has no vertices", self.extremes())?;
        let Some(vertex) = twice(&found) else { return Ok(found) };
        let message = format!("{} is listed twice", self.described(vertex));
        Err(self.file.error_at(span(), message, "name every vertex once"))
    }

    /// Returns the number of a vertex of the patch.
    fn vertex(&self, name: VertexName, vertex: Range<usize>, cell: Range<usize>) -> Result<usize, SceneError> {
        let count = self.sheet.vertices.len();
        if name.vertex >= count {
            let help = format!("the vertices of a cell are 0 to {}", count - 1);
            return Err(self.file.error_at(vertex, format!("there is no vertex {}", name.vertex), help));
        }
        let [n1, n2] = self.tiling.cells;
        if name.cell[0] >= n1 || name.cell[1] >= n2 {
            let help = format!("the cells are [0, 0] to [{}, {}]", n1 - 1, n2 - 1);
            return Err(self.file.error_at(cell, format!("there is no cell {:?}", name.cell), help));
        }
        Ok((name.cell[1] * n1 + name.cell[0]) * count + name.vertex)
    }

    /// Returns the vertices that the mesh lists under a name.
    fn named(&self, name: &str, span: Range<usize>) -> Result<Vec<usize>, SceneError> {
        let Some(corners) = self.sheet.names.get(name) else {
            let help = if self.sheet.names.is_empty() {
                "the mesh has no names: give a list of vertices, { where = { z = \"max\" } } or a box, or add the key \
                 `foldwell:names` to the mesh"
                    .to_owned()
            } else {
                there_are(name, self.sheet.names.keys().map(String::as_str))
            };
            return Err(self.file.error_at(span, format!("the mesh names no vertices `{name}`"), help));
        };
        let vertex = |corner: &crate::sheet::Corner| {
            let cell = corner.shift.map(|n| usize::try_from(n).unwrap_or(usize::MAX));
            self.vertex(VertexName { vertex: corner.vertex, cell }, span.clone(), span.clone())
        };
        corners.iter().map(vertex).collect()
    }

    /// Returns the vertices with these drawn coordinates.
    fn at(&self, values: &[Option<Coordinate>; 3]) -> Vec<usize> {
        let [low, high] = bounds(&self.tiling.positions);
        let value = |axis: usize, value: Coordinate| match value {
            Coordinate::Least => low[axis],
            Coordinate::Largest => high[axis],
            Coordinate::At(value) => value,
        };
        let close = |position: &Vec3| {
            let mut given = values.iter().enumerate().filter_map(|(axis, at)| Some((axis, value(axis, (*at)?))));
            given.all(|(axis, value)| (position[axis] - value).abs() <= self.tolerance)
        };
        self.selected(close)
    }

    /// Returns the vertices whose drawn positions are in a box.
    fn within(&self, [a, b]: &[[f64; 3]; 2]) -> Vec<usize> {
        let between = |x: f64, axis: usize| {
            let (low, high) = (a[axis].min(b[axis]), a[axis].max(b[axis]));
            x >= low - self.tolerance && x <= high + self.tolerance
        };
        self.selected(|position| (0..3).all(|axis| between(position[axis], axis)))
    }

    fn selected(&self, has: impl Fn(&Vec3) -> bool) -> Vec<usize> {
        let positions = self.tiling.positions.iter().enumerate();
        positions.filter(|(_, position)| has(position)).map(|(vertex, _)| vertex).collect()
    }

    /// Returns a sentence about the extent of the patch.
    fn extremes(&self) -> String {
        let [low, high] = bounds(&self.tiling.positions);
        let range = |axis: usize| format!("{} from {:.6} to {:.6}", ["x", "y", "z"][axis], low[axis], high[axis]);
        format!("in the drawn state, the vertices of the patch have {}, {} and {}", range(0), range(1), range(2))
    }

    /// Returns the name of a vertex for messages.
    pub(super) fn described(&self, vertex: usize) -> String {
        let (count, [n1, n2]) = (self.sheet.vertices.len(), self.tiling.cells);
        let cell = vertex / count;
        let home = format!("vertex {}", vertex % count);
        if n1 * n2 == 1 { home } else { format!("{home} of cell [{}, {}]", cell % n1, cell / n1) }
    }

    /// Returns the vertices of a load or a pin, which `vertex` and `cell`, or `vertices`, names.
    pub(super) fn of_entry(
        &self,
        (what, span): (&str, Range<usize>),
        vertex: Option<&Located<usize>>,
        cell: Option<&Located<CellIndex>>,
        vertices: Option<&Located<VertexSet>>,
    ) -> Result<Vec<usize>, SceneError> {
        let help = "give vertex = n, with cell = [c1, c2] if it is not [0, 0], or vertices = [..]";
        match (vertex, vertices, cell) {
            (Some(vertex), None, _) => {
                let home = cell.map_or([0, 0], |cell| cell.0);
                let name = VertexName { vertex: **vertex, cell: home };
                Ok(vec![self.vertex(name, vertex.span(), cell.map_or(0..0, Located::span))?])
            }
            (None, Some(vertices), None) => self.set(vertices),
            (None, Some(_), Some(cell)) => {
                let help = "in a list, a vertex of another cell than [0, 0] is [v, c1, c2]";
                Err(self.file.error_at(cell.span(), "`cell` belongs to `vertex`, and not to `vertices`", help))
            }
            (Some(_), Some(vertices), _) => {
                Err(self.file.error_at(vertices.span(), format!("{what} has both `vertex` and `vertices`"), help))
            }
            (None, None, _) => Err(self.file.error_at(span, format!("{what} names no vertex"), help)),
        }
    }

    /// Returns the springs as one term; none if there are none.
    pub(super) fn springs(&self) -> Result<Option<OwnTerm>, SceneError> {
        let site = |vertex: usize| Site { vertex, shift: [0, 0] };
        let mut springs = Vec::new();
        for SpringSpec { vertices, stiffness, rest } in &self.file.scene.springs {
            let Ok([a, b]) = <[usize; 2]>::try_from(self.set(vertices)?) else {
                let help = "name two, as in vertices = [3, [7, 0, 1]]";
                return Err(self.file.error_at(vertices.span(), "a spring is between two vertices", help));
            };
            let drawn = (self.tiling.positions[b] - self.tiling.positions[a]).norm();
            let help = "two vertices in one place have no direction between them";
            self.file.error_if(drawn <= self.tolerance, vertices.span(), "the spring has no length", help)?;
            let rest = rest.map_or(drawn, |rest| rest.0);
            springs.push(([site(a), site(b)], Spring { stiffness: stiffness.0, rest }));
        }
        Ok((!springs.is_empty()).then(|| OwnTerm::new("springs", Length, springs)))
    }

    /// Returns the pins and guides. The axes of several pins of a vertex are joined.
    pub(super) fn held(&self) -> Result<Held, SceneError> {
        let mut held = Held { pins: Vec::new(), guides: Vec::new() };
        let mut numbers: HashMap<usize, usize> = HashMap::new();
        for pin in &self.file.scene.pins {
            let PinSpec { vertex, cell, vertices, axes, normal } = &**pin;
            let what = ("the pin", pin.span());
            let on = self.of_entry(what, vertex.as_ref(), cell.as_ref(), vertices.as_ref())?;
            if let Some(normal) = normal {
                let help = "`axes` names coordinates that stay, `normal` the one direction along which nothing moves";
                let message = "the pin has both `axes` and `normal`";
                self.file.error_if(axes.is_some(), normal.span(), message, help)?;
                let direction = Vec3::from(normal.0).try_normalize(0.0).ok_or_else(|| {
                    let help = "give the direction along which the vertices keep their coordinate, as in [0, 0, 1]";
                    self.file.error_at(normal.span(), "the normal is zero", help)
                })?;
                held.guides.extend(on.into_iter().map(|vertex| (vertex, direction)));
                continue;
            }
            for vertex in on {
                let number = *numbers.entry(vertex).or_insert_with(|| {
                    held.pins.push((vertex, [false; 3]));
                    held.pins.len() - 1
                });
                let joined = &mut held.pins[number].1;
                *joined = std::array::from_fn(|axis| joined[axis] || pin.axes()[axis]);
            }
        }
        self.independent(&held)?;
        Ok(held)
    }

    /// Checks that no guide holds a vertex along a direction along which pins and other guides hold it.
    fn independent(&self, held: &Held) -> Result<(), SceneError> {
        let mut directions: HashMap<usize, Vec<Vec3>> = HashMap::new();
        let axis = |axis: usize| Vec3::ith(axis, 1.0);
        for &(vertex, axes) in &held.pins {
            directions.insert(vertex, (0..3).filter(|&k| axes[k]).map(axis).collect());
        }
        for &(vertex, normal) in &held.guides {
            let others = directions.entry(vertex).or_default();
            let rest = others.iter().fold(normal, |rest, other| rest - other * other.dot(&rest));
            let Some(new) = rest.try_normalize(DEPENDENT) else {
                let mut normals = self.file.scene.pins.iter().filter_map(|pin| pin.normal.as_ref());
                let span = normals.next_back().map_or(0..0, Located::span);
                let message = format!("{} is held twice along a normal", self.described(vertex));
                let help = "pins and normals of a vertex name each direction once: leave the vertex out of one of them";
                return Err(self.file.error_at(span, message, help));
            };
            others.push(new);
        }
        Ok(())
    }

    /// Returns the rigid parts. Its vertices belong to no other part, and are not held.
    pub(super) fn parts(&self, held: &Held) -> Result<Vec<Part>, SceneError> {
        let mut parts: Vec<Part> = Vec::new();
        let mut owner: HashMap<usize, &str> = HashMap::new();
        for spec in &self.file.scene.parts {
            let part = Part { vertices: self.set(&spec.vertices)?, free: motions(spec) };
            let wrong = |vertex: usize, fault: String, help: &str| {
                let message = format!("{} of part `{}` {fault}", self.described(vertex), spec.name.0);
                Err(self.file.error_at(spec.vertices.span(), message, help))
            };
            for &vertex in &part.vertices {
                if let Some(other) = owner.insert(vertex, &spec.name.0) {
                    return wrong(vertex, format!("is in part `{other}` too"), "a vertex belongs to one part at most");
                }
                let mut pinned = held.pins.iter().map(|(pin, _)| pin).chain(held.guides.iter().map(|(guide, _)| guide));
                if pinned.any(|pin| *pin == vertex) {
                    let help = "leave it out of the pins: `free` of the part says what the part cannot do";
                    return wrong(vertex, "is pinned".into(), help);
                }
            }
            self.turns(spec, &part)?;
            parts.push(part);
        }
        Ok(parts)
    }

    /// Checks that every free rotation of a part moves its vertices: those of a part on a line do not feel a rotation
    /// about the line.
    fn turns(&self, spec: &PartSpec, part: &Part) -> Result<(), SceneError> {
        if part.free[3..].iter().all(|free| !free) {
            return Ok(());
        }
        let positions: Vec<Vec3> = part.vertices.iter().map(|&vertex| self.tiling.positions[vertex]).collect();
        let Some(line) = line(&positions, self.tolerance) else { return Ok(()) };
        let others = (0..3).filter(|&axis| !part.free[3 + axis]).map(|axis| line[axis].abs()).fold(0.0, f64::max);
        if others > DEPENDENT {
            return Ok(());
        }
        let span = spec.free.as_ref().map_or_else(|| spec.vertices.span(), Located::span);
        let message = format!("the vertices of part `{}` lie on a line, about which it would turn freely", spec.name.0);
        let help = "add vertices that are not on the line, or leave rotations about it out of `free`, as in \
                    free = [\"x\", \"y\", \"z\"]";
        Err(self.file.error_at(span, message, help))
    }
}

/// Returns the motions that a part keeps; all, if the scene does not say.
pub(super) fn motions(spec: &PartSpec) -> [bool; 6] {
    spec.free.as_ref().map_or([true; 6], |free| free.0)
}

fn twice(list: &[usize]) -> Option<usize> {
    let mut seen = std::collections::HashSet::new();
    list.iter().copied().find(|vertex| !seen.insert(*vertex))
}

/// Returns the direction of the line on which all positions lie within `tolerance`; zero if they are one point, `None`
/// if there is no such line.
fn line(positions: &[Vec3], tolerance: f64) -> Option<Vec3> {
    let first = positions[0];
    let farthest = positions.iter().map(|x| x - first).max_by(|a, b| a.norm().total_cmp(&b.norm()))?;
    let Some(direction) = farthest.try_normalize(tolerance) else { return Some(Vec3::zeros()) };
    positions.iter().all(|x| (x - first).cross(&direction).norm() <= tolerance).then_some(direction)
}
