//! Gravity in the laws of soil.

/// Gravity in all laws of soil, m/s^2.
pub const GRAVITY_M_S2: f64 = 9.81;
