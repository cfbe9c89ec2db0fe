//! Sparse and dense linear algebra, and the check of derivatives. The only module that names `faer`.

pub mod factor;
pub mod order;
pub mod parallel;
pub mod sparse;
