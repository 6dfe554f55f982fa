#define_import_path bevy_verdure::texel::place

// The vertex stage of all passes: which slice a slot is, and where its corners are.

#import bevy_pbr::mesh_bindings::mesh
#import bevy_pbr::mesh_view_bindings::view
#import bevy_render::globals::Globals
#import bevy_render::maths::mat2x4_f32_to_mat3x3_unpack
#import bevy_verdure::texel::choose::{TexelQuality, TexelView, VolumeMeasure, choose_count, look_at, lots_of_axis}
#import bevy_verdure::texel::facet::{Facet, facet_point, facet_uv, normal_transform, slice_line_end, slice_position, slice_range, smooth_frame, texel_frame}
#import bevy_verdure::texel::types::{facets, texels}
#import bevy_verdure::wind::sway

#ifdef PREPASS_PIPELINE
@group(0) @binding(1) var<uniform> globals: Globals;
#else
#import bevy_pbr::mesh_view_bindings::globals
#endif

// The slices of each axis are a draw of their own.
const AXIS: u32 = #{TEXEL_AXIS}u;

struct Corner {
    @builtin(instance_index) instance_index: u32,
    // The facet; the slot on it times four, plus the corner.
    @location(0) corner: vec2<u32>,
}

struct Varying {
    @builtin(position) position: vec4<f32>,
    @location(0) world_position: vec4<f32>,
    // Columns and rows of the slice, from 0 to 1 for one texel.
    @location(1) uv: vec2<f32>,
    @location(2) @interpolate(flat) layer: u32,
    @location(3) @interpolate(flat) instance_index: u32,
    // Columns of what turns the volume's normals to world space.
    @location(4) normal_from_u: vec3<f32>,
    @location(5) normal_from_v: vec3<f32>,
    @location(6) normal_from_w: vec3<f32>,
    @location(7) local_position: vec3<f32>,
    // How far, in metres, the surface may be above the place inside of it that is seen.
    @location(8) @interpolate(flat) inside: f32,
    // Which pixels are this slice's, by their lots.
    @location(9) @interpolate(flat) lots: vec2<f32>,
}

fn is_orthographic() -> bool {
    return view.clip_from_view[3].w == 1.0;
}

// Lights have no place from which levels of detail are judged; Bevy gives them that of a camera.
fn is_light() -> bool {
    return any(view.lod_view_world_position != view.world_position);
}

// A facet in world space, from the eye, so that one 10 km from the origin is as steady as one at the origin.
fn facet_from_eye(index: u32, instance_index: u32) -> Facet {
    let record = facets[index];
    let m = mesh[instance_index].world_from_local;
    let turn = transpose(mat3x3(m[0].xyz, m[1].xyz, m[2].xyz));
    let origin = vec3(m[0].w, m[1].w, m[2].w) - view.world_position;
    let positions = turn * mat3x3(record.positions[0].xyz, record.positions[1].xyz, record.positions[2].xyz)
        + mat3x3(origin, origin, origin);
    let heights = turn * mat3x3(record.heights[0].xyz, record.heights[1].xyz, record.heights[2].xyz);
    return Facet(
        positions,
        mat3x3(bend(positions[0], heights[0]), bend(positions[1], heights[1]), bend(positions[2], heights[2])),
        mat3x2(
            vec2(record.positions[0].w, record.heights[0].w),
            vec2(record.positions[1].w, record.heights[1].w),
            vec2(record.positions[2].w, record.heights[2].w)),
    );
}

// A height vector in the wind: as long as it was. It keeps what it has of the way up, so that it never leads through the
// surface.
fn bend(foot: vec3<f32>, height: vec3<f32>) -> vec3<f32> {
    if texels.wind.w == 0.0 || all(texels.wind.xyz == vec3(0.0)) {
        return height;
    }
    let tall = length(height);
    let moved = sway(texels.wind.xyz, foot + view.world_position, 1.0, texels.wind.w * tall, globals.time);
    // Along the height vector nothing moves.
    let aside = moved - height * (dot(moved, height) / max(tall * tall, 1e-30));
    let bent = height + aside;
    return bent * (tall / max(length(bent), 1e-30));
}

// This view, with its eye at zero.
fn texel_view() -> TexelView {
    var half_spaces: array<vec4<f32>, 6>;
    // The sides. What is nearer than a light's near plane casts shadows all the same.
    for (var i = 0u; i < 4u; i += 1u) {
        let plane = view.frustum[i];
        half_spaces[i] = vec4(plane.xyz, plane.w + dot(plane.xyz, view.world_position));
    }
    return TexelView(
        vec3(0.0),
        -view.world_from_view[2].xyz,
        is_orthographic(),
        0.5 * abs(view.clip_from_view[1].y) * view.main_pass_viewport.w,
        half_spaces,
    );
}

fn texel_quality() -> TexelQuality {
    let light = is_light();
    return TexelQuality(
        (texels.flags & 1u) != 0u,
        select(texels.depth, texels.shadow_depth, light),
        select(texels.pixels, texels.shadow_pixels, light),
    );
}

fn place_corner(in: Corner) -> Varying {
    var out: Varying;
    // What is not drawn collapses to a point outside the view.
    out.position = vec4(0.0, 0.0, -2.0, 1.0);
    out.instance_index = in.instance_index;
    let facet = facet_from_eye(in.corner.x, in.instance_index);
    let measure = VolumeMeasure(texels.most, texels.lengths, texels.thickness);
    let view_of_texels = texel_view();
    let quality = texel_quality();
    let seen = look_at(facet, measure, view_of_texels, quality);
    var lots = lots_of_axis(seen.cost, AXIS);
    // Shadows are not seen to pop, and stay whole.
    let fades = (texels.flags & 2u) != 0u && !is_light();
    if !fades {
        lots = round(lots);
    }
    if !seen.seen || lots.x >= lots.y {
        return out;
    }
    let choice = choose_count(facet, seen, AXIS, measure, view_of_texels, quality);
    let finer = select(0.0, choice.finer, fades);
    var count = 1u << choice.exponent;
    var range = slice_range(facet.uvs, AXIS, count);
    var slot = i32(in.corner.y >> 2u);
    // Twice as many slices fade in: they have the next slots, and the lower lots.
    let split = mix(lots.x, lots.y, finer);
    if slot < range.y {
        lots.x = split;
    } else {
        slot -= range.y;
        count *= 2u;
        range = slice_range(facet.uvs, AXIS, count);
        lots.y = split;
    }
    if slot >= range.y || lots.x >= lots.y {
        return out;
    }
    out.lots = lots;
    // Near slices first, so that they hide the far ones.
    let slice = range.x + select(range.y - 1 - slot, slot, choice.along);
    let corner = in.corner.y & 3u;
    var b: vec3<f32>;
    var w: f32;
    if AXIS == 2u {
        // A triangle: the fourth corner is the third.
        b = vec3(f32(corner == 0u), f32(corner == 1u), f32(corner >= 2u));
        w = slice_position(slice, count);
    } else {
        // A line, from the surface to the top.
        let position = slice_position(slice, count);
        b = slice_line_end(facet.uvs, AXIS, position, corner == 1u || corner == 2u);
        w = f32(corner >= 2u);
    }
    let uv = facet_uv(facet, b);
    out.uv = vec2(select(uv.x, uv.y, AXIS == 0u), select(w, uv.y, AXIS == 2u));
    // Light sees slices too: those of merged layers stand out by up to half their distance.
    out.inside = choice.inside + choice.depth;
    // Copies of the texture show the same slices; counts are powers of two.
    out.layer = count - 1u + (u32(slice) & (count - 1u));
    let from_eye = facet_point(facet, b, w);
    let v = view.view_from_world;
    var clip = view.clip_from_view * vec4(mat3x3(v[0].xyz, v[1].xyz, v[2].xyz) * from_eye, 1.0);
#ifdef TEXEL_DIRECTIONAL_LIGHT
    // What is nearer to the sun than its shadow map casts shadows all the same.
    clip.z = min(clip.z, 1.0);
#endif
    out.position = clip;
    out.world_position = vec4(from_eye + view.world_position, 1.0);
    // In local space as bent, so that motion vectors leave wind out.
    let m = mesh[in.instance_index].world_from_local;
    let origin = vec3(m[0].w, m[1].w, m[2].w) - view.world_position;
    let local_from_world_transpose = mat2x4_f32_to_mat3x3_unpack(
        mesh[in.instance_index].local_from_world_transpose_a,
        mesh[in.instance_index].local_from_world_transpose_b,
    );
    out.local_position = transpose(local_from_world_transpose) * (from_eye - origin);
    let record = facets[in.corner.x];
    let normal = local_from_world_transpose
        * (mat3x3(record.normals[0].xyz, record.normals[1].xyz, record.normals[2].xyz) * b);
    let frame = smooth_frame(texel_frame(facet, b, w), normal / max(length(normal), 1e-30));
    let turn = normal_transform(frame, texels.lengths);
    out.normal_from_u = turn[0];
    out.normal_from_v = turn[1];
    out.normal_from_w = turn[2];
    return out;
}
