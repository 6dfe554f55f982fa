#define_import_path bevy_verdure::frusta::march

// Marching a ray through the shell (§3).
//
// The shell that is marched lies between the cones of the map's least and greatest height. With the balls of its round
// ends, less what the planes cut away, it is convex: a ray has one stretch in it, from where it enters to where it
// leaves, or to the floor, which is solid all through. In steps along that stretch the ray's height is compared with the
// map's; the step that goes below is halved.

#import bevy_verdure::frusta::types::{Frustum, ROUND, FLAT}
#import bevy_verdure::frusta::cast::{Ray, Hit, cast_ray, cone_roots, NO_ROOT, START, END}
#import bevy_verdure::frusta::relief::{Shell, coordinates, height, map_density, mip_level, part_of}
#import bevy_verdure::frusta::shell_radii::relief
#import bevy_verdure::frusta::view::pixel_width
#ifdef FRUSTA_LEAPING
#import bevy_verdure::frusta::leap::{ceiling_levels, ceiling_level, ceiling_over, is_sure, leap}
#endif

// Steps of a march that picks their number: at least, and at most.
const LEAST_STEPS: f32 = 3.0;
const MOST_STEPS: f32 = 64.0;
// Cosine between a segment's planes below which v is never interpolated: that of 45°.
const BENT: f32 = 0.7071068;

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

// v where a ray enters and leaves the shell.
struct VEnds {
    interpolated: bool,
    entry: f32,
    exit: f32,
}

// The coordinates of a point of a ray, `share` of the way from where it enters to where it leaves.
fn coordinates_at(shell: Shell, point: vec3<f32>, ends: VEnds, share: f32) -> vec3<f32> {
    var c = coordinates(shell, point);
    if ends.interpolated {
        c.y = mix(ends.entry, ends.exit, share);
    }
    return c;
}

// How fast a ray passes over the surface below a point: its part across the direction away from the axis.
fn tangential(radial: vec3<f32>, d: vec3<f32>) -> f32 {
    let across = radial / max(length(radial), 1e-6);
    return length(d - across * dot(d, across));
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

// The first hit of a ray from depth `least_t` on, as `exact` as the settings ask for, or just whether there is one: then
// what is said of it but `grounded` holds to a step of the march.
fn march(ray: Ray, shell: Shell, least_t: f32, exact: bool) -> ReliefHit {
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
    if found.grounded && !exact {
        found.hit.t = span.y + t_c;
        return found;
    }

    let pixel = pixel_width(span.x + t_c) * shell.metre;
    let entry = p + d * span.x;
    let y = dot(entry, shell.top.axis);
    let radial = entry - shell.top.axis * y;
    let distance = length(radial);
    let density = map_density(shell, distance);
    let densest = max(density.x, density.y);
    let lod = mip_level(pixel * densest);
    var steps = f32(relief.steps);
    if relief.steps == 0u {
        let pixels = tangential(radial, d) * (span.y - span.x) / max(pixel, 1.0 / densest);
        steps = clamp(ceil(pixels) + 1.0, LEAST_STEPS, MOST_STEPS);
    }

    var ends = VEnds(false, 0.0, 0.0);
#ifdef FRUSTA_INTERPOLATED_V
    ends.interpolated = dot(shell.top.start.normal, shell.top.end.normal) > BENT;
    ends.entry = coordinates(shell, entry).y;
    ends.exit = coordinates(shell, p + d * span.y).y;
#endif
    var above = span.x;
    var below = span.x;
    var over = 1.0;
    var under = 0.0;
    var was_above = false;
    var is_hit = false;
#ifdef FRUSTA_LEAPING
    let levels = ceiling_levels(lod);
    var level = ceiling_level(tangential(radial, d) * (span.y - span.x) * densest, levels);
    let step = (span.y - span.x) / steps;
    var above_c = vec3(0.0);
    var is_over_known = false;
#endif
    for (var i = 0.0; i <= steps; i += 1.0) {
        let t = span.x + (span.y - span.x) * (i / steps);
        let point = p + d * t;
        let c = coordinates_at(shell, point, ends, i / steps);
#ifdef FRUSTA_LEAPING
        let ceiling = ceiling_over(shell, c, level);
        if c.z > ceiling {
            above = t;
            above_c = c;
            was_above = true;
            is_over_known = false;
            let leapt = min(floor(leap(shell, point, d, ceiling, level) / step), steps - i);
            if leapt >= 2.0 {
                let landing_t = span.x + (span.y - span.x) * ((i + leapt) / steps);
                let landing = p + d * landing_t;
                let landing_c = coordinates_at(shell, landing, ends, (i + leapt) / steps);
                if is_sure(shell, point, landing, c, landing_c, ceiling, level) {
                    above = landing_t;
                    above_c = landing_c;
                    i += leapt;
                    level = min(level + 1, levels.y);
                    continue;
                }
            }
            level = max(level - 1, levels.x);
            continue;
        }
        level = max(level - 1, levels.x);
#endif
        let excess = c.z - height(shell, c.x, c.y, lod);
        if excess <= 0.0 {
            // An eye inside the solid sees out of it: only what a ray enters is hit.
            if was_above || i == 0.0 && span.x > least_t - t_c {
                below = t;
                under = excess;
                is_hit = true;
#ifdef FRUSTA_LEAPING
                if was_above && !is_over_known {
                    over = above_c.z - height(shell, above_c.x, above_c.y, lod);
                }
#endif
                break;
            }
            was_above = false;
        } else {
            above = t;
            over = excess;
            was_above = true;
        }
#ifdef FRUSTA_LEAPING
        is_over_known = excess > 0.0;
#endif
    }
    if !is_hit {
        if !(found.grounded && was_above) {
            return found;
        }
        // Rounding left the floor's point just above it.
        below = span.y;
        above = span.y;
    }
    if !exact {
        found.hit.t = below + t_c;
        return found;
    }
    if above < below {
        for (var i = 0u; i < relief.bisections; i++) {
            let t = 0.5 * (above + below);
            let point = p + d * t;
            let c = coordinates_at(shell, point, ends, (t - span.x) / (span.y - span.x));
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
    let c = coordinates_at(shell, point, ends, (below - span.x) / (span.y - span.x));
    found.hit = Hit(below + t_c, point, part_of(shell, point));
    found.w = c.z;
    found.v = c.y;
    return found;
}
