#define_import_path bevy_verdure::slicing::look

// The fragment stage of all passes: what a slice looks like at a place.

#import bevy_verdure::slicing::types::{color_texture, normal_texture, slice_sampler, crown_set}
#import bevy_verdure::slicing::blend::covered
#import bevy_verdure::slicing::parts::turned_weight
#import bevy_verdure::slicing::place::Varying

struct Facing {
    // World space.
    normal: vec3<f32>,
    // Share of the light from around.
    occlusion: f32,
}

fn slice_color(in: Varying) -> vec4<f32> {
#ifdef CROWN_LIGHT_VIEW
    // One pixel says it all: by chance a place is there or not anyhow.
    let size = i32(crown_set.pixels >> in.mip);
    let pixel = min(vec2<i32>(in.uv * f32(size)), vec2(size - 1));
    var color = textureLoad(color_texture, pixel, in.layer, in.mip);
#else
    var color = textureSampleLevel(color_texture, slice_sampler, in.uv, in.layer, in.lod);
#ifdef CROWN_PARTS
    color.a = covered(color.a, turned_weight(in.turn) * in.opacity);
#else ifdef CROWN_PAPER_ORDER
    color.a *= in.opacity;
#else
    color.a = covered(color.a, in.opacity);
#endif
    color = vec4(color.rgb * in.tint.rgb, color.a);
#endif
#ifdef CROWN_FRAMES
#ifndef PREPASS_PIPELINE
    let edge = min(min(in.uv.x, in.uv.y), min(1.0 - in.uv.x, 1.0 - in.uv.y));
    if edge < 0.012 {
        color = vec4(1.0, 0.15, 0.05, saturate(in.opacity));
    }
#endif
#endif
    return color;
}

#ifndef CROWN_LIGHT_VIEW
#ifdef CROWN_COMPRESSED
// A direction from an octahedron's square, -1 to 1, as octahedral.rs folds it; of any length.
fn unfold(folded: vec2<f32>) -> vec3<f32> {
    let y = 1.0 - abs(folded.x) - abs(folded.y);
    let sides = select(vec2(-1.0), vec2(1.0), folded >= vec2(0.0));
    let over = folded - max(-y, 0.0) * sides;
    return vec3(over.x, y, over.y);
}
#endif

fn slice_facing(in: Varying) -> Facing {
    // One pixel of the nearest level: opacity smooths over what filters would, at a fifth of their cost.
    let mip = u32(in.lod + 0.5);
    let size = i32(crown_set.pixels >> mip);
    let pixel = min(vec2<i32>(in.uv * f32(size)), vec2(size - 1));
    let baked = textureLoad(normal_texture, pixel, in.layer, mip);
#ifdef CROWN_COMPRESSED
    let occlusion = baked.r;
    let n = unfold(baked.ag * 2.0 - 1.0);
#else
    let occlusion = baked.a;
    // The least length keeps a normal of nothing from becoming none.
    let n = baked.xyz * 2.0 - (1.0 - 1e-6);
#endif
    return Facing(normalize(mat3x3(in.turn_x, in.turn_y, in.turn_z) * n), occlusion);
}
#endif
