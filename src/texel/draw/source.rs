//! What the slices of a surface are chosen from.

use core::ops::Range;
use std::sync::Arc;

use bevy::asset::AssetId;
use bevy::camera::primitives::Aabb;
use bevy::math::primitives::ViewFrustum;
use bevy::math::{Affine3A, Mat4, Vec3, Vec3A, Vec4};
use bevy::prelude::*;

use super::super::choose::{TexelQuality, TexelView, VolumeMeasure, choose_fading};
use super::super::facet::{Facet, bend, slice_range};
use super::super::slice_sets::{SliceBoxes, WHOLE};
use super::component::TexelSettings;
use super::geometry::Geometry;
use super::material::TexelMaterial;
use super::records::SliceRecord;
use super::room::FacetRoom;

/// What of a volume its slices are chosen by.
#[derive(Clone, Debug)]
pub(crate) struct DrawnVolume {
    pub measure: VolumeMeasure,
    pub boxes: Arc<SliceBoxes>,
}

/// What the slices of a surface are chosen from, in each view. On the surface; the plugin keeps it up to date.
#[derive(Component, Clone, Debug)]
pub(crate) struct SliceSource {
    /// In the space of the surface. All pass their check.
    pub facets: Arc<[Facet]>,
    /// Where they are on the GPU.
    pub room: Arc<FacetRoom>,
    /// What holds them.
    bounds: Aabb,
    volume: DrawnVolume,
    settings: TexelSettings,
    /// The children that colours across u, v and w are drawn by, and those for depth.
    pub slices: [Entity; 6],
    /// The first one's material, which stands for all six.
    pub material: AssetId<TexelMaterial>,
}

impl SliceSource {
    pub(crate) fn new(
        geometry: &Geometry,
        bounds: Aabb,
        volume: DrawnVolume,
        settings: TexelSettings,
        slices: [Entity; 6],
        material: AssetId<TexelMaterial>,
    ) -> Self {
        Self {
            facets: geometry.facets.clone(),
            room: geometry.room.clone(),
            bounds,
            volume,
            settings: settings.without_nan(),
            slices,
            material,
        }
    }

    /// Follows facets that have moved. False if they have not.
    pub(crate) fn follow(&mut self, geometry: &Geometry, bounds: Aabb) -> bool {
        let has_moved = !Arc::ptr_eq(&self.facets, &geometry.facets);
        if has_moved {
            self.facets = geometry.facets.clone();
            self.room = geometry.room.clone();
            self.bounds = bounds;
        }
        has_moved
    }

    /// Whether it is drawn as another one is.
    pub(crate) fn is_as(&self, other: &Self) -> bool {
        self.lists_as(other) && self.slices == other.slices && self.material == other.material
    }

    /// Whether its slices are those of another one, wherever they are seen from.
    pub(crate) fn lists_as(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.facets, &other.facets)
            && Arc::ptr_eq(&self.room, &other.room)
            && Arc::ptr_eq(&self.volume.boxes, &other.volume.boxes)
            && self.volume.measure == other.volume.measure
            && self.bounds == other.bounds
            && self.settings == other.settings
    }
}

/// Where and when facets are seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SeenFrom {
    /// With its eye, if it has one, at zero.
    pub view: TexelView,
    /// Where that is in the world.
    pub eye: Vec3,
    /// Whether it is a light that sees.
    pub is_light: bool,
    /// The wind's velocity, and the time in seconds.
    pub wind: Vec3,
    pub time: f32,
}

impl SeenFrom {
    /// How far a place is, or its square, that is `at` from the eye.
    fn far(&self, at: Vec3) -> f32 {
        let direction = self.view.direction;
        direction.map_or(at.length_squared(), |ray| at.dot(ray))
    }
}

impl SliceSource {
    /// What of `from` its slices depend on: where no wind bends it, not the time.
    pub(crate) fn heeded(&self, from: &SeenFrom) -> SeenFrom {
        if from.wind == Vec3::ZERO || self.settings.limited_flexibility() == 0.0 {
            let (wind, time) = (Vec3::ZERO, 0.0);
            SeenFrom {
                wind,
                time,
                ..*from
            }
        } else {
            *from
        }
    }

    /// How far its middle is, to be compared with others in the same view.
    pub(crate) fn far(&self, world_from_local: &Affine3A, from: &SeenFrom) -> f32 {
        let centre = world_from_local.transform_point3a(self.bounds.center);
        from.far(Vec3::from(centre) - from.eye)
    }

    /// Lists the slices that a view has of some facets of a surface placed so, across u, v and w: near facets first, and on
    /// each the nearest slices, so that they hide the far ones. `order` is for facets to be sorted in.
    pub(crate) fn list(
        &self,
        world_from_local: &Affine3A,
        from: &SeenFrom,
        facets: Range<usize>,
        order: &mut Vec<(f32, u32)>,
        lists: &mut [Vec<SliceRecord>; 3],
    ) {
        // From the eye, so that a facet 10 km from the origin is as steady as one at the origin.
        let mut eye_from_local = *world_from_local;
        eye_from_local.translation -= Vec3A::from(from.eye);
        let stretch = eye_from_local.matrix3.x_axis.length();
        let stretch = stretch.max(eye_from_local.matrix3.y_axis.length());
        let stretch = stretch.max(eye_from_local.matrix3.z_axis.length());
        let centre = eye_from_local.transform_point3a(self.bounds.center);
        // Sheared by less than the three axes together could.
        let radius = self.bounds.half_extents.length() * stretch * 3f32.sqrt();
        if !from.view.may_see(centre.into(), radius) {
            return;
        }
        let settings = &self.settings;
        let quality = if from.is_light {
            TexelQuality {
                direction: settings.quality.direction,
                ..settings.shadows
            }
        } else {
            settings.quality
        };
        // Shadows are not seen to pop, and stay whole, of slices in the middles of their layers.
        let fades = settings.fade && !from.is_light;
        let flexibility = settings.limited_flexibility();
        order.clear();
        let numbers = facets.start as u32..;
        order.extend(numbers.zip(&self.facets[facets]).map(|(index, facet)| {
            let at = eye_from_local.transform_point3(facet.positions[0]);
            (from.far(at), index)
        }));
        order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let first = self.room.range.start as u32;
        for &mut (_, index) in order {
            let facet = &self.facets[index as usize];
            let positions = facet
                .positions
                .map(|at| eye_from_local.transform_point3(at));
            let heights = facet.heights.map(|h| eye_from_local.transform_vector3(h));
            let straight = Facet {
                positions,
                heights,
                uvs: facet.uvs,
            };
            let bent = |i: usize| {
                let foot = positions[i] + from.eye;
                bend(foot, heights[i], from.wind, flexibility, from.time)
            };
            let heights = [0, 1, 2].map(bent);
            if heights != straight.heights && !straight.may_bend_to(heights) {
                continue;
            }
            let facet = Facet {
                heights,
                ..straight
            };
            let chosen = choose_fading(&facet, &self.volume.measure, &from.view, &quality);
            for slices in chosen.into_iter().flatten() {
                let Some(drawn) = slices.drawn(fades) else {
                    continue;
                };
                let axis = slices.axis;
                let range = slice_range(facet.uvs, axis, drawn.count, drawn.apart);
                let most = self.volume.measure.most[axis.index()];
                let stand_off = settings.stand_off(&slices, &drawn, most);
                let record = |slice| {
                    let trim = if settings.empty_slices {
                        WHOLE
                    } else {
                        let boxes = &self.volume.boxes;
                        boxes.trim(facet.uvs, axis, slice, &drawn, slices.footprint)?
                    };
                    let facet = first + index;
                    Some(SliceRecord::new(facet, slice, &drawn, stand_off, trim))
                };
                let list = &mut lists[axis.index()];
                if slices.along {
                    list.extend(range.filter_map(record));
                } else {
                    list.extend(range.rev().filter_map(record));
                }
            }
        }
    }
}

/// A view with its eye at zero: f by its projection and the height of its pictures, and the half-spaces that it sees.
pub(crate) fn view_from_eye(
    world_from_view: &Affine3A,
    clip_from_view: &Mat4,
    height: f32,
    half_spaces: Option<&[Vec4; 6]>,
) -> TexelView {
    let eye = Vec3::from(world_from_view.translation);
    let mut sides = [Vec4::ZERO; 6];
    if let Some(half_spaces) = half_spaces {
        for (i, (side, plane)) in sides.iter_mut().zip(half_spaces).enumerate() {
            // What is nearer than a light's near plane casts shadows all the same. An endless one has no far plane.
            if i == ViewFrustum::NEAR_PLANE_IDX || !plane.is_finite() {
                continue;
            }
            *side = plane.truncate().extend(plane.w + plane.truncate().dot(eye));
        }
    }
    let is_orthographic = clip_from_view.w_axis.w == 1.0;
    TexelView {
        eye: Vec3::ZERO,
        direction: is_orthographic.then(|| -Vec3::from(world_from_view.matrix3.z_axis)),
        pixels: 0.5 * clip_from_view.y_axis.y.abs() * height,
        half_spaces: sides,
    }
}
