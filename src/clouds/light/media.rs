//! Media of clouds: droplets and ice, with the light in them.

use std::sync::{Arc, OnceLock};

use super::transport::{Scattering, Transport};
use crate::{
    clouds::field::droplets::LIQUID_UM,
    light::{Phase, PhaseLobes},
};

/// Change of the sun's cosine after which the tables under its beam are made anew.
pub(crate) const SUN_MOVED: f64 = 2e-3;
/// Asymmetry of ice crystals (Fu 2007: 0.74 to 0.8 by shape).
const ICE_ASYMMETRY: f64 = 0.77;

fn medium(phase: Phase) -> Arc<Transport> {
    Arc::new(Transport::new(Scattering::new(PhaseLobes::new(&phase), 1.0)))
}

/// Droplets of a diameter, kept for all contexts if it is one of those that clouds have.
pub(crate) fn droplets(diameter_um: f64) -> Arc<Transport> {
    static MADE: [OnceLock<Arc<Transport>>; LIQUID_UM.len()] = [const { OnceLock::new() }; LIQUID_UM.len()];
    let new = || medium(Phase::Droplets { diameter_um });
    let kept = LIQUID_UM.iter().position(|um| *um == diameter_um).map(|i| MADE[i].get_or_init(new).clone());
    kept.unwrap_or_else(new)
}

/// Ice.
fn ice() -> Arc<Transport> {
    static MADE: OnceLock<Arc<Transport>> = OnceLock::new();
    MADE.get_or_init(|| medium(Phase::HenyeyGreenstein { g: ICE_ASYMMETRY })).clone()
}

/// Droplets of a diameter, and ice.
pub(crate) fn media(liquid_um: f64) -> [Arc<Transport>; 2] {
    [droplets(liquid_um), ice()]
}
