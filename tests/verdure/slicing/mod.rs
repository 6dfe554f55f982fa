//! Crowns as they are drawn.

mod agreement;
mod bands;
mod brightness;
mod close_up;
mod compression;
mod draws;
mod error;
mod file_sets;
mod files;
mod intersecting;
mod lighting;
mod live;
mod models;
mod near;
mod parts;
mod passes;
mod reloads;
mod sets;
mod steady;
mod twins;
mod twins_of_blending;
mod views;

use std::sync::LazyLock;

use bevy::light::CascadeShadowConfigBuilder;
use bevy::prelude::*;
use bevy_verdure::lab::{Lens, Pixels, Shot, Studio, broadleaf_crown};
use bevy_verdure::plants::{Broadleaf, BroadleafMeshes, Dice};
use bevy_verdure::prelude::*;

/// Size of the tests' pictures, in pixels.
const SIZE: UVec2 = UVec2::new(160, 120);

/// A small broadleaf.
static TREE: LazyLock<BroadleafMeshes> = LazyLock::new(|| {
    Broadleaf {
        twig_triangles: 900,
        leaf_triangles: 2400,
        leaf_length: 0.45,
        ..default()
    }
    .grow(3)
});

/// Its crown, baked with 64² pixels a slice.
static CROWN: LazyLock<Slicing> = LazyLock::new(|| baked(0.5, 0.0));

/// Another slicing of its crown: of fewer pixels, slices, levels of detail and orientations.
static SMALL: LazyLock<Slicing> = LazyLock::new(|| {
    bake_crown(&BakeSettings {
        orientations: Orientations::Circle(3),
        levels: vec![2, 1],
        switches: vec![10.0],
        ..BakeSettings::default().with_pixels(16)
    })
});

/// Its crown, baked in a way of its own.
fn bake_crown(settings: &BakeSettings) -> Slicing {
    let crown = broadleaf_crown(&TREE, 0.0).expect("a broadleaf's meshes can be baked");
    bake(&crown, settings).expect("the settings are in range")
}

/// Its crown with a correction m_s, and leaves through which such a share of light comes.
fn baked(correction: f32, diffuse_transmission: f32) -> Slicing {
    let crown =
        broadleaf_crown(&TREE, diffuse_transmission).expect("a broadleaf's meshes can be baked");
    let settings = BakeSettings {
        samples: 2,
        correction,
        ..BakeSettings::default().with_pixels(64)
    };
    bake(&crown, &settings).expect("the settings are in range")
}

/// Colours of the pictures, as they are.
const UNLIT: CrownSettings = CrownSettings {
    composition: Composition::Blended,
    order: SliceOrder::Steady,
    left_out: 0,
    lighting: PlantLighting::Unlit,
    frames: false,
    discrepancy: DiscrepancyAngle::PerPart,
};

/// A shot of the crown from `eye`.
fn shot(eye: Vec3) -> Shot {
    Shot {
        eye,
        at: CROWN.shape().centroid,
        lens: Lens::Perspective(0.6),
        size: SIZE,
    }
}

/// An eye at an azimuth and an elevation, in degrees, and so many metres from the centroid.
fn eye(azimuth: f32, elevation: f32, distance: f32) -> Vec3 {
    let (sin, cos) = azimuth.to_radians().sin_cos();
    let (rise, level) = elevation.to_radians().sin_cos();
    CROWN.shape().centroid + Vec3::new(level * cos, rise, level * sin) * distance
}

/// A direction by chance.
fn unit(dice: &mut Dice) -> Vec3 {
    let mut jitter = || dice.jitter(1.0);
    Vec3::new(jitter(), jitter(), jitter()).normalize_or(Vec3::X)
}

/// Plants the crown.
pub fn plant(studio: &mut Studio, settings: CrownSettings, transform: Transform) -> Entity {
    let world = studio.world();
    let slicing = world.resource_mut::<Assets<Slicing>>().add(CROWN.clone());
    world
        .spawn((SlicedCrown(slicing), settings, transform))
        .id()
}

/// Plants the triangles that the crown was baked from, lit or in their own colours.
fn plant_mesh(studio: &mut Studio, transform: Transform, unlit: bool) -> Vec<Entity> {
    plant_crown_of(&TREE, studio, transform, unlit)
}

/// Plants the twigs and leaves of a tree, as triangles.
fn plant_crown_of(
    tree: &BroadleafMeshes,
    studio: &mut Studio,
    transform: Transform,
    unlit: bool,
) -> Vec<Entity> {
    let world = studio.world();
    let green = world
        .resource_mut::<Assets<StandardMaterial>>()
        .add(StandardMaterial {
            perceptual_roughness: 0.75,
            reflectance: 0.3,
            double_sided: true,
            cull_mode: None,
            unlit,
            ..default()
        });
    let parts = [&tree.twigs, &tree.leaves];
    let parts = parts.map(|mesh| world.resource_mut::<Assets<Mesh>>().add(mesh.clone()));
    let plant = |mesh| {
        let look = (Mesh3d(mesh), MeshMaterial3d(green.clone()), transform);
        world.spawn(look).id()
    };
    parts.into_iter().map(plant).collect()
}

/// A studio with one crown.
fn studio(settings: CrownSettings) -> (Studio, Entity) {
    let mut studio = Studio::default();
    let crown = plant(&mut studio, settings, Transform::IDENTITY);
    studio.headless.step();
    (studio, crown)
}

/// Pixels that differ from the background, in which the picture is empty.
fn covered(picture: &Pixels, background: [u8; 3]) -> usize {
    let all = (0..SIZE.y).flat_map(|y| (0..SIZE.x).map(move |x| (x, y)));
    all.filter(|(x, y)| picture.rgb(*x, *y) != background)
        .count()
}

/// Mean of a channel, 0 to 255.
fn mean(picture: &Pixels, channel: usize) -> f64 {
    let bytes = picture.rgb_bytes();
    let all = bytes.chunks_exact(3).map(|rgb| f64::from(rgb[channel]));
    all.sum::<f64>() / f64::from(SIZE.x * SIZE.y)
}

/// A sun from above, with shadows as far as the tests look.
fn sun(studio: &mut Studio) {
    sun_to(studio, 40.0);
}

/// The same, with shadows up to so many metres from the eye.
fn sun_to(studio: &mut Studio, reach: f32) {
    studio.world().spawn((
        DirectionalLight {
            illuminance: 5_000.0,
            shadow_maps_enabled: true,
            ..default()
        },
        CascadeShadowConfigBuilder {
            num_cascades: 1,
            maximum_distance: reach,
            ..default()
        }
        .build(),
        Transform::default().looking_to(Vec3::new(0.0, -1.0, -0.2), Vec3::Z),
    ));
}
