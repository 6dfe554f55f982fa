//! A skeleton as a mesh that bends: each vertex moves with its segment, one on a cut with both.

use bevy::math::{Mat4, Vec3};
use bevy::mesh::skinning::SkinnedMeshInverseBindposes;
use bevy::mesh::{Mesh, VertexAttributeValues};

use super::polygons::{MeshError, MeshParts, MeshSettings};
use crate::skeleton::Skeleton;

/// How many segments a skinned mesh may have: Bevy's indices of a vertex's joints have 16 bits.
pub const MAX_SKINNED_SEGMENTS: usize = 1 << 16;

impl Skeleton {
    /// The same mesh as [`to_mesh`](Self::to_mesh), with a skin: it bends with the segments of an unfolded plant.
    ///
    /// The k-th joint of the skin is the k-th segment of
    /// [`SegmentEntities::iter`](crate::skeleton::SegmentEntities::iter). As with any skin, the entity's own transform
    /// moves nothing.
    ///
    /// ```
    /// # use bevy::prelude::*;
    /// # use bevy::camera::visibility::DynamicSkinnedMeshBounds;
    /// # use bevy::mesh::skinning::{SkinnedMesh, SkinnedMeshInverseBindposes};
    /// # use bevy_verdure::prelude::*;
    /// /// Gives each plant that is unfolded a mesh that follows it.
    /// fn clothe(
    ///     mut commands: Commands,
    ///     plants: Query<(Entity, &Skeleton3d, &SegmentEntities), Added<SegmentEntities>>,
    ///     skeletons: Res<Assets<Skeleton>>,
    ///     mut meshes: ResMut<Assets<Mesh>>,
    ///     mut bindposes: ResMut<Assets<SkinnedMeshInverseBindposes>>,
    ///     mut materials: ResMut<Assets<StandardMaterial>>,
    /// ) -> Result {
    ///     for (plant, skeleton, segments) in &plants {
    ///         let Some(skeleton) = skeletons.get(&skeleton.0) else { continue };
    ///         let (mesh, inverse_bindposes) = skeleton.to_skinned_mesh(&MeshSettings::default())?;
    ///         commands.spawn((
    ///             Mesh3d(meshes.add(mesh)),
    ///             MeshMaterial3d(materials.add(Color::WHITE)),
    ///             SkinnedMesh {
    ///                 inverse_bindposes: bindposes.add(inverse_bindposes),
    ///                 joints: segments.iter().map(|(_, segment)| segment).collect(),
    ///             },
    ///             // What is culled follows as well.
    ///             DynamicSkinnedMeshBounds,
    ///             ChildOf(plant),
    ///         ));
    ///     }
    ///     Ok(())
    /// }
    /// ```
    ///
    /// At a bend of θ the ring of a cut is half way between where both segments would have it, cos(θ/2) as wide across
    /// the bend, where a mitre's is 1/cos(θ/2) as wide: 4 % less at 15°. Relief is that of the skeleton at rest.
    ///
    /// Where skins are in uniform buffers, on devices without storage buffers for the vertex stage, such as WebGL 2,
    /// Bevy draws no more than 256 joints a mesh ([`bevy::pbr::MAX_JOINTS`]), and is not asked here which device it is
    /// for. A larger plant can be divided into skeletons of its limbs.
    ///
    /// # Errors
    /// As [`to_mesh`](Self::to_mesh), and when there are more than [`MAX_SKINNED_SEGMENTS`] segments.
    pub fn to_skinned_mesh(
        &self,
        settings: &MeshSettings,
    ) -> Result<(Mesh, SkinnedMeshInverseBindposes), MeshError> {
        let segments = self.segment_count();
        if segments > MAX_SKINNED_SEGMENTS {
            return Err(MeshError::TooManyJoints { segments });
        }
        let parts = self.to_mesh_parts(settings)?;
        let (starts, skin) = (self.segment_starts(), Skin::new(self, &parts));
        let inverse: Vec<_> = starts.map(|start| Mat4::from_translation(-start)).collect();
        let mut mesh = Mesh::from(parts)
            .with_inserted_attribute(
                Mesh::ATTRIBUTE_JOINT_INDEX,
                VertexAttributeValues::Uint16x4(skin.joints),
            )
            .with_inserted_attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT, skin.weights);
        // Fails for a mesh without vertices alone, which has no bounds.
        let _ = mesh.generate_skinned_mesh_bounds();
        Ok((mesh, inverse.into()))
    }

    /// Where each segment starts at rest, which is the origin of its frame when the plant is unfolded; its axes are
    /// the plant's.
    fn segment_starts(&self) -> impl Iterator<Item = Vec3> {
        let joints = self.joints();
        let parents = joints.iter().filter_map(|joint| joint.parent);
        parents.map(|parent| joints[parent as usize].position)
    }
}

/// What moves each vertex.
struct Skin {
    joints: Vec<[u16; 4]>,
    weights: Vec<[f32; 4]>,
}

impl Skin {
    fn new(skeleton: &Skeleton, parts: &MeshParts) -> Self {
        let mut count = 0;
        // The place of each joint's segment among segments; roots end none, and no vertex moves with them.
        let places: Vec<u16> = skeleton
            .joints()
            .iter()
            .map(|joint| {
                let place = count;
                count += usize::from(joint.parent.is_some());
                place as u16
            })
            .collect();
        let place = |joint: u32| places[joint as usize];
        let owners = parts.segments.iter().zip(&parts.neighbours);
        let (joints, weights) = owners
            .map(|(&own, &other)| match own == other {
                true => ([place(own), 0, 0, 0], [1.0, 0.0, 0.0, 0.0]),
                false => ([place(own), place(other), 0, 0], [0.5, 0.5, 0.0, 0.0]),
            })
            .unzip();
        Self { joints, weights }
    }
}
