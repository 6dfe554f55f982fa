//! Pictures when files are slow to come, and when frames are drawn while the next one begins.

use core::time::Duration;
use std::thread::sleep;

use bevy::prelude::*;
use bevy::tasks::IoTaskPool;
use bevy_verdure::lab::{Lens, Shot, Studio};
use bevy_verdure::prelude::*;

use crate::{skeletons, slicing, texel};

#[test]
fn pictures_have_their_shaders_however_long_these_take() {
    let shot = Shot {
        eye: Vec3::new(0.0, 0.5, 3.0),
        at: Vec3::new(0.0, 0.5, 0.0),
        lens: Lens::Perspective(0.9),
        size: UVec2::new(64, 48),
    };
    let photograph = |mut studio: Studio| {
        studio.plant(skeletons::limb(2), Frusta::default(), Transform::IDENTITY);
        studio.photograph(&shot, Color::BLACK).rgb_bytes()
    };
    let at_once = photograph(Studio::default());
    assert!(at_once.iter().any(|&byte| byte > 0));
    let late = photograph(Studio::new(|_| {
        // Nothing is read while all who read are busy.
        let readers = IoTaskPool::get();
        for _ in 0..readers.thread_num() {
            let busy = async { sleep(Duration::from_secs(2)) };
            readers.spawn(busy).detach();
        }
    }));
    assert_eq!(late, at_once);
}

/// A picture of what has been there for some frames.
fn settled(studio: &mut Studio, shot: &Shot) -> Vec<u8> {
    for _ in 0..4 {
        studio.headless.step();
    }
    studio.photograph(shot, Color::WHITE).rgb_bytes()
}

#[test]
fn frames_that_are_drawn_while_the_next_one_begins_look_the_same() {
    let shot = Shot {
        eye: Vec3::new(0.0, 2.5, 8.0),
        at: Vec3::new(0.0, 1.2, 0.0),
        lens: Lens::Perspective(0.9),
        size: UVec2::new(128, 96),
    };
    let pictures = [Studio::default(), Studio::pipelined()].map(|mut studio| {
        let left = Transform::from_xyz(-2.0, 0.0, 0.0);
        let right = Transform::from_xyz(2.0, 0.0, 0.0);
        let plants = [
            studio.plant(skeletons::limb(2), Frusta::default(), left),
            slicing::plant(&mut studio, CrownSettings::default(), right),
            texel::cover_default(&mut studio, TexelSettings::default()),
        ];
        let before = settled(&mut studio, &shot);
        for plant in plants {
            let world = studio.world();
            let mut place = world.get_mut::<Transform>(plant).expect("it has one");
            place.rotate_local_y(1.0);
            place.translation.y += 0.2;
        }
        let moved = settled(&mut studio, &shot);
        for plant in plants {
            studio.world().despawn(plant);
        }
        [before, moved, settled(&mut studio, &shot)]
    });
    let [one_by_one, pipelined] = pictures;
    assert!(one_by_one[0] != one_by_one[1] && one_by_one[1] != one_by_one[2]);
    assert!(one_by_one[2].iter().all(|&byte| byte == 255));
    assert!(one_by_one == pipelined);
}
