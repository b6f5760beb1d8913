//! Wind near the ground, the sea that it raises, and the ground under precipitation.

use super::conditions::{SeaState, SurfaceCover, WindProfile};
use super::kinds::SurfaceState;
use super::model::{Surface, Weather};
use super::precipitation::Falling;

/// Roughness of open grassland, m, on which wind masts stand (WMO-No. 8, part I, chapter 5).
const GRASS_ROUGHNESS_M: f64 = 0.03;
/// Number of standard deviations by which the highest 3-second gust in 10 minutes exceeds the mean (Harper, Kepert and
/// Ginger 2010).
const GUST_PEAK_FACTOR: f64 = 2.3;
/// Acceleration of gravity, m/s^2.
const GRAVITY_M_S2: f64 = 9.80665;

/// Returns the roughness length of the sea, m, under a wind of `speed_10_m_s` at 10 m: Charnock (1955) with the
/// constant 0.0144 (Garratt 1977) plus the smooth-flow limit 0.11 nu / u*, with the air's kinematic viscosity nu and
/// the friction velocity u*. The sum is solved together with the log law by repeated substitution. It is limited to
/// \[1e-6, 0.1\].
pub fn sea_roughness_length_m(speed_10_m_s: f64) -> f64 {
    let mut z0 = 1e-4;
    // Each round leaves about 0.2 of the error; after 20 rounds it is below the last bit that matters.
    for _ in 0..20 {
        let friction = 0.4 * speed_10_m_s / libm::log(10.0 / z0);
        z0 = (0.0144 * friction * friction / GRAVITY_M_S2 + 0.11 * 1.5e-5 / friction.max(1e-3)).clamp(1e-6, 0.1);
    }
    z0
}

/// Returns the significant height of a fully developed sea, m: Pierson and Moskowitz (1964), 0.2092 U^2 / g with the
/// wind speed U at 19.5 m.
pub fn fully_developed_wave_height_m(speed_19_5_m_s: f64) -> f64 {
    0.2092 * speed_19_5_m_s * speed_19_5_m_s / GRAVITY_M_S2
}

/// Returns the middle of the range of significant heights of a WMO sea state (code 3700), m; 16 m for state 9.
pub fn wave_height_of_state_m(state: u8) -> f64 {
    const BOUNDS: [f64; 9] = [0.0, 0.1, 0.5, 1.25, 2.5, 4.0, 6.0, 9.0, 14.0];
    match usize::from(state) {
        0 => 0.0,
        s @ 1..=8 => 0.5 * (BOUNDS[s - 1] + BOUNDS[s]),
        _ => 16.0,
    }
}

/// Returns the share of level ground that snow of this depth, m, covers. It is the hyperbolic tangent of the depth
/// divided by 2.5 times a roughness of 1 cm, as in Niu and Yang 2007.
pub fn snow_cover(depth_m: f64) -> f64 {
    if depth_m > 0.25 { 1.0 } else { libm::tanh(depth_m / 0.025) }
}

/// Returns the wind profile. The turbulence intensity is as given, else the larger of that of the log law, sigma / U =
/// 1 / ln(10 / z0) (Panofsky and Dutton 1984), and that which a reported gust implies.
pub(super) fn wind_profile(w: &Weather) -> WindProfile {
    let roughness = w.surface.roughness_length_m.unwrap_or(GRASS_ROUGHNESS_M);
    let neutral = (1.0 / libm::log(10.0 / roughness).max(1.0)).min(1.0);
    let from_gust = match w.wind.gust_m_s {
        Some(gust) if w.wind.speed_m_s > 0.0 => (gust / w.wind.speed_m_s - 1.0) / GUST_PEAK_FACTOR,
        _ => 0.0,
    };
    let intensity = w.wind.turbulence_intensity.unwrap_or(neutral.max(from_gust).min(1.0));
    let gust = w.wind.gust_m_s.unwrap_or(w.wind.speed_m_s * (1.0 + GUST_PEAK_FACTOR * intensity));
    let (sin, cos) = libm::sincos(w.wind.from_deg.to_radians());
    let half_range = |(from, to): (f64, f64)| {
        let span = to - from;
        0.5 * if span < 0.0 { span + 360.0 } else { span }
    };
    WindProfile {
        east_m_s: -w.wind.speed_m_s * sin,
        north_m_s: -w.wind.speed_m_s * cos,
        gust_m_s: gust,
        turbulence_intensity: intensity,
        wander_deg: w.wind.variable_deg.map_or(0.0, half_range),
        roughness_length_m: roughness,
        sea_roughness_length_m: sea_roughness_length_m(w.wind.speed_m_s),
        up_m_s: 0.0,
    }
}

/// Returns the state of the sea: height as given, else of the reported sea state, else fully developed under this wind.
pub(super) fn sea_state(w: &Weather, wind: &WindProfile, height_override: Option<f64>) -> SeaState {
    let z0 = wind.sea_roughness_length_m;
    let to_19_5 = libm::log(19.5 / z0) / libm::log(10.0 / z0);
    let from_wind = || fully_developed_wave_height_m(w.wind.speed_m_s * to_19_5);
    let given = height_override.or(w.sea.significant_wave_height_m).or(w.sea.state.map(wave_height_of_state_m));
    let (sin, cos) = libm::sincos(w.sea.swell.map_or(0.0, |s| s.from_deg).to_radians());
    SeaState {
        significant_wave_height_m: given.unwrap_or_else(from_wind),
        given_share: if given.is_some() { 1.0 } else { 0.0 },
        swell_height_m: w.sea.swell.map_or(0.0, |s| s.height_m),
        swell_period_s: w.sea.swell.map_or(10.0, |s| s.period_s),
        swell_east: -sin,
        swell_north: -cos,
        // Sea water freezes at -1.8 C (salinity 33).
        temperature_c: w.sea.temperature_c.unwrap_or(w.temperature_c.max(-1.8)),
    }
}

/// Returns the wetness that rain maintains against evaporation: L / (L + E), with L the liquid rate and E = 0.5 (1 -
/// RH) + 0.02 mm/h, the daytime evaporation from a wet surface (of the order that Penman 1948 gives).
pub fn wetness_from_rain(liquid_mm_h: f64, relative_humidity: f64) -> f64 {
    liquid_mm_h / (liquid_mm_h + 0.5 * (1.0 - relative_humidity) + 0.02)
}

/// Returns the share of the ground under standing water, from rain beyond the 2 mm/h that drains off level ground.
fn puddles_from_rain(liquid_mm_h: f64) -> f64 {
    let excess = (liquid_mm_h - 2.0).max(0.0);
    excess / (excess + 20.0)
}

/// Returns the wetness and the share of puddles that rain and drizzle maintain.
pub(crate) fn cover_under_rain(falling: &Falling, humidity: f64) -> (f64, f64) {
    let liquid = falling.rain_mm_h + falling.drizzle_mm_h;
    (wetness_from_rain(liquid, humidity), puddles_from_rain(liquid))
}

/// Returns the ground as observed, else as precipitation maintains it. Lying snow above 0 C keeps it at least half wet.
/// Freezing rain makes ice instead of a film.
pub(super) fn surface_cover(s: &Surface, air_c: f64, humidity: f64, falling: &Falling) -> SurfaceCover {
    let cover = |wetness, puddles, ice| SurfaceCover { wetness, puddles, ice, snow_depth_m: s.snow_depth_m };
    if let Some(state) = s.state {
        return match state {
            SurfaceState::Dry => cover(0.0, 0.0, 0.0),
            SurfaceState::Damp => cover(0.3, 0.0, 0.0),
            SurfaceState::Wet => cover(1.0, 0.0, 0.0),
            SurfaceState::StandingWater => cover(1.0, 0.3, 0.0),
            SurfaceState::Frost => cover(0.0, 0.0, 0.5),
            SurfaceState::Ice => cover(0.0, 0.0, 1.0),
            SurfaceState::Snow => SurfaceCover { snow_depth_m: s.snow_depth_m.max(0.03), ..cover(0.0, 0.0, 0.0) },
        };
    }
    let liquid = falling.rain_mm_h + falling.drizzle_mm_h;
    let melting = if air_c > 0.0 { falling.snow_mm_h + falling.ice_pellets_mm_h + falling.hail_mm_h } else { 0.0 };
    let thaw: f64 = if air_c > 0.0 && s.snow_depth_m > 0.0 { 0.5 } else { 0.0 };
    let film = wetness_from_rain(liquid + melting, humidity).max(thaw);
    let frozen = falling.freezing;
    cover(film * (1.0 - frozen), puddles_from_rain(liquid) * (1.0 - frozen), film * frozen)
}

#[cfg(test)]
mod tests {
    use super::super::model::Wind;
    use super::*;

    #[test]
    fn waves_of_published_winds() {
        assert!((fully_developed_wave_height_m(10.0) - 2.133).abs() < 1e-3);
        assert!((fully_developed_wave_height_m(20.0) - 8.532).abs() < 2e-3);
        let states: Vec<f64> = (0..=9).map(wave_height_of_state_m).collect();
        assert!(states.windows(2).all(|s| s[1] > s[0]));
        assert_eq!(states[5], 3.25);
    }

    #[test]
    fn sea_roughness_solves_its_own_equation() {
        for u in [0.0, 0.5, 2.0, 10.0, 30.0, 100.0] {
            let z0 = sea_roughness_length_m(u);
            let f = 0.4 * u / (10.0f64 / z0).ln();
            let again = (0.0144 * f * f / GRAVITY_M_S2 + 0.11 * 1.5e-5 / f.max(1e-3)).clamp(1e-6, 0.1);
            assert!((again / z0 - 1.0).abs() < 1e-6, "{u}: {z0} {again}");
        }
        // About 0.1 to 0.3 mm in a fresh breeze.
        assert!((1e-4..3e-4).contains(&sea_roughness_length_m(10.0)));
    }

    #[test]
    fn wind_points_where_the_air_goes_and_follows_the_log_law() {
        let w = Weather { wind: Wind::of(8.0, 270.0), ..Weather::default() };
        let p = wind_profile(&w);
        assert!((p.east_m_s - 8.0).abs() < 1e-12 && p.north_m_s.abs() < 1e-12, "a west wind blows east");
        assert!((p.from_deg() - 270.0).abs() < 1e-9);
        assert!((p.speed_at_height_m_s(10.0) - 8.0).abs() < 1e-12);
        let expected = 8.0 * (2.0f64 / 0.03).ln() / (10.0f64 / 0.03).ln();
        assert!((p.speed_at_height_m_s(2.0) - expected).abs() < 1e-12);
        assert_eq!(p.speed_at_height_m_s(0.01), 0.0);
        assert!(p.gust_m_s > 8.0 && p.gust_m_s < 13.0);
    }

    #[test]
    fn reported_gusts_raise_the_turbulence() {
        let mut w = Weather { wind: Wind { gust_m_s: Some(18.0), ..Wind::of(8.0, 0.0) }, ..Weather::default() };
        assert!((wind_profile(&w).turbulence_intensity - (18.0 / 8.0 - 1.0) / 2.3).abs() < 1e-12);
        w.wind = Wind { variable_deg: Some((350.0, 20.0)), ..Wind::of(2.0, 0.0) };
        assert_eq!(wind_profile(&w).wander_deg, 15.0);
        w.wind = Wind::default();
        assert_eq!(wind_profile(&w).gust_m_s, 0.0);
    }

    #[test]
    fn observed_ground_wins_over_rain() {
        let rain = Falling { rain_mm_h: 10.0, ..super::super::precipitation::falling(&Default::default()) };
        let dry = Surface { state: Some(SurfaceState::Dry), ..Surface::default() };
        assert_eq!(surface_cover(&dry, 10.0, 0.9, &rain).wetness, 0.0);
        let wet = surface_cover(&Surface::default(), 10.0, 0.9, &rain);
        assert!(wet.wetness > 0.95 && wet.puddles > 0.2 && wet.ice == 0.0);
        let freezing = surface_cover(&Surface::default(), -1.0, 0.9, &Falling { freezing: 1.0, ..rain });
        assert!(freezing.ice > 0.95 && freezing.wetness == 0.0);
    }
}
