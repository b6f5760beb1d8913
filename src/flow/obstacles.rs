//! Terrain and boxes in the air, as open shares of faces.
//!
//! Heights are exact along a face's vertical; along its level sides [`SAMPLES`] places count. So terrain slopes through cells rather than
//! standing in them as stairs, and a box may end anywhere within a cell. A box thinner than a cell stands as one cell thick, so
//! that no air passes between two faces that it lies between.

use glam::{DVec2, DVec3};

use super::lattice::{Faces, Lattice};
use crate::error::{Error, Result, check_range};

/// Places along each level side of a face at which obstacles are looked up.
const SAMPLES: usize = 8;
/// What lies nearer to a face than this share of a cell lies on it.
const NEAR: f64 = 1e-6;

/// A box in the air, level, turned about the vertical. Lengths count from the lowest corner of the field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlowBox {
    /// Its middle, m.
    pub center_m: DVec3,
    /// Half its size along its own axes, m, \[1e-3, 1e5\].
    pub half_size_m: DVec3,
    /// How far it is turned, degrees, counter-clockwise seen from above, \[-360, 360\].
    pub turned_deg: f64,
}

/// Height of the ground above the lowest corner of the field at a place east and north of it, m.
pub type Heights<'a> = &'a dyn Fn(DVec2) -> f64;

/// What stands in the air.
#[derive(Clone, Copy, Default)]
pub struct FlowObstacles<'a> {
    /// The ground; none: the field's lowest side.
    pub terrain: Option<Heights<'a>>,
    /// Boxes.
    pub boxes: &'a [FlowBox],
}

/// A box as one grid meets it.
struct Footprint {
    center: DVec2,
    along: DVec2,
    half: DVec2,
    low: f64,
    high: f64,
}

impl Footprint {
    fn covers(&self, place: DVec2) -> bool {
        let from = place - self.center;
        from.dot(self.along).abs() <= self.half.x && from.perp_dot(self.along).abs() <= self.half.y
    }
}

impl FlowObstacles<'_> {
    fn check(&self, lattice: &Lattice) -> Result<()> {
        let size = DVec3::from([0, 1, 2].map(|a| lattice.n[a] as f64 * f64::from(lattice.h[a])));
        for (i, b) in self.boxes.iter().enumerate() {
            let name = |field: &str| format!("flow.boxes[{i}].{field}");
            for v in b.half_size_m.to_array() {
                check_range(&name("half_size_m"), v, 1e-3, 1e5, "m")?;
            }
            check_range(&name("turned_deg"), b.turned_deg, -360.0, 360.0, "")?;
            let reach =
                DVec3::new(b.half_size_m.truncate().length(), b.half_size_m.truncate().length(), b.half_size_m.z);
            let is_in = (b.center_m + reach).cmpgt(DVec3::ZERO).all() && (b.center_m - reach).cmplt(size).all();
            if !(b.center_m.is_finite() && is_in) {
                return Err(Error::range(&name("center_m"), "such that the box reaches into the field", b.center_m));
            }
        }
        Ok(())
    }

    fn footprints(&self, lattice: &Lattice) -> Vec<Footprint> {
        let [hx, hy, hz] = lattice.h.map(f64::from);
        let footprint = |b: &FlowBox| {
            let angle = b.turned_deg.to_radians();
            let along = DVec2::new(libm::cos(angle), libm::sin(angle));
            let thinnest =
                0.5 * DVec2::new(along.x.abs() * hx + along.y.abs() * hy, along.y.abs() * hx + along.x.abs() * hy);
            let half = b.half_size_m.truncate().max(thinnest) + NEAR * hx.min(hy);
            let half_height = b.half_size_m.z.max(0.5 * hz) + NEAR * hz;
            let (low, high) = (b.center_m.z - half_height, b.center_m.z + half_height);
            Footprint { center: b.center_m.truncate(), along, half, low, high }
        };
        self.boxes.iter().map(footprint).collect()
    }

    /// Open shares of all faces of a grid.
    pub(super) fn open(&self, lattice: &Lattice) -> Result<Faces> {
        let mut open = lattice.zeros().map(|v| vec![1.0; v.len()]);
        if self.terrain.is_none() && self.boxes.is_empty() {
            return Ok(open);
        }
        self.check(lattice)?;
        let footprints = self.footprints(lattice);
        let h = lattice.h.map(f64::from);
        let mut column = Column { h: h[2], spans: Vec::new() };
        for c in lattice.axes() {
            let [nx, ny, nz] = [0, 1, 2].map(|a| lattice.count(c, a));
            // Across the face's plane one place is enough.
            let count = |a: usize| if a == c || lattice.is_flat(a) { 1 } else { SAMPLES };
            let along = |a: usize, i: usize, s: usize| match a == c && !lattice.is_flat(a) {
                true => i as f64 * h[a],
                false => (i as f64 + (s as f64 + 0.5) / count(a) as f64) * h[a],
            };
            let share = 1.0 / (count(0) * count(1)) as f64;
            let mut closed = vec![0.0; nz];
            for j in 0..ny {
                for i in 0..nx {
                    closed.fill(0.0);
                    for (t, s) in (0..count(1)).flat_map(|t| (0..count(0)).map(move |s| (t, s))) {
                        let place = DVec2::new(along(0, i, s), along(1, j, t));
                        column.find(self.terrain, &footprints, place)?;
                        let of = |k| if c == 2 { column.closed_at(k) } else { column.closed_within(k) };
                        closed.iter_mut().enumerate().for_each(|(k, v)| *v += share * of(k));
                    }
                    for (k, v) in closed.iter().enumerate() {
                        open[c][lattice.at([i, j, k])] = (1.0 - v) as f32;
                    }
                }
            }
        }
        Ok(open)
    }
}

/// What is solid above a place.
struct Column {
    h: f64,
    /// From and to a height, lowest first, apart from each other.
    spans: Vec<[f64; 2]>,
}

impl Column {
    fn find(&mut self, terrain: Option<Heights>, footprints: &[Footprint], place: DVec2) -> Result<()> {
        self.spans.clear();
        if let Some(heights) = terrain {
            let ground = heights(place);
            if !ground.is_finite() {
                let got = format!("{ground} at {place}");
                return Err(Error::range("flow.terrain", "a finite height everywhere in the field", got));
            }
            self.spans.push([f64::NEG_INFINITY, ground + NEAR * self.h]);
        }
        self.spans.extend(footprints.iter().filter(|f| f.covers(place)).map(|f| [f.low, f.high]));
        self.spans.sort_by(|a, b| a[0].total_cmp(&b[0]));
        self.spans.dedup_by(|next, kept| {
            let joins = next[0] <= kept[1];
            if joins {
                kept[1] = kept[1].max(next[1]);
            }
            joins
        });
        Ok(())
    }

    /// 1 if the face at the foot of a cell is solid, else 0.
    fn closed_at(&self, cell: usize) -> f64 {
        let height = cell as f64 * self.h;
        if self.spans.iter().any(|s| (s[0]..=s[1]).contains(&height)) { 1.0 } else { 0.0 }
    }

    /// Solid share of a cell's height.
    fn closed_within(&self, cell: usize) -> f64 {
        let (low, high) = (cell as f64 * self.h, (cell + 1) as f64 * self.h);
        let solid = |s: &[f64; 2]| (s[1].min(high) - s[0].max(low)).max(0.0);
        (self.spans.iter().map(solid).sum::<f64>() / self.h).min(1.0)
    }
}
