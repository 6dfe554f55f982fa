#define_import_path bevy_verdure::slicing::parts

// The discrepancy angle part by part (§4), function by function what blend/parts.rs is.

#import bevy_verdure::slicing::types::{crowns, which}
#import bevy_verdure::slicing::blend::{RISE, Slot, nearest, slots, upright_count}

// Cosine of the angle between two orientations beyond which neither is beside the other.
const OPPOSITE: f32 = -0.9999;

const PART_SLOTS: u32 = 4u;
const PARTS: vec2<f32> = vec2(2.0, 3.0);

// Cosine and sine of the angle by which directions to the eye may differ from that from the centroid, for an eye so many
// radii away; `level` is the cosine of the eye's elevation.
fn deviation(distance: f32, widest: f32, level: f32) -> vec2<f32> {
    let seen = asin(1.0 / max(distance, 1.0));
    let angle = min(seen, asin(sin(widest) * level)) * (1.0 - smoothstep(PARTS.x, PARTS.y, distance));
    return vec2(cos(angle), sin(angle));
}

// The direction to the eye that counts for what is seen along `ray`.
fn part_direction(direction: vec3<f32>, ray: vec3<f32>, deviation: vec2<f32>) -> vec3<f32> {
    let cosine = dot(direction, ray);
    if cosine >= deviation.x {
        return ray;
    }
    let across = ray - direction * cosine;
    return direction * deviation.x + across * (deviation.y / max(length(across), 1e-6));
}

fn part_weight(orientation: u32, direction: vec3<f32>) -> f32 {
    let all = slots(direction);
    var weight = 0.0;
    for (var k = 0u; k < 3u; k += 1u) {
        weight += select(0.0, all[k].weight, all[k].orientation == orientation);
    }
    return weight;
}

// Where a direction is among orientations, for one of them, of which the weight can be told by `turned_weight`.
fn part_turn(orientation: u32, direction: vec3<f32>) -> vec2<f32> {
    let rise = select(0.0, smoothstep(RISE.x, RISE.y, abs(direction.y)), crowns[which].vertical != 0u);
    let towards = crowns[which].orientations[orientation].direction;
    if abs(towards.y) > 0.999 {
        return vec2(0.0, 1.0 - rise);
    }
    let count = upright_count();
    let right = vec3(towards.z, 0.0, -towards.x);
    let discrepancy = atan2(dot(direction, right), dot(direction, towards));
    var next = 0.0;
    var greatest = -2.0;
    for (var i = 0u; i < count; i += 1u) {
        let other = crowns[which].orientations[i].direction;
        greatest = max(greatest, dot(other, direction));
        let cosine = dot(other, towards);
        let angle = atan2(dot(other, right), cosine);
        if angle * discrepancy > 0.0 && cosine > OPPOSITE && (next == 0.0 || abs(angle) < next) {
            next = abs(angle);
        }
    }
    if next == 0.0 {
        return vec2(select(2.0, 0.0, dot(direction, towards) >= greatest), rise);
    }
    return vec2(discrepancy / (0.5 * next), rise);
}

fn turned_weight(turn: vec2<f32>) -> f32 {
    return saturate(1.5 - abs(turn.x)) * (1.0 - turn.y);
}

// Whether an orientation counts for any part.
fn counts(orientation: u32, direction: vec3<f32>, deviation: vec2<f32>) -> bool {
    let towards = crowns[which].orientations[orientation].direction;
    if abs(towards.y) > 0.999 {
        // The vertical one shows either side.
        let side = select(towards, -towards, direction.y < 0.0);
        return part_weight(orientation, part_direction(direction, side, deviation)) > 0.0;
    }
    let level = vec3(direction.x, 0.0, direction.z);
    let cosine = max(length(level), 1e-6);
    let lowest = part_direction(direction, level / cosine, deviation);
    if crowns[which].vertical != 0u && abs(lowest.y) >= RISE.y {
        return false;
    }
    // The sine of the widest turn of azimuth in a cone round the direction.
    let sine = deviation.y / cosine;
    if sine >= 1.0 || abs(towards.y) > 0.01 || dot(towards, level) < 0.0 {
        return true;
    }
    let turned = part_direction(level / cosine, towards, vec2(sqrt(1.0 - sine * sine), sine));
    return part_weight(orientation, turned) > 0.0;
}

// The `number`th of the slicings that are drawn: of weight 1 where it counts for any part, else 0.
fn part_slot(number: u32, direction: vec3<f32>, deviation: vec2<f32>) -> Slot {
    let found = nearest(direction).orientations;
    let low = min(found.x, min(found.y, found.z));
    let high = max(found.x, max(found.y, found.z));
    let sorted = array(low, found.x + found.y + found.z - low - high, high, crowns[which].orientation_count - 1u);
    let orientation = sorted[number];
    // Of few orientations some are named twice.
    if number > 0u && orientation == sorted[max(number, 1u) - 1u] {
        return Slot(orientation, 0.0);
    }
    return Slot(orientation, select(0.0, 1.0, counts(orientation, direction, deviation)));
}
