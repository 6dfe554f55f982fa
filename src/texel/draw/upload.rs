//! The buffers of facets in the render world. What of facets is new or has changed is written to them, and no more.

use bevy::prelude::*;
use bevy::render::Extract;
use bevy::render::render_resource::{
    Buffer, BufferDescriptor, BufferUsages, CommandEncoderDescriptor,
};
use bevy::render::renderer::{RenderDevice, RenderQueue};

use super::geometry::Geometry;
use super::library::TexelLibrary;
use super::limit::DeviceLimits;
use super::records::FacetRecord;
use super::stats::TexelStats;

/// Bytes of a facet.
const FACET: usize = size_of::<FacetRecord>();

/// Facets that a buffer has room for at least.
const LEAST_ROOM: usize = 256;

/// The facets of all surfaces, in as few buffers as hold them.
#[derive(Resource, Default)]
pub(crate) struct FacetBuffers {
    pools: Vec<Buffer>,
    /// The library's frame that was written last.
    frame: u64,
}

impl FacetBuffers {
    /// The buffers, in order.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &Buffer> {
        self.pools.iter()
    }

    /// Lets a buffer hold so many facets, at most `most`, and keep what it has.
    fn fit(
        &mut self,
        pool: usize,
        facets: usize,
        most: usize,
        device: &RenderDevice,
        queue: &RenderQueue,
    ) {
        let old = self.pools.get(pool);
        let Some(capacity) = capacity(old.map_or(0, |old| old.size() as usize / FACET), facets)
        else {
            return;
        };
        let fitting = device.create_buffer(&BufferDescriptor {
            label: Some("texel_facets"),
            size: (capacity.min(most) * FACET) as u64,
            usage: BufferUsages::STORAGE | BufferUsages::COPY_DST | BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        if let Some(old) = old {
            let mut encoder = device.create_command_encoder(&CommandEncoderDescriptor::default());
            let kept = old.size().min(fitting.size());
            encoder.copy_buffer_to_buffer(old, 0, &fitting, 0, kept);
            queue.submit([encoder.finish()]);
            self.pools[pool] = fitting;
        } else {
            self.pools.push(fitting);
        }
    }

    /// Writes a run of a surface's facets.
    fn write(
        &self,
        geometry: &Geometry,
        first: usize,
        records: &[FacetRecord],
        queue: &RenderQueue,
    ) {
        let room = &geometry.room;
        let start = ((room.range.start + first) * FACET) as u64;
        queue.write_buffer(&self.pools[room.pool], start, bytemuck::cast_slice(records));
    }
}

/// For how many facets a buffer that holds `now` is made anew, if it is, when there are so many: one that grows doubles, and
/// one of which most is not used any more is given back.
fn capacity(now: usize, facets: usize) -> Option<usize> {
    let fitting = facets.next_power_of_two().max(LEAST_ROOM);
    (facets > now || now == 0 || now > 4 * fitting).then_some(fitting)
}

/// Writes facets that are new or have changed.
pub(crate) fn upload(
    library: Extract<Option<Res<TexelLibrary>>>,
    mut buffers: ResMut<FacetBuffers>,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
    mut stats: ResMut<TexelStats>,
) {
    stats.uploaded_bytes = 0;
    let Some(library) = &*library else {
        return;
    };
    if device.is_changed() {
        // Buffers of a lost device are lost.
        *buffers = FacetBuffers::default();
    }
    let most = DeviceLimits::of(Some(&device)).facets;
    library.space.for_each_pool(|pool, facets| {
        buffers.fit(pool, facets, most, &device, &queue);
    });
    // What changed in a frame that the render world has missed is not told again.
    let is_behind = library.frame != buffers.frame + 1;
    buffers.frame = library.frame;
    for geometry in library.geometries() {
        if geometry.is_new || is_behind {
            buffers.write(geometry, 0, &geometry.records, &queue);
            continue;
        }
        for range in &geometry.changed {
            let records = &geometry.records[range.clone()];
            buffers.write(geometry, range.start, records, &queue);
            stats.uploaded_bytes += size_of_val(records);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn buffers_double_and_are_given_back_when_hardly_used() {
        assert_eq!(capacity(0, 0), Some(LEAST_ROOM));
        assert_eq!(capacity(256, 256), None);
        assert_eq!(capacity(256, 257), Some(512));
        assert_eq!(capacity(1024, 200), None);
        assert_eq!(capacity(4096, 200), Some(LEAST_ROOM));
        assert_eq!(
            capacity(1000, 900),
            None,
            "a device's limit is no power of two"
        );
    }
}
