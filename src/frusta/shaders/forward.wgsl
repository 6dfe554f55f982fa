// The main pass: lit where the ray meets the surface.

#import bevy_pbr::{
    forward_io,
    pbr_fragment::pbr_input_from_standard_material,
    pbr_functions,
    pbr_functions::{apply_pbr_lighting, main_pass_post_lighting_processing},
    pbr_types,
    decal::clustered::apply_decals,
}
#import bevy_verdure::frusta::place::{Corner, Varying, place_corner, segment_of}
#import bevy_verdure::frusta::trace::{see, surface}
#import bevy_verdure::frusta::material
#import bevy_verdure::frusta::view::is_orthographic
#ifdef FRUSTA_SELF_SHADOW
#import bevy_verdure::frusta::self_shadow::self_shadow
#endif

@vertex
fn vertex(corner: Corner) -> Varying {
    return place_corner(corner);
}

struct Output {
    @location(0) color: vec4<f32>,
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
    let s = surface(seen, in);
    let g = material::gradients(s);

    // What Bevy's own vertex stage would have handed over.
    var v: forward_io::VertexOutput;
    v.position = vec4(in.position.xy, seen.depth, in.position.w);
    v.world_position = s.world_position;
    v.world_normal = s.world_normal;
#ifdef VERTEX_OUTPUT_INSTANCE_INDEX
    v.instance_index = in.instance_index;
#endif
    var input = pbr_input_from_standard_material(v, true);
    material::apply_textures(&input, s, g);
    if material::is_hole(input.material.base_color.a) {
        discard;
    }
    apply_decals(&input);
    input.material.base_color.a = 1.0;

    var out: Output;
    if (input.material.flags & pbr_types::STANDARD_MATERIAL_FLAGS_UNLIT_BIT) == 0u {
        out.color = apply_pbr_lighting(input);
#ifdef FRUSTA_SELF_SHADOW
        out.color = vec4(max(out.color.rgb - self_shadow(seen, input, in.instance_index), vec3(0.0)), out.color.a);
#endif
    } else {
        out.color = input.material.base_color;
    }
    out.color = main_pass_post_lighting_processing(input, out.color);
#ifdef FRUSTA_OUTPUT_GEOMETRY
    out.color = vec4(seen.hit.t, f32(segment_of(in)), s.uv);
#endif
#ifdef FRUSTA_OUTPUT_NORMALS
    out.color = vec4(s.world_normal, seen.hit.t);
#endif
    out.depth = seen.depth;
#ifdef DEPTH_PREPASS
    // The prepass computed this depth in another shader, whose roundings may differ: stay in front of it.
    out.depth = out.depth * (1.0 + 1e-6) + 2e-7 * f32(is_orthographic());
#endif
#ifdef FRUSTA_MULTISAMPLED
    out.coverage = seen.coverage;
#endif
    return out;
}
