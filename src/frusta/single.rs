//! The geometry of frusta in single precision: what a running game uses, and what the shaders mirror.
//!
//! The files are those of [`double`](super::double), compiled for `f32`.

/// The scalar and vector types of this precision.
pub(crate) mod scalar {
    /// A scalar.
    pub type Real = f32;
    pub use core::f32::consts;
    pub use glam::Vec3;
}

#[path = "math/bounds.rs"]
pub mod bounds;
#[path = "math/cast.rs"]
pub mod cast;
#[path = "math/cone.rs"]
pub mod cone;
#[path = "math/join.rs"]
pub mod join;
#[path = "math/links.rs"]
pub mod links;
#[path = "math/mitre.rs"]
pub mod mitre;
#[path = "math/paper.rs"]
pub mod paper;
#[path = "math/shell.rs"]
pub mod shell;
#[path = "math/surface.rs"]
pub mod surface;
