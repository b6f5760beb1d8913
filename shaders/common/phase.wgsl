// Phase functions.

// Henyey-Greenstein, normalised to 4 pi.
fn henyey(g: f32, c: f32) -> f32 {
    let b = 1.0 + g * g - 2.0 * g * c;
    return (1.0 - g * g) / (b * sqrt(b));
}
