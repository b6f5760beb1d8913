//! Waves of a hull along its track: the surface at a place.
//!
//! A hull raises waves at its bow and at its stern (Michell 1898, for parabolic waterlines and upright sides). A wave
//! that left the track u seconds ago has the phase -g u^2 / (4 D) at the distance D from where it left (Cauchy and
//! Poisson). A place has the waves of the times u at which this phase is stationary:
//!
//! S(u) = D^2 - u V . r / 2 = 0. V is the velocity that the hull's bow or stern had u seconds ago, and r, of length D,
//! the way from where the bow or stern then was to the place.
//!
//! On a straight track S is a parabola. Its two zeros are Kelvin's diverging and transverse waves. At the cusp the two
//! zeros coincide. On a turning track S is followed from node to node, so wakes bend as they do at sea: waves crowd
//! together on the inner side of the turn and spread out on the outer side. Near cusps the sum of both waves is Airy's
//! function (Ursell 1960). It is computed from its modulus and phase within some percent. Waves are those of deep
//! water.

use std::f64::consts::{FRAC_PI_4, PI};

use glam::{DVec2, DVec3};

use super::{
    dispersion::GRAVITY_M_S2,
    hull::SeaHull,
    track::{HullTrack, MOST_NODES, TrackNode, age_share},
};
use crate::numerics::smoothstep;

/// Froude numbers of the hull between which it begins to plane.
const PLANING: [f64; 2] = [0.5, 0.9];
/// Constant c of the modulus of Airy's functions, pi^-1/2 (x + c)^-1/4. With it the modulus is exact at x = 0.
const MODULUS: f64 = 0.3987;
/// Ai(0).
const AIRY_0: f64 = 0.355_028_053_887_817;
/// Difference at x = 0 between the phase of Airy's functions and that of their asymptotic expansion, rad, and the rate
/// at which the difference falls with x^(3/2).
const PHASE: [f64; 2] = [-PI / 12.0, 2.2];
/// Argument above which Ai, beyond a cusp, is taken as 0.
const LAST_AIRY: f64 = 6.0;
/// Range over which the waves beyond a cusp fade out: ratios of the place's distance from the source to that of the
/// cusp.
const BEYOND: [f64; 2] = [1.2, 1.6];
/// Least second derivative of S, as a ratio to that on a straight track, and the range of the ratio over which the
/// waves beyond cusps fade in.
const LEAST_BEND: f64 = 0.1;
const CUSP_BENDS: [f64; 2] = [0.05, 0.3];
/// Limit that the steepness a k of a hull's waves approaches: steeper waves would break.
const MOST_STEEPNESS: f64 = 0.3;
/// Distance from a line, m, and difference of velocities, m/s, up to which a track is taken as straight.
const STRAIGHT_M: f64 = 2e-3;
const STRAIGHT_M_S: f64 = 1e-4;
/// Way, in lengths of the hull, that is added to the way of the waves when their height is computed: the formulas hold
/// only far from the hull.
const BEGINNING: f64 = 0.1;
/// Speeds, m/s, between which a hull begins to raise waves.
const SPEEDS_M_S: [f64; 2] = [0.7, 1.5];
/// Steepnesses, not yet limited by [`MOST_STEEPNESS`], between which waves of a hull begin to break, and the share of
/// foam on the crests of the steepest waves.
const BREAKS: [f64; 2] = [0.35, 1.0];
const BROKEN_SHARE: f64 = 0.6;
/// Foam of the hull's wash: its share astern, the time in which it fades to 1/e, s, its half width in beams of the
/// hull, and the hull's speeds, m/s, between which it begins.
const WASH_SHARE: f64 = 0.75;
const WASH_DECAY_S: f64 = 10.0;
const WASH_WIDTH: f64 = 0.45;
const WASH_SPEEDS_M_S: [f64; 2] = [0.5, 5.0];

/// Wake of a hull at a time.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Wake {
    pub(super) hull: SeaHull,
    /// States from new to old.
    pub(super) states: Vec<WakeState>,
    nodes: Vec<TrackNode>,
    pub(super) time_s: f64,
    /// Middle and radius of a circle with all of the wake, m on the map.
    circle: Option<(DVec2, f64)>,
}

/// State of a hull with its rate of turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct WakeState {
    pub node: TrackNode,
    /// Rate of turn, rad/s anticlockwise.
    pub turn_rad_s: f64,
}

impl WakeState {
    /// Returns the velocity of the point of the hull `off_middle_m` ahead of its middle, m/s.
    fn velocity(&self, off_middle_m: f64) -> DVec2 {
        self.node.velocity() + self.node.ahead.perp() * (self.turn_rad_s * off_middle_m)
    }
}

/// Surface of wakes at a place, to be added to that of the sea.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct WakePoint {
    pub height_m: f64,
    pub slope: DVec2,
    pub velocity_m_s: DVec3,
    pub acceleration_m_s2: DVec3,
    /// Share under foam.
    pub foam: f64,
    /// Sum of the amplitudes of the waves that were left out, m.
    pub left_out_m: f64,
}

/// Bow or stern in a state.
#[derive(Clone, Copy)]
struct EndState {
    place_m: DVec2,
    velocity: DVec2,
    /// Acceleration that the rate of turn causes.
    turning: DVec2,
    age_s: f64,
}

impl EndState {
    fn new(state: &WakeState, time_s: f64, off_middle_m: f64) -> Self {
        let node = &state.node;
        let velocity = state.velocity(off_middle_m);
        Self {
            place_m: node.place_m + node.ahead * off_middle_m,
            velocity,
            turning: velocity.perp() * state.turn_rad_s,
            age_s: time_s - node.time_s,
        }
    }

    /// Returns S at a place and the derivative of S by age. The two passages that meet in this state have the same two
    /// values here.
    fn s(&self, place_m: DVec2) -> [f64; 2] {
        let to_place = place_m - self.place_m;
        let along = self.velocity.dot(to_place);
        let turned = self.turning.dot(to_place) - self.velocity.length_squared();
        [to_place.length_squared() - 0.5 * self.age_s * along, 1.5 * along + 0.5 * self.age_s * turned]
    }
}

/// Motion of the bow or stern between two states, as a cubic of the age.
struct Passage {
    start_s: f64,
    length_s: f64,
    cubic: [DVec2; 4],
}

/// Waves that a query asks for.
#[derive(Clone, Copy)]
struct AskedWaves {
    end: HullEnd,
    place_m: DVec2,
    shortest_m: f64,
}

/// Bow or stern at an age, seen from a place.
struct WakeSource {
    age_s: f64,
    to_place: DVec2,
    velocity: DVec2,
    /// S and its derivatives by age.
    s: [f64; 3],
}

/// End of a hull.
#[derive(Clone, Copy, PartialEq)]
enum HullEnd {
    Bow,
    Stern,
}

impl HullEnd {
    /// Returns 1 for the bow and -1 for the stern.
    fn sign(self) -> f64 {
        if self == Self::Bow { 1.0 } else { -1.0 }
    }
}

impl Passage {
    fn new(newer: &EndState, older: &EndState) -> Self {
        let length_s = older.age_s - newer.age_s;
        let way = older.place_m - newer.place_m;
        // With growing age the places run astern.
        let [v, w] = [newer, older].map(|end| -end.velocity * length_s);
        let cubic = [newer.place_m, v, way * 3.0 - v * 2.0 - w, v + w - way * 2.0];
        Self { start_s: newer.age_s, length_s, cubic }
    }

    /// Returns the source that is `past_s` seconds older than the newer state.
    fn at(&self, place_m: DVec2, past_s: f64) -> WakeSource {
        let h = self.length_s;
        let t = past_s / h;
        let [a, b, c, d] = self.cubic;
        let to_place = place_m - (a + (b + (c + d * t) * t) * t);
        let velocity = -(b + (c * 2.0 + d * (3.0 * t)) * t) / h;
        let change = (c * 2.0 + d * (6.0 * t)) / (h * h);
        let jerk = d * (-6.0 / (h * h * h));
        let u = self.start_s + past_s;
        let along = velocity.dot(to_place);
        let s = [
            to_place.length_squared() - 0.5 * u * along,
            1.5 * along - 0.5 * u * velocity.length_squared() + 0.5 * u * change.dot(to_place),
            velocity.length_squared() - change.dot(to_place) + 1.5 * u * change.dot(velocity)
                - 0.5 * u * jerk.dot(to_place),
        ];
        WakeSource { age_s: u, to_place, velocity, s }
    }
}

/// Type of a wave at a place.
#[derive(Clone, Copy, PartialEq)]
enum WakeWave {
    Diverging,
    Transverse,
    /// Waves of a cusp at a place beyond the cusp.
    BeyondCusp,
}

/// Ages, s after the beginning of half a passage, at which S is 0 or has its least value.
struct HalfPassage {
    zeros: [Option<f64>; 2],
    least: Option<f64>,
}

impl HalfPassage {
    /// Solves s + d t + q t^2 = 0 for t from 0 to `length`: the falling zero first.
    fn new([s, d, q]: [f64; 3], length: f64) -> Self {
        let inside = |t: f64| (0.0..length).contains(&t).then_some(t);
        let square = d * d - 4.0 * q * s;
        if square <= 0.0 {
            let least = if q > 0.0 { inside(-0.5 * d / q) } else { None };
            return Self { zeros: [None; 2], least };
        }
        let root = square.sqrt();
        // Each zero is computed in the form in which no digits cancel.
        let falling = if d < 0.0 { 2.0 * s / (root - d) } else { -(d + root) / (2.0 * q) };
        let rising = if d > 0.0 { -2.0 * s / (d + root) } else { (root - d) / (2.0 * q) };
        Self { zeros: [inside(falling), inside(rising)], least: None }
    }
}

impl Wake {
    /// Sets the wake to that of a track at a time.
    pub(super) fn fill(&mut self, track: &HullTrack, time_s: f64) {
        self.states.clear();
        self.states.reserve_exact(MOST_NODES);
        // The track's nodes and those of its leg are joined before the oldest are dropped.
        self.nodes.clear();
        self.nodes.reserve_exact(2 * MOST_NODES);
        (self.hull, self.time_s) = (track.hull, time_s);
        track.states(time_s, &mut self.nodes);
        merge_straight(&mut self.nodes);
        let nodes = &self.nodes;
        // The rate at a node is the mean over the ways to its neighbours.
        let turned = |i: usize, j: usize| {
            let (new, old) = (&nodes[i], &nodes[j]);
            let angle = libm::atan2(old.ahead.perp_dot(new.ahead), old.ahead.dot(new.ahead));
            angle / (new.time_s - old.time_s).max(1e-9)
        };
        let last = nodes.len().saturating_sub(1);
        self.states.extend(nodes.iter().enumerate().map(|(i, node)| {
            let turn_rad_s = match i {
                _ if last == 0 => 0.0,
                0 => turned(0, 1),
                _ if i == last => turned(last - 1, last),
                _ => 0.5 * (turned(i - 1, i) + turned(i, i + 1)),
            };
            WakeState { node: *node, turn_rad_s }
        }));
        self.circle = self.bounds();
    }

    /// Returns the middle and the radius of a circle with all of the wake, m on the map; `None` without one.
    pub(super) fn circle(&self) -> Option<(DVec2, f64)> {
        self.circle
    }

    fn bounds(&self) -> Option<(DVec2, f64)> {
        if self.states.len() < 2 {
            return None;
        }
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for WakeState { node: state, .. } in &self.states {
            // Energy spreads at most at half the hull's speed, and to the sides by at most 0.36 of the hull's way.
            let reach = 0.36 * state.speed_m_s * (self.time_s - state.time_s) + self.hull.length_m;
            low = low.min(state.place_m - reach);
            high = high.max(state.place_m + reach);
        }
        Some((0.5 * (low + high), 0.5 * (high - low).length()))
    }

    /// Whether the wake may reach a place.
    pub fn reaches(&self, place_m: DVec2) -> bool {
        self.circle().is_some_and(|(middle, radius)| (place_m - middle).length_squared() <= radius * radius)
    }

    /// Whether a place is in the rectangle around the hull.
    pub fn holds(&self, place_m: DVec2) -> bool {
        self.states.first().is_some_and(|WakeState { node: state, .. }| {
            let p = place_m - state.place_m;
            let beside = state.ahead.perp_dot(p).abs();
            p.dot(state.ahead).abs() <= 0.5 * self.hull.length_m && beside <= 0.5 * self.hull.beam_m
        })
    }

    /// Adds the wake at a place to `sum`, without waves shorter than `shortest_m`. Waves of up to twice this length are
    /// added in part.
    pub(super) fn add_at(&self, place_m: DVec2, shortest_m: f64, sum: &mut WakePoint) {
        for end in [HullEnd::Bow, HullEnd::Stern] {
            let asked = AskedWaves { end, place_m, shortest_m };
            let off_middle_m = 0.5 * end.sign() * self.hull.length_m;
            let mut ends = self.states.iter().map(|state| EndState::new(state, self.time_s, off_middle_m));
            let Some(mut newer) = ends.next() else { continue };
            let mut first = newer.s(place_m);
            for older in ends {
                let last = older.s(place_m);
                // If S is positive at both ends of a passage, S has a zero or a least value in between only if S falls
                // at the first end and rises at the last.
                if first[0] <= 0.0 || last[0] <= 0.0 || (first[1] < 0.0 && last[1] > 0.0) {
                    self.add_passage(&Passage::new(&newer, &older), [first, last], asked, sum);
                }
                (newer, first) = (older, last);
            }
        }
        sum.foam = (sum.foam + self.wash(place_m)).min(1.0);
    }

    /// Adds the waves of a passage, from S and its slope at both ends. Between the ends S is taken as two parabolas
    /// with a common tangent in the middle.
    fn add_passage(&self, passage: &Passage, [first, last]: [[f64; 2]; 2], asked: AskedWaves, sum: &mut WakePoint) {
        let h = passage.length_s;
        let middle_slope = 2.0 * (last[0] - first[0]) / h - 0.5 * (first[1] + last[1]);
        let middle = first[0] + 0.25 * h * (first[1] + middle_slope);
        let halves = [
            (0.0, [first[0], first[1], (middle_slope - first[1]) / h]),
            (0.5 * h, [middle, middle_slope, (last[1] - middle_slope) / h]),
        ];
        for (start_s, parabola) in halves {
            let found = HalfPassage::new(parabola, 0.5 * h);
            let [falling, rising] = found.zeros;
            for (wave, t) in
                [(WakeWave::Diverging, falling), (WakeWave::Transverse, rising), (WakeWave::BeyondCusp, found.least)]
            {
                if let Some(t) = t {
                    let source = passage.at(asked.place_m, start_s + t);
                    self.add_wave(&source, wave, asked, sum);
                }
            }
        }
    }

    /// Adds a wave to `sum`.
    fn add_wave(&self, source: &WakeSource, wave: WakeWave, asked: AskedWaves, sum: &mut WakePoint) {
        let AskedWaves { end, shortest_m, .. } = asked;
        let Some(shape) = self.shape(source, wave, end) else { return };
        let length_m = 2.0 * PI / shape.k;
        let share = if shortest_m > 0.0 { (length_m / shortest_m - 1.0).clamp(0.0, 1.0) } else { 1.0 };
        let (sin, cos) = libm::sincos(shape.phase);
        let amplitude = share * shape.amplitude_m;
        let direction = source.to_place / source.to_place.length().max(1e-6);
        let rad_s = (GRAVITY_M_S2 * shape.k).sqrt();
        sum.height_m += amplitude * cos;
        sum.slope -= direction * (amplitude * shape.k * sin);
        let speed = rad_s * amplitude;
        sum.velocity_m_s += (direction * (speed * cos)).extend(speed * sin);
        sum.acceleration_m_s2 += (direction * (speed * rad_s * sin)).extend(-speed * rad_s * cos);
        sum.foam += share * BROKEN_SHARE * smoothstep(BREAKS[0], BREAKS[1], shape.raw_steepness) * cos.max(0.0);
        sum.left_out_m += (1.0 - share) * shape.amplitude_m;
    }

    /// Returns the shape of a wave at the place from which `source` is seen; `None` if the wave has no height.
    fn shape(&self, source: &WakeSource, wave: WakeWave, end: HullEnd) -> Option<WaveShape> {
        let g = GRAVITY_M_S2;
        let (u, speed2) = (source.age_s, source.velocity.length_squared());
        let speed = speed2.sqrt();
        let distance = source.to_place.length().max(1e-6);
        if u <= 0.0 || speed <= SPEEDS_M_S[0] {
            return None;
        }
        let [newest, oldest] = [self.states.first(), self.states.last()].map(|s| s.map_or(0.0, |s| s.node.time_s));
        let share = age_share(u, self.time_s - newest, self.time_s - oldest);
        let share = share * smoothstep(SPEEDS_M_S[0], SPEEDS_M_S[1], speed);
        let [s, slope, bend] = source.s;
        let is_beyond = wave == WakeWave::BeyondCusp;
        // A place beyond a cusp has the waves of the cusp. The cusp is at the distance at which S would be 0.
        let far = if is_beyond { (distance * distance - s).max(1e-12).sqrt() } else { distance };
        let cosine = (2.0 * far / (speed * u)).clamp(1e-3, 1.0);
        let factor = g * u / (2.0 * far * far * far);
        let half_bend = 0.5 * if is_beyond { bend } else { bend.abs() }.max(LEAST_BEND * speed2);
        let third = factor * half_bend;
        let (k, raw) = self.raised(speed, cosine, end);
        let near_u = u + BEGINNING * self.hull.length_m / speed;
        let size = (2.0 * PI).sqrt() / near_u * share;
        let exact = -g * u * u / (4.0 * distance);
        let (size, phase) = if is_beyond {
            let least = (s - slope * slope / (4.0 * half_bend)).max(0.0);
            let beyond = factor * factor * half_bend * least * libm::pow(third, -4.0 / 3.0);
            let gone = smoothstep(BEYOND[0], BEYOND[1], distance / far);
            let comes = smoothstep(CUSP_BENDS[0], CUSP_BENDS[1], bend / speed2);
            if beyond > LAST_AIRY {
                return None;
            }
            (2.0 * PI.sqrt() * airy_beyond(beyond) * libm::cbrt(1.0 / third) * (1.0 - gone) * comes * size, exact)
        } else {
            let second = factor * slope.abs();
            let four_thirds = libm::pow(third, 4.0 / 3.0);
            let argument = second * second / (4.0 * four_thirds);
            let later = PHASE[0] / (1.0 + PHASE[1] * argument * argument.sqrt());
            let turned = if wave == WakeWave::Diverging { FRAC_PI_4 - later } else { later - FRAC_PI_4 };
            // The zero was found on a parabola, so that S is not quite 0. The phase is stationary there, and its
            // correction is of second order in S.
            let left = 0.5 * factor * s * s * slope / (slope * slope + 1e-6 * speed2 * speed2 * u * u);
            let size = size / (0.25 * second * second + MODULUS * four_thirds).sqrt().sqrt();
            (size, exact + left.clamp(-0.5, 0.5) + turned)
        };
        let amplitude_m = size * raw.length();
        let raw_steepness = amplitude_m * k;
        let limit = 1.0 / (1.0 + (raw_steepness / MOST_STEEPNESS).powi(2)).sqrt();
        let phase = phase + libm::atan2(raw.y, raw.x);
        Some(WaveShape { k, amplitude_m: amplitude_m * limit, phase, raw_steepness })
    }

    /// Returns the wave number, rad/m, of waves whose direction is at an angle of the given cosine to the course, and
    /// the amplitude of these waves before they spread, m, as a complex number (Michell 1898).
    fn raised(&self, speed: f64, cosine: f64, end: HullEnd) -> (f64, DVec2) {
        let hull = &self.hull;
        let along = GRAVITY_M_S2 / (speed * speed * cosine);
        let k = along / cosine;
        let deep = 1.0 - libm::exp(-k * hull.draught_m);
        // Waves much shorter than the beam are not raised by the hull as a whole; a planing hull presses on an area.
        let planing = smoothstep(PLANING[0], PLANING[1], speed / (GRAVITY_M_S2 * hull.length_m).sqrt());
        let width = k * hull.beam_m * libm::pow(hull.length_m / hull.beam_m, 0.5 * planing) / (2.0 * PI);
        let base = 8.0 * hull.beam_m * deep * libm::exp(-width * width) / (PI * cosine * hull.length_m * hull.length_m);
        (k, DVec2::new(end.sign() / (along * along), 0.5 * hull.length_m / along) * base)
    }

    /// Returns the share of a place under the foam that the hull has churned up.
    fn wash(&self, place_m: DVec2) -> f64 {
        let mut most = 0.0f64;
        let stern = |state: &TrackNode| state.place_m - state.ahead * (0.5 * self.hull.length_m);
        for pair in self.states.windows(2) {
            let pair = [&pair[0].node, &pair[1].node];
            let (a, b) = (stern(pair[0]), stern(pair[1]));
            let way = b - a;
            let part = ((place_m - a).dot(way) / way.length_squared().max(1e-9)).clamp(0.0, 1.0);
            let state_s = pair[0].time_s + (pair[1].time_s - pair[0].time_s) * part;
            let speed = pair[0].speed_m_s + (pair[1].speed_m_s - pair[0].speed_m_s) * part;
            let age_s = (self.time_s - state_s).max(0.0);
            // The wash of a hull widens with about the fourth root of the distance astern.
            let lengths = 1.0 + speed * age_s / (2.0 * self.hull.length_m);
            let half = WASH_WIDTH * self.hull.beam_m * lengths.sqrt().sqrt();
            let off = (place_m - a - way * part).length() / half;
            let begins = smoothstep(WASH_SPEEDS_M_S[0], WASH_SPEEDS_M_S[1], speed);
            most = most.max(WASH_SHARE * begins * libm::exp(-age_s / WASH_DECAY_S) * (1.0 - off * off).max(0.0));
        }
        most
    }
}

/// Removes the states inside straight stretches of constant speed: S is one parabola there.
fn merge_straight(nodes: &mut Vec<TrackNode>) {
    let is_between = |new: &TrackNode, node: &TrackNode, old: &TrackNode| {
        let on_way = |other: &TrackNode| {
            let expected = old.place_m + old.velocity() * (other.time_s - old.time_s);
            (other.place_m - expected).length_squared() < STRAIGHT_M * STRAIGHT_M
                && (other.velocity() - old.velocity()).length_squared() < STRAIGHT_M_S * STRAIGHT_M_S
        };
        on_way(new) && on_way(node)
    };
    let mut kept = 0;
    for i in 0..nodes.len() {
        let is_gone = kept > 0 && i + 1 < nodes.len() && is_between(&nodes[kept - 1], &nodes[i], &nodes[i + 1]);
        if !is_gone {
            nodes[kept] = nodes[i];
            kept += 1;
        }
    }
    nodes.truncate(kept);
}

/// Wave at a place.
struct WaveShape {
    /// Wave number, rad/m.
    k: f64,
    amplitude_m: f64,
    phase: f64,
    /// Steepness before it was limited.
    raw_steepness: f64,
}

/// Returns Ai(x) for x of at least 0, within 3 % of Ai(0).
fn airy_beyond(x: f64) -> f64 {
    AIRY_0 * libm::exp(-2.0 / 3.0 * x * x.sqrt()) * (MODULUS / (x + MODULUS)).sqrt().sqrt()
}

#[cfg(test)]
mod tests;
