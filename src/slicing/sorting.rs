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
use super::blend::{Ranks, SliceOrder, slots};
use super::component::{CrownSettings, SlicedCrown};
use super::eye::Eye;
use super::mesh::band_ranks;
use super::near::DrawnAs;
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
type InBands<'w> = (
    Entity,
    (&'w CrownBands, &'w CrownSettings, &'w DrawnAs),
    &'w GlobalTransform,
    &'w MeshTag,
    &'w ViewVisibility,
);

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
    for (entity, (bands, settings, drawn_as), place, tag, visibility) in &in_bands {
        if !visibility.get() {
            continue;
        }
        let start = crowns.bands.len();
        let all = once(entity).chain(bands.children.iter().copied());
        crowns.bands.extend(all);
        let [.., seed] = tag.0.to_le_bytes();
        crowns.in_bands.push(CrownInBands {
            world_from_local: place.affine(),
            shape: bands.shape.clone(),
            order: settings.order,
            bands: start..crowns.bands.len(),
            band_ranks: band_ranks(drawn_as.ranks),
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
        let seen = eye.sees(shape, &self.world_from_local);
        // The middle of slicing boxes, and through them, as much as each orientation shows.
        let (mut middle, mut depth, mut weights) = (0.0, 0.0, 0.0);
        for slot in slots(shape, seen.direction, self.order) {
            let o = &shape.orientations[slot.orientation as usize];
            let along = self.world_from_local.transform_vector3(o.direction);
            let towards = along.dot(eye.back);
            // Slices that are seen along themselves have an order too.
            let towards_at_least = towards.abs().max(LEAST_SLOPE * along.length());
            middle += slot.weight * towards * 0.5 * (o.low.z + o.high.z);
            depth += slot.weight * towards_at_least * (o.high.z - o.low.z);
            weights += slot.weight;
        }
        let scale = 1.0 / weights.max(f32::EPSILON);
        let (middle, depth) = (middle * scale, depth * scale);
        let ranks = Ranks::new(shape, seen.distance, self.order);
        let mut start = 0.0;
        (0..self.bands.len() as u32).map(move |band| {
            let first = band * self.band_ranks;
            let end = ranks.end(first + self.band_ranks);
            let at = 0.5 * (start + end) + chance(self.seed, ranks.in_level(first)) * (end - start);
            start = end;
            middle + (at - 0.5) * depth
        })
    }
}

/// The least cosine between the view and the normal of slices by which they are sorted.
const LEAST_SLOPE: f32 = 0.01;

/// How far a band that begins with some rank of its level is moved, as a share of its own depth, from −0.45 to 0.45: less
/// than to its neighbour. So of two crowns alike not all bands change their order at once.
fn chance(seed: u8, rank: u32) -> f32 {
    let bits = mixed(u32::from(seed) << 8 | rank);
    0.9 * (bits as f32 / u32::MAX as f32 - 0.5)
}

/// Mixes the bits of a number, as A. Appleby's MurmurHash3 ends.
fn mixed(number: u32) -> u32 {
    let number = (number ^ (number >> 16)).wrapping_mul(0x85eb_ca6b);
    let number = (number ^ (number >> 13)).wrapping_mul(0xc2b2_ae35);
    number ^ (number >> 16)
}

#[cfg(test)]
mod tests {
    use bevy::math::Mat4;

    use super::*;
    use crate::slicing::tests::leaves;

    /// A crown of five, three and one slices of an orientation, in as many bands.
    fn crown(bands: usize) -> CrownInBands {
        let mut shape = leaves(16).shape().clone();
        shape.levels = vec![5, 3, 1];
        shape.switches = vec![10.0, 25.0];
        CrownInBands {
            world_from_local: Affine3A::IDENTITY,
            shape: Arc::new(shape),
            order: SliceOrder::Steady,
            bands: 0..bands,
            band_ranks: 1,
            seed: 77,
        }
    }

    /// How far before the centroid its bands are for an eye in a direction, so many radii away.
    fn depths(crown: &CrownInBands, direction: Vec3, radii: f32) -> Vec<f32> {
        let shape = &crown.shape;
        let eye = direction.normalize() * radii * shape.radius + shape.centroid;
        let place = Transform::from_translation(eye).looking_at(shape.centroid, Vec3::Z);
        // 500 pixels for a metre, one metre away.
        let clip_from_view = Mat4::perspective_infinite_reverse_rh(1.0, 1.0, 0.1);
        let lines = 1000.0 / clip_from_view.y_axis.y;
        let affine = place.compute_affine();
        let eye = Eye::new(affine, &clip_from_view, lines.round() as u32);
        crown.depths(&eye).collect()
    }

    const ASLANT: Vec3 = Vec3::new(0.6, 0.0, 0.8);

    #[test]
    fn bands_stay_in_order_and_within_their_crown() {
        let radius = crown(8).shape.radius;
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
            let depths = depths(&crown(8), ASLANT, radii);
            assert!(depths.is_sorted_by(|a, b| a < b), "{radii}: {depths:?}");
            let are_within = depths[..shown].iter().all(|depth| depth.abs() <= radius);
            assert!(are_within, "{radii}: {depths:?}");
        }
    }

    #[test]
    fn bands_are_in_order_where_slices_are_seen_along_themselves_and_where_each_has_several() {
        for order in [SliceOrder::Steady, SliceOrder::Paper] {
            let mut shape = (*crown(8).shape).clone();
            shape.vertical = false;
            shape.levels = vec![17, 6];
            shape.switches = vec![10.0];
            for (radii, ranks) in [(5.0, 17), (10.0, 23)] {
                let crown = CrownInBands {
                    shape: Arc::new(shape.clone()),
                    order,
                    band_ranks: band_ranks(ranks),
                    bands: 0..ranks.div_ceil(band_ranks(ranks)) as usize,
                    ..crown(8)
                };
                for direction in [Vec3::Y, ASLANT] {
                    let depths = depths(&crown, direction, radii);
                    assert!(depths.is_sorted_by(|a, b| a < b), "{order:?} {depths:?}");
                }
            }
        }
    }

    #[test]
    fn no_band_jumps_as_another_level_comes_or_goes() {
        // At both ends of a fade: three more come at the far end, five go at the near one.
        let at = |radii| depths(&crown(8), ASLANT, radii);
        let (alone, begins) = (at(8.99), at(9.01));
        let (ends, coarse) = (at(10.99), at(11.01));
        let size = alone[4] - alone[0];
        let is_near = |a: f32, b: f32| (a - b).abs() < 0.02 * size;
        for rank in 0..5 {
            let (before, after) = (alone[rank], begins[3 + rank]);
            assert!(is_near(before, after), "{alone:?} {begins:?}");
        }
        for rank in 0..3 {
            let (before, after) = (ends[rank], coarse[rank]);
            assert!(is_near(before, after), "{ends:?} {coarse:?}");
        }
    }

    #[test]
    fn of_two_crowns_alike_few_bands_change_their_order_at_once() {
        // Shares of a rank by which crowns are nearer than one another as bands of theirs change their order.
        let coincide = |a: u8, b: u8| {
            let pairs = (0..5).flat_map(|i| (0..5).map(move |j| (i, j)));
            let mut swaps: Vec<f32> = pairs
                .map(|(i, j)| i as f32 + chance(a, i) - j as f32 - chance(b, j))
                .collect();
            swaps.sort_by(f32::total_cmp);
            // The most within a hundredth of a rank.
            let within = |first: f32| {
                let near = swaps
                    .iter()
                    .filter(|swap| (first..first + 0.01).contains(*swap));
                near.count()
            };
            swaps.iter().map(|first| within(*first)).max().unwrap_or(0)
        };
        let counts: Vec<usize> = (0..=255)
            .flat_map(|a: u8| [1, 2, 3, 5, 8, 89].map(|step| coincide(a, a.wrapping_add(step))))
            .collect();
        // Of 25, all five of a kind if crowns were moved as a whole.
        let mean = counts.iter().sum::<usize>() as f32 / counts.len() as f32;
        assert!(
            mean < 2.5 && counts.iter().all(|count| *count <= 6),
            "{mean} {counts:?}"
        );
    }
}
