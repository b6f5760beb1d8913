//! Conversion between visibility and extinction: Koschmieder's law with the contrast of the WMO.

/// Contrast that is left at the meteorological optical range (WMO-No. 8).
pub const CONTRAST_THRESHOLD: f64 = 0.05;

/// Returns the total extinction at 550 nm, 1/m, for a visibility, m: -ln(0.05)/V (Koschmieder 1924 with the WMO
/// threshold).
pub fn koschmieder_extinction_per_m(visibility_m: f64) -> f64 {
    -CONTRAST_THRESHOLD.ln() / visibility_m
}

/// Returns the visibility, m, for a total extinction at 550 nm, 1/m; infinite for 0. The inverse of
/// [`koschmieder_extinction_per_m`].
pub fn koschmieder_visibility_m(extinction_per_m: f64) -> f64 {
    -CONTRAST_THRESHOLD.ln() / extinction_per_m
}
