#define_import_path bevy_verdure::texel::place

// The vertex stage of all passes: where the corners of a slice are.

#import bevy_pbr::mesh_view_bindings::view
#import bevy_render::globals::Globals
#import bevy_verdure::texel::facet::{Facet, TexelFrame, facet_point, facet_uv, normal_transform, slice_line_point, slice_position, in_frame, smooth_frame, texel_frame}
#import bevy_verdure::texel::types::{facets, normal_texture, surfaces, texels}
#import bevy_verdure::wind::sway

#ifdef PREPASS_PIPELINE
@group(0) @binding(1) var<uniform> globals: Globals;
#else
#import bevy_pbr::mesh_view_bindings::globals
#endif

// Slices of each axis are a draw of their own.
const AXIS: u32 = #{TEXEL_AXIS}u;

// A slice, as records.rs writes it.
struct Corner {
    @builtin(vertex_index) corner: u32,
    // The facet, the number of the slice, and, of how many a texel it is one, the exponent, in the lowest 5 bits, below the
    // number of the surface.
    @location(0) slice: vec3<u32>,
    // How far above the place that is seen light falls on it, and how far apart it has moved from the one with which it
    // takes the place of a coarser one.
    @location(1) look: vec2<f32>,
    // Which pixels are its, from one lot to another.
    @location(2) lots: vec2<f32>,
    // What of it is drawn: from where to where along its line, and up its height vectors, from 0 to 1.
    @location(3) trim: vec4<f32>,
}

struct Varying {
    // The same to the last bit in depth and in colour.
    @builtin(position) @invariant position: vec4<f32>,
    @location(0) world_position: vec4<f32>,
    // Columns and rows of the slice, from 0 to 1 for one texel.
    @location(1) uv: vec2<f32>,
    @location(2) @interpolate(flat) layer: u32,
    @location(3) @interpolate(flat) flags: u32,
#ifdef TEXEL_NORMALS
    // Columns of what turns the volume's normals to world space.
    @location(4) normal_from_u: vec3<f32>,
    @location(5) normal_from_v: vec3<f32>,
    @location(6) normal_from_w: vec3<f32>,
#endif
#ifdef TEXEL_INNER
    // The way of the view in the volume: changes of u, v and w.
    @location(11) view_in_volume: vec3<f32>,
    // Where, across slices, it is in a texel.
    @location(12) @interpolate(flat) place: f32,
#endif
#ifdef MOTION_VECTOR_PREPASS
    @location(7) previous_world_position: vec3<f32>,
#endif
    @location(8) @interpolate(flat) stand_off: f32,
    @location(9) @interpolate(flat) lots: vec2<f32>,
#ifdef TEXEL_DIRECTIONAL_LIGHT
    // The mip level whose pixels are as large as those of the shadow map.
    @location(10) @interpolate(flat) level: u32,
#endif
}

fn is_orthographic() -> bool {
    return view.clip_from_view[3].w == 1.0;
}

// The way of the view at a place that is seen from the eye so, of any length.
fn view_direction(from_eye: vec3<f32>) -> vec3<f32> {
    return select(from_eye, -view.world_from_view[2].xyz, is_orthographic());
}

// A facet from the eye, so that one 10 km from the origin is as steady as one at the origin.
fn facet_from_eye(index: u32, turn: mat3x3<f32>, origin: vec3<f32>) -> Facet {
    let record = facets[index];
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

// A height vector in the wind: as long as it was. It moves across itself, and turns by less than a right angle. One that
// leans may be led through the surface so, or across another: facets of which one is have no slices (source.rs).
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

#ifdef TEXEL_DIRECTIONAL_LIGHT

// From the middle of the layer of a slice to that of the finest one at its end away from the light. A slice is as wide as
// what is widest in its layer: at that end it stands out of nothing that narrows towards the light, and so is what is lit.
// Slices that a light sees never move apart (source.rs), so that each is in the middle of its layer.
fn away_from_light(frame: TexelFrame, count: u32) -> vec3<f32> {
    let most = f32((textureNumLayers(normal_texture) + 1u) / 2u);
    let along = in_frame(frame, view_direction(vec3(0.0)))[AXIS];
    return frame.edges[AXIS] * (sign(along) * 0.5 * (1.0 / f32(count) - 1.0 / most));
}

// The mip level of a slice in an orthographic view, in which it is the same everywhere.
fn slice_level(frame: TexelFrame) -> u32 {
    let v = view.view_from_world;
    let c = view.clip_from_view;
    let to_pixels = mat3x3(v[0].xyz, v[1].xyz, v[2].xyz);
    let f = 0.5 * view.viewport.zw * vec2(c[0].x, c[1].y);
    // Pixels of the view that columns and rows of the slice cover, all of them.
    let columns = (to_pixels * frame.edges[select(0u, 1u, AXIS == 0u)]).xy * f;
    let rows = (to_pixels * frame.edges[select(2u, 1u, AXIS == 2u)]).xy * f;
    let det = columns.x * rows.y - columns.y * rows.x;
    // And those of the slice that one of the view covers, along x and along y.
    let size = vec2<f32>(textureDimensions(normal_texture)) / det;
    let dx = vec2(rows.y, -columns.y) * size;
    let dy = vec2(-rows.x, columns.x) * size;
    let level = 0.5 * log2(max(max(dot(dx, dx), dot(dy, dy)), 1.0)) + 0.5;
    // Slices that are seen along themselves cover nothing.
    return u32(min(level, f32(textureNumLevels(normal_texture) - 1u)));
}

#endif

fn place_corner(in: Corner) -> Varying {
    var out: Varying;
    let surface = surfaces[in.slice.z >> 5u];
    let rows = surface.world_from_local;
    let turn = transpose(mat3x3(rows[0].xyz, rows[1].xyz, rows[2].xyz));
    let origin = vec3(rows[0].w, rows[1].w, rows[2].w) - view.world_position;
    let facet = facet_from_eye(in.slice.x, turn, origin);
    let slice = bitcast<i32>(in.slice.y);
    let count = 1u << (in.slice.z & 31u);
    let apart = in.look.y;
    let position = slice_position(slice, count, apart);
    // Once round, in the order of a strip of triangles.
    let corner = in.corner ^ (in.corner >> 1u);
    var b: vec3<f32>;
    var w: f32;
    if AXIS == 2u {
        // A triangle: the fourth corner is the third.
        b = vec3(f32(corner == 0u), f32(corner == 1u), f32(corner >= 2u));
        w = position;
    } else {
        // A line, from the surface to the top.
        b = slice_line_point(facet.uvs, AXIS, position, select(in.trim.x, in.trim.y, corner == 1u || corner == 2u));
        w = select(in.trim.z, in.trim.w, corner >= 2u);
    }
    let uv = facet_uv(facet, b);
    out.uv = vec2(select(uv.x, uv.y, AXIS == 0u), select(w, uv.y, AXIS == 2u));
    out.lots = in.lots;
    out.stand_off = in.look.x;
    out.flags = surface.flags.x;
    // Copies of the texture show the same slices; counts are powers of two.
    out.layer = count - 1u + (in.slice.y & (count - 1u));
    let frame = texel_frame(facet, b, w);
    var from_eye = facet_point(facet, b, w);
#ifdef TEXEL_DIRECTIONAL_LIGHT
    from_eye += away_from_light(frame, count);
#endif
    let v = view.view_from_world;
    var clip = view.clip_from_view * vec4(mat3x3(v[0].xyz, v[1].xyz, v[2].xyz) * from_eye, 1.0);
#ifdef TEXEL_DIRECTIONAL_LIGHT
    // What is nearer to the sun than its shadow map casts shadows all the same.
    clip.z = min(clip.z, 1.0);
    out.level = slice_level(frame);
#endif
    out.position = clip;
    out.world_position = vec4(from_eye + view.world_position, 1.0);
    // The inverse is the transpose of the cofactors over the determinant.
    let cofactors = mat3x3(cross(turn[1], turn[2]), cross(turn[2], turn[0]), cross(turn[0], turn[1]));
    let det = dot(turn[0], cofactors[0]);
#ifdef MOTION_VECTOR_PREPASS
    // In local space as bent, so that motion vectors leave wind out.
    let local = vec4(transpose(cofactors) * (from_eye - origin) / det, 1.0);
    let previous = surface.previous;
    out.previous_world_position = vec3(dot(previous[0], local), dot(previous[1], local), dot(previous[2], local));
#endif
#ifdef TEXEL_NORMALS
    let record = facets[in.slice.x];
    let normal = cofactors * (mat3x3(record.normals[0].xyz, record.normals[1].xyz, record.normals[2].xyz) * b) * sign(det);
    let shaded = smooth_frame(frame, normal / max(length(normal), 1e-30));
    let to_world = normal_transform(shaded, texels.lengths);
    out.normal_from_u = to_world[0];
    out.normal_from_v = to_world[1];
    out.normal_from_w = to_world[2];
#ifdef TEXEL_INNER
    out.view_in_volume = in_frame(frame, view_direction(from_eye));
    out.place = slice_position(slice & i32(count - 1u), count, apart);
#endif
#endif
    return out;
}
