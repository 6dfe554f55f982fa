//! The scenes: what stands where, and where it is seen from.

use bevy::prelude::*;
use bevy_verdure::plants::{
    Aloe, CoconutTree, Desert, Elm, Oasis, Pine, Plant, Planting, Saguaro, Well,
};
use clap::ValueEnum;

use super::common::stage::Stage;
use super::crowd::crowd;
use super::planting::{Drawn, drawing, plant};
use super::twins::{Subdivisions, twins};
use super::wardrobe::wardrobe;

/// A scene of the paper's Table 1.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
#[value(rename_all = "snake_case")]
pub enum Scene {
    Coconut,
    Pine,
    Elm,
    Aloe,
    Saguaro,
    Well,
    Desert,
    Oasis,
    DancingCacti,
}

impl Scene {
    /// What stands where; nothing for the cacti, which plant themselves.
    fn grow(self, seed: u64) -> Planting {
        match self {
            Self::Coconut => alone(CoconutTree::default().grow(seed)),
            Self::Pine => alone(Pine::default().grow(seed)),
            Self::Elm => alone(Elm::default().grow(seed)),
            Self::Aloe => alone(Aloe::default().grow(seed)),
            Self::Saguaro => alone(Saguaro::default().grow(seed)),
            Self::Well => alone(Well::default().grow(seed)),
            Self::Desert => Desert::default().grow(seed),
            Self::Oasis => Oasis::default().grow(seed),
            Self::DancingCacti => Planting::default(),
        }
    }

    /// Where the eye stands, and what it looks at.
    fn view(self) -> (Vec3, Vec3) {
        let (eye, at) = match self {
            Self::Coconut => ([9.0, 4.6, 17.5], [0.0, 5.2, 0.0]),
            Self::Pine => ([4.8, 3.2, 12.2], [0.0, 3.5, 0.0]),
            Self::Elm => ([10.8, 5.6, 28.0], [0.0, 7.2, 0.0]),
            Self::Aloe => ([0.5, 0.62, 1.25], [0.0, 0.24, 0.0]),
            Self::Saguaro => ([2.5, 2.6, 7.5], [0.0, 2.4, 0.0]),
            Self::Well => ([2.4, 2.5, 5.6], [0.0, 1.35, 0.0]),
            Self::Desert => ([3.0, 4.5, 17.0], [0.0, 1.4, 0.0]),
            Self::Oasis => ([7.6, 5.0, 22.0], [0.0, 4.6, 0.0]),
            Self::DancingCacti => ([-5.5, 3.4, 14.0], [0.0, 0.75, 1.5]),
        };
        (eye.into(), at.into())
    }

    /// The name by which it is asked for.
    pub fn name(self) -> String {
        let value = self.to_possible_value().expect("no scene is skipped");
        value.get_name().into()
    }

    /// Sets the scene up in an app.
    pub fn stage(self, seed: u64, drawn: Drawn, subdivisions: u32, app: &mut App) {
        let (eye, at) = self.view();
        app.add_plugins((
            Stage {
                eye,
                at,
                centre: at.with_x(0.0).with_z(0.0),
                shadows: 3.0 * eye.distance(at),
                ..default()
            },
            drawing,
            twins,
        ));
        app.insert_resource(drawn)
            .insert_resource(Subdivisions(subdivisions));
        if self == Self::DancingCacti {
            app.add_plugins((crowd, wardrobe));
        } else {
            let planting = self.grow(seed);
            app.add_systems(Startup, move |world: &mut World| plant(world, &planting));
        }
    }
}

/// One plant, at the origin.
fn alone(plant: Plant) -> Planting {
    let mut planting = Planting::default();
    let plant = planting.add(plant);
    planting.place(plant, Vec3::ZERO, 0.0, 1.0);
    planting
}
