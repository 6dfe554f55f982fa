//! A limb of fur that bends at the knee.

use core::f32::consts::TAU;

use bevy::mesh::skinning::{SkinnedMesh, SkinnedMeshInverseBindposes};
use bevy::mesh::{Mesh, VertexAttributeValues};
use bevy::prelude::*;

use super::surfaces::lattice;

/// Where the knee is at rest.
const KNEE: Vec3 = Vec3::new(0.0, 1.1, 0.0);

/// Rings of vertices, and vertices of a ring.
const RINGS: u32 = 14;
const SIDES: u32 = 10;

/// The joint that bends.
#[derive(Component)]
pub struct Knee;

/// The limb at rest, upright on the ground, with the weights of two joints.
pub fn limb() -> Mesh {
    let ring = |row: u32| row as f32 / RINGS as f32;
    // A blunt end.
    let radius = |at: f32| (0.34 - 0.16 * at) * (1.0 - at.powi(10)).max(0.02).sqrt();
    let mesh = lattice(SIDES, RINGS, |column, row| {
        let turn = column as f32 / SIDES as f32 * TAU;
        let out = Vec3::new(turn.sin(), 0.0, turn.cos());
        let at = ring(row);
        let normal = (out + Vec3::Y * at.powi(6) * 3.0).normalize();
        (out * radius(at) + Vec3::Y * 2.2 * at, normal)
    });
    let rows = (0..=RINGS).flat_map(|row| (0..=SIDES).map(move |_| row));
    let weights = rows.map(|row| {
        let share = ((2.2 * ring(row) - KNEE.y) / 0.9 + 0.5).clamp(0.0, 1.0);
        let second = share * share * (3.0 - 2.0 * share);
        [1.0 - second, second, 0.0, 0.0]
    });
    let weights: Vec<[f32; 4]> = weights.collect();
    let joints = VertexAttributeValues::Uint16x4(vec![[0, 1, 0, 0]; weights.len()]);
    mesh.with_inserted_attribute(Mesh::ATTRIBUTE_JOINT_INDEX, joints)
        .with_inserted_attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT, weights)
}

/// The joints of the limb, where they are at rest.
pub fn joints(
    commands: &mut Commands,
    bindposes: &mut Assets<SkinnedMeshInverseBindposes>,
) -> SkinnedMesh {
    let hip = commands.spawn(Transform::IDENTITY).id();
    let knee = (Knee, Transform::from_translation(KNEE), ChildOf(hip));
    let knee = commands.spawn(knee).id();
    let poses = vec![Mat4::IDENTITY, Mat4::from_translation(-KNEE)];
    SkinnedMesh {
        inverse_bindposes: bindposes.add(SkinnedMeshInverseBindposes::from(poses)),
        joints: vec![hip, knee],
    }
}

/// Bends knees as time goes on.
pub fn bend_knees(time: Res<Time>, mut knees: Query<&mut Transform, With<Knee>>) {
    for mut knee in &mut knees {
        let angle = 0.9 * (2.0 * time.elapsed_secs()).cos();
        knee.rotation = Quat::from_rotation_z(-angle);
    }
}
