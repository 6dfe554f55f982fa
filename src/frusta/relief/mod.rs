//! Relief (§3): detail in the shell between an inner and an outer frustum.
//!
//! Every joint has two spheres, and the cones that touch them are the inner and the outer frustum. A point between
//! them has a relief height w, 0 on the inner and 1 on the outer cone (Equation 12), and (u, v) on the cone of its own
//! height. What is no higher than the relief map at (u, v) is solid.
//!
//! 1. [`Relief`] on a [`FrustaMaterial`](super::FrustaMaterial) names the map, the shell and how it is marched
//!    (`settings.rs`).
//! 2. The map's heights are taken from its image, reduced to mip levels and kept beside it (`map.rs`, `library.rs`).
//! 3. Plants with relief are cut by the planes of half its height, one for the whole shell, so that every point of space
//!    has one owner (`math/shell.rs`).
//! 4. `gpu.rs` hands map and settings to the shaders; `shaders/relief.wgsl` finds u, v and height of a point,
//!    `shaders/march.wgsl` marches; where a material asks for leaps, `shaders/leap.wgsl` tells from the greatest heights
//!    about a point (`ceilings.rs`) which steps are in air.

mod ceilings;
mod gpu;
mod library;
mod map;
mod settings;

pub(crate) use gpu::{ReliefBindings, ReliefTextures, upload};
pub(crate) use library::{ReliefMaps, follow_maps};
pub use map::{ReliefMap, ReliefMapError};
pub use settings::{Relief, ReliefMarch, ReliefSteps, ReliefThickness, ReliefV, relief_material};
