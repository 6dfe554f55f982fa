//! From a Bevy mesh to the facets of a surface.

use bevy::math::{Vec2, Vec3};
use bevy::mesh::{Mesh, MeshVertexAttribute, VertexAttributeValues};
use thiserror::Error;

use super::super::facet::{Surface, SurfaceError};
use super::super::from_mesh::{ShapeMeshError, triangles};
use super::component::ATTRIBUTE_HEIGHT_VECTOR;

/// Why a mesh carries no texels at all.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum TexelSurfaceError {
    /// The mesh cannot be read.
    #[error(transparent)]
    Mesh(#[from] ShapeMeshError),
    /// It is read, but is no surface for texels.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// The length of height vectors is none.
    #[error("the thickness of the texels is {0}: give it a finite length greater than 0")]
    Thickness(f32),
}

/// The surface of a mesh.
pub(crate) fn surface(mesh: &Mesh) -> Result<Surface, ShapeMeshError> {
    let vectors = |attribute: MeshVertexAttribute, name| -> Result<Vec<Vec3>, ShapeMeshError> {
        let Some(values) = mesh.try_attribute_option(attribute)? else {
            return Ok(Vec::new());
        };
        let values = values.as_float3().ok_or(ShapeMeshError::Format(name))?;
        Ok(values.iter().copied().map(Vec3::from).collect())
    };
    let uvs: Vec<Vec2> = match mesh.try_attribute_option(Mesh::ATTRIBUTE_UV_0)? {
        Some(VertexAttributeValues::Float32x2(uvs)) => {
            uvs.iter().copied().map(Vec2::from).collect()
        }
        Some(_) => return Err(ShapeMeshError::Format("texture coordinates")),
        None => Vec::new(),
    };
    let positions = vectors(Mesh::ATTRIBUTE_POSITION, "positions")?;
    Ok(Surface {
        normals: vectors(Mesh::ATTRIBUTE_NORMAL, "normals")?,
        uvs,
        heights: vectors(ATTRIBUTE_HEIGHT_VECTOR, "height vectors")?,
        triangles: triangles(mesh, positions.len())?,
        positions,
    })
}
