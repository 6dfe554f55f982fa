#define_import_path bevy_verdure::lighting::spread

// Light on many normals at once: what spread.rs is, by the same names.

fn mean_cosine(cosine: f32, spread: f32, transmission: f32) -> f32 {
    return 0.5 * ((1.0 - 2.0 * transmission) * cosine + sqrt(cosine * cosine + 0.25 * spread));
}
