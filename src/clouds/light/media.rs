//! Media of clouds, droplets and ice, with the transport of light in them.

use std::sync::{Arc, OnceLock};

use super::transport::{Scattering, Transport};
use crate::{
    clouds::field::droplets::LIQUID_UM,
    light::{Phase, PhaseLobes},
};

/// Change of the cosine of the sun's zenith angle after which the tables under its beam are computed again.
pub(crate) const SUN_MOVED: f64 = 2e-3;
/// Asymmetry parameter of ice crystals (Fu 2007: 0.74 to 0.8 by shape).
const ICE_ASYMMETRY: f64 = 0.77;

/// Creates the transport in a medium that absorbs nothing.
fn medium(phase: Phase) -> Arc<Transport> {
    Arc::new(Transport::new(Scattering::new(PhaseLobes::new(&phase), 1.0)))
}

/// Returns the transport in droplets of a diameter. It is shared by all contexts if the diameter is one of
/// [`LIQUID_UM`].
pub(crate) fn droplets(diameter_um: f64) -> Arc<Transport> {
    static MADE: [OnceLock<Arc<Transport>>; LIQUID_UM.len()] = [const { OnceLock::new() }; LIQUID_UM.len()];
    let new = || medium(Phase::Droplets { diameter_um });
    let kept = LIQUID_UM.iter().position(|um| *um == diameter_um).map(|i| MADE[i].get_or_init(new).clone());
    kept.unwrap_or_else(new)
}

/// Returns the transport in ice, shared by all contexts.
fn ice() -> Arc<Transport> {
    static MADE: OnceLock<Arc<Transport>> = OnceLock::new();
    MADE.get_or_init(|| medium(Phase::HenyeyGreenstein { g: ICE_ASYMMETRY })).clone()
}

/// Returns the media of clouds: droplets of a diameter (index 0), and ice (index 1).
pub(crate) fn media(liquid_um: f64) -> [Arc<Transport>; 2] {
    [droplets(liquid_um), ice()]
}
