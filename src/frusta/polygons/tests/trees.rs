//! Trees of any shape: folds, stumps shorter than they are thick, segments without cone or length.

use bevy::math::{DVec3, Vec3};

use super::{all, assert_closed, mesh, volume};
use crate::frusta::double::join::{Link, NONE, PosedJoint};

/// Numbers in 0..1 that look random (Knuth's MMIX generator).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() * n as f64) as usize
    }

    fn vector(&mut self) -> DVec3 {
        DVec3::from_array([0; 3].map(|_| self.next() - 0.5))
    }
}

/// A tree in which each joint's first child continues its limb.
fn tree(numbers: &mut Numbers) -> (Vec<Link>, Vec<PosedJoint>) {
    let link = |parent, continues, twist| Link {
        parent,
        next: NONE,
        continues,
        branches: false,
        twist,
    };
    let mut links = vec![link(NONE, true, 0.0)];
    let mut joints = vec![PosedJoint {
        position: DVec3::ZERO,
        radius: 0.2,
    }];
    for i in 1..3 + numbers.below(8) as u32 {
        let parent = numbers.below(links.len());
        let continues = links[parent].next == NONE;
        if continues {
            links[parent].next = i;
        } else {
            links[parent].branches = true;
        }
        links.push(link(parent as u32, continues, 2.0 * numbers.next()));
        // Some straight up, so that there are folds and limbs in line; some of no length.
        let step = match numbers.below(8) {
            0 => DVec3::ZERO,
            1 => DVec3::Y,
            2 => -DVec3::Y,
            _ => 2.0 * numbers.vector(),
        };
        joints.push(PosedJoint {
            position: joints[parent].position + step,
            radius: 0.02 + 0.3 * numbers.next(),
        });
    }
    (links, joints)
}

#[test]
fn any_tree_is_closed_and_faces_outwards() {
    let mut numbers = Numbers(1);
    for case in 0..300 {
        let plant = tree(&mut numbers);
        for settings in all(case % 3) {
            let what = format!("case {case}, {:?}, {:?}", settings.join, settings.ends);
            let parts = mesh(&plant, &settings);
            // Parts of one shape may lie at one place.
            assert_closed(&parts, true, &what);
            assert!(parts.indices.is_empty() || volume(&parts) > 0.0, "{what}");
            assert!(
                parts.positions.iter().flatten().all(|x| x.is_finite()),
                "{what}"
            );
            for n in &parts.normals {
                assert!(
                    (Vec3::from(*n).length() - 1.0).abs() < 1e-5,
                    "{what}: {n:?}"
                );
            }
        }
    }
}
