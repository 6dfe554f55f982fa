//! Orientations and slicing boxes (§2.1).

use core::f32::consts::{PI, TAU};

use bevy::math::Vec3;
use bevy::reflect::Reflect;
use serde::{Deserialize, Serialize};

/// How the directions from which a plant is seen are covered with orientations (§2.3). Other numbers are refused when it is
/// baked.
#[derive(Clone, Debug, PartialEq, Reflect)]
pub enum Orientations {
    /// So many, evenly spread over the horizontal circle: 3 to 31. The paper has 6.
    Circle(u32),
    /// So many, evenly spread over the sphere: 6 to 31.
    Sphere(u32),
    /// So many over an arc of the horizontal circle, from which alone the plant is seen: 2 to 31.
    Arc {
        /// How many, both ends included.
        count: u32,
        /// First azimuth of the eye, in radians from x towards z.
        from: f32,
        /// Last azimuth, greater than `from` by less than 2π.
        to: f32,
    },
}

impl Default for Orientations {
    fn default() -> Self {
        Self::Circle(6)
    }
}

impl Orientations {
    /// The unit vectors towards the eye that they are made for, in the plant's local space.
    pub fn directions(&self) -> Vec<Vec3> {
        let horizontal = |azimuth: f32| Vec3::new(azimuth.cos(), 0.0, azimuth.sin());
        match *self {
            Self::Circle(count) => (0..count)
                .map(|i| horizontal(TAU * i as f32 / count as f32))
                .collect(),
            Self::Arc { count, from, to } => (0..count)
                .map(|i| horizontal(from + (to - from) * i as f32 / (count.max(2) - 1) as f32))
                .collect(),
            // A spiral of equal areas: Á. González, Measurement of Areas on a Sphere Using Fibonacci and
            // Latitude-Longitude Lattices, Mathematical Geosciences 42, 2010.
            Self::Sphere(count) => (0..count)
                .map(|i| {
                    let y = 1.0 - (2.0 * i as f32 + 1.0) / count as f32;
                    let azimuth = i as f32 * PI * (3.0 - 5.0_f32.sqrt());
                    horizontal(azimuth) * (1.0 - y * y).sqrt() + Vec3::Y * y
                })
                .collect(),
        }
    }
}

/// One orientation of the slices: their common normal, the axes of their pictures, and the slicing box (§2.1).
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
pub struct Orientation {
    /// v_s/|v_s|: unit, towards the eye that the slices are made for; local space.
    pub direction: Vec3,
    /// Unit, to the right in the pictures.
    pub right: Vec3,
    /// Unit, up in the pictures.
    pub up: Vec3,
    /// Low corner of the slicing box, in metres along right, up and direction from the centroid c_s.
    pub low: Vec3,
    /// High corner of the slicing box.
    pub high: Vec3,
}

impl Orientation {
    /// The axes of pictures taken from `direction` (unit). Straight above, the picture's top is towards −z.
    pub fn facing(direction: Vec3) -> Self {
        let top = if direction.y.abs() > 0.999 {
            Vec3::NEG_Z
        } else {
            Vec3::Y
        };
        let right = top.cross(direction).normalize();
        Self {
            direction,
            right,
            up: direction.cross(right),
            low: Vec3::ZERO,
            high: Vec3::ZERO,
        }
    }

    /// A point, given from the centroid, in the box's own axes: right, up, towards the eye.
    pub fn axes(&self, from_centroid: Vec3) -> Vec3 {
        Vec3::new(
            self.right.dot(from_centroid),
            self.up.dot(from_centroid),
            self.direction.dot(from_centroid),
        )
    }

    /// |v_s|: the distance between `count` slices, in metres.
    pub fn spacing(&self, count: u32) -> f32 {
        (self.high.z - self.low.z) / count as f32
    }

    /// Where slice `index` of `count` lies along the direction, in metres from the centroid. The first is furthest from
    /// the eye. Slices stand in the middle of equal layers of the box, so that no primitive moves by more than half
    /// their distance.
    pub fn offset(&self, index: u32, count: u32) -> f32 {
        self.low.z + (index as f32 + 0.5) * self.spacing(count)
    }

    /// The slice nearest to a depth along the direction: 2 d(S_s, c_p) ≤ |v_s| (§2.2).
    pub fn slice_at(&self, depth: f32, count: u32) -> u32 {
        let index = ((depth - self.low.z) / self.spacing(count)).floor();
        // The cast clamps from below, and makes 0 of NaN.
        (index as u32).min(count - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_are_right_handed_and_of_unit_length() {
        let all = [Orientations::Circle(6), Orientations::Sphere(20)];
        for direction in all
            .iter()
            .flat_map(Orientations::directions)
            .chain([Vec3::Y, Vec3::NEG_Y])
        {
            let o = Orientation::facing(direction);
            // Three roundings of 2⁻²⁴ in each product of unit vectors.
            assert!((o.right.cross(o.up) - o.direction).length() < 1e-6, "{o:?}");
            assert!((o.right.length() - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn every_depth_goes_to_a_slice_no_further_than_half_the_spacing() {
        let mut o = Orientation::facing(Vec3::X);
        (o.low.z, o.high.z) = (-1.7, 2.4);
        for count in [1, 3, 5, 64] {
            for i in 0..=1000 {
                let depth = -1.7 + 4.1 * i as f32 / 1000.0;
                let slice = o.offset(o.slice_at(depth, count), count);
                assert!(
                    (slice - depth).abs() <= 0.5 * o.spacing(count) + 1e-6,
                    "{depth}, {count}"
                );
            }
        }
        assert_eq!(o.slice_at(f32::NAN, 5), 0);
    }

    #[test]
    fn orientations_over_the_sphere_leave_no_gap_wider_than_four_mean_spacings() {
        let directions = Orientations::Sphere(20).directions();
        // A cap of 4π/20 steradians has a radius of 0.456.
        for probe in Orientations::Sphere(997).directions() {
            let nearest = directions.iter().map(|d| d.dot(probe)).fold(-1.0, f32::max);
            assert!(nearest.acos() < 0.8, "{probe}");
        }
    }
}
