//! Paths along which advection follows the air back in time, and interpolation, for four neighbouring faces at once.
//! Each face has one lane of a vector.
//!
//! The air of neighbouring faces mostly comes from neighbouring places, so the values of all lanes lie side by side in
//! memory. If the places are apart, each lane's values are looked up singly, with the same result.

use glam::{BVec4A, Vec3, Vec4, vec4};

use super::lattice::{Faces, GHOSTS, Lattice};

/// Number of faces that are carried at once.
pub(super) const LANES: usize = 4;

/// Places of four faces along each axis, in cells.
pub(super) type FacePlaces = [Vec4; 3];

/// Wind that carries, and the range in which it may be looked up.
pub(super) struct Carrier<'a> {
    pub lattice: &'a Lattice,
    wind: &'a Faces,
    /// Range of places along each axis, in cells; `None` along a periodic axis, where places wrap.
    range: [Option<[f32; 2]>; 3],
    /// Offset to the next value along each axis; 0 along a flat one.
    next: [usize; 3],
    is_flat: [bool; 3],
    per_cell: [f32; 3],
}

/// Places of four lanes among the values along one axis.
#[derive(Clone, Copy)]
struct AxisPlaces {
    /// Index of the last value at or below each place along the axis, counted from the first ghost.
    low: Vec4,
    /// Fraction of a cell from that value to the place.
    part: Vec4,
    /// Whether the value of each lane lies in one row with that of the first lane, as many values farther along as the
    /// number of the lane. Along the first axis the index is then that of the first lane plus this number. Along the
    /// other axes it is that of the first lane.
    follows: BVec4A,
}

/// Position in the list, for each of four places, of that value around the place which has the lowest indices.
enum Lowest {
    /// The lanes' values follow each other, from this position.
    Row(usize),
    Apart([usize; LANES]),
}

/// Four places among values: the value with the lowest indices around each place, and the fraction of a cell from this
/// value to the place along each axis.
pub(super) struct Taps {
    lowest: Lowest,
    part: [Vec4; 3],
}

impl AxisPlaces {
    #[inline]
    fn new(axis: usize, places: Vec4) -> Self {
        let low = places.trunc();
        let first = Vec4::splat(low.x) + if axis == 0 { vec4(0.0, 1.0, 2.0, 3.0) } else { Vec4::ZERO };
        Self { low, part: places - low, follows: low.cmpeq(first) }
    }

    /// Returns the place along a flat axis.
    #[inline]
    fn flat(axis: usize) -> Self {
        Self { follows: BVec4A::splat(axis != 0), low: Vec4::ZERO, part: Vec4::ZERO }
    }
}

/// Returns the first four values as a vector.
#[inline]
pub(super) fn four(values: &[f32]) -> Vec4 {
    vec4(values[0], values[1], values[2], values[3])
}

impl<'a> Carrier<'a> {
    pub(super) fn new(lattice: &'a Lattice, wind: &'a Faces, range: [Option<[f32; 2]>; 3]) -> Self {
        let is_flat = [0, 1, 2].map(|a| lattice.is_flat(a));
        let next = [0, 1, 2].map(|a| if is_flat[a] { 0 } else { lattice.stride[a] });
        Self { lattice, wind, range, next, is_flat, per_cell: lattice.h.map(|h| 1.0 / h) }
    }

    /// Calls `f` for the faces of a component, four of a row at a time. `f` gets the places of the faces, the position
    /// of the first face in the list, and the number of faces, which may be less than four at the end of a row.
    #[inline]
    pub(super) fn each_four(&self, component: usize, mut f: impl FnMut(FacePlaces, usize, usize)) {
        self.lattice.each_row(component, |j, k, row, count| {
            for i in (0..count).step_by(LANES) {
                let [x, y, z] = self.lattice.place(component, [i, j, k]);
                let places = [Vec4::splat(x) + vec4(0.0, 1.0, 2.0, 3.0), Vec4::splat(y), Vec4::splat(z)];
                f(places, row + i, LANES.min(count - i));
            }
        });
    }

    /// Returns `places` moved by `far` times `way`, m, and clamped to the range of places. Along a periodic axis they
    /// wrap.
    #[inline]
    pub(super) fn moved(&self, mut places: FacePlaces, way: [Vec4; 3], far: f32) -> FacePlaces {
        for (a, along) in places.iter_mut().enumerate() {
            if self.is_flat[a] {
                continue;
            }
            let p = *along + Vec4::splat(far * self.per_cell[a]) * way[a];
            *along = match self.range[a] {
                // NaN becomes the low end of the range.
                Some([low, high]) => {
                    let low = Vec4::splat(low);
                    Vec4::select(p.cmpgt(low), p, low).min(Vec4::splat(high))
                }
                None => wrapped(p, self.lattice.n[a] as f32),
            };
        }
        places
    }

    /// Returns the places along an axis among values that lie on faces, or in the middle between them.
    #[inline]
    fn along(&self, axis: usize, places: Vec4, is_on_faces: bool) -> AxisPlaces {
        if self.is_flat[axis] {
            return AxisPlaces::flat(axis);
        }
        AxisPlaces::new(axis, places + Vec4::splat(GHOSTS as f32) - Vec4::splat(if is_on_faces { 0.0 } else { 0.5 }))
    }

    #[inline]
    pub(super) fn taps(&self, component: usize, [x, y, z]: FacePlaces) -> Taps {
        let along = |axis: usize, places: Vec4| self.along(axis, places, axis == component);
        self.taps_between(along(0, x), along(1, y), along(2, z))
    }

    #[inline]
    fn taps_between(&self, x: AxisPlaces, y: AxisPlaces, z: AxisPlaces) -> Taps {
        let [dx, dy, dz] = self.lattice.stride;
        let position = |lane: usize| x.low[lane] as usize * dx + y.low[lane] as usize * dy + z.low[lane] as usize * dz;
        let lowest = if (x.follows & y.follows & z.follows).all() {
            Lowest::Row(position(0))
        } else {
            Lowest::Apart([position(0), position(1), position(2), position(3)])
        };
        Taps { lowest, part: [x.part, y.part, z.part] }
    }

    /// Returns the values of four lanes at an offset from the position `lowest` of each lane.
    #[inline]
    fn gathered(values: &[f32], lowest: &[usize; LANES], offset: usize) -> Vec4 {
        let of = |lane: usize| values[lowest[lane] + offset];
        vec4(of(0), of(1), of(2), of(3))
    }

    /// Interpolates linearly between the eight values around each place.
    #[inline]
    pub(super) fn linear(&self, values: &[f32], taps: &Taps) -> Vec4 {
        match &taps.lowest {
            Lowest::Row(at) => self.linear_of(taps.part, |offset| {
                let row = &values[at + offset..at + offset + LANES + 1];
                [four(row), four(&row[1..])]
            }),
            Lowest::Apart(all) => self.linear_of(taps.part, |offset| {
                [Self::gathered(values, all, offset), Self::gathered(values, all, offset + self.next[0])]
            }),
        }
    }

    /// Interpolates linearly between two values in each of four rows. `pair` returns these two for the row at an
    /// offset.
    #[inline]
    fn linear_of(&self, [fx, fy, fz]: [Vec4; 3], pair: impl Fn(usize) -> [Vec4; 2]) -> Vec4 {
        let [_, dy, dz] = self.next;
        let row = |offset: usize| {
            let [low, high] = pair(offset);
            low + (high - low) * fx
        };
        let layer = |offset: usize| {
            let (low, high) = (row(offset), row(offset + dy));
            low + (high - low) * fy
        };
        let low = layer(0);
        if dz == 0 { low } else { low + (layer(dz) - low) * fz }
    }

    /// Returns the least and the largest of the eight values around each place.
    pub(super) fn bounds(&self, values: &[f32], taps: &Taps) -> [Vec4; 2] {
        let [dx, dy, dz] = self.next;
        let (mut least, mut most) = (Vec4::INFINITY, Vec4::NEG_INFINITY);
        for offset in [0, dz].into_iter().flat_map(|z| [z, z + dy]).flat_map(|yz| [yz, yz + dx]) {
            let v = match &taps.lowest {
                Lowest::Row(at) => four(&values[at + offset..at + offset + LANES]),
                Lowest::Apart(all) => Self::gathered(values, all, offset),
            };
            (least, most) = (lesser(least, v), larger(most, v));
        }
        [least, most]
    }

    /// Interpolates along each axis by Lagrange's cubic through four values, limited to the range of the eight nearest
    /// values.
    #[inline]
    pub(super) fn limited_cubic(&self, values: &[f32], taps: &Taps) -> Vec4 {
        let [dx, dy, dz] = self.next;
        let back = dx + dy + dz;
        match &taps.lowest {
            Lowest::Row(at) => self.limited_cubic_of(taps.part, |offset| {
                let start = at - back + offset;
                let row = &values[start..start + LANES + 3];
                [four(row), four(&row[1..]), four(&row[2..]), four(&row[3..])]
            }),
            Lowest::Apart(all) => {
                let all = &[all[0] - back, all[1] - back, all[2] - back, all[3] - back];
                self.limited_cubic_of(taps.part, |offset| {
                    let of = |i: usize| Self::gathered(values, all, offset + i * dx);
                    [of(0), of(1), of(2), of(3)]
                })
            }
        }
    }

    /// Interpolates between four values in each of sixteen rows. `row` returns these four for the row at an offset.
    #[inline]
    fn limited_cubic_of(&self, part: [Vec4; 3], row: impl Fn(usize) -> [Vec4; 4]) -> Vec4 {
        let [dx, dy, dz] = self.next;
        let [wx, wy, wz] = [cubic_weights(part[0]), cubic_weights(part[1]), cubic_weights(part[2])];
        let (mut least, mut most) = (Vec4::INFINITY, Vec4::NEG_INFINITY);
        let is_near = |d: usize, i: usize| d == 0 || i == 1 || i == 2;
        let mut layers = [Vec4::ZERO; 4];
        for (k, layer) in layers.iter_mut().enumerate().take(if dz == 0 { 1 } else { 4 }) {
            let mut rows = [Vec4::ZERO; 4];
            for (j, sum) in rows.iter_mut().enumerate().take(if dy == 0 { 1 } else { 4 }) {
                let v = row(k * dz + j * dy);
                *sum = if dx == 0 { v[0] } else { weighted(wx, v) };
                if is_near(dz, k) && is_near(dy, j) {
                    (least, most) = (lesser(lesser(least, v[1]), v[2]), larger(larger(most, v[1]), v[2]));
                }
            }
            *layer = if dy == 0 { rows[0] } else { weighted(wy, rows) };
        }
        let cubic = if dz == 0 { layers[0] } else { weighted(wz, layers) };
        lesser(larger(cubic, least), most)
    }

    /// Returns the wind at a place in cells, m/s. Outside the range it is the wind at the nearest place in the range;
    /// along a periodic axis the place wraps.
    pub(super) fn velocity_near(&self, place: [f32; 3]) -> Vec3 {
        let [x, y, z] = place;
        let places = self.moved([Vec4::splat(x), Vec4::splat(y), Vec4::splat(z)], [Vec4::ZERO; 3], 0.0);
        let [east, north, up] = self.velocity(places);
        Vec3::new(east.x, north.x, up.x)
    }

    #[inline]
    fn velocity(&self, [x, y, z]: FacePlaces) -> [Vec4; 3] {
        let faces = [self.along(0, x, true), self.along(1, y, true), self.along(2, z, true)];
        let middles = [self.along(0, x, false), self.along(1, y, false), self.along(2, z, false)];
        let component = |c: usize, x: AxisPlaces, y: AxisPlaces, z: AxisPlaces| match self.is_flat[c] {
            true => Vec4::ZERO,
            false => self.linear(&self.wind[c], &self.taps_between(x, y, z)),
        };
        [
            component(0, faces[0], middles[1], middles[2]),
            component(1, middles[0], faces[1], middles[2]),
            component(2, middles[0], middles[1], faces[2]),
        ]
    }

    /// Returns the wind at four faces of a component, of which the first has the position `first` in the list. Each
    /// other component is the mean of its values on the four faces around.
    #[inline]
    pub(super) fn velocity_on_faces(&self, component: usize, first: usize) -> [Vec4; 3] {
        let half = Vec4::splat(0.5);
        let along = |a: usize| {
            let v = &self.wind[a];
            let from = |at: usize| four(&v[at..at + LANES]);
            if self.is_flat[a] {
                return Vec4::ZERO;
            }
            if a == component {
                return from(first);
            }
            let [across, along] = [self.next[component], self.next[a]];
            let [inner, outer] = [across.min(along), across.max(along)];
            let low = first - across;
            let middle = |at: usize| from(at) + (from(at + inner) - from(at)) * half;
            middle(low) + (middle(low + outer) - middle(low)) * half
        };
        [along(0), along(1), along(2)]
    }

    /// Returns where air at faces of a component will be after `dt` (or was, if negative), along a curved path (third
    /// order, Ralston 1962).
    #[inline]
    pub(super) fn curved(&self, places: FacePlaces, component: usize, first: usize, dt: f32) -> FacePlaces {
        let v1 = self.velocity_on_faces(component, first);
        let v2 = self.velocity(self.moved(places, v1, 0.5 * dt));
        let v3 = self.velocity(self.moved(places, v2, 0.75 * dt));
        let mean = |a: usize| (2.0 * v1[a] + 3.0 * v2[a] + 4.0 * v3[a]) / 9.0;
        self.moved(places, [mean(0), mean(1), mean(2)], dt)
    }
}

/// Wraps places on a periodic axis of `n` cells into [0, n).
#[inline]
fn wrapped(places: Vec4, n: f32) -> Vec4 {
    if (places.cmpge(Vec4::ZERO) & places.cmplt(Vec4::splat(n))).all() {
        return places;
    }
    Vec4::from_array(places.to_array().map(|p| {
        let p = if (0.0..n).contains(&p) { p } else { p - n * (p / n).floor() };
        if p < n { p } else { 0.0 }
    }))
}

/// Returns the lesser number of each lane; of two zeros the first, whatever their signs.
#[inline]
pub(super) fn lesser(a: Vec4, b: Vec4) -> Vec4 {
    Vec4::select(b.cmplt(a), b, a)
}

/// Returns the larger number of each lane; of two zeros the first, whatever their signs.
#[inline]
pub(super) fn larger(a: Vec4, b: Vec4) -> Vec4 {
    Vec4::select(b.cmpgt(a), b, a)
}

/// Returns the sum of four values times their weights.
#[inline]
fn weighted(w: [Vec4; 4], v: [Vec4; 4]) -> Vec4 {
    w[0] * v[0] + w[1] * v[1] + w[2] * v[2] + w[3] * v[3]
}

/// Returns Lagrange's weights of the values at -1, 0, 1, 2 for places in [0, 1].
#[inline]
fn cubic_weights(f: Vec4) -> [Vec4; 4] {
    let (a, b, c) = (f + 1.0, f - 1.0, f - 2.0);
    [-f * b * c / 6.0, a * b * c / 2.0, -a * f * c / 2.0, a * f * b / 6.0]
}
