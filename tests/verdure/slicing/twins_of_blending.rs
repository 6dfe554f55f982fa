//! The shaders' formulas of view blending against those in Rust: `blend.wgsl` and `parts.wgsl` are run as they are.

use bevy::math::{Vec3, Vec3Swizzles};
use bevy_verdure::plants::Dice;
use bevy_verdure::prelude::*;
use bevy_verdure::slicing::blend::{
    deviation, leaning, part_direction, part_slots, part_turn, slanted, slots, towards_sun, turned,
    turned_weight, widest,
};
use bevy_verdure::slicing::{Orientation, SlicingShape};

use super::unit;
use crate::compute::run;

/// A uniform of what the functions read, and what runs them on cases.
const WORK: &str = r"
struct Facing { direction: vec3<f32> }

struct Shape {
    levels: vec4<u32>,
    switches: vec2<f32>,
    orientation_count: u32,
    sphere: u32,
    vertical: u32,
    orientations: array<Facing, 32>,
}

var<private> crowns: array<Shape, 1>;
var<private> which: u32;

fn work(i: u32) {
    crowns[0].orientation_count = u32(cases[i][0]);
    crowns[0].vertical = u32(cases[i][1]);
    crowns[0].sphere = u32(cases[i][2]);
    for (var k = 0u; k < crowns[0].orientation_count; k += 1u) {
        crowns[0].orientations[k].direction = vector(i, 11u + 3u * k);
    }
    let eye = vector(i, 3u);
    let most = deviation(cases[i][9], cases[i][10], length(eye.xz));
    let part = part_direction(eye, vector(i, 6u), most);
    put(i, 0u, part);
    results[i][3] = most.x;
    results[i][4] = most.y;
    let all = slots(eye);
    for (var k = 0u; k < 3u; k += 1u) {
        results[i][5u + k] = f32(all[k].orientation);
        results[i][8u + k] = all[k].weight;
    }
    for (var k = 0u; k < PART_SLOTS; k += 1u) {
        let slot = part_slot(k, eye, most);
        results[i][11u + 3u * k] = f32(slot.orientation);
        results[i][12u + 3u * k] = slot.weight;
        results[i][13u + 3u * k] = turned_weight(part_turn(slot.orientation, part));
    }
    let front = crowns[0].orientations[0].direction;
    results[i][23] = slanted(0.7, front, eye);
    put(i, 24u, turned(vector(i, 6u), front, leaning(front, eye)));
    results[i][27] = towards_sun(front, eye, dot(eye, vector(i, 6u)), 0.4, 1.2);
}
";

/// A shader as it is where nothing is defined: of lines between conditions, those after `#else`.
fn undefined(shader: &str) -> String {
    let (mut lines, mut is_left_out) = (Vec::new(), false);
    for line in shader.lines() {
        match line.split_whitespace().next() {
            Some("#ifdef") => is_left_out = true,
            Some("#else" | "#endif") => is_left_out = false,
            _ if !is_left_out => lines.push(line),
            _ => {}
        }
    }
    lines.join("\n")
}

fn shape(orientations: &Orientations, vertical: bool) -> SlicingShape {
    let mut directions = orientations.directions();
    directions.extend(vertical.then_some(Vec3::Y));
    SlicingShape {
        centroid: Vec3::ZERO,
        radius: 1.0,
        pixels: 16,
        levels: vec![5],
        switches: vec![],
        correction: 0.5,
        diffuse_transmission: 0.0,
        sphere: matches!(orientations, Orientations::Sphere(_)),
        vertical,
        orientations: directions.into_iter().map(Orientation::facing).collect(),
    }
}

#[test]
fn shaders_blend_slicings_as_rust_does() {
    let mut dice = Dice::new(7);
    let shapes = [
        shape(&Orientations::Circle(6), true),
        shape(&Orientations::Circle(3), false),
        shape(&Orientations::Sphere(9), false),
        shape(
            &Orientations::Arc {
                count: 2,
                from: 0.0,
                to: 0.5,
            },
            true,
        ),
    ];
    let mut cases = Vec::new();
    for shape in &shapes {
        for _ in 0..3000 {
            let (eye, ray) = (unit(&mut dice), unit(&mut dice));
            // Rays near the eye's direction matter most.
            let ray = (eye + ray * dice.roll()).normalize_or(eye);
            cases.push((shape, eye, ray, dice.between(0.2, 4.0)));
        }
    }
    let floats: Vec<[f32; 40]> = cases
        .iter()
        .map(|(shape, eye, ray, distance)| {
            let flags = [
                shape.orientations.len() as f32,
                f32::from(u8::from(shape.vertical)),
            ];
            let sphere = f32::from(u8::from(shape.sphere));
            let mut floats: Vec<f32> = flags.into_iter().chain([sphere]).collect();
            floats.extend(eye.to_array());
            floats.extend(ray.to_array());
            floats.extend([*distance, widest(shape)]);
            let directions = shape.orientations.iter();
            floats.extend(directions.flat_map(|o| o.direction.to_array()));
            floats.resize(40, 0.0);
            floats.try_into().expect("40 floats")
        })
        .collect();
    let blend = undefined(include_str!("../../../src/slicing/shaders/blend.wgsl"));
    let parts = undefined(include_str!("../../../src/slicing/shaders/parts.wgsl"));
    let seen = undefined(include_str!("../../../src/slicing/shaders/seen.wgsl"));
    let results: Vec<[f32; 28]> = run(&[&blend, &parts, &seen, WORK], &floats);
    // Where two slicings are equally near, or one is about to count, rounding decides.
    let (mut decided, total) = (0, cases.len());
    for ((shape, eye, ray, distance), found) in cases.iter().zip(results) {
        let most = deviation(*distance, widest(shape), eye.xz().length());
        let part = part_direction(*eye, *ray, most);
        // Arc sines and cosines of the device are good to 2⁻¹¹ or so.
        assert!((found[3] - most.x).abs() < 1e-3 && (found[4] - most.y).abs() < 1e-3);
        let cosine = eye.dot(*ray);
        if (cosine - most.x).abs() > 1e-3 {
            assert!(
                Vec3::from_slice(&found[..3]).distance(part) < 4e-3,
                "{eye} {ray}: {part}"
            );
        }
        let weight = slanted(shape, 0.7, shape.orientations[0].direction, *eye);
        assert!((found[23] - weight).abs() < 1e-5, "{eye}: {weight}");
        let front = shape.orientations[0].direction;
        let normal = turned(*ray, front, leaning(shape, front, *eye));
        let found_normal = Vec3::from_slice(&found[24..27]);
        assert!(
            found_normal.distance(normal) < 4e-3,
            "{eye} {ray}: {normal}"
        );
        let shift = towards_sun(shape, front, *eye, cosine, 0.4, 1.2);
        assert!((found[27] - shift).abs() < 1e-5, "{eye}: {shift}");
        let expected = slots(shape, *eye, SliceOrder::Steady);
        let orientations = |from: usize, step: usize, n: usize| -> Vec<u32> {
            (0..n).map(|k| found[from + step * k] as u32).collect()
        };
        let own = expected.map(|slot| slot.orientation);
        let parts = part_slots(shape, *eye, most);
        if orientations(5, 1, 3) != own
            || orientations(11, 3, 4) != parts.map(|slot| slot.orientation)
            || (0..4).any(|k| found[12 + 3 * k] != parts[k].weight)
        {
            continue;
        }
        decided += 1;
        for (k, slot) in expected.iter().enumerate() {
            // As much over 15° in radians.
            assert!((found[8 + k] - slot.weight).abs() < 8e-3, "{eye}: {slot:?}");
        }
        for (k, slot) in parts.iter().enumerate() {
            let weight = turned_weight(part_turn(shape, slot.orientation, part));
            assert!(
                (found[13 + 3 * k] - weight).abs() < 2e-2,
                "{eye} {ray}: {weight}"
            );
        }
    }
    assert!(decided > total - total / 50, "{decided} of {total}");
}
