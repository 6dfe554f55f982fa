// The main pass, in two draws: the depth of slices among all that is opaque, and then the light of those that are seen. What
// is hidden costs no light.

#import bevy_pbr::{
    pbr_functions,
    pbr_types,
}
#import bevy_verdure::lighting::simple::{Leaf, simple_light, transmission_of}
#import bevy_verdure::texel::look::{seen_samples, slice_normal_and_alpha}
#ifdef TEXEL_INNER
#import bevy_pbr::mesh_view_bindings::view
#import bevy_verdure::texel::inner::look_inside
#import bevy_verdure::texel::look::{covered_samples, normal_spread, world_normal}
#endif
#import bevy_verdure::texel::place::{Corner, Varying, place_corner, is_orthographic, view_direction}
#import bevy_verdure::texel::types::texels

@vertex
fn vertex(corner: Corner) -> Varying {
    return place_corner(corner);
}

#ifdef TEXEL_DEPTH

#ifdef TEXEL_FOUR_SAMPLES

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

#else

@fragment
fn fragment(in: Varying) -> @location(0) vec4<f32> {
    let own = slice_normal_and_alpha(in);
    // Slices of another surface may lie at the same depth. They are blended away: to discard them costs software drivers
    // more.
    let is_seen = covered_samples(in, own.a) != 0u;
    let inner = look_inside(in, own);
    let seen = inner.color;
    let normal = world_normal(in, inner.normal);
    // Lit and shadowed where the surface is, above the inside that slices show (§4.1).
    let way = view_direction(in.world_position.xyz - view.world_position);
    let surface = in.world_position.xyz + way * inner.along;
    var input = pbr_types::pbr_input_new();
    input.material.base_color = vec4(seen, 1.0);
    input.material.perceptual_roughness = texels.roughness;
    input.material.reflectance = vec3(texels.reflectance);
    input.material.diffuse_transmission = texels.diffuse_transmission;
    // Light from behind falls as far on the other side.
    input.material.thickness = 2.0 * in.stand_off;
    input.material.flags = input.material.flags | pbr_types::STANDARD_MATERIAL_FLAGS_FOG_ENABLED_BIT;
    input.flags = in.flags;
    input.frag_coord = in.position;
    input.world_position = vec4(surface + normal * in.stand_off, 1.0);
    var color = input.material.base_color;
#ifdef TEXEL_FULL_LIGHT
    input.world_normal = normal;
    input.N = normal;
    input.is_orthographic = is_orthographic();
    input.V = pbr_functions::calculate_view(in.world_position, input.is_orthographic);
    color = pbr_functions::apply_pbr_lighting(input);
#else ifdef TEXEL_SIMPLE_LIGHT
    let leaf = Leaf(
        surface, normal, normal_spread(inner.normal), 1.0, transmission_of(texels.diffuse_transmission), in.stand_off,
        in.position.xy, 0u, in.flags);
    color = vec4(simple_light(leaf, seen), 1.0);
#endif
    color = pbr_functions::main_pass_post_lighting_processing(input, color);
    return vec4(color.rgb, select(0.0, 1.0, is_seen));
}

#endif
