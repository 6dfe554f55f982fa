//! What keys change.

use bevy::camera::visibility::VisibilityRange;
use bevy::prelude::*;
use bevy_verdure::prelude::*;
use bevy_verdure::slicing::close_up;

use super::trees::{Drawn, MeshCrown};
use super::walk::Walk;

/// What is shown.
#[derive(Resource)]
pub struct Shown {
    pub drawn: Drawn,
    pub settings: CrownSettings,
    /// Whether crowns of slices give over to their triangles right up close.
    pub close_up: bool,
}

/// Metres from the eye within which crowns give over to their triangles.
const CLOSE_UP: core::ops::Range<f32> = 8.0..12.0;

pub fn press(
    keys: Res<ButtonInput<KeyCode>>,
    mut shown: ResMut<Shown>,
    mut walk: ResMut<Walk>,
    mut wind: ResMut<Wind>,
) {
    let pressed = |key| keys.just_pressed(key);
    if pressed(KeyCode::KeyP) {
        walk.stands = !walk.stands;
    }
    if keys.any_just_pressed([KeyCode::KeyW, KeyCode::KeyA, KeyCode::KeyS, KeyCode::KeyD]) {
        walk.stands = true;
    }
    if pressed(KeyCode::KeyG) {
        let next = if wind.velocity == Vec3::ZERO {
            Vec3::new(6.0, 0.0, 2.0)
        } else {
            Vec3::ZERO
        };
        *wind = Wind::new(next);
    }
    if pressed(KeyCode::KeyM) {
        shown.drawn = match shown.drawn {
            Drawn::Mesh => Drawn::Slicing,
            Drawn::Slicing => Drawn::Mesh,
        };
    }
    if pressed(KeyCode::KeyN) {
        shown.close_up = !shown.close_up;
    }
    let mut settings = shown.settings;
    if pressed(KeyCode::KeyF) {
        settings.frames = !settings.frames;
    }
    if pressed(KeyCode::KeyL) {
        settings.lighting = match settings.lighting {
            PlantLighting::Simple => PlantLighting::Full,
            PlantLighting::Full => PlantLighting::Unlit,
            PlantLighting::Unlit => PlantLighting::Simple,
        };
    }
    if pressed(KeyCode::KeyX) {
        settings.left_out = (settings.left_out + 1) % 3;
    }
    if pressed(KeyCode::KeyH) {
        settings.composition = match settings.composition {
            Composition::Blended => Composition::Hashed,
            Composition::Hashed => Composition::Blended,
        };
    }
    if pressed(KeyCode::KeyB) {
        settings.order = match settings.order {
            SliceOrder::Steady => SliceOrder::Paper,
            SliceOrder::Paper => SliceOrder::Steady,
        };
    }
    if settings != shown.settings {
        shown.settings = settings;
    }
}

/// Shows crowns as they are wanted.
pub fn show(
    shown: Res<Shown>,
    mut commands: Commands,
    mut crowns: Query<(Entity, &mut CrownSettings, &mut Visibility), Without<MeshCrown>>,
    mut meshes: Query<(Entity, &mut Visibility), With<MeshCrown>>,
) {
    if !shown.is_changed() {
        return;
    }
    let slices = shown.drawn == Drawn::Slicing;
    let both = slices && shown.close_up;
    let visibility = |is_shown| {
        if is_shown {
            Visibility::Inherited
        } else {
            Visibility::Hidden
        }
    };
    let [near, far] = close_up(CLOSE_UP);
    let mut limit = |entity, range: &VisibilityRange| {
        let mut entity = commands.entity(entity);
        if both {
            entity.insert(range.clone());
        } else {
            entity.remove::<VisibilityRange>();
        }
    };
    for (entity, mut settings, mut is_visible) in &mut crowns {
        settings.set_if_neq(shown.settings);
        is_visible.set_if_neq(visibility(slices));
        limit(entity, &far);
    }
    for (entity, mut is_visible) in &mut meshes {
        is_visible.set_if_neq(visibility(!slices || both));
        limit(entity, &near);
    }
}
