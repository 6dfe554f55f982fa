//! Height vectors in the wind (§5: the second kind of animation).

use bevy::math::Vec3;

use crate::wind::sway;

/// A height vector that bends in the wind, and keeps its length: at `foot` in world space, `time` seconds on. Each metre a
/// second of `velocity` moves the top by up to `flexibility` heights, if it is across.
///
/// It turns by less than a right angle. One that leans far already may be led through its facet so; such facets are not
/// drawn.
pub fn bend(foot: Vec3, height: Vec3, velocity: Vec3, flexibility: f32, time: f32) -> Vec3 {
    if flexibility == 0.0 || velocity == Vec3::ZERO {
        return height;
    }
    let tall = height.length();
    let moved = sway(velocity, foot, 1.0, flexibility * tall, time);
    // Along the height vector nothing moves.
    let aside = moved - height * (moved.dot(height) / (tall * tall).max(LEAST));
    let bent = height + aside;
    bent * (tall / bent.length().max(LEAST))
}

/// In place of the length of a vector that has none.
const LEAST: f32 = 1e-30;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn height_vectors_lean_with_the_wind_and_keep_their_length_and_side() {
        for (i, height) in [Vec3::Y, Vec3::new(0.3, 0.2, -0.1), Vec3::new(0.0, 2.0, 1.0)]
            .into_iter()
            .enumerate()
        {
            let velocity = Vec3::new(12.0, 0.0, -5.0);
            let bent = bend(Vec3::ONE, height, velocity, 0.05, i as f32);
            assert!((bent.length() / height.length() - 1.0).abs() < 1e-6);
            assert!(bent.dot(velocity) > height.dot(velocity));
            assert!(bent.dot(height) > 0.0, "never by a right angle");
            assert_eq!(bend(Vec3::ONE, height, velocity, 0.0, 1.0), height);
        }
        assert_eq!(bend(Vec3::ONE, Vec3::ZERO, Vec3::X, 0.1, 0.0), Vec3::ZERO);
    }
}
