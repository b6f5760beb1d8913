//! Air at a height: temperature, humidity and pressure above a station.
//!
//! The temperature falls by 6.5 K/km up to the tropopause, 11 km above sea level, and is constant above it; the
//! pressure follows in hydrostatic equilibrium from that at the station (ICAO standard atmosphere, Doc 7488). The
//! density of water vapour falls by a factor e every 2 km (ITU-R P.835), up to saturation over water.

use super::conditions::Conditions;
use super::model::saturation_pressure_hpa;

/// Lapse rate below the tropopause, K/m.
const LAPSE_K_PER_M: f64 = 0.0065;
/// Altitude of the tropopause above sea level, m.
const TROPOPAUSE_M: f64 = 11_000.0;
/// Gravity divided by the gas constant of dry air, K/m.
const K_PER_M: f64 = 9.80665 / 287.053;
/// Height over which the density of water vapour falls by a factor e, m.
const VAPOUR_SCALE_M: f64 = 2000.0;
/// Absolute temperature of 0 degrees Celsius, K.
const ZERO_C_K: f64 = 273.15;

/// Air at a place and height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AirAtHeight {
    /// Temperature, degrees Celsius.
    pub temperature_c: f64,
    /// Relative humidity over water, 0 to 1.
    pub relative_humidity: f64,
    /// Pressure, hPa.
    pub pressure_hpa: f64,
    /// Density of the air, taken as dry, kg/m^3.
    pub density_kg_m3: f64,
}

impl Conditions {
    /// Returns the air at an altitude above sea level, m. Temperature falls by 6.5 K/km up to 11 km, pressure follows
    /// (ICAO Doc 7488), and the density of vapour falls by a factor e every 2 km (ITU-R P.835). The same laws give the
    /// air down to 1 km below the station. A lower altitude gets the air at 1 km below the station.
    pub fn air_at_altitude_m(&self, altitude_m: f64) -> AirAtHeight {
        let station_m = self.air.station_altitude_m;
        let altitude_m = altitude_m.max(station_m - 1000.0);
        let station_k = self.air.temperature_c + ZERO_C_K;
        // The limit of 100 K keeps the temperature above absolute zero in any weather.
        let kelvin = |a: f64| (station_k - LAPSE_K_PER_M * (a.min(TROPOPAUSE_M) - station_m)).max(100.0);
        let (here_k, bend_m) = (kelvin(altitude_m), altitude_m.min(TROPOPAUSE_M.max(station_m)));
        let bend_k = kelvin(bend_m);
        let below = libm::pow(bend_k / station_k, K_PER_M / LAPSE_K_PER_M);
        let above = libm::exp(-K_PER_M * (altitude_m - bend_m) / bend_k);
        let pressure_hpa = self.air.station_pressure_hpa * below * above;
        // Vapour pressure is proportional to density times temperature.
        let thinner = libm::exp(-(altitude_m - station_m) / VAPOUR_SCALE_M);
        let vapour_hpa =
            self.air.relative_humidity * saturation_pressure_hpa(self.air.temperature_c) * thinner * here_k / station_k;
        let temperature_c = here_k - ZERO_C_K;
        AirAtHeight {
            temperature_c,
            relative_humidity: (vapour_hpa / saturation_pressure_hpa(temperature_c)).min(1.0),
            pressure_hpa,
            density_kg_m3: pressure_hpa * 100.0 / (287.053 * here_k),
        }
    }
}
