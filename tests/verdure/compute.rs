//! Shaders' formulas run as they are, on cases, to be compared with those in Rust.

use core::time::Duration;

use bevy::render::render_resource::{
    BindGroupEntry, BindGroupLayoutEntry, BindingType, BufferBindingType, BufferDescriptor,
    BufferInitDescriptor, BufferUsages, CommandEncoderDescriptor, ComputePassDescriptor, MapMode,
    PipelineCompilationOptions, PipelineLayoutDescriptor, PollType, RawComputePipelineDescriptor,
    ShaderModuleDescriptor, ShaderSource, ShaderStages,
};
use bevy::render::renderer::{RenderDevice, RenderQueue};
use bevy_verdure::lab::Headless;

/// How `work` reads cases and writes results, and is run on each case.
const HELPERS: &str = r"
fn vector(i: u32, at: u32) -> vec3<f32> {
    return vec3(cases[i][at], cases[i][at + 1u], cases[i][at + 2u]);
}

fn put(i: u32, at: u32, value: vec3<f32>) {
    results[i][at] = value.x;
    results[i][at + 1u] = value.y;
    results[i][at + 2u] = value.z;
}

@compute @workgroup_size(64)
fn run(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x < arrayLength(&cases) {
        work(id.x);
    }
}
";

/// Runs a shader in parts, of which the last has a function `work` that reads the case of a number, `cases[i]`, and writes
/// `results[i]`. Lines for naga_oil are left out: imports are all in one piece here.
pub fn run<const N: usize, const M: usize>(parts: &[&str], cases: &[[f32; N]]) -> Vec<[f32; M]> {
    let mut headless = Headless::new(Duration::ZERO, |_| {});
    headless.step();
    let world = headless.world();
    let device = world.resource::<RenderDevice>().clone();
    let queue = world.resource::<RenderQueue>().clone();
    let storage = format!(
        "@group(0) @binding(0) var<storage, read> cases: array<array<f32, {N}>>;
         @group(0) @binding(1) var<storage, read_write> results: array<array<f32, {M}>>;"
    );
    let lines = [&storage, HELPERS]
        .into_iter()
        .chain(parts.iter().copied())
        .flat_map(str::lines);
    let lines: Vec<_> = lines.filter(|line| !line.starts_with('#')).collect();
    let source = lines.join("\n");
    let module = device.create_and_validate_shader_module(ShaderModuleDescriptor {
        label: Some("twins"),
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
    let input = device.create_buffer_with_data(&BufferInitDescriptor {
        label: None,
        contents: bytemuck::cast_slice(cases),
        usage: BufferUsages::STORAGE,
    });
    let size = (cases.len() * size_of::<[f32; M]>()) as u64;
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
