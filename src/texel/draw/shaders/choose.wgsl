#define_import_path bevy_verdure::texel::choose

// The direction and the number of slices of a facet, for one view (§4.2, §4.3): step by step what choose/mod.rs is.

#import bevy_verdure::texel::criteria::{choose_direction, count_exponent, sin_view_angle, slices_for_depth, slices_for_pixels, tan_view_angle}
#import bevy_verdure::texel::facet::{Facet, corners, facet_bounds, facet_point, normal_and_length, stretches, texel_frame}

struct VolumeMeasure {
    most: vec3<u32>,
    lengths: vec3<f32>,
    // e along u, v and w.
    thickness: vec3<f32>,
}

struct TexelView {
    eye: vec3<f32>,
    // Of the rays of an orthographic view.
    direction: vec3<f32>,
    orthographic: bool,
    // f.
    pixels: f32,
    half_spaces: array<vec4<f32>, 6>,
}

struct TexelQuality {
    // Whether directions are judged by h·tan(a)/e.
    by_quality: bool,
    // d, as a share of e.
    depth: f32,
    // p.
    pixels: f32,
}

struct Choice {
    drawn: bool,
    axis: u32,
    exponent: u32,
    along: bool,
    // How deep inside of contours one may see, h·tan(a), and d, which it should not exceed; in lengths of the facet's space.
    inside: f32,
    depth: f32,
}

// The least cosine of the angle between a normal and the directions to all corners of the prism; 0 if they lie on both
// sides. `c` is that of the centre.
fn least_cosine(facet: Facet, normal: vec3<f32>, view: TexelView, c: f32) -> f32 {
    if view.orthographic {
        return abs(c);
    }
    let low = corners(facet, 0.0);
    let high = corners(facet, 1.0);
    let side = normal * select(1.0, -1.0, c < 0.0);
    var least = abs(c);
    for (var k = 0u; k < 3u; k += 1u) {
        least = min(least, min(cosine_to(low[k] - view.eye, side), cosine_to(high[k] - view.eye, side)));
    }
    return max(least, 0.0);
}

fn cosine_to(corner: vec3<f32>, normal: vec3<f32>) -> f32 {
    return dot(normal, corner) / max(length(corner), 1e-30);
}

fn choose(facet: Facet, measure: VolumeMeasure, view: TexelView, quality: TexelQuality) -> Choice {
    let bounds = facet_bounds(facet);
    let centre = bounds.xyz;
    let radius = bounds.w;
    for (var i = 0u; i < 6u; i += 1u) {
        let plane = view.half_spaces[i];
        if dot(plane.xyz, centre) + plane.w < -radius {
            return Choice(false, 2u, 0u, false, 0.0, 0.0);
        }
    }
    let middle = vec3(1.0 / 3.0);
    let place = facet_point(facet, middle, 0.5);
    let to_place = select(place - view.eye, view.direction, view.orthographic);
    let distance_to_place = length(to_place);
    // From a point inside the prism every direction may be seen.
    if distance_to_place == 0.0 {
        return Choice(true, 2u, count_exponent(f32(measure.most.z), measure.most.z), false, 0.0, 0.0);
    }
    let direction = to_place / distance_to_place;
    let frame = texel_frame(facet, middle, 0.5);
    let across_u = normal_and_length(frame.edges[0], frame.edges[1], frame.edges[2]);
    let across_v = normal_and_length(frame.edges[1], frame.edges[0], frame.edges[2]);
    let across_w = normal_and_length(frame.edges[2], frame.edges[0], frame.edges[1]);
    let c = vec3(dot(across_u.normal, direction), dot(across_v.normal, direction), dot(across_w.normal, direction));
    let l = vec3(across_u.length, across_v.length, across_w.length);
    let h = l / vec3<f32>(measure.most);
    let stretch = stretches(frame, measure.lengths);
    let e = measure.thickness * min(stretch.yxx, stretch.zzy);
    let i = choose_direction(c, select(h, h / e, quality.by_quality));
    // Not by index, on which Mesa's software driver of 2022 crashes.
    let chosen = vec3<f32>(vec3(i) == vec3(0u, 1u, 2u));
    let cosine = dot(c, chosen);
    let texel_length = dot(l, chosen);
    let most = u32(dot(vec3<f32>(measure.most), chosen));
    let normal = mat3x3(across_u.normal, across_v.normal, across_w.normal) * chosen;
    let least = least_cosine(facet, normal, view, cosine);
    let tan_a = tan_view_angle(least);
    let d = quality.depth * dot(e, chosen);
    let for_depth = slices_for_depth(texel_length, tan_a, d);
    // The nearest that the facet can be.
    let z = select(distance(view.eye, centre) - radius, 1.0, view.orthographic);
    var slices = for_depth;
    if z > 0.0 {
        slices = min(for_depth, slices_for_pixels(texel_length, sin_view_angle(least), z, view.pixels, quality.pixels));
    }
    let exponent = count_exponent(slices, most);
    return Choice(true, i, exponent, cosine > 0.0, texel_length / f32(1u << exponent) * tan_a, d);
}
