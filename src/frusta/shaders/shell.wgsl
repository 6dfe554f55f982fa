#define_import_path bevy_verdure::frusta::shell

// The shell of a relief (§3): how thick it is, and where u is in it. Term for term `math/shell.rs`, which tells why.

#import bevy_verdure::frusta::types::Frustum

// 1 − SMALLEST_COSINE_SQUARED of `math/cone.rs`.
const STEEPEST: f32 = 0.999999;

// A frustum of the height of the planes at another height, that of the spheres of radius `from` at its start and `to` at
// its end.
fn at_height(level: Frustum, from_radius: f32, to_radius: f32) -> Frustum {
    var frustum = level;
    frustum.start.radius = from_radius;
    frustum.end.radius = to_radius;
    if level.radius > 0.0 {
        let sine = clamp((from_radius - to_radius) / level.length, -STEEPEST, STEEPEST);
        let secant = inverseSqrt((1.0 - sine) * (1.0 + sine));
        frustum.radius = from_radius * secant;
        frustum.slope = -sine * secant;
    }
    return frustum;
}

// κ times the direction of the outside of the bend, across the second axis; zero where there is no mitre. `first_slope`
// is that of the first cone, which ends in a cut.
fn skew(first_axis: vec3<f32>, first_slope: f32, second: Frustum) -> vec3<f32> {
    let m1 = first_axis;
    let m2 = second.axis;
    let cosine = dot(m1, m2);
    let outside1 = m1 * cosine - m2;
    let outside2 = m1 - m2 * cosine;
    let squares = vec2(dot(outside1, outside1), dot(outside2, outside2));
    if min(squares.x, squares.y) < 1e-12 {
        return vec3(0.0);
    }
    let b1 = outside1 * inverseSqrt(squares.x);
    let b2 = outside2 * inverseSqrt(squares.y);
    let n = second.start.normal;
    let eta1 = first_slope * dot(n, b1) / dot(n, m1);
    let eta2 = second.slope * dot(n, b2) / dot(n, m2);
    return b2 * ((eta1 - eta2) / (1.0 - eta1 * eta2));
}

// A unit vector leant towards `skew` by its length: cos φ becomes (cos φ + κ)/(1 + κ cos φ).
fn leant(across: vec3<f32>, skew: vec3<f32>) -> vec3<f32> {
    let cosine = dot(across, skew);
    let root = sqrt(max(1.0 - dot(skew, skew), 0.0));
    return (across * root + skew * (1.0 + cosine / (1.0 + root))) / (1.0 + cosine);
}
