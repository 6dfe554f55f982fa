//! What the frusta of a world did in the last frame.

use core::time::Duration;

use bevy::prelude::*;

/// Figures of the last frame, for overlays and for measuring.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[reflect(Resource, Clone, Debug, Default, PartialEq)]
pub struct FrustaStats {
    /// Plants that have a shape, drawn or culled.
    pub plants: usize,
    /// Their segments.
    pub segments: usize,
    /// Joints of the plants whose pose changed, or came to rest.
    pub moved_joints: usize,
    /// Bytes that changed and were written to the GPU; a buffer that had to grow is written whole besides.
    pub uploaded_bytes: usize,
    /// Time spent on cones, cutting planes and records, from the first plant to the last.
    pub cutting_planes: Duration,
}
