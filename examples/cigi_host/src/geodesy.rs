//! Places on the ellipsoid WGS 84 (NIMA TR8350.2, 2000), and how objects stand on it.

/// Semi-major axis, m.
const SEMI_MAJOR_M: f64 = 6_378_137.0;
/// Square of the first eccentricity.
const ECCENTRICITY_SQUARED: f64 = 6.694_379_990_14e-3;

/// A place: degrees north and east, and metres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Place {
    /// Latitude, degrees north.
    pub latitude_deg: f64,
    /// Longitude, degrees east.
    pub longitude_deg: f64,
    /// Altitude, m.
    pub altitude_m: f64,
}

/// Returns how many metres north and east a radian of latitude and of longitude are at a place: the radius of the
/// meridian, and that of the parallel (Torge and Mueller 2012, Geodesy, equations 4.14 and 4.15).
fn metres_per_radian(place: Place) -> [f64; 2] {
    let latitude = place.latitude_deg.to_radians();
    let sine = libm::sin(latitude);
    let factor = 1.0 - ECCENTRICITY_SQUARED * sine * sine;
    let prime_vertical = SEMI_MAJOR_M / factor.sqrt();
    let meridian = prime_vertical * (1.0 - ECCENTRICITY_SQUARED) / factor;
    [meridian + place.altitude_m, (prime_vertical + place.altitude_m) * libm::cos(latitude)]
}

/// Returns the way from one place to another on the ellipsoid in the plane that touches it at the first: metres north
/// and east. The altitudes do not count.
pub fn north_east_m(origin: Place, place: Place) -> [f64; 2] {
    let [north, east] = metres_per_radian(Place { altitude_m: 0.0, ..origin });
    let turned = (place.longitude_deg - origin.longitude_deg + 180.0).rem_euclid(360.0) - 180.0;
    [(place.latitude_deg - origin.latitude_deg).to_radians() * north, turned.to_radians() * east]
}

/// Returns the place that is metres north, east and down of another.
pub fn moved(origin: Place, north_east_down_m: [f64; 3]) -> Place {
    let [north, east, down] = north_east_down_m;
    let [per_north, per_east] = metres_per_radian(origin);
    // At a pole east has no meaning.
    let turn_deg = if per_east.abs() < 1.0 { 0.0 } else { (east / per_east).to_degrees() };
    Place {
        latitude_deg: (origin.latitude_deg + (north / per_north).to_degrees()).clamp(-90.0, 90.0),
        longitude_deg: (origin.longitude_deg + turn_deg + 180.0).rem_euclid(360.0) - 180.0,
        altitude_m: origin.altitude_m - down,
    }
}

/// Axes of an object as columns: forward, right and down, each in north, east and down of where it stands, or in the
/// axes of its parent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attitude(pub [[f64; 3]; 3]);

impl Attitude {
    /// Returns the axes after yaw, then pitch, then roll, degrees: the order of CIGI.
    pub fn of_angles(yaw_pitch_roll_deg: [f64; 3]) -> Self {
        let [[sy, cy], [sp, cp], [sr, cr]] =
            yaw_pitch_roll_deg.map(|a| [libm::sin(a.to_radians()), libm::cos(a.to_radians())]);
        let forward = [cy * cp, sy * cp, -sp];
        let right = [cy * sp * sr - sy * cr, sy * sp * sr + cy * cr, cp * sr];
        let down = [cy * sp * cr + sy * sr, sy * sp * cr - cy * sr, cp * cr];
        Self([forward, right, down])
    }

    /// Turns a vector of this object's axes into those in which the axes are given.
    pub fn turned(&self, vector: [f64; 3]) -> [f64; 3] {
        let Self(axes) = self;
        [0, 1, 2].map(|i| vector[0] * axes[0][i] + vector[1] * axes[1][i] + vector[2] * axes[2][i])
    }

    /// Returns the axes of a child whose axes are given in this object's.
    pub fn with_child(&self, child: &Self) -> Self {
        Self(child.0.map(|axis| self.turned(axis)))
    }
}

/// Where an object is, and how it stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Its place.
    pub place: Place,
    /// Its axes in north, east and down.
    pub attitude: Attitude,
}

impl Pose {
    /// Returns the pose of a child by its offset, m, and its angles in this object's axes.
    pub fn with_child(&self, forward_right_down_m: [f64; 3], yaw_pitch_roll_deg: [f64; 3]) -> Self {
        Self {
            place: moved(self.place, self.attitude.turned(forward_right_down_m)),
            attitude: self.attitude.with_child(&Attitude::of_angles(yaw_pitch_roll_deg)),
        }
    }
}
