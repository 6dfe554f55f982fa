//! Which triangle is seen by each sample of a slice: parallel projection along the orientation (§2.2).

use bevy::math::{Vec2, Vec3};

use super::alpha::LEAST_ALPHA;
use super::source::CrownMesh;
use crate::slicing::orientation::Orientation;

/// Stands for a sample that sees nothing.
pub(super) const NOTHING: u32 = u32::MAX;

/// Where slices are seen from: an orientation, with its box, and the size of its pictures in samples.
pub(super) struct Projection<'a> {
    pub orientation: &'a Orientation,
    pub centroid: Vec3,
    /// Samples along each side of the picture.
    pub side: u32,
}

impl Projection<'_> {
    /// A local position in samples from the picture's top left corner, and its depth along the direction.
    pub fn project(&self, position: Vec3) -> Vec3 {
        let o = self.orientation;
        let p = o.axes(position - self.centroid);
        let size = o.high - o.low;
        Vec3::new(
            (p.x - o.low.x) / size.x * self.side as f32,
            (o.high.y - p.y) / size.y * self.side as f32,
            p.z,
        )
    }
}

/// A triangle in samples, with what interpolates over it.
pub(super) struct Face {
    corners: [Vec2; 3],
    depths: Vec3,
    inverse_area: f32,
}

impl Face {
    /// `None` where it is seen from its edge.
    pub fn new(positions: [Vec3; 3], projection: &Projection) -> Option<Self> {
        let [a, b, c] = positions.map(|position| projection.project(position));
        let corners = [a, b, c].map(Vec3::truncate);
        let area = (corners[1] - corners[0]).perp_dot(corners[2] - corners[0]);
        let inverse_area = 1.0 / area;
        inverse_area.is_finite().then_some(Self {
            corners,
            depths: Vec3::new(a.z, b.z, c.z),
            inverse_area,
        })
    }

    /// Barycentric coordinates of a place, none negative inside.
    pub fn weights(&self, at: Vec2) -> Vec3 {
        let [a, b, c] = self.corners.map(|corner| corner - at);
        Vec3::new(b.perp_dot(c), c.perp_dot(a), a.perp_dot(b)) * self.inverse_area
    }

    /// The samples of a row that may lie inside, of those in `columns`. Weights are linear along a row; a sample more on
    /// either side makes up for rounding, and each is tested by its own weights.
    fn span(&self, y: u32, columns: &core::ops::Range<u32>) -> core::ops::Range<u32> {
        let [a, b, c] = self.corners;
        let first = columns.start as f32;
        let start = self.weights(Vec2::new(first + 0.5, y as f32 + 0.5));
        let slopes = Vec3::new(b.y - c.y, c.y - a.y, a.y - b.y) * self.inverse_area;
        let (mut low, mut high) = (0.0_f32, (columns.end - columns.start) as f32);
        for (start, slope) in start.to_array().into_iter().zip(slopes.to_array()) {
            // Of a level weight nothing is known that the test does not find out.
            if slope > 0.0 {
                low = low.max(-start / slope - 1.0);
            } else if slope < 0.0 {
                high = high.min(-start / slope + 2.0);
            }
        }
        // Casts clamp what is below 0.
        let place = |x: f32| columns.start + (x as u32).min(columns.end - columns.start);
        place(low)..place(high)
    }

    /// The samples whose centres may lie inside: from the first to the one after the last.
    fn range(&self, side: u32) -> [core::ops::Range<u32>; 2] {
        let [a, b, c] = self.corners;
        let low = (a.min(b).min(c) - 0.5).ceil().max(Vec2::ZERO);
        let high = (a.max(b).max(c) - 0.5).floor();
        // Casts clamp what is below 0.
        let end = |x: f32| ((x + 1.0).max(0.0) as u32).min(side);
        let side = |low: f32, high: f32| {
            let end = end(high);
            (low as u32).min(end)..end
        };
        [side(low.x, high.x), side(low.y, high.y)]
    }
}

/// The samples of one slice: the index of the triangle nearest to the eye in each, or [`NOTHING`].
///
/// A primitive is on the slice nearest to its centroid. One that reaches through more than the distance of two slices is
/// on several: each of its points on the slice nearest to that point, so that nothing cracks (§2.2).
pub(super) fn rasterize(
    mesh: &CrownMesh,
    projection: &Projection,
    slice: u32,
    count: u32,
) -> Vec<u32> {
    let side = projection.side as usize;
    let o = projection.orientation;
    let spacing = o.spacing(count);
    let mut seen = vec![NOTHING; side * side];
    let mut depths = vec![f32::NEG_INFINITY; side * side];
    for (index, triangle) in mesh.triangles.iter().enumerate() {
        let Some(face) = Face::new(triangle.positions(), projection) else {
            continue;
        };
        let (near, far) = (face.depths.max_element(), face.depths.min_element());
        let is_large = near - far > spacing;
        if is_large {
            if o.slice_at(far, count) > slice || o.slice_at(near, count) < slice {
                continue;
            }
        } else if o.slice_at(o.axes(triangle.centroid() - projection.centroid).z, count) != slice {
            continue;
        }
        let material = &mesh.materials[triangle.material as usize];
        let may_have_holes = material.may_have_holes(triangle);
        let [columns, rows] = face.range(projection.side);
        for y in rows {
            for x in face.span(y, &columns) {
                let weights = face.weights(Vec2::new(x as f32 + 0.5, y as f32 + 0.5));
                if weights.min_element() < 0.0 {
                    continue;
                }
                let depth = weights.dot(face.depths);
                let at = y as usize * side + x as usize;
                // Of equal depths the first stays, so that the order of work is all that counts.
                let is_nearest = depth > depths[at];
                if !is_nearest || (is_large && o.slice_at(depth, count) != slice) {
                    continue;
                }
                // What is not there hides nothing.
                if may_have_holes && material.alpha(triangle, weights) < LEAST_ALPHA {
                    continue;
                }
                depths[at] = depth;
                seen[at] = index as u32;
            }
        }
    }
    seen
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plants::Dice;

    #[test]
    fn spans_hold_every_sample_inside() {
        let mut dice = Dice::new(2);
        let mut inside = 0;
        for _ in 0..2000 {
            // From thin needles to whole pictures.
            let reach = 200.0 * dice.roll() * dice.roll() + 0.1;
            let place = Vec2::new(dice.between(-20.0, 276.0), dice.between(-20.0, 276.0));
            let thin = dice.roll() * dice.roll();
            let along = Vec2::from_angle(dice.angle());
            let corner = |dice: &mut Dice| {
                place + along * dice.jitter(reach) + along.perp() * dice.jitter(reach * thin)
            };
            let corners = [corner(&mut dice), corner(&mut dice), corner(&mut dice)];
            let area = (corners[1] - corners[0]).perp_dot(corners[2] - corners[0]);
            let face = Face {
                corners,
                depths: Vec3::ZERO,
                inverse_area: 1.0 / area,
            };
            if !face.inverse_area.is_finite() {
                continue;
            }
            let [columns, rows] = face.range(256);
            for y in 0..256 {
                let span = face.span(y, &columns);
                for x in 0..256 {
                    let at = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
                    // The very border is decided by rounding, one way or the other.
                    if face.weights(at).min_element() > 1e-4 {
                        assert!(
                            rows.contains(&y) && span.contains(&x),
                            "{at} in {corners:?}"
                        );
                        inside += 1;
                    }
                }
            }
        }
        assert!(inside > 100_000, "{inside}");
    }
}
