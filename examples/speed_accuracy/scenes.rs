//! The nine scenes of the paper's Table 1.

use bevy::prelude::*;
use bevy_verdure::lab::Shot;
use bevy_verdure::lab::rivals::fitting;
use bevy_verdure::plants::{
    Aloe, CoconutTree, Desert, Elm, Oasis, Pine, Plant, Planting, Saguaro, Well,
};
use clap::ValueEnum;

use super::moment::dancing_cacti;

/// What plants grow from.
const SEED: u64 = 1;

/// A scene of the paper's Table 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
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
    /// All of them, in the paper's order.
    pub const ALL: [Self; 9] = [
        Self::Coconut,
        Self::Pine,
        Self::Elm,
        Self::Aloe,
        Self::Saguaro,
        Self::Well,
        Self::Desert,
        Self::Oasis,
        Self::DancingCacti,
    ];

    /// The name by which it is asked for.
    pub fn name(self) -> String {
        let value = self.to_possible_value().expect("no scene is skipped");
        value.get_name().into()
    }

    /// What stands where.
    pub fn grow(self) -> Planting {
        match self {
            Self::Coconut => alone(CoconutTree::default().grow(SEED)),
            Self::Pine => alone(Pine::default().grow(SEED)),
            Self::Elm => alone(Elm::default().grow(SEED)),
            Self::Aloe => alone(Aloe::default().grow(SEED)),
            Self::Saguaro => alone(Saguaro::default().grow(SEED)),
            Self::Well => alone(Well::default().grow(SEED)),
            Self::Desert => Desert::default().grow(SEED),
            Self::Oasis => Oasis::default().grow(SEED),
            Self::DancingCacti => dancing_cacti(),
        }
    }

    /// A view in which the scene spans most of the picture, as in the paper.
    pub fn shot(self, planting: &Planting, size: UVec2) -> Shot {
        let direction = match self {
            Self::Coconut | Self::Pine | Self::Elm | Self::Saguaro => Vec3::new(0.4, 0.05, 1.0),
            Self::Desert | Self::Oasis => Vec3::new(0.3, 0.2, 1.0),
            Self::Aloe | Self::Well | Self::DancingCacti => Vec3::new(0.4, 0.35, 1.0),
        };
        fitting(planting, direction, size)
    }

    /// The distance to which shadows are cast: the last four scenes have shadow maps, as in the paper.
    pub fn shadows(self, shot: &Shot) -> Option<f32> {
        let has = matches!(
            self,
            Self::Well | Self::Desert | Self::Oasis | Self::DancingCacti
        );
        // The plants stand about the origin.
        has.then(|| 2.0 * shot.eye.length())
    }
}

/// One plant, at the origin.
pub fn alone(plant: Plant) -> Planting {
    let mut planting = Planting::default();
    let plant = planting.add(plant);
    planting.place(plant, Vec3::ZERO, 0.0, 1.0);
    planting
}
