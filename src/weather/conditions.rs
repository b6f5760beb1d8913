//! `Conditions`: the physical state of the weather that every effect reads. Plain numbers that follow from a
//! [`super::Weather`], each continuous in time.

use serde::{Deserialize, Serialize};

use super::model::MAX_CLOUD_LAYERS;
use super::precipitation::Falling;

/// ln 20: product of extinction and the distance at which contrast falls to 5 % (Koschmieder 1924 with the WMO
/// threshold).
pub const LN_20: f64 = 2.995_732_273_553_991;

/// The physical state of the weather at one place and time.
///
/// Created by [`super::derive`] or [`super::Timeline::at`]. Every field is a quantity. Kinds that a report names in
/// words become numbers, so that any two conditions can be blended ([`Conditions::lerp`]). Heights are above the
/// station unless stated otherwise; extinctions are at 550 nm. Plain data, any thread.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Conditions {
    /// Total extinction at station height, 1/m: air, aerosol, fog, precipitation and matter lifted by the wind.
    /// Excludes shallow or patchy fog, which the reported visibility leaves out.
    pub extinction_per_m: f64,
    /// Temperature, humidity, pressure, and the Rayleigh scattering that follows from them.
    pub air: Air,
    /// Dry or swollen particles in the mixed layer; the sky's Mie medium.
    pub aerosol: AerosolLayer,
    /// Droplets, or lifted snow or dust, in a layer at the ground; drawn by the fog effect.
    pub fog: GroundLayer,
    /// Precipitation.
    pub precipitation: Falling,
    /// Cloud layers, lowest first, each in a slot of its height class; slots with `cover == 0` are empty. Light meets
    /// the layers in the order of the slots, even while a change moves one layer past another. See
    /// [`Conditions::cloud_slabs`].
    pub clouds: [CloudSlab; MAX_CLOUD_LAYERS],
    /// Upper limit of the share of the sky that no layer hides. While one overcast replaces another, it is below the
    /// share that independently placed layers would leave clear. A value of 1 sets no limit.
    #[serde(default = "whole")]
    pub clear_sky: f64,
    /// The host's own cloud light, in place of that of the slabs.
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
    /// Ratio of the number density of air at sea level to that at 15 C and 1013.25 hPa. It multiplies a planet's
    /// sea-level Rayleigh coefficient.
    pub rayleigh_density_ratio: f64,
    /// Scale height of the air, m.
    pub rayleigh_scale_height_m: f64,
    /// Rayleigh extinction at 550 nm and station height, 1/m.
    pub rayleigh_extinction_per_m: f64,
}

/// Particles whose density is proportional to exp(-height / `scale_height_m`).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct AerosolLayer {
    /// Extinction at 550 nm and station height, 1/m.
    pub extinction_per_m: f64,
    /// Exponent of the extinction's power law, (wavelength / 550 nm)^-exponent (Angstrom 1929).
    pub angstrom_exponent: f64,
    /// Exponent of the absorption's power law, (wavelength / 550 nm)^-exponent (Russell et al. 2010).
    pub absorption_angstrom_exponent: f64,
    /// Single scattering albedo at 550 nm.
    pub single_scattering_albedo: f64,
    /// Asymmetry of the phase function.
    pub asymmetry: f64,
    /// Scale height, m.
    pub scale_height_m: f64,
    /// Altitude at which `extinction_per_m` holds, m: the station's height above sea level.
    pub reference_altitude_m: f64,
}

/// A layer at the ground: full density from `base_m` to `top_m - softness_m`, none above `top_m`, smooth between.
///
/// If `extinction_per_m` is 0, there is no layer and the other fields have no meaning.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct GroundLayer {
    /// Extinction inside the layer at 550 nm, 1/m.
    pub extinction_per_m: f64,
    /// Exponent of the extinction's power law, (wavelength / 550 nm)^-exponent; 0 for droplets.
    pub angstrom_exponent: f64,
    /// Single scattering albedo.
    pub single_scattering_albedo: f64,
    /// Asymmetry of the phase function.
    pub asymmetry: f64,
    /// Base above the station, m. With 0 or less, the layer also fills valleys below the station.
    pub base_m: f64,
    /// Top above the station, m.
    pub top_m: f64,
    /// Depth of the soft upper edge, m.
    pub softness_m: f64,
    /// Share of the ground that the layer covers, 0 to 1.
    pub coverage: f64,
    /// Patch size, m: of the layer's patches if `coverage` is below 1, of a gust's patch if `lifted` is not 0.
    pub patch_size_m: f64,
    /// Share of the layer that the wind lifts from the ground in gusts, 0 to 1 ([`super::lifting`]).
    #[serde(default)]
    pub lifted: f64,
}

/// A layer of cloud with horizontally constant properties.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CloudSlab {
    /// Share of the sky covered, 0 to 1; 0 means that there is no such layer.
    pub cover: f64,
    /// Base above the station, m.
    pub base_m: f64,
    /// Thickness, m.
    pub thickness_m: f64,
    /// Vertical optical depth of the layer where there is cloud.
    pub optical_depth: f64,
    /// Effective radius of droplets or crystals, um.
    pub droplet_radius_um: f64,
    /// Asymmetry of the phase function.
    pub asymmetry: f64,
    /// Shape: 0 a sheet, 0.5 fair-weather cumulus, 1 cumulonimbus.
    pub convection: f64,
    /// Share of the water that is ice, 0 to 1.
    pub ice_fraction: f64,
    /// Distance from cloud to cloud, m.
    #[serde(default = "common_scale")]
    pub scale_m: f64,
    /// How much the layer is divided into cells side by side, 0 to 1: stratocumulus and altocumulus.
    #[serde(default)]
    pub cellular: f64,
    /// How much the layer is stretched into fibres, 0 to 1: cirrus.
    #[serde(default)]
    pub fibre: f64,
    /// Wind that carries the layer, m/s towards east and north.
    #[serde(default)]
    pub wind_m_s: [f64; 2],
    /// Time in which the layer's clouds form and dissolve, s.
    #[serde(default = "common_life")]
    pub life_s: f64,
}

/// Returns the life of clouds in states saved without one, s.
fn common_life() -> f64 {
    CloudSlab::NONE.life_s
}

/// Returns the distance from cloud to cloud in states saved without one, m.
fn common_scale() -> f64 {
    CloudSlab::NONE.scale_m
}

/// The host's own cloud light. With `weight` 0 the slabs decide, with 1 these values.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct CloudLightOverride {
    /// Weight of the override, 0 to 1.
    pub weight: f64,
    /// Share of the direct sunlight that passes.
    pub direct: f64,
    /// Diffuse light below the clouds as a share of the light above them.
    pub diffuse: f64,
}

/// Mean wind: a neutral logarithmic profile over height up to 100 m. Above that, the wind turns towards the geostrophic
/// wind ([`Self::mean_at_height_m_s`]).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct WindProfile {
    /// Velocity at 10 m towards the east, m/s (the direction in which the air moves).
    pub east_m_s: f64,
    /// Velocity at 10 m towards the north, m/s.
    pub north_m_s: f64,
    /// Highest 3-second gust at 10 m, m/s.
    pub gust_m_s: f64,
    /// Ratio of the standard deviation of the speed to its mean, at 10 m.
    pub turbulence_intensity: f64,
    /// Half the range over which the direction wanders, degrees: 0 steady, 180 all directions.
    pub wander_deg: f64,
    /// Roughness length of the land, m.
    pub roughness_length_m: f64,
    /// Roughness length of the sea, m (Charnock 1955).
    pub sea_roughness_length_m: f64,
    /// Upward velocity at 100 m above ground and higher, m/s. Below 100 m it decreases linearly to 0 at the ground. It
    /// is 0 outside weather regions.
    #[serde(default, skip_serializing_if = "is_none")]
    pub up_m_s: f64,
}

/// The sea's surface.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SeaState {
    /// Significant height of the wind sea, m.
    pub significant_wave_height_m: f64,
    /// Share of `significant_wave_height_m` that a host or a report gave, 0 to 1. The rest is the height of a sea that
    /// the wind has fully developed.
    #[serde(default, skip_serializing_if = "is_none")]
    pub given_share: f64,
    /// Significant height of the swell, m; 0 without swell.
    pub swell_height_m: f64,
    /// Peak period of the swell, s.
    pub swell_period_s: f64,
    /// East component of the unit vector along which the swell travels.
    pub swell_east: f64,
    /// North component of the unit vector along which the swell travels.
    pub swell_north: f64,
    /// Water temperature, degrees Celsius.
    pub temperature_c: f64,
}

/// Water, ice and snow on the ground, for places without a simulated ground.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SurfaceCover {
    /// Wetness: 0 dry, 0.3 damp, 1 under a closed film of water.
    pub wetness: f64,
    /// Share of the ground under standing water, 0 to 1.
    pub puddles: f64,
    /// Share of the ground under ice or frost, 0 to 1.
    pub ice: f64,
    /// Depth of lying snow, m.
    pub snow_depth_m: f64,
}

fn whole() -> f64 {
    1.0
}

/// Whether a value is 0. Saved states leave out such values.
fn is_none(value: &f64) -> bool {
    *value == 0.0
}

/// Returns the share of the sky that independently placed layers leave clear (random overlap): the product of (1 -
/// cover) over all layers.
pub(super) fn clear_between(clouds: &[CloudSlab; MAX_CLOUD_LAYERS]) -> f64 {
    clouds.iter().fold(1.0, |clear, slab| clear * (1.0 - slab.cover))
}

impl AerosolLayer {
    /// Returns the extinction at station height, 1/m, at each wavelength (nm): the Angstrom law.
    pub fn extinction_at(&self, wavelengths_nm: [f64; 3]) -> [f64; 3] {
        wavelengths_nm.map(|l| self.extinction_per_m * libm::pow(l / 550.0, -self.angstrom_exponent))
    }

    /// Returns the scattering at station height, 1/m, at each wavelength (nm): extinction minus absorption. The
    /// absorption follows its own exponent and never exceeds the extinction.
    pub fn scattering_at(&self, wavelengths_nm: [f64; 3]) -> [f64; 3] {
        let absorption = self.extinction_per_m * (1.0 - self.single_scattering_albedo);
        let extinction = self.extinction_at(wavelengths_nm);
        std::array::from_fn(|i| {
            let a = absorption * libm::pow(wavelengths_nm[i] / 550.0, -self.absorption_angstrom_exponent);
            extinction[i] - a.min(extinction[i])
        })
    }

    /// Returns the factor that converts an extinction at station height to sea level, the altitude of the values in
    /// planet files.
    pub fn sea_level_factor(&self) -> f64 {
        libm::exp(self.reference_altitude_m / self.scale_height_m)
    }

    /// Returns the vertical optical depth of the layer above the station, at 550 nm.
    pub fn optical_depth(&self) -> f64 {
        self.extinction_per_m * self.scale_height_m
    }
}

impl GroundLayer {
    /// No fog. The shape is that of a shallow layer, so that a blend into a fog starts from a layer near the ground.
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

    /// Returns the size of a patch as drawn, m.
    pub fn drawn_patch_m(&self) -> f64 {
        self.patch_size_m.clamp(5.0, 1e5)
    }

    /// Whether the layer varies from place to place.
    pub fn is_patchy(&self) -> bool {
        self.extinction_per_m > 0.0 && (self.coverage < 1.0 || self.lifted > 0.0)
    }

    /// Returns the extinction at each wavelength (nm), 1/m, inside the layer.
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

    /// Returns the top above the station, m.
    pub fn top_m(&self) -> f64 {
        self.base_m + self.thickness_m
    }
}

impl WindProfile {
    /// Returns the mean speed at 10 m, m/s.
    pub fn speed_m_s(&self) -> f64 {
        (self.east_m_s * self.east_m_s + self.north_m_s * self.north_m_s).sqrt()
    }

    /// Returns the direction from which the wind blows, degrees clockwise from true north in [0, 360); 0 in a calm.
    pub fn from_deg(&self) -> f64 {
        if self.speed_m_s() < 1e-9 {
            return 0.0;
        }
        let deg = libm::atan2(-self.east_m_s, -self.north_m_s).to_degrees();
        if deg < 0.0 { deg + 360.0 } else { deg }
    }

    /// Returns the friction velocity u* over land, m/s: kappa U10 / ln(10 / z0), with kappa = 0.4, the mean speed U10
    /// at 10 m and the roughness length z0 (neutral surface layer, Panofsky and Dutton 1984).
    pub fn friction_velocity_m_s(&self) -> f64 {
        0.4 * self.speed_m_s() / libm::log(10.0 / self.roughness_length_m)
    }

    /// Returns the mean speed over land at a height z above ground, m/s: the log law (u*/kappa) ln(z/z0), with the
    /// symbols of [`Self::friction_velocity_m_s`]. The speed is 0 at and below z0, and constant above 100 m, where the
    /// surface layer ends.
    pub fn speed_at_height_m_s(&self, height_m: f64) -> f64 {
        let z = height_m.min(100.0);
        if z <= self.roughness_length_m {
            return 0.0;
        }
        self.friction_velocity_m_s() / 0.4 * libm::log(z / self.roughness_length_m)
    }
}

impl Conditions {
    /// Returns the meteorological optical range at station height, m: ln 20 / [`Conditions::extinction_per_m`], at most
    /// 1e9 (as without any air).
    pub fn visibility_m(&self) -> f64 {
        (LN_20 / self.extinction_per_m).min(1e9)
    }

    /// Iterates over the existing cloud layers, in slot order (low, middle, high classes).
    pub fn cloud_slabs(&self) -> impl Iterator<Item = &CloudSlab> {
        self.clouds.iter().filter(|slab| slab.cover > 0.0)
    }

    /// Returns the share of the sky hidden by cloud: 1 - product of (1 - cover) for independently placed layers (random
    /// overlap), or more while one overcast replaces another.
    pub fn cloud_cover(&self) -> f64 {
        1.0 - self.clear_sky()
    }

    /// Returns the share of the sky that no layer hides.
    pub(super) fn clear_sky(&self) -> f64 {
        self.clear_sky.min(clear_between(&self.clouds))
    }

    /// Returns the ratio of the share of the sky that layers hide to the share that they would hide if placed
    /// independently; at least 1.
    pub(super) fn gathered(&self) -> f64 {
        let hidden = 1.0 - clear_between(&self.clouds);
        if hidden > 0.0 { (self.cloud_cover() / hidden).max(1.0) } else { 1.0 }
    }
}
