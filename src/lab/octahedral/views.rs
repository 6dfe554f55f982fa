//! From where an impostor's pictures are taken, and the outline that holds them all.

use core::f32::consts::FRAC_PI_4;

use bevy::math::{Vec2, Vec3};

use crate::slicing::octagon::CORNERS;

/// The directions of the pictures: `side` × `side` points of the square that the upper half of the octahedron unfolds to.
pub(super) fn directions(side: u32) -> Vec<Vec3> {
    let along = |i: u32| 2.0 * i as f32 / (side - 1) as f32 - 1.0;
    let direction = |i: u32| {
        let (u, v) = (along(i % side), along(i / side));
        let (x, z) = (0.5 * (u + v), 0.5 * (u - v));
        Vec3::new(x, 1.0 - x.abs() - z.abs(), z).normalize()
    };
    (0..side * side).map(direction).collect()
}

/// The octagon with sides along the axes and the diagonals that holds some places.
pub(super) fn outline(places: &[Vec2]) -> [Vec2; CORNERS] {
    let side = |k: usize| Vec2::from_angle(k as f32 * FRAC_PI_4);
    let reach: [f32; CORNERS] = core::array::from_fn(|k| {
        let along = places.iter().map(|place| place.dot(side(k)));
        along.fold(0.0, f32::max)
    });
    // Where a side meets the next, 45° on.
    core::array::from_fn(|k| {
        let (a, b) = (reach[k], reach[(k + 1) % CORNERS]);
        let across = (b - a * FRAC_PI_4.cos()) / FRAC_PI_4.sin();
        side(k) * a + side(k).perp() * across
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_cover_the_upper_half_of_the_sphere() {
        let directions = directions(8);
        assert_eq!(directions.len(), 64);
        for probe in 0..1000 {
            let y = probe as f32 / 1000.0;
            let around = Vec2::from_angle(2.4 * probe as f32) * (1.0 - y * y).sqrt();
            let probe = Vec3::new(around.x, y, around.y);
            let nearest = directions.iter().map(|d| d.dot(probe)).fold(-1.0, f32::max);
            // Half a cell, 1/7, along both u and v is √2/7 on a face of the octahedron, whose middle is 1/√3 away: √6/7.
            assert!(nearest > 0.36_f32.cos(), "{probe}");
        }
        assert!(directions.iter().all(|d| d.y > -1e-6));
    }

    #[test]
    fn an_outline_holds_what_it_is_of() {
        let places: Vec<Vec2> = (0..50)
            .map(|i| Vec2::from_angle(i as f32) * (1.0 + (i % 7) as f32))
            .collect();
        let outline = outline(&places);
        for (a, b) in outline.iter().zip(outline.iter().cycle().skip(1)) {
            for place in &places {
                assert!((*b - *a).perp_dot(*place - *a) >= -1e-4, "{place}");
            }
        }
    }
}
