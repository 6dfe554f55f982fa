//! What of facets has changed is written to the GPU, and no more.

use bevy::prelude::*;
use bevy::render::Extract;
use bevy::render::render_asset::RenderAssets;
use bevy::render::renderer::RenderQueue;
use bevy::render::storage::GpuShaderBuffer;

use super::library::TexelLibrary;
use super::records::FacetRecord;

/// Figures of the last frame, for overlays and for measuring. A resource of the render world.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TexelStats {
    /// Slices of all surfaces in all views, those of lights too.
    pub slices: usize,
    /// Bytes of facets that changed and were written to the GPU; those of new surfaces are written besides.
    pub uploaded_bytes: usize,
}

/// Writes facets that have changed.
pub(crate) fn upload(
    library: Extract<Option<Res<TexelLibrary>>>,
    buffers: Res<RenderAssets<GpuShaderBuffer>>,
    queue: Res<RenderQueue>,
    mut stats: ResMut<TexelStats>,
) {
    stats.uploaded_bytes = 0;
    let geometries = library.iter().flat_map(|library| library.changed());
    for geometry in geometries {
        // One that is not there yet is made of all that there is now.
        let Some(buffer) = buffers.get(&geometry.buffer) else {
            continue;
        };
        for range in &geometry.changed {
            let bytes: &[u8] = bytemuck::cast_slice(&geometry.records[range.clone()]);
            let start = range.start * size_of::<FacetRecord>();
            queue.write_buffer(&buffer.buffer, start as u64, bytes);
            stats.uploaded_bytes += bytes.len();
        }
    }
}
