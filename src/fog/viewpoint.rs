//! Viewpoint of the camera, and the light on the layer of fog: the inputs of a frame's fog model besides the law.

use glam::DVec3;

use crate::error::{Error, Result, check_range};

/// Light for models of which only the extinction is used.
pub(super) const NO_LIGHT: FogLight =
    FogLight { to_sun: DVec3::Z, sun_irradiance: [0.0; 3], sky_irradiance: [0.0; 3], ground_albedo: [0.0; 3] };

/// Light that falls on the layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FogLight {
    /// Unit vector towards the sun, or the moon if it is brighter (east, north, up); its length within 0.001 of 1.
    pub to_sun: DVec3,
    /// Direct irradiance of the sun or moon at the layer's top, on a surface facing it, per channel, each \[0, 1e12\].
    /// The unit is free; radiances are in this unit per steradian.
    pub sun_irradiance: [f64; 3],
    /// Irradiance of the sky on a horizontal surface at the layer's top, per channel, each \[0, 1e12\].
    pub sky_irradiance: [f64; 3],
    /// Diffuse reflectance of the ground, per channel, \[0, 1\].
    pub ground_albedo: [f64; 3],
}

impl FogLight {
    /// Checks that every irradiance is in \[0, 1e12\] and every reflectance in \[0, 1\], and that `to_sun` is a unit
    /// vector.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field.
    pub fn validate(&self) -> Result<()> {
        if !(self.to_sun.length() - 1.0).abs().lt(&1e-3) {
            return Err(Error::range("fog.to_sun", "a unit vector", self.to_sun));
        }
        for i in 0..3 {
            check_range("fog.sun_irradiance", self.sun_irradiance[i], 0.0, 1e12, "")?;
            check_range("fog.sky_irradiance", self.sky_irradiance[i], 0.0, 1e12, "")?;
            check_range("fog.ground_albedo", self.ground_albedo[i], 0.0, 1.0, "")?;
        }
        Ok(())
    }
}

/// Position of the camera, as far as fog depends on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewpoint {
    /// Altitude of the camera above mean sea level, m, \[-1e5, 1e9\].
    pub altitude_m: f64,
    /// Position on the map, m east and north of any fixed point, each \[-2e12, 2e12\]. Only the patches' pattern
    /// depends on it.
    pub map_m: [f64; 2],
    /// Radius of the planet, m, above 1000; infinite for a flat world.
    pub planet_radius_m: f64,
    /// Altitude of the planet's ground where the host drew none, m, \[-1e5, 1e5\].
    pub ground_m: f64,
}

impl Viewpoint {
    /// Creates a viewpoint at `altitude_m` over a flat world.
    pub fn flat(altitude_m: f64) -> Self {
        Self { altitude_m, map_m: [0.0; 2], planet_radius_m: f64::INFINITY, ground_m: 0.0 }
    }

    /// Checks that every field is within its range.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field.
    pub fn validate(&self) -> Result<()> {
        check_range("altitude_m", self.altitude_m, -1e5, 1e9, "m")?;
        check_range("fog.ground_m", self.ground_m, -1e5, 1e5, "m")?;
        if self.planet_radius_m.is_nan() || self.planet_radius_m <= 1e3 {
            return Err(Error::range("planet_radius_m", "above 1000 m, or infinite", self.planet_radius_m));
        }
        for v in self.map_m {
            check_range("map_m", v, -2e12, 2e12, "m")?;
        }
        Ok(())
    }
}
