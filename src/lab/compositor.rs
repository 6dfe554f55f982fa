//! The reference of slicing: a compositor in double precision that follows the paper's text (§2.3) step by step.
//!
//! It shares nothing with the shaders or with `slicing::blend` but the baked pictures: slices are met by rays through the
//! pixels, discrepancy angles are angles, and blending is c_t α + c_f (1 − α), in linear light.

use bevy::math::{DMat4, DVec2, DVec3};

use super::studio::Shot;
use crate::slicing::Slicing;

/// A crown as the paper would draw it: two slicings of the finest level, without a vertical one.
pub struct Compositor<'a> {
    slicing: &'a Slicing,
    world_from_local: DMat4,
    /// Slices of primary and secondary slicing, in the paper's order, as orientation, slice and opacity.
    order: Vec<(usize, u32, f64)>,
}

impl<'a> Compositor<'a> {
    /// A crown that stands at `world_from_local`, seen from `eye` in world space.
    ///
    /// # Panics
    /// If the slicing has fewer than two orientations besides the vertical one.
    pub fn new(slicing: &'a Slicing, world_from_local: DMat4, eye: DVec3) -> Self {
        let shape = slicing.shape();
        let centroid = shape.centroid.as_dvec3();
        // The direction vector from the slicing box centroid to the observer, o − c_s.
        let o_minus_c = world_from_local.inverse().transform_point3(eye) - centroid;
        let count = shape.orientations.len() - usize::from(shape.vertical);
        let v = |s: usize| shape.orientations[s].direction.as_dvec3().normalize();
        let mut by_angle: Vec<usize> = (0..count).collect();
        by_angle.sort_by(|a, b| {
            v(*a)
                .angle_between(o_minus_c)
                .total_cmp(&v(*b).angle_between(o_minus_c))
        });
        let (primary, secondary) = (by_angle[0], by_angle[1]);
        // Equality of both angles lies at half the angle between the orientations, once the direction is projected to
        // their plane.
        let normal = v(primary).cross(v(secondary)).normalize();
        let projected = o_minus_c - normal * normal.dot(o_minus_c);
        let discrepancy = v(primary).angle_between(projected);
        let equality = 0.5 * v(primary).angle_between(v(secondary));
        // "The primary slicing opacity varies from 1 to 0.5."
        let alpha_p = 1.0 - 0.5 * (discrepancy / equality).min(1.0);
        let alpha_s = 1.0 - alpha_p;
        let f_c = 1.0 + f64::from(shape.correction) * alpha_s;
        // "The furthest secondary slice, continued with the furthest primary slice, second furthest secondary slice, and
        // so on, until the closest primary slice."
        let order = (0..shape.levels[0]).flat_map(|slice| {
            [
                (secondary, slice, (f_c * alpha_s).min(1.0)),
                (primary, slice, (f_c * alpha_p).min(1.0)),
            ]
        });
        Self {
            slicing,
            world_from_local,
            order: order.collect(),
        }
    }

    /// Linear colours of all pixels of a shot, row by row, before a background of one linear colour.
    pub fn composite(&self, shot: &Shot, background: DVec3) -> Vec<DVec3> {
        let local_from_world = self.world_from_local.inverse();
        let pixels = (0..shot.size.y).flat_map(|y| (0..shot.size.x).map(move |x| (x, y)));
        pixels
            .map(|(x, y)| {
                let (origin, direction) = shot.ray(x as f32 + 0.5, y as f32 + 0.5);
                let origin = local_from_world.transform_point3(origin);
                let direction = local_from_world.transform_vector3(direction);
                self.order
                    .iter()
                    .fold(background, |behind, &(orientation, slice, opacity)| {
                        let Some([color, alpha]) = self.meet(orientation, slice, origin, direction)
                        else {
                            return behind;
                        };
                        let alpha = alpha.x * opacity;
                        color * alpha + behind * (1.0 - alpha)
                    })
            })
            .collect()
    }

    /// Colour, and alpha in all coordinates, where a ray meets a slice.
    fn meet(
        &self,
        orientation: usize,
        slice: u32,
        origin: DVec3,
        direction: DVec3,
    ) -> Option<[DVec3; 2]> {
        let shape = self.slicing.shape();
        let o = &shape.orientations[orientation];
        let normal = o.direction.as_dvec3();
        let depth = f64::from(o.offset(slice, shape.levels[0]));
        let from_centroid = origin - shape.centroid.as_dvec3();
        let t = (depth - normal.dot(from_centroid)) / normal.dot(direction);
        if !(t.is_finite() && t > 0.0) {
            return None;
        }
        let at = from_centroid + direction * t;
        let (low, high) = (o.low.as_dvec3(), o.high.as_dvec3());
        let u = (o.right.as_dvec3().dot(at) - low.x) / (high.x - low.x);
        let v = (high.y - o.up.as_dvec3().dot(at)) / (high.y - low.y);
        let inside = (0.0..=1.0).contains(&u) && (0.0..=1.0).contains(&v);
        inside.then(|| {
            self.sample(
                shape.first_layer(0, orientation) + slice as usize,
                DVec2::new(u, v),
            )
        })
    }

    /// Bilinear, of linear light, clamped to the edge.
    fn sample(&self, layer: usize, uv: DVec2) -> [DVec3; 2] {
        let side = self.slicing.shape().pixels as usize;
        let pixels = self.slicing.color(layer);
        let place = uv * side as f64 - 0.5;
        let corner = place.floor();
        let part = place - corner;
        let mut sums = [DVec3::ZERO; 2];
        for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let clamp = |x: f64, d: i64| (x as i64 + d).clamp(0, side as i64 - 1) as usize;
            let pixel = pixels[clamp(corner.y, dy) * side + clamp(corner.x, dx)];
            let share = |part: f64, d: i64| if d == 1 { part } else { 1.0 - part };
            let weight = share(part.x, dx) * share(part.y, dy);
            let [r, g, b, a] = pixel.map(|byte| f64::from(byte) / 255.0);
            sums[0] += DVec3::new(r, g, b).map(linear) * weight;
            sums[1] += DVec3::splat(a) * weight;
        }
        sums
    }
}

/// Linear light of an sRGB number.
fn linear(x: f64) -> f64 {
    if x <= 0.04045 {
        x / 12.92
    } else {
        ((x + 0.055) / 1.055).powf(2.4)
    }
}

/// The sRGB byte of linear light.
pub fn srgb_byte(light: f64) -> u8 {
    let light = light.clamp(0.0, 1.0);
    let x = if light <= 0.003_130_8 {
        12.92 * light
    } else {
        1.055 * light.powf(1.0 / 2.4) - 0.055
    };
    (x * 255.0).round() as u8
}
