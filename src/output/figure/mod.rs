//! Figures of states and of the results of studies. Each function takes data and returns the text of an SVG; the files
//! are written elsewhere.
//!
//! All figures use the same [`canvas`], the same [`palette`], the same kind of [`axes`] and the same order of depth
//! ([`hidden`]). Equal data give equal bytes. Plotting crates were tried and are not used: `plotters` rounds
//! coordinates to whole pixels and has neither dashed outlines of polygons nor an order of depth; `kuva` sorts the
//! quadrilaterals of a height field `z(x, y)` by their means, while sheets fold over and through themselves. Both would
//! be suitable for charts only, and then there would be two ways to make a figure.

mod annotations;
mod axes;
pub(crate) mod bands;
pub(crate) mod bloch;
pub(crate) mod canvas;
pub mod chart;
mod contour;
pub(crate) mod film;
mod hidden;
pub(crate) mod palette;
pub(crate) mod projection;
pub(crate) mod ratios;
pub(crate) mod reaction;
mod script;
pub mod sheet;
pub(crate) mod sphere;
pub(crate) mod style;
pub mod surface;

pub use annotations::Annotations;
pub use axes::rounded;
pub use canvas::Caption;
pub use style::escaped;
