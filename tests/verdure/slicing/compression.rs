//! Crowns compressed on the GPU, beside the same as they were baked.

use bevy::prelude::*;
use bevy::render::renderer::RenderDevice;
use bevy_verdure::lab::{Pixels, Studio, mean_flip};
use bevy_verdure::prelude::*;

use super::{CROWN, SIZE, covered, eye, mean, shot, studio, sun};

fn pictures(studio: &mut Studio, compression: SlicingCompression) -> Vec<Pixels> {
    studio.world().insert_resource(compression);
    studio.headless.step();
    // Filtered and magnified, half-way between two orientations, small in coarse mip levels, and from above.
    [
        eye(60.0, 5.0, 8.0),
        eye(30.0, 10.0, 16.0),
        eye(75.0, 0.0, 60.0),
        eye(10.0, 70.0, 16.0),
    ]
    .map(|eye| studio.photograph(&shot(eye), Color::srgb(0.6, 0.8, 1.0)))
    .into()
}

#[test]
fn compressed_crowns_are_hardly_told_from_baked_ones() {
    for composition in [Composition::Blended, Composition::Hashed] {
        let settings = CrownSettings {
            composition,
            ..default()
        };
        let (mut studio, _) = studio(settings);
        sun(&mut studio);
        let baked = pictures(&mut studio, SlicingCompression::Never);
        let compressed = pictures(&mut studio, SlicingCompression::WhereSupported);
        let again = pictures(&mut studio, SlicingCompression::Never);
        let device = studio.world().resource::<RenderDevice>();
        let applies =
            SlicingCompression::WhereSupported.applies(CROWN.shape().pixels, device.features());
        for ((baked, compressed), again) in baked.iter().zip(&compressed).zip(&again) {
            assert_eq!(
                baked.rgb_bytes(),
                again.rgb_bytes(),
                "the choice is followed"
            );
            let is_same = baked.rgb_bytes() == compressed.rgb_bytes();
            assert_eq!(is_same, !applies, "compressed where the device can");
            let background = baked.rgb(0, 0);
            let cover = [baked, compressed].map(|picture| covered(picture, background));
            let flip = mean_flip(
                (SIZE.x, SIZE.y),
                &baked.rgb_bytes(),
                &compressed.rgb_bytes(),
            );
            let green = [baked, compressed].map(|picture| mean(picture, 1));
            println!("{composition:?}: FLIP {flip:.5}, covered {cover:?}, green {green:.3?}");
            // The least error of slicings against their meshes, 0.07 (docs/slicing.md): this one is hidden by it.
            assert!(flip < 0.07, "{flip}");
            // Errors of single pixels go both ways.
            assert!((green[0] - green[1]).abs() < 1.0, "{green:?}");
            assert!(cover[0].abs_diff(cover[1]) * 20 <= cover[0], "{cover:?}");
        }
    }
}
