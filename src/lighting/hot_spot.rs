//! Why plants are lightest round the shadow of the eye: what `hot_spot.wgsl` runs on the GPU, by the same name.

use bevy::math::Vec3;

/// How much nearer to a light, in metres, an eye sees leaves than where they are in the mean, where it looks along that light: leaves that it sees
/// are then those that the light reaches, the hot spot of canopies (A. Kuusk, *The Hot Spot Effect of a Uniform Vegetative Cover*, 1985).
///
/// `toward_eye` leads to the eye, its length squared being the most metres, and `to_light` (unit) to the light. It goes as the square of the
/// cosine between both, and is 0 where the light comes from before the eye.
pub fn hot_spot(toward_eye: Vec3, to_light: Vec3) -> f32 {
    let near = toward_eye.dot(to_light).max(0.0);
    near * near
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_all_there_behind_the_eye_and_none_before_it() {
        let toward_eye = Vec3::new(0.0, 0.6, 0.8) * f32::sqrt(0.3);
        assert!((hot_spot(toward_eye, Vec3::new(0.0, 0.6, 0.8)) - 0.3).abs() < 1e-6);
        assert!((hot_spot(toward_eye, Vec3::Z) - 0.3 * 0.64).abs() < 1e-6);
        assert_eq!(hot_spot(toward_eye, Vec3::NEG_Y), 0.0);
    }
}
