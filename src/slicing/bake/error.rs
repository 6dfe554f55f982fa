//! Why a crown cannot be baked, and what to do about it.

use bevy::math::Vec3;
use thiserror::Error;

use super::source::MAX_COORDINATE;
use crate::slicing::limits::{MAX_LAYERS, MAX_PIXELS_TOTAL};

/// Why triangles make no [`Slicing`](crate::slicing::Slicing). Triangles are counted from 0 in the order given.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum BakeError {
    /// There are no triangles.
    #[error("there are no triangles: add the mesh of the crown's twigs and leaves")]
    NoTriangles,
    /// All triangles are degenerate.
    #[error("no triangle has an area: check the scale of the mesh")]
    NoArea,
    /// A position is not finite or too far out.
    #[error(
        "triangle {triangle}: position {position} is not finite or more than {MAX_COORDINATE} m from the origin \
         along an axis: correct the mesh, or move it near its origin"
    )]
    Position {
        /// Which triangle.
        triangle: usize,
        /// The position.
        position: Vec3,
    },
    /// A normal, texture coordinate or colour is not finite.
    #[error(
        "triangle {triangle}: a normal, texture coordinate or colour is not finite: correct the mesh"
    )]
    Attribute {
        /// Which triangle.
        triangle: usize,
    },
    /// A number of a material is not finite.
    #[error(
        "material {material}, counted from 0: its colour, cutoff or texture transform is not finite: correct it"
    )]
    Material {
        /// Which material.
        material: usize,
    },
    /// A mesh cannot be baked.
    #[error("mesh `{mesh}`: {error}")]
    Mesh {
        /// The mesh's name.
        mesh: String,
        /// Why.
        error: Box<Self>,
    },
    /// Indices make no triangles.
    #[error("mesh `{mesh}` has {count} indices, no multiple of 3: give it three for each triangle")]
    IndexCount {
        /// The mesh's name.
        mesh: String,
        /// How many it has, or vertices where it has none.
        count: usize,
    },
    /// A triangle names a material that is not there.
    #[error(
        "triangle {triangle}: material {material} is not one of the {count} there are, counted from 0: add it before \
         baking"
    )]
    MissingMaterial {
        /// Which triangle.
        triangle: usize,
        /// The material it names.
        material: u32,
        /// How many there are.
        count: usize,
    },
    /// The mesh is not one of triangles.
    #[error("mesh `{mesh}` is one of {topology}: give a list of triangles")]
    Topology {
        /// The mesh's name.
        mesh: String,
        /// What it is.
        topology: &'static str,
    },
    /// The mesh lacks an attribute.
    #[error("mesh `{mesh}` has no {attribute} that can be read: {fix}")]
    MissingAttribute {
        /// The mesh's name.
        mesh: String,
        /// What it lacks.
        attribute: &'static str,
        /// What to do.
        fix: &'static str,
    },
    /// An index points behind the last vertex.
    #[error(
        "mesh `{mesh}`: triangle {triangle} names vertex {vertex} of {count}: correct the index buffer"
    )]
    Index {
        /// The mesh's name.
        mesh: String,
        /// Which triangle.
        triangle: usize,
        /// The vertex it names.
        vertex: usize,
        /// How many there are.
        count: usize,
    },
    /// A texture that a material names is not loaded.
    #[error(
        "mesh `{mesh}`: its base colour texture is missing: wait until it is loaded, or correct its path"
    )]
    MissingTexture {
        /// The mesh's name.
        mesh: String,
    },
    /// A texture's pixels cannot be read.
    #[error(
        "a texture cannot be read ({message}): give it an uncompressed format of 8 bits, and keep it in the main \
         world"
    )]
    Image {
        /// What Bevy said.
        message: String,
    },
    /// A texture has not the pixels that its size asks for.
    #[error(
        "a texture of {width} × {height} has {pixels} pixels: give it width × height, at least one"
    )]
    TextureSize {
        /// Pixels along u.
        width: u32,
        /// Pixels along v.
        height: u32,
        /// How many were given.
        pixels: usize,
    },
    /// A setting is out of range.
    #[error("setting `{setting}` is {value}: {fix}")]
    Setting {
        /// Its name.
        setting: &'static str,
        /// What it is.
        value: String,
        /// What it may be.
        fix: &'static str,
    },
    /// The slices would take too much memory.
    #[error(
        "{layers} slices of {pixels} × {pixels} pixels are too many: use fewer orientations, slices or levels of \
         detail, {MAX_LAYERS} slices at most, or fewer pixels, {MAX_PIXELS_TOTAL} at most in all slices together"
    )]
    TooLarge {
        /// Slices of all orientations and levels together.
        layers: usize,
        /// Pixels along each side of a slice.
        pixels: u32,
    },
}

impl BakeError {
    /// The same of a mesh by its name.
    pub(super) fn of_mesh(self, mesh: &str) -> Self {
        Self::Mesh {
            mesh: mesh.into(),
            error: Box::new(self),
        }
    }
}
