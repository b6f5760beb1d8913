//! Tests of the sea as a host asks for it: heights, level, motion, growth and repetition from the queries.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::{
    dispersion::{angular_frequency, wave_length_m},
    foam::whitecap_share,
    history::DatedGrowth,
    ice::SeaIce,
    model::{PreparedSea, SeaStatistics, SeaWorkshop, WeatherPast},
    regions::WaterBody,
    settings::{SeaSettings, SeaSwell, Tide, WindSea},
    single::{SingleWave, WaveScale},
    slopes::mean_square_slope,
    surface::{SeaPoint, SeaSurface},
};
use crate::weather::{Conditions, Sea, Swell, Timeline, Weather, Wind, derive};

/// A sea with its weather.
struct TestSea {
    sea: PreparedSea,
    timeline: Timeline,
    kept: Vec<DatedGrowth>,
    workshop: SeaWorkshop,
}

impl TestSea {
    fn new(settings: SeaSettings, seed: u64, weather: Conditions) -> Self {
        settings.validate().expect("settings");
        let sea = PreparedSea::new(settings, seed);
        let workshop = SeaWorkshop::new(&sea);
        // A host's context begins with the default weather, which the host replaces.
        let mut timeline = Timeline::new(blowing(0.0, 0.0));
        timeline.change(weather, 0.0, 0.0).expect("a change");
        Self { sea, timeline, kept: Vec::new(), workshop }
    }

    fn of(hs: f64, tp: f64, depth_m: f64, seed: u64) -> Self {
        let wind_sea = WindSea::Height { significant_m: hs, peak_period_s: Some(tp), gamma: None };
        Self::new(SeaSettings { wind_sea, depth_m, ..SeaSettings::default() }, seed, blowing(10.0, 250.0))
    }

    fn surface(&mut self, time_s: f64) -> std::sync::Arc<SeaSurface> {
        let revision = self.timeline.parts().1.len() as u64;
        let past = WeatherPast { timeline: &self.timeline, revision, kept: &self.kept };
        self.workshop.surface(&self.sea, &past, time_s)
    }

    fn statistics(&mut self, time_s: f64) -> SeaStatistics {
        let revision = self.timeline.parts().1.len() as u64;
        let past = WeatherPast { timeline: &self.timeline, revision, kept: &self.kept };
        self.workshop.statistics(&self.sea, &past, time_s)
    }
}

fn blowing(speed: f64, from_deg: f64) -> Conditions {
    derive(&Weather { wind: Wind::of(speed, from_deg), ..Weather::default() }).expect("a weather")
}

fn accepts() -> bool {
    std::env::var_os("WELKIN_ACCEPT").is_some()
}

/// Mean and significant height of the surface on a grid of `side`^2 places over a square.
fn heights(surface: &SeaSurface, origin: DVec2, length_m: f64, side: u32) -> (f64, f64) {
    let (mut sum, mut squares) = (0.0, 0.0);
    for i in 0..side {
        for j in 0..side {
            let place = origin + DVec2::new(f64::from(i), f64::from(j)) * (length_m / f64::from(side));
            let height = surface.at(place, 0.0).height_m;
            sum += height;
            squares += height * height;
        }
    }
    let n = f64::from(side * side);
    let mean = sum / n;
    (mean, 4.0 * (squares / n - mean * mean).sqrt())
}

#[test]
fn heights_and_mean_level_are_those_asked() {
    let lengths: &[f64] = if accepts() { &[5.0, 10.0, 25.0, 60.0, 120.0, 200.0, 350.0, 600.0] } else { &[5.0, 190.0] };
    let (seeds, side) = if accepts() { (24, 230) } else { (1, 250) };
    let (mut worst, mut lowest) = (0.0f64, 0.0f64);
    for (i, &length) in lengths.iter().enumerate() {
        let tp = (TAU * length / 9.81f64).sqrt();
        let hs = (length / 22.0).min(9.0);
        // Each seed takes its turn at a quarter of the lengths: a case takes five seconds.
        for seed in (0..seeds).filter(|seed| seeds == 1 || (i as u64 + seed).is_multiple_of(4)) {
            let mut sea = TestSea::of(hs, tp, 4000.0, seed);
            let surface = sea.surface(1000.0 * f64::from(seed as u32));
            let (mean, found) = heights(&surface, DVec2::new(-3e4, 7e4), 100.0 * length, side);
            worst = worst.max((found / hs - 1.0).abs());
            lowest = lowest.max(mean.abs());
            println!("{length} m, seed {seed}: Hs {:+.2} %, mean {:+.1} mm", 100.0 * (found / hs - 1.0), 1e3 * mean);
        }
    }
    println!("worst of Hs {:.2} %, of the mean {:.1} mm", 100.0 * worst, 1e3 * lowest);
    assert!(worst < 0.01 && lowest < 0.005, "{worst} {lowest}");
}

#[test]
fn swells_and_depths_keep_their_heights_too() {
    let swell = SeaSwell { height_m: 2.0, period_s: 12.0, from_deg: 200.0, spread_deg: None };
    let calm = SeaSettings { swells: Some(vec![swell]), ..SeaSettings::default() };
    let mut sea = TestSea::new(calm, 4, blowing(0.0, 0.0));
    assert!((sea.statistics(0.0).significant_height_m - 2.0).abs() < 1e-9);
    assert!(
        (sea.statistics(0.0).peak_period_s - 12.0).abs() < 0.05
            && (sea.statistics(0.0).mean_from_deg - 200.0).abs() < 1e-9
    );
    let (_, found) = heights(&sea.surface(50.0), DVec2::ZERO, 100.0 * 225.0, 200);
    assert!((found / 2.0 - 1.0).abs() < 0.01, "{found}");
    let mut shallow = TestSea::of(1.2, 7.0, 6.0, 4);
    let (mean, found) = heights(&shallow.surface(50.0), DVec2::ZERO, 100.0 * wave_length_m(7.0, 6.0), 200);
    assert!((found / 1.2 - 1.0).abs() < 0.02 && mean.abs() < 0.005, "{found} {mean}");
}

#[test]
fn queries_solve_for_the_place_within_their_bound() {
    let mut sea = TestSea::of(9.0, 11.0, 4000.0, 11);
    let mut worst = [0.0f64; 4];
    for time in [0.0, 1e5, 1e7] {
        let surface = sea.surface(time);
        for i in 0..400 {
            let place = DVec2::new(1e6 + 13.7 * f64::from(i), -1e6 + 7.3 * f64::from(i * i));
            let point = surface.at(place, 0.0);
            let off = [1, 2, 3, 12].map(|steps| surface.solved_off_m(place, steps));
            worst.iter_mut().zip(off).for_each(|(worst, off): (&mut f64, f64)| *worst = worst.max(off));
            assert!(point.height_error_m < 0.01 && point.height_m.abs() < 15.0, "{point:?}");
        }
    }
    println!("off by {worst:.4?} m at most after 1, 2, 3 and 12 steps");
    assert!(worst[1] < 1.0 && worst[2] < 0.1 && worst[3] < 5.1e-4, "{worst:?}");
}

#[test]
fn slopes_velocities_and_accelerations_are_those_of_the_heights() {
    let mut sea = TestSea::of(4.0, 9.0, 40.0, 5);
    let (time, h) = (777.0, 1e-2);
    let (before, now, after) = (sea.surface(time - h), sea.surface(time), sea.surface(time + h));
    for i in 0..60 {
        let place = DVec2::new(31.0 * f64::from(i), 17.0 * f64::from(i));
        let point = now.at(place, 0.0);
        let height = |d: DVec2| now.at(place + d, 0.0).height_m;
        let d = 0.02;
        let slope =
            DVec2::new(height(DVec2::X * d) - height(-DVec2::X * d), height(DVec2::Y * d) - height(-DVec2::Y * d))
                / (2.0 * d);
        let normal = DVec3::new(-slope.x, -slope.y, 1.0).normalize();
        assert!((normal - point.normal).length() < 0.02, "{i}: {normal} {}", point.normal);
        // A particle that moves with the water stays in the surface: dz/dt = vz - v . slope.
        let rate = (after.at(place, 0.0).height_m - before.at(place, 0.0).height_m) / (2.0 * h);
        let v = point.velocity_m_s;
        let slope = -point.normal.truncate() / point.normal.z;
        let wanted = v.z - v.truncate().dot(slope);
        assert!((rate - wanted).abs() < 0.02, "{i}: {rate} {wanted}");
        // The acceleration is the change of velocity that the particle sees.
        let moved = |s: &SeaSurface, t: f64| s.at(place + v.truncate() * t, 0.0).velocity_m_s;
        let change = (moved(&after, h) - moved(&before, -h)) / (2.0 * h);
        assert!((change - point.acceleration_m_s2).length() < 0.15, "{i}: {change} {}", point.acceleration_m_s2);
    }
}

#[test]
fn waves_travel_by_dispersion() {
    for (depth, tp) in [(4000.0, 8.0), (8.0, 7.0)] {
        let mut sea = TestSea::of(0.5, tp, depth, 2);
        let revision = 1;
        let past = WeatherPast { timeline: &sea.timeline, revision, kept: &[] };
        for wave in sea.workshop.waves(&sea.sea, &past, 0.0).0 {
            let w = angular_frequency(TAU * wave.turns_per_m, depth);
            assert!((w / (TAU * wave.frequency_hz) - 1.0).abs() < 1e-10);
        }
    }
    // Vertical velocity of waves longer than a metre at 10 m/s over 100 km: 0.688 m/s; shorter ones add little to it,
    // but much to their acceleration of 1.38 m/s^2.
    let mut sea = TestSea::of(2.139, 6.232, 4000.0, 3);
    let surface = sea.surface(0.0);
    let (mut speed, mut push) = (0.0, 0.0);
    let n = 120;
    for i in 0..n {
        for j in 0..n {
            let point = surface.at(DVec2::new(f64::from(i), f64::from(j)) * 41.3, 1.0);
            speed += point.velocity_m_s.z.powi(2);
            push += point.acceleration_m_s2.z.powi(2);
        }
    }
    let n = f64::from(n * n);
    let (speed, push) = ((speed / n).sqrt(), (push / n).sqrt());
    println!("vertical velocity {speed:.3} m/s, acceleration {push:.3} m/s^2");
    assert!((speed / 0.688 - 1.0).abs() < 0.03 && push > 1.38, "{speed} {push}");
}

#[test]
fn leaving_short_waves_out_stays_within_the_bound() {
    let mut sea = TestSea::of(3.0, 8.0, 4000.0, 8);
    let surface = sea.surface(12.0);
    let whole = |place: DVec2| surface.at(place, 0.0).height_m;
    let mut bounds = Vec::new();
    for shortest in [0.5, 3.0, 12.0, 60.0, 1e4] {
        let (mut worst, mut bound) = (0.0f64, 0.0);
        for i in 0..400 {
            let place = DVec2::new(37.7 * f64::from(i), 11.9 * f64::from(i));
            let point = surface.at(place, shortest);
            worst = worst.max((point.height_m - whole(place)).abs());
            bound = point.height_error_m;
        }
        // Displacements of the waves left out move heights by the slope of the others.
        assert!(worst <= 1.3 * bound + 1e-3, "{shortest}: {worst} {bound}");
        bounds.push(bound);
    }
    assert!(bounds.windows(2).all(|b| b[0] <= b[1]) && bounds[4] > 2.5, "{bounds:?}");
    assert_eq!(surface.at(DVec2::ZERO, 1e4).velocity_m_s, DVec3::ZERO);
}

#[test]
fn any_order_of_times_and_any_copy_gives_the_same_bits() {
    let place = DVec2::new(-812_345.5, 1_200_300.25);
    let mut first = TestSea::of(2.5, 7.0, 4000.0, 21);
    let mut second = TestSea::of(2.5, 7.0, 4000.0, 21);
    let wanted: Vec<SeaPoint> = [1e8, 3.0, 1e5].iter().map(|t| first.surface(*t).at(place, 0.0)).collect();
    let again: Vec<SeaPoint> = [1e5, 7.0, 3.0, 1e8].iter().map(|t| second.surface(*t).at(place, 0.0)).collect();
    assert_eq!((wanted[0], wanted[1], wanted[2]), (again[3], again[2], again[0]));
    assert_ne!(wanted[0], TestSea::of(2.5, 7.0, 4000.0, 22).surface(1e8).at(place, 0.0), "seeds differ");
    // Far away and late, waves run as smoothly as here and now.
    for time in [0.0, 1e8] {
        let step = 1e-3;
        let h = [0.0, 1.0, 2.0].map(|i| first.surface(time + i * step).at(place, 0.0).height_m);
        assert!((h[0] - 2.0 * h[1] + h[2]).abs() < 2e-5, "{time}: {h:?}");
    }
}

#[test]
fn a_turn_of_weather_grows_the_sea_without_a_jump() {
    let mut sea = TestSea::new(SeaSettings { fetch_m: Some(2e5), ..SeaSettings::default() }, 6, blowing(4.0, 270.0));
    let quiet = sea.statistics(0.0).significant_height_m;
    let strong = Weather {
        wind: Wind::of(17.0, 330.0),
        sea: Sea { swell: Some(Swell { height_m: 1.5, period_s: 13.0, from_deg: 200.0 }), ..Sea::default() },
        ..Weather::default()
    };
    sea.timeline.change(derive(&strong).unwrap(), 100.0, 0.0).unwrap();
    let place = DVec2::new(45_000.0, -12_000.0);
    let height = |sea: &mut TestSea, t: f64| sea.surface(t).at(place, 0.0).height_m;
    // Rate over the cut, and everywhere in the next minutes, against the fastest vertical motion of such a sea.
    let mut fastest = 0.0f64;
    for i in 0..80 {
        let t = 99.0 + 0.05 * f64::from(i);
        fastest = fastest.max((height(&mut sea, t + 0.05) - height(&mut sea, t)).abs() / 0.05);
    }
    for i in 0..60 {
        let t = 100.0 + 60.0 * f64::from(i);
        fastest = fastest.max((height(&mut sea, t + 0.01) - height(&mut sea, t)).abs() / 0.01);
    }
    assert!(fastest < 4.0, "{fastest} m/s");
    let hours = |h: f64| 100.0 + 3600.0 * h;
    let grown: Vec<f64> =
        [0.0, 1.0, 3.0, 8.0, 30.0].iter().map(|h| sea.statistics(hours(*h)).significant_height_m).collect();
    println!("Hs {quiet:.2} m, then {grown:.2?} m after 0, 1, 3, 8 and 30 hours of 17 m/s");
    assert!(grown.windows(2).all(|g| g[1] > g[0]), "{grown:?}");
    assert!((grown[0] / quiet - 1.0).abs() < 1e-6, "{} {quiet}", grown[0]);
    let full = (16.0 * super::growth::kept_variance_m2(17.0, Some(2e5)) + 1.5 * 1.5).sqrt();
    assert!((grown[4] / full - 1.0).abs() < 0.01, "{grown:?} {full}");
}

#[test]
fn slopes_and_foam_follow_the_wind() {
    for wind in [6.0, 10.0, 15.0, 20.0] {
        let mut sea =
            TestSea::new(SeaSettings { fetch_m: Some(3e5), ..SeaSettings::default() }, 3, blowing(wind, 90.0));
        let s = sea.statistics(0.0);
        assert!((s.mean_square_slope / mean_square_slope(wind) - 1.0).abs() < 0.03, "{wind}: {s:?}");
        assert!(
            s.drawn_square_slope <= 1.001 * s.mean_square_slope && s.drawn_square_slope > 0.3 * s.mean_square_slope
        );
        let surface = sea.surface(0.0);
        let (n, mut foam) = (if accepts() { 400 } else { 260 }, 0.0);
        for i in 0..n {
            for j in 0..n {
                foam += surface.at(DVec2::new(f64::from(i) * 17.3, f64::from(j) * 13.1), 0.0).foam;
            }
        }
        let share = foam / f64::from(n * n);
        let ratio = share / whitecap_share(wind);
        println!("{wind} m/s: foam on {share:.4}, {ratio:.2} of the law");
        assert!((1.0 / 1.5..1.5).contains(&ratio), "{wind}: {share} {ratio}");
    }
}

#[test]
fn statistics_are_those_of_the_settings() {
    let mut sea = TestSea::of(2.139, 6.232, 4000.0, 1);
    let s = sea.statistics(0.0);
    assert!((s.significant_height_m - 2.139).abs() < 1e-9 && (s.peak_period_s / 6.232 - 1.0).abs() < 0.003, "{s:?}");
    assert!((s.mean_from_deg - 250.0).abs() < 1e-6, "{s:?}");
    // 3600 s of waves of 0.777 Tp: the largest is 1.82 Hs.
    let waves = 3600.0 / (0.7774 * 6.232);
    let wanted = 2.139 * (0.5 * f64::ln(waves)).sqrt();
    assert!((s.highest_in_hour_m / wanted - 1.0).abs() < 0.01, "{s:?}");
    assert!((s.refractive_index - 1.3410).abs() < 3e-4 && s.water_temperature_c == 15.0, "{s:?}");
    let state = |wind_sea| SeaSettings { wind_sea, ..SeaSettings::default() };
    let mut four = TestSea::new(state(WindSea::SeaState(4)), 1, blowing(3.0, 0.0));
    assert!((four.statistics(0.0).significant_height_m - 1.875).abs() < 1e-9);
    let mut none = TestSea::new(state(WindSea::SeaState(0)), 1, blowing(3.0, 0.0));
    assert_eq!(none.statistics(0.0).significant_height_m, 0.0);
    let flat = none.surface(10.0).at(DVec2::new(5.0, 6.0), 0.0);
    assert_eq!((flat.height_m, flat.normal, flat.foam), (0.0, DVec3::Z, 0.0));
    let mut gale = TestSea::new(state(WindSea::Beaufort(8.0)), 1, blowing(3.0, 0.0));
    let wind = 0.836 * 8f64.powf(1.5);
    let wanted = 4.0 * super::growth::developed_variance_m2(wind).sqrt();
    assert!((gale.statistics(0.0).significant_height_m / wanted - 1.0).abs() < 1e-9);
    let tide = Some(Tide { amplitude_m: 1.5, high_water_s: 0.0 });
    let mut level =
        TestSea::new(SeaSettings { level_m: 10.0, tide, ..state(WindSea::SeaState(0)) }, 1, blowing(0.0, 0.0));
    let point = level.surface(0.0).at(DVec2::ZERO, 0.0);
    assert_eq!((point.height_m, point.depth_m), (11.5, 4001.5));
}

#[test]
fn single_waves_come_on_top_and_keep_their_form() {
    let calm = SeaSettings { wind_sea: WindSea::SeaState(0), depth_m: 20.0, ..SeaSettings::default() };
    let wave = SingleWave { height_m: 3.0, scale: WaveScale::Period(9.0), from_deg: 180.0, phase_deg: 30.0 };
    let length_m = wave_length_m(9.0, 20.0);
    let k = TAU / length_m;
    let mut sea = TestSea::new(SeaSettings { waves: vec![wave], ..calm.clone() }, 1, blowing(0.0, 0.0));
    // A crest passes the origin a twelfth of the period after time 0, and again 1e6 periods later.
    for (time_s, y) in [(0.75, 0.0), (0.75 + 9e6, 0.0), (9.75, -length_m)] {
        let crest = sea.surface(time_s).at(DVec2::new(-400.0, y), 0.0);
        let raised = 0.5 * 1.5 * 1.5 * k / libm::tanh(k * 20.0);
        assert!((crest.height_m - 1.5 - raised).abs() < 1e-4, "{time_s}: {crest:?} {raised}");
        let along = 1.5 * TAU / 9.0 / libm::tanh(k * 20.0);
        assert!((crest.velocity_m_s - DVec3::Y * along).length() < 1e-3, "{crest:?}");
        let fall = -1.5 * (TAU / 9.0).powi(2);
        assert!((crest.acceleration_m_s2 - DVec3::Z * fall).length() < 1e-3, "{crest:?}");
    }
    // The mean over a period is the level.
    let heights: f64 = (0..90).map(|i| sea.surface(0.1 * f64::from(i)).at(DVec2::new(7.0, 7.0), 0.0).height_m).sum();
    assert!((heights / 90.0).abs() < 2e-3, "{heights}");
    // Added to a sea, it changes no phase of the others.
    let rough = SeaSettings { wind_sea: WindSea::SeaState(3), ..calm };
    let mut alone = TestSea::new(rough.clone(), 1, blowing(0.0, 0.0));
    let both = SeaSettings { waves: vec![SingleWave { height_m: 0.02, ..wave }], ..rough };
    let mut both = TestSea::new(both, 1, blowing(0.0, 0.0));
    let [hs, with] = [&mut alone, &mut both].map(|sea| sea.statistics(0.0).significant_height_m);
    assert!((with - (hs * hs + 8.0 * 1e-4).sqrt()).abs() < 1e-9, "{hs} {with}");
    for i in 0..50 {
        let place = DVec2::new(13.0 * f64::from(i), 5.0);
        let [a, b] = [&mut alone, &mut both].map(|sea| sea.surface(3.0).at(place, 0.0).height_m);
        assert!((a - b).abs() < 0.02, "{a} {b}");
    }
}

#[test]
fn ice_damps_short_waves_and_shelter_damps_all_waves_equally() {
    let ice = SeaIce { cover: 1.0, floe_m: 0.1, width_m: 1e4 };
    let wind_sea = WindSea::Height { significant_m: 2.0, peak_period_s: Some(7.0), gamma: None };
    let settings = SeaSettings { wind_sea, ice: Some(ice), ..SeaSettings::default() };
    let mut sea = TestSea::new(settings, 2, blowing(15.0, 250.0));
    // The spectrum's integral with the law of Meylan et al., step by step in frequency.
    let (mut whole, mut left) = (0.0, 0.0);
    for i in 300..6000 {
        let x = 1e-3 * f64::from(i);
        let density = super::spectrum::jonswap_shape(x, 3.3);
        let hz = x / 7.0;
        whole += density;
        left += density * (-1e4 * (2.12e-3 * hz.powi(2) + 4.59e-2 * hz.powi(4))).exp();
    }
    let wanted = 2.0 * (left / whole).sqrt();
    let s = sea.statistics(0.0);
    assert!((s.significant_height_m / wanted - 1.0).abs() < 0.01 && wanted < 1.4, "{s:?} {wanted}");
    assert!(s.peak_period_s > 7.03 && s.mean_square_slope < 2e-3 && s.whitecap_share == 0.0, "{s:?}");
    let (mean, found) = heights(&sea.surface(70.0), DVec2::ZERO, 8000.0, 120);
    assert!((found / wanted - 1.0).abs() < 0.01 && mean.abs() < 5e-3, "{found} {wanted} {mean}");

    let mut open = TestSea::of(2.0, 7.0, 4000.0, 2);
    let surface = open.surface(70.0);
    let harbour = WaterBody { wave_share: 0.3, ..WaterBody::OPEN };
    let (mut squares, mut sum, mut worst) = (0.0, 0.0, 0.0f64);
    for i in 0..20_000 {
        let point = surface.within(&harbour, DVec2::new(37.0 * f64::from(i % 150), 61.0 * f64::from(i / 150)), 0.0);
        squares += point.height_m.powi(2);
        sum += point.height_m;
        worst = worst.max(point.height_error_m);
    }
    let (found, mean) = (4.0 * (squares / 2e4).sqrt(), sum / 2e4);
    assert!((found / 0.6 - 1.0).abs() < 0.02 && mean.abs() < 3e-3 && worst < 2e-3, "{found} {mean} {worst}");
    let lake = surface.within(&WaterBody { lake: Some([50.0, 4.0]), wave_share: 0.0, is_dry: false }, DVec2::ONE, 0.0);
    assert_eq!((lake.height_m, lake.depth_m, lake.normal, lake.foam), (50.0, 4.0, DVec3::Z, 0.0));
}

#[test]
fn extreme_weathers_give_finite_seas() {
    let sea = |height, swell| Sea { significant_wave_height_m: height, swell, ..Sea::default() };
    let steep = Some(Swell { height_m: 20.0, period_s: 1.0, from_deg: 0.0 });
    for (speed, sea) in
        [(0.0, sea(None, None)), (0.2, sea(Some(0.0), None)), (90.0, sea(None, steep)), (0.0, sea(Some(30.0), steep))]
    {
        for (depth_m, fetch_m) in [(0.5, Some(10.0)), (12_000.0, None), (3.0, Some(2e7))] {
            let weather = Weather { wind: Wind::of(speed, 45.0), sea, ..Weather::default() };
            let settings = SeaSettings { depth_m, fetch_m, ..SeaSettings::default() };
            let mut sea = TestSea::new(settings, 1, derive(&weather).unwrap());
            let s = sea.statistics(0.0);
            let point = sea.surface(1e10).at(DVec2::new(1e7, -1e7), 0.0);
            assert!(s.significant_height_m.is_finite() && s.mean_square_slope.is_finite(), "{s:?}");
            assert!(point.height_m.is_finite() && point.normal.is_finite() && point.acceleration_m_s2.is_finite());
        }
    }
}

/// Prints what a point costs over a transform of 256^2, in one run; asserts nothing, since machines differ.
#[test]
fn costs_are_printed_on_acceptance() {
    use super::fft::{Complex, SIDE, Transform};
    if !accepts() {
        return;
    }
    let mut transform = Transform::new();
    let mut square = vec![[Complex::new(1e-3, 2e-3); SIDE]; SIDE];
    let least = |run: &mut dyn FnMut()| {
        let time = |_: u32| {
            let begun = std::time::Instant::now();
            run();
            begun.elapsed().as_secs_f64()
        };
        (0..20).map(time).fold(f64::INFINITY, f64::min)
    };
    let small_s = least(&mut || transform.square(&mut square, SIDE / 2));
    // 256^2 samples take four times as many rows of twice the length with 8 stages in place of 7.
    let transform_s = small_s * 4.0 * 8.0 / 7.0;
    let mut sea = TestSea::of(2.139, 6.232, 4000.0, 1);
    let surface = sea.surface(0.0);
    let points_s = least(&mut || {
        for i in 0..64 {
            std::hint::black_box(surface.at(DVec2::new(5.3 * f64::from(i), 1.0), 0.0));
        }
    });
    let mut time = 0.0;
    let new_s = least(&mut || {
        time += 1.0;
        std::hint::black_box(sea.surface(time));
    });
    let in_transforms = |seconds: f64| seconds / transform_s;
    println!("transform of 256^2 {:.2} ms", 1e3 * transform_s);
    println!("a point {:.1} us = 1/{:.0} of it", 1e6 * points_s / 64.0, 1.0 / in_transforms(points_s / 64.0));
    println!("a new time {:.2} ms = {:.1} of them", 1e3 * new_s, in_transforms(new_s));
}
