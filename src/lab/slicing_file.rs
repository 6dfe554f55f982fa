//! Slicings written to disk.

use std::path::{Path, PathBuf};

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};

use crate::slicing::{Slicing, SlicingDocument};

/// What was written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SavedSlicing {
    /// All files, `NAME.slicing.ron` first.
    pub files: Vec<PathBuf>,
    /// Their bytes.
    pub bytes: u64,
}

/// Writes a slicing as `NAME.slicing.ron` and its pictures into a folder, which is made if it is not there.
///
/// # Errors
/// When a file cannot be written; the message names it.
pub fn save_slicing(slicing: &Slicing, folder: &Path, name: &str) -> Result<SavedSlicing, String> {
    let named =
        |path: &Path, error: &dyn core::fmt::Display| format!("{}: {error}", path.display());
    std::fs::create_dir_all(folder).map_err(|error| named(folder, &error))?;
    let document = SlicingDocument::describe(slicing, name);
    let [width, height] = document.picture_size();
    let text = folder.join(format!("{name}.slicing.ron"));
    std::fs::write(&text, document.to_ron()).map_err(|error| named(&text, &error))?;
    let mut files = vec![text];
    for (orientation, names) in document.pictures().enumerate() {
        for (name, pixels) in names.into_iter().zip(slicing.pictures(orientation)) {
            let path = folder.join(name);
            let mut bytes = Vec::new();
            PngEncoder::new_with_quality(&mut bytes, CompressionType::Best, FilterType::Adaptive)
                .write_image(
                    pixels.as_flattened(),
                    width,
                    height,
                    ExtendedColorType::Rgba8,
                )
                .map_err(|error| named(&path, &error))?;
            std::fs::write(&path, bytes).map_err(|error| named(&path, &error))?;
            files.push(path);
        }
    }
    let mut bytes = 0;
    for path in &files {
        bytes += path.metadata().map_err(|error| named(path, &error))?.len();
    }
    Ok(SavedSlicing { files, bytes })
}
