#define_import_path bevy_verdure::frusta::cast

// Ray casting a frustum (§2.5, in a stable form). Term for term `math/cast.rs`, which tells why.

#import bevy_verdure::frusta::types::{Frustum, End, CUT, ROUND, FLAT}

const CONE: u32 = 0u;
const START: u32 = 1u;
const END: u32 = 2u;

const FAR: f32 = 4.0;
const ALONG: f32 = 1e-12;
const NO_ROOT: f32 = 1e30;

// Origin and direction in the plant's local space, the origin relative to the frustum's base.
struct Ray {
    origin: vec3<f32>,
    direction: vec3<f32>,
}

struct Hit {
    // Distance along the ray; NO_ROOT for a miss.
    t: f32,
    // Relative to the frustum's base.
    point: vec3<f32>,
    part: u32,
}

fn cast_ray(ray: Ray, frustum: Frustum, least_t: f32, slack: f32) -> Hit {
    let d = ray.direction;
    let axis = frustum.axis;
    let dd = dot(d, d);
    // Move the origin to the point of the ray nearest the middle of the segment.
    let t_c = dot(axis * (0.5 * frustum.length) - ray.origin, d) / dd;
    let p = ray.origin + d * t_c;
    let t_min = least_t - t_c;
    var best = NO_ROOT;
    var part = CONE;
    if frustum.radius > 0.0 {
        let t = cone_roots(p, d, dd, frustum);
        if t.x > t_min && on_frustum(p + d * t.x, slack, frustum) {
            best = t.x;
        } else if t.y > t_min && on_frustum(p + d * t.y, slack, frustum) {
            best = t.y;
        }
    }
    let start = cap_root(
        p,
        d,
        dd,
        t_min,
        slack,
        frustum.start.kind,
        -frustum.start.normal,
        -frustum.start.offset,
        frustum.start.radius,
        frustum.radius,
    );
    if start < best {
        best = start;
        part = START;
    }
    let end = cap_root(
        p - axis * frustum.length,
        d,
        dd,
        t_min,
        slack,
        frustum.end.kind,
        frustum.end.normal,
        frustum.end.offset,
        frustum.end.radius,
        frustum.radius + frustum.slope * frustum.length,
    );
    if end < best {
        best = end;
        part = END;
    }
    if best >= NO_ROOT {
        return Hit(NO_ROOT, vec3(0.0), CONE);
    }
    return Hit(best + t_c, p + d * best, part);
}

fn cone_roots(p: vec3<f32>, d: vec3<f32>, dd: f32, frustum: Frustum) -> vec2<f32> {
    let axis = frustum.axis;
    let k = frustum.slope;
    let dy = dot(d, axis);
    let d_perp = d - axis * dy;
    let dr = k * dy;
    let a = dot(d_perp, d_perp) - dr * dr;
    var y = dot(p, axis);
    var p_perp = p - axis * y;
    var r = frustum.radius + k * y;
    var b = dot(p_perp, d_perp) - r * dr;
    // Move the origin once more, to the vertex of the parabola: there c carries the discriminant whole.
    // Not where it is far off, as for a ray along the cone: the point at hand is the better origin then.
    let size = frustum.length + max(frustum.start.radius, frustum.end.radius);
    var t_v = 0.0;
    if b * b * dd <= a * a * (FAR * size) * (FAR * size) && a != 0.0 {
        t_v = -b / a;
        let v = p + d * t_v;
        y = dot(v, axis);
        p_perp = v - axis * y;
        r = frustum.radius + k * y;
        b = dot(p_perp, d_perp) - r * dr;
    }
    let distance = length(p_perp);
    let c = (distance - r) * (distance + r);
    let discriminant = b * b - a * c;
    if discriminant < 0.0 {
        return vec2(NO_ROOT, NO_ROOT);
    }
    let root = sqrt(discriminant);
    var q = -(b + root);
    if b < 0.0 {
        q = root - b;
    }
    var t1 = NO_ROOT;
    if abs(a) > ALONG * dd {
        t1 = q / a;
    }
    var t2 = t1;
    if q != 0.0 {
        t2 = c / q;
    }
    return vec2(min(t1, t2) + t_v, max(t1, t2) + t_v);
}

fn on_frustum(point: vec3<f32>, slack: f32, frustum: Frustum) -> bool {
    let tip = point - frustum.axis * frustum.length;
    return frustum.radius + frustum.slope * dot(point, frustum.axis) > 0.0
        && dot(frustum.start.normal, point) - frustum.start.offset >= -slack_at(frustum.start.kind, slack)
        && dot(frustum.end.normal, tip) - frustum.end.offset <= slack_at(frustum.end.kind, slack);
}

fn slack_at(kind: u32, slack: f32) -> f32 {
    return select(slack, 0.1 * slack, kind == FLAT);
}

fn cap_root(
    x: vec3<f32>,
    d: vec3<f32>,
    dd: f32,
    t_min: f32,
    slack: f32,
    kind: u32,
    normal: vec3<f32>,
    offset: f32,
    radius: f32,
    disc: f32,
) -> f32 {
    if kind == ROUND {
        // The point of the ray nearest the sphere's centre, then half the chord.
        let t_n = -dot(x, d) / dd;
        let distance = length(x + d * t_n);
        let h2 = (radius - distance) * (radius + distance);
        if h2 >= 0.0 {
            let half = sqrt(h2 / dd);
            let t1 = t_n - half;
            let t2 = t_n + half;
            if t1 > t_min && dot(normal, x + d * t1) - offset >= -slack {
                return t1;
            }
            if t2 > t_min && dot(normal, x + d * t2) - offset >= -slack {
                return t2;
            }
        }
    } else if kind == FLAT {
        let speed = dot(normal, d);
        if speed != 0.0 {
            let t = (offset - dot(normal, x)) / speed;
            let point = x + d * t;
            if t > t_min && length(point - normal * dot(normal, point)) <= disc {
                return t;
            }
        }
    }
    return NO_ROOT;
}
