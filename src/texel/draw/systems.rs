//! The systems that follow surfaces from frame to frame.

use bevy::camera::primitives::Aabb;
use bevy::camera::visibility::{NoAutoAabb, RenderLayers};
use bevy::ecs::name::NameOrEntity;
use bevy::light::NotShadowCaster;
use bevy::mesh::skinning::SkinnedMesh;
use bevy::platform::collections::HashSet;
use bevy::prelude::*;
use bevy::render::batching::NoAutomaticBatching;

use super::super::asset::TexelVolume;
use super::component::{LiveTexels, TexelCycle, TexelHeights, TexelSettings, TexelSurface};
use super::library::{Drawn, GeometryKey, TexelAssets, TexelKeys, TexelLibrary};
use super::material::TexelMaterial;
use super::source::SliceSource;
use crate::edited_assets::EditedAssets;
use crate::give_or_take::give_or_take;
use crate::lighting::SceneLights;
use crate::wind::Wind;

/// Marks the children of a [`TexelSurface`] that its slices are drawn by, two for each axis. Made by the plugin; they
/// follow their surface's [`RenderLayers`] and [`NotShadowCaster`].
#[derive(Component, Clone, Copy, Debug, Default, Reflect)]
#[reflect(Component, Clone, Debug, Default)]
pub struct TexelSlices;

/// What a surface is drawn with, and by which children.
#[derive(Component)]
pub(crate) struct TexelDrawn {
    keys: TexelKeys,
    /// Those of colours across u, v and w, and of depth.
    slices: [Entity; 6],
}

impl TexelDrawn {
    pub(crate) fn geometry(&self) -> GeometryKey {
        self.keys.geometry
    }

    fn despawn(&self, commands: &mut Commands) {
        for slices in self.slices {
            commands.entity(slices).try_despawn();
        }
    }
}

/// What is looked at of a surface.
type Attachable<'w> = (
    NameOrEntity,
    &'w TexelSurface,
    &'w TexelSettings,
    &'w Mesh3d,
    Option<Ref<'w, TexelHeights>>,
    Has<LiveTexels>,
    Has<SkinnedMesh>,
    Option<&'w TexelDrawn>,
    Option<&'w SliceSource>,
);

/// What tells that a surface may have to be drawn with other things.
type MayHaveChanged = Or<(
    Changed<TexelSurface>,
    Changed<TexelSettings>,
    Changed<Mesh3d>,
    Changed<TexelHeights>,
    Added<SkinnedMesh>,
    With<LiveTexels>,
    Without<SliceSource>,
)>;

/// Components of which a surface may have lost one.
#[derive(bevy::ecs::system::SystemParam)]
pub(crate) struct Lost<'w, 's> {
    heights: RemovedComponents<'w, 's, TexelHeights>,
    live: RemovedComponents<'w, 's, LiveTexels>,
    skins: RemovedComponents<'w, 's, SkinnedMesh>,
}

/// The surfaces, and which of them to look at.
#[derive(bevy::ecs::system::SystemParam)]
pub(crate) struct Looked<'w, 's> {
    surfaces: Query<'w, 's, Attachable<'static>>,
    changed: Query<'w, 's, Entity, (MayHaveChanged, With<TexelSurface>)>,
    lost: Lost<'w, 's>,
    /// Kept from frame to frame, so that nothing is allocated.
    list: Local<'s, Vec<Entity>>,
    /// Those that are drawn with what they had, until their new mesh or volume is there.
    waiting: Local<'s, Vec<Entity>>,
}

/// The children that slices are drawn by.
type Slices<'w> = (&'w mut MeshMaterial3d<TexelMaterial>, &'w mut Aabb);

/// Gives surfaces whose mesh and volume are there what they are drawn with. One whose volume is not there yet keeps what it
/// has.
pub(crate) fn attach(
    mut commands: Commands,
    mut library: ResMut<TexelLibrary>,
    mut assets: TexelAssets,
    wind: Res<Wind>,
    mut looked: Looked,
    mut slices: Query<Slices, (With<TexelSlices>, Without<TexelSurface>)>,
) {
    let device = assets.device.as_ref();
    let is_lost = device.is_some_and(|device| device.is_changed());
    if is_lost {
        library.clear();
    }
    let wind = wind.limited();
    let quad = library.quad(&mut assets.meshes);
    looked.list.clear();
    looked.list.append(&mut looked.waiting);
    if core::mem::take(&mut library.is_stale) {
        let surfaces = looked.surfaces.iter();
        looked.list.extend(surfaces.map(|surface| surface.0.entity));
    } else {
        looked.list.extend(&looked.changed);
        let lost = &mut looked.lost;
        let lost = (lost.heights.read())
            .chain(lost.live.read())
            .chain(lost.skins.read());
        looked.list.extend(lost);
    }
    // Each is looked at once, or one that is not drawn yet would get slices twice.
    looked.list.sort_unstable();
    looked.list.dedup();
    for &entity in &*looked.list {
        let Ok(found) = looked.surfaces.get(entity) else {
            continue;
        };
        let (owner, surface, settings, mesh, heights, is_live, is_skinned, drawn, source) = found;
        let own = (heights.is_some() || is_live || is_skinned).then_some(entity);
        let keys = TexelKeys::new(surface, mesh.id(), settings, own);
        let is_stroked = heights.as_ref().is_some_and(|heights| heights.is_changed());
        let heights = heights.as_deref();
        // One of joints is posed once these are where they are in this frame.
        if (is_live || is_stroked) && !is_skinned {
            library.renew(keys.geometry, heights, &assets);
        }
        let found = library.drawn(keys, &owner, settings, heights, wind, &mut assets);
        let (geometry, volume, materials) = match found {
            Drawn::NotYet => {
                // One that is not drawn at all is looked at anyway.
                if let Some(drawn) = drawn {
                    if is_lost {
                        // What it was drawn with is others' now.
                        drawn.despawn(&mut commands);
                        let mut entity = commands.entity(entity);
                        entity.try_remove::<(TexelDrawn, SliceSource)>();
                    } else {
                        looked.waiting.push(entity);
                    }
                }
                continue;
            }
            Drawn::Nothing => {
                if let Some(drawn) = drawn {
                    drawn.despawn(&mut commands);
                    commands
                        .entity(entity)
                        .try_remove::<(TexelDrawn, SliceSource)>();
                }
                continue;
            }
            Drawn::Slices(geometry, volume, materials) => (geometry, volume, materials),
        };
        let bounds = geometry.bounds_in_wind(settings.limited_flexibility());
        let material = materials[0].id();
        let slices = if let Some(drawn) = drawn {
            for (child, material) in drawn.slices.iter().zip(materials) {
                if let Ok((mut used, mut seen)) = slices.get_mut(*child) {
                    used.set_if_neq(MeshMaterial3d(material));
                    seen.set_if_neq(bounds);
                }
            }
            drawn.slices
        } else {
            materials.map(|material| {
                let slices = (
                    TexelSlices,
                    Mesh3d(quad.clone()),
                    MeshMaterial3d(material),
                    bounds,
                    NoAutoAabb,
                    // They are drawn together from lists of slices.
                    NoAutomaticBatching,
                    ChildOf(entity),
                );
                commands.spawn(slices).id()
            })
        };
        if drawn.is_none_or(|drawn| drawn.keys != keys) {
            let drawn = TexelDrawn { keys, slices };
            commands.entity(entity).try_insert(drawn);
        }
        let fresh = SliceSource::new(geometry, bounds, volume, *settings, slices, material);
        if source.is_none_or(|source| !source.is_as(&fresh)) {
            commands.entity(entity).try_insert(fresh);
        }
    }
}

/// Follows meshes and volumes that were edited, reloaded, or taken away and put back. Until then what was made of them stays
/// on screen.
pub(crate) fn follow_assets(
    mut meshes: EditedAssets<Mesh>,
    mut volumes: EditedAssets<TexelVolume>,
    live: Query<(), With<LiveTexels>>,
    mut library: ResMut<TexelLibrary>,
    assets: TexelAssets,
) {
    library.settle();
    volumes.look(|id| library.uses_volume(id));
    for id in volumes.edited.iter() {
        library.forget_volume(*id);
    }
    meshes.look(|id| library.uses_mesh(id));
    for id in meshes.removed.iter() {
        library.forget_mesh(*id);
    }
    for id in meshes.edited.iter() {
        // Live surfaces are followed anyway, but not those that share their mesh.
        library.follow_mesh(*id, |owner| live.contains(owner), &assets);
    }
}

/// Tells the materials of a change of wind.
pub(crate) fn follow_wind(
    library: Res<TexelLibrary>,
    mut materials: ResMut<Assets<TexelMaterial>>,
    wind: Res<Wind>,
) {
    library.follow_wind(wind.limited(), &mut materials);
}

/// Tells the materials which lighting the scene's lights call for.
pub(crate) fn follow_lights(
    library: Res<TexelLibrary>,
    mut materials: ResMut<Assets<TexelMaterial>>,
    lights: SceneLights,
) {
    library.follow_lights(&lights, &mut materials);
}

/// What of a surface its slices follow.
type Followed<'w> = (
    &'w TexelDrawn,
    Option<&'w RenderLayers>,
    Has<NotShadowCaster>,
);

/// What of it they have.
type Following<'w> = (Option<&'w RenderLayers>, Has<NotShadowCaster>);

/// Shows slices where their surface is shown, and lets them cast shadows as it does.
pub(crate) fn follow_surfaces(
    mut commands: Commands,
    surfaces: Query<Followed>,
    slices: Query<Following, With<TexelSlices>>,
) {
    for (drawn, layers, casts_none) in &surfaces {
        for &child in &drawn.slices {
            let Ok((own_layers, own_casts_none)) = slices.get(child) else {
                continue;
            };
            let mut own = commands.entity(child);
            if layers != own_layers {
                give_or_take(&mut own, layers.cloned());
            }
            if casts_none != own_casts_none {
                give_or_take(&mut own, casts_none.then_some(NotShadowCaster));
            }
        }
    }
}

/// Stops drawing texels on an entity that is no surface any more, or has no mesh.
pub(crate) fn uproot(
    removed: On<Remove, (TexelSurface, Mesh3d)>,
    drawn: Query<&TexelDrawn>,
    mut library: ResMut<TexelLibrary>,
    mut commands: Commands,
) {
    library.forget_owner(removed.entity);
    if let Ok(drawn) = drawn.get(removed.entity) {
        drawn.despawn(&mut commands);
        if let Ok(mut entity) = commands.get_entity(removed.entity) {
            entity.try_remove::<(TexelDrawn, SliceSource)>();
        }
    }
}

/// Shows the volume whose turn it is.
pub(crate) fn cycle(time: Res<Time>, mut surfaces: Query<(&TexelCycle, &mut TexelSurface)>) {
    for (cycle, mut surface) in &mut surfaces {
        if let Some(volume) = cycle.at(time.elapsed_secs())
            && *volume != surface.volume
        {
            surface.volume = volume.clone();
        }
    }
}

/// What tells that a surface may have come to use other things.
type InOtherUse = Or<(Changed<TexelDrawn>, Changed<TexelCycle>)>;

/// Forgets what no surface uses any more.
pub(crate) fn forget(
    mut removed: RemovedComponents<TexelDrawn>,
    mut library: ResMut<TexelLibrary>,
    mut uncycled: RemovedComponents<TexelCycle>,
    changed: Query<(), InOtherUse>,
    drawn: Query<(&TexelDrawn, Option<&TexelCycle>)>,
) {
    let removed = removed.read().count() + uncycled.read().count();
    if removed > 0 || !changed.is_empty() {
        let mut used = HashSet::default();
        for (drawn, cycle) in &drawn {
            used.insert(drawn.keys);
            let turns = cycle.into_iter().flat_map(|cycle| &cycle.volumes);
            used.extend(turns.map(|volume| drawn.keys.with_volume(volume.id())));
        }
        library.keep(&used);
    }
}
