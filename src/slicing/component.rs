//! What a game's author puts on an entity.

use bevy::asset::{AsAssetId, AssetId};
use bevy::camera::visibility::NoAutoAabb;
use bevy::light::TransmittedShadowReceiver;
use bevy::mesh::MeshTag;
use bevy::prelude::*;

use super::blend::SliceOrder;
use super::slicing::Slicing;
use crate::lighting::PlantLighting;

/// Draws a crown from its slicings. Scale and turn it with [`Transform`]; put what is solid, its trunk and limbs, on
/// another entity beside it or above it.
///
/// ```
/// # use bevy::prelude::*;
/// # use bevy_verdure::slicing::*;
/// fn plant(mut commands: Commands, server: Res<AssetServer>) {
///     let crown = server.load("oak.slicing.ron");
///     for i in 0..100 {
///         let place = Transform::from_xyz((i % 10) as f32 * 9.0, 0.0, (i / 10) as f32 * 9.0);
///         commands.spawn((SlicedCrown(crown.clone()), place));
///     }
/// }
/// ```
#[derive(Component, Clone, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Component, Clone, Debug, Default, PartialEq)]
#[require(
    CrownSettings,
    CrownTint,
    MeshTag,
    NoAutoAabb,
    Transform,
    // Of light that comes through leaves.
    TransmittedShadowReceiver,
    Visibility
)]
pub struct SlicedCrown(pub Handle<Slicing>);

impl AsAssetId for SlicedCrown {
    type Asset = Slicing;

    fn as_asset_id(&self) -> AssetId<Slicing> {
        self.0.id()
    }
}

/// How a [`SlicedCrown`] is put together. Filled in where a crown has none; may be changed at any time. Crowns of one
/// slicing, and soon of several of as many pixels, are drawn together where their settings are the same.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Reflect)]
#[reflect(Component, Clone, Debug, Default, PartialEq, Hash)]
pub struct CrownSettings {
    /// How slices cover what is behind them.
    pub composition: Composition,
    /// In what order slices are drawn, and which.
    pub order: SliceOrder,
    /// What the discrepancy angle is taken for, up close.
    pub discrepancy: DiscrepancyAngle,
    /// How many of the furthest slices of each slicing are left out, as the paper allows (§2.3). Of each one
    /// slice at least is drawn.
    pub left_out: u32,
    /// What lights the crown. It is some ten slices deep and lit in each: of what `Full` takes among many trees on a
    /// software driver, `Simple`, the default, takes two fifths and is hardly told from it, and `Unlit` a quarter.
    pub lighting: PlantLighting,
    /// Whether each slice has a frame, as in the paper's Figure 3.
    pub frames: bool,
}

/// Marks a [`SlicedCrown`] that may intersect others, as in a dense forest. Where it is blended, and near enough to show
/// more than one slice of an orientation, it is drawn in bands, far to near, each sorted by itself among those of other
/// marked crowns and all else that is transparent, so that little changes where two of them change their order.
///
/// There is a band for each slice of an orientation (where two levels fade into one another, of both), up to 16. The
/// furthest is drawn by the crown's own entity, the others by children of it, which the plugin spawns, keeps and despawns.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Component, Clone, Debug, Default, PartialEq)]
pub struct IntersectingCrown;

/// What one discrepancy angle (§2.3) holds for, where the eye is less than 3 radii from a crown's centroid. In the paper's
/// order, over the sphere, in orthographic views and from further away it is always the whole crown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Reflect)]
#[reflect(Clone, Debug, Default, PartialEq, Hash)]
pub enum DiscrepancyAngle {
    /// For each part of a crown its own (§4), by up to 30° from the middle's, or ¾ of the angle between two orientations.
    /// Crowns that are near are a draw of their own.
    #[default]
    PerPart,
    /// For the whole crown that of its middle, as in the paper.
    PerCrown,
}

/// How the slices of a crown cover what is behind them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Reflect)]
#[reflect(Clone, Debug, Default, PartialEq, Hash)]
pub enum Composition {
    /// Blended far to near, as the paper does: smooth; crowns are sorted among all that is transparent.
    #[default]
    Blended,
    /// Each pixel of a slice is there or not, by chance, as often as it is opaque (C. Wyman, M. McGuire, *Hashed Alpha
    /// Testing*, I3D 2017): no order, depth is written, so that prepasses and deferred rendering see the crown. Grainy
    /// without temporal anti-aliasing; for cameras whose view is jittered for that, chance is another in each frame.
    Hashed,
}

/// Multiplies the light that a [`SlicedCrown`] sends back, channel by channel, so that neighbours differ, as the base colour
/// of a `StandardMaterial` multiplies its texture. From 0 to 1 in linear light, kept as a root of 8 bits; alpha means
/// nothing.
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Component, Clone, Debug, Default, PartialEq)]
pub struct CrownTint(pub Color);

impl Default for CrownTint {
    fn default() -> Self {
        Self(Color::WHITE)
    }
}

impl CrownTint {
    /// The tint as the shaders get it, and in the fourth byte what tells a crown's lots from its neighbours'.
    pub(super) fn tag(self, seed: u8) -> u32 {
        let [r, g, b, _] = self.0.to_linear().to_f32_array().map(|light| {
            // Roots are as fine in the dark as in the light.
            (255.0 * light.clamp(0.0, 1.0).sqrt()).round() as u8
        });
        u32::from_le_bytes([r, g, b, seed])
    }
}
