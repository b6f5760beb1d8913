//! The sky in f64 on the CPU: the reference solution for tests, queries and the lab.
//!
//! [`Reference::solve`] computes the light in the air for every height of the sun. After that [`Reference::radiance`],
//! [`Reference::aerial`] and [`Reference::irradiance`] answer for any position and direction, from below the ground's
//! level to space. Order 1 (light scattered once) is integrated along the given ray, with a quadrature towards the sun
//! at every point; the ray is cut at the edges of the planet's shadow. Higher orders come from the source function on a
//! grid ([`source`], `solve`). Doubling the grid's resolution shows its error.
//!
//! Conventions: altitude 0 is the ground's sphere. For a point below it, the densities of gas and haze are those of
//! altitude 0, and the ground lies at the point's own level. Angles are in radians: zenith angles from the vertical at
//! the observer, and the azimuth of the view relative to the sun's. Radiances are in the unit of
//! [`Planet::solar_irradiance`] per steradian. Sun rays are parallel. Refraction is left out (see
//! `shaders/sky/disc.wgsl` for its lift of the disc). No device is used. Threads are spawned only if
//! [`Options::threads`] is above 1. All results depend only on the arguments and are equal for any number of threads.

pub mod grid;
pub mod march;
pub mod medium;
pub mod quadrature;
pub mod ray;
mod resolution;
mod solve;
pub mod source;
pub mod sun;

use std::f64::consts::PI;

pub use self::resolution::Resolution;

use self::march::{Cutting, Sample, march};
use self::medium::Medium;
use self::quadrature::{GAUSS_16, Gauss};
use self::ray::{End, Ray, shadow};
use self::solve::{Solver, haze_matters};
use self::source::{Nodes, Source};
use self::sun::{SunTable, disc_strips, scattered_once, sun_transmittance, with_phase};
use crate::error::{Error, Result, check_range};
use crate::planet::Planet;

/// Number of times that light may have been scattered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Orders {
    /// Exactly this many, `[1, 1e4]`; the ground counts as a scatterer.
    Exactly(usize),
    /// Orders until the tail is a smaller share of the light than `tolerance`, `(0, 0.1]`, but at most `limit` orders.
    /// The tail is the light of all higher orders. Every grid point that has more than 1e-9 of the brightest one's
    /// light must fulfil this. The tail is estimated from the last two orders as a geometric series, and is then added.
    Converged {
        /// Largest share of the light that the added tail may have.
        tolerance: f64,
        /// Number of orders after which the tail is added however large it is, `[3, 1e4]`.
        limit: usize,
    },
}

/// Settings of a reference solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Orders of scattering. By default they are converged with a tail of 2 %, at most 60 orders. The added tail is
    /// within a hundredth of its true value, so the light is within 0.05 %.
    pub orders: Orders,
    /// Sizes of the grids. Default: [`Resolution::QUICK`].
    pub resolution: Resolution,
    /// Number of strips into which the sun's disc is cut, `[1, 64]`; 1 is a point. Default 1.
    pub disc_strips: usize,
    /// Number of threads to spawn while solving, `[1, 1024]`; 1 spawns none. Default 1.
    pub threads: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            orders: Orders::Converged { tolerance: 2e-2, limit: 60 },
            resolution: Resolution::QUICK,
            disc_strips: 1,
            threads: 1,
        }
    }
}

/// Altitude of the observer, and directions of the sun and of the view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Altitude of the observer above the ground's sphere, m, `[-1e5, 1e12]`.
    pub altitude_m: f64,
    /// Zenith angle of the sun, radians, `[0, pi]`.
    pub sun_zenith: f64,
    /// Zenith angle of the view, radians, `[0, pi]`.
    pub view_zenith: f64,
    /// Azimuth of the view relative to the sun's, radians, `[-1e6, 1e6]`.
    pub azimuth: f64,
}

impl View {
    /// Creates a view from angles in degrees.
    pub fn degrees(altitude_m: f64, sun_zenith: f64, view_zenith: f64, azimuth: f64) -> Self {
        Self {
            altitude_m,
            sun_zenith: sun_zenith.to_radians(),
            view_zenith: view_zenith.to_radians(),
            azimuth: azimuth.to_radians(),
        }
    }

    fn check(&self) -> Result<()> {
        check_altitude(self.altitude_m)?;
        check_range("sun_zenith", self.sun_zenith, 0.0, PI + 1e-12, "rad")?;
        check_range("view_zenith", self.view_zenith, 0.0, PI + 1e-12, "rad")?;
        check_range("azimuth", self.azimuth, -1e6, 1e6, "rad")
    }
}

fn check_altitude(altitude_m: f64) -> Result<()> {
    check_range("altitude_m", altitude_m, -1e5, 1e12, "m")
}

/// Light along a ray, per wavelength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Along {
    /// Radiance scattered into the ray by the air, without the ground's reflection and the sun's disc.
    pub radiance: [f64; 3],
    /// Transmittance to the end of the ray. [`Reference::radiance`] returns 0 if the ray meets the ground.
    pub transmittance: [f64; 3],
    /// Whether the ray meets the ground.
    pub ground: bool,
}

/// Light on a horizontal surface facing up, per wavelength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Irradiance {
    /// Irradiance from the sun itself.
    pub direct: [f64; 3],
    /// Irradiance from the upper hemisphere without the sun.
    pub sky: [f64; 3],
}

/// The solved sky of one planet.
pub struct Reference {
    planet: Planet,
    medium: Medium,
    options: Options,
    sun_table: SunTable,
    source: Option<Source>,
    panel_altitudes: Vec<f64>,
    rule: Gauss,
    orders: usize,
    tail: f64,
}

impl Reference {
    /// Solves the sky of `planet`.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for a planet or option out of range.
    pub fn solve(planet: &Planet, options: &Options) -> Result<Self> {
        planet.check()?;
        options.resolution.check()?;
        check_range("disc_strips", options.disc_strips as f64, 1.0, 64.0, "")?;
        check_range("threads", options.threads as f64, 1.0, 1024.0, "")?;
        match options.orders {
            Orders::Exactly(n) => check_range("orders", n as f64, 1.0, 1e4, "")?,
            Orders::Converged { tolerance, limit } => {
                if tolerance.is_nan() || tolerance <= 0.0 || tolerance > 0.1 {
                    return Err(Error::range("orders.tolerance", "in (0, 0.1]", tolerance));
                }
                check_range("orders.limit", limit as f64, 3.0, 1e4, "")?;
            }
        }
        let medium = Medium::of(planet);
        let mut this = Self {
            planet: *planet,
            medium,
            options: *options,
            sun_table: SunTable::new(&medium, 192, 512),
            source: None,
            panel_altitudes: medium.panel_altitudes(),
            rule: Gauss::new(8),
            orders: 1,
            tail: 0.0,
        };
        if options.orders != Orders::Exactly(1) {
            this.solve_orders();
        }
        Ok(this)
    }

    fn solve_orders(&mut self) {
        let mut solver =
            Solver::new(&self.medium, self.planet.ground_albedo, &self.sun_table, &self.options.resolution);
        let threads = self.options.threads;
        let (limit, tolerance) = match self.options.orders {
            Orders::Exactly(n) => (n, None),
            Orders::Converged { tolerance, limit } => (limit, Some(tolerance)),
        };
        let mut order = solver.first(threads);
        let mut sum = order.clone();
        self.orders = 2;
        while self.orders < limit {
            let next = solver.next(&order, threads);
            sum.add(&next, |_| [1.0; 3]);
            self.orders += 1;
            self.tail = largest_tail(&order, &next, &sum);
            let done = tolerance.is_some_and(|t| self.tail < t);
            if tolerance.is_some() && (done || self.orders == limit) {
                sum.add(&next, |node| geometric_tail(&order, &next, node));
            }
            order = next;
            if done {
                break;
            }
        }
        self.source = Some(solver.source(&sum));
    }

    /// Number of orders that were computed one by one.
    pub fn orders(&self) -> usize {
        self.orders
    }

    /// Share of the tail (the light of the orders that were not computed one by one) in the light, estimated as a
    /// geometric series, at the grid point where it is largest. 0 if fewer than 3 orders were computed.
    pub fn tail(&self) -> f64 {
        self.tail
    }

    /// Planet of the solution.
    pub fn planet(&self) -> &Planet {
        &self.planet
    }

    /// Radiance of the air in a direction, up to the end of the air or to the ground.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for a number that is not finite or out of its range.
    pub fn radiance(&self, view: &View) -> Result<Along> {
        view.check()?;
        let mut along = self.along(view, f64::INFINITY, &GAUSS_16, true);
        if along.ground {
            along.transmittance = [0.0; 3];
        }
        Ok(along)
    }

    /// Light scattered into the first `distance_m` of a ray, and the transmittance over this distance. The ray ends
    /// earlier if it meets the ground's sphere.
    ///
    /// # Errors
    /// As [`Reference::radiance`]; `distance_m` must be in `[0, 1e12]` m.
    pub fn aerial(&self, view: &View, distance_m: f64) -> Result<Along> {
        view.check()?;
        check_range("distance_m", distance_m, 0.0, 1e12, "m")?;
        Ok(self.along(view, distance_m, &GAUSS_16, true))
    }

    /// Light on a horizontal surface facing up, at any altitude. `sun_zenith` is in radians, `[0, pi]`.
    ///
    /// # Errors
    /// As [`Reference::radiance`].
    pub fn irradiance(&self, altitude_m: f64, sun_zenith: f64) -> Result<Irradiance> {
        let view = View { altitude_m, sun_zenith, view_zenith: 0.0, azimuth: 0.0 };
        view.check()?;
        let mut direct = [0.0; 3];
        for (zenith, share) in self.strips(sun_zenith) {
            let mu_s = zenith.cos();
            let t = sun_transmittance(&self.medium, altitude_m, mu_s);
            (0..3).for_each(|c| direct[c] += share * mu_s.max(0.0) * t[c] * self.planet.solar_irradiance[c]);
        }
        let zeniths = Gauss::new(32);
        let azimuths = grid::azimuths(24);
        let mut sky = [0.0; 3];
        for (x, w) in zeniths.nodes.iter().zip(&zeniths.weights) {
            // The substitution mu = x^2 concentrates the points at the horizon, where the sky's gradient is steep.
            let x = 0.5 + 0.5 * x;
            let weight = w * x * (x * x) * 2.0 * PI / azimuths.len() as f64;
            for azimuth in &azimuths {
                let view = View { view_zenith: (x * x).acos(), azimuth: *azimuth, ..view };
                let along = self.along(&view, f64::INFINITY, &self.rule, false);
                (0..3).for_each(|c| sky[c] += weight * along.radiance[c]);
            }
        }
        Ok(Irradiance { direct, sky })
    }

    /// Zenith angles of the strips of the sun's disc, with their shares.
    fn strips(&self, sun_zenith: f64) -> Vec<(f64, f64)> {
        let strips = disc_strips(sun_zenith, self.planet.sun_angular_radius_deg.to_radians(), self.options.disc_strips);
        strips.into_iter().map(|(zenith, share)| (zenith.clamp(0.0, PI), share)).collect()
    }

    /// Light along a ray up to `distance_m`. With `exact_sun` the sun's transmittance is integrated for every sample,
    /// otherwise looked up in a table.
    fn along(&self, view: &View, distance_m: f64, rule: &Gauss, exact_sun: bool) -> Along {
        let ray = Ray::new(&self.medium, view.altitude_m, view.view_zenith.cos());
        let mut out = Along { radiance: [0.0; 3], transmittance: [1.0; 3], ground: false };
        let Some((start, end, how)) = ray.in_air(&self.medium) else { return out };
        out.ground = how == End::Ground && distance_m >= end;
        let span = (start, end.min(distance_m));
        if span.1 <= span.0 {
            return out;
        }
        out.transmittance = self.medium.transmittance(&ray.columns(&self.medium, span.0, span.1));
        for (zenith, share) in self.strips(view.sun_zenith) {
            let mu_s = zenith.cos();
            let nu = (ray.mu * mu_s + view.view_zenith.sin() * zenith.sin() * view.azimuth.cos()).clamp(-1.0, 1.0);
            let l = self.scattered(&ray, span, mu_s, nu, rule, exact_sun);
            (0..3).for_each(|c| out.radiance[c] += share * l[c] * self.planet.solar_irradiance[c]);
        }
        out
    }

    /// Radiance scattered into an interval of a ray, per unit irradiance of a point sun.
    fn scattered(&self, ray: &Ray, span: (f64, f64), mu_s: f64, nu: f64, rule: &Gauss, exact_sun: bool) -> [f64; 3] {
        let medium = &self.medium;
        let cutting = Cutting { altitudes_m: &self.panel_altitudes, rule, panel_depth: 2.0 };
        let dark = shadow(ray, mu_s, nu);
        let cuts = dark.map_or([span.0; 2], |(from, to)| [from, to]);
        let mut samples: Vec<Sample> = Vec::new();
        march(ray, medium, &cutting, span, &cuts, &mut samples);
        let (gas, haze) = if exact_sun {
            scattered_once(ray, &samples, dark, mu_s, nu, |h, mu_s| sun_transmittance(medium, h, mu_s))
        } else {
            scattered_once(ray, &samples, dark, mu_s, nu, |h, mu_s| self.sun_table.transmittance(h, mu_s))
        };
        let mut out = with_phase(medium, nu, &gas, &haze);
        if let Some(source) = &self.source {
            let r = ray.radius_m();
            for s in &samples {
                let mu_s_there = (r * mu_s + s.distance_m * nu) / (ray.bottom_m + s.altitude_m);
                let place = source.place(s.altitude_m, s.mu);
                let (gas, haze) = source.at(&place, mu_s_there, nu, haze_matters(s));
                (0..3).for_each(|c| out[c] += s.gas[c] * gas[c] + s.haze[c] * haze[c]);
            }
        }
        out
    }
}

/// Factor on the last order that gives the sum of the orders after it as a geometric series, at one grid point.
fn geometric_tail(previous: &Nodes, last: &Nodes, node: usize) -> [f64; 3] {
    let (a, b) = (previous.total(node), last.total(node));
    std::array::from_fn(|c| {
        // A ratio above 0.98 means a medium too thick for the series to be meaningful.
        let q = if a[c] > 0.0 { (b[c] / a[c]).clamp(0.0, 0.98) } else { 0.0 };
        q / (1.0 - q)
    })
}

/// Largest share of the tail in the light, over the grid points that have more than 1e-9 of the brightest one's light.
fn largest_tail(previous: &Nodes, last: &Nodes, sum: &Nodes) -> f64 {
    let brightest = (0..sum.gas.len()).flat_map(|n| sum.total(n)).fold(0.0, f64::max);
    let share = |node: usize| {
        let (f, l, s) = (geometric_tail(previous, last, node), last.total(node), sum.total(node));
        (0..3).filter(|c| s[*c] > 1e-9 * brightest).map(|c| f[c] * l[c] / s[c]).fold(0.0, f64::max)
    };
    (0..sum.gas.len()).map(share).fold(0.0, f64::max)
}
