#define_import_path bevy_verdure::slicing::look

// The fragment stage of all passes: what a slice looks like at a place.

#import bevy_pbr::mesh_bindings::mesh
#import bevy_render::maths::mat2x4_f32_to_mat3x3_unpack
#import bevy_verdure::slicing::types::{crown, color_texture, normal_texture, slice_sampler}
#import bevy_verdure::slicing::place::Varying

struct Look {
    color: vec4<f32>,
    // World space.
    normal: vec3<f32>,
    // Share of the light from around.
    occlusion: f32,
}

fn slice_color(in: Varying) -> vec4<f32> {
    var color = textureSample(color_texture, slice_sampler, in.uv, in.layer);
    color = vec4(color.rgb * unpack4x8unorm(mesh[in.instance_index].tag).rgb, color.a);
    color.a *= in.opacity;
#ifdef CROWN_FRAMES
#ifndef PREPASS_PIPELINE
    let edge = min(min(in.uv.x, in.uv.y), min(1.0 - in.uv.x, 1.0 - in.uv.y));
    if edge < 0.012 {
        color = vec4(1.0, 0.15, 0.05, in.opacity);
    }
#endif
#endif
    return color;
}

fn look(in: Varying) -> Look {
    let color = slice_color(in);
    let baked = textureSample(normal_texture, slice_sampler, in.uv, in.layer);
    let direction = crown.orientations[abs(in.orientation) - 1].direction;
    var n = baked.xyz * 2.0 - 1.0;
    if in.orientation < 0 {
        // From behind, the other side of each leaf is seen.
        n -= 2.0 * max(dot(n, direction), 0.0) * direction;
    }
    let turn = mat2x4_f32_to_mat3x3_unpack(
        mesh[in.instance_index].local_from_world_transpose_a,
        mesh[in.instance_index].local_from_world_transpose_b,
    );
    let normal = turn * n;
    let is_none = dot(normal, normal) < 1e-12;
    return Look(color, normalize(select(normal, turn * direction, is_none)), baked.a);
}

// Mixes the bits of a number: M. Jarzynski, M. Olano, Hash Functions for GPU Rendering (JCGT 2020).
fn pcg(number: u32) -> u32 {
    let state = number * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

// Whether a place of an opacity is there: by chance, the same for each cell of the slice about the size of a pixel on
// screen, so that it stays while the eye moves. `footprint` is what a pixel on screen covers of a slice.
fn is_there(in: Varying, alpha: f32, footprint: f32) -> bool {
    // Cells are of sizes in powers of two.
    let cells = exp2(ceil(-log2(max(footprint, 1e-5))));
    let cell = vec2<u32>(floor(in.uv * cells));
    let number = pcg(cell.x + pcg(cell.y + pcg(in.layer + (mesh[in.instance_index].tag >> 24u) * 256u)));
    return f32(number) * (1.0 / 4294967296.0) < alpha;
}

fn footprint(uv: vec2<f32>) -> f32 {
    return max(length(dpdx(uv)), length(dpdy(uv)));
}
