//! Stones, walls of them, and what is seen of a well's inside.

use bevy::math::{Vec2, Vec3};

use super::Paint;
use super::noise::{Noise, again, unit};
use crate::plants::shape::{mix, smooth};

/// A boulder: broad hollows, grain, lichen.
pub(super) fn boulder(uv: Vec2) -> Paint {
    // Turned by an eighth, which keeps it whole, a second lattice hides the first.
    let turned = Vec2::new(uv.x + uv.y, uv.y - uv.x);
    let broad = 0.6 * Noise::new(4, 4, 101).fractal(uv, 2)
        + 0.75 * Noise::new(3, 3, 106).fractal(turned, 2);
    let facet = Noise::new(5, 5, 102).cell(uv, 0.9, Vec2::ONE);
    let dome = 1.0 - facet.offset.length_squared().min(1.0);
    let grain = Noise::new(12, 12, 103).fractal(turned, 3);
    let height = 0.36 + 0.36 * broad + 0.38 * dome + 0.09 * grain;
    let grey = Vec3::new(0.26, 0.225, 0.18).lerp(
        Vec3::new(0.33, 0.27, 0.2),
        smooth(-0.6, 0.6, Noise::new(2, 2, 104).fractal(turned, 3)),
    );
    let lichen = smooth(0.28, 0.6, Noise::new(5, 5, 105).fractal(turned, 3));
    let color = (grey * (1.0 + 0.28 * grain) * mix(0.72, 1.06, smooth(0.1, 0.7, height)))
        .lerp(Vec3::new(0.3, 0.3, 0.215), 0.5 * lichen);
    Paint::new(color, height)
}

/// Where the courses of a map begin, as shares of its length, and how many stones each has.
const COURSES: [(f32, i32); 5] = [(0.0, 15), (0.21, 17), (0.39, 14), (0.62, 16), (0.81, 18)];

/// Courses of rough ashlar, pitched faces, recessed mortar.
pub(super) fn masonry(uv: Vec2) -> Paint {
    // A mason's line is not a ruler's.
    let warp = Vec2::new(
        Noise::new(48, 12, 111).gradient(uv) * 0.0014,
        Noise::new(24, 4, 112).fractal(uv, 2) * 0.014,
    );
    let Block { id, edge } = block(uv + warp);
    let ragged = Noise::new(72, 14, 113).fractal(uv, 2);
    let edge = edge + 0.0011 * ragged;
    let face = smooth(0.0012, 0.006, edge);
    // Pitched faces stand out towards their middle, each as far and as slanted as its mason left it.
    let pillow = smooth(0.001, 0.02, edge);
    let chisel = Noise::new(56, 12, 114).fractal(uv, 3);
    let broad = Noise::new(20, 5, 115).gradient(uv);
    let own = unit(again(id, 1)) - 0.5;
    let mortar = 0.16 + 0.07 * Noise::new(96, 20, 116).gradient(uv);
    let stone = 0.68 + 0.15 * pillow + 0.15 * own * pillow + 0.1 * chisel + 0.1 * broad * pillow;
    let height = mix(mortar, stone, face);

    let hues = [
        Vec3::new(0.41, 0.335, 0.235),
        Vec3::new(0.36, 0.31, 0.24),
        Vec3::new(0.43, 0.325, 0.205),
        Vec3::new(0.325, 0.295, 0.25),
    ];
    let hue = hues[(again(id, 2) % 4) as usize] * mix(0.86, 1.1, unit(again(id, 3)));
    let stain = smooth(0.0, 0.8, Noise::new(14, 3, 117).fractal(uv, 4));
    let hue = hue * (1.0 + 0.2 * chisel) * (1.0 - 0.28 * stain);
    let lime = Vec3::new(0.3, 0.265, 0.21) * (1.0 + 0.12 * chisel);
    Paint::new(lime.lerp(hue, face), height)
}

/// A block of a wall, as seen from a point.
struct Block {
    id: u32,
    /// To the middle of the nearest joint, in circumferences, round the corners of blocks.
    edge: f32,
}

fn block(uv: Vec2) -> Block {
    let v = uv.y.rem_euclid(1.0);
    let course = COURSES
        .iter()
        .rposition(|(start, _)| *start <= v)
        .unwrap_or(0);
    let (start, stones) = COURSES[course];
    let end = COURSES.get(course + 1).map_or(1.0, |(start, _)| *start);
    let lattice = Noise::new(stones, COURSES.len() as i32, 118);
    let joint = |i: i32| {
        let id = lattice.id((i, course as i32).into());
        (i as f32 + 0.42 * (unit(id) - 0.5), id)
    };
    let along = uv.x * stones as f32 + 0.37 * course as f32;
    let near = along.floor() as i32;
    // The stone between two joints: joints stray by less than half a stone.
    let first = (near - 1..=near + 1).rfind(|i| joint(*i).0 <= along);
    let first = first.unwrap_or(near - 1);
    let ((left, id), (right, _)) = (joint(first), joint(first + 1));
    let across = (along - left).min(right - along) / stones as f32;
    let up = (v - start).min(end - v) * super::finish::MASONRY_LENGTH;
    let corner = 0.009;
    let inner = Vec2::new(corner - across, corner - up).max(Vec2::ZERO);
    let edge = if inner.min_element() > 0.0 {
        (corner - inner.length()).max(0.0)
    } else {
        across.min(up)
    };
    Block { id, edge }
}

/// A well's shaft from above: nothing to see.
pub(super) fn shaft(uv: Vec2) -> Paint {
    let wet = Noise::new(4, 4, 119).gradient(uv);
    Paint::flat(Vec3::new(0.006, 0.0075, 0.008) * (1.0 + 0.1 * wet))
}

/// Still water over mud: what it reflects is the scene's.
pub(super) fn water(uv: Vec2) -> Paint {
    let depth = Noise::new(2, 2, 120).gradient(uv);
    Paint::flat(Vec3::new(0.014, 0.033, 0.032) * (1.0 + 0.06 * depth))
}
