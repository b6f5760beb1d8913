//! Named outputs that effects give each other within a frame. The order in which the effects run follows from these
//! outputs.

use super::composition::{Contribution, Texture};
use crate::error::{Error, Result, Status};

/// Output that exactly one effect gives and others take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Output {
    /// Light of lightning flashes. It is part of the moment ([`crate::moment::SceneMoment::flash`]).
    Flashes,
    /// Optical depth of fog from the camera straight up.
    FogDepth,
    /// Height of the drawn sea.
    Sea,
    /// Layer of stars behind the sky's own light.
    Stars,
    /// All layers of the sky, including clouds.
    Sky,
    /// Layer in front of the picture, with rain in it.
    Rain,
    /// Layer in front of the picture, with rain and flakes in it.
    Snow,
}

/// Outputs that have been given so far.
#[derive(Clone, Default)]
pub(crate) struct Outputs {
    /// [`Output::FogDepth`]; 0 if no effect has given it.
    pub fog_depth: f64,
    /// [`Output::Sea`]: height of the sea's highest crests above the camera, m, if a sea is drawn.
    pub sea_top_m: Option<f64>,
    /// [`Output::Stars`], if the layer's drawn share is above 0.
    pub stars: Option<wgpu::TextureView>,
    /// [`Output::Rain`] or [`Output::Snow`], if anything is drawn into the layer.
    pub before: Option<wgpu::TextureView>,
}

impl Outputs {
    /// No outputs, for effects that need none.
    pub const NONE: Self = Self { fog_depth: 0.0, sea_top_m: None, stars: None, before: None };

    /// Returns only the outputs that an effect `needs`, so that it sees no others.
    pub fn only(&self, needs: &[Output]) -> Self {
        if needs.is_empty() {
            return Self::NONE;
        }
        let has = |output| needs.contains(&output);
        Self {
            fog_depth: if has(Output::FogDepth) { self.fog_depth } else { 0.0 },
            sea_top_m: if has(Output::Sea) { self.sea_top_m } else { None },
            stars: if has(Output::Stars) { self.stars.clone() } else { None },
            before: if has(Output::Rain) || has(Output::Snow) { self.before.clone() } else { None },
        }
    }

    /// Takes the outputs that an effect has gathered and lists in `gives`.
    pub fn take(&mut self, gathered: &Self, gives: &[Output]) {
        if gives.contains(&Output::FogDepth) {
            self.fog_depth = gathered.fog_depth;
        }
        if gives.contains(&Output::Sea) {
            self.sea_top_m = gathered.sea_top_m;
        }
    }

    /// Takes the layers of an effect's contribution, if the effect lists them in `gives`.
    pub fn take_layers(&mut self, contribution: &Contribution, gives: &[Output]) {
        if gives.is_empty() {
            return;
        }
        let has = |output| gives.contains(&output);
        if has(Output::Stars) && contribution.shows_stars() {
            self.stars = contribution.texture(Texture::Behind).cloned();
        }
        if let Some(before) = contribution.texture(Texture::Before).filter(|_| has(Output::Rain) || has(Output::Snow)) {
            self.before = Some(before.clone());
        }
    }
}

/// Outputs that an effect takes from others, and those that it gives, either while the effects gather or while they
/// compose.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Exchange {
    pub needs: &'static [Output],
    pub gives: &'static [Output],
}

impl Exchange {
    /// No outputs.
    pub const NONE: Self = Self { needs: &[], gives: &[] };
}

/// Returns an order of the effects in which each comes after the effects whose outputs it needs. Otherwise the order of
/// the list is kept.
///
/// # Errors
/// [`crate::Status::Internal`] if the needs form a cycle, or if an effect needs an output that no effect gives.
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
    fn effects_come_after_those_whose_outputs_they_need_and_a_circle_is_refused() {
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
