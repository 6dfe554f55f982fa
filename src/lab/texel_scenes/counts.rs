//! How many slices a view shows.

use bevy::prelude::*;

use crate::lab::studio::{Lens, Shot};
use crate::texel::facet::{Facet, slice_range};
use crate::texel::{
    ReferenceVolume, SliceAxis, SliceBoxes, SliceSets, TexelSettings, TexelView, VolumeMeasure,
    choose_fading,
};

/// What facets are drawn by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SliceCounts {
    /// Facets that may be seen.
    pub facets: usize,
    /// Slices on them: a line of a facet in each case, or a triangle.
    pub slices: usize,
    /// Triangles of these slices: two a slice, one where slices are parallel to the surface.
    pub triangles: usize,
}

/// Counts what a view shows of facets in world space, with what fades in and out, and without slices that show nothing.
pub(crate) fn count(
    facets: &[Facet],
    volume: &ReferenceVolume,
    boxes: &SliceBoxes,
    shot: &Shot,
    settings: &TexelSettings,
) -> SliceCounts {
    let measure = VolumeMeasure::of(volume, settings.most_slices);
    let view = texel_view(shot);
    let mut counts = SliceCounts::default();
    for facet in facets {
        let all = choose_fading(facet, &measure, &view, &settings.quality);
        let mut is_seen = false;
        for best in all.iter().flatten() {
            let Some(drawn) = best.drawn(settings.fade) else {
                continue;
            };
            let axis = best.axis;
            let is_drawn = |slice: &i32| {
                settings.empty_slices
                    || boxes
                        .trim(facet.uvs, axis, *slice, &drawn, best.footprint)
                        .is_some()
            };
            let range = slice_range(facet.uvs, axis, drawn.count, drawn.apart);
            let slices = range.filter(is_drawn).count();
            is_seen = true;
            counts.slices += slices;
            counts.triangles += slices * if axis == SliceAxis::W { 1 } else { 2 };
        }
        counts.facets += usize::from(is_seen);
    }
    counts
}

/// Bytes on the device of a volume and of what covers facets: slices of all sets with their mip levels, colours and
/// normals, uncompressed; and records of facets. Lists of slices come to 32 bytes for each that a view shows.
pub fn texel_bytes(facets: &[Facet], volume: &ReferenceVolume, most: u32) -> usize {
    const RECORD: usize = 144;
    SliceSets::new(volume, most).bytes() + facets.len() * RECORD
}

/// A shot as slices are chosen by.
pub fn texel_view(shot: &Shot) -> TexelView {
    let transform = shot.transform();
    let forward = *transform.forward();
    let size = shot.size.as_vec2();
    let mut half_spaces = [Vec4::ZERO; 6];
    let (direction, pixels) = match shot.lens {
        Lens::Perspective(fov) => {
            let tan = Vec2::new((0.5 * fov).tan() * size.x / size.y, (0.5 * fov).tan());
            let sides = [
                (*transform.right(), tan.x),
                (*transform.left(), tan.x),
                (*transform.up(), tan.y),
                (*transform.down(), tan.y),
            ];
            for (half_space, (side, tan)) in half_spaces.iter_mut().zip(sides) {
                let normal = (forward * tan + side).normalize();
                *half_space = normal.extend(-normal.dot(shot.eye));
            }
            (None, 0.5 * size.y / (0.5 * fov).tan())
        }
        // All of it is counted.
        Lens::Orthographic(height) => (Some(forward), size.y / height),
    };
    TexelView {
        eye: shot.eye,
        direction,
        pixels,
        half_spaces,
    }
}
