#define_import_path bevy_verdure::frusta::types

// The records of `records.rs`, and a segment's frustum as the geometry knows it (`math/cone.rs`).
// A segment has the index of the joint that ends it.

#ifdef FRUSTA_RELIEF
#import bevy_verdure::frusta::shell_radii::{radius_at, PLANE_LEVEL}
#endif

// A joint in its pose, with what is needed of the segment that it ends. Scalars, so that no row is padded.
struct JointRecord {
    position: array<f32, 3>,
    // The plane at the segment's start: unit normal, and offset from the parent's joint.
    plane_normal: array<f32, 3>,
    plane_offset: f32,
    previous_position: array<f32, 3>,
    // Direction of u = 0, octahedral.
    reference: u32,
    base_radius: f32,
    slope: f32,
    bits: u32,
    previous_reference: u32,
}

// What never changes of a joint.
struct Shape {
    parent: u32,
    next: u32,
    v_start: f32,
    v_end: f32,
    twist: f32,
    radius: f32,
}

struct Plant {
    first_joint: u32,
    first_shape: u32,
    joint_count: u32,
    unused: u32,
}

@group(#{MATERIAL_BIND_GROUP}) @binding(100) var<storage, read> joints: array<JointRecord>;
@group(#{MATERIAL_BIND_GROUP}) @binding(101) var<storage, read> shapes: array<Shape>;
@group(#{MATERIAL_BIND_GROUP}) @binding(102) var<storage, read> plants: array<Plant>;

// Ends of a frustum: what closes them.
const CUT: u32 = 0u;
const ROUND: u32 = 1u;
const FLAT: u32 = 2u;

const NONE: u32 = 0xffffffffu;
const WHOLE: f32 = 1e30;
const WHOLE_SPHERE: u32 = 16u;
const PAPER: u32 = 32u;

struct End {
    normal: vec3<f32>,
    offset: f32,
    radius: f32,
    kind: u32,
}

struct Frustum {
    base: vec3<f32>,
    axis: vec3<f32>,
    length: f32,
    radius: f32,
    slope: f32,
    start: End,
    end: End,
}

fn vec3_from(v: array<f32, 3>) -> vec3<f32> {
    return vec3(v[0], v[1], v[2]);
}

// Radius of the sphere at a segment's start. A branch starts with its own.
fn start_radius(plant: Plant, segment: u32) -> f32 {
    let shape = shapes[plant.first_shape + segment];
    let parent = shapes[plant.first_shape + shape.parent];
    return select(min(parent.radius, shape.radius), parent.radius, parent.next == segment);
}

// Radius of the sphere whose cones the records hold: the joint's, or with relief that of the height of the planes.
fn sphere_radius(radius: f32) -> f32 {
#ifdef FRUSTA_RELIEF
    return radius_at(radius, PLANE_LEVEL);
#else
    return radius;
#endif
}

fn load_frustum(plant: Plant, segment: u32) -> Frustum {
    let joint = joints[plant.first_joint + segment];
    let shape = shapes[plant.first_shape + segment];
    var frustum: Frustum;
    if shape.parent == NONE {
        frustum.base = vec3_from(joint.position);
        frustum.axis = vec3(0.0, 1.0, 0.0);
        frustum.radius = -1.0;
        return frustum;
    }
    let parent = joints[plant.first_joint + shape.parent];
    frustum.base = vec3_from(parent.position);
    let across = vec3_from(joint.position) - frustum.base;
    frustum.length = length(across);
    frustum.axis = vec3(0.0, 1.0, 0.0);
    if frustum.length > 0.0 {
        frustum.axis = across / frustum.length;
    }
    frustum.radius = joint.base_radius;
    frustum.slope = joint.slope;
    frustum.start = End(
        vec3_from(joint.plane_normal),
        joint.plane_offset,
        sphere_radius(start_radius(plant, segment)),
        joint.bits & 3u,
    );
    frustum.end = End(frustum.axis, 0.0, sphere_radius(shape.radius), (joint.bits >> 2u) & 3u);
    if frustum.end.kind == ROUND {
        if (joint.bits & WHOLE_SPHERE) != 0u {
            frustum.end.offset = -WHOLE;
        } else if (joint.bits & PAPER) == 0u {
            // The contact circle.
            frustum.end.offset = -frustum.end.radius * frustum.slope / sqrt(1.0 + frustum.slope * frustum.slope);
        }
    } else if frustum.end.kind == CUT && shape.next != NONE {
        let next = joints[plant.first_joint + shape.next];
        frustum.end.normal = vec3_from(next.plane_normal);
        frustum.end.offset = next.plane_offset;
    }
    return frustum;
}

// A unit vector from 2 × 16 bit, octahedral.
fn from_octahedral(packed: u32) -> vec3<f32> {
    let p = unpack2x16snorm(packed);
    var n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
    if n.z < 0.0 {
        let signs = select(vec2(-1.0), vec2(1.0), p >= vec2(0.0));
        n = vec3((vec2(1.0) - abs(n.yx)) * signs, n.z);
    }
    return normalize(n);
}

// Where u = 0 is on a segment, across its axis.
fn reference_across(packed: u32, axis: vec3<f32>) -> vec3<f32> {
    let reference = from_octahedral(packed);
    return normalize(reference - axis * dot(reference, axis));
}
