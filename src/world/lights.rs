//! Sun and moon over a place: direction, light, and disc.

use glam::DVec3;

use super::{air::planet_under, color::color_of, state::World};
use crate::{
    almanac::{
        moon::{self, MoonPosition},
        sun::{self, SunPosition, Topocentric},
    },
    error::{Error, Result},
    moment::Light,
    planet::Planet,
    scene::{Place, angle_between},
    weather::{CloudLight, Conditions, LAND_ALBEDO, snow_cover},
};

/// Illuminance of the sun at 1 au above the air, lux (Darula, Kittler & Gueymard 2005).
const SUN_LUX: f64 = 133_334.0;
/// Colour of moonlight relative to sunlight: the moon's albedo rises towards red (Velikodsky et al. 2011). The
/// luminance is kept.
const MOON_TINT: [f64; 3] = [1.12, 0.98, 0.83];

/// Elevation of the sun above which moonlight is ignored, degrees. With a higher sun moonlight adds less than a
/// hundredth to the twilight.
const MOON_MATTERS_BELOW_DEG: f64 = -4.0;

/// Reflectance of snow of which only the depth is known.
const SNOW_ALBEDO: f64 = 0.82;

/// Number of steps to which the share of snow on the ground is rounded for the sky's tables. Half a step changes the
/// light of a clear sky by less than a hundredth.
const SNOW_STEPS: f64 = 16.0;

/// Reflectance of the land with its snow, for light from above.
pub(super) struct LandSeen {
    /// Share of the land that snow covers.
    pub snow: f64,
    /// Albedo of land and snow together.
    pub albedo: f64,
    /// Albedo of the snow.
    snow_albedo: f64,
}

impl LandSeen {
    fn new(snow: f64, snow_albedo: f64) -> Self {
        Self { snow, albedo: LAND_ALBEDO + (snow_albedo - LAND_ALBEDO) * snow, snow_albedo }
    }

    /// Returns the albedo of a planet's land per channel, with its snow.
    pub fn albedo_on(&self, planet: &Planet) -> [f64; 3] {
        planet.ground_albedo.map(|bare| bare + (self.snow_albedo - bare) * self.snow)
    }

    /// Returns a planet whose ground is this land. The share of snow is rounded to steps, so that the sky's tables are
    /// not rebuilt at every small change.
    pub fn under_sky(&self, planet: Planet) -> Planet {
        let stepped = Self { snow: (self.snow * SNOW_STEPS).round() / SNOW_STEPS, ..*self };
        Planet { ground_albedo: stepped.albedo_on(&planet), ..planet }
    }

    /// Creates the land with the snow that the weather reports.
    pub fn reported(c: &Conditions) -> Self {
        Self::new(snow_cover(c.surface.snow_depth_m), SNOW_ALBEDO)
    }
}

impl World {
    /// Returns the planet with the air of a weather, and with the snow on its ground.
    pub fn planet_under(&self, c: &Conditions) -> Planet {
        self.land(c).under_sky(planet_under(&self.set.planet, c))
    }

    /// Returns the land under a weather, with the simulated snow if there is any, else with the reported snow.
    pub(super) fn land(&self, c: &Conditions) -> LandSeen {
        match &self.snow {
            Some(snow) => LandSeen::new(snow.cover, snow.country.albedo),
            None => LandSeen::reported(c),
        }
    }
}

/// Creates the error for a time at which universal time lies outside the almanac's years.
fn out_of_almanac(time_s: f64) -> Error {
    Error::range("time_s", "a time at which the context's clock shows one of the years -2000 to 6000", time_s)
}

/// The sun or moon, and the shares of its light that the clouds let through.
pub(super) type UnderClouds = (Light, CloudLight);

impl World {
    /// Returns sun and moon over `place` at simulation time `time_s`, under the weather `c` over land of the given
    /// albedo.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] if universal time then lies outside the almanac's years.
    pub(super) fn lights_over(
        &self,
        place: &Place,
        (c, albedo): (&Conditions, f64),
        time_s: f64,
    ) -> Result<[UnderClouds; 2]> {
        let utc = self.utc_at(time_s);
        let sky = self.ephemeris.at(utc).map_err(|_| out_of_almanac(time_s))?;
        let turned = Topocentric::new(&sky, utc, place);
        let pressure = c.air.pressure_hpa * libm::exp(-place.altitude_m.max(0.0) / c.air.rayleigh_scale_height_m);
        let see = |d: DVec3| refracted(d, pressure, c.air.temperature_c);
        let sun = self.sun_over(&turned.sun(), (c, albedo), place.altitude_m, see);
        let moon = self.moon_over(moon::lit(&turned), &sun.0, (c, albedo), place.altitude_m, see);
        Ok([sun, moon])
    }

    /// Returns the sun over a place. `see` returns the apparent direction and the flattening of a disc in a true
    /// direction.
    fn sun_over(
        &self,
        almanac: &SunPosition,
        (c, albedo): (&Conditions, f64),
        altitude_m: f64,
        see: impl Fn(DVec3) -> (DVec3, f64),
    ) -> UnderClouds {
        let to_sun = self.set.given_sun.map_or(almanac.direction, |g| g.unit());
        let (apparent, flattening) = see(to_sun);
        let clouds = c.cloud_light_at(to_sun.z, albedo, altitude_m);
        let strength = 1.0 / (almanac.distance_au * almanac.distance_au);
        let spectrum = self.set.planet.sun_ratios().map(|ratio| ratio * strength);
        let sun = Light {
            direction: to_sun,
            apparent,
            bright_limb: DVec3::Z,
            angular_radius: (self.set.planet.sun_angular_radius_deg / almanac.distance_au).to_radians(),
            lit: 1.0,
            spectrum,
            illuminance_lux: color_of(&self.set.color, spectrum),
            flattening,
            direct_share: clouds.direct,
            matters: true,
        };
        (sun, clouds)
    }

    /// Returns the moon over a place; `see` is that of [`Self::sun_over`].
    fn moon_over(
        &self,
        mut almanac: MoonPosition,
        sun: &Light,
        (c, albedo): (&Conditions, f64),
        altitude_m: f64,
        see: impl Fn(DVec3) -> (DVec3, f64),
    ) -> UnderClouds {
        if let Some(given) = &self.set.given_moon {
            almanac.direction = given.unit();
        }
        if self.set.given_moon.is_some() || self.set.given_sun.is_some() {
            // The host has set one of the two directions, so the phase follows from both.
            let elongation = angle_between(almanac.direction, sun.direction);
            almanac.phase_angle = std::f64::consts::PI - elongation;
            almanac.illuminated = 0.5 * (1.0 + libm::cos(almanac.phase_angle));
            let in_disc = sun.direction - almanac.direction * sun.direction.dot(almanac.direction);
            almanac.bright_limb = in_disc.normalize_or(almanac.direction.any_orthonormal_vector());
            almanac.illuminance_lux = moon::moon_illuminance_lux(almanac.phase_angle, almanac.distance_m);
        }
        let (apparent, flattening) = see(almanac.direction);
        let ratios = self.set.planet.sun_ratios();
        let spectrum = [0, 1, 2].map(|i| MOON_TINT[i] * almanac.illuminance_lux / SUN_LUX * ratios[i]);
        let dark = sun.direction.z < libm::sin(MOON_MATTERS_BELOW_DEG.to_radians());
        let above = apparent.z > -0.02;
        let clouds = c.cloud_light_at(almanac.direction.z, albedo, altitude_m);
        let moon = Light {
            direction: almanac.direction,
            apparent,
            bright_limb: almanac.bright_limb,
            angular_radius: almanac.angular_radius,
            lit: almanac.illuminated,
            spectrum,
            illuminance_lux: color_of(&self.set.color, spectrum),
            flattening,
            direct_share: clouds.direct,
            matters: dark && above,
        };
        (moon, clouds)
    }
}

/// Returns the apparent, refracted direction of a light in the true direction `d`, and the flattening of its disc.
fn refracted(d: DVec3, pressure_hpa: f64, temperature_c: f64) -> (DVec3, f64) {
    let elevation = libm::asin(d.z.clamp(-1.0, 1.0));
    let lift = sun::refraction_deg(elevation.to_degrees(), pressure_hpa, temperature_c).to_radians();
    let (s, c) = libm::sincos(elevation + lift);
    let horizontal = DVec3::new(d.x, d.y, 0.0).normalize_or(DVec3::Y);
    let seen = if libm::cos(elevation) < 1e-6 { d } else { horizontal * c + DVec3::Z * s };
    (seen, sun::disc_flattening(elevation.to_degrees(), pressure_hpa, temperature_c))
}
