#define_import_path bevy_verdure::frusta::material

// Bevy's standard material on a ray-cast surface. Its scalars are filled in by Bevy; its textures are sampled
// here, with gradients of the ray, so that no mip level betrays the seam at u = 0.

#import bevy_pbr::{pbr_bindings, pbr_functions, pbr_types}
#import bevy_pbr::mesh_view_bindings::view
#import bevy_verdure::frusta::trace::Surface

struct Gradients {
    uv: vec2<f32>,
    dx: vec2<f32>,
    dy: vec2<f32>,
}

fn gradients(surface: Surface) -> Gradients {
    let m = pbr_bindings::material.uv_transform;
    let linear = mat2x2(m[0].xy, m[1].xy);
    let bias = exp2(view.mip_bias);
    return Gradients(
        (m * vec3(surface.uv, 1.0)).xy,
        linear * surface.uv_dx * bias,
        linear * surface.uv_dy * bias,
    );
}

fn base_color(g: Gradients) -> vec4<f32> {
    var color = pbr_bindings::material.base_color;
    if (pbr_bindings::material.flags & pbr_types::STANDARD_MATERIAL_FLAGS_BASE_COLOR_TEXTURE_BIT) != 0u {
        color *= textureSampleGrad(pbr_bindings::base_color_texture, pbr_bindings::base_color_sampler, g.uv, g.dx, g.dy);
    }
    return color;
}

// True where a masked material has a hole.
fn is_hole(alpha: f32) -> bool {
    let mode = pbr_bindings::material.flags & pbr_types::STANDARD_MATERIAL_FLAGS_ALPHA_MODE_RESERVED_BITS;
    return mode == pbr_types::STANDARD_MATERIAL_FLAGS_ALPHA_MODE_MASK && alpha < pbr_bindings::material.alpha_cutoff;
}

fn is_masked() -> bool {
    let mode = pbr_bindings::material.flags & pbr_types::STANDARD_MATERIAL_FLAGS_ALPHA_MODE_RESERVED_BITS;
    return mode == pbr_types::STANDARD_MATERIAL_FLAGS_ALPHA_MODE_MASK;
}

// The shading normal, world space, with the normal map.
fn shading_normal(surface: Surface, g: Gradients) -> vec3<f32> {
#ifdef STANDARD_MATERIAL_NORMAL_MAP
    let n = surface.world_normal;
    // Across the shading normal, which leans from the tangent where it is interpolated.
    let tangent = normalize(surface.world_tangent.xyz - n * dot(n, surface.world_tangent.xyz));
    let tbn = pbr_functions::calculate_tbn_mikktspace(n, vec4(tangent, surface.world_tangent.w));
    let texture = textureSampleGrad(pbr_bindings::normal_map_texture, pbr_bindings::normal_map_sampler, g.uv, g.dx, g.dy);
    return pbr_functions::apply_normal_mapping(pbr_bindings::material.flags, tbn, false, true, texture.rgb);
#else
    return surface.world_normal;
#endif
}

// Puts the textures on what Bevy made of the material's scalars.
fn apply_textures(input: ptr<function, pbr_types::PbrInput>, surface: Surface, g: Gradients) {
    let flags = pbr_bindings::material.flags;
    (*input).material.base_color = base_color(g);
    (*input).material.uv_transform = pbr_bindings::material.uv_transform;
    if (flags & pbr_types::STANDARD_MATERIAL_FLAGS_UNLIT_BIT) != 0u {
        return;
    }
    if (flags & pbr_types::STANDARD_MATERIAL_FLAGS_EMISSIVE_TEXTURE_BIT) != 0u {
        let emissive = textureSampleGrad(pbr_bindings::emissive_texture, pbr_bindings::emissive_sampler, g.uv, g.dx, g.dy);
        (*input).material.emissive = vec4((*input).material.emissive.rgb * emissive.rgb, (*input).material.emissive.a);
    }
    if (flags & pbr_types::STANDARD_MATERIAL_FLAGS_METALLIC_ROUGHNESS_TEXTURE_BIT) != 0u {
        // As glTF has it: roughness in green, metallic in blue.
        let metallic_roughness = textureSampleGrad(
            pbr_bindings::metallic_roughness_texture, pbr_bindings::metallic_roughness_sampler, g.uv, g.dx, g.dy);
        (*input).material.metallic *= metallic_roughness.b;
        (*input).material.perceptual_roughness *= metallic_roughness.g;
    }
    if (flags & pbr_types::STANDARD_MATERIAL_FLAGS_OCCLUSION_TEXTURE_BIT) != 0u {
        let occlusion = textureSampleGrad(pbr_bindings::occlusion_texture, pbr_bindings::occlusion_sampler, g.uv, g.dx, g.dy);
        (*input).diffuse_occlusion *= occlusion.r;
    }
#ifndef LOAD_PREPASS_NORMALS
    (*input).N = shading_normal(surface, g);
    (*input).clearcoat_N = surface.world_normal;
#endif
}
