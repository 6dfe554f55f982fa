//! What is read of a model, as Bevy has it, and what methods take of that.

use core::fmt::{self, Debug, Formatter};

use bevy::asset::Assets;
use bevy::image::Image;
use bevy::math::Mat4;
use bevy::mesh::Mesh;
use bevy::pbr::StandardMaterial;

use crate::slicing::{BakeError, CrownMaterial, CrownMesh};
use crate::texel::build::Shape;

/// A model that was read.
#[derive(Default)]
pub struct Model {
    /// All that its scene draws.
    pub parts: Vec<ModelPart>,
    /// The textures that its materials name.
    pub images: Assets<Image>,
}

/// A part of a model: all that one node draws with one material.
#[derive(Clone, Debug)]
pub struct ModelPart {
    /// Name of the mesh; empty where it has none.
    pub mesh: String,
    /// Name of the material; empty where it has none.
    pub material: String,
    /// Its triangles, in the model's space.
    pub triangles: Mesh,
    /// Base colour, its texture with where that lies, and what alpha does.
    pub surface: StandardMaterial,
}

impl Debug for Model {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let mut model = f.debug_struct("Model");
        model.field("parts", &self.parts).finish_non_exhaustive()
    }
}

impl ModelPart {
    /// How many triangles it has.
    pub fn triangle_count(&self) -> usize {
        let indices = self.triangles.indices();
        indices.map_or(0, |indices| indices.len() / 3)
    }
}

impl Model {
    /// The parts of which `is_wanted` is true, to be baked into a slicing.
    ///
    /// # Errors
    /// When one lies too far from the origin; the message names its mesh.
    pub fn crown(&self, is_wanted: impl Fn(&ModelPart) -> bool) -> Result<CrownMesh, String> {
        let mut crown = CrownMesh::default();
        for part in self.parts.iter().filter(|part| is_wanted(part)) {
            let added = self.crown_of(part).map_err(|error| error.to_string())?;
            crown.append(&added, Mat4::IDENTITY);
        }
        Ok(crown)
    }

    fn crown_of(&self, part: &ModelPart) -> Result<CrownMesh, BakeError> {
        let mut crown = CrownMesh::default();
        let material = CrownMaterial::from_standard(&part.mesh, &part.surface, &self.images)?;
        let material = crown.add_material(material);
        crown.add_mesh(&part.mesh, &part.triangles, Mat4::IDENTITY, material)?;
        Ok(crown)
    }

    /// All of it, to be built into a volume: glTF's y is its height, w, and −z is v.
    ///
    /// # Errors
    /// As [`Shape::add_mesh`], which takes all that [`load_model`](crate::lab::load_model) reads; the message names the
    /// mesh.
    pub fn shape(&self) -> Result<Shape, String> {
        let mut shape = Shape::default();
        for part in &self.parts {
            shape
                .add_mesh(&part.triangles, &part.surface, &self.images)
                .map_err(|error| format!("mesh `{}`: {error}", part.mesh))?;
        }
        Ok(shape)
    }
}
