#define_import_path bevy_verdure::slicing::place

// The vertex stage of all passes: where the corners of slices are.

#import bevy_pbr::mesh_bindings::mesh
#import bevy_pbr::mesh_view_bindings::view
#import bevy_render::globals::Globals
#import bevy_render::maths::mat2x4_f32_to_mat3x3_unpack
#import bevy_verdure::slicing::types::{crowns, which, octagons, first_layer, crown_set}
#import bevy_verdure::slicing::blend::FOCAL
#import bevy_verdure::slicing::drawn::{cast_slice, drawn_slice}
#import bevy_verdure::slicing::cast::facing
#import bevy_verdure::slicing::seen::{leaning, towards_sun, turned}
#import bevy_verdure::slicing::parts::{deviation, part_direction, part_turn}
#import bevy_verdure::slicing::lots::{cells, gathered_frame, pcg}
#import bevy_verdure::wind::sway

#ifdef VISIBILITY_RANGE_DITHER
#import bevy_pbr::mesh_functions::get_visibility_range_dither_level
#endif

#ifdef PREPASS_PIPELINE
@group(0) @binding(1) var<uniform> globals: Globals;
#else
#import bevy_pbr::mesh_view_bindings::globals
#endif

// How much more crowns cover that are blended before colours are mapped to the screen. Tone mapping dims what is bright
// most, so that a leaf half there before the sky comes out nearer to the sky than to the leaf, where a pixel that a mesh has
// or has not does not. Found on the broadleaf, by what shows through it in the grove from 12 to 40 m, with TonyMcMapface.
const TONE_MAPPED: f32 = 1.35;

// How far slices near to the eye flutter besides, as a share of the crown's sway.
const FLUTTER: f32 = 0.25;

// The leaves next to one another that lie at one depth each in a shadow map, along the side of a slice; a power of two.
const LEAVES: f32 = 64.0;

struct Corner {
    @builtin(instance_index) instance_index: u32,
    // The corner in 3 bits, the number of the slice in 13, and which slicing it is of.
    @location(0) corner: u32,
}

// What is the same all over a slice, or over a crown, is worked out here rather than for every pixel.
struct Varying {
    @builtin(position) position: vec4<f32>,
    @location(0) uv: vec2<f32>,
    @location(1) @interpolate(flat) layer: u32,
    @location(2) @interpolate(flat) opacity: f32,
    @location(3) @interpolate(flat) instance_index: u32,
    // Tells the lots of this slice from those of others.
    @location(4) @interpolate(flat) lot: u32,
#ifdef VISIBILITY_RANGE_DITHER
    // How much of the crown its near mesh, or nothing, takes over, as Bevy has it.
    @location(13) @interpolate(flat) dither: i32,
#endif
#ifdef CROWN_LIGHT_VIEW
    // Cells that lots are drawn for, along a side of the slice.
    @location(5) @interpolate(flat) grid: f32,
    // The mip level whose pixels are the cells, or the finest.
    @location(6) @interpolate(flat) mip: u32,
    // From where to where the leaves of this slice lie, of 1 next to the light to -1, ...
    @location(7) @interpolate(flat) share: vec2<f32>,
    // ... and 1 in the shadow map's depth.
    @location(8) @interpolate(flat) deep: f32,
#else
#ifdef CROWN_PARTS
    // Where the direction from a part to the eye is among orientations.
    @location(14) turn: vec2<f32>,
#endif
    // The layer among those of its slicing, whatever set that is in.
    @location(10) @interpolate(flat) own_layer: u32,
    // In linear light; w: the share of the sun's that comes through from behind.
    @location(5) @interpolate(flat) tint: vec4<f32>,
    @location(6) world_position: vec3<f32>,
    // Columns of the matrix that turns baked normals into those seen, in world space.
    @location(7) @interpolate(flat) turn_x: vec3<f32>,
    @location(8) @interpolate(flat) turn_y: vec3<f32>,
    @location(9) @interpolate(flat) turn_z: vec3<f32>,
#ifdef PREPASS_PIPELINE
    @location(12) local_position: vec3<f32>,
#endif
    // The mip level that suits the slice's size.
    @location(11) @interpolate(flat) lod: f32,
#endif
}

fn world_from_local(instance_index: u32) -> mat3x3<f32> {
    let m = mesh[instance_index].world_from_local;
    return transpose(mat3x3(m[0].xyz, m[1].xyz, m[2].xyz));
}

// The transpose of `local_from_world`.
fn turn_of_normals(instance_index: u32) -> mat3x3<f32> {
    return mat2x4_f32_to_mat3x3_unpack(
        mesh[instance_index].local_from_world_transpose_a,
        mesh[instance_index].local_from_world_transpose_b,
    );
}

fn local_from_world(instance_index: u32) -> mat3x3<f32> {
    return transpose(turn_of_normals(instance_index));
}

// The tint of a crown: its square root in 8 bits a channel.
fn tint(tag: u32) -> vec3<f32> {
    let root = unpack4x8unorm(tag).rgb;
    return root * root;
}

// The frame that lots are drawn for.
fn frame() -> u32 {
    return gathered_frame(crown_set.gathering, view.clip_from_world, view.unjittered_clip_from_world, globals.frame_count);
}

fn is_orthographic() -> bool {
    return view.clip_from_view[3].w == 1.0;
}

// Where the eye is, from the centroid, in local space, measured in radii.
fn eye_from_centroid(instance_index: u32) -> vec3<f32> {
    let to_local = local_from_world(instance_index);
    if is_orthographic() {
        return normalize(to_local * view.world_from_view[2].xyz);
    }
    let m = mesh[instance_index].world_from_local;
    let origin = vec3(m[0].w, m[1].w, m[2].w);
    return (to_local * (view.world_position - origin) - crowns[which].centroid) / crowns[which].radius;
}

// How many world metres a local one is.
fn metre(instance_index: u32) -> f32 {
    let m = mesh[instance_index].world_from_local;
    return length(vec3(m[0].y, m[1].y, m[2].y));
}

// Pixels of the view for a metre: one metre away, or anywhere in an orthographic view.
fn pixels_per_metre() -> f32 {
    return 0.5 * view.main_pass_viewport.w * abs(view.clip_from_view[1].y);
}

// How many radii away a crown would be as small as it is here, on the screen that levels of detail are made for.
fn apparent_distance(instance_index: u32, distance: f32) -> f32 {
    if is_orthographic() {
        return FOCAL / (crowns[which].radius * metre(instance_index) * pixels_per_metre());
    }
    return distance * FOCAL / pixels_per_metre();
}

// The mip level for a slice of so many local metres, so many away. Between two levels only for a quarter of all sizes:
// drivers in software filter one level where it is a whole number.
fn mip_level(size: f32, distance: f32, instance_index: u32) -> f32 {
    let away = select(distance * metre(instance_index), 1.0, is_orthographic());
    let pixels = size * metre(instance_index) * pixels_per_metre() / max(away, 1e-6);
    let most = f32(firstLeadingBit(crown_set.pixels));
    let level = clamp(log2(f32(crown_set.pixels) / pixels), 0.0, most);
    return floor(level) + saturate(4.0 * fract(level) - 1.5);
}

fn place_corner(in: Corner) -> Varying {
    var out: Varying;
    // What is not drawn collapses to a point outside the view.
    out.position = vec4(0.0, 0.0, -2.0, 1.0);
    out.instance_index = in.instance_index;
    which = in.corner >> 16u;
    let number = (in.corner >> 3u) & 0x1fffu;
    let eye = eye_from_centroid(in.instance_index);
    let distance = length(eye);
    let direction = select(vec3(0.0, 0.0, 1.0), eye / distance, distance > 0.0);
#ifdef CROWN_LIGHT_VIEW
    let slice = cast_slice(number, direction);
#else
    let apparent = apparent_distance(in.instance_index, distance);
    // From far, all parts are seen from one direction.
    let differ = deviation(select(distance, 1e9, is_orthographic()), crowns[which].widest, length(direction.xz));
    let slice = drawn_slice(number, direction, apparent, differ);
#endif
    if slice.opacity <= 0.0 {
        return out;
    }
    let o = crowns[which].orientations[slice.orientation];
    let faces = dot(o.direction, direction) >= 0.0;
    let count = crowns[which].levels[slice.level];
    let own_layer = first_layer(slice.level, slice.orientation) + slice.index;
    let layer = crowns[which].layers_before + own_layer;
    let pair = octagons[layer * 4u + (in.corner & 7u) / 2u];
#ifdef CROWN_FRAMES
    // The whole quad, so that its frame shows.
    var quad = array(
        vec2(1.0, 0.5), vec2(1.0, 1.0), vec2(0.5, 1.0), vec2(0.0, 1.0),
        vec2(0.0, 0.5), vec2(0.0, 0.0), vec2(0.5, 0.0), vec2(1.0, 0.0));
    let uv = quad[in.corner & 7u];
#else
    let uv = select(pair.xy, pair.zw, (in.corner & 1u) == 1u);
#endif
    let size = o.high - o.low;
    let spacing = size.z / f32(count);
    let depth = o.low.z + (f32(slice.index) + 0.5) * spacing;
    let flat = o.right * (o.low.x + uv.x * size.x) + o.up * (o.high.y - uv.y * size.y);
#ifdef CROWN_LIGHT_VIEW
    let middle = 0.5 * o.direction * (o.low.z + o.high.z);
    let local = crowns[which].centroid + middle + facing(o, direction, flat);
#else
    let local = crowns[which].centroid + flat + o.direction * depth;
#endif

    let m = mesh[in.instance_index].world_from_local;
    let origin = vec3(m[0].w, m[1].w, m[2].w);
    var moved = vec3(0.0);
    if any(crown_set.wind.xyz != vec3(0.0)) {
        let foot_height = crowns[which].centroid.y - crowns[which].radius;
        let height = clamp((local.y - foot_height) / (2.0 * crowns[which].radius), 0.0, 1.0);
        // Flexibility is in local metres.
        moved = sway(crown_set.wind.xyz, origin, height, crowns[which].flexibility * metre(in.instance_index), globals.time);
        // Near slices move more than far ones, each in its own time.
        let from_far = select(count - 1u - slice.index, slice.index, faces);
        let nearness = (f32(from_far) + 0.5) / f32(count);
        moved *= 1.0 + FLUTTER * nearness * sin(5.3 * globals.time + 2.4 * f32(slice.index) + dot(origin.xz, vec2(1.7)));
    }
    // Relative to the eye, so that a plant 10 km from the origin is as steady as one at the origin.
    let from_eye = world_from_local(in.instance_index) * local + (origin - view.world_position) + moved;
    let v = view.view_from_world;
    var clip = view.clip_from_view * vec4(mat3x3(v[0].xyz, v[1].xyz, v[2].xyz) * from_eye, 1.0);
    out.position = clip;
    out.uv = uv;
    out.layer = layer;
    out.opacity = slice.opacity;
#ifdef CROWN_TONE_MAPPED_LATER
    out.opacity *= TONE_MAPPED;
#endif
    let tag = mesh[in.instance_index].tag;
    out.lot = pcg(own_layer + (tag >> 24u) * 256u);
#ifdef VISIBILITY_RANGE_DITHER
    out.dither = get_visibility_range_dither_level(in.instance_index, vec4(origin, 1.0));
#endif
#ifdef CROWN_LIGHT_VIEW
    let width = max(size.x, size.y) * metre(in.instance_index) * pixels_per_metre();
    let across = cells(1.0 / width);
    out.mip = u32(max(log2(f32(crown_set.pixels) / across), 0.0));
    // Lots of whole leaves, not of pixels: what shades is as large as leaves are, or the crown would look strewn with salt.
    out.grid = min(across, LEAVES);
    let next = f32(select(slice.index, count - 1u - slice.index, faces));
    out.share = 1.0 - 2.0 * vec2(next, next + 1.0) / f32(count);
    // Half the way of light through an ellipsoid.
    let axes = vec3(dot(direction, o.right), dot(direction, o.up), dot(direction, o.direction));
    out.deep = 0.5 / length(axes / size) * metre(in.instance_index) * view.clip_from_view[2].z;
#else
    out.lod = mip_level(max(size.x, size.y), length(eye * crowns[which].radius - o.direction * depth), in.instance_index);
#ifdef CROWN_PARTS
    let ray = normalize(eye * crowns[which].radius - (local - crowns[which].centroid));
    out.turn = part_turn(slice.orientation, part_direction(direction, ray, differ));
#endif
    out.own_layer = own_layer;
    out.tint = vec4(tint(tag), crowns[which].diffuse_transmission);
    out.world_position = from_eye + view.world_position;
    let front = select(-o.direction, o.direction, faces);
    let turn = turn_of_normals(in.instance_index);
    let leans = leaning(front, direction);
    // From behind, the other side of each leaf is seen.
    let back = select(o.direction, vec3(0.0), faces);
    out.turn_x = turn * turned(vec3(1.0, 0.0, 0.0) - 2.0 * back.x * back, front, leans);
    out.turn_y = turn * turned(vec3(0.0, 1.0, 0.0) - 2.0 * back.y * back, front, leans);
    out.turn_z = turn * turned(vec3(0.0, 0.0, 1.0) - 2.0 * back.z * back, front, leans);
#ifndef PREPASS_PIPELINE
    let to_eye = normalize(world_from_local(in.instance_index) * direction);
    let metres = metre(in.instance_index);
    let near = dot(to_eye, crown_set.sun.xyz);
    out.world_position += towards_sun(front, direction, near, spacing * metres, size.z * metres) * crown_set.sun.xyz;
#else
    // Moved likewise in the frame before, so that motion vectors leave wind out.
    out.local_position = local + local_from_world(in.instance_index) * moved;
#endif
#endif
    return out;
}
