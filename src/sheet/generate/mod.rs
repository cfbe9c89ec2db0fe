//! stub
#![allow(missing_docs)]
#[derive(serde::Deserialize)]
pub enum Pattern {}
#[derive(Debug, thiserror::Error)]
pub enum GenerateError {}
pub fn generate(p: &Pattern) -> Result<crate::sheet::Sheet, GenerateError> { match *p {} }
