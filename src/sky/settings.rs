//! Settings of the sky: the model, and the numbers of nodes, cells and texels.

use crate::error::{Error, Result};

/// Model of the sky. All models share the same look-up functions. With [`SkyModel::BruteForce`] these functions march
/// along the ray of every pixel. Between the other models only the tables differ.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum SkyModel {
    /// Light scattered once, from a table over (altitude, view angle, sun angle); the phase functions are applied
    /// afterwards (Elek 2008). The table is computed for views in the sun's azimuth, and used for all azimuths. By day
    /// the light scattered once is within 3 %; at sunset, away from the sun, it is wrong by a factor of 2 to 3, and by
    /// more from space. Light scattered more than once is missing (20 to 50 %).
    Table3d,
    /// Light scattered more than once is taken as equal in all directions (Hillaire 2020). The error is -3 to -6 % near
    /// the horizon and +3 % at the zenith. The tables take a tenth of the default's time to build.
    IsotropicTables,
    /// Light scattered more than once is computed order by order, and depends on direction. The default.
    #[default]
    Directional,
    /// The default model, but without an observer's tables: every pixel marches along its ray with
    /// [`SkySettings::march_cells`] nodes, and looks up the light scattered more than once at each of them. The tables
    /// are measured against it.
    BruteForce,
}

impl SkyModel {
    /// All models, with the names that programs use for them.
    pub const NAMES: [(&'static str, SkyModel); 4] = [
        ("table3d", SkyModel::Table3d),
        ("isotropic", SkyModel::IsotropicTables),
        ("directional", SkyModel::Directional),
        ("brute-force", SkyModel::BruteForce),
    ];

    /// Returns the model with this name.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] listing the known names.
    pub fn from_name(name: &str) -> Result<Self> {
        let known = Self::NAMES.map(|(n, _)| n).join(", ");
        let found = Self::NAMES.iter().find(|(n, _)| *n == name);
        found.map(|(_, m)| *m).ok_or_else(|| Error::range("model", &format!("one of {known}"), name))
    }

    /// Whether light scattered more than once depends on direction.
    pub(crate) fn is_directional(self) -> bool {
        matches!(self, Self::Directional | Self::BruteForce)
    }

    /// Name of the model.
    pub fn name(self) -> &'static str {
        Self::NAMES.iter().find(|(_, m)| *m == self).map_or("", |(n, _)| n)
    }
}

/// Sizes and counts of the sky's tables. The defaults have the errors stated in the documentation of [`crate::sky`].
/// With all numbers at their minimum the median error of the default model is 5 % in clear air, and 6 % with ozone and
/// in haze of 30 km visibility (95th percentile 26 to 48 %, in twilight and in the sun's glow). In haze of 9 km it is
/// 15 %, because the light of high orders is missed; with 16 orders it is 9 %. `tests/sky_gpu.rs` checks these limits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SkySettings {
    /// Model of the sky, default [`SkyModel::Directional`].
    pub model: SkyModel,
    /// Number of wavelengths that the tables are built for, a multiple of 3 in `[3, 15]`. With the default, 3, they are
    /// the planet's own wavelengths. More wavelengths are spread over the visible range, and combined into three values
    /// at the planet's wavelengths that give the same colour (models [`SkyModel::Directional`] and
    /// [`SkyModel::IsotropicTables`]). Colours are then right where three wavelengths are too few, but the time of a
    /// build grows in proportion to their number. See [`crate::sky`] for errors and costs.
    pub wavelengths: u32,
    /// Number of scattering orders that are computed one by one, `[3, 16]`, default 5. Higher orders are added as a
    /// geometric series.
    pub orders: u32,
    /// Number of sun angles in the planet's tables, `[16, 128]`, default 64.
    pub suns: u32,
    /// Number of altitudes in the planet's tables, `[8, 64]`, default 22.
    pub altitudes: u32,
    /// Number of zenith angles in the table of light that the air scatters again, `[4, 32]`, default 17.
    pub zeniths: u32,
    /// Number of azimuths on `[0, pi]` in the table of light that the air scatters again, `[3, 24]`, default 10.
    pub azimuths: u32,
    /// Number of zenith angles on each side of the horizon in the sum over directions, `[3, 16]`, default 8.
    pub rule_zeniths: u32,
    /// Number of azimuths on `[0, pi]` in the sum over directions, `[3, 24]`, default 12.
    pub rule_azimuths: u32,
    /// Number of panels (of 4 nodes) in a ray's march while the planet's tables are built, `[1, 16]`, default 3.
    pub build_panels: u32,
    /// Number of azimuths on `[0, pi]` in an observer's sky, `[8, 256]`, default 40.
    pub sky_azimuths: u32,
    /// Number of rows above the horizon in an observer's sky, `[8, 256]`, default 80.
    pub sky_above: u32,
    /// Number of rows below the horizon in an observer's sky, `[8, 256]`, default 40.
    pub sky_below: u32,
    /// Number of panels (of 4 nodes) in a march for an observer's sky, `[1, 32]`, default 5.
    pub sky_panels: u32,
    /// Number of azimuths on `[0, pi]` in the table of the air in front of objects, `[4, 64]`, default 24.
    pub air_azimuths: u32,
    /// Number of rows above the horizon in the table of the air, `[4, 128]`, default 20.
    pub air_above: u32,
    /// Number of rows below the horizon in the table of the air, `[4, 128]`, default 20.
    pub air_below: u32,
    /// Number of distances in the table of the air, `[4, 64]`, default 16.
    pub air_slices: u32,
    /// Number of panels (of 4 nodes) in a march to one distance of the table of the air, `[1, 16]`, default 2.
    pub air_panels: u32,
    /// Number of nodes in a pixel's march ([`SkyModel::BruteForce`]), rounded up to a multiple of 4, `[1, 4096]`,
    /// default 64.
    pub march_cells: u32,
}

/// Largest number of wavelengths, for which `sky/observer.wgsl` has room.
pub(crate) const MOST_WAVELENGTHS: u32 = 15;

/// Number of tiles in the table of light: one of irradiance, and six of coefficients of spherical harmonics.
pub(crate) const LIGHT_TILES: u32 = 7;

/// Largest width of a table, texels, which every device supports.
const WIDEST: u32 = 2048;

impl Default for SkySettings {
    fn default() -> Self {
        Self {
            model: SkyModel::default(),
            wavelengths: 3,
            orders: 5,
            suns: 64,
            altitudes: 22,
            zeniths: 17,
            azimuths: 10,
            rule_zeniths: 8,
            rule_azimuths: 12,
            build_panels: 3,
            sky_azimuths: 40,
            sky_above: 80,
            sky_below: 40,
            sky_panels: 5,
            air_azimuths: 24,
            air_above: 20,
            air_below: 20,
            air_slices: 16,
            air_panels: 2,
            march_cells: 64,
        }
    }
}

impl SkySettings {
    /// The default settings with another model.
    pub fn with_model(model: SkyModel) -> Self {
        Self { model, ..Self::default() }
    }

    /// Returns settings for a draft: small tables over the planet, which are shown until the full tables are built.
    /// With the default settings a draft is a twentieth of the work. Except with [`SkyModel::Table3d`], light scattered
    /// once keeps its resolution, because the observer's tables march it.
    pub(crate) fn draft(&self) -> Self {
        Self {
            orders: self.orders.min(4),
            suns: self.suns.min(32),
            altitudes: self.altitudes.min(14),
            zeniths: self.zeniths.min(9),
            azimuths: self.azimuths.min(6),
            rule_zeniths: self.rule_zeniths.min(5),
            // With 9, the width of the table of radiances is no power of two. The same holds for the full tables.
            // llvmpipe compiles a pass again if a width becomes a power of two.
            rule_azimuths: self.rule_azimuths.min(9),
            build_panels: self.build_panels.min(2),
            ..*self
        }
    }

    /// Number of triples of wavelengths.
    pub(crate) fn layers(&self) -> u32 {
        self.wavelengths / 3
    }

    /// Size of the table of the air, texels; its slices lie side by side.
    pub(crate) fn air_size(&self) -> (u32, u32) {
        (self.air_azimuths * self.air_slices, self.air_above + self.air_below)
    }

    /// Size of an observer's sky, texels. It is transposed: rows along x, azimuths along y.
    pub(crate) fn sky_size(&self) -> (u32, u32) {
        (self.sky_above + self.sky_below, self.sky_azimuths)
    }

    /// First texel of the sky in an observer's tables. The sky lies beside the table of the air, or below this table if
    /// the texture would be too wide.
    pub(crate) fn sky_corner(&self) -> (u32, u32) {
        let (air, sky) = (self.air_size(), self.sky_size());
        if air.0 + sky.0 <= WIDEST { (air.0, 0) } else { (0, air.1) }
    }

    /// Size of an observer's tables (air and sky together), texels.
    pub(crate) fn observer_size(&self) -> (u32, u32) {
        let (corner, air, sky) = (self.sky_corner(), self.air_size(), self.sky_size());
        (air.0.max(corner.0 + sky.0), air.1.max(corner.1 + sky.1))
    }

    /// All numbers of these settings, each as (name, value, least value, largest value).
    pub(crate) fn numbers(&self) -> [(&'static str, u32, u32, u32); 19] {
        [
            ("wavelengths", self.wavelengths, 3, MOST_WAVELENGTHS),
            ("orders", self.orders, 3, 16),
            ("suns", self.suns, 16, 128),
            ("altitudes", self.altitudes, 8, 64),
            ("zeniths", self.zeniths, 4, 32),
            ("azimuths", self.azimuths, 3, 24),
            ("rule_zeniths", self.rule_zeniths, 3, 16),
            ("rule_azimuths", self.rule_azimuths, 3, 24),
            ("build_panels", self.build_panels, 1, 16),
            ("sky_azimuths", self.sky_azimuths, 8, 256),
            ("sky_above", self.sky_above, 8, 256),
            ("sky_below", self.sky_below, 8, 256),
            ("sky_panels", self.sky_panels, 1, 32),
            ("air_azimuths", self.air_azimuths, 4, 64),
            ("air_above", self.air_above, 4, 128),
            ("air_below", self.air_below, 4, 128),
            ("air_slices", self.air_slices, 4, 64),
            ("air_panels", self.air_panels, 1, 16),
            ("march_cells", self.march_cells, 1, 4096),
        ]
    }

    /// Checks every number against its range, the wavelengths against the model, and the widths and heights of the
    /// tables against 2048 texels.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field and what is accepted.
    pub fn check(&self) -> Result<()> {
        for (name, value, lo, hi) in self.numbers() {
            if !(lo..=hi).contains(&value) {
                return Err(Error::range(name, &format!("in [{lo}, {hi}]"), value));
            }
        }
        if !self.wavelengths.is_multiple_of(3) {
            return Err(Error::range("wavelengths", "a multiple of 3", self.wavelengths));
        }
        if self.layers() > 1 && !matches!(self.model, SkyModel::Directional | SkyModel::IsotropicTables) {
            let accepted = format!("3 with the model {}", self.model.name());
            return Err(Error::range("wavelengths", &accepted, self.wavelengths));
        }
        for (name, times, (a, b)) in [
            ("suns", "rule_azimuths", (self.suns, self.rule_azimuths)),
            ("suns", "azimuths", (self.suns, self.azimuths.max(LIGHT_TILES))),
            ("altitudes", "2 rule_zeniths", (self.altitudes, 2 * self.rule_zeniths)),
            ("altitudes", "zeniths x wavelengths/3", (self.altitudes * self.layers(), self.zeniths)),
            ("air_azimuths", "air_slices", (self.air_azimuths, self.air_slices)),
        ] {
            if a * b > WIDEST {
                let rest = format!("x {times} must be at most {WIDEST} texels, got {}", a * b);
                return Err(Error::invalid(name, rest));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_and_written_and_errors_state_the_range() {
        for (name, model) in SkyModel::NAMES {
            assert_eq!(SkyModel::from_name(name).unwrap(), model);
            assert_eq!(model.name(), name);
        }
        assert!(SkyModel::from_name("best").unwrap_err().to_string().contains("directional"));
        assert!(SkySettings::default().check().is_ok());
        let e = SkySettings { sky_panels: 0, ..Default::default() }.check().unwrap_err();
        assert!(e.to_string().contains("sky_panels") && e.to_string().contains("[1, 32]"), "{}", e);
        let uneven = SkySettings { wavelengths: 10, ..Default::default() };
        assert!(uneven.check().unwrap_err().to_string().contains("wavelengths must be a multiple of 3"));
        let marched = SkySettings { wavelengths: 9, ..SkySettings::with_model(SkyModel::BruteForce) };
        assert!(marched.check().unwrap_err().to_string().contains("wavelengths must be 3 with the model brute-force"));
        assert!(SkySettings { wavelengths: 15, ..Default::default() }.check().is_ok());
        let wide = SkySettings { suns: 128, azimuths: 24, ..Default::default() };
        assert!(wide.check().unwrap_err().to_string().contains("suns x azimuths"));
    }

    #[test]
    fn the_sky_and_air_of_an_observer_do_not_overlap_and_fit_into_the_widest_atlas() {
        let most =
            SkySettings { air_azimuths: 64, air_slices: 32, sky_above: 256, sky_below: 256, ..Default::default() };
        assert!(most.check().is_ok());
        for s in [SkySettings::default(), most] {
            let (corner, air, sky, all) = (s.sky_corner(), s.air_size(), s.sky_size(), s.observer_size());
            assert!(corner.0 >= air.0 || corner.1 >= air.1, "{corner:?} {air:?}");
            assert!(corner.0 + sky.0 <= all.0 && corner.1 + sky.1 <= all.1 && all.0 <= WIDEST && all.1 <= WIDEST);
        }
        let (width, height) = SkySettings::default().observer_size();
        assert_eq!(width * height, 40 * 120 + 24 * 16 * 40, "nothing is left empty by default");
    }
}
