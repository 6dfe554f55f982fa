//! The wind of a scene. Crowns ([`slicing`](crate::slicing)) and texels ([`texel`](crate::texel)) sway in it; frusta do not
//! yet.
//!
//! A stem that bends like a cantilever under an even load moves by about the square of the height. Gusts travel with the
//! wind, so that neighbours sway one after the other. `wind.wgsl` has the same functions by the same names.

use bevy::prelude::*;
use bevy::shader::load_shader_library;

/// Angular frequency of swaying, in radians a second: a tree sways in 2.5 seconds.
const SWAY: f32 = 2.5;
/// Length of gusts along the wind, in metres, over 2π.
const GUST_LENGTH: f32 = 4.0;

/// The wind that the crowns and texels of a scene sway in. None by default. Change it at any time.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[reflect(Resource, Clone, Debug, Default, PartialEq)]
pub struct Wind {
    /// Where to and how fast, in metres a second, in world space. What is not finite is still air.
    pub velocity: Vec3,
}

impl Wind {
    /// Wind with this velocity, in metres a second.
    pub const fn new(velocity: Vec3) -> Self {
        Self { velocity }
    }

    /// The velocity, at most a gale's 25 m/s.
    pub(crate) fn limited(&self) -> Vec3 {
        if self.velocity.is_finite() {
            self.velocity.clamp_length_max(25.0)
        } else {
            Vec3::ZERO
        }
    }
}

/// How far a place on a plant is moved, in metres: a plant at `foot`, at the share `height` of its own height (0 to 1), of
/// which the top gives `flexibility` metres for each metre a second of `velocity`, at `time` seconds.
pub fn sway(velocity: Vec3, foot: Vec3, height: f32, flexibility: f32, time: f32) -> Vec3 {
    let speed = velocity.length();
    let along = velocity.dot(foot) / (speed.max(1e-3) * GUST_LENGTH);
    let gust = 0.6 + 0.4 * (SWAY * time - along).sin() * (0.37 * SWAY * time - 0.7 * along).cos();
    velocity * (flexibility * height * height * gust)
}

/// Makes [`Wind`] a resource, and its functions those of shaders.
pub struct WindPlugin;

impl Plugin for WindPlugin {
    fn build(&self, app: &mut App) {
        load_shader_library!(app, "wind.wgsl");
        app.init_resource::<Wind>().register_type::<Wind>();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn still_air_and_the_foot_do_not_move_and_the_top_moves_with_the_wind() {
        assert_eq!(sway(Vec3::ZERO, Vec3::ONE, 1.0, 0.1, 3.0), Vec3::ZERO);
        let wind = Vec3::new(3.0, 0.0, 1.0);
        assert_eq!(sway(wind, Vec3::ONE, 0.0, 0.1, 3.0), Vec3::ZERO);
        for step in 0..100 {
            let moved = sway(wind, Vec3::ONE, 1.0, 0.1, step as f32 * 0.1);
            // Gusts are 0.2 to 1 of the greatest.
            let share = moved.dot(wind) / (0.1 * wind.length_squared());
            assert!((0.2 - 1e-5..=1.0 + 1e-5).contains(&share), "{share}");
        }
        let broken = Wind::new(Vec3::splat(f32::NAN));
        assert_eq!(broken.limited(), Vec3::ZERO);
    }
}
