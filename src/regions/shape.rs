//! Shapes of regions on the ground plan: validation, and the signed distance of a point from the border.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use crate::error::{Error, Result, check_range};

/// Largest number of corners of a polygon.
pub const MAX_REGION_CORNERS: usize = 16;
/// Largest half extent of a shape, and largest coordinate of a corner, m.
const MOST_HALF_M: f64 = 1e6;
/// Smallest half extent of a shape, m.
const LEAST_HALF_M: f64 = 1.0;

/// Shape of a region on the ground plan, in metres to the right of its heading and along it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[expect(
    clippy::large_enum_variant,
    reason = "at most 64 shapes are held, and corners on the heap would be no plain data"
)]
pub enum RegionShape {
    /// Rectangle with round corners.
    Rectangle {
        /// Half extents to the right and along the heading, m, each \[1, 1e6\].
        half_m: [f64; 2],
        /// Radius of the corners, m, \[0, the smaller half extent\]. The largest radius turns a square into a circle.
        corner_radius_m: f64,
    },
    /// Ellipse.
    Ellipse {
        /// Half extents to the right and along the heading, m, each \[1, 1e6\].
        half_m: [f64; 2],
    },
    /// Simple polygon, convex or not.
    Polygon {
        /// Corners in order, in either sense, each coordinate within 1e6 m. Sides must not cross or touch others, and
        /// the area must be above 1 m^2.
        corners_m: [[f64; 2]; MAX_REGION_CORNERS],
        /// Number of corners, \[3, 16\].
        count: usize,
    },
}

impl RegionShape {
    /// Checks that every field is within its range and that a polygon's sides do not cross.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field.
    pub fn validate(&self) -> Result<()> {
        match self {
            Self::Rectangle { half_m, corner_radius_m } => {
                check_halves(half_m)?;
                let most = half_m[0].min(half_m[1]);
                check_range("weather_region.corner_radius_m", *corner_radius_m, 0.0, most, "m")
            }
            Self::Ellipse { half_m } => check_halves(half_m),
            Self::Polygon { corners_m, count } => check_corners(corners_m, *count),
        }
    }

    /// Returns the kind of the shape, by which shaders and their pipelines differ: 0 rectangle, 1 ellipse, 2 convex
    /// polygon, 3 other polygon.
    pub(crate) fn kind(&self) -> u32 {
        match self {
            Self::Rectangle { .. } => 0,
            Self::Ellipse { .. } => 1,
            Self::Polygon { corners_m, count } if is_convex(&corners_m[..*count]) => 2,
            Self::Polygon { .. } => 3,
        }
    }

    /// Returns the distance of a point of the plan from the border, m: positive outside, negative inside.
    pub(crate) fn distance(&self, p: DVec2) -> f64 {
        match self {
            Self::Rectangle { half_m, corner_radius_m } => {
                let q = p.abs() - DVec2::from(*half_m) + *corner_radius_m;
                q.max(DVec2::ZERO).length() + q.max_element().min(0.0) - corner_radius_m
            }
            Self::Ellipse { half_m } => ellipse_distance(DVec2::from(*half_m), p),
            Self::Polygon { corners_m, count } => polygon_distance(&corners_m[..*count], p),
        }
    }

    /// Returns the radius, m, of the smallest circle around the centre that holds the shape. For a rectangle with round
    /// corners it is the larger circle through the corners without rounding.
    pub(crate) fn radius_m(&self) -> f64 {
        match self {
            Self::Rectangle { half_m, .. } => DVec2::from(*half_m).length(),
            Self::Ellipse { half_m } => half_m[0].max(half_m[1]),
            Self::Polygon { corners_m, count } => {
                corners_m[..*count].iter().map(|c| DVec2::from(*c).length()).fold(0.0, f64::max)
            }
        }
    }
}

/// Returns the turn at each corner of a polygon: above 0 to the left.
pub(crate) fn turns(corners: &[[f64; 2]]) -> impl Iterator<Item = f64> {
    let count = corners.len();
    let corner = move |i: usize| DVec2::from(corners[i % count]);
    (0..count).map(move |i| (corner(i + 1) - corner(i)).perp_dot(corner(i + 2) - corner(i + 1)))
}

/// Whether a polygon is convex.
fn is_convex(corners: &[[f64; 2]]) -> bool {
    let (left, right) = (turns(corners).any(|turn| turn > 0.0), turns(corners).any(|turn| turn < 0.0));
    // A polygon that does not cross itself, and whose corners all turn one way, makes one full turn.
    left != right
}

/// Checks the half extents of a rectangle or an ellipse.
fn check_halves(half_m: &[f64; 2]) -> Result<()> {
    half_m.iter().try_for_each(|v| check_range("weather_region.half_size_m", *v, LEAST_HALF_M, MOST_HALF_M, "m"))
}

/// Checks that the corners are those of a simple polygon of more than 1 m^2.
fn check_corners(corners: &[[f64; 2]; MAX_REGION_CORNERS], count: usize) -> Result<()> {
    check_range("weather_region.corner_count", count as f64, 3.0, MAX_REGION_CORNERS as f64, "")?;
    let corners = &corners[..count];
    for v in corners.iter().flatten() {
        check_range("weather_region.corners_m", *v, -MOST_HALF_M, MOST_HALF_M, "m")?;
    }
    let refused = |got: &str| {
        Err(Error::range("weather_region.corners_m", "those of a polygon of more than 1 m^2 without crossings", got))
    };
    let side = |i: usize| [corners[i], corners[(i + 1) % count]].map(DVec2::from);
    let twice_area: f64 = (0..count).map(|i| side(i)[0].perp_dot(side(i)[1])).sum();
    if twice_area.abs() <= 2.0 {
        return refused("a smaller one");
    }
    for i in 0..count {
        for j in i + 1..count {
            let (a, b) = (side(i), side(j));
            let crosses = if j == i + 1 {
                folds_back(b[0], a[0], b[1])
            } else if i == 0 && j == count - 1 {
                folds_back(a[0], a[1], b[0])
            } else {
                segments_meet(a, b)
            };
            if crosses {
                return refused("sides that cross or touch");
            }
        }
    }
    Ok(())
}

/// Whether, of two sides that share `corner` and end at `a` and `b`, one has no length or both overlap.
fn folds_back(corner: DVec2, a: DVec2, b: DVec2) -> bool {
    let (a, b) = (a - corner, b - corner);
    a == DVec2::ZERO || b == DVec2::ZERO || (a.perp_dot(b) == 0.0 && a.dot(b) > 0.0)
}

/// Whether two segments have a point in common.
fn segments_meet(a: [DVec2; 2], b: [DVec2; 2]) -> bool {
    let turn = |s: [DVec2; 2], p: DVec2| (s[1] - s[0]).perp_dot(p - s[0]);
    let holds =
        |s: [DVec2; 2], p: DVec2| turn(s, p) == 0.0 && p.cmpge(s[0].min(s[1])).all() && p.cmple(s[0].max(s[1])).all();
    let [a0, a1, b0, b1] = [turn(b, a[0]), turn(b, a[1]), turn(a, b[0]), turn(a, b[1])];
    let opposite = |p: f64, q: f64| (p > 0.0 && q < 0.0) || (p < 0.0 && q > 0.0);
    (opposite(a0, a1) && opposite(b0, b1)) || holds(b, a[0]) || holds(b, a[1]) || holds(a, b[0]) || holds(a, b[1])
}

/// Returns the signed distance of a point from a simple polygon, m.
fn polygon_distance(corners: &[[f64; 2]], p: DVec2) -> f64 {
    let mut nearest = f64::INFINITY;
    let mut inside = false;
    let mut before = DVec2::from(corners[corners.len() - 1]);
    for corner in corners {
        let corner = DVec2::from(*corner);
        let (side, away) = (corner - before, p - before);
        let along = (away.dot(side) / side.length_squared()).clamp(0.0, 1.0);
        nearest = nearest.min((away - side * along).length());
        // A ray from the point to the right crosses this side.
        if (corner.y > p.y) != (before.y > p.y) && p.x < before.x + side.x * (p.y - before.y) / side.y {
            inside = !inside;
        }
        before = corner;
    }
    if inside { -nearest } else { nearest }
}

/// Returns the signed distance of a point from an ellipse, m. The nearest point depends on one parameter, which is
/// found by bisection (Eberly 2013, "Distance from a point to an ellipse"); this converges for every point.
fn ellipse_distance(half: DVec2, p: DVec2) -> f64 {
    // The longer axis comes first.
    let (e, y) =
        if half.x < half.y { (DVec2::new(half.y, half.x), DVec2::new(p.y, p.x).abs()) } else { (half, p.abs()) };
    if y.y == 0.0 {
        let (reach, room) = (e.x * y.x, e.x * e.x - e.y * e.y);
        if reach >= room {
            return y.x - e.x;
        }
        let share = reach / room;
        return -DVec2::new(e.x * share - y.x, e.y * (1.0 - share * share).sqrt()).length();
    }
    if y.x == 0.0 {
        return y.y - e.y;
    }
    let z = y / e;
    let outside = z.length_squared() - 1.0;
    let ratio = (e.x / e.y) * (e.x / e.y);
    let first = ratio * z.x;
    let mut low = z.y - 1.0;
    let mut high = if outside < 0.0 { 0.0 } else { DVec2::new(first, z.y).length() - 1.0 };
    let mut middle = low;
    for _ in 0..200 {
        middle = 0.5 * (low + high);
        if middle == low || middle == high {
            break;
        }
        let (a, b) = (first / (middle + ratio), z.y / (middle + 1.0));
        if a * a + b * b > 1.0 { low = middle } else { high = middle }
    }
    let nearest = DVec2::new(ratio * y.x / (middle + ratio), y.y / (middle + 1.0));
    (nearest - y).length() * outside.signum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polygon(corners: &[[f64; 2]]) -> RegionShape {
        let mut corners_m = [[0.0; 2]; MAX_REGION_CORNERS];
        corners_m[..corners.len()].copy_from_slice(corners);
        RegionShape::Polygon { corners_m, count: corners.len() }
    }

    /// An L, which is not convex, in clockwise order.
    fn l_shape() -> RegionShape {
        polygon(&[[0.0, 0.0], [0.0, 3000.0], [1000.0, 3000.0], [1000.0, 1000.0], [2500.0, 1000.0], [2500.0, 0.0]])
    }

    /// Returns points that lie densely along the border of a shape.
    fn border(shape: &RegionShape) -> Vec<DVec2> {
        let on_side = |a: DVec2, b: DVec2| (0..4000).map(move |i| a.lerp(b, f64::from(i) / 4000.0));
        match shape {
            RegionShape::Ellipse { half_m } => (0..40_000)
                .map(|i| f64::from(i) / 40_000.0 * std::f64::consts::TAU)
                .map(|a| DVec2::new(half_m[0] * a.cos(), half_m[1] * a.sin()))
                .collect(),
            RegionShape::Rectangle { half_m, corner_radius_m: r } => {
                let inner = DVec2::from(*half_m) - *r;
                let arc = (0..4000)
                    .map(|i| f64::from(i) / 4000.0 * std::f64::consts::FRAC_PI_2)
                    .map(|a| inner + DVec2::new(a.cos(), a.sin()) * *r);
                let sides = on_side(DVec2::new(half_m[0], 0.0), DVec2::new(half_m[0], inner.y))
                    .chain(on_side(DVec2::new(0.0, half_m[1]), DVec2::new(inner.x, half_m[1])));
                let quarter: Vec<DVec2> = arc.chain(sides).collect();
                let turned = |s: DVec2| quarter.iter().map(move |p| *p * s).collect::<Vec<_>>();
                [[1.0, 1.0], [-1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]]
                    .into_iter()
                    .flat_map(|s| turned(DVec2::from(s)))
                    .collect()
            }
            RegionShape::Polygon { corners_m, count } => (0..*count)
                .flat_map(|i| on_side(DVec2::from(corners_m[i]), DVec2::from(corners_m[(i + 1) % count])))
                .collect(),
        }
    }

    #[test]
    fn distances_are_those_of_the_nearest_points_of_the_border() {
        let shapes = [
            RegionShape::Rectangle { half_m: [3000.0, 1200.0], corner_radius_m: 700.0 },
            RegionShape::Rectangle { half_m: [1000.0, 2000.0], corner_radius_m: 0.0 },
            RegionShape::Rectangle { half_m: [900.0, 900.0], corner_radius_m: 900.0 },
            RegionShape::Ellipse { half_m: [5000.0, 400.0] },
            RegionShape::Ellipse { half_m: [800.0, 800.0] },
            RegionShape::Ellipse { half_m: [300.0, 2500.0] },
            l_shape(),
        ];
        for shape in shapes {
            shape.validate().unwrap();
            let border = border(&shape);
            let (mut inside, mut outside) = (0, 0);
            for i in 0..400 {
                let p = DVec2::new(f64::from(i % 20) * 641.0 - 6000.0, f64::from(i / 20) * 389.0 - 3700.0);
                let d = shape.distance(p);
                let nearest = border.iter().map(|b| (*b - p).length()).fold(f64::INFINITY, f64::min);
                assert!((d.abs() - nearest).abs() < 1.0, "{shape:?} {p}: {d} against {nearest}");
                if d < 0.0 { inside += 1 } else { outside += 1 }
            }
            assert!(inside > 0 && outside > 0, "{shape:?}: {inside} inside, {outside} outside");
            assert!(border.iter().all(|b| b.length() <= shape.radius_m() * (1.0 + 1e-12)));
        }
    }

    #[test]
    fn no_step_of_a_millimetre_changes_a_distance_by_more() {
        let shapes = [
            RegionShape::Ellipse { half_m: [50_000.0, 60.0] },
            RegionShape::Ellipse { half_m: [700.0, 690.0] },
            l_shape(),
        ];
        for shape in shapes {
            for i in 0..3000 {
                let angle = f64::from(i) * 0.7;
                let p = DVec2::new(angle.cos(), angle.sin()) * f64::from(i * 23);
                for step in [DVec2::X, DVec2::Y, DVec2::new(0.6, 0.8)] {
                    let change = shape.distance(p + step * 1e-3) - shape.distance(p);
                    assert!(change.abs() <= 1e-3 + 1e-9, "{shape:?} at {p}: {change}");
                }
            }
        }
    }

    #[test]
    fn shapes_that_cross_themselves_and_radii_beyond_the_half_are_refused_by_name() {
        let bow_tie = polygon(&[[0.0, 0.0], [100.0, 100.0], [100.0, 0.0], [0.0, 100.0]]);
        let uneven_tie = polygon(&[[0.0, 0.0], [100.0, 150.0], [100.0, 0.0], [0.0, 100.0]]);
        let touching = polygon(&[[0.0, 0.0], [200.0, 0.0], [200.0, 100.0], [100.0, 0.0], [0.0, 100.0]]);
        let spike = polygon(&[[0.0, 0.0], [100.0, 0.0], [100.0, 100.0], [100.0, 40.0], [0.0, 100.0]]);
        let twice = polygon(&[[0.0, 0.0], [0.0, 0.0], [100.0, 0.0], [100.0, 100.0]]);
        let flat = polygon(&[[0.0, 0.0], [100.0, 0.0], [50.0, 0.001]]);
        for shape in [bow_tie, uneven_tie, touching, spike, twice, flat] {
            let e = shape.validate().expect_err("refused").to_string();
            assert!(e.contains("weather_region.corners_m"), "{shape:?}: {e}");
        }
        let halves = [[100.0, 50.0], [f64::NAN, 50.0], [0.0, 50.0], [100.0, 2e6]];
        let rectangle = |half_m, corner_radius_m| RegionShape::Rectangle { half_m, corner_radius_m };
        let e = rectangle(halves[0], 50.001).validate().expect_err("a radius beyond the half").to_string();
        assert!(e.contains("weather_region.corner_radius_m must be in [0, 50]"), "{e}");
        for half_m in &halves[1..] {
            for shape in [rectangle(*half_m, 0.0), RegionShape::Ellipse { half_m: *half_m }] {
                assert!(shape.validate().expect_err("refused").to_string().contains("weather_region.half_size_m"));
            }
        }
        let mut corners_m = [[0.0; 2]; MAX_REGION_CORNERS];
        corners_m[1] = [100.0, f64::NAN];
        corners_m[2] = [0.0, 100.0];
        let broken = |count| RegionShape::Polygon { corners_m, count }.validate().expect_err("refused").to_string();
        assert!(broken(3).contains("weather_region.corners_m"));
        assert!(
            broken(2).contains("weather_region.corner_count") && broken(17).contains("weather_region.corner_count")
        );
    }
}
