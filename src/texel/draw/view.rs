//! The views of a frame: cameras, and the lights that cast shadows.

use bevy::camera::primitives::Frustum;
use bevy::camera::visibility::RenderLayers;
use bevy::camera::{Camera3d, MainPassResolutionOverride};
use bevy::pbr::LightEntity;
use bevy::prelude::*;
use bevy::render::view::ExtractedView;

use super::extract::ExtractedTexels;
use super::source::{SeenFrom, view_from_eye};

/// A view in this frame.
pub(crate) struct ViewInFrame {
    pub entity: Entity,
    pub layers: RenderLayers,
    pub from: SeenFrom,
}

/// What is asked of a view.
pub(crate) type Seeing<'w> = (
    Entity,
    &'w ExtractedView,
    Has<LightEntity>,
    Option<&'w Frustum>,
    Option<&'w MainPassResolutionOverride>,
);

/// Views that may show texels.
pub(crate) type ShowsTexels = Or<(With<Camera3d>, With<LightEntity>)>;

/// The views of a frame, with the time in seconds; none if there is nothing to see.
pub(crate) fn views<'a>(
    found: &'a Query<Seeing, ShowsTexels>,
    texels: &'a ExtractedTexels,
    time: f32,
) -> impl Iterator<Item = ViewInFrame> + 'a {
    let found = found.iter().filter(|_| !texels.surfaces.is_empty());
    found.map(move |(entity, view, is_light, frustum, resolution)| {
        let world_from_view = view.world_from_view.affine();
        let height = resolution.map_or(view.viewport.w, |resolution| resolution.0.y);
        let half_spaces = frustum.map(|frustum| frustum.half_spaces.map(|half| half.normal_d()));
        // Those of a light are its own, in all its views.
        let layers = texels
            .layers
            .get(&view.retained_view_entity.main_entity.id());
        ViewInFrame {
            entity,
            layers: layers.cloned().unwrap_or_default(),
            from: SeenFrom {
                view: view_from_eye(
                    &world_from_view,
                    &view.clip_from_view,
                    height as f32,
                    half_spaces.as_ref(),
                ),
                eye: world_from_view.translation.into(),
                is_light,
                wind: texels.wind,
                time,
            },
        }
    })
}
