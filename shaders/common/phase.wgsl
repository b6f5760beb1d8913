// Phase functions.

// Henyey-Greenstein phase function; its integral over the sphere is 4 pi.
fn henyey(g: f32, c: f32) -> f32 {
    let b = 1.0 + g * g - 2.0 * g * c;
    return (1.0 - g * g) / (b * sqrt(b));
}
