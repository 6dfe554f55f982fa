//! The triangles of a glTF model.

use bevy::asset::RenderAssetUsages;
use bevy::mesh::{Indices, Mesh, PrimitiveTopology};
use gltf::accessor::{DataType, Dimensions};
use gltf::{Accessor, Semantic};

use super::Model;

/// Numbers of which texture coordinates and colours may be made: as they are, or as shares of the greatest.
const SHARES: [DataType; 3] = [DataType::F32, DataType::U8, DataType::U16];
const INDICES: [DataType; 3] = [DataType::U8, DataType::U16, DataType::U32];

impl Model<'_> {
    pub(super) fn mesh(&self, name: &str, primitive: &gltf::Primitive) -> Result<Mesh, String> {
        if primitive.mode() != gltf::mesh::Mode::Triangles {
            return Err(format!(
                "mesh `{name}` is not a list of triangles: triangulate it"
            ));
        }
        let unread = |what| format!("mesh `{name}` has no {what} that can be read: export it anew");
        let reader = primitive.reader(|buffer| self.buffers.get(buffer.index()).map(Vec::as_slice));
        // Whether there is such an attribute. The reader takes it to be of a kind that the format allows.
        let has = |semantic, dimensions: &[Dimensions], types: &[DataType], what| {
            let accessor = primitive.get(&semantic);
            let fits = accessor.is_none_or(|accessor| is_of(&accessor, dimensions, types));
            fits.then(|| primitive.get(&semantic).is_some())
                .ok_or_else(|| unread(what))
        };
        let (vec2, vec3) = ([Dimensions::Vec2], [Dimensions::Vec3]);
        let floats = [DataType::F32];
        has(Semantic::Positions, &vec3, &floats, "positions")?;
        let positions = reader.read_positions().ok_or_else(|| unread("positions"))?;
        let mut mesh = Mesh::new(
            PrimitiveTopology::TriangleList,
            RenderAssetUsages::MAIN_WORLD,
        )
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions.collect::<Vec<_>>());
        if has(Semantic::Normals, &vec3, &floats, "normals")? {
            let normals = reader.read_normals().ok_or_else(|| unread("normals"))?;
            mesh.insert_attribute(Mesh::ATTRIBUTE_NORMAL, normals.collect::<Vec<_>>());
        }
        let set = texture_coordinates(&primitive.material());
        let what = "texture coordinates";
        if has(Semantic::TexCoords(set), &vec2, &SHARES, what)? {
            let uvs = reader.read_tex_coords(set).ok_or_else(|| unread(what))?;
            mesh.insert_attribute(Mesh::ATTRIBUTE_UV_0, uvs.into_f32().collect::<Vec<_>>());
        }
        let of_colors = [Dimensions::Vec3, Dimensions::Vec4];
        if has(Semantic::Colors(0), &of_colors, &SHARES, "colours")? {
            let colors = reader.read_colors(0).ok_or_else(|| unread("colours"))?;
            let colors: Vec<_> = colors.into_rgba_f32().collect();
            mesh.insert_attribute(Mesh::ATTRIBUTE_COLOR, colors);
        }
        if let Some(accessor) = primitive.indices() {
            let indices = is_of(&accessor, &[Dimensions::Scalar], &INDICES)
                .then(|| reader.read_indices())
                .flatten()
                .ok_or_else(|| unread("indices"))?;
            mesh.insert_indices(Indices::U32(indices.into_u32().collect()));
        }
        let corners = mesh
            .indices()
            .map_or(mesh.count_vertices(), |indices| indices.len());
        if !corners.is_multiple_of(3) {
            return Err(format!(
                "mesh `{name}` has {corners} corners, which make no whole triangles: export it anew"
            ));
        }
        Ok(mesh)
    }
}

fn is_of(accessor: &Accessor, dimensions: &[Dimensions], types: &[DataType]) -> bool {
    dimensions.contains(&accessor.dimensions()) && types.contains(&accessor.data_type())
}

/// Which set of them the base colour's texture takes.
fn texture_coordinates(material: &gltf::Material) -> u32 {
    let surface = material.pbr_metallic_roughness();
    surface.base_color_texture().map_or(0, |texture| {
        let other = texture
            .texture_transform()
            .and_then(|transform| transform.tex_coord());
        other.unwrap_or(texture.tex_coord())
    })
}
