#define_import_path bevy_verdure::texel::look

// The fragment stage of all passes: what a slice looks like at a place.

#import bevy_pbr::utils::interleaved_gradient_noise
#import bevy_verdure::texel::place::{AXIS, Varying}
#import bevy_verdure::texel::types::{level_sampler, normal_texture}

// The volume's normal, and alpha, which colours have too, but here needs no conversion from sRGB.
fn slice_normal_and_alpha(in: Varying) -> vec4<f32> {
#ifdef TEXEL_DIRECTIONAL_LIGHT
    // Of what casts a shadow one pixel says enough, in the level whose pixels are those of the shadow map.
    let columns_and_rows = max(textureDimensions(normal_texture) >> vec2(in.level), vec2(1u));
    // Rows of upright slices are heights, which end.
    let inside = select(fract(in.uv), vec2(fract(in.uv.x), in.uv.y), AXIS != 2u);
    let pixel = min(vec2<u32>(inside * vec2<f32>(columns_and_rows)), columns_and_rows - 1u);
    return textureLoad(normal_texture, pixel, in.layer, in.level);
#else
    return textureSample(normal_texture, level_sampler, in.uv, in.layer);
#endif
}

// Which samples of a pixel are there, where alpha goes through one half. Pixels of slices are there or not; what
// filtering puts between is where their outline runs.
fn covered_samples(in: Varying, alpha: f32) -> u32 {
#ifdef TEXEL_DIRECTIONAL_LIGHT
    // Shadows do not fade.
    let is_mine = true;
#else
    // A number from 0 to 1 for each pixel of the screen, as evenly spread as may be.
    let mine = interleaved_gradient_noise(in.position.xy, 0u);
    let is_mine = mine >= in.lots.x && mine < in.lots.y;
#endif
#ifdef TEXEL_FOUR_SAMPLES
    // The standard places of four samples, in pixels from the centre.
    let dx = dpdx(alpha);
    let dy = dpdy(alpha);
    let at = vec4(alpha) + dx * vec4(-0.125, 0.375, -0.375, 0.125) + dy * vec4(-0.375, -0.125, 0.125, 0.375);
    let there = vec4<u32>(at >= vec4(0.5)) * vec4(1u, 2u, 4u, 8u);
    return select(0u, there.x | there.y | there.z | there.w, is_mine);
#else
    return select(0u, 0xffffffffu, is_mine && alpha >= 0.5);
#endif
}

// The same; a pixel without any is none.
fn seen_samples(in: Varying, alpha: f32) -> u32 {
    let covered = covered_samples(in, alpha);
    if covered == 0u {
        discard;
    }
    return covered;
}

#ifdef TEXEL_NORMALS

// The unit normal in world space, of one of the volume as its texture has it.
fn world_normal(in: Varying, baked: vec3<f32>) -> vec3<f32> {
    let n = baked * 2.0 - 1.0;
    let turned = in.normal_from_u * n.x + in.normal_from_v * n.y + in.normal_from_w * n.z;
    // Opposite normals may cancel out.
    let is_none = dot(turned, turned) == 0.0;
    return normalize(select(turned, in.normal_from_w, is_none));
}

// How much normals differ of which a texture has the mean: 0 if they are one, 1 if they point everywhere.
fn normal_spread(baked: vec3<f32>) -> f32 {
    let mean = baked * 2.0 - 1.0;
    return saturate(1.0 - dot(mean, mean));
}

#endif
