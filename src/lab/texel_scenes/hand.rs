//! A hand that strokes an animal's back to and fro.

use core::f32::consts::{FRAC_PI_2, TAU};

use bevy::prelude::*;

use super::surfaces::on_back;
use crate::texel::TexelBrush;

/// Seconds in which fur that was stroked rises again.
pub const RECOVERY: f32 = 8.0;

/// Seconds to and fro.
const PERIOD: f32 = 3.2;

/// How far ahead of time it is, in seconds, and how soon: a first picture shows what it has stroked.
const AHEAD: f32 = 2.6;
const SOON: f32 = 0.12;

/// What moves to and fro.
#[derive(Component)]
pub struct Hand;

/// Puts a hand where it begins.
pub fn bring_hand(
    commands: &mut Commands,
    meshes: &mut Assets<Mesh>,
    materials: &mut Assets<StandardMaterial>,
) {
    let brush = TexelBrush {
        radius: 0.3,
        ..default()
    };
    commands.spawn((
        Hand,
        brush,
        Mesh3d(meshes.add(Capsule3d::new(0.08, 0.2))),
        MeshMaterial3d(materials.add(Color::srgb(0.3, 0.42, 0.55))),
        place(0.0),
    ));
}

/// Moves hands as time goes on.
pub fn move_hands(time: Res<Time>, mut hands: Query<&mut Transform, With<Hand>>) {
    let seconds = time.elapsed_secs();
    let seconds = seconds + AHEAD * (seconds / SOON).min(1.0);
    for mut hand in &mut hands {
        *hand = place(seconds);
    }
}

/// A hand in the fur, across the back.
fn place(seconds: f32) -> Transform {
    let along = -0.9 * (TAU * seconds / PERIOD).cos();
    let turn = 0.45 + 0.4 * (0.8 * seconds).cos();
    let skin = on_back(along, turn);
    let out = Vec3::new(0.0, turn.cos(), turn.sin());
    Transform::from_translation(skin + out * 0.1)
        .with_rotation(Quat::from_rotation_x(turn + FRAC_PI_2))
}
