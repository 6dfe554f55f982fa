//! The shaders' formulas of light against those in Rust: `spread.wgsl` is run as it is.

use bevy_verdure::lighting::mean_cosine;

use crate::compute::run;

/// What runs the shader on cases.
const WORK: &str = r"
fn work(i: u32) {
    put(i, 0u, vec3(mean_cosine(cases[i][0], cases[i][1], cases[i][2]), 0.0, 0.0));
}
";

#[test]
fn light_on_many_normals_is_the_same_in_both() {
    let steps = |count: i32| (0..=count).map(move |step| step as f32 / count as f32);
    let cases: Vec<[f32; 4]> = steps(40)
        .flat_map(|c| {
            steps(20).flat_map(move |spread| {
                [0.0, 0.3, 0.5, 1.0].map(|t| [2.0 * c - 1.0, spread, t, 0.0])
            })
        })
        .collect();
    let shader = include_str!("../../src/lighting/spread.wgsl");
    let found = run::<4, 4>(&[shader, WORK], &cases);
    assert_eq!(found.len(), cases.len());
    for (case, found) in cases.iter().zip(found) {
        let expected = mean_cosine(case[0], case[1], case[2]);
        // A root and three roundings of numbers up to 1.1, and the root of a driver is good to 3 in the last place.
        assert!(
            (found[0] - expected).abs() < 1e-6,
            "{case:?}: {found:?} {expected}"
        );
    }
}
