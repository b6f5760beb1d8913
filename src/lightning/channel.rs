//! Path of a flash, its distance from a place, and the delay of its thunder there.
//!
//! # Model
//! A channel wanders around a straight line by midpoint displacement: the middle of each interval is moved sideways at
//! random, by a share of the interval's length. This share is smaller in the first two halvings. Photographs show a
//! fractal dimension of 1.1 to 1.4 (Tsonis 1991); the chosen share gives 1.15 (tested). From the path of a ground flash
//! 8 to 17 branches leave, each at 20 to 50 degrees to the straight way to the path's end, with 0.15 to 0.6 of the
//! length of this way. A third of them branch again. All branches point down, and none reaches the ground.
//!
//! Tall objects attract a ground flash. The last leap of a leader with peak current I, in kA, has the length L = 10
//! I^0.65 m (Love 1973). The leader comes down until it is within that distance of the ground or of something tall, and
//! strikes whichever it reaches first (Armstrong and Whitehead 1968, the electrogeometric model).

use glam::{DVec2, DVec3};

use super::flash::{Flash, FlashKind};
use crate::chance::RandomStream;

/// Ratio of the standard deviation of the sideways move of an interval's middle to the interval's length.
const WANDERING: f64 = 0.25;
/// Value of [`WANDERING`] for the first [`FIRST`] halvings. The electric field that drives a channel is even on a large
/// scale, so the channel wanders less there.
const WANDERING_FIRST: f64 = 0.12;
/// Number of halvings with [`WANDERING_FIRST`].
const FIRST: u32 = 2;
/// Number of halvings of a channel: 2^9 intervals of some 10 m.
const HALVINGS: u32 = 9;
/// Number of points of a channel.
pub const POINTS: usize = (1 << HALVINGS) + 1;

/// A tall object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mast {
    /// Tip: m east and north on the map, and the altitude, m.
    pub tip_m: DVec3,
}

/// Returns the speed of sound in air, c = 331.3 + 0.606 T, m/s, with T in degrees Celsius.
pub fn sound_m_s(temperature_c: f64) -> f64 {
    331.3 + 0.606 * temperature_c
}

/// Returns the length of a leader's last leap, m, for the peak current, kA, of the stroke that follows (Love 1973).
pub fn leap_m(peak_ka: f64) -> f64 {
    10.0 * libm::pow(peak_ka.max(0.0), 0.65)
}

/// A side channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Branch {
    /// Points from the place where the branch leaves its path to the branch's own end.
    pub points_m: Vec<DVec3>,
    /// Position on the main channel where the branch leaves, 0 at the upper end to 1 at the lower end. A branch of a
    /// branch has the position of that branch.
    pub leaves_at: f64,
    /// Ratio of the light at its start to that of the main channel there.
    pub strength: f64,
}

/// Path of a flash.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Points from its upper end on, m east, north and up.
    pub points_m: Vec<DVec3>,
    /// Branches that leave it.
    pub branches: Vec<Branch>,
}

/// Returns the end of a ground flash: the tip of the mast that the flash strikes, or the point of the ground at the
/// flash's place, at the height `ground_m`.
pub fn struck(flash: &Flash, masts: &[Mast], ground_m: f64) -> DVec3 {
    let leap = leap_m(flash.strokes()[0].peak_ka);
    let below = flash.place_m;
    // Height at which the leader is a leap away from a mast's tip. For the ground this height is `ground_m` + leap.
    let met = |mast: &Mast| {
        let aside = (mast.tip_m.truncate() - below).length();
        (aside <= leap).then(|| mast.tip_m.z + (leap * leap - aside * aside).sqrt())
    };
    let first = masts.iter().filter_map(|m| Some((met(m)?, m))).max_by(|a, b| a.0.total_cmp(&b.0));
    match first {
        Some((height, mast)) if height > ground_m + leap => mast.tip_m,
        _ => below.extend(ground_m),
    }
}

impl Channel {
    /// Creates the channel of a flash. It starts at the height `top_m`, beside the flash's place by a tenth of the
    /// height above `end_m`. A ground flash ends at `end_m`. A flash in the cloud ends some kilometres away from its
    /// start.
    pub fn new(flash: &Flash, top_m: f64, end_m: DVec3) -> Self {
        let mut chance = RandomStream::new(flash.id, 0xc4a1);
        let start = flash.place_m.extend(top_m) + aside(&mut chance, DVec3::Z) * 0.1 * (top_m - end_m.z);
        let end = match flash.kind {
            FlashKind::ToGround => end_m,
            FlashKind::InCloud => {
                let turn = 2.0 * std::f64::consts::PI * chance.even();
                let level = DVec2::new(libm::cos(turn), libm::sin(turn));
                start + (level * (0.5 + chance.even()) * 3000.0).extend(400.0 * chance.normal())
            }
        };
        let lowest_m = end_m.z.min(end.z);
        let points_m = wander(&mut chance, (start, end), HALVINGS, lowest_m);
        let branches = match flash.kind {
            FlashKind::ToGround => branches(&mut chance, &points_m),
            FlashKind::InCloud => Vec::new(),
        };
        Self { points_m, branches }
    }

    /// Returns the points of all its paths: the main one and the branches.
    pub fn ways(&self) -> impl Iterator<Item = &[DVec3]> {
        std::iter::once(self.points_m.as_slice()).chain(self.branches.iter().map(|b| b.points_m.as_slice()))
    }

    /// Ends every path where it first meets an object. `met` takes the two ends of an interval and returns the position
    /// between them, 0 to 1, at which the interval meets an object; `None` if it meets none. Returns whether the main
    /// path was cut.
    pub fn cut(&mut self, met: impl Fn(DVec3, DVec3) -> Option<f64>) -> bool {
        let cut = |points: &mut Vec<DVec3>| {
            let hit = points.windows(2).enumerate().find_map(|(i, p)| Some((i, p[0].lerp(p[1], met(p[0], p[1])?))));
            if let Some((i, at)) = hit {
                points.truncate(i + 1);
                points.push(at);
            }
            hit.is_some()
        };
        let last = self.points_m.len() - 1;
        let was_cut = cut(&mut self.points_m);
        // Branches that leave below the new end of the main path are removed.
        let left = (self.points_m.len() - 1) as f64 / last as f64;
        if was_cut {
            self.branches.retain(|b| b.leaves_at < left);
        }
        self.branches.iter_mut().for_each(|b| {
            cut(&mut b.points_m);
        });
        was_cut
    }

    /// Returns the channel's lower end, or its far end in the cloud.
    pub fn end_m(&self) -> DVec3 {
        self.points_m[self.points_m.len() - 1]
    }

    /// Returns the length of the main path, m.
    pub fn length_m(&self) -> f64 {
        self.points_m.windows(2).map(|p| (p[1] - p[0]).length()).sum()
    }

    /// Returns the distance from a place to the nearest point of the channel, m.
    pub fn distance_m(&self, place_m: DVec3) -> f64 {
        let to_stretch = |ends: &[DVec3]| {
            let (a, way) = (ends[0], ends[1] - ends[0]);
            let t = ((place_m - a).dot(way) / way.length_squared().max(1e-12)).clamp(0.0, 1.0);
            (a + way * t - place_m).length()
        };
        self.ways().flat_map(|way| way.windows(2)).map(to_stretch).fold(f64::INFINITY, f64::min)
    }

    /// Returns the time from the flash to the start of its thunder at a place, s.
    pub fn thunder_delay_s(&self, place_m: DVec3, temperature_c: f64) -> f64 {
        self.distance_m(place_m) / sound_m_s(temperature_c)
    }
}

/// Returns a path between two points, made by `halvings` halvings. The path does not go below `lowest_m`.
fn wander(chance: &mut RandomStream, (start, end): (DVec3, DVec3), halvings: u32, lowest_m: f64) -> Vec<DVec3> {
    let last = 1usize << halvings;
    let mut points_m = vec![DVec3::ZERO; last + 1];
    (points_m[0], points_m[last]) = (start, end);
    let mut stretch = last;
    while stretch > 1 {
        for from in (0..last).step_by(stretch) {
            let (a, b) = (points_m[from], points_m[from + stretch]);
            let away = aside(chance, b - a);
            let share = if stretch > last >> FIRST { WANDERING_FIRST } else { WANDERING };
            let mut middle = 0.5 * (a + b) + away * (share * (b - a).length() * chance.normal());
            if middle.z < lowest_m {
                middle.z = 0.5 * (a.z + b.z);
            }
            points_m[from + stretch / 2] = middle;
        }
        stretch /= 2;
    }
    points_m
}

/// Number of branches of the first order: the least value, and the length of the range above it. A random value of
/// this range is rounded down.
const BRANCHES: (f64, f64) = (8.0, 10.0);
/// Range of the angles of branches to the direction of the path that they leave, degrees.
const LEAVES_DEG: (f64, f64) = (20.0, 50.0);
/// Range of the ratio of a branch's length to the straight distance from its start to the end of the main path. For a
/// branch of a branch it is the ratio to the straight length of that branch.
const LENGTHS: (f64, f64) = (0.15, 0.6);
/// Share of branches that branch again.
const AGAIN: f64 = 0.33;
/// Ratio of a branch's light to that of the path it leaves. Photographs show branches of first strokes some two to four
/// times fainter.
const FAINTER: f64 = 0.35;
/// Least height of a branch's end above the end of the main path, m.
const CLEAR_M: f64 = 30.0;

/// Creates the branches of a ground flash along its main path.
fn branches(chance: &mut RandomStream, main: &[DVec3]) -> Vec<Branch> {
    let end = main[main.len() - 1];
    let count = (BRANCHES.0 + BRANCHES.1 * chance.even()) as usize;
    let mut out = Vec::with_capacity(2 * count);
    for _ in 0..count {
        let leaves_at = 0.1 + 0.8 * chance.even();
        let from = (leaves_at * (main.len() - 1) as f64) as usize;
        let remains = (end - main[from]).length();
        let points_m = branch(chance, (main[from], end - main[from]), remains, end.z + CLEAR_M, HALVINGS - 3);
        let again = (chance.even() < AGAIN).then(|| {
            let at = (points_m.len() - 1) / 3 + (chance.even() * (points_m.len() / 3) as f64) as usize;
            let way = points_m[points_m.len() - 1] - points_m[0];
            let points_m = branch(chance, (points_m[at], way), way.length(), end.z + CLEAR_M, HALVINGS - 4);
            Branch { points_m, leaves_at, strength: FAINTER * FAINTER }
        });
        out.push(Branch { points_m, leaves_at, strength: FAINTER });
        out.extend(again);
    }
    out
}

/// Creates a branch that leaves a path at `from`. `way` is the direction of the path.
fn branch(
    chance: &mut RandomStream,
    (from, way): (DVec3, DVec3),
    remains_m: f64,
    lowest_m: f64,
    halvings: u32,
) -> Vec<DVec3> {
    let share = |(low, high): (f64, f64), x: f64| low + (high - low) * x;
    let angle = share(LEAVES_DEG, chance.even()).to_radians();
    let turned = way.normalize_or(DVec3::NEG_Z) * libm::cos(angle) + aside(chance, way) * libm::sin(angle);
    // Branches point down, whatever the direction of the path.
    let turned = DVec3::new(turned.x, turned.y, turned.z.min(-0.15)).normalize();
    let mut end = from + turned * (share(LENGTHS, chance.even()) * remains_m);
    end.z = end.z.max(lowest_m.min(from.z));
    wander(chance, (from, end), halvings, lowest_m.min(from.z))
}

/// Returns a random unit vector at right angles to `way`.
fn aside(chance: &mut RandomStream, way: DVec3) -> DVec3 {
    let (a, b) = way.normalize_or(DVec3::Z).any_orthonormal_pair();
    let turn = 2.0 * std::f64::consts::PI * chance.even();
    a * libm::cos(turn) + b * libm::sin(turn)
}

#[cfg(test)]
mod tests {
    use super::super::schedule::Storm;
    use super::*;

    /// As on photographs of ground flashes, branches point down and end above the ground.
    #[test]
    fn branches_lead_down_and_end_above_the_ground() {
        for flash in &ground_flashes(2000.0, 1.0)[..20] {
            let channel = Channel::new(flash, 5000.0, struck(flash, &[], 300.0));
            assert!((8..=34).contains(&channel.branches.len()), "{}", channel.branches.len());
            for b in &channel.branches {
                let (first, last) = (b.points_m[0], b.points_m[b.points_m.len() - 1]);
                assert!(last.z < first.z && b.points_m.iter().all(|p| p.z >= 300.0 && p.is_finite()));
                assert!(channel.distance_m(first) < 1e-6 && last.z >= 330.0f64.min(first.z));
            }
        }
    }

    #[test]
    fn an_obstacle_ends_a_channel() {
        let flash = &ground_flashes(2000.0, 1.0)[0];
        let whole = Channel::new(flash, 5000.0, struck(flash, &[], 0.0));
        let mut channel = whole.clone();
        // A roof above everything, 1000 m high.
        let roof = |a: DVec3, b: DVec3| (a.z > 1000.0 && b.z <= 1000.0).then(|| (a.z - 1000.0) / (a.z - b.z));
        assert!(channel.cut(roof));
        assert!((channel.end_m().z - 1000.0).abs() < 1e-6 && channel.length_m() < whole.length_m());
        assert!(channel.ways().flatten().all(|p| p.z >= 1000.0 - 1e-6), "nothing below the roof");
        assert!(channel.branches.len() <= whole.branches.len());
    }

    fn ground_flashes(radius_m: f64, hours: f64) -> Vec<Flash> {
        let storm = Storm { seed: 5, per_minute: 60.0, middle_m: DVec2::ZERO, radius_m };
        storm.flashes(0.0, 3600.0 * hours).into_iter().filter(|f| f.kind == FlashKind::ToGround).collect()
    }

    #[test]
    fn thunder_comes_from_the_nearest_point_at_the_speed_of_sound() {
        let flash = &ground_flashes(2000.0, 1.0)[0];
        let channel = Channel::new(flash, 5000.0, struck(flash, &[], 300.0));
        let place = DVec3::new(4000.0, -1000.0, 302.0);
        let mut nearest = f64::INFINITY;
        for ends in channel.ways().flat_map(|way| way.windows(2)) {
            for i in 0..=1000 {
                nearest = nearest.min((ends[0].lerp(ends[1], f64::from(i) / 1000.0) - place).length());
            }
        }
        for t in [-10.0, 20.0] {
            let delay = channel.thunder_delay_s(place, t);
            assert!((delay - nearest / (331.3 + 0.606 * t)).abs() < 1e-3, "{delay}");
        }
        assert_eq!(channel.points_m[POINTS - 1].z, 300.0);
    }

    /// A mast of 50 m is struck at least ten times as often as ground of the same area. The area of the mast is a
    /// circle of 10 m around it. The area of the ground is a ring away from the mast, as large as forty such circles.
    #[test]
    fn a_mast_is_struck_far_more_often_than_the_ground_beside_it() {
        let mast = Mast { tip_m: DVec3::new(0.0, 0.0, 50.0) };
        let (mut at_mast, mut beside) = (0, 0);
        for flash in ground_flashes(400.0, 40.0) {
            let end = struck(&flash, &[mast], 0.0);
            at_mast += usize::from(end == mast.tip_m);
            // A ring with the area of forty circles of 10 m, out of the mast's reach.
            let off = end.truncate().length();
            beside += usize::from(end != mast.tip_m && (300.0..306.6).contains(&off));
        }
        let circles = (306.6f64.powi(2) - 300.0f64.powi(2)) / 100.0;
        let one = beside as f64 / circles;
        println!("mast {at_mast}, a circle of the same 10 m beside it {one:.1}");
        assert!(at_mast as f64 > 10.0 * one && beside > 20);
    }

    /// The length is measured with rulers of 2 and of 16 intervals. The dimension is 1 + ln(ratio) / ln 8.
    #[test]
    fn channels_are_as_rough_as_photographs_show() {
        let flashes = ground_flashes(2000.0, 2.0);
        let mut sum = 0.0;
        for flash in &flashes {
            let channel = Channel::new(flash, 5000.0, struck(flash, &[], 0.0));
            let length = |step: usize| {
                channel
                    .points_m
                    .iter()
                    .step_by(step)
                    .collect::<Vec<_>>()
                    .windows(2)
                    .map(|p| (*p[1] - *p[0]).length())
                    .sum::<f64>()
            };
            sum += 1.0 + (length(2) / length(16)).ln() / 8f64.ln();
        }
        let dimension = sum / flashes.len() as f64;
        println!("dimension {dimension:.3}");
        assert!((1.1..1.4).contains(&dimension), "{dimension}");
    }
}
