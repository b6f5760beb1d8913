//! Radiance of a layer of cloud along a ray, from photons that are traced back from the eye through the drawn field. It
//! is the reference for the march and the light.
//!
//! # Model
//! Free paths are sampled by null collisions in f64, without steps or scaled depths. The sun is a beam. At each
//! scattering, sunlight is sampled along the path through the cloud towards the sun. Photons that leave through the top
//! meet the radiance above, and photons that leave through the base meet the radiance below. The drawn light has the
//! same inputs. Nothing is absorbed. The layer is level and infinite.
//!
//! The photons' noise is the main error; each answer includes its standard error. The other error is a widened lobe:
//! after a scattering through a wide angle, the narrow lobe of the phase function is widened where the sun is sampled.
//! Otherwise a few rare photons would contribute most of the radiance. The widening changes the reflectance of uniform
//! slabs by less than the test's noise.

use std::sync::Arc;

use glam::DVec3;

use super::march::{CloudRays, CloudsSeen, skip};
use crate::{
    chance::RandomStream,
    clouds::{
        field::{
            droplets::nearest_diameter,
            extinction::{Field, MOST_FRAYED},
            map::Map,
            shape::{Shape, dome},
            solid::Solid,
            thresholds::{threshold, typical},
        },
        light::{layer_light::LayerLight, media::media, sources::Sources},
        reference::turned,
    },
    error::Result,
    light::{PhaseLobes, phase::lobes_phase},
    weather::{CloudKind, CloudSlab},
};

/// Share of the cloud-free distance from [`skip`] by which a photon advances.
const SKIPPED: f64 = 0.5;
/// Distance within which the threshold stays the same, m, and its slope beyond: the field has no local cover.
const UNMAPPED: [f64; 2] = [f64::INFINITY, 0.0];
/// Rate at which the narrow lobe is widened where the sun is sampled: after n scatterings through wide angles its
/// asymmetry is at most 1 - `WIDER` n.
const WIDER: f64 = 0.03;
/// Largest n in the limit of [`WIDER`].
const WIDER_TURNS: u32 = 3;
/// Ratio of the phase function towards the sun to isotropic scattering, 1 / (4 pi), above which the sun is always
/// sampled.
const ASKED_FROM: f64 = 2.0;
/// Smallest probability of sampling the sun.
const ASKED_LEAST: f64 = 0.1;

/// Light that falls on a layer, in any unit of radiance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GivenLight {
    /// Unit vector towards the sun, (east, north, up).
    pub to_sun: DVec3,
    /// Irradiance of the sun on a surface that faces it.
    pub sun: f64,
    /// Radiance from above.
    pub above: f64,
    /// Radiance from below.
    pub below: f64,
}

impl GivenLight {
    /// Creates the light of a sun of irradiance 1 under a sky of radiance `sky`, over ground of this albedo.
    pub fn over_ground(to_sun: DVec3, sky: f64, albedo: f64) -> Self {
        let falls = to_sun.z.max(0.0) + std::f64::consts::PI * sky;
        Self { to_sun, sun: 1.0, above: sky, below: albedo / std::f64::consts::PI * falls }
    }
}

/// Light of sun, sky and ground along a ray, in the unit of [`GivenLight`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// Radiance, including the light from behind the cloud.
    pub all: f64,
    /// Parts of `all` by source: sun, above, below.
    pub by: [f64; 3],
    /// Transmittance of the cloud, 0 to 1. In the model it includes light that droplets scatter into the narrow forward
    /// peak, in the photons' answer only light that is not scattered.
    pub through: f64,
    /// Standard error of `all`; 0 for the model.
    pub error: f64,
}

/// A layer of cloud of one kind in given light.
pub struct LitLayer {
    /// Shape of the layer's clouds.
    shape: Shape,
    /// Sheets of the map.
    map: Map,
    /// Solid noise that frays the edges.
    solid: Solid,
    /// Tables of light that the model reads.
    sources: Arc<Sources>,
    /// Light that falls on the layer.
    light: GivenLight,
}

impl LitLayer {
    /// Creates the layer of a slab in still air with the noise of a seed.
    ///
    /// # Errors
    /// [`crate::Status::OutOfMemory`] if there is no memory for the noise.
    pub fn new(slab: &CloudSlab, seed: u64, light: GivenLight) -> Result<Self> {
        let [droplets, ice] = media(nearest_diameter(std::iter::once(slab)));
        let medium = if slab.ice_fraction > 0.5 { ice } else { droplets };
        let sources = Sources::new(&medium, light.to_sun);
        let shape = Shape::still(slab, threshold(slab));
        Ok(Self { shape, map: Map::new(seed), solid: Solid::new(seed)?, sources: Arc::new(sources), light })
    }

    /// Returns the field of the layer's clouds.
    fn field(&self) -> Field<'_> {
        Field { shape: self.shape, map: &self.map, solid: &self.solid, placed: Default::default() }
    }

    /// Returns the model's light along a ray from `eye` (east, north, up), m: the march for queries through this field.
    /// `longer` has two factors on the lengths of its steps: by depth, and by angle and rise.
    pub fn model(&self, eye: DVec3, direction: DVec3, longer: [f64; 2]) -> Seen {
        // Each source has its own colour channel, with unit strength.
        let light = LayerLight { sun: [1.0, 0.0, 0.0], above: [0.0, 1.0, 0.0], below: [0.0, 0.0, 1.0] };
        let rays = CloudRays::given(self.field(), &self.sources, light, eye, longer);
        let CloudsSeen { light, transmittance, .. } = rays.seen(direction, f64::INFINITY);
        let mut by = [light.x * self.light.sun, light.y * self.light.above, light.z * self.light.below];
        let behind = if direction.z > 0.0 { 1 } else { 2 };
        by[behind] += transmittance * [0.0, self.light.above, self.light.below][behind];
        Seen { all: by.iter().sum(), by, through: transmittance, error: 0.0 }
    }

    /// Returns the light that `count` photons find along a ray from `eye` (east, north, up), m. `seed` sets their
    /// random numbers.
    pub fn photons(&self, eye: DVec3, direction: DVec3, count: u32, seed: u64) -> Seen {
        let (mut chance, field) = (RandomStream::new(seed, 1), self.field());
        let s = &self.shape;
        // Start at the layer's nearer face.
        let face = if direction.z > 0.0 { s.base_m } else { s.base_m + s.thickness_m };
        let inside = (s.base_m..s.base_m + s.thickness_m).contains(&eye.z);
        let eye = if inside { eye } else { eye + direction * ((face - eye.z) / direction.z).max(0.0) };
        let photon = Photon { layer: self, field: &field, lobes: &self.sources.scattering.lobes };
        let (mut by, mut squares, mut through) = ([0.0; 3], 0.0, 0.0);
        for _ in 0..count {
            let (one, met) = photon.follow(eye, direction, &mut chance);
            let all: f64 = one.iter().sum();
            (0..3).for_each(|i| by[i] += one[i] / f64::from(count));
            squares += all * all / f64::from(count);
            through += if met { 0.0 } else { 1.0 / f64::from(count) };
        }
        let all: f64 = by.iter().sum();
        let error = ((squares - all * all).max(0.0) / f64::from(count)).sqrt();
        Seen { all, by, through, error }
    }
}

/// A photon that is traced back from the eye.
struct Photon<'a> {
    /// Layer in which the photon moves.
    layer: &'a LitLayer,
    /// Field of the layer's clouds.
    field: &'a Field<'a>,
    /// Phase function of the droplets or crystals.
    lobes: &'a PhaseLobes,
}

impl Photon<'_> {
    /// Returns the extinction at a place, 1/m, and a distance along a direction within which there is no cloud, m.
    fn look(&self, position: DVec3, direction: DVec3) -> [f64; 2] {
        let s = &self.field.shape;
        let height = (position.z - s.base_m) / s.thickness_m;
        let over = self.field.over(position);
        let excess = over - dome(s, over, height);
        let frays = if excess < -MOST_FRAYED * s.rough { f64::INFINITY } else { self.field.frays(position) };
        let dense = if frays.is_finite() { self.field.dense(excess + frays) } else { 0.0 };
        let clear =
            if dense > 0.0 { 0.0 } else { SKIPPED * skip((s, UNMAPPED), [over, frays], height, direction).max(0.0) };
        [dense, clear]
    }

    /// Returns where a photon is scattered next; `None` if it leaves the layer.
    fn meets(&self, position: DVec3, direction: DVec3, chance: &mut RandomStream) -> Option<DVec3> {
        let s = &self.field.shape;
        let face = if direction.z > 0.0 { s.base_m + s.thickness_m } else { s.base_m };
        let end = (face - position.z) / direction.z;
        let mut gone = 0.0;
        loop {
            gone -= chance.even().ln() / s.extinction_per_m;
            if gone >= end {
                return None;
            }
            let here = position + direction * gone;
            let [dense, clear] = self.look(here, direction);
            if chance.even() * s.extinction_per_m < dense {
                return Some(here);
            }
            gone += clear;
        }
    }

    /// Returns the radiance of one photon by source (sun, above, below), and whether it was scattered.
    fn follow(&self, mut position: DVec3, mut direction: DVec3, chance: &mut RandomStream) -> ([f64; 3], bool) {
        let light = &self.layer.light;
        let (mut by, mut met, mut turns) = ([0.0; 3], false, 0);
        loop {
            let Some(place) = self.meets(position, direction, chance) else {
                let (to, radiance) = if direction.z > 0.0 { (1, light.above) } else { (2, light.below) };
                by[to] += radiance;
                return (by, met);
            };
            (position, met) = (place, true);
            // The photon is traced back from the eye, so the light goes the opposite way; the scattering angle is the
            // same.
            let versine = 1.0 - direction.dot(light.to_sun);
            let g_hg = self.lobes.g_hg.min(1.0 - WIDER * f64::from(turns));
            let phase = lobes_phase(&PhaseLobes { g_hg, ..*self.lobes }, 1.0, versine);
            let share = (phase * 4.0 * std::f64::consts::PI / ASKED_FROM).clamp(ASKED_LEAST, 1.0);
            if chance.even() < share && self.meets(position, light.to_sun, chance).is_none() {
                by[0] += light.sun * phase / share;
            }
            let (way, is_wide) = turned(self.lobes, direction, chance);
            direction = way;
            turns = (turns + u32::from(is_wide)).min(WIDER_TURNS);
        }
    }
}

/// Case of the comparison with photons: a layer, the sun, and the eye that looks at the layer.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// Name of the case.
    pub name: &'static str,
    /// Kind of the cloud.
    pub kind: CloudKind,
    /// Cover, 0 to 1.
    pub cover: f64,
    /// Altitude of the base, m.
    pub base_m: f64,
    /// Height of the eye above the sea, m.
    pub height_m: f64,
    /// The sun's elevation, degrees.
    pub sun_deg: f64,
    /// Lowest and highest pitch of rays, degrees.
    pub pitch_deg: [f64; 2],
}

/// Cumulus from below and from above, and stratocumulus from above, each with a high and a low sun; and cirrus from
/// below.
pub const CASES: [Case; 7] = {
    const fn case(name: &'static str, kind: CloudKind, numbers: [f64; 4], pitch_deg: [f64; 2]) -> Case {
        let [cover, base_m, height_m, sun_deg] = numbers;
        Case { name, kind, cover, base_m, height_m, sun_deg, pitch_deg }
    }
    [
        case("cumulus", CloudKind::Cumulus, [0.4, 1000.0, 2.0, 55.0], [10.0, 60.0]),
        case("cumulus, low sun", CloudKind::Cumulus, [0.4, 1000.0, 2.0, 10.0], [10.0, 60.0]),
        case("cumulus from above", CloudKind::Cumulus, [0.4, 1000.0, 4000.0, 50.0], [-70.0, -20.0]),
        case("cumulus from above, low sun", CloudKind::Cumulus, [0.4, 1000.0, 4000.0, 10.0], [-70.0, -20.0]),
        case("stratocumulus from above", CloudKind::Stratocumulus, [0.9, 900.0, 3000.0, 40.0], [-60.0, -10.0]),
        case("stratocumulus from above, low sun", CloudKind::Stratocumulus, [0.9, 900.0, 3000.0, 10.0], [-60.0, -10.0]),
        case("cirrus", CloudKind::Cirrus, [0.5, 9000.0, 2.0, 35.0], [15.0, 70.0]),
    ]
};

/// Ratio of the sky's radiance to the sun's irradiance, 1/sr.
const SKY: f64 = 0.045;
/// Albedo of the ground.
const GROUND: f64 = 0.2;
/// Seed of the field.
const SEED: u64 = 3;
/// Angle from the sun within which rays are left out, rad.
const NEAR_SUN: f64 = 0.3;
/// Transmittance above which rays are left out.
const MOST_THROUGH: f64 = 0.7;

/// Errors of the model against photons, over rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compared {
    /// Median of the relative error over rays.
    pub p50: f64,
    /// 95th percentile of the relative error over rays.
    pub p95: f64,
    /// Relative error of the mean radiance.
    pub bias: f64,
    /// Error of the mean radiance from each source (sun, above, below), relative to the whole mean radiance.
    pub parts: [f64; 3],
    /// Standard error of the photons relative to their radiance: for the median ray, and for the mean over rays.
    pub chance: [f64; 2],
    /// 95th percentile of the relative difference from the model with 64 times as many steps: with the model's own
    /// steps, with its own steps by depth only, and with its own steps by angle only.
    pub steps: [f64; 3],
}

/// Returns the quantile of the values at a share from 0 to 1.
fn quantile(mut values: Vec<f64>, share: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    values[((values.len() - 1) as f64 * share).round() as usize]
}

impl Case {
    /// Creates the layer in its light.
    ///
    /// # Errors
    /// Errors of [`LitLayer::new`].
    pub fn layer(&self) -> Result<LitLayer> {
        let (sine, cosine) = self.sun_deg.to_radians().sin_cos();
        let to_sun = DVec3::new(0.5 * cosine, -0.75f64.sqrt() * cosine, sine);
        let slab = CloudSlab { base_m: self.base_m, ..typical(self.kind, self.cover)? };
        LitLayer::new(&slab, SEED, GivenLight::over_ground(to_sun, SKY, GROUND))
    }

    /// Returns up to `count` rays that meet cloud and are neither nearly level nor near the sun: their origins and
    /// directions.
    pub fn rays(&self, layer: &LitLayer, count: usize) -> Vec<(DVec3, DVec3)> {
        let ray = |i: usize| {
            let [low, high] = self.pitch_deg;
            let pitch = (low + (high - low) * (0.618_034 * i as f64).fract()).to_radians();
            let (sine, cosine) = (2.399_963 * i as f64).sin_cos();
            let from = DVec3::new(700.0 * (i % 17) as f64, 900.0 * (i % 13) as f64, self.height_m);
            (from, DVec3::new(sine * pitch.cos(), cosine * pitch.cos(), pitch.sin()))
        };
        let counts = |(from, d): &(DVec3, DVec3)| {
            let is_clear = d.z.abs() > 0.05 && d.angle_between(layer.light.to_sun) > NEAR_SUN;
            is_clear && layer.model(*from, *d, [1.0; 2]).through < MOST_THROUGH
        };
        (0..100 * count).map(ray).filter(counts).take(count).collect()
    }

    /// Compares the model with photons along `rays` rays, with `photons` photons for each.
    ///
    /// # Errors
    /// Errors of [`LitLayer::new`].
    pub fn compare(&self, rays: usize, photons: u32) -> Result<Compared> {
        let layer = self.layer()?;
        let rays = self.rays(&layer, rays);
        let count = rays.len() as f64;
        let see = |longer| rays.iter().map(|(from, d)| layer.model(*from, *d, longer)).collect::<Vec<_>>();
        let follow = |(i, (from, d)): (usize, &(DVec3, DVec3))| layer.photons(*from, *d, photons, i as u64);
        let truth: Vec<Seen> = rays.iter().enumerate().map(follow).collect();
        let (model, finest) = (see([1.0; 2]), see([1.0 / 64.0; 2]));
        let off = |a: &[Seen], b: &[Seen]| a.iter().zip(b).map(|(a, b)| (a.all / b.all - 1.0).abs()).collect();
        let mean = |of: &[Seen], part: &dyn Fn(&Seen) -> f64| of.iter().map(part).sum::<f64>() / count;
        let all = mean(&truth, &|s| s.all);
        let of_mean = truth.iter().map(|s| s.error * s.error).sum::<f64>().sqrt() / count / all;
        let steps = [[1.0; 2], [1.0, 1.0 / 64.0], [1.0 / 64.0, 1.0]];
        Ok(Compared {
            p50: quantile(off(&model, &truth), 0.5),
            p95: quantile(off(&model, &truth), 0.95),
            bias: mean(&model, &|s| s.all) / all - 1.0,
            parts: [0, 1, 2].map(|k| (mean(&model, &|s| s.by[k]) - mean(&truth, &|s| s.by[k])) / all),
            chance: [quantile(truth.iter().map(|s| s.error / s.all).collect(), 0.5), of_mean],
            steps: steps.map(|longer| quantile(off(&see(longer), &finest), 0.95)),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clouds::{field::NO_ANVIL, reference};

    /// Reflectance and transmittance of an even layer of droplets, by photons from the eye and by photons from the sun.
    #[test]
    fn photons_from_the_eye_find_what_photons_from_the_sun_do() {
        let (depth, cosine) = (8.0, 0.6);
        let slab = typical(CloudKind::Stratus, 0.5).unwrap();
        let light = GivenLight { to_sun: DVec3::new(-0.8, 0.0, cosine), sun: 1.0, above: 0.0, below: 0.0 };
        let mut layer = LitLayer::new(&slab, 3, light).unwrap();
        let extinction_per_m = depth / layer.shape.thickness_m;
        layer.shape =
            Shape { threshold: -9.0, dome: 0.0, rough: 0.0, anvil: NO_ANVIL, extinction_per_m, ..layer.shape };
        let lobes = layer.sources.scattering.lobes;
        let sides = DVec3::new(f64::INFINITY, f64::INFINITY, depth);
        let sun = reference::Box { sides, extinction: &|_| 1.0, most: 1.0, lobes, albedo: 1.0 };
        let want = sun.fluxes(cosine, 100_000, 5);
        for (face, up) in [(5, -1.0), (4, 1.0)] {
            // Directions are distributed as the cosine, so the mean radiance times pi is the flux.
            let (mut chance, mut flux, rays) = (RandomStream::new(9, 2), 0.0, 4000);
            for i in 0..rays {
                let (u, azimuth) = (chance.even().max(1e-4), std::f64::consts::TAU * chance.even());
                let level = (1.0 - u).sqrt();
                let d = DVec3::new(level * azimuth.cos(), level * azimuth.sin(), up * u.sqrt());
                let from = DVec3::Z * (layer.shape.base_m - up * 1e4);
                flux += std::f64::consts::PI * layer.photons(from, d, 20, i).by[0] / (cosine * f64::from(rays as u32));
            }
            // Light that comes straight through is not part of the radiance.
            let want = want[face] - if up > 0.0 { (-depth / cosine).exp() } else { 0.0 };
            println!("face {face}: {flux:.4} from the eye, {want:.4} from the sun");
            assert!((flux / want - 1.0).abs() < 0.03, "{flux} not {want}");
        }
    }

    /// Traces a hundred rays for each case with `WELKIN_ACCEPT`, otherwise twenty.
    #[test]
    fn drawn_light_is_near_that_of_photons() {
        let long = std::env::var_os("WELKIN_ACCEPT").is_some();
        let (rays, photons) = if long { (100, 4000) } else { (20, 1000) };
        for (case, [p50, p95, bias]) in CASES.iter().zip(HELD) {
            let c = case.compare(rays, photons).unwrap();
            println!("{}: {c:.3?}", case.name);
            // Tolerance for the photons' noise.
            let [one, of_mean] = c.chance;
            assert!(c.bias.abs() < bias + 3.0 * of_mean, "{}: {c:?}", case.name);
            assert!(c.p50 < p50 + one && (!long || c.p95 < p95 + one), "{}: {c:?}", case.name);
        }
    }

    /// Largest errors allowed for [`CASES`]: median, 95th percentile, and error of the mean radiance.
    const HELD: [[f64; 3]; 7] = [
        [0.14, 0.45, 0.08],
        [0.20, 0.68, 0.33],
        [0.25, 0.75, 0.10],
        [0.30, 0.60, 0.32],
        [0.14, 0.42, 0.08],
        [0.24, 0.62, 0.12],
        [0.06, 0.13, 0.03],
    ];
}
