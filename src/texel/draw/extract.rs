//! What the render world takes over of surfaces in each frame.

use bevy::camera::Camera3d;
use bevy::camera::visibility::RenderLayers;
use bevy::light::{NotShadowCaster, NotShadowReceiver};
use bevy::math::Affine3A;
use bevy::pbr::MeshFlags;
use bevy::platform::collections::HashMap;
use bevy::prelude::*;
use bevy::render::Extract;
use bevy::render::renderer::RenderDevice;

use super::limit::DeviceLimits;
use super::records::SurfaceRecord;
use super::source::SliceSource;
use crate::wind::Wind;

/// A surface in this frame.
pub(crate) struct SurfaceInFrame {
    pub source: SliceSource,
    pub world_from_local: Affine3A,
    pub record: SurfaceRecord,
    pub casts_shadows: bool,
    pub layers: RenderLayers,
}

/// The surfaces of this frame.
#[derive(Resource, Default)]
pub(crate) struct ExtractedTexels {
    pub surfaces: Vec<SurfaceInFrame>,
    /// Where surfaces are.
    places: HashMap<Entity, Affine3A>,
    /// Where they were.
    previous: HashMap<Entity, Affine3A>,
    /// The layers of views and lights, where these are not the usual one.
    pub layers: HashMap<Entity, RenderLayers>,
    pub wind: Vec3,
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
    device: Option<Res<RenderDevice>>,
) {
    let texels = &mut *texels;
    let most = DeviceLimits::of(device.as_deref()).surfaces;
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
        if texels.surfaces.len() == most {
            error_once!(
                "texels are left out: there are more than {most} surfaces, all that a buffer of this device takes; join \
                 meshes"
            );
            break;
        }
        let world_from_local = transform.affine();
        let previous = texels.previous.get(&entity).copied();
        let previous = previous.unwrap_or(world_from_local);
        texels.places.insert(entity, world_from_local);
        let mut flags = MeshFlags::NONE;
        flags.set(
            MeshFlags::SHADOW_RECEIVER | MeshFlags::TRANSMITTED_SHADOW_RECEIVER,
            !receives_none,
        );
        texels.surfaces.push(SurfaceInFrame {
            source: source.clone(),
            world_from_local,
            record: SurfaceRecord::new(&world_from_local, &previous, &flags),
            casts_shadows: !casts_none,
            layers: layers.cloned().unwrap_or_default(),
        });
    }
}
