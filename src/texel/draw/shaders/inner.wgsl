#define_import_path bevy_verdure::texel::inner

// What is seen in the layer of a slice.
//
// A slice shows what is in its layer as if all of it were in the middle, up to h/2·tan(a) aside of where it is. Which slices
// are where does with that; colours, normals and shadows, which change from pixel to pixel, would shimmer. So what is seen is
// looked up along the view in more slices of the same layer, and of the next one, as relief maps are (F. Policarpo et al.,
// *Real-Time Relief Mapping on Arbitrary Polygonal Surfaces*, 2005): once a pixel, after depth is drawn.

#import bevy_verdure::texel::place::{AXIS, Varying}
#import bevy_verdure::texel::types::{color_texture, level_sampler, normal_texture, slice_sampler, texels}

struct Inner {
    color: vec3<f32>,
    // As the texture has it.
    normal: vec3<f32>,
    // How far along the view, in lengths of the vector from which `view_in_volume` comes.
    along: f32,
}

fn look_inside(in: Varying) -> Inner {
    let size = vec2<f32>(textureDimensions(normal_texture));
    let dx = dpdx(in.uv) * size;
    let dy = dpdy(in.uv) * size;
    let level = 0.5 * log2(max(max(dot(dx, dx), dot(dy, dy)), 1.0));
    // Slice k of N is layer N − 1 + k, and N a power of two.
    let count = 1u << firstLeadingBit(in.layer + 1u);
    let slice = in.layer + 1u - count;
    let most = (textureNumLayers(normal_texture) + 1u) / 2u;
    let inner = i32(min(most / count, 1u << firstLeadingBit(texels.inner_slices)));
    let all = i32(count) * inner;
    // Columns, rows, and across slices.
    var way = in.view_in_volume;
    if AXIS == 0u {
        way = way.yzx;
    } else if AXIS == 1u {
        way = way.xzy;
    }
    var uv = in.uv;
    var layer = in.layer;
    var along = 0.0;
    // Alone, a slice is what it shows.
    let steps = select(2 * inner, 0, inner == 1);
    for (var i = 0; i < steps; i += 1) {
        let step = select(inner - 1 - i, i, way.z > 0.0);
        let reach = ((f32(step) + 0.5) / f32(inner) - 0.5) / (f32(count) * way.z);
        let at = in.uv + clamp(way.xy * reach, vec2(-0.5), vec2(0.5));
        let number = i32(slice) * inner + step;
        // Along w there is nothing beyond; along u and v texels repeat.
        let is_in = select(at.y >= 0.0 && at.y <= 1.0, number >= 0 && number < all, AXIS == 2u);
        let at_layer = u32(all - 1 + (number & (all - 1)));
        let alpha = textureSampleLevel(normal_texture, level_sampler, at, at_layer, level).a;
        if is_in && alpha >= 0.5 {
            uv = at;
            layer = at_layer;
            along = reach;
            break;
        }
    }
    return Inner(
        textureSampleLevel(color_texture, slice_sampler, uv, layer, level).rgb,
        textureSampleLevel(normal_texture, slice_sampler, uv, layer, level).xyz,
        along,
    );
}
