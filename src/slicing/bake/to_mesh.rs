//! Crowns back into Bevy's meshes: what is not baked stays a mesh.

use bevy::asset::RenderAssetUsages;
use bevy::math::Vec3;
use bevy::mesh::{Indices, Mesh, PrimitiveTopology};
use bevy::platform::collections::HashMap;

use super::source::{CrownMesh, CrownTriangle, CrownVertex};

/// All numbers of a vertex of a mesh: position, normal, texture coordinates and colour.
type Numbers = [f32; 12];

impl CrownMesh {
    /// All triangles as one Bevy mesh: a list of triangles with indices, in which corners that are the same are one vertex.
    /// For the solid part that [`separate`](super::separate()) gives back.
    ///
    /// It has positions in metres, normals of unit length, texture coordinates as they are, and linear vertex colours, which
    /// the colours of the materials are multiplied into. So its material is white, with the texture, its transform and the
    /// mask that the triangles' material has; where triangles have materials of several textures, make a mesh of each.
    ///
    /// Nothing is checked: a normal of no length becomes that of its triangle, a material that is not there is white, and of
    /// no triangles comes an empty mesh.
    pub fn to_mesh(&self) -> Mesh {
        let mut known: HashMap<[u32; 12], u32> = HashMap::default();
        let (mut positions, mut normals) = (Vec::new(), Vec::new());
        let (mut uvs, mut colors) = (Vec::new(), Vec::new());
        let mut indices = Vec::with_capacity(3 * self.triangles.len());
        for triangle in &self.triangles {
            let material = self.materials.get(triangle.material as usize);
            let color = material.map_or([1.0; 4], |material| material.color);
            for vertex in &triangle.vertices {
                let numbers = numbers(vertex, color, triangle);
                let index = *known.entry(numbers.map(f32::to_bits)).or_insert_with(|| {
                    let [x, y, z, nx, ny, nz, u, v, r, g, b, a] = numbers;
                    positions.push([x, y, z]);
                    normals.push([nx, ny, nz]);
                    uvs.push([u, v]);
                    colors.push([r, g, b, a]);
                    positions.len() as u32 - 1
                });
                indices.push(index);
            }
        }
        Mesh::new(
            PrimitiveTopology::TriangleList,
            RenderAssetUsages::default(),
        )
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, normals)
        .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, uvs)
        .with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, colors)
        .with_inserted_indices(Indices::U32(indices))
    }
}

/// What a vertex of a triangle is in a mesh, its material being of a `color`.
fn numbers(vertex: &CrownVertex, color: [f32; 4], triangle: &CrownTriangle) -> Numbers {
    let [a, b, c] = triangle.positions();
    let flat = (b - a).cross(c - a).normalize_or(Vec3::Y);
    let p = vertex.position;
    let n = vertex.normal.normalize_or(flat);
    let [r, g, b, a]: [f32; 4] = core::array::from_fn(|i| vertex.color[i] * color[i]);
    let numbers = [
        p.x,
        p.y,
        p.z,
        n.x,
        n.y,
        n.z,
        vertex.uv.x,
        vertex.uv.y,
        r,
        g,
        b,
        a,
    ];
    // Adding 0 makes −0 and 0 one.
    numbers.map(|x| x + 0.0)
}

#[cfg(test)]
mod tests {
    use bevy::math::{Mat4, Vec2};

    use super::*;
    use crate::slicing::bake::CrownMaterial;

    /// Two triangles of a square that share two corners, and one of another colour on the square's edge.
    fn crown() -> CrownMesh {
        let mut crown = CrownMesh::default();
        let brown = crown.add_material(CrownMaterial {
            color: [0.5, 0.25, 0.125, 1.0],
            ..CrownMaterial::default()
        });
        let white = crown.add_material(CrownMaterial::default());
        let corner = |x: f32, y: f32| CrownVertex {
            position: Vec3::new(x, y, 2.0),
            normal: Vec3::Z,
            uv: Vec2::new(x, 1.0 - y),
            color: [1.0, 0.5, y, 1.0],
        };
        let [a, b, c, d] =
            [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(x, y)| corner(x, y));
        crown.push([a, b, c], brown);
        crown.push([a, c, d], brown);
        crown.push([b, corner(3.0, 0.5), c], white);
        crown
    }

    #[test]
    fn a_mesh_of_a_crown_makes_the_same_crown() {
        let crown = crown();
        let mesh = crown.to_mesh();
        // Four corners of the square, three of the other colour.
        assert_eq!(mesh.count_vertices(), 7);
        let mut again = CrownMesh::default();
        let material = again.add_material(CrownMaterial::default());
        again
            .add_mesh("again", &mesh, Mat4::IDENTITY, material)
            .unwrap();
        let mut expected = crown.triangles.clone();
        for triangle in &mut expected {
            let color = crown.materials[triangle.material as usize].color;
            triangle.material = material;
            for vertex in &mut triangle.vertices {
                // Halves of halves multiply without rounding.
                vertex.color = core::array::from_fn(|i| vertex.color[i] * color[i]);
            }
        }
        assert_eq!(again.triangles, expected);
    }

    #[test]
    fn what_is_missing_is_made_up_for() {
        let mut crown = crown();
        for vertex in &mut crown.triangles[0].vertices {
            vertex.normal = Vec3::ZERO;
        }
        crown.triangles[2].material = 7;
        // The triangle's own normal is the square's, so that it shares its corners as before.
        assert_eq!(crown.to_mesh().count_vertices(), 7);
        assert_eq!(CrownMesh::default().to_mesh().count_vertices(), 0);
    }
}
