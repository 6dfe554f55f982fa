//! How much light from around comes to each triangle: the inside of a crown is darker.
//!
//! Light that passes leaves of random orientation dies off as exp(−½ ρ s), ρ being their area a volume and s the way
//! (M. Monsi, T. Saeki, 1953; G = ½ for spherical leaf angles). A coarse grid of ρ is marched in a few directions.

use bevy::math::Vec3;

use super::source::{CrownMesh, CrownTriangle};
use crate::slicing::orientation::Orientations;

/// Cells along the longest side of the grid.
const CELLS: f32 = 20.0;
/// Directions that light is looked for in.
const DIRECTIONS: u32 = 16;

struct Grid {
    low: Vec3,
    cell: f32,
    size: [usize; 3],
    /// ½ ρ, in 1/m.
    extinction: Vec<f32>,
}

impl Grid {
    /// The cell at a place from the grid's low corner, in cells.
    fn index(&self, place: Vec3) -> Option<usize> {
        let cell = place.floor();
        let mut index = 0;
        for (x, size) in cell.to_array().into_iter().zip(self.size).rev() {
            if !(x >= 0.0 && x < size as f32) {
                return None;
            }
            index = index * size + x as usize;
        }
        Some(index)
    }

    /// A position in cells from the grid's low corner. Steps of a cell move it however far from the origin the crown is.
    fn place(&self, at: Vec3) -> Vec3 {
        (at - self.low) / self.cell
    }

    fn new(mesh: &CrownMesh) -> Option<Self> {
        let (low, high) = mesh.bounds()?;
        let longest = (high - low).max_element();
        let cell = longest / CELLS;
        if cell <= 0.0 {
            return None;
        }
        let size = ((high - low) / cell).to_array().map(|x| x as usize + 1);
        let mut grid = Self {
            low,
            cell,
            size,
            extinction: vec![0.0; size.iter().product()],
        };
        for triangle in &mesh.triangles {
            if let Some(index) = grid.index(grid.place(triangle.centroid())) {
                grid.extinction[index] += 0.5 * triangle.area() / (cell * cell * cell);
            }
        }
        Some(grid)
    }

    /// The share of light from all around that reaches a place.
    fn light(&self, at: Vec3, directions: &[Vec3]) -> f32 {
        let sum: f32 = directions
            .iter()
            .map(|direction| {
                let mut depth = 0.0;
                // A cell on the way at first, so that what hangs beside a leaf does not count as above it.
                let mut place = self.place(at) + *direction;
                while let Some(index) = self.index(place) {
                    depth += self.extinction[index] * self.cell;
                    place += *direction;
                }
                (-depth).exp()
            })
            .sum();
        sum / directions.len() as f32
    }
}

/// The share of light from around, 0 to 1, that comes to each triangle.
pub(super) fn light_from_around(mesh: &CrownMesh) -> Vec<f32> {
    let Some(grid) = Grid::new(mesh) else {
        return vec![1.0; mesh.triangles.len()];
    };
    let directions = Orientations::Sphere(DIRECTIONS).directions();
    let light = |triangle: &CrownTriangle| grid.light(triangle.centroid(), &directions);
    mesh.triangles.iter().map(light).collect()
}
