//! The geometry of frusta in double precision: for tests, figures and tools.
//!
//! The files are those of [`single`](super::single), compiled for `f64`.

/// The scalar and vector types of this precision.
pub(crate) mod scalar {
    /// A scalar.
    pub type Real = f64;
    pub use core::f64::consts;
    pub use glam::DVec3 as Vec3;
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
