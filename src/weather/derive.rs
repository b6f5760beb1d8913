//! Derivation of conditions from a weather: every coupling between parts of the weather is a published law. The host
//! can replace some of the laws by values ([`Overrides`]).

use super::conditions::{CloudLightOverride, Conditions, clear_between};
use super::model::Weather;
use super::overrides::Overrides;
use super::{air, cloud_slabs, particles, precipitation, surface};
use crate::error::Result;

/// Derives the conditions that follow from a weather by the laws alone. Pure and deterministic; any thread.
///
/// # Errors
/// As [`Weather::validate`].
pub fn derive(weather: &Weather) -> Result<Conditions> {
    derive_with(weather, &Overrides::default())
}

/// Derives conditions as [`derive()`], with the host's values in place of some laws.
///
/// The reported visibility V is total, so each component counts once. The extinction ln 20 / V is shared by air
/// (Bodhaine et al. 1999), precipitation (drop and flake spectra, limited to what air leaves of the extinction) and
/// particles, which take the remainder.
///
/// # Errors
/// As [`Weather::validate`] and [`Overrides::validate`].
pub fn derive_with(weather: &Weather, overrides: &Overrides) -> Result<Conditions> {
    weather.validate()?;
    overrides.validate()?;
    let (w, o) = (weather, overrides);
    let mut air = air::air(w);
    if let Some(ratio) = o.rayleigh_density_ratio {
        air.rayleigh_extinction_per_m *= ratio / air.rayleigh_density_ratio;
        air.rayleigh_density_ratio = ratio;
    }
    air.rayleigh_scale_height_m = o.rayleigh_scale_height_m.unwrap_or(air.rayleigh_scale_height_m);
    let mut falling = precipitation::falling(&w.precipitation);
    let left = (super::LN_20 / w.visibility_m - air.rayleigh_extinction_per_m).max(0.0);
    if let Some(whole) = o.precipitation_extinction_per_m {
        falling = falling.with_extinction(whole);
    } else if falling.extinction_per_m() > left {
        falling = falling.with_extinction(left);
    }
    let shares = particles::share_extinction(w, &air, falling.extinction_per_m(), o);
    let aerosol = particles::aerosol_layer(w, shares.aerosol_per_m, o.humidity_growth);
    let fog = particles::ground_layer(w, shares.ground_per_m, &aerosol);
    let counted = if shares.ground_counts { fog.extinction_per_m } else { 0.0 };
    let wind = surface::wind_profile(w);
    let mut ground = surface::surface_cover(&w.surface, w.temperature_c, w.relative_humidity, &falling);
    ground.wetness = o.wetness.unwrap_or(ground.wetness);
    let clouds = cloud_slabs::cloud_slabs(w, &wind, o.rain_needs_cloud.unwrap_or(true));
    Ok(Conditions {
        extinction_per_m: air.rayleigh_extinction_per_m + shares.aerosol_per_m + counted + falling.extinction_per_m(),
        air,
        aerosol,
        fog,
        precipitation: falling,
        clear_sky: clear_between(&clouds),
        clouds,
        cloud_light: o.cloud_light.map_or(CloudLightOverride::default(), |(direct, diffuse)| CloudLightOverride {
            weight: 1.0,
            direct,
            diffuse,
        }),
        wind,
        sea: surface::sea_state(w, &wind, o.wave_height_m),
        surface: ground,
        ozone_du: w.ozone_du,
    })
}

#[cfg(test)]
mod tests {
    use super::super::*;

    fn sum(c: &Conditions) -> f64 {
        c.air.rayleigh_extinction_per_m + c.aerosol.extinction_per_m + c.precipitation.extinction_per_m()
    }

    #[test]
    fn reported_visibility_is_kept_whatever_is_in_it() {
        let kinds = [FogKind::None, FogKind::Mist, FogKind::Fog, FogKind::Freezing];
        for fog in kinds {
            for aerosol in AerosolKind::ALL {
                for rate in [0.0, 0.5, 4.0, 60.0] {
                    for v in [30.0, 150.0, 900.0, 4000.0, 9000.0, 40_000.0, 120_000.0] {
                        let w = Weather {
                            visibility_m: v,
                            fog: Fog::of(fog),
                            aerosol: Aerosol::of(*aerosol),
                            precipitation: Precipitation::of(PrecipitationKind::Rain, rate),
                            ..Weather::default()
                        };
                        let c = derive(&w).unwrap();
                        assert!((c.visibility_m() / v - 1.0).abs() < 1e-9, "{fog:?} {aerosol:?} {rate} {v}");
                        let parts = sum(&c) + c.fog.extinction_per_m;
                        assert!((parts / c.extinction_per_m - 1.0).abs() < 1e-9);
                    }
                }
            }
        }
    }

    #[test]
    fn beyond_pure_air_nothing_is_left_for_particles() {
        let c = derive(&Weather { visibility_m: 1e6, ..Weather::default() }).unwrap();
        assert_eq!((c.aerosol.extinction_per_m, c.fog.extinction_per_m), (0.0, 0.0));
        assert!((c.visibility_m() - 260_725.0).abs() < 100.0, "{}", c.visibility_m());
    }

    #[test]
    fn haze_fills_the_mixed_layer_and_mist_keeps_low() {
        let with = |aerosol, fog, v| {
            let w = Weather { visibility_m: v, aerosol: Aerosol::of(aerosol), fog: Fog::of(fog), ..Weather::default() };
            derive(&w).unwrap()
        };
        let haze = with(AerosolKind::Haze, FogKind::None, 4500.0);
        assert_eq!(haze.fog.extinction_per_m, 0.0);
        let thick = with(AerosolKind::Haze, FogKind::None, 1500.0);
        let column = (thick.aerosol.extinction_per_m + thick.fog.extinction_per_m) * thick.aerosol.scale_height_m;
        assert!(thick.aerosol.extinction_per_m * thick.aerosol.scale_height_m <= 1.0 && column > 2.0, "{column}");
        assert!((thick.visibility_m() / 1500.0 - 1.0).abs() < 1e-9 && thick.fog.top_m == 2400.0);
        let steps = (200..6000).map(|v| with(AerosolKind::Haze, FogKind::None, f64::from(v)).aerosol.extinction_per_m);
        let steps: Vec<f64> = steps.collect();
        assert!(steps.windows(2).all(|s| (s[1] - s[0]).abs() < 5e-6), "a small change of the sight makes no jump");
        let mist = with(AerosolKind::Continental, FogKind::Mist, 1800.0);
        assert!((mist.aerosol.extinction_per_m + mist.air.rayleigh_extinction_per_m - LN_20 / 5000.0).abs() < 1e-12);
        assert!(mist.fog.extinction_per_m > 0.0 && mist.fog.top_m == 300.0);
        let fog = with(AerosolKind::Continental, FogKind::Fog, 150.0);
        assert!(fog.fog.extinction_per_m > 0.95 * LN_20 / 150.0 && (100.0..=200.0).contains(&fog.fog.top_m));
        let unnamed = with(AerosolKind::Continental, FogKind::None, 150.0);
        assert!(unnamed.fog.extinction_per_m > 0.9 * LN_20 / 150.0, "thick clean air is fog, named or not");
    }

    #[test]
    fn shallow_fog_is_clear_above_two_metres() {
        let w = Weather { visibility_m: 12_000.0, fog: Fog::of(FogKind::Shallow), ..Weather::default() };
        let c = derive(&w).unwrap();
        assert!((c.visibility_m() - 12_000.0).abs() < 1e-6);
        assert_eq!(c.fog.top_m, 2.0);
        assert!((sum(&c) + c.fog.extinction_per_m - LN_20 / 200.0).abs() < 1e-12, "200 m inside");
    }

    #[test]
    fn rain_brings_its_cloud_and_wets_the_ground() {
        let w = Weather {
            precipitation: Precipitation::of(PrecipitationKind::Rain, 6.0),
            visibility_m: 4000.0,
            ..Weather::default()
        };
        let c = derive(&w).unwrap();
        assert_eq!(c.cloud_cover(), 1.0);
        assert!(c.cloud_light(0.7, 0.2).direct < 1e-6 && c.surface.wetness > 0.9);
        let without = derive_with(&w, &Overrides { rain_needs_cloud: Some(false), ..Overrides::default() }).unwrap();
        assert_eq!(without.cloud_cover(), 0.0);
        let thin = CloudLayer { water_g_m3: Some(0.01), ..CloudLayer::of(CloudKind::Stratus, 1.0, 500.0) };
        let c = derive(&Weather { clouds: vec![thin], ..w }).unwrap();
        let water = c.clouds[0].optical_depth * 7e-6 * 1000.0 / 1.5;
        assert!((water - water_path_for_rate_kg_m2(6.0)).abs() < 1e-9, "{water} kg/m^2");
    }

    #[test]
    fn every_override_replaces_its_law() {
        let rainy = Weather {
            visibility_m: 3000.0,
            precipitation: Precipitation::of(PrecipitationKind::Rain, 3.0),
            fog: Fog::of(FogKind::Mist),
            ..Weather::default()
        };
        let o = Overrides {
            aerosol_extinction_per_m: Some(1e-5),
            fog_extinction_per_m: Some(2e-5),
            precipitation_extinction_per_m: Some(3e-5),
            humidity_growth: Some(1.0),
            rayleigh_density_ratio: Some(0.5),
            rayleigh_scale_height_m: Some(7000.0),
            cloud_light: Some((0.3, 0.4)),
            wave_height_m: Some(1.5),
            wetness: Some(0.2),
            ..Overrides::default()
        };
        let c = derive_with(&rainy, &o).unwrap();
        assert_eq!(c.aerosol.extinction_per_m, 1e-5);
        assert_eq!(c.fog.extinction_per_m, 2e-5);
        assert_eq!(c.precipitation.extinction_per_m(), 3e-5);
        assert!((c.aerosol.single_scattering_albedo - 0.925).abs() < 1e-12);
        assert_eq!((c.air.rayleigh_density_ratio, c.air.rayleigh_scale_height_m), (0.5, 7000.0));
        assert_eq!((c.sea.significant_wave_height_m, c.surface.wetness), (1.5, 0.2));
        assert_eq!((c.cloud_light(0.5, 0.1).direct, c.cloud_light(0.5, 0.1).diffuse), (0.3, 0.4));
        let clearer = Overrides { visibility_above_fog_m: Some(20_000.0), ..Overrides::default() };
        assert!(derive_with(&rainy, &clearer).unwrap().aerosol.extinction_per_m < LN_20 / 20_000.0);
    }

    #[test]
    fn overrides_are_refused_by_name() {
        let e = derive_with(&Weather::default(), &Overrides { wetness: Some(f64::NAN), ..Overrides::default() })
            .unwrap_err();
        assert!(e.to_string().contains("overrides.wetness"), "{}", e);
        assert!(derive(&Weather { visibility_m: f64::NAN, ..Weather::default() }).is_err());
    }

    #[test]
    fn blowing_snow_lies_low_and_drifting_snow_lower() {
        let lofted =
            |kind, v| derive(&Weather { visibility_m: v, lofted: Lofted::of(kind), ..Weather::default() }).unwrap();
        let blowing = lofted(LoftedKind::BlowingSnow, 300.0);
        assert!(blowing.fog.top_m == 50.0 && blowing.fog.asymmetry == 0.89);
        assert!((blowing.visibility_m() - 300.0).abs() < 1e-6);
        let drifting = lofted(LoftedKind::DriftingSnow, 20_000.0);
        assert!(drifting.fog.top_m < 2.0 && (drifting.visibility_m() - 20_000.0).abs() < 1e-6);
        let dust = lofted(LoftedKind::BlowingDust, 400.0);
        assert!(dust.fog.extinction_per_m > 7e-3 && dust.fog.single_scattering_albedo < 0.9);
        assert!(dust.fog.top_m == 3000.0 && dust.aerosol.absorption_angstrom_exponent > 2.0);
    }
}
