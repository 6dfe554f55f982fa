//! What surfaces of one mesh share: facets and slots.

use bevy::asset::{Assets, Handle};
use bevy::camera::primitives::Aabb;
use bevy::log::{error, warn};
use bevy::math::{UVec3, Vec3};
use bevy::mesh::Mesh;
use bevy::prelude::default;
use bevy::render::storage::ShaderBuffer;

use super::super::axis::SliceAxis;
use super::super::facet::{Facet, SurfaceFacets};
use super::component::TexelHeights;
use super::records::{FacetRecord, facet_buffer};
use super::slots::{MAX_SLOTS, slot_mesh, slots_of};
use super::surface_mesh::{TexelSurfaceError, surface};

/// The facets of a mesh, on the GPU.
pub(crate) struct Geometry {
    /// Slots across u, v and w.
    pub slots: [Handle<Mesh>; 3],
    pub facets: Handle<ShaderBuffer>,
    pub bounds: Aabb,
    /// The most slices a texel that there are slots for.
    pub most: UVec3,
    records: Vec<FacetRecord>,
}

/// The facets of a mesh with texels as thick, or with other height vectors than its own.
pub(crate) fn facets(
    mesh: &Mesh,
    thickness: f32,
    heights: Option<&TexelHeights>,
) -> Result<SurfaceFacets, TexelSurfaceError> {
    if !(thickness.is_finite() && thickness > 0.0) {
        return Err(TexelSurfaceError::Thickness(thickness));
    }
    let mut surface = surface(mesh)?;
    if let Some(heights) = heights {
        surface.heights.clone_from(&heights.0);
    }
    Ok(surface.facets(thickness)?)
}

impl Geometry {
    /// Of facets, for volumes of which there are so many slices. None, and a message, if they need too many slots.
    pub(crate) fn new(
        found: &SurfaceFacets,
        most: UVec3,
        meshes: &mut Assets<Mesh>,
        buffers: &mut Assets<ShaderBuffer>,
    ) -> Option<Self> {
        let facets = &found.facets;
        let (counts, most) = count_slots(facets, most)?;
        let records = records(found);
        Some(Self {
            slots: add_slots(&counts, meshes),
            facets: buffers.add(facet_buffer(&records)),
            bounds: bounds(facets),
            most,
            records,
        })
    }

    /// Follows facets that may have changed. Materials must be made anew if this tells so.
    pub(crate) fn renew(
        &mut self,
        found: &SurfaceFacets,
        most: UVec3,
        meshes: &mut Assets<Mesh>,
        buffers: &mut Assets<ShaderBuffer>,
    ) -> bool {
        let (facets, records) = (&found.facets, records(found));
        if records == self.records {
            return false;
        }
        self.bounds = bounds(facets);
        // Slots depend on texture coordinates alone.
        let uvs =
            |records: &[FacetRecord]| records.iter().map(FacetRecord::uvs).collect::<Vec<_>>();
        if uvs(&records) == uvs(&self.records) {
            // The buffer is written, and stays where it is.
            if let Some(mut buffer) = buffers.get_mut(&self.facets) {
                *buffer = facet_buffer(&records);
            }
            self.records = records;
            return false;
        }
        let Some((counts, most)) = count_slots(facets, most) else {
            return true;
        };
        self.slots = add_slots(&counts, meshes);
        self.facets = buffers.add(facet_buffer(&records));
        (self.records, self.most) = (records, most);
        true
    }
}

fn records(found: &SurfaceFacets) -> Vec<FacetRecord> {
    let both = found.facets.iter().zip(&found.normals);
    both.map(|(facet, normals)| FacetRecord::new(facet, normals))
        .collect()
}

fn add_slots(counts: &[Vec<usize>; 3], meshes: &mut Assets<Mesh>) -> [Handle<Mesh>; 3] {
    counts
        .each_ref()
        .map(|counts| meshes.add(slot_mesh(counts.iter().copied())))
}

/// Slots for each facet, and the most slices a texel; fewer than `most` if there were too many slots. None, and a message,
/// if one slice a texel is too many already.
fn count_slots(facets: &[Facet], most: UVec3) -> Option<([Vec<usize>; 3], UVec3)> {
    let mut fewer = most;
    let mut counts: [Vec<usize>; 3] = default();
    for (axis, counts) in SliceAxis::ALL.into_iter().zip(&mut counts) {
        let most = &mut fewer[axis.index()];
        loop {
            counts.clear();
            counts.extend(facets.iter().map(|facet| slots_of(facet, axis, *most)));
            let slots = counts.iter().fold(0usize, |sum, n| sum.saturating_add(*n));
            // One slot a facet is what any mesh takes.
            if slots <= MAX_SLOTS.max(facets.len()) {
                break;
            }
            if *most == 1 {
                error!(
                    "a surface of {} facets carries no texels: with one slice each across an axis there would be {slots}, \
                     more than {MAX_SLOTS}. Its texture coordinates go over too many texels: scale them down, or \
                     subdivide the mesh into several",
                    facets.len()
                );
                return None;
            }
            *most /= 2;
        }
    }
    if fewer != most {
        warn!(
            "a surface of {} facets would need more than {MAX_SLOTS} slices across an axis: a texel gets {fewer} instead \
             of {most}; lower TexelSettings::most_slices, or let fewer texels lie on a facet",
            facets.len()
        );
    }
    Some((counts, fewer))
}

fn bounds(facets: &[Facet]) -> Aabb {
    let corners = facets
        .iter()
        .flat_map(|facet| [facet.corners(0.0), facet.corners(1.0)]);
    let (min, max) = corners
        .flatten()
        .fold((Vec3::MAX, Vec3::MIN), |(min, max), corner| {
            (min.min(corner), max.max(corner))
        });
    Aabb::from_min_max(min, max)
}

#[cfg(test)]
mod tests {
    use bevy::math::Vec2;

    use super::*;

    #[test]
    fn texture_coordinates_over_too_many_texels_are_refused_and_many_are_met_by_fewer_slices() {
        let facet = |across: f32| Facet {
            positions: [Vec3::ZERO, Vec3::X, Vec3::Y],
            heights: [Vec3::Z; 3],
            uvs: [Vec2::ZERO, Vec2::X * across, Vec2::Y],
        };
        let most = UVec3::splat(256);
        let (_, all) = count_slots(&[facet(1.0)], most).expect("few texels have slots");
        assert_eq!(all, most);
        let (counts, fewer) = count_slots(&[facet(2e4)], most).expect("fewer slices have slots");
        assert!(fewer.x < 256 && fewer.x > 1, "{fewer}");
        assert!(counts[0].iter().sum::<usize>() <= MAX_SLOTS);
        for across in [1e8, 1e30] {
            assert!(count_slots(&[facet(across)], most).is_none(), "{across}");
        }
    }
}
