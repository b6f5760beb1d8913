//! Light that is scattered more than once in a layer of cloud, as a function of the depths above and below a place:
//! adding and doubling (van de Hulst 1980) with four directions in each hemisphere.
//!
//! # Model
//! The forward peak of the phase function counts as not scattered (delta scaling, Wiscombe 1977). The phase function is
//! cut off at a cap, chosen so that the share g^6 of the scattering is cut, for asymmetry g. The rest is smooth enough
//! for eight directions and four Legendre moments. Depths are scaled by 1 - albedo x share.
//!
//! A place has the scaled depths `above` and `below` it. The cloud above and the cloud below it are slabs from a ladder
//! of depths, each the square root of 2 times the one before. The radiance between the two slabs follows from their
//! reflection and transmission. Its first four Legendre moments m_l give what the place scatters: J = albedo x sum of
//! (2 l + 1) chi_l m_l P_l / (4 pi). chi_l are the moments of the phase function, and P_l the Legendre polynomials.
//!
//! A cloud of finite width loses light through its sides. In the diffusion approximation the light in a box varies as a
//! cosine from side to side. It leaks as if it were absorbed at the rate D b^2 for each of the two level axes, with b =
//! pi / (width + 2 x 0.71 / (1 - g')) and D = 1 / (3 (1 - g')) (Duderstadt and Hamilton 1976, chapter 5):
//! [`leak_rate`]. g' is the asymmetry of the scaled phase function. There is one ladder for each of [`LEAKS`] rates.
//!
//! # Error
//! `cargo test --lib clouds::drawn::probe -- --nocapture` prints reflectance and transmittance of drawn slabs against
//! discrete ordinates.

use std::{
    f64::consts::PI,
    sync::{Arc, OnceLock},
};

use glam::{DMat4, DVec4};

use crate::light::phase::{PhaseLobes, lobes_phase};

/// Gauss nodes over (0, 1): the cosines of the directions of a hemisphere.
const NODES: DVec4 =
    DVec4::new(0.069_431_844_202_973_71, 0.330_009_478_207_571_9, 0.669_990_521_792_428_1, 0.930_568_155_797_026_3);
/// Weights of the [`NODES`].
const WEIGHTS: DVec4 =
    DVec4::new(0.173_927_422_568_726_93, 0.326_072_577_431_273_07, 0.326_072_577_431_273_07, 0.173_927_422_568_726_93);

/// The share of scattering that counts as straight on is the asymmetry to this power.
const FORWARD_POWER: i32 = 6;
/// Number of azimuths in half a turn over which the phase function is averaged.
const AZIMUTHS: usize = 64;

/// Scaled depth of the thinnest slab of a ladder. Each slab after it is the square root of 2 times as deep.
pub const THINNEST: f64 = 0.05;
/// Number of slabs in a ladder, with the one of depth 0.
pub const DEPTHS: usize = 28;
/// Number of ladders. Each has one rate at which light leaks through the sides, per scaled depth. The root of the rate
/// sets how fast light falls off; the root of the rate of ladder k is 0.03 (e^(k/4) - 1).
pub const LEAKS: usize = 16;
/// Factor in the roots of the leak rates.
const LEAK_ROOT: f64 = 0.03;

/// Returns the leak rate of ladder `k`.
fn leak_of(k: usize) -> f64 {
    (LEAK_ROOT * (0.25 * k as f64).exp_m1()).powi(2)
}

/// Returns values of 1 - cos of the scattering angle and their weights, to integrate a phase function. They are dense
/// where 1 - cos is small.
fn angles() -> impl Iterator<Item = (f64, f64)> {
    let (n, least) = (4000, 1e-9f64.ln());
    let step = (2f64.ln() - least) / f64::from(n);
    (0..n).map(move |i| {
        let versine = (least + step * (f64::from(i) + 0.5)).exp();
        (versine, 2.0 * PI * versine * step)
    })
}

/// Returns the Legendre polynomial of degree `l` at `x`.
fn legendre(l: usize, x: f64) -> f64 {
    [1.0, x, 1.5 * x * x - 0.5, (2.5 * x * x - 1.5) * x][l]
}

/// Scattering by the droplets or crystals of a cloud, divided into a forward peak and the smooth rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scattering {
    /// Whole phase function.
    pub lobes: PhaseLobes,
    /// Single-scattering albedo, with the peak.
    pub albedo: f64,
    /// Share of scattering in the peak.
    pub forward: f64,
    /// Value at which the phase function is cut off, 1/sr.
    pub cap: f64,
    /// First four Legendre moments of the phase function without the peak.
    pub moments: [f64; 4],
}

impl Scattering {
    /// Creates the scattering of a phase function with this single-scattering albedo.
    pub fn new(lobes: PhaseLobes, albedo: f64) -> Self {
        let asymmetry = lobes.moments()[0].clamp(0.0, 0.999);
        let forward = asymmetry.powi(FORWARD_POWER);
        let values: Vec<[f64; 3]> =
            angles().map(|(versine, weight)| [versine, weight, lobes_phase(&lobes, 1.0, versine)]).collect();
        let whole: f64 = values.iter().map(|[_, w, p]| w * p).sum();
        let kept = |cap: f64| values.iter().map(|[_, w, p]| w * p.min(cap)).sum::<f64>() / whole;
        let (mut low, mut high) = (1e-6, values.iter().fold(0.0, |most: f64, v| most.max(v[2])));
        for _ in 0..60 {
            let middle = (low * high).sqrt();
            if kept(middle) > 1.0 - forward { high = middle } else { low = middle }
        }
        let moment = |l| {
            values.iter().map(|[v, w, p]| w * p.min(high) * legendre(l, 1.0 - v)).sum::<f64>() / (whole * kept(high))
        };
        Self { lobes, albedo, forward, cap: high, moments: [0, 1, 2, 3].map(moment) }
    }

    /// Returns the ratio of scaled depth to depth.
    pub fn scale(&self) -> f64 {
        1.0 - self.albedo * self.forward
    }

    /// Returns the single-scattering albedo without the peak.
    pub fn scaled_albedo(&self) -> f64 {
        self.albedo * (1.0 - self.forward) / self.scale()
    }

    /// Returns the phase function without its peak, 1/sr, at the angle whose 1 - cos is `versine`.
    pub fn smooth_phase(&self, versine: f64) -> f64 {
        lobes_phase(&self.lobes, 1.0, versine).min(self.cap) / (1.0 - self.forward)
    }

    /// Returns the peak that was cut off, 1/sr, after light has gone the scaled depth `gone` in all. Of the beam that
    /// counts as going straight on, the share 1 - exp(-f gone / (1 - f)) was scattered in the peak, with f =
    /// [`Scattering::forward`]. The answer spreads this share evenly along the path.
    pub fn peak(&self, versine: f64, gone: f64) -> f64 {
        let x = self.forward * gone / (1.0 - self.forward);
        let share = if x < 1e-3 { 1.0 - 0.5 * x } else { (1.0 - (-x).exp()) / x };
        (lobes_phase(&self.lobes, 1.0, versine) - self.cap).max(0.0) / (1.0 - self.forward) * share
    }

    /// Returns the share of momentum that light loses at each scattering: 1 - g'.
    pub fn turning(&self) -> f64 {
        1.0 - self.moments[1]
    }

    /// Returns the mean of the smooth phase function over azimuth, between directions of these cosines.
    fn mean_phase(&self, cosine_in: f64, cosine_out: f64) -> f64 {
        let sines = ((1.0 - cosine_in * cosine_in) * (1.0 - cosine_out * cosine_out)).max(0.0).sqrt();
        let at = |k: usize| {
            let azimuth = PI * (k as f64 + 0.5) / AZIMUTHS as f64;
            self.smooth_phase((1.0 - cosine_in * cosine_out - sines * azimuth.cos()).max(0.0))
        };
        (0..AZIMUTHS).map(at).sum::<f64>() / AZIMUTHS as f64
    }

    /// Returns the light that a beam of unit irradiance and this cosine scatters into the directions down and up, per
    /// unit of scaled depth. The sum over all directions is the scaled albedo.
    fn sent_by_beam(&self, cosine: f64) -> (DVec4, DVec4) {
        let at = |sign: f64| DVec4::from_array(NODES.to_array().map(|mu| self.mean_phase(cosine, sign * mu)));
        let (down, up) = (at(1.0), at(-1.0));
        let whole = 2.0 * PI * WEIGHTS.dot(down + up) / self.scaled_albedo();
        (down / whole, up / whole)
    }
}

/// Returns the rate at which light leaks through the sides of a box of these scaled widths, per scaled depth, divided
/// by the rate of scattering: sum over both widths w of (pi / (w + 1.42 / turning))^2, divided by 3 turning. `turning`
/// is [`Scattering::turning`].
pub fn leak_rate(widths: [f64; 2], turning: f64) -> f64 {
    let one = |width: f64| (PI / (width + 1.42 / turning)).powi(2);
    (one(widths[0]) + one(widths[1])) / (3.0 * turning)
}

/// Reflection and transmission of a slab: matrices from the radiance in the directions of [`NODES`] to the radiance
/// that leaves it.
#[derive(Clone, Copy)]
struct ScatterSlab {
    /// Scaled depth.
    depth: f64,
    /// Reflection, from above as from below.
    reflects: DMat4,
    /// Transmission, including light that is not scattered.
    passes: DMat4,
}

/// Light that leaves a slab under a beam: scattered down, scattered up, and the share left of the beam.
#[derive(Clone, Copy)]
struct UnderBeam {
    /// Scattered radiance below the slab, in the directions of [`NODES`].
    down: DVec4,
    /// Scattered radiance above the slab, in the directions of [`NODES`].
    up: DVec4,
    /// Share left of the beam.
    left: f64,
}

/// Returns 1 / (1 - a b), the sum over all reflections to and fro between two slabs.
fn back_and_forth(a: DMat4, b: DMat4) -> DMat4 {
    (DMat4::IDENTITY - a * b).inverse()
}

impl ScatterSlab {
    /// No cloud: all light passes.
    const NONE: Self = Self { depth: 0.0, reflects: DMat4::ZERO, passes: DMat4::IDENTITY };

    /// Creates a slab so thin that nothing is scattered twice.
    fn thin(turned: &ScatterMatrices, albedo: f64, depth: f64) -> Self {
        let straight = DMat4::from_diagonal(DVec4::ONE - depth / NODES);
        let scattered = albedo * depth;
        Self { depth, reflects: turned.up * scattered, passes: straight + turned.down * scattered }
    }

    /// Returns the slab that two such slabs make, one on the other.
    fn doubled(&self) -> Self {
        let (r, t) = (self.reflects, self.passes);
        let between = back_and_forth(r, r);
        Self { depth: 2.0 * self.depth, reflects: r + t * between * r * t, passes: t * between * t }
    }

    /// Returns the light that leaves two such slabs under a beam, from the light that leaves one. `bounces` is
    /// [`back_and_forth`] between the two.
    fn doubled_beam(&self, bounces: &DMat4, lit: &UnderBeam) -> UnderBeam {
        let (r, t) = (self.reflects, self.passes);
        let below = lit.up * lit.left;
        let down = *bounces * (lit.down + r * below);
        let up = r * down + below;
        UnderBeam { down: lit.down * lit.left + t * down, up: lit.up + t * up, left: lit.left * lit.left }
    }
}

/// Matrices of single scattering in a layer of scaled depth 1, without attenuation: the shares of the light scattered
/// from each direction that go into each direction, down and up.
struct ScatterMatrices {
    /// Scattering from a downward direction into the downward directions.
    down: DMat4,
    /// Scattering from a downward direction into the upward directions.
    up: DMat4,
}

impl ScatterMatrices {
    fn new(scattering: &Scattering) -> Self {
        let between = |sign: f64| {
            let column =
                |j: usize| DVec4::from_array([0, 1, 2, 3].map(|i| scattering.mean_phase(NODES[i], sign * NODES[j])));
            DMat4::from_cols(column(0), column(1), column(2), column(3))
        };
        let (mut down, mut up) = (between(1.0), between(-1.0));
        for j in 0..4 {
            let share = WEIGHTS[j] / WEIGHTS.dot(down.col(j) + up.col(j));
            *down.col_mut(j) *= share / NODES;
            *up.col_mut(j) *= share / NODES;
        }
        Self { down, up }
    }
}

/// Slabs of one medium with one leak rate, at the depths of a ladder.
struct SlabLadder {
    /// Two chains of slabs, each slab twice as deep as the one before it: from a slab so thin that nothing is scattered
    /// twice up to the deepest slab of the ladder. Each slab has its [`back_and_forth`] with a slab like it.
    doublings: [Vec<(ScatterSlab, DMat4)>; 2],
    /// Slabs of the ladder, the one of depth 0 first.
    slabs: Vec<ScatterSlab>,
    /// [`back_and_forth`] between the slabs above and below, by their depths.
    between: Vec<DMat4>,
    /// Leak rate.
    leak: f64,
}

/// Number of doublings from a slab so thin that nothing is scattered twice to the ladder's thinnest slab.
const DOUBLINGS: i32 = 10;

impl SlabLadder {
    fn new(scattering: &Scattering, turned: &ScatterMatrices, leak: f64) -> Self {
        let albedo = scattering.scaled_albedo() / (1.0 + leak);
        let doublings = [1.0, 2f64.sqrt()].map(|step| {
            let mut slab = ScatterSlab::thin(turned, albedo, THINNEST * step / 2f64.powi(DOUBLINGS));
            let all = (0..DOUBLINGS as usize + DEPTHS.div_ceil(2)).map(|_| {
                let this = slab;
                slab = slab.doubled();
                (this, back_and_forth(this.reflects, this.reflects))
            });
            all.collect::<Vec<_>>()
        });
        let slabs: Vec<ScatterSlab> =
            in_turn(ScatterSlab::NONE, doublings.each_ref().map(|chain| chain.iter().map(|(slab, _)| *slab)));
        let pairs = (0..DEPTHS * DEPTHS).map(|i| (&slabs[i % DEPTHS], &slabs[i / DEPTHS]));
        let between = pairs.map(|(above, below)| back_and_forth(above.reflects, below.reflects)).collect();
        Self { doublings, slabs, between, leak }
    }

    /// Returns for each slab of the ladder the light that leaves it under a beam from above at this cosine. `down` and
    /// `up` are the light of [`Scattering::sent_by_beam`].
    fn under_beam(&self, (down, up): (DVec4, DVec4), cosine: f64) -> Vec<UnderBeam> {
        // The light that the beam scatters leaks through the sides at the same rate.
        let kept = 1.0 / (1.0 + self.leak);
        let chains = self.doublings.each_ref().map(|chain| {
            let depth = chain[0].0.depth;
            let mut lit = UnderBeam {
                down: down * kept * depth / NODES,
                up: up * kept * depth / NODES,
                left: (-depth / cosine).exp(),
            };
            chain.iter().map(move |(slab, between)| {
                let two = slab.doubled_beam(between, &lit);
                std::mem::replace(&mut lit, two)
            })
        });
        in_turn(UnderBeam { down: DVec4::ZERO, up: DVec4::ZERO, left: 1.0 }, chains)
    }
}

/// Returns the value at depth 0 and then the values at the other depths of a ladder, taken in turn from its two chains.
/// The first [`DOUBLINGS`] values of each chain belong to thinner slabs and are left out.
fn in_turn<T>(none: T, mut chains: [impl Iterator<Item = T>; 2]) -> Vec<T> {
    chains.iter_mut().for_each(|chain| (0..DOUBLINGS).for_each(|_| drop(chain.next())));
    let [even, odd] = chains;
    let pairs = even.zip(odd).flat_map(|(a, b)| [a, b]);
    std::iter::once(none).chain(pairs).take(DEPTHS).collect()
}

/// Source terms, the light that a place scatters per unit of scaled depth, by depth above (columns), depth below (rows)
/// and leak rate (blocks of rows). Each entry has the coefficients of Legendre polynomials of the cosine between a
/// direction and straight down, 1/sr.
pub type Table = Vec<[f32; 4]>;

/// Transport of light in a medium: all that does not depend on the light itself.
pub struct Transport {
    /// Scattering of the medium.
    pub scattering: Scattering,
    /// Ladders of slabs, one for each leak rate.
    ladders: Vec<SlabLadder>,
    /// Factor that conserves energy ([`Transport::conserving`]).
    conserved: f64,
    /// Table of [`Transport::under_sky`], created at first use.
    sky: OnceLock<Arc<Table>>,
}

impl Transport {
    /// Creates the transport of a medium. It takes some milliseconds.
    pub fn new(scattering: Scattering) -> Self {
        let turned = ScatterMatrices::new(&scattering);
        let ladders = (0..LEAKS).map(|k| SlabLadder::new(&scattering, &turned, leak_of(k))).collect();
        let mut made = Self { scattering, ladders, conserved: 1.0, sky: OnceLock::new() };
        made.conserved = made.conserving();
        made
    }

    /// Returns the factor that conserves energy: with it, as much light leaves a uniform slab that absorbs nothing as
    /// falls on it. Rays through the slab find the light that leaves. Without the factor a sum over eight directions
    /// differs by a hundredth from one over all directions.
    fn conserving(&self) -> f64 {
        let of = Scattering { albedo: 1.0, ..self.scattering };
        let ladders = vec![SlabLadder::new(&of, &ScatterMatrices::new(&of), 0.0)];
        let whole = Self { scattering: of, ladders, conserved: 1.0, sky: OnceLock::new() };
        let (depth, cosine) = (6.0, 0.6);
        let table = whole.under_beam(cosine);
        let (mut once, mut often) = (0.0, 0.0);
        let (rays, steps) = (12, 40);
        for ray in 0..rays {
            let mu = (f64::from(ray) + 0.5) / f64::from(rays);
            for side in [1.0, -1.0] {
                let phase = of.mean_phase(cosine, side * mu);
                for step in 0..steps {
                    let seen = -(-depth / mu).exp_m1();
                    let gone = -mu * (-(f64::from(step) + 0.5) / f64::from(steps) * seen).ln_1p();
                    let above = if side > 0.0 { depth - gone } else { gone };
                    let terms = first_leak_at(&table, above, depth - above);
                    let share = seen * mu * 2.0 * PI / f64::from(rays * steps);
                    once += share * phase * (-above / cosine).exp();
                    often += share * (0..4).map(|l| terms[l] * legendre(l, side * mu)).sum::<f64>();
                }
            }
        }
        let falls = -cosine * (-depth / cosine).exp_m1();
        ((falls - once) / often).clamp(0.9, 1.1)
    }

    /// Returns the moments of the light between a slab above and one below, times the scattering of a place.
    fn source(&self, downward: DVec4, upward: DVec4) -> [f32; 4] {
        let of = &self.scattering;
        [0usize, 1, 2, 3].map(|l| {
            let nodes = NODES.to_array();
            let sum: f64 = (0..4)
                .map(|i| WEIGHTS[i] * (downward[i] * legendre(l, nodes[i]) + upward[i] * legendre(l, -nodes[i])))
                .sum();
            let scattered = of.scaled_albedo() * (2 * l + 1) as f64 * of.moments[l] / (4.0 * PI);
            (2.0 * PI * sum * scattered * self.conserved) as f32
        })
    }

    /// Returns the table under a beam from above at this cosine, with unit irradiance on a surface that faces it. It
    /// does not contain light that is scattered once.
    pub fn under_beam(&self, cosine: f64) -> Table {
        let cosine = cosine.clamp(0.01, 1.0);
        let of = &self.scattering;
        let sent = of.sent_by_beam(cosine);
        let mut out = Vec::with_capacity(LEAKS * DEPTHS * DEPTHS);
        for ladder in &self.ladders {
            let lit = ladder.under_beam(sent, cosine);
            for i in 0..DEPTHS * DEPTHS {
                let (above, below) = (i % DEPTHS, i / DEPTHS);
                let from_below = lit[below].up * lit[above].left;
                let down = ladder.between[i] * (lit[above].down + ladder.slabs[above].reflects * from_below);
                let up = ladder.slabs[below].reflects * down + from_below;
                out.push(self.source(down, up));
            }
        }
        out
    }

    /// Returns the table under a sky of radiance 1 over the whole upper side, with all scattered light. The table is
    /// computed once, since it does not depend on the sun.
    pub fn under_sky(&self) -> Arc<Table> {
        let one = |ladder: &SlabLadder, i: usize| {
            let (above, below) = (i % DEPTHS, i / DEPTHS);
            let down = ladder.between[i] * (ladder.slabs[above].passes * DVec4::ONE);
            self.source(down, ladder.slabs[below].reflects * down)
        };
        let all = || self.ladders.iter().flat_map(|ladder| (0..DEPTHS * DEPTHS).map(move |i| one(ladder, i))).collect();
        self.sky.get_or_init(|| Arc::new(all())).clone()
    }
}

/// Returns the position of a scaled depth in a row of a table, from 0 to [`DEPTHS`] - 1.
pub fn depth_place(depth: f64) -> f64 {
    let x = if depth < THINNEST { depth / THINNEST } else { 1.0 + 2.0 * (depth / THINNEST).log2() };
    x.clamp(0.0, (DEPTHS - 1) as f64)
}

/// Returns the position of a leak rate among the [`LEAKS`], from 0 to their number less 1.
pub fn leak_place(leak: f64) -> f64 {
    (4.0 * (leak.sqrt() / LEAK_ROOT).ln_1p()).min((LEAKS - 1) as f64)
}

/// Splits a position among `count` nodes into the index of the node before it and the weight of the next.
fn cell(x: f64, count: usize) -> (usize, f64) {
    let i = (x as usize).min(count - 2);
    (i, x - i as f64)
}

/// Interpolates the source terms of the leak rate with which `table` begins. A whole table begins with no leak.
fn first_leak_at(table: &[[f32; 4]], depth_above: f64, depth_below: f64) -> [f64; 4] {
    let (i, x) = cell(depth_place(depth_above), DEPTHS);
    let (j, y) = cell(depth_place(depth_below), DEPTHS);
    let mut out = [0.0; 4];
    for (dj, wj) in [(0, 1.0 - y), (1, y)] {
        for (di, wi) in [(0, 1.0 - x), (1, x)] {
            let texel = table[(j + dj) * DEPTHS + i + di];
            for l in 0..4 {
                out[l] += wj * wi * f64::from(texel[l]);
            }
        }
    }
    out
}

/// Interpolates a table's source terms.
pub fn table_at(table: &Table, depth_above: f64, depth_below: f64, leak: f64) -> [f64; 4] {
    let (k, z) = cell(leak_place(leak), LEAKS);
    let [low, high] = [k, k + 1].map(|k| first_leak_at(&table[k * DEPTHS * DEPTHS..], depth_above, depth_below));
    [0, 1, 2, 3].map(|l| low[l] + (high[l] - low[l]) * z)
}
