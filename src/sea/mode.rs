//! One wave of a sea, as probes list it.

/// One wave of a sea.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeaMode {
    /// Wave number, 1/m.
    pub k_per_m: f64,
    /// Direction in which it travels, rad from east to north.
    pub direction: f64,
    /// Variance of its height, m^2.
    pub variance_m2: f64,
}
