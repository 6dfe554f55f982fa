//! What texels cost in a frame.

use bevy::prelude::*;

/// Figures of the last frame, for overlays and for measuring. A resource of the render world.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TexelStats {
    /// Slices of all surfaces in all views, those of lights too.
    pub slices: usize,
    /// Runs of slices that are drawn at once: one for each view, group of surfaces that share looks, and axis across which
    /// it has slices. Colours are a draw of each, and so is depth; shadow maps and prepasses are one draw.
    pub draws: usize,
    /// Lists that were made in this frame, of at most 8,192 facets of a surface in a view each. The others are those of
    /// the frame before.
    pub listed: usize,
    /// Bytes of slices, and of where surfaces are, that were written to the GPU: those that differ from what was there, in
    /// blocks of 4,096 bytes.
    pub list_bytes: usize,
    /// Bytes of facets that changed and were written to the GPU; those of new surfaces are written besides.
    pub uploaded_bytes: usize,
}
