//! Laws of lying snow, in f64: the density of new snow; settling, melt and refreezing; the winds that move snow, and
//! the mass fluxes of drifting snow.
//!
//! Each law is a closed form with its source. The columns (`column.rs`) and the drift (`drift.rs`) convert its results
//! to whole units of mass, so no mass is lost to rounding.

use crate::weather::{Conditions, lifting::drift_friction_velocity_m_s, saturation_pressure_hpa};

/// Density of ice, kg/m^3.
pub const ICE_KG_M3: f64 = 917.0;
/// Density of lying ice pellets and hail, kg/m^3: loosely packed spheres of ice that fill 0.6 of the volume.
pub const PELLETS_KG_M3: f64 = 550.0;
/// Albedo of new snow, of visible light.
pub const NEW_ALBEDO: f64 = 0.88;
/// Lower limit of the albedo of old snow: Wiscombe and Warren (1980) find 0.6 to 0.7 for old, wet and dirty snow.
pub const OLD_ALBEDO: f64 = 0.6;
/// Scale S0 of the mass of new snow that renews the albedo, kg/m^2: a fall of S kg/m^2 restores the share
/// 1 - exp(-S / S0) of the difference to [`NEW_ALBEDO`] (Douville, Royer and Mahfouf 1995; Essery 2015).
pub const RENEWING_KG_M2: f64 = 10.0;
/// Time in which the excess of the albedo over [`OLD_ALBEDO`] falls to 1/e in frost, s (same sources).
const FROST_S: f64 = 3.6e6;
/// Time in which the excess of the albedo over [`OLD_ALBEDO`] falls to 1/e in thaw, s (same sources).
const THAW_S: f64 = 3.6e5;
/// Share of the ice's mass that snow can hold as liquid water (Bergstroem 1976).
pub const HELD_SHARE: f64 = 0.1;
/// Liquid water, as a share of the ice, above which snow counts as wet: its grains stick.
pub const WET_SHARE: f64 = 0.005;
/// Wind at 10 m above which dry snow moves, m/s (Li and Pomeroy 1997).
pub const DRY_THRESHOLD_M_S: f64 = 7.7;
/// Wind at 10 m above which wet snow moves, m/s (Li and Pomeroy 1997).
pub const WET_THRESHOLD_M_S: f64 = 9.9;
/// Steepest slope on which loose snow lies, degrees.
pub const REPOSE_DEG: f64 = 38.0;
/// Ratio of the latent heat of melting to the specific heat of water, degrees C.
const MELTING_C: f64 = 3.34e5 / 4186.0;

/// Returns the density of new snow, kg/m^3: 109 + 6 T + 26 sqrt(U), limited to 50 to 400, at an air temperature T in C
/// and a wind U at 10 m in m/s (Pahaut 1976 in Vionnet et al. 2012, eq. 1).
pub fn new_density_kg_m3(temperature_c: f64, wind_m_s: f64) -> f64 {
    (109.0 + 6.0 * temperature_c + 26.0 * wind_m_s.max(0.0).sqrt()).clamp(50.0, 400.0)
}

/// Returns the rate at which snow settles as its grains change, 1/s: 2.777e-6 exp(-0.04 F - 0.046 (rho - 100)), twice
/// as high in wet snow (Anderson 1976 in Jordan 1991, eq. 29). F is the frost, degrees below 0 C; rho is the density,
/// kg/m^3, of which less than 100 counts as 100.
pub fn metamorphism_per_s(temperature_c: f64, density_kg_m3: f64, wet: bool) -> f64 {
    let cold = (-temperature_c).max(0.0);
    let dense = (density_kg_m3 - 100.0).max(0.0);
    2.777e-6 * if wet { 2.0 } else { 1.0 } * libm::exp(-0.04 * cold - 0.046 * dense)
}

/// Returns the viscosity of snow, kg s/m^2: 9e5 exp(0.08 F + 0.023 rho) (Anderson 1976). F is the frost, degrees below
/// 0 C; rho is the density, kg/m^3. Under a load W, kg/m^2, snow settles at the rate W / viscosity, 1/s.
pub fn viscosity(temperature_c: f64, density_kg_m3: f64) -> f64 {
    9e5 * libm::exp(0.08 * (-temperature_c).max(0.0) + 0.023 * density_kg_m3)
}

/// Returns the share of the albedo's excess over [`OLD_ALBEDO`] that is left after `seconds`: exp(-seconds / t). t is
/// 3.6e5 s if the snow thaws and 3.6e6 s in frost.
pub fn albedo_kept(thaws: bool, seconds: f64) -> f64 {
    libm::exp(-seconds / if thaws { THAW_S } else { FROST_S })
}

/// Returns (m0, m1) of the melting rate m0 + m1 G, mm/h, where G is the sunlight that the snow absorbs, W/m^2. Above 1
/// C, m0 = 0.05 T + r and m1 = 0.0094; at 1 C and below, m0 = r and m1 = 0 (Pellicciotti et al. 2005). r is the melt by
/// rain, 0 at or below 0 C: `r = P T / 79.8 + 0.01 U T min(P / 0.5, 1)`. P is the rain, mm/h; T the air temperature, C;
/// U the wind, m/s. The first term is the rain's own heat, the second that of moist wind in the open: 0.24 mm per day
/// for each degree and m/s (US Army Corps of Engineers 1956), reduced in rain below 0.5 mm/h.
pub fn melt_mm_h(c: &Conditions, rain_mm_h: f64) -> (f64, f64) {
    let t = c.air.temperature_c;
    let rain = if rain_mm_h > 0.0 && t > 0.0 {
        rain_mm_h * t / MELTING_C + 0.24 / 24.0 * c.wind.speed_m_s() * t * (rain_mm_h / 0.5).min(1.0)
    } else {
        0.0
    };
    if t > 1.0 { (0.05 * t + rain, 0.0094) } else { (rain, 0.0) }
}

/// Returns the rate at which liquid water refreezes, mm/h: 0.05 x 3.5 / 24 for each degree below 0 C (Bergstroem 1976).
/// 3.5 mm per day and degree is a rate of melting, 0.05 the ratio of the rate of refreezing to this rate.
pub fn refreezing_mm_h(temperature_c: f64) -> f64 {
    0.05 * 3.5 / 24.0 * (-temperature_c).max(0.0)
}

/// Returns the sublimation rate of snow, mm/h, by the bulk formula: `E = 3600 rho (k / ln(2 / z0))^2 U (qs - q)`. rho
/// is the air's density, kg/m^3; k = 0.4 von Karman's constant; z0 = 0.001 m the roughness length; U the wind at 2 m,
/// m/s; q the specific humidity of the air, and qs that of saturated air over ice at the air's temperature, at most
/// 0 C. The rate is 0 where q exceeds qs.
pub fn sublimation_mm_h(c: &Conditions) -> f64 {
    let t = c.air.temperature_c.min(0.0);
    let pressure = c.air.station_pressure_hpa;
    let over_ice = 6.112 * libm::exp(22.46 * t / (272.62 + t));
    let vapour = c.air.relative_humidity * saturation_pressure_hpa(c.air.temperature_c);
    let exchange = libm::pow(0.4 / libm::log(2.0 / 1e-3), 2.0);
    let air = pressure * 100.0 / (287.05 * (c.air.temperature_c + 273.15));
    let dry = 0.622 * (over_ice - vapour) / pressure;
    (3600.0 * air * exchange * c.wind.speed_at_height_m_s(2.0) * dry).max(0.0)
}

/// Returns the wind at 10 m above which snow moves, m/s. Denser snow is bound more strongly: above 300 kg/m^3 the
/// threshold grows as in Liston et al. (2007, eq. 20).
pub fn threshold_m_s(wet: bool, density_kg_m3: f64) -> f64 {
    let loose = if wet { WET_THRESHOLD_M_S } else { DRY_THRESHOLD_M_S };
    loose * libm::exp(0.013 * (density_kg_m3 - 300.0).max(0.0))
}

/// Returns the flux of saltating snow, kg/(m s), for winds at 10 m: `Q = 0.68 rho t (u^2 - t^2) / (u g)` (Pomeroy and
/// Gray 1990). u and t are the friction velocities of the wind and of the threshold, m/s; rho = 1.3 kg/m^3 is the air's
/// density; g = 9.81 m/s^2. The flux is 0 up to the threshold.
pub fn saltation_kg_m_s(wind_m_s: f64, threshold_m_s: f64) -> f64 {
    if wind_m_s <= threshold_m_s {
        return 0.0;
    }
    let (u, t) = (drift_friction_velocity_m_s(wind_m_s), drift_friction_velocity_m_s(threshold_m_s));
    0.68 * 1.3 / (u * 9.81) * t * (u * u - t * t)
}

/// Returns the flux of fully developed suspended snow, kg/(m s), for a wind U at 10 m, m/s:
/// `Q = (1 - t^2 / u^2) U^3.8 / 233847 - Qs`. U^3.8 / 233847 is the flux of all snow up to 5 m (Tabler 1990). Qs is the
/// flux of [`saltation_kg_m_s`], with the same u and t: friction velocities of the wind and of the threshold, m/s. Qs
/// contains the factor 1 - t^2 / u^2 too, so that suspension begins at the threshold of saltation.
pub fn suspension_kg_m_s(wind_m_s: f64, threshold_m_s: f64) -> f64 {
    if wind_m_s <= threshold_m_s {
        return 0.0;
    }
    let (u, t) = (drift_friction_velocity_m_s(wind_m_s), drift_friction_velocity_m_s(threshold_m_s));
    let all = libm::pow(wind_m_s, 3.8) / 233_847.0 * (1.0 - t * t / (u * u));
    (all - saltation_kg_m_s(wind_m_s, threshold_m_s)).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::weather::{Weather, Wind, derive};

    /// Returns the conditions in this wind; `humidity` is from 0 to 1.
    fn weather(temperature_c: f64, wind_m_s: f64, humidity: f64) -> Conditions {
        let w = Weather {
            temperature_c,
            relative_humidity: humidity,
            wind: Wind::of(wind_m_s, 270.0),
            ..Weather::default()
        };
        derive(&w).unwrap()
    }

    #[test]
    fn new_snow_lies_lighter_in_the_cold_and_denser_in_wind() {
        assert_eq!(new_density_kg_m3(0.0, 0.0), 109.0);
        assert_eq!(new_density_kg_m3(-5.0, 4.0), 131.0);
        assert_eq!(new_density_kg_m3(-20.0, 0.0), 50.0);
    }

    #[test]
    fn settling_has_the_published_rates() {
        // Light snow at the melting point settles by 1 % per hour; at 130 kg/m^3 by a quarter of that.
        assert!((metamorphism_per_s(0.0, 80.0, false) * 3600.0 - 0.01).abs() < 1e-5);
        let slower = metamorphism_per_s(0.0, 130.0, false) / metamorphism_per_s(0.0, 100.0, false);
        assert!((slower - 0.2516).abs() < 1e-3, "{slower}");
        assert!((viscosity(-10.0, 200.0) / 9e5 - (0.8f64 + 4.6).exp()).abs() < 1e-9 * 221.0);
    }

    #[test]
    fn melt_follows_temperature_sun_and_rain() {
        let (warm, sun) = melt_mm_h(&weather(5.0, 3.0, 0.6), 0.0);
        assert!((warm - 0.25).abs() < 1e-12 && sun == 0.0094);
        assert_eq!(melt_mm_h(&weather(0.5, 3.0, 0.6), 0.0), (0.0, 0.0));
        // 10 mm of rain at 5 C bring the heat to melt 0.63 mm.
        let rained = melt_mm_h(&weather(5.0, 0.0, 0.9), 10.0).0 - 0.25;
        assert!((rained - 0.6266).abs() < 1e-3, "{rained}");
        assert_eq!((refreezing_mm_h(2.0), sublimation_mm_h(&weather(-5.0, 5.0, 1.0)).min(1e-9)), (0.0, 0.0));
        let dry = sublimation_mm_h(&weather(-5.0, 6.0, 0.6));
        assert!((0.01..0.1).contains(&dry), "{dry} mm/h");
    }

    #[test]
    fn drift_begins_at_the_threshold_and_grows_as_published() {
        assert_eq!((threshold_m_s(false, 200.0), threshold_m_s(true, 200.0)), (7.7, 9.9));
        assert!(threshold_m_s(false, 450.0) > 40.0, "pressed snow stays");
        assert_eq!(saltation_kg_m_s(7.7, 7.7), 0.0);
        // The literature's thresholds are friction velocities of 0.27 to 0.69 m/s.
        assert!(
            (0.27..0.69).contains(&drift_friction_velocity_m_s(7.7))
                && (0.27..0.69).contains(&drift_friction_velocity_m_s(9.9))
        );
        let q = saltation_kg_m_s(15.0, 7.7);
        assert!((0.01..0.03).contains(&q), "{q} kg/(m s)");
        assert!(saltation_kg_m_s(7.8, 7.7) < 0.02 * q);
        assert_eq!(suspension_kg_m_s(7.7, 7.7), 0.0);
        // Far above the threshold the sum is Tabler's flux: 0.376 kg/(m s) at 20 m/s. Most of it is suspended.
        let (hops, floats) = (saltation_kg_m_s(20.0, 7.7), suspension_kg_m_s(20.0, 7.7));
        assert!(((hops + floats) / 0.376 - 1.0).abs() < 0.15 && floats > 5.0 * hops, "{hops} {floats}");
        let near = suspension_kg_m_s(8.0, 7.7);
        assert!((0.0..2.0 * saltation_kg_m_s(8.0, 7.7)).contains(&near), "{near}");
    }
}
