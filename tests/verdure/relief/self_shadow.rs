//! Relief that keeps the sun off itself.

use bevy::core_pipeline::prepass::{DepthPrepass, NormalPrepass};
use bevy::prelude::*;
use bevy_verdure::lab::{Lens, NEAR, Pixels, Shot, Studio};
use bevy_verdure::prelude::*;

use super::leaping::{MAP, studs};
use super::{THICKNESS, image, limb, with_reference};

/// Near enough for a pixel of the map to cover more than one of the screen.
const SHOT: Shot = Shot {
    eye: Vec3::new(0.8, 2.0, 2.2),
    at: Vec3::new(0.2, 1.4, 0.0),
    lens: Lens::Perspective(0.8),
    size: UVec2::new(160, 120),
};
/// From where the sun shines: aslant along what the picture shows.
const SUN: Vec3 = Vec3::new(-0.6, -0.6, -0.4);

fn picture(self_shadow: u32, configure: impl FnOnce(&mut Studio)) -> Pixels {
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
    configure(&mut studio);
    for _ in 0..3 {
        studio.headless.step();
    }
    studio.photograph(&SHOT, Color::BLACK)
}

#[test]
fn what_the_reference_cannot_see_the_sun_from_is_darker_and_the_rest_is_not() {
    let (plain, shadowed) = (picture(0, |_| {}), picture(32, |_| {}));
    let (mut dark, mut light, mut wrong) = (0, 0, 0);
    let Shot { size, .. } = SHOT;
    with_reference(&studs(), |scene| {
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
    });
    println!("{dark} pixels in shadow, {light} in light, {wrong} wrong");
    assert!(dark > 100 && light > 500);
    // Rims of shadows are soft, and drawn by 32 steps.
    assert!(wrong * 50 <= dark + light, "{wrong} wrong");
}

#[test]
fn with_shadow_maps_and_prepasses_it_takes_light_away_and_adds_none() {
    let [plain, shadowed] = [0, 8].map(|steps| {
        picture(steps, |studio| {
            let camera = studio.camera();
            let passes = (DepthPrepass, NormalPrepass, Msaa::Sample4);
            let world = studio.world();
            world.entity_mut(camera).insert(passes);
            for mut light in world.query::<&mut DirectionalLight>().iter_mut(world) {
                light.shadow_maps_enabled = true;
            }
        })
    });
    let mut darker = 0;
    for (one, other) in plain.rgb_bytes().iter().zip(shadowed.rgb_bytes()) {
        // A step of eight bits, which the light that is taken away again may be off by.
        assert!(other <= one.saturating_add(1), "{one} became {other}");
        darker += usize::from(other + 10 < *one);
    }
    assert!(darker > 100, "{darker} values are darker");
}
