//! Height vectors that are combed (§5: the second kind of animation).

use bevy::math::Vec3;

/// How far what is combed stays above the surface: the sine of the least angle to it, 11.5°.
const LEAST_RISE: f32 = 0.2;

/// A height vector that is laid down towards `lean`, and keeps its length: by a share of the way to where it nearly lies on
/// a surface of this unit `normal`. A share below 0 or above 1 is taken for the nearest, and no number for 0.
///
/// It comes no nearer to the surface than 11.5°, or than it was. One that leads through the surface or is no number stays as
/// it is, and so does any where `lean` is straight up or down, zero or no number.
pub fn comb(height: Vec3, normal: Vec3, lean: Vec3, share: f32) -> Vec3 {
    let along = (lean - normal * lean.dot(normal)).try_normalize();
    let (Some(upright), Some(along)) = (height.try_normalize(), along) else {
        return height;
    };
    let is_turned = upright.dot(normal) > 0.0 && share > 0.0;
    if !is_turned {
        return height;
    }
    let down = normal * LEAST_RISE + along * (1.0 - LEAST_RISE * LEAST_RISE).sqrt();
    // Over the top if it leans to the other side.
    let turned = upright.slerp(down, share.min(1.0));
    turned.normalize() * height.length()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn vector() -> impl Strategy<Value = Vec3> {
        prop::array::uniform3(-1.0..1.0f32).prop_map(Vec3::from)
    }

    #[test]
    fn what_is_combed_all_the_way_nearly_lies_down() {
        let expected = Vec3::new(0.96f32.sqrt(), 0.2, 0.0) * 3.0;
        for height in [Vec3::Y, Vec3::new(-0.9, 0.3, 0.0), Vec3::new(0.1, 0.9, 0.5)] {
            let height = height.normalize() * 3.0;
            // Up and down is no direction to lean to.
            let lean = Vec3::new(0.5, 7.0, 0.0);
            let combed = comb(height, Vec3::Y, lean, 2.0);
            assert!(combed.distance(expected) < 1e-3, "{height} {combed}");
            let half = comb(height, Vec3::Y, lean, 0.5);
            let angles = [half.angle_between(height), half.angle_between(expected)];
            assert!((angles[0] - angles[1]).abs() < 1e-2, "{angles:?}");
        }
    }

    #[test]
    fn what_cannot_be_combed_stays_as_it_is() {
        let (up, x) = (Vec3::Y, Vec3::X);
        for (height, normal, lean, share) in [
            (up, up, x, 0.0),
            (up, up, x, f32::NAN),
            (up, up, Vec3::ZERO, 1.0),
            (up, up, Vec3::NAN, 1.0),
            (up, up, up, 1.0),
            (up, Vec3::ZERO, x, 1.0),
            (-up, up, x, 1.0),
            (Vec3::ZERO, up, x, 1.0),
            (Vec3::INFINITY, up, x, 1.0),
        ] {
            assert_eq!(comb(height, normal, lean, share), height);
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(500) })]

        #[test]
        fn what_is_combed_keeps_its_length_and_stays_above_the_surface(
            height in vector(),
            normal in vector(),
            lean in vector(),
            share in -0.5..1.5f32,
        ) {
            let normal = normal.try_normalize().unwrap_or(Vec3::Y);
            prop_assume!(height.length() > 1e-3);
            let combed = comb(height, normal, lean, share);
            prop_assert_eq!(combed, comb(height, normal, lean, share));
            prop_assert!(combed.is_finite());
            prop_assert!((combed.length() / height.length() - 1.0).abs() < 1e-5);
            let rise = |height: Vec3| height.normalize().dot(normal);
            prop_assert!(rise(combed) > rise(height).min(LEAST_RISE) - 1e-3);
        }
    }
}
