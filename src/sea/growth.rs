//! Growth of the wind sea by fetch and duration, along the timeline of the weather.
//!
//! The height comes from one law of fetch (Kahma and Calkoen 1992), capped by the fully developed sea (Pierson and
//! Moskowitz 1964). The time that a fetch needs comes from the Coastal Engineering Manual (2002, II-2-35), so that wind
//! that lasts raises the sea as a growing fetch would. When the wind falls, the sea fades as its waves leave the basin.

use glam::DVec2;

use super::{
    dispersion::GRAVITY_M_S2,
    spectrum::{GROWING_GAMMA, developed_peak_rad_s},
};
use crate::{
    numerics::smoothstep,
    weather::{Conditions, fully_developed_wave_height_m, sea_roughness_length_m},
};

/// Coefficients of Kahma and Calkoen (1992), all data: eps = 5.2e-7 z^0.9 and wp U / g = 13.7 z^-0.27, z = g F / U^2.
const ENERGY: f64 = 5.2e-7;
const ENERGY_POWER: f64 = 0.9;
const PEAK: f64 = 13.7;
const PEAK_POWER: f64 = -0.27;
/// Coefficients of the time that a fetch needs: t = 77.23 F^0.67 / (U^0.34 g^0.33) (Coastal Engineering Manual 2002).
const DURATION: f64 = 77.23;
const DURATION_POWER: f64 = 0.67;
/// Size of the region, m, that the waves of an open sea leave after the wind has fallen: that of a low-pressure area.
const OPEN_REGION_M: f64 = 5e5;
/// Range of the peak, rad/s: periods of 31 s to 1 s.
const PEAKS_RAD_S: [f64; 2] = [0.2, 6.0];
/// Wind up to which the sea is taken as calm, m/s.
const CALM_M_S: f64 = 0.5;
/// Times, s, in which the sea's difference from the weather falls to 1/e: for the peak, a given height and the swell,
/// for the mean direction, and for the shortest waves. These times keep every amplitude continuous when the weather
/// changes abruptly.
const PEAK_TIME_S: f64 = 600.0;
const TURNING_TIME_S: f64 = 3600.0;
const SHORT_TIME_S: f64 = 60.0;

/// Returns the variance, m^2, of the sea that a wind raises over a fetch: Kahma and Calkoen (1992), not capped.
pub fn fetch_variance_m2(wind_m_s: f64, fetch_m: f64) -> f64 {
    let u2 = wind_m_s * wind_m_s;
    let z = GRAVITY_M_S2 * fetch_m / u2;
    ENERGY * libm::pow(z, ENERGY_POWER) * u2 * u2 / (GRAVITY_M_S2 * GRAVITY_M_S2)
}

/// Returns the peak, rad/s, of the sea that a wind raises over a fetch (Kahma and Calkoen 1992).
pub fn fetch_peak_rad_s(wind_m_s: f64, fetch_m: f64) -> f64 {
    let z = GRAVITY_M_S2 * fetch_m / (wind_m_s * wind_m_s);
    PEAK * libm::pow(z, PEAK_POWER) * GRAVITY_M_S2 / wind_m_s
}

/// Returns the fetch, m, over which a wind raises a variance: the inverse of [`fetch_variance_m2`].
fn fetch_of_variance_m(wind_m_s: f64, m0_m2: f64) -> f64 {
    let u2 = wind_m_s * wind_m_s;
    let eps = m0_m2 * GRAVITY_M_S2 * GRAVITY_M_S2 / (u2 * u2);
    libm::pow(eps / ENERGY, 1.0 / ENERGY_POWER) * u2 / GRAVITY_M_S2
}

/// Returns the time, s, that a wind needs to raise the sea of a fetch.
pub fn time_of_fetch_s(wind_m_s: f64, fetch_m: f64) -> f64 {
    DURATION * libm::pow(fetch_m, DURATION_POWER) / (libm::pow(wind_m_s, 0.34) * libm::pow(GRAVITY_M_S2, 0.33))
}

/// Returns the variance, m^2, of the fully developed sea of a wind at 10 m (Pierson and Moskowitz 1964).
pub fn developed_variance_m2(wind_m_s: f64) -> f64 {
    if wind_m_s <= 0.0 {
        return 0.0;
    }
    let z0 = sea_roughness_length_m(wind_m_s);
    let quarter = 0.25 * fully_developed_wave_height_m(wind_m_s * libm::log(19.5 / z0) / libm::log(10.0 / z0));
    quarter * quarter
}

/// Returns the variance, m^2, that a wind keeps up: that of the fetch, at most that of the fully developed sea.
/// `fetch_m` is `None` for the open sea.
pub fn kept_variance_m2(wind_m_s: f64, fetch_m: Option<f64>) -> f64 {
    let developed = developed_variance_m2(wind_m_s);
    match fetch_m {
        Some(fetch) if wind_m_s > CALM_M_S => developed.min(fetch_variance_m2(wind_m_s, fetch)),
        _ => developed,
    }
}

/// Returns how far a sea is developed under a wind: 0 up to half of the fully developed variance, rising to 1 at the
/// full one.
fn development(m0_m2: f64, wind_m_s: f64) -> f64 {
    let developed = developed_variance_m2(wind_m_s);
    if wind_m_s <= CALM_M_S || m0_m2 >= developed { 1.0 } else { smoothstep(0.5, 1.0, m0_m2 / developed) }
}

/// Returns the peak, rad/s, of a sea of a variance under a wind: Kahma and Calkoen's for the same height, and that of
/// Pierson and Moskowitz for a developed sea or one that has outlived its wind.
pub fn peak_of_variance_rad_s(m0_m2: f64, wind_m_s: f64) -> f64 {
    let developed = developed_peak_rad_s(m0_m2);
    let share = development(m0_m2, wind_m_s);
    let peak = if share >= 1.0 || m0_m2 <= 0.0 {
        developed
    } else {
        let growing = fetch_peak_rad_s(wind_m_s, fetch_of_variance_m(wind_m_s, m0_m2));
        libm::exp((1.0 - share) * libm::log(growing) + share * libm::log(developed))
    };
    peak.clamp(PEAKS_RAD_S[0], PEAKS_RAD_S[1])
}

/// Returns the peak enhancement of a sea of a variance under a wind: JONSWAP's 3.3 while it grows, 1 once developed.
pub fn gamma_of_variance(m0_m2: f64, wind_m_s: f64) -> f64 {
    GROWING_GAMMA + (1.0 - GROWING_GAMMA) * development(m0_m2, wind_m_s)
}

/// Influence of the weather at a time on the sea.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct WaveForcing {
    pub wind_m_s: f64,
    /// Unit vector along which the wind blows, east and north; zero without wind.
    pub toward: DVec2,
    pub fetch_m: Option<f64>,
    /// Share, 0 to 1, by which a height that the weather gives replaces the height that the wind raises, and the
    /// variance of the given height, m^2.
    pub given: f64,
    pub given_m2: f64,
    /// Variance of the swell, m^2, its peak, rad/s, and the unit vector in which it travels.
    pub swell_m2: f64,
    pub swell_rad_s: f64,
    pub swell_toward: DVec2,
}

impl WaveForcing {
    /// Creates the forcing of a weather over a fetch.
    pub fn new(c: &Conditions, fetch_m: Option<f64>) -> Self {
        let wind = DVec2::new(c.wind.east_m_s, c.wind.north_m_s);
        let quarter = 0.25 * c.sea.significant_wave_height_m;
        let swell = 0.25 * c.sea.swell_height_m;
        Self {
            wind_m_s: wind.length(),
            toward: wind.normalize_or_zero(),
            fetch_m,
            given: c.sea.given_share,
            given_m2: quarter * quarter,
            swell_m2: swell * swell,
            swell_rad_s: std::f64::consts::TAU / c.sea.swell_period_s,
            swell_toward: DVec2::new(c.sea.swell_east, c.sea.swell_north).normalize_or_zero(),
        }
    }

    /// Returns the variance that this weather keeps up.
    fn kept_m2(&self) -> f64 {
        let free = kept_variance_m2(self.wind_m_s, self.fetch_m);
        free + self.given * (self.given_m2 - free)
    }
}

/// State of the waves that the weather has raised so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct GrowthState {
    /// Variance of the wind sea, m^2.
    pub m0_m2: f64,
    /// Share of the variance that a given height decides, 0 to 1.
    pub given: f64,
    /// Peak of the wind sea, rad/s, and its peak enhancement.
    pub peak_rad_s: f64,
    pub gamma: f64,
    /// Direction in which the wind sea travels (east, north). The vector's length is the share of the waves that
    /// spreads around this direction. The rest is even over all directions.
    pub toward: DVec2,
    /// Wind to which the shortest waves have adapted, m/s.
    pub short_wind_m_s: f64,
    /// Variance of the swell, m^2; the variance times the swell's peak; and the variance times its direction.
    pub swell_m2: f64,
    pub swell_peaks: f64,
    pub swell_toward: DVec2,
}

impl GrowthState {
    /// Creates the state after a weather that has lasted for ever.
    pub fn lasting(f: &WaveForcing) -> Self {
        let m0_m2 = f.kept_m2();
        Self {
            m0_m2,
            given: f.given,
            peak_rad_s: peak_of_variance_rad_s(m0_m2, f.wind_m_s),
            gamma: gamma_of_variance(m0_m2, f.wind_m_s),
            toward: f.toward,
            short_wind_m_s: f.wind_m_s,
            swell_m2: f.swell_m2,
            swell_peaks: f.swell_m2 * f.swell_rad_s,
            swell_toward: f.swell_toward * f.swell_m2,
        }
    }

    /// Returns the state after `dt_s` more seconds under a constant weather, in closed form. Two steps in succession
    /// give the same state as one step of both lengths together, with two exceptions. A fading sea takes the group
    /// speed at the start of a step. Where a height is given only in part, the variance that is given and the one that
    /// the wind raises both start each step from their mixture.
    pub fn after(&self, f: &WaveForcing, dt_s: f64) -> Self {
        let left = |time_s: f64| libm::exp(-dt_s / time_s);
        let toward = |now: f64, aim: f64, time_s: f64| aim + (now - aim) * left(time_s);
        let free = self.free_variance_m2(f, dt_s);
        let m0_m2 = free + f.given * (toward(self.m0_m2, f.given_m2, PEAK_TIME_S) - free);
        let law = |m0: f64| libm::log(peak_of_variance_rad_s(m0, f.wind_m_s));
        let off = (libm::log(self.peak_rad_s) - law(self.m0_m2)) * left(PEAK_TIME_S);
        let gamma_off = (self.gamma - gamma_of_variance(self.m0_m2, f.wind_m_s)) * left(PEAK_TIME_S);
        // Wind below 2 m/s turns waves more slowly, and a calm turns none.
        let turning = TURNING_TIME_S / smoothstep(0.0, 2.0, f.wind_m_s).max(1e-9);
        Self {
            m0_m2,
            given: toward(self.given, f.given, PEAK_TIME_S),
            peak_rad_s: libm::exp(law(m0_m2) + off).clamp(PEAKS_RAD_S[0], PEAKS_RAD_S[1]),
            gamma: (gamma_of_variance(m0_m2, f.wind_m_s) + gamma_off).clamp(1.0, GROWING_GAMMA),
            toward: f.toward + (self.toward - f.toward) * left(turning),
            short_wind_m_s: toward(self.short_wind_m_s, f.wind_m_s, SHORT_TIME_S),
            swell_m2: toward(self.swell_m2, f.swell_m2, PEAK_TIME_S),
            swell_peaks: toward(self.swell_peaks, f.swell_m2 * f.swell_rad_s, PEAK_TIME_S),
            swell_toward: f.swell_toward * f.swell_m2
                + (self.swell_toward - f.swell_toward * f.swell_m2) * left(PEAK_TIME_S),
        }
    }

    /// Returns the variance of the wind sea after `dt_s`, m^2, where no height is given.
    fn free_variance_m2(&self, f: &WaveForcing, dt_s: f64) -> f64 {
        let kept = kept_variance_m2(f.wind_m_s, f.fetch_m);
        if self.m0_m2 >= kept {
            // Waves leave their basin at the group speed g / (2 wp).
            let group_m_s = 0.5 * GRAVITY_M_S2 / self.peak_rad_s;
            let left = libm::exp(-dt_s * group_m_s / f.fetch_m.unwrap_or(OPEN_REGION_M));
            return kept + (self.m0_m2 - kept) * left;
        }
        if f.wind_m_s <= CALM_M_S {
            return kept + (self.m0_m2 - kept) * libm::exp(-dt_s / PEAK_TIME_S);
        }
        // The fetch that would have raised this sea grows as F^0.67 = t U^0.34 g^0.33 / 77.23.
        let rate = 1.0 / time_of_fetch_s(f.wind_m_s, 1.0);
        let now = libm::pow(fetch_of_variance_m(f.wind_m_s, self.m0_m2), DURATION_POWER);
        let fetch = libm::pow(now + rate * dt_s, 1.0 / DURATION_POWER);
        kept.min(fetch_variance_m2(f.wind_m_s, fetch))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn height(m0: f64) -> f64 {
        4.0 * m0.sqrt()
    }

    fn wind(speed: f64, fetch: Option<f64>) -> WaveForcing {
        WaveForcing {
            wind_m_s: speed,
            toward: if speed > 0.0 { DVec2::X } else { DVec2::ZERO },
            fetch_m: fetch,
            given: 0.0,
            given_m2: 0.0,
            swell_m2: 0.0,
            swell_rad_s: 0.6,
            swell_toward: DVec2::Y,
        }
    }

    #[test]
    fn fetch_raises_the_sea_of_kahma_and_calkoen() {
        assert!((height(fetch_variance_m2(10.0, 1e5)) - 1.84).abs() < 5e-3);
        assert!((std::f64::consts::TAU / fetch_peak_rad_s(10.0, 1e5) - 5.59).abs() < 5e-3);
        assert!((time_of_fetch_s(10.0, 1e5) / 3600.0 - 10.3).abs() < 0.05);
        for m0 in [0.001, 0.1, 1.0] {
            let fetch = fetch_of_variance_m(12.0, m0);
            assert!((fetch_variance_m2(12.0, fetch) / m0 - 1.0).abs() < 1e-12);
        }
        // Pierson and Moskowitz's sea is the cap: 20 m/s over 5000 km.
        let capped = height(kept_variance_m2(20.0, Some(5e6)));
        assert_eq!(capped, height(developed_variance_m2(20.0)));
        assert!(height(fetch_variance_m2(20.0, 5e6)) > capped);
    }

    #[test]
    fn a_wind_of_some_hours_raises_the_sea_of_the_equivalent_fetch() {
        let lasting = GrowthState::lasting(&wind(0.0, None));
        let hours = 5.0;
        let grown = lasting.after(&wind(10.0, None), 3600.0 * hours);
        let fetch = 1e5 * (hours * 3600.0 / time_of_fetch_s(10.0, 1e5)).powf(1.0 / 0.67);
        assert!((grown.m0_m2 / fetch_variance_m2(10.0, fetch) - 1.0).abs() < 0.02, "{grown:?}");
        // A short fetch ends the growth.
        let lake = lasting.after(&wind(10.0, Some(2000.0)), 3600.0 * hours);
        assert_eq!(lake.m0_m2, fetch_variance_m2(10.0, 2000.0));
    }

    #[test]
    fn two_steps_are_one_step_of_their_sum() {
        let start = GrowthState { toward: DVec2::Y, ..GrowthState::lasting(&wind(6.0, None)) };
        for f in [wind(12.0, Some(3e5)), wind(3.0, None), wind(0.0, None)] {
            let once = start.after(&f, 5000.0);
            let twice = start.after(&f, 1200.0).after(&f, 3800.0);
            for (a, b) in [
                (once.m0_m2, twice.m0_m2),
                (once.peak_rad_s, twice.peak_rad_s),
                (once.gamma, twice.gamma),
                (once.toward.y, twice.toward.y),
                (once.short_wind_m_s, twice.short_wind_m_s),
            ] {
                // The group speed at which an old sea leaves is that at the step's start.
                assert!((a - b).abs() < 0.02 * a.abs().max(0.01), "{f:?}: {once:?} {twice:?}");
            }
        }
    }

    #[test]
    fn nothing_jumps_when_the_wind_is_cut() {
        let start = GrowthState::lasting(&wind(5.0, Some(1e5)));
        for speed in [0.0, 1.0, 15.0, 40.0] {
            let next = start.after(&wind(speed, Some(1e5)), 1e-3);
            assert!((next.m0_m2 / start.m0_m2 - 1.0).abs() < 1e-4, "{speed}: {next:?}");
            assert!((next.peak_rad_s / start.peak_rad_s - 1.0).abs() < 1e-4, "{speed}: {next:?}");
            assert!((next.gamma - start.gamma).abs() < 1e-4 && (next.toward - start.toward).length() < 1e-4);
        }
    }

    #[test]
    fn old_seas_run_out() {
        let start = GrowthState::lasting(&wind(15.0, Some(2e5)));
        let day = start.after(&wind(0.0, Some(2e5)), 86_400.0);
        assert!(day.m0_m2 < 0.1 * start.m0_m2 && day.m0_m2 > 0.0);
        assert!((day.toward - start.toward).length() < 1e-6, "a calm turns no waves");
    }
}
