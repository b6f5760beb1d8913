//! Linear interpolation of two values.

/// Returns a + (b - a) t, exact at both ends and monotone in t.
pub(super) fn mix(a: f64, b: f64, t: f64) -> f64 {
    if t >= 1.0 { b } else { a + (b - a) * t }
}
