//! A piece of a tube: a number of rows of whole cells, as a finite sheet with two open ends.
//!
//! With the greatest common divisor `g` of the seam and `p = (n1, n2) / g`, every cell is `i p + j m`, where
//! `p1 m2 - p2 m1 = 1`; because of the seam `i` counts modulo `g`. Row `j` has the `g` cells `i = 0 .. g-1`: a ring of
//! cells if `p` is one of the two lattice vectors, otherwise `g` strands that wind around the tube.

use super::Tube;
use crate::kinematics::{Motion, Shape};
use crate::math::Vec3;
use crate::sheet::build::{Drawing, build};
use crate::sheet::error::Defect;
use crate::sheet::{Corner, Sheet};
use nalgebra::Matrix3;
use std::collections::HashMap;

/// The numbering of cells modulo a seam.
#[derive(Clone, Copy, Debug)]
struct Rows {
    /// The cells `p` and `m`.
    basis: [[i32; 2]; 2],
    /// The greatest common divisor `g`.
    strands: i32,
}

impl Rows {
    fn new([n1, n2]: [i32; 2]) -> Self {
        let (strands, x, y) = bezout(n1, n2);
        Self { basis: [[n1 / strands, n2 / strands], [-y, x]], strands }
    }

    fn cell(&self, strand: i32, row: i32) -> [i32; 2] {
        let [p, m] = self.basis;
        [0, 1].map(|a| strand * p[a] + row * m[a])
    }

    /// Returns the same cell of the tube with its strand in `0 .. g`.
    fn home(&self, [c1, c2]: [i32; 2]) -> [i32; 2] {
        let [p, m] = self.basis;
        self.cell((c1 * m[1] - c2 * m[0]).rem_euclid(self.strands), p[0] * c2 - p[1] * c1)
    }
}

/// Returns the greatest common divisor `g > 0` of two numbers, and `x`, `y` with `x a + y b = g`.
fn bezout(a: i32, b: i32) -> (i32, i32, i32) {
    if b == 0 {
        return (a.abs(), a.signum(), 0);
    }
    let (g, x, y) = bezout(b, a.rem_euclid(b));
    (g, y, x - a.div_euclid(b) * y)
}

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
        let (count, rows) = (Rows::new(self.seam), rows as i32);
        let mut drawn = Drawing { title: "tube".to_owned(), description: self.described(rows), ..Drawing::default() };
        let mut numbers: HashMap<Corner, usize> = HashMap::new();
        let place = self.placing(angles);
        for cell in (0..rows).flat_map(|row| (0..count.strands).map(move |strand| count.cell(strand, row))) {
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
        let ([n1, n2], name) = (self.seam, &self.sheet.title);
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: every cell of the plane is in one of the rows, cells that differ by the seam are the same, and a row has
    /// `g` cells.
    #[test]
    fn cells_modulo_a_seam() {
        for (seam, strands) in [([0, 7], 7), ([1, 8], 1), ([4, -6], 2), ([-3, 0], 3), ([-5, -5], 5), ([0, -2], 2)] {
            let rows = Rows::new(seam);
            let [[p1, p2], [m1, m2]] = rows.basis;
            assert_eq!((rows.strands, p1 * m2 - p2 * m1), (strands, 1), "{seam:?}");
            let mut homes = std::collections::HashSet::new();
            for cell in (-9..9).flat_map(|c1| (-9..9).map(move |c2| [c1, c2])) {
                let home = rows.home(cell);
                let [d1, d2] = [cell[0] - home[0], cell[1] - home[1]];
                assert_eq!(d1 * seam[1] - d2 * seam[0], 0, "they differ by a multiple of the seam");
                let once_round = [cell[0] + seam[0], cell[1] + seam[1]];
                assert_eq!((rows.home(once_round), rows.home(home)), (home, home));
                homes.insert(home);
            }
            let row = |home: &&[i32; 2]| p1 * home[1] - p2 * home[0] == 0;
            assert_eq!(homes.iter().filter(row).count(), strands as usize);
        }
    }
}
