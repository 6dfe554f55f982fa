//! Crowns that intersect, drawn in bands: slices of a crown that follow one another are an item of the transparent phase, and
//! each is sorted by where these slices are, among the bands of other crowns and all else that is transparent.
//!
//! Drawn whole, one crown is in front of the other, and where they change their order all that both cover changes. In bands, two
//! that change theirs cover little between them. A crown alone is drawn as it is whole, to the bit: its bands stay in order.
//!
//! The crown's own entity draws the furthest band, and children of it the others.

use core::iter::zip;
use std::sync::Arc;

use bevy::camera::primitives::Aabb;
use bevy::camera::visibility::{NoAutoAabb, NoFrustumCulling, RenderLayers, VisibilityRange};
use bevy::core_pipeline::core_3d::{Transparent3d, TransparentSortingInfo3d};
use bevy::light::{NotShadowCaster, NotShadowReceiver, TransmittedShadowReceiver};
use bevy::math::{Affine3A, Vec3A};
use bevy::mesh::MeshTag;
use bevy::prelude::*;
use bevy::render::Extract;
use bevy::render::render_phase::ViewSortedRenderPhases;
use bevy::render::sync_world::MainEntity;
use bevy::render::view::ExtractedView;

use super::blend::{PART_SLOTS, SLOTS, SliceOrder};
use super::component::{CrownSettings, SlicedCrown};
use super::library::CrownLibrary;
use super::material::SlicedCrownMaterial;
use super::mesh::{band_ranks, bands as bands_of};
use super::near::{Eye, Nearness};
use super::slicing::SlicingShape;

/// The bands of a crown but the furthest, which it draws itself.
#[derive(Component, Default)]
pub(crate) struct CrownBands {
    children: Vec<Entity>,
    look: BandLook,
}

impl CrownBands {
    pub(crate) fn despawn(&self, commands: &mut Commands) {
        for &child in &self.children {
            if let Ok(mut child) = commands.get_entity(child) {
                child.try_despawn();
            }
        }
    }
}

/// Marks what draws a band of its parent.
#[derive(Component)]
pub(crate) struct CrownBand;

/// What the bands of a crown are drawn with.
#[derive(Clone, Default, PartialEq)]
struct BandLook {
    meshes: Vec<Handle<Mesh>>,
    material: MeshMaterial3d<SlicedCrownMaterial>,
    tag: MeshTag,
    bounds: Aabb,
    layers: Option<RenderLayers>,
    range: Option<VisibilityRange>,
    receives_no_shadows: bool,
    is_never_culled: bool,
    /// How many of them have slices that cast shadows.
    casters: usize,
}

impl BandLook {
    /// Gives a child what the band at an `index` among those of children is drawn with.
    fn give(&self, index: usize, child: &mut EntityCommands) {
        child.try_insert((
            Mesh3d(self.meshes[index].clone()),
            self.material.clone(),
            self.tag.clone(),
            self.bounds,
        ));
        follow(child, self.layers.clone());
        follow(child, self.range.clone());
        follow(child, self.receives_no_shadows.then_some(NotShadowReceiver));
        follow(child, self.is_never_culled.then_some(NoFrustumCulling));
        follow(child, (index >= self.casters).then_some(NotShadowCaster));
    }
}

/// Gives an entity a component, or takes it.
fn follow<C: Component>(entity: &mut EntityCommands, component: Option<C>) {
    match component {
        Some(component) => entity.try_insert(component),
        None => entity.try_remove::<C>(),
    };
}

/// What bands follow of their crown.
type Followed<'w> = (
    Entity,
    (&'w SlicedCrown, &'w CrownSettings, &'w Nearness),
    (
        &'w MeshMaterial3d<SlicedCrownMaterial>,
        &'w MeshTag,
        &'w Aabb,
    ),
    (Option<&'w RenderLayers>, Option<&'w VisibilityRange>),
    (
        Has<NotShadowReceiver>,
        Has<NotShadowCaster>,
        Has<NoFrustumCulling>,
    ),
    (&'w GlobalTransform, &'w InheritedVisibility),
    Option<&'w mut CrownBands>,
);

/// Spawns the bands of crowns that are drawn in them, lets them follow their crowns, and despawns those of others.
pub(crate) fn follow_crowns(
    mut commands: Commands,
    library: Res<CrownLibrary>,
    crowns: Query<Followed>,
    bands: Query<(), With<CrownBand>>,
) {
    for (entity, crown, drawn, culled, has, place, own) in crowns {
        let (crown, settings, nearness) = crown;
        if own.is_none() && !nearness.is_in_bands() {
            continue;
        }
        let Some(shared) = library.shared.get(&crown.0.id()) else {
            continue;
        };
        let (receives_no_shadows, casts_none, is_never_culled) = has;
        let (material, tag, bounds) = drawn;
        let meshes = library
            .bands(crown.0.id(), *nearness)
            .get(1..)
            .unwrap_or(&[]);
        let look = BandLook {
            meshes: meshes.to_vec(),
            material: material.clone(),
            tag: tag.clone(),
            bounds: *bounds,
            layers: culled.0.cloned(),
            range: culled.1.cloned(),
            receives_no_shadows,
            is_never_culled,
            casters: if casts_none {
                0
            } else {
                casters(&shared.shape, settings.order, *nearness)
            },
        };
        let mut fresh = CrownBands::default();
        let mut own = own;
        let known = own.as_deref_mut().unwrap_or(&mut fresh);
        let are_there = known.children.iter().all(|child| bands.contains(*child));
        if known.look == look && are_there {
            continue;
        }
        known.children.retain(|child| bands.contains(*child));
        for child in known
            .children
            .drain(meshes.len().min(known.children.len())..)
        {
            commands.entity(child).try_despawn();
        }
        while known.children.len() < meshes.len() {
            let (transform, visibility) = place;
            let child = commands.spawn((
                CrownBand,
                ChildOf(entity),
                NoAutoAabb,
                TransmittedShadowReceiver,
                // As they will be once they have come down from the crown.
                *transform,
                *visibility,
            ));
            known.children.push(child.id());
        }
        for (index, child) in known.children.iter().enumerate() {
            look.give(index, &mut commands.entity(*child));
        }
        known.look = look;
        if !nearness.is_in_bands() {
            commands.entity(entity).try_remove::<CrownBands>();
        } else if own.is_none() {
            commands.entity(entity).try_insert(fresh);
        }
    }
}

/// How many bands but the furthest have slices that cast shadows.
fn casters(shape: &SlicingShape, order: SliceOrder, nearness: Nearness) -> usize {
    let level = match order {
        SliceOrder::Steady => shape.levels.len() - 1,
        SliceOrder::Paper => 0,
    };
    let slots = if nearness.is_near { PART_SLOTS } else { SLOTS };
    let others = bands_of(shape, slots, nearness.ranks).skip(1);
    others
        .filter(|band| band.start < shape.levels[level])
        .count()
}

/// A crown that is drawn in bands in this frame.
struct CrownInBands {
    world_from_local: Affine3A,
    shape: Arc<SlicingShape>,
    order: SliceOrder,
    /// Its bands, far to near, and how many ranks each has.
    bands: Vec<Entity>,
    band_ranks: u32,
    /// From −½ to ½, so that of two crowns alike not all bands change their order at once.
    chance: f32,
}

/// The crowns that are drawn in bands in this frame.
#[derive(Resource, Default)]
pub(crate) struct CrownsInBands(Vec<CrownInBands>);

/// What is extracted of a crown in bands.
type ExtractedCrown<'w> = (
    Entity,
    (&'w SlicedCrown, &'w CrownSettings, &'w Nearness),
    &'w CrownBands,
    &'w GlobalTransform,
    &'w MeshTag,
);

/// Takes crowns in bands over into the render world.
pub(crate) fn extract(
    mut crowns: ResMut<CrownsInBands>,
    library: Extract<Option<Res<CrownLibrary>>>,
    found: Extract<Query<ExtractedCrown>>,
) {
    crowns.0.clear();
    let Some(library) = &*library else {
        return;
    };
    for (entity, (crown, settings, nearness), bands, place, tag) in &found {
        let Some(shared) = library.shared.get(&crown.0.id()) else {
            continue;
        };
        let [.., seed] = tag.0.to_le_bytes();
        crowns.0.push(CrownInBands {
            world_from_local: place.affine(),
            shape: shared.shape.clone(),
            order: settings.order,
            band_ranks: band_ranks(nearness.ranks),
            bands: [entity]
                .into_iter()
                .chain(bands.children.iter().copied())
                .collect(),
            chance: f32::from(seed) / 255.0 - 0.5,
        });
    }
}

/// Tells the items of bands where they are to be sorted to.
pub(crate) fn place_bands(
    crowns: Res<CrownsInBands>,
    views: Query<&ExtractedView>,
    mut phases: ResMut<ViewSortedRenderPhases<Transparent3d>>,
) {
    for view in &views {
        let Some(phase) = phases.get_mut(&view.retained_view_entity) else {
            continue;
        };
        for crown in &crowns.0 {
            let centroid = crown
                .world_from_local
                .transform_point3(crown.shape.centroid);
            for (band, depth) in zip(&crown.bands, crown.depths(view)) {
                // As Bevy has meshes.
                let key = (Entity::PLACEHOLDER, MainEntity::from(*band));
                if let Some(item) = phase.items.get_mut(&key) {
                    item.sorting_info = TransparentSortingInfo3d::Sorted {
                        mesh_center: centroid,
                        depth_bias: depth,
                    };
                }
            }
        }
    }
}

impl CrownInBands {
    /// How far before its centroid each band is for a view, in metres: ranks are as far apart as slices of the orientation that it
    /// sees best.
    fn depths(&self, view: &ExtractedView) -> impl Iterator<Item = f32> {
        let place = view.world_from_view.affine();
        let eye = Eye::new(
            place.translation.into(),
            &view.clip_from_view,
            view.viewport.w,
        );
        let ranks = eye.ranks(&self.shape, &self.world_from_local, self.order);
        let matrix = self.world_from_local.matrix3;
        // Of the vectors through the slicing boxes.
        let depths = self.shape.orientations.iter().map(|o| {
            let through = matrix * Vec3A::from(o.direction * (o.high.z - o.low.z));
            through.dot(place.matrix3.z_axis).abs()
        });
        let spacing = depths.fold(0.0, f32::max) / ranks as f32;
        let (each, chance) = (self.band_ranks, self.chance);
        (0..self.bands.len() as u32).map(move |band| {
            let first = band * each;
            // Of what is not drawn in this view it does not matter where it is.
            let last = (first + each).min(ranks).max(first + 1);
            let middle = 0.5 * (first + last) as f32;
            (middle - 0.5 * ranks as f32 + chance) * spacing
        })
    }
}
