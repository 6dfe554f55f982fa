//! The written form of a slicing: `*.slicing.ron` and its pictures.
//!
//! The text names, for each orientation, a picture of colours and one of normals: PNGs of 8 bits with alpha, the slices
//! of all levels of detail one under the other, the finest level first, and in a level the furthest slice first.

use std::path::Path;

use bevy::asset::RenderAssetUsages;
use bevy::image::{CompressedImageFormats, Image, ImageSampler, ImageType};
use bevy::math::Vec3;
use bevy::render::render_resource::TextureFormat;
use ron::ser::PrettyConfig;
use serde::{Deserialize, Serialize};

use super::error::{SlicingError, SlicingFileError, SlicingFileErrorKind};
use super::limits::{MAX_ORIENTATIONS, MAX_PIXELS, MAX_SLICES};
use super::orientation::Orientation;
use super::slicing::{Slicing, SlicingShape};
use crate::ron_text::options;

/// Largest `*.slicing.ron`, in bytes: many times what the most orientations take.
pub(super) const MAX_TEXT_BYTES: usize = 1 << 20;
/// Largest picture file, in bytes.
pub(super) const MAX_PICTURE_BYTES: usize = 1 << 28;
/// Levels of brackets that a file may nest.
const RECURSION_LIMIT: usize = 32;
/// Longest message of the RON parser that is passed on, in characters.
const MAX_MESSAGE: usize = 240;

/// What is read for a slicing before its pictures: plain data, not yet checked.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Slicing", deny_unknown_fields)]
pub struct SlicingDocument {
    centroid: Vec3,
    radius: f32,
    pixels: u32,
    levels: Vec<u32>,
    #[serde(default)]
    switches: Vec<f32>,
    #[serde(default = "paper_correction")]
    correction: f32,
    #[serde(default)]
    diffuse_transmission: f32,
    #[serde(default)]
    sphere: bool,
    #[serde(default)]
    vertical: bool,
    orientations: Vec<DocumentOrientation>,
}

fn paper_correction() -> f32 {
    0.5
}

/// An orientation, and where its pictures are: paths relative to the document.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Orientation", deny_unknown_fields)]
struct DocumentOrientation {
    direction: Vec3,
    right: Vec3,
    up: Vec3,
    low: Vec3,
    high: Vec3,
    color: String,
    normal: String,
}

/// Pixels of a picture file, row by row.
pub type Picture = Vec<[u8; 4]>;

impl SlicingDocument {
    /// Reads the text of a `*.slicing.ron`; `path` names it in errors.
    ///
    /// # Errors
    /// When the bytes are no such text, or ask for more than a slicing may hold.
    pub fn parse(path: &str, bytes: &[u8]) -> Result<Self, SlicingFileError> {
        if bytes.len() > MAX_TEXT_BYTES {
            let kind = SlicingFileErrorKind::TooLarge {
                limit: MAX_TEXT_BYTES,
            };
            return Err(SlicingFileError::new(path, kind));
        }
        let options = options(RECURSION_LIMIT);
        let document: Self = options.from_bytes(bytes).map_err(|error| {
            let mut message = error.code.to_string();
            if let Some((end, _)) = message.char_indices().nth(MAX_MESSAGE) {
                message.truncate(end);
            }
            SlicingFileError {
                path: path.into(),
                line: Some(error.span.end.line as u64),
                kind: SlicingFileErrorKind::Ron { message },
            }
        })?;
        // Before any picture is opened: what it is checked against must be sane.
        document
            .shape()
            .check()
            .map_err(|error| SlicingFileError::new(path, error))?;
        // Such a picture would be the folder, or nothing that an error could name.
        let is_nameless = |name: &str| Path::new(name).file_name().is_none();
        let nameless = document
            .pictures()
            .position(|names| names.into_iter().any(is_nameless));
        if let Some(index) = nameless {
            let message = format!("a picture of orientation {index} has no name");
            return Err(SlicingFileError::new(
                path,
                SlicingFileErrorKind::Ron { message },
            ));
        }
        Ok(document)
    }

    /// The document of a slicing whose pictures are named after `stem`.
    pub fn describe(slicing: &Slicing, stem: &str) -> Self {
        let shape = slicing.shape();
        let orientations = shape.orientations.iter().enumerate();
        let orientations = orientations.map(|(i, o)| DocumentOrientation {
            direction: o.direction,
            right: o.right,
            up: o.up,
            low: o.low,
            high: o.high,
            color: format!("{stem}.{i}.color.png"),
            normal: format!("{stem}.{i}.normal.png"),
        });
        Self {
            centroid: shape.centroid,
            radius: shape.radius,
            pixels: shape.pixels,
            levels: shape.levels.clone(),
            switches: shape.switches.clone(),
            correction: shape.correction,
            diffuse_transmission: shape.diffuse_transmission,
            sphere: shape.sphere,
            vertical: shape.vertical,
            orientations: orientations.collect(),
        }
    }

    /// The text of the document.
    pub fn to_ron(&self) -> String {
        let layout = PrettyConfig::new().depth_limit(3).new_line("\n");
        let mut text = options(RECURSION_LIMIT)
            .to_string_pretty(self, layout)
            .expect("plain numbers and names can always be written");
        text.push('\n');
        text
    }

    /// Paths of the pictures, relative to the document: of each orientation, that of the colours and of the normals.
    pub fn pictures(&self) -> impl Iterator<Item = [&str; 2]> {
        self.orientations
            .iter()
            .map(|o| [o.color.as_str(), o.normal.as_str()])
    }

    /// Width and height of each picture.
    pub fn picture_size(&self) -> [u32; 2] {
        let slices = self
            .levels
            .iter()
            .fold(0, |sum: u32, n| sum.saturating_add(*n));
        [self.pixels, self.pixels.saturating_mul(slices)]
    }

    /// The slicing of this document and its pictures, in the order of [`pictures`](Self::pictures). `path` names it in
    /// errors.
    ///
    /// # Errors
    /// When pictures have not the pixels that the document says.
    pub fn assemble(
        &self,
        path: &str,
        pictures: &[[Picture; 2]],
    ) -> Result<Slicing, SlicingFileError> {
        let refuse = |error| SlicingFileError::new(path, error);
        let shape = self.shape();
        shape.check().map_err(refuse)?;
        let layer = (self.pixels * self.pixels) as usize;
        let expected = layer * self.levels.iter().sum::<u32>() as usize;
        let mut sizes = pictures.as_flattened().iter().map(Vec::len);
        if let Some(found) = sizes.find(|found| *found != expected) {
            return Err(refuse(SlicingError::PictureSize { expected, found }));
        }
        let [mut color, mut normal] = [Vec::new(), Vec::new()];
        let mut start = 0;
        for slices in &self.levels {
            let end = start + *slices as usize * layer;
            for [colors, normals] in pictures {
                color.extend(&colors[start..end]);
                normal.extend(&normals[start..end]);
            }
            start = end;
        }
        Slicing::new(shape, color, normal).map_err(refuse)
    }

    fn shape(&self) -> SlicingShape {
        let orientations = self.orientations.iter().map(|o| Orientation {
            direction: o.direction,
            right: o.right,
            up: o.up,
            low: o.low,
            high: o.high,
        });
        SlicingShape {
            centroid: self.centroid,
            radius: self.radius,
            pixels: self.pixels,
            levels: self.levels.clone(),
            switches: self.switches.clone(),
            correction: self.correction,
            diffuse_transmission: self.diffuse_transmission,
            sphere: self.sphere,
            vertical: self.vertical,
            orientations: orientations.collect(),
        }
    }
}

impl Slicing {
    /// The two pictures of an orientation, as [`SlicingDocument`] lays them out.
    pub fn pictures(&self, orientation: usize) -> [Picture; 2] {
        let [mut color, mut normal] = [Picture::new(), Picture::new()];
        for (level, slices) in self.shape().levels.iter().enumerate() {
            let first = self.shape().first_layer(level, orientation);
            for layer in first..first + *slices as usize {
                color.extend(self.color(layer));
                normal.extend(self.normal(layer));
            }
        }
        [color, normal]
    }
}

/// Reads a picture of a size that is known beforehand; `path` names it in errors.
///
/// # Errors
/// When the bytes are no PNG, or one of another size; the size is looked at before anything is unpacked.
pub fn read_picture(path: &str, bytes: &[u8], size: [u32; 2]) -> Result<Picture, SlicingFileError> {
    let refuse = |kind| Err(SlicingFileError::new(path, kind));
    let [expected_width, expected_height] = size;
    // Signature, then the length and name of the header chunk, then width and height.
    let header = bytes
        .get(..24)
        .filter(|header| header.starts_with(b"\x89PNG\r\n\x1a\n"));
    let Some(header) = header else {
        let message = "it does not begin as a PNG does".into();
        return refuse(SlicingFileErrorKind::Picture { message });
    };
    let number = |at: usize| u32::from_be_bytes([0, 1, 2, 3].map(|i| header[at + i]));
    let (width, height) = (number(16), number(20));
    if [width, height] != size {
        return refuse(SlicingFileErrorKind::PictureSize {
            width,
            height,
            expected_width,
            expected_height,
        });
    }
    let image = Image::from_buffer(
        bytes,
        ImageType::Extension("png"),
        CompressedImageFormats::NONE,
        true,
        ImageSampler::Default,
        RenderAssetUsages::MAIN_WORLD,
    );
    let message = match image {
        Ok(image) => {
            // Two channels of 16 bits take four bytes a pixel, too.
            let is_color = image.texture_descriptor.format == TextureFormat::Rgba8UnormSrgb;
            let data = image.data.unwrap_or_default();
            if is_color && data.len() as u64 == u64::from(width) * u64::from(height) * 4 {
                let pixels = data.chunks_exact(4).map(|p| [p[0], p[1], p[2], p[3]]);
                return Ok(pixels.collect());
            }
            "its pixels are not of 8 bits in four channels".into()
        }
        Err(error) => error.to_string(),
    };
    refuse(SlicingFileErrorKind::Picture { message })
}

// The most that `picture_size` can come to fits a `u32`.
const _: () =
    assert!((MAX_PIXELS as u64 * MAX_SLICES as u64 * 3) < u32::MAX as u64 && MAX_ORIENTATIONS > 0);

#[cfg(test)]
mod tests;
