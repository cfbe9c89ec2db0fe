//! What the theory predicts, computed in other ways than the library does: tests compare the two.

pub mod continuum;
pub mod duality;
pub mod strain_form;
pub mod tuning;

/// The result, or why there is none.
pub type Predicted<T> = Result<T, Box<dyn std::error::Error>>;
