//! The shaders' formulas against those in Rust: `criteria.wgsl`, `facet.wgsl` and `choose.wgsl` are run as they are.

use core::time::Duration;

use bevy::math::{UVec3, Vec2, Vec3, Vec4};
use bevy::render::render_resource::{
    BindGroupEntry, BindGroupLayoutEntry, BindingType, BufferBindingType, BufferDescriptor,
    BufferInitDescriptor, BufferUsages, CommandEncoderDescriptor, ComputePassDescriptor, MapMode,
    PipelineCompilationOptions, PipelineLayoutDescriptor, PollType, RawComputePipelineDescriptor,
    ShaderModuleDescriptor, ShaderSource, ShaderStages,
};
use bevy::render::renderer::{RenderDevice, RenderQueue};
use bevy_verdure::lab::Headless;
use bevy_verdure::plants::Dice;
use bevy_verdure::texel::criteria::{finer_share, second_share};
use bevy_verdure::texel::facet::{Facet, slice_line, slice_position, slice_range};
use bevy_verdure::texel::{
    Choice, DirectionRule, SliceAxis, TexelQuality, TexelView, Thickness, VolumeMeasure, choose,
};

/// The shaders of the method that need no bindings, and an entry that runs them on cases.
const ENTRY: &str = r"
@group(0) @binding(0) var<storage, read> cases: array<array<f32, 44>>;
@group(0) @binding(1) var<storage, read_write> results: array<array<f32, 16>>;

fn vector(i: u32, at: u32) -> vec3<f32> {
    return vec3(cases[i][at], cases[i][at + 1u], cases[i][at + 2u]);
}

@compute @workgroup_size(64)
fn run(@builtin(global_invocation_id) id: vec3<u32>) {
    let i = id.x;
    if i >= arrayLength(&cases) {
        return;
    }
    let facet = Facet(
        mat3x3(vector(i, 0u), vector(i, 3u), vector(i, 6u)),
        mat3x3(vector(i, 9u), vector(i, 12u), vector(i, 15u)),
        mat3x2(cases[i][18], cases[i][19], cases[i][20], cases[i][21], cases[i][22], cases[i][23]),
    );
    let measure = VolumeMeasure(vec3<u32>(vector(i, 24u)), vector(i, 27u), vector(i, 30u));
    var view: TexelView;
    view.eye = vector(i, 33u);
    view.direction = vector(i, 36u);
    view.orthographic = cases[i][39] != 0.0;
    view.pixels = cases[i][40];
    let quality = TexelQuality(cases[i][41] != 0.0, cases[i][42], cases[i][43]);
    let choice = choose(facet, measure, view, quality);
    let count = 1u << choice.exponent;
    let range = slice_range(facet.uvs, choice.axis, count);
    results[i][0] = f32(choice.axis);
    results[i][1] = f32(choice.exponent);
    results[i][2] = f32(choice.along);
    results[i][3] = f32(range.x);
    results[i][4] = f32(range.y);
    let position = slice_position(range.x + range.y / 2, count);
    let first = slice_line_end(facet.uvs, choice.axis, position, false);
    let last = slice_line_end(facet.uvs, choice.axis, position, true);
    for (var k = 0u; k < 3u; k += 1u) {
        results[i][5u + k] = first[k];
        results[i][8u + k] = last[k];
    }
    // Within and beyond where things fade.
    let share = 0.7 + 0.35 * fract(cases[i][40]);
    results[i][11] = finer_share(f32(count) * share, choice.exponent, 128u);
    results[i][12] = second_share(share * 3.0, 3.0);
}
";

fn source() -> String {
    let parts = [
        include_str!("../../../src/texel/draw/shaders/criteria.wgsl"),
        include_str!("../../../src/texel/draw/shaders/facet.wgsl"),
        include_str!("../../../src/texel/draw/shaders/choose.wgsl"),
        ENTRY,
    ];
    let lines = parts.iter().flat_map(|part| part.lines());
    // They are in one piece here.
    lines
        .filter(|line| !line.starts_with('#'))
        .collect::<Vec<_>>()
        .join("\n")
}

/// What is chosen for.
#[derive(Clone, Debug)]
struct Case {
    facet: Facet,
    measure: VolumeMeasure,
    view: TexelView,
    quality: TexelQuality,
}

impl Case {
    fn roll(dice: &mut Dice) -> Self {
        let vector =
            |dice: &mut Dice, by: f32| Vec3::new(dice.jitter(by), dice.jitter(by), dice.jitter(by));
        let size = 4f32.powf(dice.jitter(1.0));
        let facet = loop {
            let corners = [Vec3::ZERO, Vec3::X, Vec3::NEG_Z];
            let uvs = [Vec2::ZERO, Vec2::X, Vec2::Y];
            let facet = Facet {
                positions: corners.map(|at| (at + vector(dice, 0.3)) * size),
                heights: [(); 3].map(|()| (Vec3::Y * 0.5 + vector(dice, 0.3)) * size),
                uvs: uvs.map(|uv| {
                    uv * dice.between(0.5, 3.0) + Vec2::new(dice.jitter(2.0), dice.jitter(2.0))
                }),
            };
            if facet.check().is_ok() {
                break facet;
            }
        };
        let power = |dice: &mut Dice| 1 << (dice.roll() * 8.99) as u32;
        Self {
            facet,
            measure: VolumeMeasure {
                most: UVec3::new(power(dice), power(dice), power(dice)),
                lengths: Vec3::new(1.0, dice.between(0.5, 2.0), dice.between(0.2, 1.0)),
                thickness: Thickness {
                    narrowest: Vec3::new(
                        dice.between(0.01, 0.2),
                        dice.between(0.01, 0.2),
                        dice.between(0.01, 0.2),
                    ),
                },
            },
            view: TexelView {
                eye: vector(dice, 10.0) * size,
                direction: (dice.roll() < 0.3).then(|| vector(dice, 1.0).normalize_or(Vec3::X)),
                pixels: dice.between(50.0, 2000.0),
                half_spaces: [Vec4::ZERO; 6],
            },
            quality: TexelQuality {
                direction: if dice.roll() < 0.5 {
                    DirectionRule::Quality
                } else {
                    DirectionRule::StepAside
                },
                depth: dice.between(0.1, 1.0),
                pixels: dice.between(0.5, 4.0),
            },
        }
    }

    fn floats(&self) -> [f32; 44] {
        let mut floats = Vec::new();
        for vectors in [self.facet.positions, self.facet.heights] {
            floats.extend(vectors.iter().flat_map(|vector| vector.to_array()));
        }
        floats.extend(self.facet.uvs.iter().flat_map(|uv| uv.to_array()));
        let direction = self.view.direction.unwrap_or_default();
        for vector in [
            self.measure.most.as_vec3(),
            self.measure.lengths,
            self.measure.thickness.narrowest,
            self.view.eye,
            direction,
        ] {
            floats.extend(vector.to_array());
        }
        let flag = |set: bool| f32::from(u8::from(set));
        floats.extend([
            flag(self.view.direction.is_some()),
            self.view.pixels,
            flag(self.quality.direction == DirectionRule::Quality),
            self.quality.depth,
            self.quality.pixels,
        ]);
        floats.try_into().expect("44 floats")
    }

    /// What is chosen if all that decides is larger by a share: roundings differ, and there is always one on the edge.
    fn choose(&self, share: f32) -> Choice {
        let mut near = self.clone();
        near.view.eye *= 1.0 + share;
        near.quality.depth *= 1.0 - share;
        near.quality.pixels *= 1.0 - share;
        if let Some(direction) = &mut near.view.direction {
            direction.x += share;
        }
        choose(&near.facet, &near.measure, &near.view, &near.quality)
    }
}

fn run(cases: &[Case]) -> Vec<[f32; 16]> {
    let mut headless = Headless::new(Duration::ZERO, |_| {});
    headless.step();
    let world = headless.world();
    let device = world.resource::<RenderDevice>().clone();
    let queue = world.resource::<RenderQueue>().clone();
    let source = source();
    let module = device.create_and_validate_shader_module(ShaderModuleDescriptor {
        label: Some("texel twins"),
        source: ShaderSource::Wgsl(source.into()),
    });
    let entry = |binding, read_only| BindGroupLayoutEntry {
        binding,
        visibility: ShaderStages::COMPUTE,
        ty: BindingType::Buffer {
            ty: BufferBindingType::Storage { read_only },
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    };
    let layout = device.create_bind_group_layout(None, &[entry(0, true), entry(1, false)]);
    let pipeline_layout = device.create_pipeline_layout(&PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &[Some(&layout)],
        immediate_size: 0,
    });
    let pipeline = device.create_compute_pipeline(&RawComputePipelineDescriptor {
        label: None,
        layout: Some(&pipeline_layout),
        module: &module,
        entry_point: Some("run"),
        compilation_options: PipelineCompilationOptions::default(),
        cache: None,
    });
    let floats: Vec<[f32; 44]> = cases.iter().map(Case::floats).collect();
    let input = device.create_buffer_with_data(&BufferInitDescriptor {
        label: None,
        contents: bytemuck::cast_slice(&floats),
        usage: BufferUsages::STORAGE,
    });
    let size = (cases.len() * 64) as u64;
    let buffer = |usage| {
        device.create_buffer(&BufferDescriptor {
            label: None,
            size,
            usage,
            mapped_at_creation: false,
        })
    };
    let output = buffer(BufferUsages::STORAGE | BufferUsages::COPY_SRC);
    let back = buffer(BufferUsages::MAP_READ | BufferUsages::COPY_DST);
    let bindings = device.create_bind_group(
        None,
        &layout,
        &[
            BindGroupEntry {
                binding: 0,
                resource: input.as_entire_binding(),
            },
            BindGroupEntry {
                binding: 1,
                resource: output.as_entire_binding(),
            },
        ],
    );
    let mut encoder = device.create_command_encoder(&CommandEncoderDescriptor::default());
    {
        let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, Some(&*bindings), &[]);
        pass.dispatch_workgroups(cases.len().div_ceil(64) as u32, 1, 1);
    }
    encoder.copy_buffer_to_buffer(&output, 0, &back, 0, size);
    queue.submit([encoder.finish()]);
    device.map_buffer(&back.slice(..), MapMode::Read, |mapped| mapped.unwrap());
    device.poll(PollType::wait_indefinitely()).unwrap();
    let mapped = back.slice(..).get_mapped_range();
    bytemuck::cast_slice(&mapped).to_vec()
}

#[test]
fn shaders_choose_and_cut_as_rust_does() {
    let mut dice = Dice::new(9);
    let cases: Vec<Case> = (0..20_000).map(|_| Case::roll(&mut dice)).collect();
    let mut on_the_edge = 0;
    let mut axes = [0; 3];
    for (case, found) in cases.iter().zip(run(&cases)) {
        let axis = SliceAxis::ALL[found[0] as usize];
        let chosen = Choice::Slices {
            axis,
            exponent: found[1] as u8,
            along: found[2] != 0.0,
        };
        axes[axis.index()] += 1;
        if chosen != case.choose(0.0) {
            on_the_edge += 1;
            let near = [-1e-5, 1e-5, -1e-4, 1e-4].map(|share| case.choose(share));
            assert!(near.contains(&chosen), "{case:?}: {chosen:?}, not {near:?}");
        }
        let count = 1 << found[1] as u32;
        let share = 0.7 + 0.35 * case.view.pixels.fract();
        let fades = [
            finer_share(count as f32 * share, found[1] as u32, 128),
            second_share(share * 3.0, 3.0),
        ];
        for (fade, found) in fades.iter().zip(&found[11..]) {
            // What rounds, at the scale of the fade.
            assert!((fade - found).abs() < 1e-5, "{share}: {found}, not {fade}");
        }
        let range = slice_range(case.facet.uvs, axis, count);
        assert_eq!(
            [found[3] as i32, found[4] as i32],
            [range.start, range.end - range.start]
        );
        if axis == SliceAxis::W || range.is_empty() {
            continue;
        }
        let middle = range.start + (range.end - range.start) / 2;
        let ends = slice_line(case.facet.uvs, axis, slice_position(middle, count));
        let ends = ends.expect("slices of the range meet the facet");
        for (k, end) in ends.iter().enumerate() {
            let found = Vec3::from_slice(&found[5 + 3 * k..8 + 3 * k]);
            assert!(found.distance(*end) < 1e-5, "{case:?}: {found}, not {end}");
        }
    }
    assert!(axes.iter().all(|&count| count > 1000), "{axes:?}");
    // Roundings decide for few.
    assert!(on_the_edge < 40, "{on_the_edge}");
}
