//! Where plants are shown: ground, sun, sky and a camera.

use bevy::light::{CascadeShadowConfigBuilder, DirectionalLightShadowMap};
use bevy::prelude::*;

use super::{Orbit, camera};

/// Colour of the sky, and of what fades into it.
const SKY: Color = Color::srgb(0.62, 0.82, 1.0);

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
        app.insert_resource(ClearColor(SKY))
            .insert_resource(DirectionalLightShadowMap { size: 2048 })
            .insert_resource(GlobalAmbientLight {
                color: Color::srgb(0.72, 0.82, 1.0),
                brightness: 750.0,
                ..default()
            })
            .insert_resource(Orbit {
                centre: stage.centre,
                speed: 1.0,
            })
            .add_systems(
                Startup,
                move |commands: Commands,
                      meshes: ResMut<Assets<Mesh>>,
                      materials: ResMut<Assets<StandardMaterial>>| {
                    stage.build_up(commands, meshes, materials);
                },
            );
    }
}

impl Stage {
    fn build_up(
        &self,
        mut commands: Commands,
        mut meshes: ResMut<Assets<Mesh>>,
        mut materials: ResMut<Assets<StandardMaterial>>,
    ) {
        commands.spawn((
            Mesh3d(meshes.add(Plane3d::default().mesh().size(400.0, 400.0))),
            MeshMaterial3d(materials.add(StandardMaterial {
                base_color: Color::srgb(0.80, 0.66, 0.46),
                perceptual_roughness: 1.0,
                reflectance: 0.1,
                ..default()
            })),
        ));
        commands.spawn((
            DirectionalLight {
                illuminance: 10_500.0,
                color: Color::srgb(1.0, 0.95, 0.86),
                shadow_maps_enabled: true,
                ..default()
            },
            CascadeShadowConfigBuilder {
                maximum_distance: self.shadows,
                first_cascade_far_bound: 0.2 * self.shadows,
                ..default()
            }
            .build(),
            Transform::default().looking_to(Vec3::new(-0.7, -0.85, -0.35), Vec3::Y),
        ));
        commands.spawn((
            camera(self.eye, self.at),
            DistanceFog {
                color: SKY,
                falloff: FogFalloff::Linear {
                    start: self.haze.0,
                    end: self.haze.1,
                },
                ..default()
            },
        ));
    }
}
