//! Figures as OpenEXR files.

use std::path::Path;

use exr::prelude::{AnyChannel, AnyChannels, Encoding, FlatSamples, Image, WritableImage};

/// Writes channels of 32-bit floats, row by row, as one EXR image.
pub fn save_exr(
    path: &Path,
    (width, height): (u32, u32),
    channels: &[(&str, Vec<f32>)],
) -> Result<(), String> {
    let channels = channels
        .iter()
        .map(|(name, values)| AnyChannel::new(*name, FlatSamples::F32(values.clone())))
        .collect();
    let mut image = Image::from_channels(
        (width as usize, height as usize),
        AnyChannels::sort(channels),
    );
    image.layer_data.encoding = Encoding::SMALL_LOSSLESS;
    image
        .write()
        .to_file(path)
        .map_err(|error| format!("{}: {error}", path.display()))
}
