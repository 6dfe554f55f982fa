#define_import_path bevy_verdure::texel::criteria

// Which direction of slices to draw, and how many of them (§4.1 to §4.3): function by function what criteria.rs is.

// In place of zero below a line, where shaders need not know infinity.
const LEAST: f32 = 1e-20;

fn sin_view_angle(c: f32) -> f32 {
    return sqrt(max(1.0 - c * c, 0.0));
}

fn tan_view_angle(c: f32) -> f32 {
    return sin_view_angle(c) / max(abs(c), LEAST);
}

fn direction_cost(c: f32, h: f32) -> f32 {
    let square = c * c;
    return max(1.0 - square, 0.0) / max(square, LEAST) * (h * h);
}

// By costs; the later one of equals.
fn choose_direction(cost: vec3<f32>) -> u32 {
    var best = 2u;
    var least = cost.z;
    if cost.y < least {
        best = 1u;
        least = cost.y;
    }
    if cost.x < least {
        best = 0u;
    }
    return best;
}

fn slices_for_depth(l: f32, tan_a: f32, d: f32) -> f32 {
    return l * tan_a / d;
}

fn slices_for_pixels(l: f32, sin_a: f32, z: f32, f: f32, p: f32) -> f32 {
    return l * sin_a / (z / f) / p;
}

fn count_exponent(slices: f32, most: u32) -> u32 {
    var exponent = 0u;
    // What is no number becomes `most`.
    while (1u << (exponent + 1u)) <= most && !(slices <= f32(1u << exponent)) {
        exponent += 1u;
    }
    return exponent;
}

// The last part of the way to the next count, and to the next direction, in which one fades into the other.
const FADE: f32 = 0.25;

fn finer_share(slices: f32, exponent: u32, most: u32) -> f32 {
    if (1u << (exponent + 1u)) > most {
        return 0.0;
    }
    let used = slices / f32(1u << exponent);
    return clamp((used - (1.0 - FADE)) / FADE, 0.0, 1.0);
}

fn second_share(best: f32, second: f32) -> f32 {
    if second <= 0.0 {
        return 0.5;
    }
    let alike = best / second;
    return 0.5 * clamp((alike - (1.0 - FADE)) / FADE, 0.0, 1.0);
}
