//! Advection: how the air carries its own velocity. Three schemes, from Stam's simple one to one that keeps energy.

use glam::Vec3;

use super::lattice::{Faces, GHOSTS, Lattice};
use crate::error::{Error, Result, shown};

/// Scheme that carries velocity and splits a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scheme {
    /// Value at the place the air came from, along a straight path, linear between grid points (Stam 1999): the most
    /// diffusive scheme.
    SemiLagrangian,
    /// Value along a curved path, corrected by the error that carrying it back shows, and limited to the range of the
    /// values it came from (Selle et al. 2008).
    MacCormack,
    /// Half a step of advection, a projection, a reflection (2 x projected - unprojected velocity), another half step
    /// of advection and a projection (Zehnder et al. 2018, eq. 6). Advection is cubic. The reflection gives back the
    /// energy that the projection removes.
    #[default]
    Reflection,
}

/// Wind that carries, and the range in which it may be looked up.
pub(super) struct Carrier<'a> {
    /// Grid.
    lattice: &'a Lattice,
    /// Wind that carries, m/s.
    wind: &'a Faces,
    /// Range of places along each axis, in cells; `None` along a periodic axis, where places wrap.
    range: [Option<[f32; 2]>; 3],
    /// Offset to the next value along each axis; 0 along a flat one.
    next: [usize; 3],
    /// Whether an axis is flat.
    is_flat: [bool; 3],
    /// Reciprocal size of a cell along each axis, 1/m.
    per_cell: [f32; 3],
}

/// Values around a place: index of the lowest one, and the fraction of a cell between it and the next along each axis.
struct Taps {
    /// Position of the lowest value in the list.
    low: usize,
    /// Fraction of a cell between the lowest value and the next, along each axis.
    part: [f32; 3],
}

/// Place among the values of all components: offset and fraction along each axis, relative to faces and to cell
/// centres.
struct StaggeredPlace {
    /// Place relative to the faces, as (offset of the lower face in the list, fraction of a cell).
    faces: [(usize, f32); 3],
    /// Place relative to the cell centres, as (offset of the lower centre in the list, fraction of a cell).
    middles: [(usize, f32); 3],
}

impl StaggeredPlace {
    /// Returns the values of a component around the place.
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
    /// All schemes, with the names by which tools know them.
    pub const NAMES: [(&'static str, Self); 3] =
        [("semi-lagrangian", Self::SemiLagrangian), ("maccormack", Self::MacCormack), ("reflection", Self::Reflection)];

    /// Returns the scheme of a name.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] with the list of names.
    pub fn from_name(name: &str) -> Result<Self> {
        let known = Self::NAMES.map(|(n, _)| n).join(", ");
        let found = Self::NAMES.into_iter().find(|(n, _)| *n == name).map(|(_, s)| s);
        found.ok_or_else(|| Error::range("scheme", &format!("one of {known}"), format!("`{}`", shown(name))))
    }
}

impl<'a> Carrier<'a> {
    /// Creates the carrier of a wind with the range in which it may be looked up.
    pub(super) fn new(lattice: &'a Lattice, wind: &'a Faces, range: [Option<[f32; 2]>; 3]) -> Self {
        let is_flat = [0, 1, 2].map(|a| lattice.is_flat(a));
        let next = [0, 1, 2].map(|a| if is_flat[a] { 0 } else { lattice.stride[a] });
        Self { lattice, wind, range, next, is_flat, per_cell: lattice.h.map(|h| 1.0 / h) }
    }

    /// Returns `place`, in cells, moved by `far` times `way`, m, and clamped to the range of places.
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

    /// Finds the values around a place, which is in cells from the box's lowest corner.
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

    /// Returns the values of a component around a place in cells.
    #[inline]
    fn taps(&self, component: usize, place: [f32; 3]) -> Taps {
        self.between(place).taps(component)
    }

    #[inline]
    /// Interpolates linearly between the eight values around a place.
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

    /// Returns the least and the largest of the eight values around a place.
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

    /// Interpolates along each axis by Lagrange's cubic through four values.
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

    /// Returns the wind at a place in cells, m/s; outside the range the wind at the nearest place within it.
    pub(super) fn velocity_near(&self, place: [f32; 3]) -> Vec3 {
        self.velocity(self.moved(place, [0.0; 3], 0.0)).into()
    }

    /// Returns the wind at a place in cells within the range, m/s.
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

    /// Returns where air at `place` will be after `dt` (or was, if negative), along a straight path.
    fn straight(&self, place: [f32; 3], dt: f32) -> [f32; 3] {
        self.moved(place, self.velocity(place), dt)
    }

    /// Returns where air at `place` will be after `dt` (or was, if negative), along a curved path (third order, Ralston
    /// 1962).
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

    /// Carries `source` by `dt` along straight paths, with linear interpolation.
    pub(super) fn semi_lagrangian(&self, source: &Faces, dt: f32, target: &mut Faces) {
        for c in self.lattice.axes() {
            self.lattice.each(c, |i, at| {
                let place = self.straight(self.lattice.place(c, i), -dt);
                target[c][at] = self.linear(&source[c], &self.taps(c, place));
            });
        }
    }

    /// Carries `source` by `dt` along curved paths, with cubic interpolation limited to the range of the eight nearest
    /// values.
    pub(super) fn cubic(&self, source: &Faces, dt: f32, target: &mut Faces) {
        for c in self.lattice.axes() {
            self.lattice.each(c, |i, at| {
                let taps = self.taps(c, self.curved(self.lattice.place(c, i), -dt));
                let [least, most] = self.bounds(&source[c], &taps);
                target[c][at] = self.cubic_between(&source[c], &taps).max(least).min(most);
            });
        }
    }

    /// Carries `source` by `dt` along curved paths, with linear interpolation, and stores the range of the values that
    /// each result came from.
    pub(super) fn predict(&self, source: &Faces, dt: f32, target: &mut Faces, bounds: &mut [Vec<[f32; 2]>; 3]) {
        for c in self.lattice.axes() {
            self.lattice.each(c, |i, at| {
                let taps = self.taps(c, self.curved(self.lattice.place(c, i), -dt));
                target[c][at] = self.linear(&source[c], &taps);
                bounds[c][at] = self.bounds(&source[c], &taps);
            });
        }
    }

    /// Applies MacCormack's correction to `predicted`, whose ghosts are filled: half of the error that carrying it back
    /// shows.
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

/// Returns Lagrange's weights of the values at -1, 0, 1, 2 for a place in [0, 1].
fn cubic_weights(f: f32) -> [f32; 4] {
    let (a, b, c) = (f + 1.0, f - 1.0, f - 2.0);
    [-f * b * c / 6.0, a * b * c / 2.0, -a * f * c / 2.0, a * f * b / 6.0]
}
