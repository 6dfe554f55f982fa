#define_import_path bevy_verdure::slicing::types

// A set of slicings: what is the same for all, and their shapes, as material.rs writes them.

struct Orientation {
    direction: vec3<f32>,
    right: vec3<f32>,
    up: vec3<f32>,
    // Corners of the slicing box along right, up and direction, from the centroid.
    low: vec3<f32>,
    high: vec3<f32>,
}

struct Crown {
    centroid: vec3<f32>,
    radius: f32,
    // Slices of each level of detail; w is the number of levels.
    levels: vec4<u32>,
    switches: vec2<f32>,
    correction: f32,
    // Layers of the set before its own.
    layers_before: u32,
    orientation_count: u32,
    sphere: u32,
    vertical: u32,
    flexibility: f32,
    // The greatest angle by which a part's direction may differ from the crown's, in radians.
    widest: f32,
    diffuse_transmission: f32,
    orientations: array<Orientation, 32>,
}

struct CrownSet {
    // xyz: velocity.
    wind: vec4<f32>,
    // xyz: to the brightest sun that casts shadows, or 0.
    sun: vec4<f32>,
    // Along a side of a slice.
    pixels: u32,
    left_out: u32,
    // Which cameras gather frames, as temporal anti-aliasing does: 0 none, 1 those whose view is jittered, 2 all.
    gathering: u32,
}

@group(#{MATERIAL_BIND_GROUP}) @binding(0) var<uniform> crown_set: CrownSet;
@group(#{MATERIAL_BIND_GROUP}) @binding(1) var<storage, read> crowns: array<Crown>;
// Four times two corners a layer.
@group(#{MATERIAL_BIND_GROUP}) @binding(2) var<storage, read> octagons: array<vec4<f32>>;
@group(#{MATERIAL_BIND_GROUP}) @binding(3) var color_texture: texture_2d_array<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(4) var slice_sampler: sampler;
@group(#{MATERIAL_BIND_GROUP}) @binding(5) var normal_texture: texture_2d_array<f32>;

// The slicing that the vertex stage is at.
var<private> which: u32;

// The first of the slicing's own layers in a level of an orientation.
fn first_layer(level: u32, orientation: u32) -> u32 {
    var before = 0u;
    if level > 0u { before += crowns[which].levels.x; }
    if level > 1u { before += crowns[which].levels.y; }
    return before * crowns[which].orientation_count + orientation * crowns[which].levels[level];
}
