//! Reference volumes as Bevy assets.

use std::sync::Arc;

use bevy::asset::io::Reader;
use bevy::asset::{Asset, AssetLoader, AsyncReadExt, LoadContext};
use bevy::prelude::{App, AssetApp, Plugin, TypePath};

use super::file::{
    EXTENSION, MAX_DOCUMENT_BYTES, TexelDocument, TexelFileError, TexelFileErrorKind,
};
use super::progress::silent;
use super::volume::ReferenceVolume;

/// Makes [`TexelVolume`] an asset that the asset server loads from `*.texel.ron`.
///
/// Needs Bevy's `AssetPlugin`, added before.
pub struct TexelVolumePlugin;

impl Plugin for TexelVolumePlugin {
    fn build(&self, app: &mut App) {
        app.init_asset::<TexelVolume>()
            .register_asset_loader(TexelVolumeLoader);
    }
}

/// A reference volume that surfaces share.
#[derive(Asset, TypePath, Clone, Debug, PartialEq)]
pub struct TexelVolume(pub Arc<ReferenceVolume>);

impl From<ReferenceVolume> for TexelVolume {
    fn from(volume: ReferenceVolume) -> Self {
        Self(Arc::new(volume))
    }
}

/// Loads a [`TexelVolume`] and the images that its file names; see [`file`](super::file).
#[derive(Clone, Copy, Debug, Default, TypePath)]
pub struct TexelVolumeLoader;

impl AssetLoader for TexelVolumeLoader {
    type Asset = TexelVolume;
    type Settings = ();
    type Error = TexelFileError;

    async fn load(
        &self,
        reader: &mut dyn Reader,
        _settings: &(),
        load_context: &mut LoadContext<'_>,
    ) -> Result<TexelVolume, TexelFileError> {
        let path = load_context.path().to_string();
        let document = TexelDocument::from_ron(&path, &read_document(reader, &path).await?)?;
        let colors = read_beside(load_context, &document.colors).await?;
        let normals = match &document.normals {
            Some(name) => Some(read_beside(load_context, name).await?),
            None => None,
        };
        let volume = document.volume(&path, &colors, normals.as_deref(), &silent)?;
        Ok(volume.into())
    }

    fn extensions(&self) -> &[&str] {
        &[EXTENSION]
    }
}

/// The document's bytes, of which one more than there may be is enough to refuse it.
async fn read_document(reader: &mut dyn Reader, path: &str) -> Result<Vec<u8>, TexelFileError> {
    let mut bytes = vec![0; MAX_DOCUMENT_BYTES + 1];
    let mut end = 0;
    while end < bytes.len() {
        let count = reader.read(&mut bytes[end..]).await.map_err(|error| {
            let message = error.to_string();
            TexelFileError::new(path, TexelFileErrorKind::Read { message })
        })?;
        if count == 0 {
            break;
        }
        end += count;
    }
    bytes.truncate(end);
    Ok(bytes)
}

/// The bytes of an image in the same folder.
async fn read_beside(context: &mut LoadContext<'_>, name: &str) -> Result<Vec<u8>, TexelFileError> {
    let unreadable = |path: &str, message: String| {
        TexelFileError::new(path, TexelFileErrorKind::Read { message })
    };
    let path = context
        .path()
        .resolve_embed_str(name)
        .map_err(|error| unreadable(name, error.to_string()))?;
    let named = path.to_string();
    let bytes = context.read_asset_bytes(path).await;
    bytes.map_err(|error| unreadable(&named, error.to_string()))
}
