//! Volumes by turns, and pictures that are gathered over frames.

use bevy::anti_alias::taa::TemporalAntiAliasing;
use bevy::prelude::*;
use bevy_verdure::lab::Studio;
use bevy_verdure::prelude::*;
use bevy_verdure::texel::build::{VolumeSettings, from_hypertexture};
use bevy_verdure::texel::silent;

use super::{BACKGROUND, LOLLY, cover_default, is_background, shot, unlit};

const EYE: Vec3 = Vec3::new(1.9, 2.3, 1.2);

/// A small red ball.
pub fn ball() -> TexelVolume {
    let solid = |at: Vec3| (0.7 - at.distance(Vec3::splat(0.5)), Vec3::X);
    let settings = VolumeSettings::new(UVec3::splat(16));
    let built = from_hypertexture(solid, &settings, &silent);
    built.expect("the volume is in range").volume.into()
}

fn seen(studio: &mut Studio) -> Vec<u8> {
    studio.headless.step();
    studio.photograph(&shot(EYE), BACKGROUND).rgb_bytes()
}

#[test]
fn volumes_are_shown_by_turns() {
    let mut studio = Studio::default();
    let surface = cover_default(&mut studio, unlit());
    let lolly = seen(&mut studio);
    let world = studio.world();
    let mut volumes = world.resource_mut::<Assets<TexelVolume>>();
    let (first, second) = (volumes.add(LOLLY.clone()), volumes.add(ball()));
    let cycle = |volumes: [&Handle<TexelVolume>; 2], rate| TexelCycle {
        volumes: volumes.map(Clone::clone).into(),
        rate,
    };
    let turns = cycle([&second, &first], 0.0);
    world.entity_mut(surface).insert(turns);
    let ball = seen(&mut studio);
    assert!(ball != lolly);
    for _ in 0..30 {
        studio.headless.step();
    }
    // One and a half turns from now on, for a while.
    let world = studio.world();
    let rate = 1.2 / world.resource::<Time>().elapsed_secs();
    let turns = cycle([&second, &first], rate);
    world.entity_mut(surface).insert(turns);
    assert!(seen(&mut studio) == lolly);
    let turns = cycle([&second, &first], -rate * 0.5);
    studio.world().entity_mut(surface).insert(turns);
    assert!(seen(&mut studio) == lolly, "backwards from the last");
    let turns = cycle([&first, &second], -rate * 0.5);
    studio.world().entity_mut(surface).insert(turns);
    assert!(seen(&mut studio) == ball);
}

#[test]
fn temporal_anti_aliasing_keeps_texels_where_they_are() {
    let mut studio = Studio::default();
    cover_default(&mut studio, unlit());
    studio.headless.step();
    let plain = studio.photograph(&shot(EYE), BACKGROUND);
    let camera = studio.camera();
    studio
        .world()
        .entity_mut(camera)
        .insert((Msaa::Off, TemporalAntiAliasing::default()));
    for _ in 0..12 {
        studio.headless.step();
    }
    let gathered = studio.photograph(&shot(EYE), BACKGROUND);
    let size = shot(EYE).size;
    let there = |x: u32, y: u32| !is_background(plain.rgb(x, y));
    let (mut inside, mut lost, mut ghosts) = (0, 0, 0);
    for y in 2..size.y - 2 {
        for x in 2..size.x - 2 {
            let near = (y - 2..=y + 2).flat_map(|y| (x - 2..=x + 2).map(move |x| (x, y)));
            let count = near.filter(|&(x, y)| there(x, y)).count();
            let [_, _, blue] = gathered.rgb(x, y);
            let [_, _, own] = plain.rgb(x, y);
            // Two pixels from outlines colours change slowly, and stay what they are.
            if count == 25 {
                inside += 1;
                lost += usize::from(blue.abs_diff(own) > 60);
            } else if count == 0 {
                ghosts += usize::from(blue < 250);
            }
        }
    }
    println!("of {inside} pixels {lost} are lost, and {ghosts} appear outside");
    assert!(inside > 500);
    assert!(50 * lost < inside && ghosts == 0, "{lost} {ghosts}");
}
