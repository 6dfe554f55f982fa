#define_import_path bevy_verdure::frusta::trace

// The fragment stage of all passes: finding what a pixel sees of a segment, and what there is to shade.

#import bevy_pbr::mesh_bindings::mesh
#import bevy_verdure::frusta::types::{Frustum, joints, plants, shapes, reference_across, vec3_from, ROUND, FLAT}
#import bevy_verdure::frusta::cast::{Ray, Hit, cast_ray, NO_ROOT, CONE, START, END}
#import bevy_verdure::frusta::place::{Varying, frustum_of, pixel_of, ray_frame_of, segment_of}
#import bevy_verdure::frusta::surface::{SurfacePoint, surface_point, TAU}
#import bevy_verdure::frusta::view::{
    PixelRay, RayFrame, stand, pixel_ray, near_depth, buffer_depth, local_to_world,
}

#ifdef FRUSTA_RELIEF
#import bevy_verdure::frusta::relief::{Shell, shell_of, height, map_pixels, mip_level, ball_across, turn_of}
#import bevy_verdure::frusta::march::{ReliefHit, march}
#endif

// Share of a pixel by which cutting planes overlap.
const SLACK: f32 = 0.01;

// What a pixel sees of a segment.
struct Seen {
    frustum: Frustum,
    frame: RayFrame,
    hit: Hit,
    // The ray that hit: the pixel's, or that of one of its samples.
    ray: PixelRay,
    // Samples of the pixel that see the segment; 0 for a miss.
    coverage: u32,
    depth: f32,
#ifdef FRUSTA_RELIEF
    shell: Shell,
    // Height in the shell and v of the hit.
    w: f32,
    v: f32,
#endif
}

fn see(in: Varying, sample_mask: u32) -> Seen {
    var seen: Seen;
    seen.frustum = frustum_of(in);
    seen.frame = ray_frame_of(in);
    seen.ray = pixel_ray(seen.frame, in.position.xy);
#ifdef FRUSTA_RELIEF
    see_relief(&seen, in, sample_mask);
#else
    see_surface(&seen, in, sample_mask);
#endif
    seen.depth = buffer_depth(seen.hit.t, seen.ray.view_xy);
#ifdef FRUSTA_UNCLIPPED_DEPTH
    seen.depth = min(seen.depth, 1.0);
#else
    // Beyond the far plane, which only an orthographic view has.
    if seen.depth < 0.0 {
        seen.coverage = 0u;
    }
#endif
    return seen;
}

#ifdef FRUSTA_RELIEF
fn see_relief(seen: ptr<function, Seen>, in: Varying, sample_mask: u32) {
    let shell = shell_of(in);
    (*seen).shell = shell;
    let ray = (*seen).ray;
    let found = march(Ray(ray.origin, ray.direction), shell, least_depth(ray), true);
    take(seen, found);
    (*seen).coverage = select(0u, sample_mask, found.hit.t < NO_ROOT);
#ifdef FRUSTA_MULTISAMPLED
    // Where the ray is well within the floor's outline, so are those of all samples.
    if found.grounded {
        var ground = *seen;
        ground.frustum = shell.floor;
        ground.hit = cast_ray(Ray(ray.origin, ray.direction), shell.floor, least_depth(ray), 0.0);
        if is_inside(ground, in.reach.y, false) {
            return;
        }
    } else if found.hit.t >= NO_ROOT && is_outside(*seen, in) {
        return;
    }
    var coverage = 0u;
    for (var i = 0u; i < #{FRUSTA_SAMPLES}u; i++) {
        if (sample_mask & (1u << i)) == 0u {
            continue;
        }
        let sample_ray = pixel_ray((*seen).frame, in.position.xy + sample_offset(i));
        let shades = (*seen).hit.t >= NO_ROOT;
        let sample = march(Ray(sample_ray.origin, sample_ray.direction), shell, least_depth(sample_ray), shades);
        if sample.hit.t >= NO_ROOT {
            continue;
        }
        if shades {
            (*seen).ray = sample_ray;
            take(seen, sample);
        }
        coverage |= 1u << i;
    }
    (*seen).coverage = coverage;
#endif
}

fn take(seen: ptr<function, Seen>, found: ReliefHit) {
    (*seen).hit = found.hit;
    (*seen).w = found.w;
    (*seen).v = found.v;
}
#else
fn see_surface(pointer: ptr<function, Seen>, in: Varying, sample_mask: u32) {
    var seen = *pointer;
    let slack = SLACK * pixel_of(in);
    seen.hit = cast_ray(Ray(seen.ray.origin, seen.ray.direction), seen.frustum, least_depth(seen.ray), slack);
    seen.coverage = select(0u, sample_mask, seen.hit.t < NO_ROOT);
#ifdef FRUSTA_MULTISAMPLED
    // Coverage is the geometry's own: along outlines each sample casts its own ray, and the pixel is shaded once.
    var faces = seen.hit.t < NO_ROOT && is_facing(seen.frustum, seen.hit, seen.ray.direction);
    if seen.hit.t >= NO_ROOT && is_outside(seen, in) {
        *pointer = seen;
        return;
    }
    if !faces || !is_inside(seen, in.reach.y, true) {
        var coverage = 0u;
        for (var i = 0u; i < #{FRUSTA_SAMPLES}u; i++) {
            let ray = pixel_ray(seen.frame, in.position.xy + sample_offset(i));
            let hit = cast_ray(Ray(ray.origin, ray.direction), seen.frustum, least_depth(ray), slack);
            if (sample_mask & (1u << i)) == 0u || hit.t >= NO_ROOT {
                continue;
            }
            // Through the cut a ray may see the far wall from within, where its neighbour's near side hides it. It must
            // not lend its depth and its dark side to samples of the near side.
            let sample_faces = is_facing(seen.frustum, hit, ray.direction);
            if seen.hit.t >= NO_ROOT || sample_faces && !faces {
                seen.hit = hit;
                seen.ray = ray;
                faces = sample_faces;
                coverage = 0u;
            }
            if sample_faces == faces {
                coverage |= 1u << i;
            }
        }
        seen.coverage = coverage;
    }
#endif
    *pointer = seen;
}
#endif

// Rays count from the near plane, but in shadow maps of directional lights from before it.
fn least_depth(ray: PixelRay) -> f32 {
#ifdef FRUSTA_UNCLIPPED_DEPTH
    return -NO_ROOT;
#else
    return near_depth(ray.view_xy);
#endif
}

#ifdef FRUSTA_MULTISAMPLED
// True if a ray hits the surface from outside.
fn is_facing(frustum: Frustum, hit: Hit, direction: vec3<f32>) -> bool {
    var normal = hit.point;
    if hit.part == CONE {
        let y = dot(hit.point, frustum.axis);
        let radial = hit.point - frustum.axis * y;
        normal = radial - frustum.axis * (frustum.slope * length(radial));
    } else if hit.part == END {
        normal = select(hit.point - frustum.axis * frustum.length, frustum.axis, frustum.end.kind == FLAT);
    } else if frustum.start.kind == FLAT {
        normal = -frustum.axis;
    }
    return dot(normal, direction) <= 0.0;
}

// True if the ray that missed passes the axis so far off that no other of its pixel can hit.
fn is_outside(seen: Seen, in: Varying) -> bool {
    let across = cross(seen.frustum.axis, seen.ray.direction);
    let reach = in.reach.x + 2.0 * in.reach.y;
    return abs(dot(across, seen.ray.origin)) > reach * length(across);
}

// True if a hit is so far inside the part it lies on that all rays of its pixel hit it: two pixels, seen at its slant,
// from the part's outline and, where planes count, from the planes that end it. `pixel` is the width of one, in local
// metres.
fn is_inside(seen: Seen, pixel: f32, planes_count: bool) -> bool {
    let frustum = seen.frustum;
    let point = seen.hit.point;
    let tip = point - frustum.axis * frustum.length;
    var normal: vec3<f32>;
    var radius: f32;
    var room: f32;
    if seen.hit.part == CONE {
        let y = dot(point, frustum.axis);
        radius = frustum.radius + frustum.slope * y;
        normal = normalize(point - frustum.axis * y) - frustum.axis * frustum.slope;
        room = min(
            dot(frustum.start.normal, point) - frustum.start.offset,
            frustum.end.offset - dot(frustum.end.normal, tip),
        );
    } else if seen.hit.part == START {
        radius = frustum.start.radius;
        normal = point;
        room = select(0.0, frustum.start.offset - dot(frustum.start.normal, point), frustum.start.kind == ROUND);
    } else {
        radius = frustum.end.radius;
        normal = tip;
        room = select(0.0, dot(frustum.end.normal, tip) - frustum.end.offset, frustum.end.kind == ROUND);
    }
    let d = seen.ray.direction;
    let cosine = min(abs(dot(normal, d)) / (length(normal) * length(d)), 1.0);
    let to_outline = radius * (1.0 - sqrt(1.0 - cosine * cosine));
    return min(to_outline, select(to_outline, room * cosine, planes_count)) > 2.0 * pixel;
}

// The standard sample positions, relative to the pixel's centre, in sixteenths of a pixel.
fn sample_offset(i: u32) -> vec2<f32> {
#if FRUSTA_SAMPLES == 2
    var offsets = array<vec2<f32>, 2>(vec2(4.0, 4.0), vec2(-4.0, -4.0));
#else if FRUSTA_SAMPLES == 4
    var offsets = array<vec2<f32>, 4>(vec2(-2.0, -6.0), vec2(6.0, -2.0), vec2(-6.0, 2.0), vec2(2.0, 6.0));
#else
    var offsets = array<vec2<f32>, 8>(
        vec2(1.0, -3.0), vec2(-1.0, 3.0), vec2(5.0, 1.0), vec2(-3.0, -5.0),
        vec2(-5.0, 5.0), vec2(-7.0, -1.0), vec2(3.0, 7.0), vec2(7.0, -7.0),
    );
#endif
    return offsets[i] / 16.0;
}
#endif

// What the passes shade.
struct Surface {
    world_position: vec4<f32>,
    world_normal: vec3<f32>,
    // Towards growing u; w as Bevy has it, whose bitangents point to falling v.
    world_tangent: vec4<f32>,
    uv: vec2<f32>,
    // Change of uv to the next pixel on the right, and below.
    uv_dx: vec2<f32>,
    uv_dy: vec2<f32>,
}

fn surface(seen: Seen, in: Varying) -> Surface {
    let plant = plants[mesh[in.instance_index].tag];
    let segment = segment_of(in);
    let joint = joints[plant.first_joint + segment];
    let shape = shapes[plant.first_shape + segment];
    let place = stand(in.instance_index);
#ifdef FRUSTA_RELIEF
    // The frustum of the hit's own height.
    var frustum = seen.frustum;
    let floor = seen.shell.floor;
    frustum.radius = mix(floor.radius, frustum.radius, seen.w);
    frustum.slope = mix(floor.slope, frustum.slope, seen.w);
    var s = surface_point(frustum, seen.shell.reference, shape.twist, seen.hit.point, seen.hit.part);
    s.v = seen.v;
    var across = s.across;
    if seen.hit.part == START {
        across = ball_across(seen.shell, seen.hit.point, START);
    } else if seen.hit.part == END {
        across = ball_across(seen.shell, seen.hit.point - frustum.axis * frustum.length, END);
    }
    s.u = fract(turn_of(seen.shell, across, s.v));
#else
    let frustum = seen.frustum;
    let reference = reference_across(joint.reference, frustum.axis);
    let s = surface_point(frustum, reference, shape.twist, seen.hit.point, seen.hit.part);
#endif
    var out: Surface;
    out.world_position = vec4(local_to_world(place, frustum.base + seen.hit.point), 1.0);
    let around = cross(frustum.axis, s.across);
    out.world_tangent = vec4(normalize(place.world_from_local * around), -place.handedness);
    let v_length = shape.v_end - shape.v_start;
    out.uv = vec2(s.u, shape.v_start + v_length * s.v);
    // Gradients of the ray: where the rays of the neighbouring pixels meet the tangent plane.
    let d = seen.ray.direction;
    let facing = dot(s.true_normal, d);
    let least = 0.05 * length(d);
    let n_d = select(min(facing, -least), max(facing, least), facing > 0.0);
    let generator = normalize(frustum.axis + s.across * frustum.slope);
    let du = around / (TAU * max(s.distance, 1e-6)) + generator * (shape.twist / (TAU * s.span));
    let dv = generator * (v_length / s.span);
    let here = pixel_ray(seen.frame, in.position.xy);
    for (var i = 0u; i < 2u; i++) {
        let step = select(vec2(0.0, 1.0), vec2(1.0, 0.0), i == 0u);
        let next = pixel_ray(seen.frame, in.position.xy + step);
        let moved = (next.origin - here.origin) + (next.direction - here.direction) * seen.hit.t;
        let on_plane = moved - d * (dot(s.true_normal, moved) / n_d);
        // Half a texture a pixel selects the smallest mip level; more, as at the pole of a cap, only costs.
        let gradient = clamp(vec2(dot(du, on_plane), dot(dv, on_plane)), vec2(-0.5), vec2(0.5));
        if i == 0u {
            out.uv_dx = gradient;
        } else {
            out.uv_dy = gradient;
        }
    }
    var normal = s.normal;
#ifdef FRUSTA_RELIEF
    normal = relief_normal(seen, s, out, around, generator, frustum);
#endif
    out.world_normal = normalize(transpose(place.local_from_world) * normal);
    return out;
}

#ifdef FRUSTA_RELIEF
// The shading normal leant by the relief's gradient: that of w − H(u, v), times the shell's thickness.
fn relief_normal(
    seen: Seen,
    s: SurfacePoint,
    surface: Surface,
    around: vec3<f32>,
    generator: vec3<f32>,
    frustum: Frustum,
) -> vec3<f32> {
    let shell = seen.shell;
    // Differences over a pixel of the map or of the screen, whichever is larger.
    let pixels = map_pixels();
    let footprint = max(length(surface.uv_dx * pixels), length(surface.uv_dy * pixels));
    let lod = mip_level(footprint);
    let du = 0.5 * exp2(lod) / max(pixels.x, 1e-6);
    let dv = 0.5 * exp2(lod) / max(pixels.y * abs(shell.v_length), 1e-6);
    let slope_u = height(shell, s.u + du, s.v, lod) - height(shell, s.u - du, s.v, lod);
    let slope_v = height(shell, s.u, s.v + dv, lod) - height(shell, s.u, s.v - dv, lod);
    var thickness = shell.top.radius - shell.floor.radius;
    if seen.hit.part == START {
        thickness = shell.top.start.radius - shell.floor.start.radius;
    } else if seen.hit.part == END {
        thickness = shell.top.end.radius - shell.floor.end.radius;
    }
    let h_u = slope_u / (2.0 * du) / (TAU * max(s.distance, 1e-6));
    let h_v = slope_v / (2.0 * dv) / s.span;
    // On balls v does not change.
    let leans = around * h_u + generator * select(0.0, h_v, seen.hit.part == CONE);
    return normalize(s.normal) - leans * thickness;
}
#endif

// Where the seen point was in the frame before, in the plant's local space of that frame.
fn previous_local_position(seen: Seen, in: Varying) -> vec3<f32> {
    let plant = plants[mesh[in.instance_index].tag];
    let segment = segment_of(in);
    let joint = joints[plant.first_joint + segment];
    let parent = joints[plant.first_joint + shapes[plant.first_shape + segment].parent];
    let frustum = seen.frustum;
    let position = vec3_from(joint.position);
    let previous_position = vec3_from(joint.previous_position);
    let previous_base = vec3_from(parent.previous_position);
    if all(previous_position == position)
        && all(previous_base == frustum.base)
        && joint.previous_reference == joint.reference {
        return frustum.base + seen.hit.point;
    }
    let across = previous_position - previous_base;
    let length = length(across);
    var axis = frustum.axis;
    if length > 0.0 {
        axis = across / length;
    }
    // The point keeps its place along the segment and round it.
    let reference = reference_across(joint.reference, frustum.axis);
    let previous_reference = reference_across(joint.previous_reference, axis);
    let p = seen.hit.point;
    let x = dot(p, reference);
    let z = dot(p, cross(frustum.axis, reference));
    let y = dot(p, frustum.axis) * select(1.0, length / frustum.length, frustum.length > 0.0);
    return previous_base + axis * y + previous_reference * x + cross(axis, previous_reference) * z;
}
