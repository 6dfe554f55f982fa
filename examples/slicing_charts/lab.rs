//! The app that everything is measured in, and the tree.

use bevy::light::CascadeShadowConfigBuilder;
use bevy::prelude::*;
use bevy_verdure::lab::{
    Billboard, GpuClockPlugin, Impostor, ImpostorPlugin, SUNLIGHT, Studio, adapter_name,
    broadleaf_crown,
};
use bevy_verdure::plants::Broadleaf;
use bevy_verdure::prelude::*;

pub struct Lab {
    pub studio: Studio,
    pub crown: CrownMesh,
    /// The device's name.
    pub adapter: String,
    /// Whether to measure less.
    pub quick: bool,
    /// Numbers of trees that were asked for.
    trees: Vec<u32>,
    looks: Looks,
}

struct Looks {
    solid: Handle<Mesh>,
    leaves: Handle<Mesh>,
    twigs: Handle<Mesh>,
    wood: Handle<StandardMaterial>,
    /// The trunk's wood beside crowns that are no mesh.
    bark: Handle<PlantMaterial>,
    green: Handle<StandardMaterial>,
}

/// How a tree's crown is drawn.
#[derive(Clone)]
pub enum Drawn {
    Mesh,
    /// Not at all: trunk and limbs alone.
    Bare,
    Slicing(Handle<Slicing>, CrownSettings),
    /// In bands, as crowns are that may intersect.
    InBands(Handle<Slicing>, CrownSettings),
    /// A quad turned to the eye.
    Impostor(Impostor),
    /// Flat pictures.
    Billboards(Vec<Billboard>),
}

impl Lab {
    pub fn open(quick: bool, trees: Vec<u32>) -> Self {
        let mut studio = Studio::new(|app| {
            app.add_plugins((GpuClockPlugin, ImpostorPlugin))
                .insert_resource(GlobalAmbientLight {
                    brightness: 750.0,
                    ..default()
                });
        });
        let tree = Broadleaf::default().grow(1);
        let crown = broadleaf_crown(&tree, 0.0).expect("a broadleaf's meshes can be baked");
        let world = studio.world();
        world.spawn((
            DirectionalLight {
                illuminance: 10_500.0,
                shadow_maps_enabled: true,
                ..default()
            },
            CascadeShadowConfigBuilder {
                maximum_distance: 70.0,
                first_cascade_far_bound: 20.0,
                ..default()
            }
            .build(),
            Transform::default().looking_to(SUNLIGHT, Vec3::Y),
        ));
        let mut meshes = world.resource_mut::<Assets<Mesh>>();
        let [solid, twigs, leaves] =
            [&tree.solid, &tree.twigs, &tree.leaves].map(|mesh| meshes.add(mesh.clone()));
        let mut materials = world.resource_mut::<Assets<StandardMaterial>>();
        let wood_look = StandardMaterial {
            perceptual_roughness: 0.95,
            reflectance: 0.2,
            ..default()
        };
        let wood = materials.add(wood_look.clone());
        let green = materials.add(StandardMaterial {
            perceptual_roughness: 0.75,
            reflectance: 0.3,
            double_sided: true,
            cull_mode: None,
            ..default()
        });
        let bark = world
            .resource_mut::<Assets<PlantMaterial>>()
            .add(LitAsPlant::default().over(wood_look));
        let adapter = adapter_name(world);
        Self {
            studio,
            crown,
            adapter,
            quick,
            trees,
            looks: Looks {
                solid,
                leaves,
                twigs,
                wood,
                bark,
                green,
            },
        }
    }

    /// Numbers of trees to measure: those that were asked for, or these.
    pub fn trees(&self, usual: &[u32]) -> Vec<u32> {
        if self.trees.is_empty() {
            usual.to_vec()
        } else {
            self.trees.clone()
        }
    }

    /// The middle of the crown's bounds.
    pub fn centroid(&self) -> Vec3 {
        let (low, high) = self.crown.bounds().unwrap_or_default();
        0.5 * (low + high)
    }

    /// Half the diagonal of the crown's bounds, in metres.
    pub fn radius(&self) -> f32 {
        let (low, high) = self.crown.bounds().unwrap_or_default();
        0.5 * (high - low).length()
    }

    /// Bakes the crown.
    pub fn bake(&mut self, settings: &BakeSettings) -> Result<Handle<Slicing>, String> {
        let slicing = bake(&self.crown, settings).map_err(|error| error.to_string())?;
        Ok(self
            .studio
            .world()
            .resource_mut::<Assets<Slicing>>()
            .add(slicing))
    }

    /// Plants a tree.
    pub fn plant(&mut self, drawn: &Drawn, place: Transform) -> Entity {
        let looks = &self.looks;
        let parts = [
            (looks.twigs.clone(), looks.wood.clone()),
            (looks.leaves.clone(), looks.green.clone()),
        ];
        let trunk = (Mesh3d(looks.solid.clone()), place, Visibility::default());
        let wood = MeshMaterial3d(looks.wood.clone());
        let bark = MeshMaterial3d(looks.bark.clone());
        let mut tree = self.studio.world().spawn(trunk);
        // As a user of either would have it.
        match drawn {
            Drawn::Mesh => tree.insert(wood),
            _ => tree.insert(bark),
        };
        tree.with_children(|tree| match drawn {
            Drawn::Bare => {}
            Drawn::Mesh => {
                for (mesh, material) in parts {
                    tree.spawn((Mesh3d(mesh), MeshMaterial3d(material)));
                }
            }
            Drawn::Impostor((mesh, material)) => {
                tree.spawn((Mesh3d(mesh.clone()), MeshMaterial3d(material.clone())));
            }
            Drawn::Billboards(pair) => {
                for (mesh, material) in pair {
                    tree.spawn((Mesh3d(mesh.clone()), MeshMaterial3d(material.clone())));
                }
            }
            Drawn::Slicing(slicing, settings) => {
                tree.spawn((SlicedCrown(slicing.clone()), *settings));
            }
            Drawn::InBands(slicing, settings) => {
                tree.spawn((SlicedCrown(slicing.clone()), *settings, IntersectingCrown));
            }
        });
        tree.id()
    }
}
