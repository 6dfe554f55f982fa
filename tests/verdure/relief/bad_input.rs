//! Maps that are not there or no maps, and shells that are none.

use std::time::{Duration, Instant};

use bevy::prelude::*;
use bevy_verdure::lab::{Figures, Studio};
use bevy_verdure::prelude::*;

use super::{SHOT, THICKNESS, limb, studio_with};

/// Depths of all pixels; a miss has none.
fn depths(figures: &Figures) -> Vec<Option<f32>> {
    let size = figures.size();
    (0..size.x * size.y)
        .map(|i| figures.get(i % size.x, i / size.x).map(|seen| seen.depth))
        .collect()
}

fn smooth() -> Vec<Option<f32>> {
    let mut studio = Studio::default();
    studio.plant(limb(0.75, 0.5), Frusta::default(), Transform::IDENTITY);
    depths(&studio.measure(&SHOT))
}

/// The greatest difference of depth; every pixel must see the plant in both, or in neither, but for `strays`.
fn difference(a: &[Option<f32>], b: &[Option<f32>], strays: usize) -> f32 {
    let pairs = a.iter().zip(b);
    let other = pairs.clone().filter(|(a, b)| a.is_some() != b.is_some());
    assert!(other.count() <= strays);
    pairs.fold(0.0, |worst: f32, pair| match pair {
        (Some(a), Some(b)) => worst.max((a - b).abs()),
        _ => worst,
    })
}

#[test]
fn a_shell_that_is_none_is_no_relief() {
    let smooth = smooth();
    for thickness in [
        ReliefThickness::Metres(0.0),
        ReliefThickness::Metres(-1.0),
        ReliefThickness::Relative(f32::NAN),
        ReliefThickness::Metres(f32::INFINITY),
    ] {
        let mut studio = studio_with(&limb(0.75, 0.5), Color::WHITE.into(), |relief| Relief {
            thickness,
            ..relief
        });
        let seen = depths(&studio.measure(&SHOT));
        assert_eq!(difference(&smooth, &seen, 0), 0.0, "{thickness:?}");
    }
}

#[test]
fn a_map_that_cannot_be_loaded_leaves_the_plant_smooth() {
    let mut studio = Studio::default();
    let map = studio
        .world()
        .resource::<AssetServer>()
        .load("there_is_no_such_map.png");
    let relief = Relief::new(map.clone(), ReliefThickness::Metres(THICKNESS));
    let material = relief_material(Color::WHITE, relief);
    studio.plant_in(
        limb(0.75, 0.5),
        Frusta::default(),
        Transform::IDENTITY,
        material,
    );
    // Files are read behind the frames, and late if much else is.
    let patience = Instant::now() + Duration::from_secs(60);
    while !studio
        .world()
        .resource::<AssetServer>()
        .load_state(map.id())
        .is_failed()
    {
        assert!(
            Instant::now() < patience,
            "the map is not known to be missing"
        );
        studio.headless.step();
    }
    let is_drawn = |studio: &mut Studio| depths(&studio.measure(&SHOT)).iter().any(Option::is_some);
    assert!(
        (0..4).any(|_| is_drawn(&mut studio)),
        "the plant appears once the map is known to be missing"
    );
    // Half a level of 255 lies above the floor, which the shell is never thinner than.
    let seen = depths(&studio.measure(&SHOT));
    let strays = seen.len() / 100;
    let off = difference(&smooth(), &seen, strays);
    assert!(off < THICKNESS, "{off}");
}

#[test]
fn a_shell_thicker_than_the_plant_is_clamped_and_drawn() {
    for (thickness, level) in [(1e6, 0.0), (1e6, 1.0), (5.0, 0.5), (1e6, f32::NAN)] {
        let thickness = ReliefThickness::Metres(thickness);
        let mut studio = studio_with(&limb(0.75, 0.5), Color::WHITE.into(), |relief| Relief {
            thickness,
            level,
            ..relief
        });
        let seen = depths(&studio.measure(&SHOT));
        assert!(seen.iter().any(Option::is_some), "{thickness:?}, {level}");
        assert!(seen.iter().flatten().all(|depth| depth.is_finite()));
    }
}
