//! Changes from one weather to another have no jump: over a microsecond of a change of an hour no query result changes
//! by more than a millionth of itself.

use glam::DVec3;
use welkin::{
    clouds::CloudModel,
    context::{Context, GivenDirection},
    weather::*,
};
use welkin_support::accept;

use crate::host::{Dice, Host};

/// Start and length of the changes, s. At times so near 0 a microsecond is 2e6 times the resolution of f64 even at
/// their end.
const START_S: f64 = 100.0;
const LENGTH_S: f64 = 3600.0;
const MICROSECOND: f64 = 1e-6;

/// Greatest change in a microsecond, relative to the value or, if that is larger, to a thousandth of the larger end
/// value.
const MOST: f64 = 1e-6;

/// Number of intervals in a change among which the one with the largest change is looked for.
const PLACES: usize = 48;

/// Distances from a seam at which the size of each number is also measured, s: a number may be large for a few seconds
/// only, such as direct sunlight through the first of a cloud, before that thickens.
const NEAR_S: [f64; 3] = [1.0, 6.0, 36.0];

/// Appends every number of some conditions. No field can be forgotten, because the patterns must name all.
pub fn numbers(c: &Conditions, out: &mut Vec<f64>) {
    let Conditions {
        extinction_per_m,
        air,
        aerosol,
        fog,
        precipitation,
        clouds,
        clear_sky,
        cloud_light: CloudLightOverride { weight, direct, diffuse },
        wind,
        sea,
        surface: SurfaceCover { wetness, puddles, ice, snow_depth_m },
        ozone_du,
    } = *c;
    out.extend([extinction_per_m, ozone_du, weight, direct, diffuse, wetness, puddles, ice, snow_depth_m]);
    let Air {
        temperature_c,
        relative_humidity,
        pressure_hpa,
        station_pressure_hpa,
        station_altitude_m,
        rayleigh_density_ratio,
        rayleigh_scale_height_m,
        rayleigh_extinction_per_m,
    } = air;
    out.extend([temperature_c, relative_humidity, pressure_hpa, station_pressure_hpa, station_altitude_m]);
    out.extend([rayleigh_density_ratio, rayleigh_scale_height_m, rayleigh_extinction_per_m]);
    let AerosolLayer {
        extinction_per_m,
        angstrom_exponent,
        absorption_angstrom_exponent,
        single_scattering_albedo,
        asymmetry,
        scale_height_m,
        reference_altitude_m,
    } = aerosol;
    out.extend([extinction_per_m, angstrom_exponent, absorption_angstrom_exponent, single_scattering_albedo]);
    out.extend([asymmetry, scale_height_m, reference_altitude_m]);
    let GroundLayer {
        extinction_per_m,
        angstrom_exponent,
        single_scattering_albedo,
        asymmetry,
        base_m,
        top_m,
        softness_m,
        coverage,
        patch_size_m,
        lifted,
    } = fog;
    out.extend([extinction_per_m, angstrom_exponent, single_scattering_albedo, asymmetry, base_m, top_m, softness_m]);
    out.extend([coverage, patch_size_m, lifted]);
    let Falling {
        rain_mm_h,
        drizzle_mm_h,
        snow_mm_h,
        grain_share: _,
        crystal_share: _,
        ice_pellets_mm_h,
        hail_mm_h,
        freezing,
        showers,
        thunder,
        liquid_extinction_per_m,
        solid_extinction_per_m,
    } = precipitation;
    // The shares of the kinds of snow may jump where there is no snow.
    out.extend(precipitation.snow_kinds_mm_h());
    out.extend([rain_mm_h, drizzle_mm_h, snow_mm_h, ice_pellets_mm_h, hail_mm_h, freezing, showers, thunder]);
    out.extend([liquid_extinction_per_m, solid_extinction_per_m]);
    for slab in clouds {
        let CloudSlab {
            cover,
            base_m,
            thickness_m,
            optical_depth,
            droplet_radius_um,
            asymmetry,
            convection,
            ice_fraction,
            scale_m,
            cellular,
            fibre,
            wind_m_s,
            life_s,
        } = slab;
        out.extend([cover, base_m, thickness_m, optical_depth, droplet_radius_um, asymmetry, convection, ice_fraction]);
        out.extend([scale_m, cellular, fibre, life_s]);
        // The wind of a layer may turn at any rate where its cover is close to 0.
        out.extend(wind_m_s.map(|v| v * cover));
    }
    let WindProfile {
        east_m_s,
        north_m_s,
        gust_m_s,
        turbulence_intensity,
        wander_deg,
        roughness_length_m,
        sea_roughness_length_m,
        up_m_s,
    } = wind;
    out.extend([east_m_s, north_m_s, gust_m_s, turbulence_intensity, wander_deg, roughness_length_m]);
    out.extend([sea_roughness_length_m, up_m_s]);
    let SeaState {
        significant_wave_height_m,
        given_share,
        swell_height_m,
        swell_period_s,
        swell_east,
        swell_north,
        temperature_c,
    } = sea;
    out.push(given_share);
    out.extend([significant_wave_height_m, swell_height_m, swell_period_s, swell_east, swell_north, temperature_c]);
    out.extend([c.visibility_m(), c.cloud_cover(), clear_sky]);
}

/// Light at a place: on the ground and above the fog, and the shares of the picture's sky.
fn light(context: &Context, up_m: f64, t: f64) -> Vec<f64> {
    let scene = context.scene_at(DVec3::Z * up_m, t).unwrap();
    let mut out = vec![scene.ground.total_lux, scene.ground.adaptation_cd_m2, luminance(scene.ground.sky_lux)];
    // Shares of a picture are judged by their absolute change, hence the 1 added.
    out.extend([scene.above_fog.total_lux, 1.0 + scene.deck_cover, 1.0 + scene.medium_share]);
    for lit in [scene.ground, scene.above_fog] {
        out.extend([lit.sun_lux, lit.moon_lux, lit.sky_lux].as_flattened());
    }
    out.extend([scene.sun.direct_share, scene.moon.direct_share]);
    out.extend(scene.deck_cd_m2);
    out
}

fn luminance(rgb: [f64; 3]) -> f64 {
    0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]
}

/// Transmittance along a nearly level and a rising line, and the rain.
fn sight_and_rain(context: &Context, t: f64) -> Vec<f64> {
    let mut out = Vec::new();
    for to in [DVec3::new(300.0, 900.0, 40.0), DVec3::new(900.0, -400.0, 700.0)] {
        out.extend(context.between(DVec3::Z * 2.0, to, t).unwrap().transmittance);
    }
    let rain = context.rain_at(DVec3::Z * 2.0, t).unwrap();
    out.extend([rain.rate_mm_h, rain.extinction_per_m, rain.number_per_m3, rain.liquid_g_m3, rain.drops_per_m2_s]);
    out.extend([rain.ice_mm_h, rain.stones_per_m3, rain.stone_extinction_per_m, rain.stones_per_m2_s]);
    out
}

/// Largest change over a microsecond, in units of the greatest allowed one.
#[derive(Clone, Copy, Default)]
struct Steepest {
    change: f64,
    number: usize,
    at_s: f64,
}

/// Finds the steepest change of `f`: of all numbers within a microsecond of each of the `seams`, and of the first
/// `followed` numbers also between the first and the last seam. There that one of [`PLACES`] intervals in which a
/// number changes most is halved down to a microsecond.
fn steepest(f: &dyn Fn(f64) -> Vec<f64>, followed: usize, seams: &[f64]) -> Steepest {
    let ends: Vec<_> = seams.iter().map(|t| f(*t)).collect();
    let (from_s, to_s) = (seams[0], seams[seams.len() - 1]);
    let place = |k: usize| from_s + (to_s - from_s) * k as f64 / PLACES as f64;
    let grid: Vec<_> = if followed == 0 { Vec::new() } else { (0..=PLACES).map(|k| f(place(k))).collect() };
    let near = seams.iter().flat_map(|t| NEAR_S.iter().flat_map(move |s| [t - s, t + s]));
    let near: Vec<_> = if followed == 0 { Vec::new() } else { near.map(f).collect() };
    let part = |i: usize, a: &[f64], b: &[f64]| {
        // A value may be large only between two seams, where another change overtook the first.
        let larger_end = ends.iter().chain(&grid).chain(&near).map(|at| at[i].abs()).fold(0.0, f64::max);
        let size = a[i].abs().max(b[i].abs()).max(1e-3 * larger_end);
        if a[i] == b[i] { 0.0 } else { (b[i] - a[i]).abs() / (size * MOST) }
    };
    let mut worst = Steepest::default();
    let mut take = |change: f64, number: usize, at_s: f64| {
        if change.is_nan() || change > worst.change {
            worst = Steepest { change, number, at_s };
        }
    };
    for (seam, end) in seams.iter().zip(&ends) {
        let [before, after] = [f(seam - MICROSECOND), f(seam + MICROSECOND)];
        (0..end.len()).for_each(|i| take(part(i, &before, end).max(part(i, end, &after)), i, *seam));
    }
    if followed == 0 {
        return worst;
    }
    for i in 0..followed.min(ends[0].len()) {
        let steep = |k: &usize| part(i, &grid[*k], &grid[*k + 1]);
        let k = (0..PLACES).max_by(|a, b| steep(a).total_cmp(&steep(b))).unwrap();
        let (mut a, mut b) = ((place(k), grid[k].clone()), (place(k + 1), grid[k + 1].clone()));
        // A change that is small over a longer time is assumed small over each microsecond of it.
        while b.0 - a.0 > MICROSECOND && part(i, &a.1, &b.1) > 1.0 {
            let t = 0.5 * (a.0 + b.0);
            let middle = (t, f(t));
            if part(i, &a.1, &middle.1) > part(i, &middle.1, &b.1) { b = middle } else { a = middle }
        }
        take(if b.0 - a.0 > MICROSECOND { 0.0 } else { part(i, &a.1, &b.1) }, i, a.0);
    }
    worst
}

/// A context with sun and moon in the `n`th position, and the height of the eye above the station.
fn lit(host: &Host, n: usize) -> (Context, f64) {
    let mut context = host.context();
    // Clouds as a volume drift through a line of sight faster than weather may change.
    context.set_cloud_model(CloudModel::Deck);
    let elevation_deg = [50.0, 12.0, 2.0, -7.0][n % 4];
    context.set_sun(Some(GivenDirection { azimuth_deg: 140.0, elevation_deg })).unwrap();
    context.set_moon(Some(GivenDirection { azimuth_deg: 250.0, elevation_deg: 30.0 })).unwrap();
    (context, [2.0, 700.0, 2600.0][n / 4 % 3])
}

/// Messages about numbers of a context that jump at the `seams` of its weather's changes, and with `between` also
/// between them. `changes` is how many changes are under way at once: each may move numbers as fast as alone.
fn jumps(context: &Context, up_m: f64, seams: &[f64], between: bool, changes: f64) -> Vec<String> {
    let conditions = |t: f64| {
        let mut out = Vec::with_capacity(192);
        numbers(&context.conditions_at(DVec3::ZERO, t).unwrap(), &mut out);
        out
    };
    let followed = |numbers: usize| if between { numbers } else { 0 };
    let found = [
        ("conditions", steepest(&conditions, followed(usize::MAX), seams)),
        ("light", steepest(&|t| light(context, up_m, t), followed(6), seams)),
        ("sight and rain", steepest(&|t| sight_and_rain(context, t), followed(8), seams)),
    ];
    let jumping = found.into_iter().filter(|(_, s)| s.change.is_nan() || s.change > changes);
    jumping
        .map(|(what, s)| format!("number {} of {what} by {} of what it may at {} s", s.number, s.change, s.at_s))
        .collect()
}

/// A layer that the picture draws as a volume until it is closed, and then as a deck, hides as much on either side of
/// that moment.
#[test]
fn a_layer_that_closes_hides_no_more_at_once() {
    let host = Host::new();
    let mut context = host.context();
    let still = |name| Weather { wind: Wind::default(), ..Weather::preset(name).unwrap() };
    context.set_weather(&still("high_cloud"), 0.0, 0.0).unwrap();
    context.set_weather(&still("heavy_rain"), START_S, LENGTH_S).unwrap();
    let base_m = context.conditions_at(DVec3::ZERO, 1e5).unwrap().cloud_slabs().next().unwrap().base_m;
    let through = |t| context.between(DVec3::Z * 2.0, DVec3::new(5.0, 3.0, base_m + 12.0), t).unwrap().transmittance[1];
    let [before, at, after] = [-1e-3, 0.0, 1e-3].map(|s| through(START_S + LENGTH_S + s));
    println!("{before} before, {at} at, {after} after");
    assert!(at > 0.0 && at < 0.7 * (-0.5f64).exp(), "{at}: there is cloud before it");
    assert!((before / at - 1.0).abs() < 1e-3 && (after / at - 1.0).abs() < 1e-3);
}

#[test]
fn no_preset_becomes_another_with_a_jump() {
    let host = Host::new();
    let presets: Vec<(&str, Weather)> = Weather::preset_names().map(|n| (n, Weather::preset(n).unwrap())).collect();
    let (mut pairs, mut faults) = (0, Vec::new());
    for (a, from) in &presets {
        for (b, to) in presets.iter().filter(|(b, _)| b != a) {
            let (mut context, up_m) = lit(&host, pairs);
            context.set_weather(from, 0.0, 0.0).unwrap();
            context.set_weather(to, START_S, LENGTH_S).unwrap();
            // In these two changes the wind stops lifting dust or spray while some is still in the air.
            let lulls = [("dust_storm", "shallow_fog"), ("storm_at_sea", "fog")].contains(&(a, b));
            let between = accept() || pairs % 29 == 0 || lulls;
            let found = jumps(&context, up_m, &[START_S, START_S + LENGTH_S], between, 1.0);
            faults.extend(found.into_iter().map(|f| format!("{a} to {b}: {f}")));
            pairs += 1;
        }
    }
    assert_eq!(pairs, presets.len() * (presets.len() - 1));
    assert!(faults.is_empty(), "{} of {pairs}, among them {:#?}", faults.len(), &faults[..faults.len().min(10)]);
}

#[test]
fn a_change_hides_no_less_of_the_sky_than_one_of_its_ends_and_no_more_than_the_other() {
    let all: Vec<Conditions> =
        Weather::preset_names().map(|n| derive(&Weather::preset(n).unwrap()).unwrap()).chain(layered()).collect();
    for (i, a) in all.iter().enumerate() {
        for (j, b) in all.iter().enumerate() {
            let ends = [a.cloud_cover(), b.cloud_cover()];
            let (least, most) = (ends[0].min(ends[1]) - 1e-12, ends[0].max(ends[1]) + 1e-12);
            for t in (0..=64).map(|k| f64::from(k) / 64.0) {
                let c = a.lerp(b, t);
                let cover = c.cloud_cover();
                assert!((least..=most).contains(&cover), "{i} to {j} at {t}: {cover} between {ends:?}");
                for ((a, b), c) in a.clouds.iter().zip(&b.clouds).zip(&c.clouds) {
                    let within = a.cover.min(b.cover)..=a.cover.max(b.cover);
                    assert!(within.contains(&c.cover), "{i} to {j} at {t}: {} outside {within:?}", c.cover);
                }
            }
        }
    }
}

/// Skies of one to sixteen layers, high and low.
fn layered() -> Vec<Conditions> {
    let mut dice = Dice(3);
    let skies = (1..=MAX_CLOUD_LAYERS).map(|count| {
        let mut layer = || CloudLayer::new(dice.below(9) as f64 / 8.0, 10.0 * dice.below(1200) as f64);
        Weather { clouds: (0..count).map(|_| layer()).collect(), ..Weather::default() }
    });
    skies.map(|w| derive(&w).unwrap()).collect()
}

/// Reports that differ in their cloud layers, precipitation, fog and lifted particles.
const REPORTS: [&str; 12] = [
    "METAR EGLL 060850Z 21006KT CAVOK 20/10 Q1020",
    "METAR EGLL 060850Z 21006KT 9999 FEW010 SCT030 BKN080 OVC200 15/10 Q1012",
    "METAR EGLL 060850Z 09012KT 3000 RA OVC006 11/10 Q1003",
    "METAR EGLL 060850Z 27025G40KT 1500 +SHRA BKN012CB OVC040 11/10 Q0998",
    "METAR EGLL 060850Z 00000KT 0150 FG VV001 03/03 Q1025",
    "METAR EGLL 060850Z 03003KT 9000 MIFG FEW200 02/02 Q1025",
    "METAR EGLL 060850Z 03003KT 4000 BCFG BKN003 02/02 Q1025",
    "METAR EGLL 060850Z 02030KT 0300 +SN BLSN VV002 M06/M07 Q0985",
    "METAR EGLL 060850Z 18008KT 2500 -DZ BR BKN003 OVC009 09/08 Q1008",
    "METAR EGLL 060850Z 32035KT 0600 DS SKC 38/05 Q1001",
    "METAR EGLL 060850Z 24015G30KT 2000 TSRAGR SCT010 BKN025CB OVC090 18/17 Q1002",
    "METAR EGLL 060850Z 06010KT 1200 FZRA OVC004 M01/M02 Q1006",
];

/// Tests changes between reports and presets that begin while others are under way.
#[test]
fn no_chain_of_changes_jumps() {
    let host = Host::new();
    let reports = REPORTS.map(|text| Weather::from_metar(text).unwrap_or_else(|e| panic!("{text}: {e}")).weather);
    let presets = Weather::preset_names().map(|n| Weather::preset(n).unwrap());
    let all: Vec<Weather> = reports.into_iter().chain(presets).collect();
    let (mut dice, mut faults) = (Dice(17), Vec::new());
    for n in 0..if accept() { 400 } else { 8 } {
        let (mut context, up_m) = lit(&host, n);
        let (mut start, mut seams) = (START_S, Vec::new());
        context.set_weather(&all[dice.below(all.len())], 0.0, 0.0).unwrap();
        for _ in 0..3 {
            context.set_weather(&all[dice.below(all.len())], start, LENGTH_S).unwrap();
            seams.extend([start, start + LENGTH_S]);
            start += dice.below(LENGTH_S as usize + 200) as f64;
        }
        seams.sort_by(f64::total_cmp);
        let found = jumps(&context, up_m, &seams, true, 3.0);
        faults.extend(found.into_iter().map(|f| format!("chain {n}, changes at {seams:?}: {f}")));
    }
    assert!(faults.is_empty(), "{} faults, among them {:#?}", faults.len(), &faults[..faults.len().min(10)]);
}
