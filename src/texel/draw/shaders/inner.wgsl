#define_import_path bevy_verdure::texel::inner

// What is seen in the layer of a slice.
//
// A slice shows what is in its layer as if all of it were where the slice is: up to h/2·tan(a) aside, where that is the
// middle, and up to twice as far, where two begin to move apart from between their layers. Which slices are where does with
// that; colours, normals and shadows, which change from pixel to pixel, would shimmer. So what is seen is looked for along
// the view in the finer slices of the same layer, as relief maps are (F. Policarpo et al., *Real-Time Relief Mapping on
// Arbitrary Polygonal Surfaces*, 2005): once a pixel, after depth is drawn. Sets of slices are nested, so that it takes one
// look to halve a layer, and not one for each slice in it.

#import bevy_verdure::texel::place::{AXIS, Varying}
#import bevy_verdure::texel::types::{color_texture, level_sampler, normal_texture, slice_sampler, texels}

struct Inner {
    color: vec3<f32>,
    // As the texture has it.
    normal: vec3<f32>,
    // How far along the view, in lengths of the vector from which `view_in_volume` comes.
    along: f32,
}

// Of a slice that shows this normal, and alpha, itself.
fn look_inside(in: Varying, own: vec4<f32>) -> Inner {
    let size = vec2<f32>(textureDimensions(normal_texture));
    let dx = dpdx(in.uv) * size;
    let dy = dpdy(in.uv) * size;
    let level = 0.5 * log2(max(max(dot(dx, dx), dot(dy, dy)), 1.0));
    // Slice k of N is layer N − 1 + k, and N a power of two.
    let count = 1u << firstLeadingBit(in.layer + 1u);
    let slice = in.layer + 1u - count;
    let most = (textureNumLayers(normal_texture) + 1u) / 2u;
    let finest = min(most, count * texels.inner_slices);
    // Columns, rows, and across slices.
    var way = in.view_in_volume;
    if AXIS == 0u {
        way = way.yzx;
    } else if AXIS == 1u {
        way = way.xzy;
    }
    // Of the two slices of twice as many that a layer consists of: which is the nearer one.
    let nearer = select(1u, 0u, way.z > 0.0);
    var number = slice;
    var half_count = count;
    while half_count < finest {
        half_count *= 2u;
        let near = 2u * number + nearer;
        let at = in.uv + aside(way, near, half_count, in.place);
        let alpha = textureSampleLevel(normal_texture, level_sampler, at, half_count - 1u + near, level).a;
        number = select(near ^ 1u, near, is_in_volume(at) && alpha >= 0.5);
    }
    let at = in.uv + aside(way, number, half_count, in.place);
    let found = textureSampleLevel(normal_texture, level_sampler, at, half_count - 1u + number, level);
    let is_there = is_in_volume(at) && found.a >= 0.5;
    let uv = select(in.uv, at, is_there);
    let layer = select(in.layer, half_count - 1u + number, is_there);
    return Inner(
        textureSampleLevel(color_texture, slice_sampler, uv, layer, level).rgb,
        select(own.xyz, found.xyz, is_there),
        select(0.0, reach(way, number, half_count, in.place), is_there),
    );
}

// How far along the view a slice is from one that is drawn at a place.
fn reach(way: vec3<f32>, number: u32, count: u32, place: f32) -> f32 {
    return ((f32(number) + 0.5) / f32(count) - place) / way.z;
}

// How far aside, in columns and rows. Seen along themselves slices say nothing of what is beside.
fn aside(way: vec3<f32>, number: u32, count: u32, place: f32) -> vec2<f32> {
    return clamp(way.xy * reach(way, number, count, place), vec2(-0.5), vec2(0.5));
}

// Rows of upright slices are heights, which end.
fn is_in_volume(at: vec2<f32>) -> bool {
    return AXIS == 2u || at.y >= 0.0 && at.y <= 1.0;
}
