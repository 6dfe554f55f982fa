//! The trees of the grove, each as a trunk with a crown of triangles or of slices.

use std::path::Path;

use bevy::ecs::system::SystemParam;
use bevy::light::TransmittedShadowReceiver;
use bevy::prelude::*;
use bevy_verdure::lab::broadleaf_crown;
use bevy_verdure::plants::{Broadleaf, BroadleafMeshes, Dice};
use bevy_verdure::prelude::*;
use clap::ValueEnum;

use super::common::Plant;

/// Metres between trees.
const SPACING: f32 = 9.0;

/// How crowns are drawn.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Drawn {
    /// Blended slices.
    Slicing,
    /// All triangles.
    Mesh,
}

/// Marks crowns of triangles.
#[derive(Component)]
pub struct MeshCrown;

/// The tree of the grove.
#[derive(Resource)]
pub struct Grove {
    meshes: BroadleafMeshes,
    slicing: Slicing,
    /// The share of light that comes through leaves from behind.
    transmission: f32,
}

#[derive(SystemParam)]
pub struct TreeAssets<'w> {
    meshes: ResMut<'w, Assets<Mesh>>,
    materials: ResMut<'w, Assets<StandardMaterial>>,
    barks: ResMut<'w, Assets<PlantMaterial>>,
    slicings: ResMut<'w, Assets<Slicing>>,
}

/// Radius of a grove of so many trees, in metres.
pub fn radius(trees: u32) -> f32 {
    SPACING * (trees as f32 / core::f32::consts::PI).sqrt()
}

impl Grove {
    pub fn grow(
        seed: u64,
        pixels: u32,
        transmission: f32,
        slicing: Option<&Path>,
    ) -> Result<Self, String> {
        let meshes = Broadleaf::default().grow(seed);
        let slicing = match slicing {
            Some(path) => Slicing::read(path).map_err(|error| error.to_string())?,
            None => {
                let crown = broadleaf_crown(&meshes, transmission);
                let crown = crown.map_err(|error| error.to_string())?;
                let settings = BakeSettings::default().with_pixels(pixels);
                bake(&crown, &settings).map_err(|error| error.to_string())?
            }
        };
        Ok(Self {
            meshes,
            slicing,
            transmission,
        })
    }

    /// Plants trees of different scale and turn on a spiral.
    pub fn plant(
        &self,
        trees: u32,
        seed: u64,
        drawn: Drawn,
        settings: CrownSettings,
        mut commands: Commands,
        mut assets: TreeAssets,
    ) {
        let solid = assets.meshes.add(self.meshes.solid.clone());
        let twigs = assets.meshes.add(self.meshes.twigs.clone());
        let leaves = assets.meshes.add(self.meshes.leaves.clone());
        let look = StandardMaterial {
            perceptual_roughness: 0.95,
            reflectance: 0.2,
            ..default()
        };
        // Trunks are lit as the crowns of slices that they bear.
        let bark = assets
            .barks
            .add(LitAsPlant::by(settings.lighting).over(look.clone()));
        let wood = assets.materials.add(look);
        let green = assets.materials.add(StandardMaterial {
            perceptual_roughness: 0.75,
            reflectance: 0.3,
            diffuse_transmission: self.transmission,
            double_sided: true,
            cull_mode: None,
            ..default()
        });
        let slicing = assets.slicings.add(self.slicing.clone());
        let mut dice = Dice::new(seed);
        let shown = |is_shown: bool| {
            if is_shown {
                Visibility::Inherited
            } else {
                Visibility::Hidden
            }
        };
        for i in 0..trees {
            // A spiral of equal areas; the middle stays free for one tree alone.
            let reach = if i == 0 { 0.0 } else { radius(i) };
            let azimuth = 2.399_963 * i as f32;
            let (sin, cos) = azimuth.sin_cos();
            let place = Transform::from_xyz(reach * cos, 0.0, reach * sin)
                .with_rotation(Quat::from_rotation_y(dice.angle()))
                .with_scale(Vec3::splat(if trees == 1 {
                    1.0
                } else {
                    dice.between(0.75, 1.2)
                }));
            let shade = if trees == 1 {
                1.0
            } else {
                dice.between(0.85, 1.0)
            };
            let tint = Color::srgb(shade, shade * dice.between(0.93, 1.0), shade * 0.9);
            let tint = if trees == 1 { Color::WHITE } else { tint };
            commands
                .spawn((
                    Plant,
                    place,
                    Visibility::default(),
                    Mesh3d(solid.clone()),
                    MeshMaterial3d(bark.clone()),
                ))
                .with_children(|tree| {
                    tree.spawn((
                        SlicedCrown(slicing.clone()),
                        settings,
                        CrownTint(tint),
                        shown(drawn == Drawn::Slicing),
                    ));
                    for (mesh, material) in [(&twigs, &wood), (&leaves, &green)] {
                        tree.spawn((
                            MeshCrown,
                            Mesh3d(mesh.clone()),
                            MeshMaterial3d(material.clone()),
                            TransmittedShadowReceiver,
                            shown(drawn == Drawn::Mesh),
                        ));
                    }
                });
        }
    }
}
