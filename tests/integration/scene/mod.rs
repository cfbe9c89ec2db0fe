//! Scenes: what they mean, and what is refused.

mod bad_scenes;
mod driven_scenes;
mod refused_scenes;
