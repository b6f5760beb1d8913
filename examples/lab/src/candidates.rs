//! The charted ways to draw: the library's candidates, and those of older systems. The lab builds the latter itself to
//! show what was gained.

pub use welkin::candidates::Effect;
use welkin::candidates::Method as LibraryMethod;
use welkin::plan::Work;
use welkin::rain::{RainModel, RainSettings, candidates::work as rain_work};
use welkin::{Error, Result};

use crate::sky::elek::ElekTable;
use crate::source_lod::SourceLod;

/// How a candidate draws.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// By the library.
    Library(LibraryMethod),
    /// The sky by a table of single scattering as of 2008.
    Elek(ElekTable),
    /// By drops that get fewer and larger with distance.
    SourceLod(SourceLod),
}

/// One way to draw an effect.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// The effect that it draws.
    pub effect: Effect,
    /// Unique within the effect.
    pub name: &'static str,
    /// How it draws.
    pub method: Method,
    /// Its cost.
    pub work: Work,
    /// Whether it is the default.
    pub is_default: bool,
}

/// Candidates that the library itself does not have.
fn of_older_systems(effect: Effect) -> Vec<Candidate> {
    let one = |name, method, work| Candidate { effect, name, method, work, is_default: false };
    let elek = |name, samples| {
        let table = ElekTable { side: 128, samples };
        one(name, Method::Elek(table), table.work())
    };
    let source = |name, seeds, copies| {
        let lod = SourceLod { seeds, copies, ..SourceLod::default() };
        one(name, Method::SourceLod(lod), rain_work(&as_many_drops(&lod)))
    };
    match effect {
        Effect::Sky => vec![elek("elek-15", 15), elek("elek-50", 50)],
        Effect::Rain => vec![
            source("source-20k", 20_000, 0),
            source("source-140k", 140_000, 0),
            source("source-replicated-140k", 20_000, 6),
        ],
        Effect::Fog | Effect::Stars | Effect::Snow | Effect::Clouds => Vec::new(),
    }
}

/// The library's drops, in the same number as an older system's, so that they cost the same.
pub fn as_many_drops(lod: &SourceLod) -> RainSettings {
    RainSettings { model: RainModel::Drops, most_drops: Some(lod.drop_count()), ..RainSettings::default() }
}

/// All candidates of an effect.
pub fn candidates(effect: Effect) -> Vec<Candidate> {
    let one = |c: welkin::candidates::Candidate| {
        let is_default = c.is_default();
        Candidate { effect, name: c.name, method: Method::Library(c.method), work: c.work, is_default }
    };
    welkin::candidates::candidates(effect).into_iter().map(one).chain(of_older_systems(effect)).collect()
}

/// The candidate with that name.
///
/// # Errors
/// [`welkin::Status::InvalidArgument`] with the known names.
pub fn candidate(effect: Effect, name: &str) -> Result<Candidate> {
    let all = candidates(effect);
    let known: Vec<_> = all.iter().map(|c| c.name).collect();
    let fault =
        Error::range("name", &format!("one of the candidates for {}: {}", effect.name(), known.join(", ")), name);
    all.into_iter().find(|c| c.name == name).ok_or(fault)
}
