//! The shaders' formulas against those in Rust: `facet.wgsl` is run as it is.

use bevy::math::{Vec2, Vec3};
use bevy_verdure::plants::Dice;
use bevy_verdure::texel::SliceAxis;
use bevy_verdure::texel::facet::{Facet, TexelFrame, slice_line, slice_position, slice_range};

use crate::compute::run;

/// What runs the shader on cases.
const WORK: &str = r"
fn work(i: u32) {
    let facet = Facet(
        mat3x3(vector(i, 0u), vector(i, 3u), vector(i, 6u)),
        mat3x3(vector(i, 9u), vector(i, 12u), vector(i, 15u)),
        mat3x2(cases[i][18], cases[i][19], cases[i][20], cases[i][21], cases[i][22], cases[i][23]),
    );
    let b = vector(i, 24u);
    let lengths = vector(i, 27u);
    let baked = vector(i, 30u);
    let w = cases[i][33];
    let axis = u32(cases[i][34]);
    let position = slice_position(i32(cases[i][35]), u32(cases[i][36]), cases[i][37]);
    put(i, 0u, slice_line_end(facet.uvs, axis, position, false));
    put(i, 3u, slice_line_end(facet.uvs, axis, position, true));
    put(i, 24u, slice_line_point(facet.uvs, axis, position, 0.3));
    put(i, 6u, facet_point(facet, b, w));
    let frame = texel_frame(facet, b, w);
    put(i, 9u, frame.edges[0]);
    put(i, 12u, frame.edges[1]);
    put(i, 15u, frame.edges[2]);
    put(i, 18u, normalize(normal_transform(frame, lengths) * baked));
    put(i, 27u, in_frame(frame, baked));
    results[i][21] = facet_uv(facet, b).x;
    results[i][22] = facet_uv(facet, b).y;
    results[i][23] = position;
}
";

/// A place on a facet, and a slice of it.
#[derive(Clone, Debug)]
struct Case {
    facet: Facet,
    b: Vec3,
    w: f32,
    lengths: Vec3,
    normal: Vec3,
    axis: SliceAxis,
    slice: i32,
    count: u32,
    apart: f32,
}

impl Case {
    fn roll(dice: &mut Dice) -> Self {
        let vector =
            |dice: &mut Dice, by: f32| Vec3::new(dice.jitter(by), dice.jitter(by), dice.jitter(by));
        let size = 4f32.powf(dice.jitter(1.0));
        loop {
            let corners = [Vec3::ZERO, Vec3::X, Vec3::NEG_Z];
            let uvs = [Vec2::ZERO, Vec2::X, Vec2::Y];
            let facet = Facet {
                positions: corners.map(|at| (at + vector(dice, 0.3)) * size),
                heights: [(); 3].map(|()| (Vec3::Y * 0.5 + vector(dice, 0.3)) * size),
                uvs: uvs.map(|uv| {
                    uv * dice.between(0.5, 3.0) + Vec2::new(dice.jitter(2.0), dice.jitter(2.0))
                }),
            };
            let axis = SliceAxis::ALL[(dice.roll() * 1.99) as usize];
            let count = 1 << (dice.roll() * 8.99) as u32;
            let apart = dice.roll();
            let range = slice_range(facet.uvs, axis, count, apart);
            if facet.check().is_err() || range.is_empty() {
                continue;
            }
            let (r, s) = (dice.roll(), dice.roll());
            break Self {
                facet,
                b: Vec3::new(1.0 - r.max(s), r.min(s), r.max(s) - r.min(s)),
                w: dice.roll(),
                lengths: Vec3::new(1.0, dice.between(0.5, 2.0), dice.between(0.2, 1.0)),
                normal: vector(dice, 1.0).normalize_or(Vec3::X),
                axis,
                slice: range.start + (dice.roll() * range.len() as f32) as i32,
                count,
                apart,
            };
        }
    }

    fn floats(&self) -> [f32; 44] {
        let mut floats = Vec::new();
        for vectors in [self.facet.positions, self.facet.heights] {
            floats.extend(vectors.iter().flat_map(|vector| vector.to_array()));
        }
        floats.extend(self.facet.uvs.iter().flat_map(|uv| uv.to_array()));
        for vector in [self.b, self.lengths, self.normal] {
            floats.extend(vector.to_array());
        }
        let axis = self.axis.index() as f32;
        floats.extend([self.w, axis, self.slice as f32]);
        floats.extend([self.count as f32, self.apart]);
        floats.resize(44, 0.0);
        floats.try_into().expect("44 floats")
    }
}

#[test]
fn shaders_place_slices_as_rust_does() {
    let mut dice = Dice::new(9);
    let cases: Vec<Case> = (0..20_000).map(|_| Case::roll(&mut dice)).collect();
    let floats: Vec<[f32; 44]> = cases.iter().map(Case::floats).collect();
    let shader = include_str!("../../../src/texel/draw/shaders/facet.wgsl");
    let results: Vec<[f32; 36]> = run(&[shader, WORK], &floats);
    for (case, found) in cases.iter().zip(results) {
        let vector = |at: usize| Vec3::from_slice(&found[at..at + 3]);
        let facet = &case.facet;
        let position = slice_position(case.slice, case.count, case.apart);
        assert_eq!(found[23], position);
        let ends = slice_line(facet.uvs, case.axis, position);
        let ends = ends.expect("slices of the range meet the facet");
        for (end, at) in ends.into_iter().zip([0, 3]) {
            assert!(vector(at).distance(end) < 1e-5, "{case:?}: {}", vector(at));
        }
        let between = ends[0].lerp(ends[1], 0.3);
        assert!(vector(24).distance(between) < 1e-5, "{case:?}");
        // Roundings of a few operations, at the size of the facet.
        let size = facet.bounds().1;
        let point = facet.point(case.b, case.w);
        assert!(vector(6).distance(point) < 1e-6 * size, "{case:?}");
        let frame = TexelFrame::new(facet, case.b, case.w);
        // Edges are quotients by the area on the texture, which may cancel.
        let [s, t] = [facet.uvs[1] - facet.uvs[0], facet.uvs[2] - facet.uvs[0]];
        let lost = s.length() * t.length() / s.perp_dot(t).abs();
        for (edge, at) in frame.edges.into_iter().zip([9, 12, 15]) {
            let scale = size + edge.length();
            assert!(vector(at).distance(edge) < 1e-5 * scale * lost, "{case:?}");
        }
        // Taken apart by the same frame, and put together again.
        let parts = vector(27);
        let together =
            frame.edges[0] * parts.x + frame.edges[1] * parts.y + frame.edges[2] * parts.z;
        let [u, v, w] = frame.edges.map(Vec3::normalize);
        let bound = 1e-5 * lost / u.dot(v.cross(w)).abs();
        assert!(
            together.distance(case.normal) < bound,
            "{case:?}: {together}"
        );
        let scale = parts.length().max(1e-6);
        let own = frame.in_frame(case.normal);
        assert!(
            parts.distance(own) < bound * scale,
            "{case:?}: {parts} {own}"
        );
        let normal = frame.transform_normal(case.normal, case.lengths);
        let normal = normal.normalize();
        let [u, v, w] = frame.edges.map(Vec3::normalize);
        let flat = u.dot(v.cross(w)).abs();
        // Normals of flat texels turn with small errors of what they are normal to.
        let bound = 1e-5 * lost / flat;
        assert!(vector(18).distance(normal) < bound, "{case:?}");
        let uv = Vec2::new(found[21], found[22]);
        assert!(uv.distance(facet.uv(case.b)) < 1e-5, "{case:?}: {uv}");
    }
}
