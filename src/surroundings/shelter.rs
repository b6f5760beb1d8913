//! Shelters, which keep rain off: the host's boxes (roofs, bridges, cabs, trucks) and convex shapes cut from them,
//! standing or moving.
//!
//! A drop is removed if its slanted path, traced back relative to the box, meets the box. The lee and the inside of a
//! box are therefore dry and the ground to windward is wet, whatever the wind. Each drop is tested exactly against each
//! box, and against the planes that cut the box.

use glam::{DMat3, DVec3};

use crate::error::{Error, Result, check_range};

/// Maximum number of boxes at a time.
pub const MAX_SHELTERS: usize = 32;

/// Maximum number of planes that cut one box.
pub const MAX_PLANES: usize = 16;
/// Least thickness, m, that planes must leave of a box ([`Shelter::thickness_m`]).
const THINNEST_M: f64 = 1e-5;

/// Planes that cut a box to a convex shape: the parts of the box beyond each plane are removed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Planes {
    /// Normal and distance of each plane; only the first `count` are in use.
    all: [[f64; 4]; MAX_PLANES],
    /// Number of planes.
    count: usize,
}

impl Planes {
    /// Empty list of planes: the box stays whole.
    pub const NONE: Self = Self { all: [[0.0; 4]; MAX_PLANES], count: 0 };

    /// Creates planes from normals and distances. A normal is a unit vector in the box's axes that points out of the
    /// shape. The distance is that of the plane from the box's middle along the normal, m, within 1e6.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for more than [`MAX_PLANES`].
    pub fn new(planes: &[[f64; 4]]) -> Result<Self> {
        if planes.len() > MAX_PLANES {
            return Err(Error::range("shelter.planes", &format!("at most {MAX_PLANES} planes"), planes.len()));
        }
        let mut all = [[0.0; 4]; MAX_PLANES];
        all[..planes.len()].copy_from_slice(planes);
        Ok(Self { all, count: planes.len() })
    }

    /// Returns the planes as they were given.
    pub fn as_slice(&self) -> &[[f64; 4]] {
        &self.all[..self.count]
    }

    /// Iterates over normals and distances.
    fn each(&self) -> impl ExactSizeIterator<Item = (DVec3, f64)> + Clone {
        self.as_slice().iter().map(|&[x, y, z, d]| (DVec3::new(x, y, z), d))
    }
}

/// Box that rain does not pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shelter {
    /// Middle of the box in the host's world, m, within 1e12 of the origin.
    pub center_m: DVec3,
    /// Axes of the box in the host's world as columns: unit vectors at right angles, to 1e-3.
    pub axes: DMat3,
    /// Half the size along each axis, m, \[1e-3, 1e5\].
    pub half_size_m: DVec3,
    /// Velocity in the host's world, m/s, of a magnitude of at most 2000. A box faster than 0.1 m/s does not keep the
    /// ground dry.
    pub velocity_m_s: DVec3,
    /// Planes that cut the box to another convex shape. They must leave some of the box.
    pub planes: Planes,
}

impl Shelter {
    /// Checks that every field is in range and that the planes leave some of the box.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field.
    pub fn validate(&self) -> Result<()> {
        if !(self.center_m.is_finite() && self.center_m.length() <= 1e12) {
            return Err(Error::range("shelter.center_m", "finite and within 1e12 m", self.center_m));
        }
        let turned = self.axes.transpose() * self.axes;
        let off = (turned - DMat3::IDENTITY)
            .to_cols_array()
            .iter()
            .map(|v| v.abs())
            .fold(0.0, |a, v| if v > a || v.is_nan() { v } else { a });
        if off.is_nan() || off > 1e-3 {
            return Err(Error::range("shelter.axes", "three unit vectors at right angles", self.axes));
        }
        for v in self.half_size_m.to_array() {
            check_range("shelter.half_size_m", v, 1e-3, 1e5, "m")?;
        }
        let speed = self.velocity_m_s.length();
        if speed.is_nan() || speed > 2000.0 {
            return Err(Error::range("shelter.velocity_m_s", "a vector of at most 2000 m/s", self.velocity_m_s));
        }
        for (i, (n, d)) in self.planes.each().enumerate() {
            if !((n.length() - 1.0).abs() <= 1e-3 && d.abs() <= 1e6) {
                let accepted = format!("unit vectors and distances within 1e6 m in plane {i}");
                return Err(Error::range("shelter.planes", &accepted, n.extend(d)));
            }
        }
        if self.planes.count > 0 && self.thickness_m() < THINNEST_M {
            return Err(Error::range("shelter.planes", "planes that leave some of the box", "nothing of it"));
        }
        Ok(())
    }

    /// Returns the distance of the mean of the shape's corners from the nearest face, m; negative if the shape has no
    /// corners.
    fn thickness_m(&self) -> f64 {
        const FACES: usize = 6 + MAX_PLANES;
        let half = self.half_size_m;
        let mut faces = [(DVec3::X, half.x); FACES];
        for (i, axis) in [DVec3::X, DVec3::Y, DVec3::Z].into_iter().enumerate() {
            faces[2 * i] = (axis, half[i]);
            faces[2 * i + 1] = (-axis, half[i]);
        }
        self.planes.each().enumerate().for_each(|(i, plane)| faces[6 + i] = plane);
        let faces = &faces[..6 + self.planes.count];
        let slack = 1e-7 * half.max_element();
        let within = |p: DVec3| faces.iter().map(|(n, d)| d - n.dot(p)).fold(f64::INFINITY, f64::min);
        let (mut sum, mut corners) = (DVec3::ZERO, 0u32);
        for (i, &(a, da)) in faces.iter().enumerate() {
            for (j, &(b, db)) in faces.iter().enumerate().skip(i + 1) {
                for &(c, dc) in &faces[j + 1..] {
                    let det = a.dot(b.cross(c));
                    let corner = (b.cross(c) * da + c.cross(a) * db + a.cross(b) * dc) / det;
                    if det.abs() > 1e-9 && within(corner) > -slack {
                        (sum, corners) = (sum + corner, corners + 1);
                    }
                }
            }
        }
        if corners == 0 { -1.0 } else { within(sum / f64::from(corners)) }
    }

    /// Returns whether the box stands still, which means a speed of at most 0.1 m/s. A box that moves does not keep the
    /// ground dry.
    pub(crate) fn stands(&self) -> bool {
        self.velocity_m_s.length() <= 0.1
    }

    /// Returns whether the box can keep rain off a drop within `reach_m` of a camera. Other boxes need not be tested.
    /// `wind` is the air's velocity, (east, north, up), m/s; drops fall at `slowest_m_s` or faster. The answer may be
    /// true for a box that keeps no rain off, but is never false for a box that does.
    pub(crate) fn matters(&self, eye: DVec3, to_enu: DMat3, wind: DVec3, slowest_m_s: f64, reach_m: f64) -> bool {
        let center = to_enu * (self.center_m - eye);
        let radius = self.half_size_m.length();
        // Computes the largest height over which a drop falls from the box to the place where it is drawn, m.
        let rise = center.z + radius + reach_m;
        if rise < 0.0 {
            return false;
        }
        let drift = (to_enu * self.velocity_m_s - wind).truncate() * (rise / slowest_m_s);
        let along = (center.truncate().dot(drift) / drift.length_squared().max(1e-12)).clamp(0.0, 1.0);
        (center.truncate() - drift * along).length() <= reach_m + radius
    }

    /// Returns the box as shaders test it, for a camera at `eye` in the host's world, m. `to_enu` is the rotation from
    /// the host's axes to the camera's east, north, up. Three rows map camera-relative east, north, up, m, into the
    /// box's own space, where the box spans -1 to 1 along each axis. The fourth row has the box's velocity, m/s, and 1
    /// if the box moves.
    pub(crate) fn rows(&self, eye: DVec3, to_enu: DMat3) -> [[f32; 4]; 4] {
        let axes = to_enu * self.axes;
        let center = to_enu * (self.center_m - eye);
        let row = |i: usize| {
            let n = axes.col(i) / self.half_size_m[i];
            [n.x as f32, n.y as f32, n.z as f32, -n.dot(center) as f32]
        };
        let v = to_enu * self.velocity_m_s;
        let moves = f32::from(u8::from(!self.stands()));
        [row(0), row(1), row(2), [v.x as f32, v.y as f32, v.z as f32, moves]]
    }
}

impl Shelter {
    /// Returns the planes as shaders test them, in the space of [`Shelter::rows`].
    pub(crate) fn cuts(&self) -> impl ExactSizeIterator<Item = [f32; 4]> {
        let half = self.half_size_m;
        self.planes.each().map(move |(n, d)| {
            let scale = (n * half).length();
            (n * half / scale).extend(d / scale).as_vec4().to_array()
        })
    }
}

/// Returns the share of the way from `a` to `b` (host's world) at which the way first meets the shelter's shape: 0 if
/// `a` is inside, `None` if the way misses the shape.
pub(crate) fn met_at(shelter: &Shelter, a: DVec3, b: DVec3) -> Option<f64> {
    let own = |v: DVec3| shelter.axes.transpose() * v;
    let (o, d) = (own(a - shelter.center_m), own(b - a));
    let half = shelter.half_size_m;
    let faces = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().enumerate().flat_map(|(i, n)| [(n, half[i]), (-n, half[i])]);
    let (mut near, mut far) = (0.0f64, 1.0f64);
    for (n, distance) in faces.chain(shelter.planes.each()) {
        let (out, rate) = (n.dot(o) - distance, n.dot(d));
        if rate < -1e-12 {
            near = near.max(-out / rate);
        } else if rate > 1e-12 {
            far = far.min(-out / rate);
        } else if out > 0.0 {
            return None;
        }
    }
    (near <= far).then_some(near)
}

/// Returns whether a drop that came to `p` with `velocity` (host's world) met the shelter's shape on its way.
pub fn sheltered(shelter: &Shelter, p: DVec3, velocity: DVec3) -> bool {
    let own = |v: DVec3| shelter.axes.transpose() * v / shelter.half_size_m;
    let (o, d) = (own(p - shelter.center_m), own(shelter.velocity_m_s - velocity));
    let (mut near, mut far) = (0.0f64, f64::INFINITY);
    for i in 0..3 {
        let inverse = 1.0 / if d[i].abs() < 1e-9 { 1e-9 } else { d[i] };
        let (a, b) = ((-1.0 - o[i]) * inverse, (1.0 - o[i]) * inverse);
        near = near.max(a.min(b));
        far = far.min(a.max(b));
    }
    for (n, distance) in shelter.planes.each() {
        let n = n * shelter.half_size_m;
        let (out, rate) = (n.dot(o) - distance, n.dot(d));
        let at = -out / if rate.abs() < 1e-9 { 1e-9 } else { rate };
        if rate <= -1e-9 {
            near = near.max(at);
        } else {
            far = far.min(at);
        }
    }
    far >= near
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Creates a roof 5 m up, 20 m long to the east, 6 m wide and 0.4 m thick.
    fn roof() -> Shelter {
        Shelter {
            center_m: DVec3::new(0.0, 0.0, 5.0),
            axes: DMat3::IDENTITY,
            half_size_m: DVec3::new(10.0, 3.0, 0.2),
            velocity_m_s: DVec3::ZERO,
            planes: Planes::NONE,
        }
    }

    #[test]
    fn a_roof_is_dry_below_and_its_windward_wedge_is_wet() {
        let roof = roof();
        for (wind, fall) in [(0.0, 6.0), (8.0, 6.0), (25.0, 2.0)] {
            let velocity = DVec3::new(0.0, wind, -fall);
            // On the ground, the dry area is the roof's outline moved downwind by height x wind / fall speed.
            for (z, edge) in [(0.0, 5.0), (4.0, 1.0)] {
                let shift = edge * wind / fall;
                for y in [-6.0, -2.9, 0.0, 2.9, 6.0] {
                    let p = DVec3::new(1.0, y + shift, z);
                    assert_eq!(sheltered(&roof, p, velocity), y.abs() < 3.0, "wind {wind} z {z} y {y}");
                }
            }
            assert!(!sheltered(&roof, DVec3::new(0.0, 0.0, 5.3), velocity), "it rains on the roof");
            assert!(sheltered(&roof, DVec3::new(0.0, 0.0, 5.1), velocity), "inside it does not");
        }
    }

    #[test]
    fn a_driving_truck_keeps_the_rain_it_drives_into_off_its_rear() {
        let truck = Shelter {
            center_m: DVec3::new(0.0, 0.0, 2.0),
            half_size_m: DVec3::new(1.2, 4.0, 2.0),
            velocity_m_s: DVec3::Y * 20.0,
            ..roof()
        };
        let rain = DVec3::new(0.0, 0.0, -6.0);
        assert!(sheltered(&truck, DVec3::new(0.0, -5.0, 1.0), rain), "behind it");
        assert!(!sheltered(&truck, DVec3::new(0.0, 5.0, 1.0), rain), "before it");
        assert!(sheltered(&truck, DVec3::new(0.5, 1.0, 1.0), rain), "in it");
    }

    /// A gable roof 2 m high and 6 m wide, turned and moving.
    fn gable() -> Shelter {
        let slope = DVec3::new(0.0, 2.0, 3.0).normalize();
        let planes = [[slope.x, slope.y, slope.z, slope.z], [0.0, -slope.y, slope.z, slope.z]];
        Shelter {
            axes: DMat3::from_rotation_z(0.7),
            half_size_m: DVec3::new(5.0, 3.0, 1.0),
            velocity_m_s: DVec3::new(3.0, -1.0, 0.0),
            planes: Planes::new(&planes).unwrap(),
            ..roof()
        }
    }

    #[test]
    fn a_path_meets_a_cut_box_where_a_point_that_goes_along_it_is_inside() {
        let shape = gable();
        let inside = |p: DVec3| {
            let own = shape.axes.transpose() * (p - shape.center_m);
            // The roof's own geometry: at the eaves' height it is 1 m below the ridge.
            own.abs().cmple(shape.half_size_m).all() && own.z <= 1.0 - own.y.abs() * (2.0 / 3.0)
        };
        let (mut met, mut by_box_only) = (0, 0);
        for i in 0..3000u32 {
            let random = |k: u32| f64::from(crate::falling::random3([i, k, 3])[0]) / 4_294_967_296.0;
            let p = shape.center_m + (DVec3::new(random(0), random(1), random(2)) - 0.5) * DVec3::new(24.0, 24.0, 10.0);
            let velocity = DVec3::new(30.0 * random(3) - 15.0, 30.0 * random(4) - 15.0, -1.0 - 8.0 * random(5));
            let hit = sheltered(&shape, p, velocity);
            let back = shape.velocity_m_s - velocity;
            let marched = (0..6000).any(|k| inside(p + back.normalize() * (5e-3 * f64::from(k))));
            // A march misses parts that are thinner than its step.
            let thin = hit && !marched;
            assert!(!marched || hit, "{p} {velocity}");
            if thin {
                let shrunk = Shelter { half_size_m: shape.half_size_m - 0.02, ..shape };
                let planes = shape.planes.each().map(|(n, d)| n.extend(d - 0.02).to_array()).collect::<Vec<_>>();
                let shrunk = Shelter { planes: Planes::new(&planes).unwrap(), ..shrunk };
                assert!(!sheltered(&shrunk, p, velocity), "{p} {velocity}");
            }
            met += u32::from(hit);
            by_box_only += u32::from(!hit && sheltered(&Shelter { planes: Planes::NONE, ..shape }, p, velocity));
        }
        assert!(met > 100 && by_box_only > 50, "{met} {by_box_only}");
    }

    #[test]
    fn no_box_that_matters_is_left_out() {
        let (mut left_out, mut kept) = (0, 0);
        for i in 0..4000u32 {
            let random = |k: u32| f64::from(crate::falling::random3([i, k, 7])[0]) / 4_294_967_296.0 - 0.5;
            let at = |k: u32, size: f64| DVec3::new(random(k), random(k + 1), random(k + 2)) * size;
            let b = Shelter {
                center_m: at(0, 120.0),
                half_size_m: at(3, 6.0).abs() + DVec3::splat(0.1),
                velocity_m_s: at(6, 30.0) * DVec3::new(1.0, 1.0, 0.0),
                ..roof()
            };
            let wind = at(9, 40.0) * DVec3::new(1.0, 1.0, 0.0);
            let matters = b.matters(DVec3::ZERO, DMat3::IDENTITY, wind, 2.0, 16.0);
            (left_out, kept) = (left_out + u32::from(!matters), kept + u32::from(matters));
            for k in 0..40 {
                let p = at(100 + 4 * k, 32.0).clamp_length_max(16.0);
                let velocity = wind - DVec3::Z * (2.0 + 7.0 * (random(103 + 4 * k) + 0.5));
                assert!(matters || !sheltered(&b, p, velocity), "{b:?} {p} {velocity}");
            }
        }
        assert!(left_out > 500 && kept > 500, "{left_out} {kept}");
    }

    #[test]
    fn bad_boxes_are_refused_by_name() {
        let nan = f64::NAN;
        let cut = |planes: &[[f64; 4]]| Shelter { planes: Planes::new(planes).unwrap(), ..roof() };
        for (bad, name) in [
            (Shelter { center_m: DVec3::new(nan, 0.0, 0.0), ..roof() }, "shelter.center_m"),
            (Shelter { axes: DMat3::from_diagonal(DVec3::new(1.0, 2.0, 1.0)), ..roof() }, "shelter.axes"),
            (Shelter { half_size_m: DVec3::new(1.0, 0.0, 1.0), ..roof() }, "shelter.half_size_m"),
            (Shelter { velocity_m_s: DVec3::splat(5000.0), ..roof() }, "shelter.velocity_m_s"),
            (cut(&[[0.0, 0.0, 2.0, 0.1]]), "shelter.planes must be unit vectors and distances within 1e6 m in plane 0"),
            (cut(&[[0.0, 0.0, 1.0, 0.1], [0.0, 1.0, 0.0, nan]]), "plane 1"),
            // Two planes that leave nothing between them, a sheet without thickness, and a plane below the whole box.
            (
                cut(&[[0.0, 1.0, 0.0, -1.0], [0.0, -1.0, 0.0, 0.5]]),
                "shelter.planes must be planes that leave some of the box",
            ),
            (cut(&[[0.0, 1.0, 0.0, 1.0], [0.0, -1.0, 0.0, -1.0]]), "leave some"),
            (cut(&[[0.0, 0.0, 1.0, -0.3]]), "leave some"),
        ] {
            let e = bad.validate().unwrap_err();
            assert!(e.to_string().contains(name), "{}", e);
        }
        for good in [roof(), gable(), cut(&[[0.0, 0.0, 1.0, 0.1999]]), cut(&[[1.0, 0.0, 0.0, 1e6]; 16])] {
            good.validate().unwrap();
        }
        let many = Planes::new(&[[1.0, 0.0, 0.0, 1.0]; 17]).unwrap_err();
        assert!(many.to_string().contains("shelter.planes must be at most 16 planes"), "{}", many);
    }
}
