//! Bounding primitives: obliquely cut pyramidal frusta of twelve triangles (§2.6).
//!
//! The four side planes touch the cone, the two end planes are the cutting planes themselves. The pyramid is
//! turned so that its sides face the tilt of the steeper cut; where a corner's edge would still miss a plane, or
//! the planes cross inside the pyramid, that end is closed across the axis at the cut's farthest point instead.
//! Round ends stand off by their sphere. `shaders/bounds.wgsl` is this file term for term.

use super::cone::{End, EndKind, Frustum};
use super::scalar::{Real, Vec3};

/// Least cosine between a corner's edge and a plane's normal with which the edge is cut.
const STEEP: Real = 0.05;

/// The pyramidal frustum round a frustum: 8 corners, relative to its base. Corners 0 to 3 are at the start,
/// 4 to 7 at the end; bit 0 tells the side along the first side axis, bit 1 along the second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    axis: Vec3,
    /// First side axis, along the tilt of the steeper cut.
    side: Vec3,
    /// Second side axis: axis × side.
    other: Vec3,
    /// Half the pyramid's width at the base, and its change with y.
    radius: Real,
    slope: Real,
    /// The ends as planes, normal·X = offset with X from the base.
    start: (Vec3, Real),
    end: (Vec3, Real),
}

/// Whether an end is cut obliquely, and its least and greatest axial distance from its joint.
fn extent(frustum: &Frustum, end: &End, at_joint: Real, outward: Real) -> (Real, Real) {
    match end.kind {
        EndKind::Flat => (0.0, 0.0),
        EndKind::Round => {
            let far = outward * end.radius;
            (far, far)
        }
        EndKind::Cut => {
            let m = end.normal.dot(frustum.axis);
            let q = end.normal.cross(frustum.axis).length();
            let y1 = (end.offset - at_joint * q) / (m + frustum.slope * q).max(STEEP * STEEP);
            let y2 = (end.offset + at_joint * q) / (m - frustum.slope * q).max(STEEP * STEEP);
            (y1.min(y2), y1.max(y2))
        }
    }
}

impl Bounds {
    /// The bounds of a frustum that draws anything, widened by `margin` metres on all sides; `None` for one that
    /// draws nothing.
    pub fn new(frustum: &Frustum, margin: Real) -> Option<Self> {
        let (axis, length) = (frustum.axis, frustum.length);
        if !frustum.has_cone() {
            return Self::sphere(frustum, margin);
        }
        let at_end = frustum.radius + frustum.slope * length;
        let (low, _) = extent(frustum, &frustum.start, frustum.radius, -1.0);
        let (_, high) = extent(frustum, &frustum.end, at_end, 1.0);
        let (low, high) = (low.min(high + length), low.max(high + length));
        let (tilt_start, tilt_end) = (
            frustum.start.normal.cross(axis),
            frustum.end.normal.cross(axis),
        );
        let tilt = if tilt_start.length_squared() > tilt_end.length_squared() {
            tilt_start
        } else {
            tilt_end
        };
        // normal × axis is across both; the tilt itself lies across that and the axis.
        let side = tilt
            .cross(axis)
            .try_normalize()
            .unwrap_or_else(|| axis.any_orthonormal_vector());
        let (radius, slope) = widths(frustum, low, high);
        let mut bounds = Self {
            axis,
            side,
            other: axis.cross(side),
            radius: radius + margin,
            slope,
            start: (axis, low - margin),
            end: (axis, high + margin),
        };
        let level = bounds;
        if frustum.start.kind == EndKind::Cut {
            bounds.start = (frustum.start.normal, frustum.start.offset - margin);
        }
        if frustum.end.kind == EndKind::Cut {
            let n = frustum.end.normal;
            bounds.end = (n, frustum.end.offset + n.dot(axis) * length + margin);
        }
        if !bounds.is_convex() {
            bounds = level;
        }
        Some(bounds)
    }

    fn sphere(frustum: &Frustum, margin: Real) -> Option<Self> {
        let (centre, radius) = if frustum.end.kind == EndKind::Round {
            (frustum.length, frustum.end.radius)
        } else if frustum.start.kind == EndKind::Round {
            (0.0, frustum.start.radius)
        } else {
            return None;
        };
        let axis = frustum.axis;
        let side = axis.any_orthonormal_vector();
        Some(Self {
            axis,
            side,
            other: axis.cross(side),
            radius: radius + margin,
            slope: 0.0,
            start: (axis, centre - radius - margin),
            end: (axis, centre + radius + margin),
        })
    }

    /// Axial distance at which the edge of a corner meets a plane, and the slope it meets it with.
    fn cut(&self, across: Vec3, (normal, offset): (Vec3, Real)) -> (Real, Real) {
        let q = normal.dot(across);
        let m = normal.dot(self.axis) + self.slope * q;
        ((offset - self.radius * q) / m, m)
    }

    /// The direction of a corner's edge from the axis, √2 long.
    fn across(&self, corner: u32) -> Vec3 {
        let u = if corner & 1 == 0 {
            -self.side
        } else {
            self.side
        };
        let w = if corner & 2 == 0 {
            -self.other
        } else {
            self.other
        };
        u + w
    }

    /// True if every edge meets both planes in order.
    fn is_convex(&self) -> bool {
        (0..4).all(|corner| {
            let across = self.across(corner);
            let (y_l, m_l) = self.cut(across, self.start);
            let (y_u, m_u) = self.cut(across, self.end);
            m_l > STEEP && m_u > STEEP && y_l < y_u
        })
    }

    /// The position of a corner, 0 to 7.
    pub fn corner(&self, corner: u32) -> Vec3 {
        let across = self.across(corner);
        let plane = if corner & 4 == 0 {
            self.start
        } else {
            self.end
        };
        let (y, _) = self.cut(across, plane);
        self.axis * y + across * (self.radius + self.slope * y).max(0.0)
    }
}

/// Width of the pyramid as a line in y: along the cone, which holds every sphere that it touches, or straight
/// up where that is the smaller body or a cap bulges out of the cone.
fn widths(frustum: &Frustum, low: Real, high: Real) -> (Real, Real) {
    let (r_low, r_high) = (
        (frustum.radius + frustum.slope * low).max(0.0),
        (frustum.radius + frustum.slope * high).max(0.0),
    );
    let mut widest: Real = 0.0;
    let mut bulges = false;
    for (end, base, r_cut) in [
        (&frustum.start, 0.0, r_low),
        (&frustum.end, frustum.length, r_high),
    ] {
        match end.kind {
            EndKind::Round => {
                let at_plane = frustum.radius + frustum.slope * (base + end.offset);
                widest = widest.max(end.radius).max(at_plane);
                // A cone that touches the sphere is, seen from the axis, never nearer than the sphere.
                let touching = end.radius * (1.0 + frustum.slope * frustum.slope).sqrt();
                let at_joint = frustum.radius + frustum.slope * base;
                bulges |= at_joint < touching * (1.0 - 1e-4);
            }
            EndKind::Cut | EndKind::Flat => widest = widest.max(r_cut),
        }
    }
    let along = r_low * r_low + r_low * r_high + r_high * r_high;
    if bulges || 3.0 * widest * widest < along {
        (widest, 0.0)
    } else {
        (frustum.radius, frustum.slope)
    }
}
