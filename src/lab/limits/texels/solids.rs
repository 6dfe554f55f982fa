//! Closed shapes of triangles, and whether a point is in them.

use core::f32::consts::{PI, TAU};

use bevy::math::{Quat, Vec3};

use crate::texel::build::Shape;

/// A shape in the unit cube.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Solid {
    /// A ball.
    Ball,
    /// An upright ring.
    Ring,
    /// Two balls that reach into each other.
    TwoBalls,
    /// A box on end, some turns aside.
    LeaningBox,
    /// A plate over a box, an 83rd of the cube thick: below two voxels of 128.
    Plate,
}

/// Steps round what is round: the polygons are off by less than a tenth of a voxel of 128.
const STEPS: u32 = 64;
/// Centres and radius of the balls.
pub(super) const BALLS: [Vec3; 2] = [Vec3::new(0.4, 0.5, 0.4), Vec3::new(0.6, 0.5, 0.6)];
pub(super) const RADIUS: f32 = 0.25;
/// Radii of the ring: to the middle of its tube, and of that.
const RING: [f32; 2] = [0.28, 0.12];

impl Solid {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Ball,
        Self::Ring,
        Self::TwoBalls,
        Self::LeaningBox,
        Self::Plate,
    ];

    /// What it is called.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Ball => "ball",
            Self::Ring => "upright ring",
            Self::TwoBalls => "two balls in one another",
            Self::LeaningBox => "leaning box",
            Self::Plate => "thin plate over a box",
        }
    }

    /// Its triangles.
    pub fn shape(self) -> Shape {
        let mut shape = Shape::default();
        match self {
            Self::Ball => add_ball(&mut shape, Vec3::splat(0.5)),
            Self::Ring => add_ring(&mut shape),
            Self::TwoBalls => {
                for centre in BALLS {
                    add_ball(&mut shape, centre);
                }
            }
            Self::LeaningBox | Self::Plate => {
                for cuboid in self.cuboids() {
                    cuboid.add_to(&mut shape);
                }
            }
        }
        shape
    }

    /// The distance of a point from its surface, negative inside.
    pub fn distance(self, at: Vec3) -> f32 {
        let ball = |centre: Vec3| at.distance(centre) - RADIUS;
        match self {
            Self::Ball => ball(Vec3::splat(0.5)),
            Self::TwoBalls => ball(BALLS[0]).min(ball(BALLS[1])),
            Self::Ring => {
                let from = at - 0.5;
                let out = from.y.hypot(from.z) - RING[0];
                out.hypot(from.x) - RING[1]
            }
            Self::LeaningBox | Self::Plate => {
                let distances = self.cuboids().into_iter().map(|cuboid| cuboid.distance(at));
                distances.fold(f32::INFINITY, f32::min)
            }
        }
    }

    fn cuboids(self) -> Vec<Cuboid> {
        let level = |centre, half| Cuboid {
            centre,
            half,
            turn: Quat::IDENTITY,
        };
        match self {
            Self::LeaningBox => vec![Cuboid {
                turn: Quat::from_rotation_z(0.4) * Quat::from_rotation_x(0.3),
                ..level(Vec3::splat(0.5), Vec3::new(0.2, 0.15, 0.3))
            }],
            Self::Plate => vec![
                level(Vec3::new(0.503, 0.496, 0.3), Vec3::new(0.2, 0.2, 0.15)),
                level(Vec3::new(0.503, 0.496, 0.707), Vec3::new(0.3, 0.3, 0.006)),
            ],
            Self::Ball | Self::Ring | Self::TwoBalls => Vec::new(),
        }
    }
}

/// A box.
struct Cuboid {
    centre: Vec3,
    half: Vec3,
    turn: Quat,
}

impl Cuboid {
    fn add_to(&self, shape: &mut Shape) {
        let first = shape.positions.len() as u32;
        for i in 0..8 {
            let side = |bit: u32| if i >> bit & 1 == 1 { 1.0 } else { -1.0 };
            let corner = Vec3::new(side(0), side(1), side(2)) * self.half;
            shape.positions.push(self.centre + self.turn * corner);
        }
        let faces = [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ];
        for face in faces {
            let [a, b, c, d] = face.map(|i| first + i);
            shape.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }

    fn distance(&self, at: Vec3) -> f32 {
        let from = (self.turn.inverse() * (at - self.centre)).abs() - self.half;
        from.max(Vec3::ZERO).length() + from.max_element().min(0.0)
    }
}

/// Quads between rows and columns that both come round.
fn add_lattice(shape: &mut Shape, columns: u32, rows: u32, place: impl Fn(u32, u32) -> Vec3) {
    let first = shape.positions.len() as u32;
    let index = |column, row| first + row % rows * columns + column % columns;
    for row in 0..rows {
        for column in 0..columns {
            shape.positions.push(place(column, row));
            let [a, b] = [index(column, row), index(column + 1, row)];
            let [c, d] = [index(column, row + 1), index(column + 1, row + 1)];
            shape.triangles.extend([[a, b, d], [a, d, c]]);
        }
    }
}

fn add_ring(shape: &mut Shape) {
    let turn = |step: u32| step as f32 / STEPS as f32 * TAU;
    add_lattice(shape, STEPS, STEPS, |column, row| {
        let out = RING[0] + RING[1] * turn(row).cos();
        let (sin, cos) = turn(column).sin_cos();
        Vec3::new(RING[1] * turn(row).sin(), out * cos, out * sin) + 0.5
    });
}

fn add_ball(shape: &mut Shape, centre: Vec3) {
    let first = shape.positions.len() as u32;
    let row_of = |row: u32| first + row * STEPS;
    for row in 0..=STEPS {
        // Exact at the poles, where all columns must meet.
        let (sin, cos) = match row {
            0 => (0.0, 1.0),
            STEPS => (0.0, -1.0),
            _ => (row as f32 / STEPS as f32 * PI).sin_cos(),
        };
        for column in 0..STEPS {
            let (x, y) = (column as f32 / STEPS as f32 * TAU).sin_cos();
            let out = Vec3::new(sin * y, sin * x, cos);
            shape.positions.push(centre + out * RADIUS);
            if row < STEPS {
                let next = (column + 1) % STEPS;
                let [a, b] = [row_of(row) + column, row_of(row) + next];
                let [c, d] = [row_of(row + 1) + column, row_of(row + 1) + next];
                shape.triangles.extend([[a, c, d], [a, d, b]]);
            }
        }
    }
}
