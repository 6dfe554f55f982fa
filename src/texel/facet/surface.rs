//! From a mesh to facets (§2.1): texture coordinates and a height vector at every vertex.

use bevy::math::{Vec2, Vec3};
use thiserror::Error;

use super::{Facet, FacetFault};

/// A surface that is to carry texels, in any one space. Lists have an entry for each vertex.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surface {
    /// Where the vertices are.
    pub positions: Vec<Vec3>,
    /// Normals, of any length; if empty, those of the triangles round each vertex, weighted by area.
    pub normals: Vec<Vec3>,
    /// Texture coordinates, which repeat with 1.
    pub uvs: Vec<Vec2>,
    /// Height vectors; if empty, they follow the normals.
    pub heights: Vec<Vec3>,
    /// Vertices of each triangle, counterclockwise seen from the side that carries texels.
    pub triangles: Vec<[u32; 3]>,
}

/// The facets of a surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurfaceFacets {
    /// What carries texels.
    pub facets: Vec<Facet>,
    /// Unit normals of the surface at the vertices of each facet, for shading; zero where there is none.
    pub normals: Vec<[Vec3; 3]>,
    /// The triangle of each facet.
    pub triangles: Vec<u32>,
    /// Triangles that carry none, and why.
    pub left_out: Vec<(u32, FacetFault)>,
}

/// Why a surface carries no texels at all.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum SurfaceError {
    /// There are no texture coordinates.
    #[error(
        "the mesh has no texture coordinates: unwrap it, or add UVs in code; they place the texels"
    )]
    NoUvs,
    /// There are no triangles.
    #[error("the mesh has no triangles: give it at least one")]
    NoTriangles,
    /// A list has another length than there are vertices.
    #[error("there are {found} {what} for {expected} vertices: give one for each")]
    Count {
        /// What is counted.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many vertices there are.
        expected: usize,
    },
    /// A triangle names a vertex that is not there.
    #[error("triangle {triangle}: vertex {vertex} is not one of {count}: correct the index")]
    MissingVertex {
        /// Which triangle.
        triangle: usize,
        /// The vertex that it names.
        vertex: u32,
        /// How many there are.
        count: usize,
    },
}

impl Surface {
    /// The facets, with height vectors of a length along the normals where the surface has none of its own. Triangles
    /// that can carry no texels are left out.
    ///
    /// Edges may have any number of triangles, and the surface may be open.
    ///
    /// # Errors
    /// When lists don't agree, or there are no texture coordinates.
    pub fn facets(&self, thickness: f32) -> Result<SurfaceFacets, SurfaceError> {
        let mut surface = self.clone();
        surface.complete(thickness)?;
        Ok(surface.completed_facets())
    }

    /// Fills in normals and height vectors where there are none.
    ///
    /// # Errors
    /// As of [`facets`](Self::facets).
    pub(crate) fn complete(&mut self, thickness: f32) -> Result<(), SurfaceError> {
        self.check()?;
        if self.normals.is_empty() {
            self.normals = self.vertex_normals();
        }
        for normal in &mut self.normals {
            *normal = normal.normalize_or_zero();
        }
        if self.heights.is_empty() {
            let along = self.normals.iter().map(|&normal| normal * thickness);
            self.heights = along.collect();
        }
        Ok(())
    }

    /// The facets of a surface that was [completed](Self::complete).
    pub(crate) fn completed_facets(&self) -> SurfaceFacets {
        let mut found = SurfaceFacets::default();
        for (index, triangle) in (0..).zip(&self.triangles) {
            let vertices = triangle.map(|vertex| vertex as usize);
            let facet = Facet {
                positions: vertices.map(|vertex| self.positions[vertex]),
                heights: vertices.map(|vertex| self.heights[vertex]),
                uvs: vertices.map(|vertex| self.uvs[vertex]),
            };
            match facet.check() {
                Ok(()) => {
                    found.facets.push(facet);
                    found
                        .normals
                        .push(vertices.map(|vertex| self.normals[vertex]));
                    found.triangles.push(index);
                }
                Err(fault) => found.left_out.push((index, fault)),
            }
        }
        found
    }

    fn check(&self) -> Result<(), SurfaceError> {
        if self.triangles.is_empty() {
            return Err(SurfaceError::NoTriangles);
        }
        if self.uvs.is_empty() {
            return Err(SurfaceError::NoUvs);
        }
        let count = self.positions.len();
        for (what, found, may_be_empty) in [
            ("texture coordinates", self.uvs.len(), false),
            ("normals", self.normals.len(), true),
            ("height vectors", self.heights.len(), true),
        ] {
            if found != count && !(may_be_empty && found == 0) {
                return Err(SurfaceError::Count {
                    what,
                    found,
                    expected: count,
                });
            }
        }
        for (triangle, vertices) in self.triangles.iter().enumerate() {
            if let Some(&vertex) = vertices.iter().find(|&&vertex| vertex as usize >= count) {
                return Err(SurfaceError::MissingVertex {
                    triangle,
                    vertex,
                    count,
                });
            }
        }
        Ok(())
    }

    fn vertex_normals(&self) -> Vec<Vec3> {
        let mut normals = vec![Vec3::ZERO; self.positions.len()];
        for triangle in &self.triangles {
            let [a, b, c] = triangle.map(|vertex| self.positions[vertex as usize]);
            let normal = (b - a).cross(c - a);
            // A triangle that is no number must not spoil its neighbours.
            if normal.is_finite() {
                for vertex in triangle {
                    normals[*vertex as usize] += normal;
                }
            }
        }
        normals
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of two triangles.
    fn square() -> Surface {
        let corners = [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y];
        Surface {
            positions: corners.map(|corner| corner.extend(0.0)).to_vec(),
            uvs: corners.to_vec(),
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            ..Surface::default()
        }
    }

    #[test]
    fn height_vectors_are_those_given_or_follow_the_normals() {
        let mut surface = square();
        let heights = |surface: &Surface| surface.facets(0.5).unwrap().facets[0].heights;
        assert_eq!(heights(&surface), [Vec3::Z * 0.5; 3]);
        surface.normals = vec![Vec3::new(0.0, 3.0, 4.0); 4];
        assert_eq!(heights(&surface), [Vec3::new(0.0, 0.3, 0.4); 3]);
        surface.heights = vec![Vec3::new(0.1, 0.0, 2.0); 4];
        assert_eq!(heights(&surface), [Vec3::new(0.1, 0.0, 2.0); 3]);
        let normals = surface.facets(0.5).unwrap().normals;
        assert_eq!(normals, [[Vec3::new(0.0, 0.6, 0.8); 3]; 2]);
    }

    #[test]
    fn broken_triangles_are_left_out_and_named() {
        let mut surface = square();
        surface
            .positions
            .extend([Vec3::NAN, Vec3::new(2.0, 0.0, 0.0)]);
        surface.uvs.extend([Vec2::ONE, Vec2::ZERO]);
        surface.triangles.extend([[0, 1, 4], [0, 1, 5], [1, 5, 2]]);
        let found = surface.facets(0.5).unwrap();
        assert_eq!(found.triangles, [0, 1, 4]);
        let expected = [(2, FacetFault::NotFinite), (3, FacetFault::NoArea)];
        assert_eq!(found.left_out, expected);
    }

    #[test]
    fn surfaces_without_what_is_needed_are_refused() {
        let with = |change: &dyn Fn(&mut Surface)| {
            let mut surface = square();
            change(&mut surface);
            surface.facets(1.0).unwrap_err().to_string()
        };
        assert!(with(&|s| s.uvs.clear()).contains("no texture coordinates"));
        assert!(with(&|s| s.triangles.clear()).contains("no triangles"));
        assert!(with(&|s| s.triangles[1][2] = 9).contains("triangle 1: vertex 9 is not one of 4"));
        assert!(with(&|s| s.normals = vec![Vec3::Z]).contains("1 normals for 4 vertices"));
    }

    #[test]
    fn edges_of_many_triangles_are_fine() {
        let mut surface = square();
        // A fin on the diagonal.
        surface.positions.push(Vec3::new(0.5, 0.5, 1.0));
        surface.uvs.push(Vec2::new(0.9, 0.1));
        surface.triangles.push([0, 2, 4]);
        surface.heights = vec![Vec3::new(0.3, -0.3, 0.5); 5];
        assert_eq!(surface.facets(1.0).unwrap().facets.len(), 3);
    }
}
