//! Test of the weather's closed formulas for the share of direct light under clouds ([`Conditions::cloud_light_at`]),
//! which queries report. The formulas are compared with the mean share that the drawn clouds let through to many
//! places, for high and low light, from below the clouds' base to above their top.

use glam::{DVec2, DVec3};

use super::shadow::depth;
use crate::{
    clouds::field::{
        Field, Map, Solid,
        cover::{field, threshold},
    },
    weather::{CloudKind, CloudLayer, Conditions, Weather, derive},
};

/// Sines of the light's elevation.
const LIGHTS: [f64; 6] = [1.0, 0.7, 0.4, 0.2, 0.1, 0.03];
/// Number of places for each seed.
const PLACES: usize = 160;

/// Creates the maps and noises of three seeds.
fn grown() -> Vec<(Map, Solid)> {
    (1..=3).map(|seed| (Map::new(seed), Solid::new(seed).unwrap())).collect()
}

/// Returns the mean share of the direct light that comes to places at a height. `mu` is the sine of the light's
/// elevation.
fn mean(c: &Conditions, grown: &[(Map, Solid)], height_m: f64, mu: f64) -> f64 {
    let spacing_m = c.cloud_slabs().map(|slab| slab.scale_m).fold(0.0, f64::max);
    let to_light = DVec3::new((1.0 - mu * mu).sqrt(), 0.0, mu);
    let of_seed = |seed: &(Map, Solid)| {
        let fields: Vec<Field<'_>> = c.cloud_slabs().map(|slab| field(slab, seed, threshold(slab))).collect();
        let one = |i: usize| {
            // The places are some clouds apart, so that they are independent.
            let place = DVec2::new(3.37 * i as f64, 2.618 * ((i * i) % 101) as f64) * spacing_m;
            (-fields.iter().map(|field| depth(field, place.extend(height_m), to_light)).sum::<f64>()).exp()
        };
        (0..PLACES).map(one).sum::<f64>() / PLACES as f64
    };
    grown.iter().map(of_seed).sum::<f64>() / grown.len() as f64
}

/// Returns the conditions of a weather with these layers of cloud.
fn under(layers: &[CloudLayer]) -> Conditions {
    derive(&Weather { clouds: layers.to_vec(), ..Weather::default() }).unwrap()
}

/// Compares the share of direct light that the weather's formula gives with the mean over places, at these heights and
/// for all of [`LIGHTS`]. Returns the root mean square of the differences, and the largest with its description.
fn off(c: &Conditions, grown: &[(Map, Solid)], heights_m: &[f64]) -> (f64, (f64, String)) {
    let (mut squares, mut most) = (0.0, (0.0, String::new()));
    for height_m in heights_m {
        for mu in LIGHTS {
            let (reported, mean) = (c.cloud_light_at(mu, 0.2, *height_m).direct, mean(c, grown, *height_m, mu));
            squares += (reported - mean) * (reported - mean) / (heights_m.len() * LIGHTS.len()) as f64;
            if (reported - mean).abs() > most.0 {
                most = (
                    (reported - mean).abs(),
                    format!("{reported:.2} for {mean:.2} at {height_m:.0} m under a sine of {mu}"),
                );
            }
        }
    }
    (squares.sqrt(), most)
}

#[test]
fn the_queried_share_of_the_sun_is_the_mean_over_places() {
    let grown = grown();
    for kind in &CloudKind::ALL[1..] {
        let (mut below, mut within) = ((0.0f64, 0.0f64), (0.0f64, 0.0f64));
        let mut worst = (0.0, String::new());
        for cover in [0.125, 0.4375, 0.75, 1.0] {
            // The layer lies on the ground. A high layer gives the same: only the height within the layer counts.
            let c = under(&[CloudLayer::of(*kind, cover, 0.0)]);
            let thickness_m = c.cloud_slabs().next().unwrap().thickness_m;
            let (rms, most) = off(&c, &grown, &[-1.0]);
            below = (below.0.max(rms), below.1.max(most.0));
            let inside = [0.2, 0.5, 0.8, 0.95].map(|share| share * thickness_m);
            let (rms, most) = off(&c, &grown, &inside);
            within = (within.0.max(rms), within.1.max(most.0));
            if most.0 > worst.0 {
                worst = (most.0, format!("{cover}: {}", most.1));
            }
            assert_eq!(off(&c, &grown, &[thickness_m + 1.0]).1.0, 0.0, "{kind:?}: above all clouds");
        }
        println!("{kind:?}: off by {below:.3?} below, {within:.3?} within (rms and most); {}", worst.1);
        assert!(below.0 < 0.08 && below.1 < 0.16, "{kind:?} below: {below:.3?}");
        assert!(within.0 < 0.1 && within.1 < 0.22, "{kind:?} within: {within:.3?}, {}", worst.1);
    }
}

#[test]
fn the_queried_share_of_the_sun_is_the_mean_among_several_layers() {
    use CloudKind::{Altocumulus, Cirrostratus, Cumulus, Nimbostratus, Stratocumulus, Stratus};
    let grown = grown();
    for said in [
        &[(Stratus, 0.75, 30.0), (Stratocumulus, 0.75, 600.0)][..],
        &[(Stratus, 1.0, 30.0), (Nimbostratus, 1.0, 150.0)],
        &[(Cumulus, 0.3, 400.0), (Altocumulus, 0.5, 3000.0), (Cirrostratus, 1.0, 8000.0)],
        &[(Stratus, 0.4, 0.0), (Stratocumulus, 0.6, 100.0), (Cumulus, 0.5, 250.0)],
    ] {
        let layers: Vec<_> = said.iter().map(|(kind, cover, base_m)| CloudLayer::of(*kind, *cover, *base_m)).collect();
        let c = under(&layers);
        let (rms, most) = off(&c, &grown, &[-10.0, 2.0, 60.0, 200.0, 450.0, 800.0, 3200.0, 9000.0]);
        println!("{said:?}: off by {rms:.3}, {:.3} at most: {}", most.0, most.1);
        assert!(rms < 0.08 && most.0 < 0.25, "{said:?}: {rms:.3}, {most:?}");
    }
}
