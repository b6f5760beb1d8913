//! Which drops of a weather make bows.

use glam::DVec3;

use super::table::{CLASSES, RAIN_EDGES_MM, Table, mixed};
use crate::{
    falling::{FallingLayer, drops::factor_in, sizes::DropSizes},
    moment::{GroundLight, Light, Moment, Scene},
    weather::{Conditions, smoothstep},
};

/// Direct light over all light on level ground below which no bow shows.
const LEAST_DIRECT: f64 = 1e-3;

/// Adds what classes of rain take of the light, 1/m.
fn add_rain(classes: &mut [f64; CLASSES], sizes: &DropSizes) {
    for (class, edges) in classes[1..].iter_mut().zip(RAIN_EDGES_MM.windows(2)) {
        *class += sizes.extinction_between_per_m(edges[0], edges[1]);
    }
}

/// The bows of a weather's low air, of all that takes its light; `None` where there are no drops.
pub(crate) fn in_low_air(c: &Conditions) -> Option<Table> {
    low_air(c).map(|shares| mixed(&shares))
}

/// What each class of drops takes of the light in a weather's low air, fog and what falls together, over all that is taken.
pub(super) fn low_air(c: &Conditions) -> Option<[f64; CLASSES]> {
    let mut classes = [0.0; CLASSES];
    let falling = FallingLayer::new(c);
    if falling.liquid_per_m > 0.0 {
        add_rain(&mut classes, &DropSizes::new(&c.precipitation, factor_in(&c.air, c.air.station_altitude_m)));
        let all: f64 = classes.iter().sum();
        classes.iter_mut().for_each(|v| *v *= falling.liquid_per_m / all.max(f64::MIN_POSITIVE));
    }
    // Particles that tell colours apart are no droplets.
    let fog = c.fog.extinction_per_m.max(0.0);
    classes[0] = fog * (1.0 - smoothstep(0.25, 0.75, c.fog.angstrom_exponent));
    let all = fog + falling.extinction_per_m();
    (classes.iter().sum::<f64>() > 0.0).then(|| classes.map(|v| v / all))
}

/// The same of the rain areas' drops on the mean; `None` without any.
pub(super) fn areas(now: &Moment<'_>) -> Option<[f64; CLASSES]> {
    let mut classes = [0.0; CLASSES];
    let factor = factor_in(&now.here.air, now.here.air.station_altitude_m);
    for region in now.weather.regions {
        add_rain(&mut classes, &DropSizes::new(&region.area.falling(), factor));
    }
    let all: f64 = classes.iter().sum();
    (all > 0.0).then(|| classes.map(|v| v / all))
}

/// Whether sun or moon, whichever is brighter, lights drops so directly that a bow shows.
pub(crate) fn is_lit(scene: &Scene) -> bool {
    let of = |light: &Light, ground: &GroundLight| {
        let lux = if light == &scene.sun { ground.sun_lux } else { ground.moon_lux };
        lux[1] > LEAST_DIRECT * ground.total_lux
    };
    of(scene.brighter(), &scene.above_fog)
}

/// Whether some direction within `half_angle` of the middle of a picture may be within `reach` of the point opposite to the light, rad.
pub(super) fn is_within(middle: DVec3, half_angle: f64, to_light: DVec3, reach: f64) -> bool {
    middle.dot(-to_light).clamp(-1.0, 1.0).acos() < half_angle + reach
}
