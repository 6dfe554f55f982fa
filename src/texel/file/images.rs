//! Slices in a grid, as PNG images.

use std::io::Cursor;

use bevy::math::UVec3;
use png::{BitDepth, ColorType, Compression, Decoder, Encoder, Limits, Transformations};

use super::error::TexelFileErrorKind;

/// Memory that a decoder may take beside the pixels.
const DECODER_BYTES: usize = 1 << 26;

/// The grid's width and height in pixels.
fn grid_size(size: UVec3, columns: u32) -> [u32; 2] {
    [size.x * columns, size.y * (size.z / columns)]
}

/// How many slices stand in a row, for a picture about as wide as high.
pub(super) fn columns(size: UVec3) -> u32 {
    let mut columns = 1;
    while columns < size.z && size.x * columns < size.y * (size.z / columns) {
        columns *= 2;
    }
    columns
}

/// Where in the grid's pixels each row of voxels begins, in the order of voxels.
fn rows(size: UVec3, columns: u32) -> impl Iterator<Item = usize> {
    let width = (size.x * columns) as usize;
    (0..size.z).flat_map(move |z| {
        (0..size.y).map(move |y| {
            let row = (z / columns * size.y + y) as usize;
            row * width + (z % columns * size.x) as usize
        })
    })
}

/// Writes voxels with as many channels, 3 or 4, as are kept of each.
pub(super) fn encode(voxels: &[[u8; 4]], size: UVec3, columns: u32, channels: usize) -> Vec<u8> {
    let [width, height] = grid_size(size, columns);
    let mut pixels = vec![0; (width * height) as usize * channels];
    for (row, voxels) in rows(size, columns).zip(voxels.chunks(size.x as usize)) {
        let start = row * channels;
        let end = start + voxels.len() * channels;
        for (pixel, voxel) in pixels[start..end].chunks_mut(channels).zip(voxels) {
            pixel.copy_from_slice(&voxel[..channels]);
        }
    }
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, width, height);
    encoder.set_color(if channels == 4 {
        ColorType::Rgba
    } else {
        ColorType::Rgb
    });
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Balanced);
    let written = encoder.write_header().and_then(|mut writer| {
        writer.write_image_data(&pixels)?;
        writer.finish()
    });
    written.expect("a buffer in memory takes all bytes of a picture of a valid size");
    bytes
}

/// Reads voxels, in four channels, whatever kind of PNG they are in. Alpha is 255 where it has none.
pub(super) fn decode(
    bytes: &[u8],
    size: UVec3,
    columns: u32,
) -> Result<Vec<[u8; 4]>, TexelFileErrorKind> {
    let fail = |error: png::DecodingError| TexelFileErrorKind::Png {
        message: error.to_string(),
    };
    let mut decoder = Decoder::new_with_limits(
        Cursor::new(bytes),
        Limits {
            bytes: DECODER_BYTES,
        },
    );
    decoder.set_transformations(
        Transformations::EXPAND | Transformations::ALPHA | Transformations::STRIP_16,
    );
    let mut reader = decoder.read_info().map_err(fail)?;
    // Before there is memory for the pixels.
    let found = [reader.info().width, reader.info().height];
    let expected = grid_size(size, columns);
    if found != expected {
        return Err(TexelFileErrorKind::ImageSize { found, expected });
    }
    let length = reader.output_buffer_size().unwrap_or(0);
    let mut pixels = vec![0; length];
    let info = reader.next_frame(&mut pixels).map_err(fail)?;
    let pixel = |index: usize| match info.color_type {
        ColorType::GrayscaleAlpha => {
            let [grey, alpha] = [pixels[index * 2], pixels[index * 2 + 1]];
            [grey, grey, grey, alpha]
        }
        _ => std::array::from_fn(|channel| pixels[index * 4 + channel]),
    };
    let width = size.x as usize;
    let voxels = rows(size, columns).flat_map(|row| (row..row + width).map(pixel));
    Ok(voxels.collect())
}
