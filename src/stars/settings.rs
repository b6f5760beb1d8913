//! Settings of the stars.

use std::sync::Arc;

use glam::DMat3;

use super::catalogue::{Star, catalogue};
use crate::error::{Error, Result, check_range};

/// Largest number of stars in a host's own list.
pub const MAX_STARS: usize = 1_000_000;

/// Settings of the stars. The default draws the Bright Star Catalogue and the planets as seen from the Earth.
#[derive(Clone, Debug)]
pub struct StarSettings {
    /// The host's own stars in place of the catalogue's, at most 1 000 000. `None`, the default, uses the catalogue.
    pub stars: Option<Arc<[Star]>>,
    /// Whether Mercury to Uranus are drawn. Default true.
    pub planets: bool,
    /// Rotation from the equator and equinox of J2000.0 to (east, north, up), in place of the one computed for the
    /// Earth; orthonormal to 1e-6. With it, stars have neither aberration nor proper motion. `None` by default.
    pub celestial_to_world: Option<DMat3>,
    /// Strength of the airglow, [0, 10]: 1 (default) near the minimum of solar activity, 1.7 at the maximum.
    pub airglow: f64,
}

impl Default for StarSettings {
    fn default() -> Self {
        Self { stars: None, planets: true, celestial_to_world: None, airglow: 1.0 }
    }
}

impl StarSettings {
    /// Checks that every field is within its range.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field.
    pub fn validate(&self) -> Result<()> {
        check_range("airglow", self.airglow, 0.0, 10.0, "")?;
        if let Some(m) = &self.celestial_to_world {
            let off = *m * m.transpose() - DMat3::IDENTITY;
            let is_rotation = off.to_cols_array().iter().all(|v| v.abs() < 1e-6) && m.determinant() > 0.0;
            if !is_rotation {
                return Err(Error::range("celestial_to_world", "a rotation, to 1e-6", m));
            }
        }
        let Some(stars) = &self.stars else { return Ok(()) };
        if stars.len() > MAX_STARS {
            return Err(Error::range("stars", &format!("at most {MAX_STARS} stars"), stars.len()));
        }
        stars.iter().enumerate().try_for_each(|(i, star)| star.validate(&format!("stars[{i}]")))
    }

    /// Stars to draw: the host's own or the catalogue.
    pub fn stars(&self) -> &[Star] {
        self.stars.as_deref().unwrap_or_else(|| catalogue())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_out_of_range_is_named_with_its_range() {
        let good = StarSettings::default();
        assert!(good.validate().is_ok() && good.stars().len() == 9096);
        let refused = |settings: StarSettings, words: &str| {
            let message = settings.validate().unwrap_err().to_string();
            assert!(message.starts_with(words), "{message}");
        };
        refused(StarSettings { airglow: f64::NAN, ..good.clone() }, "airglow must be in [0, 10]");
        for matrix in [DMat3::from_diagonal(glam::DVec3::new(1.0, 1.0, -1.0)), DMat3::IDENTITY * 2.0, DMat3::NAN] {
            let settings = StarSettings { celestial_to_world: Some(matrix), ..good.clone() };
            refused(settings, "celestial_to_world must be a rotation");
        }
        let bad = Star { magnitude: 99.0, ..Star::new(0.0, 0.0, 1.0, 5000.0) };
        let stars: Arc<[Star]> = vec![Star::new(1.0, 2.0, 3.0, 4000.0), bad].into();
        refused(StarSettings { stars: Some(stars), ..good.clone() }, "stars[1].magnitude must be in [-30, 30] mag");
        let many: Arc<[Star]> = vec![bad; MAX_STARS + 1].into();
        refused(StarSettings { stars: Some(many), ..good }, "stars must be at most 1000000 stars");
    }
}
