//! Directions as two numbers, for compressed slices: the octahedron unfolded to a square (Cigolle et al., *A Survey of
//! Efficient Representations for Independent Unit Vectors*, JCGT 3(2), 2014).
//!
//! A block of BC3 has but a line through the colours of its pixels, onto which normals of three channels would fall, and one
//! channel of its own. Of two numbers each has nearly one for itself.

use bevy::math::{Vec2, Vec3};

/// A direction on the square from −1 to 1: its upper half in the middle, the lower folded out. Any length but nothing.
fn fold(n: Vec3) -> Vec2 {
    let n = n / (n.x.abs() + n.y.abs() + n.z.abs());
    let folded = Vec2::new(n.x, n.z);
    if n.y < 0.0 {
        (1.0 - Vec2::new(n.z, n.x).abs()) * Vec2::ONE.copysign(folded)
    } else {
        folded
    }
}

/// A pixel of a slice's normals, and of the light from around in alpha, as compressed slices have it: the light in red, the
/// normal in alpha and green, of which alpha is the finer.
pub(crate) fn folded_pixel([x, y, z, light]: [u8; 4]) -> [u8; 4] {
    let signed = [x, y, z].map(|byte| f32::from(byte) / 127.5 - 1.0);
    // No byte is 0, so that no normal is nothing.
    let folded = fold(Vec3::from_array(signed));
    let [u, v] = (127.5 * folded + 127.5).round().to_array();
    [light, v as u8, 0, u as u8]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plants::Dice;

    /// As `unfold` in `look.wgsl`.
    fn unfold(folded: Vec2) -> Vec3 {
        let y = 1.0 - folded.x.abs() - folded.y.abs();
        let sides = Vec2::ONE.copysign(folded);
        let over = folded - (-y).max(0.0) * sides;
        Vec3::new(over.x, y, over.y)
    }

    #[test]
    fn directions_come_back() {
        let mut dice = Dice::new(7);
        for _ in 0..1000 {
            let n = Vec3::from_array([(); 3].map(|()| 2.0 * dice.roll() - 1.0));
            let (n, back) = (n.normalize(), unfold(fold(n)).normalize());
            assert!(n.distance(back) < 1e-5, "{n} {back}");
        }
    }

    #[test]
    fn pixels_keep_their_normal_and_their_light() {
        let mut dice = Dice::new(8);
        for _ in 0..1000 {
            let pixel = [(); 4].map(|()| (256.0 * dice.roll()) as u8);
            let [x, y, z, light] = pixel;
            let [l, v, _, u] = folded_pixel(pixel);
            assert_eq!(l, light);
            let n = Vec3::from_array([x, y, z].map(|b| f32::from(b) / 127.5 - 1.0)).normalize();
            let square = Vec2::new(f32::from(u), f32::from(v)) / 127.5 - 1.0;
            // Half a step of 8 bits along both sides, √3 of it on the ball, where the square is stretched most.
            let most = (2.0f32).sqrt() / 255.0 * 3.0;
            assert!(n.distance(unfold(square).normalize()) <= most, "{pixel:?}");
        }
    }
}
