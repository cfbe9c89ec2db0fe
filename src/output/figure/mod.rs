//! Figures of states and of what studies found: each function takes data and returns the text of an SVG; nothing is
//! written to disk here.
//!
//! All figures are drawn on one [`canvas`] with one [`palette`], one kind of [`axes`] and one order of what hides what
//! ([`hidden`]). Plotting crates were tried and left out: `plotters` rounds places on the paper to whole pixels, has no
//! dashed outlines of polygons and no order of depth; `kuva` sorts the quadrilaterals of a height field `z(x, y)` by their
//! means, while sheets fold over and through themselves. Both would serve for charts alone, and two ways to make one
//! figure are worse than one. The same data give the same bytes.

mod axes;
pub mod bloch;
mod canvas;
pub mod chart;
mod contour;
mod hidden;
mod palette;
mod projection;
pub mod sheet;
pub mod sphere;
mod style;
pub mod surface;

pub use axes::rounded;
pub use canvas::Caption;
pub use style::escaped;
