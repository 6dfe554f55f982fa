#define_import_path bevy_verdure::texel::types

// Facets and surfaces, and a volume's slices, as records.rs and material.rs write them.

// xyz: a vertex, its height vector, its normal; w: its u, its v, nothing.
struct FacetRecord {
    positions: array<vec4<f32>, 3>,
    heights: array<vec4<f32>, 3>,
    normals: array<vec4<f32>, 3>,
}

struct SurfaceRecord {
    // Rows of the transform from the surface to the world, now and in the frame before.
    world_from_local: array<vec4<f32>, 3>,
    previous: array<vec4<f32>, 3>,
    // x: Bevy's flags of a mesh.
    flags: vec4<u32>,
}

struct Texels {
    // Of the volume's box, in metres.
    lengths: vec3<f32>,
    roughness: f32,
    // xyz: velocity of the wind; w: how far it moves the top, in heights, for each metre a second.
    wind: vec4<f32>,
    reflectance: f32,
    // How many slices are looked up in the layer of one: a power of two.
    inner_slices: u32,
    diffuse_transmission: f32,
}

// Those of all surfaces, and where these are in this frame: in place of Bevy's meshes (bindings.rs).
@group(2) @binding(0) var<storage, read> facets: array<FacetRecord>;
@group(2) @binding(1) var<storage, read> surfaces: array<SurfaceRecord>;

@group(#{MATERIAL_BIND_GROUP}) @binding(0) var<uniform> texels: Texels;
// Slices across one axis; the sets of 1, 2, 4 and so on slices, one after the other.
@group(#{MATERIAL_BIND_GROUP}) @binding(1) var color_texture: texture_2d_array<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(2) var normal_texture: texture_2d_array<f32>;
// They repeat along u and v, and not along w; the second looks up one mip level.
@group(#{MATERIAL_BIND_GROUP}) @binding(3) var slice_sampler: sampler;
@group(#{MATERIAL_BIND_GROUP}) @binding(4) var level_sampler: sampler;
