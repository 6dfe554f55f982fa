//! The paper's Figures 3, 5 and 6 as ours.

use std::path::Path;

use bevy::prelude::*;
use bevy_verdure::lab::{Lens, Pixels, Shot, box_downsample};
use bevy_verdure::prelude::*;
use image::{ExtendedColorType, ImageEncoder, codecs::png};

use super::accuracy::SKY;
use super::lab::{Drawn, Lab};

/// Pixels along each side of a picture, of which Figures 5 and 6 have two.
const SIDE: u32 = 224;
/// Samples along each side of a pixel of meshes.
const SAMPLES: u32 = 4;
/// Rows of white between two pictures.
const GAP: usize = 4;

/// Draws all figures.
pub fn draw(lab: &mut Lab, dir: &Path) -> Result<(), String> {
    std::fs::create_dir_all(dir).map_err(|error| format!("{}: {error}", dir.display()))?;
    let slicing = lab.bake(&BakeSettings::default())?;
    let sliced = |frames| {
        let settings = CrownSettings {
            frames,
            ..default()
        };
        Drawn::Slicing(slicing.clone(), settings)
    };
    // In line with an orientation, and half-way to the next.
    let near = [0.0, 30.0].map(|azimuth| view(lab, azimuth, 9.0, 0.74));
    let framed = view(lab, 30.0, 22.0, 0.42);
    let drawings = [
        ("slicing_3", sliced(true), &[framed][..]),
        ("slicing_5", sliced(false), &near[..]),
        ("slicing_6", Drawn::Mesh, &near[..]),
    ];
    for (name, drawn, shots) in drawings {
        let pictures: Vec<_> = photographs(lab, &drawn, shots);
        let file = dir.join(name).with_extension("png");
        save(&file, &pictures)?;
        println!("{}", file.display());
    }
    Ok(())
}

/// The tree from an azimuth in degrees and a distance, at a vertical field of view.
fn view(lab: &Lab, azimuth: f32, distance: f32, fov: f32) -> Shot {
    let at = lab.centroid();
    let (sin, cos) = azimuth.to_radians().sin_cos();
    Shot {
        eye: at + Vec3::new(cos, 0.0, sin) * distance,
        at,
        lens: Lens::Perspective(fov),
        size: UVec2::splat(SIDE),
    }
}

/// Rows of pictures of a tree. Meshes have no mip levels: They are drawn larger and averaged down.
fn photographs(lab: &mut Lab, drawn: &Drawn, shots: &[Shot]) -> Vec<Vec<u8>> {
    let is_mesh = matches!(drawn, Drawn::Mesh);
    let camera = lab.studio.camera();
    let msaa = if is_mesh { Msaa::Off } else { Msaa::Sample4 };
    lab.studio.world().entity_mut(camera).insert(msaa);
    let tree = lab.plant(drawn, Transform::IDENTITY);
    for _ in 0..3 {
        lab.studio.headless.step();
    }
    let pictures = shots.iter().map(|shot| {
        if !is_mesh {
            return lab.studio.photograph(shot, SKY).rgb_bytes();
        }
        let fine = Shot {
            size: shot.size * SAMPLES,
            ..*shot
        };
        let fine: Pixels = lab.studio.photograph(&fine, SKY);
        box_downsample(shot.size, SAMPLES, &fine.rgb_bytes())
    });
    let pictures = pictures.collect();
    lab.studio.world().despawn(tree);
    lab.studio.headless.step();
    pictures
}

/// Writes pictures as one, the first on top.
fn save(file: &Path, pictures: &[Vec<u8>]) -> Result<(), String> {
    let gap = vec![255; SIDE as usize * 3 * GAP];
    let rows = pictures.join(&gap[..]);
    let wrong = |error: &dyn core::fmt::Display| format!("{}: {error}", file.display());
    let out = std::fs::File::create(file).map_err(|error| wrong(&error))?;
    let encoder = png::PngEncoder::new_with_quality(
        std::io::BufWriter::new(out),
        png::CompressionType::Best,
        png::FilterType::Adaptive,
    );
    let height = rows.len() as u32 / 3 / SIDE;
    encoder
        .write_image(&rows, SIDE, height, ExtendedColorType::Rgb8)
        .map_err(|error| wrong(&error))
}
