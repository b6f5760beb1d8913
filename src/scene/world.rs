//! World frames: mapping from the host's coordinates to up, north, altitude and place.

use glam::{DMat3, DVec3};

use super::turn::turn_z;
use crate::error::{Error, Result, check_range};

/// Semi-major axis of the WGS 84 ellipsoid, m (NIMA TR8350.2, 2000).
const WGS84_A: f64 = 6_378_137.0;
/// First eccentricity squared of the WGS 84 ellipsoid (NIMA TR8350.2, 2000).
const WGS84_E2: f64 = 6.694_379_990_141_4e-3;

/// Largest magnitude of [`WorldFrame::geoid_height_m`], m. The height of mean sea level above the ellipsoid lies
/// between -107 m south of India and 86 m at New Guinea (EGM2008, Pavlis et al. 2012). The rest is a margin for other
/// reference surfaces.
const GEOID_M: f64 = 120.0;
/// Lowest and highest altitude of a place, m.
const ALTITUDES_M: [f64; 2] = [-1e4, 1e9];
/// Tolerance of the altitude range, m: an altitude outside the range by at most this counts as its nearer end. At 1e9 m
/// coordinates are rounded to 1e-7 m, and values computed from them to somewhat more.
const ROUNDING_M: f64 = 1e-3;
/// Farthest position from the world's origin, m.
const FARTHEST_M: f64 = 1e12;

/// Figure of a planet's mean surface: an ellipsoid of revolution about the polar axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Figure {
    /// Equatorial radius, m.
    equatorial_m: f64,
    /// First eccentricity squared.
    eccentricity2: f64,
}

impl Default for Figure {
    fn default() -> Self {
        Self::WGS84
    }
}

impl Figure {
    /// Figure of the Earth, WGS 84.
    pub const WGS84: Self = Self { equatorial_m: WGS84_A, eccentricity2: WGS84_E2 };

    /// Returns the figure of a planet whose ground has this radius, m: WGS 84 if the radius is between the polar and
    /// the equatorial radius of the Earth, otherwise a sphere.
    pub fn of_radius(radius_m: f64) -> Self {
        let polar_m = WGS84_A * (1.0 - WGS84_E2).sqrt();
        if (polar_m..=WGS84_A).contains(&radius_m) {
            return Self::WGS84;
        }
        Self { equatorial_m: radius_m, eccentricity2: 0.0 }
    }

    /// Returns planet-centred coordinates of a place, m, with its altitude above the figure. The z axis points to the
    /// north pole, the x axis to longitude 0.
    pub fn centred(&self, place: &Place) -> DVec3 {
        let (sp, cp) = libm::sincos(place.latitude_deg.to_radians());
        let (sl, cl) = libm::sincos(place.longitude_deg.to_radians());
        let n = self.equatorial_m / (1.0 - self.eccentricity2 * sp * sp).sqrt();
        let r = (n + place.altitude_m) * cp;
        DVec3::new(r * cl, r * sl, (n * (1.0 - self.eccentricity2) + place.altitude_m) * sp)
    }

    /// Computes the place of planet-centred coordinates, with its altitude above the figure. Eight steps of the
    /// iteration tan B = (z + e^2 N(B) sin B) / rho give the latitude B, where rho is the distance from the axis and N
    /// the radius of curvature in the prime vertical. On the Earth the result inverts [`Self::centred`] within 1e-6 m,
    /// at 1000 km to 1e9 m from the centre.
    pub fn place(&self, p: DVec3) -> Place {
        let (a, e2) = (self.equatorial_m, self.eccentricity2);
        let rho = libm::hypot(p.x, p.y);
        let longitude = libm::atan2(p.y, p.x);
        let mut latitude = libm::atan2(p.z, rho * (1.0 - e2));
        for _ in 0..8 {
            let s = libm::sin(latitude);
            let n = a / (1.0 - e2 * s * s).sqrt();
            latitude = libm::atan2(p.z + e2 * n * s, rho);
        }
        let (s, c) = libm::sincos(latitude);
        let n = a / (1.0 - e2 * s * s).sqrt();
        let altitude_m = rho * c + p.z * s - a * a / n;
        Place { latitude_deg: latitude.to_degrees(), longitude_deg: longitude.to_degrees(), altitude_m }
    }
}

/// A place on a planet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Geodetic latitude, degrees north, [-90, 90].
    pub latitude_deg: f64,
    /// Longitude, degrees east, [-360, 360].
    pub longitude_deg: f64,
    /// Height above mean sea level, m, [-1e4, 1e9].
    pub altitude_m: f64,
}

impl Place {
    /// Checks that every field is in range; the error names the one that is not.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`].
    pub fn validate(&self) -> Result<()> {
        check_range("latitude_deg", self.latitude_deg, -90.0, 90.0, "deg")?;
        check_range("longitude_deg", self.longitude_deg, -360.0, 360.0, "deg")?;
        check_range("altitude_m", self.altitude_m, ALTITUDES_M[0], ALTITUDES_M[1], "m")
    }

    /// Returns Earth-centred coordinates on WGS 84, m, with mean sea level at the ellipsoid
    /// ([`WorldFrame::geoid_height_m`] 0).
    pub fn to_ecef(&self) -> DVec3 {
        Figure::WGS84.centred(self)
    }

    /// Computes the place of Earth-centred coordinates on WGS 84, with its altitude above the ellipsoid
    /// ([`Figure::place`]).
    pub fn from_ecef(p: DVec3) -> Self {
        Figure::WGS84.place(p)
    }

    /// Returns the rotation from planet-centred axes to (east, north, up) at this place.
    pub(crate) fn ecef_to_enu(&self) -> DMat3 {
        let (sp, cp) = libm::sincos(self.latitude_deg.to_radians());
        let (sl, cl) = libm::sincos(self.longitude_deg.to_radians());
        let east = DVec3::new(-sl, cl, 0.0);
        let north = DVec3::new(-sp * cl, -sp * sl, cp);
        let up = DVec3::new(cp * cl, cp * sl, sp);
        DMat3::from_cols(east, north, up).transpose()
    }
}

/// Directions of the host's axes, in flat and tangent worlds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Axes {
    /// x east, y north, z up.
    #[default]
    ZUp,
    /// x east, y up, z south: the usual axes of OpenGL worlds.
    YUp,
}

/// Relation of the host's world to the planet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum WorldKind {
    /// A plane: up is the same everywhere, and altitude is the up coordinate plus the origin's altitude. Latitude and
    /// longitude are the origin's everywhere.
    #[default]
    Flat,
    /// A tangent plane: axes east, north and up at the origin's place, with the curved planet below.
    Tangent,
    /// Earth-centred, Earth-fixed (WGS 84), or centred on another planet ([`WorldFrame::figure`]). The axes are not
    /// used. The origin is used for the sunlight on simulated ground, and as the zero point of the map on which clouds,
    /// patches of fog, waves and lightning have their places. Altitudes count from mean sea level, which lies
    /// [`WorldFrame::geoid_height_m`] above the ellipsoid.
    Ecef,
}

/// The host's world frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorldFrame {
    /// Flat, tangent or Earth-centred.
    pub kind: WorldKind,
    /// Axes of flat and tangent worlds.
    pub axes: Axes,
    /// Place of the host's (0, 0, 0). Default 50 degrees north, 10 degrees east, at sea level.
    pub origin: Place,
    /// Bearing of the world's north axis, degrees clockwise from true north, [-360, 360]. Default 0. Used only by flat
    /// and tangent worlds.
    pub grid_bearing_deg: f64,
    /// Height of mean sea level above the WGS 84 ellipsoid where the simulation takes place, m, [-120, 120]: 47.8 m at
    /// Frankfurt, -30 m at New York. It varies by some metres over 100 km, but this one value holds for all of the
    /// host's world. Used only by Earth-centred worlds, whose coordinates refer to the ellipsoid. Default 0.
    pub geoid_height_m: f64,
    /// Figure of the planet's mean surface in tangent and planet-centred worlds. Default [`Figure::WGS84`]. A context
    /// sets it to that of its planet ([`Figure::of_radius`]).
    pub figure: Figure,
}

impl Default for WorldFrame {
    fn default() -> Self {
        let origin = Place { latitude_deg: 50.0, longitude_deg: 10.0, altitude_m: 0.0 };
        Self {
            kind: WorldKind::Flat,
            axes: Axes::ZUp,
            origin,
            grid_bearing_deg: 0.0,
            geoid_height_m: 0.0,
            figure: Figure::WGS84,
        }
    }
}

/// Place of a point of the host's world on its planet, and the axes there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalFrame {
    /// Latitude, longitude and altitude of the point.
    pub place: Place,
    /// Rotation from the host's axes to (east, north, up) at the point.
    pub world_to_enu: DMat3,
}

impl WorldFrame {
    /// Checks that every field is in range; the error names the one that is not.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`].
    pub fn validate(&self) -> Result<()> {
        self.origin.validate()?;
        check_range("grid_bearing_deg", self.grid_bearing_deg, -360.0, 360.0, "deg")?;
        check_range("geoid_height_m", self.geoid_height_m, -GEOID_M, GEOID_M, "m")
    }

    /// Returns up, north, altitude and place at `position` of the host's world. `name` names the position in an error.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming `name` if the position is not finite, farther than 1e12 m from the
    /// world's origin, or not at an altitude in \[-1e4, 1e9\] m, with a tolerance of 1 mm.
    pub fn place_at(&self, name: &str, position: DVec3) -> Result<LocalFrame> {
        if !(position.is_finite() && position.length() <= FARTHEST_M) {
            return Err(Error::range(name, "finite and within 1e12 m of the world's origin", position));
        }
        let mut local = self.frame_at(position);
        let [lowest, highest] = ALTITUDES_M;
        let altitude = local.place.altitude_m;
        if !(lowest - ROUNDING_M..=highest + ROUNDING_M).contains(&altitude) {
            let accepted = format!("at an altitude in [{lowest}, {highest}] m above the sea");
            return Err(Error::range(name, &accepted, format!("{altitude} m at {position}")));
        }
        local.place.altitude_m = altitude.clamp(lowest, highest);
        Ok(local)
    }

    /// Returns up, north, altitude and place at `position` of the host's world, without checking it.
    pub fn frame_at(&self, position: DVec3) -> LocalFrame {
        match self.kind {
            WorldKind::Flat => {
                let to_enu = self.axes_to_enu();
                let mut place = self.origin;
                place.altitude_m += (to_enu * position).z;
                LocalFrame { place, world_to_enu: to_enu }
            }
            WorldKind::Tangent => {
                let to_origin = self.axes_to_enu();
                let origin_rows = self.origin.ecef_to_enu();
                let centred = self.figure.centred(&self.origin) + origin_rows.transpose() * (to_origin * position);
                let place = self.figure.place(centred);
                LocalFrame { place, world_to_enu: place.ecef_to_enu() * origin_rows.transpose() * to_origin }
            }
            WorldKind::Ecef => {
                let mut place = self.figure.place(position);
                place.altitude_m -= self.geoid_height_m;
                LocalFrame { place, world_to_enu: place.ecef_to_enu() }
            }
        }
    }

    /// Returns the position in the host's world of a place on the planet: the inverse of [`WorldFrame::frame_at`]. The
    /// world must be tangent or Earth-centred.
    pub(crate) fn position_of(&self, place: &Place) -> DVec3 {
        match self.kind {
            WorldKind::Ecef => {
                self.figure.centred(&Place { altitude_m: place.altitude_m + self.geoid_height_m, ..*place })
            }
            _ => {
                let away = self.figure.centred(place) - self.figure.centred(&self.origin);
                let from_origin = self.origin.ecef_to_enu() * away;
                self.axes_to_enu().transpose() * from_origin
            }
        }
    }

    /// Returns the rotation from the host's axes to (east, north, up), with the grid bearing.
    fn axes_to_enu(&self) -> DMat3 {
        let axes = match self.axes {
            Axes::ZUp => DMat3::IDENTITY,
            Axes::YUp => DMat3::from_cols(DVec3::X, DVec3::Z, -DVec3::Y),
        };
        // If the grid's north points east of true north, vectors turn clockwise.
        turn_z(-self.grid_bearing_deg.to_radians()) * axes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ecef_round_trip_from_ground_to_space() {
        for lat in [-90.0, -45.0, 0.0, 36.6, 89.9] {
            for alt in [-400.0, 0.0, 9000.0, 2e5, 1e7] {
                let p = Place { latitude_deg: lat, longitude_deg: -84.2, altitude_m: alt };
                let q = Place::from_ecef(p.to_ecef());
                assert!((q.altitude_m - alt).abs() < 1e-6 * (1.0 + alt.abs() * 1e-6), "{p:?} {q:?}");
                assert!((q.latitude_deg - lat).abs() < 1e-10);
            }
        }
        // Greenwich on the equator lies one semi-major axis from the centre.
        let p = Place { latitude_deg: 0.0, longitude_deg: 0.0, altitude_m: 0.0 };
        assert_eq!(p.to_ecef(), DVec3::new(WGS84_A, 0.0, 0.0));
    }

    #[test]
    fn tangent_world_curves_away_and_flat_does_not() {
        let mut w = WorldFrame { kind: WorldKind::Tangent, ..Default::default() };
        let far = DVec3::new(0.0, 50e3, 0.0);
        let drop = w.frame_at(far).place.altitude_m;
        assert!((drop - 50e3f64.powi(2) / (2.0 * 6.372e6)).abs() < 2.0, "{drop}");
        let tilt = (w.frame_at(far).world_to_enu * DVec3::Z).y;
        assert!((tilt + 50e3 / 6.37e6).abs() < 2e-4, "up at the origin leans back south of the far up: {tilt}");
        w.kind = WorldKind::Flat;
        assert_eq!(w.frame_at(far).place.altitude_m, 0.0);
    }

    #[test]
    fn an_earth_centred_worlds_altitudes_count_from_the_geoid() {
        let frankfurt = Place { latitude_deg: 50.03, longitude_deg: 8.55, altitude_m: 111.0 };
        for geoid_height_m in [-107.0, 0.0, 47.8, 120.0] {
            let world = WorldFrame { kind: WorldKind::Ecef, geoid_height_m, ..WorldFrame::default() };
            let above = Place { altitude_m: 111.0 + geoid_height_m, ..frankfurt }.to_ecef();
            let local = world.frame_at(above);
            assert!((local.place.altitude_m - 111.0).abs() < 1e-6, "{local:?}");
            assert_eq!(world.place_at("position", above).unwrap(), local);
            assert!((world.position_of(&frankfurt) - above).length() < 1e-6);
            // Flat and tangent worlds count altitudes from that of the origin, so the ellipsoid does not matter.
            for kind in [WorldKind::Flat, WorldKind::Tangent] {
                let world = WorldFrame { kind, origin: frankfurt, ..world };
                let without = WorldFrame { geoid_height_m: 0.0, ..world };
                let at = DVec3::new(3e3, -2e3, 40.0);
                assert_eq!(world.frame_at(at), without.frame_at(at));
            }
        }
        for bad in [f64::NAN, -120.001, 121.0, f64::INFINITY] {
            let e = WorldFrame { geoid_height_m: bad, ..WorldFrame::default() }.validate().unwrap_err().to_string();
            assert!(e.starts_with("geoid_height_m must be in [-120, 120] m, got "), "{e}");
        }
    }

    #[test]
    fn worlds_of_another_planet_are_spheres_of_its_radius() {
        assert_eq!([6.36e6, 6_371_000.0].map(Figure::of_radius), [Figure::WGS84; 2]);
        let radius_m = 3_389_500.0;
        let origin = Place { latitude_deg: -4.6, longitude_deg: 137.4, altitude_m: -4500.0 };
        let tangent =
            WorldFrame { kind: WorldKind::Tangent, figure: Figure::of_radius(radius_m), origin, ..Default::default() };
        let centred = WorldFrame { kind: WorldKind::Ecef, ..tangent };
        for (latitude_deg, altitude_m) in [(-90.0, 0.0), (-4.6, -4500.0), (18.0, 21_900.0), (60.0, 4e5)] {
            let place = Place { latitude_deg, longitude_deg: 30.0, altitude_m };
            for world in [tangent, centred] {
                let found = world.place_at("position", world.position_of(&place)).unwrap().place;
                assert!((found.altitude_m - altitude_m).abs() < 1e-6, "{found:?}");
                assert!((found.latitude_deg - latitude_deg).abs() < 1e-9, "{found:?}");
            }
            assert!((centred.position_of(&place).length() - radius_m - altitude_m).abs() < 1e-6, "{place:?}");
        }
        let drop = tangent.frame_at(DVec3::new(0.0, 50e3, 0.0)).place.altitude_m - origin.altitude_m;
        assert!((drop - 50e3f64.powi(2) / (2.0 * (radius_m - 4500.0))).abs() < 0.1, "{drop}");
    }

    #[test]
    fn axes_and_grid_bearing_turn_into_east_north_up() {
        let y_up = WorldFrame { axes: Axes::YUp, ..Default::default() };
        assert_eq!(y_up.frame_at(DVec3::ZERO).world_to_enu * DVec3::NEG_Z, DVec3::Y);
        assert_eq!(y_up.frame_at(DVec3::new(0.0, 7.0, 0.0)).place.altitude_m, 7.0);
        let turned = WorldFrame { grid_bearing_deg: 90.0, ..Default::default() };
        let north_axis = turned.frame_at(DVec3::ZERO).world_to_enu * DVec3::Y;
        assert!((north_axis - DVec3::X).length() < 1e-12, "grid north of bearing 90 points east: {north_axis}");
    }
}
