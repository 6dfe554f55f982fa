//! What surfaces of one mesh share: facets.

use core::ops::Range;
use std::sync::Arc;

use bevy::camera::primitives::Aabb;
use bevy::log::{error, warn};
use bevy::math::{UVec3, Vec3, Vec3A};
use bevy::mesh::Mesh;

use super::super::axis::SliceAxis;
use super::super::facet::{Facet, Surface, SurfaceFacets};
use super::component::TexelHeights;
use super::limit::{MAX_SLICES, most_on_facet};
use super::records::FacetRecord;
use super::room::{FacetRoom, FacetSpace};
use super::surface_mesh::{TexelSurfaceError, surface};

/// The facets of a mesh.
pub(crate) struct Geometry {
    pub facets: Arc<[Facet]>,
    /// Where they are on the GPU.
    pub room: Arc<FacetRoom>,
    bounds: Aabb,
    /// Length of the longest height vector.
    tallest: f32,
    /// The most slices a texel that may be shown, of volumes that have so many; none if these are too many.
    limits: Vec<(UVec3, Option<UVec3>)>,
    pub records: Arc<[FacetRecord]>,
    /// Records that were changed in this frame.
    pub changed: Vec<Range<usize>>,
    /// Whether it came to its room in this frame.
    pub is_new: bool,
}

/// Records between two changed ones that are written along with them, rather than these apart.
const LEAST_GAP: usize = 4;

/// The facets of a mesh with texels as thick, or with other height vectors than its own, on a device that takes `most`.
pub(crate) fn facets(
    mesh: &Mesh,
    thickness: f32,
    heights: Option<&TexelHeights>,
    most: usize,
) -> Result<SurfaceFacets, TexelSurfaceError> {
    facets_within(&completed(mesh, thickness, heights)?, most)
}

/// The facets of a completed surface on a device that takes `most`. Those that are left out count: there is room for
/// them, so that they may come back.
pub(crate) fn facets_within(
    surface: &Surface,
    most: usize,
) -> Result<SurfaceFacets, TexelSurfaceError> {
    let facets = surface.triangles.len();
    if facets > most {
        return Err(TexelSurfaceError::TooManyFacets { facets, most });
    }
    Ok(surface.completed_facets())
}

/// The surface of a mesh, with the height vectors that it is covered by.
pub(crate) fn completed(
    mesh: &Mesh,
    thickness: f32,
    heights: Option<&TexelHeights>,
) -> Result<Surface, TexelSurfaceError> {
    if !(thickness.is_finite() && thickness > 0.0) {
        return Err(TexelSurfaceError::Thickness(thickness));
    }
    let mut surface = surface(mesh)?;
    if let Some(heights) = heights {
        surface.heights.clone_from(&heights.0);
    }
    surface.complete(thickness)?;
    Ok(surface)
}

impl Geometry {
    /// Of the facets of a mesh, with a room in buffers that hold `most` each.
    pub(crate) fn new(found: &SurfaceFacets, space: &FacetSpace, most: usize) -> Self {
        Self {
            facets: found.facets.as_slice().into(),
            room: space.room(found.facets.len() + found.left_out.len(), most),
            bounds: bounds(&found.facets),
            tallest: tallest(&found.facets),
            limits: Vec::new(),
            records: records(found).into(),
            changed: Vec::new(),
            is_new: true,
        }
    }

    /// Follows facets that may have changed.
    pub(crate) fn renew(&mut self, found: &SurfaceFacets, space: &FacetSpace, most: usize) {
        let before = core::mem::replace(&mut self.records, records(found).into());
        if self.records == before {
            return;
        }
        self.bounds = bounds(&found.facets);
        self.tallest = tallest(&found.facets);
        self.facets = found.facets.as_slice().into();
        let uvs =
            |records: &[FacetRecord]| -> Vec<_> { records.iter().map(FacetRecord::uvs).collect() };
        if uvs(&self.records) != uvs(&before) {
            // How many slices there may be depends on texture coordinates alone.
            self.limits.clear();
        }
        if self.records.len() <= self.room.range.len() {
            self.changed.extend(changed(&before, &self.records));
        } else {
            self.room = space.room(self.records.len(), most);
            self.is_new = true;
        }
    }

    /// Begins a frame in which nothing has changed yet.
    pub(crate) fn settle(&mut self) {
        self.changed.clear();
        self.is_new = false;
    }

    /// The most slices a texel that may be shown of a volume that has so many. None, and a message once, if even the fewest
    /// are too many.
    pub(crate) fn most(&mut self, most: UVec3) -> Option<UVec3> {
        if let Some((_, limit)) = self.limits.iter().find(|(of, _)| *of == most) {
            return *limit;
        }
        let limit = limit(&self.facets, most, MAX_SLICES);
        self.limits.push((most, limit));
        limit
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

/// Where records differ from those before, or are new.
fn changed(before: &[FacetRecord], records: &[FacetRecord]) -> Vec<Range<usize>> {
    let mut ranges: Vec<Range<usize>> = Vec::new();
    for (i, record) in records.iter().enumerate() {
        if before.get(i) == Some(record) {
            continue;
        }
        match ranges.last_mut() {
            Some(last) if i < last.end + LEAST_GAP => last.end = i + 1,
            _ => ranges.push(i..i + 1),
        }
    }
    ranges
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
fn limit(facets: &[Facet], most: UVec3, most_slices: usize) -> Option<UVec3> {
    let mut fewer = most;
    for axis in SliceAxis::ALL {
        let most = &mut fewer[axis.index()];
        loop {
            let counts = facets.iter().map(|facet| most_on_facet(facet, axis, *most));
            let slices = counts.fold(0usize, usize::saturating_add);
            // One slice a facet is what any mesh takes.
            if slices <= most_slices.max(facets.len()) {
                break;
            }
            if *most == 1 {
                error!(
                    "a surface of {} facets carries no texels: with one slice each across an axis there would be {slices}, \
                     more than {most_slices}. Its texture coordinates go over too many texels: scale them down, or \
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
            "a surface of {} facets would need more than {most_slices} slices across an axis: a texel gets {fewer} instead \
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
    fn records_that_changed_are_told_in_few_ranges() {
        let facet = Facet {
            positions: [Vec3::ZERO, Vec3::X, Vec3::Y],
            heights: [Vec3::Z; 3],
            uvs: [Vec2::ZERO, Vec2::X, Vec2::Y],
        };
        let before = vec![FacetRecord::new(&facet, &[Vec3::Z; 3]); 20];
        let mut after = before.clone();
        after.push(before[0]);
        for i in [3, 6, 12] {
            after[i] = FacetRecord::new(&facet, &[Vec3::X; 3]);
        }
        assert!(changed(&before, &before).is_empty());
        assert_eq!(changed(&before, &after), [3..7, 12..13, 20..21]);
        let fewer = changed(&after, &before[..5]);
        assert_eq!(fewer.as_slice(), core::slice::from_ref(&(3..4)));
    }

    #[test]
    fn facets_stay_in_their_room_as_long_as_it_holds_them() {
        let found = |count: usize, height: f32| {
            let facet = Facet {
                positions: [Vec3::ZERO, Vec3::X, Vec3::Y],
                heights: [Vec3::Z * height; 3],
                uvs: [Vec2::ZERO, Vec2::X, Vec2::Y],
            };
            SurfaceFacets {
                facets: vec![facet; count],
                normals: vec![[Vec3::Z; 3]; count],
                triangles: (0..count as u32).collect(),
                left_out: Vec::new(),
            }
        };
        let space = FacetSpace::default();
        let mut geometry = Geometry::new(&found(5, 1.0), &space, 100);
        let beside = space.room(3, 100);
        assert!(geometry.is_new);
        geometry.settle();
        geometry.renew(&found(5, 1.0), &space, 100);
        assert!(!geometry.is_new && geometry.changed.is_empty());
        geometry.renew(&found(4, 2.0), &space, 100);
        assert_eq!((&geometry.room.range, geometry.is_new), (&(0..5), false));
        assert_eq!(geometry.changed.as_slice(), core::slice::from_ref(&(0..4)));
        geometry.settle();
        geometry.renew(&found(6, 2.0), &space, 100);
        assert_eq!((&geometry.room.range, geometry.is_new), (&(8..14), true));
        assert_eq!(beside.range, 5..8);
    }

    /// One whose texture coordinates go over so many texels along u.
    fn facet(across: f32) -> Facet {
        Facet {
            positions: [Vec3::ZERO, Vec3::X, Vec3::Y],
            heights: [Vec3::Z; 3],
            uvs: [Vec2::ZERO, Vec2::X * across, Vec2::Y],
        }
    }

    #[test]
    fn texture_coordinates_over_too_many_texels_are_refused_and_many_are_met_by_fewer_slices() {
        let most = UVec3::splat(256);
        let limit = |facets: &[Facet], most| limit(facets, most, MAX_SLICES);
        assert_eq!(limit(&[facet(1.0)], most), Some(most));
        let fewer = limit(&[facet(2e4)], most).expect("fewer slices may be shown");
        assert!(fewer.x < 256 && fewer.x > 1, "{fewer}");
        assert!(most_on_facet(&facet(2e4), SliceAxis::U, fewer.x) <= MAX_SLICES);
        for across in [1e8, 1e30] {
            assert_eq!(limit(&[facet(across)], most), None, "{across}");
        }
    }

    #[test]
    fn any_mesh_takes_one_slice_a_facet() {
        let facets = vec![facet(1.0); 101];
        assert_eq!(limit(&facets, UVec3::splat(2), 100), Some(UVec3::ONE));
    }
}
