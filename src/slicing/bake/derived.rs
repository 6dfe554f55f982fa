//! Settings that follow from how near a crown is seen, and how exact it has to be there.

use core::f32::consts::PI;
use core::ops::RangeInclusive;

use super::settings::BakeSettings;
use crate::slicing::blend::FOCAL;
use crate::slicing::limits::{MAX_LAYERS, MAX_PIXELS, MAX_PIXELS_TOTAL};
use crate::slicing::orientation::Orientations;

/// Distance, in radii, and error, in pixels, that stand in for what is no number above 0.
const USUAL: (f64, f32) = (10.0, 4.0);
/// Distances that are told apart, in radii: nearer eyes are within the crown, and from afar it is a pixel.
const DISTANCES: (f64, f64) = (1.0, 1e4);
/// Errors that are told apart, in pixels.
const ERRORS: (f32, f32) = (0.01, 100.0);
/// Orientations and slices to choose from.
const ORIENTATIONS: RangeInclusive<u32> = 3..=24;
const SLICES: RangeInclusive<u32> = 1..=15;
/// Fewest pixels along a slice's side.
const FEWEST_PIXELS: u32 = 64;

impl BakeSettings {
    /// Settings for a crown of `radius` metres whose centroid is seen from no nearer than `distance` metres, so that nothing
    /// of it is displaced by more than `error` pixels on a screen of 480 lines of 52°
    /// ([`FOCAL`](crate::slicing::blend::FOCAL)).
    ///
    /// Of n slices over a depth of 2 r, a primitive is moved to the nearest one by at most r/n (§2.2). Eyes as high as the
    /// crown see one of k orientations from at most θ = π/k aside, half of the way to the next; so what is moved is
    /// displaced on screen by at most (r/n) sin θ `FOCAL` / d. Of 3 to 24 orientations and 1 to 15 slices, those of the
    /// least product are taken that keep this under `error`, of equal products those of fewer slices. Where they would be
    /// more than [`MAX_LAYERS`](crate::slicing::MAX_LAYERS) slices in all, which is so where `error` × `distance` / `radius`
    /// is below 8.6, the finest that are allowed are taken, and the bound does not hold.
    ///
    /// Coarser levels of 3 and of 1 slices take over where the same holds of them. Slices have as many pixels a side as the
    /// crown takes on screen, over `error` where that is more than one, up to the next power of two: 64, or more as far as
    /// is allowed. All other settings are the defaults.
    ///
    /// A radius or a distance that is no finite number above 0 makes the distance 10 radii; such an error is taken for 4
    /// pixels. Distances are brought into 1 to 10,000 radii and errors into 0.01 to 100 pixels. So what comes out can always
    /// be baked with.
    pub fn for_view(radius: f32, distance: f32, error: f32) -> Self {
        let is_usable = |x: f32| x.is_finite() && x > 0.0;
        let radii = if is_usable(radius) && is_usable(distance) {
            f64::from(distance) / f64::from(radius)
        } else {
            USUAL.0
        };
        let radii = radii.clamp(DISTANCES.0, DISTANCES.1) as f32;
        let error = if is_usable(error) { error } else { USUAL.1 };
        let error = error.clamp(ERRORS.0, ERRORS.1);

        let (orientations, slices) = fewest(FOCAL / (radii * error));
        let levels = levels(slices);
        let switch = |slices: &u32| FOCAL / (error * fineness(orientations, *slices));
        Self {
            orientations: Orientations::Circle(orientations),
            switches: levels[1..].iter().map(switch).collect(),
            pixels: pixels(
                2.0 * FOCAL / radii / error.max(1.0),
                layers(orientations, slices),
            ),
            levels,
            vertical: true,
            ..Self::default()
        }
    }
}

/// How fine slicings are: radii over the furthest that something is displaced across the eye's direction, n / sin(π/k). Of n
/// slices something is moved by 1/n of the radius, and seen from at most π/k aside.
fn fineness(orientations: u32, slices: u32) -> f32 {
    slices as f32 / (PI / orientations as f32).sin()
}

/// Slices in each level of detail, of so many in the finest.
fn levels(slices: u32) -> Vec<u32> {
    let coarser = [3, 1].into_iter().filter(|coarser| *coarser < slices);
    core::iter::once(slices).chain(coarser).collect()
}

/// Slices of all levels and orientations, the vertical one among them.
fn layers(orientations: u32, slices: u32) -> u32 {
    (orientations + 1) * levels(slices).iter().sum::<u32>()
}

/// So many orientations and slices, of the least product, as are as fine as is asked for, or else as fine as is allowed.
fn fewest(fine: f32) -> (u32, u32) {
    // Fewer slices come first, and so are taken of equal products.
    let all = SLICES.flat_map(|n| ORIENTATIONS.map(move |k| (k, n)));
    let allowed: Vec<_> = all
        .filter(|(k, n)| layers(*k, *n) as usize <= MAX_LAYERS)
        .collect();
    let finest = allowed
        .iter()
        .map(|(k, n)| fineness(*k, *n))
        .fold(0.0, f32::max);
    allowed
        .into_iter()
        .filter(|(k, n)| fineness(*k, *n) >= fine.min(finest))
        .min_by_key(|(k, n)| k * n)
        .expect("the finest is as fine as itself")
}

/// The power of two from so many pixels on, of so many slices.
fn pixels(wanted: f32, layers: u32) -> u32 {
    let wanted = wanted.clamp(FEWEST_PIXELS as f32, MAX_PIXELS as f32);
    let mut pixels = (wanted.ceil() as u32).next_power_of_two();
    while u64::from(layers) * u64::from(pixels).pow(2) > MAX_PIXELS_TOTAL {
        pixels /= 2;
    }
    pixels
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// How far something is displaced at most, in pixels, so many radii away, by what the baker makes of the settings.
    fn displaced(settings: &BakeSettings, slices: u32, radii: f32) -> f32 {
        let directions = settings.orientations.directions();
        // The sine of half the angle between two unit vectors is half their distance.
        let sine = 0.5 * directions[0].distance(directions[1]);
        sine / slices as f32 * FOCAL / radii
    }

    /// Roundings of 2⁻²⁴, a dozen on either side.
    const ROUNDED: f32 = 1.0 + 1e-5;

    #[test]
    fn what_is_displaced_stays_under_the_error_from_the_distance_on_and_in_every_level() {
        for radii in [2.0, 5.0, 10.0, 25.0, 100.0, 1000.0] {
            for error in [0.25, 0.5, 1.0, 2.0, 4.0, 10.0] {
                let settings = BakeSettings::for_view(3.0, 3.0 * radii, error);
                let most = error * ROUNDED;
                let [finest, coarser @ ..] = settings.levels.as_slice() else {
                    panic!("{settings:?}")
                };
                // The finest settings are 58.5 times as fine as one slice seen from the side.
                let is_within_reach = radii * error >= FOCAL / 58.5;
                assert!(!is_within_reach || displaced(&settings, *finest, radii) <= most);
                for (slices, switch) in coarser.iter().zip(&settings.switches) {
                    assert!(displaced(&settings, *slices, *switch) <= most);
                    assert!(*switch >= radii || !is_within_reach, "{settings:?}");
                }
                let across = 2.0 * FOCAL / radii / error.max(1.0);
                assert!(settings.pixels as f32 >= across.clamp(64.0, 512.0));
            }
        }
    }

    #[test]
    fn fewer_slices_are_taken_of_equal_products() {
        // 500/50 = 10 pixels of a radius: 6 orientations of 5 slices would do, and 3 of 9 too.
        let settings = BakeSettings::for_view(1.0, 50.0, 1.0);
        assert_eq!(settings.orientations, Orientations::Circle(3));
        assert_eq!(settings.levels, [9, 3, 1]);
        // 500/1000 of a pixel: anything will do.
        let far = BakeSettings::for_view(1.0, 1000.0, 1.0);
        assert_eq!(
            (far.levels, far.switches, far.pixels),
            (vec![1], vec![], 64)
        );
        assert_eq!(far.orientations, Orientations::Circle(3));
    }

    #[test]
    fn numbers_that_are_none_are_taken_for_the_usual() {
        let usual = BakeSettings::for_view(1.0, 10.0, 4.0);
        for bad in [f32::NAN, f32::INFINITY, 0.0, -1.0] {
            assert_eq!(BakeSettings::for_view(bad, 10.0, 4.0), usual);
            assert_eq!(BakeSettings::for_view(1.0, bad, 4.0), usual);
            assert_eq!(BakeSettings::for_view(1.0, 10.0, bad), usual);
        }
    }

    proptest! {
        #[test]
        fn whatever_is_asked_for_can_be_baked(
            radius in prop::num::f32::ANY,
            distance in prop::num::f32::ANY,
            error in prop::num::f32::ANY,
        ) {
            let settings = BakeSettings::for_view(radius, distance, error);
            prop_assert!(settings.check().is_ok(), "{settings:?}");
        }

        #[test]
        fn a_nearer_eye_and_a_smaller_error_never_give_coarser_settings(
            far in 0.5_f32..2000.0,
            nearer in 0.1_f32..=1.0,
            large in 0.05_f32..20.0,
            smaller in 0.1_f32..=1.0,
        ) {
            let coarse = BakeSettings::for_view(1.0, far, large);
            let finer = BakeSettings::for_view(1.0, far * nearer, large * smaller);
            let pictures = |settings: &BakeSettings| {
                settings.orientations.directions().len() as u32 * settings.levels[0]
            };
            prop_assert!(pictures(&finer) >= pictures(&coarse), "{finer:?} {coarse:?}");
            prop_assert!(finer.pixels >= coarse.pixels, "{finer:?} {coarse:?}");
            let [of_finer, of_coarse] = [&finer, &coarse]
                .map(|settings| displaced(settings, settings.levels[0], 1.0));
            prop_assert!(of_finer <= of_coarse * ROUNDED, "{finer:?} {coarse:?}");
        }
    }
}
