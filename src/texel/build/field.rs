//! From functions of space (§3.3): implicit surfaces (J. Bloomenthal et al., *Introduction to Implicit Surfaces*,
//! 1997) and hypertextures (K. Perlin and E. Hoffert, *Hypertexture*, 1989).

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use bevy::math::Vec3;

use super::super::error::TexelError;
use super::super::parallel::for_each_chunk;
use super::super::progress::{BuildStep, Progress};
use super::draft::{Cell, Draft, Mark};
use super::{BuildReport, Built, VolumeSettings};

/// Builds a volume from an implicit function, which is greater than one inside.
///
/// Both functions are given a place in the volume, 0 to 1 along u, v and w, and are called by several threads.
/// Colours are linear. A function that is to tile repeats with 1 along u and v.
///
/// # Errors
/// When the function is no number somewhere, a colour is not finite where it is opaque, or the volume is refused
/// (see [`ReferenceVolume`](super::super::ReferenceVolume)).
pub fn from_implicit(
    function: impl Fn(Vec3) -> f32 + Sync,
    color: impl Fn(Vec3) -> Vec3 + Sync,
    settings: &VolumeSettings,
    progress: Progress,
) -> Result<Built, TexelError> {
    evaluate(&function, &color, 1.0, settings, progress)
}

/// Builds a volume from a hypertexture: the density, 0 to 1, and the linear colour of every place in the volume. What
/// is at least half dense is opaque.
///
/// # Errors
/// As [`from_implicit`].
pub fn from_hypertexture(
    hypertexture: impl Fn(Vec3) -> (f32, Vec3) + Sync,
    settings: &VolumeSettings,
    progress: Progress,
) -> Result<Built, TexelError> {
    let density = |at| hypertexture(at).0;
    let color = |at| hypertexture(at).1;
    // The next number below one half, so that one half is opaque.
    evaluate(&density, &color, 0.5f32.next_down(), settings, progress)
}

/// Every voxel whose centre has more than `threshold`. Its normal is against the gradient, by central differences
/// half a voxel away.
fn evaluate(
    function: &(dyn Fn(Vec3) -> f32 + Sync),
    color: &(dyn Fn(Vec3) -> Vec3 + Sync),
    threshold: f32,
    settings: &VolumeSettings,
    progress: Progress,
) -> Result<Built, TexelError> {
    let mut draft = Draft::new(settings.size, settings.lengths, settings.topology)?;
    let size = draft.size;
    let layer = draft.layer();
    let failure: Mutex<Option<(usize, TexelError)>> = Mutex::new(None);
    let fail = |index: usize, error: TexelError| {
        let mut failure = failure.lock().expect("nothing here panics");
        // The first place in order, whichever thread was first.
        if failure.as_ref().is_none_or(|(first, _)| index < *first) {
            *failure = Some((index, error));
        }
    };
    let step = Vec3::ONE / size.as_vec3();
    let done = AtomicUsize::new(0);
    for_each_chunk(&mut draft.cells, layer, |z, cells| {
        for (i, cell) in cells.iter_mut().enumerate() {
            let (x, y) = (i as u32 % size.x, i as u32 / size.x);
            let at = (Vec3::new(x as f32, y as f32, z as f32) + 0.5) * step;
            let value = function(at);
            if value.is_nan() {
                fail(z * layer + i, TexelError::FunctionNotFinite { at, value });
            }
            if value > threshold {
                let slope = |axis: Vec3| {
                    let half = step * axis * 0.5;
                    let metres = (settings.lengths * step).dot(axis);
                    (function(at - half) - function(at + half)) / metres
                };
                let normal = Vec3::new(slope(Vec3::X), slope(Vec3::Y), slope(Vec3::Z));
                let color = color(at);
                if !color.is_finite() {
                    fail(z * layer + i, TexelError::ColorNotFinite { at, color });
                }
                *cell = Cell::coloured(color, normal);
            }
        }
        // Slices are not done in order.
        let done = done.fetch_add(1, Ordering::Relaxed) + 1;
        progress(BuildStep::Slicing, done as f32 / size.z as f32);
    });
    if let Some((_, error)) = failure.into_inner().expect("nothing here panics") {
        return Err(error);
    }
    let report = BuildReport {
        surface_voxels: draft.count(Mark::Coloured),
        ..BuildReport::default()
    };
    draft.finish(report, progress)
}
