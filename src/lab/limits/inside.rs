//! An eye inside the shell, above the relief.
//!
//! A march that takes the first hit of the outer frustum for its beginning starts, from there, where the ray leaves the
//! shell. It has to begin at the eye. Both are held against the reference's ray from outside, of which only what lies
//! beyond the eye counts.

use core::f64::consts::TAU;

use glam::DVec3;

use super::limb::{Course, for_reference, limb};
use super::random::Random;
use super::shell::{Stretch, end, march, shells, stretch};
use crate::frusta::double::cast::Ray;
use crate::frusta::double::join::JoinKind;
use crate::frusta::double::shell::Thickness;
use crate::lab::charts::{Axis, Chart, Series};
use crate::lab::reference::ReferenceSettings;
use crate::lab::reference::relief::{ReliefScene, ShellThickness};

/// Rays at each height of the eye.
const RAYS: usize = 1500;
/// Steps of the march: enough that ridges as wide as these are not missed.
const STEPS: usize = 256;
/// Thickness of the shell, in radii.
const THICKNESS: f64 = 0.3;
/// Length of the limb, in radii.
const LENGTH: f64 = 12.0;
/// An error of the depth that counts, in thicknesses of the shell.
const WRONG: f64 = 0.01;
/// How far from the outer frustum an eye still counts as on it, in thicknesses of the shell.
const ROUNDING: f64 = 1e-9;

/// Shares of rays that are right.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inside {
    /// The march begins at the eye where that is in the shell.
    pub from_eye: f64,
    /// The march begins at the first hit of the outer frustum.
    pub from_outside: f64,
}

/// Knobs that fill the lower four fifths of the shell.
fn relief(u: f64, v: f64) -> f64 {
    0.4 + 0.4 * (8.0 * TAU * u).sin() * (TAU * v * LENGTH).sin()
}

/// Rays in all directions from eyes of a height w in the shell (above 1: outside it).
pub fn measure(height: f64) -> Inside {
    let joints = limb(0.0, LENGTH, &[1.0; 2], Course::Arc);
    let shell = shells(
        &joints,
        JoinKind::Mitre,
        Thickness::Metres(THICKNESS),
        false,
    )[1];
    // The reference's map repeats once a radius of length, this shell's v runs from 0 to 1.
    let repeated = |u: f64, v: f64| relief(u, v / LENGTH);
    let reference = ReliefScene::new(
        &for_reference(&joints),
        ReferenceSettings::default(),
        &repeated,
        ShellThickness::Metres(THICKNESS),
    );
    let mut random = Random::new(6);
    let (mut rays, mut from_eye, mut from_outside) = (0, 0, 0);
    while rays < RAYS {
        let across = random.across(DVec3::X);
        let eye =
            DVec3::X * random.between(0.4, 0.6) * LENGTH + across * (1.0 + height * THICKNESS);
        let direction = random.direction();
        let (u, v, w) = shell.coordinates(eye, 0.0);
        // Eyes in the relief see nothing that is right; rays along the limb leave it at its ends.
        if w <= relief(u, v) || direction.x.abs() > 0.8 {
            continue;
        }
        rays += 1;
        let ray = Ray {
            origin: eye,
            direction,
        };
        let back = 4.0;
        let wanted = reference
            .cast(eye - direction * back, direction, back)
            .map(|hit| hit.t - back);
        let is_right = |stretch: Option<Stretch>| {
            let found = stretch.and_then(|stretch| march(&shell, &ray, stretch, STEPS, &relief));
            match (found, wanted) {
                (Some(t), Some(wanted)) => (t - wanted).abs() <= WRONG * THICKNESS,
                (found, wanted) => found.is_none() && wanted.is_none(),
            }
        };
        let outside = stretch(&shell, &ray, 0.0);
        let at_eye = Stretch {
            from: 0.0,
            to: end(&shell, &ray, 0.0),
        };
        // An eye on the outer frustum, as far as roundings can tell, is in the shell too.
        let is_inside = w < 1.0 + ROUNDING && at_eye.to.is_finite();
        let inside = if is_inside { Some(at_eye) } else { outside };
        from_eye += usize::from(is_right(inside));
        from_outside += usize::from(is_right(outside));
    }
    let share = |count: usize| count as f64 / RAYS as f64;
    Inside {
        from_eye: share(from_eye),
        from_outside: share(from_outside),
    }
}

/// The chart.
pub fn chart() -> Chart {
    let rows: Vec<_> = (1..=12)
        .map(|i| 0.1 * f64::from(i))
        .map(|height| (height, measure(height)))
        .collect();
    let points = |value: fn(&Inside) -> f64| rows.iter().map(move |(x, row)| (*x, value(row)));
    super::chart(
        "Rays that are right from an eye in the shell",
        Axis::linear("height w of the eye (1: the outer frustum)"),
        Axis::linear("share of rays"),
        vec![
            Series::line("march begins at the eye", points(|row| row.from_eye)),
            Series::line(
                "march begins at the outer frustum",
                points(|row| row.from_outside),
            ),
        ],
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_march_that_begins_at_the_eye_is_right_and_one_from_the_outer_frustum_is_not() {
        for height in [0.3, 0.6, 0.9, 1.0] {
            let found = measure(height);
            // What is left are rays along a flank, where a step may leap over a ridge.
            assert!(found.from_eye > 0.99, "{height} {found:?}");
            assert!(found.from_outside < 0.9, "{height} {found:?}");
        }
        let outside = measure(1.1);
        assert!(
            outside.from_eye > 0.99 && outside.from_eye == outside.from_outside,
            "{outside:?}"
        );
    }
}
