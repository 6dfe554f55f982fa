//! Relief in every pass: what they draw is one surface.

use bevy::core_pipeline::prepass::{
    DeferredPrepass, DepthPrepass, MotionVectorPrepass, NormalPrepass,
};
use bevy::light::CascadeShadowConfigBuilder;
use bevy::material::OpaqueRendererMethod;
use bevy::math::DVec3;
use bevy::prelude::*;
use bevy_verdure::frusta::ReliefV;
use bevy_verdure::lab::{NEAR, Pixels, Studio, mean_flip};
use bevy_verdure::prelude::*;

use super::{SHOT, bumps, limb, studio_with, with_reference};

/// Greatest mean FLIP between two ways to draw one picture, as for plants without relief (`twins.rs`).
const SAME: f32 = 0.003;
/// From where the sun shines.
const SUN: Vec3 = Vec3::new(-0.7, -0.85, -0.35);

fn lit(method: OpaqueRendererMethod, configure: impl FnOnce(&mut Studio)) -> Pixels {
    lit_with(method, |relief| relief, configure)
}

fn lit_with(
    method: OpaqueRendererMethod,
    relief: impl Fn(Relief) -> Relief,
    configure: impl FnOnce(&mut Studio),
) -> Pixels {
    let base = StandardMaterial {
        opaque_render_method: method,
        ..Color::srgb(0.5, 0.4, 0.3).into()
    };
    let mut studio = studio_with(&limb(0.75, 0.5), base, relief);
    studio.world().spawn((
        DirectionalLight {
            illuminance: 8_000.0,
            shadow_maps_enabled: true,
            ..default()
        },
        CascadeShadowConfigBuilder {
            maximum_distance: 20.0,
            ..default()
        }
        .build(),
        Transform::default().looking_to(SUN, Vec3::Y),
    ));
    configure(&mut studio);
    for _ in 0..3 {
        studio.headless.step();
    }
    studio.photograph(&SHOT, Color::BLACK)
}

#[test]
fn prepasses_draw_the_relief_that_the_main_pass_draws() {
    let forward = lit(OpaqueRendererMethod::Forward, |_| {});
    let prepass = lit(OpaqueRendererMethod::Forward, |studio| {
        let camera = studio.camera();
        let prepasses = (DepthPrepass, NormalPrepass, MotionVectorPrepass);
        studio.world().entity_mut(camera).insert(prepasses);
    });
    check_alike(&forward, &prepass);
}

#[test]
fn deferred_lighting_sees_the_relief_that_the_main_pass_draws() {
    let forward = lit(OpaqueRendererMethod::Forward, |_| {});
    let deferred = lit(OpaqueRendererMethod::Deferred, |studio| {
        let camera = studio.camera();
        let prepasses = (DepthPrepass, DeferredPrepass);
        studio.world().entity_mut(camera).insert(prepasses);
    });
    check_alike(&forward, &deferred);
    // The G-buffer packs normals and colours into bytes. Were the pictures the same, forward would have drawn both.
    assert!(forward.rgb_bytes() != deferred.rgb_bytes());
}

/// In all passes: leaps draw the steps' picture, with shadow maps and prepasses too.
#[test]
fn leaps_draw_what_steps_draw_in_every_pass() {
    for v in [ReliefV::Exact, ReliefV::Interpolated] {
        let [steps, leaps] = [ReliefMarch::Uniform, ReliefMarch::Leaping].map(|march| {
            let relief = |relief| Relief { march, v, ..relief };
            lit_with(OpaqueRendererMethod::Forward, relief, |studio| {
                let camera = studio.camera();
                let prepasses = (DepthPrepass, NormalPrepass, Msaa::Sample4);
                studio.world().entity_mut(camera).insert(prepasses);
            })
        });
        check_alike(&steps, &leaps);
    }
}

fn check_alike(one: &Pixels, other: &Pixels) {
    let flip = mean_flip(
        (SHOT.size.x, SHOT.size.y),
        &one.rgb_bytes(),
        &other.rgb_bytes(),
    );
    println!("mean FLIP {flip:.5}");
    assert!(flip < SAME, "{flip}");
}

#[test]
fn multisampled_outlines_of_relief_have_their_coverage() {
    let white = StandardMaterial {
        base_color: Color::WHITE,
        unlit: true,
        ..default()
    };
    let mut studio = studio_with(&limb(0.75, 0.5), white, |relief| Relief {
        bisections: 12,
        ..relief.with_steps(ReliefSteps::Fixed(128))
    });
    let camera = studio.camera();
    studio.world().entity_mut(camera).insert(Msaa::Sample4);
    let picture = studio.photograph(&SHOT, Color::BLACK);
    let (mut outline, mut off) = (0, 0);
    with_reference(&bumps(), |scene| {
        for (x, y) in (0..SHOT.size.y).flat_map(|y| (0..SHOT.size.x).map(move |x| (x, y))) {
            let srgb = f32::from(picture.rgb(x, y)[0]) / 255.0;
            let seen = Color::srgb(srgb, 0.0, 0.0).to_linear().red;
            let places = [(-2.0, -6.0), (6.0, -2.0), (-6.0, 2.0), (2.0, 6.0)];
            let hits = places.iter().filter(|(dx, dy)| {
                let place = (x as f32 + 0.5 + dx / 16.0, y as f32 + 0.5 + dy / 16.0);
                let (origin, direction): (DVec3, DVec3) = SHOT.ray(place.0, place.1);
                scene.cast(origin, direction, f64::from(NEAR)).is_some()
            });
            let expected = hits.count() as f32 / 4.0;
            outline += usize::from(expected > 0.0 && expected < 1.0);
            // One sample of four, and half a step of the picture's eight bits.
            off += usize::from((seen - expected).abs() > 0.25 + 0.005);
        }
    });
    println!("{off} of {outline} pixels are more than a sample off");
    assert!(outline > 100);
    assert!(off * 100 <= outline, "{off} of {outline}");
}

#[test]
fn shadows_follow_the_relief() {
    let mut studio = studio_with(&limb(0.75, 0.5), Color::WHITE.into(), |r| r);
    let world = studio.world();
    let floor = world
        .resource_mut::<Assets<Mesh>>()
        .add(Plane3d::default().mesh().size(40.0, 40.0));
    let grey = world
        .resource_mut::<Assets<StandardMaterial>>()
        .add(Color::WHITE);
    world.spawn((
        Mesh3d(floor),
        MeshMaterial3d(grey),
        Transform::from_xyz(0.0, -0.6, 0.0),
    ));
    world.spawn((
        DirectionalLight {
            illuminance: 3_000.0,
            shadow_maps_enabled: true,
            ..default()
        },
        CascadeShadowConfigBuilder {
            num_cascades: 1,
            maximum_distance: 14.0,
            ..default()
        }
        .build(),
        Transform::default().looking_to(SUN, Vec3::Y),
    ));
    for _ in 0..3 {
        studio.headless.step();
    }
    let shot = bevy_verdure::lab::Shot {
        eye: Vec3::new(-2.5, 7.0, 1.0),
        at: Vec3::new(-2.4, -0.6, -1.0),
        ..SHOT
    };
    let picture = studio.photograph(&shot, Color::BLACK);
    let (mut dark, mut wrong) = (0, 0);
    with_reference(&bumps(), |scene| {
        let to_sun = -SUN.as_dvec3().normalize();
        let shade = |x: f32, y: f32| {
            let (origin, direction) = shot.ray(x, y);
            if scene.cast(origin, direction, f64::from(NEAR)).is_some() {
                return None;
            }
            let floor = origin + direction * ((-0.6 - origin.y) / direction.y);
            Some(scene.cast(floor, to_sun, 1e-3).is_some())
        };
        for (x, y) in (0..shot.size.y).flat_map(|y| (0..shot.size.x).map(move |x| (x, y))) {
            let (cx, cy) = (x as f32 + 0.5, y as f32 + 0.5);
            let Some(is_dark) = shade(cx, cy) else {
                continue;
            };
            // The shadow map has pixels of its own, and its filter softens edges: judge what is two pixels from one.
            let alike = [(-2.0, 0.0), (2.0, 0.0), (0.0, -2.0), (0.0, 2.0)]
                .iter()
                .all(|(dx, dy)| shade(cx + dx, cy + dy) == Some(is_dark));
            if alike {
                dark += usize::from(is_dark);
                wrong += usize::from((picture.rgb(x, y)[0] < 96) != is_dark);
            }
        }
    });
    println!("{wrong} wrong, {dark} dark");
    assert!(dark > 300, "{dark}");
    assert_eq!(wrong, 0);
}
