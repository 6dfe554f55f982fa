//! From a file's coordinates to metres in a plant's local space.

use bevy::math::{DVec3, Vec3};

use super::error::{SkeletonError, SkeletonFileErrorKind};
use super::joint::MAX_RADIUS;
use super::settings::{Recentre, SkeletonLoaderSettings, UpAxis};
use super::skeleton::Skeleton;

/// Distance from a file's origin along an axis, in metres, from which [`Recentre::Auto`] moves it. At this
/// distance neighbouring `f32` numbers are 1 mm apart.
const FAR: f64 = 1.0e4;

/// How a file's coordinates lie in the plant's local space.
pub(super) struct Frame {
    /// The local origin, in the file's coordinates.
    origin: DVec3,
    /// Metres in one unit of the file.
    scale: f64,
    up: UpAxis,
    /// Least radius in metres.
    min_radius: f64,
}

impl Frame {
    /// The frame for a file with these `positions`, whose first root stands on `base`.
    pub fn new(
        settings: &SkeletonLoaderSettings,
        default_up: UpAxis,
        base: DVec3,
        mut positions: impl Iterator<Item = DVec3>,
    ) -> Self {
        let scale = f64::from(settings.scale);
        let recentred = match settings.recentre {
            Recentre::Always => true,
            Recentre::Never => false,
            Recentre::Auto => positions.any(|position| position.abs().max_element() * scale > FAR),
        };
        Self {
            origin: if recentred { base } else { DVec3::ZERO },
            scale,
            up: settings.up.unwrap_or(default_up),
            min_radius: settings.min_radius.map_or(0.0, f64::from),
        }
    }

    /// A position of the file, in metres in the plant's local space. Not finite if it is too far away.
    pub fn position(&self, position: DVec3) -> Vec3 {
        let local = (position - self.origin) * self.scale;
        let upright = match self.up {
            UpAxis::Y => local,
            UpAxis::Z => DVec3::new(local.x, local.z, -local.y),
        };
        upright.as_vec3()
    }

    /// A distance of the file, in metres.
    pub fn metres(&self, distance: f64) -> f64 {
        distance * self.scale
    }

    /// A radius of the file, in metres.
    pub fn radius(&self, radius: f64) -> Result<f32, SkeletonFileErrorKind> {
        let metres = (radius * self.scale).max(self.min_radius) as f32;
        // Checked as `f32`, since a positive number may round to zero.
        if metres > 0.0 && metres <= MAX_RADIUS {
            Ok(metres)
        } else {
            Err(SkeletonFileErrorKind::Radius { radius })
        }
    }

    /// The skeleton, with the offset of this frame.
    pub fn place(&self, skeleton: Skeleton) -> Result<Skeleton, SkeletonError> {
        skeleton.with_offset(self.origin)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const OAK: DVec3 = DVec3::new(384_512.25, 6_671_034.5, 112.0);

    fn frame(settings: &SkeletonLoaderSettings, base: DVec3) -> Frame {
        Frame::new(settings, UpAxis::Y, base, [base].into_iter())
    }

    #[test]
    fn far_positions_keep_their_millimetres() {
        let frame = frame(&SkeletonLoaderSettings::default(), OAK);
        let local = frame.position(OAK + DVec3::new(0.001, -0.002, 0.003));
        // The sum is rounded to the f64 grid at 7e6, 1e-9 apart.
        assert!(local.abs_diff_eq(Vec3::new(0.001, -0.002, 0.003), 2e-9));
    }

    #[test]
    fn auto_recentres_beyond_ten_kilometres_only() {
        let near = DVec3::new(9_999.0, -9_999.0, 0.0);
        let settings = SkeletonLoaderSettings::default();
        assert_eq!(frame(&settings, near).origin, DVec3::ZERO);
        assert_eq!(frame(&settings, near * 1.001).origin, near * 1.001);
        // 20 000 µm are no distance.
        let micrometres = SkeletonLoaderSettings {
            scale: 1e-6,
            ..settings
        };
        assert_eq!(frame(&micrometres, near * 2.0).origin, DVec3::ZERO);
    }

    #[test]
    fn recentring_can_be_forced_or_forbidden() {
        let always = SkeletonLoaderSettings {
            recentre: Recentre::Always,
            ..Default::default()
        };
        assert_eq!(frame(&always, DVec3::ONE).origin, DVec3::ONE);
        let never = SkeletonLoaderSettings {
            recentre: Recentre::Never,
            ..Default::default()
        };
        assert_eq!(frame(&never, OAK).origin, DVec3::ZERO);
    }

    #[test]
    fn z_up_becomes_y_up_without_mirroring() {
        let settings = SkeletonLoaderSettings {
            up: Some(UpAxis::Z),
            ..Default::default()
        };
        let frame = frame(&settings, DVec3::ZERO);
        let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| frame.position(axis));
        assert_eq!((z, x.cross(y)), (Vec3::Y, z));
    }

    #[test]
    fn radii_are_scaled_and_then_widened() {
        let settings = SkeletonLoaderSettings {
            scale: 0.01,
            min_radius: Some(0.002),
            ..Default::default()
        };
        let frame = frame(&settings, DVec3::ZERO);
        assert_eq!(frame.radius(50.0), Ok(0.5));
        assert_eq!(frame.radius(0.1), Ok(0.002));
        assert_eq!(frame.radius(-3.0), Ok(0.002));
    }

    #[test]
    fn radii_that_are_not_positive_or_round_to_zero_are_refused() {
        let frame = frame(&SkeletonLoaderSettings::default(), DVec3::ZERO);
        for radius in [0.0, -1.0, 1e-60, 2e5, 1e300] {
            assert_eq!(
                frame.radius(radius),
                Err(SkeletonFileErrorKind::Radius { radius })
            );
        }
    }
}
