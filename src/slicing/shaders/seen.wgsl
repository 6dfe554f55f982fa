#define_import_path bevy_verdure::slicing::seen

// How the leaves of a slice are lit for an eye above or below, or with the sun behind it, function by function what
// blend/seen.rs is.

#import bevy_verdure::slicing::blend::is_upright
#import bevy_verdure::slicing::types::{crowns, which}

const LEAN: f32 = 1.5;
const LEAN_DOWN: f32 = 0.5;
const STEEPEST: f32 = 1.5707964;
const HOT_SPOT: vec2<f32> = vec2(0.65, 0.13);
const TOP_LIGHT: f32 = 2.1;
const HEIGHTS: vec2<f32> = vec2(-0.2, 0.5);
const EVEN_HEIGHT: f32 = 0.19;

fn leaning(front: vec3<f32>, direction: vec3<f32>) -> vec3<f32> {
    if crowns[which].sphere != 0u {
        return front;
    }
    let elevation = asin(clamp(direction.y, -1.0, 1.0));
    if is_upright(front) {
        let rise = clamp(LEAN * elevation, -STEEPEST, STEEPEST);
        return front * cos(rise) + vec3(0.0, sin(rise), 0.0);
    }
    let fall = LEAN_DOWN * (STEEPEST - abs(elevation));
    let level = direction.xz / max(length(direction.xz), 1e-6);
    return front * cos(fall) + vec3(level.x, 0.0, level.y) * sin(fall);
}

fn turned(normal: vec3<f32>, before: vec3<f32>, after: vec3<f32>) -> vec3<f32> {
    let half = before + after;
    return normal - half * (dot(half, normal) / (1.0 + dot(before, after))) + after * (2.0 * dot(before, normal));
}

fn towards_sun(front: vec3<f32>, direction: vec3<f32>, near: f32, spacing: f32, deep: f32) -> f32 {
    var shift = max(near, 0.0) * max(near, 0.0);
    if is_upright(front) {
        shift += TOP_LIGHT * (clamp(direction.y, HEIGHTS.x, HEIGHTS.y) - EVEN_HEIGHT);
    }
    return min(HOT_SPOT.x * spacing, HOT_SPOT.y * deep) * shift;
}
