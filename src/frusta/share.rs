//! The tables behind the GPU's buffers, and what plants of one skeleton share in them.

use std::sync::Arc;

use bevy::asset::AssetId;
use bevy::camera::primitives::Aabb;
use bevy::ecs::resource::Resource;
use bevy::platform::collections::HashMap;

use super::links::LinkedSkeleton;
use super::plant::{FrustaPlant, OwnPose};
use super::records::{JointRecord, PlantRecord, ShapeRecord};
use super::shaping::Shaping;
use super::table::{NoRoomError, Rows, Table};
use crate::skeleton::Skeleton;

/// A skeleton as it was when it was last loaded: plants keep the old one until they follow a reload.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct SkeletonKey {
    pub id: AssetId<Skeleton>,
    version: u32,
}

/// Everything that the frusta of a world have on the GPU.
#[derive(Resource)]
pub(crate) struct FrustaData {
    pub joints: Table<JointRecord>,
    pub shapes: Table<ShapeRecord>,
    pub plants: Table<PlantRecord>,
    versions: HashMap<AssetId<Skeleton>, u32>,
    skeletons: HashMap<SkeletonKey, SharedSkeleton>,
    stances: HashMap<(SkeletonKey, Shaping), SharedStance>,
    /// Plants that have a place in the tables, and their segments.
    drawn: (usize, usize),
    /// Some plant has given its place back since those that wait for one were last tried.
    gave_back: bool,
}

/// What all plants of a skeleton share, whatever their pose.
struct SharedSkeleton {
    linked: Arc<LinkedSkeleton>,
    shapes: Rows,
    users: usize,
}

/// What all plants share that stand as their skeleton does.
struct SharedStance {
    joints: Rows,
    bounds: Aabb,
    users: usize,
}

/// A plant's place in the tables.
struct Place {
    slot: Rows,
    joints: Rows,
    bounds: Aabb,
    own: Option<OwnPose>,
}

impl Default for FrustaData {
    fn default() -> Self {
        Self::with_tables(
            Table::new("joints"),
            Table::new("joints"),
            Table::new("plants"),
        )
    }
}

impl FrustaData {
    /// With nothing in any table.
    pub(crate) fn with_tables(
        joints: Table<JointRecord>,
        shapes: Table<ShapeRecord>,
        plants: Table<PlantRecord>,
    ) -> Self {
        Self {
            joints,
            shapes,
            plants,
            versions: HashMap::default(),
            skeletons: HashMap::default(),
            stances: HashMap::default(),
            drawn: (0, 0),
            gave_back: false,
        }
    }

    /// The key of a skeleton as it is now.
    pub(crate) fn key(&self, id: AssetId<Skeleton>) -> SkeletonKey {
        let version = self.versions.get(&id).copied().unwrap_or_default();
        SkeletonKey { id, version }
    }

    /// How many plants have a shape, and their segments.
    pub(crate) fn drawn(&self) -> (usize, usize) {
        self.drawn
    }

    /// Notes that a skeleton has changed.
    pub(crate) fn reloaded(&mut self, id: AssetId<Skeleton>) {
        *self.versions.entry(id).or_default() += 1;
    }

    /// Forgets a skeleton that is gone.
    pub(crate) fn unloaded(&mut self, id: AssetId<Skeleton>) {
        // The version goes on counting, should the id come back while plants still have the old shape.
        if self.skeletons.keys().any(|key| key.id == id) {
            self.reloaded(id);
        } else {
            self.versions.remove(&id);
        }
    }

    /// Gives a plant its place in the tables.
    pub(crate) fn attach(
        &mut self,
        id: AssetId<Skeleton>,
        skeleton: &Skeleton,
        shaping: Shaping,
        posed: bool,
    ) -> Result<FrustaPlant, NoRoomError> {
        let key = self.key(id);
        let (linked, first_shape) = self.share_skeleton(key, skeleton)?;
        let place = self.place(key, &linked, shaping, posed);
        if place.is_err() {
            self.release_skeleton(key);
        }
        let Place {
            slot,
            joints,
            bounds,
            own,
        } = place?;
        let record = PlantRecord {
            first_joint: joints.first(),
            first_shape,
            joint_count: linked.links.len() as u32,
            unused: 0,
        };
        self.plants.write(slot, 0, &[record]);
        self.drawn.0 += 1;
        self.drawn.1 += linked.segments;
        Ok(FrustaPlant {
            skeleton: key,
            shaping,
            linked,
            slot,
            joints,
            bounds,
            own,
        })
    }

    /// A plant's row, and its joints or those that it shares; nothing is taken if either has no room.
    fn place(
        &mut self,
        key: SkeletonKey,
        linked: &LinkedSkeleton,
        shaping: Shaping,
        posed: bool,
    ) -> Result<Place, NoRoomError> {
        let slot = self.plants.allocate(1)?;
        let stance = if posed {
            let own = OwnPose::at_rest(linked, shaping);
            let joints = self.joints.allocate(own.records.len());
            joints.map(|joints| (joints, own.bounds, Some(own)))
        } else {
            let shared = self.share_stance(key, linked, shaping);
            shared.map(|(joints, bounds)| (joints, bounds, None))
        };
        if stance.is_err() {
            self.plants.free(slot);
        }
        let (joints, bounds, own) = stance?;
        Ok(Place {
            slot,
            joints,
            bounds,
            own,
        })
    }

    /// True once after some plant has given its place back.
    pub(crate) fn take_gave_back(&mut self) -> bool {
        core::mem::take(&mut self.gave_back)
    }

    /// Gives back what a plant had.
    pub(crate) fn detach(&mut self, plant: &FrustaPlant) {
        self.gave_back = true;
        self.drawn.0 -= 1;
        self.drawn.1 -= plant.linked.segments;
        self.plants.free(plant.slot);
        match plant.own {
            Some(_) => self.joints.free(plant.joints),
            None => self.release_stance(plant.skeleton, plant.shaping),
        }
        self.release_skeleton(plant.skeleton);
    }

    fn share_skeleton(
        &mut self,
        key: SkeletonKey,
        skeleton: &Skeleton,
    ) -> Result<(Arc<LinkedSkeleton>, u32), NoRoomError> {
        if let Some(shared) = self.skeletons.get_mut(&key) {
            shared.users += 1;
            return Ok((shared.linked.clone(), shared.shapes.first()));
        }
        let linked = Arc::new(LinkedSkeleton::new(skeleton));
        let shapes = self.shapes.allocate(linked.shapes.len())?;
        self.shapes.write(shapes, 0, &linked.shapes);
        let shared = SharedSkeleton {
            linked: linked.clone(),
            shapes,
            users: 1,
        };
        self.skeletons.insert(key, shared);
        Ok((linked, shapes.first()))
    }

    fn share_stance(
        &mut self,
        key: SkeletonKey,
        linked: &LinkedSkeleton,
        shaping: Shaping,
    ) -> Result<(Rows, Aabb), NoRoomError> {
        if let Some(shared) = self.stances.get_mut(&(key, shaping)) {
            shared.users += 1;
            return Ok((shared.joints, shared.bounds));
        }
        let stance = OwnPose::at_rest(linked, shaping);
        let joints = self.joints.allocate(stance.records.len())?;
        self.joints.write(joints, 0, &stance.records);
        let shared = SharedStance {
            joints,
            bounds: stance.bounds,
            users: 1,
        };
        self.stances.insert((key, shaping), shared);
        Ok((joints, stance.bounds))
    }

    fn release_skeleton(&mut self, key: SkeletonKey) {
        if let Some(shared) = self.skeletons.get_mut(&key) {
            shared.users -= 1;
            if shared.users == 0 {
                self.shapes.free(shared.shapes);
                self.skeletons.remove(&key);
            }
        }
    }

    fn release_stance(&mut self, key: SkeletonKey, shaping: Shaping) {
        if let Some(shared) = self.stances.get_mut(&(key, shaping)) {
            shared.users -= 1;
            if shared.users == 0 {
                self.joints.free(shared.joints);
                self.stances.remove(&(key, shaping));
            }
        }
    }
}
