//! Ribbon that an edge sweeps between two poses: which cells it passes, and which share of each.

use glam::{DVec2, DVec3};

/// Part of a cell that an edge has passed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CellShare {
    /// Cell of the lattice.
    pub place: [i32; 2],
    /// Share of the cell's area.
    pub share: f64,
    /// Centre of the part, in cells.
    pub centre: DVec2,
    /// Height of the edge at the centre, in the unit of the edge's heights.
    pub height: f64,
}

/// Largest number of corners of a triangle that is clipped to a square.
const MOST_CORNERS: usize = 8;
/// Smallest share of a cell that is taken into account.
const LEAST_SHARE: f64 = 1e-9;

/// Convex polygon in cells.
#[derive(Clone, Copy)]
struct Polygon {
    corners: [DVec2; MOST_CORNERS],
    count: usize,
}

impl Polygon {
    /// Returns the part in which coordinate `axis`, times `sign`, is at least `limit`.
    fn clipped(&self, axis: usize, sign: f64, limit: f64) -> Self {
        let mut out = Self { corners: [DVec2::ZERO; MOST_CORNERS], count: 0 };
        for i in 0..self.count {
            let (p, q) = (self.corners[i], self.corners[(i + 1) % self.count]);
            let [inside, next] = [p, q].map(|corner| sign * corner[axis] - limit);
            if inside >= 0.0 {
                out.push(p);
            }
            if (inside >= 0.0) != (next >= 0.0) {
                out.push(p + (q - p) * (inside / (inside - next)));
            }
        }
        out
    }

    fn push(&mut self, corner: DVec2) {
        if self.count < MOST_CORNERS {
            self.corners[self.count] = corner;
            self.count += 1;
        }
    }

    /// Whole numbers between which a coordinate lies.
    fn bounds(&self, axis: usize) -> [i32; 2] {
        let values = self.corners[..self.count].iter().map(|corner| corner[axis]);
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        [low.floor() as i32, high.ceil() as i32]
    }

    /// Area and centroid.
    fn area(&self) -> (f64, DVec2) {
        let (mut area, mut centre) = (0.0, DVec2::ZERO);
        let first = self.corners[0];
        for i in 2..self.count {
            let (p, q) = (self.corners[i - 1], self.corners[i]);
            let part = 0.5 * (p - first).perp_dot(q - first).abs();
            area += part;
            centre += (first + p + q) * (part / 3.0);
        }
        (area, if area > 0.0 { centre / area } else { first })
    }
}

/// Calls `act` for each cell under a triangle. Corners are in cells; the cell (i, j) reaches from (i, j) to (i + 1, j +
/// 1). Heights are linear over the triangle.
fn each_share_of_triangle(corners: [DVec3; 3], act: &mut impl FnMut(CellShare)) {
    let plan = corners.map(DVec3::truncate);
    let (u, v) = (plan[1] - plan[0], plan[2] - plan[0]);
    let doubled = u.perp_dot(v);
    if doubled.abs() < LEAST_SHARE {
        return;
    }
    let height = |p: DVec2| {
        let off = p - plan[0];
        let [along_u, along_v] = [off.perp_dot(v) / doubled, u.perp_dot(off) / doubled];
        corners[0].z + along_u * (corners[1].z - corners[0].z) + along_v * (corners[2].z - corners[0].z)
    };
    let mut whole = Polygon { corners: [DVec2::ZERO; MOST_CORNERS], count: 3 };
    whole.corners[..3].copy_from_slice(&plan);
    let [south, north] = whole.bounds(1);
    for y in south..north {
        let row = whole.clipped(1, 1.0, f64::from(y)).clipped(1, -1.0, -f64::from(y + 1));
        if row.count < 3 {
            continue;
        }
        let [west, east] = row.bounds(0);
        for x in west..east {
            let part = row.clipped(0, 1.0, f64::from(x)).clipped(0, -1.0, -f64::from(x + 1));
            if part.count < 3 {
                continue;
            }
            let (share, centre) = part.area();
            if share > LEAST_SHARE {
                act(CellShare { place: [x, y], share, centre, height: height(centre) });
            }
        }
    }
}

/// Calls `act` for each cell that an edge passes on its way between two positions. `start` has the two ends of the edge
/// at the first position, `end` those at the second, in cells. `act` can get a cell several times, with parts that do
/// not overlap. Four triangles around the middle favour no corner, so that the error on a curved way falls with the
/// square of the number of pieces into which the way is divided.
pub(super) fn each_share(start: [DVec3; 2], end: [DVec3; 2], mut act: impl FnMut(CellShare)) {
    let ring = [start[0], start[1], end[1], end[0]];
    let middle = 0.25 * ring.iter().sum::<DVec3>();
    for i in 0..4 {
        each_share_of_triangle([ring[i], ring[(i + 1) % 4], middle], &mut act);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_add_up_to_the_ribbon_however_it_is_divided() {
        let edge = |t: f64| {
            let (sine, cosine) = (0.7 * t).sin_cos();
            [DVec3::new(3.0 * cosine, 3.0 * sine, t), DVec3::new(11.0 * cosine, 11.0 * sine, 2.0 + t)]
        };
        let area = |parts: usize| {
            let (mut area, mut raised) = (0.0, 0.0);
            for i in 0..parts {
                let [start, end] = [i, i + 1].map(|i| edge(i as f64 / parts as f64));
                each_share(start, end, |part| {
                    assert!((0.0..=1.0 + 1e-12).contains(&part.share));
                    let low = DVec2::new(f64::from(part.place[0]), f64::from(part.place[1]));
                    assert!(
                        (part.centre - low).min_element() > -1e-9 && (part.centre - low).max_element() < 1.0 + 1e-9
                    );
                    area += part.share;
                    raised += part.share * part.height;
                });
            }
            [area, raised]
        };
        // The area of a ring's sector: half the angle times the difference of the squares.
        let exact = 0.5 * 0.7 * (121.0 - 9.0);
        assert!((area(200)[0] / exact - 1.0).abs() < 1e-5, "{:?}", area(200));
        let off = |parts: usize| (area(parts)[1] / area(400)[1] - 1.0).abs();
        assert!(off(10) < 2e-3 && off(20) < 0.3 * off(10), "{} {}", off(10), off(20));
        let square = [DVec3::new(0.25, 0.5, 1.0), DVec3::new(0.25, 1.5, 1.0)];
        let mut parts = Vec::new();
        each_share(square, square.map(|p| p + DVec3::X), |part| parts.push(part));
        let all: f64 = parts.iter().map(|part| part.share).sum();
        assert!((all - 1.0).abs() < 1e-12 && parts.iter().all(|part| part.height == 1.0), "{parts:?}");
    }
}
