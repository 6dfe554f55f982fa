//! From a height field (§3.3).

use bevy::math::{UVec2, Vec3};

use super::super::color::SrgbTable;
use super::super::error::TexelError;
use super::super::progress::{BuildStep, Progress};
use super::super::topology::Topology;
use super::draft::{Cell, Draft, Mark};
use super::{BuildReport, Built, VolumeSettings};

/// Heights over the surface, with colours.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightField {
    /// Width and height: those of the volume along u and v.
    pub size: UVec2,
    /// From 0, the bottom of the volume, to 1, its top; what is outside is clamped. Row by row, along v.
    pub heights: Vec<f32>,
    /// sRGB colours, one for each height.
    pub colors: Vec<[u8; 3]>,
    /// Normals of the function that the heights are samples of, in metres; of any length, one for each height. If there
    /// are none they are taken from the differences of neighbouring heights.
    pub normals: Option<Vec<Vec3>>,
}

impl HeightField {
    /// A height field of one colour.
    pub fn new(size: UVec2, heights: Vec<f32>, color: [u8; 3]) -> Self {
        Self {
            size,
            colors: vec![color; heights.len()],
            heights,
            normals: None,
        }
    }

    /// Normals by the gradient: differences between the neighbours on both sides, or between one and the pixel itself
    /// at the border of an isolated field.
    fn normal(&self, x: u32, y: u32, settings: &VolumeSettings) -> Vec3 {
        let height = |x: u32, y: u32| self.heights[(y * self.size.x + x) as usize].clamp(0.0, 1.0);
        let wraps = settings.topology == Topology::Tiling;
        let around = |at: u32, side: u32| {
            let before = if at > 0 {
                at - 1
            } else if wraps {
                side - 1
            } else {
                at
            };
            let after = if at + 1 < side {
                at + 1
            } else if wraps {
                0
            } else {
                at
            };
            let steps = if wraps { 2 } else { after - before };
            (before, after, steps.max(1) as f32)
        };
        let (left, right, u_steps) = around(x, self.size.x);
        let (near, far, v_steps) = around(y, self.size.y);
        let lengths = settings.lengths;
        let du = u_steps * lengths.x / self.size.x as f32;
        let dv = v_steps * lengths.y / self.size.y as f32;
        Vec3::new(
            (height(left, y) - height(right, y)) * lengths.z / du,
            (height(x, near) - height(x, far)) * lengths.z / dv,
            1.0,
        )
    }
}

/// Builds a volume from a height field.
///
/// A column is opaque up to the slice border nearest to its height; one voxel at least, unless the height is 0, which
/// leaves the column empty. Errors of height are at most half a slice, and heights lower than a slice one slice.
///
/// # Errors
/// When lists and sizes don't agree, a height or a normal is no number, or the volume is refused
/// (see [`ReferenceVolume`](super::super::ReferenceVolume)): an isolated field is 0 along its border.
pub fn from_height_field(
    field: &HeightField,
    settings: &VolumeSettings,
    progress: Progress,
) -> Result<Built, TexelError> {
    let mut draft = Draft::new(settings.size, settings.lengths, settings.topology)?;
    check(field, settings)?;
    let (layer, layers) = (draft.layer(), draft.size.z as usize);
    let table = SrgbTable::new();
    for column in 0..layer {
        let height = field.heights[column].clamp(0.0, 1.0);
        if height == 0.0 {
            continue;
        }
        let top = ((height * layers as f32).round() as usize).clamp(1, layers) - 1;
        let (x, y) = (column as u32 % field.size.x, column as u32 / field.size.x);
        let normal = match &field.normals {
            Some(normals) => normals[column],
            None => field.normal(x, y, settings),
        };
        let color = table.decode(field.colors[column]);
        draft.cells[top * layer + column] = Cell::coloured(color, normal);
        for z in 0..top {
            draft.cells[z * layer + column].mark = Mark::Inside;
        }
    }
    progress(BuildStep::Slicing, 1.0);
    let report = BuildReport {
        surface_voxels: draft.count(Mark::Coloured),
        ..BuildReport::default()
    };
    draft.fill(settings.spreading, report, progress)
}

fn check(field: &HeightField, settings: &VolumeSettings) -> Result<(), TexelError> {
    let pixels = settings.size.x as usize * settings.size.y as usize;
    let normals = field.normals.as_ref().map_or(pixels, Vec::len);
    if field.size != settings.size.truncate() {
        return Err(TexelError::SourceSize {
            what: "height field",
            found: field.size.to_array(),
            expected: settings.size.truncate().to_array(),
        });
    }
    for (what, found) in [
        ("heights", field.heights.len()),
        ("colours", field.colors.len()),
        ("normals", normals),
    ] {
        if found != pixels {
            return Err(TexelError::Count {
                what,
                found,
                expected: pixels,
            });
        }
    }
    let pixel = |index: usize| (index as u32 % field.size.x, index as u32 / field.size.x);
    if let Some(index) = field.heights.iter().position(|height| height.is_nan()) {
        let ((x, y), height) = (pixel(index), field.heights[index]);
        return Err(TexelError::Height { x, y, height });
    }
    let mut normals = field.normals.iter().flatten().enumerate();
    match normals.find(|(_, normal)| !normal.is_finite()) {
        Some((index, &normal)) => {
            let (x, y) = pixel(index);
            Err(TexelError::HeightNormal { x, y, normal })
        }
        None => Ok(()),
    }
}
