//! A volume that is being built: linear colours, and marks.

use bevy::math::{UVec3, Vec3};

use super::super::color::{SrgbTable, encode_normal};
use super::super::error::TexelError;
use super::super::parallel::for_each_chunk;
use super::super::progress::{BuildStep, Progress};
use super::super::topology::Topology;
use super::super::volume::{ReferenceVolume, VolumeParts, check_size};
use super::close::close;
use super::spread::{Spreading, spread};
use super::{BuildReport, Built};

/// What a voxel is known to be.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Mark {
    /// Outside the shape.
    #[default]
    Empty,
    /// Inside, without a colour yet.
    Inside,
    /// Opaque, with a colour and a normal.
    Coloured,
}

/// A voxel of a draft.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Cell {
    /// Linear colour.
    pub color: Vec3,
    /// Normal, of any length, in metres of the volume's box.
    pub normal: Vec3,
    /// What it is.
    pub mark: Mark,
}

impl Cell {
    /// An opaque voxel.
    pub fn coloured(color: Vec3, normal: Vec3) -> Self {
        Self {
            color,
            normal,
            mark: Mark::Coloured,
        }
    }
}

/// A volume that is being built.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Draft {
    pub size: UVec3,
    pub lengths: Vec3,
    pub topology: Topology,
    /// x fastest, then y, then z.
    pub cells: Vec<Cell>,
}

impl Draft {
    /// An empty volume.
    pub fn new(size: UVec3, lengths: Vec3, topology: Topology) -> Result<Self, TexelError> {
        check_size(size, lengths)?;
        Ok(Self {
            size,
            lengths,
            topology,
            cells: vec![Cell::default(); size.element_product() as usize],
        })
    }

    /// Voxels of one slice along w.
    pub fn layer(&self) -> usize {
        (self.size.x * self.size.y) as usize
    }

    /// Index of a voxel.
    pub fn index(&self, x: u32, y: u32, z: u32) -> usize {
        ((z * self.size.y + y) * self.size.x + x) as usize
    }

    /// Index of the voxel at some distance from another: round the border of a tiling volume, and none beyond other
    /// borders.
    pub fn beside(&self, [x, y, z]: [u32; 3], step: [i32; 3]) -> Option<usize> {
        let along = |at: u32, step: i32, side: u32, wraps: bool| {
            let at = at as i32 + step;
            if wraps {
                Some(at.rem_euclid(side as i32) as u32)
            } else {
                (0..side as i32).contains(&at).then_some(at as u32)
            }
        };
        let wraps = self.topology == Topology::Tiling;
        Some(self.index(
            along(x, step[0], self.size.x, wraps)?,
            along(y, step[1], self.size.y, wraps)?,
            along(z, step[2], self.size.z, false)?,
        ))
    }

    /// How many voxels have a mark.
    pub fn count(&self, mark: Mark) -> usize {
        self.cells.iter().filter(|cell| cell.mark == mark).count()
    }

    /// Closes contours, spreads colours, and makes the volume. `report` has what is known so far.
    pub fn fill(
        mut self,
        spreading: Spreading,
        mut report: BuildReport,
        progress: Progress,
    ) -> Result<Built, TexelError> {
        report.closing_voxels = close(&mut self);
        progress(BuildStep::Filling, 1.0);
        report.inside_voxels = self.count(Mark::Inside);
        spread(&mut self, spreading, progress);
        self.finish(report, progress)
    }

    /// Makes the volume.
    pub fn finish(self, mut report: BuildReport, progress: Progress) -> Result<Built, TexelError> {
        progress(BuildStep::Spreading, 1.0);
        let table = SrgbTable::new();
        let mut voxels = vec![([0; 4], [0; 4]); self.cells.len()];
        for_each_chunk(&mut voxels, self.layer(), |z, layer| {
            let cells = &self.cells[z * self.layer()..];
            for ((color, normal), cell) in layer.iter_mut().zip(cells) {
                if cell.mark == Mark::Coloured {
                    let [r, g, b] = table.encode(cell.color);
                    *color = [r, g, b, 255];
                    let [x, y, z] = encode_normal(cell.normal);
                    *normal = [x, y, z, 255];
                }
            }
        });
        let (colors, normals) = voxels.into_iter().unzip();
        let parts = VolumeParts {
            size: self.size,
            lengths: self.lengths,
            topology: self.topology,
            colors,
            normals,
        };
        let volume = ReferenceVolume::new(parts, progress)?;
        report.topology = volume.topology_report();
        Ok(Built { volume, report })
    }
}
