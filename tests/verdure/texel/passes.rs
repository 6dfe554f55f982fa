//! Texels among other things: prepasses, light and shadow, MSAA, layers, removal.

use bevy::camera::visibility::RenderLayers;
use bevy::core_pipeline::prepass::{DepthPrepass, MotionVectorPrepass, NormalPrepass};
use bevy::light::CascadeShadowConfigBuilder;
use bevy::prelude::*;
use bevy_verdure::lab::texel::{ReferenceSteps, ReferenceTexels};
use bevy_verdure::lab::{Pixels, Shot, Studio};
use bevy_verdure::prelude::*;
use bevy_verdure::texel::TexelSlices;

use super::{
    BACKGROUND, LOLLY, SIDE, SIZE, Square, cover_default, is_background, rays, reference, shot,
    unlit,
};

const EYE: Vec3 = Vec3::new(1.9, 2.3, 1.2);

fn covered(picture: &Pixels) -> usize {
    let all = (0..SIZE.y).flat_map(|y| (0..SIZE.x).map(move |x| (x, y)));
    all.filter(|&(x, y)| !is_background(picture.rgb(x, y)))
        .count()
}

#[test]
fn the_prepass_leaves_the_picture_as_it_is() {
    let mut studio = Studio::default();
    cover_default(&mut studio, unlit());
    let without = studio.photograph(&shot(EYE), BACKGROUND);
    let camera = studio.camera();
    studio
        .world()
        .entity_mut(camera)
        .insert((DepthPrepass, NormalPrepass, MotionVectorPrepass));
    studio.headless.step();
    let with = studio.photograph(&shot(EYE), BACKGROUND);
    assert!(covered(&without) > 500);
    // Depths that differed in their last bit would leave holes.
    assert_eq!(without.rgb_bytes(), with.rgb_bytes());
}

/// Where the tests' sun shines.
const SUNLIGHT: Vec3 = Vec3::new(0.3, -1.0, 0.0);

/// A sun with a shadow map.
pub fn sun(studio: &mut Studio) {
    studio.world().spawn((
        DirectionalLight {
            illuminance: 5_000.0,
            shadow_maps_enabled: true,
            ..default()
        },
        CascadeShadowConfigBuilder {
            num_cascades: 1,
            maximum_distance: 12.0,
            ..default()
        }
        .build(),
        Transform::default().looking_to(SUNLIGHT, Vec3::Y),
    ));
}

/// A white floor below the default square.
pub fn floor(studio: &mut Studio) {
    let world = studio.world();
    let mesh = world
        .resource_mut::<Assets<Mesh>>()
        .add(Plane3d::default().mesh().size(8.0, 8.0));
    let white = world
        .resource_mut::<Assets<StandardMaterial>>()
        .add(Color::WHITE);
    world.spawn((
        Mesh3d(mesh),
        MeshMaterial3d(white),
        Transform::from_xyz(0.0, -0.01, 0.0),
    ));
}

/// Mean of all channels, 0 to 255.
pub fn mean(picture: &Pixels) -> f64 {
    let bytes = picture.rgb_bytes();
    bytes.iter().map(|&byte| f64::from(byte)).sum::<f64>() / bytes.len() as f64
}

/// Which pixels show what the sun reaches, by rays marched in double precision: from there to the sun nothing is further
/// away than two voxels, which are the place's own.
fn sunlit(shot: &Shot) -> Vec<bool> {
    let facets = Square::default().facets(&Transform::IDENTITY);
    let references = facets.map(|facet| reference(&facet));
    let texels = ReferenceTexels::new(&LOLLY, &references, ReferenceSteps { per_voxel: 3.0 });
    let to_sun = -SUNLIGHT.normalize().as_dvec3();
    let reached = rays(shot).map(|(eye, direction)| {
        texels.cast(eye, direction, 0.0).is_some_and(|hit| {
            let place = eye + direction * hit.t;
            texels.cast(place, to_sun, 2.0 / f64::from(SIDE)).is_none()
        })
    });
    reached.collect()
}

#[test]
fn texels_cast_shadows_on_the_ground_and_do_not_darken_themselves() {
    use bevy::light::{NotShadowCaster, NotShadowReceiver};
    let mut studio = Studio::default();
    sun(&mut studio);
    floor(&mut studio);
    let surface = cover_default(&mut studio, TexelSettings::default());
    let from_above = shot(EYE);
    let with = studio.photograph(&from_above, BACKGROUND);
    studio.world().entity_mut(surface).insert(NotShadowReceiver);
    studio.headless.step();
    let unshadowed = studio.photograph(&from_above, BACKGROUND);
    studio.world().entity_mut(surface).insert(NotShadowCaster);
    studio.headless.step();
    let without = studio.photograph(&from_above, BACKGROUND);
    // The shadow on the floor is as large as the ball, about a tenth of the picture.
    assert!(
        mean(&unshadowed) < mean(&without) - 5.0,
        "{} {}",
        mean(&unshadowed),
        mean(&without)
    );
    // A ball shades its own lower half and post; acne would darken what the sun reaches, in
    // stripes all over. Pixels of the texel are those that neither have the floor's grey nor the background.
    let texel = |i: usize| {
        let [r, g, b] = without.rgb(i as u32 % SIZE.x, i as u32 / SIZE.x);
        r.abs_diff(g) > 8 || g.abs_diff(b) > 8
    };
    let lit = sunlit(&from_above);
    let pixels: Vec<usize> = (0..(SIZE.x * SIZE.y) as usize)
        .filter(|&i| texel(i) && lit[i])
        .collect();
    let light = |picture: &Pixels, i: usize| {
        let color = picture.rgb(i as u32 % SIZE.x, i as u32 / SIZE.x);
        color.map(u32::from).iter().sum::<u32>()
    };
    // Normals that differ leave a little light on what faces away from the sun, which its own shadow takes: acne is what
    // darkens by a tenth of the usual light.
    let usual = pixels.iter().map(|&i| light(&unshadowed, i)).sum::<u32>() / pixels.len() as u32;
    let darkened = pixels
        .iter()
        .filter(|&&i| light(&with, i) + usual / 10 < light(&unshadowed, i))
        .count();
    println!(
        "{darkened} of {} pixels are in their own shadow",
        pixels.len()
    );
    assert!(pixels.len() > 500);
    assert!(
        darkened * 100 < pixels.len(),
        "{darkened} of {}",
        pixels.len()
    );
}

#[test]
fn slices_are_where_their_surface_is_seen_and_go_with_it() {
    let mut studio = Studio::default();
    let surface = cover_default(&mut studio, unlit());
    let seen = |studio: &mut Studio| {
        studio.headless.step();
        covered(&studio.photograph(&shot(EYE), BACKGROUND))
    };
    assert!(seen(&mut studio) > 500);
    studio
        .world()
        .entity_mut(surface)
        .insert(RenderLayers::layer(3));
    assert_eq!(seen(&mut studio), 0);
    studio.world().entity_mut(surface).remove::<RenderLayers>();
    assert!(seen(&mut studio) > 500);
    studio
        .world()
        .entity_mut(surface)
        .insert(Visibility::Hidden);
    assert_eq!(seen(&mut studio), 0);
    let mesh = studio.world().get::<Mesh3d>(surface).unwrap().clone();
    studio
        .world()
        .entity_mut(surface)
        .insert(Visibility::Visible)
        .remove::<Mesh3d>();
    assert_eq!(seen(&mut studio), 0, "what has no mesh carries no texels");
    studio.world().entity_mut(surface).insert(mesh);
    assert!(seen(&mut studio) > 500);
    studio.world().entity_mut(surface).remove::<TexelSurface>();
    assert_eq!(seen(&mut studio), 0);
    let world = studio.world();
    let left = world.query::<&TexelSlices>().iter(world).count();
    assert_eq!(left, 0, "slices go with their surface");
}

#[test]
fn meshes_that_can_carry_no_texels_are_left_alone() {
    let mut studio = Studio::default();
    let no_uvs = {
        let mut mesh = Square::default().mesh();
        mesh.remove_attribute(Mesh::ATTRIBUTE_UV_0);
        mesh
    };
    let no_heights = Square {
        heights: [Vec3::ZERO; 4],
        ..default()
    };
    let mut not_finite = Square::default();
    not_finite.positions[2] = Vec3::NAN;
    let mut folded = Square::default();
    folded.heights[0] = Vec3::NEG_Y;
    let surface = cover_default(&mut studio, unlit());
    let whole = covered(&studio.photograph(&shot(EYE), BACKGROUND));
    // Triangles that share the broken vertex carry none; the other may remain.
    for (mesh, most) in [
        (no_uvs, 0),
        (no_heights.mesh(), 0),
        (not_finite.mesh(), 0),
        (folded.mesh(), 0),
        (Square::default().mesh(), whole),
    ] {
        let world = studio.world();
        let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh);
        world.entity_mut(surface).insert(Mesh3d(mesh));
        studio.headless.step();
        let picture = studio.photograph(&shot(EYE), BACKGROUND);
        assert_eq!(covered(&picture), most);
    }
}

#[test]
fn with_msaa_outlines_are_smooth_and_prepasses_agree() {
    let mut studio = Studio::default();
    let camera = studio.camera();
    studio.world().entity_mut(camera).insert(Msaa::Sample4);
    cover_default(&mut studio, unlit());
    let mut without = studio.photograph(&shot(EYE), BACKGROUND);
    let mixed = |picture: &Pixels| {
        let all = (0..SIZE.y).flat_map(|y| (0..SIZE.x).map(move |x| (x, y)));
        // Within 0.33 of the middle red and green add up to 0.53 of 255 and more, but for a voxel's width.
        all.filter(|&(x, y)| {
            let [r, g, b] = picture.rgb(x, y);
            u32::from(r) + u32::from(g) < 125 && !is_background([r, g, b])
        })
        .count()
    };
    let smooth = mixed(&without);
    studio
        .world()
        .entity_mut(camera)
        .insert((DepthPrepass, NormalPrepass));
    studio.headless.step();
    let with = studio.photograph(&shot(EYE), BACKGROUND);
    assert_eq!(without.rgb_bytes(), with.rgb_bytes());
    studio
        .world()
        .entity_mut(camera)
        .remove::<(DepthPrepass, NormalPrepass)>()
        .insert(Msaa::Off);
    studio.headless.step();
    without = studio.photograph(&shot(EYE), BACKGROUND);
    let plain = mixed(&without);
    println!("{smooth} pixels are mixed with the background, {plain} without MSAA");
    // Pixels of which less than a fourth is covered count, for a mixture looks lighter than its share.
    assert!(plain == 0 && smooth > 8, "{smooth} {plain}");
}
