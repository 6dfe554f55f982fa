//! The buffers of facets in the render world. What of facets is new or has changed is written to them, and no more.

use core::ops::Range;
use std::sync::Arc;

use bevy::prelude::*;
use bevy::render::Extract;
use bevy::render::render_resource::{
    Buffer, BufferDescriptor, BufferUsages, CommandEncoderDescriptor,
};
use bevy::render::renderer::{RenderDevice, RenderQueue};

use super::library::TexelLibrary;
use super::limit::DeviceLimits;
use super::records::FacetRecord;
use super::room::FacetRoom;
use super::stats::TexelStats;

/// Bytes of a facet.
const FACET: usize = size_of::<FacetRecord>();

/// Facets that a buffer has room for at least.
const LEAST_ROOM: usize = 256;

/// Facets of a room that are to be written.
struct Write {
    room: Arc<FacetRoom>,
    records: Arc<[FacetRecord]>,
    range: Range<usize>,
}

/// What of facets is to be written in this frame, as the main world has told it.
#[derive(Resource, Default)]
pub(crate) struct FacetWrites {
    /// How many facets each buffer has to hold.
    ends: Vec<usize>,
    writes: Vec<Write>,
    /// Bytes of those that changed.
    changed_bytes: usize,
    /// The library's frame that was noted last.
    frame: u64,
    /// Whether nobody has come to write it, as while a device is lost.
    is_left: bool,
}

/// The facets of all surfaces, in as few buffers as hold them.
#[derive(Resource, Default)]
pub(crate) struct FacetBuffers {
    pools: Vec<Buffer>,
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

    fn write(&self, write: &Write, queue: &RenderQueue) {
        let room = &write.room;
        let start = ((room.range.start + write.range.start) * FACET) as u64;
        let bytes = bytemuck::cast_slice(&write.records[write.range.clone()]);
        queue.write_buffer(&self.pools[room.pool], start, bytes);
    }
}

/// For how many facets a buffer that holds `now` is made anew, if it is, when there are so many: one that grows doubles, and
/// one of which most is not used any more is given back.
fn capacity(now: usize, facets: usize) -> Option<usize> {
    let fitting = facets.next_power_of_two().max(LEAST_ROOM);
    (facets > now || now == 0 || now > 4 * fitting).then_some(fitting)
}

/// Notes the facets that are new or have changed. They are written when there is a device to write to.
pub(crate) fn note(library: Extract<Option<Res<TexelLibrary>>>, mut noted: ResMut<FacetWrites>) {
    let Some(library) = &*library else {
        return;
    };
    let noted = &mut *noted;
    // What changed in a frame that the render world has missed is not told again.
    let is_behind = library.frame != noted.frame + 1 || noted.is_left;
    (noted.frame, noted.is_left, noted.changed_bytes) = (library.frame, true, 0);
    noted.ends.clear();
    library.space.for_each_pool(|_, end| noted.ends.push(end));
    noted.writes.clear();
    for geometry in library.geometries() {
        let write = |range| Write {
            room: geometry.room.clone(),
            records: geometry.records.clone(),
            range,
        };
        if geometry.is_new || is_behind {
            noted.writes.push(write(0..geometry.records.len()));
            continue;
        }
        for range in &geometry.changed {
            noted.changed_bytes += range.len() * FACET;
            noted.writes.push(write(range.clone()));
        }
    }
}

/// Writes what is noted.
pub(crate) fn upload(
    mut noted: ResMut<FacetWrites>,
    mut buffers: ResMut<FacetBuffers>,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
    mut stats: ResMut<TexelStats>,
) {
    if device.is_changed() {
        // Buffers of a lost device are lost.
        *buffers = FacetBuffers::default();
    }
    let most = DeviceLimits::of(Some(&device)).facets;
    buffers.pools.truncate(noted.ends.len());
    for (pool, end) in noted.ends.iter().enumerate() {
        buffers.fit(pool, *end, most, &device, &queue);
    }
    for write in &noted.writes {
        buffers.write(write, &queue);
    }
    noted.is_left = false;
    stats.uploaded_bytes = noted.changed_bytes;
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
