//! Predictions of the theory, computed in other ways than by the library, for comparison in tests.

pub mod continuum;
pub mod duality;
pub mod strain_form;
pub mod tuning;

/// The result of a prediction, or the reason why there is none.
pub type Predicted<T> = Result<T, Box<dyn std::error::Error>>;
