//! What the device says that a frame took, by Bevy's render diagnostics.
//!
//! Bevy times its passes one by one, but not those of shadow maps. So two timestamps of our own stand at the start and
//! at the end of all that a frame is made of. Its figures arrive two frames later, when the device is waited for after
//! each.

use std::time::Instant;

use bevy::diagnostic::{DiagnosticPath, DiagnosticsStore};
use bevy::prelude::*;
use bevy::render::RenderApp;
use bevy::render::diagnostic::{
    DiagnosticsRecorder, RecordDiagnostics, RenderDiagnosticsPlugin, begin_diagnostics_frame,
    resolve_encoder,
};
use bevy::render::render_resource::{CommandEncoder, CommandEncoderDescriptor};
use bevy::render::renderer::{
    PendingCommandBuffers, RenderDevice, RenderGraph, RenderGraphSystems,
};
use bevy::render::settings::WgpuFeatures;

/// The span's name.
const FRAME: &str = "verdure_frame";

/// Has the device time its frames, for [`gpu_frame`].
pub struct GpuClockPlugin;

impl Plugin for GpuClockPlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins(RenderDiagnosticsPlugin);
        if let Some(render_app) = app.get_sub_app_mut(RenderApp) {
            render_app.add_systems(
                RenderGraph,
                (
                    begin
                        .after(begin_diagnostics_frame)
                        .in_set(RenderGraphSystems::Begin),
                    end.after(RenderGraphSystems::Render)
                        .before(resolve_encoder)
                        .before(RenderGraphSystems::Submit),
                ),
            );
        }
    }
}

// Both have the world to themselves, which makes them run in one thread: a span ends in the thread that it began in.

fn begin(world: &mut World) {
    record(world, |recorder, encoder| {
        recorder.begin_time_span(encoder, FRAME.into());
    });
}

fn end(world: &mut World) {
    record(world, DiagnosticsRecorder::end_time_span);
}

/// Records commands that are carried out between those of the systems before and after.
fn record(world: &mut World, record: impl FnOnce(&DiagnosticsRecorder, &mut CommandEncoder)) {
    let device = world.resource::<RenderDevice>();
    let mut encoder = device.create_command_encoder(&CommandEncoderDescriptor::default());
    if let Some(recorder) = world.get_resource::<DiagnosticsRecorder>() {
        record(recorder, &mut encoder);
    }
    let mut pending = world.resource_mut::<PendingCommandBuffers>();
    pending.push([encoder.finish()]);
}

/// Whether a device has the timestamps that frames are timed by.
pub fn has_timestamps(world: &World) -> bool {
    let needed = WgpuFeatures::TIMESTAMP_QUERY | WgpuFeatures::TIMESTAMP_QUERY_INSIDE_ENCODERS;
    let device = world.get_resource::<RenderDevice>();
    device.is_some_and(|device| device.features().contains(needed))
}

/// Milliseconds that the device spent on a frame whose figures arrived after `since`. `None` without
/// [`GpuClockPlugin`], or without timestamps.
pub fn gpu_frame(world: &World, since: Instant) -> Option<f64> {
    let store = world.get_resource::<DiagnosticsStore>()?;
    let path = DiagnosticPath::from_components(["render", FRAME, "elapsed_gpu"]);
    let measured = store.get_measurement(&path)?;
    (measured.time >= since).then_some(measured.value)
}
