//! Rain areas: regions on the ground plan with their own rain rate. They fade out over a rim, and move with the wind or
//! with their own velocity.
//!
//! Inside a region the area's rain replaces the weather's. At a place, the share `1 - s` of the drops belongs to the
//! weather and `s` to the area; `s` rises smoothly from 0 on the border to 1 at the inner edge of the rim. Drop
//! numbers, water and extinction are therefore linear in `s`: half-way through the rim there is half of each rain.
//! Where areas overlap, a later area in the list replaces the earlier ones in the same way, so that everything stays
//! continuous. An area of rate 0 is a dry hole.

use glam::{DMat3, DVec2, DVec3};
use serde::{Deserialize, Serialize};

use crate::{
    error::{Error, Result, check_range},
    numerics::smoothstep,
    weather::{Falling, hydrometeors},
};

/// Largest number of corners of a polygon.
pub const MAX_CORNERS: usize = 8;
/// Largest distance from a query point to an area's centre, minus the area's radius, m. A point farther away counts as
/// outside the area.
const FARTHEST_M: f64 = 3e5;

/// Shape of a region on the ground plan, in metres to the right and ahead of its centre.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum AreaShape {
    /// Half extents to the right and ahead, m, each \[10, 1e6\].
    Ellipse([f64; 2]),
    /// Corners of a convex region of more than 1 m^2, m, in order, clockwise or counter-clockwise, each coordinate
    /// within 1e6 m of the centre; and the number of corners, \[3, 8\].
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
    /// Motion with the wind at 10 m and its gusts, by the wind's displacement.
    #[default]
    WithWind,
    /// Own velocity of the area, m/s (east, north), each component within \[-200, 200\]; 0 for an area that stands
    /// still.
    Own([f64; 2]),
}

/// Region with its own rain.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RainArea {
    /// Position of the centre in the host's world at the time `at_s`, m, within 1e12 of the origin. The height of the
    /// centre does not matter.
    pub center_m: [f64; 3],
    /// Shape around the centre.
    pub shape: AreaShape,
    /// Heading of the shape's `ahead` axis: degrees clockwise from true north, \[-360, 360\].
    pub heading_deg: f64,
    /// Width of the band inside the border over which the rain fades, m, \[1, 1e6\]. It is at most the smaller half
    /// extent of an ellipse, or the radius of the largest circle inside a polygon.
    pub rim_m: f64,
    /// Rain rate at the ground, mm/h, \[0, 500\].
    pub rate_mm_h: f64,
    /// Kind of the rain.
    pub kind: AreaRain,
    /// Altitude of the cloud base that the rain falls from, m above the sea, \[-1000, 20 000\]. Above this base no
    /// rain falls inside the area: neither the area's nor, except in the rim, the weather's.
    pub top_m: f64,
    /// Motion of the area.
    pub motion: AreaMotion,
    /// Simulation time at which the centre is at `center_m`, s.
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
    /// Checks that every field but the time is within its range. The context checks the time.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field.
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

    /// Returns the precipitation inside the area.
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

/// Checks that the corners are those of a convex region of more than 1 m^2.
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

/// Returns whether the sides turn by one full turn in total, in either sense. Corners that go around twice would pass
/// the test for convexity.
fn turns_once(corners: &[[f64; 2]]) -> bool {
    let next = corners.iter().cycle().skip(1);
    let sides = corners.iter().zip(next).map(|(a, b)| DVec2::from(*b) - DVec2::from(*a));
    let sides: Vec<DVec2> = sides.filter(|s| s.length_squared() > 0.0).collect();
    let turned: f64 =
        sides.iter().zip(sides.iter().cycle().skip(1)).map(|(a, b)| libm::atan2(a.perp_dot(*b), a.dot(*b))).sum();
    turned.abs() < 1.5 * std::f64::consts::TAU
}

/// Returns the radius of the largest circle inside a convex polygon. This circle touches three of the polygon's sides.
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

/// Returns twice the area of a polygon, m^2; negative if its corners are in clockwise order.
fn twice_area(corners: &[[f64; 2]]) -> f64 {
    let next = corners.iter().cycle().skip(1);
    corners.iter().zip(next).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum()
}

/// Side of a polygon. A point p lies dot(normal, p) + offset inside it, m.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub(crate) struct Edge {
    /// Unit vector inwards, (right, ahead).
    pub normal: DVec2,
    /// Depth of the plan's centre inside the side, m.
    pub offset: f64,
}

impl Edge {
    /// Returns how deep the point `p` of the plan, (right, ahead), lies inside the side, m; negative outside.
    pub(crate) fn depth(&self, p: DVec2) -> f64 {
        self.normal.dot(p) + self.offset
    }
}

/// Returns the sides of a polygon. A side without length does not limit the region: every point lies inside it.
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

/// Outline of a region around its centre, m to the right and ahead.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Outline {
    Ellipse(DVec2),
    Polygon([Edge; MAX_CORNERS], usize),
}

impl Outline {
    /// Returns the depth of a point inside the border, m, negative outside. It is exact inside a polygon, and of first
    /// order for an ellipse.
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

/// Rain area at one time: the column of its rain from the ground to the cloud.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Shaft {
    /// Centre in the host's world, m.
    pub center: DVec3,
    /// Altitude of `center`, m.
    pub center_altitude_m: f64,
    /// Outline of the area in its plan.
    pub(crate) outline: Outline,
    /// Unit vector of the plan's axis to the right, (east, north).
    pub right: DVec2,
    /// Width of the rim over which the rain fades out, m.
    pub rim_m: f64,
    /// Horizontal shift of the column per metre of height, (east, north).
    pub lean: DVec2,
    /// Altitude at which the column's plan equals the area's plan, m.
    pub ground_m: f64,
    /// Altitude of the cloud's base, m.
    pub top_m: f64,
    /// Precipitation in the column.
    pub falling: Falling,
    /// Fall speed of the drop of median volume, m/s: half of the water is in larger drops.
    pub speed_m_s: f64,
    /// Distance of the plan's farthest point from the centre, m.
    pub radius_m: f64,
    /// Index in the host's list, which seeds the pattern.
    pub index: u32,
}

/// Largest lean of a column, m per m of height: the tangent of 72 degrees. Without this limit a gale would carry
/// drizzle from a stationary cloud farther than its area is wide.
const MOST_LEAN: f64 = 3.0;
/// Depth below the cloud over which the rain sets in, as a share of the column's height.
const SOFT_SHARE: f64 = 0.25;
/// Smallest and largest depth below the cloud over which the rain sets in, m.
const SOFT_M: [f64; 2] = [50.0, 400.0];

impl Shaft {
    /// Creates the shaft of an area whose centre is now at `center`, which has the altitude `center_altitude_m`.
    /// `speed_m_s` is the rain's fall speed, and `cloud_m_s` the velocity of the rain's cloud relative to the air
    /// through which the rain falls.
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

    /// Returns the position on the plan, (east, north) of the centre, m: the point is moved along the lean of the
    /// column to the level of the plan. `None` for a point farther away than [`FARTHEST_M`].
    fn plan(&self, position: DVec3, world_to_enu: &DMat3, altitude_m: f64) -> Option<DVec2> {
        let away = world_to_enu * (position - self.center);
        let near = away.length() <= self.radius_m + FARTHEST_M;
        near.then(|| away.truncate() - self.lean * (altitude_m - self.ground_m))
    }

    /// Turns (east, north) into (right, ahead).
    pub(crate) fn turned(&self, plan: DVec2) -> DVec2 {
        DVec2::new(plan.dot(self.right), plan.dot(self.right.perp()))
    }

    /// Returns the share of this area in the rain at a position, 0 to 1. The height of the position matters only
    /// because the column leans.
    pub fn share_at(&self, position: DVec3, world_to_enu: &DMat3, altitude_m: f64) -> f64 {
        let Some(plan) = self.plan(position, world_to_enu, altitude_m) else { return 0.0 };
        smoothstep(0.0, self.rim_m, self.outline.depth(self.turned(plan)))
    }

    /// Returns the share of the area's rain that has left its cloud at an altitude, 0 to 1.
    pub fn begun(&self, altitude_m: f64) -> f64 {
        ((self.top_m - altitude_m) / self.soft_m()).clamp(0.0, 1.0)
    }

    /// Returns the depth below the cloud over which the rain sets in, m.
    pub fn soft_m(&self) -> f64 {
        (SOFT_SHARE * (self.top_m - self.ground_m)).clamp(SOFT_M[0], SOFT_M[1])
    }

    /// Returns bounds, least and largest, of [`Shaft::share_at`] within `reach_m` of a position.
    pub fn share_within(&self, position: DVec3, world_to_enu: &DMat3, altitude_m: f64, reach_m: f64) -> [f64; 2] {
        let Some(plan) = self.plan(position, world_to_enu, altitude_m) else { return [0.0; 2] };
        // At the tips of a long ellipse the first-order depth changes faster than the distance.
        let steepest = match self.outline {
            Outline::Ellipse(semi) => 1.0 + semi.max_element() / semi.min_element(),
            Outline::Polygon(..) => 1.0,
        };
        let reach = steepest * reach_m * (1.0 + self.lean.length());
        let depth = self.outline.depth(self.turned(plan));
        [depth - reach, depth + reach].map(|d| smoothstep(0.0, self.rim_m, d))
    }
}
