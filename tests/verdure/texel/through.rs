//! Texels and ordinary meshes that run through one another: whichever is nearer is seen.
//!
//! All slices are drawn, 1/32 apart, across the axis along which the eye looks. A ray that enters the solid box of the
//! volume meets one at the latest where it has gone from slice to slice, unless it has left the box before. So the box alone
//! tells what is seen, but for rays that meet the mesh in between.

use bevy::core_pipeline::prepass::DepthPrepass;
use bevy::math::DVec3;
use bevy::prelude::*;
use bevy_verdure::lab::texel_scenes::all_slices;
use bevy_verdure::lab::{Lens, Pixels, Shot, Studio};
use bevy_verdure::prelude::*;
use bevy_verdure::texel::build::{VolumeSettings, from_hypertexture};
use bevy_verdure::texel::silent;

use super::{BACKGROUND, SIDE, cover_default, rays, shot};

/// Corners of what is solid, as it stands on the default square.
const LOW: DVec3 = DVec3::new(0.25, 0.0, -0.75);
const HIGH: DVec3 = DVec3::new(0.75, 0.75, -0.25);

/// How far inside a box is opaque for certain, in metres: filters round the edges of a slice off, but 0.3 voxels inside of
/// two of its sides a place has 0.8 of 0.8, more than a half.
const INSIDE: f64 = 0.3 / SIDE as f64;

/// How far rounding may move a face, in metres: a tenth of a pixel, where depths and filters are off by less than a
/// hundredth.
const ROUNDING: f64 = 1e-3;

/// The brightest channel of a pixel of the mesh, of a texel, and of neither.
const MESH: usize = 0;
const TEXEL: usize = 1;
const NEITHER: usize = 2;

/// Eyes, each with the axis along which it looks: down, from the front, from the right.
const EYES: [(Vec3, usize); 3] = [
    (Vec3::new(0.9, 3.4, 0.1), 1),
    (Vec3::new(0.9, 1.4, 2.4), 2),
    (Vec3::new(3.4, 1.3, -0.1), 0),
];

/// A green box, a quarter of the volume away from its sides and its top.
fn solid_box() -> TexelVolume {
    let solid = |at: Vec3| {
        let aside = 0.25 - (at.truncate() - 0.5).abs().max_element();
        (0.5 + aside.min(0.75 - at.z), Vec3::Y)
    };
    let settings = VolumeSettings::new(UVec3::splat(SIDE));
    let built = from_hypertexture(solid, &settings, &silent);
    built.expect("the volume is in range").volume.into()
}

/// Ordinary meshes, cuboids of some size: two thin slabs through the middle of the box, and a bar that comes out of its
/// front.
fn cuboids() -> [(&'static str, Vec3, Transform); 3] {
    let slab = |normal: Vec3| {
        let middle = (0.5 * (LOW + HIGH)).as_vec3();
        let turn = Quat::from_rotation_arc(Vec3::Z, normal.normalize());
        let place = Transform::from_translation(middle).with_rotation(turn);
        (Vec3::new(4.0, 4.0, 0.02), place)
    };
    let (size, upright) = slab(Vec3::new(1.0, 0.2, 0.3));
    let (_, lying) = slab(Vec3::new(0.3, 1.0, 0.2));
    let bar = Transform::from_xyz(0.5, 0.425, -0.25);
    [
        ("upright slab", size, upright),
        ("lying slab", size, lying),
        ("bar", Vec3::new(1.6, 0.25, 0.3), bar),
    ]
}

/// Where a ray enters a box, and where it leaves it again, if it does.
fn cross(low: DVec3, high: DVec3, eye: DVec3, direction: DVec3) -> Option<(f64, f64)> {
    let (a, b) = ((low - eye) / direction, (high - eye) / direction);
    let (enters, leaves) = (a.min(b).max_element(), a.max(b).min_element());
    (0.0 < enters && enters < leaves).then_some((enters, leaves))
}

fn brightest([red, green, blue]: [u8; 3]) -> usize {
    if red > green.max(blue) {
        MESH
    } else if green > blue {
        TEXEL
    } else {
        NEITHER
    }
}

/// All pixels of which that is known must show what is nearest on their ray.
fn check(name: &str, picture: &Pixels, look: &Shot, axis: usize, (size, place): (Vec3, Transform)) {
    let half = 0.5 * size.as_dvec3();
    let turn = place.rotation.as_dquat().inverse();
    let middle = place.translation.as_dvec3();
    let (mut before, mut behind, mut open, mut solid) = (0, 0, 0, 0);
    for (i, (eye, direction)) in rays(look).enumerate() {
        let (x, y) = (i as u32 % look.size.x, i as u32 / look.size.x);
        // Larger by so much on all sides.
        let texel = |by: f64| cross(LOW - by, HIGH + by, eye, direction);
        let mesh = |by: f64| {
            let (eye, direction) = (turn * (eye - middle), turn * direction);
            cross(-half - by, half + by, eye, direction).map(|(enters, _)| enters)
        };
        let spacing = 1.0 / f64::from(SIDE) / direction[axis].abs();
        let slice = texel(-INSIDE)
            .filter(|(enters, leaves)| enters + spacing <= *leaves)
            .map(|(enters, _)| enters + spacing);
        solid += usize::from(slice.is_some());
        let expected = if let Some(latest) = slice
            && mesh(ROUNDING).is_none_or(|meets| latest < meets)
        {
            before += usize::from(mesh(-ROUNDING).is_some());
            TEXEL
        } else if let Some(meets) = mesh(-ROUNDING)
            && texel(ROUNDING).is_none_or(|(enters, _)| meets < enters)
        {
            behind += usize::from(slice.is_some());
            MESH
        } else if mesh(ROUNDING).is_none() && texel(ROUNDING).is_none() {
            NEITHER
        } else {
            open += 1;
            continue;
        };
        let color = picture.rgb(x, y);
        assert_eq!(
            brightest(color),
            expected,
            "{name}: {x}, {y} shows {color:?}"
        );
    }
    println!(
        "{name}: texels before the mesh at {before} pixels, behind it at {behind}, {open} open"
    );
    // Spacing is a twelfth of the box's depth, and edges and outlines are as much again.
    assert!(
        before > 30 && behind > 30 && 6 * open < solid,
        "{name}: {before} {behind} {open} {solid}"
    );
}

#[test]
fn a_mesh_that_runs_through_texels_is_seen_where_it_is_nearer_and_hidden_where_they_are() {
    let mut studio = Studio::default();
    let surface = cover_default(&mut studio, all_slices(PlantLighting::Unlit));
    let world = studio.world();
    let volume = world.resource_mut::<Assets<TexelVolume>>().add(solid_box());
    let thickness = 1.0;
    world
        .entity_mut(surface)
        .insert(TexelSurface { volume, thickness });
    let red = StandardMaterial {
        base_color: Color::srgb(1.0, 0.0, 0.0),
        unlit: true,
        ..default()
    };
    let red = world.resource_mut::<Assets<StandardMaterial>>().add(red);
    for prepass in [false, true] {
        if prepass {
            let camera = studio.camera();
            studio.world().entity_mut(camera).insert(DepthPrepass);
        }
        for (name, size, place) in cuboids() {
            let world = studio.world();
            let mesh = world
                .resource_mut::<Assets<Mesh>>()
                .add(Cuboid::from_size(size));
            let look = (Mesh3d(mesh), MeshMaterial3d(red.clone()), place);
            let mesh = world.spawn(look).id();
            studio.headless.step();
            for (eye, axis) in EYES {
                let look = Shot {
                    lens: Lens::Perspective(0.4),
                    ..shot(eye)
                };
                let picture = studio.photograph(&look, BACKGROUND);
                let name = format!("{name} from {eye}, prepass {prepass}");
                check(&name, &picture, &look, axis, (size, place));
            }
            studio.world().despawn(mesh);
        }
    }
}
