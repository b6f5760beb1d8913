//! For every accepted weather all queries succeed, and a frame can be drawn.

use glam::DVec3;
use welkin::{
    context::{Context, GivenDirection},
    rain::RainSurface,
    weather::{Overrides, Weather, derive_with},
};
use welkin_support::accept;

use crate::{
    host::{Dice, Host},
    random::{FIELDS, Given},
};

/// A context to which one weather after another is given.
struct Asked {
    context: Context,
    time_s: f64,
}

fn finite(name: &str, values: &[f64]) -> Result<(), String> {
    if values.iter().all(|v| v.is_finite()) { Ok(()) } else { Err(format!("{name}: {values:?}")) }
}

impl Asked {
    fn new(host: &Host) -> Self {
        Self { context: host.context(), time_s: 0.0 }
    }

    /// Finds what is wrong with the query results of a weather.
    fn fault(&mut self, given: &Given, elevation_deg: f64) -> Result<(), String> {
        let says = |what: &'static str| move |e: welkin::Error| format!("{what}: {e}");
        self.time_s += 10.0;
        let t = self.time_s;
        let context = &mut self.context;
        context.set_sun(Some(GivenDirection { azimuth_deg: 120.0, elevation_deg })).unwrap();
        context.set_weather_with(&given.weather, &given.overrides, t, 0.0).map_err(says("set_weather"))?;
        context.update(t).map_err(says("update"))?;
        let c = context.conditions_at(DVec3::ZERO, t).map_err(says("conditions"))?;
        let mut all = Vec::new();
        crate::seams::numbers(&c, &mut all);
        finite("conditions", &all)?;
        for up in [2.0, 3000.0, 30_000.0] {
            let eye = DVec3::Z * up;
            let scene = context.scene_at(eye, t).map_err(says("scene"))?;
            scene.planet.check().map_err(says("planet"))?;
            let lux = [scene.ground.sun_lux, scene.ground.moon_lux, scene.ground.sky_lux, scene.deck_cd_m2];
            finite("light", lux.as_flattened())?;
            if lux.as_flattened().iter().any(|v| *v < 0.0) {
                return Err(format!("negative light: {lux:?}"));
            }
            finite("light", &[scene.ground.total_lux, scene.ground.adaptation_cd_m2, scene.deck_cover])?;
            finite("light", &[scene.medium_share, scene.sun.direct_share, scene.sun.flattening, scene.moon.lit])?;
            scene.fog_model(None, 1, context.planet_radius_m()).map_err(says("fog"))?;
            let way = DVec3::new(800.0, 2000.0, 30.0 - 0.4 * up);
            let between = context.between(eye, eye + way, t).map_err(says("between"))?;
            finite("between", &between.transmittance)?;
            if !between.transmittance.iter().all(|v| (0.0..=1.0).contains(v)) || between.visibility_m.is_nan() {
                return Err(format!("between: {between:?}"));
            }
            let rain = context.rain_at(eye, t).map_err(says("rain"))?;
            finite("rain", &[rain.rate_mm_h, rain.number_per_m3, rain.liquid_g_m3, rain.extinction_per_m])?;
            finite("rain", &[rain.mean_diameter_mm, rain.median_volume_diameter_mm, rain.drops_per_m2_s])?;
            finite("rain", &rain.fall_velocity_m_s.to_array())?;
            finite("ice", &[rain.ice_mm_h, rain.stones_per_m3, rain.stone_extinction_per_m, rain.stone_diameter_mm])?;
            let wind = context.wind_at(eye, t).map_err(says("wind"))?;
            finite("wind", &wind.velocity_m_s.to_array())?;
            finite("mean wind", &wind.mean_m_s.to_array())?;
            finite("wind", &[wind.gust_deviation_m_s])?;
        }
        let pane = RainSurface { position: DVec3::Z, normal: DVec3::Y, velocity_m_s: DVec3::Y * 20.0, area_m2: 1.0 };
        let on = context.rain_on(&pane, t).map_err(says("rain on"))?;
        finite("rain on", &[on.rate_mm_h, on.drops_per_s, on.ice_mm_h, on.stones_per_s])?;
        finite("displacement", &context.wind_displacement(t).map_err(says("displacement"))?.to_array())?;
        let ground = context.ground_at(DVec3::ZERO).map_err(says("ground"))?;
        finite("ground", &[ground.water_mm, ground.film_mm, ground.wetness, ground.puddles])
    }
}

/// Fails if there are faults: prints one of each kind with its number.
pub fn report(count: usize, faults: &[(String, Given)]) {
    let mut kinds = std::collections::BTreeMap::new();
    for (text, given) in faults {
        let key: String = text.chars().filter(|c| !c.is_ascii_digit()).take(60).collect();
        kinds.entry(key).or_insert((text, given, 0)).2 += 1;
    }
    let lines: Vec<String> = kinds.values().map(|(text, given, n)| format!("{n} x {text}\n    {given:?}")).collect();
    assert!(faults.is_empty(), "{} of {count} weathers:\n{}", faults.len(), lines.join("\n"));
}

#[test]
fn every_random_weather_answers() {
    let host = Host::new();
    let count = if accept() { 16_000 } else { 1500 };
    let (mut asked, mut dice, mut faults) = (Asked::new(&host), Dice(1), Vec::new());
    for _ in 0..count {
        let (given, elevation) = (Given::random(&mut dice), dice.below(100) as f64 - 20.0);
        if let Err(text) = asked.fault(&given, elevation) {
            faults.push((text, given));
        }
    }
    report(count, &faults);
}

#[test]
fn without_any_air_the_visibility_is_a_number() {
    let none = Some(0.0);
    let overrides = Overrides {
        aerosol_extinction_per_m: none,
        fog_extinction_per_m: none,
        precipitation_extinction_per_m: none,
        rayleigh_density_ratio: none,
        ..Overrides::default()
    };
    let conditions = derive_with(&Weather::default(), &overrides).unwrap();
    assert_eq!((conditions.extinction_per_m, conditions.visibility_m()), (0.0, 1e9));
}

/// Tests each number at both ends of its range, alone and together with each other number at both ends.
#[test]
fn every_pair_of_extremes_answers() {
    let host = Host::new();
    let (mut asked, mut dice, mut faults, mut count) = (Asked::new(&host), Dice(2), Vec::new(), 0);
    let ends: Vec<_> = FIELDS.iter().flat_map(|f| f.range.map(|v| (f, v))).collect();
    for (i, (a, va)) in ends.iter().enumerate() {
        for (b, vb) in &ends[i..] {
            if !accept() && dice.below(4) > 0 && a.name != b.name {
                continue;
            }
            let mut given = Given::of_kinds(&mut dice);
            (a.set)(&mut given, *va);
            (b.set)(&mut given, *vb);
            let given = given.accepted();
            count += 1;
            if let Err(text) = asked.fault(&given, 35.0) {
                faults.push((format!("{text} ({} {va}, {} {vb})", a.name, b.name), given));
            }
        }
    }
    report(count, &faults);
}
