//! Distances in one slice (P. Felzenszwalb and D. Huttenlocher, *Distance transforms of sampled functions*, 2012),
//! where pixels may be longer than wide.

use std::ops::Range;

/// A slice with what surrounds it.
pub(super) struct Plane {
    /// Columns and rows.
    pub size: [usize; 2],
    /// Which columns and rows are the slice's own.
    pub own: [Range<usize>; 2],
    /// Width and height of a pixel.
    pub spacing: [f32; 2],
    /// Row by row, whether a pixel is opaque.
    pub solid: Vec<bool>,
}

impl Plane {
    /// Squares of how deep in the contour the centre of each pixel lies: of its distance to the nearest empty pixel,
    /// which is a rectangle and not its centre. Infinite without empty pixels.
    pub fn depth_squared(&self) -> Vec<f32> {
        let [width, height] = self.size;
        let mut depth = vec![f32::INFINITY; width * height];
        for row in 0..height {
            let range = row * width..(row + 1) * width;
            depth_in_row(
                &self.solid[range.clone()],
                self.spacing[0],
                &mut depth[range],
            );
        }
        let mut envelope = Envelope::default();
        // A row that is d away is nearer by half a pixel, at its border.
        let edges: Vec<f32> = (0..=height).map(|k| k as f32 * self.spacing[1]).collect();
        let mut column = vec![0.0; height];
        for x in 0..width {
            for (y, value) in column.iter_mut().enumerate() {
                *value = depth[y * width + x];
            }
            envelope.clear();
            for (k, &edge) in edges.iter().enumerate() {
                let above = column.get(k).copied().unwrap_or(f32::INFINITY);
                let below = if k > 0 { column[k - 1] } else { f32::INFINITY };
                envelope.add(edge, above.min(below));
            }
            let centres = (0..height).map(|y| (y as f32 + 0.5) * self.spacing[1]);
            envelope.evaluate(centres, |y, value| {
                depth[y * width + x] = value.min(column[y]);
            });
        }
        depth
    }

    /// Pixels of the slice's own contour: opaque, and beside an empty one.
    pub fn contour(&self, depth_squared: &[f32]) -> Vec<u32> {
        let [columns, rows] = &self.own;
        let half = self.spacing[0].max(self.spacing[1]) * 0.5;
        let mut contour = Vec::new();
        for row in rows.clone() {
            let start = row * self.size[0];
            let pixels = (start + columns.start..start + columns.end)
                .filter(|&index| self.solid[index] && depth_squared[index] <= half * half);
            contour.extend(pixels.map(|index| index as u32));
        }
        contour
    }

    /// How many pixels of a contour are further than a diameter from all points at least half of it deep.
    pub fn far_from_deep(&self, depth_squared: &[f32], contour: &[u32], diameter: f32) -> usize {
        let [width, height] = self.size;
        let deep = (diameter / 2.0) * (diameter / 2.0) * (1.0 - 1e-5);
        // Points are pixels' centres, so that one may lie half a pixel off.
        let slack = self.spacing[0].max(self.spacing[1]) * 0.5;
        let near = (diameter + slack) * (diameter + slack);
        let mut along_rows = vec![f32::INFINITY; width * height];
        for row in 0..height {
            let range = row * width..(row + 1) * width;
            let line = &mut along_rows[range.clone()];
            distance_in_row(&depth_squared[range], deep, self.spacing[0], line);
        }
        // The nearest row first: most have a deep point in their own or the next.
        let is_near = |index: usize, rows: isize| {
            let step = rows as f32 * self.spacing[1];
            let other = index as isize + rows * width as isize;
            let inside = (0..along_rows.len() as isize).contains(&other);
            inside && along_rows[other as usize] + step * step <= near
        };
        let reach = ((diameter + slack) / self.spacing[1]) as isize;
        let far = contour.iter().filter(|&&index| {
            let index = index as usize;
            !(0..=reach).any(|rows| is_near(index, rows) || is_near(index, -rows))
        });
        far.count()
    }
}

/// Squares of distances from centres to the nearest empty pixel of the row.
fn depth_in_row(solid: &[bool], spacing: f32, depth: &mut [f32]) {
    let mut walk = |order: &mut dyn Iterator<Item = usize>| {
        let mut distance = f32::INFINITY;
        for i in order {
            distance = if solid[i] {
                distance + spacing
            } else {
                -0.5 * spacing
            };
            // Empty pixels have no depth; the first pixel after one is half a pixel deep.
            depth[i] = depth[i].min(distance.max(0.0) * distance.max(0.0));
        }
    };
    let count = solid.len();
    walk(&mut (0..count));
    walk(&mut (0..count).rev());
}

/// Squares of distances between centres, to the nearest of the row that is deep.
fn distance_in_row(depth_squared: &[f32], deep: f32, spacing: f32, squared: &mut [f32]) {
    let mut walk = |order: &mut dyn Iterator<Item = usize>| {
        let mut distance = f32::INFINITY;
        for i in order {
            distance = if depth_squared[i] >= deep {
                0.0
            } else {
                distance + spacing
            };
            squared[i] = squared[i].min(distance * distance);
        }
    };
    let count = depth_squared.len();
    walk(&mut (0..count));
    walk(&mut (0..count).rev());
}

/// The lowest of parabolas (x − place)² + value.
#[derive(Default)]
struct Envelope {
    /// Place and value of each parabola that is lowest somewhere, and from where on.
    parts: Vec<[f32; 3]>,
}

impl Envelope {
    fn clear(&mut self) {
        self.parts.clear();
    }

    /// Adds a parabola to the right of all others.
    fn add(&mut self, place: f32, value: f32) {
        if value == f32::INFINITY {
            return;
        }
        let mut from = f32::NEG_INFINITY;
        while let Some(&[last_place, last_value, last_from]) = self.parts.last() {
            // Where both are equal; written so that large squares cancel before they are subtracted.
            let middle = 0.5 * (place + last_place);
            from = middle + 0.5 * (value - last_value) / (place - last_place);
            if from > last_from {
                break;
            }
            self.parts.pop();
            from = f32::NEG_INFINITY;
        }
        self.parts.push([place, value, from]);
    }

    /// Calls `write` with the number and value of each place; places grow.
    fn evaluate(&self, places: impl Iterator<Item = f32>, mut write: impl FnMut(usize, f32)) {
        let mut part = 0;
        for (i, x) in places.enumerate() {
            while part + 1 < self.parts.len() && self.parts[part + 1][2] <= x {
                part += 1;
            }
            let value = self
                .parts
                .get(part)
                .map_or(f32::INFINITY, |[place, value, _]| {
                    (x - place) * (x - place) + value
                });
            write(i, value);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depths_are_those_of_a_search_through_all_pixels() {
        let size = [13, 9];
        let spacing = [1.0, 0.5];
        // Pseudo-random, mostly opaque.
        let solid: Vec<bool> = (0..size[0] * size[1])
            .map(|i| (i * 7919 + 13) % 11 != 0)
            .collect();
        let plane = Plane {
            size,
            own: [0..size[0], 0..size[1]],
            spacing,
            solid,
        };
        let depth = plane.depth_squared();
        for i in 0..depth.len() {
            let mut expected = f32::INFINITY;
            for j in (0..depth.len()).filter(|&j| !plane.solid[j]) {
                let along = |a: usize, b: usize, spacing: f32| {
                    (a.abs_diff(b) as f32 - 0.5).max(0.0) * spacing
                };
                let dx = along(i % size[0], j % size[0], spacing[0]);
                let dy = along(i / size[0], j / size[0], spacing[1]);
                expected = expected.min(dx * dx + dy * dy);
            }
            assert!(
                (depth[i] - expected).abs() < 1e-4,
                "{i}: {} {expected}",
                depth[i]
            );
        }
    }
}
