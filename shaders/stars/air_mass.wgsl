// Relative air mass at the sine of an apparent elevation (Kasten and Young 1989).
fn air_mass(sine: f32) -> f32 {
    let s = max(sine, 0.0);
    return 1.0 / (s + 0.50572 * pow(asin(min(s, 1.0)) * 57.29578 + 6.07995, -1.6364));
}
