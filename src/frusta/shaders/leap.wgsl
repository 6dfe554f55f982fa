#define_import_path bevy_verdure::frusta::leap

// Leaping over steps of a march that are in air.
//
// A ceiling is the greatest height of a mip level's pixel and its eight neighbours (`relief/ceilings.rs`): while a ray
// is above it, and its u and v stay in or near that pixel, there is nothing to hit. How far it stays above it is told by
// the ray's slope: the distance to the cone, or ball, of one height is convex along a ray, and nowhere below its tangent.

#import bevy_verdure::frusta::cast::{CONE, END}
#import bevy_verdure::frusta::relief::{Shell, relief_map, map_place, part_of, TAU}
#import bevy_verdure::frusta::shell_radii::relief

// How far u and v may move from a pixel of a ceiling, in its pixels. Ceilings are at least two levels coarser than the
// heights that are looked at, so that a tap and the boxes of its levels reach 2.5 / 4 of a pixel.
const FARTHEST: f32 = 0.375;
// Sides of this many pixels and fewer are covered whole by a pixel and its neighbours.
const COVERED: f32 = 3.0;

// The first level whose ceilings are kept: they lie one after the other in the map's green channel, all in its finest
// level, since drivers may read one mip level for four neighbouring pixels.
const FIRST_LEVEL: i32 = 2;

// Pixels of a level.
fn level_size(level: i32) -> vec2<f32> {
    return max(floor(relief.size * exp2(-f32(level))), vec2(1.0));
}

// The first level that may serve as a ceiling over heights of some level, and the last.
fn ceiling_levels(lod: f32) -> vec2<i32> {
    let last = i32(textureNumLevels(relief_map)) - 1;
    return vec2(min(i32(ceil(lod)) + FIRST_LEVEL, last), last);
}

// The level of which a pixel is so wide that a leap over this many pixels of the map can be sure.
fn ceiling_level(pixels: f32, levels: vec2<i32>) -> i32 {
    return clamp(i32(ceil(log2(max(pixels / FARTHEST, 1.0)))), levels.x, levels.y);
}

// The height that nothing about (u, v) is above, between floor and top.
fn ceiling_over(shell: Shell, c: vec3<f32>, level: i32) -> f32 {
    if level < FIRST_LEVEL {
        return 1.0;
    }
    let size = level_size(level);
    let cell = min(floor(fract(map_place(shell, c.x, c.y)) * size), size - 1.0);
    let index = f32(relief.ceilings[level / 4][level % 4]) + cell.y * size.x + cell.x;
    let row = floor((index + 0.5) / relief.size.x);
    let pixel = vec2<i32>(vec2(index - row * relief.size.x, row));
    let h = textureLoad(relief_map, pixel, 0).g;
    return (h - relief.range.x) / (relief.range.y - relief.range.x);
}

// How far along the ray, counted in `d`, a point above a ceiling may leap: it stays above for sure, and near as far as its
// own speed tells.
fn leap(shell: Shell, point: vec3<f32>, d: vec3<f32>, ceiling: f32, level: i32) -> f32 {
    let axis = shell.top.axis;
    let part = part_of(shell, point);
    let y = dot(point, axis);
    let radial = point - axis * y;
    let distance = max(length(radial), 1e-6);
    // Distance to the ceiling's cone or ball, and how fast it grows.
    var above: f32;
    var growth: f32;
    if part == CONE {
        let slope = mix(shell.floor.slope, shell.top.slope, ceiling);
        above = distance - mix(shell.floor.radius, shell.top.radius, ceiling) - slope * y;
        growth = dot(radial, d) / distance - slope * dot(axis, d);
    } else {
        var x = point;
        var radius = mix(shell.floor.start.radius, shell.top.start.radius, ceiling);
        if part == END {
            x = point - axis * shell.top.length;
            radius = mix(shell.floor.end.radius, shell.top.end.radius, ceiling);
        }
        above = length(x) - radius;
        growth = dot(x, d) / max(length(x), 1e-6);
    }
    let dv = dot(axis, d) / max(shell.top.length, 1e-6);
    let du = dot(cross(axis, radial), d) / (TAU * distance * distance) + dv * shell.twist / TAU;
    let near = FARTHEST / max(in_pixels(shell, du, dv, level), 1e-6);
    return select(near, min(above / -growth, near), growth < 0.0);
}

// True if a leap was sure: within one part of the shell, and as near as the ceiling tells of.
fn is_sure(
    shell: Shell,
    start: vec3<f32>,
    landing: vec3<f32>,
    start_c: vec3<f32>,
    landing_c: vec3<f32>,
    ceiling: f32,
    level: i32,
) -> bool {
    let dv = landing_c.y - start_c.y;
    // Twist turns u as v moves; what is left of u is an angle, which along a straight line changes by less than half a
    // turn.
    let twisted = dv * shell.twist / TAU;
    let turned = landing_c.x - start_c.x - twisted;
    let du = turned - round(turned) + twisted;
    return part_of(shell, start) == part_of(shell, landing)
        && landing_c.z > ceiling
        && in_pixels(shell, du, dv, level) <= FARTHEST;
}

// A change of u and v in pixels of a level; nothing along sides that are covered whole.
fn in_pixels(shell: Shell, du: f32, dv: f32, level: i32) -> f32 {
    let size = level_size(level);
    let moved = map_place(shell, du, dv) - map_place(shell, 0.0, 0.0);
    let pixels = select(abs(moved) * size, vec2(0.0), size <= vec2(COVERED));
    return max(pixels.x, pixels.y);
}
