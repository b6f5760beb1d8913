//! Straight rays through spherical shells, and the columns of air along them. A medium's column is the integral of its
//! density along a ray, in m at density 1.
//!
//! All formulas use altitudes: r^2 - R^2 is computed as h (2 R + h). Here r is the radius of a point, h its altitude
//! and R the radius of the ground. The perigee, the point of the ray's line nearest to the planet's centre, has the
//! radius r_p and the altitude h_p. A point on a ray is given by u = sqrt(h - h_p). In u the path element ds = 2 r /
//! sqrt(r + r_p) du has no pole at the perigee, and an exponential density becomes a Gaussian, so that few Gauss points
//! give 10 digits.

use super::medium::{MEDIA, Medium};
use super::quadrature::GAUSS_16;

/// A ray from a point at some altitude.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// Radius of the ground, m.
    pub bottom_m: f64,
    /// Altitude of the origin, m.
    pub altitude_m: f64,
    /// Cosine of the angle between the ray and the vertical at its origin.
    pub mu: f64,
    /// Radius at the perigee of the whole line, m.
    pub perigee_radius_m: f64,
    /// Altitude of the origin above the perigee, m.
    above_perigee_m: f64,
}

/// End of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum End {
    /// The ray leaves the air.
    Space,
    /// The ray meets the ground.
    Ground,
}

impl Ray {
    /// Creates a ray on a planet of `medium`; `mu` is in [-1, 1].
    pub fn new(medium: &Medium, altitude_m: f64, mu: f64) -> Self {
        let mu = mu.clamp(-1.0, 1.0);
        let r = medium.bottom_m + altitude_m;
        let sine = ((1.0 - mu) * (1.0 + mu)).sqrt();
        let above_perigee_m = r * mu * mu / (1.0 + sine);
        Self { bottom_m: medium.bottom_m, altitude_m, mu, perigee_radius_m: r * sine, above_perigee_m }
    }

    /// Radius of the origin, m.
    pub fn radius_m(&self) -> f64 {
        self.bottom_m + self.altitude_m
    }

    /// Altitude of the perigee, m.
    pub fn perigee_altitude_m(&self) -> f64 {
        self.altitude_m - self.above_perigee_m
    }

    /// Altitude at `distance_m` from the origin, m.
    pub fn altitude_at(&self, distance_m: f64) -> f64 {
        let r = self.radius_m();
        let growth = distance_m * (2.0 * r * self.mu + distance_m);
        let r_there = (r * r + growth).max(0.0).sqrt();
        self.altitude_m + growth / (r + r_there).max(f64::MIN_POSITIVE)
    }

    /// Distance from the origin to the ground, m; `None` if the ray misses the ground. For an origin at or below
    /// altitude 0 the ground lies at the origin's own level: every ray below the horizontal meets it at distance 0, all
    /// others miss it.
    pub fn distance_to_ground(&self) -> Option<f64> {
        if self.mu >= 0.0 {
            return None;
        }
        let h = self.altitude_m;
        if h <= 0.0 {
            return Some(0.0);
        }
        let depth = self.above_perigee_m - h;
        if depth < 0.0 {
            return None;
        }
        let to_perigee = -self.radius_m() * self.mu;
        let chord = (depth * (self.bottom_m + self.perigee_radius_m)).sqrt();
        Some(h * (2.0 * self.bottom_m + h) / (to_perigee + chord))
    }

    /// Interval of the ray inside the air: distances of its start and end, and how it ends. `None` if the ray misses
    /// the air.
    pub fn in_air(&self, medium: &Medium) -> Option<(f64, f64, End)> {
        let to_perigee = -self.radius_m() * self.mu;
        let headroom = medium.top_m - self.perigee_altitude_m();
        if headroom <= 0.0 {
            return None;
        }
        let half_chord = (headroom * (medium.bottom_m + medium.top_m + self.perigee_radius_m)).sqrt();
        if to_perigee + half_chord <= 0.0 {
            return None;
        }
        let start = if self.altitude_m <= medium.top_m { 0.0 } else { (to_perigee - half_chord).max(0.0) };
        match self.distance_to_ground() {
            Some(ground) => Some((start.min(ground), ground, End::Ground)),
            None => Some((start, to_perigee + half_chord, End::Space)),
        }
    }

    /// Returns u = sqrt(altitude above the perigee) at a distance, and the side of the perigee (-1 before, 1 after).
    pub fn u_at(&self, distance_m: f64) -> (f64, f64) {
        let t = self.radius_m() * self.mu + distance_m;
        let r = (self.perigee_radius_m * self.perigee_radius_m + t * t).sqrt();
        let sum = r + self.perigee_radius_m;
        (if sum > 0.0 { t.abs() / sum.sqrt() } else { 0.0 }, if t < 0.0 { -1.0 } else { 1.0 })
    }

    /// Value of u at an altitude; 0 below the perigee.
    pub fn u_of_altitude(&self, altitude_m: f64) -> f64 {
        (altitude_m - self.altitude_m + self.above_perigee_m).max(0.0).sqrt()
    }

    /// Distance along the ray at which the point at `u` lies, on `side` of the perigee, m.
    pub fn distance_of(&self, u: f64, side: f64) -> f64 {
        side * u * (2.0 * self.perigee_radius_m + u * u).sqrt() - self.radius_m() * self.mu
    }

    /// Derivative ds/du at `u`, m^(1/2).
    pub fn stretch(&self, u: f64) -> f64 {
        let rp = self.perigee_radius_m;
        2.0 * (rp + u * u) / (2.0 * rp + u * u).max(f64::MIN_POSITIVE).sqrt()
    }

    /// Columns between two distances along the ray, in m at density 1 for each medium. The relative error is below 1e-9
    /// for smooth profiles of any scale height.
    pub fn columns(&self, medium: &Medium, from_m: f64, to_m: f64) -> [f64; MEDIA] {
        if to_m <= from_m {
            return [0.0; MEDIA];
        }
        let ((u0, side0), (u1, side1)) = (self.u_at(from_m), self.u_at(to_m));
        if side0 == side1 {
            return self.leg(medium, u0.min(u1), u0.max(u1));
        }
        let (a, b) = (self.leg(medium, 0.0, u0), self.leg(medium, 0.0, u1));
        std::array::from_fn(|i| a[i] + b[i])
    }

    /// Columns from the origin to the end of the air, even if the ground is in between. Below altitude 0 gas and haze
    /// have density 1.
    pub fn columns_to_space(&self, medium: &Medium) -> [f64; MEDIA] {
        let u0 = self.above_perigee_m.sqrt();
        let u_top = self.u_of_altitude(medium.top_m);
        if self.mu >= 0.0 {
            return self.leg(medium, u0, u_top);
        }
        let (a, b) = (self.leg(medium, 0.0, u0), self.leg(medium, 0.0, u_top));
        std::array::from_fn(|i| a[i] + b[i])
    }

    /// Columns on one side of the perigee, between u_low and u_high.
    fn leg(&self, medium: &Medium, u_low: f64, u_high: f64) -> [f64; MEDIA] {
        let u_high = u_high.min(self.u_of_altitude(medium.top_m));
        if u_high <= u_low {
            return [0.0; MEDIA];
        }
        // Below altitude 0 the exponential media have density 1.
        let u_ground = self.u_of_altitude(0.0).clamp(u_low, u_high);
        let below = self.distance_of(u_ground, 1.0) - self.distance_of(u_low, 1.0);
        let mut out = [0.0; MEDIA];
        for (i, h) in medium.scale_height_m.iter().enumerate() {
            if medium.extinction[i].iter().any(|b| *b > 0.0) {
                out[i] = below + self.exponential_leg(*h, u_ground, u_high);
            }
        }
        if medium.extinction[2].iter().any(|b| *b > 0.0) {
            out[2] = self.ozone_leg(medium, u_low, u_high);
        }
        out
    }

    /// Integral of exp(-h/H) ds over u in [a, b], altitudes above 0.
    fn exponential_leg(&self, scale_height_m: f64, a: f64, b: f64) -> f64 {
        if scale_height_m <= 0.0 || b <= a {
            return 0.0;
        }
        let low = (self.perigee_altitude_m() + a * a).max(0.0);
        let density = (-low / scale_height_m).exp();
        if density == 0.0 {
            return 0.0;
        }
        // Panels end where the density has fallen by the factors e^3, e^12 and e^40 from the lowest point of the leg.
        let mut sum = 0.0;
        let mut from = a;
        for fall in [3.0, 12.0, 40.0] {
            let to = (a * a + fall * scale_height_m).sqrt().min(b);
            if to > from {
                sum += self.panel(from, to, &|u: f64| (-(u - a) * (u + a) / scale_height_m).exp());
                from = to;
            }
        }
        density * sum
    }

    /// Integral of the ozone tent over u in [a, b] in closed form. With t the distance from the perigee, the integral
    /// of r dt is (t r + r_p^2 asinh(t / r_p)) / 2.
    fn ozone_leg(&self, medium: &Medium, a: f64, b: f64) -> f64 {
        let (center, half_width) = medium.ozone_m;
        if half_width <= 0.0 {
            return 0.0;
        }
        let rp = self.perigee_radius_m;
        let at = |altitude: f64| {
            let u = self.u_of_altitude(altitude).clamp(a, b);
            let (t, r) = (u * (2.0 * rp + u * u).sqrt(), rp + u * u);
            // With r_p below a millimetre the second term is negligible. With r_p = 0, asinh(t / r_p) is not finite.
            let bend = if rp > 1e-3 { rp * rp * (t / rp).asinh() } else { 0.0 };
            (t, 0.5 * (t * r + bend))
        };
        let (low, middle, high) = (at(center - half_width), at(center), at(center + half_width));
        let rise = (middle.1 - low.1) - (self.bottom_m + center - half_width) * (middle.0 - low.0);
        let fall = (self.bottom_m + center + half_width) * (high.0 - middle.0) - (high.1 - middle.1);
        ((rise + fall) / half_width).max(0.0)
    }

    /// Column of the ozone tent from the origin to the end of the air, m, in a direction that misses the ground.
    pub fn ozone_to_space(&self, medium: &Medium) -> f64 {
        let u0 = self.above_perigee_m.sqrt();
        let u_top = self.u_of_altitude(medium.top_m);
        if self.mu >= 0.0 {
            return self.ozone_leg(medium, u0.min(u_top), u_top);
        }
        self.ozone_leg(medium, 0.0, u0.min(u_top)) + self.ozone_leg(medium, 0.0, u_top)
    }

    /// Gauss integral of `density` ds over u in [a, b]. The interval is cut into pieces over which ds/du is smooth
    /// enough. There are several pieces only if the perigee is close to the planet's centre compared with the length of
    /// the leg, as on nearly vertical rays.
    fn panel(&self, a: f64, b: f64, density: &dyn Fn(f64) -> f64) -> f64 {
        let mut sum = 0.0;
        let mut from = a;
        while from < b {
            let reach = 4.0 * (2.0 * self.perigee_radius_m + from * from).sqrt();
            let to = if reach > 0.0 && from + reach < b { from + reach } else { b };
            sum += GAUSS_16.integrate(from, to, |u| density(u) * self.stretch(u));
            from = to;
        }
        sum
    }
}

/// Cosine of the horizon's zenith angle at an altitude. Rays with a smaller `mu` meet the ground. It is 0 at and below
/// altitude 0.
pub fn horizon_mu(medium: &Medium, altitude_m: f64) -> f64 {
    let h = altitude_m.max(0.0);
    -(h * (2.0 * medium.bottom_m + h)).sqrt() / (medium.bottom_m + h)
}

/// Interval of a ray's whole line that lies in the planet's shadow, for a sun at infinity. Its ends are distances from
/// the ray's origin, negative behind the origin. `None` if all of the line is lit. `mu_s` is the cosine of the sun's
/// zenith angle at the origin, and `nu` that of the angle between ray and sun.
pub fn shadow(ray: &Ray, mu_s: f64, nu: f64) -> Option<(f64, f64)> {
    // The shadow is a cylinder of the ground's radius. It extends from the plane through the planet's centre away from
    // the sun.
    let r = ray.radius_m();
    let h = ray.altitude_m;
    let a = (1.0 - nu) * (1.0 + nu);
    let b = r * (ray.mu - mu_s * nu);
    let c = h * (2.0 * ray.bottom_m + h) - r * r * mu_s * mu_s;
    let (mut from, mut to) = if a < 1e-15 {
        if c >= 0.0 {
            return None;
        }
        (f64::NEG_INFINITY, f64::INFINITY)
    } else {
        let discriminant = b * b - a * c;
        if discriminant <= 0.0 {
            return None;
        }
        let q = -(b + discriminant.sqrt().copysign(b));
        let (x, y) = (q / a, if q == 0.0 { 0.0 } else { c / q });
        (x.min(y), x.max(y))
    };
    // A point is behind the planet where r mu_s + s nu < 0.
    let turn = -r * mu_s / nu;
    if nu > 0.0 {
        to = to.min(turn);
    } else if nu < 0.0 {
        from = from.max(turn);
    } else if mu_s >= 0.0 {
        return None;
    }
    (to > from).then_some((from, to))
}

/// Whether the planet hides the sun at a point.
pub fn sun_hidden(medium: &Medium, altitude_m: f64, mu_s: f64) -> bool {
    mu_s < horizon_mu(medium, altitude_m)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::Planet;

    fn medium(radius_m: f64, scale_height_m: f64, top_m: f64) -> Medium {
        let mut p = Planet::earth();
        (p.bottom_radius_m, p.top_radius_m) = (radius_m, radius_m + top_m);
        (p.rayleigh.scale_height_m, p.mie.scale_height_m) = (scale_height_m, scale_height_m);
        Medium::of(&p)
    }

    #[test]
    fn air_mass_of_an_exponential_sphere() {
        let m = medium(6_371_000.0, 8000.0, 1e6);
        let table = [(80.0, 5.5505), (85.0, 10.140), (88.0, 18.666), (90.0, 35.385)];
        for (zenith_deg, air_mass) in table {
            let mu = f64::cos(f64::to_radians(zenith_deg));
            let column = Ray::new(&m, 0.0, mu).columns_to_space(&m)[0];
            assert!((column / 8000.0 / air_mass - 1.0).abs() < 3e-5, "{zenith_deg}: {}", column / 8000.0);
        }
        // Refraction and the real profile let Kasten and Young 1989 differ by up to 7 % at the horizon.
        for (zenith_deg, air_mass) in [(60.0, 1.9943), (75.0, 3.8129), (80.0, 5.586), (85.0, 10.306)] {
            let mu = f64::cos(f64::to_radians(zenith_deg));
            let column = Ray::new(&m, 0.0, mu).columns_to_space(&m)[0];
            assert!((column / 8000.0 / air_mass - 1.0).abs() < 0.017, "{zenith_deg}");
        }
    }

    /// Plain Simpson sums of `n` steps: slow, but independent of the substitution and of the panels.
    fn brute_columns(m: &Medium, altitude_m: f64, mu: f64, length_m: f64, n: usize) -> [f64; MEDIA] {
        let r = m.bottom_m + altitude_m;
        let mut out = [0.0; MEDIA];
        for i in 0..=n {
            let s = length_m * i as f64 / n as f64;
            let h = (r * r + 2.0 * r * mu * s + s * s).sqrt() - m.bottom_m;
            let w = if i == 0 || i == n {
                1.0
            } else if i % 2 == 1 {
                4.0
            } else {
                2.0
            };
            let d = m.density(h.min(m.top_m));
            (0..MEDIA).for_each(|k| out[k] += w * d[k] * length_m / n as f64 / 3.0);
        }
        out
    }

    #[test]
    fn columns_agree_with_a_plain_sum() {
        let m = Medium::of(&Planet::earth());
        for altitude in [1.0, 500.0, 12_000.0, 60_000.0] {
            for mu in [1.0, 0.5, 0.05, 1e-3, 0.0, -1e-3, -0.02, -0.3, -1.0] {
                let ray = Ray::new(&m, altitude, mu);
                let (start, end, _) = ray.in_air(&m).unwrap();
                assert_eq!(start, 0.0);
                for share in [0.37, 1.0] {
                    let exact = brute_columns(&m, altitude, mu, end * share, 200_000);
                    let ours = ray.columns(&m, 0.0, end * share);
                    for k in 0..MEDIA {
                        let error = (ours[k] - exact[k]).abs() / (exact[k] + 1e-3);
                        assert!(error < 2e-8, "h {altitude} mu {mu} medium {k}: {} {}", ours[k], exact[k]);
                    }
                }
            }
        }
    }

    #[test]
    fn columns_add_up_and_are_the_same_both_ways() {
        let m = Medium::of(&Planet::earth());
        for (altitude, mu) in [(0.0, 0.0), (1.7, 0.02), (30_000.0, -0.09), (90_000.0, -0.165), (9e6, -0.93)] {
            let ray = Ray::new(&m, altitude, mu);
            let (start, end, _) = ray.in_air(&m).unwrap();
            let middle = start + 0.43 * (end - start);
            let (whole, a, b) =
                (ray.columns(&m, start, end), ray.columns(&m, start, middle), ray.columns(&m, middle, end));
            // Follows the same path from its other end.
            let h = ray.altitude_at(middle);
            let back_mu = -(ray.radius_m() * mu + middle) / (m.bottom_m + h);
            let back = Ray::new(&m, h, back_mu).columns(&m, 0.0, middle - start);
            for k in 0..MEDIA {
                assert!((a[k] + b[k] - whole[k]).abs() <= 1e-9 * whole[k] + 1e-9, "{altitude} {mu} {k}");
                assert!((back[k] - a[k]).abs() <= 1e-6 * a[k] + 1e-6, "{altitude} {mu} {k}: {} {}", back[k], a[k]);
            }
        }
    }

    #[test]
    fn horizon_distance_does_not_cancel() {
        let m = medium(6_371_000.0, 8000.0, 1e5);
        for h in [1e-3, 1.7, 100.0, 1e4, 1e6, 1e7] {
            let exact = f64::sqrt(h * (2.0 * 6_371_000.0 + h));
            let horizon = horizon_mu(&m, h);
            let just_below = Ray::new(&m, h, horizon - 1e-13).distance_to_ground().unwrap();
            assert!((just_below / exact - 1.0).abs() < 1e-3, "{h}: {just_below} {exact}");
            assert!(Ray::new(&m, h, horizon + 1e-13).distance_to_ground().is_none(), "{h}");
        }
        assert!((Ray::new(&m, 1.7, -1.0).distance_to_ground().unwrap() - 1.7).abs() < 1e-9);
        assert_eq!(Ray::new(&m, -100.0, -0.1).distance_to_ground(), Some(0.0));
        assert_eq!(Ray::new(&m, -100.0, 0.1).distance_to_ground(), None);
    }

    #[test]
    fn shadow_ends_where_the_sun_rises() {
        let m = Medium::of(&Planet::earth());
        let sun_zenith = 97f64.to_radians();
        for view_deg in [0.0, 40.0, 85.0, 89.9] {
            for azimuth_deg in [0.0, 70.0, 180.0] {
                let (v, phi) = (f64::to_radians(view_deg), f64::to_radians(azimuth_deg));
                let nu = v.cos() * sun_zenith.cos() + v.sin() * sun_zenith.sin() * phi.cos();
                let ray = Ray::new(&m, 10.0, v.cos());
                let (from, to) = shadow(&ray, sun_zenith.cos(), nu).unwrap();
                assert!(from <= 0.0 && to > 0.0);
                for (s, hidden) in [(to - 10.0, true), (to + 10.0, false)] {
                    let h = ray.altitude_at(s);
                    let mu_s = (ray.radius_m() * sun_zenith.cos() + s * nu) / (m.bottom_m + h);
                    assert_eq!(sun_hidden(&m, h, mu_s), hidden, "view {view_deg} azimuth {azimuth_deg}");
                }
            }
        }
    }
}
