//! Steps between two values: the straight mixture and the smooth step.

/// a + (b - a) t, exact at both ends and monotone in t.
pub(super) fn mix(a: f64, b: f64, t: f64) -> f64 {
    if t >= 1.0 { b } else { a + (b - a) * t }
}

/// 0 at `a`, 1 at `b`, level at both.
pub(crate) fn smoothstep(a: f64, b: f64, x: f64) -> f64 {
    let t = ((x - a) / (b - a)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
