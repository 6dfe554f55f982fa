// The deferred prepass: the material of the ray's hit, for Bevy's deferred lighting.

#import bevy_pbr::{
    prepass_io,
    pbr_fragment::pbr_input_from_standard_material,
    pbr_deferred_functions::deferred_output,
    pbr_functions,
    mesh_functions,
    decal::clustered::apply_decals,
}
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
    @location(2) deferred: vec4<u32>,
    @location(3) deferred_lighting_pass_id: u32,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn fragment(in: Varying) -> Output {
#ifdef VISIBILITY_RANGE_DITHER
    pbr_functions::visibility_range_dither(in.position, in.visibility_range_dither);
#endif
    let seen = see(in, 1u);
    if seen.coverage == 0u {
        discard;
    }
    let s = surface(seen, in);
    let g = material::gradients(s);

    // What Bevy's own vertex stage would have handed over.
    var v: prepass_io::VertexOutput;
    v.position = vec4(in.position.xy, seen.depth, in.position.w);
    v.world_position = s.world_position;
    v.world_normal = s.world_normal;
#ifdef VERTEX_OUTPUT_INSTANCE_INDEX
    v.instance_index = in.instance_index;
#endif
#ifdef MOTION_VECTOR_PREPASS
    v.previous_world_position = mesh_functions::get_previous_world_from_local(in.instance_index)
        * vec4(previous_local_position(seen, in), 1.0);
#endif
    var input = pbr_input_from_standard_material(v, true);
    material::apply_textures(&input, s, g);
    if material::is_hole(input.material.base_color.a) {
        discard;
    }
    apply_decals(&input);
    input.material.base_color.a = 1.0;
    let packed = deferred_output(v, input);

    var out: Output;
#ifdef NORMAL_PREPASS
    out.normal = vec4(input.N * 0.5 + vec3(0.5), 1.0);
#endif
#ifdef MOTION_VECTOR_PREPASS
    out.motion_vector = packed.motion_vector;
#endif
    out.deferred = packed.deferred;
    out.deferred_lighting_pass_id = packed.deferred_lighting_pass_id;
    out.depth = seen.depth;
    return out;
}
