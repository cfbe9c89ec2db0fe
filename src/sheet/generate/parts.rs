//! Parts that all generators use: the macro of their parameters, the step from vertices and polygons to a sheet, and a
//! rectangular grid of vertices with its periodic continuation.

use super::error::GenerateError;
use crate::math::Vec3;
use crate::sheet::assignment::Assignment;
use crate::sheet::build::{Drawing, GluedEdge, build, draw};
use crate::sheet::cell::{Corner, EdgeKey, Sheet};
use std::f64::consts::PI;

/// Defines the parameters of a pattern, each with its default. `as "radians"` names the function that reads a value.
macro_rules! parameters {
    ($(#[$about:meta])* $pattern:ident { $($(#[$note:meta])* $name:ident: $kind:ty $(as $reader:literal)? = $default:expr,)+ }) => {
        $(#[$about])*
        #[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
        #[serde(default, deny_unknown_fields)]
        pub struct $pattern {
            $($(#[$note])* $(#[serde(deserialize_with = $reader)])? pub $name: $kind,)+
        }

        impl Default for $pattern {
            fn default() -> Self {
                Self { $($name: $default),+ }
            }
        }
    };
}
pub(super) use parameters;

/// The parts of a sheet that a generator gives; edges and triangles are computed from them.
pub(super) struct Parts {
    pub title: &'static str,
    /// Literature from which the pattern is taken.
    pub source: &'static str,
    pub vertices: Vec<Vec3>,
    pub lattice: Option<[Vec3; 2]>,
    pub polygons: Vec<Vec<Corner>>,
}

impl Parts {
    pub(crate) fn sheet(self, parameters: String) -> Result<Sheet, GenerateError> {
        self.glued(parameters, vec![])
    }

    /// Makes a sheet with these words for the joints of edges of more than two faces.
    pub(super) fn glued(self, parameters: String, glue: Vec<GluedEdge>) -> Result<Sheet, GenerateError> {
        Ok(build(&Drawing { glue, ..draw(&self.bare(parameters)) })?)
    }

    /// Makes a sheet with these openings.
    pub(super) fn open(self, parameters: String, holes: Vec<Vec<Corner>>) -> Result<Sheet, GenerateError> {
        Ok(build(&draw(&Sheet { holes, ..self.bare(parameters) }))?)
    }

    fn bare(self, parameters: String) -> Sheet {
        let Self { title, source, vertices, lattice, polygons } = self;
        Sheet {
            title: title.to_owned(),
            description: format!("{source} {parameters} Unit of length: any."),
            vertices,
            lattice,
            polygons,
            ..Sheet::default()
        }
    }

    /// Makes a flat sheet whose edges fold to these angles, in radians, valley positive: each gets the letter of its
    /// side, and its angle as a target unless all of them fold flat.
    pub(crate) fn folding(self, parameters: String, angles: Vec<([Corner; 2], f64)>) -> Result<Sheet, GenerateError> {
        let mut sheet = self.sheet(parameters)?;
        let angles: Vec<_> = angles.into_iter().map(|([a, b], angle)| (EdgeKey::new(a, b).0, angle)).collect();
        sheet.assignments.extend(angles.iter().map(|&(key, angle)| (key, Assignment::of_angle(angle))));
        if angles.iter().any(|(_, angle)| angle.abs() < PI) {
            sheet.targets.extend(angles);
        }
        Ok(sheet)
    }
}

/// A grid of `size[0] x size[1]` vertices; vertex `(i, j)` has the number `j size[0] + i`.
pub(super) struct VertexGrid {
    pub size: [usize; 2],
}

impl VertexGrid {
    /// Returns `(i, j)` of every vertex, in the order of their numbers.
    pub(crate) fn all(&self) -> impl Iterator<Item = [usize; 2]> + use<> {
        let [m1, m2] = self.size;
        (0..m2).flat_map(move |j| (0..m1).map(move |i| [i, j]))
    }

    /// Returns vertex `(i, j)` of the grid continued periodically.
    pub(crate) fn corner(&self, i: i64, j: i64) -> Corner {
        let [m1, m2] = self.size.map(|m| m as i64);
        Corner {
            vertex: (j.rem_euclid(m2) * m1 + i.rem_euclid(m1)) as usize,
            shift: [i.div_euclid(m1) as i32, j.div_euclid(m2) as i32],
        }
    }

    /// Returns the quadrilateral whose lower left corner is `(i, j)`, counter-clockwise from that corner.
    pub(crate) fn quad(&self, [i, j]: [usize; 2]) -> [Corner; 4] {
        let (i, j) = (i as i64, j as i64);
        [self.corner(i, j), self.corner(i + 1, j), self.corner(i + 1, j + 1), self.corner(i, j + 1)]
    }
}
