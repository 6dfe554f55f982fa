#define_import_path bevy_verdure::slicing::cast

// What casts shadows, function by function what blend/cast.rs is.

#import bevy_verdure::slicing::types::Orientation

const DENSEST: f32 = 0.985;

// How far light comes before it meets a leaf, from 0 to 1.
fn first_leaf(lot: f32, alpha: f32) -> f32 {
    return log2(1.0 - min(lot, DENSEST)) / log2(1.0 - min(alpha, DENSEST));
}

// Where a place of a slice casts its shadow from, from the centroid.
fn facing(o: Orientation, direction: vec3<f32>, place: vec3<f32>) -> vec3<f32> {
    let size = o.high - o.low;
    let cosine = dot(direction, o.direction);
    let tilt = direction - o.direction * cosine;
    let sine = length(tilt);
    let flat = place - direction * dot(place, direction);
    if sine < 1e-3 {
        return flat;
    }
    let along = length(vec2(dot(tilt, o.right) / size.x, dot(tilt, o.up) / size.y)) / sine;
    let wider = length(vec2(1.0, size.z * along * sine / max(abs(cosine), 0.02)));
    let axis = normalize(o.direction - direction * cosine);
    return flat + axis * (dot(place, axis) * (wider - 1.0));
}
