//! Random numbers for the tests, the same on every machine.

use glam::DVec3;

use crate::plants::Dice;

/// Random numbers in double precision.
pub(super) struct SplitMix64(Dice);

impl SplitMix64 {
    pub fn new(seed: u64) -> Self {
        Self(Dice::new(seed))
    }

    pub fn next(&mut self) -> u64 {
        self.0.bits()
    }

    /// In [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Even in the logarithm, for sizes and ratios.
    pub fn log_range(&mut self, low: f64, high: f64) -> f64 {
        self.range(low.ln(), high.ln()).exp()
    }

    pub fn below(&mut self, n: usize) -> usize {
        (self.unit() * n as f64) as usize
    }

    /// A direction, evenly on the sphere.
    pub fn direction(&mut self) -> DVec3 {
        let z = self.range(-1.0, 1.0);
        let (sin, cos) = self.range(0.0, std::f64::consts::TAU).sin_cos();
        let across = (1.0 - z * z).sqrt();
        DVec3::new(across * cos, across * sin, z)
    }

    /// A direction at `angle` (radians) from `axis`.
    pub fn direction_at(&mut self, axis: DVec3, angle: f64) -> DVec3 {
        let (u, v) = axis.any_orthonormal_pair();
        let (sin, cos) = self.range(0.0, std::f64::consts::TAU).sin_cos();
        axis * angle.cos() + (u * cos + v * sin) * angle.sin()
    }
}
