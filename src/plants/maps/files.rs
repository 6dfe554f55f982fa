//! Maps as files: `<kind>_color.png` (sRGB) and `<kind>_height.png` (8-bit grey, linear).

use std::path::{Path, PathBuf};

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};

use super::{Maps, SURFACES};

/// Why maps could not be written, or are not what is painted now.
#[derive(Debug)]
pub enum MapFileError {
    /// A file could not be read or written.
    File(PathBuf, image::ImageError),
    /// A file has another size than the map.
    Size(PathBuf, [u32; 2], [u32; 2]),
    /// A pixel (column, row) differs by so many levels.
    Pixel(PathBuf, [u32; 2], u8),
}

impl core::fmt::Display for MapFileError {
    fn fmt(&self, f: &mut core::fmt::Formatter) -> core::fmt::Result {
        match self {
            Self::File(path, error) => write!(f, "{}: {error}", path.display()),
            Self::Size(path, is, [x, y]) => {
                let path = path.display();
                write!(
                    f,
                    "{path} is {} x {}, not {x} x {y}: paint it again",
                    is[0], is[1]
                )
            }
            Self::Pixel(path, [x, y], off) => {
                let path = path.display();
                write!(
                    f,
                    "{path}: pixel ({x}, {y}) is off by {off} levels: paint it again"
                )
            }
        }
    }
}

impl core::error::Error for MapFileError {}

/// The files of a surface's maps: path, channels (3 or 1), and bytes.
fn files(dir: &Path, name: &str, maps: &Maps) -> impl Iterator<Item = (PathBuf, usize, Vec<u8>)> {
    let color = maps.color.iter().flat_map(|[r, g, b, _]| [*r, *g, *b]);
    let color = (dir.join(format!("{name}_color.png")), 3, color.collect());
    let height = maps.height.clone();
    let height = height.map(|height| (dir.join(format!("{name}_height.png")), 1, height));
    core::iter::once(color).chain(height)
}

/// Paints all maps into a folder that exists.
///
/// # Errors
/// The first file that cannot be written.
pub fn paint_all(dir: &Path) -> Result<(), MapFileError> {
    for (kind, name) in SURFACES {
        save(dir, name, &Maps::paint(kind))?;
    }
    Ok(())
}

fn save(dir: &Path, name: &str, maps: &Maps) -> Result<(), MapFileError> {
    let [width, length] = maps.size;
    for (path, channels, bytes) in files(dir, name, maps) {
        let format = match channels {
            1 => ExtendedColorType::L8,
            _ => ExtendedColorType::Rgb8,
        };
        let write = || {
            let file = std::io::BufWriter::new(std::fs::File::create(&path)?);
            PngEncoder::new_with_quality(file, CompressionType::Best, FilterType::Adaptive)
                .write_image(&bytes, width, length, format)
        };
        write().map_err(|error| MapFileError::File(path.clone(), error))?;
    }
    Ok(())
}

/// Compares a surface's maps in a folder with those painted; `levels` of 255 are forgiven (2 for another machine).
///
/// # Errors
/// The first file that is missing or differs by more.
pub fn compare(dir: &Path, name: &str, maps: &Maps, levels: u8) -> Result<(), MapFileError> {
    for (path, channels, painted) in files(dir, name, maps) {
        let stored = image::open(&path).map_err(|error| MapFileError::File(path.clone(), error))?;
        let is = [stored.width(), stored.height()];
        if is != maps.size {
            return Err(MapFileError::Size(path, is, maps.size));
        }
        let stored = match channels {
            1 => stored.into_luma8().into_raw(),
            _ => stored.into_rgb8().into_raw(),
        };
        for (i, (a, b)) in stored.iter().zip(&painted).enumerate() {
            let off = a.abs_diff(*b);
            if off > levels {
                let pixel = (i / channels) as u32;
                let place = [pixel % maps.size[0], pixel / maps.size[0]];
                return Err(MapFileError::Pixel(path, place, off));
            }
        }
    }
    Ok(())
}
