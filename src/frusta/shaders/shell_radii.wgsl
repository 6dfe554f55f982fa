#define_import_path bevy_verdure::frusta::shell_radii

// The settings of a material's relief, and the radii of the spheres that bound its shell (`ShellShape` of
// `math/shell.rs`).

struct ReliefSettings {
    // The shell's thickness: metres plus a share of the joint's radius.
    metres: f32,
    share: f32,
    // The relief height at the joints' radius.
    level: f32,
    // Steps of the march; 0 for as many as the shell needs on screen.
    steps: u32,
    // Least and greatest height of the map.
    range: vec2<f32>,
    // Pixels of the map.
    size: vec2<f32>,
    bisections: u32,
    // No digits at the end of a name: naga_oil hands the struct on with underscores added, as another type, and the
    // binding comes out twice.
    // Steps towards the main light; 0 for none.
    self_shadow: u32,
    unused_a: u32,
    unused_b: u32,
    // Where the ceilings of each mip level begin.
    ceilings: array<vec4<u32>, 4>,
}

@group(#{MATERIAL_BIND_GROUP}) @binding(103) var<uniform> relief: ReliefSettings;

// Height of the cones whose cutting planes divide the shell.
const PLANE_LEVEL: f32 = 0.5;
const THICKEST: f32 = 8.0;
const THINNEST: f32 = 0.05;

// Radii of the inner and the outer sphere of a joint.
fn shell_radii(radius: f32) -> vec2<f32> {
    var thickest = THICKEST;
    if relief.level * THICKEST > 1.0 - THINNEST {
        thickest = (1.0 - THINNEST) / relief.level;
    }
    let h = min(relief.metres + relief.share * radius, thickest * radius);
    let inner = radius - relief.level * h;
    return vec2(inner, inner + h);
}

// Radius of the sphere of height `w` of a joint.
fn radius_at(radius: f32, w: f32) -> f32 {
    let radii = shell_radii(radius);
    return radii.x + (radii.y - radii.x) * w;
}
