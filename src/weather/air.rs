//! Clear air: Rayleigh scattering from pressure and temperature.

use super::conditions::Air;
use super::model::Weather;

/// Rayleigh scattering of air at 550 nm, 15 C and 1013.25 hPa, 1/m (Bodhaine et al. 1999).
pub const RAYLEIGH_550_PER_M: f64 = 11.49e-6;
/// Temperature of the standard atmosphere at sea level, K (ISO 2533).
const STANDARD_TEMPERATURE_K: f64 = 288.15;
/// Lapse rate of the standard atmosphere, K/m.
const STANDARD_LAPSE_K_PER_M: f64 = 0.0065;
/// Pressure of the standard atmosphere at sea level, hPa.
const STANDARD_PRESSURE_HPA: f64 = 1013.25;
/// Gas constant of dry air divided by gravity, m/K: scale height of an isothermal atmosphere per kelvin.
const SCALE_HEIGHT_M_PER_K: f64 = 287.053 / 9.80665;

/// Returns the pressure at the station from QNH, hPa: p = QNH (1 - 0.0065 h / 288.15)^5.25588, the definition of QNH
/// (ICAO standard atmosphere, Doc 7488).
pub fn station_pressure_hpa(qnh_hpa: f64, altitude_m: f64) -> f64 {
    qnh_hpa * libm::pow(1.0 - STANDARD_LAPSE_K_PER_M * altitude_m / STANDARD_TEMPERATURE_K, 5.255_88)
}

/// Returns the ratio of the air density to the standard's, from pressure (hPa) and temperature (C): the ideal gas law.
pub fn density_ratio(pressure_hpa: f64, temperature_c: f64) -> f64 {
    pressure_hpa / STANDARD_PRESSURE_HPA * STANDARD_TEMPERATURE_K / (temperature_c + 273.15)
}

/// Returns the scale height of air of this temperature (C), m: R T / g. With [`density_ratio`] at the same level, the
/// mass of the air above that level depends on the pressure alone, as in hydrostatic equilibrium.
pub fn scale_height_m(temperature_c: f64) -> f64 {
    SCALE_HEIGHT_M_PER_K * (temperature_c + 273.15)
}

/// Returns the clear air of a weather. The Rayleigh density ratio and scale height are those at sea level, to which the
/// temperature is reduced along the standard lapse rate.
pub(super) fn air(w: &Weather) -> Air {
    let station_pressure = station_pressure_hpa(w.pressure_hpa, w.station_altitude_m);
    let sea_level_c = w.temperature_c + STANDARD_LAPSE_K_PER_M * w.station_altitude_m;
    Air {
        temperature_c: w.temperature_c,
        relative_humidity: w.relative_humidity,
        pressure_hpa: w.pressure_hpa,
        station_pressure_hpa: station_pressure,
        station_altitude_m: w.station_altitude_m,
        rayleigh_density_ratio: density_ratio(w.pressure_hpa, sea_level_c),
        rayleigh_scale_height_m: scale_height_m(sea_level_c),
        rayleigh_extinction_per_m: RAYLEIGH_550_PER_M * density_ratio(station_pressure, w.temperature_c),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn standard_atmosphere_gives_its_published_levels() {
        // ICAO Doc 7488, geopotential heights: 1000 m 898.75 hPa, 5000 m 540.20 hPa.
        assert!((station_pressure_hpa(1013.25, 1000.0) - 898.75).abs() < 0.02);
        assert!((station_pressure_hpa(1013.25, 5000.0) - 540.20).abs() < 0.02);
        assert!((density_ratio(1013.25, 15.0) - 1.0).abs() < 1e-12);
        assert!((scale_height_m(15.0) - 8434.6).abs() < 1.0);
    }

    #[test]
    fn column_follows_pressure_and_not_temperature() {
        let column = |t: f64, p: f64| {
            let a = air(&Weather { temperature_c: t, pressure_hpa: p, ..Weather::default() });
            a.rayleigh_density_ratio * a.rayleigh_scale_height_m
        };
        assert!((column(-40.0, 1013.25) / column(40.0, 1013.25) - 1.0).abs() < 1e-12);
        assert!((column(15.0, 960.0) / column(15.0, 1013.25) - 960.0 / 1013.25).abs() < 1e-12);
        // Bodhaine's optical depth at 550 nm is 0.0971 with this column.
        assert!((column(15.0, 1013.25) * RAYLEIGH_550_PER_M - 0.0971).abs() < 3e-4);
    }
}
