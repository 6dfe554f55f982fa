//! The triangles of a glTF model.

use bevy::asset::RenderAssetUsages;
use bevy::math::{Mat3, Mat4, Vec3};
use bevy::mesh::{Indices, Mesh, PrimitiveTopology};
use gltf::accessor::{DataType, Dimensions};
use gltf::{Accessor, Semantic};

use super::Reader;

/// Numbers of which texture coordinates and colours may be made: as they are, or as shares of the greatest.
const SHARES: [DataType; 3] = [DataType::F32, DataType::U8, DataType::U16];
const INDICES: [DataType; 3] = [DataType::U8, DataType::U16, DataType::U32];

impl Reader<'_> {
    /// The triangles of a primitive whose node stands at `place`.
    pub(super) fn mesh(
        &self,
        name: &str,
        primitive: &gltf::Primitive,
        place: Mat4,
    ) -> Result<Mesh, String> {
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
        let place_point = |at: [f32; 3]| place.transform_point3(Vec3::from(at)).to_array();
        let positions: Vec<_> = positions.map(place_point).collect();
        let count = positions.len();
        let positions = checked(name, "positions", positions, count)?;
        let mut mesh = Mesh::new(
            PrimitiveTopology::TriangleList,
            RenderAssetUsages::MAIN_WORLD,
        )
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions);
        if has(Semantic::Normals, &vec3, &floats, "normals")? {
            let normals = reader.read_normals().ok_or_else(|| unread("normals"))?;
            let turn = turn(place);
            let normals = normals.map(|normal| (turn * Vec3::from(normal)).to_array());
            let normals = checked(name, "normals", normals.collect(), count)?;
            mesh.insert_attribute(Mesh::ATTRIBUTE_NORMAL, normals);
        }
        let set = texture_coordinates(&primitive.material());
        let what = "texture coordinates";
        if has(Semantic::TexCoords(set), &vec2, &SHARES, what)? {
            let uvs = reader.read_tex_coords(set).ok_or_else(|| unread(what))?;
            let uvs = checked(name, what, uvs.into_f32().collect(), count)?;
            mesh.insert_attribute(Mesh::ATTRIBUTE_UV_0, uvs);
        } else if has_texture(&primitive.material()) {
            return Err(format!(
                "mesh `{name}` has a texture, but no texture coordinates: unwrap it, or take the texture away"
            ));
        }
        let of_colors = [Dimensions::Vec3, Dimensions::Vec4];
        if has(Semantic::Colors(0), &of_colors, &SHARES, "colours")? {
            let colors = reader.read_colors(0).ok_or_else(|| unread("colours"))?;
            let colors = checked(name, "colours", colors.into_rgba_f32().collect(), count)?;
            mesh.insert_attribute(Mesh::ATTRIBUTE_COLOR, colors);
        }
        let indices: Vec<u32> = match primitive.indices() {
            Some(accessor) => is_of(&accessor, &[Dimensions::Scalar], &INDICES)
                .then(|| reader.read_indices())
                .flatten()
                .ok_or_else(|| unread("indices"))?
                .into_u32()
                .collect(),
            None => (0..count as u32).collect(),
        };
        let indices = wound(name, indices, count, is_mirror(place))?;
        mesh.insert_indices(Indices::U32(indices));
        Ok(mesh)
    }
}

/// What a mesh has of one for each vertex, if it is that.
fn checked<const N: usize>(
    mesh: &str,
    what: &str,
    values: Vec<[f32; N]>,
    vertices: usize,
) -> Result<Vec<[f32; N]>, String> {
    if values.len() != vertices {
        return Err(format!(
            "mesh `{mesh}` has {what} for {} of {vertices} vertices: export it anew",
            values.len()
        ));
    }
    let is_finite = |value: &[f32; N]| value.iter().all(|number| number.is_finite());
    match values.iter().position(|value| !is_finite(value)) {
        Some(vertex) => Err(format!(
            "mesh `{mesh}`: the {what} of vertex {vertex} are not finite: correct it"
        )),
        None => Ok(values),
    }
}

/// Indices of whole triangles of vertices that are there, counterclockwise from outside also where a mirror has turned them.
fn wound(
    mesh: &str,
    mut indices: Vec<u32>,
    vertices: usize,
    is_mirrored: bool,
) -> Result<Vec<u32>, String> {
    let number = indices.len();
    if !number.is_multiple_of(3) {
        return Err(format!(
            "mesh `{mesh}` has {number} corners, which make no whole triangles: export it anew"
        ));
    }
    for (triangle, corners) in indices.chunks_exact_mut(3).enumerate() {
        if let Some(vertex) = corners.iter().find(|corner| **corner as usize >= vertices) {
            return Err(format!(
                "mesh `{mesh}`: triangle {triangle} names vertex {vertex} of {vertices}: correct the index buffer"
            ));
        }
        if is_mirrored {
            corners.swap(1, 2);
        }
    }
    Ok(indices)
}

fn is_mirror(place: Mat4) -> bool {
    Mat3::from_mat4(place).determinant() < 0.0
}

/// What normals are turned by: cofactors, which stay finite where the scale is 0 along an axis. A mirror leaves them
/// outside.
fn turn(place: Mat4) -> Mat3 {
    let [x, y, z] = Mat3::from_mat4(place).to_cols_array_2d().map(Vec3::from);
    let cofactors = Mat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
    let side: f32 = if is_mirror(place) { -1.0 } else { 1.0 };
    cofactors * side
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

fn has_texture(material: &gltf::Material) -> bool {
    let surface = material.pbr_metallic_roughness();
    surface.base_color_texture().is_some()
}
