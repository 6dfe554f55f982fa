//! Crowns for cameras and lights of other kinds: deferred ones, those that gather frames, lamps.

use bevy::anti_alias::taa::TemporalAntiAliasing;
use bevy::core_pipeline::prepass::{DeferredPrepass, DepthPrepass};
use bevy::light::NotShadowCaster;
use bevy::prelude::*;
use bevy::render::camera::TemporalJitter;
use bevy_verdure::lab::mean_flip;
use bevy_verdure::prelude::*;

use super::{CROWN, SIZE, UNLIT, eye, mean, shot, studio};

const HASHED: CrownSettings = CrownSettings {
    composition: Composition::Hashed,
    ..UNLIT
};

#[test]
fn deferred_cameras_show_crowns_as_others_do() {
    let look = shot(eye(20.0, 10.0, 16.0));
    for settings in [UNLIT, HASHED] {
        let (mut studio, crown) = studio(settings);
        let forward = studio.photograph(&look, Color::WHITE);
        let camera = studio.camera();
        let prepasses = (DepthPrepass, DeferredPrepass);
        studio.world().entity_mut(camera).insert(prepasses);
        studio.headless.step();
        let deferred = studio.photograph(&look, Color::WHITE);
        studio.world().entity_mut(crown).insert(Visibility::Hidden);
        let without = studio.photograph(&look, Color::WHITE);
        assert!(mean(&without, 1) > mean(&forward, 1) + 3.0);
        let pairs = forward.rgb_bytes().into_iter().zip(deferred.rgb_bytes());
        let differing = pairs.filter(|(a, b)| a != b).count();
        // Both passes draw the same lots for the same places; derivatives may round another way.
        let name = settings.composition;
        assert!(
            differing * 50 < forward.rgb_bytes().len(),
            "{name:?}: {differing}"
        );
    }
}

#[test]
fn temporal_anti_aliasing_keeps_hashed_crowns_where_they_are_and_smooths_them() {
    let look = shot(eye(20.0, 10.0, 16.0));
    let blended = studio(UNLIT).0.photograph(&look, Color::WHITE).rgb_bytes();
    let (mut studio, _) = studio(HASHED);
    let plain = studio.photograph(&look, Color::WHITE).rgb_bytes();
    let camera = studio.camera();
    let gathers = (Msaa::Off, TemporalAntiAliasing::default());
    studio.world().entity_mut(camera).insert(gathers);
    for _ in 0..12 {
        studio.headless.step();
    }
    let gathered = studio.photograph(&look, Color::WHITE).rgb_bytes();
    let error = |picture: &[u8]| mean_flip((SIZE.x, SIZE.y), &blended, picture);
    let (plain, gathered) = (error(&plain), error(&gathered));
    println!("from the blended crown: hashed {plain:.4}, gathered over frames {gathered:.4}");
    // Nothing is smeared or lost, and grain goes: were lots the same in each frame, nine tenths of the error would stay.
    assert!(gathered < 0.85 * plain, "{gathered} {plain}");
}

#[test]
fn lots_change_from_frame_to_frame_for_cameras_that_gather_them_and_stay_for_others() {
    let look = shot(eye(20.0, 10.0, 16.0));
    let (mut studio, _) = studio(HASHED);
    let camera = studio.camera();
    let mut changes = |jitter: Option<Vec2>, is_alone: bool| {
        let mut camera = studio.world().entity_mut(camera);
        camera.remove::<TemporalJitter>();
        if let Some(offset) = jitter {
            camera.insert(TemporalJitter { offset });
        }
        let other = (!is_alone).then(|| studio.world().spawn(Camera3d::default()).id());
        let mut photograph = || studio.photograph(&look, Color::WHITE).rgb_bytes();
        let changes = photograph() != photograph();
        if let Some(other) = other {
            studio.world().despawn(other);
        }
        changes
    };
    assert!(!changes(None, true));
    // Bevy's jitter is zero in one frame of eight.
    for jitter in [Vec2::ZERO, Vec2::new(0.4, -0.3)] {
        assert!(changes(Some(jitter), true), "{jitter}");
    }
    assert!(changes(Some(Vec2::new(0.4, -0.3)), false));
    assert!(!changes(None, false));
}

#[test]
fn lamps_cast_shadows_of_crowns() {
    let centroid = CROWN.shape().centroid;
    let above = centroid + Vec3::new(0.5, 7.0, 0.0);
    let lamp = Transform::from_translation(above).looking_at(centroid, Vec3::X);
    let point = |world: &mut World| {
        let light = PointLight {
            intensity: 8_000_000.0,
            range: 60.0,
            shadow_maps_enabled: true,
            ..default()
        };
        world.spawn((light, lamp));
    };
    let spot = |world: &mut World| {
        let light = SpotLight {
            intensity: 8_000_000.0,
            range: 60.0,
            shadow_maps_enabled: true,
            outer_angle: 1.0,
            ..default()
        };
        world.spawn((light, lamp));
    };
    let lamps: [&dyn Fn(&mut World); 2] = [&point, &spot];
    for (name, spawn) in ["point", "spot"].into_iter().zip(lamps) {
        let (mut studio, crown) = studio(CrownSettings::default());
        spawn(studio.world());
        let world = studio.world();
        let mut meshes = world.resource_mut::<Assets<Mesh>>();
        let floor = meshes.add(Plane3d::default().mesh().size(60.0, 60.0));
        let mut materials = world.resource_mut::<Assets<StandardMaterial>>();
        let white = materials.add(Color::WHITE);
        world.spawn((Mesh3d(floor), MeshMaterial3d(white)));
        let mut down = shot(Vec3::new(0.0, 1.2, 6.0));
        down.at = Vec3::ZERO;
        for _ in 0..3 {
            studio.headless.step();
        }
        let with = mean(&studio.photograph(&down, Color::BLACK), 1);
        studio.world().entity_mut(crown).insert(NotShadowCaster);
        let without = mean(&studio.photograph(&down, Color::BLACK), 1);
        // All of the floor that is seen lies in its shadow, which lets some of the light through.
        assert!(with < 0.9 * without, "{name}: {with} {without}");
    }
}
