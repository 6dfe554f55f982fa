//! Reference volumes in files: `*.texel.ron`, and two PNG images beside it.
//!
//! ```ron
//! (
//!     size: (256, 256, 64),
//!     lengths: (1.0, 1.0, 0.25),
//!     topology: Tiling,
//!     columns: 8,
//!     colors: "meadow.color.png",
//!     normals: "meadow.normal.png",
//!     thickness: (0.016, 0.016, 0.012),
//! )
//! ```
//!
//! | field | what it is |
//! |---|---|
//! | `size` | voxels along u, v and w: powers of two |
//! | `lengths` | of the box along u, v and w, in metres; [`ReferenceVolume::lengths`] |
//! | `topology` | `Tiling` or `Isolated`; [`Topology`](super::Topology) |
//! | `columns` | how many slices there are in a row of the images; 1 if left out |
//! | `colors` | image of all slices along w, the lowest first, row by row of the grid: sRGB, opaque from alpha 128 on |
//! | `normals` | image of their normals, as normal maps have them; up everywhere if left out |
//! | `thickness` | e, in metres; measured anew if left out. Leave it out when images were painted over |
//!
//! Names of images are relative to the file. [`save`] writes all three, [`load`] reads them; both are the same on all
//! machines, byte by byte. No input makes reading panic or take memory out of proportion to the size that the file
//! states, which is bounded.

mod document;
mod error;
mod images;
#[cfg(test)]
mod tests;

use std::fs;
use std::path::Path;

use super::progress::Progress;
use super::volume::ReferenceVolume;

pub use document::TexelDocument;
pub use error::{TexelFileError, TexelFileErrorKind};

/// What names of these files end in.
pub const EXTENSION: &str = "texel.ron";

/// Largest `*.texel.ron` file, in bytes.
pub const MAX_DOCUMENT_BYTES: usize = 1 << 16;

/// Writes a volume to a file, whose name ends in `.texel.ron`, and its images beside it. Returns the names of the
/// images.
///
/// # Errors
/// When a file cannot be written, or the name is another.
pub fn save(volume: &ReferenceVolume, path: &Path) -> Result<[String; 2], TexelFileError> {
    let named = |kind: TexelFileErrorKind| TexelFileError::new(path.display(), kind);
    let name = path.file_name().and_then(|name| name.to_str());
    let stem = name.and_then(|name| name.strip_suffix(EXTENSION)?.strip_suffix('.'));
    let stem = stem.ok_or_else(|| named(TexelFileErrorKind::Extension))?;
    let (document, images) = TexelDocument::of(volume, stem);
    let names = [document.colors.clone(), format!("{stem}.normal.png")];
    let write = |path: &Path, bytes: &[u8]| {
        let result = fs::write(path, bytes);
        result
            .map_err(|error| TexelFileError::new(path.display(), TexelFileErrorKind::write(&error)))
    };
    for (name, image) in names.iter().zip(images) {
        write(&path.with_file_name(name), &image)?;
    }
    write(path, document.to_ron().as_bytes())?;
    Ok(names)
}

/// Reads a volume from a file and its images.
///
/// # Errors
/// When a file cannot be read, is not what it should be, or its voxels make no volume. The error names the file and
/// the line.
pub fn load(path: &Path, progress: Progress) -> Result<ReferenceVolume, TexelFileError> {
    let read = |path: &Path| {
        let result = fs::read(path);
        result
            .map_err(|error| TexelFileError::new(path.display(), TexelFileErrorKind::read(&error)))
    };
    let document = TexelDocument::from_ron(&path.display().to_string(), &read(path)?)?;
    let colors = read(&path.with_file_name(&document.colors))?;
    let normals = match &document.normals {
        Some(name) => Some(read(&path.with_file_name(name))?),
        None => None,
    };
    document.volume(
        &path.display().to_string(),
        &colors,
        normals.as_deref(),
        progress,
    )
}
