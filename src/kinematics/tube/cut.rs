//! A piece of a tube: a number of rows of whole cells (see [`Seam`](crate::sheet::Seam)), as a finite sheet with two
//! open ends.

use super::Tube;
use crate::kinematics::{Motion, Shape};
use crate::math::Vec3;
use crate::sheet::build::{Drawing, build};
use crate::sheet::error::Defect;
use crate::sheet::{Corner, Sheet};
use nalgebra::Matrix3;
use std::collections::HashMap;

impl Tube<'_> {
    /// Returns the tube with these fold angles, cut to `rows` rows of cells: a finite sheet with its axis along z and
    /// vertex 0 of the first cell at height 0 in the half-plane `y = 0`, `x > 0`.
    ///
    /// The faces of a cell are those that the sheet lists.
    ///
    /// # Errors
    /// [`Defect`] if the faces do not form a sheet, as in a tube so narrow that a face meets itself.
    ///
    /// # Panics
    /// If the length of `angles` is not the number of edges.
    pub fn cut(&self, angles: &[f64], rows: usize) -> Result<Sheet, Defect> {
        let (count, rows) = (self.seam, rows as i32);
        let mut drawn = Drawing { title: "tube".to_owned(), description: self.described(rows), ..Drawing::default() };
        let mut numbers: HashMap<Corner, usize> = HashMap::new();
        let place = self.placing(angles);
        for cell in (0..rows).flat_map(|row| (0..count.strands()).map(move |strand| count.cell(strand, row))) {
            for triangle in &self.sheet.triangles {
                let corners = triangle.corners.map(|corner| {
                    let there = corner.translated(cell);
                    let home = Corner { shift: count.home(there.shift), ..there };
                    *numbers.entry(home).or_insert_with(|| {
                        drawn.coords.push(place(home));
                        drawn.coords.len() - 1
                    })
                });
                drawn.faces.push(corners.to_vec());
            }
        }
        build(&drawn)
    }

    fn described(&self, rows: i32) -> String {
        let ([n1, n2], name) = (self.seam.lattice_vector(), &self.sheet.title);
        format!(
            "{name} rolled up until cell ({n1}, {n2}) lies on cell (0, 0), cut to {rows} rows. {}",
            self.sheet.description
        )
    }

    /// Returns the function from corners to positions in the frame of the tube; the seam is closed only up to rounding.
    fn placing(&self, angles: &[f64]) -> impl Fn(Corner) -> Vec3 {
        let shape = Shape::at(&self.embedding, angles).ok();
        move |corner| {
            let Some(Shape { positions, screw, .. }) = &shape else { return Vec3::repeat(f64::NAN) };
            let towards = screw.towards_axis();
            let (x, z) = (-towards.normalize(), screw.axis.unwrap_or_else(Vec3::zeros));
            let rotation = Matrix3::from_rows(&[x.transpose(), z.cross(&x).transpose(), z.transpose()]);
            let frame = Motion { rotation, translation: Vec3::new(1.0 / towards.norm(), 0.0, 0.0) };
            frame.apply(&screw.motion(corner.shift).apply(&positions[corner.vertex]))
        }
    }
}
