//! Crowns that intersect, drawn in bands: slices of a crown that follow one another are an item of the transparent phase,
//! and each is sorted by where these slices are (`sorting.rs`), among the bands of other crowns and all else that is
//! transparent. While two levels fade into one another, which are in the same place, the coarser one is sorted to the far
//! end of the crown, as it is drawn, by its share.
//!
//! Drawn whole, one crown is in front of the other, and where they change their order all that both cover changes. In bands,
//! two that change theirs cover little between them. A crown alone is drawn as it is whole, to the bit: its bands stay in
//! order.
//!
//! The crown's own entity draws the furthest band, and children of it the others.

use std::sync::Arc;

use bevy::camera::primitives::Aabb;
use bevy::camera::visibility::{NoAutoAabb, NoFrustumCulling, RenderLayers, VisibilityRange};
use bevy::ecs::query::QueryData;
use bevy::light::{NotShadowCaster, NotShadowReceiver, TransmittedShadowReceiver};
use bevy::mesh::MeshTag;
use bevy::prelude::*;

use super::component::{IntersectingCrown, SlicedCrown};
use super::library::CrownLibrary;
use super::material::SlicedCrownMaterial;
use super::near::DrawnAs;
use super::slicing::SlicingShape;
use crate::give_or_take::give_or_take;

/// The bands of a crown. On the crown, as long as it is drawn in them.
#[derive(Component)]
pub(crate) struct CrownBands {
    /// What draws all bands but the furthest, far to near.
    pub children: Vec<Entity>,
    pub shape: Arc<SlicingShape>,
    look: BandLook,
}

/// Marks what draws a band of its parent.
#[derive(Component, Clone)]
pub(crate) struct BandOfParent;

/// What the bands of a crown have of it.
#[derive(Default)]
struct BandLook {
    /// Of bands that children draw.
    meshes: Vec<Handle<Mesh>>,
    material: MeshMaterial3d<SlicedCrownMaterial>,
    tag: MeshTag,
    bounds: Aabb,
    layers: Option<RenderLayers>,
    range: Option<VisibilityRange>,
    marks: (bool, bool, bool, bool),
}

/// What marks a crown, and all of its bands: that it casts no shadows, receives none, receives transmitted ones, is never
/// culled.
type Marks = (
    Has<NotShadowCaster>,
    Has<NotShadowReceiver>,
    Has<TransmittedShadowReceiver>,
    Has<NoFrustumCulling>,
);

/// A crown, and what its bands have of it.
#[derive(QueryData)]
#[query_data(mutable)]
pub(crate) struct Followed {
    entity: Entity,
    crown: &'static SlicedCrown,
    drawn_as: &'static DrawnAs,
    /// Of the furthest band.
    mesh: &'static mut Mesh3d,
    material: &'static MeshMaterial3d<SlicedCrownMaterial>,
    tag: &'static MeshTag,
    bounds: &'static Aabb,
    layers: Option<&'static RenderLayers>,
    range: Option<&'static VisibilityRange>,
    marks: Marks,
    place: &'static GlobalTransform,
    visibility: &'static InheritedVisibility,
    bands: Option<&'static mut CrownBands>,
}

impl FollowedItem<'_, '_> {
    /// Whether bands of these meshes look so.
    fn has(&self, meshes: &[Handle<Mesh>], look: &BandLook) -> bool {
        look.meshes == meshes
            && look.material == *self.material
            && look.tag == *self.tag
            && look.bounds == *self.bounds
            && look.layers.as_ref() == self.layers
            && look.range.as_ref() == self.range
            && look.marks == self.marks
    }

    /// How bands of these meshes look.
    fn look(&self, meshes: &[Handle<Mesh>]) -> BandLook {
        BandLook {
            meshes: meshes.to_vec(),
            material: self.material.clone(),
            tag: self.tag.clone(),
            bounds: *self.bounds,
            layers: self.layers.cloned(),
            range: self.range.cloned(),
            marks: self.marks,
        }
    }
}

impl BandLook {
    /// Lets a child draw one of these bands.
    fn give(&self, mesh: &Handle<Mesh>, child: &mut EntityCommands) {
        child.try_insert((
            Mesh3d(mesh.clone()),
            self.material.clone(),
            self.tag.clone(),
            self.bounds,
        ));
        let (casts_none, receives_none, receives_transmitted, is_never_culled) = self.marks;
        give_or_take(child, self.layers.clone());
        give_or_take(child, self.range.clone());
        give_or_take(child, casts_none.then_some(NotShadowCaster));
        give_or_take(child, receives_none.then_some(NotShadowReceiver));
        let transmitted = receives_transmitted.then_some(TransmittedShadowReceiver);
        give_or_take(child, transmitted);
        give_or_take(child, is_never_culled.then_some(NoFrustumCulling));
    }
}

/// Crowns that are drawn in bands, may be, or were.
type MaybeInBands = Or<(With<IntersectingCrown>, With<CrownBands>)>;

/// Spawns the bands of crowns that are drawn in them, and lets them follow their crowns.
pub(crate) fn follow_crowns(
    mut commands: Commands,
    library: Res<CrownLibrary>,
    crowns: Query<Followed, MaybeInBands>,
    parents: Query<&ChildOf, With<BandOfParent>>,
) {
    for mut crown in crowns {
        if !crown.drawn_as.is_in_bands() {
            if crown.bands.is_some() {
                commands.entity(crown.entity).try_remove::<CrownBands>();
            }
            continue;
        }
        // While there is no slicing all stays as it is.
        let Some(shared) = library.shared.get(&crown.crown.0.id()) else {
            continue;
        };
        let meshes = shared.known_bands(*crown.drawn_as);
        let Some((_, meshes)) = meshes.split_first() else {
            continue;
        };
        let entity = crown.entity;
        let is_there = |child: &Entity| {
            let parent = parents.get(*child).map(ChildOf::parent);
            parent.is_ok_and(|parent| parent == entity)
        };
        let settled = crown.bands.as_ref().is_some_and(|bands| {
            crown.has(meshes, &bands.look)
                && Arc::ptr_eq(&bands.shape, &shared.shape)
                && bands.children.iter().all(is_there)
        });
        if settled {
            continue;
        }
        let had_range = crown.bands.as_ref().map(|bands| bands.look.range.is_some());
        if had_range.is_some_and(|had_range| had_range != crown.range.is_some()) {
            // Bevy heeds it only where a mesh is new, as those of children are.
            crown.mesh.set_changed();
        }
        let before = crown.bands.as_deref_mut();
        let mut children =
            before.map_or_else(Vec::new, |bands| core::mem::take(&mut bands.children));
        children.retain(is_there);
        children.truncate(meshes.len());
        while children.len() < meshes.len() {
            let child = commands.spawn((
                BandOfParent,
                ChildOf(entity),
                NoAutoAabb,
                // As they will be once they have come down from the crown.
                *crown.place,
                *crown.visibility,
            ));
            children.push(child.id());
        }
        let look = crown.look(meshes);
        for (child, mesh) in children.iter().zip(meshes) {
            look.give(mesh, &mut commands.entity(*child));
        }
        commands.entity(entity).try_insert(CrownBands {
            children,
            shape: shared.shape.clone(),
            look,
        });
    }
}

/// Despawns what draws a band that no crown knows of: those of crowns that are whole again or have fewer, of clones, and
/// what was taken from its crown.
pub(crate) fn sweep(
    mut commands: Commands,
    children: Query<(Entity, Option<&ChildOf>), With<BandOfParent>>,
    crowns: Query<&CrownBands, With<SlicedCrown>>,
) {
    for (child, parent) in &children {
        let bands = parent.and_then(|parent| crowns.get(parent.parent()).ok());
        if bands.is_none_or(|bands| !bands.children.contains(&child)) {
            commands.entity(child).try_despawn();
        }
    }
}
