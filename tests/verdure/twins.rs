//! A sphere of frusta looks like a sphere of triangles, whatever lights, passes and cameras a scene has.

use core::f32::consts::TAU;

use bevy::anti_alias::taa::TemporalAntiAliasing;
use bevy::asset::RenderAssetUsages;
use bevy::core_pipeline::prepass::{
    DeferredPrepass, DepthPrepass, MotionVectorPrepass, NormalPrepass,
};
use bevy::image::{ImageAddressMode, ImageSampler, ImageSamplerDescriptor};
use bevy::light::{CascadeShadowConfigBuilder, EnvironmentMapLight};
use bevy::pbr::DefaultOpaqueRendererMethod;
use bevy::prelude::*;
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat};
use bevy_verdure::lab::{Lens, Shot, Studio, mean_flip};
use bevy_verdure::prelude::*;

const SIZE: UVec2 = UVec2::new(256, 192);
const RADIUS: f32 = 0.6;
/// A mesh of these sectors lies at most 0.2 mm inside its sphere, far below a pixel.
const SECTORS: u32 = 160;
/// Mean FLIP of pictures that differ by some pixels' roundings along outlines; a missing shadow, light or highlight
/// gives 0.02 and more.
const SAME: f32 = 0.003;

fn shot(lens: Lens) -> Shot {
    Shot {
        eye: Vec3::new(0.6, 1.5, 3.6),
        at: Vec3::new(0.0, 0.4, 0.0),
        lens,
        size: SIZE,
    }
}

fn skin() -> StandardMaterial {
    StandardMaterial {
        base_color: Color::srgb(0.7, 0.35, 0.2),
        perceptual_roughness: 0.4,
        metallic: 0.1,
        ..default()
    }
}

fn ground(world: &mut World) {
    let mesh = world
        .resource_mut::<Assets<Mesh>>()
        .add(Plane3d::default().mesh().size(12.0, 12.0));
    let material = world
        .resource_mut::<Assets<StandardMaterial>>()
        .add(Color::srgb(0.6, 0.6, 0.55));
    world.spawn((
        Mesh3d(mesh),
        MeshMaterial3d(material),
        Transform::from_xyz(0.0, -0.2, 0.0),
    ));
}

/// Mean FLIP between both spheres in a scene that `stage` sets up.
fn difference(name: &str, lens: Lens, frames: usize, stage: impl Fn(&mut Studio)) -> f32 {
    let mut pictures = Vec::new();
    for frusta in [false, true] {
        let mut studio = Studio::default();
        ground(studio.world());
        stage(&mut studio);
        let place = Transform::from_xyz(0.0, 0.5, 0.0);
        let world = studio.world();
        if frusta {
            // A segment of no length is its sphere.
            let skeleton = Skeleton::new(vec![
                Joint::root(Vec3::ZERO, RADIUS),
                Joint::new(Vec3::ZERO, RADIUS, 0),
            ]);
            let skeleton = world
                .resource_mut::<Assets<Skeleton>>()
                .add(skeleton.unwrap());
            let skin = world
                .resource_mut::<Assets<FrustaMaterial>>()
                .add(frusta_material(skin()));
            world.spawn((Skeleton3d(skeleton), MeshMaterial3d(skin), place));
        } else {
            let mesh = Sphere::new(RADIUS).mesh().uv(SECTORS, SECTORS);
            let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh);
            let skin = world.resource_mut::<Assets<StandardMaterial>>().add(skin());
            world.spawn((Mesh3d(mesh), MeshMaterial3d(skin), place));
        }
        for _ in 0..frames {
            studio.headless.step();
        }
        pictures.push(studio.photograph(&shot(lens), Color::srgb(0.4, 0.6, 0.8)));
    }
    let flip = mean_flip(
        (SIZE.x, SIZE.y),
        &pictures[0].rgb_bytes(),
        &pictures[1].rgb_bytes(),
    );
    println!("{name}: mean FLIP {flip:.5}");
    if let Ok(folder) = std::env::var("VERDURE_PICTURES") {
        std::fs::create_dir_all(&folder).unwrap();
        for (picture, kind) in pictures.iter().zip(["mesh", "frusta"]) {
            let file = std::path::Path::new(&folder).join(format!("{name}_{kind}.png"));
            picture.save_png(&file).unwrap();
        }
    }
    flip
}

const PERSPECTIVE: Lens = Lens::Perspective(0.7);

fn sun(studio: &mut Studio) {
    studio.world().spawn((
        DirectionalLight {
            illuminance: 8_000.0,
            shadow_maps_enabled: true,
            ..default()
        },
        CascadeShadowConfigBuilder {
            maximum_distance: 12.0,
            ..default()
        }
        .build(),
        Transform::default().looking_to(Vec3::new(-0.7, -0.8, -0.3), Vec3::Y),
    ));
}

#[test]
fn under_a_sun_with_shadows() {
    assert!(difference("sun", PERSPECTIVE, 1, sun) < SAME);
}

#[test]
fn under_a_point_light_with_shadows() {
    let stage = |studio: &mut Studio| {
        studio.world().spawn((
            PointLight {
                intensity: 700_000.0,
                shadow_maps_enabled: true,
                ..default()
            },
            Transform::from_xyz(1.6, 2.4, 0.8),
        ));
    };
    assert!(difference("point", PERSPECTIVE, 1, stage) < SAME);
}

#[test]
fn under_a_spot_light_with_shadows() {
    let stage = |studio: &mut Studio| {
        studio.world().spawn((
            SpotLight {
                intensity: 1_500_000.0,
                shadow_maps_enabled: true,
                ..default()
            },
            Transform::from_xyz(1.6, 2.8, 0.8).looking_at(Vec3::ZERO, Vec3::Y),
        ));
    };
    assert!(difference("spot", PERSPECTIVE, 1, stage) < SAME);
}

#[test]
fn in_an_environment() {
    let stage = |studio: &mut Studio| {
        let camera = studio.camera();
        let mut images = studio.world().resource_mut::<Assets<Image>>();
        let sky = EnvironmentMapLight::hemispherical_gradient(
            &mut images,
            Color::srgb(0.5, 0.7, 1.0),
            Color::srgb(0.6, 0.5, 0.4),
            Color::srgb(0.3, 0.2, 0.1),
        );
        let sky = EnvironmentMapLight {
            intensity: 900.0,
            ..sky
        };
        studio.world().entity_mut(camera).insert(sky);
    };
    assert!(difference("environment", PERSPECTIVE, 1, stage) < SAME);
}

#[test]
fn in_fog() {
    let stage = |studio: &mut Studio| {
        sun(studio);
        let camera = studio.camera();
        studio.world().entity_mut(camera).insert(DistanceFog {
            color: Color::srgb(0.8, 0.8, 0.9),
            falloff: FogFalloff::Linear {
                start: 2.0,
                end: 6.0,
            },
            ..default()
        });
    };
    assert!(difference("fog", PERSPECTIVE, 1, stage) < SAME);
}

#[test]
fn without_perspective() {
    assert!(difference("orthographic", Lens::Orthographic(2.6), 1, sun) < SAME);
}

#[test]
fn after_all_prepasses() {
    let stage = |studio: &mut Studio| {
        sun(studio);
        let camera = studio.camera();
        let prepasses = (DepthPrepass, NormalPrepass, MotionVectorPrepass);
        studio.world().entity_mut(camera).insert(prepasses);
    };
    assert!(difference("prepass", PERSPECTIVE, 1, stage) < SAME);
}

fn deferred_sun(studio: &mut Studio) {
    sun(studio);
    let camera = studio.camera();
    let world = studio.world();
    world.insert_resource(DefaultOpaqueRendererMethod::deferred());
    world
        .entity_mut(camera)
        .insert((DepthPrepass, DeferredPrepass));
}

#[test]
fn deferred() {
    assert!(difference("deferred", PERSPECTIVE, 1, deferred_sun) < SAME);
}

/// A deferred limb whose forward pass would write figures instead of light, were it drawn there.
fn deferred_limb(output: FrustaOutput, prepass: bool) -> Vec<u8> {
    let mut limb = Skeleton::builder();
    let root = limb.root(Vec3::ZERO, RADIUS);
    limb.joint(root, Vec3::Y, 0.5 * RADIUS);
    let mut studio = Studio::default();
    deferred_sun(&mut studio);
    let camera = studio.camera();
    let world = studio.world();
    if !prepass {
        world
            .entity_mut(camera)
            .remove::<(DepthPrepass, DeferredPrepass)>();
    }
    let skeleton = world
        .resource_mut::<Assets<Skeleton>>()
        .add(limb.build().unwrap());
    let mut skin = frusta_material(skin());
    skin.extension.output = output;
    let skin = world.resource_mut::<Assets<FrustaMaterial>>().add(skin);
    world.spawn((Skeleton3d(skeleton), MeshMaterial3d(skin)));
    studio.headless.step();
    studio
        .photograph(&shot(PERSPECTIVE), Color::BLACK)
        .rgb_bytes()
}

#[test]
fn deferred_plants_are_drawn_once() {
    let lit = deferred_limb(FrustaOutput::Shaded, true);
    assert!(lit.iter().any(|&byte| byte > 50), "nothing was drawn");
    // Deferred lighting's, to the byte: no forward pass wrote normals over it.
    assert!(lit == deferred_limb(FrustaOutput::Normals, true));
    // A view without that prepass draws the same material forward.
    let forward = deferred_limb(FrustaOutput::Shaded, false);
    let flip = mean_flip((SIZE.x, SIZE.y), &lit, &forward);
    println!("deferred against forward: mean FLIP {flip:.5}");
    assert!(flip < SAME, "{flip}");
    assert!(lit != deferred_limb(FrustaOutput::Normals, false));
}

#[test]
fn with_multisampling() {
    let stage = |studio: &mut Studio| {
        sun(studio);
        let camera = studio.camera();
        studio.world().entity_mut(camera).insert(Msaa::Sample4);
    };
    assert!(difference("msaa", PERSPECTIVE, 1, stage) < SAME);
}

#[test]
fn with_multisampling_and_prepasses() {
    let stage = |studio: &mut Studio| {
        sun(studio);
        let camera = studio.camera();
        let prepasses = (Msaa::Sample4, DepthPrepass, NormalPrepass);
        studio.world().entity_mut(camera).insert(prepasses);
    };
    assert!(difference("msaa_prepass", PERSPECTIVE, 1, stage) < SAME);
}

#[test]
fn with_temporal_anti_aliasing() {
    let stage = |studio: &mut Studio| {
        sun(studio);
        let camera = studio.camera();
        studio
            .world()
            .entity_mut(camera)
            .insert(TemporalAntiAliasing::default());
    };
    // The jitter repeats after eight frames.
    assert!(difference("taa", PERSPECTIVE, 12, stage) < SAME);
}

/// Waves in both directions, as a normal map; `flip` turns its green channel round.
fn waves(flip: bool) -> Image {
    let size = 64u32;
    let pixels = (0..size * size).flat_map(|i| {
        let [x, y] = [i % size, i / size].map(|x| (x as f32 + 0.5) / size as f32 * 2.0);
        let slope = Vec2::new((x * TAU).sin(), (y * TAU).sin() + 0.5) * 0.5;
        let green = if flip { -slope.y } else { slope.y };
        let normal = Vec3::new(slope.x, green, 1.0).normalize() * 0.5 + 0.5;
        [normal.x, normal.y, normal.z, 1.0].map(|x| (x * 255.0).round() as u8)
    });
    let mut image = Image::new(
        Extent3d {
            width: size,
            height: size,
            depth_or_array_layers: 1,
        },
        TextureDimension::D2,
        pixels.collect(),
        TextureFormat::Rgba8Unorm,
        RenderAssetUsages::RENDER_WORLD,
    );
    image.sampler = ImageSampler::Descriptor(ImageSamplerDescriptor {
        address_mode_u: ImageAddressMode::Repeat,
        address_mode_v: ImageAddressMode::Repeat,
        ..ImageSamplerDescriptor::linear()
    });
    image
}

/// A limb with a normal map, as frusta or as polygons.
fn waved_limb(frusta: bool, flip: bool) -> Vec<u8> {
    let mut limb = Skeleton::builder();
    let mut last = limb.root(Vec3::ZERO, 0.5);
    limb.texture_length(last, 1.0);
    for i in 1..=4 {
        let h = i as f32 * 0.5;
        last = limb.joint(last, Vec3::new(0.1 * h * h, h, 0.0), 0.5 - 0.05 * h);
    }
    let limb = limb.build().unwrap();
    let mut studio = Studio::default();
    let world = studio.world();
    let map = world.resource_mut::<Assets<Image>>().add(waves(flip));
    let skin = StandardMaterial {
        normal_map_texture: Some(map),
        ..skin()
    };
    let place = Transform::from_xyz(0.0, -0.3, 0.0);
    if frusta {
        let skeleton = world.resource_mut::<Assets<Skeleton>>().add(limb);
        let skin = world
            .resource_mut::<Assets<FrustaMaterial>>()
            .add(frusta_material(skin));
        world.spawn((Skeleton3d(skeleton), MeshMaterial3d(skin), place));
    } else {
        let settings = MeshSettings {
            subdivisions: 3,
            ..default()
        };
        let mesh = limb.to_mesh(&settings).unwrap();
        let mesh = mesh.with_generated_tangents().unwrap();
        let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh);
        let skin = world.resource_mut::<Assets<StandardMaterial>>().add(skin);
        world.spawn((Mesh3d(mesh), MeshMaterial3d(skin), place));
    }
    world.spawn((
        DirectionalLight {
            illuminance: 8_000.0,
            ..default()
        },
        Transform::default().looking_to(Vec3::new(0.3, -1.0, -0.4), Vec3::Z),
    ));
    studio.photograph(&shot(Lens::Perspective(0.7)), Color::BLACK);
    let picture = studio.photograph(&shot(Lens::Perspective(0.7)), Color::BLACK);
    picture.rgb_bytes()
}

#[test]
fn normal_maps_lean_as_they_do_on_polygons() {
    let polygons = waved_limb(false, false);
    let compare = |flip| {
        let frusta = waved_limb(true, flip);
        mean_flip((SIZE.x, SIZE.y), &polygons, &frusta)
    };
    let (same, flipped) = (compare(false), compare(true));
    println!("normal map: mean FLIP {same:.5}, upside down {flipped:.5}");
    // 64 sectors stand for the round, and tangents are interpolated: well below what one channel upside down does.
    assert!(same < 0.25 * flipped, "{same} against {flipped}");
}
