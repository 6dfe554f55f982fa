//! Maps: what the surfaces of the plants look like, painted by code.
//!
//! A map tiles. u runs once round the limb, v along it, once in a texture length of the limb's joints (divided by
//! [`Finish::repeats`]); row 0 of the pixels is v = 0, the lower end. Colours are the skin's own, in daylight and
//! without its shadows. The relief height w is 0 on the inner frustum of the shell and 1 on the outer (§3 of the
//! frusta paper); most of a limb is near 1, so that limbs look as thick as their joints say.
//!
//! Every surface is a function of (u, v) ([`Paint::at`]); [`Maps::paint`] averages 9 samples a pixel, and nothing in a
//! height map is thinner than a few pixels, so that neither the pixels nor a march through the shell miss anything.
//!
//! Paint needs sums and products, square roots, and for a few kinds a sine or exponential; two machines differ by
//! one level of 255 at most.
//!
//! # The files here, in reading order
//! `noise`, then a file for each family of surfaces, `finish` (thickness, roughness and the like) and `files` (PNG).

mod bark;
mod cactus;
#[cfg(feature = "lab")]
mod files;
mod finish;
mod leaf;
mod noise;
mod palm;
mod roof;
mod stone;
mod succulent;
#[cfg(test)]
mod testing;
mod timber;

use core::f32::consts::TAU;

use bevy::math::{Vec2, Vec3};

#[cfg(feature = "lab")]
pub use files::{MapFileError, compare, paint_all};
pub use finish::Finish;

use super::Surface;

/// Samples of a pixel along u, and along v.
const SAMPLES: u32 = 3;

/// Every kind of surface that there are maps for, and the name of its files.
pub const SURFACES: [(Surface, &str); 19] = [
    (Surface::PalmTrunk, "palm_trunk"),
    (Surface::PalmLeaf, "palm_leaf"),
    (Surface::Coconut, "coconut"),
    (Surface::PineBark, "pine_bark"),
    (Surface::PineNeedles, "pine_needles"),
    (Surface::ElmBark, "elm_bark"),
    (Surface::AloeLeaf, "aloe_leaf"),
    (Surface::SaguaroSkin, "saguaro_skin"),
    (Surface::BarrelCactusSkin, "barrel_cactus_skin"),
    (Surface::OcotilloCane, "ocotillo_cane"),
    (Surface::OcotilloFlower, "ocotillo_flower"),
    (Surface::GrassBlade, "grass_blade"),
    (Surface::Stone, "stone"),
    (Surface::Masonry, "masonry"),
    (Surface::Timber, "timber"),
    (Surface::RoofTile, "roof_tile"),
    (Surface::Rope, "rope"),
    (Surface::WellShaft, "well_shaft"),
    (Surface::Water, "water"),
];

/// A surface at one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Paint {
    /// Diffuse colour: linear red, green and blue, each 0..1.
    pub color: Vec3,
    /// Relief height, 0 (inner) to 1 (outer).
    pub height: f32,
}

impl Paint {
    /// The surface of this kind at (u, v), which repeats with every whole number.
    pub fn at(kind: Surface, uv: Vec2) -> Self {
        match kind {
            Surface::PalmTrunk => palm::trunk(uv),
            Surface::PalmLeaf => leaf::palm(uv),
            Surface::Coconut => palm::husk(uv),
            Surface::PineBark => bark::pine(uv),
            Surface::PineNeedles => leaf::needle(uv),
            Surface::ElmBark => bark::elm(uv),
            Surface::AloeLeaf => succulent::aloe(uv),
            Surface::SaguaroSkin => cactus::saguaro(uv),
            Surface::BarrelCactusSkin => cactus::barrel(uv),
            Surface::OcotilloCane => succulent::cane(uv),
            Surface::OcotilloFlower => succulent::flower(uv),
            Surface::GrassBlade => leaf::grass(uv),
            Surface::Stone => stone::boulder(uv),
            Surface::Masonry => stone::masonry(uv),
            Surface::Timber => timber::post(uv),
            Surface::RoofTile => roof::tiles(uv),
            Surface::Rope => timber::rope(uv),
            Surface::WellShaft => stone::shaft(uv),
            Surface::Water => stone::water(uv),
        }
    }

    fn new(color: Vec3, height: f32) -> Self {
        let color = color.clamp(Vec3::ZERO, Vec3::ONE);
        let height = knee(1.0 - knee(1.0 - height));
        Self { color, height }
    }

    /// Without relief: the outer surface.
    fn flat(color: Vec3) -> Self {
        Self {
            height: 1.0,
            ..Self::new(color, 1.0)
        }
    }
}

/// The maps of a surface, pixel by pixel, row 0 at v = 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Maps {
    /// Width and length in pixels.
    pub size: [u32; 2],
    /// sRGB, and opaque.
    pub color: Vec<[u8; 4]>,
    /// Relief heights, linear: 0 inner, 255 outer. `None` for leaves, whose shape is all of their relief.
    pub height: Option<Vec<u8>>,
}

impl Maps {
    /// Paints the maps of a kind of surface, in the size of its [`Finish`].
    pub fn paint(kind: Surface) -> Self {
        let finish = Finish::of(kind);
        let [width, length] = finish.size;
        let size = Vec2::new(width as f32, length as f32);
        let pixels =
            || (0..length).flat_map(|y| (0..width).map(move |x| Vec2::new(x as f32, y as f32)));
        let (mut colors, mut heights) = (Vec::new(), Vec::new());
        for pixel in pixels() {
            let (mut color, mut height) = (Vec3::ZERO, 0.0);
            for i in 0..SAMPLES * SAMPLES {
                let at = Vec2::new((i % SAMPLES) as f32, (i / SAMPLES) as f32) + 0.5;
                let paint = Paint::at(kind, (pixel + at / SAMPLES as f32) / size);
                color += paint.color;
                height += paint.height;
            }
            let share = 1.0 / (SAMPLES * SAMPLES) as f32;
            let [r, g, b] = (color * share).to_array().map(srgb);
            colors.push([r, g, b, 255]);
            heights.push((height * share * 255.0).round() as u8);
        }
        Self {
            size: finish.size,
            color: colors,
            height: finish.thickness.map(|_| heights),
        }
    }
}

/// `x` where it is below 0.9, then ever less, towards 1: cutting it off would leave flat spots with an edge.
fn knee(x: f32) -> f32 {
    let over = (x - 0.9).max(0.0);
    x - over + 0.1 * over / (0.1 + over)
}

/// A linear value, 0..1, in sRGB (IEC 61966-2-1), 0 to 255. Even levels only, which nobody sees and which makes files a
/// fifth smaller.
fn srgb(linear: f32) -> u8 {
    let encoded = if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * linear.powf(1.0 / 2.4) - 0.055
    };
    2 * (encoded * 127.5).round().min(127.0) as u8
}

/// A wave of period 1 and of height 1, with its crest at 0.
fn ripple(t: f32) -> f32 {
    (t * TAU).cos()
}
