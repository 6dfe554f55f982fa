//! The shaders' formulas of what casts shadows against those in Rust: `cast.wgsl` is run as it is.

use bevy::math::Vec3;
use bevy_verdure::plants::Dice;
use bevy_verdure::slicing::Orientation;
use bevy_verdure::slicing::blend::{facing, first_leaf};

use super::unit;
use crate::compute::run;

/// What runs the shader on cases.
const WORK: &str = r"
fn work(i: u32) {
    let o = Orientation(vector(i, 0u), vector(i, 3u), vector(i, 6u), vector(i, 9u), vector(i, 12u));
    put(i, 0u, facing(o, vector(i, 15u), vector(i, 18u)));
    results[i][3] = first_leaf(cases[i][21], cases[i][22]);
}
";

/// The definition of an orientation in the shaders.
fn orientation() -> &'static str {
    let types = include_str!("../../../src/slicing/shaders/types.wgsl");
    let from = types.find("struct Orientation {").expect("it is defined");
    let end = types[from..].find("}\n").expect("it ends");
    &types[from..=from + end]
}

#[test]
fn shaders_cast_shadows_as_rust_does() {
    let mut dice = Dice::new(5);
    let cases: Vec<_> = (0..10_000)
        .map(|_| {
            let half = Vec3::from_array([(); 3].map(|()| dice.between(0.5, 4.0)));
            let mut o = Orientation::facing(unit(&mut dice));
            (o.low, o.high) = (-half, half);
            let place = o.right * dice.jitter(half.x) + o.up * dice.jitter(half.y);
            let (alpha, share) = (dice.between(0.02, 1.0), dice.roll());
            (o, unit(&mut dice), place, alpha * share, alpha)
        })
        .collect();
    let floats: Vec<[f32; 24]> = cases
        .iter()
        .map(|(o, light, place, lot, alpha)| {
            let vectors = [o.direction, o.right, o.up, o.low, o.high, *light, *place];
            let floats = vectors.iter().flat_map(|vector| vector.to_array());
            let mut floats: Vec<f32> = floats.chain([*lot, *alpha]).collect();
            floats.resize(24, 0.0);
            floats.try_into().expect("24 floats")
        })
        .collect();
    let shader = include_str!("../../../src/slicing/shaders/cast.wgsl");
    let results: Vec<[f32; 4]> = run(&[orientation(), shader, WORK], &floats);
    for ((o, light, place, lot, alpha), found) in cases.iter().zip(results) {
        let expected = facing(o, *light, *place);
        // Roundings at the size of what is cast, and where the axis is the difference of two directions that are nearly the
        // same, of these.
        let sine = o.direction.cross(*light).length();
        let bound = 1e-5 * (place.length() + expected.length()) / sine.clamp(1e-3, 1.0);
        let cast = Vec3::from_slice(&found[..3]);
        assert!(
            cast.distance(expected) < bound,
            "{o:?} {light}: {cast} {expected}"
        );
        let depth = first_leaf(*lot, *alpha);
        // Logarithms near 1 are of what is left of 2⁻²⁴, here over one of 0.98 at least.
        assert!(
            (found[3] - depth).abs() < 1e-4,
            "{lot} {alpha}: {} {depth}",
            found[3]
        );
    }
}
