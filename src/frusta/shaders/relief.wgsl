#define_import_path bevy_verdure::frusta::relief

// Marching a ray through the shell (§3).
//
// The shell that is marched lies between the cones of the map's least and greatest height. With the balls of its round
// ends, less what the planes cut away, it is convex: a ray has one stretch in it, from where it enters to where it
// leaves, or to the floor, which is solid all through. In steps along that stretch the ray's height is compared with the
// map's; the step that goes below is halved.

#import bevy_pbr::pbr_bindings
#import bevy_pbr::mesh_bindings::mesh
#import bevy_verdure::frusta::types::{Frustum, End, joints, plants, shapes, reference_across, ROUND, FLAT}
#import bevy_verdure::frusta::cast::{Ray, Hit, cast_ray, cone_roots, NO_ROOT, CONE, START, END}
#import bevy_verdure::frusta::place::{Varying, frustum_of, segment_of}
#import bevy_verdure::frusta::shell::leant
#import bevy_verdure::frusta::shell_radii::relief
#import bevy_verdure::frusta::view::pixel_width

const TAU: f32 = 6.283185307179586;
// Steps of a march that picks their number: at least, and at most.
const LEAST_STEPS: f32 = 3.0;
const MOST_STEPS: f32 = 64.0;
// Cosine between a segment's planes below which v is never interpolated: that of 45°.
const BENT: f32 = 0.7071068;

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

// The part of a ray within the top frustum and its balls, from `least_t` on; t measured from `p`. Empty where x ≥ y.
fn stretch(p: vec3<f32>, d: vec3<f32>, dd: f32, shell: Shell, least_t: f32) -> vec2<f32> {
    let top = shell.top;
    var span = vec2(NO_ROOT, -NO_ROOT);
    if top.radius > 0.0 {
        let roots = cone_roots(p, d, dd, top);
        if roots.x < NO_ROOT {
            span = on_nappe(roots, p, d, top);
            span = behind(span, dot(top.start.normal, p) - top.start.offset, dot(top.start.normal, d));
            let tip = p - top.axis * top.length;
            span = behind(span, top.end.offset - dot(top.end.normal, tip), -dot(top.end.normal, d));
            if span.x >= span.y {
                span = vec2(NO_ROOT, -NO_ROOT);
            }
        }
    }
    if top.start.kind == ROUND {
        let ball = chord(p, d, dd, top.start.radius);
        span = joined(span, behind(ball, top.start.offset - dot(top.start.normal, p), -dot(top.start.normal, d)));
    }
    if top.end.kind == ROUND {
        let tip = p - top.axis * top.length;
        var ball = chord(tip, d, dd, top.end.radius);
        ball = behind(ball, dot(top.end.normal, tip) - top.end.offset, dot(top.end.normal, d));
        span = joined(span, behind(ball, shell.beyond.w - dot(shell.beyond.xyz, tip), -dot(shell.beyond.xyz, d)));
    }
    return vec2(max(span.x, least_t), span.y);
}

// The stretch within the proper nappe, from both roots with the cone.
fn on_nappe(roots: vec2<f32>, p: vec3<f32>, d: vec3<f32>, frustum: Frustum) -> vec2<f32> {
    let speed = frustum.slope * dot(d, frustum.axis);
    let here = frustum.radius + frustum.slope * dot(p, frustum.axis);
    let proper = vec2(here) + speed * roots > vec2(0.0);
    if proper.x && proper.y {
        return roots;
    }
    // A ray steeper than the cone meets both nappes, each once: on the proper one it goes on to where that widens.
    if proper.x == proper.y {
        return vec2(NO_ROOT, -NO_ROOT);
    }
    let root = select(roots.y, roots.x, proper.x);
    return select(vec2(-NO_ROOT, root), vec2(root, NO_ROOT), speed > 0.0);
}

// A stretch, less what is before a plane: that of points whose distance, `distance` at t = 0 and growing by `rate`, is
// negative.
fn behind(span: vec2<f32>, distance: f32, rate: f32) -> vec2<f32> {
    let t = -distance / rate;
    if rate > 0.0 {
        return vec2(max(span.x, t), span.y);
    }
    if rate < 0.0 {
        return vec2(span.x, min(span.y, t));
    }
    return select(vec2(NO_ROOT, -NO_ROOT), span, distance >= 0.0);
}

// The stretch within a sphere about the origin of x.
fn chord(x: vec3<f32>, d: vec3<f32>, dd: f32, radius: f32) -> vec2<f32> {
    let nearest = -dot(x, d) / dd;
    let distance = length(x + d * nearest);
    let h2 = (radius - distance) * (radius + distance);
    if h2 <= 0.0 {
        return vec2(NO_ROOT, -NO_ROOT);
    }
    let half = sqrt(h2 / dd);
    return vec2(nearest - half, nearest + half);
}

// Two stretches that meet, or of which one is empty, as one.
fn joined(a: vec2<f32>, b: vec2<f32>) -> vec2<f32> {
    if b.x >= b.y {
        return a;
    }
    return vec2(min(a.x, b.x), max(a.y, b.y));
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

// The map's height at (u, v), between floor and top.
fn height(shell: Shell, u: f32, v: f32, lod: f32) -> f32 {
    let uv = (pbr_bindings::material.uv_transform * vec3(u, shell.v_start + shell.v_length * v, 1.0)).xy;
    let h = textureSampleLevel(relief_map, relief_sampler, uv, lod).r;
    return (h - relief.range.x) / (relief.range.y - relief.range.x);
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

// Where a ray meets the relief.
struct ReliefHit {
    hit: Hit,
    // Height between floor and top, and v.
    w: f32,
    v: f32,
    // The ray meets the floor as well, so that it is bound to hit.
    grounded: bool,
}

fn march(ray: Ray, shell: Shell, least_t: f32) -> ReliefHit {
    let d = ray.direction;
    let dd = dot(d, d);
    var found: ReliefHit;
    found.hit.t = NO_ROOT;
    // From the point of the ray nearest the segment's middle, as `cast_ray` does.
    let t_c = dot(shell.top.axis * (0.5 * shell.top.length) - ray.origin, d) / dd;
    let p = ray.origin + d * t_c;
    var span = stretch(p, d, dd, shell, least_t - t_c);
    if span.x >= span.y {
        return found;
    }
    let ground = cast_ray(Ray(p, d), shell.floor, span.x, 0.0).t;
    found.grounded = ground <= span.y;
    span.y = min(span.y, ground);

    let pixel = pixel_width(span.x + t_c) * shell.metre;
    let entry = p + d * span.x;
    let y = dot(entry, shell.top.axis);
    let radial = entry - shell.top.axis * y;
    let distance = length(radial);
    let density = map_density(shell, distance);
    let densest = max(density.x, density.y);
    let lod = max(log2(pixel * densest), 0.0);
    var steps = f32(relief.steps);
    if relief.steps == 0u {
        let across = radial / max(distance, 1e-6);
        let run = d * (span.y - span.x);
        let tangential = length(run - across * dot(run, across));
        steps = clamp(ceil(tangential / max(pixel, 1.0 / densest)) + 1.0, LEAST_STEPS, MOST_STEPS);
    }

#ifdef FRUSTA_INTERPOLATED_V
    let ends = vec2(coordinates(shell, entry).y, coordinates(shell, p + d * span.y).y);
    let interpolated = dot(shell.top.start.normal, shell.top.end.normal) > BENT;
#endif
    var above = span.x;
    var below = span.x;
    var over = 1.0;
    var under = 0.0;
    var was_above = false;
    var is_hit = false;
    for (var i = 0.0; i <= steps; i += 1.0) {
        let t = span.x + (span.y - span.x) * (i / steps);
        let point = p + d * t;
        var c = coordinates(shell, point);
#ifdef FRUSTA_INTERPOLATED_V
        if interpolated {
            c.y = mix(ends.x, ends.y, i / steps);
        }
#endif
        let excess = c.z - height(shell, c.x, c.y, lod);
        if excess <= 0.0 {
            // An eye inside the solid sees out of it: only what a ray enters is hit.
            if was_above || i == 0.0 && span.x > least_t - t_c {
                below = t;
                under = excess;
                is_hit = true;
                break;
            }
            was_above = false;
        } else {
            above = t;
            over = excess;
            was_above = true;
        }
    }
    if !is_hit {
        if !(found.grounded && was_above) {
            return found;
        }
        // Rounding left the floor's point just above it.
        below = span.y;
        above = span.y;
    }
    if above < below {
        for (var i = 0u; i < relief.bisections; i++) {
            let t = 0.5 * (above + below);
            let point = p + d * t;
            var c = coordinates(shell, point);
#ifdef FRUSTA_INTERPOLATED_V
            if interpolated {
                c.y = mix(ends.x, ends.y, (t - span.x) / (span.y - span.x));
            }
#endif
            let excess = c.z - height(shell, c.x, c.y, lod);
            if excess <= 0.0 {
                below = t;
                under = excess;
            } else {
                above = t;
                over = excess;
            }
        }
        // What is left of the step is nearly straight.
        below = mix(above, below, over / max(over - under, 1e-12));
    }
    let point = p + d * below;
    let c = coordinates(shell, point);
    found.hit = Hit(below + t_c, point, part_of(shell, point));
    found.w = c.z;
    found.v = c.y;
#ifdef FRUSTA_INTERPOLATED_V
    if interpolated {
        found.v = mix(ends.x, ends.y, (below - span.x) / (span.y - span.x));
    }
#endif
    return found;
}
