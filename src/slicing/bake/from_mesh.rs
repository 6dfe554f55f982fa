//! Crowns from Bevy's meshes and materials.

use bevy::asset::Assets;
use bevy::color::{ColorToComponents, LinearRgba};
use bevy::image::Image;
use bevy::math::{Mat4, Vec2, Vec3};
use bevy::mesh::{Mesh, PrimitiveTopology, UvChannel, VertexAttributeValues};
use bevy::pbr::StandardMaterial;
use bevy::prelude::AlphaMode;

use super::error::BakeError;
use super::source::{CrownMaterial, CrownMesh, CrownTriangle, CrownVertex};
use super::texture::CrownTexture;

impl CrownMaterial {
    /// What a crown takes of a standard material: base colour, its texture and where that lies, its alpha mode, and its
    /// diffuse transmission. `mesh` names it in errors.
    ///
    /// # Errors
    /// When the texture is not among `images`, or cannot be read.
    pub fn from_standard(
        mesh: &str,
        material: &StandardMaterial,
        images: &Assets<Image>,
    ) -> Result<Self, BakeError> {
        let texture = match &material.base_color_texture {
            None => None,
            Some(handle) => {
                let image = images
                    .get(handle)
                    .ok_or_else(|| BakeError::MissingTexture { mesh: mesh.into() })?;
                Some(CrownTexture::from_image(image).map_err(|error| error.of_mesh(mesh))?)
            }
        };
        Ok(Self {
            color: LinearRgba::from(material.base_color).to_f32_array(),
            texture,
            uv_transform: material.uv_transform,
            uv_channel: material.base_color_channel.clone(),
            opaque: material.alpha_mode == AlphaMode::Opaque,
            cutoff: match material.alpha_mode {
                // A mask at 0 lets everything through, as no mask does.
                AlphaMode::Mask(at) => at,
                _ => 0.0,
            },
            diffuse_transmission: material.diffuse_transmission,
        })
    }
}

impl CrownMesh {
    /// Adds a Bevy mesh, moved by `transform`, with a material of this crown. `name` names it in errors.
    ///
    /// A mesh without indices is a list of triangles; without normals it is flat-shaded; texture coordinates may be
    /// missing where the material has no texture, and vertex colours always.
    ///
    /// # Errors
    /// When the mesh is not one of triangles, is not kept in the main world, lacks positions or needed texture coordinates,
    /// its indices make no triangles or point behind its vertices, or a number is not finite or too far from the origin.
    pub fn add_mesh(
        &mut self,
        name: &str,
        mesh: &Mesh,
        transform: Mat4,
        material: u32,
    ) -> Result<(), BakeError> {
        let topology = match mesh.primitive_topology() {
            PrimitiveTopology::TriangleList => None,
            PrimitiveTopology::TriangleStrip => Some("a strip"),
            PrimitiveTopology::PointList => Some("points"),
            _ => Some("lines"),
        };
        if let Some(topology) = topology {
            return Err(BakeError::Topology {
                mesh: name.into(),
                topology,
            });
        }
        let missing = |attribute, fix| BakeError::MissingAttribute {
            mesh: name.into(),
            attribute,
            fix,
        };
        let fix = "give it positions of three 32-bit floats, and keep it in the main world";
        let attribute = |attribute| mesh.try_attribute_option(attribute).ok().flatten();
        let positions = attribute(Mesh::ATTRIBUTE_POSITION)
            .and_then(VertexAttributeValues::as_float3)
            .ok_or_else(|| missing("positions", fix))?;
        let normals = attribute(Mesh::ATTRIBUTE_NORMAL).and_then(VertexAttributeValues::as_float3);
        let material_of = self.materials.get(material as usize);
        let channel = match material_of.map(|material| &material.uv_channel) {
            Some(UvChannel::Uv1) => Mesh::ATTRIBUTE_UV_1,
            _ => Mesh::ATTRIBUTE_UV_0,
        };
        let uvs = match attribute(channel) {
            Some(VertexAttributeValues::Float32x2(uvs)) => Some(uvs),
            _ => None,
        };
        let colors = match attribute(Mesh::ATTRIBUTE_COLOR) {
            Some(VertexAttributeValues::Float32x4(colors)) => Some(colors),
            _ => None,
        };
        if uvs.is_none() && material_of.is_some_and(|material| material.texture.is_some()) {
            let fix = "give it texture coordinates, or a material without a texture";
            return Err(missing("texture coordinates", fix));
        }
        let indices: Vec<usize> = match mesh.try_indices_option() {
            Ok(Some(indices)) => indices.iter().collect(),
            _ => (0..positions.len()).collect(),
        };
        if !indices.len().is_multiple_of(3) {
            return Err(BakeError::IndexCount {
                mesh: name.into(),
                count: indices.len(),
            });
        }
        let mut part = Self::default();
        for (index, corners) in indices.chunks_exact(3).enumerate() {
            if let Some(vertex) = corners.iter().find(|corner| **corner >= positions.len()) {
                return Err(BakeError::Index {
                    mesh: name.into(),
                    triangle: index,
                    vertex: *vertex,
                    count: positions.len(),
                });
            }
            let at = |corner: usize| Vec3::from(positions[corners[corner]]);
            let flat = (at(1) - at(0)).cross(at(2) - at(0));
            let vertices = core::array::from_fn(|corner| {
                let i = corners[corner];
                CrownVertex {
                    position: at(corner),
                    normal: normals
                        .and_then(|all| all.get(i))
                        .map_or(flat, |n| Vec3::from(*n)),
                    uv: uvs
                        .and_then(|all| all.get(i))
                        .map_or(Vec2::ZERO, |uv| Vec2::from(*uv)),
                    color: colors
                        .and_then(|all| all.get(i))
                        .copied()
                        .unwrap_or([1.0; 4]),
                }
            });
            part.push(vertices, 0);
        }
        let mut moved = Self::default();
        moved.append(&part, transform);
        moved
            .check_vertices()
            .map_err(|error| error.of_mesh(name))?;
        let triangles = moved.triangles.into_iter();
        self.triangles
            .extend(triangles.map(|triangle| CrownTriangle {
                material,
                ..triangle
            }));
        Ok(())
    }
}
