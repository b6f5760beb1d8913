//! Phase function of a layer whose light is solved without its forward peak: the f64 reference of `fog_phase_after` in
//! `shaders/fog/lookup.wgsl`.

use std::f64::consts::PI;

use crate::light::phase::{PhaseLobes, lobes_phase};

/// Returns the share of the delta-scaled beam that is really unscattered: e^(-f x) after the optical path x, with the
/// mean (1 - e^(-f s)) / (f s) from 0 to s = `slant`. f = `forward` is the share of scattering that the delta scaling
/// treats as unscattered. The rest of the scaled beam has been scattered forward. The doc of [`fog_phase_after`] uses
/// this mean.
pub fn share_unscattered(forward: f64, slant: f64) -> f64 {
    let fs = (forward * slant).min(1e4);
    if fs < 1e-3 { 1.0 - 0.5 * fs } else { (1.0 - (-fs).exp()) / fs }
}

/// Returns the phase function with which the layer scatters sunlight into the eye after the optical path `slant`, as
/// its smooth part and the peak above it. The share `forward` of the scattering counts with the beam, as in the
/// delta-scaled solution.
///
/// In a thin layer this is the phase function itself (the correction of Nakajima and Tanaka 1988 for truncated peaks).
/// In a thick layer light is scattered forward several times. The scaled beam counts f s forward scatterings, of which
/// 1 - e^(-f s) are first ones; the others make the peak wider. The peak is the part of the phase function above the
/// smooth one (Henyey-Greenstein of `smooth`). It is multiplied by E = (1 - e^(-f s)) / (f s) and widened: the phase
/// function is that of light scattered 1 / sqrt(E) times in a row ([`lobes_phase`]). The exponent 1/2 is fitted to
/// adding and doubling (`tests/fog/light.rs`), without bias from 4 to 40 degrees off the sun.
pub fn fog_phase_after(lobes: &PhaseLobes, forward: f64, smooth: f64, slant: f64, versine: f64) -> [f64; 2] {
    let share = share_unscattered(forward, slant);
    let d = (1.0 - smooth) * (1.0 - smooth) + 2.0 * smooth * versine;
    let even = (1.0 - forward) * (1.0 - smooth * smooth) / (d * d.sqrt()) / (4.0 * PI);
    [even, share * (lobes_phase(lobes, 1.0 / share.sqrt(), versine) - even)]
}
