//! From a Bevy mesh to the facets of a surface.

use bevy::mesh::Mesh;
use thiserror::Error;

use super::super::facet::{Surface, SurfaceError};
use super::super::from_mesh::{ShapeMeshError, positions, triangles, uvs, vectors};
use super::component::ATTRIBUTE_HEIGHT_VECTOR;
use super::records::FacetRecord;

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
    /// There are more facets than the device's buffers hold.
    #[error(
        "it has {facets} triangles, of which a storage buffer of this device holds {most}, at {} bytes each: split the mesh \
         into several, on an entity each",
        size_of::<FacetRecord>()
    )]
    TooManyFacets {
        /// How many triangles the mesh has.
        facets: usize,
        /// How many there may be.
        most: usize,
    },
    /// The mesh of a `SkinnedMesh` says nothing of joints.
    #[error(
        "it has a SkinnedMesh, but its mesh has no joints: give it ATTRIBUTE_JOINT_INDEX (Uint16x4) and \
         ATTRIBUTE_JOINT_WEIGHT (Float32x4) for each vertex, or remove the SkinnedMesh"
    )]
    NoSkin,
    /// The bind poses of a `SkinnedMesh` are not loaded.
    #[error("the inverse bind poses of its SkinnedMesh are not loaded: wait for them")]
    NoBindposes,
    /// A joint of a `SkinnedMesh` is not there.
    #[error(
        "joint {joint} of its SkinnedMesh has no GlobalTransform: keep the entity, or list another one"
    )]
    LostJoint {
        /// Its place in the list of joints.
        joint: usize,
    },
    /// A vertex follows a joint that is not there.
    #[error(
        "vertex {vertex}: joint {joint} is not one of {count}: give the SkinnedMesh as many joints and bind poses"
    )]
    MissingJoint {
        /// The vertex.
        vertex: usize,
        /// The joint that it names.
        joint: u16,
        /// How many there are.
        count: usize,
    },
    /// A joint is nowhere.
    #[error(
        "vertex {vertex} is posed to no number: correct the transforms of the joints that it follows"
    )]
    NotFinitePose {
        /// The vertex.
        vertex: usize,
    },
    /// The surface's own transform cannot be undone.
    #[error(
        "its own transform has a scale of zero, or is no number: skinned surfaces need one that can be undone"
    )]
    FlatTransform,
}

/// The surface of a mesh.
pub(crate) fn surface(mesh: &Mesh) -> Result<Surface, ShapeMeshError> {
    let positions = positions(mesh)?;
    let or_none = |attribute, name| {
        let found = vectors(mesh, attribute, name)?;
        Ok::<_, ShapeMeshError>(found.unwrap_or_default())
    };
    Ok(Surface {
        normals: or_none(Mesh::ATTRIBUTE_NORMAL, "normals")?,
        uvs: uvs(mesh)?,
        heights: or_none(ATTRIBUTE_HEIGHT_VECTOR, "height vectors")?,
        triangles: triangles(mesh, positions.len())?,
        positions,
    })
}
