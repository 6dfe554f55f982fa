//! What the species share: ranges, directions, curved limbs.

use bevy::math::{Quat, Vec3};

use crate::skeleton::SkeletonBuilder;

/// The golden angle, in radians: leaves that follow one another round a stem at this angle shade each other least.
pub(super) const GOLDEN_ANGLE: f32 = 2.399_963_2;

/// `value` brought into `low..=high`, or `default` where it is not finite.
pub(super) fn within(value: f32, low: f32, high: f32, default: f32) -> f32 {
    if value.is_finite() {
        value.clamp(low, high)
    } else {
        default
    }
}

/// The horizontal direction of a heading, in radians from x towards z.
pub(super) fn heading(angle: f32) -> Vec3 {
    let (sin, cos) = angle.sin_cos();
    Vec3::new(cos, 0.0, sin)
}

/// The unit direction at `elevation` radians above the horizontal, over `outward` (unit, horizontal).
pub(super) fn raised(outward: Vec3, elevation: f32) -> Vec3 {
    let (sin, cos) = elevation.sin_cos();
    outward * cos + Vec3::Y * sin
}

/// The unit direction `angle` radians away from `axis` (unit), to the side that `azimuth` radians give.
pub(super) fn spread(axis: Vec3, angle: f32, azimuth: f32) -> Vec3 {
    let (right, up) = axis.any_orthonormal_pair();
    let (sin, cos) = azimuth.sin_cos();
    axis * angle.cos() + (right * cos + up * sin) * angle.sin()
}

/// `from` turned towards `to` (both unit) by at most `angle` radians.
pub(super) fn turned(from: Vec3, to: Vec3, angle: f32) -> Vec3 {
    let between = from.angle_between(to);
    if between <= angle || between < 1e-4 {
        return if angle > 0.0 { to } else { from };
    }
    // Opposite directions have no plane in common; any will do.
    let axis = from.cross(to).try_normalize();
    let axis = axis.unwrap_or_else(|| from.any_orthonormal_vector());
    (Quat::from_axis_angle(axis, angle) * from).normalize()
}

/// `a` at 0, `b` at 1, linear between and beyond.
pub(super) fn mix(a: f32, b: f32, t: f32) -> f32 {
    a + (b - a) * t
}

/// 0 up to `low`, 1 from `high`, and an S between.
pub(super) fn smooth(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// The tip of a limb that grows step by step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tip {
    /// The last joint.
    pub joint: u32,
    /// Where it is, in metres.
    pub position: Vec3,
    /// Where the limb heads, unit.
    pub direction: Vec3,
}

impl Tip {
    /// A limb that starts with a root.
    pub fn root(plant: &mut SkeletonBuilder, position: Vec3, radius: f32, direction: Vec3) -> Self {
        Self {
            joint: plant.root(position, radius),
            position,
            direction,
        }
    }

    /// Turns up as far as the next segment, `length` metres long, needs to end `clearance` metres above the ground.
    pub fn keep_above(&mut self, clearance: f32, length: f32) {
        let sine = ((clearance - self.position.y) / length).clamp(-1.0, 1.0);
        if self.direction.y < sine {
            let level = Vec3::new(self.direction.x, 0.0, self.direction.z);
            self.direction = raised(level.normalize_or(Vec3::X), sine.asin());
        }
    }

    /// Grows by one segment along its direction, `length` metres to a joint of `radius` metres.
    pub fn step(&mut self, plant: &mut SkeletonBuilder, length: f32, radius: f32) {
        self.position += self.direction * length;
        self.joint = plant.joint(self.joint, self.position, radius);
    }
}
