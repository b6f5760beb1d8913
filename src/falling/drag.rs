//! How what falls follows the air: drag that is linear for one step and solved exactly, so that no length of a step is
//! unstable.
//!
//! dv/dt = k (air - v) - g has the solution v(t) = s + (v(0) - s) exp(-k t) about the settled velocity s = air - g / k.
//! The rate k is that of drag by the square at the step's first moment, so short steps converge to it; where a step is
//! long against it, the rate at rest, which ends at the right fall.

use glam::DVec3;

use super::drops::GRAVITY_M_S2;

/// One step: velocity (m/s) and way (m) after `dt_s` of what has `velocity_m_s` in air of `air_m_s`, and falls at
/// `terminal_m_s` at rest. Vectors (east, north, up). `shaders/falling/step.wgsl` has the same.
pub fn step(velocity_m_s: DVec3, air_m_s: DVec3, terminal_m_s: f64, dt_s: f64) -> (DVec3, DVec3) {
    let terminal = terminal_m_s.max(1e-3);
    let at_rest = GRAVITY_M_S2 / terminal;
    let pull = ((velocity_m_s - air_m_s).length() / terminal).clamp(0.25, 8.0);
    let rate = at_rest * if dt_s * at_rest > 0.5 { 1.0 } else { pull };
    let settled = air_m_s - DVec3::Z * (GRAVITY_M_S2 / rate);
    let gone = -libm::expm1(-rate * dt_s);
    let difference = velocity_m_s - settled;
    (velocity_m_s - difference * gone, settled * dt_s + difference * (gone / rate))
}
