//! What a surface's material needs beside its maps.

use super::Surface;

/// Length of a map of a cactus' skin, in circumferences.
pub(super) const CACTUS_LENGTH: f32 = 0.25;
/// Length of a map of masonry, in circumferences.
pub(super) const MASONRY_LENGTH: f32 = 1.0 / 6.0;

/// Recommended numbers for a [`Surface`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Finish {
    /// Width (once round the limb) and length (along it) of the maps, in pixels; powers of two.
    pub size: [u32; 2],
    /// Metres along the limb that the map is painted for, in circumferences of the limb: a joint of radius r wants the
    /// texture length `length · 2πr`.
    pub length: f32,
    /// How often the map repeats in one texture length as the plants here set it: what to multiply v by, so that the
    /// map comes out as long as `length` says.
    pub repeats: f32,
    /// Thickness of the shell, in radii of the joint; the joint's radius is the outer frustum's. `None` where there is
    /// no relief.
    pub thickness: Option<f32>,
    /// Perceptual roughness, 0..1.
    pub roughness: f32,
    /// Reflectance at normal incidence as Bevy counts it (0.5 is 4 %), 0..1.
    pub reflectance: f32,
}

impl Finish {
    /// The numbers for a kind of surface.
    pub const fn of(kind: Surface) -> Self {
        let wood = Self {
            size: [256, 256],
            length: 1.0,
            repeats: 1.0,
            thickness: Some(0.1),
            roughness: 0.92,
            reflectance: 0.3,
        };
        match kind {
            Surface::PalmTrunk => Self {
                thickness: Some(0.09),
                ..wood
            },
            Surface::PineBark => Self {
                thickness: Some(0.16),
                ..wood
            },
            Surface::ElmBark => Self {
                thickness: Some(0.13),
                roughness: 0.95,
                ..wood
            },
            Surface::SaguaroSkin => Self {
                size: [512, 128],
                length: CACTUS_LENGTH,
                repeats: 4.0,
                thickness: Some(0.17),
                roughness: 0.62,
                reflectance: 0.4,
            },
            Surface::BarrelCactusSkin => Self {
                size: [512, 128],
                length: CACTUS_LENGTH,
                repeats: 4.0,
                thickness: Some(0.15),
                roughness: 0.62,
                reflectance: 0.4,
            },
            Surface::OcotilloCane => Self {
                size: [128, 256],
                length: 2.0,
                repeats: 2.0,
                thickness: Some(0.3),
                roughness: 0.85,
                ..wood
            },
            Surface::OcotilloFlower => Self {
                size: [64, 64],
                thickness: Some(0.4),
                roughness: 0.6,
                reflectance: 0.4,
                ..wood
            },
            Surface::AloeLeaf => Self {
                size: [128, 128],
                thickness: Some(0.05),
                roughness: 0.5,
                reflectance: 0.45,
                ..wood
            },
            Surface::Coconut => Self {
                size: [128, 64],
                thickness: Some(0.07),
                roughness: 0.55,
                reflectance: 0.45,
                ..wood
            },
            Surface::Stone => Self {
                size: [128, 128],
                thickness: Some(0.16),
                ..wood
            },
            Surface::Masonry => Self {
                size: [512, 128],
                length: MASONRY_LENGTH,
                repeats: 6.0,
                thickness: Some(0.055),
                roughness: 0.95,
                ..wood
            },
            Surface::Timber => Self {
                size: [256, 256],
                length: 2.0,
                repeats: 0.5,
                thickness: Some(0.1),
                roughness: 0.88,
                ..wood
            },
            Surface::Rope => Self {
                size: [64, 64],
                thickness: Some(0.3),
                ..wood
            },
            Surface::RoofTile => Self {
                size: [512, 128],
                length: 0.159_154_94,
                thickness: Some(0.075),
                roughness: 0.85,
                ..wood
            },
            Surface::PalmLeaf => Self {
                size: [64, 64],
                thickness: None,
                roughness: 0.5,
                reflectance: 0.45,
                ..wood
            },
            Surface::GrassBlade => Self {
                size: [32, 64],
                length: 8.0,
                repeats: 0.125,
                thickness: None,
                roughness: 0.6,
                reflectance: 0.4,
            },
            Surface::PineNeedles => Self {
                size: [16, 64],
                length: 6.0,
                thickness: None,
                roughness: 0.55,
                reflectance: 0.4,
                ..wood
            },
            Surface::WellShaft => Self {
                size: [16, 16],
                thickness: None,
                roughness: 1.0,
                reflectance: 0.0,
                ..wood
            },
            Surface::Water => Self {
                size: [16, 16],
                length: 0.159_154_94,
                thickness: None,
                roughness: 0.08,
                reflectance: 0.5,
                ..wood
            },
        }
    }
}
