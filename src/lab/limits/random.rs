//! Random numbers in double precision, the same on every machine.

use core::f64::consts::TAU;

use glam::DVec3;

use crate::plants::Dice;

/// A stream of random numbers.
pub(super) struct Random(Dice);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(Dice::new(seed))
    }

    /// A number from `low` to `high`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        let unit = (self.0.bits() >> 11) as f64 / (1_u64 << 53) as f64;
        low + (high - low) * unit
    }

    /// A direction, evenly on the sphere.
    pub fn direction(&mut self) -> DVec3 {
        let z = self.between(-1.0, 1.0);
        let (sin, cos) = self.between(0.0, TAU).sin_cos();
        let across = (1.0 - z * z).sqrt();
        DVec3::new(across * cos, across * sin, z)
    }

    /// A unit vector across a unit vector.
    pub fn across(&mut self, axis: DVec3) -> DVec3 {
        let (u, v) = axis.any_orthonormal_pair();
        let (sin, cos) = self.between(0.0, TAU).sin_cos();
        u * cos + v * sin
    }
}

/// The value that this share of the values do not exceed; 0 where there are none.
pub(super) fn quantile(values: &mut [f64], share: f64) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    values.sort_unstable_by(f64::total_cmp);
    values[((values.len() - 1) as f64 * share).round() as usize]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_values_in_order() {
        let mut values = [5.0, 1.0, 4.0, 2.0, 3.0];
        assert_eq!(quantile(&mut values, 0.0), 1.0);
        assert_eq!(quantile(&mut values, 0.5), 3.0);
        assert_eq!(quantile(&mut values, 1.0), 5.0);
    }
}
