// What drops scatter of a beam.

// Henyey-Greenstein, normalised to 4 pi.
fn henyey(g: f32, c: f32) -> f32 {
    let b = 1.0 + g * g - 2.0 * g * c;
    return (1.0 - g * g) / (b * sqrt(b));
}

// What a drop scatters of light that comes from where `c` = 1 is straight behind it: rays through the sphere, and the
// backward share that makes rainbows (geometric optics of water, asymmetry .88 of what is not diffracted).
fn drop_phase(c: f32) -> f32 {
    return 0.93 * henyey(0.9, c) + 0.07 * henyey(-0.35, c);
}
