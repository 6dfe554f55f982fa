//! A skeleton as a mesh: its surface in triangles, for collision, for export, and for comparison.

use bevy::asset::RenderAssetUsages;
use bevy::mesh::{Indices, Mesh, PrimitiveTopology};

use super::double::links::{joints_at_rest, links};
use super::links::LinkedSkeleton;
use super::polygons::{MeshError, MeshParts, MeshSettings, polygons};
use crate::skeleton::Skeleton;

impl Skeleton {
    /// The surface round the skeleton at rest in triangles: 16·4^m a segment at m subdivisions, besides caps. The same
    /// surface, texture coordinates and relief as frusta have; normals follow the triangles.
    ///
    /// ```
    /// # use bevy::math::Vec3;
    /// # use bevy_verdure::prelude::*;
    /// let mut post = Skeleton::builder();
    /// let foot = post.root(Vec3::ZERO, 0.1);
    /// post.joint(foot, Vec3::Y, 0.08);
    /// let mesh = post.build()?.to_mesh(&MeshSettings { subdivisions: 1, ends: Ends::Flat, ..Default::default() })?;
    /// // 64 of the segment, and 16 of each end.
    /// assert_eq!(mesh.indices().unwrap().len() / 3, 64 + 2 * 16);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// When there would be more vertices than 32-bit indices reach.
    pub fn to_mesh(&self, settings: &MeshSettings) -> Result<Mesh, MeshError> {
        Ok(self.to_mesh_parts(settings)?.into())
    }

    /// The same in plain arrays, with the segments that the vertices move with.
    ///
    /// # Errors
    /// When there would be more vertices than 32-bit indices reach.
    pub fn to_mesh_parts(&self, settings: &MeshSettings) -> Result<MeshParts, MeshError> {
        let linked = LinkedSkeleton::new(self);
        let shapes = linked.shapes.iter();
        let v_ranges: Vec<_> = shapes
            .map(|shape| [f64::from(shape.v_start), f64::from(shape.v_end)])
            .collect();
        polygons(
            &links(self),
            &joints_at_rest(self),
            &v_ranges,
            |i| linked.references[i].as_dvec3(),
            settings,
        )
    }
}

impl From<MeshParts> for Mesh {
    fn from(parts: MeshParts) -> Self {
        Mesh::new(
            PrimitiveTopology::TriangleList,
            RenderAssetUsages::default(),
        )
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, parts.positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, parts.normals)
        .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, parts.uvs)
        .with_inserted_indices(Indices::U32(parts.indices))
    }
}
