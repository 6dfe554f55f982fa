#define_import_path bevy_verdure::slicing::seen

// How the leaves of a slice are lit for an eye above or below, function by function what blend/seen.rs is.

#import bevy_verdure::slicing::blend::is_upright

const LEAN: f32 = 1.25;
const STEEPEST: f32 = 1.5707964;
const AHEAD: vec2<f32> = vec2(0.35, 0.12);

fn leaning(front: vec3<f32>, direction: vec3<f32>) -> vec3<f32> {
    if !is_upright(front) {
        return front;
    }
    let rise = clamp(LEAN * asin(clamp(direction.y, -1.0, 1.0)), -STEEPEST, STEEPEST);
    return front * cos(rise) + vec3(0.0, sin(rise), 0.0);
}

fn turned(normal: vec3<f32>, before: vec3<f32>, after: vec3<f32>) -> vec3<f32> {
    let half = before + after;
    return normal - half * (dot(half, normal) / (1.0 + dot(before, after))) + after * (2.0 * dot(before, normal));
}

fn ahead(spacing: f32, deep: f32, front: vec3<f32>, direction: vec3<f32>) -> f32 {
    let most = min(AHEAD.x * spacing, AHEAD.y * deep);
    return most * abs(direction.y) / max(abs(dot(front, direction)), 0.5);
}
