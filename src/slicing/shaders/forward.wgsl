// The main pass: slices lit by the scene.

#import bevy_pbr::{
    pbr_functions,
    pbr_types,
}
#import bevy_pbr::mesh_bindings::mesh
#import bevy_verdure::slicing::place::{Corner, Varying, frame, place_corner, is_orthographic}
#import bevy_verdure::slicing::look::{slice_color, slice_facing}
#import bevy_verdure::slicing::lots::{cells, footprint, lot_of}
#import bevy_verdure::lighting::simple::{Leaf, simple_light, transmission_of}

// Opacity below which a place is not worth its light.
#ifdef CROWN_PAPER_ORDER
const LEAST: f32 = 0.5 / 255.0;
#else
const LEAST: f32 = 1.0 / 255.0;
#endif

@vertex
fn vertex(corner: Corner) -> Varying {
    return place_corner(corner);
}

@fragment
fn fragment(in: Varying) -> @location(0) vec4<f32> {
#ifdef VISIBILITY_RANGE_DITHER
    pbr_functions::visibility_range_dither(in.position, in.dither);
#endif
    var seen = slice_color(in);
#ifdef CROWN_HASHED
    let is_seen = lot_of(in.uv, cells(footprint(in.uv)), in.lot, frame()) < seen.a;
    seen.a = 1.0;
#else
    let is_seen = seen.a >= LEAST;
#endif
    // Most of a slice is empty.
    if !is_seen {
        discard;
    }
    var input = pbr_types::pbr_input_new();
    input.material.base_color = seen;
    input.material.flags = input.material.flags | pbr_types::STANDARD_MATERIAL_FLAGS_FOG_ENABLED_BIT;
    input.flags = mesh[in.instance_index].flags;
    input.frag_coord = in.position;
    input.world_position = vec4(in.world_position, 1.0);
#ifdef CROWN_FULL_LIGHT
    let facing = slice_facing(in);
    input.material.perceptual_roughness = 0.75;
    input.material.reflectance = vec3(0.3);
    input.material.diffuse_transmission = in.tint.w;
    input.world_normal = facing.normal;
    input.N = facing.normal;
    input.is_orthographic = is_orthographic();
    input.V = pbr_functions::calculate_view(input.world_position, input.is_orthographic);
    input.diffuse_occlusion = vec3(facing.occlusion);
    input.specular_occlusion = facing.occlusion;
    var color = pbr_functions::apply_pbr_lighting(input);
#else ifdef CROWN_SIMPLE_LIGHT
    let facing = slice_facing(in);
    let leaf = Leaf(
        in.world_position, facing.normal, 0.0, facing.occlusion, transmission_of(in.tint.w), 0.0,
        in.position.xy, in.own_layer, input.flags);
    var color = vec4(simple_light(leaf, seen.rgb), seen.a);
#else
    var color = seen;
#endif
    color = pbr_functions::main_pass_post_lighting_processing(input, color);
    return vec4(color.rgb, seen.a);
}
