//! Broadleaf: a round-crowned tree in leaf, as triangles rather than a skeleton.

mod crown;
mod wood;

use bevy::mesh::Mesh;

use crate::plants::dice::Dice;
use crate::plants::shape::within;

/// A tree in leaf, with a short trunk and a round crown: the paper's test of slicing (see
/// [`slicing`](crate::slicing)), as triangles. Its solid part is meant to be drawn as it is, its twigs and leaves to be
/// baked; beside its slicing, the same triangles are what it is judged by.
///
/// It has exactly as many triangles as asked for; by default those of the paper's Figure 1: 200 of trunk and limbs,
/// 8,093 of twigs, 11,564 of leaves. A limb's piece takes 10, a twig 3, a leaf 2; what is left over makes one twig or
/// leaf of fewer. The same parameters and seed grow the same tree.
#[derive(Clone, Debug, PartialEq)]
pub struct Broadleaf {
    /// Height, in metres; 1 to 60.
    pub height: f32,
    /// Width of the crown, in metres; 0.5 to 60.
    pub width: f32,
    /// Triangles of trunk and limbs; 100 to 10,000.
    pub solid_triangles: u32,
    /// Triangles of twigs; 3 to 1,000,000.
    pub twig_triangles: u32,
    /// Triangles of leaves; 0 to 1,000,000.
    pub leaf_triangles: u32,
    /// Length of a leaf, in metres; 0.005 to 2.
    pub leaf_length: f32,
}

impl Default for Broadleaf {
    fn default() -> Self {
        Self {
            height: 8.5,
            width: 6.5,
            solid_triangles: 200,
            twig_triangles: 8093,
            leaf_triangles: 11_564,
            leaf_length: 0.24,
        }
    }
}

/// The meshes of a [`Broadleaf`], in metres, y up, the foot of the trunk at the origin: positions, normals and linear
/// vertex colours, in indexed triangles.
#[derive(Clone, Debug)]
pub struct BroadleafMeshes {
    /// Trunk and limbs.
    pub solid: Mesh,
    /// Twigs, each a three-sided spike.
    pub twigs: Mesh,
    /// Leaves, each folded along its midrib.
    pub leaves: Mesh,
}

impl Broadleaf {
    /// Grows a tree. Values outside their ranges are brought into them, and those that are not finite replaced by the
    /// default's.
    pub fn grow(&self, seed: u64) -> BroadleafMeshes {
        let normal = Self::default();
        let tree = Self {
            height: within(self.height, 1.0, 60.0, normal.height),
            width: within(self.width, 0.5, 60.0, normal.width),
            solid_triangles: self.solid_triangles.clamp(100, 10_000),
            twig_triangles: self.twig_triangles.clamp(3, 1_000_000),
            leaf_triangles: self.leaf_triangles.min(1_000_000),
            leaf_length: within(self.leaf_length, 0.005, 2.0, normal.leaf_length),
        };
        let mut dice = Dice::new(seed);
        let (solid, limbs) = wood::solid(&tree, &mut dice.split());
        let (twigs, leaves) = crown::grow(&tree, &limbs, &mut dice.split());
        BroadleafMeshes {
            solid,
            twigs,
            leaves,
        }
    }
}

#[cfg(test)]
mod tests {
    use bevy::mesh::VertexAttributeValues;

    use super::*;

    fn positions(mesh: &Mesh) -> &[[f32; 3]] {
        mesh.attribute(Mesh::ATTRIBUTE_POSITION)
            .and_then(VertexAttributeValues::as_float3)
            .expect("positions")
    }

    fn triangles(mesh: &Mesh) -> usize {
        mesh.indices().map_or(0, |indices| indices.len() / 3)
    }

    #[test]
    fn the_default_tree_has_the_triangles_of_the_papers_figure_1() {
        for seed in 0..5 {
            let tree = Broadleaf::default().grow(seed);
            assert_eq!(triangles(&tree.solid), 200);
            assert_eq!(triangles(&tree.twigs), 8093);
            assert_eq!(triangles(&tree.leaves), 11_564);
        }
    }

    #[test]
    fn a_tree_has_as_many_triangles_as_asked_for_and_they_are_finite() {
        for (solid, twigs, leaves) in [(100, 3, 0), (1234, 4, 1), (107, 5000, 777)] {
            for odd in [f32::NAN, 0.0, -1.0, f32::INFINITY, 9.0] {
                let tree = Broadleaf {
                    height: odd,
                    width: odd,
                    leaf_length: odd,
                    solid_triangles: solid,
                    twig_triangles: twigs,
                    leaf_triangles: leaves,
                }
                .grow(3);
                let all = [
                    (&tree.solid, solid),
                    (&tree.twigs, twigs),
                    (&tree.leaves, leaves),
                ];
                for (mesh, count) in all {
                    assert_eq!(triangles(mesh), count as usize);
                    assert!(positions(mesh).iter().flatten().all(|x| x.is_finite()));
                }
            }
        }
    }

    #[test]
    fn the_crown_keeps_to_its_size_and_the_same_seed_grows_the_same_tree() {
        let tree = Broadleaf::default().grow(7);
        for mesh in [&tree.twigs, &tree.leaves] {
            for [x, y, z] in positions(mesh) {
                // Leaves stand out beyond the crown's outline by their length and a twig's.
                assert!(
                    x.hypot(*z) < 0.5 * 6.5 + 0.8 && (1.0..8.5 + 0.8).contains(y),
                    "{x} {y} {z}"
                );
            }
        }
        let again = Broadleaf::default().grow(7);
        assert_eq!(positions(&tree.leaves), positions(&again.leaves));
        assert_ne!(
            positions(&tree.leaves),
            positions(&Broadleaf::default().grow(8).leaves)
        );
    }
}
