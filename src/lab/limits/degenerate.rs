//! Depth in 32 bits against 64 where the quadratic degenerates: cones that are nearly cylinders, rays along the surface
//! and rays through an apex.
//!
//! How near a case is to the degenerate one is its closeness: the cone's slope, the angle between the ray and the
//! surface (its first coefficient a then goes with it), or the distance between the ray and the apex.

use glam::{DVec3, Vec3};

use super::precision::cast_both;
use super::random::{Random, quantile};
use crate::frusta::single::cone::{Cone, End, EndKind, Frustum};
use crate::lab::charts::{Axis, Chart, Series};

/// Rays of each case.
const RAYS: usize = 10_000;
/// Distance of the eye in lengths of the segment.
const DISTANCE: f64 = 10.0;
/// Radius of the segment of length 1, at its base.
const RADIUS: f32 = 0.2;

/// A way in which the quadratic degenerates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Case {
    /// The slope goes to zero: closeness is the slope.
    Cylinder,
    /// The ray goes along a line of a tapering cone's surface: closeness is the angle to it, in radians.
    AlongCone,
    /// The same for a cylinder, where the ray goes along the axis too.
    AlongCylinder,
    /// The ray goes through the apex: closeness is its distance from it, in lengths of the segment.
    Apex,
}

/// What a closeness costs.
#[derive(Clone, Debug, PartialEq)]
pub struct Depth {
    /// Error of the depth that 99 of 100 rays do not exceed, in lengths of the segment.
    pub error: f64,
    /// The same of 64 bits, if each number of the ray is off by half a unit of its 32 bits: what no arithmetic can
    /// better.
    pub at_best: f64,
    /// Rays that hit in one precision and miss in the other, as a share of those that hit in 64 bits.
    pub lost: f64,
}

/// A frustum along a slanted axis, open at its base and closed at its tip by a sphere of no radius, which only a ray
/// through its very centre could meet.
fn frustum(radius: f32, slope: f32) -> Frustum {
    let axis = Vec3::new(2.0, 3.0, -6.0) / 7.0;
    let cone = Cone::through(axis, radius, slope);
    let end = |kind| End {
        normal: axis,
        kind,
        ..End::default()
    };
    Frustum {
        axis,
        length: 1.0,
        radius: cone.radius,
        slope: cone.slope,
        secant: cone.secant,
        start: end(EndKind::Cut),
        end: end(EndKind::Round),
        reference: axis.any_orthonormal_vector(),
        ..Frustum::default()
    }
}

/// A ray of a case: a point that it goes through, and its direction.
fn ray(case: Case, closeness: f64, cone: &Frustum, random: &mut Random) -> (DVec3, DVec3) {
    let axis = cone.axis.as_dvec3().normalize();
    let (radius, slope) = (f64::from(cone.radius), f64::from(cone.slope));
    let across = random.across(axis);
    let y = random.between(0.2, 0.8);
    let on_surface = axis * y + across * (radius + slope * y);
    match case {
        Case::Cylinder => (on_surface, random.direction()),
        Case::AlongCone | Case::AlongCylinder => {
            let along = (axis + across * slope).normalize();
            let tilt = random.across(along);
            let (sin, cos) = closeness.sin_cos();
            (on_surface, along * cos + tilt * sin)
        }
        Case::Apex => {
            let direction = random.direction();
            (axis + random.across(direction) * closeness, direction)
        }
    }
}

/// The next number of 32 bits above or below.
fn nudged(vector: Vec3, random: &mut Random) -> DVec3 {
    let mut nudge =
        |value: f32| f64::from(value) * (1.0 + random.between(-0.5, 0.5) * f64::from(f32::EPSILON));
    DVec3::new(nudge(vector.x), nudge(vector.y), nudge(vector.z))
}

/// Rays of a case at a closeness.
pub fn measure(case: Case, closeness: f64) -> Depth {
    let cone = match case {
        Case::Cylinder => frustum(RADIUS, closeness as f32),
        Case::AlongCone => frustum(RADIUS, -0.1),
        Case::AlongCylinder => frustum(RADIUS, 0.0),
        // The apex is the tip: radius 0 at y = 1.
        Case::Apex => frustum(RADIUS, -RADIUS),
    };
    let mut random = Random::new(2);
    let (mut errors, mut at_best) = (Vec::new(), Vec::new());
    let (mut hits, mut lost) = (0, 0);
    for _ in 0..RAYS {
        let (through, direction) = ray(case, closeness, &cone, &mut random);
        let origin = (through - direction * DISTANCE).as_vec3();
        let direction = direction.as_vec3();
        let (single, double) = cast_both(origin, direction, &cone);
        lost += usize::from(single.is_some() != double.is_some());
        let Some(exact) = double else { continue };
        hits += 1;
        errors.extend(single.map(|t| (t - exact).abs()));
        let (origin, direction) = (nudged(origin, &mut random), nudged(direction, &mut random));
        let double = crate::frusta::double::cast::cast_ray(
            &crate::frusta::double::cast::Ray { origin, direction },
            &super::precision::widened(&cone),
            0.0,
            0.0,
        );
        at_best.extend(double.map(|hit| (hit.t - exact).abs()));
    }
    Depth {
        error: quantile(&mut errors, 0.99),
        at_best: quantile(&mut at_best, 0.99),
        lost: lost as f64 / f64::from(hits.max(1)),
    }
}

/// Closeness from 1 to 10⁻⁸, twice a decade.
fn closenesses() -> impl Iterator<Item = f64> {
    (0..=16).map(|i| 10f64.powf(-0.5 * f64::from(i)))
}

/// The chart.
pub fn chart() -> Chart {
    let cases = [
        ("slope of the cone", Case::Cylinder),
        ("ray's angle to a cone", Case::AlongCone),
        ("ray's angle to a cylinder", Case::AlongCylinder),
        ("ray's distance from the apex", Case::Apex),
    ];
    let mut series = Vec::new();
    for (name, case) in cases {
        let rows: Vec<_> = closenesses().map(|x| (x, measure(case, x))).collect();
        let points = |value: fn(&Depth) -> f64| rows.iter().map(move |(x, row)| (*x, value(row)));
        series.push(Series::line(name, points(|row| row.error)));
        if matches!(case, Case::AlongCone | Case::Apex) {
            let name = format!("{name}, at best");
            series.push(Series::line(name, points(|row| row.at_best)));
        }
    }
    super::chart(
        "Depth error of 32 bits near what degenerates, 99 of 100 rays, from 10 lengths away",
        Axis::log("closeness (slope, radians, or lengths of the segment)"),
        Axis::log("depth error (lengths of the segment)"),
        series,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cylinders_are_no_special_case() {
        let plain = measure(Case::Cylinder, 0.1);
        for closeness in [1e-3, 1e-5, 1e-7, 0.0] {
            let near = measure(Case::Cylinder, closeness);
            assert!(
                near.error < 2.0 * plain.error,
                "{closeness} {near:?} {plain:?}"
            );
        }
    }

    #[test]
    fn along_the_surface_the_error_is_that_of_the_rays_own_numbers() {
        // A quadratic found as it should be errs by a few times what rounding its input does.
        for case in [Case::AlongCone, Case::AlongCylinder, Case::Apex] {
            for closeness in [1e-1, 1e-2, 1e-3, 1e-4] {
                let depth = measure(case, closeness);
                assert!(
                    depth.error < 10.0 * depth.at_best,
                    "{case:?} {closeness} {depth:?}"
                );
            }
        }
    }
}
