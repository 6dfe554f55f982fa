//! Plants: skeletons grown from a seed and a few botanical parameters, for a game without an artist.
//!
//! ```
//! use bevy_verdure::plants::{CoconutTree, Surface};
//!
//! let palm = CoconutTree { height: 7.0, ..Default::default() }.grow(42);
//! for part in &palm.parts {
//!     // Spawn `part.skeleton` with the material that you have for `part.kind`.
//!     println!("{:?}: {} segments", part.kind, part.skeleton.segment_count());
//! }
//! assert!(palm.part(Surface::Coconut).is_some());
//! ```
//!
//! | plant | what it is | segments by default |
//! |---|---|---|
//! | [`CoconutTree`] | a leaning trunk, feathered fronds, nuts | 3,713 |
//! | [`Pine`] | a straight trunk, whorls of branches, needles in tufts | 16,997 |
//! | [`Elm`] | a bare vase of limbs and fine twigs | 1,833 |
//! | [`Aloe`] | a rosette of fleshy leaves with teeth; agaves too | 229 |
//! | [`Saguaro`] | a column with arms | 30 |
//! | [`BarrelCactus`] | a squat column | 4 |
//! | [`Ocotillo`] | a spray of canes with red tips | 96 |
//! | [`Grass`] | a tussock; reeds too | 96 |
//! | [`Stones`] | a few stones | 5 |
//! | [`Well`] | a draw-well with a roof | 8 |
//!
//! [`Broadleaf`], a tree in leaf, is grown as triangles instead, 19,857 by default: what the `slicing` method bakes.
//!
//! Two scenes put several of them in their places: [`Desert`] (799) and [`Oasis`] (18,557), each a [`Planting`].
//!
//! What their surfaces look like is painted by code too: [`maps`].
//!
//! # Promises
//! * The same parameters and seed grow the same plant; another seed grows another of the same kind. Random numbers
//!   are integers' work ([`Dice`]), so plants on two machines differ by the rounding of sines at most.
//! * How many segments a plant has follows from its parameters alone, never from the seed; each plant's page says how.
//!   The defaults have the counts of Table 1 of the frusta paper (see [`frusta`](crate::frusta)), so that
//!   measurements compare. Where a number is shared out at random (an elm's segments, a pine's needles, an aloe's
//!   teeth), the last share is what is left.
//! * Parameters outside their documented range are brought into it, and those that are not finite are replaced by
//!   the default's. Nothing panics, and no plant has more segments than its page says.
//! * Plants stand on the ground, y = 0, with the foot at the origin. Only the foot goes below it, by its own radius at
//!   most, unless the plant's page says otherwise.
//! * Every root but those in the ground lies inside another part: no leaf hangs in the air.
//! * Limbs bend by less than 30° from segment to segment, so that mitred joins stay smooth.
//!
//! # The files here, in reading order
//! `dice` (random numbers), `shape` (ranges, directions, the growing tip), a file or folder for each plant, `scene`
//! (plants at places), `desert` and `oasis`.

mod aloe;
mod barrel;
mod broadleaf;
mod coconut;
mod desert;
mod dice;
mod elm;
mod grass;
pub mod maps;
mod oasis;
mod ocotillo;
mod pine;
mod saguaro;
mod scene;
mod shape;
mod stones;
#[cfg(test)]
mod testing;
mod well;

pub use aloe::Aloe;
pub use barrel::BarrelCactus;
pub use broadleaf::{Broadleaf, BroadleafMeshes};
pub use coconut::CoconutTree;
pub use desert::Desert;
pub use dice::Dice;
pub use elm::Elm;
pub use grass::Grass;
pub use oasis::Oasis;
pub use ocotillo::Ocotillo;
pub use pine::Pine;
pub use saguaro::Saguaro;
pub use scene::{Place, Planting};
pub use stones::Stones;
pub use well::Well;

use crate::skeleton::{Skeleton, SkeletonBuilder, SkeletonError};

/// A grown plant: one skeleton for each kind of surface, all in the plant's local space (metres, y up, the foot of
/// the stem at the origin).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plant {
    /// The parts, each of another kind, the woody ones first.
    pub parts: Vec<PlantPart>,
}

/// The part of a [`Plant`] that has one kind of surface.
#[derive(Clone, Debug, PartialEq)]
pub struct PlantPart {
    /// What covers the part.
    pub kind: Surface,
    /// Its shape.
    pub skeleton: Skeleton,
}

impl Plant {
    /// How many segments there are in all parts.
    pub fn segment_count(&self) -> usize {
        let count = |part: &PlantPart| part.skeleton.segment_count();
        self.parts.iter().map(count).sum()
    }

    /// The skeleton of the part of this kind, if the plant has one.
    pub fn part(&self, kind: Surface) -> Option<&Skeleton> {
        let part = self.parts.iter().find(|part| part.kind == kind)?;
        Some(&part.skeleton)
    }

    /// Adds a part, unless nothing was built.
    fn with(mut self, kind: Surface, part: SkeletonBuilder) -> Self {
        // The species keep to ranges in which every joint is valid: what is left to fail is a part without joints.
        match part.build() {
            Ok(skeleton) => self.parts.push(PlantPart { kind, skeleton }),
            Err(error) => debug_assert_eq!(error, SkeletonError::Empty, "{kind:?}"),
        }
        self
    }
}

/// What the surface of a part is, for the choice of its material.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Surface {
    /// Ringed, fibrous, grey-brown.
    PalmTrunk,
    /// Midribs, stalks and leaflets of a palm: leathery, green to yellow.
    PalmLeaf,
    /// The smooth green or brown husk of a coconut.
    Coconut,
    /// Plated, reddish-grey.
    PineBark,
    /// Dark green, smooth.
    PineNeedles,
    /// Furrowed, grey.
    ElmBark,
    /// Fleshy, grey-green, with pale flecks. Teeth included.
    AloeLeaf,
    /// Ribbed lengthwise, green, with tufts of spines on the ribs.
    SaguaroSkin,
    /// Like a saguaro's, with more ribs and denser spines.
    BarrelCactusSkin,
    /// Grey-green canes with dark furrows and thorns.
    OcotilloCane,
    /// Scarlet flowers at the tips of an ocotillo's canes.
    OcotilloFlower,
    /// Grass and reeds.
    GrassBlade,
    /// A boulder or pebble.
    Stone,
    /// Blocks of stone in mortar. Flat ends.
    Masonry,
    /// Sawn timber: posts, beams, pails. Flat ends.
    Timber,
    /// Tiles or shingles. Flat ends.
    RoofTile,
    /// Twisted fibre. Flat ends.
    Rope,
    /// The shaft of a well, seen from above: all but black. Flat ends.
    WellShaft,
    /// Still water. Flat ends.
    Water,
}

impl Surface {
    /// Whether free ends of this kind are meant to be closed by discs (`Ends::Flat` of
    /// `Frusta`) instead of spheres.
    pub const fn has_flat_ends(self) -> bool {
        matches!(
            self,
            Self::Masonry
                | Self::Timber
                | Self::RoofTile
                | Self::Rope
                | Self::WellShaft
                | Self::Water
        )
    }
}
