//! Slicings as Bevy assets, and as files without an asset server.

use std::path::Path;

use bevy::asset::io::Reader;
use bevy::asset::{AssetLoader, AssetPath, AsyncReadExt, LoadContext};
use bevy::prelude::TypePath;

use super::document::{MAX_PICTURE_BYTES, MAX_TEXT_BYTES, SlicingDocument, read_picture};
use super::error::{SlicingFileError, SlicingFileErrorKind};
use super::slicing::Slicing;

/// Loads a [`Slicing`] from a `*.slicing.ron` and the pictures that it names, which lie beside it.
///
/// Pictures are PNGs: Bevy's feature `png` must be on. Where a file is changed for the worse while the game runs, the
/// error is in the log and the last good version stays on screen.
#[derive(Clone, Copy, Debug, Default, TypePath)]
pub struct SlicingLoader;

impl AssetLoader for SlicingLoader {
    type Asset = Slicing;
    type Settings = ();
    type Error = SlicingFileError;

    async fn load(
        &self,
        reader: &mut dyn Reader,
        _: &(),
        load_context: &mut LoadContext<'_>,
    ) -> Result<Slicing, SlicingFileError> {
        let path = load_context.path().clone().into_owned();
        let name = path.to_string();
        let failed = |name: &str, message: String| {
            SlicingFileError::new(name, SlicingFileErrorKind::Read { message })
        };
        let mut bytes = Vec::new();
        // One byte more than may be, so that a longer file is seen to be one.
        let mut limited = reader.take(MAX_TEXT_BYTES as u64 + 1);
        limited
            .read_to_end(&mut bytes)
            .await
            .map_err(|error| failed(&name, error.to_string()))?;
        let document = SlicingDocument::parse(&name, &bytes)?;
        let mut pictures = Vec::new();
        for names in document.pictures() {
            let [mut color, mut normal] = [Vec::new(), Vec::new()];
            for (relative, picture) in names.into_iter().zip([&mut color, &mut normal]) {
                let picture_path: AssetPath = path
                    .resolve_embed_str(relative)
                    .map_err(|error| failed(&name, format!("`{relative}`: {error}")))?;
                let named = picture_path.to_string();
                let bytes = load_context
                    .read_asset_bytes(picture_path)
                    .await
                    .map_err(|error| failed(&named, error.to_string()))?;
                *picture = picture_of(&named, &bytes, &document)?;
            }
            pictures.push([color, normal]);
        }
        document.assemble(&name, &pictures)
    }

    fn extensions(&self) -> &[&str] {
        &["slicing.ron"]
    }
}

fn picture_of(
    name: &str,
    bytes: &[u8],
    document: &SlicingDocument,
) -> Result<super::document::Picture, SlicingFileError> {
    if bytes.len() > MAX_PICTURE_BYTES {
        let kind = SlicingFileErrorKind::TooLarge {
            limit: MAX_PICTURE_BYTES,
        };
        return Err(SlicingFileError::new(name, kind));
    }
    read_picture(name, bytes, document.picture_size())
}

impl Slicing {
    /// Reads a `*.slicing.ron` and its pictures from disk, without an asset server.
    ///
    /// # Errors
    /// When a file is missing or not what it should be; the error names it.
    pub fn read(path: &Path) -> Result<Self, SlicingFileError> {
        let open = |path: &Path| {
            std::fs::read(path).map_err(|error| {
                let message = error.to_string();
                SlicingFileError::new(
                    &path.display().to_string(),
                    SlicingFileErrorKind::Read { message },
                )
            })
        };
        let name = path.display().to_string();
        let document = SlicingDocument::parse(&name, &open(path)?)?;
        let mut pictures = Vec::new();
        for [color, normal] in document.pictures() {
            let picture = |relative: &str| {
                let path = path.with_file_name(relative);
                picture_of(&path.display().to_string(), &open(&path)?, &document)
            };
            pictures.push([picture(color)?, picture(normal)?]);
        }
        document.assemble(&name, &pictures)
    }
}
