//! How the air carries its own velocity: candidates, from the source's to the one that keeps energy.

use glam::Vec3;

use super::lattice::{Faces, Lattice};

/// How velocity is carried, and how a step is split.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scheme {
    /// The value from where the air came from, along a straight path, linear between grid points (Stam 1999): the sources' scheme.
    SemiLagrangian,
    /// The same along a curved path, corrected by what carrying back would have shown, within the values that it came from
    /// (Selle et al. 2008).
    MacCormack,
    /// Half a step carried, projected, mirrored at the projection, half a step carried again and projected (Zehnder et al. 2018,
    /// eq. 6), each carrying cubic: what projection takes is given back by the mirror.
    #[default]
    Reflection,
}

/// A wind to be carried by, and where it may be looked up.
pub(super) struct Carrier<'a> {
    pub lattice: &'a Lattice,
    pub wind: &'a Faces,
    /// For each axis, the range of places in cells, or none where it is periodic.
    pub range: [Option<[f32; 2]>; 3],
}

/// The values about a place: where the lowest of them stands, the stride to the others, and how far the place lies between.
struct Taps {
    low: usize,
    part: [f32; 3],
}

impl Carrier<'_> {
    /// The place itself, or where it leaves the range of places, the nearest in it.
    fn kept(&self, mut place: [f32; 3]) -> [f32; 3] {
        for a in self.lattice.axes() {
            place[a] = match self.range[a] {
                Some([low, high]) => place[a].max(low).min(high),
                None => {
                    let n = self.lattice.n[a] as f32;
                    let p = place[a] - n * (place[a] / n).floor();
                    if p < n { p } else { 0.0 }
                }
            };
        }
        place
    }

    fn taps(&self, component: usize, place: [f32; 3]) -> Taps {
        let mut taps = Taps { low: 0, part: [0.0; 3] };
        for (a, along) in place.into_iter().enumerate() {
            let (offset, part) = self.lattice.between(component, a, along);
            taps.low += offset;
            taps.part[a] = part;
        }
        taps
    }

    /// Offset to the next value along an axis: none along a flat one.
    fn next(&self, axis: usize) -> usize {
        if self.lattice.is_flat(axis) { 0 } else { self.lattice.stride[axis] }
    }

    /// Linear between the eight values about a place.
    fn linear(&self, values: &[f32], taps: &Taps) -> f32 {
        let [dx, dy, dz] = [0, 1, 2].map(|a| self.next(a));
        let [fx, fy, fz] = taps.part;
        let mix = |a: f32, b: f32, f: f32| a + (b - a) * f;
        let row = |at: usize| mix(values[at], values[at + dx], fx);
        let layer = |at: usize| mix(row(at), row(at + dy), fy);
        let low = layer(taps.low);
        if dz == 0 { low } else { mix(low, layer(taps.low + dz), fz) }
    }

    /// The least and the largest of the eight.
    fn bounds(&self, values: &[f32], taps: &Taps) -> [f32; 2] {
        let [dx, dy, dz] = [0, 1, 2].map(|a| self.next(a));
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
    fn cubic(&self, values: &[f32], taps: &Taps) -> f32 {
        let [x, y, z] = [0, 1, 2].map(|a| (self.next(a), cubic_weights(taps.part[a])));
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

    /// The wind at a place in cells, m/s.
    pub(super) fn velocity(&self, place: [f32; 3]) -> Vec3 {
        let place = self.kept(place);
        let mut v = Vec3::ZERO;
        for a in self.lattice.axes() {
            v[a] = self.linear(&self.wind[a], &self.taps(a, place));
        }
        v
    }

    /// The wind in cells a second.
    fn speed(&self, place: [f32; 3]) -> [f32; 3] {
        let mut speed = [0.0; 3];
        for a in self.lattice.axes() {
            speed[a] = self.linear(&self.wind[a], &self.taps(a, place)) / self.lattice.h[a];
        }
        speed
    }

    /// Where air that is at `place` will be after `dt` (was, if negative), along a straight path.
    fn straight(&self, place: [f32; 3], dt: f32) -> [f32; 3] {
        let v = self.speed(place);
        self.kept([0, 1, 2].map(|a| place[a] + dt * v[a]))
    }

    /// The same along a curved one (third order, Ralston 1962).
    fn curved(&self, place: [f32; 3], dt: f32) -> [f32; 3] {
        let to = |v: [f32; 3], share: f32| self.kept([0, 1, 2].map(|a| place[a] + share * dt * v[a]));
        let v1 = self.speed(place);
        let v2 = self.speed(to(v1, 0.5));
        let v3 = self.speed(to(v2, 0.75));
        to([0, 1, 2].map(|a| (2.0 * v1[a] + 3.0 * v2[a] + 4.0 * v3[a]) / 9.0), 1.0)
    }

    /// Carries `from` by `dt` along straight paths, linear.
    pub(super) fn semi_lagrangian(&self, from: &Faces, dt: f32, to: &mut Faces) {
        for c in self.lattice.axes() {
            self.lattice.each(c, |i, at| {
                let place = self.straight(self.lattice.place(c, i), -dt);
                to[c][at] = self.linear(&from[c], &self.taps(c, place));
            });
        }
    }

    /// Carries `from` by `dt` along curved paths; cubic between values, kept within the eight nearest if `limited`.
    pub(super) fn cubic_step(&self, from: &Faces, dt: f32, limited: bool, to: &mut Faces) {
        for c in self.lattice.axes() {
            self.lattice.each(c, |i, at| {
                let place = self.curved(self.lattice.place(c, i), -dt);
                let taps = self.taps(c, place);
                let value = self.cubic(&from[c], &taps);
                let [least, most] = if limited { self.bounds(&from[c], &taps) } else { [value; 2] };
                to[c][at] = value.max(least).min(most);
            });
        }
    }

    /// Carries `from` by `dt` along curved paths, linear, and keeps the bounds of what each value came from.
    pub(super) fn predict(&self, from: &Faces, dt: f32, to: &mut Faces, bounds: &mut [Vec<[f32; 2]>; 3]) {
        for c in self.lattice.axes() {
            self.lattice.each(c, |i, at| {
                let taps = self.taps(c, self.curved(self.lattice.place(c, i), -dt));
                to[c][at] = self.linear(&from[c], &taps);
                bounds[c][at] = self.bounds(&from[c], &taps);
            });
        }
    }

    /// MacCormack's correction of `predicted`, whose ghosts are filled: half of what carrying it back misses.
    pub(super) fn correct(&self, from: &Faces, predicted: &Faces, dt: f32, bounds: &[Vec<[f32; 2]>; 3], to: &mut Faces) {
        for c in self.lattice.axes() {
            self.lattice.each(c, |i, at| {
                let back = self.linear(&predicted[c], &self.taps(c, self.curved(self.lattice.place(c, i), dt)));
                let [least, most] = bounds[c][at];
                to[c][at] = (predicted[c][at] + 0.5 * (from[c][at] - back)).max(least).min(most);
            });
        }
    }
}

/// Lagrange's weights of the values at -1, 0, 1, 2 for a place in [0, 1].
fn cubic_weights(f: f32) -> [f32; 4] {
    let (a, b, c) = (f + 1.0, f - 1.0, f - 2.0);
    [-f * b * c / 6.0, a * b * c / 2.0, -a * f * c / 2.0, a * f * b / 6.0]
}
