//! Skeletons as Bevy assets.

use bevy::asset::io::Reader;
use bevy::asset::{AssetLoader, AsyncReadExt, LoadContext};
use bevy::prelude::{App, AssetApp, Plugin, TypePath};

use super::error::{SkeletonFileError, SkeletonFileErrorKind};
use super::file::{EXTENSIONS, skeleton_from_bytes};
use super::settings::SkeletonLoaderSettings;
use super::skeleton::Skeleton;
use super::text::MAX_FILE_BYTES;

/// Makes [`Skeleton`] an asset that the asset server loads from `*.skeleton.ron`, `*.swc` and `*.csv`.
///
/// Needs Bevy's `AssetPlugin`, added before.
pub struct SkeletonPlugin;

impl Plugin for SkeletonPlugin {
    fn build(&self, app: &mut App) {
        app.init_asset::<Skeleton>()
            .register_asset_reflect::<Skeleton>()
            .register_asset_loader(SkeletonLoader);
    }
}

/// Loads a [`Skeleton`], with [`SkeletonLoaderSettings`]; see
/// [`skeleton_from_bytes`](super::skeleton_from_bytes).
#[derive(Clone, Copy, Debug, Default, TypePath)]
pub struct SkeletonLoader;

impl AssetLoader for SkeletonLoader {
    type Asset = Skeleton;
    type Settings = SkeletonLoaderSettings;
    type Error = SkeletonFileError;

    async fn load(
        &self,
        reader: &mut dyn Reader,
        settings: &SkeletonLoaderSettings,
        load_context: &mut LoadContext<'_>,
    ) -> Result<Skeleton, SkeletonFileError> {
        let path = load_context.path().to_string();
        let bytes = read_limited(reader)
            .await
            .map_err(|error| error.in_file(&path))?;
        skeleton_from_bytes(&path, &bytes, settings)
    }

    fn extensions(&self) -> &[&str] {
        EXTENSIONS
    }
}

/// All bytes of the reader, or an error as soon as there are more than [`MAX_FILE_BYTES`].
async fn read_limited(reader: &mut dyn Reader) -> Result<Vec<u8>, SkeletonFileError> {
    const CHUNK: usize = 1 << 18;

    let mut bytes = Vec::new();
    loop {
        let end = bytes.len();
        bytes.resize(end + CHUNK, 0);
        let read = reader.read(&mut bytes[end..]).await;
        let count = read.map_err(|error| SkeletonFileErrorKind::Read {
            message: error.to_string(),
        })?;
        bytes.truncate(end + count);
        if count == 0 {
            return Ok(bytes);
        }
        if bytes.len() as u64 > MAX_FILE_BYTES {
            return Err(SkeletonFileErrorKind::TooLarge.into());
        }
    }
}
