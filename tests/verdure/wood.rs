//! `PlantMaterial`: wood lit as Bevy lights it, as crowns are, and not at all.

use bevy::asset::RenderAssetUsages;
use bevy::mesh::{Indices, PrimitiveTopology, UvChannel};
use bevy::prelude::*;
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat};
use bevy_verdure::lab::{Lens, Pixels, Shot, Studio};
use bevy_verdure::prelude::*;

const SIZE: UVec2 = UVec2::new(128, 96);

fn shot() -> Shot {
    Shot {
        eye: Vec3::new(0.0, 1.2, 4.0),
        at: Vec3::ZERO,
        lens: Lens::Perspective(0.8),
        size: SIZE,
    }
}

fn photograph(studio: &mut Studio) -> Pixels {
    studio.headless.step();
    studio.photograph(&shot(), Color::srgb(0.6, 0.8, 1.0))
}

/// A picture of four pixels: red, green, blue, white.
fn picture(studio: &mut Studio) -> Handle<Image> {
    let size = Extent3d {
        width: 2,
        height: 2,
        depth_or_array_layers: 1,
    };
    let data = [
        [255, 0, 0, 255],
        [0, 255, 0, 255],
        [0, 0, 255, 255],
        [255; 4],
    ];
    studio
        .world()
        .resource_mut::<Assets<Image>>()
        .add(Image::new(
            size,
            TextureDimension::D2,
            data.concat(),
            TextureFormat::Rgba8UnormSrgb,
            RenderAssetUsages::default(),
        ))
}

/// An upright square with vertex colours, whose second UVs are the first ones halved.
fn square() -> Mesh {
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    Mesh::new(
        PrimitiveTopology::TriangleList,
        RenderAssetUsages::default(),
    )
    .with_inserted_attribute(
        Mesh::ATTRIBUTE_POSITION,
        corners
            .map(|[x, y]| [2.0 * x - 1.0, 2.0 * y - 1.0, 0.0])
            .to_vec(),
    )
    .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, vec![[0.0, 0.0, 1.0]; 4])
    .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, corners.to_vec())
    .with_inserted_attribute(
        Mesh::ATTRIBUTE_UV_1,
        corners.map(|[u, v]| [0.5 * u, 0.5 * v]).to_vec(),
    )
    .with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, vec![[1.0, 0.7, 0.4, 1.0]; 4])
    .with_inserted_indices(Indices::U32(vec![0, 1, 2, 0, 2, 3]))
}

fn material(
    studio: &mut Studio,
    light: LitAsPlant,
    base: &StandardMaterial,
) -> MeshMaterial3d<PlantMaterial> {
    let mut materials = studio.world().resource_mut::<Assets<PlantMaterial>>();
    MeshMaterial3d(materials.add(light.over(base.clone())))
}

#[test]
fn wood_is_lit_in_full_as_bevy_does_simply_alike_and_in_full_where_lamps_are() {
    let mut studio = Studio::default();
    let sun = DirectionalLight {
        shadow_maps_enabled: true,
        ..default()
    };
    let aslant = Transform::default().looking_to(Vec3::new(-0.7, -1.0, -0.6), Vec3::Y);
    studio.world().spawn((sun, aslant));
    // A ball in the shadow of a smaller one.
    let mut meshes = studio.world().resource_mut::<Assets<Mesh>>();
    let [ball, small] = [1.0, 0.3].map(|radius| meshes.add(Sphere::new(radius).mesh().uv(32, 16)));
    let base = StandardMaterial {
        base_color: Color::srgb(0.6, 0.4, 0.3),
        perceptual_roughness: 0.75,
        reflectance: 0.3,
        ..default()
    };
    let world = studio.world();
    let standard = MeshMaterial3d(
        world
            .resource_mut::<Assets<StandardMaterial>>()
            .add(base.clone()),
    );
    let above = Transform::from_xyz(0.9, 1.2, 0.8);
    world.spawn((Mesh3d(small), standard.clone(), above));
    let ball = world.spawn((Mesh3d(ball), standard)).id();
    let bevy = photograph(&mut studio);
    studio
        .world()
        .entity_mut(ball)
        .remove::<MeshMaterial3d<StandardMaterial>>();
    let lit = |studio: &mut Studio, lighting| {
        let material = material(studio, LitAsPlant::by(lighting), &base);
        studio.world().entity_mut(ball).insert(material);
        photograph(studio)
    };
    let full = lit(&mut studio, PlantLighting::Full);
    assert_eq!(bevy.rgb_bytes(), full.rgb_bytes());
    let simple = lit(&mut studio, PlantLighting::Simple);
    let unlit = lit(&mut studio, PlantLighting::Unlit);
    // Channels of two pictures more than a twenty-fifth apart.
    let apart = |a: &Pixels, b: &Pixels| {
        let (a, b) = (a.rgb_bytes(), b.rgb_bytes());
        let pairs = a.chunks_exact(3).zip(b.chunks_exact(3));
        pairs
            .filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 10))
            .count()
    };
    let (near, far) = (apart(&full, &simple), apart(&full, &unlit));
    println!("simple {near}, unlit {far} pixels");
    // The ball's rim, where gloss is more than in the mean, and the edge of a shadow, a pixel wide each: circles of radii 30
    // and 9. The ball has some 2,800 pixels.
    assert!(near < 245, "{near}");
    assert!(far > 2000, "{far}");

    let lamp = PointLight {
        intensity: 300_000.0,
        ..default()
    };
    let lamp = studio
        .world()
        .spawn((lamp, Transform::from_xyz(2.0, 1.5, 1.5)))
        .id();
    studio.headless.step();
    let lamplit = lit(&mut studio, PlantLighting::Simple);
    let full = lit(&mut studio, PlantLighting::Full);
    assert_eq!(full.rgb_bytes(), lamplit.rgb_bytes());
    assert_ne!(full.rgb_bytes(), bevy.rgb_bytes());
    lit(&mut studio, PlantLighting::Simple);
    // With the lamp gone, a material that stays follows.
    studio.world().despawn(lamp);
    studio.headless.step();
    assert_eq!(photograph(&mut studio).rgb_bytes(), simple.rgb_bytes());
}

#[test]
fn textures_vertex_colours_masks_and_second_uvs_are_those_of_the_standard_material() {
    let mut studio = Studio::default();
    let texture = picture(&mut studio);
    let mesh = studio.world().resource_mut::<Assets<Mesh>>().add(square());
    for (uvs, alpha_mode, alpha) in [
        (UvChannel::Uv0, AlphaMode::Opaque, 1.0),
        (UvChannel::Uv1, AlphaMode::Opaque, 1.0),
        (UvChannel::Uv0, AlphaMode::Mask(0.5), 0.4),
        (UvChannel::Uv0, AlphaMode::Blend, 0.4),
    ] {
        let base = StandardMaterial {
            base_color: Color::srgb(0.9, 0.8, 0.7).with_alpha(alpha),
            base_color_texture: Some(texture.clone()),
            base_color_channel: uvs.clone(),
            alpha_mode,
            unlit: true,
            ..default()
        };
        let world = studio.world();
        let standard = world
            .resource_mut::<Assets<StandardMaterial>>()
            .add(base.clone());
        let standard = world
            .spawn((Mesh3d(mesh.clone()), MeshMaterial3d(standard)))
            .id();
        let expected = photograph(&mut studio);
        studio.world().despawn(standard);
        let plant = material(&mut studio, LitAsPlant::default(), &base);
        let plant = studio.world().spawn((Mesh3d(mesh.clone()), plant)).id();
        let seen = photograph(&mut studio);
        studio.world().despawn(plant);
        assert_eq!(
            seen.rgb_bytes(),
            expected.rgb_bytes(),
            "{uvs:?} {alpha_mode:?}"
        );
    }
}
