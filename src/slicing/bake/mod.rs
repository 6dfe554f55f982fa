//! Baking: from the triangles of a crown to the pictures of its slices (§2.1, §2.2).
//!
//! 1. The crown's triangles are gathered (`source`, `from_mesh`) and parted from the solid ones (`separate`), which stay a
//!    mesh (`to_mesh`). Settings are given, or follow from a distance and an error (`settings`, `derived`).
//! 2. The light that leaves hold back is found for each (`occlusion`).
//! 3. Every orientation gets its box and axes ([`Orientation`]); every slice is a job of its own, taken by the next free
//!    thread: the triangles nearest to it are drawn by parallel projection with many samples a pixel (`raster`, `alpha`).
//! 4. Samples become pixels, and colours spread under transparent ones (`resolve`).
//!
//! No job knows of another, and none depends on the number of threads: the same input bakes to the same bytes.

mod alpha;
pub(crate) mod color;
mod derived;
mod error;
mod from_mesh;
mod occlusion;
mod raster;
mod resolve;
mod separate;
mod settings;
mod source;
#[cfg(test)]
mod tests;
mod texture;
mod to_mesh;

use core::sync::atomic::{AtomicUsize, Ordering};
use std::sync::Mutex;

use bevy::math::Vec3;

use self::raster::{Projection, rasterize};
use self::resolve::{Pictures, resolve};
use super::orientation::{Orientation, Orientations};
use super::slicing::{Slicing, SlicingShape};

pub use error::BakeError;
pub use separate::{Separation, separate};
pub use settings::BakeSettings;
pub use source::{CrownMaterial, CrownMesh, CrownTriangle, CrownVertex, MAX_COORDINATE};
pub use texture::CrownTexture;

/// Pixels round the crown that stay free in its pictures, for filtering.
const FREE: f32 = 2.0;

/// Bakes a crown; see [`bake_with_progress`].
///
/// # Errors
/// When there is no crown to bake, its numbers are not finite, or a setting is out of range.
pub fn bake(mesh: &CrownMesh, settings: &BakeSettings) -> Result<Slicing, BakeError> {
    bake_with_progress(mesh, settings, |_, _| {})
}

/// Bakes a crown on several threads. `progress` is told from them, after each slice, how many of how many are done.
///
/// # Errors
/// As [`bake`].
pub fn bake_with_progress(
    mesh: &CrownMesh,
    settings: &BakeSettings,
    progress: impl Fn(usize, usize) + Sync,
) -> Result<Slicing, BakeError> {
    bake_shape(mesh, settings, settings.directions(), progress)
}

/// Bakes a crown for eyes in these directions (unit, at most [`MAX_ORIENTATIONS`](super::MAX_ORIENTATIONS)) in place of
/// those of the settings: pictures for other methods to draw.
#[cfg(feature = "lab")]
pub(crate) fn bake_towards(
    mesh: &CrownMesh,
    settings: &BakeSettings,
    directions: Vec<Vec3>,
) -> Result<Slicing, BakeError> {
    bake_shape(mesh, settings, directions, |_, _| {})
}

/// Bakes with settings that are not checked: in particular, with more pixels a side (a power of two) than a slicing may
/// have.
#[cfg(feature = "lab")]
pub(crate) fn bake_unchecked(
    mesh: &CrownMesh,
    settings: &BakeSettings,
) -> Result<Slicing, BakeError> {
    mesh.check()?;
    let (shape, color, normal) = layers(mesh, settings, settings.directions(), |_, _| {});
    Ok(Slicing::trimmed(shape, color, normal))
}

fn bake_shape(
    mesh: &CrownMesh,
    settings: &BakeSettings,
    directions: Vec<Vec3>,
    progress: impl Fn(usize, usize) + Sync,
) -> Result<Slicing, BakeError> {
    mesh.check()?;
    settings.check()?;
    let (shape, color, normal) = layers(mesh, settings, directions, progress);
    Ok(Slicing::new(shape, color, normal).expect("the settings have been checked"))
}

/// The shape, and all layers' colours and normals.
fn layers(
    mesh: &CrownMesh,
    settings: &BakeSettings,
    directions: Vec<Vec3>,
    progress: impl Fn(usize, usize) + Sync,
) -> (SlicingShape, Vec<[u8; 4]>, Vec<[u8; 4]>) {
    let shape = shape(mesh, settings, directions);
    let share = settings.occlusion;
    let light: Vec<f32> = if share > 0.0 {
        let light = occlusion::light_from_around(mesh).into_iter();
        light.map(|light| 1.0 - share * (1.0 - light)).collect()
    } else {
        vec![1.0; mesh.triangles.len()]
    };
    let jobs = jobs(&shape);
    let picture = |&(orientation, slice, count): &(usize, u32, u32)| {
        let projection = Projection {
            orientation: &shape.orientations[orientation],
            centroid: shape.centroid,
            side: settings.pixels * settings.samples,
        };
        let seen = rasterize(mesh, &projection, slice, count);
        resolve(mesh, &light, &projection, &seen, settings.samples)
    };
    let pictures = in_parallel(&jobs, settings.threads, picture, progress);
    let (mut color, mut normal) = (Vec::new(), Vec::new());
    for (colors, normals) in pictures {
        color.extend(colors);
        normal.extend(normals);
    }
    (shape, color, normal)
}

/// Orientation, slice and number of slices of each layer.
fn jobs(shape: &SlicingShape) -> Vec<(usize, u32, u32)> {
    let mut jobs = Vec::with_capacity(shape.layers());
    for &count in &shape.levels {
        for orientation in 0..shape.orientations.len() {
            jobs.extend((0..count).map(|slice| (orientation, slice, count)));
        }
    }
    jobs
}

fn in_parallel<J: Sync>(
    jobs: &[J],
    threads: usize,
    work: impl Fn(&J) -> Pictures + Sync,
    progress: impl Fn(usize, usize) + Sync,
) -> Vec<Pictures> {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let threads = if threads == 0 { cores } else { threads };
    let (next, done) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let results: Vec<Mutex<Option<Pictures>>> = jobs.iter().map(|_| Mutex::new(None)).collect();
    std::thread::scope(|scope| {
        for _ in 0..threads.min(jobs.len()) {
            scope.spawn(|| {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(job) = jobs.get(index) else { break };
                    let result = work(job);
                    if let Ok(mut slot) = results[index].lock() {
                        *slot = Some(result);
                    }
                    progress(done.fetch_add(1, Ordering::Relaxed) + 1, jobs.len());
                }
            });
        }
    });
    let results = results
        .into_iter()
        .filter_map(|slot| slot.into_inner().ok().flatten());
    results.collect()
}

/// Orientations and boxes for a crown.
fn shape(mesh: &CrownMesh, settings: &BakeSettings, directions: Vec<Vec3>) -> SlicingShape {
    let (low, high) = mesh.bounds().unwrap_or_default();
    let centroid = 0.5 * (low + high);
    let positions = || mesh.triangles.iter().flat_map(CrownTriangle::positions);
    let radius = positions()
        .map(|p| p.distance(centroid))
        .fold(0.0, f32::max);
    // A flat crown has no depth; its box has, so that nothing is divided by 0.
    let thinnest = Vec3::splat(1e-3 * radius);
    let orientations = directions.into_iter().map(|direction| {
        let mut o = Orientation::facing(direction);
        let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for position in positions() {
            let p = o.axes(position - centroid);
            (low, high) = (low.min(p), high.max(p));
        }
        let room = (0.5 * (high - low)).max(thinnest);
        let middle = 0.5 * (low + high);
        let free = 1.0 + 2.0 * FREE / (settings.pixels as f32 - 2.0 * FREE).max(1.0);
        let room = room * Vec3::new(free, free, 1.0);
        (o.low, o.high) = (middle - room, middle + room);
        o
    });
    SlicingShape {
        centroid,
        radius,
        pixels: settings.pixels,
        levels: settings.levels.clone(),
        switches: settings.switches.clone(),
        correction: settings.correction,
        diffuse_transmission: mesh.diffuse_transmission(),
        sphere: matches!(settings.orientations, Orientations::Sphere(_)),
        vertical: settings.has_vertical(),
        orientations: orientations.collect(),
    }
}
