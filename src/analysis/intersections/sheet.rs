//! Which faces of a drawn sheet pass through others, or have gone through each other at their hinge.
//!
//! What counts as the sheet:
//! - a **patch**: its faces;
//! - a **torus**: its period, with [`NEIGHBOURS`] more cells on every side, so that a cell is held against what really
//!   surrounds it;
//! - a **screw**: the cells that are drawn, as many as the scene's `cells` says, and no more; faces that reach over
//!   their rim are among them. Without end, every curved screw-periodic sheet winds round and meets itself: whether a
//!   tube closes on itself is a question about a number of cells. To see it, draw a whole turn: `n` cells of rotation
//!   angle `theta` with `n |theta|` above 2 pi. Six cells, which are drawn when the scene says nothing, show a cell
//!   among its neighbours;
//! - a **tube**: the rows of cells that are drawn, joined at the seam, where faces are neighbours as anywhere else.
//!
//! Fold angles are continued through pi, so an angle beyond it says that the two faces of a hinge have gone through
//! each other on the way. Their positions alone do not show that (they are those of the opposite fold), hence it is
//! asked of the angles.

use super::Finder;
use crate::analysis::shown_cells::ShownCells;
use crate::analysis::state::State;
use crate::model::{Assembly, Drawn};
use crate::sheet::{Sheet, Tiling};
use std::collections::HashMap;
use std::f64::consts::PI;

/// Cells of a torus on every side of the drawn ones that these are held against.
pub(crate) const NEIGHBOURS: usize = 2;
/// A margin for states that are known to the tolerance of a relaxation: layers that lie on each other stay apart.
pub const STACKED_LAYERS_MARGIN: f64 = 1e-9;

/// What passes through itself in one state.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Marks {
    /// Whether anything does.
    pub any: bool,
    /// For each triangle of the drawn patch whether it goes through another one.
    pub faces: Vec<bool>,
}

/// Looks for self-intersection in states of one sheet.
pub struct SelfIntersection {
    /// The cells that are looked at.
    view: ShownCells,
    finder: Finder,
    /// The triangle here that each triangle of the drawn patch is.
    drawn: Vec<usize>,
    /// Edges of the model's tiling between two faces, and these.
    hinges: Vec<(usize, [usize; 2])>,
    mean_edge: f64,
}

impl SelfIntersection {
    /// For the states of an assembly.
    pub fn new(assembly: &Assembly) -> Self {
        let (sheet, tiling) = (assembly.sheet(), assembly.tiling());
        let drawn = ShownCells::new(assembly);
        let around = if assembly.domain().is_torus() { NEIGHBOURS } else { 0 };
        let view = if around == 0 {
            ShownCells::new(assembly)
        } else {
            ShownCells::of_cells(sheet, tiling, drawn.patch.cells.map(|n| n + 2 * around), [-(around as i32); 2])
        };
        let numbers: HashMap<(usize, [i32; 2]), usize> =
            view.patch.triangles.iter().enumerate().map(|(k, t)| ((t.triangle, t.cell), k)).collect();
        let number = |triangle: usize, cell: [i32; 2]| numbers[&(triangle, cell.map(|c| c + around as i32))];
        Self {
            drawn: drawn.patch.triangles.iter().map(|t| number(t.triangle, t.cell)).collect(),
            finder: Finder::new(view.triangles.clone()),
            hinges: hinges(&view),
            mean_edge: mean_edge(sheet, &view.patch),
            view,
        }
    }

    /// The self-intersections of a state. [`STACKED_LAYERS_MARGIN`] is how deep faces may be in each other and still
    /// lie on each other, as a part of the mean drawn edge, and how far beyond pi a hinge may be folded, in radians.
    pub fn marks(&mut self, drawn: &Drawn, state: &State) -> Marks {
        let positions = self.view.positions(drawn, &state.coordinates);
        let mut found = self.finder.crossings(&positions, STACKED_LAYERS_MARGIN * self.mean_edge).faces;
        for &(edge, faces) in &self.hinges {
            // false for edges that are no hinges: their angle is NaN
            if state.fold_angle[edge].abs() > PI + STACKED_LAYERS_MARGIN {
                faces.into_iter().for_each(|face| found[face] = true);
            }
        }
        Marks { any: found.contains(&true), faces: self.drawn.iter().map(|&face| found[face]).collect() }
    }
}

fn hinges(view: &ShownCells) -> Vec<(usize, [usize; 2])> {
    let hinge = |(&edge, beside): (&usize, &Vec<usize>)| Some((edge, beside.as_slice().try_into().ok()?));
    view.edges.iter().zip(&view.beside).filter_map(hinge).collect()
}

fn mean_edge(sheet: &Sheet, patch: &Tiling) -> f64 {
    let lengths = patch.edges.iter().map(|edge| sheet.length(sheet.edges[edge.edge].key));
    lengths.sum::<f64>() / patch.edges.len().max(1) as f64
}
