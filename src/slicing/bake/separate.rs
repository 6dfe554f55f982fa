//! Solid and sparse parts of a plant (§2.1).

use bevy::math::Vec3;
use bevy::platform::collections::HashMap;

use super::source::CrownMesh;

/// The parts of a plant.
#[derive(Clone, Debug, PartialEq)]
pub struct Separation {
    /// Trunk and limbs: what stays a mesh ([`CrownMesh::to_mesh`]).
    pub solid: CrownMesh,
    /// Twigs and leaves: what is baked.
    pub sparse: CrownMesh,
}

/// Parts a plant's triangles by connected component: those whose box has a diagonal of at least `share` of the whole
/// plant's are solid. Corners at the very same position are connected. A good first try is 0.25: a trunk with its limbs
/// is one large component, leaves are many small ones. From 0 down all are solid, above 1 none is, and none of no number.
///
/// Where parts are known by name, put them into two crowns instead, mesh by mesh.
pub fn separate(plant: &CrownMesh, share: f32) -> Separation {
    let mut ids: HashMap<[u32; 3], usize> = HashMap::default();
    let mut parents: Vec<usize> = Vec::new();
    let corners: Vec<[usize; 3]> = plant
        .triangles
        .iter()
        .map(|triangle| {
            triangle.positions().map(|position| {
                // Adding 0 makes −0 and 0 one.
                let key = position.to_array().map(|x| (x + 0.0).to_bits());
                *ids.entry(key).or_insert_with(|| {
                    parents.push(parents.len());
                    parents.len() - 1
                })
            })
        })
        .collect();
    for [a, b, c] in &corners {
        for other in [b, c] {
            let (from, to) = (root(&mut parents, *a), root(&mut parents, *other));
            parents[from] = to;
        }
    }
    let mut boxes: HashMap<usize, (Vec3, Vec3)> = HashMap::default();
    for (triangle, corners) in plant.triangles.iter().zip(&corners) {
        let known = boxes
            .entry(root(&mut parents, corners[0]))
            .or_insert((triangle.vertices[0].position, triangle.vertices[0].position));
        for position in triangle.positions() {
            *known = (known.0.min(position), known.1.max(position));
        }
    }
    let whole = plant.bounds().map_or(0.0, |(low, high)| low.distance(high));
    let part = || CrownMesh {
        triangles: Vec::new(),
        materials: plant.materials.clone(),
    };
    let (mut solid, mut sparse) = (part(), part());
    for (triangle, corners) in plant.triangles.iter().zip(&corners) {
        let (low, high) = boxes[&root(&mut parents, corners[0])];
        let is_solid = low.distance(high) >= share * whole;
        let part = if is_solid { &mut solid } else { &mut sparse };
        part.triangles.push(*triangle);
    }
    Separation { solid, sparse }
}

/// The representative of a set, with the way to it halved.
fn root(parents: &mut [usize], mut of: usize) -> usize {
    while parents[of] != of {
        parents[of] = parents[parents[of]];
        of = parents[of];
    }
    of
}
