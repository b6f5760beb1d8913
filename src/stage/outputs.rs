//! Outputs that effects give each other in a frame, by name: the order in which they are run follows from it.

use super::composition::{Contribution, Texture};
use crate::error::{Error, Result, Status};

/// Output that one effect gives and others take. Each has one giver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Output {
    /// Light of flashes of lightning, in the moment.
    Flashes,
    /// Optical depth of fog straight up from the camera.
    FogDepth,
    /// The layer of stars behind the sky's own light.
    Stars,
    /// All layers of the sky, clouds among them.
    Sky,
    /// The layer before the picture, with rain in it.
    Rain,
    /// The layer before the picture, with rain and flakes in it.
    Snow,
}

/// Outputs that have been given so far.
#[derive(Clone, Default)]
pub(crate) struct Outputs {
    /// [`Output::FogDepth`]; 0 where it was not given.
    pub fog_depth: f64,
    /// [`Output::Stars`], where any of it shows.
    pub stars: Option<wgpu::TextureView>,
    /// [`Output::Rain`] or [`Output::Snow`]: the layer, where anything is drawn into it.
    pub before: Option<wgpu::TextureView>,
}

impl Outputs {
    /// Returns those outputs that an effect `needs`: it sees nothing else.
    pub fn only(&self, needs: &[Output]) -> Self {
        if needs.is_empty() {
            return Self::default();
        }
        let has = |output| needs.contains(&output);
        Self {
            fog_depth: if has(Output::FogDepth) { self.fog_depth } else { 0.0 },
            stars: self.stars.clone().filter(|_| has(Output::Stars)),
            before: self.before.clone().filter(|_| has(Output::Rain) || has(Output::Snow)),
        }
    }

    /// Takes what an effect has gathered, as far as it says that it `gives` it.
    pub fn take(&mut self, gathered: &Self, gives: &[Output]) {
        if gives.contains(&Output::FogDepth) {
            self.fog_depth = gathered.fog_depth;
        }
    }

    /// Takes the layers among what an effect composes, as far as it says that it `gives` them.
    pub fn take_layers(&mut self, contribution: &Contribution<'_>, gives: &[Output]) {
        let has = |output| gives.contains(&output);
        if has(Output::Stars) && contribution.shows_stars() {
            self.stars = contribution.texture(Texture::Behind).cloned();
        }
        if let Some(before) = contribution.texture(Texture::Before).filter(|_| has(Output::Rain) || has(Output::Snow)) {
            self.before = Some(before.clone());
        }
    }
}

/// Outputs that an effect takes from others and gives to them in one step of a frame.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Exchange {
    pub needs: &'static [Output],
    pub gives: &'static [Output],
}

impl Exchange {
    /// Takes and gives nothing.
    pub const NONE: Self = Self { needs: &[], gives: &[] };
}

/// An order in which each comes after all that give what it needs, otherwise as they stand in the list.
///
/// # Errors
/// [`crate::Status::Internal`] where they form a circle, or need what none gives.
pub(crate) fn ordered<const N: usize>(list: [Exchange; N]) -> Result<[usize; N]> {
    let (mut order, mut done) = ([0; N], [false; N]);
    for place in &mut order {
        let is_given = |need: &Output| (0..N).any(|i| done[i] && list[i].gives.contains(need));
        let next = (0..N).find(|&i| !done[i] && list[i].needs.iter().all(is_given));
        let Some(next) = next else {
            let left: Vec<&Exchange> = (0..N).filter(|&i| !done[i]).map(|i| &list[i]).collect();
            return Err(Error::new(Status::Internal, format!("effects that wait for each other: {left:?}")));
        };
        (*place, done[next]) = (next, true);
    }
    Ok(order)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_needs_comes_after_who_gives_and_a_circle_is_refused() {
        let stars = Exchange { needs: &[Output::FogDepth], gives: &[Output::Stars] };
        let clouds = Exchange { needs: &[Output::Stars], gives: &[Output::Sky] };
        let fog = Exchange { needs: &[], gives: &[Output::FogDepth] };
        assert_eq!(ordered([clouds, Exchange::NONE, stars, fog]).unwrap(), [1, 3, 2, 0]);
        assert_eq!(ordered([fog, stars, clouds]).unwrap(), [0, 1, 2]);
        let back = Exchange { needs: &[Output::Sky], gives: &[Output::FogDepth] };
        let error = ordered([back, stars, clouds]).unwrap_err();
        assert!(error.to_string().contains("wait for each other"), "{error}");
        assert!(ordered([clouds]).is_err());
    }
}
