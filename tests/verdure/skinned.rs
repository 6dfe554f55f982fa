//! Skinned meshes: that they are the mesh at rest, and go with the segments of an unfolded plant.

use core::f32::consts::FRAC_PI_6;

use bevy::camera::visibility::DynamicSkinnedMeshBounds;
use bevy::math::Affine3A;
use bevy::mesh::VertexAttributeValues;
use bevy::mesh::skinning::{SkinnedMesh, SkinnedMeshInverseBindposes};
use bevy::prelude::*;
use bevy_verdure::frusta::{MAX_SKINNED_SEGMENTS, MeshParts};
use bevy_verdure::lab::{Lens, Shot, Studio};
use bevy_verdure::prelude::*;

/// Positions are of a few metres, moved by a few products and sums in single precision.
const ROUNDING: f32 = 1e-5;

/// Two limbs from two roots, one with a branch: places of segments and of joints differ.
fn fork() -> Skeleton {
    let mut plant = Skeleton::builder();
    let root = plant.root(Vec3::new(0.3, 0.0, 0.1), 0.3);
    let knee = plant.joint(root, Vec3::new(0.3, 1.0, 0.1), 0.25);
    plant.joint(knee, Vec3::new(0.4, 2.0, 0.1), 0.2);
    plant.joint(knee, Vec3::new(1.1, 1.6, 0.1), 0.12);
    let root = plant.root(Vec3::new(-1.0, 0.0, 0.0), 0.2);
    let knee = plant.joint(root, Vec3::new(-1.0, 0.8, 0.0), 0.2);
    plant.joint(knee, Vec3::new(-1.1, 1.7, 0.2), 0.15);
    plant.build().unwrap()
}

const SETTINGS: MeshSettings = MeshSettings {
    subdivisions: 1,
    join: Join::Mitre,
    ends: Ends::Round,
    relief: None,
    continuous_u: true,
    close_branches: false,
};

/// A plant, unfolded, in a studio.
struct Unfolded {
    studio: Studio,
    plant: Entity,
    skeleton: Skeleton,
}

impl Unfolded {
    fn new(skeleton: Skeleton, transform: Transform) -> Self {
        let mut studio = Studio::default();
        let plant = studio.plant(skeleton.clone(), Frusta::default(), transform);
        studio.world().entity_mut(plant).insert(UnfoldSkeleton);
        studio.headless.step();
        Self {
            studio,
            plant,
            skeleton,
        }
    }

    fn segments(&mut self) -> Vec<(usize, Entity)> {
        let world = self.studio.world();
        let segments = world.get::<SegmentEntities>(self.plant).unwrap();
        segments.iter().collect()
    }

    fn turn(&mut self, joint: usize, rotation: Quat) {
        let segments = self.segments();
        let (_, segment) = segments.iter().find(|(i, _)| *i == joint).unwrap();
        let world = self.studio.world();
        world.get_mut::<Transform>(*segment).unwrap().rotation = rotation;
        self.studio.headless.step();
    }

    /// The vertices in world space, as the skin puts them.
    fn skinned(&mut self) -> Vec<Vec3> {
        let (mesh, inverse) = self.skeleton.to_skinned_mesh(&SETTINGS).unwrap();
        let segments = self.segments();
        assert_eq!(segments.len(), inverse.len());
        let world = self.studio.world();
        let matrices: Vec<Mat4> = segments
            .iter()
            .zip(inverse.iter())
            .map(|((_, segment), inverse)| {
                world.get::<GlobalTransform>(*segment).unwrap().to_matrix() * *inverse
            })
            .collect();
        let joints = match mesh.attribute(Mesh::ATTRIBUTE_JOINT_INDEX) {
            Some(VertexAttributeValues::Uint16x4(joints)) => joints,
            other => panic!("indices of joints are {other:?}"),
        };
        let weights = match mesh.attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT) {
            Some(VertexAttributeValues::Float32x4(weights)) => weights,
            other => panic!("weights are {other:?}"),
        };
        let positions = mesh.attribute(Mesh::ATTRIBUTE_POSITION).unwrap();
        let positions = positions.as_float3().unwrap();
        let vertices = positions.iter().zip(joints).zip(weights);
        vertices
            .map(|((position, joints), weights)| {
                assert_eq!(weights.iter().sum::<f32>(), 1.0);
                let moved = joints.iter().zip(weights).map(|(joint, weight)| {
                    *weight * matrices[*joint as usize].transform_point3((*position).into())
                });
                moved.sum()
            })
            .collect()
    }

    fn parts(&self) -> MeshParts {
        self.skeleton.to_mesh_parts(&SETTINGS).unwrap()
    }
}

fn assert_near(is: Vec3, expected: Vec3, what: &str) {
    assert!(is.distance(expected) < ROUNDING, "{what}: {is}, {expected}");
}

#[test]
fn at_rest_a_skinned_mesh_is_the_mesh_where_the_plant_stands() {
    let place = Transform::from_xyz(1.0, 0.5, -2.0)
        .with_rotation(Quat::from_rotation_y(0.8))
        .with_scale(Vec3::splat(1.5));
    let mut plant = Unfolded::new(fork(), place);
    let parts = plant.parts();
    for (is, at_rest) in plant.skinned().into_iter().zip(&parts.positions) {
        let expected = place.transform_point((*at_rest).into());
        assert_near(is, expected, "a vertex");
    }
}

#[test]
fn vertices_move_rigidly_with_their_segment_and_those_of_a_cut_stay_half_way() {
    let mut plant = Unfolded::new(fork(), Transform::IDENTITY);
    let turn = Quat::from_rotation_z(FRAC_PI_6);
    // The second segment of the first limb turns about its start; nothing hangs on it.
    let turned = 2;
    let start = plant.skeleton.joints()[1].position;
    let rigid = Affine3A::from_translation(start)
        * Affine3A::from_quat(turn)
        * Affine3A::from_translation(-start);
    plant.turn(turned, turn);
    let parts = plant.parts();
    let (mut alone, mut shared) = (0, 0);
    for (i, is) in plant.skinned().into_iter().enumerate() {
        let rest = Vec3::from(parts.positions[i]);
        let owners = [parts.segments[i], parts.neighbours[i]];
        let moving = owners.iter().filter(|&&own| own == turned as u32).count();
        let expected = [
            rest,
            rest.midpoint(rigid.transform_point3(rest)),
            rigid.transform_point3(rest),
        ];
        assert_near(is, expected[moving], "a vertex");
        alone += usize::from(moving == 2);
        shared += usize::from(moving == 1);
    }
    // One ring at the cut, of 16 quads and so 17 vertices.
    assert_eq!(shared, 17);
    assert!(alone > 100, "{alone}");
}

#[test]
fn more_segments_than_a_skin_has_joints_are_told_of() {
    let mut plant = Skeleton::builder();
    let root = plant.root(Vec3::ZERO, 0.1);
    for i in 0..=MAX_SKINNED_SEGMENTS {
        plant.joint(root, Vec3::new(i as f32, 1.0, 0.0), 0.1);
    }
    let error = plant.build().unwrap().to_skinned_mesh(&SETTINGS).err();
    let message = error.unwrap().to_string();
    assert!(message.contains("65537"), "{message}");
}

#[test]
fn a_bent_skinned_mesh_is_drawn_where_the_bent_frusta_are() {
    let mut plant = Unfolded::new(fork(), Transform::from_rotation(Quat::from_rotation_y(0.3)));
    for joint in [1, 2, 3, 6] {
        plant.turn(joint, Quat::from_rotation_z(0.25));
    }
    let shot = Shot::framing(
        Vec3::new(-1.8, 0.0, -0.5),
        Vec3::new(1.2, 2.2, 0.5),
        Lens::Perspective(0.7),
        UVec2::new(160, 120),
    );
    // Frusta are drawn as good as black, the mesh is red.
    let covered = |studio: &mut Studio, red: bool| {
        let pixels = studio.photograph(&shot, Color::WHITE).rgb_bytes();
        let covered = pixels.chunks(3);
        covered
            .map(|pixel| pixel[1] < 128 && (pixel[0] > 128) == red)
            .collect::<Vec<_>>()
    };
    let frusta = covered(&mut plant.studio, false);
    let settings = MeshSettings {
        subdivisions: 3,
        ..SETTINGS
    };
    let (mesh, inverse) = plant.skeleton.to_skinned_mesh(&settings).unwrap();
    let joints = plant
        .segments()
        .iter()
        .map(|(_, segment)| *segment)
        .collect();
    let world = plant.studio.world();
    let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh);
    let mut bindposes = world.resource_mut::<Assets<SkinnedMeshInverseBindposes>>();
    let inverse_bindposes = bindposes.add(inverse);
    let mut materials = world.resource_mut::<Assets<StandardMaterial>>();
    let material = materials.add(StandardMaterial {
        base_color: Color::srgb(1.0, 0.0, 0.0),
        unlit: true,
        ..default()
    });
    world.spawn((
        Mesh3d(mesh),
        MeshMaterial3d(material),
        SkinnedMesh {
            inverse_bindposes,
            joints,
        },
        DynamicSkinnedMeshBounds,
    ));
    // Frusta hide; their segments, which lead the mesh, do not.
    let world = plant.studio.world();
    world
        .entity_mut(plant.plant)
        .remove::<MeshMaterial3d<FrustaMaterial>>();
    plant.studio.headless.step();
    let polygons = covered(&mut plant.studio, true);
    let count = |covered: &[bool]| covered.iter().filter(|c| **c).count();
    let pairs = frusta.iter().zip(&polygons);
    let different = pairs.filter(|(one, other)| one != other).count();
    assert!(count(&frusta) > 1000, "{} pixels of plant", count(&frusta));
    // Cuts are narrower by 1 − cos²(0.125) = 1.6 % of a limb some 17 pixels wide, and outlines 600 pixels long are
    // drawn by 64 sides, off by 0.01 pixels: a pixel in twenty of the outline may fall on the other side.
    assert!(different < 30, "{different} pixels differ");
}
