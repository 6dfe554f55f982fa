//! How a crown is baked.

use bevy::math::Vec3;

use super::error::BakeError;
use crate::slicing::limits::{
    MAX_LAYERS, MAX_LEVELS, MAX_ORIENTATIONS, MAX_PIXELS, MAX_PIXELS_TOTAL, MAX_SAMPLES, MAX_SLICES,
};
use crate::slicing::orientation::Orientations;

/// Settings of [`bake`](super::bake()). The defaults are the paper's 6 orientations of 5 slices of 256² pixels, with a
/// vertical orientation and two coarser levels of detail besides; [`for_view`](Self::for_view) derives them from a distance
/// and an error. There are 256 slices at most in all, of all orientations and levels, and 2²⁶ pixels; what is out of range
/// is refused, with the fix.
#[derive(Clone, Debug, PartialEq)]
pub struct BakeSettings {
    /// Directions to bake for.
    pub orientations: Orientations,
    /// Whether one more orientation looks down, for eyes above. Without meaning for [`Orientations::Sphere`].
    pub vertical: bool,
    /// Slices of an orientation, for each level of detail, the finest first: 1 to 3 levels of 1 to 64.
    pub levels: Vec<u32>,
    /// Distances from the centroid, in radii of the crown, at which each level gives over to the next, on a screen of 480
    /// lines of 52°; on others, where the crown is as small. One fewer than levels.
    pub switches: Vec<f32>,
    /// Pixels along each side of a slice: a power of two, 4 to 1024.
    pub pixels: u32,
    /// Samples along each side of a pixel, 1 to 8, and 4096 at most along that of a slice: each thread keeps eight bytes a
    /// sample.
    pub samples: u32,
    /// m_s of §2.3, 0 to 4: how much more opaque blended slicings are drawn in the paper's order, for their brightness.
    pub correction: f32,
    /// How much light from around is held back by the leaves it passes, from 0 to 1: 0 not at all, as meshes are lit in
    /// Bevy, which is nearest to these; 1 as if leaves were black. The default, a quarter, still is a little darker within.
    pub occlusion: f32,
    /// Threads to bake with; 0 for as many as the machine has cores. The result does not depend on it.
    pub threads: usize,
}

impl Default for BakeSettings {
    fn default() -> Self {
        Self {
            orientations: Orientations::default(),
            vertical: true,
            levels: vec![5, 3, 1],
            switches: vec![10.0, 25.0],
            pixels: 256,
            samples: 4,
            correction: 0.5,
            occlusion: 0.25,
            threads: 0,
        }
    }
}

impl BakeSettings {
    /// These settings with slices of so many pixels a side.
    pub fn with_pixels(mut self, pixels: u32) -> Self {
        self.pixels = pixels;
        self
    }

    /// These settings with other orientations.
    pub fn with_orientations(mut self, orientations: Orientations) -> Self {
        self.orientations = orientations;
        self
    }

    /// These settings with one level of detail of so many slices.
    pub fn with_slices(mut self, slices: u32) -> Self {
        self.levels = vec![slices];
        self.switches.clear();
        self
    }

    pub(super) fn check(&self) -> Result<(), BakeError> {
        let refuse = |setting, value: String, fix| {
            Err(BakeError::Setting {
                setting,
                value,
                fix,
            })
        };
        let (count, least) = match self.orientations {
            Orientations::Circle(count) => (count, 3),
            Orientations::Sphere(count) => (count, 6),
            Orientations::Arc { count, from, to } => {
                let width = to - from;
                if !(width > 0.0 && width < core::f32::consts::TAU && from.abs() < 100.0) {
                    return refuse(
                        "orientations",
                        format!("an arc from {from} to {to}"),
                        "let `to` be greater than `from`, by less than 2π",
                    );
                }
                (count, 2)
            }
        };
        if count < least || count as usize >= MAX_ORIENTATIONS {
            let fix = "use 3 to 31 over the circle, 6 to 31 over the sphere, 2 to 31 over an arc";
            return refuse("orientations", count.to_string(), fix);
        }
        let slices_fit = self
            .levels
            .iter()
            .all(|slices| (1..=MAX_SLICES).contains(slices));
        if !(1..=MAX_LEVELS).contains(&self.levels.len()) || !slices_fit {
            let fix = "use 1 to 3 levels of 1 to 64 slices";
            return refuse("levels", format!("{:?}", self.levels), fix);
        }
        let rises = self
            .switches
            .windows(2)
            .all(|pair| 1.25 * pair[0] <= pair[1]);
        let is_distance = |at: &f32| at.is_finite() && *at > 0.0;
        if self.switches.len() + 1 != self.levels.len()
            || !rises
            || !self.switches.iter().all(is_distance)
        {
            let fix = "give one distance fewer than levels, each by a quarter more than the last";
            return refuse("switches", format!("{:?}", self.switches), fix);
        }
        if !self.pixels.is_power_of_two() || !(4..=MAX_PIXELS).contains(&self.pixels) {
            return refuse(
                "pixels",
                self.pixels.to_string(),
                "use a power of two from 4 to 1024",
            );
        }
        if !(1..=8).contains(&self.samples) {
            return refuse("samples", self.samples.to_string(), "use 1 to 8");
        }
        if self.pixels * self.samples > MAX_SAMPLES {
            let fix = "let pixels times samples be 4096 at most";
            return refuse("samples", self.samples.to_string(), fix);
        }
        if !(0.0..=4.0).contains(&self.correction) {
            return refuse(
                "correction",
                self.correction.to_string(),
                "use 0 to 4; the paper has 0.5",
            );
        }
        if !(0.0..=1.0).contains(&self.occlusion) {
            return refuse("occlusion", self.occlusion.to_string(), "use 0 to 1");
        }
        let orientations = count as usize + usize::from(self.has_vertical());
        let layers = orientations * self.levels.iter().sum::<u32>() as usize;
        let total = layers as u64 * u64::from(self.pixels).pow(2);
        if layers > MAX_LAYERS || total > MAX_PIXELS_TOTAL {
            return Err(BakeError::TooLarge {
                layers,
                pixels: self.pixels,
            });
        }
        Ok(())
    }

    /// The directions that are baked for, the vertical one last.
    pub(super) fn directions(&self) -> Vec<Vec3> {
        let mut directions = self.orientations.directions();
        directions.extend(self.has_vertical().then_some(Vec3::Y));
        directions
    }

    pub(super) fn has_vertical(&self) -> bool {
        self.vertical && !matches!(self.orientations, Orientations::Sphere(_))
    }
}
