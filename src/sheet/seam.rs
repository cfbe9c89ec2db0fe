//! Seams of tubes, and the numbering of cells modulo a seam.
//!
//! A seam `(n1, n2)` is the cell that lies on cell (0, 0) when a sheet is rolled up. Let `g` be the greatest common
//! divisor of its two numbers and `p = (n1, n2) / g`. A second cell `m` with `p1 m2 - p2 m1 = 1` makes a basis of the
//! lattice with `p`: every cell is `i p + j m` with whole numbers `i`, its strand, and `j`, its row. On the tube
//! strands count modulo `g`, so that a row has `g` cells: a ring of cells if `p` is one of the two lattice vectors,
//! otherwise one cell of each of the `g` strands that wind around the tube.

/// A seam: the cell `(n1, n2)` of a tube that coincides with cell (0, 0), and a basis of the lattice that goes with it.
///
/// ```
/// use foldwell::sheet::Seam;
///
/// let seam = Seam::new([4, -6]).ok_or("no seam")?;
/// assert_eq!((seam.strands(), seam.basis()[0]), (2, [2, -3]));
/// let [strand, row] = seam.place([5, 7]);
/// assert_eq!(seam.cell(strand, row), [5, 7]);
/// assert_eq!(seam.home([5 + 4, 7 - 6]), seam.home([5, 7]));
/// assert_eq!(Seam::new([0, 0]), None);
/// # Ok::<(), &str>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Seam {
    cell: [i32; 2],
    /// The cells `p` and `m`.
    basis: [[i32; 2]; 2],
    /// The greatest common divisor `g`.
    strands: i32,
}

impl Seam {
    /// Makes the seam to cell `(n1, n2)`; `None` for cell (0, 0), which is no seam, and for numbers of more than 15
    /// bits.
    pub fn new([n1, n2]: [i32; 2]) -> Option<Self> {
        let far = |n: i32| n.unsigned_abs() > 1 << 15;
        if [n1, n2] == [0, 0] || far(n1) || far(n2) {
            return None;
        }
        let (strands, x, y) = bezout(n1, n2);
        Some(Self { cell: [n1, n2], basis: [[n1 / strands, n2 / strands], [-y, x]], strands })
    }

    /// Returns the cell that coincides with cell (0, 0).
    pub fn lattice_vector(&self) -> [i32; 2] {
        self.cell
    }

    /// Returns the number `g` of strands, the cells of a row.
    pub fn strands(&self) -> i32 {
        self.strands
    }

    /// Returns the cells `p`, the next one of a row, and `m`, the same place in the next row.
    pub fn basis(&self) -> [[i32; 2]; 2] {
        self.basis
    }

    /// Returns the cell `strand p + row m`.
    pub fn cell(&self, strand: i32, row: i32) -> [i32; 2] {
        let [p, m] = self.basis;
        [0, 1].map(|a| strand * p[a] + row * m[a])
    }

    /// Returns strand and row of a cell; strands are not counted modulo `g`.
    pub fn place(&self, [c1, c2]: [i32; 2]) -> [i32; 2] {
        let [p, m] = self.basis;
        [c1 * m[1] - c2 * m[0], p[0] * c2 - p[1] * c1]
    }

    /// Returns the same cell of the tube with its strand in `0 .. g`.
    pub fn home(&self, cell: [i32; 2]) -> [i32; 2] {
        let [strand, row] = self.place(cell);
        self.cell(strand.rem_euclid(self.strands), row)
    }
}

/// The closing conditions that a tube keeps: `n1 theta1 + n2 theta2 = 2 pi` and `n1 h1 + n2 h2 = 0`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SeamKept {
    /// Whether the seam turns by `2 pi`.
    pub turn: bool,
    /// Whether the seam has no translation along the axis.
    pub rise: bool,
}

impl SeamKept {
    /// Both conditions: a closed tube.
    pub const BOTH: Self = Self { turn: true, rise: true };

    /// Whether the tube is closed.
    pub fn is_closed(self) -> bool {
        self.turn && self.rise
    }

    /// Returns the number of conditions that are not kept.
    pub fn free(self) -> usize {
        usize::from(!self.turn) + usize::from(!self.rise)
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: every cell of the plane is in one of the rows, cells that differ by the seam are the same, and a row has
    /// `g` cells.
    #[test]
    fn cells_modulo_a_seam() {
        for (seam, strands) in [([0, 7], 7), ([1, 8], 1), ([4, -6], 2), ([-3, 0], 3), ([-5, -5], 5), ([0, -2], 2)] {
            let rows = Seam::new(seam).unwrap();
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
