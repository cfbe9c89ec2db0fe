//! A state from which an analysis begins, independent of the numbering of a model's unknowns.

/// A state from which an analysis begins.
#[derive(Clone, Debug, PartialEq)]
pub struct StartState {
    /// All coordinates.
    pub coordinates: Vec<f64>,
    /// Angles of all hinges of the model, from which angles continue.
    pub angles: Vec<f64>,
    /// Tensions of the stiff measures of the model.
    pub tension: Vec<f64>,
}
