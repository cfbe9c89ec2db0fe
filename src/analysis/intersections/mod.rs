//! Which faces of a sheet pass through each other.
//!
//! A tree of boxes (`parry3d`) finds the pairs whose boxes meet, `contact` decides each pair exactly. Crossing is told
//! apart from touching: a face touches its neighbours, and layers may lie on each other. Pairs with a common corner are
//! decided like all others, and pairs with a common edge cannot cross (the module [`contact`](mod@contact) says why).
//!
//! Exact is the verdict on the coordinates given, and these carry rounding errors: layers that lie on each other in
//! truth may be in each other by 1e-15. So [`Finder::crossings`] takes a margin, and pairs that are no deeper in each
//! other than that count as touching; margin 0 asks the coordinates alone. A sheet that goes through itself exactly at
//! a crease, to the last bit, is not seen: each of the two faces only touches.

pub mod contact;
mod depth;
mod finder;
mod sheet;

pub use contact::{Triangle, cross};
pub use depth::depth;
pub use finder::{Crossings, Finder, crossings};
pub use sheet::{Marks, STACKED_LAYERS_MARGIN, SelfIntersection};
