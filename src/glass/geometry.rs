//! Pane of the glass: its shape, its plane in the camera's axes, and the lattice on it.

use glam::{DMat3, DMat4, DVec2, DVec3, DVec4};

use crate::error::{Error, Result};

/// Edge of a cell, m, on glass up to 4 m across; larger glass has larger cells.
pub const CELL_M: f64 = 0.004;
/// Largest number of cells along the longer edge.
pub const MAX_CELLS: u32 = 1024;

/// Shape and position of the glass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pane {
    /// A flat window. Its corners in the camera's axes (x right, y up, z backwards), m from the camera: lower left,
    /// lower right, upper right, upper left as seen from the camera. Convex, in one plane within 2 % of a diagonal,
    /// each coordinate within 20 m, edges from 0.05 to 8 m.
    Quad([DVec3; 4]),
    /// Glass over the whole picture, at right angles to the camera's axis. The value is its distance from the camera,
    /// m, [0.1, 3].
    WholeView(f64),
}

/// Plane of a pane with its axes. u runs along the lower edge and v up the glass, both from the lower left of the
/// pane's bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Lower left of the bounds in the camera's axes, m.
    pub origin: DVec3,
    /// Unit vector along the lower edge, to the right.
    pub u: DVec3,
    /// Unit vector up the glass.
    pub v: DVec3,
    /// Unit vector outwards, away from the camera.
    pub out: DVec3,
    /// Width and height of the bounds, m.
    pub size_m: DVec2,
    /// Corners in (u, v), m, anticlockwise as seen from the camera.
    pub corners: [DVec2; 4],
}

impl Plane {
    /// Creates the plane of four corners: lower left, lower right, upper right, upper left as seen from the camera,
    /// which is at the origin.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] if the corners are out of range, not in one plane, not convex, not in that
    /// order, or in a plane less than 1 mm from the camera.
    pub fn of(corners: &[DVec3; 4]) -> Result<Self> {
        const NAME: &str = "windscreen.corners_m";
        let listed = || format!("{corners:?}");
        if !corners.iter().all(|c| c.is_finite() && c.abs().max_element() <= 20.0) {
            return Err(Error::range(NAME, "finite and within 20 m of the camera", listed()));
        }
        let edge = |i: usize| corners[(i + 1) % 4] - corners[i];
        if !(0..4).all(|i| (0.05..=8.0).contains(&edge(i).length())) {
            return Err(Error::range(NAME, "four corners with edges in [0.05, 8] m", listed()));
        }
        let normal = (corners[2] - corners[0]).cross(corners[3] - corners[1]);
        let Some(towards) = normal.try_normalize() else {
            return Err(Error::range(NAME, "the corners of an area", listed()));
        };
        let (u, distance) = (edge(0).normalize(), -towards.dot(corners[0]));
        if distance < 1e-3 {
            let accepted = "lower left, lower right, upper right, upper left as seen from a camera at least 1 mm away";
            return Err(Error::range(NAME, accepted, listed()));
        }
        // `towards` is at right angles to u only within the corners' errors, `out` exactly.
        let v = towards.cross(u).normalize();
        let (out, flat) = (v.cross(u), |c: DVec3| DVec2::new(u.dot(c - corners[0]), v.dot(c - corners[0])));
        let off = corners.map(|c| out.dot(c - corners[0]).abs()).into_iter().fold(0.0, f64::max);
        if off > 0.02 * (corners[2] - corners[0]).length() {
            return Err(Error::range(NAME, "in one plane within 2 % of the diagonal", listed()));
        }
        let flat = corners.map(flat);
        let turn = |i: usize| {
            let (a, b, c) = (flat[i], flat[(i + 1) % 4], flat[(i + 2) % 4]);
            (b - a).perp_dot(c - b)
        };
        if !(0..4).all(|i| turn(i) > 0.0) {
            return Err(Error::range(NAME, "the corners of a convex area, in order", listed()));
        }
        let low = flat.into_iter().fold(DVec2::INFINITY, DVec2::min);
        let high = flat.into_iter().fold(DVec2::NEG_INFINITY, DVec2::max);
        let origin = corners[0] + u * low.x + v * low.y;
        Ok(Self { origin, u, v, out, size_m: high - low, corners: flat.map(|c| c - low) })
    }

    /// Creates the plane of a pane in a picture with this projection.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for corners that [`Plane::of`] refuses; [`crate::Status::Unsupported`] for
    /// glass over the whole view with a projection from which no valid corners follow.
    pub fn of_pane(pane: &Pane, projection: &DMat4) -> Result<Self> {
        match pane {
            Pane::Quad(corners) => Self::of(corners),
            Pane::WholeView(distance_m) => {
                let rays = PictureRays::of(projection)?;
                // Makes the pane 2 % larger than the picture, so that the picture's edge is on the glass.
                let at = |x: f64, y: f64| {
                    let d = rays.direction + 1.02 * (x * rays.dx + y * rays.dy);
                    d * (distance_m / -d.z)
                };
                Self::of(&[at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)]).map_err(|e| {
                    Error::unsupported(format!("windscreen over the whole view with this projection: {e}"))
                })
            }
        }
    }

    /// Returns the edge of a cell, m, and the numbers of the lattice's columns and rows.
    pub fn lattice(&self) -> (f64, [u32; 2]) {
        let cell = CELL_M.max(self.size_m.max_element() / f64::from(MAX_CELLS));
        (cell, self.size_m.to_array().map(|m| ((m / cell).round() as u32).clamp(4, MAX_CELLS)))
    }

    /// Returns the area of the pane, m^2.
    pub fn area_m2(&self) -> f64 {
        let c = &self.corners;
        0.5 * (c[2] - c[0]).perp_dot(c[3] - c[1])
    }
}

/// Rays of a perspective picture in the camera's axes: direction = `direction` + x `dx` + y `dy` at clip x and y.
#[derive(Clone, Copy, Debug)]
pub(super) struct PictureRays {
    pub direction: DVec3,
    pub dx: DVec3,
    pub dy: DVec3,
}

impl PictureRays {
    /// # Errors
    /// [`crate::Status::Unsupported`] for parallel rays: there is no eye behind the glass.
    pub fn of(projection: &DMat4) -> Result<Self> {
        // The point p = (x, y, z, 1) lies on the ray of (x', y') if (r_x - x' r_w) . p = (r_y - y' r_w) . p = 0. These
        // are two planes through the eye. The cross product of their normals is the ray's direction; it is affine in x'
        // and y' because r_w x r_w = 0.
        let row = |i: usize| {
            let r: DVec4 = projection.row(i);
            r.truncate()
        };
        let (rx, ry, rw) = (row(0), row(1), row(3));
        if rw.length_squared() == 0.0 {
            return Err(Error::unsupported(
                "a windscreen with a projection of parallel rays: it needs a perspective one",
            ));
        }
        let (direction, dx, dy) = (rx.cross(ry), ry.cross(rw), rw.cross(rx));
        let sign = rw.dot(direction).signum();
        Ok(Self { direction: direction * sign, dx: dx * sign, dy: dy * sign })
    }

    /// Returns the matrix from a direction to (x, y, 1) in clip space, times a factor that is positive in front of the
    /// camera.
    pub fn to_clip(self) -> DMat3 {
        DMat3::from_cols(self.dx, self.dy, self.direction).inverse()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Camera;

    /// Returns the corners of a window: low left, low right, high right, high left; m.
    fn quad() -> [DVec3; 4] {
        // The windscreen of a car: 1.2 m wide, leaning back.
        [(-0.7, -0.2, -0.9), (0.7, -0.2, -0.9), (0.5, 0.3, -0.4), (-0.5, 0.3, -0.4)].map(DVec3::from)
    }

    #[test]
    fn axes_are_those_of_the_glass() {
        let p = Plane::of(&quad()).unwrap();
        assert!((p.u - DVec3::X).length() < 1e-12 && p.v.y > 0.0 && p.v.z > 0.0 && p.out.z < 0.0 && p.out.y > 0.0);
        assert!((p.size_m.y - 0.5f64.hypot(0.5)).abs() < 1e-12 && (p.size_m.x - 1.4).abs() < 1e-12);
        assert!((p.area_m2() - 1.2 * p.size_m.y).abs() < 1e-12);
        assert_eq!(p.lattice(), (0.004, [350, 177]));
        for (c, flat) in quad().iter().zip(p.corners) {
            assert!((p.origin + p.u * flat.x + p.v * flat.y - *c).length() < 1e-12);
        }
    }

    #[test]
    fn bad_windows_are_refused_by_name() {
        let [a, b, c, d] = quad();
        let lifted = c + DVec3::Z * 0.4;
        let lost = DVec3::new(f64::NAN, 0.0, 0.0);
        let flat = [a, a + DVec3::X, a + DVec3::X * 2.0, a + DVec3::X * 3.0];
        for bad in [[a, d, c, b], [a, b, lifted, d], [lost, b, c, d], [a, a, c, d], flat, [a, b, d, c]] {
            let e = Plane::of(&bad).unwrap_err();
            assert!(e.to_string().contains("windscreen.corners_m"), "{e}");
        }
        assert!(Plane::of(&[a, b, c, d].map(|p| p * 30.0)).is_err());
    }

    #[test]
    fn rays_invert_any_perspective() {
        let camera = Camera::look_to(DVec3::ZERO, DVec3::Y, DVec3::Z, 0.8, 1.6, 0.1);
        let shifted = DMat4::from_translation(DVec3::new(0.3, -0.2, 0.0)) * camera.projection;
        for projection in [camera.projection, shifted] {
            let rays = PictureRays::of(&projection).unwrap();
            let d = rays.direction + 0.4 * rays.dx - 0.7 * rays.dy;
            let clip = projection * d.extend(0.0);
            assert!(clip.w > 0.0 && (clip.x / clip.w - 0.4).abs() < 1e-12 && (clip.y / clip.w + 0.7).abs() < 1e-12);
            let back = rays.to_clip() * d;
            assert!(back.z > 0.0 && (back.x / back.z - 0.4).abs() < 1e-12);
        }
        let parallel = DMat4::from_scale(DVec3::new(0.1, 0.1, 0.01));
        assert_eq!(PictureRays::of(&parallel).unwrap_err().status, crate::Status::Unsupported);
    }
}
