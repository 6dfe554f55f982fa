//! Which segments may a ray meet: boxes in a binary tree, split at the median.

use glam::DVec3;

/// Boxes per leaf of the tree.
const LEAF: usize = 4;

/// An axis-aligned box.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    low: DVec3,
    high: DVec3,
}

impl Bounds {
    /// No point.
    pub const EMPTY: Self = Self {
        low: DVec3::INFINITY,
        high: DVec3::NEG_INFINITY,
    };
    /// Every point.
    pub const ALL: Self = Self {
        low: DVec3::NEG_INFINITY,
        high: DVec3::INFINITY,
    };

    /// Grows to hold a sphere.
    pub fn add_sphere(&mut self, center: DVec3, radius: f64) {
        self.add(center, DVec3::splat(radius));
    }

    /// Grows to hold a disc: along a coordinate axis it reaches as far as the sine of the angle
    /// between that axis and its normal.
    pub fn add_disc(&mut self, center: DVec3, normal: DVec3, radius: f64) {
        let sine = (DVec3::ONE - normal * normal).max(DVec3::ZERO);
        self.add(center, radius * sine.map(f64::sqrt));
    }

    fn add(&mut self, center: DVec3, half: DVec3) {
        // Room for rounding, here and in the slab test.
        let half = half * (1.0 + 1e-12) + 1e-12 * center.abs() + DVec3::splat(f64::MIN_POSITIVE);
        self.low = self.low.min(center - half);
        self.high = self.high.max(center + half);
    }

    fn union(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    fn center(self) -> DVec3 {
        let center = 0.5 * (self.low + self.high);
        if center.is_finite() {
            center
        } else {
            DVec3::ZERO
        }
    }

    /// Slab test: does the ray have a point with `from` ≤ t ≤ `to` in the box?
    fn is_met(&self, origin: DVec3, dir: DVec3, mut from: f64, mut to: f64) -> bool {
        for k in 0..3 {
            if dir[k] == 0.0 {
                if origin[k] < self.low[k] || origin[k] > self.high[k] {
                    return false;
                }
                continue;
            }
            let a = (self.low[k] - origin[k]) / dir[k];
            let b = (self.high[k] - origin[k]) / dir[k];
            let slack = 1e-12 * a.abs().max(b.abs()).min(f64::MAX);
            from = from.max(a.min(b) - slack);
            to = to.min(a.max(b) + slack);
        }
        from <= to
    }
}

#[derive(Clone, Debug)]
enum Node {
    /// A range of `Bvh::order`.
    Leaf(usize, usize),
    /// Indices of two nodes.
    Inner(usize, usize),
}

/// A tree of boxes.
#[derive(Clone, Debug)]
pub(super) struct Bvh {
    boxes: Vec<Bounds>,
    order: Vec<usize>,
    nodes: Vec<(Bounds, Node)>,
}

impl Bvh {
    pub fn new(boxes: Vec<Bounds>) -> Self {
        let mut bvh = Self {
            order: (0..boxes.len()).collect(),
            boxes,
            nodes: Vec::new(),
        };
        bvh.build(0, bvh.order.len());
        bvh
    }

    /// Adds the tree over a range of `order`; returns its root.
    fn build(&mut self, from: usize, to: usize) -> usize {
        let node = self.nodes.len();
        let bounds = self.order[from..to]
            .iter()
            .fold(Bounds::EMPTY, |all, &i| all.union(self.boxes[i]));
        self.nodes.push((bounds, Node::Leaf(from, to)));
        if to - from > LEAF {
            let centers = self.order[from..to].iter().map(|&i| self.boxes[i].center());
            let low = centers.clone().fold(DVec3::INFINITY, DVec3::min);
            let high = centers.fold(DVec3::NEG_INFINITY, DVec3::max);
            let axis = (high - low).max_position();
            let middle = (to - from) / 2;
            let boxes = &self.boxes;
            self.order[from..to].select_nth_unstable_by(middle, |&i, &j| {
                boxes[i].center()[axis].total_cmp(&boxes[j].center()[axis])
            });
            let left = self.build(from, from + middle);
            let right = self.build(from + middle, to);
            self.nodes[node].1 = Node::Inner(left, right);
        }
        node
    }

    /// Calls `visit` with every box that the ray may meet between `t_min` and the bound that the
    /// last call returned. `dir` is unit.
    pub fn visit(
        &self,
        origin: DVec3,
        dir: DVec3,
        t_min: f64,
        mut visit: impl FnMut(usize) -> f64,
    ) {
        let mut bound = f64::INFINITY;
        let mut stack = vec![0];
        while let Some(node) = stack.pop() {
            let (bounds, kind) = &self.nodes[node];
            if !bounds.is_met(origin, dir, t_min, bound) {
                continue;
            }
            match *kind {
                Node::Leaf(from, to) => {
                    for &index in &self.order[from..to] {
                        if self.boxes[index].is_met(origin, dir, t_min, bound) {
                            bound = bound.min(visit(index));
                        }
                    }
                }
                Node::Inner(left, right) => stack.extend([left, right]),
            }
        }
    }
}
