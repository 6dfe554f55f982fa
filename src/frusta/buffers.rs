//! The storage buffers in the render world. They are made anew only when they have to grow; else, what has changed
//! is written into them, straight from the main world's tables.

use bevy::ecs::resource::Resource;
use bevy::prelude::{Res, ResMut};
use bevy::render::Extract;
use bevy::render::render_resource::{Buffer, BufferDescriptor, BufferUsages};
use bevy::render::renderer::{RenderDevice, RenderQueue};
use bytemuck::Pod;

use super::share::FrustaData;
use super::table::Table;

/// The buffers that the shaders of a [`FrustaMaterial`](super::FrustaMaterial) read, in the order of their bindings.
/// Lives in the render world; `None` until the first frame.
#[derive(Resource, Default)]
pub struct FrustaBuffers {
    pub(super) joints: Option<Buffer>,
    pub(super) shapes: Option<Buffer>,
    pub(super) plants: Option<Buffer>,
}

/// Rows that a buffer has for a table of `len` rows.
pub(crate) fn capacity(len: usize) -> usize {
    len.next_power_of_two().max(256)
}

/// Brings the buffers up to date with the tables.
pub(crate) fn upload(
    mut buffers: ResMut<FrustaBuffers>,
    data: Extract<Res<FrustaData>>,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
) {
    let FrustaBuffers {
        joints,
        shapes,
        plants,
    } = buffers.as_mut();
    upload_table(joints, &data.joints, "frusta_joints", &device, &queue);
    upload_table(shapes, &data.shapes, "frusta_shapes", &device, &queue);
    upload_table(plants, &data.plants, "frusta_plants", &device, &queue);
}

fn upload_table<T: Pod>(
    buffer: &mut Option<Buffer>,
    table: &Table<T>,
    label: &'static str,
    device: &RenderDevice,
    queue: &RenderQueue,
) {
    let row = size_of::<T>();
    let needed = (capacity(table.rows().len()) * row) as u64;
    match buffer {
        Some(buffer) if buffer.size() >= needed => {
            for range in table.changed() {
                let bytes = bytemuck::cast_slice(&table.rows()[range.clone()]);
                queue.write_buffer(buffer, (range.start * row) as u64, bytes);
            }
        }
        _ => {
            let grown = device.create_buffer(&BufferDescriptor {
                label: Some(label),
                size: needed,
                usage: BufferUsages::STORAGE | BufferUsages::COPY_DST,
                mapped_at_creation: false,
            });
            queue.write_buffer(&grown, 0, bytemuck::cast_slice(table.rows()));
            *buffer = Some(grown);
        }
    }
}
