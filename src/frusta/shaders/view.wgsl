#define_import_path bevy_verdure::frusta::view

// From pixels to rays and back. Everything is relative to the eye, so that a plant 10 km from the origin is as
// steady as one at the origin: positions are subtracted while they are exact, and only then turned.

#import bevy_pbr::mesh_bindings::mesh
#import bevy_pbr::mesh_view_bindings::view
#import bevy_render::maths::mat2x4_f32_to_mat3x3_unpack

// A plant's place as seen from the eye.
struct Stand {
    // Local axes in world space.
    world_from_local: mat3x3<f32>,
    local_from_world: mat3x3<f32>,
    // The plant's origin minus the eye, in world space.
    from_eye: vec3<f32>,
    // 1, or −1 for a mirrored plant.
    handedness: f32,
}

fn stand(instance_index: u32) -> Stand {
    // Affine, transposed: row i holds the i-th coordinates of all columns.
    let m = mesh[instance_index].world_from_local;
    let world_from_local = transpose(mat3x3(m[0].xyz, m[1].xyz, m[2].xyz));
    let local_from_world = transpose(mat2x4_f32_to_mat3x3_unpack(
        mesh[instance_index].local_from_world_transpose_a,
        mesh[instance_index].local_from_world_transpose_b,
    ));
    let position = vec3(m[0].w, m[1].w, m[2].w);
    return Stand(
        world_from_local,
        local_from_world,
        position - view.world_position,
        select(1.0, -1.0, determinant(world_from_local) < 0.0),
    );
}

fn is_orthographic() -> bool {
    return view.clip_from_view[3].w == 1.0;
}

// The width of a pixel, in metres, at a distance in front of the eye.
fn pixel_width(depth: f32) -> f32 {
    let width = 2.0 / (abs(view.clip_from_view[1].y) * view.main_pass_viewport.w);
    return select(width * max(depth, 0.0), width, is_orthographic());
}

// The eye as a segment sees it: view directions in local space, and the eye's place, relative to the segment's base.
struct RayFrame {
    local_from_view: mat3x3<f32>,
    origin: vec3<f32>,
}

fn ray_frame(stand: Stand, base: vec3<f32>) -> RayFrame {
    let v = view.world_from_view;
    let turn = mat3x3(v[0].xyz, v[1].xyz, v[2].xyz);
    return RayFrame(stand.local_from_world * turn, stand.local_from_world * -stand.from_eye - base);
}

// A ray in local space, its origin relative to a segment's base, its direction one metre of depth long.
struct PixelRay {
    origin: vec3<f32>,
    direction: vec3<f32>,
    // The direction in view space; its z is −1.
    view_xy: vec2<f32>,
}

// The ray through a point of the framebuffer. Its parameter t is depth: metres along the view axis.
fn pixel_ray(frame: RayFrame, frag_coord: vec2<f32>) -> PixelRay {
    let uv = (frag_coord - view.main_pass_viewport.xy) / view.main_pass_viewport.zw;
    let ndc = uv * vec2(2.0, -2.0) + vec2(-1.0, 1.0);
    let p = view.clip_from_view;
    if is_orthographic() {
        // A jitter shears the view: it sits beside depth.
        let offset = vec3((ndc - p[3].xy) / vec2(p[0].x, p[1].y), 0.0);
        let direction = vec3(p[2].xy / vec2(p[0].x, p[1].y), -1.0);
        return PixelRay(
            frame.origin + frame.local_from_view * offset, frame.local_from_view * direction, direction.xy);
    }
    let direction = vec3((ndc + p[2].xy) / vec2(p[0].x, p[1].y), -1.0);
    return PixelRay(frame.origin, frame.local_from_view * direction, direction.xy);
}

// What clip space's z gains for each metre of depth along a ray; an oblique near plane, as mirrors have, leans it.
fn depth_slope(view_xy: vec2<f32>) -> f32 {
    let p = view.clip_from_view;
    return p[0].z * view_xy.x + p[1].z * view_xy.y - p[2].z;
}

// Depth at which a ray meets the near plane.
fn near_depth(view_xy: vec2<f32>) -> f32 {
    let p = view.clip_from_view;
    if is_orthographic() {
        return (p[3].z - 1.0) / p[2].z;
    }
    return p[3].z / (1.0 - depth_slope(view_xy));
}

// What the depth buffer holds at a depth in metres along a ray.
fn buffer_depth(depth: f32, view_xy: vec2<f32>) -> f32 {
    let p = view.clip_from_view;
    if is_orthographic() {
        return p[3].z - p[2].z * depth;
    }
    return (p[3].z + depth_slope(view_xy) * depth) / depth;
}

// A local position in clip space.
fn local_to_clip(stand: Stand, position: vec3<f32>) -> vec4<f32> {
    let v = view.view_from_world;
    let turn = mat3x3(v[0].xyz, v[1].xyz, v[2].xyz);
    return view.clip_from_view * vec4(turn * (stand.world_from_local * position + stand.from_eye), 1.0);
}

fn local_to_world(stand: Stand, position: vec3<f32>) -> vec3<f32> {
    return stand.world_from_local * position + stand.from_eye + view.world_position;
}
