//! An app without a window, stepped frame by frame, that gives its pictures back.

use core::time::Duration;

use bevy::camera::RenderTarget;
use bevy::image::ImageSampler;
use bevy::light::cluster::GlobalClusterSettings;
use bevy::log::LogPlugin;
use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::render::pipelined_rendering::PipelinedRenderingPlugin;
use bevy::render::render_resource::{PollType, TextureFormat, TextureUsages};
use bevy::render::renderer::{RenderAdapterInfo, RenderDevice};
use bevy::render::settings::{RenderCreation, WgpuSettings};
use bevy::render::view::screenshot::{Screenshot, ScreenshotCaptured};
use bevy::time::TimeUpdateStrategy;
use bevy::window::ExitCondition;

use super::capture::Pixels;
use super::shaders::load_shaders;

/// Frames after which a picture that has not come back never will.
const PATIENCE: usize = 64;

/// An app that renders without a window. Time advances by a fixed step a frame, and shaders are there and pipelines compiled
/// before they are needed, so that two runs draw the same pictures.
pub struct Headless {
    app: App,
}

#[derive(Resource, Default)]
struct Captured(Option<Image>);

impl Headless {
    /// An app with Bevy's default plugins, short of a window, and whatever `configure` adds. `step` is how far time
    /// goes a frame.
    pub fn new(step: Duration, configure: impl FnOnce(&mut App)) -> Self {
        Self::with_settings(step, WgpuSettings::default(), configure)
    }

    /// As [`new`](Self::new), on a device with other limits or features.
    pub fn with_settings(
        step: Duration,
        settings: WgpuSettings,
        configure: impl FnOnce(&mut App),
    ) -> Self {
        Self::build(step, settings, false, configure)
    }

    /// As [`new`](Self::new), but each frame is drawn while the next one begins, as in games: pictures are of a frame
    /// before, and the render world is out of reach.
    pub fn pipelined(step: Duration, configure: impl FnOnce(&mut App)) -> Self {
        Self::build(step, WgpuSettings::default(), true, configure)
    }

    fn build(
        step: Duration,
        settings: WgpuSettings,
        is_pipelined: bool,
        configure: impl FnOnce(&mut App),
    ) -> Self {
        let mut app = App::new();
        let plugins = DefaultPlugins
            .set(WindowPlugin {
                primary_window: None,
                exit_condition: ExitCondition::DontExit,
                ..default()
            })
            .set(RenderPlugin {
                render_creation: RenderCreation::Automatic(Box::new(settings)),
                synchronous_pipeline_compilation: true,
                ..default()
            })
            .set(LogPlugin {
                filter: format!(
                    "{},bevy_render=warn,wgpu_hal=error",
                    bevy::log::DEFAULT_FILTER
                ),
                level: bevy::log::Level::WARN,
                ..default()
            })
            .disable::<bevy::winit::WinitPlugin>();
        let plugins = if is_pipelined {
            plugins
        } else {
            // One frame is done before the next begins, so that a picture is of the frame it was asked in.
            plugins.disable::<PipelinedRenderingPlugin>()
        };
        app.add_plugins(plugins)
            .insert_resource(TimeUpdateStrategy::ManualDuration(step))
            .init_resource::<Captured>();
        configure(&mut app);
        app.finish();
        app.cleanup();
        load_shaders(app.world_mut());
        // Lights are sorted on the CPU: sorted on Mesa's software device, spot lights light nothing.
        if let Some(mut clusters) = app.world_mut().get_resource_mut::<GlobalClusterSettings>() {
            clusters.gpu_clustering = None;
        }
        Self { app }
    }

    /// The app's world.
    pub fn world(&mut self) -> &mut World {
        self.app.world_mut()
    }

    /// The app.
    pub fn app(&mut self) -> &mut App {
        &mut self.app
    }

    /// Runs one frame.
    pub fn step(&mut self) {
        self.app.update();
    }

    /// Runs frames until `done` says so, at most `limit` of them; tells whether it did.
    pub fn step_until(&mut self, limit: usize, mut done: impl FnMut(&mut World) -> bool) -> bool {
        for _ in 0..limit {
            self.app.update();
            if done(self.app.world_mut()) {
                return true;
            }
        }
        false
    }

    /// An image to render to: `Rgba8UnormSrgb` for pictures, `Rgba32Float` for figures.
    pub fn target(&mut self, size: UVec2, format: TextureFormat) -> RenderTarget {
        let mut image = Image::new_target_texture(size.x, size.y, format, None);
        image.texture_descriptor.usage |= TextureUsages::COPY_SRC;
        image.sampler = ImageSampler::nearest();
        let handle = self.world().resource_mut::<Assets<Image>>().add(image);
        RenderTarget::Image(handle.into())
    }

    /// Runs one more frame and gives back what it drew to `target`.
    ///
    /// # Panics
    /// If the picture never comes back: nothing renders to the target.
    pub fn capture(&mut self, target: &RenderTarget) -> Pixels {
        self.world().resource_mut::<Captured>().0 = None;
        self.world().spawn(Screenshot(target.clone())).observe(
            |captured: On<ScreenshotCaptured>, mut result: ResMut<Captured>| {
                result.0 = Some(captured.image.clone());
            },
        );
        for _ in 0..PATIENCE {
            self.app.update();
            if let Some(image) = self.world().resource_mut::<Captured>().0.take() {
                return Pixels::new(image);
            }
        }
        panic!("no picture after {PATIENCE} frames: does any camera render to this target?");
    }
}

/// The name of the adapter that an app renders with.
pub fn adapter_name(world: &World) -> String {
    world
        .get_resource::<RenderAdapterInfo>()
        .map_or_else(|| "none".into(), |info| info.name.clone())
}

/// Waits until the device has done all that it was given, so that a frame's time is all of it.
pub fn wait_for_gpu(world: &World) {
    if let Some(device) = world.get_resource::<RenderDevice>() {
        // An error here is a lost device, which the next frame reports.
        let _ = device.poll(PollType::wait_indefinitely());
    }
}
