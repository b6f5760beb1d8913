//! Validation of a `Weather`: an error names the field and its range.

use super::kinds::PrecipitationKind;
use super::model::{Aerosol, CloudLayer, Fog, MAX_CLOUD_LAYERS, Precipitation, Sea, Weather, Wind};
use crate::error::{Error, Result, check_range};

/// Applies [`check_range`] to a value that may be absent.
fn check_some(name: &str, value: Option<f64>, lo: f64, hi: f64, unit: &str) -> Result<()> {
    value.map_or(Ok(()), |v| check_range(name, v, lo, hi, unit))
}

impl Weather {
    /// Checks every field against the range its documentation states.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] with the first offending field's name, range and value. NaN and infinity are
    /// outside every range.
    pub fn validate(&self) -> Result<()> {
        check_range("visibility_m", self.visibility_m, 1.0, 1e6, "m")?;
        check_some("vertical_visibility_m", self.vertical_visibility_m, 0.0, 10_000.0, "m")?;
        check_some("runway_visual_range_m", self.runway_visual_range_m, 1.0, 10_000.0, "m")?;
        check_range("temperature_c", self.temperature_c, -90.0, 60.0, "C")?;
        check_range("relative_humidity", self.relative_humidity, 0.0, 1.0, "")?;
        check_range("pressure_hpa", self.pressure_hpa, 800.0, 1100.0, "hPa")?;
        check_range("station_altitude_m", self.station_altitude_m, -500.0, 9000.0, "m")?;
        check_range("ozone_du", self.ozone_du, 0.0, 700.0, "DU")?;
        self.aerosol.validate()?;
        self.fog.validate()?;
        if self.clouds.len() > MAX_CLOUD_LAYERS {
            let accepted = format!("at most {MAX_CLOUD_LAYERS} layers");
            return Err(Error::range("clouds", &accepted, self.clouds.len()));
        }
        for (i, layer) in self.clouds.iter().enumerate() {
            layer.validate(i)?;
        }
        self.precipitation.validate()?;
        self.wind.validate()?;
        self.sea.validate()?;
        check_range("surface.snow_depth_m", self.surface.snow_depth_m, 0.0, 20.0, "m")?;
        check_some("surface.roughness_length_m", self.surface.roughness_length_m, 1e-5, 5.0, "m")?;
        check_some("lofted.top_m", self.lofted.top_m, 0.1, 5000.0, "m")
    }
}

impl Aerosol {
    fn validate(&self) -> Result<()> {
        check_some("aerosol.angstrom_exponent", self.angstrom_exponent, -1.0, 4.0, "")?;
        check_some("aerosol.single_scattering_albedo", self.single_scattering_albedo, 0.0, 1.0, "")?;
        check_some("aerosol.asymmetry", self.asymmetry, -0.99, 0.99, "")?;
        check_some("aerosol.scale_height_m", self.scale_height_m, 10.0, 20_000.0, "m")
    }
}

impl Fog {
    fn validate(&self) -> Result<()> {
        check_some("fog.top_m", self.top_m, 0.1, 2000.0, "m")?;
        check_some("fog.coverage", self.coverage, 0.0, 1.0, "")?;
        check_some("fog.visibility_inside_m", self.visibility_inside_m, 1.0, 10_000.0, "m")
    }
}

impl CloudLayer {
    fn validate(&self, index: usize) -> Result<()> {
        let name = |field: &str| format!("clouds[{index}].{field}");
        check_range(&name("cover"), self.cover, 0.0, 1.0, "")?;
        check_range(&name("base_m"), self.base_m, 0.0, 20_000.0, "m")?;
        check_some(&name("thickness_m"), self.thickness_m, 1.0, 20_000.0, "m")?;
        check_some(&name("water_g_m3"), self.water_g_m3, 0.0, 10.0, "g/m^3")?;
        check_some(&name("droplet_radius_um"), self.droplet_radius_um, 1.0, 500.0, "um")?;
        check_some(&name("spacing_m"), self.spacing_m, 50.0, 200_000.0, "m")?;
        check_some(&name("life_s"), self.life_s, 60.0, 1e6, "s")?;
        let Some(wind) = self.wind else { return Ok(()) };
        check_range(&name("wind.speed_m_s"), wind.speed_m_s, 0.0, 150.0, "m/s")?;
        check_range(&name("wind.from_deg"), wind.from_deg, 0.0, 360.0, "degrees")
    }
}

impl Precipitation {
    fn validate(&self) -> Result<()> {
        check_range("precipitation.rate_mm_h", self.rate_mm_h, 0.0, 500.0, "mm/h")?;
        check_some("precipitation.liquid_fraction", self.liquid_fraction, 0.0, 1.0, "")?;
        if self.kind == PrecipitationKind::None && self.rate_mm_h > 0.0 {
            return Err(Error::range("precipitation.rate_mm_h", "0 where precipitation.kind is none", self.rate_mm_h));
        }
        Ok(())
    }
}

impl Wind {
    fn validate(&self) -> Result<()> {
        check_range("wind.speed_m_s", self.speed_m_s, 0.0, 120.0, "m/s")?;
        check_range("wind.from_deg", self.from_deg, 0.0, 360.0, "degrees")?;
        check_some("wind.gust_m_s", self.gust_m_s, self.speed_m_s, 150.0, "m/s")?;
        if let Some((from, to)) = self.variable_deg {
            check_range("wind.variable_deg.0", from, 0.0, 360.0, "degrees")?;
            check_range("wind.variable_deg.1", to, 0.0, 360.0, "degrees")?;
        }
        check_some("wind.turbulence_intensity", self.turbulence_intensity, 0.0, 1.0, "")
    }
}

impl Sea {
    fn validate(&self) -> Result<()> {
        check_some("sea.significant_wave_height_m", self.significant_wave_height_m, 0.0, 30.0, "m")?;
        check_some("sea.state", self.state.map(f64::from), 0.0, 9.0, "")?;
        check_some("sea.temperature_c", self.temperature_c, -3.0, 45.0, "C")?;
        let Some(swell) = self.swell else { return Ok(()) };
        check_range("sea.swell.height_m", swell.height_m, 0.0, 20.0, "m")?;
        check_range("sea.swell.period_s", swell.period_s, 1.0, 30.0, "s")?;
        check_range("sea.swell.from_deg", swell.from_deg, 0.0, 360.0, "degrees")
    }
}

#[cfg(test)]
mod tests {
    use super::super::model::{LayerWind, Swell};
    use super::*;
    use crate::error::Status;

    /// One way to make a weather invalid, and the name that the error must give.
    type Spoil = (&'static str, fn(&mut Weather, f64));

    /// Every float field, with a function that writes the invalid value into it.
    const FIELDS: &[Spoil] = &[
        ("visibility_m", |w, v| w.visibility_m = v),
        ("vertical_visibility_m", |w, v| w.vertical_visibility_m = Some(v)),
        ("runway_visual_range_m", |w, v| w.runway_visual_range_m = Some(v)),
        ("temperature_c", |w, v| w.temperature_c = v),
        ("relative_humidity", |w, v| w.relative_humidity = v),
        ("pressure_hpa", |w, v| w.pressure_hpa = v),
        ("station_altitude_m", |w, v| w.station_altitude_m = v),
        ("ozone_du", |w, v| w.ozone_du = v),
        ("aerosol.angstrom_exponent", |w, v| w.aerosol.angstrom_exponent = Some(v)),
        ("aerosol.single_scattering_albedo", |w, v| w.aerosol.single_scattering_albedo = Some(v)),
        ("aerosol.asymmetry", |w, v| w.aerosol.asymmetry = Some(v)),
        ("aerosol.scale_height_m", |w, v| w.aerosol.scale_height_m = Some(v)),
        ("fog.top_m", |w, v| w.fog.top_m = Some(v)),
        ("fog.coverage", |w, v| w.fog.coverage = Some(v)),
        ("fog.visibility_inside_m", |w, v| w.fog.visibility_inside_m = Some(v)),
        ("clouds[1].cover", |w, v| w.clouds[1].cover = v),
        ("clouds[1].base_m", |w, v| w.clouds[1].base_m = v),
        ("clouds[0].thickness_m", |w, v| w.clouds[0].thickness_m = Some(v)),
        ("clouds[0].water_g_m3", |w, v| w.clouds[0].water_g_m3 = Some(v)),
        ("clouds[0].droplet_radius_um", |w, v| w.clouds[0].droplet_radius_um = Some(v)),
        ("clouds[0].spacing_m", |w, v| w.clouds[0].spacing_m = Some(v)),
        ("clouds[1].life_s", |w, v| w.clouds[1].life_s = Some(v)),
        ("clouds[0].wind.speed_m_s", |w, v| w.clouds[0].wind = Some(LayerWind { speed_m_s: v, from_deg: 10.0 })),
        ("clouds[0].wind.from_deg", |w, v| w.clouds[0].wind = Some(LayerWind { speed_m_s: 10.0, from_deg: v })),
        ("precipitation.rate_mm_h", |w, v| w.precipitation = Precipitation::of(PrecipitationKind::Rain, v)),
        ("precipitation.liquid_fraction", |w, v| w.precipitation.liquid_fraction = Some(v)),
        ("wind.speed_m_s", |w, v| w.wind.speed_m_s = v),
        ("wind.from_deg", |w, v| w.wind.from_deg = v),
        ("wind.gust_m_s", |w, v| w.wind.gust_m_s = Some(v)),
        ("wind.variable_deg.0", |w, v| w.wind.variable_deg = Some((v, 10.0))),
        ("wind.variable_deg.1", |w, v| w.wind.variable_deg = Some((10.0, v))),
        ("wind.turbulence_intensity", |w, v| w.wind.turbulence_intensity = Some(v)),
        ("sea.significant_wave_height_m", |w, v| w.sea.significant_wave_height_m = Some(v)),
        ("sea.temperature_c", |w, v| w.sea.temperature_c = Some(v)),
        ("sea.swell.height_m", |w, v| w.sea.swell = Some(Swell { height_m: v, period_s: 8.0, from_deg: 0.0 })),
        ("sea.swell.period_s", |w, v| w.sea.swell = Some(Swell { height_m: 1.0, period_s: v, from_deg: 0.0 })),
        ("sea.swell.from_deg", |w, v| w.sea.swell = Some(Swell { height_m: 1.0, period_s: 8.0, from_deg: v })),
        ("surface.snow_depth_m", |w, v| w.surface.snow_depth_m = v),
        ("surface.roughness_length_m", |w, v| w.surface.roughness_length_m = Some(v)),
        ("lofted.top_m", |w, v| w.lofted.top_m = Some(v)),
    ];

    fn two_layers() -> Weather {
        Weather { clouds: vec![CloudLayer::new(0.5, 900.0), CloudLayer::new(1.0, 2000.0)], ..Weather::default() }
    }

    #[test]
    fn each_field_is_refused_by_its_name() {
        two_layers().validate().unwrap();
        for (name, spoil) in FIELDS {
            for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1e9, 1e9] {
                let mut w = two_layers();
                spoil(&mut w, bad);
                let e = w.validate().expect_err(name);
                assert_eq!(e.status, Status::InvalidArgument);
                assert!(e.to_string().starts_with(&format!("{name} must be in [")), "{name} {bad}: {}", e);
            }
        }
    }

    #[test]
    fn couplings_of_fields_are_refused() {
        let mut w = two_layers();
        w.wind = Wind { gust_m_s: Some(9.0), ..Wind::of(10.0, 0.0) };
        assert!(w.validate().unwrap_err().to_string().contains("wind.gust_m_s"));
        w = two_layers();
        w.precipitation.rate_mm_h = 1.0;
        assert!(w.validate().unwrap_err().to_string().contains("precipitation.kind is none"));
        w = two_layers();
        w.clouds = vec![CloudLayer::new(0.1, 100.0); 17];
        assert!(w.validate().unwrap_err().to_string().contains("at most 16"));
        w = two_layers();
        w.sea.state = Some(10);
        assert!(w.validate().unwrap_err().to_string().contains("sea.state"));
    }
}
