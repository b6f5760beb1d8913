//! The way of a flash, and what of it a place sees and hears.
//!
//! # Model
//! A channel wanders about a straight way by halving: the middle of each stretch is moved aside by chance, by a share
//! of the stretch's length, and less in the first two halvings. Of all shares that give a dimension near what
//! photographs show (1.1 to 1.4; Tsonis 1991), the one taken gives 1.15 (tested). From the way of a ground flash 8 to
//! 17 branches leave, each by 20 to 50 degrees from the way and 0.15 to 0.6 of what remains of it long; a third of them
//! branch again. They point down, and none reaches the ground.
//!
//! What stands high draws a ground flash: from a leader of peak current I the last leap is 10 I^0.65 m (Love 1973), and
//! the leader comes down until it is so near to the ground or to something tall; that which it meets first is struck
//! (Armstrong and Whitehead 1968, the electrogeometric model).

use glam::{DVec2, DVec3};

use super::flash::{Flash, FlashKind};
use crate::chance::Chance;

/// Sideways move of a stretch's middle over the stretch's length, one spread.
const WANDERING: f64 = 0.25;
/// Sideways move at the first halvings, over the stretch's length, one spread: a channel wanders less in the large than
/// in the small, for the field that draws it down is even there.
const WANDERING_FIRST: f64 = 0.12;
const FIRST: u32 = 2;
/// Halvings of a channel: 2^9 stretches of some 10 m.
const HALVINGS: u32 = 9;
/// Points of a channel.
pub const POINTS: usize = (1 << HALVINGS) + 1;

/// Something tall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mast {
    /// Its tip, m east, north and up.
    pub tip_m: DVec3,
}

/// Speed of sound in air, m/s (331.3 + 0.606 T).
pub fn sound_m_s(temperature_c: f64) -> f64 {
    331.3 + 0.606 * temperature_c
}

/// Length of a leader's last leap, m, by the peak current that follows (Love 1973).
pub fn leap_m(peak_ka: f64) -> f64 {
    10.0 * libm::pow(peak_ka.max(0.0), 0.65)
}

/// A side channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Branch {
    /// From the channel that it leaves on.
    pub points_m: Vec<DVec3>,
    /// How far down the main channel it left, 0 at the upper end to 1.
    pub leaves_at: f64,
    /// Light of its beginning over that of the main channel there.
    pub strength: f64,
}

/// The way of a flash.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// From its upper end on, m east, north and up.
    pub points_m: Vec<DVec3>,
    /// Branches that leave it.
    pub branches: Vec<Branch>,
}

/// Where a ground flash ends: the tip of the mast that it meets, or the ground at `ground_m` below its start.
pub fn struck(flash: &Flash, masts: &[Mast], ground_m: f64) -> DVec3 {
    let leap = leap_m(flash.strokes()[0].peak_ka);
    let below = flash.place_m;
    // The height at which the leader is a leap away from the ground, and from each mast.
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
    /// Creates the channel of a flash that starts `top_m` high, and ends at `end_m` (ground flashes) or some kilometres
    /// away in the cloud.
    pub fn new(flash: &Flash, top_m: f64, end_m: DVec3) -> Self {
        let mut chance = Chance::new(flash.id, 0xc4a1);
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

    /// All ways: the main one and those that leave it.
    pub fn ways(&self) -> impl Iterator<Item = &[DVec3]> {
        std::iter::once(self.points_m.as_slice()).chain(self.branches.iter().map(|b| b.points_m.as_slice()))
    }

    /// Ends every way where it first meets something: `met` says at which share of a stretch that is. Whether the main
    /// one was cut.
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
        // What left the main way below where it ends now leaves nothing.
        let left = (self.points_m.len() - 1) as f64 / last as f64;
        if was_cut {
            self.branches.retain(|b| b.leaves_at < left);
        }
        self.branches.iter_mut().for_each(|b| {
            cut(&mut b.points_m);
        });
        was_cut
    }

    /// Its lower end, or its far one in the cloud.
    pub fn end_m(&self) -> DVec3 {
        self.points_m[self.points_m.len() - 1]
    }

    /// Length of the main way, m.
    pub fn length_m(&self) -> f64 {
        self.points_m.windows(2).map(|p| (p[1] - p[0]).length()).sum()
    }

    /// Distance of its point nearest to a place, m.
    pub fn distance_m(&self, place_m: DVec3) -> f64 {
        let to_stretch = |ends: &[DVec3]| {
            let (a, way) = (ends[0], ends[1] - ends[0]);
            let t = ((place_m - a).dot(way) / way.length_squared().max(1e-12)).clamp(0.0, 1.0);
            (a + way * t - place_m).length()
        };
        self.ways().flat_map(|way| way.windows(2)).map(to_stretch).fold(f64::INFINITY, f64::min)
    }

    /// Time from the flash to the beginning of its thunder at a place, s.
    pub fn thunder_delay_s(&self, place_m: DVec3, temperature_c: f64) -> f64 {
        self.distance_m(place_m) / sound_m_s(temperature_c)
    }
}

/// A way between two points by so many halvings that goes nowhere below `lowest_m`.
fn wander(chance: &mut Chance, (start, end): (DVec3, DVec3), halvings: u32, lowest_m: f64) -> Vec<DVec3> {
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

/// Branches of the first order, the fewest and how many more there may be.
const BRANCHES: (f64, f64) = (8.0, 10.0);
/// Their angles with the way that they leave, degrees.
const LEAVES_DEG: (f64, f64) = (20.0, 50.0);
/// Their lengths over what remains of the way.
const LENGTHS: (f64, f64) = (0.15, 0.6);
/// Share of branches that branch again.
const AGAIN: f64 = 0.33;
/// Light of a branch over that of what it leaves: photographs show branches of first strokes some two to four times
/// fainter.
const FAINTER: f64 = 0.35;
/// Least height of a branch's end over the end of the main way, m.
const CLEAR_M: f64 = 30.0;

fn branches(chance: &mut Chance, main: &[DVec3]) -> Vec<Branch> {
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

/// One branch from a point of a way that leads on along `way`.
fn branch(
    chance: &mut Chance,
    (from, way): (DVec3, DVec3),
    remains_m: f64,
    lowest_m: f64,
    halvings: u32,
) -> Vec<DVec3> {
    let share = |(low, high): (f64, f64), x: f64| low + (high - low) * x;
    let angle = share(LEAVES_DEG, chance.even()).to_radians();
    let turned = way.normalize_or(DVec3::NEG_Z) * libm::cos(angle) + aside(chance, way) * libm::sin(angle);
    // Downwards, however the way went.
    let turned = DVec3::new(turned.x, turned.y, turned.z.min(-0.15)).normalize();
    let mut end = from + turned * (share(LENGTHS, chance.even()) * remains_m);
    end.z = end.z.max(lowest_m.min(from.z));
    wander(chance, (from, end), halvings, lowest_m.min(from.z))
}

/// A unit vector across `way`, any.
fn aside(chance: &mut Chance, way: DVec3) -> DVec3 {
    let (a, b) = way.normalize_or(DVec3::Z).any_orthonormal_pair();
    let turn = 2.0 * std::f64::consts::PI * chance.even();
    a * libm::cos(turn) + b * libm::sin(turn)
}

#[cfg(test)]
mod tests {
    use super::super::schedule::Storm;
    use super::*;

    /// Photographs of ground flashes: branches point down, and end above the ground.
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
    fn what_stands_in_the_way_ends_it() {
        let flash = &ground_flashes(2000.0, 1.0)[0];
        let whole = Channel::new(flash, 5000.0, struck(flash, &[], 0.0));
        let mut channel = whole.clone();
        // A roof over everything, 1000 m high.
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

    /// A mast of 50 m is struck at least ten times as often as ground of the area over which it draws lightning down
    /// would be expected to be at its foot: a circle of 10 m about it against rings of the same area beside it.
    #[test]
    fn a_mast_is_struck_far_more_often_than_the_ground_beside_it() {
        let mast = Mast { tip_m: DVec3::new(0.0, 0.0, 50.0) };
        let (mut at_mast, mut beside) = (0, 0);
        for flash in ground_flashes(400.0, 40.0) {
            let end = struck(&flash, &[mast], 0.0);
            at_mast += usize::from(end == mast.tip_m);
            // Forty circles of 10 m in a ring where the mast no longer reaches.
            let off = end.truncate().length();
            beside += usize::from(end != mast.tip_m && (300.0..306.6).contains(&off));
        }
        let circles = (306.6f64.powi(2) - 300.0f64.powi(2)) / 100.0;
        let one = beside as f64 / circles;
        println!("mast {at_mast}, a circle of the same 10 m beside it {one:.1}");
        assert!(at_mast as f64 > 10.0 * one && beside > 20);
    }

    /// Length over rulers of the straight way's eighth and sixty-fourth: the dimension is 1 + ln(ratio) / ln 8.
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
