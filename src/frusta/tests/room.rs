//! Tables that are full: plants wait, and are drawn as soon as others have gone.

use std::io::{self, Write};
use std::sync::{Arc, Mutex};

use bevy::ecs::schedule::SingleThreadedExecutor;
use bevy::log::tracing_subscriber;
use bevy::log::tracing_subscriber::util::SubscriberInitExt;
use bevy::prelude::*;

use crate::frusta::plant::FrustaPlant;
use crate::frusta::share::FrustaData;
use crate::frusta::table::Table;
use crate::prelude::*;

/// Rows that each table has room for.
struct Room {
    joints: u32,
    shapes: u32,
    plants: u32,
}

/// Enough of a table for all that is planted here.
const ENOUGH: u32 = 64;

/// An app without a device, and what it has said of room.
struct Garden {
    app: App,
    log: Log,
}

#[derive(Clone, Default)]
struct Log(Arc<Mutex<Vec<u8>>>);

impl Write for Log {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.lock().unwrap().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Garden {
    fn new(room: Room) -> Self {
        let mut app = App::new();
        app.add_plugins((
            MinimalPlugins,
            bevy::asset::AssetPlugin::default(),
            bevy::image::ImagePlugin::default(),
            bevy::mesh::MeshPlugin,
        ))
        .init_asset::<bevy::shader::Shader>()
        .add_plugins(VerdurePlugin)
        .insert_resource(FrustaData::with_tables(
            Table::with_capacity("joints", room.joints),
            Table::with_capacity("joints", room.shapes),
            Table::with_capacity("plants", room.plants),
        ))
        // On this thread, whose log is read.
        .edit_schedule(PostUpdate, |schedule| {
            schedule.set_executor(SingleThreadedExecutor::new());
        });
        app.finish();
        app.cleanup();
        Self {
            app,
            log: Log::default(),
        }
    }

    fn frames(&mut self, count: usize) {
        let _log = tracing_subscriber::fmt()
            .with_writer(Mutex::new(self.log.clone()))
            .set_default();
        for _ in 0..count {
            self.app.update();
        }
    }

    fn plant(&mut self, joints: usize, more: impl Bundle) -> Entity {
        let skeleton = limb(joints);
        let world = self.app.world_mut();
        let skeleton = world.resource_mut::<Assets<Skeleton>>().add(skeleton);
        world.spawn((Skeleton3d(skeleton), more)).id()
    }

    fn uproot(&mut self, plant: Entity) {
        self.app.world_mut().despawn(plant);
    }

    fn is_drawn(&self, plant: Entity) -> bool {
        let plant = self.app.world().entity(plant);
        plant.contains::<FrustaPlant>() && plant.contains::<Mesh3d>()
    }

    /// How often a plant was said to have no room.
    fn reports(&self) -> usize {
        let log = self.log.0.lock().unwrap();
        String::from_utf8_lossy(&log).matches("no room for").count()
    }
}

fn limb(joints: usize) -> Skeleton {
    let mut limb = Skeleton::builder();
    let mut last = limb.root(Vec3::ZERO, 0.1);
    for i in 1..joints {
        last = limb.joint(last, Vec3::Y * i as f32, 0.1);
    }
    limb.build().unwrap()
}

fn bent(joints: usize) -> SkeletonPose {
    SkeletonPose {
        rotations: vec![Quat::from_rotation_x(0.2); joints],
    }
}

#[test]
fn a_plant_without_room_is_reported_once_and_drawn_as_soon_as_there_is_room() {
    let rooms = [
        ("joints", [8, ENOUGH, ENOUGH]),
        ("shapes", [ENOUGH, 8, ENOUGH]),
        ("plants", [ENOUGH, ENOUGH, 1]),
    ];
    for (full, [joints, shapes, plants]) in rooms {
        for is_bent in [false, true] {
            let mut garden = Garden::new(Room {
                joints,
                shapes,
                plants,
            });
            let mut plant = |joints| match is_bent {
                true => garden.plant(joints, bent(joints)),
                false => garden.plant(joints, ()),
            };
            let (first, second) = (plant(4), plant(6));
            garden.frames(1);
            assert!(garden.is_drawn(first), "{full}");
            garden.frames(3);
            assert!(!garden.is_drawn(second), "{full}");
            assert_eq!(garden.reports(), 1, "{full}");
            garden.uproot(first);
            garden.frames(1);
            assert!(garden.is_drawn(second), "{full}");
            garden.frames(3);
            assert_eq!(garden.reports(), 1, "{full}");
            let stats = garden.app.world().resource::<FrustaStats>();
            assert_eq!((stats.plants, stats.segments), (1, 5), "{full}");
            // Nothing is left behind in any table: as much fits as at first.
            garden.uproot(second);
            garden.frames(1);
            let mut data = garden.app.world_mut().resource_mut::<FrustaData>();
            assert!(data.joints.allocate(joints as usize).is_ok(), "{full}");
            assert!(data.shapes.allocate(shapes as usize).is_ok(), "{full}");
            assert!(data.plants.allocate(plants as usize).is_ok(), "{full}");
        }
    }
}

#[test]
fn room_that_does_not_suffice_is_no_reason_to_report_anew() {
    let mut garden = Garden::new(Room {
        joints: 8,
        shapes: ENOUGH,
        plants: ENOUGH,
    });
    let (small, large) = (garden.plant(2, ()), garden.plant(4, ()));
    garden.frames(1);
    let waiting = garden.plant(6, ());
    garden.frames(1);
    garden.uproot(small);
    garden.frames(3);
    assert!(garden.is_drawn(large) && !garden.is_drawn(waiting));
    assert_eq!(garden.reports(), 1);
    // One that found room and lost it again is told of again.
    garden.uproot(large);
    garden.frames(1);
    assert!(garden.is_drawn(waiting));
    let skeleton = garden
        .app
        .world_mut()
        .resource_mut::<Assets<Skeleton>>()
        .add(limb(7));
    garden
        .app
        .world_mut()
        .entity_mut(waiting)
        .insert(Skeleton3d(skeleton));
    garden.frames(3);
    assert_eq!(garden.reports(), 2);
}

#[test]
fn a_plant_keeps_its_shape_until_there_is_room_for_the_next() {
    let mut garden = Garden::new(Room {
        joints: 8,
        shapes: ENOUGH,
        plants: ENOUGH,
    });
    let (plant, other) = (garden.plant(4, ()), garden.plant(3, ()));
    garden.frames(1);
    let round = Frusta::default().with_join(Join::Round);
    garden.app.world_mut().entity_mut(plant).insert(round);
    garden.frames(3);
    let settings = |garden: &Garden| {
        let drawn = garden.app.world().get::<FrustaPlant>(plant);
        drawn.map(|drawn| drawn.shaping.frusta)
    };
    assert_eq!(settings(&garden), Some(Frusta::default()));
    assert_eq!(garden.reports(), 1);
    garden.uproot(other);
    garden.frames(1);
    assert_eq!(settings(&garden), Some(round));
    assert_eq!(garden.reports(), 1);
}
