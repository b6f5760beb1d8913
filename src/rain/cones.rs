//! Rain on three nested cones around the camera (after Wang and Wade 2004): a texture of streaks, created once, moves
//! as the drops do.
//!
//! Each cone shows the drops in a band of distances. In the two outer bands the far end is 2.8 times the near end. Let
//! a drop at distance r move with velocity V relative to the camera, and let theta be its angle from V. Its azimuth
//! about V stays the same. Its coordinate s = ln tan(theta / 2), the latitude of Mercator's projection, changes at the
//! constant speed |V| / r. Its streak has the length |V| t / r in s for any theta, where t is the exposure time. The
//! texture is therefore mapped to (azimuth, s), where it repeats in tiles, and moves along s. Streaks then converge in
//! the directions V and -V, as those of drops do. Towards these directions the number of tiles in a turn of azimuth is
//! halved each time sin theta is halved, so streaks keep their width. Wang and Wade narrowed the cone to a tip, where
//! all streaks met in a point.
//!
//! A cone shows as many streaks as there are drops in its band. The texture's four channels hold streaks in the ratio
//! 1:4:16:64, and as many channels are summed as are needed. If a band has more drops than the texture has streaks, the
//! contrast is reduced to that of the drops. The mean optical depth is that of the band's drops.
//!
//! No state is carried from frame to frame. A cone shows a set of streaks at a random offset, moved by the wind, the
//! fall and the camera's motion since the set's birth, less than a second before. These motions are exact at any time,
//! and the same in every view of a simulator. After its life another set replaces it. At any time a set is being
//! replaced in at most one cone, so that one more look-up a pixel suffices for all cones.

use glam::{DVec2, DVec3};
use half::f16;

use super::{
    classes::Classes,
    shells::{HIDDEN_M, SIDE_M},
    sizes::{DropSizes, Weight},
};
use crate::{
    falling::random3,
    particles::{MovingAir, StreakCamera},
};

/// Number of cones.
pub const CONES: usize = 3;
/// Ends of the cones' bands of distances, m.
pub const BANDS_M: [f64; CONES + 1] = {
    // Single drops of the innermost shell fade out at half of this distance, the end of the first band.
    let drops = HIDDEN_M;
    [0.1875, 0.5 * drops, 0.5 * FURTHER * drops, 4.0 * drops]
};
/// Ratio of the far end to the near end of each of the outer two bands: the square root of 8.
const FURTHER: f64 = 2.828_427_124_746_190_3;
/// Number of stretches of a ray that are tested for shelter: one for each band, but two for the outermost, which is
/// halved.
pub(super) const STRETCHES: usize = CONES + 1;
/// Width and height of the texture, texels.
pub(crate) const SIDE: u32 = 256;
/// Number of streaks in each channel.
pub(crate) const STREAKS: [u32; 4] = [48, 192, 768, 3072];
/// Mean length of a streak, texels.
const LENGTH: f64 = 5.0;
/// Half the width of a streak, texels; its profile is a parabola.
const HALF_WIDTH: f64 = 0.8;
/// Time from one set of the innermost cone to the next, s. Each farther cone takes twice as long as the next nearer
/// one.
const LIFE_S: f64 = 0.2;
/// Birth time of set 0 of each cone, in units of [`LIFE_S`], chosen so that no two cones replace a set at once.
const PHASES: [f64; CONES] = [0.5, 1.0, 0.0];
/// Share of a set's life in which it grows from 0 to its full depth, while the set before it shrinks.
const GROWS: f64 = 0.1;
/// Value of [`ConeUniform::growing`] while no set grows.
pub(crate) const NONE_GROWS: u32 = CONES as u32;

/// `ConeUniform` of `shaders/rain/cone_block.wgsl`, which explains the fields.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct ConeUniform {
    pub axis: [f32; 3],
    pub fall: f32,
    pub east: [f32; 3],
    pub first: u32,
    pub north: [f32; 3],
    pub growing: u32,
    pub bands: [[f32; 4]; CONES],
    pub shapes: [[f32; 4]; CONES],
    pub looks: [[f32; 4]; CONES],
    pub stretches: [[f32; 4]; STRETCHES],
    pub sets: [[f32; 4]; CONES + 1],
}

/// Means over all drawn drops.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Mean {
    /// Diameter, m, weighted by the area of the drops' discs.
    diameter_m: f64,
    /// Fall speed, m/s, weighted by the discs.
    fall_m_s: f64,
    /// Time to fall one metre, s, weighted by the discs. The distance that the wind carries drops in under a roof is
    /// proportional to this time.
    fall_s_per_m: f64,
}

impl Mean {
    /// Computes the means over all classes, weighted by the area of the drops' discs.
    fn of(classes: &Classes) -> Self {
        let mut m = Self { diameter_m: 0.0, fall_m_s: 0.0, fall_s_per_m: 0.0 };
        let mut discs = 0.0;
        for &(d, speed, flux) in classes.flux.iter().filter(|c| c.1 > 0.0) {
            let disc = flux / speed * d * d;
            discs += disc;
            m.diameter_m += disc * d * 1e-3;
            m.fall_m_s += disc * speed;
            m.fall_s_per_m += disc / speed;
        }
        if discs > 0.0 {
            m.diameter_m /= discs;
            m.fall_m_s /= discs;
            m.fall_s_per_m /= discs;
        }
        m
    }
}

/// Returns two unit vectors at right angles to `axis` and to each other: east and north, turned by the shortest
/// rotation that takes the downward direction to `axis`.
fn frame(axis: DVec3) -> (DVec3, DVec3) {
    let turn = glam::DQuat::from_rotation_arc(DVec3::NEG_Z, axis);
    (turn * DVec3::X, turn * DVec3::Y)
}

/// Returns the birth time of set `number` of cone `j`, s: the same in every frame of its life.
fn set_born_s(j: usize, number: f64) -> f64 {
    LIFE_S * (PHASES[j] + number * f64::from(1u32 << j))
}

/// Returns the number of the youngest set of cone `j` at a time, its birth time, and how far it has grown, 0 to 1.
fn set_at(j: usize, time_s: f64) -> (f64, f64, f64) {
    let life = LIFE_S * f64::from(1u32 << j);
    let number = ((time_s - set_born_s(j, 0.0)) / life).floor();
    let born_s = set_born_s(j, number);
    (number, born_s, ((time_s - born_s) / (GROWS * life)).clamp(0.0, 1.0))
}

/// Function that returns the displacement of the air by the wind, m (east, north, up), since a time, s.
pub(crate) type Carried<'a> = &'a dyn Fn(f64) -> DVec3;

impl ConeUniform {
    /// Creates the block for a camera.
    pub fn new(seed: u32, classes: &Classes, shot: &StreakCamera<'_>, air: &MovingAir, carried: Carried<'_>) -> Self {
        let mean = Mean::of(classes);
        let fall = DVec3::Z * mean.fall_m_s;
        let relative = air.velocity_m_s - fall - shot.velocity_m_s;
        let axis = relative.normalize_or(DVec3::NEG_Z);
        let (east, north) = frame(axis);
        let v = |d: DVec3| d.as_vec3().to_array();
        let pixel = shot.rays.pixel_angle(shot.height);
        let mut c = Self {
            growing: NONE_GROWS,
            axis: v(axis),
            fall: (1.0 / mean.fall_s_per_m.max(1e-3)) as f32,
            east: v(east),
            north: v(north),
            ..Self::zero()
        };
        for j in 0..CONES {
            let (near, far) = (BANDS_M[j], BANDS_M[j + 1]);
            let middle = 0.5 * (near + far);
            // Makes a streak slightly wider than a pixel, or as wide as a drop if that is more.
            let texel = (0.7 * pixel).max(mean.diameter_m / middle / (2.0 * HALF_WIDTH));
            let tiles = (std::f64::consts::TAU / (f64::from(SIDE) * texel)).round().max(1.0);
            let length = (relative.length() * shot.exposure_s + mean.diameter_m) / middle;
            let number =
                f64::from(classes.per_shell) * classes.weight / SIDE_M.powi(3) * (far.powi(3) - near.powi(3)) / 3.0;
            let depth = 0.5 * classes.extinction_per_m * (far - near);
            c.bands[j] = [near, far, middle, depth].map(|x| x as f32);
            let in_a_radian = |streak: f64| LENGTH / f64::from(SIDE) / streak;
            c.shapes[j] = [tiles, in_a_radian(length), number, in_a_radian(1.5 * pixel)].map(|x| x as f32);
            let clear = (-air.extinction_per_m * middle).exp();
            let level = (pixel * f64::from(SIDE) * tiles / std::f64::consts::TAU).log2() - 1.0;
            let (number, born_s, grown) = set_at(j, air.time_s);
            let set = |number: f64, born_s: f64, share: f64| {
                let moved = carried(born_s) - (fall + shot.velocity_m_s) * (air.time_s - born_s);
                let chance = random3([seed, j as u32 | 0x7000_0000, number as i64 as u32]);
                let [x, y] = [chance[0], chance[1]].map(|r| f64::from(r) / 4_294_967_296.0);
                [moved.dot(axis) / middle, share, x, y].map(|x| x as f32)
            };
            c.sets[j] = set(number, born_s, 1.0);
            if grown < 1.0 {
                c.sets[CONES] = set(number, born_s, grown);
                c.sets[j] = set(number - 1.0, set_born_s(j, number - 1.0), 1.0 - grown);
                c.growing = j as u32;
            }
            c.looks[j] = [clear, level, tiles.log2(), 0.0].map(|x| x as f32);
        }
        let [.., near, far] = BANDS_M;
        let ends = [BANDS_M[0], BANDS_M[1], near, 0.5 * (near + far), far];
        c.stretches = std::array::from_fn(|i| [ends[i] as f32, ends[i + 1] as f32, 0.0, 0.0]);
        c
    }

    /// Adapts the cones to the drops that are drawn one by one: the share `drops` of all drops nearer than
    /// `distance_m`. The cones leave these drops out. All optical depths are multiplied by `share`. If all drops up to
    /// `distance_m` are drawn one by one and this distance lies inside a band, the band's cone begins there.
    pub fn behind(mut self, (distance_m, drops): (f64, f64), share: f64) -> Self {
        for (j, band) in self.bands.iter_mut().enumerate() {
            let (near, far) = (BANDS_M[j], BANDS_M[j + 1]);
            let nearer = ((distance_m - near) / (far - near)).clamp(0.0, 1.0);
            let left = 1.0 - nearer * drops;
            band[3] *= (share * if left > 0.01 { left } else { 0.0 }) as f32;
            if (0.01..0.99).contains(&nearer) && drops >= 1.0 {
                band[0] = distance_m as f32;
                self.stretches[j][0] = distance_m as f32;
                let cubes = [distance_m, near, far].map(|r| r.powi(3));
                self.shapes[j][2] *= ((cubes[2] - cubes[0]) / (cubes[2] - cubes[1])) as f32;
            }
        }
        self.first = self.bands.iter().position(|b| b[3] > 0.0).unwrap_or(CONES) as u32;
        self
    }

    /// Creates a block of zeros, with which nothing is drawn.
    fn zero() -> Self {
        bytemuck::Zeroable::zeroed()
    }
}

/// Streak of the texture.
struct Streak {
    /// Middle, texels.
    middle: DVec2,
    /// Half of its length, texels.
    half_length: f64,
    /// Optical depth relative to other streaks.
    weight: f64,
    /// Channel of the texture, 0 to 3.
    channel: usize,
}

/// Returns streaks for the drops above 0.5 mm in one of the outer bands, in rain of 10 mm/h.
fn streaks() -> Vec<Streak> {
    let sizes = DropSizes::of_rain(10.0, 1.0);
    let table = sizes.diameter_table(Weight::Number, 0.5);
    let share = |r: u32| f64::from(r) / 4_294_967_296.0;
    let mut all = Vec::new();
    for (channel, count) in STREAKS.into_iter().enumerate() {
        for i in 0..count {
            let [a, b] = [0, 1].map(|k| random3([0x5712_ea45, k << 8 | channel as u32, i]).map(share));
            let d = super::sizes::table_diameter_mm(&table, a[2]);
            // Distance of the drop, in units of the distance of the band's middle.
            let distance = libm::cbrt(1.0 + (FURTHER.powi(3) - 1.0) * b[0]) / (0.5 * (1.0 + FURTHER));
            all.push(Streak {
                middle: DVec2::new(a[0], a[1]) * f64::from(SIDE),
                half_length: 0.5 * LENGTH * sizes.speed_m_s(d) / 6.0 / distance,
                weight: d * d / (distance * distance),
                channel,
            });
        }
    }
    all
}

/// Returns the texture with all its mip levels, by rows. A texel has the optical depth of each channel, scaled so that
/// the mean of a channel over the texture is the channel's share of all streaks.
pub(crate) fn texture() -> Vec<Vec<[f16; 4]>> {
    let n = SIDE as i64;
    let mut level = vec![[0.0f64; 4]; (n * n) as usize];
    for s in streaks() {
        let reach = s.half_length + 0.5;
        let (x0, y0) = ((s.middle.x - HALF_WIDTH).floor() as i64, (s.middle.y - reach).floor() as i64);
        let mut texels = Vec::new();
        for y in y0..=(s.middle.y + reach).ceil() as i64 {
            for x in x0..=(s.middle.x + HALF_WIDTH).ceil() as i64 {
                let across = (x as f64 + 0.5 - s.middle.x) / HALF_WIDTH;
                let along = (reach - (y as f64 + 0.5 - s.middle.y).abs()).clamp(0.0, 1.0);
                texels.push((x, y, (1.0 - across * across).max(0.0) * along));
            }
        }
        let sum: f64 = texels.iter().map(|t| t.2).sum();
        for (x, y, w) in texels.into_iter().filter(|_| sum > 0.0) {
            level[(y.rem_euclid(n) * n + x.rem_euclid(n)) as usize][s.channel] += s.weight * w / sum;
        }
    }
    let total = f64::from(STREAKS.iter().sum::<u32>());
    for (k, count) in STREAKS.into_iter().enumerate() {
        let mean = level.iter().map(|t| t[k]).sum::<f64>() / level.len() as f64;
        level.iter_mut().for_each(|t| t[k] *= f64::from(count) / total / mean);
    }
    let mut levels = Vec::new();
    let mut side = SIDE as usize;
    loop {
        levels.push(level.iter().map(|t| t.map(f16::from_f64)).collect());
        if side == 1 {
            return levels;
        }
        side /= 2;
        let finer = |x: usize, y: usize| level[y * 2 * side + x];
        level = (0..side * side)
            .map(|i| {
                let (x, y) = (2 * (i % side), 2 * (i / side));
                let four = [finer(x, y), finer(x + 1, y), finer(x, y + 1), finer(x + 1, y + 1)];
                std::array::from_fn(|k| 0.25 * four.iter().map(|t| t[k]).sum::<f64>())
            })
            .collect();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drops_and_cones_leave_no_gap_and_hide_nothing_twice() {
        let bands = std::array::from_fn(|j| {
            let (near, far) = (BANDS_M[j] as f32, BANDS_M[j + 1] as f32);
            [near, far, 0.0, far - near]
        });
        let whole = ConeUniform { bands, stretches: [[1.0, 2.0, 0.0, 0.0]; STRETCHES], ..ConeUniform::zero() };
        for (shells, drops) in [(0, 0.0), (1, 1.0), (1, 0.4), (4, 1.0)] {
            let reach = super::super::lattice::hidden_m(shells);
            let cones = whole.behind((reach, drops), 1.0);
            let depth: f64 = cones.bands.iter().map(|b| f64::from(b[3])).sum();
            // Depth of the drops from the distance at which they fade in, and of the cones beyond.
            let all = depth + drops * (reach - BANDS_M[0]).max(0.0);
            assert!((all / (BANDS_M[CONES] - BANDS_M[0]) - 1.0).abs() < 1e-6, "{shells} {drops}: {all}");
            let begins = cones.bands.iter().filter(|b| b[3] > 0.0).map(|b| f64::from(b[0])).fold(f64::MAX, f64::min);
            let expected = if drops < 1.0 { BANDS_M[0] } else { reach };
            assert!((begins - expected).abs() < 1e-6, "{shells} {drops}: cones begin at {begins}");
        }
    }

    #[test]
    fn at_most_one_set_of_streaks_grows_at_a_time_and_none_jumps() {
        let mut growing = 0;
        for i in 0..160_000 {
            let time_s = 1e5 + f64::from(i) * 1e-4;
            let sets: [_; CONES] = std::array::from_fn(|j| set_at(j, time_s));
            let grow = sets.iter().filter(|set| set.2 < 1.0).count();
            growing += grow;
            assert!(grow <= 1, "{time_s}: {sets:?}");
            for (j, (number, born_s, grown)) in sets.into_iter().enumerate() {
                let before = set_at(j, time_s - 1e-4);
                assert!(number - before.0 <= 1.0 && born_s <= time_s + 1e-9, "{time_s}: {before:?} {number}");
                let step = if number == before.0 { grown - before.2 } else { grown };
                assert!((0.0..0.006).contains(&step), "{time_s}: cone {j} grows by {step}");
            }
        }
        // There are three cones, each growing for a tenth of the time.
        assert!((growing as f64 / 160_000.0 - 0.3).abs() < 0.01, "{growing}");
    }
}
