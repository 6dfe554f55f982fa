//! Depth in 32 bits against 64, however far away the eye is.
//!
//! Both precisions get the same frustum and the same rays, whose numbers are those of 32 bits, so that they differ by
//! their arithmetic alone. Beside the crate's way of finding the roots stands the quadratic with its origin in the eye,
//! as Equation 10 has it, in 32 bits.

use glam::Vec3;

use super::limb::{Course, limb, links};
use super::random::{Random, quantile};
use crate::frusta::double::cast as double_cast;
use crate::frusta::double::cone as double_cone;
use crate::frusta::single::cast as single_cast;
use crate::frusta::single::cone as single_cone;
use crate::frusta::single::join as single_join;
use crate::lab::charts::{Axis, Chart, Series};

/// Rays at each distance.
const RAYS: usize = 20_000;
/// Radius at the start of the segment of length 1 that is looked at, and at its end.
const RADII: [f64; 2] = [0.2, 0.15];

/// What a distance costs.
#[derive(Clone, Debug, PartialEq)]
pub struct Precision {
    /// Distance from the eye to the segment, in lengths of the segment.
    pub distance: f64,
    /// Error of the depth, in shares of it: half of the rays have no more.
    pub median: f64,
    /// 99 of 100 rays have no more.
    pub most: f64,
    /// Rays that hit in one precision and miss in the other, as a share of those that hit.
    pub lost: f64,
    /// The same of the plain quadratic.
    pub plain_median: f64,
    /// The same of the plain quadratic.
    pub plain_most: f64,
    /// Rays that hit and for which the plain quadratic has no root, as a share.
    pub plain_lost: f64,
}

/// The middle one of three segments, tapering, between two mitres.
fn middle_segment() -> single_cone::Frustum {
    let [from, to] = RADII;
    let joints = limb(30.0, 1.0, &[from + 0.05, from, to, to - 0.05], Course::Arc);
    let joints: Vec<_> = joints
        .iter()
        .map(|joint| single_join::PosedJoint {
            position: joint.position.as_vec3(),
            radius: joint.radius as f32,
        })
        .collect();
    let links: Vec<_> = links(joints.len())
        .iter()
        .map(|link| single_join::Link {
            parent: link.parent,
            next: link.next,
            continues: link.continues,
            branches: link.branches,
            twist: 0.0,
        })
        .collect();
    let skin = single_join::Skin {
        join: single_join::JoinKind::Mitre,
        ends: single_cone::EndKind::Round,
    };
    let mut frusta = vec![single_cone::Frustum::default(); joints.len()];
    single_join::skin(&links, &joints, skin, &mut frusta);
    frusta[2]
}

/// The same numbers in 64 bits.
pub(super) fn widened(frustum: &single_cone::Frustum) -> double_cone::Frustum {
    let end = |end: &single_cone::End| double_cone::End {
        normal: end.normal.as_dvec3(),
        offset: f64::from(end.offset),
        radius: f64::from(end.radius),
        reach: f64::from(end.reach),
        kind: match end.kind {
            single_cone::EndKind::Cut => double_cone::EndKind::Cut,
            single_cone::EndKind::Round => double_cone::EndKind::Round,
            single_cone::EndKind::Flat => double_cone::EndKind::Flat,
        },
    };
    double_cone::Frustum {
        base: frustum.base.as_dvec3(),
        axis: frustum.axis.as_dvec3(),
        length: f64::from(frustum.length),
        radius: f64::from(frustum.radius),
        slope: f64::from(frustum.slope),
        secant: f64::from(frustum.secant),
        start: end(&frustum.start),
        end: end(&frustum.end),
        reference: frustum.reference.as_dvec3(),
    }
}

/// Where both precisions meet a frustum, along a ray of 32 bits: distances in lengths of its direction.
pub(super) fn cast_both(
    origin: Vec3,
    direction: Vec3,
    frustum: &single_cone::Frustum,
) -> (Option<f64>, Option<f64>) {
    let single = single_cast::cast_ray(&single_cast::Ray { origin, direction }, frustum, 0.0, 0.0);
    let double = double_cast::cast_ray(
        &double_cast::Ray {
            origin: origin.as_dvec3(),
            direction: direction.as_dvec3(),
        },
        &widened(frustum),
        0.0,
        0.0,
    );
    (single.map(|hit| f64::from(hit.t)), double.map(|hit| hit.t))
}

/// The quadratic of Equation 10 with its origin in the eye. Of its roots the one nearest to `wanted` counts, so that
/// picking the wrong one is not held against it.
fn plain_root(e: Vec3, d: Vec3, frustum: &single_cone::Frustum, wanted: f64) -> Option<f64> {
    let (axis, k) = (frustum.axis, frustum.slope);
    let (ey, dy) = (e.dot(axis), d.dot(axis));
    let (e_perp, d_perp) = (e - axis * ey, d - axis * dy);
    let r = frustum.radius + k * ey;
    let a = d_perp.dot(d_perp) - k * dy * k * dy;
    let b = e_perp.dot(d_perp) - r * k * dy;
    let c = e_perp.dot(e_perp) - r * r;
    let discriminant = b * b - a * c;
    if discriminant < 0.0 {
        return None;
    }
    let root = discriminant.sqrt();
    let roots = [(-b - root) / a, (-b + root) / a].map(f64::from);
    roots
        .into_iter()
        .min_by(|s, t| (s - wanted).abs().total_cmp(&(t - wanted).abs()))
}

/// Rays from all sides at a distance towards a segment of length 1.
pub fn measure(distance: f64) -> Precision {
    let frustum = middle_segment();
    let axis = frustum.axis.as_dvec3();
    let mut random = Random::new(1);
    let (mut errors, mut plain_errors) = (Vec::new(), Vec::new());
    let (mut hits, mut lost, mut plain_lost) = (0, 0, 0);
    for _ in 0..RAYS {
        let aim = axis * random.between(0.1, 0.9) + random.direction() * RADII[0];
        let away = random.direction();
        let origin = (aim + away * (distance + RADII[0])).as_vec3();
        let direction = (aim - origin.as_dvec3()).as_vec3();
        let (single, double) = cast_both(origin, direction, &frustum);
        lost += usize::from(single.is_some() != double.is_some());
        let Some(exact) = double else { continue };
        hits += 1;
        errors.extend(single.map(|t| (t - exact).abs() / exact));
        match plain_root(origin, direction, &frustum, exact) {
            Some(t) => plain_errors.push((t - exact).abs() / exact),
            None => plain_lost += 1,
        }
    }
    let share = |count: usize| count as f64 / f64::from(hits);
    Precision {
        distance,
        median: quantile(&mut errors, 0.5),
        most: quantile(&mut errors, 0.99),
        lost: share(lost),
        plain_median: quantile(&mut plain_errors, 0.5),
        plain_most: quantile(&mut plain_errors, 0.99),
        plain_lost: share(plain_lost),
    }
}

/// Two distances a decade, from 1 to 10⁷.
fn sweep() -> Vec<Precision> {
    (0..=14)
        .map(|i| measure(10f64.powf(0.5 * f64::from(i))))
        .collect()
}

/// What a curve is called, and what it shows.
type Curve = (&'static str, fn(&Precision) -> f64);

fn curves<const N: usize>(curves: [Curve; N]) -> Vec<Series> {
    let rows = sweep();
    let curve = |(name, value): Curve| {
        Series::line(name, rows.iter().map(|row| (row.distance, value(row))))
    };
    curves.map(curve).into()
}

fn distance_axis() -> Axis {
    Axis::log("distance from the eye (lengths of the segment)")
}

/// The chart of depth error.
pub fn chart() -> Chart {
    let resolution = |_: &Precision| f64::from(f32::EPSILON) / 2.0;
    super::chart(
        "Depth error of 32 bits against distance",
        distance_axis(),
        Axis::log("depth error (share of the depth)"),
        curves([
            ("crate, half of the rays", |row| row.median),
            ("crate, 99 of 100", |row| row.most),
            ("Equation 10, half of the rays", |row| row.plain_median),
            ("Equation 10, 99 of 100", |row| row.plain_most),
            ("half a unit of a 32-bit depth buffer", resolution),
        ]),
    )
}

/// The chart of rays that are lost.
pub fn lost_rays_chart() -> Chart {
    super::chart(
        "Rays that 32 bits lose or gain against distance",
        distance_axis(),
        Axis::log("share of the rays that hit (1e-6 stands for none)").with_floor(1e-6),
        curves([
            ("crate", |row| row.lost),
            ("Equation 10", |row| row.plain_lost),
        ]),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depth_stays_as_good_as_a_depth_buffer_at_every_distance() {
        for row in sweep() {
            // The ray's own numbers are off by half a unit each; the depth is a sum of three products of them and a
            // root found from there: ten units leave room for all.
            assert!(row.median < 10.0 * f64::from(f32::EPSILON), "{row:?}");
        }
    }

    #[test]
    fn the_plain_quadratic_gets_worse_with_distance_and_the_crates_does_not() {
        let (near, far) = (measure(1.0), measure(1e4));
        // b² and ac agree to (radius/distance)², 10⁻⁹ here, of which 32 bits see nothing.
        assert!(far.plain_lost > 0.1, "{far:?}");
        assert!(far.lost < 0.01 && near.lost < 0.01, "{near:?} {far:?}");
        assert!(far.median < 4.0 * near.median, "{near:?} {far:?}");
    }
}
