//! Settings of a field, [`FlowSettings`]: its cells, its sides, and the methods that solve it.

use glam::{DVec3, Vec3};

use super::{advect::Scheme, pressure::PressureMethod, sides::Side};
use crate::error::{Error, Result, check_range};

/// Largest speed of the air that a field accepts, m/s.
pub const MAX_SPEED_M_S: f64 = 300.0;

/// Settings of a field. Lengths are measured from the lowest corner of its box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlowSettings {
    /// Numbers of cells east, north and up, 1 to 4096 each, at most 33,554,432 in all. An axis of one cell is flat:
    /// nothing changes along it. At most one axis may be flat.
    pub cells: [u32; 3],
    /// Size of a cell, m, \[1e-6, 10,000\].
    pub cell_m: DVec3,
    /// Low and high side of each axis.
    pub sides: [[Side; 2]; 3],
    /// Scheme that carries velocity.
    pub scheme: Scheme,
    /// Method that solves for the pressure.
    pub pressure: PressureMethod,
    /// Largest divergence times cell size that the pressure may leave in any cell, as a share of the largest speed,
    /// \[1e-7, 1\].
    pub tolerance: f64,
    /// Kinematic viscosity, m2/s, \[0, 1e6\]. In weather it is 0, since it would not slow air that slides along walls.
    /// Tests set it.
    pub viscosity_m2_s: f64,
    /// Whether air slides along terrain and boxes; otherwise it sticks to them.
    pub is_slip: bool,
    /// Roughness length of terrain, boxes and a slip wall as floor, m, \[0, 5\], which sets the friction on air that
    /// slides along them; 0 for no friction.
    pub roughness_m: f64,
    /// Whether eddies smaller than a cell mix the air (Vreman 2004).
    pub has_eddies: bool,
}

impl Default for FlowSettings {
    /// Returns the default settings.
    fn default() -> Self {
        Self {
            cells: [128, 128, 32],
            cell_m: DVec3::splat(4.0),
            sides: [[Side::Open; 2], [Side::Open; 2], [Side::Slip; 2]],
            scheme: Scheme::default(),
            pressure: PressureMethod::default(),
            tolerance: 1e-4,
            viscosity_m2_s: 0.0,
            is_slip: true,
            roughness_m: 0.0,
            has_eddies: false,
        }
    }
}

impl FlowSettings {
    /// Checks that the settings are within their ranges.
    pub(super) fn check(&self) -> Result<()> {
        self.pressure.check("flow.pressure")?;
        check_range("flow.tolerance", self.tolerance, 1e-7, 1.0, "")?;
        check_range("flow.viscosity_m2_s", self.viscosity_m2_s, 0.0, 1e6, "m2/s")?;
        check_range("flow.roughness_m", self.roughness_m, 0.0, 5.0, "m")?;
        for (a, [low, high]) in self.sides.into_iter().enumerate() {
            if (low == Side::Periodic) != (high == Side::Periodic) {
                return Err(Error::invalid(format!("flow.sides[{a}]"), "must be periodic on both sides or on neither"));
            }
            for side in [low, high] {
                if let Side::NoSlip(v) = side {
                    check_range(
                        &format!("flow.sides[{a}].velocity"),
                        Vec3::from(v).length().into(),
                        0.0,
                        MAX_SPEED_M_S,
                        "m/s",
                    )?;
                }
            }
        }
        Ok(())
    }
}
