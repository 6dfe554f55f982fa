//! A studio: one skeleton, one camera, and pictures of it, as colours or as figures.

use core::time::Duration;

use bevy::camera::{RenderTarget, ScalingMode};
use bevy::core_pipeline::tonemapping::{DebandDither, Tonemapping};
use bevy::math::{DVec2, DVec3};
use bevy::prelude::*;
use bevy::render::render_resource::TextureFormat;

use super::capture::Pixels;
use super::headless::Headless;
use crate::prelude::*;

/// Where a picture is taken from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shot {
    /// The eye, in world space.
    pub eye: Vec3,
    /// What it looks at.
    pub at: Vec3,
    /// What it sees.
    pub lens: Lens,
    /// Size of the picture in pixels.
    pub size: UVec2,
}

/// What an eye sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lens {
    /// Perspective, with a vertical field of view in radians.
    Perspective(f32),
    /// Orthographic, with a height in metres.
    Orthographic(f32),
}

/// Depth of the near plane of a studio's cameras, in metres.
pub const NEAR: f32 = 0.01;

impl Shot {
    /// The camera's transform. Looking straight up or down, the picture's top is towards −z.
    pub fn transform(&self) -> Transform {
        let forward = (self.at - self.eye).normalize_or(Vec3::NEG_Z);
        let up = if forward.y.abs() > 0.999 {
            Vec3::NEG_Z
        } else {
            Vec3::Y
        };
        Transform::from_translation(self.eye).looking_to(forward, up)
    }

    /// The camera's projection.
    pub fn projection(&self) -> Projection {
        match self.lens {
            Lens::Perspective(fov) => Projection::Perspective(PerspectiveProjection {
                fov,
                near: NEAR,
                aspect_ratio: self.size.x as f32 / self.size.y as f32,
                ..default()
            }),
            Lens::Orthographic(height) => Projection::Orthographic(OrthographicProjection {
                near: NEAR,
                far: 1e5,
                scaling_mode: ScalingMode::FixedVertical {
                    viewport_height: height,
                },
                ..OrthographicProjection::default_3d()
            }),
        }
    }

    /// The ray through a point of the picture, in pixels, in world space; its direction is one metre of depth long. In
    /// double precision, by the very matrices that the shaders are given.
    pub fn ray(&self, x: f32, y: f32) -> (DVec3, DVec3) {
        let size = self.size.as_vec2();
        let mut projection = self.projection();
        projection.update(size.x, size.y);
        let p = projection.get_clip_from_view().as_dmat4();
        let turn = Mat3::from_quat(self.transform().rotation).as_dmat3();
        let (x, y, size) = (f64::from(x), f64::from(y), size.as_dvec2());
        let ndc = DVec2::new(2.0 * x / size.x - 1.0, 1.0 - 2.0 * y / size.y);
        let scale = DVec2::new(p.x_axis.x, p.y_axis.y);
        let eye = self.eye.as_dvec3();
        match self.lens {
            Lens::Perspective(_) => {
                let direction = ((ndc + p.z_axis.xy()) / scale).extend(-1.0);
                (eye, turn * direction)
            }
            Lens::Orthographic(_) => {
                let offset = ((ndc - p.w_axis.xy()) / scale).extend(0.0);
                (eye + turn * offset, turn * DVec3::NEG_Z)
            }
        }
    }

    /// A shot that frames a box, seen from the front and a little above.
    pub fn framing(low: Vec3, high: Vec3, lens: Lens, size: UVec2) -> Self {
        let centre = 0.5 * (low + high);
        let radius = (0.5 * (high - low).length()).max(1e-3);
        let aspect = size.x as f32 / size.y as f32;
        let (distance, lens) = match lens {
            Lens::Perspective(fov) => {
                let narrow = 2.0 * ((0.5 * fov).tan() * aspect.min(1.0)).atan();
                (radius / (0.5 * narrow).sin(), lens)
            }
            Lens::Orthographic(height) if height > 0.0 => (radius * 2.0, lens),
            Lens::Orthographic(_) => (
                radius * 2.0,
                Lens::Orthographic(2.0 * radius / aspect.min(1.0)),
            ),
        };
        let direction = Vec3::new(0.35, 0.25, 1.0).normalize();
        Self {
            eye: centre + direction * (distance + NEAR),
            at: centre,
            lens,
            size,
        }
    }
}

/// A picture of figures: what each pixel sees of a plant.
#[derive(Clone, Debug)]
pub struct Figures {
    geometry: Pixels,
    normals: Pixels,
}

/// What a pixel sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeenPixel {
    /// Metres along the view axis.
    pub depth: f32,
    /// Index of the joint that ends the segment.
    pub segment: u32,
    /// Texture coordinates.
    pub uv: Vec2,
    /// Shading normal, world space.
    pub normal: Vec3,
}

impl Figures {
    /// Width and height.
    pub fn size(&self) -> UVec2 {
        self.geometry.size()
    }

    /// What a pixel sees; `None` for the background.
    pub fn get(&self, x: u32, y: u32) -> Option<SeenPixel> {
        let [depth, segment, u, v] = self.geometry.floats(x, y);
        if segment < 0.0 {
            return None;
        }
        let [nx, ny, nz, _] = self.normals.floats(x, y);
        Some(SeenPixel {
            depth,
            segment: segment as u32,
            uv: Vec2::new(u, v),
            normal: Vec3::new(nx, ny, nz),
        })
    }
}

/// A headless app with one camera.
pub struct Studio {
    /// The app.
    pub headless: Headless,
    camera: Entity,
    colours: Option<(UVec2, RenderTarget)>,
    figures: Option<(UVec2, RenderTarget)>,
}

/// How far time goes a frame.
const FRAME: Duration = Duration::from_millis(16);

/// The background of figures: no depth, no segment.
const MISS: LinearRgba = LinearRgba::new(-1.0, -1.0, -1.0, -1.0);

impl Default for Studio {
    fn default() -> Self {
        Self::new(|_| {})
    }
}

impl Studio {
    /// A studio with the crate's plugins, and whatever `configure` adds.
    pub fn new(configure: impl FnOnce(&mut App)) -> Self {
        Self::with(Headless::new(FRAME, |app| {
            app.add_plugins(VerdurePlugin);
            configure(app);
        }))
    }

    /// A studio whose frames are [drawn while the next one begins](Headless::pipelined). What it asks of the render world
    /// panics.
    pub fn pipelined() -> Self {
        Self::with(Headless::pipelined(FRAME, |app| {
            app.add_plugins(VerdurePlugin);
        }))
    }

    fn with(mut headless: Headless) -> Self {
        let camera = headless
            .world()
            .spawn((
                Camera3d::default(),
                Camera::default(),
                RenderTarget::None { size: UVec2::ONE },
                Msaa::Off,
                Tonemapping::None,
                DebandDither::Disabled,
            ))
            .id();
        Self {
            headless,
            camera,
            colours: None,
            figures: None,
        }
    }

    /// The world.
    pub fn world(&mut self) -> &mut World {
        self.headless.world()
    }

    /// The camera's entity.
    pub fn camera(&self) -> Entity {
        self.camera
    }

    /// Plants a skeleton.
    pub fn plant(&mut self, skeleton: Skeleton, settings: Frusta, transform: Transform) -> Entity {
        let material = frusta_material(Color::srgb(0.45, 0.4, 0.33));
        self.plant_in(skeleton, settings, transform, material)
    }

    /// Plants a skeleton with a material of its own.
    pub fn plant_in(
        &mut self,
        skeleton: Skeleton,
        settings: Frusta,
        transform: Transform,
        material: FrustaMaterial,
    ) -> Entity {
        let world = self.world();
        let skeleton = world.resource_mut::<Assets<Skeleton>>().add(skeleton);
        let material = world.resource_mut::<Assets<FrustaMaterial>>().add(material);
        let plant = (
            Skeleton3d(skeleton),
            settings,
            MeshMaterial3d(material),
            transform,
        );
        world.spawn(plant).id()
    }

    /// Despawns a plant.
    pub fn uproot(&mut self, plant: Entity) {
        self.world().despawn(plant);
    }

    /// Aims the camera at `target`.
    fn aim(&mut self, shot: &Shot, target: RenderTarget, background: LinearRgba) {
        let camera = self.camera;
        let mut camera = self.headless.world().entity_mut(camera);
        camera.insert((shot.transform(), shot.projection(), target));
        if let Some(mut camera) = camera.get_mut::<Camera>() {
            camera.clear_color = ClearColorConfig::Custom(background.into());
        }
    }

    /// A picture of colours.
    pub fn photograph(&mut self, shot: &Shot, background: Color) -> Pixels {
        let target = match &self.colours {
            Some((size, target)) if *size == shot.size => target.clone(),
            _ => {
                let target = self
                    .headless
                    .target(shot.size, TextureFormat::Rgba8UnormSrgb);
                self.colours = Some((shot.size, target.clone()));
                target
            }
        };
        self.aim(shot, target.clone(), background.to_linear());
        self.headless.step();
        self.headless.capture(&target)
    }

    /// A picture of figures. The materials of all plants are switched over and back.
    pub fn measure(&mut self, shot: &Shot) -> Figures {
        let geometry = self.measure_output(shot, FrustaOutput::Geometry);
        let normals = self.measure_output(shot, FrustaOutput::Normals);
        self.set_output(FrustaOutput::Shaded);
        Figures { geometry, normals }
    }

    /// A picture of one kind of figures, which the materials of all plants go on writing.
    pub fn measure_output(&mut self, shot: &Shot, output: FrustaOutput) -> Pixels {
        let (target, is_new) = match &self.figures {
            Some((size, target)) if *size == shot.size => (target.clone(), false),
            _ => {
                let target = self.headless.target(shot.size, TextureFormat::Rgba32Float);
                self.figures = Some((shot.size, target.clone()));
                (target, true)
            }
        };
        self.aim(shot, target.clone(), MISS);
        let is_other = self.set_output(output);
        // What a material writes, and a camera's target, reach the pipelines a frame later.
        if is_new || is_other {
            self.headless.step();
        }
        self.headless.capture(&target)
    }

    /// What all plants' materials write. Tells whether any wrote something else before.
    pub fn set_output(&mut self, output: FrustaOutput) -> bool {
        let world = self.headless.world();
        let mut materials = world.resource_mut::<Assets<FrustaMaterial>>();
        let others: Vec<_> = materials
            .iter()
            .filter(|(_, material)| material.extension.output != output)
            .map(|(id, _)| id)
            .collect();
        for id in &others {
            if let Some(mut material) = materials.get_mut(*id) {
                material.extension.output = output;
            }
        }
        !others.is_empty()
    }
}
