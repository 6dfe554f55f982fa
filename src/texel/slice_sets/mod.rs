//! Sets of slices in three directions (§4.2) and in counts of powers of two (§4.3), with mip levels.
//!
//! A set of fewer slices is one of thicker layers: a pixel is opaque if any voxel behind it in its layer is, so that
//! seen along the axis the volume covers the same pixels with any count. Along w the pixel shows the topmost voxel,
//! which is what one sees from above; along u and v the average of the first and the last, which are seen from either
//! side.
//!
//! Slice k of N stands in the middle of its layer, at (k + ½)/N.

mod mips;

use bevy::math::Vec3;

use super::axis::SliceAxis;
use super::color::{SrgbTable, decode_normal, encode_normal};
use super::parallel;
use super::volume::ReferenceVolume;

/// Slices along one axis, the first at 0. Their pixels are opaque, with alpha 255, or empty; empty ones beside opaque
/// ones have their colour, so that filtered edges do not darken.
#[derive(Clone, Debug, PartialEq)]
pub struct SliceSet {
    /// The axis that the slices are perpendicular to.
    pub axis: SliceAxis,
    /// How many slices there are: a power of two.
    pub count: u32,
    /// Mip levels, from that of one pixel a voxel down to one pixel.
    pub levels: Vec<SliceLevel>,
}

/// All slices of a set at one mip level.
#[derive(Clone, Debug, PartialEq)]
pub struct SliceLevel {
    /// Pixels of a slice along both [`in_plane`](SliceAxis::in_plane) axes: columns and rows.
    pub size: [u32; 2],
    /// sRGB colours and alpha, slice by slice, row by row.
    pub colors: Vec<[u8; 4]>,
    /// Normals in (u, v, w) as normal maps have them; the fourth byte is alpha.
    pub normals: Vec<[u8; 4]>,
}

impl SliceLevel {
    /// Index of a pixel.
    pub fn index(&self, slice: u32, column: u32, row: u32) -> usize {
        ((slice * self.size[1] + row) * self.size[0] + column) as usize
    }
}

/// One pixel as it is averaged: sums over the opaque pixels of level 0 that it stands for, and their number.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct PixelSum {
    color: Vec3,
    normal: Vec3,
    opaque: u32,
}

impl SliceSet {
    /// Cuts a volume into `count` slices. Counts are rounded up to a power of two, and are at most as many as there
    /// are voxels.
    pub fn new(volume: &ReferenceVolume, axis: SliceAxis, count: u32) -> Self {
        let most = volume.size()[axis.index()];
        let count = count.clamp(1, most).next_power_of_two();
        let table = SrgbTable::new();
        let slices = parallel::map(count as usize, |slice| {
            layer(volume, axis, slice as u32, most / count, &table)
        });
        let size = axis.in_plane().map(|axis| volume.size()[axis.index()]);
        Self {
            axis,
            count,
            levels: mips::levels(&slices, size, &table),
        }
    }

    /// Bytes of colours and normals, of all levels.
    pub fn bytes(&self) -> usize {
        self.levels.iter().map(|level| level.colors.len() * 8).sum()
    }
}

/// The pixels of one layer.
fn layer(
    volume: &ReferenceVolume,
    axis: SliceAxis,
    slice: u32,
    depth: u32,
    table: &SrgbTable,
) -> Vec<PixelSum> {
    let [across, up] = axis.in_plane();
    let [width, height] = [across, up].map(|axis| volume.size()[axis.index()]);
    let mut pixels = Vec::with_capacity((width * height) as usize);
    let mut voxel = [0; 3];
    for row in 0..height {
        for column in 0..width {
            voxel[across.index()] = column;
            voxel[up.index()] = row;
            let mut opaque = (slice * depth..(slice + 1) * depth).filter_map(|at| {
                voxel[axis.index()] = at;
                let index = volume.index(voxel[0], voxel[1], voxel[2]);
                (volume.colors()[index][3] != 0).then_some(index)
            });
            let mut pixel = PixelSum::default();
            if let Some(first) = opaque.next() {
                let last = opaque.next_back().unwrap_or(first);
                pixel.opaque = 1;
                let ends = if axis == SliceAxis::W {
                    [last, last]
                } else {
                    [first, last]
                };
                for index in ends {
                    let [r, g, b, _] = volume.colors()[index];
                    let [x, y, z, _] = volume.normals()[index];
                    pixel.color += 0.5 * table.decode([r, g, b]);
                    pixel.normal += 0.5 * decode_normal([x, y, z]);
                }
            }
            pixels.push(pixel);
        }
    }
    pixels
}

impl PixelSum {
    /// Colour and normal as bytes, without alpha.
    fn encode(&self, table: &SrgbTable) -> ([u8; 3], [u8; 3]) {
        let color = table.encode(self.color / self.opaque.max(1) as f32);
        (color, encode_normal(self.normal))
    }
}

/// All sets of a volume.
#[derive(Clone, Debug, PartialEq)]
pub struct SliceSets {
    sets: [Vec<SliceSet>; 3],
}

impl SliceSets {
    /// Cuts a volume along all axes, into 1, 2, 4 and so on up to one slice a voxel, or to `most` slices, which is
    /// what a device's texture arrays hold (256 everywhere).
    pub fn new(volume: &ReferenceVolume, most: u32) -> Self {
        let sets = SliceAxis::ALL.map(|axis| {
            let most = volume.size()[axis.index()].min(most.max(1));
            let counts = (0..=most.ilog2()).map(|exponent| 1 << exponent);
            counts
                .map(|count| SliceSet::new(volume, axis, count))
                .collect()
        });
        Self { sets }
    }

    /// The set of `count` slices, a power of two, along an axis, or the one of most slices if there are not as many.
    pub fn get(&self, axis: SliceAxis, count: u32) -> &SliceSet {
        let sets = &self.sets[axis.index()];
        let exponent = count.max(1).next_power_of_two().ilog2() as usize;
        &sets[exponent.min(sets.len() - 1)]
    }

    /// All of them: along u, v, then w, the fewest slices first.
    pub fn iter(&self) -> impl Iterator<Item = &SliceSet> {
        self.sets.iter().flatten()
    }

    /// Bytes of colours and normals.
    pub fn bytes(&self) -> usize {
        self.iter().map(SliceSet::bytes).sum()
    }
}

#[cfg(test)]
mod tests;
