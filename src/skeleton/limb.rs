//! Limbs: which child goes on where its parent's segment ends.

use super::Joint;
use glam::Vec3;

/// Dot products of unit axes nearer than this count as equally well aligned.
const ALIKE: f32 = 1e-6;
/// Alignment of a segment that has no direction: worse than any.
const NO_DIRECTION: f32 = -2.0;

/// For every joint the child that continues its limb: the best aligned with the joint's own segment, then the
/// thickest, then the first. A root joint, which has no segment, is continued by its thickest child.
/// Every other child branches off.
///
/// Indices are those of `joints`; parents stand before their children, as in a [`Skeleton`](super::Skeleton).
pub fn continuations(joints: &[Joint]) -> Vec<Option<u32>> {
    let mut best: Vec<Option<(f32, f32, u32)>> = vec![None; joints.len()];
    for (i, joint) in joints.iter().enumerate() {
        let Some(parent) = joint.parent else { continue };
        let slot = &mut best[parent as usize];
        let alignment = match direction(joints, parent as usize) {
            None if joints[parent as usize].parent.is_none() => 0.0,
            axis => match (axis, direction(joints, i)) {
                (Some(axis), Some(own)) => axis.dot(own),
                _ => NO_DIRECTION,
            },
        };
        let better = match *slot {
            None => true,
            Some((aligned, radius, _)) => {
                alignment > aligned + ALIKE
                    || ((alignment - aligned).abs() <= ALIKE && joint.radius > radius)
            }
        };
        if better {
            *slot = Some((alignment, joint.radius, i as u32));
        }
    }
    best.into_iter().map(|best| best.map(|b| b.2)).collect()
}

/// Unit direction of the segment that ends at a joint; `None` at a root and for a segment of zero length.
fn direction(joints: &[Joint], i: usize) -> Option<Vec3> {
    let parent = joints[i].parent?;
    (joints[i].position - joints[parent as usize].position).try_normalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_straightest_child_continues_a_limb_and_the_thickest_a_root() {
        let joints = [
            Joint::root(Vec3::ZERO, 0.2),
            Joint::new(Vec3::Y, 0.1, 0),
            Joint::new(Vec3::new(1.0, 2.0, 0.0), 0.1, 1),
            Joint::new(Vec3::new(0.1, 2.0, 0.0), 0.02, 1),
            Joint::new(Vec3::X, 0.15, 0),
        ];
        assert_eq!(
            continuations(&joints),
            vec![Some(4), Some(3), None, None, None]
        );
    }

    #[test]
    fn among_children_in_line_the_thicker_then_the_first_continues() {
        let joints = [
            Joint::root(Vec3::ZERO, 0.2),
            Joint::new(Vec3::Y, 0.1, 0),
            Joint::new(Vec3::Y * 2.0, 0.05, 1),
            Joint::new(Vec3::Y * 3.0, 0.06, 1),
            Joint::new(Vec3::Y * 4.0, 0.06, 1),
        ];
        assert_eq!(continuations(&joints)[1], Some(3));
    }
}
