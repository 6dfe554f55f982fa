//! How a plant's frusta are shaped: settings a game's author sets on a plant.

use bevy::prelude::*;

use super::single::cone::EndKind;
use super::single::join::{JoinKind, Skin};

/// How the frusta of a limb meet at a joint.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Reflect)]
#[reflect(Clone, Debug, Default, PartialEq, Hash)]
pub enum Join {
    /// Along the curve in which both cones meet: exact, sharp, and the cheapest to draw. Bends too sharp for
    /// their segments' length fall back to `Round`, as strokes of a vector drawing do: cylinders four radii long from
    /// 152° on.
    #[default]
    Mitre,
    /// With a sphere of the joint's radius: watertight for every bend up to and including a fold.
    Round,
    /// As the paper builds it (Equations 3 to 5), for comparison. Leaves gaps where bent cones taper: 2 to 5 % of the
    /// radius where each of them halves it over four radii; `docs/limits.md` has a chart.
    Paper,
    /// As the paper builds it, iterated on the base radius (§2.2), for comparison.
    PaperIterated,
}

/// What closes a skeleton's free ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Reflect)]
#[reflect(Clone, Debug, Default, PartialEq, Hash)]
pub enum Ends {
    /// The joint's sphere.
    #[default]
    Round,
    /// A disc through the joint.
    Flat,
}

/// Shapes the frusta of a [`Skeleton3d`](crate::skeleton::Skeleton3d). Filled in where a plant has none; may be
/// changed at any time. Plants share their data with those of the same skeleton and the same settings.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Reflect)]
#[reflect(Component, Clone, Debug, Default, PartialEq, Hash)]
pub struct Frusta {
    /// How frusta meet.
    pub join: Join,
    /// What closes free ends.
    pub ends: Ends,
}

impl Frusta {
    /// Frusta that meet in the given way.
    pub fn with_join(mut self, join: Join) -> Self {
        self.join = join;
        self
    }

    /// Frusta whose free ends are closed in the given way.
    pub fn with_ends(mut self, ends: Ends) -> Self {
        self.ends = ends;
        self
    }

    /// The same in the words of the geometry.
    pub fn skin(&self) -> Skin {
        Skin {
            join: match self.join {
                Join::Mitre => JoinKind::Mitre,
                Join::Round => JoinKind::Round,
                Join::Paper => JoinKind::Paper,
                Join::PaperIterated => JoinKind::PaperIterated,
            },
            ends: match self.ends {
                Ends::Round => EndKind::Round,
                Ends::Flat => EndKind::Flat,
            },
        }
    }
}
