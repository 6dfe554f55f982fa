//! Texels that brushes stroke.

use bevy::mesh::VertexAttributeValues;
use bevy::prelude::*;
use bevy_verdure::lab::{Lens, Shot, Studio};
use bevy_verdure::prelude::*;

use super::uploads::{FACET, stats};
use super::{BACKGROUND, SIZE, lollies, unlit};

/// Bytes of the lawn's facets.
const ALL: usize = 2 * 16 * 16 * FACET;

const HAND: TexelBrush = TexelBrush {
    radius: 0.3,
    strength: 0.9,
};

/// Ground of so many squares along each side.
fn ground(squares: u32) -> Mesh {
    let plane = Plane3d::default().mesh().size(2.0, 2.0);
    let mut mesh = plane.subdivisions(squares - 1).build();
    if let Some(VertexAttributeValues::Float32x2(uvs)) = mesh.attribute_mut(Mesh::ATTRIBUTE_UV_0) {
        for uv in uvs.as_flattened_mut() {
            *uv *= 8.0;
        }
    }
    mesh
}

/// A lawn of 64 texels, 0.2 m tall.
fn lawn(studio: &mut Studio, recovery: f32) -> Entity {
    let world = studio.world();
    let mesh = world.resource_mut::<Assets<Mesh>>().add(ground(16));
    let surface = lollies(world, 0.2);
    let stroked = StrokedTexels { recovery };
    world.spawn((Mesh3d(mesh), surface, unlit(), stroked)).id()
}

/// From aslant above; what is to the right of the middle is on the right.
fn picture(studio: &mut Studio) -> Vec<u8> {
    studio.headless.step();
    let shot = Shot {
        eye: Vec3::new(0.0, 2.6, 2.6),
        at: Vec3::ZERO,
        lens: Lens::Perspective(0.7),
        size: SIZE,
    };
    studio.photograph(&shot, BACKGROUND).rgb_bytes()
}

/// Moves a brush over the left of the lawn, away from the eye. Gives it back, and what was written in the last frame.
fn stroke(studio: &mut Studio, brush: TexelBrush) -> (Entity, usize) {
    let at = |step: u8| Transform::from_xyz(-0.5, 0.05, 0.6 - 0.12 * f32::from(step));
    let hand = studio.world().spawn((brush, at(0))).id();
    let mut last = stats(studio).uploaded_bytes;
    for step in 1..=10 {
        studio.world().entity_mut(hand).insert(at(step));
        last = stats(studio).uploaded_bytes;
    }
    (hand, last)
}

/// The height vectors that a surface has of its own.
fn heights(studio: &mut Studio, surface: Entity) -> Option<Vec<Vec3>> {
    let heights = studio.world().get::<TexelHeights>(surface);
    heights.map(|heights| heights.0.clone())
}

#[test]
fn a_brush_combs_what_it_goes_over_and_nothing_else() {
    let mut studio = Studio::default();
    let surface = lawn(&mut studio, f32::INFINITY);
    let before = picture(&mut studio);
    let still = Transform::from_xyz(0.5, 0.05, 0.0);
    studio.world().spawn((HAND, still));
    studio.headless.step();
    assert_eq!(heights(&mut studio, surface), None, "it has not moved");

    let (_, last) = stroke(&mut studio, HAND);
    assert!(last > 0 && last < ALL / 2, "{last}");
    assert_eq!(stats(&mut studio).uploaded_bytes, 0, "it stands still");
    let combed = picture(&mut studio);
    let pixels = before.chunks_exact(3).zip(combed.chunks_exact(3));
    let changed = (0..)
        .zip(pixels)
        .filter(|(_, (before, combed))| before != combed);
    let (left, right): (Vec<u32>, Vec<u32>) = changed
        .map(|(i, _)| i % SIZE.x)
        .partition(|&x| x < SIZE.x / 2);
    println!("{} pixels changed", left.len());
    assert!(left.len() > 100, "{}", left.len());
    assert!(right.is_empty(), "{}", right.len());
    assert!(combed == picture(&mut studio), "it stays combed");
}

#[test]
fn what_is_combed_rises_again_to_where_it_was() {
    let mut studio = Studio::default();
    lawn(&mut studio, 0.4);
    let before = picture(&mut studio);
    let (hand, _) = stroke(&mut studio, HAND);
    assert!(picture(&mut studio) != before);
    studio.world().despawn(hand);
    assert!(stats(&mut studio).uploaded_bytes > 0);
    for _ in 0..40 {
        studio.headless.step();
    }
    assert_eq!(stats(&mut studio).uploaded_bytes, 0);
    assert!(picture(&mut studio) == before);
}

#[test]
fn brushes_that_are_nowhere_or_reach_nothing_comb_nothing() {
    let mut studio = Studio::default();
    let surface = lawn(&mut studio, 1.0);
    let without_mesh = lollies(studio.world(), 0.2);
    studio
        .world()
        .spawn((without_mesh, StrokedTexels::default()));
    for radius in [0.0, -0.3, f32::NAN, f32::INFINITY] {
        stroke(&mut studio, TexelBrush { radius, ..HAND });
        assert_eq!(heights(&mut studio, surface), None, "{radius}");
    }
    // From one side of the lawn to the other, by way of nowhere.
    let hand = studio.world().spawn(HAND).id();
    for x in [-3.0, f32::NAN, 3.0] {
        let at = Transform::from_xyz(x, 0.0, 0.0);
        studio.world().entity_mut(hand).insert(at);
        studio.headless.step();
        assert_eq!(heights(&mut studio, surface), None, "{x}");
    }
}

#[test]
fn height_vectors_of_the_entity_are_those_at_rest() {
    let mut studio = Studio::default();
    let surface = lawn(&mut studio, 0.1);
    let before = picture(&mut studio);
    let lean = vec![Vec3::new(0.05, 0.2, 0.0); 17 * 17];
    let own = TexelHeights(lean.clone());
    studio.world().entity_mut(surface).insert(own);
    let leaning = picture(&mut studio);
    let (hand, _) = stroke(&mut studio, HAND);
    assert!(heights(&mut studio, surface).is_some_and(|heights| heights != lean));
    studio.world().despawn(hand);
    for _ in 0..20 {
        studio.headless.step();
    }
    assert_eq!(heights(&mut studio, surface), Some(lean));
    assert!(picture(&mut studio) == leaning);
    // Without them, those of the mesh.
    let world = studio.world();
    world.entity_mut(surface).remove::<TexelHeights>();
    assert!(picture(&mut studio) == before);
    stroke(&mut studio, HAND);
    let combed = heights(&mut studio, surface).expect("a brush has moved some");
    assert!(combed.contains(&(Vec3::Y * 0.2)), "they were upright");
}

#[test]
fn a_mesh_of_other_vertices_is_stroked_anew() {
    let mut studio = Studio::default();
    let surface = lawn(&mut studio, f32::INFINITY);
    stroke(&mut studio, HAND);
    let world = studio.world();
    let mesh = world.get::<Mesh3d>(surface).unwrap().0.clone();
    let mut meshes = world.resource_mut::<Assets<Mesh>>();
    *meshes.get_mut(&mesh).unwrap() = ground(8);
    studio.headless.step();
    let upright = vec![Vec3::Y * 0.2; 9 * 9];
    assert_eq!(heights(&mut studio, surface), Some(upright.clone()));
    stroke(&mut studio, HAND);
    let combed = heights(&mut studio, surface).expect("it had some before");
    assert!(combed.len() == 9 * 9 && combed != upright);
    // One that is turned takes along what was combed.
    let turn = Quat::from_rotation_x(0.5);
    let mut turned = ground(8);
    for attribute in [Mesh::ATTRIBUTE_POSITION, Mesh::ATTRIBUTE_NORMAL] {
        if let Some(VertexAttributeValues::Float32x3(vectors)) = turned.attribute_mut(attribute) {
            for vector in vectors {
                *vector = (turn * Vec3::from(*vector)).to_array();
            }
        }
    }
    let mut meshes = studio.world().resource_mut::<Assets<Mesh>>();
    *meshes.get_mut(&mesh).unwrap() = turned;
    for _ in 0..3 {
        studio.headless.step();
    }
    let along = heights(&mut studio, surface).expect("it had some before");
    assert_eq!(along.len(), combed.len());
    for (along, combed) in along.iter().zip(&combed) {
        let turned = turn * *combed;
        assert!(along.distance(turned) < 1e-5, "{along} {turned}");
    }
}

/// Turned and larger, so that there and back rounds.
fn aslant() -> Transform {
    Transform::from_rotation(Quat::from_rotation_y(0.7)).with_scale(Vec3::splat(1.3))
}

#[test]
fn what_is_under_a_still_brush_stays_bit_by_bit() {
    let mut studio = Studio::default();
    let surface = lawn(&mut studio, f32::INFINITY);
    let lean = Vec3::new(0.05, 0.2, 0.03);
    let own = TexelHeights(vec![lean; 17 * 17]);
    let place = aslant();
    studio.world().entity_mut(surface).insert((own, place));
    let still = Vec3::new(0.6, 0.05, 0.0);
    let at = Transform::from_translation(still);
    studio.world().spawn((HAND, at));
    stroke(&mut studio, HAND);

    let combed = heights(&mut studio, surface).expect("it has its own");
    let mesh = ground(16);
    let positions = mesh.attribute(Mesh::ATTRIBUTE_POSITION);
    let positions = positions.and_then(VertexAttributeValues::as_float3);
    let positions = positions.expect("it has positions");
    let (mut held, mut moved) = (0, 0);
    for (&at, &height) in positions.iter().zip(&combed) {
        if place.transform_point(Vec3::from(at)).distance(still) < HAND.radius {
            assert_eq!(height, lean);
            held += 1;
        } else if height != lean {
            moved += 1;
        }
    }
    assert!(held > 0 && moved > 0, "{held} {moved}");
}

#[test]
fn what_no_brush_combs_has_no_height_vectors_of_its_own() {
    let mut studio = Studio::default();
    let surface = lawn(&mut studio, f32::INFINITY);
    studio.world().entity_mut(surface).insert(aslant());
    let weak = TexelBrush {
        strength: 0.0,
        ..HAND
    };
    stroke(&mut studio, weak);
    assert_eq!(heights(&mut studio, surface), None);
}

#[test]
fn what_is_written_while_a_surface_is_left_out_is_at_rest_then() {
    let mut studio = Studio::default();
    let surface = lawn(&mut studio, 0.1);
    let (hand, _) = stroke(&mut studio, HAND);
    studio.world().despawn(hand);
    studio.world().entity_mut(surface).remove::<StrokedTexels>();
    studio.headless.step();
    let lean = vec![Vec3::new(0.05, 0.2, 0.0); 17 * 17];
    let own = TexelHeights(lean.clone());
    studio.world().entity_mut(surface).insert(own);
    for _ in 0..3 {
        studio.headless.step();
    }
    let stroked = StrokedTexels { recovery: 0.1 };
    studio.world().entity_mut(surface).insert(stroked);
    for _ in 0..20 {
        studio.headless.step();
    }
    assert_eq!(heights(&mut studio, surface), Some(lean));
}
