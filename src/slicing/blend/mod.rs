//! View blending (§2.3): which slicings are drawn for an eye, how opaque, and in what order.
//!
//! `weights.rs` finds the slicings and their weights, `parts.rs` how they differ from part to part up close, `detail.rs` the
//! level, `cast.rs` what casts shadows, `seen.rs` how leaves are lit from above; here they become slices, far to near. In
//! `shaders`, `blend.wgsl`, `parts.wgsl`, `cast.wgsl`, `seen.wgsl` and, for what becomes of them, `drawn.wgsl` have the same
//! functions by the same names.

use bevy::math::Vec3;

mod cast;
mod detail;
mod parts;
mod seen;
mod weights;

pub use cast::{DENSEST, cast_slices, facing, first_leaf};
pub use detail::{FOCAL, Ranks, levels};
pub use parts::{
    PART_SLOTS, PARTS, deviation, part_direction, part_slots, part_turn, part_weight,
    turned_weight, widest,
};
pub use seen::{
    EVEN_HEIGHT, HEIGHTS, HOT_SPOT, LEAN, LEAN_DOWN, TOP_LIGHT, leaning, towards_sun, turned,
};
pub use weights::{
    ALONE, SLOTS, SUREST, Slot, corrected, covered, nearest, primary_opacity, slanted, slots,
};

use super::slicing::SlicingShape;

/// In what order the slices of blended slicings are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, bevy::reflect::Reflect)]
pub enum SliceOrder {
    /// Interleaved by rank from the furthest; within a rank, always by number of orientation. Nothing pops where primary
    /// and secondary are swapped.
    #[default]
    Steady,
    /// As the paper does: interleaved, within a rank the secondary slice before the primary one, two slicings of the
    /// finest level only. Swaps pop.
    Paper,
}

/// A slice that is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrawnSlice {
    /// Which orientation.
    pub orientation: u32,
    /// Which level of detail.
    pub level: u32,
    /// Which slice of it, the first being furthest along the direction.
    pub index: u32,
    /// What becomes of its pixels' opacities: in the paper's order they are multiplied with this, α f_c; else this is α,
    /// [`slanted`], and they are what [`covered`] says.
    pub opacity: f32,
}

/// All slices for an eye at `eye`, from the centroid in local space, on the screen of [`FOCAL`], in the order in which they
/// are drawn: far to near.
/// `left_out` of the furthest ones of each slicing are not.
pub fn drawn_slices(
    shape: &SlicingShape,
    eye: Vec3,
    order: SliceOrder,
    left_out: u32,
) -> Vec<DrawnSlice> {
    let direction = eye.normalize_or(Vec3::Z);
    let slots = slots(shape, direction, order);
    let (level, share) = levels(shape, eye.length() / shape.radius, order);
    let greatest = slots.iter().map(|slot| slot.weight).fold(0.0, f32::max);
    let mut drawn = Vec::new();
    for (level, share) in [(level + 1, 1.0 - share), (level, share)] {
        let count = shape.levels.get(level).copied().unwrap_or(0);
        for rank in 0..count {
            for slot in slots {
                let weight = slot.weight * share;
                let towards = shape.orientations[slot.orientation as usize].direction;
                let faces = towards.dot(direction) >= 0.0;
                let opacity = match order {
                    SliceOrder::Steady => slanted(shape, weight, towards, direction),
                    SliceOrder::Paper => corrected(weight, greatest, shape.correction),
                };
                // One is always left, or far crowns would be gone.
                if opacity <= 0.0 || rank < left_out.min(count - 1) {
                    continue;
                }
                drawn.push(DrawnSlice {
                    orientation: slot.orientation,
                    level: level as u32,
                    index: if faces { rank } else { count - 1 - rank },
                    opacity,
                });
            }
        }
    }
    drawn
}

/// 0 up to `low`, 1 from `high`, and an S between.
fn smooth(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests;
