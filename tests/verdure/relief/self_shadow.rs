//! Relief that keeps the sun off itself.

use bevy::prelude::*;
use bevy_verdure::lab::reference::ReferenceSettings;
use bevy_verdure::lab::reference::relief::{ReliefOptions, ReliefScene, ShellThickness};
use bevy_verdure::lab::{Lens, NEAR, Pixels, Shot, Studio};
use bevy_verdure::prelude::*;

use super::leaping::{MAP, studs};
use super::{THICKNESS, image, limb};
use crate::skeletons::reference_joints;

/// Near enough for a pixel of the map to cover more than one of the screen.
const SHOT: Shot = Shot {
    eye: Vec3::new(0.8, 2.0, 2.2),
    at: Vec3::new(0.2, 1.4, 0.0),
    lens: Lens::Perspective(0.8),
    size: UVec2::new(160, 120),
};
/// From where the sun shines: aslant along what the picture shows.
const SUN: Vec3 = Vec3::new(-0.6, -0.6, -0.4);

fn picture(self_shadow: u32) -> Pixels {
    let mut studio = Studio::default();
    let map = (studio.world())
        .resource_mut::<Assets<Image>>()
        .add(image(&studs(), MAP));
    let relief = Relief::new(map, ReliefThickness::Metres(THICKNESS)).with_self_shadow(self_shadow);
    studio.plant_in(
        limb(0.75, 0.5),
        Frusta::default(),
        Transform::IDENTITY,
        relief_material(Color::srgb(0.5, 0.5, 0.5), relief),
    );
    // Nothing but the sun, and no shadow maps: what is dark is turned away, or in the relief's own shadow.
    studio.world().insert_resource(GlobalAmbientLight::NONE);
    studio.world().spawn((
        DirectionalLight {
            illuminance: 3_000.0,
            ..default()
        },
        Transform::default().looking_to(SUN, Vec3::Y),
    ));
    for _ in 0..3 {
        studio.headless.step();
    }
    studio.photograph(&SHOT, Color::BLACK)
}

#[test]
fn what_the_reference_cannot_see_the_sun_from_is_darker_and_the_rest_is_not() {
    let (plain, shadowed) = (picture(0), picture(32));
    let (mut dark, mut light, mut wrong) = (0, 0, 0);
    let Shot { size, .. } = SHOT;
    let map = studs();
    let height = |u: f64, v: f64| map.sample(u, v);
    let options = ReliefOptions {
        continuous_u: true,
        steps: 512,
        ..default()
    };
    let scene = ReliefScene::with_options(
        &reference_joints(&limb(0.75, 0.5)),
        ReferenceSettings::default(),
        &height,
        ShellThickness::Metres(f64::from(THICKNESS)),
        &options,
    );
    for (x, y) in (0..size.y).flat_map(|y| (0..size.x).map(move |x| (x, y))) {
        let (origin, direction) = SHOT.ray(x as f32 + 0.5, y as f32 + 0.5);
        let Some(hit) = scene.cast(origin, direction, f64::from(NEAR)) else {
            continue;
        };
        let sun = -SUN.as_dvec3().normalize();
        let lit = u32::from(plain.rgb(x, y)[1]);
        // In the last of the light the shadow cannot be told from the shade.
        if lit < 40 || hit.normal.dot(sun) < 0.1 {
            continue;
        }
        let start = hit.position + hit.normal * 1e-3;
        let between = scene.cast(start, sun, 0.0);
        // Others' shadows are the shadow map's.
        if between.is_some_and(|between| between.segment != hit.segment) {
            continue;
        }
        let left = f64::from(shadowed.rgb(x, y)[1]) / f64::from(lit);
        if between.is_some() {
            dark += 1;
            wrong += usize::from(left > 0.9);
        } else {
            light += 1;
            wrong += usize::from(left < 0.5);
        }
    }
    println!("{dark} pixels in shadow, {light} in light, {wrong} wrong");
    assert!(dark > 100 && light > 500);
    // Rims of shadows are soft, and drawn by 32 steps.
    assert!(wrong * 50 <= dark + light, "{wrong} wrong");
}
