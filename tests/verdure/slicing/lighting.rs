//! Crowns in full light, in simple light and in none.

use bevy::asset::RenderAssetUsages;
use bevy::light::TransmittedShadowReceiver;
use bevy::prelude::*;
use bevy::render::render_resource::{
    Extent3d, TextureDimension, TextureFormat, TextureViewDescriptor, TextureViewDimension,
};
use bevy_verdure::lab::{Pixels, Studio, mean_flip};
use bevy_verdure::prelude::*;

use super::{CROWN, SIZE, TREE, UNLIT, baked, covered, eye, mean, shot, studio, sun};

/// The crown over which `sun` stands, seen from beside.
fn picture(studio: &mut Studio, crown: Entity, lighting: PlantLighting) -> Pixels {
    let settings = CrownSettings {
        lighting,
        ..default()
    };
    studio.world().entity_mut(crown).insert(settings);
    studio.headless.step();
    studio.photograph(&shot(eye(75.0, 10.0, 16.0)), Color::srgb(0.6, 0.8, 1.0))
}

#[test]
fn simple_light_looks_like_full_light() {
    let (mut studio, crown) = studio(UNLIT);
    sun(&mut studio);
    // With the sun alone, and with ambient light besides.
    for brightness in [0.0, 600.0] {
        studio.world().insert_resource(GlobalAmbientLight {
            brightness,
            ..default()
        });
        let [full, simple, unlit] = [
            PlantLighting::Full,
            PlantLighting::Simple,
            PlantLighting::Unlit,
        ]
        .map(|lighting| picture(&mut studio, crown, lighting));
        let flip = |a: &Pixels| mean_flip((SIZE.x, SIZE.y), &full.rgb_bytes(), &a.rgb_bytes());
        let (near, far) = (flip(&simple), flip(&unlit));
        println!(
            "ambient {brightness}: simple {near:.4}, unlit {far:.4}, of {} and {} of 255 green",
            mean(&full, 1),
            mean(&simple, 1)
        );
        assert!(covered(&full, full.rgb(0, 0)) > 2000);
        // The crown fills two fifths of the picture. Where it does, what is seen is 5 % off or less.
        assert!(near < 0.02, "{brightness}: {near}");
        assert!(far > 2.0 * near, "{brightness}: {near} {far}");
    }
}

#[test]
fn a_second_sun_lights_as_in_full_light_while_it_is_there() {
    let (mut studio, crown) = studio(UNLIT);
    sun(&mut studio);
    let before = picture(&mut studio, crown, PlantLighting::Simple);
    let second = (
        DirectionalLight {
            illuminance: 4_000.0,
            ..default()
        },
        Transform::default().looking_to(Vec3::new(-1.0, -0.3, -1.0), Vec3::Y),
    );
    let second = studio.world().spawn(second).id();
    studio.headless.step();
    let [full, simple] = [PlantLighting::Full, PlantLighting::Simple]
        .map(|lighting| picture(&mut studio, crown, lighting));
    assert!(mean(&simple, 1) > mean(&before, 1) + 2.0, "it lights");
    // As for one sun.
    let error = mean_flip((SIZE.x, SIZE.y), &full.rgb_bytes(), &simple.rgb_bytes());
    assert!(error < 0.02, "{error}");
    studio.world().despawn(second);
    studio.headless.step();
    let after = picture(&mut studio, crown, PlantLighting::Simple);
    assert_eq!(after.rgb_bytes(), before.rgb_bytes());
}

#[test]
fn lamps_call_for_full_light_while_they_are_there() {
    let (mut studio, crown) = studio(UNLIT);
    sun(&mut studio);
    let before = picture(&mut studio, crown, PlantLighting::Simple);
    let lamps: [fn(&mut World) -> Entity; 2] = [
        |world| {
            let lamp = PointLight {
                intensity: 4e6,
                range: 40.0,
                ..default()
            };
            let place = Transform::from_xyz(1.0, 3.0, 7.0);
            world.spawn((lamp, place)).id()
        },
        |world| {
            let lamp = SpotLight {
                intensity: 4e7,
                range: 40.0,
                ..default()
            };
            let place = Transform::from_xyz(3.0, 5.0, 12.0).looking_at(Vec3::Y * 5.0, Vec3::Y);
            world.spawn((lamp, place)).id()
        },
    ];
    for lamp in lamps {
        let lamp = lamp(studio.world());
        studio.headless.step();
        let full = picture(&mut studio, crown, PlantLighting::Full);
        let simple = picture(&mut studio, crown, PlantLighting::Simple);
        assert_eq!(simple.rgb_bytes(), full.rgb_bytes());
        assert!(mean(&simple, 1) > mean(&before, 1) + 2.0, "the lamp lights");
        studio.world().despawn(lamp);
        studio.headless.step();
        let after = picture(&mut studio, crown, PlantLighting::Simple);
        assert_eq!(after.rgb_bytes(), before.rgb_bytes());
    }
}

#[test]
fn an_environment_map_calls_for_full_light_while_it_is_there() {
    let (mut studio, crown) = studio(UNLIT);
    sun(&mut studio);
    let before = picture(&mut studio, crown, PlantLighting::Simple);
    let size = Extent3d {
        width: 1,
        height: 1,
        depth_or_array_layers: 6,
    };
    let mut sky = Image::new(
        size,
        TextureDimension::D2,
        [255; 24].to_vec(),
        TextureFormat::Rgba8Unorm,
        RenderAssetUsages::default(),
    );
    sky.texture_view_descriptor = Some(TextureViewDescriptor {
        dimension: Some(TextureViewDimension::Cube),
        ..default()
    });
    let sky = studio.world().resource_mut::<Assets<Image>>().add(sky);
    let map = EnvironmentMapLight {
        diffuse_map: sky.clone(),
        specular_map: sky,
        intensity: 1_000.0,
        ..default()
    };
    let camera = studio.camera();
    studio.world().entity_mut(camera).insert(map);
    studio.headless.step();
    let [full, simple] = [PlantLighting::Full, PlantLighting::Simple]
        .map(|lighting| picture(&mut studio, crown, lighting));
    assert_eq!(simple.rgb_bytes(), full.rgb_bytes());
    assert!(mean(&simple, 1) > mean(&before, 1) + 2.0, "the sky lights");
    studio
        .world()
        .entity_mut(camera)
        .remove::<EnvironmentMapLight>();
    studio.headless.step();
    let after = picture(&mut studio, crown, PlantLighting::Simple);
    assert_eq!(after.rgb_bytes(), before.rgb_bytes());
}

#[test]
fn light_comes_through_the_leaves_of_crowns_as_of_their_meshes() {
    let mut studio = Studio::default();
    // Low, so that an eye beside the crown sees its lit side or the other.
    studio.world().spawn((
        DirectionalLight {
            illuminance: 5_000.0,
            shadow_maps_enabled: true,
            ..default()
        },
        Transform::default().looking_to(Vec3::new(-1.0, -0.4, 0.0), Vec3::Y),
    ));
    let light = |studio: &mut Studio, planted: Vec<Entity>| {
        studio.headless.step();
        // Azimuth 0 has the sun behind the eye.
        let light = [[-20.0, 20.0], [160.0, 200.0]].map(|azimuths| {
            let means = azimuths.map(|azimuth| {
                let look = shot(eye(azimuth, 0.0, 16.0));
                mean(&studio.photograph(&look, Color::BLACK), 1)
            });
            means.iter().sum::<f64>() / 2.0
        });
        for entity in planted {
            studio.world().despawn(entity);
        }
        light
    };
    let slicings = [(CROWN.clone(), 0.0), (baked(0.5, 0.5), 0.5)].map(|(slicing, transmission)| {
        let mut slicings = studio.world().resource_mut::<Assets<Slicing>>();
        (slicings.add(slicing), transmission)
    });
    for lighting in [PlantLighting::Simple, PlantLighting::Full] {
        let [solid, leafy] = slicings.clone().map(|(slicing, transmission)| {
            let settings = CrownSettings {
                lighting,
                ..default()
            };
            let crown = studio.world().spawn((SlicedCrown(slicing), settings)).id();
            let crown = light(&mut studio, vec![crown]);
            let world = studio.world();
            let parts = [(&TREE.twigs, 0.0), (&TREE.leaves, transmission)];
            let parts = parts.map(|(mesh, diffuse_transmission)| {
                let material = LitAsPlant::by(lighting).over(StandardMaterial {
                    perceptual_roughness: 0.75,
                    reflectance: 0.3,
                    double_sided: true,
                    cull_mode: None,
                    diffuse_transmission,
                    ..default()
                });
                let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh.clone());
                let material = world.resource_mut::<Assets<PlantMaterial>>().add(material);
                let look = (Mesh3d(mesh), MeshMaterial3d(material));
                world.spawn((look, TransmittedShadowReceiver)).id()
            });
            let mesh = light(&mut studio, parts.into());
            println!("{lighting:?} {transmission}: crown {crown:.2?}, mesh {mesh:.2?}");
            [crown, mesh]
        });
        for (solid, leafy) in solid.iter().zip(&leafy) {
            // The lit side gives up some, the other side gains as much.
            assert!(leafy[0] < solid[0] && leafy[1] > 1.1 * solid[1]);
        }
        // In shadow maps a crown is leaves at depths by chance, of which more light comes through than through these few,
        // large ones: on the side turned from the sun by up to a quarter.
        for side in 0..2 {
            let gain = [0, 1].map(|of| leafy[of][side] / solid[of][side]);
            println!(
                "{lighting:?}, side {side}: crown times {:.2}, mesh {:.2}",
                gain[0], gain[1]
            );
            assert!((0.75..1.33).contains(&(gain[0] / gain[1])), "{gain:?}");
        }
    }
}
