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
use super::table::{Rows, Table};
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

impl Default for FrustaData {
    fn default() -> Self {
        Self {
            joints: Table::new("joints"),
            shapes: Table::new("joints"),
            plants: Table::new("plants"),
            versions: HashMap::default(),
            skeletons: HashMap::default(),
            stances: HashMap::default(),
            drawn: (0, 0),
        }
    }
}

impl FrustaData {
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

    /// Gives a plant its place in the tables. `None`, with an error in the log, when there is no room.
    pub(crate) fn attach(
        &mut self,
        id: AssetId<Skeleton>,
        skeleton: &Skeleton,
        shaping: Shaping,
        posed: bool,
    ) -> Option<FrustaPlant> {
        let key = self.key(id);
        let (linked, first_shape) = self.share_skeleton(key, skeleton)?;
        let (joints, bounds, own) = if posed {
            let own = OwnPose::at_rest(&linked, shaping);
            let joints = self.joints.allocate(own.records.len());
            (joints, own.bounds, Some(own))
        } else {
            match self.share_stance(key, &linked, shaping) {
                Some((joints, bounds)) => (Some(joints), bounds, None),
                None => (None, Aabb::default(), None),
            }
        };
        let slot = self.plants.allocate(1);
        let (Some(joints), Some(slot)) = (joints, slot) else {
            if let Some(slot) = slot {
                self.plants.free(slot);
            }
            if let Some(joints) = joints {
                match posed {
                    true => self.joints.free(joints),
                    false => self.release_stance(key, shaping),
                }
            }
            self.release_skeleton(key);
            return None;
        };
        let record = PlantRecord {
            first_joint: joints.first(),
            first_shape,
            joint_count: linked.links.len() as u32,
            unused: 0,
        };
        self.plants.write(slot, 0, &[record]);
        self.drawn.0 += 1;
        self.drawn.1 += linked.segments;
        Some(FrustaPlant {
            skeleton: key,
            shaping,
            linked,
            slot,
            joints,
            bounds,
            own,
        })
    }

    /// Gives back what a plant had.
    pub(crate) fn detach(&mut self, plant: &FrustaPlant) {
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
    ) -> Option<(Arc<LinkedSkeleton>, u32)> {
        if let Some(shared) = self.skeletons.get_mut(&key) {
            shared.users += 1;
            return Some((shared.linked.clone(), shared.shapes.first()));
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
        Some((linked, shapes.first()))
    }

    fn share_stance(
        &mut self,
        key: SkeletonKey,
        linked: &LinkedSkeleton,
        shaping: Shaping,
    ) -> Option<(Rows, Aabb)> {
        if let Some(shared) = self.stances.get_mut(&(key, shaping)) {
            shared.users += 1;
            return Some((shared.joints, shared.bounds));
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
        Some((joints, stance.bounds))
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
