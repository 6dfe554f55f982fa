//! Surfaces of skinned meshes.

use bevy::asset::RenderAssetUsages;
use bevy::mesh::skinning::{SkinnedMesh, SkinnedMeshInverseBindposes};
use bevy::mesh::{Indices, PrimitiveTopology, VertexAttributeValues};
use bevy::prelude::*;
use bevy_verdure::lab::Studio;
use bevy_verdure::texel::ATTRIBUTE_HEIGHT_VECTOR;

use super::{BACKGROUND, lollies, shot, unlit};

/// Squares of a strip along x, which is one long.
const SQUARES: usize = 4;

/// Places along and across the strip of all vertices.
fn vertices() -> impl Iterator<Item = (f32, f32)> {
    (0..=SQUARES).flat_map(|i| [0.0, 1.0].map(|across| (i as f32 / SQUARES as f32, across)))
}

const HEIGHT: Vec3 = Vec3::new(0.0, 0.4, 0.0);

/// A strip whose vertices are moved, and their height vectors.
fn strip(moved: impl Fn(Vec3) -> (Vec3, Vec3)) -> Mesh {
    let at = |(x, z): (f32, f32)| Vec3::new(x, 0.0, -z);
    let moved: Vec<_> = vertices().map(at).map(moved).collect();
    let uvs: Vec<[f32; 2]> = vertices().map(|(x, z)| [2.0 * x, 2.0 * z]).collect();
    let squares = (0..SQUARES as u16).map(|i| 2 * i);
    let triangles = squares.flat_map(|i| [i, i + 2, i + 3, i, i + 3, i + 1]);
    Mesh::new(
        PrimitiveTopology::TriangleList,
        RenderAssetUsages::default(),
    )
    .with_inserted_attribute(
        Mesh::ATTRIBUTE_POSITION,
        moved.iter().map(|(at, _)| *at).collect::<Vec<_>>(),
    )
    .with_inserted_attribute(
        ATTRIBUTE_HEIGHT_VECTOR,
        moved.iter().map(|(_, height)| *height).collect::<Vec<_>>(),
    )
    .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, uvs)
    .with_inserted_indices(Indices::U16(triangles.collect()))
}

/// How much of a vertex follows the second joint.
fn weight(at: Vec3) -> f32 {
    (2.0 * at.x - 0.5).clamp(0.0, 1.0)
}

/// The strip at rest, with two joints.
fn skinned_strip() -> Mesh {
    let weights = vertices().map(|(x, _)| weight(Vec3::X * x));
    let weights = weights.map(|second| [1.0 - second, second, 0.0, 0.0]);
    strip(|at| (at, HEIGHT))
        .with_inserted_attribute(
            Mesh::ATTRIBUTE_JOINT_INDEX,
            VertexAttributeValues::Uint16x4(vec![[0, 1, 0, 0]; 2 * (SQUARES + 1)]),
        )
        .with_inserted_attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT, weights.collect::<Vec<_>>())
}

/// Where the second joint is at rest.
const KNEE: Vec3 = Vec3::new(0.5, 0.0, 0.0);

fn spawn(studio: &mut Studio, mesh: Mesh, place: Transform) -> Entity {
    let world = studio.world();
    let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh);
    let surface = lollies(world, 1.0);
    world.spawn((Mesh3d(mesh), surface, unlit(), place)).id()
}

/// The strip on two joints, and these. Its own transform says nothing, as of all skinned meshes.
fn limb(studio: &mut Studio) -> (Entity, [Entity; 2]) {
    let place = Transform::from_xyz(3.0, -1.0, 2.0).with_rotation(Quat::from_rotation_y(1.0));
    let limb = spawn(studio, skinned_strip(), place);
    let world = studio.world();
    let hip = world.spawn(Transform::IDENTITY).id();
    let knee = Transform::from_translation(KNEE);
    let knee = world.spawn((knee, ChildOf(hip))).id();
    let bindposes = vec![Mat4::IDENTITY, Mat4::from_translation(-KNEE)];
    let bindposes = SkinnedMeshInverseBindposes::from(bindposes);
    let inverse_bindposes = world.resource_mut::<Assets<_>>().add(bindposes);
    let joints = vec![hip, knee];
    world.entity_mut(limb).insert(SkinnedMesh {
        inverse_bindposes,
        joints,
    });
    (limb, [hip, knee])
}

fn bend(studio: &mut Studio, knee: Entity) {
    let bent = Transform::from_translation(KNEE).with_rotation(Quat::from_rotation_z(0.7));
    studio.world().entity_mut(knee).insert(bent);
}

fn picture(studio: &mut Studio) -> Vec<u8> {
    studio.headless.step();
    let seen = shot(Vec3::new(1.6, 1.9, 1.4));
    studio.photograph(&seen, BACKGROUND).rgb_bytes()
}

/// Pixels that differ.
fn differ(a: &[u8], b: &[u8]) -> usize {
    let pixels = a.chunks_exact(3).zip(b.chunks_exact(3));
    pixels.filter(|(a, b)| a != b).count()
}

#[test]
fn facets_follow_the_joints_as_if_they_were_posed_by_hand() {
    let mut by_hand = Studio::default();
    let turn = Quat::from_rotation_z(0.7);
    let posed = strip(|at| {
        let share = weight(at);
        let turned = KNEE + turn * (at - KNEE);
        (at.lerp(turned, share), HEIGHT.lerp(turn * HEIGHT, share))
    });
    spawn(&mut by_hand, posed, Transform::IDENTITY);
    let expected = picture(&mut by_hand);

    let mut studio = Studio::default();
    let (limb, [hip, knee]) = limb(&mut studio);
    let at_rest = picture(&mut studio);
    bend(&mut studio, knee);
    let bent = picture(&mut studio);
    // Of 12,288 pixels, as many as lie where rounding to the 24th bit decides: by far less than a hundredth.
    let (moved, wrong) = (differ(&at_rest, &bent), differ(&expected, &bent));
    println!("{moved} pixels have moved, {wrong} are wrong");
    assert!(moved > 500, "{moved}");
    assert!(wrong < 20, "{wrong}");

    // A joint that is nowhere, or gone: all stays as it was, and goes on once it is back.
    let world = studio.world();
    let good = *world.get::<Transform>(knee).unwrap();
    world
        .entity_mut(knee)
        .insert(Transform::from_translation(Vec3::NAN));
    assert!(picture(&mut studio) == bent);
    let world = studio.world();
    world.entity_mut(knee).insert(good);
    let elsewhere = world.spawn(Transform::IDENTITY).id();
    world.despawn(elsewhere);
    let mut joints = world.get_mut::<SkinnedMesh>(limb).unwrap();
    joints.joints = vec![hip, elsewhere];
    assert!(picture(&mut studio) == bent);
    let straight = Transform::from_translation(KNEE);
    let world = studio.world();
    world.entity_mut(knee).insert(straight);
    let mut joints = world.get_mut::<SkinnedMesh>(limb).unwrap();
    joints.joints = vec![hip, knee];
    assert!(differ(&picture(&mut studio), &at_rest) < 20);
    // Without its joints a mesh is where its transform says.
    studio.world().entity_mut(limb).remove::<SkinnedMesh>();
    assert!(differ(&picture(&mut studio), &at_rest) > 500);
}
