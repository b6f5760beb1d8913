//! `Conditions`: what every effect reads. Plain numbers that follow from a [`super::Weather`], each continuous in time.

use serde::{Deserialize, Serialize};

use super::model::MAX_CLOUD_LAYERS;
use super::precipitation::Falling;

/// ln 20: extinction times the distance at which contrast falls to 5 % (Koschmieder 1924 with the WMO threshold).
pub const LN_20: f64 = 2.995_732_273_553_991;

/// The physical state of the weather at one place and moment.
///
/// Made by [`super::derive`] or [`super::Timeline::at`]. No field is a kind: what a report names by words is a quantity
/// here, so that any two conditions can be blended ([`Conditions::lerp`]). Heights are above the station unless they
/// say otherwise; extinctions are at 550 nm. Plain data, any thread.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Conditions {
    /// Total extinction at station height, 1/m: air, aerosol, fog, what falls and what the wind lifts.
    /// Excludes a shallow or patchy fog that the reported visibility looks over or past.
    pub extinction_per_m: f64,
    /// Temperature, humidity, pressure, and what they make of Rayleigh scattering.
    pub air: Air,
    /// Dry or swollen particles that fill the mixed layer; the sky's Mie medium.
    pub aerosol: AerosolLayer,
    /// Droplets or lifted snow in a layer at the ground; drawn by the fog.
    pub fog: GroundLayer,
    /// Precipitation.
    pub precipitation: Falling,
    /// Cloud layers, lowest first, each in a slot of its height class; those with `cover == 0` are absent. The order of
    /// the slots is that in which light meets them, also while a change moves one past another. See
    /// [`Conditions::cloud_slabs`].
    pub clouds: [CloudSlab; MAX_CLOUD_LAYERS],
    /// Part of the sky that no layer hides, at most: less than layers placed independently would leave while one
    /// overcast comes for another. 1 where only the layers say it.
    #[serde(default = "whole")]
    pub clear_sky: f64,
    /// Cloud light as the host set it, in place of the slabs'.
    pub cloud_light: CloudLightOverride,
    /// Wind and its turbulence.
    pub wind: WindProfile,
    /// The sea's surface.
    pub sea: SeaState,
    /// Water, ice and snow on the ground.
    pub surface: SurfaceCover,
    /// Ozone column, Dobson units.
    pub ozone_du: f64,
}

/// Clear air.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Air {
    /// Temperature at 2 m, degrees Celsius.
    pub temperature_c: f64,
    /// Relative humidity, 0 to 1.
    pub relative_humidity: f64,
    /// Pressure reduced to sea level, hPa.
    pub pressure_hpa: f64,
    /// Pressure at the station, hPa.
    pub station_pressure_hpa: f64,
    /// Height of the station above mean sea level, m.
    pub station_altitude_m: f64,
    /// Number density of air at sea level over that at 15 C and 1013.25 hPa: multiplies a planet's sea-level Rayleigh
    /// coefficient.
    pub rayleigh_density_ratio: f64,
    /// Height over which air thins out by 1/e, m.
    pub rayleigh_scale_height_m: f64,
    /// Rayleigh extinction at 550 nm and station height, 1/m.
    pub rayleigh_extinction_per_m: f64,
}

/// Particles whose density falls as exp(-height / `scale_height_m`).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct AerosolLayer {
    /// Extinction at 550 nm and station height, 1/m.
    pub extinction_per_m: f64,
    /// Extinction goes with (wavelength / 550 nm)^-exponent (Angstrom 1929).
    pub angstrom_exponent: f64,
    /// Absorption goes with (wavelength / 550 nm)^-exponent (Russell et al. 2010).
    pub absorption_angstrom_exponent: f64,
    /// Single scattering albedo at 550 nm.
    pub single_scattering_albedo: f64,
    /// Asymmetry of the phase function.
    pub asymmetry: f64,
    /// Scale height, m.
    pub scale_height_m: f64,
    /// Height of the station above sea level, m, where `extinction_per_m` holds.
    pub reference_altitude_m: f64,
}

/// A layer at the ground: full below `top_m - softness_m`, nothing above `top_m`, smooth between.
///
/// Where `extinction_per_m` is 0 there is no layer and the other fields mean nothing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct GroundLayer {
    /// Extinction inside the layer at 550 nm, 1/m.
    pub extinction_per_m: f64,
    /// Extinction goes with (wavelength / 550 nm)^-exponent; 0 for droplets.
    pub angstrom_exponent: f64,
    /// Single scattering albedo.
    pub single_scattering_albedo: f64,
    /// Asymmetry of the phase function.
    pub asymmetry: f64,
    /// Base above the station, m.
    pub base_m: f64,
    /// Top above the station, m.
    pub top_m: f64,
    /// Depth of the soft upper edge, m.
    pub softness_m: f64,
    /// Part of the ground that it covers, 0 to 1.
    pub coverage: f64,
    /// Size of a patch where `coverage` is below 1, or of a gust's where `lifted` is not 0, m.
    pub patch_size_m: f64,
    /// Share of it that the wind lifts from the ground, 0 to 1: it comes in gusts ([`super::lifting`]).
    #[serde(default)]
    pub lifted: f64,
}

/// A horizontally mixed layer of cloud.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CloudSlab {
    /// Part of the sky covered, 0 to 1; 0 means that there is no such layer.
    pub cover: f64,
    /// Base above the station, m.
    pub base_m: f64,
    /// Thickness, m.
    pub thickness_m: f64,
    /// Optical depth through the layer, straight up, where there is cloud.
    pub optical_depth: f64,
    /// Effective radius of droplets or crystals, um.
    pub droplet_radius_um: f64,
    /// Asymmetry of the phase function.
    pub asymmetry: f64,
    /// Shape: 0 a sheet, 0.5 fair-weather heaps, 1 cumulonimbus.
    pub convection: f64,
    /// Part of the water that is ice, 0 to 1.
    pub ice_fraction: f64,
    /// Distance from cloud to cloud, m.
    #[serde(default = "common_scale")]
    pub scale_m: f64,
    /// How far the layer is broken into cells side by side, 0 to 1: stratocumulus and altocumulus.
    #[serde(default)]
    pub cellular: f64,
    /// How far it is drawn out into fibres, 0 to 1: cirrus.
    #[serde(default)]
    pub fibre: f64,
    /// Wind that carries it, m/s towards east and north.
    #[serde(default)]
    pub wind_m_s: [f64; 2],
    /// Time in which its clouds come and go, s.
    #[serde(default = "common_life")]
    pub life_s: f64,
}

/// Life of clouds in states that were saved without one, s.
fn common_life() -> f64 {
    CloudSlab::NONE.life_s
}

/// Distance from cloud to cloud in states that were saved without one, m.
fn common_scale() -> f64 {
    CloudSlab::NONE.scale_m
}

/// The host's own cloud light. `weight` 0: the slabs decide; 1: these figures do.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct CloudLightOverride {
    /// How much the override counts, 0 to 1.
    pub weight: f64,
    /// Part of the direct sun that passes.
    pub direct: f64,
    /// Diffuse light below the clouds as part of the light above them.
    pub diffuse: f64,
}

/// Mean wind as a neutral logarithmic profile over height.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct WindProfile {
    /// Velocity at 10 m towards the east, m/s (where the air goes, not where it comes from).
    pub east_m_s: f64,
    /// Velocity at 10 m towards the north, m/s.
    pub north_m_s: f64,
    /// Highest 3-second gust at 10 m, m/s.
    pub gust_m_s: f64,
    /// Standard deviation of speed over its mean, at 10 m.
    pub turbulence_intensity: f64,
    /// Half the range over which the direction wanders, degrees: 0 steady, 180 all round.
    pub wander_deg: f64,
    /// Roughness length of the land, m.
    pub roughness_length_m: f64,
    /// Roughness length of the sea, m (Charnock 1955).
    pub sea_roughness_length_m: f64,
}

/// The sea's surface.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SeaState {
    /// Significant height of the wind sea, m.
    pub significant_wave_height_m: f64,
    /// Significant height of the swell, m; 0 without swell.
    pub swell_height_m: f64,
    /// Peak period of the swell, s.
    pub swell_period_s: f64,
    /// Direction of travel of the swell towards the east, unit vector's component.
    pub swell_east: f64,
    /// Direction of travel of the swell towards the north, unit vector's component.
    pub swell_north: f64,
    /// Water temperature, degrees Celsius.
    pub temperature_c: f64,
}

/// Water, ice and snow on the ground, where no simulation says it better.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SurfaceCover {
    /// 0 dry, 0.3 damp, 1 under a closed film.
    pub wetness: f64,
    /// Part of the ground under standing water, 0 to 1.
    pub puddles: f64,
    /// Part of the ground under ice or frost, 0 to 1.
    pub ice: f64,
    /// Depth of lying snow, m.
    pub snow_depth_m: f64,
}

fn whole() -> f64 {
    1.0
}

/// Part of the sky that layers leave clear which are placed independently (random overlap): the product of 1 - cover.
pub(super) fn clear_between(clouds: &[CloudSlab; MAX_CLOUD_LAYERS]) -> f64 {
    clouds.iter().fold(1.0, |clear, slab| clear * (1.0 - slab.cover))
}

impl AerosolLayer {
    /// Extinction at station height, 1/m, at each wavelength (nm): the Angstrom law.
    pub fn extinction_at(&self, wavelengths_nm: [f64; 3]) -> [f64; 3] {
        wavelengths_nm.map(|l| self.extinction_per_m * libm::pow(l / 550.0, -self.angstrom_exponent))
    }

    /// Scattering at station height, 1/m, at each wavelength (nm): extinction less absorption, the absorption following
    /// its own exponent and never above the extinction.
    pub fn scattering_at(&self, wavelengths_nm: [f64; 3]) -> [f64; 3] {
        let absorption = self.extinction_per_m * (1.0 - self.single_scattering_albedo);
        let extinction = self.extinction_at(wavelengths_nm);
        std::array::from_fn(|i| {
            let a = absorption * libm::pow(wavelengths_nm[i] / 550.0, -self.absorption_angstrom_exponent);
            extinction[i] - a.min(extinction[i])
        })
    }

    /// Factor from a value at station height to one at sea level, where planet files state theirs.
    pub fn sea_level_factor(&self) -> f64 {
        libm::exp(self.reference_altitude_m / self.scale_height_m)
    }

    /// Optical depth of the layer above the station, straight up, 550 nm.
    pub fn optical_depth(&self) -> f64 {
        self.extinction_per_m * self.scale_height_m
    }
}

impl GroundLayer {
    /// No fog. The geometry is a shallow one so that a blend has something to start from.
    pub const NONE: Self = Self {
        extinction_per_m: 0.0,
        angstrom_exponent: 0.0,
        single_scattering_albedo: 1.0,
        asymmetry: 0.85,
        base_m: 0.0,
        top_m: 2.0,
        softness_m: 1.0,
        coverage: 1.0,
        patch_size_m: 200.0,
        lifted: 0.0,
    };

    /// The size of a patch as it is drawn, m.
    pub fn drawn_patch_m(&self) -> f64 {
        self.patch_size_m.clamp(5.0, 1e5)
    }

    /// Whether it is unlike from place to place.
    pub fn is_patchy(&self) -> bool {
        self.extinction_per_m > 0.0 && (self.coverage < 1.0 || self.lifted > 0.0)
    }

    /// Extinction at each wavelength (nm), 1/m, inside the layer.
    pub fn extinction_at(&self, wavelengths_nm: [f64; 3]) -> [f64; 3] {
        wavelengths_nm.map(|l| self.extinction_per_m * libm::pow(l / 550.0, -self.angstrom_exponent))
    }
}

impl CloudSlab {
    /// No cloud in this slot.
    pub const NONE: Self = Self {
        cover: 0.0,
        base_m: 1000.0,
        thickness_m: 100.0,
        optical_depth: 0.0,
        droplet_radius_um: 10.0,
        asymmetry: 0.85,
        convection: 0.0,
        ice_fraction: 0.0,
        scale_m: 1500.0,
        cellular: 0.0,
        fibre: 0.0,
        wind_m_s: [0.0; 2],
        life_s: 1200.0,
    };

    /// Top above the station, m.
    pub fn top_m(&self) -> f64 {
        self.base_m + self.thickness_m
    }
}

impl WindProfile {
    /// Mean speed at 10 m, m/s.
    pub fn speed_m_s(&self) -> f64 {
        (self.east_m_s * self.east_m_s + self.north_m_s * self.north_m_s).sqrt()
    }

    /// Where the wind comes from, degrees clockwise from true north in [0, 360); 0 in a calm.
    pub fn from_deg(&self) -> f64 {
        if self.speed_m_s() < 1e-9 {
            return 0.0;
        }
        let deg = libm::atan2(-self.east_m_s, -self.north_m_s).to_degrees();
        if deg < 0.0 { deg + 360.0 } else { deg }
    }

    /// Friction velocity over land, m/s: kappa U10 / ln(10 / z0), kappa = 0.4 (neutral surface layer, Panofsky and
    /// Dutton 1984).
    pub fn friction_velocity_m_s(&self) -> f64 {
        0.4 * self.speed_m_s() / libm::log(10.0 / self.roughness_length_m)
    }

    /// Mean speed over land at a height above ground, m/s: the log law (u*/kappa) ln(z/z0), 0 at and below z0, constant
    /// above 100 m where the surface layer ends.
    pub fn speed_at_height_m_s(&self, height_m: f64) -> f64 {
        let z = height_m.min(100.0);
        if z <= self.roughness_length_m {
            return 0.0;
        }
        self.friction_velocity_m_s() / 0.4 * libm::log(z / self.roughness_length_m)
    }
}

impl Conditions {
    /// Meteorological optical range at station height, m: ln 20 / [`Conditions::extinction_per_m`], and 1e9 where less
    /// than that takes light, as without any air.
    pub fn visibility_m(&self) -> f64 {
        (LN_20 / self.extinction_per_m).min(1e9)
    }

    /// The cloud layers that are there, in slot order (low, middle, high classes).
    pub fn cloud_slabs(&self) -> impl Iterator<Item = &CloudSlab> {
        self.clouds.iter().filter(|slab| slab.cover > 0.0)
    }

    /// Part of the sky hidden by cloud: 1 - product of (1 - cover), layers placed independently (random overlap), or
    /// more while one overcast comes for another.
    pub fn cloud_cover(&self) -> f64 {
        1.0 - self.clear_sky()
    }

    /// Part of the sky that no layer hides.
    pub(super) fn clear_sky(&self) -> f64 {
        self.clear_sky.min(clear_between(&self.clouds))
    }

    /// How much more of the sky layers hide than if they were placed independently, from 1 on.
    pub(super) fn gathered(&self) -> f64 {
        let hidden = 1.0 - clear_between(&self.clouds);
        if hidden > 0.0 { (self.cloud_cover() / hidden).max(1.0) } else { 1.0 }
    }
}
