//! The single waves at a time, four side by side. Phases are reduced in f64; sines, amplitudes and sums are in f32.
//! Terms are always added in the same order, so that every machine gives the same bits. Rounding moves a height by some
//! micrometres.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3, Vec4};

use super::{
    foam::{AGE_STEP_S, AGES},
    lattice::SeaWave,
    turn::{fraction, sin_cos, sin_cos_four},
};

/// Waves that are summed at a time.
const LANES: usize = 4;
/// Largest number of groups of [`LANES`] waves. A list has at most some 320 waves.
const MOST_GROUPS: usize = 128;

/// Properties of [`LANES`] waves, in the form in which they are summed.
#[derive(Clone, Copy, Debug, Default)]
struct WaveGroup {
    /// Wave vector, turns per metre.
    turns_x: [f64; LANES],
    turns_y: [f64; LANES],
    /// Phase at the surface's time, turns.
    phase: [f64; LANES],
    /// Amplitude of height and of displacement, m.
    height: Vec4,
    shift_x: Vec4,
    shift_y: Vec4,
    /// Unit vector times wave number, 1/m.
    rise_x: Vec4,
    rise_y: Vec4,
    /// Frequency, rad/s.
    w: Vec4,
    /// Sine and cosine of the phase that passes in [`AGE_STEP_S`].
    step_sin: Vec4,
    step_cos: Vec4,
}

/// Sines and cosines of the waves' phases at a place; 0 for waves that are left out.
pub(super) struct Phases([[Vec4; 2]; MOST_GROUPS]);

impl Phases {
    pub fn new() -> Self {
        Self([[Vec4::ZERO; 2]; MOST_GROUPS])
    }
}

/// Displacement of the particle at rest at a place, and its derivatives.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Displacement {
    pub shift: DVec2,
    /// d(shift.x)/dx, d(shift.x)/dy, d(shift.y)/dx, d(shift.y)/dy.
    pub slopes: [f64; 4],
}

/// Height and motion of a particle.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ParticleMotion {
    pub height: f64,
    pub slope: DVec2,
    pub velocity: DVec3,
    pub acceleration: DVec3,
}

/// The single waves at the surface's time, long waves first.
#[derive(Clone, Debug, Default)]
pub(super) struct WaveLanes {
    groups: Vec<WaveGroup>,
    /// Sums over a wave and all longer ones: variance, and lowering of the mean level.
    variance_m2: Vec<f64>,
    lowering_m: Vec<f64>,
    /// Lengths of the waves, m.
    length_m: Vec<f64>,
}

/// Number of the waves that a query sums, from the longest on, and the sums over them.
#[derive(Clone, Copy, Debug)]
pub(super) struct IncludedLanes {
    waves: usize,
    pub variance_m2: f64,
    pub lowering_m: f64,
}

/// Returns the sum of all lanes.
fn sum(v: Vec4) -> f64 {
    (f64::from(v.x) + f64::from(v.y)) + (f64::from(v.z) + f64::from(v.w))
}

/// A single wave at the surface's time, in the form that drawing uses.
#[derive(Clone, Copy, Debug)]
pub(super) struct SurfaceWave {
    /// Wave vector, turns per metre.
    pub turns_per_m: DVec2,
    /// Phase at the map's origin, turns.
    pub phase: f64,
    /// Amplitude of the height and of the displacement, m.
    pub height_m: f64,
    pub shift_m: DVec2,
    /// Frequency, Hz.
    pub frequency_hz: f64,
}

impl WaveLanes {
    /// Returns the waves, from long to short.
    pub fn each(&self) -> impl Iterator<Item = SurfaceWave> + '_ {
        (0..self.length_m.len()).map(|i| {
            let (group, l) = (&self.groups[i / LANES], i % LANES);
            SurfaceWave {
                turns_per_m: DVec2::new(group.turns_x[l], group.turns_y[l]),
                phase: group.phase[l],
                height_m: f64::from(group.height[l]),
                shift_m: DVec2::new(f64::from(group.shift_x[l]), f64::from(group.shift_y[l])),
                frequency_hz: f64::from(group.w[l]) / TAU,
            }
        })
    }

    /// Fills the lanes with waves, which must be sorted from long to short, at a time.
    pub fn fill(&mut self, waves: &[SeaWave], time_s: f64) {
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
                group.height[l] = a as f32;
                (group.shift_x[l], group.shift_y[l]) =
                    ((along.x * a * wave.stretch) as f32, (along.y * a * wave.stretch) as f32);
                (group.rise_x[l], group.rise_y[l]) = ((along.x * k) as f32, (along.y * k) as f32);
                group.w[l] = (TAU * wave.frequency_hz) as f32;
                let (sin, cos) = sin_cos(wave.frequency_hz * AGE_STEP_S);
                (group.step_sin[l], group.step_cos[l]) = (sin as f32, cos as f32);
                variance += 0.5 * a * a;
                lowering += 0.5 * a * a * k * wave.stretch;
                self.variance_m2.push(variance);
                self.lowering_m.push(lowering);
                self.length_m.push(1.0 / wave.turns_per_m);
            }
            self.groups.push(group);
        }
    }

    /// Returns the variance of all waves, m^2.
    pub fn variance_m2(&self) -> f64 {
        self.variance_m2.last().copied().unwrap_or(0.0)
    }

    /// Returns the waves of at least a length.
    pub fn included(&self, shortest_m: f64) -> IncludedLanes {
        let waves = self.length_m.partition_point(|length| *length >= shortest_m);
        let last = |list: &[f64]| if waves > 0 { list[waves - 1] } else { 0.0 };
        IncludedLanes { waves, variance_m2: last(&self.variance_m2), lowering_m: last(&self.lowering_m) }
    }

    /// Returns the displacement of the particle at rest at a place, and writes the waves' phases there to `phases`.
    pub fn displacement(&self, rest: DVec2, included: &IncludedLanes, phases: &mut Phases) -> Displacement {
        let mut sums = [Vec4::ZERO; 5];
        let groups = self.groups.iter().take(included.waves.div_ceil(LANES));
        for (n, (group, place)) in groups.zip(&mut phases.0).enumerate() {
            let turns =
                |l: usize| fraction(group.turns_x[l] * rest.x + group.turns_y[l] * rest.y + group.phase[l]) as f32;
            let (mut sin, mut cos) = sin_cos_four(Vec4::new(turns(0), turns(1), turns(2), turns(3)));
            let kept = included.waves - n * LANES;
            if kept < LANES {
                let is_in = Vec4::from_array(std::array::from_fn(|l| if l < kept { 1.0 } else { 0.0 }));
                (sin, cos) = (is_in * sin, is_in * cos);
            }
            *place = [sin, cos];
            let (along_x, along_y) = (group.shift_x * cos, group.shift_y * cos);
            sums[0] -= group.shift_x * sin;
            sums[1] -= group.shift_y * sin;
            sums[2] -= along_x * group.rise_x;
            sums[3] -= along_x * group.rise_y;
            sums[4] -= along_y * group.rise_y;
        }
        let [x, y, xx, xy, yy] = sums.map(sum);
        Displacement { shift: DVec2::new(x, y), slopes: [xx, xy, xy, yy] }
    }

    /// Returns the compression around a particle at each age of foam before now, from the waves' phases there now.
    pub fn past_compression(&self, included: &IncludedLanes, phases: &Phases) -> [f64; AGES] {
        let mut sums = [Vec4::ZERO; AGES];
        let groups = self.groups.iter().take(included.waves.div_ceil(LANES));
        for (group, [sin, cos]) in groups.zip(&phases.0) {
            let size = group.shift_x * group.rise_x + group.shift_y * group.rise_y;
            let (mut sin, mut cos) = (*sin, *cos);
            for sum in &mut sums {
                (sin, cos) = (sin * group.step_cos + cos * group.step_sin, cos * group.step_cos - sin * group.step_sin);
                *sum += size * cos;
            }
        }
        sums.map(sum)
    }

    /// Returns height and motion of the particle at rest at a place whose phases are known.
    pub fn motion(&self, included: &IncludedLanes, phases: &Phases) -> ParticleMotion {
        let mut sums = [Vec4::ZERO; 9];
        let groups = self.groups.iter().take(included.waves.div_ceil(LANES));
        for (group, [sin, cos]) in groups.zip(&phases.0) {
            let (up_sin, up_cos) = (group.height * *sin, group.height * *cos);
            let squared = group.w * group.w;
            let (w_sin, w_cos) = (squared * *sin, group.w * *cos);
            sums[0] += up_cos;
            sums[1] -= up_sin * group.rise_x;
            sums[2] -= up_sin * group.rise_y;
            sums[3] += up_sin * group.w;
            sums[4] += group.shift_x * w_cos;
            sums[5] += group.shift_y * w_cos;
            sums[6] -= up_cos * squared;
            sums[7] += group.shift_x * w_sin;
            sums[8] += group.shift_y * w_sin;
        }
        let [height, slope_x, slope_y, rise, flow_x, flow_y, lift, push_x, push_y] = sums.map(sum);
        ParticleMotion {
            height,
            slope: DVec2::new(slope_x, slope_y),
            velocity: DVec3::new(flow_x, flow_y, rise),
            acceleration: DVec3::new(push_x, push_y, lift),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lanes_are_the_sums_of_their_waves() {
        let mut chance = crate::chance::RandomStream::new(3, 8);
        let mut wave = |i: i32| {
            let (sin, cos) = libm::sincos(TAU * chance.even());
            let length_m = 200.0 * 0.97f64.powi(i);
            SeaWave {
                amplitude_m: 0.1 * chance.even(),
                toward: DVec2::new(cos, sin),
                turns_per_m: 1.0 / length_m,
                frequency_hz: (9.81 / (TAU * length_m)).sqrt(),
                phase: chance.even(),
                stretch: 1.2,
            }
        };
        let waves: Vec<SeaWave> = (0..151).map(&mut wave).collect();
        let mut lanes = WaveLanes::default();
        lanes.fill(&waves, 1e6);
        for (shortest_m, count) in [(0.0, 151), (200.0 * 0.97f64.powi(29), 30)] {
            let included = lanes.included(shortest_m);
            let mut phases = Phases::new();
            let rest = DVec2::new(3e5 + 0.25, -7e4);
            let moved = lanes.displacement(rest, &included, &mut phases);
            let motion = lanes.motion(&included, &phases);
            let past = lanes.past_compression(&included, &phases);
            let mut before = [0.0; AGES];
            let (mut shift, mut slope, mut height) = (DVec2::ZERO, 0.0, 0.0);
            let (mut velocity, mut lift) = (DVec3::ZERO, 0.0);
            for wave in &waves[..count] {
                let turns = wave.turns_per_m * wave.toward.dot(rest) - wave.frequency_hz * 1e6 + wave.phase;
                let (sin, cos) = libm::sincos(TAU * (turns - turns.floor()));
                let (a, w, k) = (wave.amplitude_m, TAU * wave.frequency_hz, TAU * wave.turns_per_m);
                shift -= wave.toward * (a * wave.stretch * sin);
                slope -= wave.toward.x * wave.toward.y * a * wave.stretch * k * cos;
                height += a * cos;
                velocity += (wave.toward * (a * wave.stretch * w * cos)).extend(a * w * sin);
                lift -= a * w * w * cos;
                for (age, sum) in (1..).zip(&mut before) {
                    let earlier = turns + wave.frequency_hz * AGE_STEP_S * f64::from(age);
                    *sum += a * wave.stretch * k * libm::cos(TAU * (earlier - earlier.floor()));
                }
            }
            assert!((moved.shift - shift).length() < 3e-6 && (moved.slopes[1] - slope).abs() < 3e-6, "{count}");
            assert!((motion.height - height).abs() < 3e-6 && (motion.velocity - velocity).length() < 1e-5, "{count}");
            assert!(
                past.iter().zip(before).all(|(found, wanted)| (found - wanted).abs() < 1e-5),
                "{past:?} {before:?}"
            );
            assert!((motion.acceleration.z - lift).abs() < 1e-5, "{count}: {} {lift}", motion.acceleration.z);
            let variance: f64 = waves[..count].iter().map(|wave| 0.5 * wave.amplitude_m.powi(2)).sum();
            assert!((included.variance_m2 - variance).abs() < 1e-12);
        }
    }
}
