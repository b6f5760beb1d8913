//! Rain areas: regions of the ground plan with a rate of their own, fading over a rim, moving with the wind or by
//! themselves.
//!
//! Inside a region the weather's rain gives way to the area's: of the drops that fall, the share `1 - s` is the
//! weather's and `s` the area's, `s` going smoothly from 0 on the border to 1 a rim further in. Numbers, water and
//! extinction are therefore linear in `s`, and half-way through the rim is half of either rate. Where areas overlap, a
//! later one of the list lies over the earlier ones in the same way, so everything stays continuous; one of rate 0 is a
//! dry hole.

use glam::{DMat3, DVec2, DVec3};
use serde::{Deserialize, Serialize};

use crate::{
    error::{Error, Result, check_range},
    numerics::smoothstep,
    weather::{Falling, hydrometeors},
};

/// Most corners of a polygon.
pub const MAX_CORNERS: usize = 8;
/// Farthest that an area's centre may lie from what it is asked for, beside its own size, m: beyond, it is another part
/// of the planet.
const FARTHEST_M: f64 = 3e5;

/// The shape of a region on the ground plan, m to the right and ahead of its centre.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum AreaShape {
    /// Half the extent to the right and ahead, each \[10, 1e6\].
    Ellipse([f64; 2]),
    /// Corners of a convex region, one after the other either way round, each coordinate within 1e6; the count,
    /// \[3, 8\].
    Polygon([[f64; 2]; MAX_CORNERS], usize),
}

/// Kind of rain in an area.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum AreaRain {
    /// Steady rain.
    #[default]
    Rain,
    /// Showers: fewer and larger drops.
    Showers,
    /// Drizzle.
    Drizzle,
}

/// Motion of an area.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub enum AreaMotion {
    /// The wind at 10 m with its gusts, by its displacement.
    #[default]
    WithWind,
    /// A velocity of its own, m/s (east, north), each within \[-200, 200\]; 0 for what stands.
    Own([f64; 2]),
}

/// A region with rain of its own.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RainArea {
    /// Its centre in the host's world at the time `at_s`, m, within 1e12 of the origin; its height does not matter.
    pub center_m: [f64; 3],
    /// Its shape about the centre.
    pub shape: AreaShape,
    /// Where `ahead` of the shape points: degrees clockwise from true north, \[-360, 360\].
    pub heading_deg: f64,
    /// Width inside of the border over which the rain fades, m, \[1, 1e6\]; at most an ellipse's smaller half extent,
    /// or the radius of the largest circle in a polygon.
    pub rim_m: f64,
    /// Rate at the ground, mm/h, \[0, 500\].
    pub rate_mm_h: f64,
    /// Kind of the rain.
    pub kind: AreaRain,
    /// Altitude above the sea of the cloud base that it falls from, m, \[-1000, 20 000\]: above it there is neither the
    /// area's rain nor the weather's.
    pub top_m: f64,
    /// Motion of the area.
    pub motion: AreaMotion,
    /// Simulation time at which the centre is where it is said to be, s.
    pub at_s: f64,
}

impl Default for RainArea {
    fn default() -> Self {
        Self {
            center_m: [0.0; 3],
            shape: AreaShape::Ellipse([2000.0, 2000.0]),
            heading_deg: 0.0,
            rim_m: 500.0,
            rate_mm_h: 10.0,
            kind: AreaRain::default(),
            top_m: 1500.0,
            motion: AreaMotion::default(),
            at_s: 0.0,
        }
    }
}

impl RainArea {
    /// Refuses what is no area, by name. The time is the context's to check.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`].
    pub fn validate(&self) -> Result<()> {
        let center = DVec3::from(self.center_m);
        if !(center.is_finite() && center.length() <= 1e12) {
            return Err(Error::range("rain_area.center_m", "finite and within 1e12 m", center));
        }
        check_range("rain_area.heading_deg", self.heading_deg, -360.0, 360.0, "deg")?;
        check_range("rain_area.rim_m", self.rim_m, 1.0, 1e6, "m")?;
        match &self.shape {
            AreaShape::Ellipse(semi) => {
                for v in semi {
                    check_range("rain_area.semi_axes_m", *v, 10.0, 1e6, "m")?;
                }
                check_range("rain_area.rim_m", self.rim_m, 1.0, semi[0].min(semi[1]), "m")?;
            }
            AreaShape::Polygon(corners, count) => {
                validate_corners(corners, *count)?;
                let inner = inner_radius(&edges(&corners[..*count])[..*count]);
                check_range("rain_area.rim_m", self.rim_m, 1.0, inner.max(1.0), "m")?;
            }
        }
        check_range("rain_area.rate_mm_h", self.rate_mm_h, 0.0, 500.0, "mm/h")?;
        check_range("rain_area.top_m", self.top_m, -1000.0, 20_000.0, "m")?;
        if let AreaMotion::Own(v) = self.motion {
            for v in v {
                check_range("rain_area.velocity_m_s", v, -200.0, 200.0, "m/s")?;
            }
        }
        Ok(())
    }

    /// Returns the precipitation inside of it.
    pub fn falling(&self) -> Falling {
        let only = |kind, v: f64| if self.kind == kind { v } else { 0.0 };
        let drizzle = only(AreaRain::Drizzle, self.rate_mm_h);
        let extinction = match self.kind {
            AreaRain::Rain => hydrometeors::rain_extinction_per_m(self.rate_mm_h),
            AreaRain::Showers => hydrometeors::shower_extinction_per_m(self.rate_mm_h),
            AreaRain::Drizzle => hydrometeors::drizzle_extinction_per_m(self.rate_mm_h),
        };
        Falling {
            rain_mm_h: self.rate_mm_h - drizzle,
            drizzle_mm_h: drizzle,
            snow_mm_h: 0.0,
            grain_share: 0.0,
            crystal_share: 0.0,
            ice_pellets_mm_h: 0.0,
            hail_mm_h: 0.0,
            freezing: 0.0,
            showers: only(AreaRain::Showers, 1.0),
            thunder: 0.0,
            liquid_extinction_per_m: extinction,
            solid_extinction_per_m: 0.0,
        }
    }
}

fn validate_corners(corners: &[[f64; 2]; MAX_CORNERS], count: usize) -> Result<()> {
    check_range("rain_area.corner_count", count as f64, 3.0, MAX_CORNERS as f64, "")?;
    let corners = &corners[..count];
    for v in corners.iter().flatten() {
        check_range("rain_area.corners_m", *v, -1e6, 1e6, "m")?;
    }
    let edges = edges(corners);
    let flat = || Error::range("rain_area.corners_m", "those of a convex region of more than 1 m^2", "others");
    let area = 0.5 * twice_area(corners).abs();
    let convex = edges[..count].iter().all(|e| corners.iter().all(|c| e.depth(DVec2::from(*c)) > -1e-6 * area.sqrt()));
    if area > 1.0 && convex && turns_once(corners) { Ok(()) } else { Err(flat()) }
}

/// Whether the sides turn by one round in all: corners that go round twice are convex too.
fn turns_once(corners: &[[f64; 2]]) -> bool {
    let next = corners.iter().cycle().skip(1);
    let sides = corners.iter().zip(next).map(|(a, b)| DVec2::from(*b) - DVec2::from(*a));
    let sides: Vec<DVec2> = sides.filter(|s| s.length_squared() > 0.0).collect();
    let turned: f64 =
        sides.iter().zip(sides.iter().cycle().skip(1)).map(|(a, b)| libm::atan2(a.perp_dot(*b), a.dot(*b))).sum();
    turned.abs() < 1.5 * std::f64::consts::TAU
}

/// Radius of the largest circle inside of sides: it touches three of them.
fn inner_radius(edges: &[Edge]) -> f64 {
    let mut most = 0.0f64;
    for (i, a) in edges.iter().enumerate() {
        for (j, b) in edges.iter().enumerate().skip(i + 1) {
            for c in &edges[j + 1..] {
                let rows = [a, b, c].map(|e| e.normal.extend(-1.0));
                let touching = DMat3::from_cols(rows[0], rows[1], rows[2]).transpose();
                if touching.determinant().abs() < 1e-12 {
                    continue;
                }
                let at = touching.inverse() * -DVec3::new(a.offset, b.offset, c.offset);
                if edges.iter().all(|e| e.depth(at.truncate()) >= at.z * (1.0 - 1e-9) - 1e-9) {
                    most = most.max(at.z);
                }
            }
        }
    }
    most
}

fn twice_area(corners: &[[f64; 2]]) -> f64 {
    let next = corners.iter().cycle().skip(1);
    corners.iter().zip(next).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum()
}

/// A side of a polygon: how deep inside of it a point lies is `normal . p + offset`.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub(crate) struct Edge {
    pub normal: DVec2,
    pub offset: f64,
}

impl Edge {
    pub(crate) fn depth(&self, p: DVec2) -> f64 {
        self.normal.dot(p) + self.offset
    }
}

/// The sides of a polygon. One that has no length says nothing: every point lies inside.
fn edges(corners: &[[f64; 2]]) -> [Edge; MAX_CORNERS] {
    let turn = twice_area(corners).signum();
    let mut edges = [Edge { normal: DVec2::ZERO, offset: 1e9 }; MAX_CORNERS];
    for (i, edge) in edges.iter_mut().enumerate().take(corners.len()) {
        let [a, b] = [corners[i], corners[(i + 1) % corners.len()]].map(DVec2::from);
        if let Some(along) = (b - a).try_normalize() {
            let normal = along.perp() * turn;
            *edge = Edge { normal, offset: -normal.dot(a) };
        }
    }
    edges
}

/// A region about its centre, m to the right and ahead.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Outline {
    Ellipse(DVec2),
    Polygon([Edge; MAX_CORNERS], usize),
}

impl Outline {
    /// How deep inside the border a point lies, m, negative outside: exact of a polygon, to first order of an ellipse.
    pub(crate) fn depth(&self, p: DVec2) -> f64 {
        match self {
            Self::Ellipse(semi) => {
                let k = p / *semi;
                let [k1, k2] = [k.length(), (k / *semi).length()];
                (1.0 - k1) * if k1 < 1e-4 { semi.min_element() } else { k1 / k2 }
            }
            Self::Polygon(edges, count) => edges[..*count].iter().map(|e| e.depth(p)).fold(f64::INFINITY, f64::min),
        }
    }
}

/// An area at a moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Shaft {
    /// In the host's world, m.
    pub center: DVec3,
    /// Altitude of the place of `center`, m.
    pub center_altitude_m: f64,
    pub(crate) outline: Outline,
    /// The way to the right: unit vector (east, north).
    pub right: DVec2,
    pub rim_m: f64,
    /// Metres east and north that the column moves aside a metre of height.
    pub lean: DVec2,
    /// Altitude at which the plan holds, m.
    pub ground_m: f64,
    /// Altitude of the cloud's base, m.
    pub top_m: f64,
    /// Precipitation in it.
    pub falling: Falling,
    /// Fall speed of the drop that divides its water into halves, m/s.
    pub speed_m_s: f64,
    /// Farthest point of the plan from the centre, m.
    pub radius_m: f64,
    /// Place in the host's list: what its pattern is known by.
    pub index: u32,
}

/// Most that a column leans: 72 degrees. Drizzle in a gale from a cloud that stands would be blown further than its
/// area is wide.
const MOST_LEAN: f64 = 3.0;
/// Share of a column's height, and depths, m, between which lies the part below the cloud in which the rain sets in.
const SOFT_SHARE: f64 = 0.25;
const SOFT_M: [f64; 2] = [50.0, 400.0];

impl Shaft {
    /// Creates the shaft of an area whose centre has come to `center`, of place altitude `center_altitude_m`;
    /// `cloud_m_s` is the velocity of what it falls from relative to the air that it falls through.
    pub fn new(
        area: &RainArea,
        index: u32,
        (center, center_altitude_m): (DVec3, f64),
        (speed_m_s, cloud_m_s): (f64, DVec2),
        ground_m: f64,
    ) -> Self {
        let (sin, cos) = libm::sincos(area.heading_deg.to_radians());
        let (outline, radius_m) = match &area.shape {
            AreaShape::Ellipse(semi) => (Outline::Ellipse(DVec2::from(*semi)), semi[0].max(semi[1])),
            AreaShape::Polygon(corners, count) => {
                let far = corners[..*count].iter().map(|c| DVec2::from(*c).length()).fold(0.0, f64::max);
                (Outline::Polygon(edges(&corners[..*count]), *count), far)
            }
        };
        Self {
            center,
            center_altitude_m,
            outline,
            right: DVec2::new(cos, -sin),
            rim_m: area.rim_m,
            lean: (cloud_m_s / speed_m_s.max(0.1)).clamp_length_max(MOST_LEAN),
            ground_m,
            top_m: area.top_m,
            falling: area.falling(),
            speed_m_s,
            radius_m,
            index,
        }
    }

    /// Where a place lies on the plan, east and north of the centre, following the lean of the column down; `None` if
    /// it lies on another part of the planet.
    fn plan(&self, position: DVec3, world_to_enu: &DMat3, altitude_m: f64) -> Option<DVec2> {
        let away = world_to_enu * (position - self.center);
        let near = away.length() <= self.radius_m + FARTHEST_M;
        near.then(|| away.truncate() - self.lean * (altitude_m - self.ground_m))
    }

    /// From east and north of the centre to right and ahead.
    pub(crate) fn turned(&self, plan: DVec2) -> DVec2 {
        DVec2::new(plan.dot(self.right), plan.dot(self.right.perp()))
    }

    /// Share of the rain at a place that is this area's, 0 to 1, at any height.
    pub fn share_at(&self, position: DVec3, world_to_enu: &DMat3, altitude_m: f64) -> f64 {
        let Some(plan) = self.plan(position, world_to_enu, altitude_m) else { return 0.0 };
        smoothstep(0.0, self.rim_m, self.outline.depth(self.turned(plan)))
    }

    /// Share of the area's rain that has left its cloud at an altitude.
    pub fn begun(&self, altitude_m: f64) -> f64 {
        ((self.top_m - altitude_m) / self.soft_m()).clamp(0.0, 1.0)
    }

    /// Depth below the cloud within which the rain sets in, m.
    pub fn soft_m(&self) -> f64 {
        (SOFT_SHARE * (self.top_m - self.ground_m)).clamp(SOFT_M[0], SOFT_M[1])
    }

    /// Between which values [`Shaft::share_at`] lies within `reach_m` of a place.
    pub fn share_within(&self, position: DVec3, world_to_enu: &DMat3, altitude_m: f64, reach_m: f64) -> [f64; 2] {
        let Some(plan) = self.plan(position, world_to_enu, altitude_m) else { return [0.0; 2] };
        // The first-order depth changes faster than the way at the tips of a long ellipse.
        let steepest = match self.outline {
            Outline::Ellipse(semi) => 1.0 + semi.max_element() / semi.min_element(),
            Outline::Polygon(..) => 1.0,
        };
        let reach = steepest * reach_m * (1.0 + self.lean.length());
        let depth = self.outline.depth(self.turned(plan));
        [depth - reach, depth + reach].map(|d| smoothstep(0.0, self.rim_m, d))
    }
}
