//! The baked crown: what is promised of it.

use std::sync::Arc;

use bevy::asset::Asset;
use bevy::math::Vec3;
use bevy::reflect::Reflect;

use super::error::SlicingError;
use super::limits::{
    MAX_LAYERS, MAX_LEVELS, MAX_ORIENTATIONS, MAX_PIXELS, MAX_PIXELS_TOTAL, MAX_SLICES,
};
use super::octagon::{Octagon, octagon};
use super::orientation::Orientation;
use super::pyramid::{color_levels, normal_levels};
use crate::texture_compression::{compressed_bytes, has_whole_blocks};

/// Pixels that a trimmed slice has to spare round its opaque ones, for filtering.
const MARGIN: f32 = 2.0;

/// A crown baked into slicings, in several orientations and levels of detail. Bake one with
/// [`bake`](super::bake()), or load a `*.slicing.ron` file; draw it with [`SlicedCrown`](super::SlicedCrown).
///
/// Layers are counted by level of detail, then orientation, then slice, the one furthest from the eye first. Clones share
/// their pictures.
#[derive(Asset, Clone, Debug, PartialEq, Reflect)]
#[reflect(opaque)]
#[reflect(Clone, Debug, PartialEq)]
pub struct Slicing {
    pub(super) shape: SlicingShape,
    /// sRGB colours with alpha: all pixels of the first layer row by row, then the next.
    pub(super) color: Arc<[[u8; 4]]>,
    /// Local normals, −1..1 as 0..255, and the light from around that comes in, 0..1 as 0..255.
    pub(super) normal: Arc<[[u8; 4]]>,
    pub(super) octagons: Vec<Octagon>,
}

/// All of a [`Slicing`] but its pictures.
#[derive(Clone, Debug, PartialEq)]
pub struct SlicingShape {
    /// c_s: the centre of all slicing boxes (§2.1), local space, metres.
    pub centroid: Vec3,
    /// Radius of the ball round the centroid that holds the crown, in metres.
    pub radius: f32,
    /// Pixels along each side of a slice, a power of two.
    pub pixels: u32,
    /// Slices of an orientation in each level of detail, the finest level first.
    pub levels: Vec<u32>,
    /// Distances, in radii, at which each level gives over to the next, on the screen of
    /// [`FOCAL`](super::blend::FOCAL): it is the size on screen that counts. One fewer than levels.
    pub switches: Vec<f32>,
    /// m_s: how much more opaque blended slicings are drawn in the paper's order (§2.3).
    pub correction: f32,
    /// Share of the sun's light that comes through leaves from behind, 0 to 1: the mean of what is baked.
    pub diffuse_transmission: f32,
    /// Whether orientations are spread over the sphere, so that the three nearest blend; else the two nearest do.
    pub sphere: bool,
    /// Whether the last orientation looks down, and joins in as the eye rises.
    pub vertical: bool,
    /// The orientations, the vertical one last.
    pub orientations: Vec<Orientation>,
}

impl SlicingShape {
    /// How many orientations the discrepancy angle chooses among: all but a vertical one beside others, which joins in
    /// by the eye's elevation.
    pub fn upright_count(&self) -> usize {
        let count = self.orientations.len();
        count - usize::from(self.vertical && count > 1)
    }

    /// Whether slices that look `towards` a direction (unit) stand upright, round the circle or an arc of it.
    pub fn is_upright(&self, towards: Vec3) -> bool {
        !self.sphere && towards.y.abs() < 0.01
    }

    /// Slices of all levels and orientations.
    pub fn layers(&self) -> usize {
        let slices: u64 = self.levels.iter().map(|slices| u64::from(*slices)).sum();
        let layers = slices.saturating_mul(self.orientations.len() as u64);
        usize::try_from(layers).unwrap_or(usize::MAX)
    }

    /// Index of the first layer of an orientation in a level.
    pub fn first_layer(&self, level: usize, orientation: usize) -> usize {
        let before: u32 = self.levels[..level].iter().sum();
        before as usize * self.orientations.len() + orientation * self.levels[level] as usize
    }

    pub(super) fn check(&self) -> Result<(), SlicingError> {
        let count = |what, value: usize, least, most| {
            if (least..=most).contains(&value) {
                Ok(())
            } else {
                Err(SlicingError::Count {
                    what,
                    value,
                    least,
                    most,
                })
            }
        };
        count("orientations", self.orientations.len(), 1, MAX_ORIENTATIONS)?;
        count("levels", self.levels.len(), 1, MAX_LEVELS)?;
        for slices in &self.levels {
            count("slices", *slices as usize, 1, MAX_SLICES as usize)?;
        }
        count(
            "layers (orientations times slices)",
            self.layers(),
            1,
            MAX_LAYERS,
        )?;
        if !self.pixels.is_power_of_two() || self.pixels > MAX_PIXELS {
            return Err(SlicingError::Pixels {
                pixels: self.pixels,
            });
        }
        let total = self.layers() as u64 * u64::from(self.pixels).pow(2);
        if total > MAX_PIXELS_TOTAL {
            return Err(SlicingError::TotalPixels { total });
        }
        if self.switches.len() + 1 != self.levels.len() {
            return Err(SlicingError::Switches {
                switches: self.switches.len(),
                levels: self.levels.len(),
            });
        }
        let rises = self
            .switches
            .windows(2)
            .all(|pair| 1.25 * pair[0] <= pair[1]);
        if !rises || !self.switches.iter().all(|at| at.is_finite() && *at > 0.0) {
            return Err(SlicingError::SwitchOrder);
        }
        let number = |what, value: f32, is_right: bool| {
            if is_right && value.is_finite() {
                Ok(())
            } else {
                Err(SlicingError::Number { what, value })
            }
        };
        number("radius", self.radius, self.radius > 0.0)?;
        number(
            "correction",
            self.correction,
            (0.0..=4.0).contains(&self.correction),
        )?;
        number(
            "diffuse transmission",
            self.diffuse_transmission,
            (0.0..=1.0).contains(&self.diffuse_transmission),
        )?;
        number("centroid", self.centroid.length_squared(), true)?;
        for (index, o) in self.orientations.iter().enumerate() {
            let unit = |v: Vec3| (v.length_squared() - 1.0).abs() < 1e-3;
            let square = o.right.dot(o.up).abs()
                + o.up.dot(o.direction).abs()
                + o.direction.dot(o.right).abs();
            let has_room = (o.high - o.low).min_element() > 0.0;
            // Of slices of 4 pixels, half is margin; a box that reaches further is of another crown.
            let furthest = o.low.abs().max(o.high.abs()).max_element();
            let finite = o.low.is_finite() && o.high.is_finite() && furthest <= 4.0 * self.radius;
            let axes = unit(o.right) && unit(o.up) && unit(o.direction) && square < 3e-3;
            if !(axes && has_room && finite) {
                return Err(SlicingError::Orientation { index });
            }
        }
        Ok(())
    }
}

impl Slicing {
    /// A slicing of its shape and its pictures, each layer's pixels row by row.
    ///
    /// # Errors
    /// When counts or numbers are out of range, or pictures of another size.
    pub fn new(
        shape: SlicingShape,
        color: Vec<[u8; 4]>,
        normal: Vec<[u8; 4]>,
    ) -> Result<Self, SlicingError> {
        shape.check()?;
        let layer = (shape.pixels * shape.pixels) as usize;
        for found in [color.len(), normal.len()] {
            let expected = shape.layers() * layer;
            if found != expected {
                return Err(SlicingError::PictureSize { expected, found });
            }
        }
        Ok(Self::trimmed(shape, color, normal))
    }

    /// A slicing of pictures of the shape's size, whatever that is: of more pixels than a slicing may have, for other
    /// methods to draw.
    pub(crate) fn trimmed(shape: SlicingShape, color: Vec<[u8; 4]>, normal: Vec<[u8; 4]>) -> Self {
        let layer = (shape.pixels * shape.pixels) as usize;
        let octagons = color
            .chunks_exact(layer)
            .map(|pixels| {
                octagon(shape.pixels, MARGIN, |x, y| {
                    pixels[(y * shape.pixels + x) as usize][3] > 0
                })
            })
            .collect();
        Self {
            shape,
            color: color.into(),
            normal: normal.into(),
            octagons,
        }
    }

    /// All but the pictures.
    pub fn shape(&self) -> &SlicingShape {
        &self.shape
    }

    /// The trimmed outlines of all layers, in texture coordinates.
    pub fn octagons(&self) -> &[Octagon] {
        &self.octagons
    }

    /// Colours of a layer, row by row: sRGB with alpha.
    pub fn color(&self, layer: usize) -> &[[u8; 4]] {
        let size = (self.shape.pixels * self.shape.pixels) as usize;
        &self.color[layer * size..(layer + 1) * size]
    }

    /// Normals of a layer, row by row: −1..1 as 0..255, and the light from around that comes in.
    pub fn normal(&self, layer: usize) -> &[[u8; 4]] {
        let size = (self.shape.pixels * self.shape.pixels) as usize;
        &self.normal[layer * size..(layer + 1) * size]
    }

    /// Bytes on the GPU, mip levels included: as they were baked, or `compressed` (BC3;
    /// [`SlicingCompression`](super::SlicingCompression) says where). Slices of less than 4 pixels never are.
    pub fn gpu_bytes(&self, compressed: bool) -> u64 {
        let side = self.shape.pixels;
        let layer: u64 = if compressed && has_whole_blocks(side) {
            compressed_bytes(side)
        } else {
            (0..=side.ilog2())
                .map(|level| 4 * u64::from(side >> level).pow(2))
                .sum()
        };
        2 * layer * self.shape.layers() as u64
    }

    /// Colours and normals of a layer with their mip levels, the finest first.
    pub(crate) fn levels(&self, layer: usize) -> [Vec<[u8; 4]>; 2] {
        let (size, color) = (self.shape.pixels, self.color(layer));
        [
            color_levels(color, size),
            normal_levels(self.normal(layer), color, size),
        ]
    }

    /// The bytes of both texture arrays, layer by layer with their mip levels.
    #[cfg(feature = "lab")]
    pub(crate) fn texture_bytes(&self) -> [Vec<u8>; 2] {
        let (mut colors, mut normals) = (Vec::new(), Vec::new());
        for layer in 0..self.shape.layers() {
            let [color, normal] = self.levels(layer);
            colors.extend(color.into_iter().flatten());
            normals.extend(normal.into_iter().flatten());
        }
        [colors, normals]
    }
}
