//! Where crowns are sorted to in the transparent phase, and the bands of those that are drawn in them.

use core::iter::{once, zip};
use core::ops::Range;
use std::sync::Arc;

use bevy::camera::primitives::Aabb;
use bevy::core_pipeline::core_3d::{Transparent3d, TransparentSortingInfo3d};
use bevy::math::Affine3A;
use bevy::mesh::MeshTag;
use bevy::prelude::*;
use bevy::render::Extract;
use bevy::render::render_phase::{SortedRenderPhase, ViewSortedRenderPhases};
use bevy::render::sync_world::MainEntity;
use bevy::render::view::ExtractedView;

use super::bands::CrownBands;
use super::blend::{SliceOrder, ranks_end, slots};
use super::component::SlicedCrown;
use super::eye::{Eye, Seen};
use super::mesh::band_ranks;
use super::slicing::SlicingShape;

/// A crown that is drawn in bands in this frame.
struct CrownInBands {
    world_from_local: Affine3A,
    shape: Arc<SlicingShape>,
    order: SliceOrder,
    /// What draws its bands, far to near, among those of all crowns.
    bands: Range<usize>,
    /// How many ranks each has.
    band_ranks: u32,
    /// Tells it from others.
    seed: u8,
}

/// What is to be sorted to another place than Bevy has it.
#[derive(Resource, Default)]
pub(crate) struct SortedCrowns {
    /// Crowns that have moved in this frame, and their middles. Bevy sorts by where they were when they came into view.
    moved: Vec<(Entity, Vec3)>,
    in_bands: Vec<CrownInBands>,
    bands: Vec<Entity>,
}

/// What is extracted of a crown in bands.
type InBands<'w> = (Entity, &'w CrownBands, &'w GlobalTransform, &'w MeshTag);

/// What tells that a crown has moved.
type Moved = (With<SlicedCrown>, Changed<GlobalTransform>);

/// Takes over into the render world what is to be sorted.
pub(crate) fn extract(
    mut crowns: ResMut<SortedCrowns>,
    moved: Extract<Query<(Entity, &GlobalTransform, &Aabb), Moved>>,
    in_bands: Extract<Query<InBands, With<SlicedCrown>>>,
) {
    let crowns = &mut *crowns;
    crowns.moved.clear();
    crowns.in_bands.clear();
    crowns.bands.clear();
    let moved = moved.iter().map(|(entity, place, bounds)| {
        let middle = place.affine().transform_point3a(bounds.center);
        (entity, middle.into())
    });
    crowns.moved.extend(moved);
    for (entity, bands, place, tag) in &in_bands {
        let start = crowns.bands.len();
        let all = once(entity).chain(bands.children.iter().copied());
        crowns.bands.extend(all);
        let [.., seed] = tag.0.to_le_bytes();
        crowns.in_bands.push(CrownInBands {
            world_from_local: place.affine(),
            shape: bands.shape.clone(),
            order: bands.order,
            bands: start..crowns.bands.len(),
            band_ranks: band_ranks(bands.ranks),
            seed,
        });
    }
}

/// Tells items where they are to be sorted to.
pub(crate) fn place_items(
    crowns: Res<SortedCrowns>,
    views: Query<&ExtractedView>,
    mut phases: ResMut<ViewSortedRenderPhases<Transparent3d>>,
) {
    for view in &views {
        let Some(phase) = phases.get_mut(&view.retained_view_entity) else {
            continue;
        };
        for (crown, middle) in &crowns.moved {
            place(phase, *crown, *middle, 0.0);
        }
        let affine = view.world_from_view.affine();
        let eye = Eye::new(affine, &view.clip_from_view, view.viewport.w);
        for crown in &crowns.in_bands {
            let middle = crown
                .world_from_local
                .transform_point3(crown.shape.centroid);
            let bands = &crowns.bands[crown.bands.clone()];
            for (band, before) in zip(bands, crown.depths(&eye)) {
                place(phase, *band, middle, before);
            }
        }
    }
}

/// Sorts an item, if there is one, so many metres before a place.
fn place(
    phase: &mut SortedRenderPhase<Transparent3d>,
    entity: Entity,
    mesh_center: Vec3,
    depth_bias: f32,
) {
    // As Bevy has meshes.
    let key = (Entity::PLACEHOLDER, MainEntity::from(entity));
    if let Some(item) = phase.items.get_mut(&key) {
        item.sorting_info = TransparentSortingInfo3d::Sorted {
            mesh_center,
            depth_bias,
        };
    }
}

impl CrownInBands {
    /// How far before its centroid each band is for an eye, in metres.
    fn depths(&self, eye: &Eye) -> impl Iterator<Item = f32> {
        let shape = &*self.shape;
        let Seen {
            direction,
            distance,
        } = eye.sees(shape, &self.world_from_local);
        // Through the slicing boxes, as much as each orientation shows.
        let (mut depth, mut weights) = (0.0, 0.0);
        for slot in slots(shape, direction, self.order) {
            let o = &shape.orientations[slot.orientation as usize];
            let through = o.direction * (o.high.z - o.low.z);
            let through = self.world_from_local.transform_vector3(through);
            depth += slot.weight * through.dot(eye.back()).abs();
            weights += slot.weight;
        }
        let depth = depth / weights.max(f32::EPSILON);
        (0..self.bands.len() as u32).map(move |band| {
            let end = |band: u32| {
                let ranks = band * self.band_ranks;
                ranks_end(shape, distance, self.order, ranks)
            };
            let (start, end) = (end(band), end(band + 1));
            let middle = 0.5 * (start + end);
            (middle - 0.5 + chance(self.seed, band) * (end - start)) * depth
        })
    }
}

/// How far a band is moved, as a share of its own depth, from −0.45 to 0.45: less than to its neighbour. So of two crowns
/// alike not all bands change their order at once.
fn chance(seed: u8, band: u32) -> f32 {
    // By steps that spread evenly, over crowns and over bands.
    let step = 0.618_034 * f32::from(seed) + 0.754_878 * band as f32;
    0.9 * (step.fract() - 0.5)
}

#[cfg(test)]
mod tests {
    use bevy::math::Mat4;

    use super::*;
    use crate::slicing::tests::leaves;

    /// How far before the centroid bands of a crown are, as seen by an eye so many radii away.
    fn depths(radii: f32, ranks: u32) -> Vec<f32> {
        let mut shape = leaves(16).shape().clone();
        shape.levels = vec![5, 3, 1];
        shape.switches = vec![10.0, 25.0];
        let eye = Vec3::new(0.6, 0.0, 0.8) * radii * shape.radius + shape.centroid;
        let place = Transform::from_translation(eye).looking_at(shape.centroid, Vec3::Y);
        // 500 pixels for a metre, one metre away.
        let clip_from_view = Mat4::perspective_infinite_reverse_rh(1.0, 1.0, 0.1);
        let lines = 1000.0 / clip_from_view.y_axis.y;
        let eye = Eye::new(
            place.compute_affine(),
            &clip_from_view,
            lines.round() as u32,
        );
        let crown = CrownInBands {
            world_from_local: Affine3A::IDENTITY,
            shape: Arc::new(shape),
            order: SliceOrder::Steady,
            bands: 0..ranks as usize,
            band_ranks: 1,
            seed: 77,
        };
        crown.depths(&eye).collect()
    }

    #[test]
    fn bands_stay_in_order_and_within_their_crown() {
        let radius = leaves(16).shape().radius;
        for (radii, shown) in [
            (2.0, 5),
            (8.0, 5),
            (9.5, 8),
            (10.9, 8),
            (15.0, 3),
            (23.0, 4),
            (26.0, 4),
            (40.0, 1),
        ] {
            let depths = depths(radii, 8);
            assert!(depths.is_sorted_by(|a, b| a < b), "{radii}: {depths:?}");
            let are_within = depths[..shown].iter().all(|depth| depth.abs() <= radius);
            assert!(are_within, "{radii}: {depths:?}");
        }
    }

    #[test]
    fn no_band_jumps_as_another_level_comes_or_goes() {
        // Bands at both ends of a fade: five and three more to come at the far end, three of which five have gone at the
        // near one.
        let far = |radii| depths(radii, 8);
        let (alone, begins) = (far(8.99), far(9.01));
        let (ends, coarse) = (far(10.99), far(11.01));
        let size = alone[4] - alone[0];
        for rank in 0..5 {
            assert!(
                (alone[rank] - begins[3 + rank]).abs() < 0.3 * size,
                "{alone:?} {begins:?}"
            );
        }
        for rank in 0..3 {
            assert!(
                (ends[rank] - coarse[rank]).abs() < 0.02 * size,
                "{ends:?} {coarse:?}"
            );
        }
    }
}
