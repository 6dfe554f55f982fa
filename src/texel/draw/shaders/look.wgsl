#define_import_path bevy_verdure::texel::look

// The fragment stage of all passes: what a slice looks like at a place.

#import bevy_verdure::texel::place::Varying
#import bevy_verdure::texel::types::{color_texture, normal_texture, slice_sampler}

// The volume's normal, and alpha, which colours have too, but here needs no conversion from sRGB.
fn slice_normal_and_alpha(in: Varying) -> vec4<f32> {
    return textureSample(normal_texture, slice_sampler, in.uv, in.layer);
}

fn slice_color(in: Varying) -> vec3<f32> {
    return textureSample(color_texture, slice_sampler, in.uv, in.layer).rgb;
}

// Pixels are there or not: what filtering puts between is there from one half on.
fn is_there(alpha: f32) -> bool {
    return alpha >= 0.5;
}

// The unit normal in world space, of one of the volume as its texture has it.
fn world_normal(in: Varying, baked: vec3<f32>) -> vec3<f32> {
    let n = baked * 2.0 - 1.0;
    let turned = in.normal_from_u * n.x + in.normal_from_v * n.y + in.normal_from_w * n.z;
    // Opposite normals may cancel out.
    let is_none = dot(turned, turned) == 0.0;
    return normalize(select(turned, in.normal_from_w, is_none));
}
