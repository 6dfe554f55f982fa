//! Closing the contours (§3.2 and the appendix, Figures 6 and 14).
//!
//! Where the surface is steep, consecutive pixels of a column's surroundings fall into distant slices, and the slices
//! between have no contour there: uncoloured voxels of the inside lie *exposed*, beside an empty neighbour column.
//! They are coloured by interpolation along the column, once for each of the four sides that they are exposed on, and
//! get the mean.

use bevy::math::Vec3;

use super::super::parallel;
use super::draft::{Cell, Draft, Mark};

/// The four neighbour columns.
pub(super) const SIDES: [[i32; 3]; 4] = [[-1, 0, 0], [1, 0, 0], [0, -1, 0], [0, 1, 0]];

/// Colours all exposed voxels that have a colour above or below to take, and returns their number.
pub(super) fn close(draft: &mut Draft) -> usize {
    let rows = parallel::map(draft.size.y as usize, |y| {
        let mut closed = Vec::new();
        let mut column = Column::new(draft);
        for x in 0..draft.size.x {
            column.close(draft, x, y as u32, &mut closed);
        }
        closed
    });
    let mut count = 0;
    for (index, cell) in rows.into_iter().flatten() {
        draft.cells[index] = cell;
        count += 1;
    }
    count
}

/// Sums of what the sides of one column give its voxels.
struct Column {
    sums: Vec<(Vec3, Vec3, f32)>,
}

impl Column {
    fn new(draft: &Draft) -> Self {
        Self {
            sums: vec![(Vec3::ZERO, Vec3::ZERO, 0.0); draft.size.z as usize],
        }
    }

    fn close(&mut self, draft: &Draft, x: u32, y: u32, closed: &mut Vec<(usize, Cell)>) {
        self.sums.fill((Vec3::ZERO, Vec3::ZERO, 0.0));
        let own = |z: i32| {
            let z = u32::try_from(z).ok().filter(|&z| z < draft.size.z)?;
            Some(&draft.cells[draft.index(x, y, z)])
        };
        let mut exposed_anywhere = false;
        for side in SIDES {
            // Beyond the border of an isolated volume all is empty.
            let beside = |z: i32| {
                let z = u32::try_from(z).ok().filter(|&z| z < draft.size.z)?;
                draft
                    .beside([x, y, z], side)
                    .map(|index| &draft.cells[index])
            };
            let is_exposed = |z: i32| {
                own(z).is_some_and(|cell| cell.mark == Mark::Inside)
                    && beside(z).is_none_or(|cell| cell.mark == Mark::Empty)
            };
            let mut z = draft.size.z as i32 - 1;
            while z >= 0 {
                if !is_exposed(z) {
                    z -= 1;
                    continue;
                }
                let high = z;
                while is_exposed(z) {
                    z -= 1;
                }
                exposed_anywhere = true;
                let ends = [high + 1, z];
                let coloured =
                    |cell: Option<&Cell>| cell.filter(|cell| cell.mark == Mark::Coloured).copied();
                // At the upper end the column's own top, or the bottom of the neighbour's segment above; at the lower
                // end the top of the neighbour's segment below, or the column's own bottom.
                let upper = coloured(own(ends[0])).or_else(|| coloured(beside(ends[0])));
                let lower = coloured(beside(ends[1])).or_else(|| coloured(own(ends[1])));
                self.interpolate(ends, upper, lower);
            }
        }
        if !exposed_anywhere {
            return;
        }
        for (z, &(color, normal, count)) in self.sums.iter().enumerate() {
            if count > 0.0 {
                let cell = Cell::coloured(color / count, normal / count);
                closed.push((draft.index(x, y, z as u32), cell));
            }
        }
    }

    /// Adds what lies between two ends, which are not part of it.
    fn interpolate(&mut self, [high, low]: [i32; 2], upper: Option<Cell>, lower: Option<Cell>) {
        let (Some(upper), Some(lower)) = (upper.or(lower), lower.or(upper)) else {
            return;
        };
        for z in low + 1..high {
            let t = (high - z) as f32 / (high - low) as f32;
            let (color, normal, count) = &mut self.sums[z as usize];
            *color += upper.color.lerp(lower.color, t);
            let unit = |normal: Vec3| normal.normalize_or_zero();
            *normal += unit(upper.normal).lerp(unit(lower.normal), t);
            *count += 1.0;
        }
    }
}
