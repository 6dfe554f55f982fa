//! What must be true of every plant.

use bevy::math::Vec3;

use super::Plant;
use crate::skeleton::{Joint, Skeleton, continuations};

/// Numbers that users should not pass, and some that they may.
pub(super) const ODD: [f32; 10] = [
    0.0,
    -1.0,
    1e-30,
    0.05,
    3.0,
    1e30,
    f32::MAX,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::NAN,
];
/// The same for counts.
pub(super) const ODD_COUNTS: [u32; 5] = [0, 1, 2, 7, u32::MAX];

/// Checks the promises that hold by default: what `grow` makes of some seeds has `segments` segments, is the
/// same for the same seed and another for another, holds together and bends gently.
pub(super) fn keeps_promises(segments: usize, grow: impl Fn(u64) -> Plant) {
    let plants = [0, 1, 2, 77, u64::MAX].map(&grow);
    for plant in &plants {
        assert_eq!(plant.segment_count(), segments);
        bends_gently(plant);
        holds_together(plant);
        stands_on_the_ground(plant, 0.0);
    }
    assert_eq!(plants[3], grow(77));
    assert_ne!(plants[0], plants[1]);
    assert_ne!(plants[1], plants[2]);
}

/// Checks what holds for any parameters: every part is a skeleton, of `most` segments in all, and it stands on the
/// ground.
pub(super) fn is_sound(plant: &Plant, most: usize) {
    assert!(!plant.parts.is_empty());
    assert!(plant.segment_count() <= most, "{}", plant.segment_count());
    for part in &plant.parts {
        // Growing goes through `Skeleton::new`; this is for the day when it does not.
        assert!(Skeleton::new(part.skeleton.joints().to_vec()).is_ok());
        assert!(part.skeleton.segment_count() > 0, "{:?}", part.kind);
    }
}

/// No joint but the foot's and those above it is lower than `depth` metres below the ground.
pub(super) fn stands_on_the_ground(plant: &Plant, depth: f32) {
    for part in &plant.parts {
        for joint in part.skeleton.joints() {
            let foot = joint.parent.is_none() && joint.position.y >= -2.0 * joint.radius;
            assert!(
                foot || joint.position.y >= -depth - 1e-4,
                "{:?}: {joint:?}",
                part.kind
            );
        }
    }
}

/// The height of the highest point of a plant, in metres.
pub(super) fn top(plant: &Plant) -> f32 {
    let joints = plant.parts.iter().flat_map(|part| part.skeleton.joints());
    joints.fold(0.0, |top, joint| top.max(joint.position.y + joint.radius))
}

/// Along limbs, segments meet at less than 30°, are long enough for their mitres (the cutting plane at a joint of
/// radius ρ reaches ρ·tan(bend/2) along either segment), and are no cone so wide that one joint's sphere holds the
/// other.
fn bends_gently(plant: &Plant) {
    for part in &plant.parts {
        let joints = part.skeleton.joints();
        let mut reach = vec![0.0_f32; joints.len()];
        let along = |j: usize| {
            joints[j]
                .parent
                .map(|p| joints[j].position - joints[p as usize].position)
        };
        for (j, next) in continuations(joints).into_iter().enumerate() {
            let (Some(own), Some(next)) = (along(j), next) else {
                continue;
            };
            let bend = along(next as usize).unwrap_or(own).angle_between(own);
            assert!(
                bend < 30_f32.to_radians(),
                "{:?}: joint {j} bends by {bend}",
                part.kind
            );
            let mitre = joints[j].radius * (bend / 2.0).tan();
            reach[j] += mitre;
            reach[next as usize] += mitre;
        }
        let goes_on = continuations(joints);
        for (j, joint) in joints.iter().enumerate() {
            let (Some(own), Some(parent)) = (along(j), joint.parent) else {
                continue;
            };
            assert!(
                reach[j] < own.length(),
                "{:?}: joint {j} is too short",
                part.kind
            );
            let start = match goes_on[parent as usize] == Some(j as u32) {
                true => joints[parent as usize].radius,
                false => joint.radius.min(joints[parent as usize].radius),
            };
            let steep = (start - joint.radius).abs() / own.length();
            assert!(steep < 0.9, "{:?}: joint {j} has slope {steep}", part.kind);
        }
    }
}

/// Every root is in the ground or within the flesh of another tree of the plant.
fn holds_together(plant: &Plant) {
    // Segments as start, end, radii there, and the tree that they belong to.
    let mut flesh: Vec<(&Joint, &Joint, usize)> = Vec::new();
    let mut roots = Vec::new();
    let mut trees = 0;
    for part in &plant.parts {
        let joints = part.skeleton.joints();
        let mut tree = vec![0; joints.len()];
        for (j, joint) in joints.iter().enumerate() {
            match joint.parent {
                Some(parent) => {
                    tree[j] = tree[parent as usize];
                    flesh.push((&joints[parent as usize], joint, tree[j]));
                }
                None => {
                    trees += 1;
                    tree[j] = trees;
                    roots.push((joint, trees, part.kind));
                }
            }
        }
    }
    // Few trees have most of the flesh: needles are last asked.
    for (root, tree, kind) in roots {
        let inside = |&(from, to, other): &(&Joint, &Joint, usize)| {
            other != tree && depth(root.position, from, to) > -1e-5
        };
        let buried = root.position.y <= root.radius;
        assert!(
            buried || flesh.iter().any(inside),
            "{kind:?}: {root:?} hangs in the air"
        );
    }
}

/// How deep a point is in a segment, in metres; negative outside.
fn depth(point: Vec3, from: &Joint, to: &Joint) -> f32 {
    let axis = to.position - from.position;
    let t = ((point - from.position).dot(axis) / axis.length_squared()).clamp(0.0, 1.0);
    let radius = from.radius + (to.radius - from.radius) * t;
    radius - point.distance(from.position + axis * t)
}
