//! Stars of the Bright Star Catalogue, and the proper motions of the few that move noticeably.

use std::sync::OnceLock;

use glam::DVec3;

use crate::{
    almanac::celestial::equatorial_direction,
    error::{Error, Result, check_range},
};

/// A star of a catalogue.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Star {
    /// Unit vector in the equator and equinox of J2000.0 at the epoch J2000.0 (x to the equinox, z to the north pole).
    pub direction: DVec3,
    /// Proper motion, rad a Julian year, perpendicular to `direction`, at most 0.001. Default 0.
    pub motion: DVec3,
    /// Visual magnitude (Johnson V) above the air, [-30, 30].
    pub magnitude: f64,
    /// Temperature of the black body with the star's colour, K, [1000, 100000].
    /// [`super::light::temperature_of_color_index`] gives it for a B-V.
    pub temperature_k: f64,
}

impl Star {
    /// Creates a star from its right ascension and declination, degrees, in the equator, equinox and epoch of J2000.0.
    /// It has no proper motion.
    pub fn new(right_ascension_deg: f64, declination_deg: f64, magnitude: f64, temperature_k: f64) -> Self {
        let direction = equatorial_direction(right_ascension_deg, declination_deg);
        Self { direction, motion: DVec3::ZERO, magnitude, temperature_k }
    }

    /// Returns the star with this proper motion, arc seconds a Julian year: in right ascension (times the cosine of the
    /// declination) and in declination.
    #[must_use]
    pub fn moving(self, right_ascension_as: f64, declination_as: f64) -> Self {
        let east = DVec3::Z.cross(self.direction).normalize_or(DVec3::Y);
        let north = self.direction.cross(east);
        let rad = |arc_seconds: f64| (arc_seconds / 3600.0).to_radians();
        Self { motion: east * rad(right_ascension_as) + north * rad(declination_as), ..self }
    }

    /// Unit vector at `years` Julian years after J2000.0. The star moves in a straight line. Its distance is taken as
    /// constant, which for the nearest stars is an error of 0.001 degrees a century.
    pub fn direction_at(&self, years: f64) -> DVec3 {
        (self.direction + self.motion * years).normalize()
    }

    /// Checks that every field is within its range. `name` is the star's name in the error.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field and its range.
    pub fn validate(&self, name: &str) -> Result<()> {
        if (self.direction.length() - 1.0).abs() > 1e-3 || !self.direction.is_finite() {
            return Err(Error::range(&format!("{name}.direction"), "a unit vector", self.direction));
        }
        if !self.motion.is_finite() || self.motion.length() > 1e-3 {
            return Err(Error::range(&format!("{name}.motion"), "at most 0.001 rad a year long", self.motion));
        }
        check_range(&format!("{name}.magnitude"), self.magnitude, -30.0, 30.0, "mag")?;
        check_range(&format!("{name}.temperature_k"), self.temperature_k, 1e3, 1e5, "K")
    }
}

/// Records of the catalogue, one for each number (HR) from 1 on, little-endian: right ascension and declination in 1e-5
/// degrees (u32, i32), magnitude in 0.01 (i16), temperature in K (u16). The temperature is 0 for the 14 numbers that
/// are no stars. `catalogue.py` writes the file.
static PACKED: &[u8] = include_bytes!("catalogue.bin");
/// Size of a record, bytes.
const RECORD: usize = 12;

/// Proper motions: number (HR), motion in right ascension (times the cosine of the declination) and in declination, arc
/// seconds a year. The list has the brighter stars that move by more than 0.5" a year, and the stars with names that
/// move by more than 0.2" a year. Source: Hipparcos (ESA 1997, van Leeuwen 2007), rounded to 0.01" or finer; 0.01" a
/// year is 0.0003 degrees in a century.
const MOTIONS: [(u16, f64, f64); 49] = [
    (15, 0.14, -0.16),
    (21, 0.52, -0.18),
    (77, 1.71, 1.16),
    (98, 2.22, 0.32),
    (99, 0.23, -0.35),
    (188, 0.23, 0.03),
    (219, 1.09, -0.56),
    (321, 3.42, -1.60),
    (337, 0.18, -0.11),
    (509, -1.72, 0.85),
    (617, 0.19, -0.15),
    (937, 1.26, -0.09),
    (1008, 3.04, 0.73),
    (1084, -0.98, 0.02),
    (1325, -2.24, -3.42),
    (1708, 0.08, -0.43),
    (2491, -0.55, -1.22),
    (2891, -0.21, -0.15),
    (2943, -0.72, -1.04),
    (2990, -0.63, -0.05),
    (3982, -0.25, 0.00),
    (4057, 0.31, -0.15),
    (4534, -0.50, -0.11),
    (4540, 0.74, -0.27),
    (4550, 4.00, -5.81),
    (4763, 0.03, -0.26),
    (4785, -0.70, 0.29),
    (4932, -0.28, 0.02),
    (4983, -0.80, 0.88),
    (5019, -1.07, -1.06),
    (5288, -0.52, -0.52),
    (5340, -1.09, -2.00),
    (5459, -3.68, 0.48),
    (5460, -3.60, 0.95),
    (5933, 0.31, -1.28),
    (6212, -0.46, 0.34),
    (6556, 0.11, -0.22),
    (6623, -0.29, -0.75),
    (6752, 0.12, -0.96),
    (7001, 0.20, 0.29),
    (7462, 0.60, -1.74),
    (7557, 0.54, 0.39),
    (7602, 0.05, -0.48),
    (7665, 1.21, -1.13),
    (8085, 4.17, 3.27),
    (8086, 4.11, 3.145),
    (8387, 3.96, -2.54),
    (8728, 0.33, -0.16),
    (8775, 0.19, 0.14),
];

/// The unpacked catalogue, the brightest star first.
struct Catalogue {
    stars: Vec<Star>,
    /// Number (HR) of each star.
    numbers: Vec<u16>,
}

fn loaded() -> &'static Catalogue {
    static LOADED: OnceLock<Catalogue> = OnceLock::new();
    LOADED.get_or_init(|| {
        let mut numbered: Vec<(u16, Star)> = (1..)
            .zip(PACKED.chunks_exact(RECORD))
            .filter_map(|(number, r)| Some((number, unpacked(number, r)?)))
            .collect();
        numbered.sort_by(|a, b| a.1.magnitude.total_cmp(&b.1.magnitude));
        let (numbers, stars) = numbered.into_iter().unzip();
        Catalogue { stars, numbers }
    })
}

fn unpacked(number: u16, r: &[u8]) -> Option<Star> {
    let word = |at: usize| [r[at], r[at + 1], r[at + 2], r[at + 3]];
    let temperature = u16::from_le_bytes([r[10], r[11]]);
    let right_ascension = f64::from(u32::from_le_bytes(word(0))) * 1e-5;
    let declination = f64::from(i32::from_le_bytes(word(4))) * 1e-5;
    let magnitude = f64::from(i16::from_le_bytes([r[8], r[9]])) * 0.01;
    let star = Star::new(right_ascension, declination, magnitude, f64::from(temperature));
    let moving = MOTIONS.iter().find(|m| m.0 == number);
    (temperature > 0).then(|| moving.map_or(star, |m| star.moving(m.1, m.2)))
}

/// The 9096 stars of the Yale Bright Star Catalogue, 5th revised edition (Hoffleit and Warren 1991), the brightest
/// first. It has all stars down to magnitude 6.5, and some to 7.96. Unpacked at the first call. Any thread.
pub fn catalogue() -> &'static [Star] {
    &loaded().stars
}

/// Star of the catalogue with a number (HR); 2491 is Sirius. `None` for numbers that are no stars.
pub fn star(number: u16) -> Option<&'static Star> {
    let catalogue = loaded();
    let at = catalogue.numbers.iter().position(|n| *n == number)?;
    catalogue.stars.get(at)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_catalogue_has_its_stars_the_brightest_first() {
        let stars = catalogue();
        assert_eq!(stars.len(), 9096);
        assert!(stars.is_sorted_by_key(|s| s.magnitude));
        assert_eq!(stars[0], *star(2491).unwrap(), "Sirius");
        assert!((stars[0].magnitude + 1.46).abs() < 1e-9);
        assert!(stars.iter().all(|s| s.validate("stars").is_ok()));
        assert!(star(92).is_none() && star(0).is_none() && star(9111).is_none(), "HR 92 was a nova");
        // "About 9000 stars brighter than 6.5 have a combined magnitude of almost exactly -5": within a tenth.
        let sum: f64 = stars.iter().map(|s| 10f64.powf(-0.4 * s.magnitude)).sum();
        assert!((-2.5 * sum.log10() + 5.0).abs() < 0.15, "{}", -2.5 * sum.log10());
        assert!(MOTIONS.iter().all(|m| star(m.0).is_some() && m.1.hypot(m.2) > 0.19), "of stars that move");
    }

    #[test]
    fn motion_goes_east_and_north() {
        let still = Star::new(30.0, 40.0, 1.0, 5000.0);
        let (east, north) = (still.moving(3600.0, 0.0), still.moving(0.0, 3600.0));
        let (e, n) = (east.direction_at(0.1), north.direction_at(0.1));
        let right_ascension = e.y.atan2(e.x).to_degrees();
        assert!((right_ascension - 30.0 - 0.1 / 40f64.to_radians().cos()).abs() < 1e-4, "{right_ascension}");
        assert!((n.z.asin().to_degrees() - 40.1).abs() < 1e-6);
    }

    #[test]
    fn bad_stars_are_refused_by_name() {
        let good = Star::new(10.0, 20.0, 3.0, 6000.0);
        let refused = |star: Star, field: &str| {
            let e = star.validate("stars[3]").unwrap_err();
            assert!(e.to_string().starts_with(&format!("stars[3].{field} must be")), "{e}");
        };
        refused(Star { direction: DVec3::new(1.0, 1.0, 0.0), ..good }, "direction");
        refused(Star { motion: DVec3::splat(f64::NAN), ..good }, "motion");
        refused(Star { magnitude: f64::INFINITY, ..good }, "magnitude");
        refused(Star { temperature_k: 0.0, ..good }, "temperature_k");
    }
}
