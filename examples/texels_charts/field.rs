//! A level field of texels under a sun that casts no shadows, and what else it may be drawn with.

use bevy::prelude::*;
use bevy_verdure::lab::texel_scenes::surfaces::grid;
use bevy_verdure::lab::{GpuClockPlugin, Lens, Shot, Studio};
use bevy_verdure::prelude::*;
use bevy_verdure::texel::ReferenceVolume;
use bevy_verdure::texel::facet::Facet;

/// What is behind.
pub const BACKGROUND: Color = Color::srgb(0.16, 0.13, 0.09);
/// Towards the sun. With this much light nothing is too bright for eight bits: of a colour four fifths come back from it
/// where it falls straight, and an eighth from all sides.
pub const TO_SUN: Vec3 = Vec3::new(0.7, 0.85, 0.35);
const SUN: f32 = 2_500.0;
const AMBIENT: f32 = 250.0;
/// A field, and where it stands.
pub struct Field {
    pub studio: Studio,
    pub volume: ReferenceVolume,
    /// Sides and height of a texel, in metres.
    pub texel: Vec2,
    /// How many there are along each side.
    pub squares: u32,
    /// In world space.
    pub facets: Vec<Facet>,
}

impl Field {
    /// Of so many texels along each side, of which each is so wide and high.
    pub fn new(volume: ReferenceVolume, texel: Vec2, squares: u32) -> Result<Self, String> {
        let mut studio = Studio::new(|app| {
            app.add_plugins(GpuClockPlugin)
                .insert_resource(GlobalAmbientLight {
                    brightness: AMBIENT,
                    ..default()
                });
        });
        studio.world().spawn((
            DirectionalLight {
                illuminance: SUN,
                shadow_maps_enabled: false,
                ..default()
            },
            Transform::default().looking_to(-TO_SUN, Vec3::Y),
        ));
        let mesh = ground(texel.x, squares);
        let surface = TexelSurface {
            thickness: texel.y,
            ..default()
        };
        let found = surface.facets(&mesh).map_err(|error| error.to_string())?;
        Ok(Self {
            studio,
            volume,
            texel,
            squares,
            facets: found.facets,
        })
    }

    /// The ground, a texel a square.
    pub fn ground(&self) -> Mesh {
        ground(self.texel.x, self.squares)
    }

    /// A volume to cover it with.
    pub fn add_volume(&mut self, volume: ReferenceVolume) -> Handle<TexelVolume> {
        let mut volumes = self.studio.world().resource_mut::<Assets<TexelVolume>>();
        volumes.add(TexelVolume::from(volume))
    }

    /// Covers it with texels of a volume.
    pub fn cover(&mut self, volume: &Handle<TexelVolume>, settings: TexelSettings) -> Vec<Entity> {
        let (ground, thickness) = (self.ground(), self.texel.y);
        let world = self.studio.world();
        let mesh = world.resource_mut::<Assets<Mesh>>().add(ground);
        let volume = volume.clone();
        let surface = TexelSurface { volume, thickness };
        let covered = world.spawn((Mesh3d(mesh), surface, settings));
        vec![covered.id()]
    }
}

/// A level mesh, a texel a square.
fn ground(side: f32, squares: u32) -> Mesh {
    grid(squares, squares, Vec2::splat(side * squares as f32))
}

/// The field as one sees it who stands at its border: aslant in front, grazing behind.
pub fn shot(size: UVec2, field: f32) -> Shot {
    Shot {
        eye: Vec3::new(0.08, 0.42, 0.86) * field,
        at: Vec3::new(0.0, 0.04, 0.1) * field,
        lens: Lens::Perspective(core::f32::consts::FRAC_PI_4),
        size,
    }
}
