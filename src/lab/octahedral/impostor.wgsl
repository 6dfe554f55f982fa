// An octahedral impostor: a quad turned to the eye, on which the three views next to the eye's are blended.

#import bevy_pbr::{pbr_functions, pbr_types}
#import bevy_pbr::mesh_bindings::mesh
#import bevy_pbr::mesh_view_bindings::view
#import bevy_render::maths::mat2x4_f32_to_mat3x3_unpack
#ifndef PREPASS_PIPELINE
#import bevy_verdure::lighting::simple::{Leaf, simple_light}
#endif

struct Shape {
    centroid: vec3<f32>,
    radius: f32,
    // Views along a side of the hemi-octahedron's square.
    side: u32,
}

// A view: axes, low corner and size of its picture, from the centroid in metres.
struct View {
    // w: the low corner's x.
    right: vec4<f32>,
    // w: the high corner's y.
    up: vec4<f32>,
    // w: none.
    direction: vec4<f32>,
    // zw: none.
    size: vec4<f32>,
}

@group(#{MATERIAL_BIND_GROUP}) @binding(0) var<uniform> shape: Shape;
@group(#{MATERIAL_BIND_GROUP}) @binding(1) var<storage, read> views: array<View>;
@group(#{MATERIAL_BIND_GROUP}) @binding(2) var color_texture: texture_2d_array<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(3) var view_sampler: sampler;
@group(#{MATERIAL_BIND_GROUP}) @binding(4) var normal_texture: texture_2d_array<f32>;

struct Corner {
    @builtin(instance_index) instance_index: u32,
    // On the quad, in metres from the centroid.
    @location(0) place: vec2<f32>,
}

struct Varying {
    @builtin(position) position: vec4<f32>,
    @location(0) world_position: vec3<f32>,
    // Homogeneous places in the three pictures.
    @location(1) at_a: vec3<f32>,
    @location(2) at_b: vec3<f32>,
    @location(3) at_c: vec3<f32>,
    @location(4) @interpolate(flat) layers: vec3<u32>,
    @location(5) @interpolate(flat) weights: vec3<f32>,
    @location(6) @interpolate(flat) turn_x: vec3<f32>,
    @location(7) @interpolate(flat) turn_y: vec3<f32>,
    @location(8) @interpolate(flat) turn_z: vec3<f32>,
    @location(9) @interpolate(flat) instance_index: u32,
}

// The square's coordinates, 0 to 1, of a direction; below the horizon those of the horizon.
fn on_square(direction: vec3<f32>) -> vec2<f32> {
    let d = vec3(direction.x, max(direction.y, 0.0), direction.z);
    let p = d.xz / max(abs(d.x) + d.y + abs(d.z), 1e-6);
    return vec2(p.x + p.y, p.x - p.y) * 0.5 + 0.5;
}

// Where the ray from the eye through a place of the quad, both from the centroid, meets a view's plane, times w.
fn on_view(layer: u32, eye: vec3<f32>, ray: vec3<f32>) -> vec3<f32> {
    let v = views[layer];
    let along = dot(ray, v.direction.xyz);
    let met = eye * along - ray * dot(eye, v.direction.xyz);
    let x = dot(met, v.right.xyz) - v.right.w * along;
    let y = v.up.w * along - dot(met, v.up.xyz);
    return vec3(x / v.size.x, y / v.size.y, along);
}

@vertex
fn vertex(in: Corner) -> Varying {
    var out: Varying;
    let m = mesh[in.instance_index].world_from_local;
    let origin = vec3(m[0].w, m[1].w, m[2].w);
    let to_world = transpose(mat3x3(m[0].xyz, m[1].xyz, m[2].xyz));
    let turn = mat2x4_f32_to_mat3x3_unpack(
        mesh[in.instance_index].local_from_world_transpose_a,
        mesh[in.instance_index].local_from_world_transpose_b);
    let to_local = transpose(turn);
    let is_orthographic = view.clip_from_view[3].w == 1.0;
    var eye = to_local * (view.world_position - origin) - shape.centroid;
    if is_orthographic {
        eye = normalize(to_local * view.world_from_view[2].xyz) * 1e4 * shape.radius;
    }
    let distance = length(eye);
    let direction = select(vec3(0.0, 0.0, 1.0), eye / distance, distance > 0.0);
    let top = select(vec3(0.0, 1.0, 0.0), vec3(0.0, 0.0, -1.0), abs(direction.y) > 0.999);
    let right = normalize(cross(top, direction));
    let up = cross(direction, right);
    // Near by, a ball is seen larger than the disc through its middle.
    let near = min(shape.radius / max(distance, 1e-6), 0.9);
    let place = (right * in.place.x + up * in.place.y) * inverseSqrt(1.0 - near * near);

    let grid = on_square(direction) * f32(shape.side - 1u);
    let cell = min(floor(grid), vec2(f32(shape.side - 2u)));
    let f = grid - cell;
    let first = vec2<u32>(cell);
    let beside = select(vec2(0u, 1u), vec2(1u, 0u), f.x > f.y);
    let second = first + beside;
    let third = first + vec2(1u);
    out.layers = vec3(first.x, second.x, third.x) + shape.side * vec3(first.y, second.y, third.y);
    out.weights = vec3(1.0 - max(f.x, f.y), abs(f.x - f.y), min(f.x, f.y));
#ifdef PREPASS_PIPELINE
    // For shadow maps one view, the nearest, is enough.
    let greatest = max(out.weights.x, max(out.weights.y, out.weights.z));
    var nearest = out.layers.z;
    if out.weights.x == greatest { nearest = out.layers.x; }
    else if out.weights.y == greatest { nearest = out.layers.y; }
    out.layers = vec3(nearest);
#endif
    let ray = place - eye;
    out.at_a = on_view(out.layers.x, eye, ray);
    out.at_b = on_view(out.layers.y, eye, ray);
    out.at_c = on_view(out.layers.z, eye, ray);

    let from_eye = to_world * (shape.centroid + place) + (origin - view.world_position);
    let v = view.view_from_world;
    var clip = view.clip_from_view * vec4(mat3x3(v[0].xyz, v[1].xyz, v[2].xyz) * from_eye, 1.0);
#ifdef PREPASS_PIPELINE
    // What is nearer to the sun than its shadow map casts shadows all the same.
    clip.z = select(clip.z, min(clip.z, 1.0), is_orthographic);
#endif
    out.position = clip;
    out.world_position = from_eye + view.world_position;
    out.turn_x = turn[0];
    out.turn_y = turn[1];
    out.turn_z = turn[2];
    out.instance_index = in.instance_index;
    return out;
}

#ifdef PREPASS_PIPELINE

@fragment
fn fragment(in: Varying) {
    if textureSample(color_texture, view_sampler, in.at_a.xy / in.at_a.z, in.layers.x).a < 0.5 {
        discard;
    }
}

#else

@fragment
fn fragment(in: Varying) -> @location(0) vec4<f32> {
    let uv_a = in.at_a.xy / in.at_a.z;
    let uv_b = in.at_b.xy / in.at_b.z;
    let uv_c = in.at_c.xy / in.at_c.z;
    let a = textureSample(color_texture, view_sampler, uv_a, in.layers.x);
    let b = textureSample(color_texture, view_sampler, uv_b, in.layers.y);
    let c = textureSample(color_texture, view_sampler, uv_c, in.layers.z);
    let shares = in.weights * vec3(a.a, b.a, c.a);
    let alpha = shares.x + shares.y + shares.z;
    if alpha < 1.0 / 255.0 {
        discard;
    }
    let color = (shares.x * a.rgb + shares.y * b.rgb + shares.z * c.rgb) / alpha;
    let baked = (shares.x * textureSample(normal_texture, view_sampler, uv_a, in.layers.x)
        + shares.y * textureSample(normal_texture, view_sampler, uv_b, in.layers.y)
        + shares.z * textureSample(normal_texture, view_sampler, uv_c, in.layers.z)) / alpha;
    let normal = normalize(mat3x3(in.turn_x, in.turn_y, in.turn_z) * (baked.xyz * 2.0 - (1.0 - 1e-6)));
    var input = pbr_types::pbr_input_new();
    input.material.flags = input.material.flags | pbr_types::STANDARD_MATERIAL_FLAGS_FOG_ENABLED_BIT;
    input.flags = mesh[in.instance_index].flags;
    input.frag_coord = in.position;
    input.world_position = vec4(in.world_position, 1.0);
    let leaf = Leaf(in.world_position, normal, 0.0, baked.a, 0.0, 0.0, in.position.xy, in.layers.x, input.flags);
    let lit = vec4(simple_light(leaf, color), alpha);
    return vec4(pbr_functions::main_pass_post_lighting_processing(input, lit).rgb, alpha);
}

#endif
