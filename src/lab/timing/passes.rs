//! What the device says its passes took, by Bevy's render diagnostics.
//!
//! A frame's figures arrive two frames later, when the device is waited for after each.

use std::time::Instant;

use bevy::diagnostic::DiagnosticsStore;
use bevy::prelude::*;
use bevy::render::renderer::RenderDevice;
use bevy::render::settings::WgpuFeatures;

/// Whether a device has the timestamps that passes are timed by.
pub fn has_timestamps(world: &World) -> bool {
    let device = world.get_resource::<RenderDevice>();
    device.is_some_and(|device| device.features().contains(WgpuFeatures::TIMESTAMP_QUERY))
}

/// Names and milliseconds of the passes whose figures arrived after `since`. Empty without
/// [`RenderDiagnosticsPlugin`](bevy::render::diagnostic::RenderDiagnosticsPlugin), or without timestamps.
///
/// Spans within spans are left out: their time is in that of the outer ones.
pub fn gpu_passes(world: &World, since: Instant) -> Vec<(String, f64)> {
    let Some(store) = world.get_resource::<DiagnosticsStore>() else {
        return Vec::new();
    };
    let fresh = store.iter().filter_map(|diagnostic| {
        let path = diagnostic.path().as_str();
        let name = path.strip_prefix("render/")?.strip_suffix("/elapsed_gpu")?;
        let measured = diagnostic.measurement()?;
        (measured.time >= since).then(|| (name.to_owned(), measured.value))
    });
    let all: Vec<_> = fresh.collect();
    let is_inner = |name: &str| {
        let outer = |(other, _): &(String, f64)| {
            name.strip_prefix(other.as_str())
                .is_some_and(|rest| rest.starts_with('/'))
        };
        all.iter().any(outer)
    };
    all.iter()
        .filter(|(name, _)| !is_inner(name))
        .cloned()
        .collect()
}
