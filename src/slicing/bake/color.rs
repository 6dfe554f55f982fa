//! sRGB of 8 bits and back (IEC 61966-2-1).

use std::sync::LazyLock;

static DECODED: LazyLock<[f32; 256]> = LazyLock::new(|| {
    core::array::from_fn(|byte| {
        let x = byte as f32 / 255.0;
        if x <= 0.04045 {
            x / 12.92
        } else {
            ((x + 0.055) / 1.055).powf(2.4)
        }
    })
});

/// An sRGB byte as linear light.
pub(crate) fn decode(byte: u8) -> f32 {
    DECODED[usize::from(byte)]
}

/// The sRGB byte whose light is nearest in the encoding. Found by bisection in the table of [`decode`], so that it is
/// the same on every machine.
pub(crate) fn encode(light: f32) -> u8 {
    let above = DECODED.partition_point(|known| *known < light);
    let Some(below) = above.checked_sub(1) else {
        return 0;
    };
    if above > 255 {
        return 255;
    }
    let nearer = light - DECODED[below] <= DECODED[above] - light;
    if nearer { below as u8 } else { above as u8 }
}

/// A number in 0..=1 as a byte.
pub(crate) fn unorm(x: f32) -> u8 {
    (x.clamp(0.0, 1.0) * 255.0 + 0.5) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_byte_survives_decoding_and_encoding() {
        for byte in 0..=255 {
            assert_eq!(encode(decode(byte)), byte);
        }
        assert_eq!((encode(-1.0), encode(2.0), encode(f32::NAN)), (0, 255, 0));
    }
}
