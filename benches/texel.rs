//! What building reference volumes costs, and choosing slices for the facets of a view.
//!
//! ```text
//! cargo bench --bench texel --profile dev
//! ```

use std::hint::black_box;

use bevy::math::{UVec2, UVec3, Vec2, Vec3, Vec4};
use bevy_verdure::texel::build::{
    Filling, HeightField, Shape, ShapeSettings, VolumeSettings, from_height_field, from_implicit,
    from_shape,
};
use bevy_verdure::texel::facet::Facet;
use bevy_verdure::texel::{
    SliceSets, TexelQuality, TexelView, Thickness, VolumeMeasure, choose_fading, silent,
};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};

/// A tiling field of hills of several sizes.
fn hills(side: u32) -> HeightField {
    let height = |i: u32| {
        let at =
            Vec2::new((i % side) as f32, (i / side) as f32) / side as f32 * core::f32::consts::TAU;
        let waves = (1..6u8).map(|octave| {
            let turn = Vec2::from_angle(f32::from(octave)) * f32::from(octave);
            // Whole numbers of waves tile.
            let turn = (turn * 3.0).round();
            turn.dot(at).sin() / f32::from(octave)
        });
        (0.5 + 0.2 * waves.sum::<f32>()).clamp(0.02, 1.0)
    };
    let size = UVec2::splat(side);
    HeightField::new(size, (0..side * side).map(height).collect(), [90, 120, 40])
}

/// A closed surface of about `2·n²` triangles: a bumpy ball.
fn lump(n: u32) -> Shape {
    let mut shape = Shape::default();
    for ring in 0..=n {
        for sector in 0..n {
            let polar = ring as f32 / n as f32 * core::f32::consts::PI;
            let turn = sector as f32 / n as f32 * core::f32::consts::TAU;
            let across = if ring % n == 0 { 0.0 } else { polar.sin() };
            let radius = 1.0 + 0.2 * (5.0 * polar).sin() * (3.0 * turn).cos() * across;
            let out = Vec3::new(across * turn.cos(), across * turn.sin(), polar.cos());
            shape.positions.push(out * radius);
        }
    }
    for ring in 0..n {
        for sector in 0..n {
            let index = |ring: u32, sector: u32| ring * n + sector % n;
            let [a, b] = [index(ring, sector), index(ring, sector + 1)];
            let [c, d] = [index(ring + 1, sector), index(ring + 1, sector + 1)];
            shape.triangles.extend([[a, c, b], [b, c, d]]);
        }
    }
    shape
}

fn build(c: &mut Criterion) {
    let mut group = c.benchmark_group("texel_build");
    group.sample_size(10);
    let size = UVec3::new(256, 256, 64);
    let settings = VolumeSettings::new(size);
    let field = hills(256);
    group.bench_function("height_field_256x256x64", |b| {
        b.iter(|| from_height_field(black_box(&field), &settings, &silent));
    });
    let shape = lump(32);
    for (name, filling) in [
        ("flood", Filling::Flood),
        ("parity", Filling::Parity),
        ("none", Filling::None),
    ] {
        let settings = ShapeSettings {
            filling,
            ..ShapeSettings::new(UVec3::splat(64))
        };
        group.bench_function(format!("shape_{name}_64x64x64"), |b| {
            b.iter(|| from_shape(black_box(&shape), &settings, &silent));
        });
    }
    let ball = |at: Vec3| 0.4 / at.distance(Vec3::splat(0.5)).max(1e-3);
    group.bench_function("implicit_256x256x64", |b| {
        b.iter(|| from_implicit(ball, |at| at, &settings, &silent));
    });
    let volume = from_height_field(&field, &settings, &silent)
        .expect("it is a volume")
        .volume;
    group.bench_function("slice_sets_256x256x64", |b| {
        b.iter(|| SliceSets::new(black_box(&volume), 256));
    });
    group.finish();
}

/// Direction and count of every facet of a view.
fn choice(c: &mut Criterion) {
    let mut group = c.benchmark_group("texel_choose");
    for side in [100u32, 300] {
        let facets = ground(side);
        let measure = VolumeMeasure {
            most: UVec3::new(256, 256, 64),
            lengths: Vec3::new(1.0, 1.0, 0.25),
            thickness: Thickness {
                narrowest: Vec3::splat(0.02),
            },
        };
        let view = TexelView {
            eye: Vec3::new(0.0, 0.0, 1.7),
            direction: None,
            pixels: 900.0,
            half_spaces: [Vec4::ZERO; 6],
        };
        group.throughput(Throughput::Elements(facets.len() as u64));
        group.bench_function(BenchmarkId::from_parameter(facets.len()), |b| {
            b.iter(|| {
                let quality = TexelQuality::default();
                for facet in black_box(&facets) {
                    black_box(choose_fading(facet, &measure, &view, &quality));
                }
            });
        });
    }
    group.finish();
}

/// A square of ground, a texel to each pair of facets.
fn ground(side: u32) -> Vec<Facet> {
    let corner = |x: u32, y: u32| Vec2::new(x as f32, y as f32) - side as f32 / 2.0;
    let mut facets = Vec::new();
    for (x, y) in (0..side * side).map(|i| (i % side, i / side)) {
        let [a, b] = [corner(x, y), corner(x + 1, y)];
        let [c, d] = [corner(x, y + 1), corner(x + 1, y + 1)];
        for uvs in [[a, b, d], [a, d, c]] {
            facets.push(Facet {
                positions: uvs.map(|uv| uv.extend(0.0)),
                heights: [Vec3::Z * 0.25; 3],
                uvs,
            });
        }
    }
    facets
}

criterion_group!(benches, build, choice);
criterion_main!(benches);
