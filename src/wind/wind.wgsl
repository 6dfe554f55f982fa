#define_import_path bevy_verdure::wind

const SWAY: f32 = 2.5;
const GUST_LENGTH: f32 = 4.0;

// How far a place on a plant is moved, in metres, in world space.
fn sway(velocity: vec3<f32>, foot: vec3<f32>, height: f32, flexibility: f32, time: f32) -> vec3<f32> {
    let speed = length(velocity);
    let along = dot(velocity, foot) / (max(speed, 1e-3) * GUST_LENGTH);
    let gust = 0.6 + 0.4 * sin(SWAY * time - along) * cos(0.37 * SWAY * time - 0.7 * along);
    return velocity * (flexibility * height * height * gust);
}
