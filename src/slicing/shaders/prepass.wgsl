// The prepasses and the shadow maps: slices there by chance, as often as they are opaque.

#import bevy_pbr::{mesh_functions, prepass_bindings::previous_view_uniforms}
#import bevy_pbr::mesh_view_bindings::view
#import bevy_verdure::slicing::place::{Corner, Varying, place_corner}
#import bevy_verdure::slicing::look::{slice_color, slice_facing}
#import bevy_verdure::slicing::lots::{cells, footprint, is_there}

@vertex
fn vertex(corner: Corner) -> Varying {
    return place_corner(corner);
}

fn is_seen(in: Varying) -> bool {
#ifdef CROWN_LIGHT_VIEW
    let grid = in.grid;
#else
    let grid = cells(footprint(in.uv));
#endif
    return is_there(in.uv, grid, in.lot, slice_color(in).a);
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
}

@fragment
fn fragment(in: Varying) -> Output {
    if !is_seen(in) {
        discard;
    }
    var out: Output;
#ifdef NORMAL_PREPASS
    out.normal = vec4(slice_facing(in).normal * 0.5 + vec3(0.5), 1.0);
#endif
#ifdef MOTION_VECTOR_PREPASS
    let before = mesh_functions::get_previous_world_from_local(in.instance_index) * vec4(in.local_position, 1.0);
    let clip = view.unjittered_clip_from_world * vec4(in.world_position, 1.0);
    let clip_before = previous_view_uniforms.clip_from_world * before;
    // In texture coordinates: clip space is two wide, and its y points up.
    out.motion_vector = (clip.xy / clip.w - clip_before.xy / clip_before.w) * vec2(0.5, -0.5);
#endif
#ifdef UNCLIPPED_DEPTH_ORTHO_EMULATION
    // The vertex stage has brought what is nearer than the shadow map to its near plane.
    out.depth = in.position.z;
#endif
    return out;
}

#else

@fragment
fn fragment(in: Varying) {
    if !is_seen(in) {
        discard;
    }
}

#endif
