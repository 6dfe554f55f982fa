//! The meshes that plants are drawn with come and go with the plants.

use bevy::prelude::*;
use bevy::render::RenderApp;
use bevy::render::mesh::RenderMesh;
use bevy::render::render_asset::RenderAssets;
use bevy_verdure::lab::Studio;
use bevy_verdure::prelude::*;

use crate::skeletons::limb;

/// Meshes in the main world, and on the device.
fn meshes(studio: &mut Studio) -> (usize, usize) {
    // One frame to follow the plants, one to drop what they no longer use.
    for _ in 0..3 {
        studio.headless.step();
    }
    let main = studio.world().resource::<Assets<Mesh>>().len();
    let render = studio.headless.app().sub_app(RenderApp).world();
    let render = render.resource::<RenderAssets<RenderMesh>>();
    (main, render.iter().count())
}

#[test]
fn a_mesh_is_freed_once_no_plant_of_its_size_is_left() {
    let mut studio = Studio::default();
    let others = meshes(&mut studio);
    let more = |count: usize| (others.0 + count, others.1 + count);
    let plant = |studio: &mut Studio, segments: usize| {
        studio.plant(limb(segments), Frusta::default(), Transform::IDENTITY)
    };
    // 20 and 19 joints share a mesh of 20; 41 joints need another.
    let first = plant(&mut studio, 19);
    let second = plant(&mut studio, 18);
    assert_eq!(meshes(&mut studio), more(1));
    let third = plant(&mut studio, 40);
    assert_eq!(meshes(&mut studio), more(2));
    studio.uproot(first);
    assert_eq!(meshes(&mut studio), more(2), "the second still has it");
    studio.uproot(second);
    assert_eq!(meshes(&mut studio), more(1));
    studio.world().entity_mut(third).remove::<Skeleton3d>();
    assert_eq!(meshes(&mut studio), others);
    // And comes anew with the next plant.
    plant(&mut studio, 19);
    assert_eq!(meshes(&mut studio), more(1));
}
