//! Texels in full light, in simple light and in none.

use bevy::prelude::*;
use bevy_verdure::lab::{Pixels, Studio, mean_flip};
use bevy_verdure::prelude::*;
use bevy_verdure::texel::build::{Filling, Shape, ShapeSettings, from_shape};
use bevy_verdure::texel::silent;

use super::passes::{floor, mean};
use super::{SIZE, cover_default, shot};

fn picture(studio: &mut Studio, surface: Entity, lighting: PlantLighting) -> Pixels {
    let settings = TexelSettings {
        lighting,
        ..default()
    };
    studio.world().entity_mut(surface).insert(settings);
    studio.headless.step();
    studio.photograph(&shot(Vec3::new(1.9, 2.3, 1.2)), Color::srgb(0.6, 0.8, 1.0))
}

#[test]
fn simple_light_looks_like_full_light_and_gives_way_to_it() {
    let mut studio = Studio::default();
    floor(&mut studio);
    let surface = cover_default(&mut studio, TexelSettings::default());
    let sun = DirectionalLight {
        shadow_maps_enabled: true,
        ..default()
    };
    let aslant = Transform::default().looking_to(Vec3::new(-0.7, -1.0, -0.3), Vec3::Y);
    studio.world().spawn((sun, aslant));
    let [full, simple, unlit] = [
        PlantLighting::Full,
        PlantLighting::Simple,
        PlantLighting::Unlit,
    ]
    .map(|lighting| picture(&mut studio, surface, lighting));
    let flip = |a: &Pixels, b: &Pixels| mean_flip((SIZE.x, SIZE.y), &a.rgb_bytes(), &b.rgb_bytes());
    let (near, far) = (flip(&full, &simple), flip(&full, &unlit));
    println!("simple {near:.4}, unlit {far:.4}");
    // What differs is the rim, where gloss is more than in the mean, and the edges of shadows: together some 250 pixels of
    // 12,288, of which each may be wholly wrong.
    assert!(near < 0.02, "{near}");
    assert!(far > 2.0 * near, "{near} {far}");

    let lamp = PointLight {
        intensity: 300_000.0,
        ..default()
    };
    let lamp = studio
        .world()
        .spawn((lamp, Transform::from_xyz(2.0, 1.5, 0.5)))
        .id();
    studio.headless.step();
    let [full, lamplit] = [PlantLighting::Full, PlantLighting::Simple]
        .map(|lighting| picture(&mut studio, surface, lighting));
    assert_eq!(full.rgb_bytes(), lamplit.rgb_bytes());
    assert!(mean(&lamplit) > mean(&simple) + 2.0, "the lamp lights");
    studio.world().despawn(lamp);
    studio.headless.step();
    let after = picture(&mut studio, surface, PlantLighting::Simple);
    assert_eq!(after.rgb_bytes(), simple.rgb_bytes());
}

#[test]
fn what_a_sun_sees_is_in_no_shadow_of_its_own() {
    use bevy::light::NotShadowReceiver;
    let mut studio = Studio::default();
    let surface = cover_default(&mut studio, TexelSettings::default());
    let sun = DirectionalLight {
        shadow_maps_enabled: true,
        illuminance: 5_000.0,
        ..default()
    };
    let sun = studio.world().spawn((sun, Transform::default())).id();
    // Slices across each axis, merged into few; beside the axes, layers stand out of what narrows and widens.
    for to_sun in [
        Vec3::new(0.7, 0.85, 0.35),
        Vec3::new(-0.3, 1.0, 0.1),
        Vec3::new(1.0, 0.3, 0.2),
        Vec3::new(0.2, 0.4, -1.0),
    ] {
        let place = Transform::default().looking_to(-to_sun, Vec3::Y);
        studio.world().entity_mut(sun).insert(place);
        let from_sun = shot(Vec3::new(0.5, 0.5, -0.5) + to_sun.normalize() * 3.2);
        let mut light = |is_lit: bool| {
            let mut surface = studio.world().entity_mut(surface);
            if is_lit {
                surface.insert(NotShadowReceiver);
            } else {
                surface.remove::<NotShadowReceiver>();
            }
            studio.headless.step();
            let bytes = studio.photograph(&from_sun, Color::BLACK).rgb_bytes();
            let sums = bytes.chunks_exact(3);
            sums.map(|color| color.iter().map(|&c| u32::from(c)).sum())
                .collect::<Vec<u32>>()
        };
        let (with, without) = (light(false), light(true));
        let seen = without.iter().filter(|&&light| light > 0).count();
        let darkened = |(with, without): &(&u32, &u32)| *with * 10 < *without * 9;
        let darkened = with.iter().zip(&without).filter(darkened).count();
        println!("{to_sun}: {darkened} of {seen} pixels are in their own shadow");
        // The eye is nearer than the sun, and sees a little of what the ball shades of its post: one pixel in a hundred.
        assert!(
            seen > 500 && darkened * 100 <= seen,
            "{to_sun}: {darkened} of {seen}"
        );
    }
}

/// A leaf that lies in the middle of the unit cube, its front up.
fn leaf() -> TexelVolume {
    let corners = [(0.1, 0.1), (0.9, 0.1), (0.9, 0.9), (0.1, 0.9)];
    let shape = Shape {
        positions: corners.map(|(x, y)| Vec3::new(x, y, 0.52)).into(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        colors: vec![Vec4::new(0.2, 0.5, 0.1, 1.0); 4],
        ..default()
    };
    let settings = ShapeSettings {
        bounds: Some([Vec3::ZERO, Vec3::ONE]),
        filling: Filling::None,
        ..ShapeSettings::new(UVec3::splat(32))
    };
    let built = from_shape(&shape, &settings, &silent).expect("the leaf is in its box");
    built.volume.into()
}

#[test]
fn light_comes_through_leaves_from_behind_and_they_do_not_shade_it() {
    use bevy::light::NotShadowReceiver;
    let mut studio = Studio::default();
    let surface = cover_default(&mut studio, TexelSettings::default());
    let world = studio.world();
    let volume = world.resource_mut::<Assets<TexelVolume>>().add(leaf());
    let thickness = 1.0;
    world
        .entity_mut(surface)
        .insert(TexelSurface { volume, thickness });
    let sun = DirectionalLight {
        shadow_maps_enabled: true,
        illuminance: 1_500.0,
        ..default()
    };
    let sun = world.spawn((sun, Transform::default())).id();
    // The mean green of the leaf, seen from above.
    let mut green = |lighting, diffuse_transmission, sunlight: Vec3, shaded: bool| {
        let settings = TexelSettings {
            lighting,
            diffuse_transmission,
            ..default()
        };
        let world = studio.world();
        world
            .entity_mut(sun)
            .insert(Transform::default().looking_to(sunlight, Vec3::X));
        let mut surface = world.entity_mut(surface);
        surface.insert(settings);
        if shaded {
            surface.remove::<NotShadowReceiver>();
        } else {
            surface.insert(NotShadowReceiver);
        }
        studio.headless.step();
        let picture = studio.photograph(&shot(Vec3::new(0.6, 3.0, -0.4)), Color::BLACK);
        let bytes = picture.rgb_bytes();
        let greens = bytes.chunks_exact(3).map(|color| f64::from(color[1]));
        let seen = greens.clone().filter(|&green| green > 0.0).count();
        assert!(seen > 1_000, "{seen} pixels show the leaf");
        greens.sum::<f64>() / seen as f64
    };
    let (down, up) = (Vec3::new(0.3, -1.0, 0.2), Vec3::new(0.3, 1.0, 0.2));
    for lighting in [PlantLighting::Simple, PlantLighting::Full] {
        let solid = green(lighting, 0.0, down, true);
        let solid_behind = green(lighting, 0.0, up, true);
        let front = green(lighting, 0.5, down, true);
        let behind = green(lighting, 0.5, up, true);
        let unshaded = green(lighting, 0.5, up, false);
        println!(
            "{lighting:?}: solid {solid:.1} {solid_behind:.1}, half {front:.1} {behind:.1} ({unshaded:.1})"
        );
        assert!(solid > 2.0 * solid_behind, "what is solid is dark behind");
        assert!(front < solid && behind > 1.5 * solid_behind);
        // Gloss, 0.018 of 0.5, is on the front alone in full light.
        assert!((front - behind).abs() < 0.04 * front, "{front} {behind}");
        // Rounding to a byte.
        assert!((behind - unshaded).abs() < 0.5, "{behind} {unshaded}");
    }
}
