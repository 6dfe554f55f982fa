//! Crowns that change while they are on screen.

use bevy::prelude::*;
use bevy_verdure::lab::{Lens, Pixels, Studio};
use bevy_verdure::prelude::*;
use bevy_verdure::slicing::blend::FOCAL;
use bevy_verdure::slicing::{SlicedCrownMaterial, SlicingShape};
use bevy_verdure::wind::sway;

use crate::recovery::{lose_device, recovering_studio};

use super::{CROWN, SIZE, SMALL, UNLIT, bake_crown, covered, eye, mean, plant, shot, studio};

#[test]
fn tints_settings_and_wind_follow_the_components() {
    let look = shot(eye(75.0, 10.0, 16.0));
    let (mut studio, crown) = studio(UNLIT);
    let plain = studio.photograph(&look, Color::BLACK);
    let mut change = |change: &mut dyn FnMut(&mut World)| {
        change(studio.world());
        studio.headless.step();
        studio.photograph(&look, Color::BLACK)
    };
    let red = change(&mut |world| {
        world
            .entity_mut(crown)
            .insert(CrownTint(Color::srgb(1.0, 0.0, 0.0)));
    });
    assert!(mean(&red, 1) < 0.5 && (mean(&red, 0) - mean(&plain, 0)).abs() < 0.5);
    let back = change(&mut |world| {
        world.entity_mut(crown).insert(CrownTint::default());
    });
    assert_eq!(back.rgb_bytes(), plain.rgb_bytes());
    let fewer = change(&mut |world| {
        world.entity_mut(crown).insert(CrownSettings {
            left_out: 3,
            ..UNLIT
        });
    });
    assert!(mean(&fewer, 1) < mean(&plain, 1));
    change(&mut |world| {
        world.entity_mut(crown).insert(UNLIT);
    });
    let windy = change(&mut |world| world.insert_resource(Wind::new(Vec3::X * 9.0)));
    assert_ne!(windy.rgb_bytes(), plain.rgb_bytes());
    let still = change(&mut |world| world.insert_resource(Wind::default()));
    assert_eq!(still.rgb_bytes(), plain.rgb_bytes());
}

/// The crown with the finest level alone, and of each orientation's slices with one alone.
fn one_slice(index: usize) -> Slicing {
    let shape = SlicingShape {
        levels: vec![CROWN.shape().levels[0]],
        switches: Vec::new(),
        ..CROWN.shape().clone()
    };
    let count = shape.levels[0] as usize;
    let empty = vec![[0; 4]; (shape.pixels * shape.pixels) as usize];
    let color = (0..shape.layers()).flat_map(|layer| {
        if layer % count == index {
            CROWN.color(layer).to_vec()
        } else {
            empty.clone()
        }
    });
    let color = color.collect();
    let normal = (0..shape.layers()).flat_map(|layer| CROWN.normal(layer).to_vec());
    let normal = normal.collect();
    Slicing::new(shape, color, normal).expect("one slice of the crown is a slicing")
}

/// How far right the green of a picture is in the mean, in pixels.
fn middle(picture: &Pixels) -> f64 {
    let all = (0..SIZE.y).flat_map(|y| (0..SIZE.x).map(move |x| (x, y)));
    let (sum, weight) = all.fold((0.0, 0.0), |(sum, weight), (x, y)| {
        let green = f64::from(picture.rgb(x, y)[1]);
        (sum + green * f64::from(x), weight + green)
    });
    sum / weight
}

/// How far the wind moves one slice, over what sways alike in all: the greatest of a while over the least.
fn flutter(index: usize) -> f64 {
    let mut studio = Studio::default();
    let world = studio.world();
    let slicing = world
        .resource_mut::<Assets<Slicing>>()
        .add(one_slice(index));
    world.spawn((SlicedCrown(slicing), UNLIT));
    studio.headless.step();
    // In line with an orientation, which so is drawn alone, the wind across.
    let look = shot(eye(0.0, 0.0, 16.0));
    let still = middle(&studio.photograph(&look, Color::BLACK));
    let wind = Wind::new(Vec3::Z * 25.0);
    studio.world().insert_resource(wind);
    studio.headless.step();
    let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
    // Slices flutter in 1.2 s.
    while studio.world().resource::<Time>().elapsed_secs() < 1.4 {
        for _ in 0..3 {
            studio.headless.step();
        }
        let moved = (middle(&studio.photograph(&look, Color::BLACK)) - still).abs();
        let time = studio.world().resource::<Time>().elapsed_secs();
        let share = moved / f64::from(sway(wind.velocity, Vec3::ZERO, 1.0, 1.0, time).z);
        (least, most) = (least.min(share), most.max(share));
    }
    most / least
}

#[test]
fn slices_near_to_the_eye_flutter_and_far_ones_hardly() {
    let [far, near] = [0, 4].map(flutter);
    println!("most over least: the furthest slice {far:.3}, the nearest {near:.3}");
    // By a quarter times nearness, which is 0.1 and 0.9: 1.05 and 1.58. A picture that is a frame older than its time is
    // taken to be sees gusts that are up to 3 % more or less.
    assert!(far < 1.2, "{far}");
    assert!(near > 1.35, "{near}");
}

#[test]
fn a_slicing_edited_in_its_old_shape_shows_whole() {
    let look = shot(eye(75.0, 10.0, 16.0));
    let (mut studio, crown) = studio(UNLIT);
    let plain = studio.photograph(&look, Color::BLACK);
    let crown = studio.world().entity(crown).get::<SlicedCrown>();
    let id = crown.expect("a crown").0.id();
    let inserted = studio
        .world()
        .resource_mut::<Assets<Slicing>>()
        .insert(id, CROWN.clone());
    assert!(inserted.is_ok());
    for _ in 0..2 {
        studio.headless.step();
    }
    let seen = studio.photograph(&look, Color::BLACK);
    assert_eq!(seen.rgb_bytes(), plain.rgb_bytes());
}

#[test]
fn an_edited_slicing_shows_and_a_crown_no_more_is_gone() {
    let look = shot(eye(75.0, 10.0, 16.0));
    let (mut studio, crown) = studio(UNLIT);
    let plain = studio.photograph(&look, Color::BLACK);
    // The same shape in pure blue, with one level.
    let shape = SlicingShape {
        levels: vec![CROWN.shape().levels[0]],
        switches: Vec::new(),
        ..CROWN.shape().clone()
    };
    let layers = shape.layers();
    let pixels = |of: &dyn Fn(usize) -> Vec<[u8; 4]>| (0..layers).flat_map(of).collect::<Vec<_>>();
    let blue = pixels(&|layer| {
        CROWN
            .color(layer)
            .iter()
            .map(|p| [0, 0, 255, p[3]])
            .collect()
    });
    let normal = pixels(&|layer| CROWN.normal(layer).to_vec());
    let edited = Slicing::new(shape, blue, normal).expect("one level of the crown is a slicing");
    let id = studio
        .world()
        .entity(crown)
        .get::<SlicedCrown>()
        .expect("a crown")
        .0
        .id();
    let inserted = studio
        .world()
        .resource_mut::<Assets<Slicing>>()
        .insert(id, edited);
    assert!(inserted.is_ok());
    for _ in 0..2 {
        studio.headless.step();
    }
    let seen = studio.photograph(&look, Color::BLACK);
    assert!(mean(&seen, 1) < 0.1 && mean(&seen, 2) > mean(&plain, 2) + 10.0);
    studio.world().entity_mut(crown).remove::<SlicedCrown>();
    studio.headless.step();
    let gone = studio.photograph(&look, Color::BLACK);
    assert_eq!(covered(&gone, [0; 3]), 0);
    studio.headless.step();
    let left = studio
        .world()
        .resource::<Assets<SlicedCrownMaterial>>()
        .len();
    assert_eq!(left, 0, "what no crown uses is forgotten");
}

#[test]
fn an_edited_slicing_is_drawn_as_a_fresh_one_whatever_its_shape_was() {
    let round = BakeSettings::default().with_pixels(32).with_slices(7);
    let round = bake_crown(&round.with_orientations(Orientations::Sphere(8)));
    let versions: [&Slicing; 3] = [&CROWN, &SMALL, &round];
    let (mut studio, crown) = studio(UNLIT);
    // From afar, and so near that the discrepancy angle is taken part by part.
    let looks = [16.0, 6.0].map(|distance| shot(eye(75.0, 10.0, distance)));
    let pictures = |studio: &mut Studio| {
        for _ in 0..2 {
            studio.headless.step();
        }
        looks.map(|look| studio.photograph(&look, Color::BLACK).rgb_bytes())
    };
    // On one entity all along, so that nothing but the slicing differs.
    let show = |studio: &mut Studio, version: &Slicing| {
        let mut slicings = studio.world().resource_mut::<Assets<Slicing>>();
        let slicing = slicings.add(version.clone());
        let mut crown = studio.world().entity_mut(crown);
        crown.insert(SlicedCrown(slicing.clone()));
        slicing
    };
    let fresh = versions.map(|version| {
        show(&mut studio, version);
        pictures(&mut studio)
    });
    for pair in [[0, 1], [1, 2], [2, 0]] {
        assert!(fresh[pair[0]] != fresh[pair[1]], "{pair:?}");
    }
    let edited = show(&mut studio, versions[0]);
    assert!(pictures(&mut studio) == fresh[0]);
    for next in [1, 2, 0] {
        let mut slicings = studio.world().resource_mut::<Assets<Slicing>>();
        let inserted = slicings.insert(&edited, versions[next].clone());
        assert!(inserted.is_ok());
        assert!(pictures(&mut studio) == fresh[next], "{next}");
    }
}

#[test]
fn far_crowns_have_fewer_slices_and_no_change_of_brightness() {
    let (mut studio, _) = studio(UNLIT);
    let radius = CROWN.shape().radius;
    // From 8 to 30 radii on the screen that levels are made for, of 120 lines in this picture.
    let fov = 0.6_f32;
    let focal = 0.5 * SIZE.y as f32 / (0.5 * fov).tan();
    let mut cover = Vec::new();
    for step in 0..=44 {
        let distance = (8.0 + 0.5 * step as f32) * focal / FOCAL;
        let mut look = shot(eye(15.0, 3.0, radius * distance));
        look.lens = Lens::Perspective(fov);
        let missing = 255.0 - mean(&studio.photograph(&look, Color::WHITE), 2);
        // Of the same crown further away less is seen by the square of the distance.
        cover.push(missing * f64::from(distance * distance));
    }
    println!("{cover:.0?}");
    for (step, pair) in cover.windows(2).enumerate() {
        let change = pair[1] / pair[0];
        assert!((change - 1.0).abs() < 0.06, "{step}: {pair:?}");
    }
}

#[test]
fn a_crown_that_is_given_a_slicing_still_loading_takes_it_when_it_is_there() {
    let (mut studio, crown) = studio(UNLIT);
    let material = |studio: &mut Studio| {
        let world = studio.world();
        let material = world.get::<MeshMaterial3d<SlicedCrownMaterial>>(crown);
        material.map(|material| material.id())
    };
    let before = material(&mut studio);
    assert!(before.is_some());
    let loading = studio
        .world()
        .resource::<Assets<Slicing>>()
        .reserve_handle();
    studio
        .world()
        .entity_mut(crown)
        .insert(SlicedCrown(loading.clone()));
    studio.headless.step();
    // Until then it stays as it was.
    assert_eq!(material(&mut studio), before);
    let mut slicings = studio.world().resource_mut::<Assets<Slicing>>();
    slicings.insert(&loading, CROWN.clone()).unwrap();
    // Changes of assets are seen in the frame after.
    studio.headless.step();
    studio.headless.step();
    assert_ne!(material(&mut studio), before);
}

#[test]
fn crowns_come_back_after_their_device_is_lost() {
    let mut studio = recovering_studio();
    plant(&mut studio, UNLIT, Transform::IDENTITY);
    let look = shot(eye(75.0, 10.0, 16.0));
    studio.headless.step();
    let before = studio.photograph(&look, Color::BLACK);
    assert!(covered(&before, [0; 3]) > 2000);
    lose_device(&mut studio);
    let after = studio.photograph(&look, Color::BLACK);
    assert_eq!(after.rgb_bytes(), before.rgb_bytes());
}
