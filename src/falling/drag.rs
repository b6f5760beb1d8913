//! Drag that makes falling particles follow the air. It is linear during one step and solved exactly, so that a step of
//! any length is stable.
//!
//! dv/dt = k (air - v) - g has the solution v(t) = s + (v(0) - s) exp(-k t), where s = air - g / k is the settled
//! velocity. A settled particle has the rate k0 = g / vt, with its terminal speed vt. In a step of at most 0.5 / k0, k
//! is that of quadratic drag at the start of the step, k0 |v(0) - air| / vt, limited to 0.25 k0 to 8 k0; short steps
//! therefore converge to quadratic drag. In a longer step k = k0, which gives the right terminal speed.

use glam::DVec3;

use super::drops::GRAVITY_M_S2;

/// Returns the velocity (m/s) and the displacement (m) of a particle after `dt_s`. The particle has `velocity_m_s` at
/// first, the air has the velocity `air_m_s`, and the terminal speed in still air is `terminal_m_s`. Vectors are (east,
/// north, up). The loop of `stepped` in `shaders/falling/step.wgsl` has the same formulas.
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
