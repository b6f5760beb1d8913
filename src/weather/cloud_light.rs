//! Light that clouds let through at any height: below their layers, inside them and above.
//!
//! # Model
//! The part of a layer above a place dims the light there; the part below reflects light up again. For each part above,
//! the model needs the share of the sky that its clouds cover, and their optical depth ([`super::cloud_part`]). The
//! adding method (van de Hulst 1980) combines the layers. A layer with the place inside enters as two parts, one above
//! the place and one below. Each layer or part is a mixture of cover and gaps. Fluxes are two-stream fluxes; light that
//! droplets scatter nearly straight on stays in the beam (Joseph, Wiscombe and Weinman 1976). A layer divided at any
//! height therefore transmits as much as the whole.
//!
//! # Error
//! `cargo test --lib clouds::light::mean_light -- --nocapture` prints the error of the direct light against the mean
//! over places of the drawn clouds.

use super::cloud_part::{LOWEST, SlabPart};
use super::conditions::{CloudSlab, Conditions};

/// Share of the optical depth that hides objects behind a layer from the eye. The rest scatters light nearly straight
/// on and hides nothing.
const HIDING: f64 = 0.25;
/// Weight of the value for a clear sky in [`over_layers`], as a share of the sky.
const LEAST_COVER: f64 = 1e-6;
/// Reflectance of open land below clouds, for light that is reflected to and fro between land and clouds.
pub(crate) const LAND_ALBEDO: f64 = 0.2;
/// Greatest height above a cloud's base at which its precipitation begins, m.
const MOST_GROWTH_M: f64 = 500.0;
/// Depth over which precipitation sets in, m. Half of this depth lies above the height where the precipitation begins,
/// half below. The extinction sets in over the same depth around the cloud's base ([`Conditions::below_cloud`]).
pub(crate) const ONSET_M: f64 = 100.0;

/// Returns the share of the precipitation that has set in at an altitude. The precipitation sets in around the altitude
/// `begins_m`, over the depth [`ONSET_M`].
fn onset(begins_m: f64, altitude_m: f64) -> f64 {
    ((begins_m + 0.5 * ONSET_M - altitude_m) / ONSET_M).clamp(0.0, 1.0)
}

/// Returns the mean of `f` over `layers` (cover, layer), weighted by the share of the sky in which each layer is the
/// first one met, in the order of `layers`. Without layers it is `clear`. The result is continuous when a layer comes
/// or goes.
fn over_layers<'a>(
    layers: impl Iterator<Item = (f64, &'a CloudSlab)>,
    clear: f64,
    f: impl Fn(&CloudSlab) -> f64,
) -> f64 {
    let (mut open, mut met, mut sum) = (1.0, LEAST_COVER, LEAST_COVER * clear);
    for (cover, slab) in layers {
        (met, sum) = (met + open * cover, sum + open * cover * f(slab));
        open *= 1.0 - cover;
    }
    sum / met
}

/// Light that arrives through the clouds, each field as a share of the light above them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CloudLight {
    /// Share of the sun's beam that arrives as a beam: a mean over places, with gaps weighted by their probability.
    pub direct: f64,
    /// Share of the sun's beam on a horizontal surface that arrives diffuse from the clouds, with the light reflected
    /// between ground and cloud.
    pub diffuse: f64,
    /// Share of the clear sky's diffuse light that arrives.
    pub sky: f64,
}

impl Conditions {
    /// Returns the weather with one more layer, which is placed independently of the others; unchanged if there is no
    /// free slot.
    pub(crate) fn with_layer(mut self, slab: CloudSlab) -> Self {
        if let Some(free) = self.clouds.iter_mut().find(|s| s.cover <= 0.0) {
            self.clear_sky *= 1.0 - slab.cover;
            *free = slab;
            self.clouds.sort_unstable_by(|a, b| a.base_m.total_cmp(&b.base_m));
        }
        self
    }

    /// Returns the shares of sunlight and sky light that arrive through the clouds. The horizontal irradiance is S
    /// (direct + diffuse) + D sky, with S that of the sun and D that of the sky above the clouds.
    ///
    /// `cos_sun_zenith`: cosine of the sun's zenith angle; values below 0.03 count as 0.03. `ground_albedo`: clamped to
    /// 0 to 1; 0.2 for most land. Layers are combined from the top by the adding method (van de Hulst 1980), each as a
    /// mixture of cover and holes. The host's [`super::CloudLightOverride`] is blended in last.
    pub fn cloud_light(&self, cos_sun_zenith: f64, ground_albedo: f64) -> CloudLight {
        self.cloud_light_at(cos_sun_zenith, ground_albedo, f64::NEG_INFINITY)
    }

    /// Returns the parts of the layers that lie above a place at `altitude_m` above the sea, from the top.
    fn layers_above(&self, altitude_m: f64) -> impl Iterator<Item = SlabPart<'_>> {
        let height_m = altitude_m - self.air.station_altitude_m;
        self.clouds.iter().rev().filter(|s| s.cover > 0.0).map(move |s| s.above(height_m))
    }

    /// Returns the altitude at which light from above first meets the clouds over a place: the mean top of the layers
    /// that the light meets first.
    pub(crate) fn lit_top_m(&self, altitude_m: f64) -> f64 {
        let station_m = self.air.station_altitude_m;
        let layers = self.layers_above(altitude_m).map(|part| (part.cover, part.slab));
        over_layers(layers, altitude_m, |s| s.top_m() + station_m).max(altitude_m)
    }

    /// Returns the altitude at which precipitation begins: a mean over the layers that are met first from below, and 2
    /// km above the station if there is no cloud. Precipitation grows while it falls through the lower half of its
    /// cloud, at most through the lowest 500 m, so that it also falls on a hill inside a low deck. A base lower than
    /// 100 m above the station counts as 100 m.
    pub(crate) fn falling_top_m(&self) -> f64 {
        let begins_m = |s: &CloudSlab| s.base_m.max(100.0) + (0.5 * (s.top_m() - s.base_m)).min(MOST_GROWTH_M);
        self.over_first_clouds(begins_m)
    }

    /// Returns the altitude at which precipitation leaves its cloud: as [`Conditions::falling_top_m`], but at the
    /// clouds' bases.
    pub(crate) fn falling_base_m(&self) -> f64 {
        self.over_first_clouds(|s| s.base_m.max(100.0))
    }

    /// Returns the share of the precipitation that has begun to fall at an altitude: all below the height where it
    /// begins in its cloud, none above.
    pub(crate) fn begun(&self, altitude_m: f64) -> f64 {
        onset(self.falling_top_m(), altitude_m)
    }

    /// Returns the share of the precipitation that is visible at an altitude: all below its cloud; inside, the cloud's
    /// own water hides it.
    pub(crate) fn below_cloud(&self, altitude_m: f64) -> f64 {
        onset(self.falling_base_m(), altitude_m)
    }

    /// Returns the mean altitude of the layers that are met first from below; `height_m` returns a layer's height above
    /// the station.
    fn over_first_clouds(&self, height_m: impl Fn(&CloudSlab) -> f64) -> f64 {
        let layers = self.cloud_slabs().map(|s| (s.cover, s));
        self.air.station_altitude_m + over_layers(layers, 2000.0, height_m)
    }

    /// Returns the share of the sky over a place that opaque cloud hides. A layer counts only with its part above the
    /// place, and a thin part only with its opacity.
    pub(crate) fn opaque_cover(&self, altitude_m: f64) -> f64 {
        let hidden = |part: SlabPart<'_>| -part.cover * libm::expm1(-HIDING * part.depth);
        let clear = self.layers_above(altitude_m).map(hidden).fold(1.0, |clear, hidden| clear * (1.0 - hidden));
        (self.gathered() * (1.0 - clear)).min(1.0)
    }

    /// Returns [`Conditions::cloud_light`] at an altitude. Only the clouds above it dim the light; the clouds below
    /// reflect light up, as the ground does.
    pub(crate) fn cloud_light_at(&self, cos_sun_zenith: f64, ground_albedo: f64, altitude_m: f64) -> CloudLight {
        let (fluxes, _) = self.fluxes_at(cos_sun_zenith, ground_albedo, altitude_m);
        let (o, weight) = (&self.cloud_light, self.said_share(altitude_m));
        let host = |computed: f64, said: f64| computed + (said - computed) * weight;
        CloudLight {
            direct: host(fluxes.direct, o.direct),
            diffuse: host((fluxes.beam + fluxes.diffuse - fluxes.direct).max(0.0), o.diffuse),
            sky: host(fluxes.sky, o.diffuse),
        }
    }

    /// Returns the cloud light at an altitude for a sun in the zenith, over open land, which reflects [`LAND_ALBEDO`].
    pub(crate) fn zenith_light_over_land(&self, altitude_m: f64) -> CloudLight {
        self.cloud_light_at(1.0, LAND_ALBEDO, altitude_m)
    }

    /// Returns the light that goes up at an altitude from everything below, as shares of the sun's horizontal
    /// irradiance and of the sky's light above all clouds.
    pub(crate) fn light_up_at(&self, cos_sun_zenith: f64, ground_albedo: f64, altitude_m: f64) -> [f64; 2] {
        let (fluxes, below) = self.fluxes_at(cos_sun_zenith, ground_albedo, altitude_m);
        let (o, weight) = (&self.cloud_light, self.said_share(altitude_m));
        let host = |computed: f64, said: f64| computed + (said * ground_albedo - computed) * weight;
        let sun = below.beam * fluxes.beam + below.even * fluxes.diffuse;
        [host(sun, o.direct + o.diffuse), host(below.even * fluxes.sky, o.diffuse)]
    }

    /// Returns the weight of the host's values at an altitude: full below the clouds, none above them.
    fn said_share(&self, altitude_m: f64) -> f64 {
        let height_m = altitude_m - self.air.station_altitude_m;
        let below = |s: &CloudSlab| s.shares_above_m(height_m)[1];
        self.cloud_light.weight * over_layers(self.cloud_slabs().map(|s| (s.cover, s)), 1.0, below)
    }

    /// Returns the light that comes down at an altitude, and the shares of light that everything below reflects up.
    fn fluxes_at(&self, cos_sun_zenith: f64, ground_albedo: f64, altitude_m: f64) -> (Fluxes, FromBelow) {
        let mu = cos_sun_zenith.clamp(LOWEST, 1.0);
        let height_m = altitude_m - self.air.station_altitude_m;
        let above = FromAbove::new(self.layers_above(altitude_m), mu);
        let below = FromBelow::new(self.cloud_slabs().map(|s| s.below(height_m)), ground_albedo, mu);
        // Light is reflected back and forth between the clouds above and the clouds and ground below.
        let bounce = 1.0 / (1.0 - above.back * below.even).max(1e-6);
        let diffuse = (above.diffuse + above.back * below.beam * (above.slanted + above.beam_through)) * bounce;
        let sky = above.sky * bounce;
        // The layers may hide more of the sky than independent ones would. Then cloud covers more, and less is clear.
        let gathered = self.gathered();
        let left_clear = self.clear_sky() + above.open * gathered;
        let slanted = if above.clear > 1e-9 { left_clear * (above.slanted / above.clear) } else { left_clear };
        let fluxes = Fluxes {
            direct: (slanted + above.through * gathered).min(1.0),
            beam: slanted + above.beam_through * gathered,
            diffuse: diffuse * gathered,
            sky: left_clear + (sky - above.clear).max(0.0) * gathered,
        };
        (fluxes, below)
    }
}

/// Light that comes down at an altitude, as shares of the light above all clouds.
struct Fluxes {
    /// Share of the sun's beam that no cloud scattered.
    direct: f64,
    /// Share of the sun's beam that the two-stream fluxes keep in the beam ([`super::cloud_part::Met::beam_through`]).
    beam: f64,
    /// Share of the sun's beam that comes down scattered.
    diffuse: f64,
    /// Share of the sky's light that comes down.
    sky: f64,
}

/// Light that comes down through the parts of layers above a place, as shares of the light above them all.
struct FromAbove {
    /// Share of the beam that met a cloud and was never scattered.
    through: f64,
    /// Share of the beam that met a cloud and that the two-stream fluxes keep in the beam
    /// ([`super::cloud_part::Met::beam_through`]).
    beam_through: f64,
    /// Share of the sky's light that met no cloud.
    clear: f64,
    /// Share of the beam that met no cloud.
    slanted: f64,
    /// Light that met no cloud, but would have met one if the place were below all layers. It is summed layer by layer.
    /// As the difference of two nearly equal products it would have a rounding error: light where there is none.
    open: f64,
    /// Share of the beam that comes down scattered.
    diffuse: f64,
    /// Share of the sky's light that comes down.
    sky: f64,
    /// Share of light from below that is reflected down again.
    back: f64,
}

impl FromAbove {
    /// Passes a beam through `parts` from the top; `mu` is the sine of the beam's elevation.
    fn new<'a>(parts: impl Iterator<Item = SlabPart<'a>>, mu: f64) -> Self {
        let mut to = Self {
            through: 0.0,
            beam_through: 0.0,
            clear: 1.0,
            slanted: 1.0,
            open: 0.0,
            diffuse: 0.0,
            sky: 1.0,
            back: 0.0,
        };
        let mut clear_of_all = 1.0;
        for part in parts {
            let met = part.meet(mu);
            let even_back = part.back();
            let beam = to.slanted + to.beam_through;
            let bounce = 1.0 / (1.0 - to.back * even_back);
            let between = (to.diffuse + to.back * met.back * beam) * bounce;
            to.diffuse = (1.0 - even_back) * between + beam * met.scattered();
            to.sky *= (1.0 - even_back) * bounce;
            to.back = even_back + (1.0 - even_back) * (1.0 - even_back) * to.back * bounce;
            to.through = to.through * (1.0 - met.hit + met.through) + to.slanted * met.through;
            to.beam_through = to.beam_through * (1.0 - met.hit + met.beam_through) + to.slanted * met.beam_through;
            to.slanted *= 1.0 - met.hit;
            to.open = to.open * (1.0 - part.cover) + clear_of_all * (part.slab.cover - part.cover);
            to.clear *= 1.0 - part.cover;
            clear_of_all *= 1.0 - part.slab.cover;
        }
        to
    }
}

/// Share of light that everything below a place reflects up.
struct FromBelow {
    /// Share of the beam that is reflected.
    beam: f64,
    /// Share of diffuse light that is reflected.
    even: f64,
}

impl FromBelow {
    /// Computes the shares for ground under `parts`, lowest first.
    fn new<'a>(parts: impl Iterator<Item = SlabPart<'a>>, ground_albedo: f64, mu: f64) -> Self {
        let albedo = ground_albedo.clamp(0.0, 1.0);
        let ground = Self { beam: albedo, even: albedo };
        parts.filter(|part| part.depth > 0.0).fold(ground, |below, part| {
            let met = part.meet(mu);
            let back = part.back();
            let bounce = 1.0 / (1.0 - back * below.even).max(1e-6);
            let straight = 1.0 - met.hit + met.beam_through;
            let down = (met.scattered() + back * below.beam * straight) * bounce;
            let up = below.beam * straight + below.even * down;
            Self { beam: met.back + (1.0 - back) * up, even: back + (1.0 - back) * (1.0 - back) * below.even * bounce }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::weather::{Weather, conditions::clear_between, slab_reflectance};

    fn under(slabs: &[CloudSlab]) -> Conditions {
        let mut c = crate::weather::derive(&Weather::default()).unwrap();
        c.clouds[..slabs.len()].copy_from_slice(slabs);
        c
    }

    fn sheet(optical_depth: f64, base_m: f64) -> CloudSlab {
        CloudSlab { cover: 1.0, base_m, optical_depth, ..CloudSlab::NONE }
    }

    #[test]
    fn light_is_conserved_and_falls_with_cover() {
        assert_eq!(under(&[]).cloud_light(0.7, 0.2), CloudLight { direct: 1.0, diffuse: 0.0, sky: 1.0 });
        let one = under(&[sheet(16.0, 900.0)]).cloud_light(1.0, 0.0);
        assert!((one.direct + one.diffuse - (1.0 - slab_reflectance(16.0, 0.85, 1.0))).abs() < 1e-9);
        let mut last = f64::INFINITY;
        for i in 0..=10 {
            let slab = CloudSlab { cover: f64::from(i) / 10.0, ..sheet(20.0, 900.0) };
            let l = under(&[slab]).cloud_light(0.6, 0.2);
            assert!(l.direct + l.diffuse < last, "cover must darken");
            last = l.direct + l.diffuse;
        }
    }

    /// While one overcast replaces another, the product of the holes in all layers is no light, in whatever order it is
    /// computed.
    #[test]
    fn no_light_comes_from_the_rounding_of_holes() {
        let part = |cover, optical_depth, base_m| CloudSlab { cover, ..sheet(optical_depth, base_m) };
        for i in 0..1000 {
            let t = f64::from(i) / 1000.0;
            let layers =
                [part(0.3 + 0.3 * t, 94.0, 307.0), part(0.9 - 0.3 * t, 563.0, 762.0), part(1.0 - t, 200.0, 2743.0)];
            let c = Conditions { clear_sky: 0.0, ..under(&layers) };
            let open = FromAbove::new(c.layers_above(2.0), 0.01).open;
            assert!(open == 0.0 && c.cloud_light_at(0.01, 0.2, 2.0).direct < 0.05, "{layers:?}: {open}");
        }
    }

    #[test]
    fn a_place_among_layers_has_the_light_of_those_above_it() {
        let c =
            under(&[CloudSlab { cover: 0.4, ..sheet(1e4, 500.0) }, CloudSlab { cover: 0.25, ..sheet(1e4, 3000.0) }]);
        let direct = |altitude_m: f64| c.cloud_light_at(0.5, 0.0, altitude_m).direct;
        let [none, low, high] = [0.0, 500.0, 3000.0].map(direct);
        assert!((none / (0.6 * 0.75) - 1.0).abs() < 0.1 && (high / 0.75 - 1.0).abs() < 0.1, "{none} {high}");
        assert_eq!([low, direct(600.0), direct(3100.0)], [none, high, 1.0]);
        let [within, above] = [550.0, 3050.0].map(direct);
        assert!(none < within && within < high && high < above && above < 1.0, "{within} {above}");
    }

    /// A layer of each kind, broken and closed, thin and thick, and several above one another.
    fn skies() -> Vec<Vec<CloudSlab>> {
        let kinds =
            [(0.0, 0.0, 0.0), (0.2, 0.7, 0.0), (0.5, 0.0, 0.0), (0.8, 0.0, 0.0), (1.0, 0.0, 0.0), (0.1, 0.0, 1.0)];
        let mut skies = Vec::new();
        for (convection, cellular, fibre) in kinds {
            for cover in [0.125, 0.75, 0.995, 1.0] {
                for optical_depth in [0.3, 13.0, 560.0] {
                    let of = CloudSlab {
                        cover,
                        convection,
                        cellular,
                        fibre,
                        thickness_m: 300.0,
                        ..sheet(optical_depth, 30.0)
                    };
                    skies.push(vec![of]);
                }
            }
        }
        let broken = CloudSlab { cover: 0.6, ..sheet(8.0, 200.0) };
        skies.push(vec![sheet(12.0, 0.0), broken, sheet(1.0, 700.0)]);
        skies.push(vec![CloudSlab { thickness_m: 900.0, ..sheet(40.0, -100.0) }, broken]);
        skies
    }

    /// Largest difference of a share of the light between two heights if it is continuous: over a hundredth of a
    /// millimetre no share may change by more than a hundredth.
    fn check_steady(shares: &impl Fn(f64) -> [f64; 4], low: (f64, [f64; 4]), high: (f64, [f64; 4])) {
        let most = (0..4).map(|k| (high.1[k] - low.1[k]).abs()).fold(0.0, f64::max);
        if most < 0.01 {
            return;
        }
        assert!(high.0 - low.0 > 1e-5, "a leap at {} m: {:?} {:?}", low.0, low.1, high.1);
        let middle = 0.5 * (low.0 + high.0);
        let at_middle = (middle, shares(middle));
        check_steady(shares, low, at_middle);
        check_steady(shares, at_middle, high);
    }

    #[test]
    fn light_changes_steadily_while_a_place_rises_through_layers() {
        for slabs in skies() {
            let c = Conditions { clear_sky: clear_between(&under(&slabs).clouds), ..under(&slabs) };
            let top_m = slabs.iter().map(CloudSlab::top_m).fold(0.0, f64::max);
            for mu in [-1.0, -0.1, 0.0, 0.03, 0.1, 0.3, 0.7, 1.0] {
                let shares = |altitude_m: f64| {
                    let light = c.cloud_light_at(mu, 0.2, altitude_m);
                    [light.direct, light.diffuse, light.sky, c.opaque_cover(altitude_m)]
                };
                let step_m = (top_m + 300.0) / 200.0;
                let mut last = (-200.0, shares(-200.0));
                for i in 1..=200 {
                    let altitude_m = step_m * f64::from(i) - 200.0;
                    let now = (altitude_m, shares(altitude_m));
                    let at = format!("{slabs:?}, {mu}, {altitude_m} m: {now:?}");
                    assert!(now.1.iter().all(|v| (0.0..1.5).contains(v)), "{at}");
                    assert!(now.1[0] >= last.1[0] - 1e-12 && now.1[3] <= last.1[3] + 1e-12, "{at} after {last:?}");
                    check_steady(&shares, last, now);
                    last = now;
                }
                let [ground, base, above] =
                    [-1e4, slabs[0].base_m - 1.0, top_m + 1.0].map(|z| c.cloud_light_at(mu, 0.2, z));
                assert_eq!((ground, above), (base, CloudLight { direct: 1.0, diffuse: 0.0, sky: 1.0 }));
            }
        }
    }

    /// A layer with constant water density transmits the same light wherever a place divides it.
    #[test]
    fn a_layer_divided_anywhere_is_the_layer() {
        let all = [12.0, 0.0].map(|depth| sheet(depth, 0.0));
        for mu in [0.1, 0.5, 1.0] {
            let whole = under(&all[..1]).cloud_light(mu, 0.3);
            for lower in [1.0, 4.0, 11.0] {
                let two = under(&[sheet(lower, 0.0), sheet(12.0 - lower, 1000.0)]).cloud_light(mu, 0.3);
                assert!((two.direct - whole.direct).abs() < 1e-12 && (two.diffuse - whole.diffuse).abs() < 1e-9);
                assert!((two.sky - whole.sky).abs() < 1e-9, "{two:?} {whole:?}");
            }
        }
    }

    #[test]
    fn snow_under_cloud_is_brighter_than_soil() {
        let c = under(&[sheet(20.0, 600.0)]);
        assert!(c.cloud_light(0.5, 0.8).diffuse > 1.5 * c.cloud_light(0.5, 0.1).diffuse);
    }

    #[test]
    fn override_replaces_the_slabs_light() {
        let mut c = under(&[sheet(20.0, 600.0)]);
        c.cloud_light = super::super::CloudLightOverride { weight: 1.0, direct: 0.25, diffuse: 0.5 };
        assert_eq!(c.cloud_light(0.5, 0.2), CloudLight { direct: 0.25, diffuse: 0.5, sky: 0.5 });
    }
}
