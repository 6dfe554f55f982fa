//! Ridges that a march of too few steps misses.
//!
//! A limb with four ridges along it, as many pixels wide, in a map 64 pixels round. What a march in uniform steps
//! through the shell finds is held against the reference, which takes 4096 through the whole limb.

use glam::DVec3;

use super::limb::{Course, for_reference, limb};
use super::random::Random;
use super::shell::{march, shells, stretch};
use crate::frusta::double::cast::Ray;
use crate::frusta::double::join::JoinKind;
use crate::frusta::double::shell::Thickness;
use crate::lab::charts::{Axis, Chart, Series};
use crate::lab::reference::relief::{HeightImage, ReliefScene, ShellThickness};
use crate::lab::reference::{ReferenceJoint, ReferenceSettings};

/// Pixels of the map round the limb.
const PIXELS: usize = 64;
/// Ridges round the limb.
const RIDGES: usize = 4;
/// Widths of the ridges, in pixels.
pub const WIDTHS: [usize; 4] = [1, 2, 4, 8];
/// Numbers of steps.
pub const STEPS: [usize; 7] = [4, 8, 16, 32, 64, 128, 256];
/// Rays of each width.
const RAYS: usize = 1500;
/// A shell about as thick as a pixel is wide, like bark, and one four times as thick, like fins; in radii.
pub const THICKNESSES: [f64; 2] = [0.1, 0.4];
/// An error of the depth that counts, in thicknesses of the shell.
const WRONG: f64 = 0.01;
/// Length of the limb, in radii.
const LENGTH: f64 = 12.0;

/// A map of ridges of a width, low in between.
fn ridges(width: usize) -> HeightImage {
    HeightImage::from_fn(PIXELS, 1, |u, _| {
        let pixel = (u * PIXELS as f64) as usize % (PIXELS / RIDGES);
        if pixel < width { 0.9 } else { 0.1 }
    })
}

/// A ray across the middle of the limb, as a picture has them: at an even distance from the axis.
pub(super) fn ray(random: &mut Random, length: f64, radius: f64) -> Ray {
    let direction = loop {
        let direction = random.direction();
        if direction.x.abs() < 0.8 {
            break direction;
        }
    };
    let aside = direction.cross(DVec3::X).normalize();
    let along = random.between(0.35, 0.65) * length;
    let aim = DVec3::X * along + aside * random.between(-radius, radius);
    Ray {
        origin: aim - direction * 5.0 * length,
        direction,
    }
}

/// For each number of steps, the share of rays through the shell that end at a wrong depth, or whether they hit at all
/// is wrong.
pub fn wrong(width: usize, thickness: f64) -> Vec<(usize, f64)> {
    let image = ridges(width);
    let relief = |u: f64, v: f64| image.sample(u, v);
    let joints = limb(0.0, LENGTH, &[1.0; 2], Course::Arc);
    // The first segment of a limb runs along +x where it does not bend.
    let shell = shells(
        &joints,
        JoinKind::Mitre,
        Thickness::Metres(thickness),
        false,
    )[1];
    let reference_joints: Vec<ReferenceJoint> = for_reference(&joints);
    let reference = ReliefScene::new(
        &reference_joints,
        ReferenceSettings::default(),
        &relief,
        ShellThickness::Metres(thickness),
    );
    let mut random = Random::new(3);
    let mut counts = STEPS.map(|steps| (steps, 0));
    let mut rays = 0;
    while rays < RAYS {
        let ray = ray(&mut random, LENGTH, 1.0 + thickness);
        let Some(stretch) = stretch(&shell, &ray, 0.0) else {
            continue;
        };
        rays += 1;
        let wanted = reference.cast(ray.origin, ray.direction, 0.0);
        for (steps, count) in &mut counts {
            let found = march(&shell, &ray, stretch, *steps, &relief);
            let is_right = match (found, &wanted) {
                (Some(t), Some(hit)) => (t - hit.t).abs() <= WRONG * thickness,
                (found, wanted) => found.is_none() && wanted.is_none(),
            };
            *count += usize::from(!is_right);
        }
    }
    counts
        .map(|(steps, count)| (steps, count as f64 / RAYS as f64))
        .into()
}

/// The chart.
pub fn chart() -> Chart {
    let mut series = Vec::new();
    for thickness in THICKNESSES {
        for width in WIDTHS {
            let points = wrong(width, thickness)
                .into_iter()
                .map(|(steps, share)| (steps as f64, share));
            series.push(Series::line(
                format!("{width} px, shell {thickness}"),
                points,
            ));
        }
    }
    super::chart(
        "Rays that miss a ridge, by its width and the shell's thickness in radii",
        Axis::log("uniform steps"),
        Axis::log("share of wrong rays (1e-4 stands for none)").with_floor(1e-4),
        series,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_steps_and_wider_ridges_are_missed_less() {
        let shares = WIDTHS.map(|width| wrong(width, THICKNESSES[1]));
        // Two shares of the same rays that are p in truth differ by chance by up to four deviations of √(p/n).
        let chance = |p: f64| 4.0 * (p.max(1.0 / RAYS as f64) / RAYS as f64).sqrt();
        for rows in &shares {
            for pair in rows.windows(2) {
                assert!(pair[1].1 <= pair[0].1 + chance(pair[0].1), "{rows:?}");
            }
            assert!(rows[6].1 < 0.5 * rows[0].1, "{rows:?}");
        }
        let few = |i: usize| shares[i][0].1;
        assert!(few(0) > few(3), "{} {}", few(0), few(3));
    }
}
