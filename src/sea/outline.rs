//! Outlines of regions on the ground plan: whether they cross themselves, whether a place lies inside, and how far it
//! is from the outline.

use glam::DVec2;

use crate::error::{Error, Result, check_range};

/// Maximum number of corners of an outline.
pub const MAX_OUTLINE_CORNERS: usize = 64;
/// Largest coordinate of a corner, m.
const FARTHEST_CORNER_M: f64 = 1e6;
/// Smallest area inside an outline, m^2.
const LEAST_AREA_M2: f64 = 0.01;

/// Returns the sides of an outline, each from a corner to the next.
fn sides(corners: &[[f64; 2]]) -> impl Iterator<Item = [DVec2; 2]> + Clone + '_ {
    let next = corners.iter().cycle().skip(1);
    corners.iter().zip(next).map(|(a, b)| [DVec2::from(*a), DVec2::from(*b)])
}

/// Returns on which side of a line from `a` to `b` a point lies: 1 left, -1 right, 0 on it.
fn side_of(a: DVec2, b: DVec2, p: DVec2) -> f64 {
    let turn = (b - a).perp_dot(p - a);
    if turn == 0.0 { 0.0 } else { turn.signum() }
}

/// Returns whether a point on the line through `a` and `b` lies between them.
fn is_between(a: DVec2, b: DVec2, p: DVec2) -> bool {
    p.cmpge(a.min(b)).all() && p.cmple(a.max(b)).all()
}

/// Returns whether two segments have a point in common.
fn meet([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    let (from_c, from_d) = (side_of(a, b, c), side_of(a, b, d));
    let (from_a, from_b) = (side_of(c, d, a), side_of(c, d, b));
    if from_c * from_d < 0.0 && from_a * from_b < 0.0 {
        return true;
    }
    (from_c == 0.0 && is_between(a, b, c))
        || (from_d == 0.0 && is_between(a, b, d))
        || (from_a == 0.0 && is_between(c, d, a))
        || (from_b == 0.0 && is_between(c, d, b))
}

/// Checks the corners of an outline.
///
/// # Errors
/// [`crate::Status::InvalidArgument`] naming `corner_count`, a corner such as `corners_m[2]` that is out of range, or
/// `corners_m` for an outline that crosses or touches itself or is too small.
pub(super) fn validate(corners: &[[f64; 2]]) -> Result<()> {
    check_range("corner_count", corners.len() as f64, 3.0, MAX_OUTLINE_CORNERS as f64, "")?;
    for (i, corner) in corners.iter().enumerate() {
        for v in corner {
            check_range(&format!("corners_m[{i}]"), *v, -FARTHEST_CORNER_M, FARTHEST_CORNER_M, "m")?;
        }
    }
    for (i, side) in sides(corners).enumerate() {
        if side[0] == side[1] {
            let got = format!("corners {i} and {} at the same place", (i + 1) % corners.len());
            return Err(Error::range("corners_m", "those of an outline whose corners differ", got));
        }
        for (j, other) in sides(corners).enumerate().skip(i + 2) {
            // The last side is a neighbour of the first. Neighbours share a corner. A side that runs back on its
            // neighbour also meets the side after that.
            let is_neighbour = i == 0 && j + 1 == corners.len();
            if !is_neighbour && meet(side, other) {
                let got = format!("sides {i} and {j} that meet");
                return Err(Error::range("corners_m", "those of an outline that does not cross or touch itself", got));
            }
        }
    }
    let area_m2 = 0.5 * sides(corners).map(|[a, b]| a.perp_dot(b)).sum::<f64>().abs();
    if area_m2 < LEAST_AREA_M2 {
        let accepted = format!("those of an outline of at least {LEAST_AREA_M2} m^2");
        return Err(Error::range("corners_m", &accepted, area_m2));
    }
    Ok(())
}

/// Returns whether an outline holds a point: whether a ray to the right crosses it an odd number of times.
pub(super) fn holds(corners: &[[f64; 2]], p: DVec2) -> bool {
    let crosses = |[a, b]: [DVec2; 2]| {
        if (a.y > p.y) == (b.y > p.y) {
            return false;
        }
        let turn = (b - a).perp_dot(p - a);
        (turn > 0.0) == (b.y > a.y)
    };
    sides(corners).filter(|side| crosses(*side)).count() % 2 == 1
}

/// Returns the distance of a point from an outline, m.
pub(super) fn distance_m(corners: &[[f64; 2]], p: DVec2) -> f64 {
    let square = |[a, b]: [DVec2; 2]| {
        let along = b - a;
        let share = ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
        (p - a - along * share).length_squared()
    };
    sides(corners).map(square).fold(f64::INFINITY, f64::min).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOTCHED: [[f64; 2]; 6] = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [5.0, 3.0], [0.0, 10.0], [-2.0, 5.0]];

    #[test]
    fn outlines_that_cross_or_touch_themselves_are_refused() {
        validate(&NOTCHED).expect("a notched outline");
        let mut turned = NOTCHED;
        turned.reverse();
        validate(&turned).expect("the other way round");
        for (name, corners) in [
            ("a bow tie", vec![[0.0, 0.0], [10.0, 10.0], [10.0, 0.0], [0.0, 10.0]]),
            ("a corner on a side", vec![[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [5.0, 0.0], [0.0, 10.0]]),
            ("a side that runs back", vec![[0.0, 0.0], [10.0, 0.0], [4.0, 0.0], [0.0, 10.0]]),
            ("a last side that runs back", vec![[4.0, 0.0], [10.0, 0.0], [0.0, 10.0], [0.0, 0.0], [8.0, 0.0]]),
            ("twice around", vec![[0.0, 0.0], [9.0, 0.0], [4.0, 8.0], [1.0, -1.0], [9.0, -1.0], [4.0, 9.0]]),
            ("one corner twice", vec![[0.0, 0.0], [10.0, 0.0], [10.0, 0.0], [0.0, 10.0]]),
            ("a line", vec![[0.0, 0.0], [10.0, 0.0], [20.0, 0.0]]),
            ("next to nothing", vec![[0.0, 0.0], [0.1, 0.0], [0.0, 0.1]]),
        ] {
            let e = validate(&corners).expect_err(name);
            assert_eq!(e.field(), Some("corners_m"), "{name}: {e}");
        }
        assert_eq!(validate(&NOTCHED[..2]).expect_err("two").field(), Some("corner_count"));
        assert_eq!(validate(&[[0.0; 2]; 65]).expect_err("many").field(), Some("corner_count"));
        let far = [[0.0, 0.0], [f64::NAN, 0.0], [0.0, 1.0]];
        assert_eq!(validate(&far).expect_err("far").field(), Some("corners_m[1]"));
    }

    #[test]
    fn places_inside_are_found_with_their_distance() {
        let inside = [DVec2::new(5.0, 2.0), DVec2::new(1.0, 5.0), DVec2::new(9.5, 5.0), DVec2::new(-1.5, 5.0)];
        let outside = [DVec2::new(5.0, 4.0), DVec2::new(-1.5, 8.0), DVec2::new(11.0, 5.0), DVec2::new(5.0, -1.0)];
        assert!(inside.iter().all(|p| holds(&NOTCHED, *p)) && !outside.iter().any(|p| holds(&NOTCHED, *p)));
        assert_eq!(distance_m(&NOTCHED, DVec2::new(5.0, 1.0)), 1.0);
        assert_eq!(distance_m(&NOTCHED, DVec2::new(13.0, -4.0)), 5.0);
        // By area: a million places of a square.
        let n = 1000;
        let at = |i: i32| -5.0 + 20.0 * (f64::from(i) + 0.5) / f64::from(n);
        let held = (0..n * n).filter(|i| holds(&NOTCHED, DVec2::new(at(i % n), at(i / n)))).count();
        let area = held as f64 * 400.0 / f64::from(n * n);
        assert!((area - 75.0).abs() < 0.1, "{area}");
    }
}
