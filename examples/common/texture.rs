//! Textures made by code.

#[allow(unused_imports, reason = "each example uses its part of it")]
pub use bevy_verdure::lab::{painted, texture};
