//! Shapes from Bevy's meshes and materials, whatever they were loaded from.

use bevy::asset::{AssetId, Assets};
use bevy::color::{ColorToComponents, ColorToPacked};
use bevy::image::{Image, TextureAccessError};
use bevy::math::{Vec2, Vec3, Vec4};
use bevy::mesh::{
    Indices, Mesh, MeshAccessError, MeshVertexAttribute, PrimitiveTopology, VertexAttributeValues,
};
use bevy::pbr::StandardMaterial;
use bevy::prelude::AlphaMode;
use thiserror::Error;

use super::build::{Paint, PaintTexture, Shape};

/// Why a mesh does not become part of a shape.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ShapeMeshError {
    /// The mesh is only on the GPU, or has no positions.
    #[error(
        "{0}. Load the mesh with RenderAssetUsages::MAIN_WORLD among its asset usages, and give it positions"
    )]
    Access(#[from] MeshAccessError),
    /// The mesh has lines or points.
    #[error("the mesh is a {0:?}: only TriangleList and TriangleStrip have surfaces")]
    Topology(PrimitiveTopology),
    /// An attribute has a format that is not read.
    #[error("the mesh's {0} are not in a float format: store them as Float32")]
    Format(&'static str),
    /// A texture is not there.
    #[error("the base colour texture {0} is not loaded yet: wait for it")]
    NotLoaded(AssetId<Image>),
    /// A texture's pixels cannot be read.
    #[error(
        "the base colour texture cannot be read ({0}): use an uncompressed image that is kept in the main world"
    )]
    Texture(#[from] TextureAccessError),
    /// The shape has as many paints as its triangles can name.
    #[error(
        "the shape has {0} paints already, one for each mesh that was added: merge meshes of one material before, or build \
         several volumes"
    )]
    TooManyPaints(usize),
}

impl Shape {
    /// Adds a mesh with the base colour of its material. Bevy's axes become those of volumes: x stays, y is up, w; and
    /// what Bevy's −z points to is v.
    ///
    /// Alpha cuts holes with [`AlphaMode::Mask`] at its cutoff, with blending modes at one half, else not at all.
    /// Vertex colours, if the mesh has them, multiply the material's.
    ///
    /// # Errors
    /// When the mesh is no surface or not readable, or the texture is not, or the shape has 65,536 paints already; the shape
    /// stays as it was. Indices out of range are found when the shape is built.
    pub fn add_mesh(
        &mut self,
        mesh: &Mesh,
        material: &StandardMaterial,
        images: &Assets<Image>,
    ) -> Result<(), ShapeMeshError> {
        let added = read(mesh, material)?;
        let paint = paint(material, images)?;
        // Triangles name paints by 16 bits.
        if self.paints.len() > usize::from(u16::MAX) {
            return Err(ShapeMeshError::TooManyPaints(self.paints.len()));
        }
        let first = self.positions.len() as u32;
        self.complete();
        self.paint_of
            .extend(vec![self.paints.len() as u16; added.triangles.len()]);
        self.paints.push(paint);
        self.positions.extend(added.positions);
        self.normals.extend(added.normals);
        self.uvs.extend(added.uvs);
        self.colors.extend(added.colors);
        // What is out of range stays so.
        let moved = added.triangles.into_iter();
        self.triangles
            .extend(moved.map(|triangle| triangle.map(|i| i.saturating_add(first))));
        Ok(())
    }

    /// Gives all lists an entry for all vertices and triangles there are.
    fn complete(&mut self) {
        let vertices = self.positions.len();
        // A zero normal is that of its triangle.
        self.normals.resize(vertices, Vec3::ZERO);
        self.uvs.resize(vertices, Vec2::ZERO);
        self.colors.resize(vertices, Vec4::ONE);
        if self.paints.is_empty() && !self.triangles.is_empty() {
            self.paints.push(Paint::default());
        }
        self.paint_of.resize(self.triangles.len(), 0);
    }
}

/// The vertices and triangles of a mesh, with all lists.
fn read(mesh: &Mesh, material: &StandardMaterial) -> Result<Shape, ShapeMeshError> {
    // Bevy's axes become those of volumes.
    let turned = |vectors: Vec<Vec3>| -> Vec<Vec3> {
        let turn = |Vec3 { x, y, z }: Vec3| Vec3::new(x, -z, y);
        vectors.into_iter().map(turn).collect()
    };
    let positions = positions(mesh)?;
    let count = positions.len();
    let normals = vectors(mesh, Mesh::ATTRIBUTE_NORMAL, "normals")?;
    let transform = material.uv_transform;
    let uvs = uvs(mesh)?.into_iter();
    let uvs = uvs.map(|uv| transform.transform_point2(uv)).collect();
    let colors = match mesh.try_attribute_option(Mesh::ATTRIBUTE_COLOR)? {
        Some(VertexAttributeValues::Float32x4(colors)) => {
            colors.iter().copied().map(Vec4::from).collect()
        }
        Some(_) => return Err(ShapeMeshError::Format("colours")),
        None => vec![Vec4::ONE; count],
    };
    let mut shape = Shape {
        positions: turned(positions),
        normals: turned(normals.unwrap_or_else(|| vec![Vec3::ZERO; count])),
        uvs,
        colors,
        triangles: triangles(mesh, count)?,
        ..Shape::default()
    };
    shape.uvs.resize(count, Vec2::ZERO);
    Ok(shape)
}

/// The positions of a mesh.
pub(super) fn positions(mesh: &Mesh) -> Result<Vec<Vec3>, ShapeMeshError> {
    mesh.try_attribute(Mesh::ATTRIBUTE_POSITION)?;
    let positions = vectors(mesh, Mesh::ATTRIBUTE_POSITION, "positions")?;
    Ok(positions.unwrap_or_default())
}

/// An attribute of a mesh, called so in messages, if it has it.
pub(super) fn vectors(
    mesh: &Mesh,
    attribute: MeshVertexAttribute,
    name: &'static str,
) -> Result<Option<Vec<Vec3>>, ShapeMeshError> {
    let Some(values) = mesh.try_attribute_option(attribute)? else {
        return Ok(None);
    };
    let values = values.as_float3().ok_or(ShapeMeshError::Format(name))?;
    Ok(Some(values.iter().copied().map(Vec3::from).collect()))
}

/// The texture coordinates of a mesh; none if it has none.
pub(super) fn uvs(mesh: &Mesh) -> Result<Vec<Vec2>, ShapeMeshError> {
    match mesh.try_attribute_option(Mesh::ATTRIBUTE_UV_0)? {
        Some(VertexAttributeValues::Float32x2(uvs)) => {
            Ok(uvs.iter().copied().map(Vec2::from).collect())
        }
        Some(_) => Err(ShapeMeshError::Format("texture coordinates")),
        None => Ok(Vec::new()),
    }
}

/// The triangles of a mesh of so many vertices.
pub(super) fn triangles(mesh: &Mesh, vertices: usize) -> Result<Vec<[u32; 3]>, ShapeMeshError> {
    let indices: Vec<u32> = match mesh.try_indices_option()? {
        Some(Indices::U16(indices)) => indices.iter().copied().map(u32::from).collect(),
        Some(Indices::U32(indices)) => indices.clone(),
        None => (0..vertices as u32).collect(),
    };
    match mesh.primitive_topology() {
        PrimitiveTopology::TriangleList => Ok(indices.as_chunks().0.to_vec()),
        PrimitiveTopology::TriangleStrip => {
            let windows = indices.array_windows().enumerate();
            let wound =
                windows.map(|(i, &[a, b, c])| if i % 2 == 0 { [a, b, c] } else { [b, a, c] });
            Ok(wound.collect())
        }
        other => Err(ShapeMeshError::Topology(other)),
    }
}

fn paint(material: &StandardMaterial, images: &Assets<Image>) -> Result<Paint, ShapeMeshError> {
    let texture = match &material.base_color_texture {
        Some(handle) => {
            let image = images
                .get(handle)
                .ok_or(ShapeMeshError::NotLoaded(handle.id()))?;
            Some(texture(image, material.alpha_mode == AlphaMode::Opaque)?)
        }
        None => None,
    };
    Ok(Paint {
        color: material.base_color.to_linear().to_vec4(),
        alpha_cutoff: match material.alpha_mode {
            AlphaMode::Mask(cutoff) => cutoff,
            AlphaMode::Opaque => 0.0,
            _ => 0.5,
        },
        texture,
    })
}

/// The pixels of an image. Where the material is opaque alpha says nothing of its colours.
fn texture(image: &Image, is_opaque: bool) -> Result<PaintTexture, ShapeMeshError> {
    let size = [image.width(), image.height()];
    let mut pixels = Vec::with_capacity((size[0] * size[1]) as usize);
    for y in 0..size[1] {
        for x in 0..size[0] {
            let [r, g, b, a] = image.get_color_at(x, y)?.to_srgba().to_u8_array();
            pixels.push([r, g, b, if is_opaque { 255 } else { a }]);
        }
    }
    Ok(PaintTexture::new(size, &pixels))
}

#[cfg(test)]
mod tests {
    use bevy::asset::RenderAssetUsages;
    use bevy::color::Color;
    use bevy::math::UVec3;
    use bevy::math::primitives::Cuboid;

    use super::super::build::{ShapeSettings, from_shape};
    use super::super::progress::silent;
    use super::*;

    fn red() -> StandardMaterial {
        StandardMaterial::from_color(Color::srgb_u8(200, 10, 20))
    }

    #[test]
    fn a_mesh_stands_upright_in_its_volume_with_the_colour_of_its_material() {
        let mut shape = Shape::default();
        let mesh = Mesh::from(Cuboid::new(1.0, 2.0, 4.0));
        shape.add_mesh(&mesh, &red(), &Assets::default()).unwrap();
        let built = from_shape(&shape, &ShapeSettings::new(UVec3::splat(32)), &silent);
        let volume = built.unwrap().volume;
        // Height is Bevy's y, and v its −z; along u and v there is a margin of a voxel of 1/30 and 4/30.
        assert_eq!(volume.lengths().z, 2.0);
        let margin = volume.lengths() - Vec3::new(1.0, 4.0, 2.0);
        assert!(
            margin.distance(Vec3::new(2.0, 8.0, 0.0) / 30.0) < 1e-3,
            "{margin}"
        );
        assert_eq!(volume.color(16, 16, 31), [200, 10, 20, 255]);
        assert_eq!(volume.normal(16, 16, 31).round(), Vec3::Z);
        assert_eq!(volume.normal(16, 30, 16).round(), Vec3::Y);
        assert_eq!(volume.normal(30, 16, 16).round(), Vec3::X);
        assert!(volume.is_opaque(16, 16, 16), "filled");
    }

    #[test]
    fn meshes_are_added_one_to_the_other_each_with_its_paint() {
        let mut shape = Shape::default();
        let plain = Mesh::from(Cuboid::default()).with_removed_attribute(Mesh::ATTRIBUTE_NORMAL);
        shape.add_mesh(&plain, &red(), &Assets::default()).unwrap();
        let glass = StandardMaterial {
            alpha_mode: AlphaMode::Mask(0.3),
            ..red()
        };
        shape
            .add_mesh(&Mesh::from(Cuboid::default()), &glass, &Assets::default())
            .unwrap();
        assert_eq!(shape.triangles.len(), 24);
        assert_eq!((shape.paint_of[11], shape.paint_of[12]), (0, 1));
        let cutoffs = [shape.paints[0].alpha_cutoff, shape.paints[1].alpha_cutoff];
        assert_eq!(cutoffs, [0.0, 0.3]);
        let vertices = shape.positions.len();
        for list in [shape.normals.len(), shape.uvs.len(), shape.colors.len()] {
            assert_eq!(list, vertices);
        }
        assert!(
            shape.triangles[12..]
                .as_flattened()
                .iter()
                .all(|&i| i >= 24)
        );
    }

    #[test]
    fn alpha_counts_where_a_material_is_masked_and_nowhere_else() {
        let mut images = Assets::<Image>::default();
        let mut paint_with = |alpha: u8, alpha_mode: AlphaMode| {
            let image = Image::new(
                bevy::render::render_resource::Extent3d::default(),
                bevy::render::render_resource::TextureDimension::D2,
                vec![10, 200, 30, alpha],
                bevy::render::render_resource::TextureFormat::Rgba8UnormSrgb,
                RenderAssetUsages::default(),
            );
            let material = StandardMaterial {
                base_color_texture: Some(images.add(image)),
                alpha_mode,
                ..Default::default()
            };
            paint(&material, &images).unwrap()
        };
        assert!(paint_with(0, AlphaMode::Opaque) == paint_with(255, AlphaMode::Opaque));
        let mask = AlphaMode::Mask(0.5);
        assert!(paint_with(0, mask) != paint_with(255, mask));
    }

    #[test]
    fn a_shape_takes_as_many_meshes_as_its_triangles_can_name() {
        let mut shape = Shape {
            paints: vec![Paint::default(); 65_535],
            ..Shape::default()
        };
        let mesh = Mesh::from(Cuboid::default());
        let mut add = || shape.add_mesh(&mesh, &red(), &Assets::default());
        add().expect("the last that there is a number for");
        let message = add().unwrap_err().to_string();
        assert!(
            message.contains("65536 paints") && message.contains("merge"),
            "{message}"
        );
        assert_eq!(shape.paint_of, [u16::MAX; 12]);
        assert_eq!((shape.paints.len(), shape.triangles.len()), (65_536, 12));
    }

    #[test]
    fn what_is_no_surface_or_not_there_is_refused() {
        let add = |mesh: &Mesh, material: &StandardMaterial| {
            let added = Shape::default().add_mesh(mesh, material, &Assets::default());
            added.unwrap_err().to_string()
        };
        let lines = Mesh::new(PrimitiveTopology::LineList, RenderAssetUsages::default());
        assert!(add(&lines, &red()).contains("give it positions"));
        let lines = lines.with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, vec![[0.0; 3]; 4]);
        assert!(add(&lines, &red()).contains("LineList"));
        let textured = StandardMaterial {
            base_color_texture: Some(Default::default()),
            ..red()
        };
        assert!(add(&Mesh::from(Cuboid::default()), &textured).contains("not loaded yet"));
    }
}
