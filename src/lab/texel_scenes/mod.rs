//! Scenes of texels, those of the paper's pictures (§6) and more: which volume, on what, seen from where.
//!
//! | file | question |
//! |---|---|
//! | `patterns` | which volumes are there, of what shapes? |
//! | [`surfaces`], `limb` | what do they cover? |
//! | `hand` | what strokes them? |
//! | `stand` | how does a scene look with some settings? |
//! | `full` | which triangles do texels stand for? |
//! | `counts` | how many slices is it drawn by? |

mod counts;
mod full;
mod hand;
mod limb;
mod patterns;
mod stand;
pub mod surfaces;

use bevy::prelude::*;
use clap::ValueEnum;

use crate::texel::build::Spreading;
use crate::texel::{TexelSettings, TexelVolume, silent};

pub use counts::{SliceCounts, texel_bytes, texel_view};
pub use full::{full_mesh, instances};
pub use hand::{Hand, RECOVERY, bring_hand, move_hands};
pub use limb::{Knee, bend_knees, joints};
pub use patterns::Pattern;
pub use stand::{FullMeshes, TexelStand, all_slices};

/// What there is to see.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum TexelScene {
    /// A texel of 64³, and two that overlap (§6, Figure 10).
    Pear,
    /// 96 of them on a sphere of 192 triangles (Figure 11, left).
    Pears,
    /// 16 bushes of 3,500 triangles (Figure 11, right).
    Bushes,
    /// A texel of a height field, straight and bent by its height vectors (Figure 13).
    Noise,
    /// 96 of them on a sphere of 192 triangles (Figure 15).
    Sphere,
    /// 100 of them on a jittered plane of 200 triangles (Figure 16).
    Plane,
    /// A furry flag, of which all vertices move.
    Flag,
    /// A ball of fur in the wind.
    Fur,
    /// A limb of fur on two joints.
    Limb,
    /// An animal's back, and a hand that strokes its fur.
    Stroke,
    /// Reeds that sway: eight volumes by turns, as in a cartoon (§5).
    Reeds,
    /// A hill of grass in the wind.
    Meadow,
}

/// Volumes a second of scenes that show several: a sway of reeds in a second and a third.
pub const CYCLE_RATE: f32 = 6.0;

/// A surface to be covered.
pub struct Covered {
    /// With texture coordinates of a texel a square.
    pub mesh: Mesh,
    /// Length of the height vectors, where the mesh has none.
    pub thickness: f32,
    /// Where it is.
    pub place: Transform,
    /// Of the surface itself, if it is drawn.
    pub color: Option<Color>,
}

impl TexelScene {
    /// Its name on the command line.
    pub fn name(self) -> String {
        self.to_possible_value()
            .map_or_else(String::new, |value| value.get_name().into())
    }

    /// The pattern that surfaces are covered with.
    pub const fn pattern(self) -> Pattern {
        match self {
            Self::Pear | Self::Pears => Pattern::Pear,
            Self::Bushes => Pattern::Bush,
            Self::Noise | Self::Sphere | Self::Plane => Pattern::Noise,
            Self::Flag | Self::Fur | Self::Limb | Self::Stroke => Pattern::Fur,
            Self::Reeds => Pattern::Reeds { moment: 0 },
            Self::Meadow => Pattern::Grass,
        }
    }

    /// Its volume; the first, if there are several.
    pub fn volume(self) -> Result<TexelVolume, String> {
        build(self.pattern())
    }

    /// Its volumes, one, or several that are shown by turns.
    pub fn volumes(self) -> Result<Vec<TexelVolume>, String> {
        if self == Self::Reeds {
            let moments = 0..patterns::REED_MOMENTS;
            return moments
                .map(|moment| build(Pattern::Reeds { moment }))
                .collect();
        }
        Ok(vec![self.volume()?])
    }

    /// Where it is seen from: the eye, and what it looks at.
    pub fn view(self) -> (Vec3, Vec3) {
        match self {
            Self::Pear => (Vec3::new(0.6, 1.6, 3.2), Vec3::new(0.0, 0.45, 0.0)),
            Self::Pears | Self::Sphere | Self::Fur => (Vec3::new(0.0, 1.9, 4.6), Vec3::Y * 1.3),
            Self::Limb => (Vec3::new(0.3, 1.7, 4.0), Vec3::new(0.3, 0.95, 0.0)),
            Self::Flag => (Vec3::new(0.4, 1.9, 3.4), Vec3::new(0.0, 1.3, 0.0)),
            Self::Bushes => (Vec3::new(0.0, 2.2, 5.6), Vec3::Y * 0.2),
            Self::Noise => (Vec3::new(0.0, 1.7, 3.9), Vec3::Y * 0.1),
            Self::Plane => (Vec3::new(0.0, 2.4, 6.5), Vec3::ZERO),
            Self::Stroke => (Vec3::new(0.0, 2.0, 3.2), Vec3::new(0.0, 0.4, 0.0)),
            Self::Reeds => (Vec3::new(0.0, 1.6, 6.0), Vec3::new(0.0, 0.5, 0.0)),
            Self::Meadow => (Vec3::new(0.0, 1.8, 7.0), Vec3::new(0.0, 0.9, 0.0)),
        }
    }

    /// How it is drawn.
    pub fn settings(self) -> TexelSettings {
        let mut settings = TexelSettings::default();
        match self {
            // They overlap, and meet in steps as high as slices are apart.
            Self::Pear => settings.quality.least_angle = 1.1,
            Self::Bushes | Self::Reeds => settings.diffuse_transmission = 0.5,
            Self::Fur => settings.flexibility = 0.03,
            Self::Meadow => {
                settings.flexibility = 0.03;
                settings.diffuse_transmission = 0.5;
            }
            _ => {}
        }
        settings
    }

    /// What is covered.
    pub fn surfaces(self) -> Vec<Covered> {
        let covered = |mesh, thickness, place| Covered {
            mesh,
            thickness,
            place,
            color: None,
        };
        match self {
            Self::Pear => [(-0.6, 0.0), (0.55, 0.0), (0.83, 0.12)]
                .map(|(x, z)| {
                    let place = Transform::from_xyz(x, 0.0, z);
                    covered(surfaces::grid(1, 1, Vec2::splat(0.9)), 0.9, place)
                })
                .into(),
            Self::Pears => vec![Covered {
                color: Some(Color::srgb(0.25, 0.3, 0.12)),
                ..covered(
                    surfaces::sphere(1.0),
                    0.45,
                    Transform::from_xyz(0.0, 1.3, 0.0),
                )
            }],
            Self::Bushes => vec![Covered {
                color: Some(Color::srgb(0.4, 0.32, 0.2)),
                ..covered(
                    surfaces::grid(4, 4, Vec2::splat(4.0)),
                    0.8,
                    Transform::from_xyz(0.0, 0.01, 0.0),
                )
            }],
            Self::Noise => {
                let flat = || surfaces::grid(1, 1, Vec2::splat(1.0));
                let lean = |_| Vec3::new(0.35, 0.3, 0.0);
                let spread = |at: Vec3| Vec3::new(at.x * 0.7, 0.35, at.z * 0.7);
                vec![
                    covered(flat(), 0.3, Transform::from_xyz(-1.52, 0.02, 0.0)),
                    covered(
                        surfaces::with_heights(flat(), lean),
                        0.3,
                        Transform::from_xyz(-0.42, 0.02, 0.0),
                    ),
                    covered(
                        surfaces::with_heights(flat(), spread),
                        0.3,
                        Transform::from_xyz(1.27, 0.02, 0.0),
                    ),
                ]
            }
            Self::Sphere => vec![Covered {
                color: Some(Color::srgb(0.2, 0.16, 0.12)),
                ..covered(
                    surfaces::sphere(1.0),
                    0.2,
                    Transform::from_xyz(0.0, 1.3, 0.0),
                )
            }],
            Self::Plane => vec![covered(
                surfaces::jittered(10, 10, Vec2::splat(8.0)),
                0.25,
                Transform::from_xyz(0.0, 0.01, 0.0),
            )],
            Self::Flag => vec![Covered {
                color: Some(Color::srgb(0.80, 0.32, 0.22)),
                ..covered(
                    surfaces::flag(0.0),
                    0.025,
                    // Its fur to the sun.
                    Transform::from_xyz(0.0, 1.3, 0.0).with_rotation(Quat::from_rotation_y(0.6)),
                )
            }],
            Self::Fur => vec![Covered {
                color: Some(Color::srgb(0.10, 0.06, 0.03)),
                ..covered(
                    surfaces::sphere(1.0),
                    0.25,
                    Transform::from_xyz(0.0, 1.3, 0.0),
                )
            }],
            Self::Limb => vec![Covered {
                color: Some(Color::srgb(0.10, 0.06, 0.03)),
                ..covered(limb::limb(), 0.07, Transform::IDENTITY)
            }],
            Self::Stroke => vec![Covered {
                color: Some(Color::srgb(0.10, 0.06, 0.03)),
                ..covered(surfaces::back(), 0.14, Transform::IDENTITY)
            }],
            Self::Reeds => vec![Covered {
                // Water.
                color: Some(Color::srgb(0.10, 0.17, 0.18)),
                ..covered(
                    surfaces::grid(8, 5, Vec2::new(8.0, 5.0)),
                    0.9,
                    Transform::from_xyz(0.0, 0.01, 0.0),
                )
            }],
            Self::Meadow => vec![Covered {
                color: Some(Color::srgb(0.13, 0.19, 0.05)),
                ..covered(surfaces::hill(12, 12.0), 0.35, Transform::IDENTITY)
            }],
        }
    }
}

fn build(pattern: Pattern) -> Result<TexelVolume, String> {
    let built = pattern.build(pattern.size(), Spreading::default(), &silent);
    Ok(built.map_err(|error| error.to_string())?.volume.into())
}
