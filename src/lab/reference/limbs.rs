//! What a skeleton says before it has a surface: segments, and which of them continue a limb.

use glam::DVec3;

use super::ReferenceJoint;

/// Axes whose cosines with the limb differ by no more count as equally well aligned.
const ALIGNMENT_TIE: f64 = 1e-6;

/// What stands at the start of a segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Start {
    /// A root joint whose cap this segment closes.
    Root,
    /// The parent's own segment, which this one continues.
    Continuation,
    /// The inside of the parent's sphere: a branch.
    Branch,
}

/// A segment: the line from a joint's parent to the joint.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limb {
    pub joint: usize,
    pub parent: usize,
    /// The parent's position, A.
    pub from: DVec3,
    /// The joint's position, B.
    pub to: DVec3,
    /// Unit axis M; zero when the length is.
    pub axis: DVec3,
    /// L = |B − A|.
    pub length: f64,
    /// Radius at A: the parent's, or for a branch the smaller of the parent's and the joint's.
    pub start_radius: f64,
    /// Radius at B.
    pub end_radius: f64,
    pub start: Start,
}

impl Limb {
    /// s = (ρA − ρB)/L, the sine of the tangent cone's half-angle; not finite when L = 0.
    pub fn sine(&self) -> f64 {
        (self.start_radius - self.end_radius) / self.length
    }
}

/// All segments of a skeleton, by the joint at their end, and the child that continues each joint.
pub(super) struct Limbs {
    /// `by_joint[j]` is the segment that ends at joint j; `None` for a root.
    pub by_joint: Vec<Option<Limb>>,
    /// `continuation[j]` is the child of j that continues the limb; `None` for a leaf.
    pub continuation: Vec<Option<usize>>,
    /// `children[j]` is how many segments start at j.
    pub children: Vec<usize>,
}

impl Limbs {
    /// # Panics
    ///
    /// When a joint's parent does not come before it.
    pub fn new(joints: &[ReferenceJoint]) -> Self {
        let mut children = vec![Vec::new(); joints.len()];
        for (j, joint) in joints.iter().enumerate() {
            if let Some(parent) = joint.parent {
                assert!(
                    parent < j,
                    "joint {j} names parent {parent}: parents come first"
                );
                children[parent].push(j);
            }
        }
        let axis = |j: usize| {
            let parent = joints[j].parent?;
            (joints[j].position - joints[parent].position).try_normalize()
        };
        let continuation: Vec<_> = (0..joints.len())
            .map(|j| continuation(joints, &children[j], axis(j), axis))
            .collect();
        let by_joint = (0..joints.len())
            .map(|j| limb(joints, &continuation, j))
            .collect();
        Self {
            by_joint,
            continuation,
            children: children.iter().map(Vec::len).collect(),
        }
    }

    /// The segments in the order of the joints at their ends.
    pub fn iter(&self) -> impl Iterator<Item = &Limb> {
        self.by_joint.iter().flatten()
    }
}

fn limb(joints: &[ReferenceJoint], continuation: &[Option<usize>], j: usize) -> Option<Limb> {
    let parent = joints[j].parent?;
    let (from, to) = (joints[parent].position, joints[j].position);
    let start = match (continuation[parent] == Some(j), joints[parent].parent) {
        (false, _) => Start::Branch,
        (true, None) => Start::Root,
        (true, Some(_)) => Start::Continuation,
    };
    let end_radius = joints[j].radius;
    let start_radius = match start {
        Start::Branch => end_radius.min(joints[parent].radius),
        _ => joints[parent].radius,
    };
    let axis = (to - from).try_normalize();
    Some(Limb {
        joint: j,
        parent,
        from,
        to,
        axis: axis.unwrap_or(DVec3::ZERO),
        length: axis.map_or(0.0, |_| (to - from).length()),
        start_radius,
        end_radius,
        start,
    })
}

/// Best aligned, then thickest, then first. A child whose axis has no length is the worst aligned;
/// where the joint itself has none (a root, or a segment of no length), all are aligned alike.
fn continuation(
    joints: &[ReferenceJoint],
    children: &[usize],
    own_axis: Option<DVec3>,
    axis: impl Fn(usize) -> Option<DVec3>,
) -> Option<usize> {
    let alignment = |child: usize| match (own_axis, axis(child)) {
        (Some(own), Some(other)) => own.dot(other),
        (Some(_), None) => -2.0,
        (None, _) => 0.0,
    };
    let best = children
        .iter()
        .map(|&child| alignment(child))
        .fold(f64::NEG_INFINITY, f64::max);
    children
        .iter()
        .copied()
        .filter(|&child| alignment(child) >= best - ALIGNMENT_TIE)
        .reduce(|first, next| {
            if joints[next].radius > joints[first].radius {
                next
            } else {
                first
            }
        })
}
