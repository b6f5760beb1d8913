//! The camera: it flies freely, faster the higher it is, and jumps to places that are worth a look.

use glam::DVec3;
use welkin::scene::Camera;

/// Place and direction of the eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlyCamera {
    /// Place in the world, m: east, north, up.
    pub place: DVec3,
    /// Direction of the view, degrees clockwise from north.
    pub heading_deg: f64,
    /// Angle of the view above the horizon, degrees.
    pub pitch_deg: f64,
    /// Angle from the picture's lower to its upper edge, degrees.
    pub fov_deg: f64,
}

/// Places to jump to: name, east, north and height above the ground, m, heading, pitch and angle of view, degrees.
pub const PLACES: [(&str, [f64; 3], [f64; 3]); 6] = [
    ("valley", [2604.0, 138.8, 1.8], [8.0, -4.0, 50.0]),
    ("cab", [2604.0, 138.8, 3.2], [8.0, -18.0, 70.0]),
    ("hill", [-1800.0, 1500.0, 120.0], [100.0, -8.0, 50.0]),
    ("300 m", [0.0, 0.0, 300.0], [30.0, -10.0, 60.0]),
    ("12 km", [0.0, -9000.0, 12_000.0], [0.0, -30.0, 60.0]),
    ("orbit", [0.0, -900_000.0, 400_000.0], [0.0, -22.0, 50.0]),
];

/// Lowest height above the ground, m.
const LOWEST_M: f64 = 1.0;
/// Highest place, m.
const HIGHEST_M: f64 = 1e7;

impl FlyCamera {
    /// A place of [`PLACES`]; `ground_m` gives the height of the ground.
    ///
    /// # Errors
    /// The name is none of them.
    pub fn at(name: &str, ground_m: impl Fn(DVec3) -> f64) -> Result<Self, String> {
        let names = || PLACES.map(|p| p.0).join(", ");
        let found = PLACES.iter().find(|p| p.0 == name);
        let (_, [east, north, above], [heading_deg, pitch_deg, fov_deg]) =
            *found.ok_or_else(|| format!("a place is one of {}; got `{name}`", names()))?;
        let below = DVec3::new(east, north, 0.0);
        Ok(Self { place: below + DVec3::Z * (ground_m(below) + above), heading_deg, pitch_deg, fov_deg })
    }

    /// Unit vector along the view.
    pub fn forward(&self) -> DVec3 {
        let ((sh, ch), (sp, cp)) = (self.heading_deg.to_radians().sin_cos(), self.pitch_deg.to_radians().sin_cos());
        DVec3::new(sh * cp, ch * cp, sp)
    }

    /// Turns by degrees.
    pub fn turn(&mut self, right_deg: f64, up_deg: f64) {
        self.heading_deg = (self.heading_deg + right_deg).rem_euclid(360.0);
        self.pitch_deg = (self.pitch_deg + up_deg).clamp(-89.0, 89.0);
    }

    /// Moves for `seconds`, with `keys` from -1 to 1: to the right, forward and up. The speed grows with the height
    /// above the ground, so that lifting from a walker's eye to orbit takes about 20 s.
    pub fn fly(&mut self, keys: DVec3, seconds: f64, ground_m: f64) {
        let above = (self.place.z - ground_m).max(LOWEST_M);
        let speed = 2.0 + 0.6 * above;
        let forward = self.forward();
        let right = forward.cross(DVec3::Z).normalize_or_zero();
        self.place += (right * keys.x + forward * keys.y + DVec3::Z * keys.z) * speed * seconds;
        self.place.z = self.place.z.clamp(ground_m + LOWEST_M, HIGHEST_M);
    }

    /// Camera of a picture with this width over its height.
    pub fn camera(&self, aspect: f64) -> Camera {
        Camera::look_to(self.place, self.forward(), DVec3::Z, self.fov_deg.to_radians(), aspect, 0.1)
    }
}
