//! The host's own lamps, such as head lights, work lights and search lights. They light what Welkin draws in their
//! beams.

use glam::{DMat3, DVec3};

use crate::error::{Error, Result, check_range};

/// Maximum number of lamps at a time.
pub const MAX_LIGHTS: usize = 64;

/// A lamp of the host.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HostLight {
    /// Position in the host's world, m, within 1e12 of the origin.
    pub position_m: DVec3,
    /// Direction of the beam in the host's world, of any length in \[1e-6, 1e6\].
    pub direction: DVec3,
    /// Luminous intensity in the middle of the beam, cd per channel of linear Rec. 709, \[0, 1e9\].
    pub intensity_cd: [f64; 3],
    /// Angle from the middle up to which the beam has its full intensity, degrees, \[0, 180\].
    pub inner_deg: f64,
    /// Angle from the middle at which the beam ends, degrees, from `inner_deg` to 180. Between the two angles the
    /// intensity falls by a smooth step of the cosine. If both are 180, the lamp shines to all sides.
    pub outer_deg: f64,
}

/// Lamp as shaders read it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct LightUniform {
    /// Position relative to the camera, (east, north, up), m.
    pub position: [f32; 3],
    /// Cosine of the angle at which the beam ends; -2 for a lamp that shines to all sides.
    pub end: f32,
    /// Unit vector of the beam, (east, north, up).
    pub direction: [f32; 3],
    /// 1 / (cosine of `inner_deg` - `end`), at most 1e4.
    pub steepness: f32,
    /// Luminous intensity in the middle of the beam, cd per channel, times the picture's exposure.
    pub intensity: [f32; 3],
    pub pad: f32,
}

/// Light of a lightning flash in a frame, as a lamp that lights the clouds and what is near the camera.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct FlashLamp {
    /// Position relative to the camera, (east, north, up), m.
    pub position: DVec3,
    /// Luminous flux, lm per channel of linear Rec. 709, as a mean over the frame's time.
    pub flux_lm: [f64; 3],
    /// Radius of the source around `position`, m. It keeps the light close to the source finite.
    pub radius_m: f64,
    /// Share of the light that leaves through the base of the cloud, for a flash inside a cloud. `None` for one that is
    /// open to all sides.
    pub down_share: Option<f64>,
}

/// Maximum number of flash lamps.
pub(crate) const MAX_FLASH_LAMPS: usize = 8;

impl FlashLamp {
    /// Returns the luminous intensity I of a flash of flux F, cd per channel. An open flash has I = F / (4 pi) to all
    /// sides. A flash inside a cloud has I = s F / pi straight down, where s is `down_share` and the cloud's base emits
    /// by Lambert's law.
    pub fn intensity_cd(&self) -> [f64; 3] {
        let share = self.down_share.map_or(0.25, |share| share) / std::f64::consts::PI;
        self.flux_lm.map(|lm| lm * share)
    }

    /// Returns the lamp as shaders read it, with the picture's `exposure` applied.
    pub(crate) fn uniform(&self, exposure: f64) -> LightUniform {
        let hidden = self.down_share.is_some();
        LightUniform {
            position: self.position.as_vec3().to_array(),
            // For a flash inside a cloud, smoothstep(0, 1, c) replaces Lambert's c, the cosine of the angle from
            // straight down. For an open flash, `end` makes the step 1 to all sides.
            end: if hidden { 0.0 } else { -2.0 },
            direction: [0.0, 0.0, -1.0],
            steepness: 1.0,
            intensity: self.intensity_cd().map(|c| (c * exposure).min(1e30) as f32),
            pad: 0.0,
        }
    }
}

impl HostLight {
    /// Checks that every field is in range; the error names the one that is not.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`].
    pub fn validate(&self) -> Result<()> {
        if !(self.position_m.is_finite() && self.position_m.length() <= 1e12) {
            return Err(Error::range("light.position_m", "finite and within 1e12 m", self.position_m));
        }
        if !(self.direction.is_finite() && (1e-6..=1e6).contains(&self.direction.length())) {
            return Err(Error::range("light.direction", "finite with a length in [1e-6, 1e6]", self.direction));
        }
        for v in self.intensity_cd {
            check_range("light.intensity_cd", v, 0.0, 1e9, "cd")?;
        }
        check_range("light.inner_deg", self.inner_deg, 0.0, 180.0, "degrees")?;
        check_range("light.outer_deg", self.outer_deg, self.inner_deg, 180.0, "degrees")
    }

    /// Returns the lamp as shaders read it, for a camera at `eye` with axes `to_enu`, with the picture's `exposure`
    /// applied.
    pub(crate) fn uniform(&self, eye: DVec3, to_enu: DMat3, exposure: f64) -> LightUniform {
        let v = |d: DVec3| d.as_vec3().to_array();
        let [end, steepness] = self.beam();
        LightUniform {
            position: v(to_enu * (self.position_m - eye)),
            end: end as f32,
            direction: v((to_enu * self.direction).normalize()),
            steepness: steepness as f32,
            intensity: self.intensity_cd.map(|c| (c * exposure) as f32),
            pad: 0.0,
        }
    }

    /// Returns the end and the steepness of the beam as [`LightUniform`] has them.
    fn beam(&self) -> [f64; 2] {
        let [inner, outer] = [self.inner_deg, self.outer_deg].map(|a| a.to_radians().cos());
        // -2 is below every cosine: the beam of a lamp that shines to all sides does not end.
        let end = if self.inner_deg >= 180.0 { -2.0 } else { outer };
        [end, 1.0 / (inner - end).max(1e-4)]
    }

    /// Returns the illuminance, lux per channel, at `p` in the host's world, on a surface that faces the lamp.
    /// Distances below 0.1 m count as 0.1 m.
    pub fn illuminance_lux(&self, p: DVec3) -> [f64; 3] {
        let to = p - self.position_m;
        let d2 = to.length_squared().max(0.01);
        let c = to.normalize_or_zero().dot(self.direction.normalize());
        let [end, steepness] = self.beam();
        let x = ((c - end) * steepness).clamp(0.0, 1.0);
        self.intensity_cd.map(|i| i * x * x * (3.0 - 2.0 * x) / d2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lamp() -> HostLight {
        HostLight {
            position_m: DVec3::new(0.0, 0.0, 3.0),
            direction: DVec3::Y,
            intensity_cd: [10_000.0; 3],
            inner_deg: 10.0,
            outer_deg: 20.0,
        }
    }

    #[test]
    fn light_falls_with_the_square_and_ends_with_the_beam() {
        let at = |x: f64, y: f64| lamp().illuminance_lux(DVec3::new(x, y, 3.0))[1];
        assert!((at(0.0, 10.0) - 100.0).abs() < 1e-9 && (at(0.0, 20.0) - 25.0).abs() < 1e-9);
        assert!(at(0.5, 10.0) > 0.99 * 100.0 / 1.0025 && at(4.0, 10.0) == 0.0 && at(0.0, -10.0) == 0.0);
        let bulb = HostLight { inner_deg: 180.0, outer_deg: 180.0, ..lamp() };
        assert!(bulb.illuminance_lux(DVec3::new(0.0, -10.0, 3.0))[1] > 99.0);
    }

    /// Computes the law of `light_beam` in `shaders/common/light.wgsl` from the numbers that shaders read, and compares
    /// it with the query.
    #[test]
    fn shaders_and_queries_have_the_same_beam_at_every_angle() {
        let share = |lamp: &HostLight, degrees: f64| {
            let (sine, cosine) = degrees.to_radians().sin_cos();
            let lux = lamp.illuminance_lux(lamp.position_m + 10.0 * DVec3::new(sine, cosine, 0.0))[1];
            (100.0 * lux / lamp.intensity_cd[1], cosine)
        };
        for angles in
            [[10.0, 20.0], [30.0, 30.0], [0.0, 180.0], [10.0, 180.0], [90.0, 180.0], [170.0, 180.0], [180.0; 2]]
        {
            let lamp = HostLight { inner_deg: angles[0], outer_deg: angles[1], ..lamp() };
            let read = lamp.uniform(DVec3::ZERO, DMat3::IDENTITY, 1.0);
            for degrees in [0.0, 5.0, 14.0, 45.0, 89.0, 120.0, 175.0, 180.0] {
                let (queried, cosine) = share(&lamp, degrees);
                let x = ((cosine - f64::from(read.end)) * f64::from(read.steepness)).clamp(0.0, 1.0);
                let drawn = x * x * (3.0 - 2.0 * x);
                assert!((queried - drawn).abs() < 1e-4, "{angles:?}, {degrees} degrees: {queried} and {drawn}");
            }
        }
        let wide = |outer_deg| HostLight { inner_deg: 90.0, outer_deg, ..lamp() };
        assert!(share(&wide(180.0), 180.0).0 < 1e-9 && share(&wide(180.0), 90.0).0 > 1.0 - 1e-9);
        let apart = share(&wide(180.0), 120.0).0 - share(&wide(179.9), 120.0).0;
        assert!(apart.abs() < 1e-4, "a beam up to 180 degrees is like one that ends just before: {apart}");
    }

    #[test]
    fn bad_lamps_are_refused_by_name() {
        for (bad, name) in [
            (HostLight { position_m: DVec3::splat(f64::NAN), ..lamp() }, "light.position_m"),
            (HostLight { direction: DVec3::ZERO, ..lamp() }, "light.direction"),
            (HostLight { intensity_cd: [1.0, -1.0, 1.0], ..lamp() }, "light.intensity_cd"),
            (HostLight { inner_deg: -1.0, ..lamp() }, "light.inner_deg"),
            (HostLight { outer_deg: 5.0, ..lamp() }, "light.outer_deg"),
        ] {
            let e = bad.validate().unwrap_err();
            assert!(e.to_string().contains(name), "{}", e);
        }
        lamp().validate().unwrap();
    }
}
