//! The sea's surface at a time: waves and tiles with their phases, and the solution for a fixed place.
//!
//! Waves carry the water around: a particle at rest at X is at X + D(X), at the height h(X) (Gerstner 1809; Tessendorf
//! 2001). A query at a place x solves X + D(X) = x by Newton's method and reads height, slope, velocity and
//! acceleration of that particle. Because crests are narrower than troughs, the mean level over fixed places would fall
//! by the sum of k coth(k h) times variance; the surface is raised by as much.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::{
    fft::SIDE,
    lattice::SeaWave,
    tiles::{TILES, TileWork, VALUES, WaveTiles, sample},
    turn::{fraction, sin_cos},
};
use crate::numerics::smoothstep;

/// Waves that are summed at a time.
const LANES: usize = 4;
/// Most groups of them: a list has at most some 300 waves.
const MOST_GROUPS: usize = 128;
/// Largest distance, m, between the place asked for and the one solved for, and most steps towards it.
const SOLVED_M: f64 = 5e-4;
const MOST_STEPS: usize = 12;
/// Standard deviations that a stated bound allows for: 1 place in 16,000 is off by more.
const BOUND_DEVIATIONS: f64 = 4.0;
/// Range of compressions about the threshold over which foam begins, as a share of the threshold.
const FOAM_EDGE: f64 = 0.05;
const LEAST_FOAM_EDGE: f64 = 1e-3;

/// The sea at a place and time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SeaPoint {
    /// Height of the surface above mean sea level, m.
    pub height_m: f64,
    /// Largest error of the height, m: 4 standard deviations of the waves left out and of the interpolation in tiles,
    /// and the tolerance of the solution.
    pub height_error_m: f64,
    /// Unit normal of the surface (east, north, up).
    pub normal: DVec3,
    /// Velocity of the water at the surface, m/s (east, north, up), without the drift.
    pub velocity_m_s: DVec3,
    /// Acceleration of the water at the surface, m/s^2 (east, north, up).
    pub acceleration_m_s2: DVec3,
    /// Depth of the water under the surface, m.
    pub depth_m: f64,
    /// Share of the place under foam of waves that break now, 0 to 1. Foam left by earlier waves is not in this
    /// version.
    pub foam: f64,
}

/// Properties of [`LANES`] waves, in the form in which they are summed.
#[derive(Clone, Copy, Debug, Default)]
struct WaveGroup {
    /// Wave vector, turns per metre.
    turns_x: [f64; LANES],
    turns_y: [f64; LANES],
    /// Phase at the surface's time, turns.
    phase: [f64; LANES],
    /// Amplitude of height and of displacement, m.
    height: [f64; LANES],
    shift_x: [f64; LANES],
    shift_y: [f64; LANES],
    /// Unit vector times wave number, 1/m.
    rise_x: [f64; LANES],
    rise_y: [f64; LANES],
    /// Frequency, rad/s.
    w: [f64; LANES],
}

/// The single waves at the surface's time, long waves first.
#[derive(Clone, Debug, Default)]
struct WaveLanes {
    groups: Vec<WaveGroup>,
    /// Sums over a wave and all longer ones: variance, and lowering of the mean level.
    variance_m2: Vec<f64>,
    lowering_m: Vec<f64>,
    /// Lengths of the waves, m.
    length_m: Vec<f64>,
}

impl WaveLanes {
    fn fill(&mut self, waves: &[SeaWave], time_s: f64) {
        self.groups.clear();
        for list in [&mut self.variance_m2, &mut self.lowering_m, &mut self.length_m] {
            list.clear();
        }
        let (mut variance, mut lowering) = (0.0, 0.0);
        for members in waves.chunks(LANES).take(MOST_GROUPS) {
            // Waves without amplitude fill the last group.
            let mut group = WaveGroup::default();
            for (l, wave) in members.iter().enumerate() {
                let k = TAU * wave.turns_per_m;
                let (a, along) = (wave.amplitude_m, wave.toward);
                (group.turns_x[l], group.turns_y[l]) = (along.x * wave.turns_per_m, along.y * wave.turns_per_m);
                group.phase[l] = wave.phase - fraction(wave.frequency_hz * time_s);
                group.height[l] = a;
                (group.shift_x[l], group.shift_y[l]) = (along.x * a * wave.stretch, along.y * a * wave.stretch);
                (group.rise_x[l], group.rise_y[l]) = (along.x * k, along.y * k);
                group.w[l] = TAU * wave.frequency_hz;
                variance += 0.5 * a * a;
                lowering += 0.5 * a * a * k * wave.stretch;
                self.variance_m2.push(variance);
                self.lowering_m.push(lowering);
                self.length_m.push(1.0 / wave.turns_per_m);
            }
            self.groups.push(group);
        }
    }
}

/// Sines and cosines of the waves' phases at a place.
struct Phases([[[f64; LANES]; 2]; MOST_GROUPS]);

/// Displacement of the particle at rest at a place, and its derivatives.
#[derive(Clone, Copy, Debug, Default)]
struct Displacement {
    shift: DVec2,
    /// d(shift.x)/dx, d(shift.x)/dy, d(shift.y)/dx, d(shift.y)/dy.
    slopes: [f64; 4],
}

/// Height and motion of a particle.
#[derive(Clone, Copy, Debug, Default)]
struct ParticleMotion {
    height: f64,
    slope: DVec2,
    velocity: DVec3,
    acceleration: DVec3,
}

/// A tile's fields at the surface's time.
#[derive(Clone, Debug)]
struct TileFields {
    fields: Vec<[f64; VALUES]>,
    length_m: f64,
    turn: DVec2,
    variance_m2: f64,
    lowering_m: f64,
    image_m2: f64,
    shortest_m: f64,
    longest_m: f64,
}

/// Values of the surface that hold everywhere.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct StillSea {
    /// Level without waves, m.
    pub level_m: f64,
    /// Depth below it, m.
    pub depth_m: f64,
    /// Compression at which foam begins.
    pub foam_from: f64,
}

/// The surface at a time.
#[derive(Clone, Debug)]
pub(crate) struct SeaSurface {
    lanes: WaveLanes,
    tiles: Vec<TileFields>,
    still: StillSea,
    /// Variance of all that is drawn, m^2.
    variance_m2: f64,
}

/// The particle that is at a place.
struct SolvedParticle {
    /// Its place at rest.
    rest: DVec2,
    moved: Displacement,
    /// The place asked for minus that of the particle, m.
    off: DVec2,
}

/// Waves of a query.
#[derive(Clone, Copy)]
struct IncludedWaves {
    waves: usize,
    tiles: [bool; TILES],
    raised_m: f64,
    error_m: f64,
}

impl SeaSurface {
    pub fn new() -> Self {
        let none = || TileFields {
            fields: vec![[0.0; VALUES]; SIDE * SIDE],
            length_m: 1.0,
            turn: DVec2::X,
            variance_m2: 0.0,
            lowering_m: 0.0,
            image_m2: 0.0,
            shortest_m: 1.0,
            longest_m: 1.0,
        };
        let tiles = (0..TILES).map(|_| none()).collect();
        Self { lanes: WaveLanes::default(), tiles, still: StillSea::default(), variance_m2: 0.0 }
    }

    /// Takes over waves, which must be sorted from long to short, and tiles at a time.
    pub(super) fn fill(
        &mut self,
        waves: &[SeaWave],
        tiles: &WaveTiles,
        work: &mut TileWork,
        (still, time_s): (StillSea, f64),
    ) {
        self.still = still;
        self.lanes.fill(waves, time_s);
        self.variance_m2 = self.lanes.variance_m2.last().copied().unwrap_or(0.0);
        for (to, tile) in self.tiles.iter_mut().zip(&tiles.tiles) {
            (to.length_m, to.turn, to.shortest_m) = (tile.length_m, tile.turn, tile.shortest_m);
            (to.variance_m2, to.lowering_m, to.image_m2) =
                (tile.variance_m2, tile.narrowing_m[0] + tile.narrowing_m[1], tile.image_m2);
            to.longest_m = tile.length_m / super::tiles::LEAST_PERIODS;
            self.variance_m2 += tile.variance_m2;
            if tile.variance_m2 > 0.0 {
                tile.sum(time_s, work, &mut to.fields);
            }
        }
    }

    /// Returns the sea at a place (east and north of the world's origin, m), with waves of at least `shortest_m` and
    /// tiles that have such waves.
    pub fn at(&self, place_m: DVec2, shortest_m: f64) -> SeaPoint {
        let included = self.included(shortest_m);
        let mut phases = Phases([[[0.0; LANES]; 2]; MOST_GROUPS]);
        let SolvedParticle { rest, moved, off } = self.solve(place_m, &included, &mut phases, MOST_STEPS);
        let motion = self.motion(rest, &included, &phases);
        let slope = transposed_inverse_times(&moved.slopes, motion.slope);
        let height = motion.height + included.raised_m + slope.dot(off);
        let compression = -(moved.slopes[0] + moved.slopes[3]);
        let foam_from = self.still.foam_from;
        let foam = if foam_from.is_finite() {
            let edge = FOAM_EDGE * foam_from.abs() + LEAST_FOAM_EDGE;
            smoothstep(foam_from - edge, foam_from + edge, compression)
        } else {
            0.0
        };
        SeaPoint {
            height_m: self.still.level_m + height,
            height_error_m: included.error_m + off.length() * slope.length() + SOLVED_M,
            normal: DVec3::new(-slope.x, -slope.y, 1.0).normalize(),
            velocity_m_s: motion.velocity,
            acceleration_m_s2: motion.acceleration,
            depth_m: (self.still.depth_m + height).max(0.0),
            foam,
        }
    }

    /// Returns how far from a place the solution for it is after some steps, m.
    #[cfg(test)]
    pub(super) fn solved_off_m(&self, place_m: DVec2, steps: usize) -> f64 {
        let mut phases = Phases([[[0.0; LANES]; 2]; MOST_GROUPS]);
        self.solve(place_m, &self.included(0.0), &mut phases, steps).off.length()
    }

    /// Solves for the particle that is at a place in at most so many steps, and leaves the phases there.
    fn solve(
        &self,
        place_m: DVec2,
        included: &IncludedWaves,
        phases: &mut Phases,
        most_steps: usize,
    ) -> SolvedParticle {
        let mut rest = place_m;
        let mut moved = self.displacement(rest, included, phases);
        let mut off = -moved.shift;
        for _ in 0..most_steps {
            if off.length_squared() <= SOLVED_M * SOLVED_M {
                break;
            }
            rest += inverse_times(&moved.slopes, off);
            moved = self.displacement(rest, included, phases);
            off = place_m - rest - moved.shift;
        }
        SolvedParticle { rest, moved, off }
    }

    /// Returns what a query with this shortest wave sums, and what it leaves out.
    fn included(&self, shortest_m: f64) -> IncludedWaves {
        let lanes = &self.lanes;
        let waves = lanes.length_m.partition_point(|length| *length >= shortest_m);
        let last = |list: &[f64]| if waves > 0 { list[waves - 1] } else { 0.0 };
        let (mut raised_m, mut variance, mut images) = (last(&lanes.lowering_m), last(&lanes.variance_m2), 0.0);
        let mut tiles = [false; TILES];
        for (is_in, tile) in tiles.iter_mut().zip(&self.tiles) {
            *is_in = tile.variance_m2 > 0.0 && tile.longest_m >= shortest_m;
            if *is_in {
                raised_m += tile.lowering_m;
                variance += tile.variance_m2;
                images += tile.image_m2;
            }
        }
        let left_out = (self.variance_m2 - variance).max(0.0);
        // Rounding leaves some 1e-16 of the variance.
        let left_out = if left_out < 1e-12 * self.variance_m2 { 0.0 } else { left_out };
        IncludedWaves { waves, tiles, raised_m, error_m: BOUND_DEVIATIONS * (left_out + images).sqrt() }
    }

    fn displacement(&self, rest: DVec2, included: &IncludedWaves, phases: &mut Phases) -> Displacement {
        let mut sums = [[0.0; LANES]; 5];
        let groups = self.lanes.groups.iter().take(included.waves.div_ceil(LANES));
        for (n, (group, [sines, cosines])) in groups.zip(&mut phases.0).enumerate() {
            let kept = included.waves - n * LANES;
            for l in 0..LANES {
                let is_in = if l < kept { 1.0 } else { 0.0 };
                let (sin, cos) = sin_cos(group.turns_x[l] * rest.x + group.turns_y[l] * rest.y + group.phase[l]);
                (sines[l], cosines[l]) = (is_in * sin, is_in * cos);
            }
            for l in 0..LANES {
                let (x, y) = (group.shift_x[l], group.shift_y[l]);
                let (along_x, along_y) = (x * cosines[l], y * cosines[l]);
                sums[0][l] -= x * sines[l];
                sums[1][l] -= y * sines[l];
                sums[2][l] -= along_x * group.rise_x[l];
                sums[3][l] -= along_x * group.rise_y[l];
                sums[4][l] -= along_y * group.rise_y[l];
            }
        }
        let [x, y, xx, xy, yy] = sums.map(|s| (s[0] + s[1]) + (s[2] + s[3]));
        let mut out = Displacement { shift: DVec2::new(x, y), slopes: [xx, xy, xy, yy] };
        for (tile, _) in self.tiles.iter().zip(included.tiles).filter(|(_, is_in)| *is_in) {
            let found = sample::<3>(&tile.fields, tile.length_m, to_tile(tile.turn, rest));
            out.shift += from_tile(tile.turn, DVec2::new(found.values[1], found.values[2]));
            let [dx, dy] = [found.along_x, found.along_y].map(|d| from_tile(tile.turn, DVec2::new(d[1], d[2])));
            // Derivatives along the tile's axes, turned into those along east and north.
            let (c, s) = (tile.turn.x, tile.turn.y);
            let east = dx * c - dy * s;
            let north = dx * s + dy * c;
            let turned = [east.x, north.x, east.y, north.y];
            out.slopes.iter_mut().zip(turned).for_each(|(sum, slope)| *sum += slope);
        }
        out
    }

    /// Returns height and motion of the particle at rest at a place whose phases are known.
    fn motion(&self, rest: DVec2, included: &IncludedWaves, phases: &Phases) -> ParticleMotion {
        let mut sums = [[0.0; LANES]; 9];
        let groups = self.lanes.groups.iter().take(included.waves.div_ceil(LANES));
        for (group, [sines, cosines]) in groups.zip(&phases.0) {
            for l in 0..LANES {
                let (sin, cos, w) = (sines[l], cosines[l], group.w[l]);
                let (up_sin, up_cos) = (group.height[l] * sin, group.height[l] * cos);
                let (w_sin, w_cos) = (w * w * sin, w * cos);
                sums[0][l] += up_cos;
                sums[1][l] -= up_sin * group.rise_x[l];
                sums[2][l] -= up_sin * group.rise_y[l];
                sums[3][l] += up_sin * w;
                sums[4][l] += group.shift_x[l] * w_cos;
                sums[5][l] += group.shift_y[l] * w_cos;
                sums[6][l] -= up_cos * w * w;
                sums[7][l] += group.shift_x[l] * w_sin;
                sums[8][l] += group.shift_y[l] * w_sin;
            }
        }
        let sums = sums.map(|s| (s[0] + s[1]) + (s[2] + s[3]));
        let mut out = ParticleMotion {
            height: sums[0],
            slope: DVec2::new(sums[1], sums[2]),
            velocity: DVec3::new(sums[4], sums[5], sums[3]),
            acceleration: DVec3::new(sums[7], sums[8], sums[6]),
        };
        for (tile, _) in self.tiles.iter().zip(included.tiles).filter(|(_, is_in)| *is_in) {
            let found = sample::<VALUES>(&tile.fields, tile.length_m, to_tile(tile.turn, rest));
            let v = found.values;
            out.height += v[0];
            out.slope += from_tile(tile.turn, DVec2::new(found.along_x[0], found.along_y[0]));
            out.velocity += from_tile(tile.turn, DVec2::new(v[4], v[5])).extend(v[3]);
            out.acceleration += from_tile(tile.turn, DVec2::new(v[7], v[8])).extend(v[6]);
        }
        out
    }
}

/// Turns a vector (east, north) into a tile's axes.
fn to_tile(turn: DVec2, v: DVec2) -> DVec2 {
    DVec2::new(turn.x * v.x + turn.y * v.y, turn.x * v.y - turn.y * v.x)
}

/// Turns a vector in a tile's axes into (east, north).
fn from_tile(turn: DVec2, v: DVec2) -> DVec2 {
    DVec2::new(turn.x * v.x - turn.y * v.y, turn.y * v.x + turn.x * v.y)
}

/// Returns the determinant of 1 + `slopes`, at least 0.1: where waves fold, Newton's steps stay short.
fn determinant(slopes: &[f64; 4]) -> f64 {
    ((1.0 + slopes[0]) * (1.0 + slopes[3]) - slopes[1] * slopes[2]).max(0.1)
}

/// Returns the inverse of 1 + `slopes` (rows x, y) times a vector.
fn inverse_times(slopes: &[f64; 4], v: DVec2) -> DVec2 {
    let d = determinant(slopes);
    let [xx, xy, yx, yy] = *slopes;
    DVec2::new((1.0 + yy) * v.x - xy * v.y, (1.0 + xx) * v.y - yx * v.x) / d
}

/// Returns the transposed inverse of 1 + `slopes` times a vector: a gradient over rest places as one over fixed places.
fn transposed_inverse_times(slopes: &[f64; 4], v: DVec2) -> DVec2 {
    let d = determinant(slopes);
    let [xx, xy, yx, yy] = *slopes;
    DVec2::new((1.0 + yy) * v.x - yx * v.y, (1.0 + xx) * v.y - xy * v.x) / d
}
