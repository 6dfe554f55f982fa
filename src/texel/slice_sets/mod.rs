//! Sets of slices in three directions (§4.2) and in counts of powers of two (§4.3), with mip levels.
//!
//! A set of fewer slices is one of thicker layers: a pixel is opaque if any voxel behind it in its layer is, so that
//! seen along the axis the volume covers the same pixels with any count. Along w the pixel shows the topmost voxel,
//! which is what one sees from above; along u and v the average of the first and the last, which are seen from either
//! side.
//!
//! Slice k of N stands in the middle of its layer, at (k + ½)/N.
//!
//! In mip levels `choice.rs` tells which pixels are opaque, for all counts at once, and `mips.rs` what they show. `boxes.rs`
//! finds where a slice shows anything.

mod boxes;
mod choice;
mod half;
mod mips;

use bevy::math::Vec3;

pub(crate) use boxes::{SliceBoxes, Trim, WHOLE};

use super::axis::SliceAxis;
use super::color::{SrgbTable, decode_normal, encode_mean_normal};
use super::parallel;
use super::volume::ReferenceVolume;
use choice::Chosen;

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

/// The first and the last opaque voxel behind a pixel, by their indices; both [`NO_VOXEL`] if there is none.
type Ends = [u32; 2];

const NO_VOXEL: u32 = u32::MAX;

impl SliceSet {
    /// Cuts a volume into `count` slices. Counts are rounded up to a power of two, and are at most as many as there are
    /// voxels.
    pub fn new(volume: &ReferenceVolume, axis: SliceAxis, count: u32) -> Self {
        let most = volume.size()[axis.index()];
        let count = count.clamp(1, most).next_power_of_two();
        let (sets, chosen) = sets_of_layers(volume, axis, count);
        Self::of_layers(volume, axis, &sets[sets.len() - 1], &chosen[sets.len() - 1])
    }

    fn of_layers(
        volume: &ReferenceVolume,
        axis: SliceAxis,
        layers: &[Vec<Ends>],
        chosen: &[Chosen],
    ) -> Self {
        let table = SrgbTable::new();
        let slices = parallel::map(layers.len(), |slice| {
            let pixels = layers[slice].iter();
            pixels
                .map(|&ends| pixel(volume, axis, ends, &table))
                .collect()
        });
        let in_plane = axis.in_plane();
        let size = in_plane.map(|axis| volume.size()[axis.index()]);
        let [width, height] = in_plane
            .map(|axis| volume.lengths()[axis.index()] / volume.size()[axis.index()] as f32);
        let apart = volume.slice_distance(axis, layers.len() as u32);
        let depth = mips::Depth {
            pixel: (width * height).sqrt() / apart,
            repeats: axis != SliceAxis::W,
        };
        Self {
            axis,
            count: layers.len() as u32,
            levels: mips::levels(slices, chosen, size, depth, &table),
        }
    }

    /// Bytes of colours and normals, of all levels.
    pub fn bytes(&self) -> usize {
        self.levels.iter().map(|level| level.colors.len() * 8).sum()
    }
}

/// What is behind each pixel of `count` layers.
fn layers(volume: &ReferenceVolume, axis: SliceAxis, count: u32) -> Vec<Vec<Ends>> {
    let depth = volume.size()[axis.index()] / count;
    let [across, up] = axis.in_plane();
    let [width, height] = [across, up].map(|axis| volume.size()[axis.index()]);
    parallel::map(count as usize, |slice| {
        let mut pixels = Vec::with_capacity((width * height) as usize);
        let mut voxel = [0; 3];
        for row in 0..height {
            for column in 0..width {
                voxel[across.index()] = column;
                voxel[up.index()] = row;
                let first = slice as u32 * depth;
                let mut opaque = (first..first + depth).filter_map(|at| {
                    voxel[axis.index()] = at;
                    let index = volume.index(voxel[0], voxel[1], voxel[2]);
                    (volume.colors()[index][3] != 0).then_some(index as u32)
                });
                let first = opaque.next().unwrap_or(NO_VOXEL);
                pixels.push([first, opaque.next_back().unwrap_or(first)]);
            }
        }
        pixels
    })
}

/// What is behind each pixel of 1, 2, 4 and so on up to `count` layers, and what is opaque in their mip levels.
fn sets_of_layers(
    volume: &ReferenceVolume,
    axis: SliceAxis,
    count: u32,
) -> (Vec<Vec<Vec<Ends>>>, Vec<Vec<Chosen>>) {
    let mut sets = vec![layers(volume, axis, count)];
    while sets[sets.len() - 1].len() > 1 {
        sets.push(merged(&sets[sets.len() - 1]));
    }
    sets.reverse();
    let size = axis.in_plane().map(|axis| volume.size()[axis.index()]);
    let coverages = sets.iter().map(|layers| {
        let opaque = parallel::map(layers.len(), |slice| {
            let pixels = layers[slice].iter();
            pixels
                .map(|&[first, _]| u32::from(first != NO_VOXEL))
                .collect()
        });
        choice::coverage(opaque, size)
    });
    let chosen = choice::choose(&coverages.collect::<Vec<_>>());
    (sets, chosen)
}

/// Half as many layers, each of two.
fn merged(layers: &[Vec<Ends>]) -> Vec<Vec<Ends>> {
    parallel::map(layers.len() / 2, |slice| {
        let both = layers[2 * slice].iter().zip(&layers[2 * slice + 1]);
        both.map(
            |(&[first, last], &[next_first, next_last])| match (first, next_first) {
                (NO_VOXEL, _) => [next_first, next_last],
                (_, NO_VOXEL) => [first, last],
                _ => [first, next_last],
            },
        )
        .collect()
    })
}

/// What a pixel shows of the voxels behind it.
fn pixel(
    volume: &ReferenceVolume,
    axis: SliceAxis,
    [first, last]: Ends,
    table: &SrgbTable,
) -> PixelSum {
    let mut pixel = PixelSum::default();
    if first == NO_VOXEL {
        return pixel;
    }
    pixel.opaque = 1;
    let shown = if axis == SliceAxis::W {
        [last, last]
    } else {
        [first, last]
    };
    for index in shown {
        let [r, g, b, _] = volume.colors()[index as usize];
        let [x, y, z, _] = volume.normals()[index as usize];
        pixel.color += 0.5 * table.decode([r, g, b]);
        pixel.normal += 0.5 * decode_normal([x, y, z]);
    }
    pixel
}

impl PixelSum {
    /// Adds another one, so many times.
    fn add(&mut self, other: &Self, times: u32) {
        self.color += other.color * times as f32;
        self.normal += other.normal * times as f32;
        self.opaque += other.opaque * times;
    }

    /// Colour and normal as bytes, without alpha.
    fn encode(&self, table: &SrgbTable) -> ([u8; 3], [u8; 3]) {
        let color = table.encode(self.color / self.opaque.max(1) as f32);
        (
            color,
            encode_mean_normal(self.normal / self.opaque.max(1) as f32),
        )
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
            let (sets, chosen) = sets_of_layers(volume, axis, 1 << most.ilog2());
            let sets = sets.iter().zip(&chosen);
            sets.map(|(layers, chosen)| SliceSet::of_layers(volume, axis, layers, chosen))
                .collect()
        });
        Self { sets }
    }

    /// The set of `count` slices, a power of two, along an axis, or the one of most slices if there are not as many.
    pub fn get(&self, axis: SliceAxis, count: u32) -> &SliceSet {
        let sets = &self.sets[axis.index()];
        let most = 1 << (sets.len() - 1);
        &sets[count.clamp(1, most).next_power_of_two().ilog2() as usize]
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
