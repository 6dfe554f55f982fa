//! From a stack of images: slices that someone has drawn, scanned or rendered.

use bevy::math::{UVec3, Vec3};

use super::super::color::SrgbTable;
use super::super::error::TexelError;
use super::super::progress::{BuildStep, Progress};
use super::draft::{Cell, Draft, Mark};
use super::{BuildReport, Built, VolumeSettings};

/// One slice.
#[derive(Clone, Debug, PartialEq)]
pub struct StackImage {
    /// Width and height, along u and v.
    pub size: [u32; 2],
    /// sRGB colour and alpha, row by row along v.
    pub pixels: Vec<[u8; 4]>,
}

/// Builds a volume from slices along w, the lowest first: as many as `settings.size.z`, a power of two, all of one
/// size.
///
/// Alpha of 128 and more is opaque, less is empty. Normals point to where there is less around a voxel: against the
/// gradient of opacity over its 26 neighbours.
///
/// # Errors
/// When images differ in size or number from `settings.size`, or the volume is refused
/// (see [`ReferenceVolume`](super::super::ReferenceVolume)).
pub fn from_images(
    images: &[StackImage],
    settings: &VolumeSettings,
    progress: Progress,
) -> Result<Built, TexelError> {
    let volume = settings.size.truncate().to_array();
    let first = images.first().map_or(volume, |image| image.size);
    if let Some(image) = images.iter().position(|image| image.size != first) {
        return Err(TexelError::ImageSize {
            image,
            found: images[image].size,
            expected: first,
        });
    }
    if first != volume {
        return Err(TexelError::SourceSize {
            what: "image",
            found: first,
            expected: volume,
        });
    }
    if images.len() != settings.size.z as usize {
        return Err(TexelError::Count {
            what: "images",
            found: images.len(),
            expected: settings.size.z as usize,
        });
    }
    let mut draft = Draft::new(settings.size, settings.lengths, settings.topology)?;
    let layer = draft.layer();
    let table = SrgbTable::new();
    for (image, cells) in images.iter().zip(draft.cells.chunks_mut(layer)) {
        if image.pixels.len() != layer {
            return Err(TexelError::Count {
                what: "pixels in an image",
                found: image.pixels.len(),
                expected: layer,
            });
        }
        for (&[r, g, b, alpha], cell) in image.pixels.iter().zip(cells) {
            if alpha >= 128 {
                *cell = Cell::coloured(table.decode([r, g, b]), Vec3::Z);
            }
        }
    }
    let normals = opacity_normals(&draft);
    for (cell, normal) in draft.cells.iter_mut().zip(normals) {
        cell.normal = normal;
    }
    progress(BuildStep::Slicing, 1.0);
    let report = BuildReport {
        surface_voxels: draft.count(Mark::Coloured),
        ..BuildReport::default()
    };
    draft.finish(report, progress)
}

/// Against the gradient of opacity, in metres. Below the volume all is as opaque as its lowest slice.
fn opacity_normals(draft: &Draft) -> Vec<Vec3> {
    let UVec3 {
        x: width,
        y: height,
        z: layers,
    } = draft.size;
    let voxel = draft.lengths / draft.size.as_vec3();
    let mut normals = Vec::with_capacity(draft.cells.len());
    for z in 0..layers {
        for y in 0..height {
            for x in 0..width {
                let mut normal = Vec3::ZERO;
                if draft.cells[draft.index(x, y, z)].mark == Mark::Coloured {
                    for [dx, dy, dz] in (0..27).map(|i| [i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1]) {
                        let down = if z == 0 { dz.max(0) } else { dz };
                        let opaque = draft
                            .beside([x, y, z], [dx, dy, down])
                            .is_some_and(|index| draft.cells[index].mark == Mark::Coloured);
                        if opaque {
                            // A neighbour at distance r weighs 1/r, as one of a Sobel filter does.
                            let step = Vec3::new(dx as f32, dy as f32, dz as f32);
                            normal -= step / step.length().max(1.0) / voxel;
                        }
                    }
                }
                normals.push(normal);
            }
        }
    }
    normals
}
