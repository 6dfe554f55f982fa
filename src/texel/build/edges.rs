//! Whether triangles enclose anything.

use std::collections::HashMap;

use bevy::math::Vec3;

use super::super::error::TexelError;

/// Checks that every edge has an even number of triangles, so that the surface is the border of a solid. Vertices are
/// the same where their positions are, to the last bit. Edges of which `may_be_open` is true of both ends need no
/// neighbour.
///
/// More than two triangles at an edge, as where two solids touch, are no fault as long as their number is even.
pub(super) fn check_closed(
    positions: &[Vec3],
    triangles: &[[u32; 3]],
    may_be_open: impl Fn(Vec3, Vec3) -> bool,
) -> Result<(), TexelError> {
    let mut edges: HashMap<[[u32; 3]; 2], (usize, bool)> = HashMap::new();
    for (index, &triangle) in triangles.iter().enumerate() {
        for (from, to) in sides(triangle) {
            let mut ends = [from, to].map(|vertex| key(positions[vertex as usize]));
            if ends[0] != ends[1] {
                ends.sort_unstable();
                let (_, odd) = edges.entry(ends).or_insert((index, false));
                *odd = !*odd;
            }
        }
    }
    let open = edges.iter().filter(|&(ends, &(_, odd))| {
        odd && {
            let [from, to] = ends.map(position);
            !may_be_open(from, to)
        }
    });
    let mut open: Vec<_> = open
        .map(|(ends, &(triangle, _))| (triangle, *ends))
        .collect();
    let edges = open.len();
    open.sort_unstable();
    match open.first() {
        Some(&(triangle, ends)) => {
            let [from, to] = ends.map(position);
            Err(TexelError::Open {
                edges,
                triangle,
                from,
                to,
            })
        }
        None => Ok(()),
    }
}

fn sides([a, b, c]: [u32; 3]) -> [(u32, u32); 3] {
    [(a, b), (b, c), (c, a)]
}

/// A position as what can be compared; −0 is 0.
fn key(position: Vec3) -> [u32; 3] {
    (position + Vec3::ZERO).to_array().map(f32::to_bits)
}

fn position(key: [u32; 3]) -> Vec3 {
    Vec3::from_array(key.map(f32::from_bits))
}
