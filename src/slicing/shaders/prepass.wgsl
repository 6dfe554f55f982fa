// The prepasses and the shadow maps: slices there by chance, as often as they are opaque.

#import bevy_pbr::{mesh_functions, prepass_bindings::previous_view_uniforms}
#import bevy_pbr::mesh_view_bindings::view
#import bevy_verdure::slicing::cast::first_leaf
#import bevy_verdure::slicing::place::{Corner, Varying, frame, place_corner}
#import bevy_verdure::slicing::look::{slice_color, slice_facing}
#import bevy_verdure::slicing::lots::{cells, footprint, lot_of}
#ifdef VISIBILITY_RANGE_DITHER
#import bevy_pbr::pbr_functions::visibility_range_dither
#endif

@vertex
fn vertex(corner: Corner) -> Varying {
    return place_corner(corner);
}

#ifdef CROWN_LIGHT_VIEW

// Leaves lie at depths by chance, as light would meet them in an ellipsoid that fills the slicing box: one slice shades
// itself as softly as the leaves do that are drawn into it.
@fragment
fn fragment(in: Varying) -> @builtin(frag_depth) f32 {
#ifdef VISIBILITY_RANGE_DITHER
    visibility_range_dither(in.position, in.dither);
#endif
    let alpha = slice_color(in).a;
    // A sun's shadows are not gathered: their lots stay.
    let lot = lot_of(in.uv, in.grid, in.lot, 0u);
    if lot >= alpha {
        discard;
    }
    let p = 2.0 * in.uv - 1.0;
    let half = sqrt(max(1.0 - dot(p, p), 0.0));
    let near = min(in.share.x, half);
    let far = max(in.share.y, -half);
    // What is nearer to the sun than its shadow map casts shadows all the same.
    return clamp(in.position.z + in.deep * mix(near, far, first_leaf(lot, alpha)), 0.0, 1.0);
}

#else

fn is_seen(in: Varying) -> bool {
#ifdef VISIBILITY_RANGE_DITHER
    visibility_range_dither(in.position, in.dither);
#endif
    return lot_of(in.uv, cells(footprint(in.uv)), in.lot, frame()) < slice_color(in).a;
}

#ifdef PREPASS_FRAGMENT

struct Output {
#ifdef NORMAL_PREPASS
    @location(0) normal: vec4<f32>,
#endif
#ifdef MOTION_VECTOR_PREPASS
    @location(1) motion_vector: vec2<f32>,
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

#endif
