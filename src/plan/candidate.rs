//! Candidates: the ways to draw an effect, each with its cost in work units.

use crate::error::{Error, Result};
use crate::fog::candidates::FogMethod;
use crate::rain::{RainSettings, candidates::RainMethod};
use crate::sky::candidates::ElekTable;
use crate::sky::{SkyModel, SkySettings};

/// What can be drawn. Grows with the rooms.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Effect {
    /// Clear air with haze: the sky behind and the air in front of things.
    Sky,
    /// The low layer of fog or mist.
    Fog,
    /// Rain and drizzle near the camera.
    Rain,
}

impl Effect {
    /// All effects with the names that programs use for them.
    pub const NAMES: [(&'static str, Effect); 3] = [("sky", Effect::Sky), ("fog", Effect::Fog), ("rain", Effect::Rain)];

    /// The effect of that name.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] with the known names.
    pub fn from_name(name: &str) -> Result<Self> {
        let known = Self::NAMES.map(|(n, _)| n).join(", ");
        let found = Self::NAMES.iter().find(|(n, _)| *n == name);
        found.map(|(_, e)| *e).ok_or_else(|| Error::range("effect", &format!("one of {known}"), name))
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        Self::NAMES.iter().find(|(_, e)| *e == self).map_or("", |(n, _)| n)
    }
}

/// What a candidate draws with: enough to build it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// Settings for [`crate::sky::SkyTables::new`].
    Sky(SkySettings),
    /// A table of single scattering as of 2008: what the lab compares with, not drawn by the library.
    SkyElek(ElekTable),
    /// A way to draw fog.
    Fog(FogMethod),
    /// A way to draw rain.
    Rain(RainMethod),
}

/// One way to draw an effect.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// What it draws.
    pub effect: Effect,
    /// Unique within the effect, lower case with hyphens.
    pub name: &'static str,
    /// With what it is built.
    pub method: Method,
    /// What it costs.
    pub work: Work,
    /// Whether the library itself draws it, so that a plan may choose it. Others are compared with only.
    pub offered: bool,
}

impl Candidate {
    /// Whether a host that asks for nothing gets this one.
    pub fn is_default(&self) -> bool {
        match self.method {
            Method::Sky(s) => s == SkySettings::default() && s.model == SkyModel::default(),
            Method::Fog(m) => m == FogMethod::default(),
            Method::Rain(m) => m == RainMethod::Offered(RainSettings::default()),
            Method::SkyElek(_) => false,
        }
    }
}

/// All candidates of an effect.
pub fn candidates(effect: Effect) -> Vec<Candidate> {
    match effect {
        Effect::Sky => crate::sky::candidates::candidates(),
        Effect::Fog => crate::fog::candidates::candidates(),
        Effect::Rain => crate::rain::candidates::candidates(),
    }
}

/// The candidate of that name.
///
/// # Errors
/// [`crate::Status::InvalidArgument`] with the known names.
pub fn candidate(effect: Effect, name: &str) -> Result<Candidate> {
    let all = candidates(effect);
    let known: Vec<_> = all.iter().map(|c| c.name).collect();
    let fault = Error::range(&format!("{} candidate", effect.name()), &format!("one of {}", known.join(", ")), name);
    all.into_iter().find(|c| c.name == name).ok_or(fault)
}

/// Amounts of work. A sample is one point of a march or one closed-form column: densities, exponentials, a sum.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Units {
    /// Points at which the medium is evaluated.
    pub samples: f64,
    /// Filtered look-ups.
    pub texels: f64,
    /// Bytes written.
    pub bytes: f64,
}

impl Units {
    /// This and `times` times another.
    pub fn plus(self, other: Self, times: f64) -> Self {
        Self {
            samples: self.samples + times * other.samples,
            texels: self.texels + times * other.texels,
            bytes: self.bytes + times * other.bytes,
        }
    }

    /// The amounts as one number, in samples.
    pub fn at(self, price: &Price) -> f64 {
        self.samples + price.texel * self.texels + price.byte * self.bytes
    }
}

/// What a look-up and a byte cost, in samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Price {
    /// Samples that take as long as a filtered look-up.
    pub texel: f64,
    /// Samples that take as long as a byte written.
    pub byte: f64,
}

impl Default for Price {
    /// Fitted by `lab chart` to a software driver, where look-ups are dear (docs/lab).
    fn default() -> Self {
        Self { texel: 6.4, byte: 0.8 }
    }
}

/// The cost of a candidate by what causes it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Work {
    /// Whenever the air changes, once for all views.
    pub rebuild: Units,
    /// Whenever a view's altitude, its sun or the air changes, per view and lamp.
    pub view: Units,
    /// Every pixel of every frame, per lamp.
    pub pixel: Units,
    /// Bytes held once for all views.
    pub shared_bytes: u64,
    /// Bytes held by each view.
    pub view_bytes: u64,
}

impl Work {
    /// The work of one view's frame under one lamp. `follows`: whether its altitude, sun or air changed.
    pub fn frame(&self, pixels: u64, follows: bool) -> Units {
        let view = if follows { self.view } else { Units::default() };
        view.plus(self.pixel, pixels as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_every_effect_has_one_default() {
        for (name, effect) in Effect::NAMES {
            assert_eq!(Effect::from_name(name).unwrap(), effect);
            let all = candidates(effect);
            assert_eq!(all.iter().filter(|c| c.is_default()).count(), 1, "{name}");
            for c in &all {
                assert_eq!(all.iter().filter(|d| d.name == c.name).count(), 1, "{}", c.name);
                assert_eq!(candidate(effect, c.name).unwrap(), *c);
                assert!(c.effect == effect && c.work.pixel.at(&Price::default()) > 0.0, "{}", c.name);
                if let Method::Sky(s) = c.method {
                    s.check().unwrap();
                }
            }
        }
        assert!(Effect::from_name("sea").unwrap_err().message.contains("sky, fog, rain"));
        assert!(candidate(Effect::Fog, "best").unwrap_err().message.contains("exact"));
    }

    #[test]
    fn a_frame_pays_for_what_changed() {
        let work = Work {
            view: Units { samples: 100.0, ..Default::default() },
            pixel: Units { texels: 2.0, ..Default::default() },
            ..Default::default()
        };
        let price = Price { texel: 0.5, byte: 1.0 };
        assert_eq!(work.frame(10, false).at(&price), 10.0);
        assert_eq!(work.frame(10, true).at(&price), 110.0);
    }
}
