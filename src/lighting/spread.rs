//! Light on many normals at once: what `spread.wgsl` runs on the GPU, by the same names.

/// The mean of (1 - `transmission`) max(n·l, 0) + `transmission` max(-n·l, 0) over unit normals n, for a light from l: as
/// [`PlantLighting::Simple`](super::PlantLighting::Simple) lights a pixel in which normals differ.
///
/// `cosine`, from -1 to 1, is n·l of the normals' mean, which is the shorter the more they differ, and `spread` is one less
/// the square of that mean's length: 0 of a single normal, 1 where they point everywhere. The mean of |n·l| is taken for
/// √(cosine² + spread/4), which is right for a single normal and for normals in all directions. `transmission`, from 0 to 1,
/// is the share of the light that comes through from behind: 0 of what is solid, 0.5 of a leaf that looks alike from both
/// sides.
pub fn mean_cosine(cosine: f32, spread: f32, transmission: f32) -> f32 {
    0.5 * ((1.0 - 2.0 * transmission) * cosine + (cosine * cosine + 0.25 * spread).sqrt())
}

#[cfg(test)]
mod tests {
    use core::f32::consts::{FRAC_PI_2, PI, TAU};

    use super::mean_cosine;

    #[test]
    fn one_normal_is_lit_by_its_cosine() {
        for i in -10..=10 {
            let cosine = i as f32 / 10.0;
            assert!((mean_cosine(cosine, 0.0, 0.0) - cosine.max(0.0)).abs() < 1e-6);
        }
    }

    #[test]
    fn light_comes_through_from_behind() {
        for i in -10..=10 {
            let cosine = i as f32 / 10.0;
            for spread in [0.0, 0.5, 1.0] {
                let front = mean_cosine(cosine, spread, 0.0);
                let behind = mean_cosine(-cosine, spread, 0.0);
                for transmission in [0.25, 0.5, 1.0] {
                    let both = (1.0 - transmission) * front + transmission * behind;
                    assert!((mean_cosine(cosine, spread, transmission) - both).abs() < 1e-6);
                }
            }
        }
    }

    #[test]
    fn many_normals_are_lit_as_each_of_them_in_the_mean() {
        // Normals spread evenly over caps, up to a whole sphere.
        for half_angle in [0.2, 0.8, FRAC_PI_2, 2.2, PI] {
            let least = f32::cos(half_angle);
            let mean = 0.5 * (1.0 + least);
            for tilt in 0..=12 {
                let (sin, cos) = (tilt as f32 / 12.0 * PI).sin_cos();
                let (mut sum, mut plain) = (0.0, 0.0);
                const STEPS: u32 = 100;
                for i in 0..STEPS * STEPS {
                    // Areas on a sphere go by heights.
                    let z = least + (1.0 - least) * ((i % STEPS) as f32 + 0.5) / STEPS as f32;
                    let turn = ((i / STEPS) as f32 + 0.5) / STEPS as f32 * TAU;
                    let to_light = z * cos + (1.0 - z * z).sqrt() * turn.cos() * sin;
                    sum += to_light.max(0.0);
                    plain += to_light;
                }
                let exact = sum / (STEPS * STEPS) as f32;
                let found = mean_cosine(mean * cos, 1.0 - mean * mean, 0.0);
                // The mean of |n·l| is at most that far from the root for a half sphere, seen from its top: (√0.4375 −
                // 0.5)/2.
                assert!(
                    (found - exact).abs() < 0.085,
                    "{half_angle} {tilt}: {found} {exact}"
                );
                assert!((plain / (STEPS * STEPS) as f32 - mean * cos).abs() < 0.01);
            }
        }
    }
}
