//! Temperature, humidity and pressure at altitudes, against the published standard atmosphere.

use welkin::weather::{Weather, derive};

#[test]
fn the_standard_day_has_its_published_levels() {
    let c = derive(&Weather { relative_humidity: 0.0, ..Weather::default() }).unwrap();
    // ICAO Doc 7488, geopotential altitudes: temperature C, pressure hPa, density kg/m^3.
    for (altitude_m, temperature_c, hpa, density) in [
        (0.0, 15.0, 1013.25, 1.225),
        (1000.0, 8.5, 898.75, 1.1116),
        (5000.0, -17.5, 540.20, 0.736_12),
        (11_000.0, -56.5, 226.32, 0.363_92),
        (15_000.0, -56.5, 120.45, 0.193_67),
    ] {
        let air = c.air_at_altitude_m(altitude_m);
        assert!((air.temperature_c - temperature_c).abs() < 1e-9, "{altitude_m}: {air:?}");
        assert!((air.pressure_hpa / hpa - 1.0).abs() < 2e-4, "{altitude_m}: {air:?}");
        assert!((air.density_kg_m3 / density - 1.0).abs() < 2e-4, "{altitude_m}: {air:?}");
        assert_eq!(air.relative_humidity, 0.0);
    }
}

#[test]
fn the_station_has_its_own_air_and_vapour_thins_out() {
    let weather =
        Weather { station_altitude_m: 1600.0, temperature_c: -12.0, relative_humidity: 0.8, ..Weather::default() };
    let c = derive(&weather).unwrap();
    let here = c.air_at_altitude_m(1600.0);
    assert!((here.temperature_c + 12.0).abs() < 1e-9 && (here.relative_humidity - 0.8).abs() < 1e-12, "{here:?}");
    assert!((here.pressure_hpa / c.air.station_pressure_hpa - 1.0).abs() < 1e-12);
    let humidity: Vec<f64> =
        (0..60).map(|i| c.air_at_altitude_m(1600.0 + f64::from(i) * 300.0).relative_humidity).collect();
    assert!(humidity.iter().all(|h| (0.0..=1.0).contains(h)) && humidity[59] < 0.1, "{humidity:?}");
}
