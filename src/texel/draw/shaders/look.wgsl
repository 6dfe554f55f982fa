#define_import_path bevy_verdure::texel::look

// The fragment stage of all passes: what a slice looks like at a place.

#import bevy_verdure::texel::place::Varying
#import bevy_verdure::texel::types::{
    color_across_u, color_across_v, color_across_w, normal_across_u, normal_across_v, normal_across_w,
    level_sampler, upright_sampler,
}

// Pixels are there or not: what filtering puts between is there from here on.
const OPAQUE: f32 = 0.5;

fn slice_color(in: Varying) -> vec4<f32> {
    // Gradients are taken before the texture is chosen.
    let dx = dpdx(in.uv);
    let dy = dpdy(in.uv);
    switch in.axis {
        case 0u: {
            return textureSampleGrad(color_across_u, upright_sampler, in.uv, in.layer, dx, dy);
        }
        case 1u: {
            return textureSampleGrad(color_across_v, upright_sampler, in.uv, in.layer, dx, dy);
        }
        default: {
            return textureSampleGrad(color_across_w, level_sampler, in.uv, in.layer, dx, dy);
        }
    }
}

// The unit normal in world space.
fn slice_normal(in: Varying) -> vec3<f32> {
    let dx = dpdx(in.uv);
    let dy = dpdy(in.uv);
    var baked: vec3<f32>;
    switch in.axis {
        case 0u: {
            baked = textureSampleGrad(normal_across_u, upright_sampler, in.uv, in.layer, dx, dy).xyz;
        }
        case 1u: {
            baked = textureSampleGrad(normal_across_v, upright_sampler, in.uv, in.layer, dx, dy).xyz;
        }
        default: {
            baked = textureSampleGrad(normal_across_w, level_sampler, in.uv, in.layer, dx, dy).xyz;
        }
    }
    let n = baked * 2.0 - 1.0;
    let turned = in.normal_from_u * n.x + in.normal_from_v * n.y + in.normal_from_w * n.z;
    // Opposite normals may cancel out.
    let is_none = dot(turned, turned) == 0.0;
    return normalize(select(turned, in.normal_from_w, is_none));
}
