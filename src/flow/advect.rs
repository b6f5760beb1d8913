//! How the air carries its own velocity: candidates, from the source's to the one that keeps energy.

use glam::Vec3;

use super::lattice::{Faces, GHOSTS, Lattice};
use crate::error::{Error, Result, shown};

/// How velocity is carried, and how a step is split.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scheme {
    /// The value from where the air came from, along a straight path, linear between grid points (Stam 1999): the
    /// sources' scheme.
    SemiLagrangian,
    /// The value from a curved path, corrected by the error that carrying it back shows, within the values that it came
    /// from (Selle et al. 2008).
    MacCormack,
    /// Half a step carried, projected, mirrored at the projection, half a step carried again and projected (Zehnder et
    /// al. 2018, eq. 6), each carrying cubic: what projection takes is given back by the mirror.
    #[default]
    Reflection,
}

/// A wind to be carried by, and where it may be looked up.
pub(super) struct Carrier<'a> {
    lattice: &'a Lattice,
    wind: &'a Faces,
    /// For each axis, the range of places in cells; where it is periodic, none, and places wrap.
    range: [Option<[f32; 2]>; 3],
    /// Offset to the next value along each axis: none along a flat one.
    next: [usize; 3],
    is_flat: [bool; 3],
    per_cell: [f32; 3],
}

/// The values about a place: where the lowest of them stands, and how far the place lies between them along each axis.
struct Taps {
    low: usize,
    part: [f32; 3],
}

/// A place among the values of all components: offset and part along each axis, between faces and between middles of
/// cells.
struct StaggeredPlace {
    faces: [(usize, f32); 3],
    middles: [(usize, f32); 3],
}

impl StaggeredPlace {
    #[inline]
    fn taps(&self, component: usize) -> Taps {
        let mut taps = Taps { low: 0, part: [0.0; 3] };
        for a in 0..3 {
            let (offset, part) = if a == component { self.faces[a] } else { self.middles[a] };
            taps.low += offset;
            taps.part[a] = part;
        }
        taps
    }
}

impl Scheme {
    /// All of them, with the names that tools know them by.
    pub const NAMES: [(&'static str, Self); 3] =
        [("semi-lagrangian", Self::SemiLagrangian), ("maccormack", Self::MacCormack), ("reflection", Self::Reflection)];

    /// The scheme of a name.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] with the names that there are.
    pub fn from_name(name: &str) -> Result<Self> {
        let known = Self::NAMES.map(|(n, _)| n).join(", ");
        let found = Self::NAMES.into_iter().find(|(n, _)| *n == name).map(|(_, s)| s);
        found.ok_or_else(|| Error::range("scheme", &format!("one of {known}"), format!("`{}`", shown(name))))
    }
}

impl<'a> Carrier<'a> {
    pub(super) fn new(lattice: &'a Lattice, wind: &'a Faces, range: [Option<[f32; 2]>; 3]) -> Self {
        let is_flat = [0, 1, 2].map(|a| lattice.is_flat(a));
        let next = [0, 1, 2].map(|a| if is_flat[a] { 0 } else { lattice.stride[a] });
        Self { lattice, wind, range, next, is_flat, per_cell: lattice.h.map(|h| 1.0 / h) }
    }

    /// A place that lies `far` times `way` from another, m; where that leaves the range of places, the nearest in it.
    #[inline]
    fn moved(&self, mut place: [f32; 3], way: [f32; 3], far: f32) -> [f32; 3] {
        for (a, along) in place.iter_mut().enumerate() {
            if self.is_flat[a] {
                continue;
            }
            let p = *along + far * self.per_cell[a] * way[a];
            *along = match self.range[a] {
                Some([low, high]) => p.max(low).min(high),
                None => {
                    let n = self.lattice.n[a] as f32;
                    let p = if (0.0..n).contains(&p) { p } else { p - n * (p / n).floor() };
                    if p < n { p } else { 0.0 }
                }
            };
        }
        place
    }

    #[inline]
    fn between(&self, place: [f32; 3]) -> StaggeredPlace {
        let mut between = StaggeredPlace { faces: [(0, 0.0); 3], middles: [(0, 0.0); 3] };
        for (a, along) in place.into_iter().enumerate() {
            if self.is_flat[a] {
                continue;
            }
            let stride = self.lattice.stride[a];
            let along = along + GHOSTS as f32;
            let low = along as usize;
            between.faces[a] = (low * stride, along - low as f32);
            let along = along - 0.5;
            let low = along as usize;
            between.middles[a] = (low * stride, along - low as f32);
        }
        between
    }

    #[inline]
    fn taps(&self, component: usize, place: [f32; 3]) -> Taps {
        self.between(place).taps(component)
    }

    #[inline]
    /// Linear between the eight values about a place.
    fn linear(&self, values: &[f32], taps: &Taps) -> f32 {
        let [dx, dy, dz] = self.next;
        let [fx, fy, fz] = taps.part;
        let mut layers = [0.0; 2];
        for (layer, at) in layers.iter_mut().zip([taps.low, taps.low + dz]) {
            let low = values[at] + (values[at + dx] - values[at]) * fx;
            let beside = at + dy;
            let high = values[beside] + (values[beside + dx] - values[beside]) * fx;
            *layer = low + (high - low) * fy;
            if dz == 0 {
                return *layer;
            }
        }
        layers[0] + (layers[1] - layers[0]) * fz
    }

    /// The least and the largest of the eight.
    fn bounds(&self, values: &[f32], taps: &Taps) -> [f32; 2] {
        let [dx, dy, dz] = self.next;
        let (mut least, mut most) = (f32::INFINITY, f32::NEG_INFINITY);
        for z in [0, dz] {
            for y in [0, dy] {
                for x in [0, dx] {
                    let v = values[taps.low + x + y + z];
                    least = least.min(v);
                    most = most.max(v);
                }
            }
        }
        [least, most]
    }

    /// Cubic (Lagrange's polynomial through four values) along each axis.
    fn cubic_between(&self, values: &[f32], taps: &Taps) -> f32 {
        let [x, y, z] = [0, 1, 2].map(|a| (self.next[a], cubic_weights(taps.part[a])));
        let row = |at: usize| match x {
            (0, _) => values[at],
            (d, w) => w[0] * values[at - d] + w[1] * values[at] + w[2] * values[at + d] + w[3] * values[at + 2 * d],
        };
        let layer = |at: usize| match y {
            (0, _) => row(at),
            (d, w) => w[0] * row(at - d) + w[1] * row(at) + w[2] * row(at + d) + w[3] * row(at + 2 * d),
        };
        let at = taps.low;
        match z {
            (0, _) => layer(at),
            (d, w) => w[0] * layer(at - d) + w[1] * layer(at) + w[2] * layer(at + d) + w[3] * layer(at + 2 * d),
        }
    }

    /// The wind at a place in cells, m/s; out of range that of the nearest place.
    pub(super) fn velocity_near(&self, place: [f32; 3]) -> Vec3 {
        self.velocity(self.moved(place, [0.0; 3], 0.0)).into()
    }

    #[inline]
    fn velocity(&self, place: [f32; 3]) -> [f32; 3] {
        let between = self.between(place);
        let mut v = [0.0; 3];
        for (a, v) in v.iter_mut().enumerate() {
            if !self.is_flat[a] {
                *v = self.linear(&self.wind[a], &between.taps(a));
            }
        }
        v
    }

    /// Where air that is at `place` will be after `dt` (was, if negative), along a straight path.
    fn straight(&self, place: [f32; 3], dt: f32) -> [f32; 3] {
        self.moved(place, self.velocity(place), dt)
    }

    /// Returns where air that is at `place` will be after `dt` (was, if negative), along a curved path (third order,
    /// Ralston 1962).
    fn curved(&self, place: [f32; 3], dt: f32) -> [f32; 3] {
        let v1 = self.velocity(place);
        let v2 = self.velocity(self.moved(place, v1, 0.5 * dt));
        let v3 = self.velocity(self.moved(place, v2, 0.75 * dt));
        let mut v = [0.0; 3];
        for (a, v) in v.iter_mut().enumerate() {
            *v = (2.0 * v1[a] + 3.0 * v2[a] + 4.0 * v3[a]) / 9.0;
        }
        self.moved(place, v, dt)
    }

    /// Carries `source` by `dt` along straight paths, linear.
    pub(super) fn semi_lagrangian(&self, source: &Faces, dt: f32, target: &mut Faces) {
        for c in self.lattice.axes() {
            self.lattice.each(c, |i, at| {
                let place = self.straight(self.lattice.place(c, i), -dt);
                target[c][at] = self.linear(&source[c], &self.taps(c, place));
            });
        }
    }

    /// Carries `source` by `dt` along curved paths; cubic between values, within the eight nearest.
    pub(super) fn cubic(&self, source: &Faces, dt: f32, target: &mut Faces) {
        for c in self.lattice.axes() {
            self.lattice.each(c, |i, at| {
                let taps = self.taps(c, self.curved(self.lattice.place(c, i), -dt));
                let [least, most] = self.bounds(&source[c], &taps);
                target[c][at] = self.cubic_between(&source[c], &taps).max(least).min(most);
            });
        }
    }

    /// Carries `source` by `dt` along curved paths, linear, and keeps the bounds of what each value came from.
    pub(super) fn predict(&self, source: &Faces, dt: f32, target: &mut Faces, bounds: &mut [Vec<[f32; 2]>; 3]) {
        for c in self.lattice.axes() {
            self.lattice.each(c, |i, at| {
                let taps = self.taps(c, self.curved(self.lattice.place(c, i), -dt));
                target[c][at] = self.linear(&source[c], &taps);
                bounds[c][at] = self.bounds(&source[c], &taps);
            });
        }
    }

    /// MacCormack's correction of `predicted`, whose ghosts are filled: half of what carrying it back misses.
    pub(super) fn correct(
        &self,
        source: &Faces,
        predicted: &Faces,
        dt: f32,
        bounds: &[Vec<[f32; 2]>; 3],
        target: &mut Faces,
    ) {
        for c in self.lattice.axes() {
            self.lattice.each(c, |i, at| {
                let back = self.linear(&predicted[c], &self.taps(c, self.curved(self.lattice.place(c, i), dt)));
                let [least, most] = bounds[c][at];
                target[c][at] = (predicted[c][at] + 0.5 * (source[c][at] - back)).max(least).min(most);
            });
        }
    }
}

/// Lagrange's weights of the values at -1, 0, 1, 2 for a place in [0, 1].
fn cubic_weights(f: f32) -> [f32; 4] {
    let (a, b, c) = (f + 1.0, f - 1.0, f - 2.0);
    [-f * b * c / 6.0, a * b * c / 2.0, -a * f * c / 2.0, a * f * b / 6.0]
}
