#define_import_path bevy_verdure::slicing::simple

// Light that costs little: directional lights with their shadow maps, and ambient light, on leaves that scatter evenly.

#import bevy_pbr::{
    mesh_types::MESH_FLAGS_SHADOW_RECEIVER_BIT,
    mesh_view_bindings::{lights, view},
    mesh_view_types::DIRECTIONAL_LIGHT_FLAGS_SHADOWS_ENABLED_BIT,
    shadow_sampling::sample_shadow_map_hardware,
    shadows::{get_cascade_index, world_to_directional_light_local},
}
#import bevy_render::maths::PI

// What Bevy's full lighting makes of a leaf (perceptual roughness 0.75, reflectance 0.3) that is seen at 60 degrees, which
// is the mean over a hemisphere: its share of ambient light is this one of its colour, ...
const COLOR_AROUND: f32 = 0.452;
// ... and this one, whatever its colour.
const GLOSS_AROUND: f32 = 0.013;
// Gloss under a directional light, as if that were scattered evenly.
const GLOSS: f32 = 0.018;

// The share of a directional light that comes to a place, by the shadow map's own filter of two by two pixels.
fn lit_share(light: u32, cascade: u32, position: vec3<f32>, normal: vec3<f32>) -> f32 {
    let l = &lights.directional_lights[light];
    let offset = (*l).shadow_normal_bias * (*l).cascades[cascade].texel_size * normal
        + (*l).shadow_depth_bias * (*l).direction_to_light;
    let local = world_to_directional_light_local(light, cascade, vec4(position + offset, 1.0));
    if local.w == 0.0 {
        return 1.0;
    }
    return sample_shadow_map_hardware(local.xy, local.z, i32((*l).depth_texture_base_index + cascade));
}

// The same between cascades, which overlap so that no edge shows.
fn sunlight(light: u32, position: vec3<f32>, normal: vec3<f32>, depth: f32) -> f32 {
    let l = &lights.directional_lights[light];
    let cascade = get_cascade_index(light, -depth);
    if cascade >= (*l).num_cascades {
        return 1.0;
    }
    let share = lit_share(light, cascade, position, normal);
    let far = (*l).cascades[cascade].far_bound;
    let near = (1.0 - (*l).cascades_overlap_proportion) * far;
    if cascade + 1u >= (*l).num_cascades || depth < near {
        return share;
    }
    return mix(share, lit_share(light, cascade + 1u, position, normal), (depth - near) / (far - near));
}

// The light that a leaf sends to the eye. `occlusion` is the share of ambient light that comes in; `flags` are its mesh's.
fn simple_light(position: vec3<f32>, normal: vec3<f32>, color: vec3<f32>, occlusion: f32, flags: u32) -> vec3<f32> {
    let v = view.view_from_world;
    let depth = -(v[0].z * position.x + v[1].z * position.y + v[2].z * position.z + v[3].z);
    var light = (COLOR_AROUND * color + GLOSS_AROUND) * lights.ambient_color.rgb * occlusion;
    for (var i = 0u; i < lights.n_directional_lights; i += 1u) {
        let l = &lights.directional_lights[i];
        var share = dot(normal, (*l).direction_to_light) / PI;
        if share <= 0.0 {
            continue;
        }
        if ((*l).flags & DIRECTIONAL_LIGHT_FLAGS_SHADOWS_ENABLED_BIT) != 0u
            && (flags & MESH_FLAGS_SHADOW_RECEIVER_BIT) != 0u {
            share *= sunlight(i, position, normal, depth);
        }
        light += share * (color + GLOSS) * (*l).color.rgb;
    }
    return light * view.exposure;
}
