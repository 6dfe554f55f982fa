// The main pass: slices lit by the scene.

#import bevy_pbr::{
    pbr_functions,
    pbr_types,
}
#import bevy_pbr::mesh_bindings::mesh
#import bevy_verdure::texel::look::{covered_samples, slice_color, slice_normal_and_alpha, world_normal}
#import bevy_verdure::texel::place::{Corner, Varying, place_corner, is_orthographic}
#import bevy_verdure::texel::types::texels

@vertex
fn vertex(corner: Corner) -> Varying {
    return place_corner(corner);
}

struct Output {
    @location(0) color: vec4<f32>,
#ifdef TEXEL_FOUR_SAMPLES
    @builtin(sample_mask) coverage: u32,
#endif
}

@fragment
fn fragment(in: Varying) -> Output {
    let baked = slice_normal_and_alpha(in);
    let seen = slice_color(in);
    let covered = covered_samples(in, baked.a);
    if covered == 0u {
        discard;
    }
    let normal = world_normal(in, baked.xyz);
    var input = pbr_types::pbr_input_new();
    input.material.base_color = vec4(seen, 1.0);
    input.material.perceptual_roughness = texels.roughness;
    input.material.reflectance = vec3(texels.reflectance);
    input.material.flags = input.material.flags | pbr_types::STANDARD_MATERIAL_FLAGS_FOG_ENABLED_BIT;
    input.flags = mesh[in.instance_index].flags;
    input.frag_coord = in.position;
    // Lit and shadowed where the surface is, above the inside that slices show (§4.1).
    input.world_position = vec4(in.world_position.xyz + normal * in.inside, 1.0);
    input.world_normal = normal;
    input.N = normal;
    input.is_orthographic = is_orthographic();
    input.V = pbr_functions::calculate_view(in.world_position, input.is_orthographic);
    var color = input.material.base_color;
#ifdef TEXEL_LIT
    color = pbr_functions::apply_pbr_lighting(input);
#endif
    color = pbr_functions::main_pass_post_lighting_processing(input, color);
    var out: Output;
    out.color = vec4(color.rgb, 1.0);
#ifdef TEXEL_FOUR_SAMPLES
    out.coverage = covered;
#endif
    return out;
}
