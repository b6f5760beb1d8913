//! Patterns of uneven layers: patches of fog, and curtains of rain. Both are sums of waves whose mean along a ray is a
//! closed form, so they do not flicker at any distance.

use glam::DVec3;

pub use super::{
    curtains::{CURTAIN_START_M, CURTAIN_WAVES, Curtains},
    model::PATCH_WAVES,
};
use super::{
    curtains::{PATCH_ROW, wave_mean},
    model::FogModel,
};
use crate::{light::sinc, wind::Detour};

/// Returns the mean of the patches' pattern along a ray between `first` and `last` metres: 1 for an even layer.
pub fn patch_mean(m: &FogModel, origin: DVec3, direction: DVec3, first: f64, last: f64) -> f64 {
    let (middle, half) = (0.5 * (first + last), 0.5 * (last - first));
    let mut sum: f64 = m.patch_waves.iter().map(|w| wave_mean(*w, origin, direction, middle, half).0).sum();
    if let Some(detour) = &m.detour {
        sum += detoured(m, detour, (origin, direction), [first, last]);
    }
    // The six patch waves are the differences of the pairs of four unit waves: |their sum|^2 / 4 = 1 + 1/2 sum of
    // cosines, which is never negative. Means with lags can be slightly negative.
    (1.0 + m.patch_amount * 0.5 * sum).max(0.0)
}

/// Number of parts into which a ray is cut where obstacles delay the drifting patches ([`Detour`]); each part has the
/// delay, m, at its middle. This is `DETOUR_PARTS` of `shaders/fog/patterns.wgsl`.
const DETOUR_PARTS: usize = 8;

/// Returns the change of the sum of the waves' means by the lags along a ray.
fn detoured(m: &FogModel, detour: &Detour, (origin, direction): (DVec3, DVec3), [first, last]: [f64; 2]) -> f64 {
    let [enters, leaves] = detour.over(origin, direction);
    let (from, to) = (enters.max(first), leaves.min(last));
    if to <= from {
        return 0.0;
    }
    let half = 0.5 * (to - from) / DETOUR_PARTS as f64;
    let part = |n: usize| {
        let middle = from + (2 * n + 1) as f64 * half;
        let place = origin + direction * middle;
        let lag = detour.lag_m(place).extend(0.0);
        let moved = |(wave, phase): &(DVec3, f64)| {
            let at = phase + wave.dot(place);
            // Waves fade with the length of the whole ray, not of this part.
            let row = PATCH_ROW / (PATCH_ROW + wave.length() * 0.5 * (last - first));
            ((at + wave.dot(lag)).cos() - at.cos()) * sinc(wave.dot(direction) * half) * row
        };
        m.patch_waves.iter().map(moved).sum::<f64>()
    };
    (0..DETOUR_PARTS).map(part).sum::<f64>() * 2.0 * half / (last - first)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    /// Waves of 130 to 900 m, displaced by `shift` metres.
    fn curtains(shift: f64) -> Curtains {
        let wave = |i: usize| {
            let angle = TAU * (i as f64 + 0.3) / (2.0 * CURTAIN_WAVES as f64);
            let k = TAU / (130.0 + 110.0 * ((i * 5) % CURTAIN_WAVES) as f64);
            let k = DVec3::new(k * angle.cos(), k * angle.sin(), 0.15 * k);
            (k, 2.4 * i as f64 + k.x * shift)
        };
        Curtains { amount: 0.245, waves: std::array::from_fn(wave) }
    }

    /// Compares the mean of one wave along a ray with a sum of small steps.
    #[test]
    fn a_wave_has_the_mean_of_its_steps() {
        let wave = curtains(0.0).waves[3];
        for k in 0..60 {
            let (azimuth, up) = (f64::from(k) * 0.31, f64::from(k % 7) * 0.05);
            let d = DVec3::new(azimuth.sin(), azimuth.cos(), up).normalize();
            let (from, to) = (30.0, 60.0 + 25.0 * f64::from(k));
            let n = 4000;
            let at =
                |i: i32| (wave.1 + wave.0.dot(d) * (from + (to - from) * (f64::from(i) + 0.5) / f64::from(n))).cos();
            let want = (0..n).map(at).sum::<f64>() / f64::from(n);
            let half = 0.5 * (to - from);
            let row = PATCH_ROW / (PATCH_ROW + wave.0.length() * half);
            let (got, size) = wave_mean(wave, DVec3::ZERO, d, 0.5 * (from + to), half);
            assert!((got / row - want).abs() < 1e-4 && got.abs() <= size.abs(), "{k}: {got} {want} {size}");
        }
    }

    /// The mean transmittance over all places equals that of even rain at every distance. Without the variance term it
    /// would be higher. Near the eye and far beyond all waves there is no pattern.
    #[test]
    fn curtains_leave_the_mean_transmittance_of_even_rain() {
        let n = 20_000;
        for (range, per_m) in [(100.0, 6e-3), (500.0, 3e-3), (2000.0, 1.5e-3), (5000.0, 6e-4)] {
            let depth = range * per_m;
            let (mut left, mut plain, mut mean, mut square, mut variance) = (0.0, 0.0, 0.0, 0.0, 0.0);
            for i in 0..n {
                let c = curtains(f64::from(i) * 37.0);
                let azimuth = f64::from(i) * 2.399_963;
                let d = DVec3::new(azimuth.sin(), azimuth.cos(), 0.0);
                let (m, v) = c.mean(DVec3::ZERO, d, 0.0, range);
                (mean, square, variance) = (mean + m, square + m * m, variance + v);
                plain += (-(depth * (1.0 + m)).max(0.0)).exp();
                left += (-c.depth(depth, (m, v))).exp();
            }
            let [left, plain, mean, square, variance] = [left, plain, mean, square, variance].map(|v| v / f64::from(n));
            assert!(mean.abs() < 0.01, "{range} m: {mean}");
            assert!((square / variance - 1.0).abs() < 0.05, "{range} m: {square}, said {variance}");
            let (off, without) = (left / (-depth).exp() - 1.0, plain / (-depth).exp() - 1.0);
            println!("{range} m: {off} (without the variance {without}), deviation {}", square.sqrt());
            assert!(off.abs() < 0.02, "{range} m: {off}, without the variance {without}");
        }
        let c = curtains(0.0);
        assert_eq!(c.mean(DVec3::ZERO, DVec3::Y, 0.0, 29.0), (0.0, 0.0));
        assert!(c.mean(DVec3::ZERO, DVec3::Y, 0.0, 1e6).0.abs() < 1e-3);
    }
}
