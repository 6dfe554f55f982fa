//! The paper's mode, as it is drawn, against the compositor in double precision.

use bevy::camera::Hdr;
use bevy::math::DVec3;
use bevy::prelude::*;
use bevy_verdure::lab::Lens;
use bevy_verdure::lab::compositor::{Compositor, srgb_byte};
use bevy_verdure::prelude::*;

use super::{CROWN, UNLIT, eye, shot, studio};

#[test]
fn the_papers_mode_is_what_the_reference_composes() {
    let settings = CrownSettings {
        order: SliceOrder::Paper,
        ..UNLIT
    };
    let (mut studio, crown) = studio(settings);
    let camera = studio.camera();
    // Blended in 16-bit floats: 8 bits would round after each of ten slices.
    studio.world().entity_mut(camera).insert(Hdr);
    let turned = Transform::from_rotation(Quat::from_rotation_y(0.3)).with_scale(Vec3::splat(1.2));
    for (place, background) in [
        (Transform::IDENTITY, Color::BLACK),
        (turned, Color::srgb(0.6, 0.8, 1.0)),
    ] {
        studio.world().entity_mut(crown).insert(place);
        for eye in [
            eye(3.0, 0.0, 16.0),
            eye(25.0, 5.0, 14.0),
            eye(44.0, 20.0, 13.0),
            eye(200.0, -15.0, 14.0),
        ] {
            let mut shot = shot(eye);
            // So near that a pixel of a slice is more than one of the picture: no mip level is in play.
            shot.lens = Lens::Perspective(0.3);
            let seen = studio.photograph(&shot, background);
            let compositor = Compositor::new(&CROWN, place.to_matrix().as_dmat4(), eye.as_dvec3());
            let light = background.to_linear();
            let light = DVec3::new(light.red.into(), light.green.into(), light.blue.into());
            let expected = compositor.composite(&shot, light);
            let (mut wrong, mut worst) = (0, 0);
            for (i, expected) in expected.iter().enumerate() {
                let found = seen.rgb(i as u32 % shot.size.x, i as u32 / shot.size.x);
                let expected = expected.to_array().map(srgb_byte);
                let off = found
                    .iter()
                    .zip(expected)
                    .map(|(a, b)| a.abs_diff(b))
                    .max()
                    .unwrap_or(0);
                worst = worst.max(off);
                wrong += usize::from(off > 1);
            }
            println!(
                "{wrong} of {} pixels are more than 1/255 off, the worst by {worst}",
                expected.len()
            );
            assert!(
                wrong * 1000 <= expected.len(),
                "{eye}: {wrong}, worst {worst}"
            );
            assert!(super::covered(&seen, seen.rgb(0, 0)) > 2000);
        }
    }
}
