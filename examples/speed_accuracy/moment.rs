//! The dancing cacti at one moment of their dance, as plants that stand still, so that frusta and polygons are of one
//! shape and nothing but drawing is timed.

use std::time::Duration;

use bevy::prelude::*;
use bevy_verdure::lab::Headless;
use bevy_verdure::plants::{Plant, PlantPart, Planting, Surface};
use bevy_verdure::prelude::*;

use super::crowd::crowd;

/// Frames of the dance before the moment: segments are unfolded, flowers put on, and everybody is in full swing.
const FRAMES: usize = 8;
/// Time between them.
const STEP: Duration = Duration::from_millis(160);

/// The crowd, each cactus and each flower a plant.
pub fn dancing_cacti() -> Planting {
    let mut headless = Headless::new(STEP, |app| {
        app.add_plugins((VerdurePlugin, crowd));
    });
    for _ in 0..FRAMES {
        headless.step();
    }
    let world = headless.world();
    let mut plants = world.query::<(&Skeleton3d, &GlobalTransform, Option<&PosedJoints>)>();
    let skeletons = world.resource::<Assets<Skeleton>>();
    let mut planting = Planting::default();
    for (skeleton, transform, posed) in plants.iter(world) {
        let Some(skeleton) = skeletons.get(&skeleton.0) else {
            continue;
        };
        let posed = posed.map_or(&[][..], |posed| posed.positions());
        let joints = skeleton.joints().iter().enumerate().map(|(i, joint)| {
            let local = posed.get(i).copied().unwrap_or(joint.position);
            let mut joint = joint.clone();
            joint.position = transform.transform_point(local);
            joint
        });
        let Ok(skeleton) = Skeleton::new(joints.collect()) else {
            continue;
        };
        // Flowers are those that do not bend.
        let kind = if posed.is_empty() {
            Surface::OcotilloFlower
        } else {
            Surface::SaguaroSkin
        };
        let plant = planting.add(Plant {
            parts: vec![PlantPart { kind, skeleton }],
        });
        planting.place(plant, Vec3::ZERO, 0.0, 1.0);
    }
    planting
}
