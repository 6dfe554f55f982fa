//! Pictures of a volume: four copies as the reference march sees them, and slices.

use bevy::math::{DVec2, DVec3, Vec3};
use bevy_verdure::lab::texel::{ReferenceFacet, ReferenceSteps, ReferenceTexels};
use bevy_verdure::texel::color::{linear_to_srgb, srgb_to_linear};
use bevy_verdure::texel::{ReferenceVolume, SliceAxis, SliceSet};
use image::{Rgb, RgbImage, imageops};

/// Side of each picture.
const SIDE: u32 = 320;
/// Samples along each side of a pixel.
const SAMPLES: u32 = 2;

/// Three views above, and below them all slices along w, v and u in a few.
pub fn sheet(volume: &ReferenceVolume) -> RgbImage {
    let mut sheet = RgbImage::from_pixel(SIDE * 3, SIDE * 2, Rgb([24, 26, 30]));
    let views = [
        DVec3::new(0.2, -0.5, 2.0),
        DVec3::new(0.9, -1.5, 1.1),
        DVec3::new(0.4, -2.2, 0.35),
    ];
    for (i, from) in (0..).zip(views) {
        imageops::replace(&mut sheet, &view(volume, from), i64::from(i * SIDE), 0);
    }
    for (i, axis) in (0..).zip([SliceAxis::W, SliceAxis::V, SliceAxis::U]) {
        imageops::replace(
            &mut sheet,
            &slices(volume, axis),
            i64::from(i * SIDE),
            i64::from(SIDE),
        );
    }
    sheet
}

/// Two by two copies on the ground, seen from a direction.
fn view(volume: &ReferenceVolume, from: DVec3) -> RgbImage {
    let lengths = volume.lengths().as_dvec3();
    let corner = |u: f64, v: f64| {
        (
            DVec3::new(u * lengths.x, v * lengths.y, 0.0),
            DVec2::new(u, v),
        )
    };
    let facet = |corners: [(f64, f64); 3]| {
        let corners = corners.map(|(u, v)| corner(u, v));
        ReferenceFacet {
            positions: corners.map(|corner| corner.0),
            heights: [DVec3::Z * lengths.z; 3],
            uvs: corners.map(|corner| corner.1),
        }
    };
    let facets = [
        facet([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0)]),
        facet([(-1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]),
    ];
    let texels = ReferenceTexels::new(volume, &facets, ReferenceSteps::default());
    let size = lengths.x.max(lengths.y).max(lengths.z);
    let (eye, at) = (from * size * 1.35, DVec3::Z * lengths.z * 0.3);
    let ahead = (at - eye).normalize();
    let right = ahead.cross(DVec3::Z).normalize();
    let up = right.cross(ahead);
    let light = DVec3::new(-0.5, -0.4, 0.8).normalize();
    RgbImage::from_fn(SIDE, SIDE, |x, y| {
        let mut sum = Vec3::ZERO;
        for sample in 0..SAMPLES * SAMPLES {
            let place = |pixel: u32, sub: u32| {
                (f64::from(pixel) + (f64::from(sub) + 0.5) / f64::from(SAMPLES)) / f64::from(SIDE)
                    - 0.5
            };
            let (px, py) = (place(x, sample % SAMPLES), place(y, sample / SAMPLES));
            let dir = ahead + right * px - up * py;
            sum += match texels.cast(eye, dir, 0.0) {
                Some(hit) => {
                    let [r, g, b, _] = hit
                        .color
                        .map(|byte| srgb_to_linear(f32::from(byte) / 255.0));
                    let lit = 0.25 + 0.75 * hit.normal.dot(light).max(0.0);
                    Vec3::new(r, g, b) * lit as f32
                }
                None => Vec3::new(0.25, 0.35, 0.5),
            };
        }
        let pixel = (sum / (SAMPLES * SAMPLES) as f32)
            .to_array()
            .map(linear_to_srgb);
        Rgb(pixel.map(|value| (value * 255.0).round() as u8))
    })
}

/// Sixteen slices along an axis, the lowest at the lower left.
fn slices(volume: &ReferenceVolume, axis: SliceAxis) -> RgbImage {
    let set = SliceSet::new(volume, axis, 16);
    let level = &set.levels[0];
    let side = SIDE / 4;
    RgbImage::from_fn(SIDE, SIDE, |x, y| {
        let slice = x / side + (3 - y / side) * 4;
        let (column, row) = (x % side, side - 1 - y % side);
        if slice >= set.count || column == 0 || row == 0 {
            return Rgb([90, 30, 60]);
        }
        let [width, height] = level.size;
        // Upright slices keep their proportions.
        let [a, b] = axis.in_plane().map(|axis| volume.lengths()[axis.index()]);
        let scale = 1.0 / (side as f32 / a.max(b));
        let (u, v) = (column as f32 * scale / a, row as f32 * scale / b);
        if u >= 1.0 || v >= 1.0 {
            return Rgb([24, 26, 30]);
        }
        let index = level.index(slice, (u * width as f32) as u32, (v * height as f32) as u32);
        match level.colors[index] {
            [r, g, b, 255] => Rgb([r, g, b]),
            _ => Rgb([0, 0, 0]),
        }
    })
}
