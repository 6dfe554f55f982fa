//! Patterns that need no file: those of the paper's pictures, and cover that a game may take as it is.

use core::f32::consts::{PI, TAU};

use crate::plants::Dice;
use crate::texel::build::{
    Built, Filling, HeightField, Shape, ShapeSettings, Spreading, VolumeSettings,
    from_height_field, from_hypertexture, from_shape,
};
use crate::texel::color::srgb_to_linear;
use crate::texel::{Progress, TexelError, Topology};
use bevy::math::{IVec2, UVec2, UVec3, Vec2, Vec3};
use clap::Subcommand;

/// One of them; a command of `bake_texel` each.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Subcommand)]
pub enum Pattern {
    /// A pear of about 1,000 triangles, filled (§6, Figure 10).
    Pear,
    /// A bush of 3,500 triangles, left unfilled (§6, Figure 11).
    Bush,
    /// Blades of grass that tile, left unfilled.
    Grass,
    /// A height field of Perlin noise that tiles (§6, Figure 12).
    Noise,
    /// Strands of fur that tile: a hypertexture.
    Fur,
    /// Reeds and bulrushes that tile, at one of 8 moments of their sway: a hypertexture.
    Reeds {
        /// Which moment; after the last the first comes again.
        #[arg(long, default_value_t = 0)]
        moment: u32,
    },
}

/// Moments of a sway of [`Pattern::Reeds`].
pub(super) const REED_MOMENTS: u32 = 8;

impl Pattern {
    /// The size that it is baked at.
    pub const fn size(self) -> UVec3 {
        match self {
            Self::Pear => UVec3::splat(64),
            Self::Bush | Self::Noise => UVec3::new(256, 256, 64),
            Self::Grass => UVec3::new(256, 256, 64),
            Self::Fur => UVec3::new(128, 128, 32),
            // There are eight of them on the GPU.
            Self::Reeds { .. } => UVec3::new(64, 64, 32),
        }
    }

    /// Builds it.
    pub fn build(
        self,
        size: UVec3,
        spreading: Spreading,
        progress: Progress,
    ) -> Result<Built, TexelError> {
        let field = |lengths| VolumeSettings {
            lengths,
            spreading,
            ..VolumeSettings::new(size)
        };
        let leaves = |bounds, topology| ShapeSettings {
            bounds,
            topology,
            filling: Filling::None,
            ..ShapeSettings::new(size)
        };
        match self {
            Self::Pear => {
                let settings = ShapeSettings {
                    spreading,
                    ..ShapeSettings::new(size)
                };
                from_shape(&pear(), &settings, progress)
            }
            Self::Bush => from_shape(&bush(), &leaves(None, Topology::Isolated), progress),
            Self::Grass => {
                let settings = leaves(Some(GRASS_BOX), Topology::Tiling);
                from_shape(&grass(), &settings, progress)
            }
            Self::Noise => from_height_field(
                &noise(size.truncate()),
                &field(Vec3::new(1.0, 1.0, 0.3)),
                progress,
            ),
            Self::Fur => from_hypertexture(fur(), &field(Vec3::new(0.1, 0.1, 0.03)), progress),
            Self::Reeds { moment } => {
                from_hypertexture(reeds(moment), &field(Vec3::new(1.0, 1.0, 0.9)), progress)
            }
        }
    }
}

impl Pattern {
    /// Whether it is leaves, and not solid.
    pub(super) const fn is_open(self) -> bool {
        matches!(self, Self::Bush | Self::Grass)
    }

    /// The triangles that it is built of, and the box that is sliced, if it is not the shape's own. Hypertextures have
    /// none.
    pub(super) fn shape(self, size: UVec3) -> Option<(Shape, Option<[Vec3; 2]>)> {
        match self {
            Self::Pear => Some((pear(), None)),
            Self::Bush => Some((bush(), None)),
            Self::Grass => Some((grass(), Some(GRASS_BOX))),
            Self::Noise => {
                let field = triangulated(&noise(size.truncate()));
                Some((field, Some([Vec3::ZERO, Vec3::ONE])))
            }
            Self::Fur | Self::Reeds { .. } => None,
        }
    }
}

/// A height field as triangles in texture space, with a vertex in the middle of each pixel.
fn triangulated(field: &HeightField) -> Shape {
    let mut shape = Shape::default();
    let size = field.size;
    for (i, (height, color)) in (0..).zip(field.heights.iter().zip(&field.colors)) {
        let pixel = UVec2::new(i % size.x, i / size.x).as_vec2();
        shape
            .positions
            .push(((pixel + 0.5) / size.as_vec2()).extend(*height));
        let linear = color.map(|byte| srgb_to_linear(f32::from(byte) / 255.0));
        shape.colors.push(Vec3::from(linear).extend(1.0));
    }
    for (x, y) in (0..size.y - 1).flat_map(|y| (0..size.x - 1).map(move |x| (x, y))) {
        let a = y * size.x + x;
        let c = a + size.x;
        shape.triangles.extend([[a, a + 1, c + 1], [a, c + 1, c]]);
    }
    shape
}

/// Grass tiles, and leans over this box.
const GRASS_BOX: [Vec3; 2] = [Vec3::ZERO, Vec3::new(1.0, 1.0, 0.35)];

/// A solid of revolution with a stalk.
fn pear() -> Shape {
    const RINGS: u32 = 31;
    const SECTORS: u32 = 16;
    let mut shape = Shape::default();
    let skin = |height: f32, turn: f32| {
        let sunny = (0.5 + 0.5 * (turn - 0.6).cos()) * (1.0 - height).clamp(0.0, 1.0);
        let green = Vec3::new(0.35, 0.50, 0.06);
        green.lerp(
            Vec3::new(0.75, 0.16, 0.03),
            (sunny * 1.1 - 0.1).clamp(0.0, 1.0),
        )
    };
    // Half the width at a height: a belly and a neck, closed at both ends, with a stalk on top.
    let width = |t: f32| {
        let body = (PI * t.powf(0.8)).sin().max(0.0).powf(0.6) * (0.42 - 0.22 * t);
        if t < 0.93 { body } else { body.min(0.025) }
    };
    for ring in 0..=RINGS {
        let t = ring as f32 / RINGS as f32;
        for sector in 0..SECTORS {
            let turn = sector as f32 / SECTORS as f32 * TAU;
            let closed = ring == 0 || ring == RINGS;
            let radius = if closed { 0.0 } else { width(t) };
            let height = if t < 0.93 { t } else { 0.93 + (t - 0.93) * 2.5 };
            shape
                .positions
                .push(Vec3::new(radius * turn.cos(), radius * turn.sin(), height));
            let color = if t > 0.93 {
                Vec3::new(0.08, 0.05, 0.02)
            } else {
                skin(t, turn)
            };
            shape.colors.push(color.extend(1.0));
        }
    }
    for ring in 0..RINGS {
        for sector in 0..SECTORS {
            let index = |ring: u32, sector: u32| ring * SECTORS + sector % SECTORS;
            let [a, b] = [index(ring, sector), index(ring, sector + 1)];
            let [c, d] = [index(ring + 1, sector), index(ring + 1, sector + 1)];
            shape.triangles.extend([[a, b, c], [b, d, c]]);
        }
    }
    smooth(&mut shape);
    shape
}

/// Normals of vertices, from the triangles round them weighted by area.
fn smooth(shape: &mut Shape) {
    shape.normals = vec![Vec3::ZERO; shape.positions.len()];
    for triangle in &shape.triangles {
        let [a, b, c] = triangle.map(|i| shape.positions[i as usize]);
        for &vertex in triangle {
            shape.normals[vertex as usize] += (b - a).cross(c - a);
        }
    }
}

/// Adds a leaf: two triangles from `root` along `along`, as wide as `across`.
fn leaf(shape: &mut Shape, root: Vec3, along: Vec3, across: Vec3, colors: [Vec3; 2]) {
    let first = shape.positions.len() as u32;
    let middle = root + along * 0.5;
    shape
        .positions
        .extend([root, middle - across, middle + across, root + along]);
    shape.colors.extend(
        [
            colors[0],
            colors[0].midpoint(colors[1]),
            colors[0].midpoint(colors[1]),
            colors[1],
        ]
        .map(|color| color.extend(1.0)),
    );
    shape.triangles.extend([
        [first, first + 1, first + 2],
        [first + 1, first + 3, first + 2],
    ]);
}

/// 1,750 leaves round a dome, which face outward.
fn bush() -> Shape {
    let mut shape = Shape::default();
    let mut dice = Dice::new(5);
    for _ in 0..1750 {
        let (turn, rise) = (dice.angle(), dice.roll());
        let out = Vec3::new(
            turn.cos() * (1.0 - rise * rise).sqrt(),
            turn.sin() * (1.0 - rise * rise).sqrt(),
            rise,
        );
        let depth = dice.roll();
        let place = out * Vec3::new(0.45, 0.45, 0.6) * (1.0 - 0.6 * depth * depth) + Vec3::Z * 0.05;
        let along =
            (out + Vec3::new(dice.jitter(0.7), dice.jitter(0.7), dice.jitter(0.7))).normalize();
        let across = along
            .cross(out + Vec3::new(dice.jitter(0.5), dice.jitter(0.5), 0.1))
            .normalize_or(Vec3::X);
        let length = dice.between(0.05, 0.08);
        // Deeper leaves are in the shade.
        let light = (1.0 - 0.75 * depth) * dice.between(0.7, 1.2);
        let green = Vec3::new(dice.between(0.08, 0.16), 0.28, 0.04) * light;
        leaf(
            &mut shape,
            place,
            along * length,
            across * length * 0.28,
            [green * 0.8, green * 1.2],
        );
    }
    shape
}

/// Blades that stand on a square metre and lean over its borders.
fn grass() -> Shape {
    let mut shape = Shape::default();
    let mut dice = Dice::new(11);
    for _ in 0..1800 {
        let root = Vec3::new(dice.roll(), dice.roll(), 0.0);
        let height = dice.between(0.12, 0.33);
        let lean = Vec2::from_angle(dice.angle()) * dice.between(0.04, 0.26);
        let across = Vec2::from_angle(dice.angle()).extend(0.0) * dice.between(0.005, 0.009);
        let green = Vec3::new(dice.between(0.07, 0.22), dice.between(0.24, 0.34), 0.03);
        let point = |t: f32| root + (lean * t * t).extend(height * t);
        let first = shape.positions.len() as u32;
        for step in 0..3 {
            let t = step as f32 / 3.0;
            let half = across * (1.0 - t);
            let color = (green * (0.25 + 0.75 * t)).extend(1.0);
            shape.positions.extend([point(t) - half, point(t) + half]);
            shape.colors.extend([color; 2]);
        }
        shape.positions.push(point(1.0));
        shape.colors.push(green.extend(1.0));
        for step in 0..2 {
            let a = first + step * 2;
            shape
                .triangles
                .extend([[a, a + 1, a + 2], [a + 1, a + 3, a + 2]]);
        }
        shape.triangles.push([first + 4, first + 5, first + 6]);
    }
    shape
}

/// Gradient noise that repeats with 1 (K. Perlin, *An Image Synthesizer*, 1985), with `cells` lattice cells.
fn perlin(cells: i32, seed: u64) -> impl Fn(Vec2) -> f32 {
    let mut dice = Dice::new(seed);
    let slopes: Vec<Vec2> = (0..cells * cells)
        .map(|_| Vec2::from_angle(dice.angle()))
        .collect();
    move |uv: Vec2| {
        let place = uv * cells as f32;
        let (square, at) = (place.floor(), place.fract_gl());
        let corner = |x: i32, y: i32| {
            let (cx, cy) = (square.x as i32 + x, square.y as i32 + y);
            let index = cy.rem_euclid(cells) * cells + cx.rem_euclid(cells);
            slopes[index as usize].dot(at - Vec2::new(x as f32, y as f32))
        };
        let t = at * at * at * (at * (at * 6.0 - 15.0) + 10.0);
        let row = |y| corner(0, y) + (corner(1, y) - corner(0, y)) * t.x;
        row(0) + (row(1) - row(0)) * t.y
    }
}

/// Rocky ground.
fn noise(size: UVec2) -> HeightField {
    let octaves: Vec<_> = (0..5)
        .map(|i| (perlin(4 << i, 3 + i as u64), 0.5f32.powi(i)))
        .collect();
    let mut heights = Vec::new();
    let mut colors = Vec::new();
    for y in 0..size.y {
        for x in 0..size.x {
            let uv = (Vec2::new(x as f32, y as f32) + 0.5) / size.as_vec2();
            let sum: f32 = octaves
                .iter()
                .map(|(noise, height)| noise(uv) * height)
                .sum();
            let height = (0.45 + 0.6 * sum).clamp(0.02, 1.0);
            heights.push(height);
            // Darker with depth, as in the paper.
            let ochre =
                Vec3::new(0.62, 0.52, 0.38).lerp(Vec3::new(0.86, 0.84, 0.80), height * height);
            let color = (ochre * (0.35 + 0.65 * height)).clamp(Vec3::ZERO, Vec3::ONE) * 255.0;
            colors.push(color.round().as_u8vec3().to_array());
        }
    }
    HeightField {
        colors,
        ..HeightField::new(size, heights, [0; 3])
    }
}

/// Strands on a jittered lattice, which bend to one side and thin out.
fn fur() -> impl Fn(Vec3) -> (f32, Vec3) + Sync {
    const CELLS: i32 = 22;
    let mut dice = Dice::new(2);
    let strands: Vec<[f32; 5]> = (0..CELLS * CELLS)
        .map(|_| {
            [
                dice.roll(),
                dice.roll(),
                dice.between(0.6, 1.0),
                dice.jitter(0.5),
                dice.between(0.6, 1.0),
            ]
        })
        .collect();
    move |at: Vec3| {
        let bend = Vec2::new(4.0, 1.2) * at.z * at.z;
        let place = at.truncate() * CELLS as f32 - bend;
        let square = place.floor().as_ivec2();
        let mut best = (0.0f32, Vec3::ZERO);
        for near in (0..9).map(|i| IVec2::new(i % 3 - 1, i / 3 - 1)) {
            let cell = square + near;
            let index = cell.y.rem_euclid(CELLS) * CELLS + cell.x.rem_euclid(CELLS);
            let [x, y, length, sway, shade] = strands[index as usize];
            let root = cell.as_vec2() + Vec2::new(x, y) + Vec2::new(sway, -sway) * at.z;
            let radius = 0.48 * (1.0 - at.z / length).max(0.0).powf(0.4);
            let density = 0.5 + (radius - place.distance(root)) * 2.0;
            if density > best.0 {
                let color = Vec3::new(0.55, 0.30, 0.12) * shade * (0.45 + 0.75 * at.z);
                best = (density, color);
            }
        }
        // The hide.
        if at.z < 0.04 && best.0 < 0.5 {
            best = (1.0, Vec3::new(0.18, 0.11, 0.055));
        }
        best
    }
}

/// A reed, or a bulrush with its brown head.
struct Reed {
    /// Where on its lattice cell it stands.
    root: Vec2,
    /// Its height, as a share of all.
    height: f32,
    is_bulrush: bool,
    shade: f32,
}

/// Reeds on a jittered lattice, in waves of wind of which one is as long as a texel.
fn reeds(moment: u32) -> impl Fn(Vec3) -> (f32, Vec3) + Sync {
    const CELLS: i32 = 6;
    let turn = (moment % REED_MOMENTS) as f32 / REED_MOMENTS as f32;
    let mut dice = Dice::new(13);
    let reeds: Vec<Reed> = (0..CELLS * CELLS)
        .map(|_| Reed {
            root: Vec2::new(dice.roll(), dice.roll()),
            height: dice.between(0.6, 0.98),
            is_bulrush: dice.roll() < 0.35,
            shade: dice.between(0.7, 1.1),
        })
        .collect();
    move |at: Vec3| {
        let place = at.truncate() * CELLS as f32;
        let square = place.floor().as_ivec2();
        let mut best = (0.0f32, Vec3::ZERO);
        // As far as the tallest leans.
        for near in (0..25).map(|i| IVec2::new(i % 5 - 2, i / 5 - 2)) {
            let cell = square + near;
            let index = cell.y.rem_euclid(CELLS) * CELLS + cell.x.rem_euclid(CELLS);
            let reed = &reeds[index as usize];
            let root = cell.as_vec2() + reed.root;
            let (sin, cos) = (TAU * (turn - root.x / CELLS as f32)).sin_cos();
            let lean = Vec2::new(0.3 + sin, 0.3 * cos) * at.z * at.z;
            let (radius, color) = reed.at(at.z);
            let density = 0.5 + (radius - place.distance(root + lean)) * 2.0;
            if density > best.0 {
                best = (density, color * reed.shade);
            }
        }
        best
    }
}

impl Reed {
    /// Its radius at a height, in lattice cells, and its colour there.
    fn at(&self, height: f32) -> (f32, Vec3) {
        let share = height / self.height;
        let green = Vec3::new(0.12, 0.26, 0.04) * (0.3 + 0.7 * height);
        let left = (1.0 - share).max(0.0);
        if !self.is_bulrush {
            return (0.19 * left.sqrt(), green);
        }
        // Round at both ends.
        let head = 1.0 - ((share - 0.8) / 0.14).powi(4);
        if head > 0.0 {
            (0.26 * head.sqrt(), Vec3::new(0.17, 0.07, 0.025))
        } else {
            (if share < 1.0 { 0.11 } else { 0.0 }, green)
        }
    }
}
