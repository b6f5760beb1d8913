//! Overrides: the host's own values in place of the laws that derive conditions.

use crate::error::{Result, check_range};

/// The host's own values in place of laws. `None` leaves the law in force; default all `None`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Overrides {
    /// Aerosol extinction at 550 nm and station height, 1/m, in place of the share that the visibility gives the
    /// aerosol. Range [0, 10].
    pub aerosol_extinction_per_m: Option<f64>,
    /// Extinction inside the ground layer, 1/m, in place of the share that the visibility gives the layer. Range
    /// [0, 10].
    pub fog_extinction_per_m: Option<f64>,
    /// Extinction of the precipitation, 1/m, in place of that computed from the spectra of drops and flakes. Range
    /// [0, 10].
    pub precipitation_extinction_per_m: Option<f64>,
    /// Visibility of the air above mist or fog, m. Range [100, 1e6]; by law 10 km above fog or blowing snow, else 5 km.
    pub visibility_above_fog_m: Option<f64>,
    /// Ratio of the particles' extinction to that at a humidity of 80 %, in place of Haenel's law. It sets how far
    /// water changes the optical properties of the particles; their extinction follows from the visibility. Range
    /// [0.1, 20]; 1 switches the growth off.
    pub humidity_growth: Option<f64>,
    /// Ratio of the air density at sea level to the standard atmosphere's. Range [0, 10].
    pub rayleigh_density_ratio: Option<f64>,
    /// Scale height of the air, m. Range [100, 50 000].
    pub rayleigh_scale_height_m: Option<f64>,
    /// Whether rain adds water to clouds, and a cloud to a clear sky; by law it does.
    pub rain_needs_cloud: Option<bool>,
    /// Share of the direct sunlight that passes the clouds, and diffuse light below them as a share of the light above
    /// them, in place of the slabs' light. Range [0, 1] each.
    pub cloud_light: Option<(f64, f64)>,
    /// Significant wave height, m, in place of that from the wind or the sea state. Range [0, 30].
    pub wave_height_m: Option<f64>,
    /// Wetness of the ground, in place of that from the precipitation. Range [0, 1].
    pub wetness: Option<f64>,
}

impl Overrides {
    /// Checks every value that is set.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] with the name and range of the first value that is out of range or not
    /// finite.
    pub fn validate(&self) -> Result<()> {
        let fields = [
            ("overrides.aerosol_extinction_per_m", self.aerosol_extinction_per_m, 0.0, 10.0, "1/m"),
            ("overrides.fog_extinction_per_m", self.fog_extinction_per_m, 0.0, 10.0, "1/m"),
            ("overrides.precipitation_extinction_per_m", self.precipitation_extinction_per_m, 0.0, 10.0, "1/m"),
            ("overrides.visibility_above_fog_m", self.visibility_above_fog_m, 100.0, 1e6, "m"),
            ("overrides.humidity_growth", self.humidity_growth, 0.1, 20.0, ""),
            ("overrides.rayleigh_density_ratio", self.rayleigh_density_ratio, 0.0, 10.0, ""),
            ("overrides.rayleigh_scale_height_m", self.rayleigh_scale_height_m, 100.0, 50_000.0, "m"),
            ("overrides.cloud_light.0", self.cloud_light.map(|l| l.0), 0.0, 1.0, ""),
            ("overrides.cloud_light.1", self.cloud_light.map(|l| l.1), 0.0, 1.0, ""),
            ("overrides.wave_height_m", self.wave_height_m, 0.0, 30.0, "m"),
            ("overrides.wetness", self.wetness, 0.0, 1.0, ""),
        ];
        fields.iter().try_for_each(|&(name, v, lo, hi, unit)| v.map_or(Ok(()), |v| check_range(name, v, lo, hi, unit)))
    }
}
