//! Directions of stars and planets over a place at a time.

use glam::{DMat3, DVec3};

use super::{
    catalogue::Star,
    planets::{PlanetPlace, earth_velocity, planets, sun_direction},
    settings::StarSettings,
};
use crate::{
    almanac::{
        Utc,
        celestial::{celestial_to_world, refraction_deg},
    },
    error::Result,
    scene::Place,
};

/// The heavens over a place at a time: one rotation for all stars, and the aberration, proper motion, sun and planets
/// that the rotation does not contain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Heavens {
    /// Rotation from the equator and equinox of J2000.0 to (east, north, up): precession, nutation and the Earth's
    /// rotation, or the host's own matrix.
    pub to_world: DMat3,
    /// The Earth's velocity divided by the speed of light, in the axes of J2000.0, for annual aberration. 0 with a
    /// host's own matrix.
    pub velocity: DVec3,
    /// Julian years since J2000.0, for proper motions; 0 with a host's own matrix.
    pub years: f64,
    /// Direction of the sun in the axes of J2000.0.
    pub sun: DVec3,
    /// Mercury to Uranus, whether drawn or not.
    pub planets: [PlanetPlace; 6],
}

impl Heavens {
    /// Computes the heavens over `place` at `utc`. From 1950 to 2100 directions are within 0.005 degrees for stars of
    /// the catalogue that have no proper motion, and for those whose motion the catalogue has (tested against another
    /// almanac). Most of the error is the catalogue's own.
    ///
    /// UT1 is taken as UTC. With a host's own matrix the stars have their catalogued directions, without motion and
    /// aberration. The planets and the sun then have the directions that they have among the stars at `utc`.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for a place, time or setting out of range.
    pub fn at(utc: Utc, place: &Place, settings: &StarSettings) -> Result<Self> {
        settings.validate()?;
        let (to_world, sun) = to_world_and_sun(utc, place, settings.celestial_to_world)?;
        let (velocity, years) = match settings.celestial_to_world {
            Some(_) => (DVec3::ZERO, 0.0),
            None => (earth_velocity(utc), utc.julian_centuries_tt() * 100.0),
        };
        Ok(Self { to_world, velocity, years, sun, planets: planets(utc) })
    }

    /// Apparent direction (east, north, up; unit) of a direction in J2000.0, for an observer who moves with the Earth,
    /// without refraction. Aberration is that of the Earth's orbit; that of its rotation, 0.0001 degrees, is left out.
    pub fn seen(&self, direction: DVec3) -> DVec3 {
        self.to_world * (direction + self.velocity).normalize()
    }

    /// Returns the direction to a star as [`Self::seen`] does, with the star's proper motion applied.
    pub fn star(&self, star: &Star) -> DVec3 {
        self.seen(star.direction_at(self.years))
    }
}

/// Returns the rotation from J2000.0 to (east, north, up), which is the host's own if it gives one, and the sun's
/// direction in J2000.0.
///
/// # Errors
/// [`crate::Status::InvalidArgument`] for a place or time out of range.
pub(super) fn to_world_and_sun(utc: Utc, place: &Place, hosts: Option<DMat3>) -> Result<(DMat3, DVec3)> {
    let own = celestial_to_world(utc, place)?;
    Ok((hosts.unwrap_or(own), sun_direction(utc)))
}

/// Direction (east, north, up; unit) after refraction lifts it, by Saemundsson 1986 times `density`. `density` is the
/// air's density relative to that at 1010 hPa and 10 C, 0 without air.
pub fn lifted(direction: DVec3, density: f64) -> DVec3 {
    let level = direction.x.hypot(direction.y);
    if level < 1e-6 {
        return direction;
    }
    let elevation = direction.z.atan2(level);
    let apparent = elevation + (density * refraction_deg(elevation.to_degrees(), 1010.0, 10.0)).to_radians();
    let (s, c) = apparent.sin_cos();
    DVec3::new(direction.x / level * c, direction.y / level * c, s)
}

#[cfg(test)]
mod tests {
    use super::super::catalogue::star;
    use super::*;
    use crate::almanac::celestial::direction;

    /// Rows of the almanac: number of the star, time, latitude, longitude, azimuth, elevation.
    fn almanac() -> Vec<[f64; 6]> {
        let lines = include_str!("testdata/stars.csv").lines().filter(|l| !l.starts_with('#')).skip(1);
        let row = |line: &str| {
            let mut cells = line.split(',');
            let number = cells.next().unwrap().parse().unwrap();
            let rest: Vec<f64> = cells.skip(1).map(|c| c.parse().unwrap()).collect();
            [number, rest[0], rest[1], rest[2], rest[3], rest[4]]
        };
        lines.map(row).collect()
    }

    #[test]
    fn twelve_stars_stand_where_another_almanac_has_them() {
        let (mut worst, rows) = (0.0f64, almanac());
        assert_eq!(rows.len(), 12 * 5 * 5);
        for [number, utc, latitude_deg, longitude_deg, azimuth, elevation] in rows {
            let place = Place { latitude_deg, longitude_deg, altitude_m: 0.0 };
            let heavens = Heavens::at(Utc(utc), &place, &StarSettings::default()).unwrap();
            let seen = heavens.star(star(number as u16).unwrap());
            let apart = seen.angle_between(direction(azimuth, elevation)).to_degrees();
            worst = worst.max(apart);
            assert!(apart < 0.005, "{number} at {utc} {latitude_deg}: {apart} degrees apart");
        }
        println!("worst: {worst:.5} degrees");
    }

    #[test]
    fn a_host_may_turn_the_heavens_itself() {
        let place = Place { latitude_deg: 50.0, longitude_deg: 10.0, altitude_m: 0.0 };
        let own = DMat3::from_rotation_x(0.3);
        let settings = StarSettings { celestial_to_world: Some(own), ..Default::default() };
        let heavens = Heavens::at(Utc(1.7e9), &place, &settings).unwrap();
        let sirius = star(2491).unwrap();
        assert!((heavens.star(sirius) - own * sirius.direction).length() < 1e-12);
        let bad = StarSettings { airglow: -1.0, ..Default::default() };
        assert!(Heavens::at(Utc(0.0), &place, &bad).unwrap_err().to_string().contains("airglow"));
        assert!(Heavens::at(Utc(f64::NAN), &place, &settings).unwrap_err().to_string().contains("utc"));
    }

    #[test]
    fn refraction_raises_elevations_and_keeps_azimuths() {
        for elevation in [-3.0, 0.0, 10.0, 45.0, 90.0] {
            let d = direction(123.0, elevation);
            let up = lifted(d, 1.0);
            let lift = up.z.asin().to_degrees() - d.z.asin().to_degrees();
            let want = refraction_deg(elevation, 1010.0, 10.0);
            assert!((lift - want).abs() < 1e-6 && (up.length() - 1.0).abs() < 1e-12, "{elevation}: {lift}");
            assert!((up.y.atan2(up.x) - d.y.atan2(d.x)).abs() < 1e-9 || elevation == 90.0);
            assert!((lifted(d, 0.0) - d).length() < 1e-12);
        }
    }
}
