//! What is written and listed in a frame: no more than there is need for.

use bevy::camera::visibility::RenderLayers;
use bevy::prelude::*;
use bevy::render::RenderApp;
use bevy_verdure::lab::Studio;
use bevy_verdure::prelude::*;
use bevy_verdure::texel::TexelStats;

use super::{BACKGROUND, cover_default, lollies, shot, unlit};

/// Bytes of a facet, as its shaders have it.
pub const FACET: usize = 144;

/// Squares along each side of a lawn.
const SIDE: usize = 8;

/// Those of the next frame.
pub fn stats(studio: &mut Studio) -> TexelStats {
    studio.headless.step();
    let render = studio.headless.app().sub_app(RenderApp).world();
    *render.resource::<TexelStats>()
}

/// A lawn of 128 facets.
fn lawn(studio: &mut Studio) -> (Entity, Handle<Mesh>, Vec<Vec3>) {
    let world = studio.world();
    let plane = Plane3d::default().mesh().subdivisions(SIDE as u32 - 1);
    let mesh = plane.build();
    let count = mesh.count_vertices();
    let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh);
    let surface = lollies(world, 0.2);
    let surface = world.spawn((Mesh3d(mesh.clone()), surface, unlit())).id();
    (surface, mesh, vec![Vec3::Y * 0.2; count])
}

#[test]
fn what_changed_is_written_and_nothing_else() {
    let mut studio = Studio::default();
    let (surface, _, mut heights) = lawn(&mut studio);
    let all = 2 * SIDE * SIDE * FACET;
    stats(&mut studio);
    let picture = |studio: &mut Studio| {
        studio
            .photograph(&shot(Vec3::new(1.0, 2.0, 1.5)), BACKGROUND)
            .rgb_bytes()
    };
    let stroke = |studio: &mut Studio, heights: &[Vec3]| {
        let heights = TexelHeights(heights.to_vec());
        studio.world().entity_mut(surface).insert(heights);
        stats(studio).uploaded_bytes
    };
    stroke(&mut studio, &heights);
    let before = picture(&mut studio);
    assert_eq!(stats(&mut studio).uploaded_bytes, 0, "nothing moves");
    // A vertex in the middle has six facets, in two rows of squares; in each what lies between them goes along.
    let middle = (SIDE / 2) * (SIDE + 1) + SIDE / 2;
    heights[middle] = Vec3::new(0.1, 0.15, 0.0);
    let written = stroke(&mut studio, &heights);
    assert!((6 * FACET..=10 * FACET).contains(&written), "{written}");
    assert_eq!(stroke(&mut studio, &heights), 0, "it is where it was");
    let stroked = picture(&mut studio);
    assert!(before != stroked);
    for height in &mut heights {
        *height = Vec3::new(0.05, 0.2, 0.0);
    }
    assert_eq!(stroke(&mut studio, &heights), all);
    // Another surface made with the same height vectors shows what has been written piece by piece.
    heights = vec![Vec3::Y * 0.2; heights.len()];
    heights[middle] = Vec3::new(0.1, 0.15, 0.0);
    stroke(&mut studio, &heights);
    let again = picture(&mut studio);
    assert!(stroked == again, "what was written is what is drawn");
    let world = studio.world();
    world.despawn(surface);
    let (fresh, ..) = lawn(&mut studio);
    studio
        .world()
        .entity_mut(fresh)
        .insert(TexelHeights(heights));
    stats(&mut studio);
    assert!(stroked == picture(&mut studio));
}

#[test]
fn only_views_and_lights_of_a_surface_s_layers_list_its_slices() {
    let mut studio = Studio::default();
    let surface = cover_default(&mut studio, unlit());
    studio.photograph(&shot(Vec3::new(1.9, 2.3, 1.2)), BACKGROUND);
    let seen = stats(&mut studio).slices;
    assert!(seen > 0);
    let sun = DirectionalLight {
        shadow_maps_enabled: true,
        ..default()
    };
    let down = Transform::default().looking_to(Vec3::new(0.3, -1.0, 0.0), Vec3::Y);
    let sun = studio.world().spawn((sun, down)).id();
    stats(&mut studio);
    let lit = stats(&mut studio).slices;
    assert!(lit > seen);
    let on = |studio: &mut Studio, entity: Entity, layer| {
        let layer = RenderLayers::layer(layer);
        studio.world().entity_mut(entity).insert(layer);
        stats(studio).slices
    };
    assert_eq!(on(&mut studio, surface, 1), 0, "no view has layer 1");
    assert_eq!(on(&mut studio, sun, 1), lit - seen, "the light has");
    assert_eq!(on(&mut studio, surface, 0), seen, "the camera has layer 0");
    studio.world().despawn(surface);
    assert_eq!(stats(&mut studio).slices, 0);
}
