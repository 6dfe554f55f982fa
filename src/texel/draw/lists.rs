//! The slices of every surface in every view, listed anew in each frame.

use core::ops::Range;

use bevy::camera::primitives::Frustum;
use bevy::camera::visibility::RenderLayers;
use bevy::camera::{Camera3d, MainPassResolutionOverride};
use bevy::light::{NotShadowCaster, NotShadowReceiver};
use bevy::math::Affine3A;
use bevy::pbr::{LightEntity, MeshFlags};
use bevy::platform::collections::HashMap;
use bevy::prelude::*;
use bevy::render::Extract;
use bevy::render::render_resource::{Buffer, BufferUsages, RawBufferVec};
use bevy::render::renderer::{RenderDevice, RenderQueue};
use bevy::render::sync_world::MainEntity;
use bevy::render::view::ExtractedView;
use bevy::tasks::ComputeTaskPool;

use super::records::{SliceRecord, SurfaceRecord};
use super::source::{SeenFrom, SliceSource, view_from_eye};
use super::upload::TexelStats;
use crate::wind::Wind;

/// A surface in this frame.
struct SurfaceInFrame {
    source: SliceSource,
    world_from_local: Affine3A,
    previous: Affine3A,
    flags: MeshFlags,
    casts_shadows: bool,
    layers: RenderLayers,
}

/// The surfaces of this frame.
#[derive(Resource, Default)]
pub(crate) struct ExtractedTexels {
    surfaces: Vec<SurfaceInFrame>,
    /// Where surfaces are.
    places: HashMap<Entity, Affine3A>,
    /// Where they were.
    previous: HashMap<Entity, Affine3A>,
    /// The layers of views and lights, where these are not the usual one.
    layers: HashMap<Entity, RenderLayers>,
    wind: Vec3,
}

/// What is extracted of a surface.
type Extracted<'w> = (
    Entity,
    &'w SliceSource,
    &'w GlobalTransform,
    &'w InheritedVisibility,
    Has<NotShadowReceiver>,
    Has<NotShadowCaster>,
    Option<&'w RenderLayers>,
);

/// What sees, or casts light.
type Sees = Or<(
    With<Camera3d>,
    With<DirectionalLight>,
    With<PointLight>,
    With<SpotLight>,
)>;

/// Takes the surfaces over into the render world.
pub(crate) fn extract(
    mut texels: ResMut<ExtractedTexels>,
    surfaces: Extract<Query<Extracted>>,
    views: Extract<Query<(Entity, &RenderLayers), Sees>>,
    wind: Extract<Res<Wind>>,
) {
    let texels = &mut *texels;
    texels.wind = wind.limited();
    core::mem::swap(&mut texels.places, &mut texels.previous);
    texels.places.clear();
    texels.surfaces.clear();
    texels.layers.clear();
    let layers = views.iter().map(|(view, layers)| (view, layers.clone()));
    texels.layers.extend(layers);
    for (entity, source, transform, visibility, receives_none, casts_none, layers) in &surfaces {
        if !visibility.get() {
            continue;
        }
        let world_from_local = transform.affine();
        let previous = texels.previous.get(&entity).copied();
        texels.places.insert(entity, world_from_local);
        let mut flags = MeshFlags::NONE;
        flags.set(
            MeshFlags::SHADOW_RECEIVER | MeshFlags::TRANSMITTED_SHADOW_RECEIVER,
            !receives_none,
        );
        texels.surfaces.push(SurfaceInFrame {
            source: source.clone(),
            world_from_local,
            previous: previous.unwrap_or(world_from_local),
            flags,
            casts_shadows: !casts_none,
            layers: layers.cloned().unwrap_or_default(),
        });
    }
}

/// One surface in one view.
#[derive(Default)]
struct Job {
    view: usize,
    surface: usize,
    order: Vec<(f32, u32)>,
    lists: [Vec<SliceRecord>; 3],
}

/// What a view has of a surface across one axis.
#[derive(Clone)]
struct Listed {
    records: Range<u32>,
    surface: u64,
}

/// The slices of every surface in every view of this frame, on the GPU.
#[derive(Resource)]
pub(crate) struct SliceLists {
    records: RawBufferVec<SliceRecord>,
    surfaces: RawBufferVec<SurfaceRecord>,
    /// By view, and by the entity whose slices they are.
    listed: HashMap<(Entity, MainEntity), Listed>,
    views: Vec<(Entity, RenderLayers, SeenFrom)>,
    /// Kept from frame to frame, so that nothing is allocated.
    jobs: Vec<Job>,
}

impl Default for SliceLists {
    fn default() -> Self {
        let usage = BufferUsages::VERTEX | BufferUsages::COPY_DST;
        let mut lists = Self {
            records: RawBufferVec::new(usage),
            surfaces: RawBufferVec::new(usage),
            listed: HashMap::default(),
            views: Vec::new(),
            jobs: Vec::new(),
        };
        lists.records.set_label(Some("texel slices"));
        lists.surfaces.set_label(Some("texel surfaces"));
        lists
    }
}

impl SliceLists {
    /// The buffers of slices and of surfaces, which of the slices there are, and where the surface is, in bytes.
    pub(crate) fn get(
        &self,
        view: Entity,
        slices: MainEntity,
    ) -> Option<(&Buffer, &Buffer, Range<u32>, u64)> {
        let listed = self.listed.get(&(view, slices))?;
        let (records, surfaces) = (self.records.buffer()?, self.surfaces.buffer()?);
        Some((records, surfaces, listed.records.clone(), listed.surface))
    }

    /// Lists what all views have of all surfaces, in parallel: at most so many slices.
    fn list(&mut self, texels: &ExtractedTexels, limit: usize) {
        let count = self.views.len() * texels.surfaces.len();
        self.jobs
            .resize_with(count.max(self.jobs.len()), Job::default);
        let pairs =
            (0..self.views.len()).flat_map(|v| (0..texels.surfaces.len()).map(move |s| (v, s)));
        for (job, (view, surface)) in self.jobs.iter_mut().zip(pairs) {
            (job.view, job.surface) = (view, surface);
        }
        let pool = ComputeTaskPool::get();
        let chunk = count.div_ceil(4 * pool.thread_num().max(1)).max(1);
        let views = &self.views;
        pool.scope(|scope| {
            for jobs in self.jobs[..count].chunks_mut(chunk) {
                scope.spawn(async move {
                    for job in jobs {
                        job.lists.iter_mut().for_each(Vec::clear);
                        let surface = &texels.surfaces[job.surface];
                        let (_, layers, from) = &views[job.view];
                        let is_hidden = from.is_light && !surface.casts_shadows;
                        if is_hidden || !layers.intersects(&surface.layers) {
                            continue;
                        }
                        surface.source.list(
                            &surface.world_from_local,
                            from,
                            &mut job.order,
                            &mut job.lists,
                        );
                    }
                });
            }
        });
        self.records.clear();
        self.surfaces.clear();
        self.listed.clear();
        for surface in &texels.surfaces {
            let record =
                SurfaceRecord::new(&surface.world_from_local, &surface.previous, &surface.flags);
            self.surfaces.push(record);
        }
        for job in &self.jobs[..count] {
            let view = self.views[job.view].0;
            let slices = texels.surfaces[job.surface].source.slices;
            for (axis, list) in job.lists.iter().enumerate() {
                if list.is_empty() {
                    continue;
                }
                if self.records.len() + list.len() > limit {
                    error_once!(
                        "texels are left out: a frame has more than {limit} slices, all that a buffer of this device \
                         takes; raise TexelQuality::pixels or depth, or lower TexelSettings::most_slices"
                    );
                    continue;
                }
                let start = self.records.len() as u32;
                self.records.extend(list.iter().copied());
                let listed = Listed {
                    records: start..self.records.len() as u32,
                    surface: (job.surface * size_of::<SurfaceRecord>()) as u64,
                };
                for entity in [slices[axis], slices[axis + 3]] {
                    self.listed.insert((view, entity.into()), listed.clone());
                }
            }
        }
    }
}

/// What is asked of a view.
type Seeing<'w> = (
    Entity,
    &'w ExtractedView,
    Has<LightEntity>,
    Option<&'w Frustum>,
    Option<&'w MainPassResolutionOverride>,
);

/// Views that may show texels.
type ShowsTexels = Or<(With<Camera3d>, With<LightEntity>)>;

/// Chooses slices for every surface in every view, and writes the lists of them to the GPU.
pub(crate) fn list_slices(
    mut lists: ResMut<SliceLists>,
    texels: Res<ExtractedTexels>,
    views: Query<Seeing, ShowsTexels>,
    time: Res<Time>,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
    mut stats: ResMut<TexelStats>,
) {
    if device.is_changed() {
        // Buffers of a lost device are lost.
        *lists = SliceLists::default();
    }
    let lists = &mut *lists;
    lists.views.clear();
    if !texels.surfaces.is_empty() {
        let seen = views
            .iter()
            .map(|(entity, view, is_light, frustum, resolution)| {
                let world_from_view = view.world_from_view.affine();
                let height = resolution.map_or(view.viewport.w, |resolution| resolution.0.y);
                let half_spaces =
                    frustum.map(|frustum| frustum.half_spaces.map(|half| half.normal_d()));
                let from = SeenFrom {
                    view: view_from_eye(
                        &world_from_view,
                        &view.clip_from_view,
                        height as f32,
                        half_spaces.as_ref(),
                    ),
                    eye: world_from_view.translation.into(),
                    is_light,
                    wind: texels.wind,
                    time: time.elapsed_secs_wrapped(),
                };
                // Those of a light are its own, in all its views.
                let layers = texels
                    .layers
                    .get(&view.retained_view_entity.main_entity.id());
                (entity, layers.cloned().unwrap_or_default(), from)
            });
        lists.views.extend(seen);
    }
    // What is seen itself goes before what casts shadows.
    lists.views.sort_by_key(|(_, _, from)| from.is_light);
    let limit = device.limits().max_buffer_size as usize / size_of::<SliceRecord>();
    let limit = limit.min(u32::MAX as usize);
    lists.list(&texels, limit);
    stats.slices = lists.records.len();
    // Not for each that is added a buffer anew.
    let capacity = lists.records.len().next_power_of_two().min(limit);
    lists.records.reserve(capacity, &device);
    lists.records.write_buffer(&device, &queue);
    lists.surfaces.write_buffer(&device, &queue);
}
