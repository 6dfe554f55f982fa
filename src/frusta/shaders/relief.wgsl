#define_import_path bevy_verdure::frusta::relief

// The shell of a segment, and where a point lies in it: u, v, and the height that the map is compared with (§3).

#import bevy_pbr::pbr_bindings
#import bevy_pbr::mesh_bindings::mesh
#import bevy_verdure::frusta::types::{Frustum, joints, plants, shapes, reference_across, ROUND}
#import bevy_verdure::frusta::cast::{NO_ROOT, CONE, START, END}
#import bevy_verdure::frusta::place::{Varying, frustum_of, segment_of}
#import bevy_verdure::frusta::shell::leant
#import bevy_verdure::frusta::shell_radii::relief

const TAU: f32 = 6.283185307179586;

@group(#{MATERIAL_BIND_GROUP}) @binding(104) var relief_map: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(105) var relief_sampler: sampler;

// The shell of a segment.
struct Shell {
    // Frusta of the map's greatest and least height.
    top: Frustum,
    floor: Frustum,
    // Where the next segment takes over from the ball of a round join.
    beyond: vec4<f32>,
    skew: vec3<f32>,
    reference: vec3<f32>,
    twist: f32,
    v_start: f32,
    v_length: f32,
    // Mean length of a world's metre in local space.
    metre: f32,
}

fn shell_of(in: Varying) -> Shell {
    let plant = plants[mesh[in.instance_index].tag];
    let segment = segment_of(in);
    let shape = shapes[plant.first_shape + segment];
    var shell: Shell;
    shell.top = frustum_of(in);
    shell.floor = shell.top;
    shell.floor.radius = in.floor.x;
    shell.floor.slope = in.floor.y;
    shell.floor.start.radius = in.floor.z;
    shell.floor.end.radius = in.floor.w;
    shell.beyond = in.beyond;
    shell.skew = in.skew_metre.xyz;
    shell.metre = in.skew_metre.w;
    shell.reference = reference_across(joints[plant.first_joint + segment].reference, shell.top.axis);
    shell.twist = shape.twist;
    shell.v_start = shape.v_start;
    shell.v_length = shape.v_end - shape.v_start;
    return shell;
}

// The part of the shell that a point lies in.
fn part_of(shell: Shell, point: vec3<f32>) -> u32 {
    let top = shell.top;
    if top.end.kind == ROUND && dot(top.end.normal, point - top.axis * top.length) > top.end.offset {
        return END;
    }
    if top.start.kind == ROUND && dot(top.start.normal, point) < top.start.offset {
        return START;
    }
    return CONE;
}

// A point in the shell: the turn of u before twist, v, and the height between floor and top. Heights of 1 and more, as
// of points that belong to the next segment, are air.
fn coordinates(shell: Shell, point: vec3<f32>) -> vec3<f32> {
    let part = part_of(shell, point);
    if part == CONE {
        let c = cone_coordinates(shell, point);
        return vec3(turn_of(shell, c.across, c.v), c.v, c.w);
    }
    var x = point;
    var inner = shell.floor.start.radius;
    var outer = shell.top.start.radius;
    var v = 0.0;
    if part == END {
        x = point - shell.top.axis * shell.top.length;
        inner = shell.floor.end.radius;
        outer = shell.top.end.radius;
        v = 1.0;
        if dot(shell.beyond.xyz, x) > shell.beyond.w {
            return vec3(0.0, 1.0, 2.0);
        }
    }
    let w = (length(x) - inner) / (outer - inner);
    return vec3(turn_of(shell, ball_across(shell, x, part), v), v, w);
}

struct ConeCoordinates {
    // Unit vector across the axis, away from it.
    across: vec3<f32>,
    v: f32,
    w: f32,
}

fn cone_coordinates(shell: Shell, point: vec3<f32>) -> ConeCoordinates {
    let top = shell.top;
    let axis = top.axis;
    let y = dot(point, axis);
    let radial = point - axis * y;
    let distance = length(radial);
    var across = shell.reference;
    if distance > 0.0 {
        across = radial / distance;
    }
    let r_0 = shell.floor.radius + shell.floor.slope * y;
    let r_1 = top.radius + top.slope * y;
    let w = (distance - r_0) / (r_1 - r_0);
    let slope = shell.floor.slope + (top.slope - shell.floor.slope) * max(w, 0.0);
    let g = axis + across * slope;
    let a = (dot(top.start.normal, point) - top.start.offset) * dot(top.end.normal, g);
    let b = (top.end.offset - dot(top.end.normal, point - axis * top.length)) * dot(top.start.normal, g);
    return ConeCoordinates(across, clamp(a / (a + b), 0.0, 1.0), w);
}

// The direction across the axis that a point of a ball is seen in; at a round join turned from one axis to the other.
fn ball_across(shell: Shell, x: vec3<f32>, part: u32) -> vec3<f32> {
    let m1 = shell.top.axis;
    var point = x;
    if part == END && shell.beyond.w < NO_ROOT {
        let a = max(dot(shell.top.end.normal, x) - shell.top.end.offset, 0.0);
        let b = max(shell.beyond.w - dot(shell.beyond.xyz, x), 0.0);
        let between = m1 * b + shell.beyond.xyz * a;
        let size = length(between);
        if size > 0.0 {
            let axis = between / size;
            let v = cross(axis, m1);
            let cosine = dot(axis, m1);
            point = x * cosine + cross(v, x) + v * (dot(v, x) / max(1.0 + cosine, 1e-6));
        }
    }
    let radial = point - m1 * dot(point, m1);
    let distance = length(radial);
    return select(shell.reference, radial / distance, distance > 0.0);
}

// u of a direction across the axis, for the v that twist and skew are taken at; not brought to 0..1.
fn turn_of(shell: Shell, across: vec3<f32>, v: f32) -> f32 {
    let seen = leant(across, shell.skew * (v - 1.0));
    let side = cross(shell.top.axis, shell.reference);
    return (atan2(dot(seen, side), dot(seen, shell.reference)) + v * shell.twist) / TAU;
}

// Where the map is read for (u, v).
fn map_place(shell: Shell, u: f32, v: f32) -> vec2<f32> {
    return (pbr_bindings::material.uv_transform * vec3(u, shell.v_start + shell.v_length * v, 1.0)).xy;
}

// The map's height at (u, v), between floor and top.
fn height(shell: Shell, u: f32, v: f32, lod: f32) -> f32 {
    let h = textureSampleLevel(relief_map, relief_sampler, map_place(shell, u, v), lod).r;
    return (h - relief.range.x) / (relief.range.y - relief.range.x);
}

// The mip level for a screen's pixel that is so many pixels of the map wide. A level's own pixels are boxes already, that
// interpolation and differences widen to about twice a pixel: one level finer, what is seen is a pixel wide.
fn mip_level(width: f32) -> f32 {
    return max(log2(width) - 1.0, 0.0);
}

// Pixels of the map that u and the map's v cover each time that they repeat.
fn map_pixels() -> vec2<f32> {
    let m = pbr_bindings::material.uv_transform;
    return vec2(length(m[0].xy * relief.size), length(m[1].xy * relief.size));
}

// Pixels of the map a metre, along u at a distance from the axis, and along v.
fn map_density(shell: Shell, distance: f32) -> vec2<f32> {
    let metres = vec2(TAU * max(distance, 1e-6), max(shell.top.length, 1e-6) / max(abs(shell.v_length), 1e-6));
    return map_pixels() / metres;
}
