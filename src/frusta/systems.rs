//! The systems that follow plants from frame to frame, in the order of [`VerdureSystems`](crate::VerdureSystems).

use bevy::asset::prelude::AssetChanged;
use bevy::camera::primitives::Aabb;
use bevy::mesh::MeshTag;
use bevy::platform::time::Instant;
use bevy::prelude::*;

use super::component::Frusta;
use super::material::FrustaMaterial;
use super::mesh::FrustaMeshes;
use super::plant::FrustaPlant;
use super::shaping::Shaping;
use super::share::FrustaData;
use super::stats::FrustaStats;
use crate::skeleton::{PosedJoints, Skeleton, Skeleton3d};

/// Notes which skeletons were reloaded.
pub(crate) fn follow_skeletons(
    mut events: MessageReader<AssetEvent<Skeleton>>,
    mut data: ResMut<FrustaData>,
) {
    for event in events.read() {
        match event {
            AssetEvent::Modified { id } => data.reloaded(*id),
            AssetEvent::Removed { id } => data.unloaded(*id),
            _ => {}
        }
    }
}

/// A plant for which the tables have no room. It has been told of, and is tried again once some is given back.
#[derive(Component)]
pub(crate) struct NoRoom;

/// What tells that a plant needs a (new) place in the tables.
type Unattached = Or<(
    (Without<FrustaPlant>, Without<NoRoom>),
    Changed<Skeleton3d>,
    Changed<Frusta>,
    Changed<MeshMaterial3d<FrustaMaterial>>,
    AssetChanged<MeshMaterial3d<FrustaMaterial>>,
    Added<PosedJoints>,
    AssetChanged<Skeleton3d>,
)>;

/// What is looked at to attach a plant.
type Attachable<'w> = (
    &'w Skeleton3d,
    &'w Frusta,
    Option<&'w MeshMaterial3d<FrustaMaterial>>,
    Option<&'w PosedJoints>,
    Option<&'w FrustaPlant>,
);

/// Attaches plants whose skeleton is loaded. One whose skeleton is not there yet, or could not be reloaded, keeps
/// what it has.
#[expect(
    clippy::too_many_arguments,
    reason = "a system: each argument is a resource or a query"
)]
pub(crate) fn attach(
    mut commands: Commands,
    skeletons: Res<Assets<Skeleton>>,
    materials: Res<Assets<FrustaMaterial>>,
    mut meshes: ResMut<FrustaMeshes>,
    mut mesh_assets: ResMut<Assets<Mesh>>,
    mut data: ResMut<FrustaData>,
    mut unposed: RemovedComponents<PosedJoints>,
    changed: Query<Entity, (With<Skeleton3d>, Unattached)>,
    waiting: Query<Entity, With<NoRoom>>,
    plants: Query<Attachable>,
) {
    let there_is_room = data.take_gave_back();
    let waiting_now = waiting.iter().filter(|_| there_is_room);
    for entity in changed.iter().chain(unposed.read()).chain(waiting_now) {
        let Ok((skeleton3d, settings, material, posed, plant)) = plants.get(entity) else {
            continue;
        };
        let material = material.and_then(|material| materials.get(material));
        let shaping = Shaping::new(*settings, material);
        let id = skeleton3d.id();
        let Some(skeleton) = skeletons.get(id) else {
            continue;
        };
        if let Some(plant) = plant {
            let same = plant.skeleton == data.key(id)
                && plant.shaping == shaping
                && plant.own.is_some() == posed.is_some();
            if same {
                continue;
            }
        }
        let mut plant = match data.attach(id, skeleton, shaping, posed.is_some()) {
            Ok(plant) => plant,
            Err(_) if waiting.contains(entity) => continue,
            Err(no_room) => {
                error!("{no_room}");
                commands.entity(entity).try_insert(NoRoom);
                continue;
            }
        };
        // One that was bent before goes on where it was, instead of from rest.
        if let (Some(own), Some(posed)) = (&mut plant.own, posed)
            && posed.positions().len() == plant.linked.links.len()
        {
            own.follow(&plant.linked, plant.shaping, posed);
            own.settle();
            own.measure(&plant.linked, plant.shaping);
            plant.bounds = own.bounds;
        }
        let bounds = plant.bounds;
        let mesh = meshes.with_segments(plant.linked.links.len(), &mut mesh_assets);
        // Inserting the new component drops the old one, which gives its rows back.
        let mut entity = commands.entity(entity);
        entity.try_insert((Mesh3d(mesh), MeshTag(plant.slot.first()), plant, bounds));
        entity.try_remove::<NoRoom>();
    }
}

/// Gives a plant's rows back when it is no longer drawn, or before it is attached anew.
pub(crate) fn detach(
    replaced: On<Discard, FrustaPlant>,
    plants: Query<&FrustaPlant>,
    mut data: ResMut<FrustaData>,
) {
    if let Ok(plant) = plants.get(replaced.entity) {
        data.detach(plant);
    }
}

/// Stops drawing an entity that is a plant no more.
pub(crate) fn uproot(removed: On<Remove, Skeleton3d>, mut commands: Commands) {
    if let Ok(mut entity) = commands.get_entity(removed.entity) {
        entity.try_remove::<(FrustaPlant, NoRoom, Mesh3d, MeshTag, Aabb)>();
    }
}

/// Recomputes cones, cutting planes and GPU records of the plants whose pose has changed.
pub(crate) fn cut_planes(
    mut stats: ResMut<FrustaStats>,
    mut plants: Query<(&mut FrustaPlant, Ref<PosedJoints>)>,
) {
    let started = Instant::now();
    plants.par_iter_mut().for_each(|(mut plant, posed)| {
        // Not a change that anything waits for: what moved is told by `changed` below.
        let plant = plant.bypass_change_detection();
        let Some(own) = &mut plant.own else { return };
        let fresh = posed.is_changed() && posed.positions().len() == plant.linked.links.len();
        if fresh {
            own.follow(&plant.linked, plant.shaping, &posed);
        } else {
            own.settle();
        }
    });
    stats.cutting_planes = started.elapsed();
}

/// Recomputes the bounds of the plants whose pose has changed.
pub(crate) fn update_bounds(mut plants: Query<(&mut FrustaPlant, &mut Aabb), With<PosedJoints>>) {
    plants.par_iter_mut().for_each(|(mut plant, mut aabb)| {
        let plant = plant.bypass_change_detection();
        let Some(own) = &mut plant.own else { return };
        if !own.changed.is_empty() {
            own.measure(&plant.linked, plant.shaping);
            aabb.set_if_neq(own.bounds);
        }
    });
}

/// Writes what has changed into the tables, from where it is extracted.
pub(crate) fn collect(
    mut data: ResMut<FrustaData>,
    mut stats: ResMut<FrustaStats>,
    mut plants: Query<&mut FrustaPlant, With<PosedJoints>>,
    mut materials: ResMut<Assets<FrustaMaterial>>,
    mut announced: Local<[usize; 3]>,
) {
    let data = data.as_mut();
    (stats.plants, stats.segments) = data.drawn();
    stats.moved_joints = 0;
    for mut plant in &mut plants {
        let plant = plant.bypass_change_detection();
        if let Some(own) = &mut plant.own {
            for range in own.changed.drain(..) {
                stats.moved_joints += range.len();
                data.joints
                    .write(plant.joints, range.start, &own.records[range]);
            }
        }
    }
    stats.uploaded_bytes =
        data.joints.changed_bytes() + data.shapes.changed_bytes() + data.plants.changed_bytes();
    // Buffers that have to grow are made anew, and with them the bind groups that name them.
    let lengths = [
        data.joints.rows().len(),
        data.shapes.rows().len(),
        data.plants.rows().len(),
    ];
    let capacities = lengths.map(super::buffers::capacity);
    if capacities != *announced {
        *announced = capacities;
        // Going through them marks them all modified.
        materials.iter_mut().for_each(drop);
    }
}

/// Forgets what was uploaded in the frame before.
pub(crate) fn begin_frame(mut data: ResMut<FrustaData>) {
    data.joints.clear_changed();
    data.shapes.clear_changed();
    data.plants.clear_changed();
}
