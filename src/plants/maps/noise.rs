//! Noise that repeats: value and gradient noise on a square lattice (K. Perlin, *An Image Synthesizer*, 1985, and
//! *Improving Noise*, 2002) and cells (S. Worley, *A Cellular Texture Basis Function*, 1996).
//!
//! Random numbers come from integers, and what is left is sums and products, so that all machines agree.

use bevy::math::{IVec2, Vec2};

/// A lattice over a map, with a random number at each of its points; whatever it makes repeats with the map.
#[derive(Clone, Copy, Debug)]
pub(super) struct Noise {
    /// Lattice cells in a map, along u and v.
    cells: IVec2,
    seed: u32,
}

/// Where a point lies among the cells of a lattice, one round a site in every square (see [`Noise::cell`]).
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    /// The cell's own random number.
    pub id: u32,
    /// From the cell's site to the point, in lattice cells.
    pub offset: Vec2,
    /// From the point to the border with the nearest other cell.
    pub edge: f32,
}

impl Noise {
    /// A lattice of `u` by `v` cells.
    pub const fn new(u: i32, v: i32, seed: u32) -> Self {
        let cells = IVec2::new(u, v);
        Self { cells, seed }
    }

    /// The random number of a lattice point.
    pub fn id(self, point: IVec2) -> u32 {
        let point = point.rem_euclid(self.cells);
        let key = self.seed.wrapping_mul(0x9e37_79b9);
        scrambled(scrambled(key ^ point.x as u32) ^ point.y as u32)
    }

    /// The lattice square of a point of the map, and the place in it, each 0..1.
    fn locate(self, uv: Vec2) -> (IVec2, Vec2) {
        let point = uv * self.cells.as_vec2();
        let square = point.floor();
        (square.as_ivec2(), point - square)
    }

    /// Smooth noise in 0..1, random at each lattice point.
    pub fn value(self, uv: Vec2) -> f32 {
        let (square, at) = self.locate(uv);
        blend(at, |corner| unit(self.id(square + corner)))
    }

    /// Smooth noise in -1..1, zero at each lattice point with a random slope there: no blocks, unlike `value`.
    pub fn gradient(self, uv: Vec2) -> f32 {
        let (square, at) = self.locate(uv);
        let sum = blend(at, |corner| {
            let id = self.id(square + corner);
            let slope = Vec2::new(unit(id), unit(again(id, 1))) * 2.0 - 1.0;
            slope.dot(at - corner.as_vec2())
        });
        // Slopes are at most √2 and corners 1/√2 away where all four count alike.
        (sum * 1.6).clamp(-1.0, 1.0)
    }

    /// Gradient noise and finer copies of it, each twice as fine and half as high; about -1..1.
    pub fn fractal(self, uv: Vec2, octaves: u32) -> f32 {
        let octave = |i: u32| {
            let finer = Self {
                cells: self.cells << i,
                seed: self.seed.wrapping_add(i * 101),
            };
            // Apart, else all octaves are zero at the same points, and the lattice shows.
            let apart = Vec2::new(0.3719, 0.6133) * i as f32;
            finer.gradient(uv + apart) / (1 << i) as f32
        };
        (0..octaves).map(octave).sum()
    }

    /// The site of a square: its random number, and where it lies from the square's lower corner. Sites stray from
    /// the middle by `stray` (0: a grid, 1: anywhere).
    fn site(self, square: IVec2, stray: f32) -> (u32, Vec2) {
        let id = self.id(square);
        let place = Vec2::new(unit(again(id, 2)), unit(again(id, 3)));
        (id, Vec2::splat(0.5) + (place - 0.5) * stray)
    }

    /// The Voronoi cell of a point among sites that [`stray`](Self::site). Distances are in lattice cells; that to the
    /// edge is stretched by `metric`, along u for upright edges and along v for level ones, so that edges look as
    /// broad one way as the other where lattice cells are not square.
    pub fn cell(self, uv: Vec2, stray: f32, metric: Vec2) -> Cell {
        let (square, at) = self.locate(uv);
        let sites: [(u32, Vec2); 25] = core::array::from_fn(|i| {
            let near = IVec2::new(i as i32 % 5 - 2, i as i32 / 5 - 2);
            let (id, place) = self.site(square + near, stray);
            (id, at - near.as_vec2() - place)
        });
        let mut nearest = sites[0];
        for site in sites {
            if site.1.length_squared() < nearest.1.length_squared() {
                nearest = site;
            }
        }
        let (id, offset) = nearest;
        let mut edge = f32::INFINITY;
        for (_, from) in sites {
            // The border is the perpendicular bisector of the two sites.
            let between = offset - from;
            let apart = between.length();
            if apart > 1e-4 {
                let normal = between / apart;
                let distance = -((offset + from) * 0.5).dot(normal);
                edge = edge.min(distance * (normal * metric).length());
            }
        }
        let edge = edge.max(0.0);
        Cell { id, offset, edge }
    }

    /// The strongest of the marks left by the sites around, each anywhere in its square. A mark is given the way from
    /// its site, in lattice cells, and the site's random number; more than a cell away it must be 0 or less.
    pub fn marks(self, uv: Vec2, mark: impl Fn(Vec2, u32) -> f32) -> f32 {
        let (square, at) = self.locate(uv);
        let mut strongest = 0.0_f32;
        for i in 0..9 {
            let near = IVec2::new(i % 3 - 1, i / 3 - 1);
            let (id, place) = self.site(square + near, 1.0);
            strongest = strongest.max(mark(at - near.as_vec2() - place, id));
        }
        strongest
    }
}

/// A slit along v for [`Noise::marks`], pointed at both ends: 1 in its middle, 0 from its sides on. `half` are half
/// its width and half its length, at most a cell each; slits differ in length by up to a half.
pub(super) fn slit(from: Vec2, id: u32, half: Vec2) -> f32 {
    let t = from.y / (half.y * (0.5 + 0.5 * unit(again(id, 4))));
    let width = half.x * (1.0 - t * t);
    if width <= 0.0 {
        return 0.0;
    }
    let t = ((from.x.abs() / width - 0.25) / 0.75).clamp(0.0, 1.0);
    // Shallower where it is narrow.
    (1.0 - t * t * (3.0 - 2.0 * t)) * (width / half.x).sqrt()
}

/// Interpolates between the four corners of a square by a quintic, so that slopes and curvatures go on.
fn blend(at: Vec2, corner: impl Fn(IVec2) -> f32) -> f32 {
    let t = at * at * at * (at * (at * 6.0 - 15.0) + 10.0);
    let row = |y| {
        let (left, right) = (corner(IVec2::new(0, y)), corner(IVec2::new(1, y)));
        left + (right - left) * t.x
    };
    let (low, high) = (row(0), row(1));
    low + (high - low) * t.y
}

/// A bijection of the 32-bit numbers that spreads every bit over all (the finaliser of MurmurHash3).
const fn scrambled(mut x: u32) -> u32 {
    x = x.wrapping_add(0x7f4a_7c15);
    x = (x ^ (x >> 16)).wrapping_mul(0x85eb_ca6b);
    x = (x ^ (x >> 13)).wrapping_mul(0xc2b2_ae35);
    x ^ (x >> 16)
}

/// Another random number for the same thing.
pub(super) const fn again(id: u32, which: u32) -> u32 {
    scrambled(id ^ which.wrapping_mul(0x9e37_79b9))
}

/// The number in 0..1 that a random number stands for.
pub(super) const fn unit(id: u32) -> f32 {
    (id >> 8) as f32 / (1_u32 << 24) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points() -> impl Iterator<Item = Vec2> {
        (0..400).map(|i| Vec2::new(unit(again(i, 5)), unit(again(i, 6))))
    }

    #[test]
    fn noise_repeats_with_the_map() {
        let noise = Noise::new(5, 3, 9);
        for uv in points() {
            for turn in [Vec2::X, Vec2::Y, -Vec2::ONE] {
                // Places are rounded to 2⁻²³ of a map, and slopes are at most 3 a lattice cell, 5 cells a map.
                let same = |a: f32, b: f32| assert!((a - b).abs() < 1e-5, "{a} {b} at {uv}");
                same(noise.value(uv), noise.value(uv + turn));
                same(noise.gradient(uv), noise.gradient(uv + turn));
                same(
                    noise.cell(uv, 1.0, Vec2::ONE).edge,
                    noise.cell(uv + turn, 1.0, Vec2::ONE).edge,
                );
            }
        }
    }

    #[test]
    fn noise_is_in_range_and_centred() {
        let noise = Noise::new(32, 32, 4);
        let (mut value, mut gradient) = (0.0, 0.0);
        for uv in points() {
            assert!((0.0..=1.0).contains(&noise.value(uv)));
            value += noise.value(uv) / 400.0;
            gradient += noise.gradient(uv) / 400.0;
        }
        // Standard deviations of one sample are under 0.3 and 0.45; the mean of 400 has a twentieth, five of them.
        assert!((value - 0.5).abs() < 0.075, "{value}");
        assert!(gradient.abs() < 0.12, "{gradient}");
    }

    #[test]
    fn the_edge_of_a_cell_is_as_far_as_it_says() {
        let noise = Noise::new(6, 6, 2);
        for uv in points() {
            let here = noise.cell(uv, 0.9, Vec2::ONE);
            // Nothing within that distance belongs to another cell.
            for (x, y) in [(1.0, 0.0), (0.0, 1.0), (-0.8, 0.6), (0.6, -0.8)] {
                let near = uv + Vec2::new(x, y) * (here.edge * 0.999 / 6.0);
                let there = noise.cell(near, 0.9, Vec2::ONE);
                assert!(there.id == here.id || here.edge < 1e-4);
            }
        }
    }
}
