#define_import_path bevy_verdure::frusta::self_shadow

// Shadow that the relief of a segment casts on itself (§3): a short march from the hit towards the main light, the first
// of the directional ones. Shadow maps are too coarse for ribs and bark.

#import bevy_pbr::mesh_view_bindings::{view, lights}
#import bevy_pbr::mesh_view_types::DIRECTIONAL_LIGHT_FLAGS_SHADOWS_ENABLED_BIT
#import bevy_pbr::mesh_types::MESH_FLAGS_SHADOW_RECEIVER_BIT
#import bevy_pbr::{lighting, pbr_functions, pbr_types, shadows}
#import bevy_verdure::frusta::cast::NO_ROOT
#import bevy_verdure::frusta::march::stretch
#import bevy_verdure::frusta::relief::{coordinates, height, map_density, mip_level}
#import bevy_verdure::frusta::shell_radii::relief
#import bevy_verdure::frusta::trace::Seen
#import bevy_verdure::frusta::view::{stand, pixel_width}

// The light that a hit's own segment keeps off: what was added to it too much.
fn self_shadow(seen: Seen, in: pbr_types::PbrInput, instance_index: u32) -> vec3<f32> {
    // What faces away has no light to lose.
    if lights.n_directional_lights == 0u || dot(in.N, lights.directional_lights[0].direction_to_light) <= 0.0 {
        return vec3(0.0);
    }
    let kept_off = 1.0 - light_past_relief(seen, instance_index);
    if kept_off <= 0.0 {
        return vec3(0.0);
    }
    return kept_off * main_light(in);
}

// How much of the main light reaches a hit past its own segment's relief, 0 to 1.
fn light_past_relief(seen: Seen, instance_index: u32) -> f32 {
    let shell = seen.shell;
    let p = seen.hit.point;
    let towards = stand(instance_index).local_from_world * lights.directional_lights[0].direction_to_light;
    let d = normalize(towards);
    // What is left of the shell on the way; the hit itself may lie outside by rounding.
    let exit = stretch(p, d, 1.0, shell, 0.0).y;
    if exit <= 0.0 || exit >= NO_ROOT {
        return 1.0;
    }
    let distance = length(p - shell.top.axis * dot(p, shell.top.axis));
    let density = map_density(shell, distance);
    let lod = mip_level(pixel_width(seen.hit.t) * shell.metre * max(density.x, density.y));
    // Denser near the hit, where shadows are small. What lies a step's rise below the relief is in full shadow, so that
    // steps do not show.
    let steps = f32(relief.self_shadow);
    let rise = max(1.0 - seen.w, 0.05) / steps;
    var deepest = 0.0;
    for (var i = 0.5; i < steps; i += 1.0) {
        let s = i / steps;
        let c = coordinates(shell, p + d * (exit * s * s));
        deepest = max(deepest, height(shell, c.x, c.y, lod) - c.z);
    }
    return 1.0 - clamp(deepest / rise, 0.0, 1.0);
}

// What the main light adds to a surface that has nothing before it but what shadow maps know of, as Bevy's
// `apply_pbr_lighting` adds it.
fn main_light(in: pbr_types::PbrInput) -> vec3<f32> {
    let material = in.material;
    var surface: lighting::LightingInput;
    surface.layers[0].NdotV = max(dot(in.N, in.V), 0.0001);
    surface.layers[0].N = in.N;
    surface.layers[0].R = reflect(-in.V, in.N);
    surface.layers[0].perceptual_roughness = material.perceptual_roughness;
    surface.layers[0].roughness = lighting::perceptualRoughnessToRoughness(material.perceptual_roughness);
    surface.P = in.world_position.xyz;
    surface.V = in.V;
    surface.diffuse_color = pbr_functions::calculate_diffuse_color(
        material.base_color.rgb, material.metallic, material.specular_transmission, material.diffuse_transmission);
    surface.metallic = material.metallic;
    surface.F0_dielectric = pbr_functions::calculate_F0_dielectric(material.reflectance);
    surface.F0_metallic = material.base_color.rgb;
    surface.F_ab = lighting::F_AB(material.perceptual_roughness, surface.layers[0].NdotV);
    var shadow = 1.0;
    let casts = (lights.directional_lights[0].flags & DIRECTIONAL_LIGHT_FLAGS_SHADOWS_ENABLED_BIT) != 0u;
    if casts && (in.flags & MESH_FLAGS_SHADOW_RECEIVER_BIT) != 0u {
        let v = view.view_from_world;
        let view_z = dot(vec4(v[0].z, v[1].z, v[2].z, v[3].z), in.world_position);
        shadow = shadows::fetch_directional_shadow(0u, in.world_position, in.world_normal, view_z, in.frag_coord.xy);
    }
    return view.exposure * shadow * lighting::directional_light(0u, &surface, true);
}
