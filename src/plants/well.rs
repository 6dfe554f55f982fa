//! Well: no plant, but the smallest of the paper's scenes (Figure 10): eight segments.

use core::f32::consts::TAU;

use bevy::math::Vec3;

use super::dice::Dice;
use super::shape::within;
use super::{Plant, Surface};
use crate::skeleton::{Skeleton, SkeletonBuilder};

/// A round draw-well with a roof: its wall, its shaft, two posts, the windlass across them, a rope, a pail and the
/// roof, a segment each. The wall goes an eighth of its radius into the ground. The seed says how far the pail is let
/// down.
///
/// A frustum is never hollow, so the shaft is a disc that lies 4 mm above the wall's flat top, and is meant to be
/// dark. All parts are meant for flat ends ([`Surface::has_flat_ends`]): [`Surface::Masonry`],
/// [`Surface::WellShaft`], [`Surface::Timber`] (posts, windlass, pail), [`Surface::Rope`] and [`Surface::RoofTile`].
#[derive(Clone, Debug, PartialEq)]
pub struct Well {
    /// Outer radius of the wall, in metres; 0.2 to 5.
    pub radius: f32,
    /// Height of the wall, in metres; 0.1 to 5.
    pub wall_height: f32,
    /// Height of the eaves above the wall, in metres; 0.6 to 10, and at least 1.1 times the radius.
    pub headroom: f32,
}

impl Default for Well {
    fn default() -> Self {
        Self {
            radius: 0.95,
            wall_height: 0.82,
            headroom: 1.2,
        }
    }
}

impl Well {
    /// Builds a well. Values outside their ranges are brought into them, and those that are not finite replaced by
    /// the default's.
    pub fn grow(&self, seed: u64) -> Plant {
        let normal = Self::default();
        let r = within(self.radius, 0.2, 5.0, normal.radius);
        let top = within(self.wall_height, 0.1, 5.0, normal.wall_height);
        let headroom = within(self.headroom, 0.6, 10.0, normal.headroom).max(1.1 * r);
        let eaves = top + headroom;
        let mut dice = Dice::new(seed);
        let up = |y: f32| Vec3::Y * y;

        let mut wall = Skeleton::builder();
        let buried = 0.12 * r;
        bar(&mut wall, (up(-buried), r * 1.04), (up(top), r * 0.98));
        let mut shaft = Skeleton::builder();
        bar(
            &mut shaft,
            (up(top - 0.05 * r), r * 0.70),
            (up(top + 0.004), r * 0.70),
        );

        let mut timber = Skeleton::builder();
        let aside = Vec3::X * (r * 0.84);
        for side in [-aside, aside] {
            let foot = side + up(top - 0.3 * r.min(top));
            bar(
                &mut timber,
                (foot, r * 0.095),
                (side + up(eaves + 0.12 * r), r * 0.085),
            );
        }
        let axle = top + 0.62 * headroom;
        let out = Vec3::X * (r * 1.12);
        bar(
            &mut timber,
            (up(axle) - out, r * 0.062),
            (up(axle) + out, r * 0.062),
        );
        let pail = top + headroom * dice.between(0.10, 0.2);
        let rim = pail + 0.27 * r;
        let hang = Vec3::new(r * dice.jitter(0.12), 0.0, r * 0.07);
        bar(
            &mut timber,
            (hang + up(pail), r * 0.12),
            (hang + up(rim), r * 0.165),
        );
        let mut rope = Skeleton::builder();
        bar(
            &mut rope,
            (hang + up(pail + 0.1 * r), r * 0.016),
            (hang + up(axle), r * 0.016),
        );

        let mut roof = Skeleton::builder();
        cone(&mut roof, up(eaves), r * 1.34, r * 0.98);
        Plant::default()
            .with(Surface::Masonry, wall)
            .with(Surface::Timber, timber)
            .with(Surface::RoofTile, roof)
            .with(Surface::Rope, rope)
            .with(Surface::WellShaft, shaft)
    }
}

/// A single segment from joint to joint, each a position and a radius.
fn bar(part: &mut SkeletonBuilder, from: (Vec3, f32), to: (Vec3, f32)) {
    let root = part.root(from.0, from.1);
    part.texture_length(root, TAU * from.1.max(to.1));
    part.joint(root, to.0, to.1);
}

/// An upright cone over a disc of this radius.
///
/// A joint's radius is that of the sphere that the cone touches: with half-angle α, tan α = radius/height, the one
/// about the disc's centre has ρ = radius·cos α, and the one at a distance y above it ρ − y·sin α.
fn cone(part: &mut SkeletonBuilder, foot: Vec3, radius: f32, height: f32) {
    let slant = radius.hypot(height);
    let (sin, cos) = (radius / slant, height / slant);
    let blunt = 0.985 * height;
    bar(
        part,
        (foot, radius * cos),
        (foot + Vec3::Y * blunt, radius * cos - blunt * sin),
    );
    part.texture_length(0, radius);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plants::testing::{ODD, is_sound, stands_on_the_ground};

    #[test]
    fn a_well_has_8_segments() {
        for seed in 0..5 {
            let well = Well::default().grow(seed);
            assert_eq!(well.segment_count(), 8);
            assert_eq!(well, Well::default().grow(seed));
            assert_ne!(well, Well::default().grow(seed + 1));
            stands_on_the_ground(&well, 0.0);
        }
    }

    #[test]
    fn the_roof_is_a_cone_over_its_eaves() {
        let mut part = Skeleton::builder();
        cone(&mut part, Vec3::Y, 2.0, 1.5);
        let part = part.build().unwrap();
        let [low, high] = part.joints() else { panic!() };
        // s and c of the tangent cone; its cross-section at the foot has the radius ρ/c.
        let s = (low.radius - high.radius) / (high.position.y - low.position.y);
        let c = (1.0 - s * s).sqrt();
        assert!((low.radius / c - 2.0).abs() < 1e-5);
        // It would come to its point at 1.5 m.
        assert!((low.radius / s - 1.5).abs() < 1e-5);
    }

    #[test]
    fn any_parameters_build_a_well() {
        for x in ODD {
            for y in ODD {
                let well = Well {
                    radius: x,
                    wall_height: y,
                    headroom: y,
                };
                is_sound(&well.grow(3), 8);
                let well = Well {
                    headroom: x,
                    ..Well::default()
                };
                is_sound(&well.grow(3), 8);
            }
        }
    }
}
