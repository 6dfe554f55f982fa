#define_import_path bevy_verdure::texel::choose

// The direction and the number of slices of a facet, for one view (§4.2, §4.3): step by step what choose/mod.rs is.

#import bevy_verdure::texel::criteria::{choose_direction, count_exponent, direction_cost, finer_share, second_share, sin_view_angle, slices_for_depth, slices_for_pixels, tan_view_angle}
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
    axis: u32,
    exponent: u32,
    along: bool,
    // The share of twice as many slices.
    finer: f32,
    // How deep inside of contours one may see, h·tan(a), and d, which it should not exceed; in lengths of the facet's space.
    inside: f32,
    depth: f32,
}

// A facet as a view sees it, along u, v and w.
struct FacetInView {
    // Whether any of it may be seen.
    seen: bool,
    c: vec3<f32>,
    e: vec3<f32>,
    // (1/c² − 1)·h².
    cost: vec3<f32>,
    // The least distance of any part of it; 1 of an orthographic view.
    z: f32,
}

fn look_at(facet: Facet, measure: VolumeMeasure, view: TexelView, quality: TexelQuality) -> FacetInView {
    var seen: FacetInView;
    let bounds = facet_bounds(facet);
    let centre = bounds.xyz;
    let radius = bounds.w;
    for (var i = 0u; i < 6u; i += 1u) {
        let plane = view.half_spaces[i];
        if dot(plane.xyz, centre) + plane.w < -radius {
            return seen;
        }
    }
    seen.seen = true;
    let middle = vec3(1.0 / 3.0);
    let place = facet_point(facet, middle, 0.5);
    let to_place = select(place - view.eye, view.direction, view.orthographic);
    // From a point inside the prism every direction may be seen.
    let direction = to_place / max(length(to_place), 1e-30);
    let frame = texel_frame(facet, middle, 0.5);
    let across_u = normal_and_length(frame.edges[0], frame.edges[1], frame.edges[2]);
    let across_v = normal_and_length(frame.edges[1], frame.edges[0], frame.edges[2]);
    let across_w = normal_and_length(frame.edges[2], frame.edges[0], frame.edges[1]);
    seen.c = vec3(dot(across_u.normal, direction), dot(across_v.normal, direction), dot(across_w.normal, direction));
    let l = vec3(across_u.length, across_v.length, across_w.length);
    let h = l / vec3<f32>(measure.most);
    let stretch = stretches(frame, measure.lengths);
    seen.e = measure.thickness * min(stretch.yxx, stretch.zzy);
    let step = select(h, h / seen.e, quality.by_quality);
    seen.cost = vec3(
        direction_cost(seen.c.x, step.x), direction_cost(seen.c.y, step.y), direction_cost(seen.c.z, step.z));
    seen.z = select(distance(view.eye, centre) - radius, 1.0, view.orthographic);
    return seen;
}

// How many slices the corners of the prism need for depth, and for pixels. `c` is the cosine at the centre.
fn slices_needed(
    facet: Facet, axis: u32, measure: VolumeMeasure, view: TexelView, quality: TexelQuality, c: f32, z: f32,
) -> vec2<f32> {
    let side = select(1.0, -1.0, c < 0.0);
    let chosen = vec3<f32>(vec3(axis) == vec3(0u, 1u, 2u));
    var needed = vec2(0.0);
    for (var i = 0u; i < 6u; i += 1u) {
        let b = vec3<f32>(vec3(i % 3u) == vec3(0u, 1u, 2u));
        let w = f32(i / 3u);
        let frame = texel_frame(facet, b, w);
        // The other two edges lie in the slices.
        let edge = frame.edges * chosen;
        let first = select(frame.edges[0], frame.edges[1], axis == 0u);
        let second = select(frame.edges[2], frame.edges[1], axis == 2u);
        let across = normal_and_length(edge, first, second);
        let to_corner = select(corners(facet, w) * b - view.eye, view.direction, view.orthographic);
        // Seen from the other side than the centre, slices are seen along themselves in between.
        let cosine = max(dot(across.normal, to_corner) * side / max(length(to_corner), 1e-30), 0.0);
        let stretch = stretches(frame, measure.lengths);
        let e = dot(measure.thickness * min(stretch.yxx, stretch.zzy), chosen);
        needed = max(needed, vec2(
            slices_for_depth(across.length, tan_view_angle(cosine), quality.depth * e),
            slices_for_pixels(across.length, sin_view_angle(cosine), z, view.pixels, quality.pixels)));
    }
    return needed;
}

// Slices across one axis, however good a direction it is.
fn choose_count(
    facet: Facet, seen: FacetInView, axis: u32, measure: VolumeMeasure, view: TexelView, quality: TexelQuality,
) -> Choice {
    // Not by index, on which Mesa's software driver of 2022 crashes.
    let chosen = vec3<f32>(vec3(axis) == vec3(0u, 1u, 2u));
    let c = dot(seen.c, chosen);
    let most = u32(dot(vec3<f32>(measure.most), chosen));
    let needed = slices_needed(facet, axis, measure, view, quality, c, seen.z);
    // An eye in reach of the prism sees slices however far apart.
    let slices = select(needed.x, min(needed.x, needed.y), seen.z > 0.0);
    let exponent = count_exponent(slices, most);
    let finer = finer_share(slices, exponent, most);
    let e = dot(seen.e, chosen);
    let d = quality.depth * e;
    // Beyond e there are gaps, and no inside.
    let inside = min(needed.x / f32(1u << exponent) * d, e);
    return Choice(axis, exponent, c > 0.0, finer, inside, d);
}

fn choose(facet: Facet, measure: VolumeMeasure, view: TexelView, quality: TexelQuality) -> Choice {
    let seen = look_at(facet, measure, view, quality);
    var choice: Choice;
    if seen.seen {
        choice = choose_count(facet, seen, choose_direction(seen.cost), measure, view, quality);
    }
    return choice;
}

// Which pixels the slices across an axis get: those whose lot, from 0 to 1, lies from x to y. All if it is the best
// direction by far, none if it is not, and a share if another is nearly as good.
fn lots_of_axis(cost: vec3<f32>, axis: u32) -> vec2<f32> {
    let best = choose_direction(cost);
    let is_best = vec3(best) == vec3(0u, 1u, 2u);
    let others = select(cost, vec3(3e38), is_best);
    let second = choose_direction(others);
    if axis != best && axis != second {
        return vec2(0.0);
    }
    let least = dot(cost, vec3<f32>(is_best));
    let share = second_share(least, min(min(others.x, others.y), others.z));
    // The axis of the lower index gets the lower lots, so that both share all of them.
    let lower = select(share, 1.0 - share, best < second);
    return select(vec2(lower, 1.0), vec2(0.0, lower), axis == min(best, second));
}
