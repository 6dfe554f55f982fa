#define_import_path bevy_verdure::slicing::blend

// View blending (§2.3), function by function what blend/ is.

#import bevy_verdure::slicing::types::{crowns, which}

const SLOTS: u32 = 3u;
const RISE: vec2<f32> = vec2(0.5, 0.866);
const FADE: f32 = 0.1;
const FOCAL: f32 = 500.0;
const SUREST: f32 = 0.96;
#ifdef CROWN_PAPER_ORDER
const ALONE: f32 = 0.0;
#else
const ALONE: f32 = 0.5;
#endif

struct Slot {
    orientation: u32,
    weight: f32,
}

fn primary_opacity(primary: vec3<f32>, secondary: vec3<f32>, eye: vec3<f32>, alone: f32) -> f32 {
    let cosine = clamp(dot(primary, secondary), -1.0, 1.0);
    let across = secondary - primary * cosine;
    let width = length(across);
    if width < 1e-4 {
        return 1.0;
    }
    let discrepancy = atan2(dot(eye, across) / width, dot(eye, primary));
    let half = 0.5 * acos(cosine);
    return 1.0 - 0.5 * clamp((discrepancy / half - alone) / (1.0 - alone), 0.0, 1.0);
}

fn swapped(slots: array<Slot, 3>, a: u32, b: u32) -> array<Slot, 3> {
    var sorted = slots;
    if sorted[a].orientation > sorted[b].orientation {
        let kept = sorted[a];
        sorted[a] = sorted[b];
        sorted[b] = kept;
    }
    return sorted;
}

fn upright_count() -> u32 {
    return crowns[which].orientation_count - select(0u, 1u, crowns[which].vertical != 0u && crowns[which].orientation_count > 1u);
}

fn is_upright(towards: vec3<f32>) -> bool {
    return crowns[which].sphere == 0u && abs(towards.y) < 0.01;
}

// The four orientations of least discrepancy angle, the nearest first.
struct Nearest {
    orientations: vec4<u32>,
    cosines: vec4<f32>,
}

fn nearest(eye: vec3<f32>) -> Nearest {
    var orientations = vec4(0u);
    var cosines = vec4(-2.0);
    for (var i = 0u; i < upright_count(); i += 1u) {
        let cosine = dot(crowns[which].orientations[i].direction, eye);
        if cosine > cosines.x {
            orientations = vec4(i, orientations.xyz);
            cosines = vec4(cosine, cosines.xyz);
        } else if cosine > cosines.y {
            orientations = vec4(orientations.x, i, orientations.yz);
            cosines = vec4(cosines.x, cosine, cosines.yz);
        } else if cosine > cosines.z {
            orientations = vec4(orientations.xy, i, orientations.z);
            cosines = vec4(cosines.xy, cosine, cosines.z);
        } else if cosine > cosines.w {
            orientations.w = i;
            cosines.w = cosine;
        }
    }
    return Nearest(orientations, cosines);
}

fn slots(eye: vec3<f32>) -> array<Slot, 3> {
#ifdef CROWN_PAPER_ORDER
    let vertical = false;
#else
    let vertical = crowns[which].vertical != 0u;
#endif
    let found = nearest(eye);
    let cosines = found.cosines;
    var slots: array<Slot, 3>;
    slots[0].orientation = found.orientations.x;
    slots[1].orientation = found.orientations.y;
    slots[2].orientation = found.orientations.z;
    if crowns[which].sphere != 0u {
        let angles = acos(clamp(cosines, vec4(-1.0), vec4(1.0)));
        let gains = max(angles.www - angles.xyz, vec3(1e-6));
        let weights = gains / (gains.x + gains.y + gains.z);
        slots[0].weight = weights.x;
        slots[1].weight = weights.y;
        slots[2].weight = weights.z;
    } else {
        var primary = 1.0;
        if upright_count() > 1u {
            primary = primary_opacity(
                crowns[which].orientations[slots[0].orientation].direction,
                crowns[which].orientations[slots[1].orientation].direction, eye, ALONE);
        }
        let rise = select(0.0, smoothstep(RISE.x, RISE.y, abs(eye.y)), vertical);
        slots[0].weight = primary * (1.0 - rise);
        slots[1].weight = (1.0 - primary) * (1.0 - rise);
        slots[2] = Slot(crowns[which].orientation_count - 1u, rise);
    }
#ifdef CROWN_PAPER_ORDER
    let kept = slots[0];
    slots[0] = slots[1];
    slots[1] = kept;
    return slots;
#else
    return swapped(swapped(swapped(slots, 0u, 1u), 1u, 2u), 0u, 1u);
#endif
}

// The level, and the share of it; the rest is the next coarser one's.
fn levels(distance: f32) -> vec2<f32> {
#ifdef CROWN_PAPER_ORDER
    return vec2(0.0, 1.0);
#else
    let passed = vec2(distance) >= crowns[which].switches * (1.0 + FADE);
    let level = u32(passed.x) + u32(passed.y);
    if level + 1u >= crowns[which].levels.w {
        return vec2(f32(level), 1.0);
    }
    let at = crowns[which].switches[level];
    return vec2(f32(level), 1.0 - smoothstep(at * (1.0 - FADE), at * (1.0 + FADE), distance));
#endif
}

fn corrected(weight: f32, greatest: f32, correction: f32) -> f32 {
    return min(weight * (1.0 + correction * (1.0 - greatest)), 1.0);
}

fn slanted(weight: f32, towards: vec3<f32>, direction: vec3<f32>) -> f32 {
    if !is_upright(towards) {
        return weight;
    }
    return weight / max(length(direction.xz), 0.5);
}

fn covered(alpha: f32, weight: f32) -> f32 {
    return 1.0 - pow(1.0 - SUREST * alpha, weight);
}
