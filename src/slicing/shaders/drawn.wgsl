#define_import_path bevy_verdure::slicing::drawn

// Which slices are drawn, and which cast shadows: what becomes of the slicings' weights (blend/mod.rs, blend/cast.rs).

#import bevy_verdure::slicing::types::{crowns, which, crown_set}
#import bevy_verdure::slicing::blend::{SLOTS, corrected, levels, slanted, slots}
#import bevy_verdure::slicing::parts::{PART_SLOTS, part_slot}

#ifdef CROWN_PARTS
const PLACES: u32 = PART_SLOTS;
#else
const PLACES: u32 = SLOTS;
#endif

struct DrawnSlice {
    orientation: u32,
    level: u32,
    index: u32,
    opacity: f32,
}

// The slice that is drawn in the `number`th place, far to near, for an eye in a direction (unit) from the centroid and
// apparently so many radii away; of no opacity where there is none. Up close, by part of the crown, `deviation` says how
// much they differ.
fn drawn_slice(number: u32, direction: vec3<f32>, distance: f32, deviation: vec2<f32>) -> DrawnSlice {
    let detail = levels(distance);
    // The coarser level comes first, where it shows at all.
    var level = u32(detail.x);
    var share = detail.y;
    var place = number;
    if share < 1.0 {
        let coarse = crowns[which].levels[level + 1u] * PLACES;
        if place < coarse {
            level += 1u;
            share = 1.0 - share;
        } else {
            place -= coarse;
        }
    }
    let count = crowns[which].levels[level];
    let rank = place / PLACES;
    // One is always left, or far crowns would be gone.
    if rank >= count || rank < min(crown_set.left_out, count - 1u) {
        return DrawnSlice(0u, 0u, 0u, 0.0);
    }
#ifdef CROWN_PARTS
    let slot = part_slot(place % PLACES, direction, deviation);
    let greatest = 1.0;
#else
    let slots = slots(direction);
    let greatest = max(max(slots[0].weight, slots[1].weight), slots[2].weight);
    var slot = slots[0];
    if place % PLACES == 1u {
        slot = slots[1];
    } else if place % PLACES == 2u {
        slot = slots[2];
    }
#endif
    let towards = crowns[which].orientations[slot.orientation].direction;
    let faces = dot(towards, direction) >= 0.0;
    return DrawnSlice(
        slot.orientation,
        level,
        select(count - 1u - rank, rank, faces),
#ifdef CROWN_PAPER_ORDER
        corrected(slot.weight * share, greatest, crowns[which].correction),
#else
        slanted(slot.weight * share, towards, direction),
#endif
    );
}

// The slices that cast shadows for light from a direction: those of the nearest orientation, in the coarsest level. What is
// next to the light comes first.
fn cast_slice(number: u32, direction: vec3<f32>) -> DrawnSlice {
#ifdef CROWN_PAPER_ORDER
    let level = 0u;
#else
    let level = crowns[which].levels.w - 1u;
#endif
    let count = crowns[which].levels[level];
    if number >= count {
        return DrawnSlice(0u, 0u, 0u, 0.0);
    }
    var nearest = 0u;
    var greatest = -2.0;
    for (var i = 0u; i < crowns[which].orientation_count; i += 1u) {
        let cosine = dot(crowns[which].orientations[i].direction, direction);
        if cosine > greatest {
            nearest = i;
            greatest = cosine;
        }
    }
    return DrawnSlice(nearest, level, select(number, count - 1u - number, greatest >= 0.0), 1.0);
}
