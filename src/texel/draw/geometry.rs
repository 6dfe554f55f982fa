//! What surfaces of one mesh share: facets and slots.

use bevy::asset::{Assets, Handle};
use bevy::camera::primitives::Aabb;
use bevy::log::warn;
use bevy::math::{UVec3, Vec3};
use bevy::mesh::Mesh;
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
    /// Slots of each facet across u, v and w.
    counts: [Vec<usize>; 3],
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
    /// Of facets, for volumes of which there are so many slices.
    pub(crate) fn new(
        found: &SurfaceFacets,
        most: UVec3,
        meshes: &mut Assets<Mesh>,
        buffers: &mut Assets<ShaderBuffer>,
    ) -> Self {
        let facets = &found.facets;
        let (counts, most) = count_slots(facets, most);
        let records = records(found);
        Self {
            slots: add_slots(&counts, meshes),
            facets: buffers.add(facet_buffer(&records)),
            bounds: bounds(facets),
            most,
            counts,
            records,
        }
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
        let (counts, most) = count_slots(facets, most);
        if counts == self.counts {
            // The buffer is written, and stays where it is.
            if let Some(mut buffer) = buffers.get_mut(&self.facets) {
                *buffer = facet_buffer(&records);
            }
            self.records = records;
            return false;
        }
        self.slots = add_slots(&counts, meshes);
        self.facets = buffers.add(facet_buffer(&records));
        (self.records, self.counts, self.most) = (records, counts, most);
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

/// Slots for each facet, and the most slices a texel; fewer than `most` if there were too many slots.
fn count_slots(facets: &[Facet], most: UVec3) -> ([Vec<usize>; 3], UVec3) {
    let mut fewer = most;
    let counts = SliceAxis::ALL.map(|axis| {
        loop {
            let most = &mut fewer[axis.index()];
            let counts: Vec<usize> = facets
                .iter()
                .map(|facet| slots_of(facet, axis, *most))
                .collect();
            if *most == 1 || counts.iter().sum::<usize>() <= MAX_SLOTS {
                return counts;
            }
            *most /= 2;
        }
    });
    if fewer != most {
        warn!(
            "a surface of {} facets would need more than {MAX_SLOTS} slices across an axis: a texel gets {fewer} instead \
             of {most}; lower TexelSettings::most_slices, or let fewer texels lie on a facet",
            facets.len()
        );
    }
    (counts, fewer)
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
