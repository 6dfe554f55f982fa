//! Random numbers that are the same on every machine.

use core::f32::consts::TAU;

/// A stream of random numbers from a seed (SplitMix64: G. L. Steele, D. Lea, C. H. Flood, *Fast Splittable
/// Pseudorandom Number Generators*, OOPSLA 2014). Integers only, so that a plant's seed means the same plant
/// everywhere.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Dice(u64);

impl Dice {
    /// The stream that belongs to `seed`.
    pub const fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The next 64 random bits.
    pub const fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number in 0..1, each of 2²⁴ as likely.
    pub const fn roll(&mut self) -> f32 {
        (self.bits() >> 40) as f32 / (1_u32 << 24) as f32
    }

    /// A number in `low..high`; `low` where they are equal.
    pub const fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.roll()
    }

    /// A number in `-half..half`.
    pub const fn jitter(&mut self, half: f32) -> f32 {
        self.between(-half, half)
    }

    /// An angle in 0..2π, in radians.
    pub const fn angle(&mut self) -> f32 {
        self.between(0.0, TAU)
    }

    /// A stream of its own, so that what it is used for may change in length without changing what comes after.
    pub const fn split(&mut self) -> Self {
        Self(self.bits())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stream_is_that_of_splitmix64() {
        // The first outputs of the published C code for this seed.
        let mut dice = Dice::new(1_234_567);
        assert_eq!(dice.bits(), 6_457_827_717_110_365_317);
        assert_eq!(dice.bits(), 3_203_168_211_198_807_973);
        assert_eq!(dice.bits(), 9_817_491_932_198_370_423);
    }

    #[test]
    fn rolls_are_in_range_and_centred() {
        let mut dice = Dice::new(7);
        let rolls: Vec<_> = (0..4096).map(|_| dice.roll()).collect();
        assert!(rolls.iter().all(|roll| (0.0..1.0).contains(roll)));
        // The mean of n rolls has standard deviation 1/√(12 n) = 0.0045; five of them.
        let mean = rolls.iter().sum::<f32>() / 4096.0;
        assert!((mean - 0.5).abs() < 0.023, "{mean}");
    }

    #[test]
    fn a_split_stream_leaves_the_first_as_it_was() {
        let (mut one, mut other) = (Dice::new(3), Dice::new(3));
        let mut branch = one.split();
        other.split();
        branch.roll();
        assert_eq!(one.roll(), other.roll());
        assert_ne!(branch.roll(), one.roll());
    }
}
