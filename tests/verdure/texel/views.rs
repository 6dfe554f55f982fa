//! Lists of slices for views of all kinds: several cameras, deferred ones, lamps.

use bevy::camera::{ImageRenderTarget, RenderTarget};
use bevy::core_pipeline::prepass::{DeferredPrepass, DepthPrepass};
use bevy::light::NotShadowCaster;
use bevy::prelude::*;
use bevy::render::render_resource::TextureFormat;
use bevy_verdure::lab::{Pixels, Studio};
use bevy_verdure::prelude::*;

use super::passes::{floor, mean};
use super::{BACKGROUND, cover_default, shot, unlit};

const EYE: Vec3 = Vec3::new(1.9, 2.3, 1.2);

/// A texel over a floor.
fn lolly(settings: TexelSettings) -> (Studio, Entity) {
    let mut studio = Studio::default();
    floor(&mut studio);
    let surface = cover_default(&mut studio, settings);
    (studio, surface)
}

fn seen(studio: &mut Studio) -> Pixels {
    studio.headless.step();
    studio.photograph(&shot(EYE), BACKGROUND)
}

#[test]
fn each_camera_has_slices_of_its_own() {
    let (mut studio, _) = lolly(unlit());
    let alone = seen(&mut studio);
    let world = studio.world();
    let image = Image::new_target_texture(64, 64, TextureFormat::Rgba8UnormSrgb, None);
    let image = world.resource_mut::<Assets<Image>>().add(image);
    let below = Transform::from_xyz(-6.0, 0.4, 0.5).looking_at(Vec3::Y * 0.5, Vec3::Y);
    world.spawn((
        Camera3d::default(),
        Camera {
            order: -5,
            ..default()
        },
        RenderTarget::Image(ImageRenderTarget {
            handle: image,
            scale_factor: 1.0,
        }),
        below,
    ));
    let beside = seen(&mut studio);
    assert_eq!(alone.rgb_bytes(), beside.rgb_bytes());
}

#[test]
fn deferred_cameras_show_texels_as_others_do() {
    let (mut studio, surface) = lolly(unlit());
    let forward = seen(&mut studio);
    let camera = studio.camera();
    let prepasses = (DepthPrepass, DeferredPrepass);
    studio.world().entity_mut(camera).insert(prepasses);
    let deferred = seen(&mut studio);
    studio
        .world()
        .entity_mut(surface)
        .insert(Visibility::Hidden);
    let without = seen(&mut studio);
    assert!((mean(&forward) - mean(&without)).abs() > 3.0);
    assert_eq!(forward.rgb_bytes(), deferred.rgb_bytes());
}

#[test]
fn lamps_cast_shadows_of_texels() {
    let lamp = Transform::from_xyz(0.2, 3.0, -0.4).looking_at(Vec3::new(0.5, 0.0, -0.5), Vec3::X);
    let point = |world: &mut World| {
        let light = PointLight {
            intensity: 400_000.0,
            shadow_maps_enabled: true,
            ..default()
        };
        world.spawn((light, lamp));
    };
    let spot = |world: &mut World| {
        let light = SpotLight {
            intensity: 400_000.0,
            shadow_maps_enabled: true,
            outer_angle: 0.7,
            ..default()
        };
        world.spawn((light, lamp));
    };
    let lamps: [&dyn Fn(&mut World); 2] = [&point, &spot];
    for (name, spawn) in ["point", "spot"].into_iter().zip(lamps) {
        let (mut studio, surface) = lolly(TexelSettings::default());
        spawn(studio.world());
        let with = mean(&seen(&mut studio));
        studio.world().entity_mut(surface).insert(NotShadowCaster);
        let without = mean(&seen(&mut studio));
        // The shadow on the floor is as large as the ball, about a tenth of the picture.
        assert!(with < without - 3.0, "{name}: {with} {without}");
    }
}
