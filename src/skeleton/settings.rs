//! How the numbers of a foreign file become metres in a plant's local space.

use serde::{Deserialize, Serialize};

use super::error::SkeletonFileErrorKind;

/// How an SWC file or a cylinder table is read.
///
/// A `*.skeleton.ron` file already is in metres, y up, in the plant's own space: none of this applies to it.
///
/// With the asset server: `asset_server.load_builder().with_settings(...)`, or a `.meta` file beside the
/// skeleton's.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SkeletonLoaderSettings {
    /// Metres in one unit of the file, for positions and radii alike: 1 by default, 1e-6 for the µm that
    /// SWC files of neurons use. Finite and greater than 0, or the file is refused.
    pub scale: f32,
    /// Whether the base of the first root becomes the origin.
    pub recentre: Recentre,
    /// Which axis of the file points up. `None` is that of the format: z for cylinder tables, y for SWC.
    pub up: Option<UpAxis>,
    /// Radius, in metres, to which thinner joints are widened, those of radius 0 or less among them. Finite
    /// and greater than 0, or the file is refused. `None` refuses files with a radius of 0 or less.
    pub min_radius: Option<f32>,
}

impl Default for SkeletonLoaderSettings {
    fn default() -> Self {
        Self {
            scale: 1.0,
            recentre: Recentre::Auto,
            up: None,
            min_radius: None,
        }
    }
}

impl SkeletonLoaderSettings {
    /// Checks every number against its range.
    pub(super) fn validate(&self) -> Result<(), SkeletonFileErrorKind> {
        let numbers = [("scale", Some(self.scale)), ("min_radius", self.min_radius)];
        for (setting, value) in numbers {
            match value {
                Some(value) if !(value.is_finite() && value > 0.0) => {
                    return Err(SkeletonFileErrorKind::Setting { setting, value });
                }
                _ => {}
            }
        }
        Ok(())
    }
}

/// Whether the base of a file's first root becomes the origin of the plant's local space.
///
/// Surveys give positions in map coordinates, hundreds of kilometres from their origin, where `f32`
/// numbers are centimetres apart. Positions are therefore read and moved in `f64`, and where the origin
/// was is kept in [`Skeleton::offset`](super::Skeleton::offset).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Recentre {
    /// Only when a coordinate is more than 10 km from the file's origin.
    #[default]
    Auto,
    /// Always.
    Always,
    /// Never: positions are the file's own.
    Never,
}

/// The axis of a file that points up. Axes are right-handed, as Bevy's are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum UpAxis {
    /// y is up, as in Bevy: positions keep their axes.
    Y,
    /// z is up: (x, y, z) of the file is (x, z, −y) of the plant.
    Z,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scale_and_least_radius_are_positive_and_finite() {
        assert_eq!(SkeletonLoaderSettings::default().validate(), Ok(()));
        for bad in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            let scaled = SkeletonLoaderSettings {
                scale: bad,
                ..Default::default()
            };
            let widened = SkeletonLoaderSettings {
                min_radius: Some(bad),
                ..Default::default()
            };
            assert!(scaled.validate().unwrap_err().to_string().contains("scale"));
            assert!(
                widened
                    .validate()
                    .unwrap_err()
                    .to_string()
                    .contains("min_radius")
            );
        }
    }
}
