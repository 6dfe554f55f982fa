#define_import_path bevy_verdure::frusta::surface

// The parametrization of a frustum and its normals (§2.3, §2.4). Term for term `math/surface.rs`.

#import bevy_verdure::frusta::types::{Frustum, FLAT}
#import bevy_verdure::frusta::cast::{CONE, START, END}

const GRAZING: f32 = 1e-6;
const TAU: f32 = 6.283185307179586;

struct SurfacePoint {
    u: f32,
    v: f32,
    // Unit normal to shade with, local.
    normal: vec3<f32>,
    // Unit normal of the surface itself, local.
    true_normal: vec3<f32>,
    // Unit vector across the axis, away from it.
    across: vec3<f32>,
    // Distance from the axis, and length of the generator between both planes, in metres.
    distance: f32,
    span: f32,
}

fn generator_span(frustum: Frustum, across: vec3<f32>) -> vec2<f32> {
    let m_l = dot(frustum.start.normal, frustum.axis);
    let q_l = dot(frustum.start.normal, across);
    let y_l = (frustum.start.offset - frustum.radius * q_l) / max(m_l + frustum.slope * q_l, GRAZING);
    let m_u = dot(frustum.end.normal, frustum.axis);
    let q_u = dot(frustum.end.normal, across);
    let y_u = (frustum.end.offset + m_u * frustum.length - frustum.radius * q_u)
        / max(m_u + frustum.slope * q_u, GRAZING);
    return vec2(y_l, y_u);
}

fn normalize_or(v: vec3<f32>, fallback: vec3<f32>) -> vec3<f32> {
    let l = length(v);
    return select(fallback, v / l, l > 0.0);
}

fn surface_point(frustum: Frustum, reference: vec3<f32>, twist: f32, point: vec3<f32>, part: u32) -> SurfacePoint {
    let axis = frustum.axis;
    let y = dot(point, axis);
    let radial = point - axis * y;
    var s: SurfacePoint;
    s.distance = length(radial);
    s.across = normalize_or(radial, reference);
    s.span = max(frustum.length, 1e-6);
    if part == CONE {
        let y_lu = generator_span(frustum, s.across);
        s.span = max(y_lu.y - y_lu.x, 1e-6);
        s.v = clamp((y - y_lu.x) / (y_lu.y - y_lu.x), 0.0, 1.0);
        s.true_normal = normalize(s.across - axis * frustum.slope);
#ifdef FRUSTA_GEOMETRIC_NORMALS
        s.normal = s.true_normal;
#else
        let n_l = axis * y_lu.x + s.across * (frustum.radius + frustum.slope * y_lu.x);
        let n_u = axis * (y_lu.y - frustum.length) + s.across * (frustum.radius + frustum.slope * y_lu.y);
        let n = normalize_or(n_l, s.across) * (1.0 - s.v) + normalize_or(n_u, s.across) * s.v;
        s.normal = normalize_or(n, s.across);
#endif
    } else {
        if part == START {
            s.v = 0.0;
            s.normal = select(point, -axis, frustum.start.kind == FLAT);
        } else {
            s.v = 1.0;
            s.normal = select(point - axis * frustum.length, axis, frustum.end.kind == FLAT);
        }
        s.normal = normalize_or(s.normal, s.across);
        s.true_normal = s.normal;
    }
    let side = cross(axis, reference);
    let turn = atan2(dot(s.across, side), dot(s.across, reference)) + s.v * twist;
    s.u = fract(turn / TAU);
    return s;
}
