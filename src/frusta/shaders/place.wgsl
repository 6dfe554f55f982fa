#define_import_path bevy_verdure::frusta::place

// The vertex stage of all passes: places a segment's bounds, and works out what all its fragments share, so that
// they need not.

#import bevy_pbr::mesh_bindings::mesh
#import bevy_pbr::mesh_functions
#import bevy_verdure::frusta::types::{Frustum, End, Plant, plants, load_frustum}
#ifdef FRUSTA_RELIEF
#import bevy_verdure::frusta::types::{joints, shapes, start_radius, vec3_from, CUT, ROUND, NONE}
#import bevy_verdure::frusta::shell::{at_height, skew}
#import bevy_verdure::frusta::shell_radii::{radius_at, relief}
#endif
#import bevy_verdure::frusta::bounds::{bounds, bounds_corner, bounds_width}
#import bevy_verdure::frusta::view::{
    Stand, RayFrame, stand, ray_frame, pixel_width, local_to_clip, is_orthographic,
}

// Share of a pixel by which the bounds are widened. Vertices are snapped to 1/256 of a pixel, each end of an edge by
// half of that, so neighbours' bounds overlap in any case.
const MARGIN: f32 = 0.02;

struct Corner {
    @builtin(instance_index) instance_index: u32,
    // Index of the segment times 8, plus the corner.
    @location(0) corner: u32,
}

struct Varying {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) instance_index: u32,
    // Index of the segment times 16, plus what closes its start and its end, two bits each.
    @location(1) @interpolate(flat) segment_and_ends: u32,
#ifdef VISIBILITY_RANGE_DITHER
    @location(2) @interpolate(flat) visibility_range_dither: i32,
#endif
    // The frustum.
    @location(3) @interpolate(flat) axis_length: vec4<f32>,
    @location(4) @interpolate(flat) base_radius: vec4<f32>,
    @location(5) @interpolate(flat) start_plane: vec4<f32>,
    @location(6) @interpolate(flat) end_plane: vec4<f32>,
    // Slope, both ends' radii, and the width of a pixel at the segment in local metres.
    @location(7) @interpolate(flat) slope_radii_pixel: vec4<f32>,
    // From view to local directions, and where the eye is, in local space relative to the base.
    @location(8) @interpolate(flat) local_from_view_x: vec4<f32>,
    @location(9) @interpolate(flat) local_from_view_y: vec4<f32>,
    @location(10) @interpolate(flat) local_from_view_z: vec4<f32>,
#ifdef FRUSTA_MULTISAMPLED
    // Greatest distance from the axis that the segment reaches, and the greatest width of a pixel, in local metres.
    @location(11) @interpolate(flat) reach: vec2<f32>,
#endif
#ifdef FRUSTA_RELIEF
    // The frustum above is that of the map's greatest height. Of its least: radius, slope, and both ends' radii.
    @location(12) @interpolate(flat) floor: vec4<f32>,
    // How u leans at the start, and the mean length of a world's metre in local space.
    @location(13) @interpolate(flat) skew_metre: vec4<f32>,
    // The plane where the next segment takes over from the ball of a round join.
    @location(14) @interpolate(flat) beyond: vec4<f32>,
#endif
}

fn place_corner(in: Corner) -> Varying {
    var out: Varying;
    out.instance_index = in.instance_index;
    let segment = in.corner >> 3u;
    // Spare and empty segments collapse to a point outside the view.
    out.position = vec4(0.0, 0.0, -2.0, 1.0);
    let plant = plants[mesh[in.instance_index].tag];
    if segment >= plant.joint_count {
        return out;
    }
    var frustum = load_frustum(plant, segment);
#ifdef FRUSTA_RELIEF
    let level = frustum;
    if shapes[plant.first_shape + segment].parent != NONE {
        let radius_from = start_radius(plant, segment);
        let radius_to = shapes[plant.first_shape + segment].radius;
        let w = relief.range;
        frustum = at_height(level, radius_at(radius_from, w.y), radius_at(radius_to, w.y));
        let lowest = at_height(level, radius_at(radius_from, w.x), radius_at(radius_to, w.x));
        out.floor = vec4(lowest.radius, lowest.slope, lowest.start.radius, lowest.end.radius);
        out.beyond = takes_over(plant, segment, frustum);
    }
#endif
    let place = stand(in.instance_index);
    let pixel = local_pixel_width(place, frustum);
    let b = bounds(frustum, MARGIN * pixel.y);
    if !b.drawn {
        return out;
    }
    // In a mirrored plant the other side of the bounds faces out.
    let corner = select(in.corner ^ 1u, in.corner, place.handedness > 0.0) & 7u;
    var clip = local_to_clip(place, frustum.base + bounds_corner(b, corner));
    // Only what is seen through the bounds may be clipped, not the bounds: their depth is never used. Behind the eye,
    // another z would let the near plane cut an edge elsewhere where that plane is oblique.
    if clip.w > 0.0 {
        clip.z = max(clip.z, 0.0);
    }
    if is_orthographic() {
        clip.z = min(clip.z, 1.0);
    }
    out.position = clip;
#ifdef VISIBILITY_RANGE_DITHER
    out.visibility_range_dither = mesh_functions::get_visibility_range_dither_level(
        in.instance_index, mesh_functions::get_world_from_local(in.instance_index)[3]);
#endif
    let frame = ray_frame(place, frustum.base);
    out.segment_and_ends = segment << 4u | frustum.end.kind << 2u | frustum.start.kind;
    out.axis_length = vec4(frustum.axis, frustum.length);
    out.base_radius = vec4(frustum.base, frustum.radius);
    out.start_plane = vec4(frustum.start.normal, frustum.start.offset);
    out.end_plane = vec4(frustum.end.normal, frustum.end.offset);
    out.slope_radii_pixel = vec4(frustum.slope, frustum.start.radius, frustum.end.radius, pixel.x);
    out.local_from_view_x = vec4(frame.local_from_view[0], frame.origin.x);
    out.local_from_view_y = vec4(frame.local_from_view[1], frame.origin.y);
    out.local_from_view_z = vec4(frame.local_from_view[2], frame.origin.z);
#ifdef FRUSTA_MULTISAMPLED
    out.reach = vec2(bounds_width(b), pixel.y);
#endif
#ifdef FRUSTA_RELIEF
    let metre = pow(abs(determinant(place.local_from_world)), 1.0 / 3.0);
    out.skew_metre = vec4(skew_at_start(plant, segment, level), metre);
#endif
    return out;
}

#ifdef FRUSTA_RELIEF
// The plane, about the segment's end, where the next segment takes over from the ball of a round join; out of reach
// where none does.
fn takes_over(plant: Plant, segment: u32, frustum: Frustum) -> vec4<f32> {
    let next = shapes[plant.first_shape + segment].next;
    if frustum.end.kind == ROUND && next != NONE && frustum.radius > 0.0 {
        let record = joints[plant.first_joint + next];
        if record.base_radius > 0.0 {
            return vec4(vec3_from(record.plane_normal), record.plane_offset);
        }
    }
    return vec4(frustum.axis, 1e30);
}

// How u leans at a segment's start, to be in line with the segment before.
fn skew_at_start(plant: Plant, segment: u32, level: Frustum) -> vec3<f32> {
    let before = shapes[plant.first_shape + segment].parent;
    if before == NONE {
        return vec3(0.0);
    }
    let shape = shapes[plant.first_shape + before];
    let record = joints[plant.first_joint + before];
    let mitred = shape.parent != NONE
        && shape.next == segment
        && ((record.bits >> 2u) & 3u) == CUT
        && record.base_radius > 0.0
        && level.radius > 0.0;
    if !mitred {
        return vec3(0.0);
    }
    let from_joint = vec3_from(joints[plant.first_joint + shape.parent].position);
    return skew(normalize(vec3_from(record.position) - from_joint), record.slope, level);
}
#endif

// The width of a pixel at a segment, in local metres: the mean over all directions, and the greatest, which differ where
// the plant is not scaled alike.
fn local_pixel_width(place: Stand, frustum: Frustum) -> vec2<f32> {
    let middle = frustum.base + frustum.axis * (0.5 * frustum.length);
    let from_eye = place.world_from_local * middle + place.from_eye;
    let reach = 0.5 * frustum.length + max(frustum.end.radius, frustum.start.radius);
    let local_metre = pow(abs(determinant(place.local_from_world)), 1.0 / 3.0);
    let m = place.local_from_world;
    let longest = max(max(length(m[0]), length(m[1])), length(m[2]));
    return pixel_width(length(from_eye) + reach / local_metre) * vec2(local_metre, longest);
}

// What the fragments read back.

fn segment_of(in: Varying) -> u32 {
    return in.segment_and_ends >> 4u;
}

fn frustum_of(in: Varying) -> Frustum {
    let kinds = vec2(in.segment_and_ends, in.segment_and_ends >> 2u) & vec2(3u);
    return Frustum(
        in.base_radius.xyz,
        in.axis_length.xyz,
        in.axis_length.w,
        in.base_radius.w,
        in.slope_radii_pixel.x,
        End(in.start_plane.xyz, in.start_plane.w, in.slope_radii_pixel.y, kinds.x),
        End(in.end_plane.xyz, in.end_plane.w, in.slope_radii_pixel.z, kinds.y),
    );
}

fn pixel_of(in: Varying) -> f32 {
    return in.slope_radii_pixel.w;
}

fn ray_frame_of(in: Varying) -> RayFrame {
    return RayFrame(
        mat3x3(in.local_from_view_x.xyz, in.local_from_view_y.xyz, in.local_from_view_z.xyz),
        vec3(in.local_from_view_x.w, in.local_from_view_y.w, in.local_from_view_z.w),
    );
}
