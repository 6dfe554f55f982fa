//! Measuring: a headless app, the reference that judges the shaders, image error, and figures for charts.
//!
//! Behind the feature `lab`, which examples, tests and benches turn on; a game never compiles it.

mod args;
mod billboards;
mod broadleaf_crown;
mod capture;
pub mod charts;
mod checkout;
mod compare;
pub mod compositor;
mod daylight;
mod error;
mod exr_file;
mod headless;
pub mod limits;
mod model;
mod octahedral;
pub mod reference;
pub mod rivals;
mod shaders;
mod slicing_file;
mod studio;
mod supersample;
pub mod texel;
pub mod texel_scenes;
mod texture;
mod timing;

pub use args::{ChartArgs, CommonArgs, Size, parse_filling, parse_share, parse_size, parse_vec3};
pub use billboards::{Billboard, add_billboards};
pub use broadleaf_crown::broadleaf_crown;
pub use capture::{Pixels, load_png};
pub use checkout::checkout;
pub use compare::mean_flip;
pub use daylight::{Daylight, SKY, SUNLIGHT};
pub use error::GeometryError;
pub use exr_file::save_exr;
pub use headless::{Headless, adapter_name, wait_for_gpu};
pub use model::{Model, ModelPart, load_model};
pub use octahedral::{Impostor, ImpostorMaterial, ImpostorPlugin, add_impostor};
pub use slicing_file::{SavedSlicing, save_slicing};
pub use studio::{Figures, Lens, NEAR, SeenPixel, Shot, Studio};
pub use supersample::box_downsample;
pub use texture::{painted, texture};
pub use timing::{
    Clock, FrameStats, GpuClockPlugin, Race, Timing, Variant, gpu_frame, has_timestamps, median,
};
