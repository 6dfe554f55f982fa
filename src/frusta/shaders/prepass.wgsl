// The prepasses and the shadow maps: depth, normals and motion vectors of the ray's hit.

#import bevy_pbr::{pbr_functions, prepass_bindings::previous_view_uniforms, mesh_functions}
#import bevy_pbr::mesh_view_bindings::view
#import bevy_verdure::frusta::place::{Corner, Varying, place_corner}
#import bevy_verdure::frusta::trace::{see, surface, previous_local_position}
#import bevy_verdure::frusta::material

@vertex
fn vertex(corner: Corner) -> Varying {
    return place_corner(corner);
}

struct Output {
#ifdef NORMAL_PREPASS
    @location(0) normal: vec4<f32>,
#endif
#ifdef MOTION_VECTOR_PREPASS
    @location(1) motion_vector: vec2<f32>,
#endif
    @builtin(frag_depth) depth: f32,
#ifdef FRUSTA_MULTISAMPLED
    @builtin(sample_mask) coverage: u32,
#endif
}

@fragment
fn fragment(
    in: Varying,
#ifdef FRUSTA_MULTISAMPLED
    @builtin(sample_mask) sample_mask: u32,
#endif
) -> Output {
#ifdef VISIBILITY_RANGE_DITHER
    pbr_functions::visibility_range_dither(in.position, in.visibility_range_dither);
#endif
#ifdef FRUSTA_MULTISAMPLED
    let seen = see(in, sample_mask);
#else
    let seen = see(in, 1u);
#endif
    if seen.coverage == 0u {
        discard;
    }
    var out: Output;
    out.depth = seen.depth;
#ifdef FRUSTA_MULTISAMPLED
    out.coverage = seen.coverage;
#endif
#ifdef PREPASS_FRAGMENT
    let s = surface(seen, in);
    let g = material::gradients(s);
    if material::is_masked() && material::is_hole(material::base_color(g).a) {
        discard;
    }
#ifdef NORMAL_PREPASS
    out.normal = vec4(material::shading_normal(s, g) * 0.5 + vec3(0.5), 1.0);
#endif
#ifdef MOTION_VECTOR_PREPASS
    let before = mesh_functions::get_previous_world_from_local(in.instance_index)
        * vec4(previous_local_position(seen, in), 1.0);
    let clip = view.unjittered_clip_from_world * s.world_position;
    let clip_before = previous_view_uniforms.clip_from_world * before;
    // In texture coordinates: clip space is two wide, and its y points up.
    out.motion_vector = (clip.xy / clip.w - clip_before.xy / clip_before.w) * vec2(0.5, -0.5);
#endif
#else
    if material::is_masked() {
        let s = surface(seen, in);
        if material::is_hole(material::base_color(material::gradients(s)).a) {
            discard;
        }
    }
#endif
    return out;
}
