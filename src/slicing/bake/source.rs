//! What is baked: triangles in the plant's local space, with all that tells their colour.

use bevy::math::{Affine2, Mat3, Mat4, Vec2, Vec3};
use bevy::mesh::UvChannel;

use super::error::BakeError;
use super::texture::CrownTexture;
use crate::lighting::limited_transmission;

/// Furthest that a vertex may lie from the origin along an axis, in metres.
pub const MAX_COORDINATE: f32 = 1e5;

/// The look of some of a crown's triangles.
#[derive(Clone, Debug, PartialEq)]
pub struct CrownMaterial {
    /// Base colour, linear with alpha, multiplied with vertex colours and the texture. What comes to less than 0 or more
    /// than 1 is taken for the nearest; what is not finite is refused when it is baked.
    pub color: [f32; 4],
    /// Base colour texture; `None` is white.
    pub texture: Option<CrownTexture>,
    /// What vertices' texture coordinates go through before the texture is read.
    pub uv_transform: Affine2,
    /// Which of a mesh's texture coordinates [`CrownMesh::add_mesh`] takes.
    pub uv_channel: UvChannel,
    /// Whether alpha means nothing, of colour, texture and vertices.
    pub opaque: bool,
    /// Where alpha is less than this there is a hole (an alpha mask); 0 for none, for what is blended.
    pub cutoff: f32,
    /// Share of the light that comes through from behind, 0 to 1, as of Bevy's `StandardMaterial`: 0 is solid, 0.5 looks
    /// alike from both sides. What is below or above is taken for the nearest, and no number for 0.
    pub diffuse_transmission: f32,
}

impl Default for CrownMaterial {
    fn default() -> Self {
        Self {
            color: [1.0; 4],
            texture: None,
            uv_transform: Affine2::IDENTITY,
            uv_channel: UvChannel::default(),
            opaque: false,
            cutoff: 0.0,
            diffuse_transmission: 0.0,
        }
    }
}

impl CrownMaterial {
    /// The place of the texture, linear with alpha, for a vertex's texture coordinates; white where there is no texture.
    pub(super) fn sample(&self, uv: Vec2) -> [f32; 4] {
        match &self.texture {
            Some(texture) => texture.sample(self.uv_transform.transform_point2(uv)),
            None => [1.0; 4],
        }
    }

    fn is_finite(&self) -> bool {
        let is_finite = |color: &[f32; 4]| color.iter().all(|x| x.is_finite());
        is_finite(&self.color) && self.uv_transform.is_finite() && self.cutoff.is_finite()
    }
}

/// A vertex of a crown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CrownVertex {
    /// Local space, metres.
    pub position: Vec3,
    /// Local space, of any length but 0.
    pub normal: Vec3,
    /// Texture coordinates; textures repeat.
    pub uv: Vec2,
    /// Colour, linear, multiplied with the material's.
    pub color: [f32; 4],
}

/// A triangle of a crown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CrownTriangle {
    /// Its corners.
    pub vertices: [CrownVertex; 3],
    /// Index into [`CrownMesh::materials`].
    pub material: u32,
}

impl CrownTriangle {
    /// Centroid, c_p of §2.2.
    pub fn centroid(&self) -> Vec3 {
        let [a, b, c] = self.positions();
        (a + b + c) / 3.0
    }

    /// Area, in square metres.
    pub fn area(&self) -> f32 {
        let [a, b, c] = self.positions();
        0.5 * (b - a).cross(c - a).length()
    }

    /// Texture coordinates at a place of barycentric coordinates.
    pub(super) fn uv(&self, weights: Vec3) -> Vec2 {
        let [a, b, c] = self.vertices.map(|vertex| vertex.uv);
        a * weights.x + b * weights.y + c * weights.z
    }

    /// Linear colour with alpha of its vertices at a place of barycentric coordinates.
    pub(super) fn color(&self, weights: Vec3) -> [f32; 4] {
        let [a, b, c] = self.vertices.map(|vertex| vertex.color);
        core::array::from_fn(|i| a[i] * weights.x + b[i] * weights.y + c[i] * weights.z)
    }

    /// The three corners' positions.
    pub fn positions(&self) -> [Vec3; 3] {
        self.vertices.map(|vertex| vertex.position)
    }
}

/// The sparse part of a plant, as triangles: the input of [`bake`](super::bake()).
///
/// Fill it from code with [`add_material`](Self::add_material) and [`push`](Self::push), or from Bevy meshes with
/// [`add_mesh`](Self::add_mesh), which checks them; what is pushed is checked before it is baked.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CrownMesh {
    /// The triangles, in any order; they are seen from both sides.
    pub triangles: Vec<CrownTriangle>,
    /// The materials that the triangles name.
    pub materials: Vec<CrownMaterial>,
}

impl CrownMesh {
    /// Adds a material, and gives its index.
    pub fn add_material(&mut self, material: CrownMaterial) -> u32 {
        self.materials.push(material);
        self.materials.len() as u32 - 1
    }

    /// Adds a triangle.
    pub fn push(&mut self, vertices: [CrownVertex; 3], material: u32) {
        self.triangles.push(CrownTriangle { vertices, material });
    }

    /// Adds all of another crown, moved by `transform`.
    pub fn append(&mut self, other: &Self, transform: Mat4) {
        let first = self.materials.len() as u32;
        self.materials.extend(other.materials.iter().cloned());
        // Normals are turned by the cofactors, which stay finite where the scale is 0 along an axis.
        let [x, y, z] = Mat3::from_mat4(transform)
            .to_cols_array_2d()
            .map(Vec3::from);
        let turn = Mat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
        for triangle in &other.triangles {
            let vertices = triangle.vertices.map(|vertex| CrownVertex {
                position: transform.transform_point3(vertex.position),
                normal: turn * vertex.normal,
                ..vertex
            });
            // One that is not there stays one that is not there.
            self.push(vertices, first.saturating_add(triangle.material));
        }
    }

    /// Share of the light that comes through all triangles from behind, each by its area.
    pub(super) fn diffuse_transmission(&self) -> f32 {
        let (mut through, mut all) = (0.0, 0.0);
        for triangle in &self.triangles {
            let area = f64::from(triangle.area());
            let share = self.materials[triangle.material as usize].diffuse_transmission;
            through += area * f64::from(limited_transmission(share));
            all += area;
        }
        (through / all) as f32
    }

    /// Refuses what cannot be baked; of degenerate triangles, which have no area, the rest is none the worse.
    ///
    /// # Errors
    /// When there is no triangle, none has an area, one names a material that is not there, or a number of a vertex or a
    /// material is not finite, or too far from the origin.
    pub fn check(&self) -> Result<(), BakeError> {
        if self.triangles.is_empty() {
            return Err(BakeError::NoTriangles);
        }
        if let Some(material) = self.materials.iter().position(|m| !m.is_finite()) {
            return Err(BakeError::Material { material });
        }
        let count = self.materials.len();
        let is_missing = |triangle: &CrownTriangle| triangle.material as usize >= count;
        if let Some(index) = self.triangles.iter().position(is_missing) {
            return Err(BakeError::MissingMaterial {
                triangle: index,
                material: self.triangles[index].material,
                count,
            });
        }
        self.check_vertices()?;
        if self.triangles.iter().all(|triangle| triangle.area() <= 0.0) {
            return Err(BakeError::NoArea);
        }
        Ok(())
    }

    /// Refuses numbers of vertices that are not finite, or too far from the origin.
    pub(super) fn check_vertices(&self) -> Result<(), BakeError> {
        for (index, triangle) in self.triangles.iter().enumerate() {
            // NaN is not near either; it hides from `max_element`.
            let is_far = |p: &Vec3| !p.is_finite() || p.abs().max_element() > MAX_COORDINATE;
            // Before normals, which are made of positions where a mesh has none.
            if let Some(position) = triangle.positions().into_iter().find(is_far) {
                return Err(BakeError::Position {
                    triangle: index,
                    position,
                });
            }
            let is_finite = |vertex: &CrownVertex| {
                let colours = vertex.color.iter().all(|x| x.is_finite());
                vertex.normal.is_finite() && vertex.uv.is_finite() && colours
            };
            if !triangle.vertices.iter().all(is_finite) {
                return Err(BakeError::Attribute { triangle: index });
            }
        }
        Ok(())
    }

    /// The box round all triangles: its low and its high corner.
    pub fn bounds(&self) -> Option<(Vec3, Vec3)> {
        let mut positions = self.triangles.iter().flat_map(CrownTriangle::positions);
        let first = positions.next()?;
        Some(positions.fold((first, first), |(low, high), p| (low.min(p), high.max(p))))
    }
}
