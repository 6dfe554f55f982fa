//! Ground, sun and sky, as examples and measurements have them.

use bevy::light::{CascadeShadowConfigBuilder, DirectionalLightShadowMap};
use bevy::prelude::*;

/// Colour of the sky, and of what fades into it.
pub const SKY: Color = Color::srgb(0.62, 0.82, 1.0);

/// Where the sun shines; of any length.
pub const SUNLIGHT: Vec3 = Vec3::new(-0.7, -0.85, -0.35);

/// Spawns ground at y = 0 and a sun, in a sky.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Daylight {
    /// Distance, in metres, to which shadows are cast.
    pub shadows: f32,
}

impl Plugin for Daylight {
    fn build(&self, app: &mut App) {
        let daylight = *self;
        app.insert_resource(ClearColor(SKY))
            .insert_resource(DirectionalLightShadowMap { size: 2048 })
            .insert_resource(GlobalAmbientLight {
                color: Color::srgb(0.72, 0.82, 1.0),
                brightness: 750.0,
                ..default()
            })
            .add_systems(
                Startup,
                move |commands: Commands,
                      meshes: ResMut<Assets<Mesh>>,
                      materials: ResMut<Assets<StandardMaterial>>| {
                    daylight.break_in(commands, meshes, materials);
                },
            );
    }
}

impl Daylight {
    fn break_in(
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
            Transform::default().looking_to(SUNLIGHT, Vec3::Y),
        ));
    }
}
