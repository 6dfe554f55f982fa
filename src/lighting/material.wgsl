// A StandardMaterial lit as plants are.

#import bevy_pbr::{
    forward_io::{FragmentOutput, VertexOutput},
    mesh_bindings::mesh,
    mesh_view_bindings::view,
    pbr_bindings,
    pbr_functions,
    pbr_types,
}
#ifdef PLANT_FULL_LIGHT
#import bevy_pbr::pbr_fragment::pbr_input_from_standard_material
#endif
#import bevy_verdure::lighting::simple::{Leaf, simple_light, transmission_of}

#ifndef PLANT_FULL_LIGHT
fn plant_input(in: VertexOutput, is_front: bool) -> pbr_types::PbrInput {
    var input = pbr_types::pbr_input_new();
    input.material.flags = pbr_bindings::material.flags;
    input.material.alpha_cutoff = pbr_bindings::material.alpha_cutoff;
    input.material.base_color = pbr_bindings::material.base_color;
#ifdef VERTEX_COLORS
    input.material.base_color *= in.color;
#endif
#ifdef PLANT_TEXTURED
#ifdef PLANT_SECOND_UVS
    let uv = in.uv_b;
#else
    let uv = in.uv;
#endif
    input.material.base_color *= textureSampleBias(
        pbr_bindings::base_color_texture,
        pbr_bindings::base_color_sampler,
        (pbr_bindings::material.uv_transform * vec3(uv, 1.0)).xy,
        view.mip_bias,
    );
#endif
    input.flags = mesh[in.instance_index].flags;
    input.frag_coord = in.position;
    input.world_position = in.world_position;
    let double_sided = (input.material.flags & pbr_types::STANDARD_MATERIAL_FLAGS_DOUBLE_SIDED_BIT) != 0u;
    input.world_normal = pbr_functions::prepare_world_normal(in.world_normal, double_sided, is_front);
    return input;
}
#endif

@fragment
fn fragment(in: VertexOutput, @builtin(front_facing) is_front: bool) -> FragmentOutput {
#ifdef VISIBILITY_RANGE_DITHER
    pbr_functions::visibility_range_dither(in.position, in.visibility_range_dither);
#endif
#ifdef PLANT_FULL_LIGHT
    var input = pbr_input_from_standard_material(in, is_front);
#else
    var input = plant_input(in, is_front);
#endif
    input.material.base_color = pbr_functions::alpha_discard(input.material, input.material.base_color);
    let seen = input.material.base_color;
    var out: FragmentOutput;
#ifdef PLANT_FULL_LIGHT
    out.color = pbr_functions::apply_pbr_lighting(input);
#else ifdef PLANT_SIMPLE_LIGHT
    let leaf = Leaf(
        in.world_position.xyz, normalize(input.world_normal), 0.0, 1.0, transmission_of(pbr_bindings::material.diffuse_transmission), 0.0,
        in.position.xy, 0u, input.flags);
    out.color = vec4(simple_light(leaf, seen.rgb), seen.a);
#else
    out.color = seen;
#endif
    out.color = pbr_functions::main_pass_post_lighting_processing(input, out.color);
    return out;
}
