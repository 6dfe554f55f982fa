//! Models to bake, from glTF: `*.glb` and `*.gltf` with buffers and PNG textures in the file or beside it.

mod mesh;
mod parts;
mod texture;

use std::collections::HashMap;
use std::path::Path;

use bevy::asset::Handle;
use bevy::color::Color;
use bevy::image::Image;
use bevy::math::{Affine2, Mat4};
use bevy::pbr::StandardMaterial;
use bevy::prelude::AlphaMode;

pub use parts::{Model, ModelPart};

/// Reads the triangles and base colours of a model's default scene, with where their textures lie
/// (`KHR_texture_transform`). Skins and animations are not followed.
///
/// # Errors
/// When a file is missing or not glTF, there are no triangles, a texture is no PNG, a mesh is not one of triangles or has
/// numbers that are none, or a node stands in two places; the message names it.
pub fn load_model(path: &Path) -> Result<Model, String> {
    let named = |message: String| format!("{}: {message}", path.display());
    let bytes = std::fs::read(path)
        .map_err(|error| named(format!("{error}. Give the path of a *.glb or *.gltf")))?;
    let gltf = parse(&bytes).map_err(|error| {
        named(format!(
            "is no glTF that can be read: {error}. Export it anew, uncompressed"
        ))
    })?;
    let reader = Reader::open(path, &gltf).map_err(named)?;
    let model = reader.read(&gltf).map_err(named)?;
    if model.parts.iter().all(|part| part.triangle_count() == 0) {
        return Err(named(
            "has no triangles: export the meshes of its scene".into(),
        ));
    }
    Ok(model)
}

fn parse(bytes: &[u8]) -> Result<gltf::Gltf, String> {
    let told = |error: gltf::Error| error.to_string().trim_end_matches([';', ' ']).to_string();
    let file = gltf::Gltf::from_slice_without_validation(bytes).map_err(told)?;
    let root = file.document.into_json();
    // Validation looks into the accessors of positions before it has seen whether they are there.
    let mut primitives = root.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let is_there = |accessor: &gltf::json::Index<_>| accessor.value() < root.accessors.len();
    if !primitives.all(|primitive| primitive.attributes.values().all(is_there)) {
        return Err("a mesh names an accessor that is not there".into());
    }
    let document = gltf::Document::from_json(root).map_err(told)?;
    Ok(gltf::Gltf {
        document,
        blob: file.blob,
    })
}

struct Reader<'a> {
    path: &'a Path,
    buffers: Vec<Vec<u8>>,
    /// The images that were read, by their number in the file.
    textures: HashMap<usize, Handle<Image>>,
    model: Model,
}

impl<'a> Reader<'a> {
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
        Ok(Self {
            path,
            buffers,
            textures: HashMap::new(),
            model: Model::default(),
        })
    }

    /// Of all nodes of the scene, each after the one above it.
    fn read(mut self, gltf: &gltf::Gltf) -> Result<Model, String> {
        let scene = gltf.default_scene().or_else(|| gltf.scenes().next());
        let scene = scene.ok_or("has no scene: export one")?;
        // A node with two parents would be met again and again: forty of them in a row a million million times.
        let mut is_met = vec![false; gltf.nodes().len()];
        let mut left: Vec<_> = scene.nodes().map(|node| (node, Mat4::IDENTITY)).collect();
        left.reverse();
        while let Some((node, above)) = left.pop() {
            if core::mem::replace(&mut is_met[node.index()], true) {
                return Err(format!(
                    "node {} stands in two places or within itself: give it one parent",
                    node.index()
                ));
            }
            let place = above * Mat4::from_cols_array_2d(&node.transform().matrix());
            self.add(&node, place)?;
            let first = left.len();
            left.extend(node.children().map(|child| (child, place)));
            left[first..].reverse();
        }
        Ok(self.model)
    }

    fn add(&mut self, node: &gltf::Node, place: Mat4) -> Result<(), String> {
        let Some(mesh) = node.mesh() else {
            return Ok(());
        };
        let name = mesh.name().unwrap_or_default();
        for primitive in mesh.primitives() {
            let material = primitive.material();
            let part = ModelPart {
                mesh: name.into(),
                material: material.name().unwrap_or_default().into(),
                triangles: self.mesh(name, &primitive, place)?,
                surface: self.surface(&material)?,
            };
            self.model.parts.push(part);
        }
        Ok(())
    }

    fn surface(&mut self, material: &gltf::Material) -> Result<StandardMaterial, String> {
        let surface = material.pbr_metallic_roughness();
        let [red, green, blue, alpha] = surface.base_color_factor();
        let transform = surface
            .base_color_texture()
            .and_then(|texture| texture.texture_transform());
        Ok(StandardMaterial {
            base_color: Color::linear_rgba(red, green, blue, alpha),
            base_color_texture: self.texture(material)?,
            // Counter-clockwise as one sees the texture, whose v runs down.
            uv_transform: transform.map_or(Affine2::IDENTITY, |transform| {
                Affine2::from_scale_angle_translation(
                    transform.scale().into(),
                    -transform.rotation(),
                    transform.offset().into(),
                )
            }),
            alpha_mode: match material.alpha_mode() {
                gltf::material::AlphaMode::Opaque => AlphaMode::Opaque,
                gltf::material::AlphaMode::Mask => {
                    AlphaMode::Mask(material.alpha_cutoff().unwrap_or(0.5))
                }
                gltf::material::AlphaMode::Blend => AlphaMode::Blend,
            },
            ..StandardMaterial::default()
        })
    }
}

/// The bytes of a file beside the model.
fn beside(path: &Path, uri: &str) -> Result<Vec<u8>, String> {
    if uri.starts_with("data:") {
        return Err("has data in its text: export it as *.glb".into());
    }
    let file = path.with_file_name(decoded(uri));
    std::fs::read(&file).map_err(|error| {
        format!(
            "{}: {error}. Put it there, or export the model as *.glb, which holds all",
            file.display()
        )
    })
}

/// A name as files have it: exporters write a blank as `%20`.
fn decoded(uri: &str) -> String {
    let mut bytes = Vec::new();
    let mut rest = uri.as_bytes();
    while let Some((&first, others)) = rest.split_first() {
        let code = (first == b'%')
            .then(|| core::str::from_utf8(others.get(..2)?).ok())
            .flatten();
        match code.and_then(|code| u8::from_str_radix(code, 16).ok()) {
            Some(byte) => {
                bytes.push(byte);
                rest = &others[2..];
            }
            None => {
                bytes.push(first);
                rest = others;
            }
        }
    }
    String::from_utf8(bytes).unwrap_or_else(|_| uri.into())
}
