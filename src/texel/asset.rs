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

#[cfg(test)]
mod tests {
    use std::path::{Path, PathBuf};
    use std::time::Duration;

    use bevy::MinimalPlugins;
    use bevy::asset::{AssetPlugin, AssetServer, Assets, Handle, LoadState};
    use bevy::math::UVec3;

    use super::super::build::{VolumeSettings, from_implicit};
    use super::super::file::save;
    use super::*;

    /// A folder that is removed at the end.
    struct Folder(PathBuf);

    impl Folder {
        fn new(name: &str) -> Self {
            let path = std::env::temp_dir().join(format!("texel-{name}-{}", std::process::id()));
            std::fs::create_dir_all(&path).unwrap();
            Self(path)
        }
    }

    impl Drop for Folder {
        fn drop(&mut self) {
            // What stays behind is in the system's folder for that.
            let _ = std::fs::remove_dir_all(&self.0);
        }
    }

    /// An app that has loaded `a.texel.ron`, or has failed to.
    fn loaded(folder: &Path) -> (App, Handle<TexelVolume>) {
        let mut app = App::new();
        app.add_plugins((
            MinimalPlugins,
            AssetPlugin {
                file_path: folder.display().to_string(),
                ..Default::default()
            },
            TexelVolumePlugin,
        ));
        let handle = app.world().resource::<AssetServer>().load("a.texel.ron");
        // A minute at most, of which loading takes milliseconds.
        for _ in 0..6000 {
            app.update();
            let state = app.world().resource::<AssetServer>().load_state(&handle);
            if matches!(state, LoadState::Loaded | LoadState::Failed(_)) {
                break;
            }
            std::thread::sleep(Duration::from_millis(10));
        }
        (app, handle)
    }

    fn ball() -> ReferenceVolume {
        let settings = VolumeSettings::new(UVec3::splat(16));
        let function = |at: bevy::math::Vec3| 0.4 / at.distance(bevy::math::Vec3::splat(0.5));
        from_implicit(function, |at| at, &settings, &silent)
            .unwrap()
            .volume
    }

    #[test]
    fn a_volume_is_loaded_with_its_images() {
        let folder = Folder::new("loaded");
        save(&ball(), &folder.0.join("a.texel.ron")).unwrap();
        let (app, handle) = loaded(&folder.0);
        let volumes = app.world().resource::<Assets<TexelVolume>>();
        assert_eq!(volumes.get(&handle), Some(&ball().into()));
    }

    #[test]
    fn a_missing_image_is_named() {
        let folder = Folder::new("missing");
        save(&ball(), &folder.0.join("a.texel.ron")).unwrap();
        std::fs::remove_file(folder.0.join("a.normal.png")).unwrap();
        let (app, handle) = loaded(&folder.0);
        match app.world().resource::<AssetServer>().load_state(&handle) {
            LoadState::Failed(error) => {
                let message = error.to_string();
                assert!(
                    message.contains("a.normal.png: cannot be read"),
                    "{message}"
                );
            }
            state => panic!("{state:?}"),
        }
    }
}
