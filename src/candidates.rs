//! Candidates of all rooms: the ways to draw each effect that the lab compares.
//!
//! A [`Candidate`] is a model at a setting, with its [`Work`], a deterministic model of its cost in samples, texels and
//! bytes. The lab (`examples/lab`) draws every candidate, and the methods of older systems beside them. It measures
//! cost and [`Difference`](crate::plan::Difference) from the f64 reference, and charts both. A candidate is worth
//! choosing only if no other has both less cost and a smaller difference.
//!
//! ```
//! use welkin::candidates::{Effect, Method, candidate, candidates};
//!
//! let half = candidate(Effect::Sky, "directional-half").unwrap();
//! let Method::Sky(settings) = half.method else { panic!() };
//! let default = candidates(Effect::Sky).into_iter().find(|c| c.is_default()).unwrap();
//! assert!(half.work.view.samples < default.work.view.samples);
//! settings.check().unwrap(); // ready for `SkyTables::new`
//! ```

use crate::{
    clouds::candidates::CloudMethod,
    error::{Error, Result},
    fog::candidates::FogMethod,
    plan::{Listed, Work},
    rain::RainSettings,
    sky::{SkyModel, SkySettings},
    snow::SnowSettings,
    stars::candidates::StarMethod,
};

/// Effects that have candidates. A new room with a file `candidates.rs` adds a variant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Effect {
    /// Clear air with haze: the sky behind and the air in front of objects.
    Sky,
    /// The low layer of fog or mist.
    Fog,
    /// Rain and drizzle near the camera.
    Rain,
    /// Stars, planets and the glow between them.
    Stars,
    /// Flakes of falling snow near the camera.
    Snow,
    /// Layers of cloud.
    Clouds,
}

impl Effect {
    /// All effects with the names that programs use for them.
    pub const NAMES: [(&'static str, Effect); 6] = [
        ("sky", Effect::Sky),
        ("fog", Effect::Fog),
        ("rain", Effect::Rain),
        ("stars", Effect::Stars),
        ("snow", Effect::Snow),
        ("clouds", Effect::Clouds),
    ];

    /// Finds the effect of a name.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] with the known names.
    pub fn from_name(name: &str) -> Result<Self> {
        let known = Self::NAMES.map(|(n, _)| n).join(", ");
        let found = Self::NAMES.iter().find(|(n, _)| *n == name);
        found.map(|(_, e)| *e).ok_or_else(|| Error::range("effect", &format!("one of {known}"), name))
    }

    /// Returns the effect's name.
    pub fn name(self) -> &'static str {
        Self::NAMES.iter().find(|(_, e)| *e == self).map_or("", |(n, _)| n)
    }
}

/// Method of a candidate, with all settings that are needed to build it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// Settings for [`crate::sky::SkyTables::new`].
    Sky(SkySettings),
    /// A way to draw fog.
    Fog(FogMethod),
    /// Settings for [`crate::frame::View::set_rain`].
    Rain(RainSettings),
    /// A way to draw the night sky.
    Stars(StarMethod),
    /// A way to draw falling snow.
    Snow(SnowSettings),
    /// A way to draw clouds.
    Clouds(CloudMethod),
}

/// One way to draw an effect.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// Effect that the candidate draws.
    pub effect: Effect,
    /// Name, unique within the effect: lower case with hyphens.
    pub name: &'static str,
    /// Method with its settings.
    pub method: Method,
    /// Work of drawing by this method.
    pub work: Work,
}

impl Candidate {
    /// Whether the candidate is the default, which a host gets without asking.
    pub fn is_default(&self) -> bool {
        match self.method {
            Method::Sky(s) => s == SkySettings::default() && s.model == SkyModel::default(),
            Method::Fog(m) => m == FogMethod::default(),
            Method::Rain(s) => s == RainSettings::default(),
            Method::Stars(m) => m == StarMethod::default(),
            Method::Snow(m) => m == SnowSettings::default(),
            Method::Clouds(m) => m == CloudMethod::default(),
        }
    }
}

/// Returns all candidates of an effect.
pub fn candidates(effect: Effect) -> Vec<Candidate> {
    fn all<M>(effect: Effect, listed: Vec<Listed<M>>, method: impl Fn(M) -> Method) -> Vec<Candidate> {
        let one = |l: Listed<M>| {
            let Listed { name, work, .. } = l;
            Candidate { effect, name, method: method(l.method), work }
        };
        listed.into_iter().map(one).collect()
    }
    match effect {
        Effect::Sky => all(effect, crate::sky::candidates::candidates(), Method::Sky),
        Effect::Fog => all(effect, crate::fog::candidates::candidates(), Method::Fog),
        Effect::Rain => all(effect, crate::rain::candidates::candidates(), Method::Rain),
        Effect::Stars => all(effect, crate::stars::candidates::candidates(), Method::Stars),
        Effect::Snow => all(effect, crate::snow::candidates::candidates(), Method::Snow),
        Effect::Clouds => all(effect, crate::clouds::candidates::candidates(), Method::Clouds),
    }
}

/// Finds the candidate of a name.
///
/// # Errors
/// [`crate::Status::InvalidArgument`] with the known names.
pub fn candidate(effect: Effect, name: &str) -> Result<Candidate> {
    let all = candidates(effect);
    let known: Vec<_> = all.iter().map(|c| c.name).collect();
    let fault =
        Error::range("name", &format!("one of the candidates for {}: {}", effect.name(), known.join(", ")), name);
    all.into_iter().find(|c| c.name == name).ok_or(fault)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::Price;

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
        assert!(Effect::from_name("sea").unwrap_err().to_string().contains("sky, fog, rain, stars"));
        assert!(candidate(Effect::Fog, "best").unwrap_err().to_string().contains("exact"));
    }
}
