//! Baking and choosing of slices. `cargo bench --bench slicing`

use std::hint::black_box;

use bevy::math::Vec3;
use bevy_verdure::lab::broadleaf_crown;
use bevy_verdure::plants::Broadleaf;
use bevy_verdure::prelude::*;
use bevy_verdure::slicing::blend::drawn_slices;
use criterion::{Criterion, criterion_group, criterion_main};

fn broadleaf() -> CrownMesh {
    let tree = Broadleaf::default().grow(1);
    broadleaf_crown(&tree, 0.0).expect("a broadleaf's meshes can be baked")
}

/// The paper's tree, 19,657 triangles, with the default settings: 7 orientations, 3 levels, 256² pixels, 16 samples each.
fn baking(c: &mut Criterion) {
    let crown = broadleaf();
    let mut group = c.benchmark_group("bake");
    group.sample_size(10);
    for pixels in [64, 256] {
        let settings = BakeSettings::default().with_pixels(pixels);
        group.bench_function(format!("broadleaf_{pixels}"), |b| {
            b.iter(|| bake(black_box(&crown), &settings).expect("the settings are in range"));
        });
    }
    group.finish();
}

fn choosing(c: &mut Criterion) {
    let settings = BakeSettings::default().with_pixels(16);
    let slicing = bake(&broadleaf(), &settings).expect("the settings are in range");
    let shape = slicing.shape().clone();
    c.bench_function("drawn_slices", |b| {
        b.iter(|| {
            drawn_slices(
                black_box(&shape),
                Vec3::new(9.0, 2.0, 7.0),
                SliceOrder::Steady,
                0,
            )
        });
    });
}

criterion_group!(benches, baking, choosing);
criterion_main!(benches);
