//! Pictures when files are slow to come.

use core::time::Duration;
use std::thread::sleep;

use bevy::prelude::*;
use bevy::tasks::IoTaskPool;
use bevy_verdure::lab::{Lens, Shot, Studio};
use bevy_verdure::prelude::*;

use crate::skeletons;

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
