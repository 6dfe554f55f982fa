//! Volumes from image files.

use std::path::{Path, PathBuf};

use bevy::math::{UVec2, Vec3};
use bevy_verdure::texel::build::{
    Built, HeightField, StackImage, VolumeSettings, from_height_field, from_images,
};
use bevy_verdure::texel::{Progress, TexelError};
use image::RgbaImage;

use crate::Output;

fn open(path: &Path) -> Result<image::DynamicImage, String> {
    image::open(path)
        .map_err(|error| format!("{}: {error}. Give the path of a PNG", path.display()))
}

/// Settings for images of a size; there are `slices` of them, or so many are asked for.
fn settings(size: UVec2, slices: u32, output: &Output) -> VolumeSettings {
    let size = output.size.unwrap_or(size.extend(slices));
    let lengths = output
        .lengths
        .unwrap_or_else(|| Vec3::new(1.0, size.y as f32 / size.x as f32, 0.25));
    VolumeSettings {
        lengths,
        topology: output.topology(),
        spreading: output.spreading(),
        ..VolumeSettings::new(size)
    }
}

/// From a grey image, of 8 or 16 bits.
pub fn height(
    file: &Path,
    colors: Option<&Path>,
    output: &Output,
    progress: Progress,
) -> Result<Built, String> {
    let grey = open(file)?.into_luma16();
    let size = UVec2::new(grey.width(), grey.height());
    let heights = grey
        .pixels()
        .map(|pixel| f32::from(pixel.0[0]) / 65535.0)
        .collect();
    let mut field = HeightField::new(size, heights, [150, 150, 140]);
    if let Some(path) = colors {
        let image = open(path)?.into_rgb8();
        if [image.width(), image.height()] != size.to_array() {
            let (width, height) = image.dimensions();
            return Err(format!(
                "{}: is {width}x{height} pixels, where the heights of {} are {}x{}: scale one of them",
                path.display(),
                file.display(),
                size.x,
                size.y
            ));
        }
        field.colors = image.pixels().map(|pixel| pixel.0).collect();
    }
    let built = from_height_field(&field, &settings(size, 64, output), progress);
    built.map_err(|error| format!("{}: {error}", file.display()))
}

/// From a stack of images. One without alpha is a slice that is opaque everywhere.
pub fn images(files: &[PathBuf], output: &Output, progress: Progress) -> Result<Built, String> {
    let mut images = Vec::new();
    let mut has_alpha = false;
    for path in files {
        let image = open(path)?;
        has_alpha |= image.color().has_alpha();
        let image: RgbaImage = image.into_rgba8();
        images.push(StackImage {
            size: [image.width(), image.height()],
            pixels: image.pixels().map(|pixel| pixel.0).collect(),
        });
    }
    if !has_alpha {
        return Err(format!(
            "{}: none of {} images has alpha, which tells what is opaque: save them as RGBA, with alpha below 128 where \
             slices are empty",
            files[0].display(),
            files.len()
        ));
    }
    let size = UVec2::from_array(images[0].size);
    let settings = settings(size, files.len() as u32, output);
    let built = from_images(&images, &settings, progress);
    built.map_err(|error| {
        // The one that differs, the first that is too much, or the first.
        let (file, fix) = match error {
            TexelError::ImageSize { image, .. } => (image, ""),
            TexelError::Count { what: "images", .. } => (
                settings.size.z as usize,
                ", or leave out --size, of which the last number is theirs",
            ),
            _ => (0, ""),
        };
        let file = files.get(file).unwrap_or(&files[0]);
        format!(
            "{} (of {} images): {error}{fix}",
            file.display(),
            files.len()
        )
    })
}
