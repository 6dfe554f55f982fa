//! Where plants are shown: ground, sun, sky and a camera.

use bevy::prelude::*;
use bevy_verdure::lab::{Daylight, SKY};

use super::{Orbit, camera};

/// Ground and sun about the origin, and a camera that circles.
#[derive(Clone, Copy)]
pub struct Stage {
    /// Where the camera starts.
    pub eye: Vec3,
    /// What it looks at.
    pub at: Vec3,
    /// What it circles.
    pub centre: Vec3,
    /// Distance, in metres, to which shadows are cast.
    pub shadows: f32,
    /// Distances, in metres, between which the ground fades into the sky.
    pub haze: (f32, f32),
}

impl Default for Stage {
    fn default() -> Self {
        Self {
            eye: Vec3::new(0.0, 2.0, 10.0),
            at: Vec3::Y,
            centre: Vec3::Y,
            shadows: 45.0,
            haze: (30.0, 160.0),
        }
    }
}

impl Plugin for Stage {
    fn build(&self, app: &mut App) {
        let stage = *self;
        app.add_plugins(Daylight {
            shadows: stage.shadows,
        })
        .insert_resource(Orbit {
            centre: stage.centre,
            speed: 1.0,
        })
        .add_systems(Startup, move |mut commands: Commands| {
            commands.spawn((
                camera(stage.eye, stage.at),
                DistanceFog {
                    color: SKY,
                    falloff: FogFalloff::Linear {
                        start: stage.haze.0,
                        end: stage.haze.1,
                    },
                    ..default()
                },
            ));
        });
    }
}
