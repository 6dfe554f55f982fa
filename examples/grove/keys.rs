//! What keys change.

use bevy::prelude::*;
use bevy_verdure::prelude::*;

use super::trees::{Drawn, MeshCrown};
use super::walk::Walk;

/// What is shown.
#[derive(Resource)]
pub struct Shown {
    pub drawn: Drawn,
    pub settings: CrownSettings,
}

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
    mut crowns: Query<(&mut CrownSettings, &mut Visibility), Without<MeshCrown>>,
    mut meshes: Query<&mut Visibility, With<MeshCrown>>,
) {
    if !shown.is_changed() {
        return;
    }
    let visibility = |is_shown| {
        if is_shown {
            Visibility::Inherited
        } else {
            Visibility::Hidden
        }
    };
    for (mut settings, mut is_visible) in &mut crowns {
        settings.set_if_neq(shown.settings);
        is_visible.set_if_neq(visibility(shown.drawn == Drawn::Slicing));
    }
    for mut is_visible in &mut meshes {
        is_visible.set_if_neq(visibility(shown.drawn == Drawn::Mesh));
    }
}
