//! Windscreen of a host: pane, wipers, air speeds, mist and heating.

use glam::DVec3;

use super::geometry::{Pane, Plane};
use crate::error::{Error, Result, check_range};

/// Largest number of wiper arms.
pub const MAX_ARMS: usize = 2;

/// Wiper: a blade on an arm that turns around a pivot in the plane of the glass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WiperArm {
    /// Position of the pivot, m to the right and up the glass from the lower left of the pane's bounds, each [-4, 12].
    pub pivot_m: [f64; 2],
    /// Distance from the pivot to the blade's outer end, m, [0.01, 3].
    pub length_m: f64,
    /// Distance from the pivot to the blade's inner end, m, [0, `length_m`).
    pub inner_radius_m: f64,
    /// Angle of the parked blade, degrees anticlockwise from the glass's right, as seen from the camera, [-360, 360].
    pub parked_deg: f64,
    /// Angle at the far end of the stroke, degrees, within 350 of `parked_deg`.
    pub far_deg: f64,
    /// Present position of the blade in its stroke, [0, 1]: 0 parked, 1 at the far end.
    pub position: f64,
    /// Width of the rubber on the glass, m, [0, 0.1].
    pub blade_width_m: f64,
}

impl Default for WiperArm {
    fn default() -> Self {
        Self {
            pivot_m: [0.0, 0.0],
            length_m: 0.6,
            inner_radius_m: 0.1,
            parked_deg: 0.0,
            far_deg: 90.0,
            position: 0.0,
            blade_width_m: 0.006,
        }
    }
}

/// Window that a view looks through, with its wipers, air speeds, mist and heating. A host that drives sets it before
/// each frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Windscreen {
    /// Shape and position of the glass.
    pub pane: Pane,
    /// Velocity of the glass against the air (the vehicle's minus the wind's), m/s in the camera's axes, each within
    /// 400. The number of drops that hit the glass depends on it.
    pub velocity_m_s: DVec3,
    /// Speed of the air that flows up along the glass, as close to it as a bead is high, m/s, [-100, 100]. It drives
    /// the beads.
    pub airflow_m_s: f64,
    /// Share of the weather's rain that reaches the glass, [0, 1]; for example 0 in a tunnel for which the host has set
    /// no box. The context's boxes and maps ([`crate::context::Context::set_shelters`],
    /// [`crate::context::Context::set_occluder_maps`]) further reduce the rain on each part of the pane. A box that
    /// contains the camera and ends within 3 m in front of the glass is the vehicle's own, and keeps no rain off.
    pub exposed: f64,
    /// Mist on the inside, [0, 1]: 0 is clear glass, 1 the densest mist.
    pub fogging: f64,
    /// Share of the glass's height, from the lower edge upwards, that the blower has cleared of mist, [0, 1].
    pub demist: f64,
    /// Wipers, 0 to 2.
    pub arms: [Option<WiperArm>; MAX_ARMS],
    /// Heating of the glass by wires in it or by a blower, W/m^2, [0, 3000]. It melts snow.
    pub heat_w_m2: f64,
}

impl Default for Windscreen {
    fn default() -> Self {
        Self {
            pane: Pane::WholeView(0.6),
            velocity_m_s: DVec3::ZERO,
            airflow_m_s: 0.0,
            exposed: 1.0,
            fogging: 0.0,
            demist: 0.0,
            arms: [None; MAX_ARMS],
            heat_w_m2: 0.0,
        }
    }
}

impl WiperArm {
    /// Checks the ranges of all values.
    fn validate(&self) -> Result<()> {
        check_range("pivot_m[0]", self.pivot_m[0], -4.0, 12.0, "m")?;
        check_range("pivot_m[1]", self.pivot_m[1], -4.0, 12.0, "m")?;
        check_range("length_m", self.length_m, 0.01, 3.0, "m")?;
        check_range("inner_radius_m", self.inner_radius_m, 0.0, 3.0, "m")?;
        if self.inner_radius_m >= self.length_m {
            let accepted = format!("below length_m, {}", self.length_m);
            return Err(Error::range("inner_radius_m", &accepted, self.inner_radius_m));
        }
        check_range("parked_deg", self.parked_deg, -360.0, 360.0, "deg")?;
        check_range("far_deg", self.far_deg, self.parked_deg - 350.0, self.parked_deg + 350.0, "deg")?;
        check_range("position", self.position, 0.0, 1.0, "")?;
        check_range("blade_width_m", self.blade_width_m, 0.0, 0.1, "m")
    }

    /// Returns the blade's angle at a position of the stroke, rad.
    pub(super) fn angle(&self, position: f64) -> f64 {
        (self.parked_deg + (self.far_deg - self.parked_deg) * position).to_radians()
    }
}

impl Windscreen {
    /// Checks the ranges; an error names the field.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`].
    pub fn validate(&self) -> Result<()> {
        match &self.pane {
            Pane::Quad(corners) => {
                Plane::of(corners)?;
            }
            Pane::WholeView(distance) => check_range("windscreen.distance_m", *distance, 0.1, 3.0, "m")?,
        }
        let axes = ["windscreen.velocity_m_s[0]", "windscreen.velocity_m_s[1]", "windscreen.velocity_m_s[2]"];
        for (name, v) in axes.iter().zip(self.velocity_m_s.to_array()) {
            check_range(name, v, -400.0, 400.0, "m/s")?;
        }
        check_range("windscreen.airflow_m_s", self.airflow_m_s, -100.0, 100.0, "m/s")?;
        check_range("windscreen.exposed", self.exposed, 0.0, 1.0, "")?;
        check_range("windscreen.fogging", self.fogging, 0.0, 1.0, "")?;
        check_range("windscreen.demist", self.demist, 0.0, 1.0, "")?;
        check_range("windscreen.heat_w_m2", self.heat_w_m2, 0.0, 3000.0, "W/m^2")?;
        // Names are built only for an error, because a host that drives sets its windscreen before every frame.
        let named = |i: usize| move |e: Error| e.within(&format!("windscreen.arms[{i}]"));
        let mut arms = self.arms.iter().enumerate().filter_map(|(i, arm)| Some((i, arm.as_ref()?)));
        arms.try_for_each(|(i, arm)| arm.validate().map_err(named(i)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_refusal_names_the_arm_that_is_wrong() {
        let bad = WiperArm { length_m: -1.0, ..WiperArm::default() };
        for arms in [[None, Some(bad)], [Some(WiperArm::default()), Some(bad)]] {
            let error = Windscreen { arms, ..Windscreen::default() }.validate().unwrap_err().to_string();
            assert!(error.contains("windscreen.arms[1].length_m"), "{error}");
        }
    }
}
