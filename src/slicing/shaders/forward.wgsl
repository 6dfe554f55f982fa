// The main pass: slices lit by the scene.

#import bevy_pbr::{
    pbr_functions,
    pbr_types,
}
#import bevy_pbr::mesh_bindings::mesh
#import bevy_verdure::slicing::place::{Corner, Varying, place_corner, is_orthographic}
#import bevy_verdure::slicing::look::{Look, look, is_there, footprint}
#import bevy_verdure::slicing::simple::simple_light

@vertex
fn vertex(corner: Corner) -> Varying {
    return place_corner(corner);
}

// A slice's colour in the light of the scene.
fn shade(in: Varying, seen: Look, alpha: f32) -> vec4<f32> {
    var input = pbr_types::pbr_input_new();
    input.material.base_color = vec4(seen.color.rgb, alpha);
    input.material.flags = input.material.flags | pbr_types::STANDARD_MATERIAL_FLAGS_FOG_ENABLED_BIT;
    input.flags = mesh[in.instance_index].flags;
    input.frag_coord = in.position;
    input.world_position = in.world_position;
#ifdef CROWN_FULL_LIGHT
    input.material.perceptual_roughness = 0.75;
    input.material.reflectance = vec3(0.3);
    input.world_normal = seen.normal;
    input.N = seen.normal;
    input.is_orthographic = is_orthographic();
    input.V = pbr_functions::calculate_view(in.world_position, input.is_orthographic);
    input.diffuse_occlusion = vec3(seen.occlusion);
    input.specular_occlusion = seen.occlusion;
    var color = pbr_functions::apply_pbr_lighting(input);
#else ifdef CROWN_SIMPLE_LIGHT
    let light = simple_light(in.world_position.xyz, seen.normal, seen.color.rgb, seen.occlusion, input.flags);
    var color = vec4(light, alpha);
#else
    var color = input.material.base_color;
#endif
    color = pbr_functions::main_pass_post_lighting_processing(input, color);
    return vec4(color.rgb, alpha);
}

@fragment
fn fragment(in: Varying) -> @location(0) vec4<f32> {
    let seen = look(in);
    var alpha = seen.color.a;
#ifdef CROWN_HASHED
    alpha = select(0.0, 1.0, is_there(in, alpha, footprint(in.uv)));
#endif
    // Most of a slice is empty; less than half a step of eight bits shows nowhere.
    if alpha < 0.5 / 255.0 {
        discard;
    }
    return shade(in, seen, alpha);
}
