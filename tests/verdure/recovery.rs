//! A device that is lost in the middle of a game: plants are drawn again by the next one.

use std::time::{Duration, Instant};

use bevy::prelude::*;
use bevy::render::error_handler::{ErrorType, RenderErrorHandler, RenderErrorPolicy};
use bevy::render::render_resource::PollType;
use bevy::render::renderer::RenderDevice;
use bevy_verdure::lab::{Figures, Lens, Shot, Studio};
use bevy_verdure::prelude::*;

use crate::skeletons::{Dice, TREE, ball};

/// How many devices an app has had.
#[derive(Resource, Default)]
struct Devices(usize);

fn count_devices(mut devices: ResMut<Devices>) {
    devices.0 += 1;
}

/// A studio whose app goes on with another device when it has lost one.
pub fn recovering_studio() -> Studio {
    Studio::new(|app| {
        app.insert_resource(RenderErrorHandler(|error, _, _| match error.ty {
            ErrorType::DeviceLost => RenderErrorPolicy::Recover(default()),
            _ => panic!("{error:?}"),
        }))
        .init_resource::<Devices>()
        .add_systems(
            Update,
            count_devices.run_if(resource_changed::<RenderDevice>),
        );
    })
}

/// Takes the device away, and waits for the next one to be in use.
pub fn lose_device(studio: &mut Studio) {
    let lost = studio.world().resource::<RenderDevice>().clone();
    lost.wgpu_device().destroy();
    // An error here is the lost device's, which the next frame reports.
    let _ = lost.poll(PollType::wait_indefinitely());
    let patience = Instant::now() + Duration::from_secs(60);
    while studio.world().resource::<Devices>().0 < 2 {
        assert!(Instant::now() < patience, "no new device");
        studio.headless.step();
    }
    // Bevy starts its renderer, and takes over assets, in the frames after.
    for _ in 0..4 {
        studio.headless.step();
    }
}

#[test]
fn plants_come_back_after_their_device_is_lost() {
    let mut studio = recovering_studio();
    let skeleton = TREE.grow(&mut Dice::new(3));
    let (centre, radius) = ball(&skeleton);
    let shot = Shot {
        eye: centre + Vec3::new(0.4, 0.3, 2.0) * radius,
        at: centre,
        lens: Lens::Perspective(0.8),
        size: UVec2::new(96, 72),
    };
    let bent = studio.plant(skeleton.clone(), Frusta::default(), Transform::IDENTITY);
    let rotations = vec![Quat::from_rotation_x(0.1); skeleton.len()];
    studio
        .world()
        .entity_mut(bent)
        .insert(SkeletonPose { rotations });
    let beside = Transform::from_translation(Vec3::X * (0.5 * radius));
    studio.plant(skeleton, Frusta::default(), beside);
    let before = pixels(&studio.measure(&shot));
    assert!(before.iter().flatten().count() > 500);
    lose_device(&mut studio);
    assert_eq!(pixels(&studio.measure(&shot)), before);
}

/// Segment and depth of each pixel.
fn pixels(figures: &Figures) -> Vec<Option<(u32, f32)>> {
    let size = figures.size();
    let pixel = |i: u32| {
        let seen = figures.get(i % size.x, i / size.x)?;
        Some((seen.segment, seen.depth))
    };
    (0..size.x * size.y).map(pixel).collect()
}
