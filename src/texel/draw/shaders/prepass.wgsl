// The prepasses and the shadow maps.

#import bevy_pbr::prepass_bindings::previous_view_uniforms
#import bevy_pbr::mesh_view_bindings::view
#import bevy_verdure::texel::look::{seen_samples, slice_normal_and_alpha}
#ifdef NORMAL_PREPASS
#import bevy_verdure::texel::look::world_normal
#endif
#import bevy_verdure::texel::place::{Corner, Varying, place_corner}

@vertex
fn vertex(corner: Corner) -> Varying {
    return place_corner(corner);
}

#ifdef PREPASS_FRAGMENT

struct Output {
#ifdef NORMAL_PREPASS
    @location(0) normal: vec4<f32>,
#endif
#ifdef MOTION_VECTOR_PREPASS
    @location(1) motion_vector: vec2<f32>,
#endif
#ifdef UNCLIPPED_DEPTH_ORTHO_EMULATION
    @builtin(frag_depth) depth: f32,
#endif
#ifdef TEXEL_FOUR_SAMPLES
    @builtin(sample_mask) coverage: u32,
#endif
}

@fragment
fn fragment(in: Varying) -> Output {
    let baked = slice_normal_and_alpha(in);
    let covered = seen_samples(in, baked.a);
    var out: Output;
#ifdef TEXEL_FOUR_SAMPLES
    out.coverage = covered;
#endif
#ifdef NORMAL_PREPASS
    out.normal = vec4(world_normal(in, baked.xyz) * 0.5 + vec3(0.5), 1.0);
#endif
#ifdef MOTION_VECTOR_PREPASS
    let clip = view.unjittered_clip_from_world * in.world_position;
    let clip_before = previous_view_uniforms.clip_from_world * vec4(in.previous_world_position, 1.0);
    // In texture coordinates: clip space is two wide, and its y points up.
    out.motion_vector = (clip.xy / clip.w - clip_before.xy / clip_before.w) * vec2(0.5, -0.5);
#endif
#ifdef UNCLIPPED_DEPTH_ORTHO_EMULATION
    // The vertex stage has brought what is nearer than the shadow map to its near plane.
    out.depth = in.position.z;
#endif
    return out;
}

#else ifdef TEXEL_FOUR_SAMPLES

@fragment
fn fragment(in: Varying) -> @builtin(sample_mask) u32 {
    return seen_samples(in, slice_normal_and_alpha(in).a);
}

#else

@fragment
fn fragment(in: Varying) {
    _ = seen_samples(in, slice_normal_and_alpha(in).a);
}

#endif
