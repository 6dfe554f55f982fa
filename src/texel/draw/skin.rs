//! Surfaces of skinned meshes: facets follow the joints, on the CPU, which chooses slices from them anyway.

use bevy::camera::primitives::Aabb;
use bevy::ecs::name::NameOrEntity;
use bevy::math::{Mat3, Mat4};
use bevy::mesh::skinning::{SkinnedMesh, SkinnedMeshInverseBindposes};
use bevy::mesh::{Mesh, VertexAttributeValues};
use bevy::platform::collections::HashSet;
use bevy::prelude::*;

use super::super::facet::Surface;
use super::component::{LiveTexels, TexelHeights, TexelSettings};
use super::library::{TexelAssets, TexelLibrary};
use super::source::SliceSource;
use super::surface_mesh::TexelSurfaceError;
use super::systems::{TexelDrawn, TexelSlices};

/// Which joints the vertices of a mesh follow, and how much.
pub(crate) struct Skin {
    joints: Vec<[u16; 4]>,
    weights: Vec<[f32; 4]>,
}

impl Skin {
    /// Of a mesh of so many vertices.
    pub(crate) fn of(mesh: &Mesh, vertices: usize) -> Result<Self, TexelSurfaceError> {
        let joints = mesh.attribute(Mesh::ATTRIBUTE_JOINT_INDEX);
        let weights = mesh.attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT);
        match (joints, weights) {
            (
                Some(VertexAttributeValues::Uint16x4(joints)),
                Some(VertexAttributeValues::Float32x4(weights)),
            ) if joints.len() == vertices && weights.len() == vertices => Ok(Self {
                joints: joints.clone(),
                weights: weights.clone(),
            }),
            _ => Err(TexelSurfaceError::NoSkin),
        }
    }

    /// Moves a completed surface, of which `matrices` are where joints have gone from rest.
    pub(crate) fn pose(
        &self,
        surface: &mut Surface,
        matrices: &[Mat4],
    ) -> Result<(), TexelSurfaceError> {
        for vertex in 0..surface.positions.len() {
            let mut matrix = Mat4::ZERO;
            for (&joint, weight) in self.joints[vertex].iter().zip(self.weights[vertex]) {
                if weight != 0.0 {
                    let moved = matrices.get(usize::from(joint));
                    let moved = moved.ok_or(TexelSurfaceError::MissingJoint {
                        vertex,
                        joint,
                        count: matrices.len(),
                    })?;
                    matrix += *moved * weight;
                }
            }
            let linear = Mat3::from_mat4(matrix);
            let (position, height) = (surface.positions[vertex], surface.heights[vertex]);
            surface.positions[vertex] = matrix.transform_point3(position);
            surface.heights[vertex] = linear * height;
            // As Bevy's, by the inverse transpose, here without the determinant: the length does not matter.
            let [x, y, z] = [linear.x_axis, linear.y_axis, linear.z_axis];
            let cofactors = Mat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
            let turned = cofactors * surface.normals[vertex] * linear.determinant().signum();
            surface.normals[vertex] = turned.normalize_or_zero();
            let is_finite = |value: Vec3| value.is_finite();
            if is_finite(position) && !is_finite(surface.positions[vertex])
                || is_finite(height) && !is_finite(surface.heights[vertex])
            {
                return Err(TexelSurfaceError::NotFinitePose { vertex });
            }
        }
        Ok(())
    }
}

/// Where the joints of a mesh have gone from rest, in the space of an entity.
fn matrices(
    skinned: &SkinnedMesh,
    bindposes: Option<&SkinnedMeshInverseBindposes>,
    joints: &Query<Ref<GlobalTransform>>,
    world_from_local: &GlobalTransform,
) -> Result<Vec<Mat4>, TexelSurfaceError> {
    let bindposes = bindposes.ok_or(TexelSurfaceError::NoBindposes)?;
    let local_from_world = world_from_local.to_matrix().inverse();
    if !local_from_world.is_finite() {
        return Err(TexelSurfaceError::FlatTransform);
    }
    let bound = skinned.joints.iter().zip(bindposes.iter()).enumerate();
    bound
        .map(|(joint, (&entity, bindpose))| {
            let transform = joints
                .get(entity)
                .map_err(|_| TexelSurfaceError::LostJoint { joint })?;
            Ok(local_from_world * transform.to_matrix() * *bindpose)
        })
        .collect()
}

/// A surface that follows joints.
type Skinned<'w> = (
    NameOrEntity,
    &'w TexelDrawn,
    &'w TexelSettings,
    Ref<'w, SkinnedMesh>,
    Ref<'w, GlobalTransform>,
    Option<Ref<'w, TexelHeights>>,
    Has<LiveTexels>,
    &'w mut SliceSource,
);

/// Lets facets of skinned meshes follow their joints, once these are where they are in this frame. A surface that cannot be
/// posed stays as it was, and tells why once.
pub(crate) fn follow_skins(
    mut library: ResMut<TexelLibrary>,
    assets: TexelAssets,
    bindposes: Option<Res<Assets<SkinnedMeshInverseBindposes>>>,
    joints: Query<Ref<GlobalTransform>>,
    mut surfaces: Query<Skinned>,
    mut slices: Query<&mut Aabb, With<TexelSlices>>,
    mut told: Local<HashSet<Entity>>,
) {
    let Some(bindposes) = bindposes else {
        return;
    };
    for (owner, drawn, settings, skinned, transform, heights, is_live, mut source) in &mut surfaces
    {
        let entity = owner.entity;
        let has_moved = |joint: &Entity| joints.get(*joint).is_ok_and(|joint| joint.is_changed());
        let is_as_before = !is_live
            && !source.is_changed()
            && !skinned.is_changed()
            && !transform.is_changed()
            && !heights.as_ref().is_some_and(|heights| heights.is_changed())
            && !bindposes.is_changed()
            && !told.contains(&entity)
            && !skinned.joints.iter().any(has_moved);
        if is_as_before {
            continue;
        }
        let key = drawn.geometry();
        let bindpose = bindposes.get(&skinned.inverse_bindposes);
        let posed = matrices(&skinned, bindpose, &joints, &transform)
            .and_then(|matrices| library.pose(key, heights.as_deref(), &matrices, &assets));
        match posed {
            Ok(posed) => {
                told.remove(&entity);
                let Some(geometry) = posed else {
                    continue;
                };
                let bounds = geometry.bounds_in_wind(settings.limited_flexibility());
                if source.follow(geometry, bounds) {
                    for child in source.slices {
                        if let Ok(mut seen) = slices.get_mut(child) {
                            seen.set_if_neq(bounds);
                        }
                    }
                }
            }
            // Its bind poses may be on their way.
            Err(TexelSurfaceError::NoBindposes) => {}
            Err(error) => {
                if told.insert(entity) {
                    error!("surface {owner}: its texels stay as they were: {error}");
                }
            }
        }
    }
    told.retain(|entity| surfaces.contains(*entity));
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two vertices, one that follows a joint alone, and one between two.
    fn skin() -> (Skin, Surface) {
        let skin = Skin {
            joints: vec![[1, 0, 0, 0], [0, 1, 9, 9]],
            weights: vec![[1.0, 0.0, 0.0, 0.0], [0.5, 0.5, 0.0, 0.0]],
        };
        let surface = Surface {
            positions: vec![Vec3::X, Vec3::Y],
            normals: vec![Vec3::new(0.6, 0.0, 0.8); 2],
            heights: vec![Vec3::Z * 2.0; 2],
            ..default()
        };
        (skin, surface)
    }

    #[test]
    fn vertices_go_with_their_joints_and_normals_stay_upright() {
        let (skin, mut surface) = skin();
        let stretched = Mat4::from_scale_rotation_translation(
            Vec3::new(1.0, 1.0, 3.0),
            Quat::IDENTITY,
            Vec3::new(0.0, 0.0, 5.0),
        );
        skin.pose(&mut surface, &[Mat4::IDENTITY, stretched])
            .unwrap();
        assert_eq!(
            surface.positions,
            [Vec3::new(1.0, 0.0, 5.0), Vec3::new(0.0, 1.0, 2.5)]
        );
        assert_eq!(surface.heights, [Vec3::Z * 6.0, Vec3::Z * 4.0]);
        // A plane's normal is across what lies in it, which the pose has moved.
        let in_plane = Vec3::new(0.8, 0.0, -0.6 * 3.0);
        assert!(surface.normals[0].dot(in_plane).abs() < 1e-6);
    }

    #[test]
    fn joints_that_are_missing_or_no_number_are_named() {
        let (skin, surface) = skin();
        let told = |matrices: &[Mat4]| {
            let error = skin.pose(&mut surface.clone(), matrices);
            error.unwrap_err().to_string()
        };
        assert!(told(&[Mat4::IDENTITY]).contains("joint 1 is not one of 1"));
        let broken = Mat4::from_translation(Vec3::NAN);
        assert!(told(&[Mat4::IDENTITY, broken]).contains("vertex 0 is posed to no number"));
    }
}
