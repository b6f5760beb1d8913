//! The phase function of a layer whose light is solved with its forward peak taken off. Twin of `fog_phase_after` in
//! `shaders/fog/lookup.wgsl`.

use std::f64::consts::PI;

use crate::light::phase::{PhaseLobes, lobes_phase};

/// Returns the share of sunlight that has not been scattered after the optical path `slant`, the share `forward` of
/// what is scattered counted as not scattered: (1 - e^(-f s)) / (f s), as below.
pub fn share_unscattered(forward: f64, slant: f64) -> f64 {
    let fs = (forward * slant).min(1e4);
    if fs < 1e-3 { 1.0 - 0.5 * fs } else { (1.0 - (-fs).exp()) / fs }
}

/// The phase function with which sunlight that has travelled the optical path `slant` through the layer is scattered
/// into the eye, its forward-scattered share `forward` counted with the beam, as the delta-scaled solution counts it.
///
/// In a thin layer this is the phase function itself (the correction of Nakajima and Tanaka 1988 for truncated peaks).
/// Along the way the forward share is scattered again: of f s forward scatterings that the scaled beam counts, (1 -
/// e^(-f s)) are first ones, and the peak they leave is wider. So the part of the phase function beyond the smooth,
/// scaled one (Henyey-Greenstein of `smooth`) is weighted by E = (1 - e^(-f s))/(f s) and taken of order 1/sqrt(E).
/// That exponent is fitted to adding-and-doubling (`tests/fog/light.rs`): without bias from 4 to 40 degrees off the
/// sun.
///
/// Answers the smooth part, and the peak above it.
pub fn fog_phase_after(lobes: &PhaseLobes, forward: f64, smooth: f64, slant: f64, versine: f64) -> [f64; 2] {
    let share = share_unscattered(forward, slant);
    let d = (1.0 - smooth) * (1.0 - smooth) + 2.0 * smooth * versine;
    let even = (1.0 - forward) * (1.0 - smooth * smooth) / (d * d.sqrt()) / (4.0 * PI);
    [even, share * (lobes_phase(lobes, 1.0 / share.sqrt(), versine) - even)]
}
