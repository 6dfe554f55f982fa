//! Colours and normals as bytes, and as what may be averaged.
//!
//! Averages of colours are those of light, so they are taken of linear values (IEC 61966-2-1).

use bevy::math::Vec3;

/// The linear value, 0 to 1, of an sRGB value, 0 to 1.
pub fn srgb_to_linear(value: f32) -> f32 {
    if value <= 0.04045 {
        value / 12.92
    } else {
        ((value + 0.055) / 1.055).powf(2.4)
    }
}

/// The sRGB value, 0 to 1, of a linear value, which is clamped to 0 to 1.
pub fn linear_to_srgb(value: f32) -> f32 {
    let value = value.clamp(0.0, 1.0);
    if value <= 0.003_130_8 {
        value * 12.92
    } else {
        1.055 * value.powf(1.0 / 2.4) - 0.055
    }
}

/// From sRGB bytes to linear values and back, by tables.
pub(super) struct SrgbTable {
    linear: [f32; 256],
    /// `first[i]` is the byte of the linear value `i / (COARSE − 1)`, where the search for a value starts.
    first: Vec<u8>,
    /// The linear value from which on a byte is rounded up to the next one.
    upper: [f32; 256],
}

/// Entries of the table in which the search for a byte starts.
const COARSE: usize = 4096;

impl SrgbTable {
    pub fn new() -> Self {
        let linear = std::array::from_fn(|byte| srgb_to_linear(byte as f32 / 255.0));
        let upper = std::array::from_fn(|byte| srgb_to_linear((byte as f32 + 0.5) / 255.0));
        let byte = |i: usize| (linear_to_srgb(i as f32 / (COARSE - 1) as f32) * 255.0) as u8;
        Self {
            linear,
            first: (0..COARSE).map(|i| byte(i).saturating_sub(1)).collect(),
            upper,
        }
    }

    /// The linear colour of three sRGB bytes.
    pub fn decode(&self, [r, g, b]: [u8; 3]) -> Vec3 {
        let linear = |byte: u8| self.linear[usize::from(byte)];
        Vec3::new(linear(r), linear(g), linear(b))
    }

    /// The nearest sRGB bytes of a linear colour; what is no number becomes 0.
    pub fn encode(&self, color: Vec3) -> [u8; 3] {
        color.to_array().map(|value| {
            let value = value.clamp(0.0, 1.0);
            let mut byte = usize::from(self.first[(value * (COARSE - 1) as f32) as usize]);
            while byte < 255 && value >= self.upper[byte] {
                byte += 1;
            }
            byte as u8
        })
    }
}

/// A unit vector as the colour of a normal map: (n + 1) / 2. Zero and what is no number become up.
pub fn encode_normal(normal: Vec3) -> [u8; 3] {
    encode_mean_normal(normal.try_normalize().unwrap_or(Vec3::Z))
}

/// The mean of unit vectors, the shorter the more they differ, in the same way.
pub fn encode_mean_normal(mean: Vec3) -> [u8; 3] {
    let byte = |n: f32| ((n + 1.0) * 127.5).round() as u8;
    [byte(mean.x), byte(mean.y), byte(mean.z)]
}

/// The unit vector of a colour of a normal map.
pub fn decode_normal([x, y, z]: [u8; 3]) -> Vec3 {
    let value = |byte: u8| f32::from(byte) / 127.5 - 1.0;
    let normal = Vec3::new(value(x), value(y), value(z));
    normal.try_normalize().unwrap_or(Vec3::Z)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_byte_survives_the_way_to_linear_and_back() {
        let table = SrgbTable::new();
        for byte in 0..=255 {
            assert_eq!(table.encode(table.decode([byte; 3])), [byte; 3]);
        }
    }

    #[test]
    fn the_table_finds_the_nearest_byte() {
        let table = SrgbTable::new();
        for i in 0..=10_000 {
            let value = i as f32 / 10_000.0;
            let exact = linear_to_srgb(value) * 255.0;
            let [byte, ..] = table.encode(Vec3::splat(value));
            // Half a byte, and what f32 loses in the power.
            assert!((f32::from(byte) - exact).abs() <= 0.5 + 1e-3, "{value}");
        }
        assert_eq!(
            table.encode(Vec3::new(f32::NAN, -1.0, 2.0)),
            [0, 0, 255],
            "out of range"
        );
    }

    #[test]
    fn normals_survive_to_within_a_byte() {
        // Each component is off by at most half a step of 2/255; three of them by √3 times that.
        let bound = 3f32.sqrt() / 255.0 * 1.1;
        for i in 0..500 {
            let (turn, z) = (i as f32 * 2.4, i as f32 / 250.0 - 1.0);
            let r = (1.0 - z * z).max(0.0).sqrt();
            let normal = Vec3::new(r * turn.cos(), r * turn.sin(), z).normalize();
            assert!(decode_normal(encode_normal(normal)).distance(normal) < bound);
        }
        assert_eq!(encode_normal(Vec3::ZERO), encode_normal(Vec3::Z));
    }
}
