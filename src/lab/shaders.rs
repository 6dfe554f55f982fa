//! The shaders of an app, all of them before its first frame.

use core::time::Duration;
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::Instant;

use bevy::asset::io::{AssetSourceId, ErasedAssetReader};
use bevy::asset::{AssetPath, handle_internal_asset_events};
use bevy::prelude::*;
use bevy::shader::Shader;
use bevy::tasks::{block_on, futures_lite::StreamExt};

/// Where shaders are that are built into a program.
const SOURCE: &str = "embedded";

/// How long a shader may take to be read. Machines may be busy.
const PATIENCE: Duration = Duration::from_secs(300);

/// The shaders built into a program, which are kept.
#[derive(Resource)]
struct Shaders(
    #[expect(dead_code, reason = "held, so that no shader is let go of")] Vec<Handle<Shader>>,
);

/// Loads all shaders that are built into the program, and waits for them. Else each would be read when it is first wanted,
/// behind the frames, and how many of these are without what it draws would be up to the machine's load.
///
/// # Panics
/// If one is neither read nor refused in five minutes.
pub(super) fn load_shaders(world: &mut World) {
    let Some(server) = world.get_resource::<AssetServer>().cloned() else {
        return;
    };
    let source = AssetSourceId::from(SOURCE);
    let Ok(embedded) = server.get_source(source.clone()) else {
        return;
    };
    let paths = block_on(shaders_in(embedded.reader()));
    let load = |path| server.load(AssetPath::from(path).with_source(source.clone()));
    let shaders: Vec<Handle<Shader>> = paths.into_iter().map(load).collect();
    let is_settled = |shader: &Handle<Shader>| {
        let state = server.load_state(shader);
        state.is_loaded() || state.is_failed()
    };
    let patience = Instant::now() + PATIENCE;
    while let Some(waiting) = shaders.iter().find(|shader| !is_settled(shader)) {
        assert!(
            Instant::now() < patience,
            "no shader {:?} after {PATIENCE:?}",
            waiting.path()
        );
        handle_internal_asset_events(world);
        sleep(Duration::from_millis(1));
    }
    world.insert_resource(Shaders(shaders));
}

/// The shaders of a source, in all of its folders.
async fn shaders_in(reader: &dyn ErasedAssetReader) -> Vec<PathBuf> {
    let mut shaders = Vec::new();
    let mut folders = vec![PathBuf::new()];
    while let Some(folder) = folders.pop() {
        let Ok(mut entries) = reader.read_directory(&folder).await else {
            continue;
        };
        while let Some(path) = entries.next().await {
            if reader.is_directory(&path).await.unwrap_or(false) {
                folders.push(path);
            } else if is_shader(&path) {
                shaders.push(path);
            }
        }
    }
    shaders
}

fn is_shader(path: &Path) -> bool {
    path.extension()
        .is_some_and(|extension| extension == "wgsl")
}
