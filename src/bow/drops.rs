//! Drops that make bows: their extinction by class in rain, in the low air and in rain areas, and whether the light on
//! them is direct enough.

use glam::DVec3;

use super::table::{CLASSES, RAIN_EDGES_MM, Table, mixed};
use crate::{
    falling::{FallingLayer, drops::factor_in, sizes::DropSizes},
    moment::{GroundLight, Light, Scene, SceneMoment},
    numerics::smoothstep,
    weather::{Conditions, Falling, GroundLayer},
};

/// Largest ratio of direct light to all light on level ground with which no bow shows.
const LEAST_DIRECT: f64 = 1e-3;

/// Returns the extinction of rain by each class of drops, 1/m, where drops fall `factor` times as fast as at sea level.
pub(super) fn in_rain(falling: &Falling, factor: f64) -> [f64; CLASSES] {
    let sizes = DropSizes::new(falling, factor);
    let rain = |i: usize| sizes.extinction_between_per_m(RAIN_EDGES_MM[i - 1], RAIN_EDGES_MM[i]);
    std::array::from_fn(|i| if i == 0 { 0.0 } else { rain(i) })
}

/// Asymmetry of the phase function of fog droplets. Dust and sand have less, lifted snow has more
/// (`weather::particles`).
const DROPLETS: f64 = 0.85;
/// Difference below the asymmetry [`DROPLETS`] at which a layer is dust or sand alone, without droplets.
const DUST_BELOW: f64 = 0.05;
/// Difference above the asymmetry [`DROPLETS`] at which a layer is lifted snow alone, without droplets.
const SNOW_ABOVE: f64 = 0.03;

/// Returns the share of droplets in the extinction of a layer at the ground, 0 to 1. Dust, sand, lifted snow, and fine
/// particles whose extinction changes with the wavelength make no bow.
fn droplets(layer: &GroundLayer) -> f64 {
    let off = layer.asymmetry - DROPLETS;
    let round = 1.0 - if off > 0.0 { off / SNOW_ABOVE } else { -off / DUST_BELOW };
    round.max(0.0) * (1.0 - smoothstep(0.25, 0.75, layer.angstrom_exponent))
}

/// Returns the bows of a weather's low air, relative to all extinction in it; `None` without drops.
pub(crate) fn in_low_air(c: &Conditions) -> Option<Table> {
    low_air(c, in_rain).map(|shares| mixed(&shares))
}

/// Returns the share of each class of drops in the extinction of a weather's low air, which is fog and precipitation
/// together; `None` without drops. `rain` is [`in_rain`] or a cache of it.
pub(super) fn low_air(c: &Conditions, rain: impl FnOnce(&Falling, f64) -> [f64; CLASSES]) -> Option<[f64; CLASSES]> {
    let mut classes = [0.0; CLASSES];
    let falling = FallingLayer::new(c);
    if falling.liquid_per_m > 0.0 {
        classes = rain(&c.precipitation, factor_in(&c.air, c.air.station_altitude_m));
        let all: f64 = classes.iter().sum();
        classes.iter_mut().for_each(|v| *v *= falling.liquid_per_m / all.max(f64::MIN_POSITIVE));
    }
    let fog = c.fog.extinction_per_m.max(0.0);
    classes[0] = fog * droplets(&c.fog);
    let all = fog + falling.extinction_per_m();
    (classes.iter().sum::<f64>() > 0.0).then(|| classes.map(|v| v / all))
}

/// Returns the share of each class of drops in the summed extinction of all rain areas; `None` if no drops fall in any
/// of them. `rain` is [`in_rain`] or a cache of it.
pub(super) fn areas(
    now: &SceneMoment<'_>,
    mut rain: impl FnMut(&Falling, f64) -> [f64; CLASSES],
) -> Option<[f64; CLASSES]> {
    let mut classes = [0.0; CLASSES];
    let factor = factor_in(&now.here.air, now.here.air.station_altitude_m);
    for region in now.weather.regions {
        for (all, class) in classes.iter_mut().zip(rain(&region.area.falling(), factor)) {
            *all += class;
        }
    }
    let all: f64 = classes.iter().sum();
    (all > 0.0).then(|| classes.map(|v| v / all))
}

/// Whether a bow shows: whether enough of the light above the fog comes directly from the sun or the moon, whichever is
/// brighter.
pub(crate) fn is_lit(scene: &Scene) -> bool {
    let of = |light: &Light, ground: &GroundLight| {
        let lux = if light == &scene.sun { ground.sun_lux } else { ground.moon_lux };
        lux[1] > LEAST_DIRECT * ground.total_lux
    };
    of(scene.brighter(), &scene.above_fog)
}

/// Whether a picture may show the bows: whether a direction within `half_angle` of its middle may lie within `reach` of
/// the point opposite to the light. Angles in rad.
pub(super) fn is_within(middle: DVec3, half_angle: f64, to_light: DVec3, reach: f64) -> bool {
    middle.dot(-to_light).clamp(-1.0, 1.0).acos() < half_angle + reach
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::weather::{Lofted, LoftedKind, Weather, derive};

    #[test]
    fn fog_has_a_bow_but_no_sand_dust_or_lifted_snow() {
        let bow = |weather: &Weather| in_low_air(&derive(weather).unwrap()).is_some();
        let lofted = |kind| Weather {
            visibility_m: 400.0,
            lofted: Lofted { kind, ..Weather::default().lofted },
            ..Weather::default()
        };
        assert!(bow(&Weather::preset("fog").unwrap()) && !bow(&Weather::preset("sand_storm").unwrap()));
        for kind in
            [LoftedKind::BlowingSnow, LoftedKind::DriftingSnow, LoftedKind::DriftingDust, LoftedKind::BlowingSand]
        {
            assert!(!bow(&lofted(kind)), "{kind:?}");
        }
    }
}
