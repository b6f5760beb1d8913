//! Schedule of a storm: the times, places and strokes of its flashes.

use std::f64::consts::PI;

use glam::DVec2;

pub use super::flash::{Flash, FlashKind, MOST_STROKES, Stroke};
use super::trigger::FlashTrigger;
use crate::{
    chance::RandomStream,
    error::{Result, check_range},
};

/// Number of candidates a minute: the highest rate of one storm.
pub const MOST_PER_MINUTE: f64 = 60.0;
/// Length of a window of time whose candidates are drawn together, s.
const WINDOW_S: f64 = 10.0;
/// Share of flashes that strike the ground at middle latitudes: one in four (Prentice and Mackerras 1977).
const TO_GROUND: f64 = 0.25;
/// Share of ground flashes with one stroke (Rakov and Uman 2003, table 1.1).
const SINGLE: f64 = 0.2;
/// Probability of another stroke after the second and each later one, chosen so that the mean number is 3.5.
const ANOTHER: f64 = 0.68;
/// Pause between strokes: geometric mean, s, and standard deviation of its logarithm (Rakov and Uman 2003, table 1.1).
const PAUSE_S: (f64, f64) = (0.06, 0.55);
/// Peak current of first strokes: median, kA, and standard deviation of its logarithm (Berger et al. 1975).
const FIRST_KA: (f64, f64) = (30.0, 0.61);
/// Peak current of later strokes: median, kA, and standard deviation of its logarithm (Berger et al. 1975).
const LATER_KA: (f64, f64) = (12.0, 0.61);

/// A storm. It flashes at the constant rate `per_minute`, or at a rate given to [`Self::visit`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Storm {
    /// Seed of its flashes.
    pub seed: u64,
    /// Flashes a minute, [0, 60].
    pub per_minute: f64,
    /// Middle of the storm, m east and north.
    pub middle_m: DVec2,
    /// Distance from the middle within which two thirds of the flashes start, m, [0, 1e5].
    pub radius_m: f64,
}

impl Storm {
    /// Checks the ranges; an error names the field.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`].
    pub fn validate(&self) -> Result<()> {
        check_range("lightning.per_minute", self.per_minute, 0.0, MOST_PER_MINUTE, "1/min")?;
        check_range("lightning.radius_m", self.radius_m, 0.0, 1e5, "m")
    }

    /// Returns the storm's flashes from `from_s` until `until_s`, in order of time.
    pub fn flashes(&self, from_s: f64, until_s: f64) -> Vec<Flash> {
        let mut out = Vec::new();
        self.visit(from_s, until_s, |_| self.per_minute, |flash| out.push(*flash));
        out.sort_by(|a, b| a.time_s.total_cmp(&b.time_s));
        out
    }

    /// Calls `see` with each flash from `from_s` until `until_s`, window after window. `rate` is the rate at a time,
    /// flashes a minute. No memory is allocated.
    pub fn visit(&self, from_s: f64, until_s: f64, rate: impl Fn(f64) -> f64, mut see: impl FnMut(&Flash)) {
        let (first, last) = ((from_s / WINDOW_S).floor() as i64, (until_s / WINDOW_S).ceil() as i64);
        for window in first..last {
            let mut chance = RandomStream::new(self.seed, window as u64);
            for k in 0..candidates(&mut chance) {
                let time_s = (window as f64 + chance.even()) * WINDOW_S;
                let number = chance.even();
                if time_s >= from_s && time_s < until_s && number < rate(time_s) / MOST_PER_MINUTE {
                    see(&self.flash((window as u64).wrapping_mul(4096).wrapping_add(k), time_s));
                }
            }
        }
    }

    /// Returns a flash triggered by a host. Properties that the trigger leaves open are random.
    pub fn triggered(seed: u64, trigger: &FlashTrigger, place_m: DVec2) -> Flash {
        let storm = Self { seed: seed ^ 0x7219_6765, per_minute: 0.0, middle_m: place_m, radius_m: 0.0 };
        let at = trigger.time_s.to_bits() ^ place_m.x.to_bits().rotate_left(21) ^ place_m.y.to_bits().rotate_left(42);
        let mut flash = storm.flash(at, trigger.time_s);
        flash.kind = trigger.kind;
        if let Some(count) = trigger.strokes {
            flash.count = (count as usize).clamp(1, MOST_STROKES);
        }
        if let Some(peak_ka) = trigger.peak_ka {
            let scale = peak_ka / flash.peak_ka().max(1e-9);
            flash.strokes.iter_mut().for_each(|s| s.peak_ka *= scale);
        }
        flash
    }

    /// Returns the flash with this number at a time, with random properties.
    fn flash(&self, number: u64, time_s: f64) -> Flash {
        let mut chance = RandomStream::new(self.seed ^ 0x5bd1_e995, number);
        let kind = if chance.even() < TO_GROUND { FlashKind::ToGround } else { FlashKind::InCloud };
        let (distance, azimuth) = (self.radius_m * chance.normal(), PI * chance.even());
        let mut flash = Flash {
            // The storm's seed makes flashes of two storms differ.
            id: number ^ self.seed.wrapping_mul(0x9e37_79b9_7f4a_7c15),
            time_s,
            kind,
            place_m: self.middle_m + DVec2::new(libm::cos(azimuth), libm::sin(azimuth)) * distance,
            strokes: [Stroke::default(); MOST_STROKES],
            count: strokes(&mut chance),
        };
        // All strokes are filled in, because a host may ask for more than the random count.
        let mut after_s = 0.0;
        for i in 0..MOST_STROKES {
            let (median, spread) = if i == 0 { FIRST_KA } else { LATER_KA };
            flash.strokes[i] = Stroke { after_s, peak_ka: median * libm::exp(spread * chance.normal()) };
            after_s += PAUSE_S.0 * libm::exp(PAUSE_S.1 * chance.normal());
        }
        flash
    }
}

/// Returns the number of candidates in a window, with a Poisson distribution (by multiplication; Knuth 1969).
fn candidates(chance: &mut RandomStream) -> u64 {
    let least = libm::exp(-MOST_PER_MINUTE / 60.0 * WINDOW_S);
    let (mut product, mut count) = (chance.even(), 0);
    while product > least {
        product *= chance.even();
        count += 1;
    }
    count
}

/// Returns a random number of strokes.
fn strokes(chance: &mut RandomStream) -> usize {
    if chance.even() < SINGLE {
        return 1;
    }
    let mut count = 2;
    while count < MOST_STROKES && chance.even() < ANOTHER {
        count += 1;
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    fn storm(per_minute: f64) -> Storm {
        Storm { seed: 11, per_minute, middle_m: DVec2::new(2000.0, -500.0), radius_m: 3000.0 }
    }

    /// Counts over minutes have a Poisson distribution: their variance is their mean.
    #[test]
    fn flashes_come_by_chance_at_the_rate_asked_for() {
        for rate in [0.5, 6.0, 40.0] {
            let flashes = storm(rate).flashes(-3600.0, 3600.0 * 99.0);
            let minutes = 6000;
            let mut counts = vec![0.0; minutes];
            for f in &flashes {
                counts[((f.time_s + 3600.0) / 60.0) as usize] += 1.0;
            }
            let mean = counts.iter().sum::<f64>() / minutes as f64;
            let variance = counts.iter().map(|c| (c - mean) * (c - mean)).sum::<f64>() / minutes as f64;
            assert!((mean / rate - 1.0).abs() < 4.0 / (rate * minutes as f64).sqrt(), "{rate}: {mean}");
            assert!((variance / mean - 1.0).abs() < 0.08, "{rate}: {variance}");
        }
    }

    #[test]
    fn strokes_pauses_and_currents_are_those_of_the_literature() {
        let flashes = storm(60.0).flashes(0.0, 36_000.0);
        let n = flashes.len() as f64;
        let ground = flashes.iter().filter(|f| f.kind == FlashKind::ToGround).count() as f64 / n;
        let strokes = flashes.iter().map(|f| f.strokes().len()).sum::<usize>() as f64 / n;
        let single = flashes.iter().filter(|f| f.strokes().len() == 1).count() as f64 / n;
        assert!(
            (ground - 0.25).abs() < 0.01 && (3.4..3.6).contains(&strokes) && (single - 0.2).abs() < 0.01,
            "{ground} {strokes} {single}"
        );
        let mut first: Vec<f64> = flashes.iter().map(|f| f.strokes()[0].peak_ka).collect();
        first.sort_by(f64::total_cmp);
        assert!((first[first.len() / 2] - 30.0).abs() < 0.6, "{}", first[first.len() / 2]);
        // Five per cent of first strokes exceed 80 kA (Berger et al. 1975).
        assert!((first[first.len() * 95 / 100] - 80.0).abs() < 5.0, "{}", first[first.len() * 95 / 100]);
        let pauses: Vec<f64> = flashes
            .iter()
            .flat_map(|f| f.strokes().windows(2).map(|s| (s[1].after_s - s[0].after_s).ln()).collect::<Vec<_>>())
            .collect();
        let mean = (pauses.iter().sum::<f64>() / pauses.len() as f64).exp();
        assert!((mean - 0.06).abs() < 0.001, "{mean}");
    }

    #[test]
    fn a_changed_rate_moves_no_flash_and_any_division_of_time_has_the_same() {
        let (few, many) = (storm(3.0).flashes(0.0, 7200.0), storm(20.0).flashes(0.0, 7200.0));
        assert!(few.iter().all(|f| many.contains(f)) && many.len() > few.len());
        let parts: Vec<Flash> =
            (0..72).flat_map(|i| storm(20.0).flashes(f64::from(i) * 100.0, f64::from(i + 1) * 100.0)).collect();
        assert_eq!(parts, many);
        assert!(storm(0.0).flashes(0.0, 1e5).is_empty());
    }

    #[test]
    fn storms_are_checked_by_name() {
        let says = |s: Storm| s.validate().unwrap_err().to_string();
        assert!(says(storm(61.0)).contains("lightning.per_minute"));
        assert!(says(Storm { radius_m: f64::NAN, ..storm(1.0) }).contains("lightning.radius_m"));
    }
}
