//! What surfaces of one mesh share: facets.

use std::sync::Arc;

use bevy::asset::{Assets, Handle};
use bevy::camera::primitives::Aabb;
use bevy::log::{error, warn};
use bevy::math::{UVec3, Vec3, Vec3A};
use bevy::mesh::Mesh;
use bevy::render::storage::ShaderBuffer;

use super::super::axis::SliceAxis;
use super::super::facet::{Facet, SurfaceFacets};
use super::component::TexelHeights;
use super::limit::{MAX_SLICES, most_on_facet};
use super::records::{FacetRecord, facet_buffer};
use super::surface_mesh::{TexelSurfaceError, surface};

/// The facets of a mesh.
pub(crate) struct Geometry {
    pub facets: Arc<[Facet]>,
    /// The same on the GPU.
    pub buffer: Handle<ShaderBuffer>,
    bounds: Aabb,
    /// Length of the longest height vector.
    tallest: f32,
    /// The most slices a texel that may be shown.
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
    /// Of facets, for volumes of which there are so many slices. None, and a message, if they would show too many.
    pub(crate) fn new(
        found: &SurfaceFacets,
        most: UVec3,
        buffers: &mut Assets<ShaderBuffer>,
    ) -> Option<Self> {
        let most = limit(&found.facets, most)?;
        let records = records(found);
        Some(Self {
            facets: found.facets.as_slice().into(),
            buffer: buffers.add(facet_buffer(&records)),
            bounds: bounds(&found.facets),
            tallest: tallest(&found.facets),
            most,
            records,
        })
    }

    /// Follows facets that may have changed. Materials must be made anew if this tells so.
    pub(crate) fn renew(
        &mut self,
        found: &SurfaceFacets,
        most: UVec3,
        buffers: &mut Assets<ShaderBuffer>,
    ) -> bool {
        let records = records(found);
        if records == self.records {
            return false;
        }
        self.bounds = bounds(&found.facets);
        self.tallest = tallest(&found.facets);
        self.facets = found.facets.as_slice().into();
        let uvs =
            |records: &[FacetRecord]| records.iter().map(FacetRecord::uvs).collect::<Vec<_>>();
        if uvs(&records) != uvs(&self.records) {
            // How many slices there may be depends on texture coordinates alone.
            let Some(most) = limit(&found.facets, most) else {
                return true;
            };
            self.most = most;
        }
        let is_as_long = records.len() == self.records.len();
        self.records = records;
        if is_as_long && let Some(mut buffer) = buffers.get_mut(&self.buffer) {
            // It is written, and stays where it is.
            *buffer = facet_buffer(&self.records);
            return false;
        }
        self.buffer = buffers.add(facet_buffer(&self.records));
        true
    }

    /// A box that holds all slices, whichever way the wind bends height vectors if they are flexible.
    pub(crate) fn bounds_in_wind(&self, flexibility: f32) -> Aabb {
        let mut bounds = self.bounds;
        if flexibility != 0.0 {
            bounds.half_extents += Vec3A::splat(self.tallest);
        }
        bounds
    }
}

fn tallest(facets: &[Facet]) -> f32 {
    let heights = facets.iter().flat_map(|facet| facet.heights);
    heights.map(Vec3::length).fold(0.0, f32::max)
}

fn records(found: &SurfaceFacets) -> Vec<FacetRecord> {
    let both = found.facets.iter().zip(&found.normals);
    both.map(|(facet, normals)| FacetRecord::new(facet, normals))
        .collect()
}

/// The most slices a texel, fewer than `most` if facets would show too many in all. None, and a message, if one slice a
/// texel is too many already.
fn limit(facets: &[Facet], most: UVec3) -> Option<UVec3> {
    let mut fewer = most;
    for axis in SliceAxis::ALL {
        let most = &mut fewer[axis.index()];
        loop {
            let counts = facets.iter().map(|facet| most_on_facet(facet, axis, *most));
            let slices = counts.fold(0usize, usize::saturating_add);
            // One slice a facet is what any mesh takes.
            if slices <= MAX_SLICES.max(facets.len()) {
                break;
            }
            if *most == 1 {
                error!(
                    "a surface of {} facets carries no texels: with one slice each across an axis there would be {slices}, \
                     more than {MAX_SLICES}. Its texture coordinates go over too many texels: scale them down, or \
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
            "a surface of {} facets would need more than {MAX_SLICES} slices across an axis: a texel gets {fewer} instead \
             of {most}; lower TexelSettings::most_slices, or let fewer texels lie on a facet",
            facets.len()
        );
    }
    Some(fewer)
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
        assert_eq!(limit(&[facet(1.0)], most), Some(most));
        let fewer = limit(&[facet(2e4)], most).expect("fewer slices may be shown");
        assert!(fewer.x < 256 && fewer.x > 1, "{fewer}");
        assert!(most_on_facet(&facet(2e4), SliceAxis::U, fewer.x) <= MAX_SLICES);
        for across in [1e8, 1e30] {
            assert_eq!(limit(&[facet(across)], most), None, "{across}");
        }
    }
}
