#define_import_path bevy_verdure::lighting::hot_spot

// Why plants are lightest round the shadow of the eye: what hot_spot.rs is, by the same names.

fn hot_spot(toward_eye: vec3<f32>, to_light: vec3<f32>) -> f32 {
    let near = max(dot(toward_eye, to_light), 0.0);
    return near * near;
}
