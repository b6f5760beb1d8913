//! Advection: how the air carries its own velocity. There are three schemes, from Stam's simple one to one that keeps
//! energy. Each follows the path of the air at a face back in time, and takes the velocity from the place where it
//! began. `lanes.rs` has these paths and the interpolation.

use super::{
    lanes::{Carrier, LANES},
    lattice::Faces,
};
use crate::error::{Error, Result, shown};

/// Scheme of advection. It also determines how a step is divided into advection and projections.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scheme {
    /// Takes the value at the place from which the air came on a straight path, by linear interpolation (Stam 1999).
    /// This is the most diffusive scheme.
    SemiLagrangian,
    /// Takes the value from a curved path by linear interpolation, and corrects it by half of the error that appears
    /// when the values are carried back. The result is limited to the range of the values between which it was
    /// interpolated (Selle et al. 2008).
    MacCormack,
    /// Half a step of advection, a projection, a reflection (2 x projected - unprojected velocity), another half step
    /// of advection and a projection (Zehnder et al. 2018, eq. 6). Advection is cubic. The reflection gives back the
    /// energy that the projection removes.
    #[default]
    Reflection,
}

impl Scheme {
    /// All schemes, with the names by which tools know them.
    pub const NAMES: [(&'static str, Self); 3] =
        [("semi-lagrangian", Self::SemiLagrangian), ("maccormack", Self::MacCormack), ("reflection", Self::Reflection)];

    /// Returns the name of the scheme.
    pub(super) fn name(self) -> &'static str {
        Self::NAMES.into_iter().find(|(_, s)| *s == self).map_or("", |(name, _)| name)
    }

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

impl Carrier<'_> {
    /// Carries `source` by `dt` along straight paths, with linear interpolation.
    pub(super) fn semi_lagrangian(&self, source: &Faces, dt: f32, target: &mut Faces) {
        for c in self.lattice.axes() {
            self.each_four(c, |places, at, count| {
                let taps = self.taps(c, self.moved(places, self.velocity_on_faces(c, at), -dt));
                store(&mut target[c], at, count, self.linear(&source[c], &taps).to_array());
            });
        }
    }

    /// Carries `source` by `dt` along curved paths, with cubic interpolation limited to the range of the eight nearest
    /// values.
    pub(super) fn cubic(&self, source: &Faces, dt: f32, target: &mut Faces) {
        for c in self.lattice.axes() {
            self.each_four(c, |places, at, count| {
                let taps = self.taps(c, self.curved(places, c, at, -dt));
                store(&mut target[c], at, count, self.limited_cubic(&source[c], &taps).to_array());
            });
        }
    }

    /// Carries `source` by `dt` along curved paths, with linear interpolation, and stores the range of the values that
    /// each result came from.
    pub(super) fn predict(&self, source: &Faces, dt: f32, target: &mut Faces, bounds: &mut [Vec<[f32; 2]>; 3]) {
        for c in self.lattice.axes() {
            self.each_four(c, |places, at, count| {
                let taps = self.taps(c, self.curved(places, c, at, -dt));
                store(&mut target[c], at, count, self.linear(&source[c], &taps).to_array());
                let [least, most] = self.bounds(&source[c], &taps);
                store(&mut bounds[c], at, count, std::array::from_fn(|lane| [least[lane], most[lane]]));
            });
        }
    }

    /// Sets `target` to `predicted` with MacCormack's correction, half of the error that appears when `predicted` is
    /// carried back, and limits it to `bounds`. The ghosts of `predicted` must be filled.
    pub(super) fn correct(
        &self,
        source: &Faces,
        predicted: &Faces,
        dt: f32,
        bounds: &[Vec<[f32; 2]>; 3],
        target: &mut Faces,
    ) {
        for c in self.lattice.axes() {
            self.each_four(c, |places, at, count| {
                let back = self.linear(&predicted[c], &self.taps(c, self.curved(places, c, at, dt)));
                let corrected = |lane: usize| {
                    let (at, [least, most]) = (at + lane, bounds[c][at + lane]);
                    (predicted[c][at] + 0.5 * (source[c][at] - back[lane])).max(least).min(most)
                };
                store(&mut target[c], at, count, std::array::from_fn(corrected));
            });
        }
    }
}

/// Stores the first `count` of four results.
#[inline]
fn store<T: Copy>(target: &mut [T], start: usize, count: usize, results: [T; LANES]) {
    match target[start..].first_chunk_mut() {
        Some(whole) if count == LANES => *whole = results,
        _ => target[start..start + count].copy_from_slice(&results[..count]),
    }
}
