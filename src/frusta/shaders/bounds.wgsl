#define_import_path bevy_verdure::frusta::bounds

// Bounding primitives (§2.6). Term for term `math/bounds.rs`, which tells why.

#import bevy_verdure::frusta::types::{Frustum, End, CUT, ROUND, FLAT}

const STEEP: f32 = 0.05;

struct Bounds {
    axis: vec3<f32>,
    side: vec3<f32>,
    other: vec3<f32>,
    radius: f32,
    slope: f32,
    start_normal: vec3<f32>,
    start_offset: f32,
    end_normal: vec3<f32>,
    end_offset: f32,
    // False for a frustum that draws nothing.
    drawn: bool,
}

fn any_orthonormal_vector(n: vec3<f32>) -> vec3<f32> {
    let s = select(-1.0, 1.0, n.z >= 0.0);
    let a = -1.0 / (s + n.z);
    let b = n.x * n.y * a;
    return vec3(b, s + n.y * n.y * a, -n.y);
}

fn extent(frustum: Frustum, end: End, at_joint: f32, outward: f32) -> vec2<f32> {
    if end.kind == FLAT {
        return vec2(0.0, 0.0);
    }
    if end.kind == ROUND {
        return vec2(outward * end.radius);
    }
    let m = dot(end.normal, frustum.axis);
    let q = length(cross(end.normal, frustum.axis));
    let y1 = (end.offset - at_joint * q) / max(m + frustum.slope * q, STEEP * STEEP);
    let y2 = (end.offset + at_joint * q) / max(m - frustum.slope * q, STEEP * STEEP);
    return vec2(min(y1, y2), max(y1, y2));
}

fn bounds(frustum: Frustum, margin: f32) -> Bounds {
    let axis = frustum.axis;
    let length = frustum.length;
    if frustum.radius <= 0.0 {
        return sphere_bounds(frustum, margin);
    }
    let at_end = frustum.radius + frustum.slope * length;
    let low_end = extent(frustum, frustum.start, frustum.radius, -1.0).x;
    let high_end = extent(frustum, frustum.end, at_end, 1.0).y + length;
    let low = min(low_end, high_end);
    let high = max(low_end, high_end);
    let tilt_start = cross(frustum.start.normal, axis);
    let tilt_end = cross(frustum.end.normal, axis);
    var tilt = tilt_end;
    if dot(tilt_start, tilt_start) > dot(tilt_end, tilt_end) {
        tilt = tilt_start;
    }
    // normal × axis is across both; the tilt itself lies across that and the axis.
    var side = cross(tilt, axis);
    let steepness = length_squared(side);
    if steepness > 1e-30 {
        side = side * inverseSqrt(steepness);
    } else {
        side = any_orthonormal_vector(axis);
    }
    let width = widths(frustum, low, high);
    var bounds: Bounds;
    bounds.axis = axis;
    bounds.side = side;
    bounds.other = cross(axis, side);
    bounds.radius = width.x + margin;
    bounds.slope = width.y;
    bounds.start_normal = axis;
    bounds.start_offset = low - margin;
    bounds.end_normal = axis;
    bounds.end_offset = high + margin;
    bounds.drawn = true;
    let level = bounds;
    if frustum.start.kind == CUT {
        bounds.start_normal = frustum.start.normal;
        bounds.start_offset = frustum.start.offset - margin;
    }
    if frustum.end.kind == CUT {
        let n = frustum.end.normal;
        bounds.end_normal = n;
        bounds.end_offset = frustum.end.offset + dot(n, axis) * length + margin;
    }
    if !is_convex(bounds) {
        bounds = level;
    }
    return bounds;
}

fn length_squared(v: vec3<f32>) -> f32 {
    return dot(v, v);
}

fn sphere_bounds(frustum: Frustum, margin: f32) -> Bounds {
    var bounds: Bounds;
    var centre = 0.0;
    var radius = 0.0;
    if frustum.end.kind == ROUND {
        centre = frustum.length;
        radius = frustum.end.radius;
    } else if frustum.start.kind == ROUND {
        radius = frustum.start.radius;
    } else {
        bounds.drawn = false;
        return bounds;
    }
    bounds.axis = frustum.axis;
    bounds.side = any_orthonormal_vector(frustum.axis);
    bounds.other = cross(frustum.axis, bounds.side);
    bounds.radius = radius + margin;
    bounds.slope = 0.0;
    bounds.start_normal = frustum.axis;
    bounds.start_offset = centre - radius - margin;
    bounds.end_normal = frustum.axis;
    bounds.end_offset = centre + radius + margin;
    bounds.drawn = true;
    return bounds;
}

// Axial distance at which the edge of a corner meets a plane, and the slope it meets it with.
fn cut(bounds: Bounds, across: vec3<f32>, normal: vec3<f32>, offset: f32) -> vec2<f32> {
    let q = dot(normal, across);
    let m = dot(normal, bounds.axis) + bounds.slope * q;
    return vec2((offset - bounds.radius * q) / m, m);
}

fn corner_across(bounds: Bounds, corner: u32) -> vec3<f32> {
    let u = select(bounds.side, -bounds.side, (corner & 1u) == 0u);
    let w = select(bounds.other, -bounds.other, (corner & 2u) == 0u);
    return u + w;
}

fn is_convex(bounds: Bounds) -> bool {
    for (var corner = 0u; corner < 4u; corner++) {
        let across = corner_across(bounds, corner);
        let l = cut(bounds, across, bounds.start_normal, bounds.start_offset);
        let u = cut(bounds, across, bounds.end_normal, bounds.end_offset);
        if !(l.y > STEEP && u.y > STEEP && l.x < u.x) {
            return false;
        }
    }
    return true;
}

// The position of a corner, 0 to 7, relative to the frustum's base.
fn bounds_corner(bounds: Bounds, corner: u32) -> vec3<f32> {
    let across = corner_across(bounds, corner);
    var y = cut(bounds, across, bounds.start_normal, bounds.start_offset).x;
    if (corner & 4u) != 0u {
        y = cut(bounds, across, bounds.end_normal, bounds.end_offset).x;
    }
    return bounds.axis * y + across * max(bounds.radius + bounds.slope * y, 0.0);
}

// Greatest distance from the axis of what the bounds hold.
fn bounds_width(bounds: Bounds) -> f32 {
    var widest = 0.0;
    for (var corner = 0u; corner < 8u; corner++) {
        // A corner is √2 times as far from the axis as the sides that meet there.
        let position = bounds_corner(bounds, corner);
        widest = max(widest, abs(dot(position, bounds.side)));
    }
    return widest;
}

fn widths(frustum: Frustum, low: f32, high: f32) -> vec2<f32> {
    let r_low = max(frustum.radius + frustum.slope * low, 0.0);
    let r_high = max(frustum.radius + frustum.slope * high, 0.0);
    let start = end_width(frustum, frustum.start, 0.0, r_low);
    let end = end_width(frustum, frustum.end, frustum.length, r_high);
    let widest = max(start.x, end.x);
    let bulges = start.y + end.y > 0.0;
    let along = r_low * r_low + r_low * r_high + r_high * r_high;
    if bulges || 3.0 * widest * widest < along {
        return vec2(widest, 0.0);
    }
    return vec2(frustum.radius, frustum.slope);
}

// Greatest radius of an end, and 1 if its cap bulges out of the cone.
fn end_width(frustum: Frustum, end: End, base: f32, r_cut: f32) -> vec2<f32> {
    if end.kind != ROUND {
        return vec2(r_cut, 0.0);
    }
    let at_plane = frustum.radius + frustum.slope * (base + end.offset);
    let touching = end.radius * sqrt(1.0 + frustum.slope * frustum.slope);
    let at_joint = frustum.radius + frustum.slope * base;
    return vec2(max(end.radius, at_plane), select(0.0, 1.0, at_joint < touching * (1.0 - 1e-4)));
}
