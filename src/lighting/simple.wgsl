#define_import_path bevy_verdure::lighting::simple

// Light that costs little: directional lights with their shadow maps, and ambient light, on leaves that scatter evenly.

#import bevy_pbr::{
    mesh_types::MESH_FLAGS_SHADOW_RECEIVER_BIT,
    mesh_view_bindings::{lights, view},
    mesh_view_types::DIRECTIONAL_LIGHT_FLAGS_SHADOWS_ENABLED_BIT,
    shadow_sampling::sample_shadow_map_hardware,
    utils::interleaved_gradient_noise,
}
#import bevy_render::maths::PI
#import bevy_verdure::lighting::spread::mean_cosine

// What is lit.
struct Leaf {
    // World space.
    position: vec3<f32>,
    normal: vec3<f32>,
    // 0 where that is the only one; where it is the mean of many, one less the square of that mean's length.
    spread: f32,
    // Share of the light from around.
    occlusion: f32,
    // Share of the sun's light that comes through from behind.
    transmission: f32,
    // How far above it shadows are received, on the side that the light falls on.
    stand_off: f32,
    // Where on the screen.
    pixel: vec2<f32>,
    // Tells it from others behind the same pixel.
    layer: u32,
    // Its mesh's.
    flags: u32,
}

// What Bevy's full lighting makes of a leaf (perceptual roughness 0.75, reflectance 0.3) that is seen at 60 degrees, which
// is the mean over a hemisphere: its share of ambient light is this one of its colour, ...
const COLOR_AROUND: f32 = 0.452;
// ... and this one, whatever its colour.
const GLOSS_AROUND: f32 = 0.013;
// Gloss under a directional light, as if that were scattered evenly.
const GLOSS: f32 = 0.018;

// A leaf's `transmission`, where any leaf of the draw has one: told by the pipeline, it costs nothing where none has.
fn transmission_of(transmission: f32) -> f32 {
#ifdef STANDARD_MATERIAL_DIFFUSE_TRANSMISSION
    return transmission;
#else
    return 0.0;
#endif
}

// A number from 0 to 1 for a pixel. Layers that lie one behind the other have other ones.
fn noise(leaf: Leaf) -> f32 {
    return fract(interleaved_gradient_noise(leaf.pixel, 0u) + 0.618034 * f32(leaf.layer));
}

// A place in a cascade's shadow map: texture coordinates and depth.
fn in_map(light: u32, cascade: u32, position: vec3<f32>) -> vec3<f32> {
    let m = lights.directional_lights[light].cascades[cascade].clip_from_world;
    return (m * vec4(position, 1.0)).xyz * vec3(0.5, -0.5, 1.0) + vec3(0.5, 0.5, 0.0);
}

// The share of a directional light that comes to a place, by the shadow map's own filter of two by two pixels. Where
// cascades overlap, each pixel picks one by chance: looking into one costs half as much as mixing two.
fn sunlight(light: u32, leaf: Leaf, cosine: f32, depth: f32) -> f32 {
    let l = &lights.directional_lights[light];
    let last = max((*l).num_cascades, 1u) - 1u;
    let sooner = 1.0 - (*l).cascades_overlap_proportion * (1.0 - noise(leaf));
    // No loop: software drivers go through one lane by lane.
    var cascade = select(0u, 1u, last > 0u && depth >= (*l).cascades[0].far_bound * sooner);
    cascade += select(0u, 1u, last > 1u && depth >= (*l).cascades[1].far_bound * sooner);
    cascade += select(0u, 1u, last > 2u && depth >= (*l).cascades[2].far_bound * sooner);
    let above = (*l).shadow_normal_bias * (*l).cascades[cascade].texel_size + leaf.stand_off;
    // Light that comes through falls on the other side.
    let offset = select(above, -above, leaf.transmission > 0.0 && cosine < 0.0) * leaf.normal
        + (*l).shadow_depth_bias * (*l).direction_to_light;
    let place = in_map(light, cascade, leaf.position + offset);
    let share = sample_shadow_map_hardware(place.xy, place.z, i32((*l).depth_texture_base_index + cascade));
    let is_in = all(saturate(place) == place) && depth < (*l).cascades[last].far_bound;
    return select(1.0, share, is_in);
}

// What a directional light adds.
fn add_light(light: u32, leaf: Leaf, color: vec3<f32>, depth: f32) -> vec3<f32> {
    let l = &lights.directional_lights[light];
    let cosine = dot(leaf.normal, (*l).direction_to_light) * sqrt(1.0 - leaf.spread);
    var share = mean_cosine(cosine, leaf.spread, leaf.transmission) / PI;
    if ((*l).flags & DIRECTIONAL_LIGHT_FLAGS_SHADOWS_ENABLED_BIT) != 0u
        && (leaf.flags & MESH_FLAGS_SHADOW_RECEIVER_BIT) != 0u {
        share *= sunlight(light, leaf, cosine, depth);
    }
    return share * (color + GLOSS) * (*l).color.rgb;
}

// The light that a leaf of a colour sends to the eye.
fn simple_light(leaf: Leaf, color: vec3<f32>) -> vec3<f32> {
    let v = view.view_from_world;
    let p = leaf.position;
    let depth = -(v[0].z * p.x + v[1].z * p.y + v[2].z * p.z + v[3].z);
    var light = (COLOR_AROUND * color + GLOSS_AROUND) * lights.ambient_color.rgb * leaf.occlusion;
    // The first light is named by a constant, which spares software drivers from gathering it pixel by pixel.
    if lights.n_directional_lights > 0u {
        light += add_light(0u, leaf, color, depth);
    }
#ifdef MORE_SUNS
    for (var i = 1u; i < lights.n_directional_lights; i += 1u) {
        light += add_light(i, leaf, color, depth);
    }
#endif
    return light * view.exposure;
}
