//! Models to bake, from glTF: `*.glb` and `*.gltf` with buffers and PNG textures in the file or beside it.

use std::path::Path;

use bevy::asset::RenderAssetUsages;
use bevy::math::Mat4;
use bevy::mesh::{Indices, Mesh, PrimitiveTopology};
use gltf::material::AlphaMode;

use crate::slicing::{CrownMaterial, CrownMesh, CrownTexture};

/// Levels of nodes that a scene may nest.
const DEEPEST: usize = 64;

/// A part of a model: all that one node draws with one material.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelPart {
    /// Name of the mesh; empty where it has none.
    pub mesh: String,
    /// Name of the material; empty where it has none.
    pub material: String,
    /// Its triangles, in the model's space.
    pub crown: CrownMesh,
}

/// Reads a model's triangles and base colours. Skins and animations are not followed.
///
/// # Errors
/// When a file is missing or not glTF, a texture is no PNG, or a mesh is not one of triangles; the message names it.
pub fn load_model(path: &Path) -> Result<Vec<ModelPart>, String> {
    let named = |message: String| format!("{}: {message}", path.display());
    let bytes = std::fs::read(path)
        .map_err(|error| named(format!("{error}. Give the path of a *.glb or *.gltf")))?;
    let gltf =
        gltf::Gltf::from_slice(&bytes).map_err(|error| named(format!("is no glTF: {error}")))?;
    let model = Model::open(path, &gltf).map_err(named)?;
    let scene = gltf.default_scene().or_else(|| gltf.scenes().next());
    let scene = scene.ok_or_else(|| named("has no scene: export one".into()))?;
    let mut parts = Vec::new();
    for node in scene.nodes() {
        model
            .add(&node, Mat4::IDENTITY, DEEPEST, &mut parts)
            .map_err(named)?;
    }
    Ok(parts)
}

struct Model<'a> {
    path: &'a Path,
    buffers: Vec<Vec<u8>>,
}

impl<'a> Model<'a> {
    fn open(path: &'a Path, gltf: &gltf::Gltf) -> Result<Self, String> {
        let mut buffers = Vec::new();
        for buffer in gltf.buffers() {
            let data = match buffer.source() {
                gltf::buffer::Source::Bin => gltf
                    .blob
                    .clone()
                    .ok_or("its binary chunk is missing: export it anew")?,
                gltf::buffer::Source::Uri(uri) => beside(path, uri)?,
            };
            if data.len() < buffer.length() {
                return Err(format!(
                    "buffer {} is cut short: export it anew",
                    buffer.index()
                ));
            }
            buffers.push(data);
        }
        Ok(Self { path, buffers })
    }

    fn add(
        &self,
        node: &gltf::Node,
        above: Mat4,
        depth: usize,
        parts: &mut Vec<ModelPart>,
    ) -> Result<(), String> {
        let place = above * Mat4::from_cols_array_2d(&node.transform().matrix());
        if let Some(mesh) = node.mesh() {
            let name = mesh.name().unwrap_or_default();
            for primitive in mesh.primitives() {
                let mut crown = CrownMesh::default();
                let material = primitive.material();
                let texture = self.texture(&material)?;
                let index = crown.add_material(CrownMaterial {
                    color: material.pbr_metallic_roughness().base_color_factor(),
                    texture,
                    cutoff: match material.alpha_mode() {
                        AlphaMode::Mask => material.alpha_cutoff().unwrap_or(0.5),
                        _ => 0.0,
                    },
                    ..CrownMaterial::default()
                });
                let mesh = self.mesh(name, &primitive)?;
                crown
                    .add_mesh(name, &mesh, place, index)
                    .map_err(|error| error.to_string())?;
                parts.push(ModelPart {
                    mesh: name.into(),
                    material: material.name().unwrap_or_default().into(),
                    crown,
                });
            }
        }
        if depth == 0 {
            return Err(format!(
                "its nodes are nested more than {DEEPEST} deep: flatten them"
            ));
        }
        for child in node.children() {
            self.add(&child, place, depth - 1, parts)?;
        }
        Ok(())
    }

    fn mesh(&self, name: &str, primitive: &gltf::Primitive) -> Result<Mesh, String> {
        if primitive.mode() != gltf::mesh::Mode::Triangles {
            return Err(format!(
                "mesh `{name}` is not a list of triangles: triangulate it"
            ));
        }
        let reader = primitive.reader(|buffer| self.buffers.get(buffer.index()).map(Vec::as_slice));
        let positions = reader.read_positions();
        let positions =
            positions.ok_or_else(|| format!("mesh `{name}` has no positions: export it anew"))?;
        let mut mesh = Mesh::new(
            PrimitiveTopology::TriangleList,
            RenderAssetUsages::MAIN_WORLD,
        )
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions.collect::<Vec<_>>());
        if let Some(normals) = reader.read_normals() {
            mesh.insert_attribute(Mesh::ATTRIBUTE_NORMAL, normals.collect::<Vec<_>>());
        }
        let texture = primitive
            .material()
            .pbr_metallic_roughness()
            .base_color_texture();
        let set = texture.map_or(0, |texture| texture.tex_coord());
        if let Some(uvs) = reader.read_tex_coords(set) {
            mesh.insert_attribute(Mesh::ATTRIBUTE_UV_0, uvs.into_f32().collect::<Vec<_>>());
        }
        if let Some(colors) = reader.read_colors(0) {
            mesh.insert_attribute(
                Mesh::ATTRIBUTE_COLOR,
                colors.into_rgba_f32().collect::<Vec<_>>(),
            );
        }
        if let Some(indices) = reader.read_indices() {
            mesh.insert_indices(Indices::U32(indices.into_u32().collect()));
        }
        Ok(mesh)
    }

    fn texture(&self, material: &gltf::Material) -> Result<Option<CrownTexture>, String> {
        let Some(texture) = material.pbr_metallic_roughness().base_color_texture() else {
            return Ok(None);
        };
        let (name, bytes) = match texture.texture().source().source() {
            gltf::image::Source::Uri { uri, .. } => (uri.to_string(), beside(self.path, uri)?),
            gltf::image::Source::View { view, .. } => {
                let name = format!("image {}", texture.texture().source().index());
                let buffer = self.buffers.get(view.buffer().index());
                let bytes =
                    buffer.and_then(|buffer| buffer.get(view.offset()..)?.get(..view.length()));
                (
                    name.clone(),
                    bytes
                        .ok_or_else(|| {
                            format!("{name} lies outside of its buffer: export it anew")
                        })?
                        .to_vec(),
                )
            }
        };
        let image = image::load_from_memory_with_format(&bytes, image::ImageFormat::Png)
            .map_err(|error| {
                format!("{name}: {error}. Textures must be PNGs: export it anew with PNG")
            })?
            .into_rgba8();
        let size = [image.width(), image.height()];
        let mut pixels: Vec<[u8; 4]> = image.pixels().map(|pixel| pixel.0).collect();
        if material.alpha_mode() == AlphaMode::Opaque {
            for pixel in &mut pixels {
                pixel[3] = 255;
            }
        }
        CrownTexture::new(size, pixels)
            .map(Some)
            .map_err(|error| error.to_string())
    }
}

/// The bytes of a file beside the model.
fn beside(path: &Path, uri: &str) -> Result<Vec<u8>, String> {
    if uri.starts_with("data:") {
        return Err("has data in its text: export it as *.glb".into());
    }
    let file = path.with_file_name(uri);
    std::fs::read(&file).map_err(|error| format!("{}: {error}", file.display()))
}
