//! The paper's Figures 3, 5 and 6 as ours, and crowns that intersect.

use std::path::Path;

use bevy::prelude::*;
use bevy_verdure::lab::{Lens, Pixels, Shot, box_downsample};
use bevy_verdure::prelude::*;
use image::{ExtendedColorType, ImageEncoder, codecs::png};

use super::accuracy::{SKY, planted, uproot};
use super::intersecting::pair;
use super::lab::{Drawn, Lab};

/// Pixels along each side of a picture, of which there are two but for Figure 3.
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
    // Two trees before and after they change their order.
    let pair = pair(lab, 0.5);
    let beside = [89.0, 91.0].map(|azimuth| view(lab, azimuth, 18.0, 0.7));
    let one = [Transform::IDENTITY];
    let drawings = [
        ("slicing_3", sliced(true), &one[..], &[framed][..]),
        ("slicing_5", sliced(false), &one, &near),
        ("slicing_6", Drawn::Mesh, &one, &near),
        ("slicing_whole", sliced(false), &pair, &beside),
        (
            "slicing_bands",
            Drawn::InBands(slicing.clone(), default()),
            &pair,
            &beside,
        ),
    ];
    for (name, drawn, places, shots) in drawings {
        let pictures: Vec<_> = photographs(lab, &drawn, places, shots);
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

/// The second of two trees is another one's colour.
const REDDISH: Color = Color::srgb(1.0, 0.7, 0.45);

/// Rows of pictures of trees. Meshes have no mip levels: They are drawn larger and averaged down.
fn photographs(lab: &mut Lab, drawn: &Drawn, places: &[Transform], shots: &[Shot]) -> Vec<Vec<u8>> {
    let is_mesh = matches!(drawn, Drawn::Mesh);
    let camera = lab.studio.camera();
    let msaa = if is_mesh { Msaa::Off } else { Msaa::Sample4 };
    lab.studio.world().entity_mut(camera).insert(msaa);
    let trees = planted(lab, drawn, places);
    for tree in trees.iter().skip(1) {
        let world = lab.studio.world();
        let parts = world.get::<Children>(*tree);
        let parts: Vec<_> = parts.into_iter().flatten().copied().collect();
        for part in parts {
            if world.get::<SlicedCrown>(part).is_some() {
                world.entity_mut(part).insert(CrownTint(REDDISH));
            }
        }
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
    uproot(lab, &trees);
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
