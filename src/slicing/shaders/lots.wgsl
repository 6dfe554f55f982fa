#define_import_path bevy_verdure::slicing::lots

// Whether a place is there, by chance, where slices are not blended.

// Mixes the bits of a number: M. Jarzynski, M. Olano, Hash Functions for GPU Rendering (JCGT 2020).
fn pcg(number: u32) -> u32 {
    let state = number * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

// The cells of a slice, along its side, of which each has a lot: about the size of a pixel on screen, in powers of two, so
// that lots stay while the eye moves. `footprint` is what a pixel on screen covers of the slice.
fn cells(footprint: f32) -> f32 {
    return exp2(ceil(-log2(max(footprint, 1e-5))));
}

// The number of the frame for a camera that gathers frames, else 0, so that nothing flickers. Where only some cameras do,
// they are known by a jittered view: one frame in eight, for which Bevy's jitter is zero, is then drawn as if it were not
// gathered. Where all do, what lamps see of crowns changes too.
fn gathered_frame(gathering: u32, clip_from_world: mat4x4<f32>, unjittered: mat4x4<f32>, frame: u32) -> u32 {
    if gathering != 1u {
        return select(0u, frame, gathering == 2u);
    }
    let is_jittered = any(clip_from_world[0] != unjittered[0]) || any(clip_from_world[1] != unjittered[1])
        || any(clip_from_world[2] != unjittered[2]) || any(clip_from_world[3] != unjittered[3]);
    return select(0u, frame, is_jittered);
}

fn footprint(uv: vec2<f32>) -> f32 {
    return max(length(dpdx(uv)), length(dpdy(uv)));
}

// What is drawn for a place in a frame, from 0 to 1: it is there where that is less than its opacity. From frame to frame
// lots go on by the golden ratio of all of them, so that those of a few frames are spread evenly, and their mean is that
// opacity.
fn lot_of(uv: vec2<f32>, cells: f32, lot: u32, frame: u32) -> f32 {
    // By way of signed numbers, which drivers in software turn sooner.
    let cell = bitcast<vec2<u32>>(vec2<i32>(uv * cells));
    let number = pcg(cell.x + pcg(cell.y + lot)) + frame * 2654435769u;
    return f32(bitcast<i32>(number >> 8u)) * (1.0 / 16777216.0);
}
