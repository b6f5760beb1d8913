//! Scripted runs end in states whose hashes are committed: the same on every machine, in every build, whatever
//! instructions the compiler may use.
//!
//! `WELKIN_BLESS=1` writes the hashes of this build. A change of the models changes them, and its notes must say so.

use std::fmt::Write as _;

use glam::{DMat3, DVec3};
use welkin::{
    almanac::Utc,
    context::{Context, ContextDesc},
    flow::{WindFieldDesc, WindFieldMode},
    ground::{GroundModel, SurfaceClass},
    lightning::{FlashKind, FlashTrigger, LightningSettings, StormCell},
    planet::Planet,
    rain::{AreaMotion, AreaRain, AreaShape, RainArea, Shelter},
    scene::{Axes, Place, WorldFrame, WorldKind},
    snowpack::LyingSnowModel,
    weather::{CloudMap, Fog, FogKind, Precipitation, PrecipitationKind, Surface, Weather, Wind},
};

use crate::{
    inputs::{Tiles, grid, rainfall, roof, snowfall},
    whole::{context, context_of},
};

/// The committed hashes, one line for each run with the hashes of its moments.
const PINNED: &str = include_str!("hashes.txt");

/// Hashes of the states and query results of a run's moments.
#[derive(Default)]
struct Moments(Vec<u64>);

impl Moments {
    /// Advances a context to a time and adds the hash of its state.
    fn at(&mut self, context: &mut Context, time_s: f64) {
        context.update(time_s).unwrap();
        self.0.push(context.state_hash().unwrap());
    }

    /// Adds a hash of the bits of query results (FNV-1a).
    fn answers(&mut self, numbers: impl IntoIterator<Item = f64>) {
        let fold = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        let bytes = numbers.into_iter().flat_map(|v| (v + 0.0).to_bits().to_le_bytes());
        self.0.push(bytes.fold(0xcbf2_9ce4_8422_2325, fold));
    }
}

fn snow(m: &mut Moments) {
    let mut c = context();
    c.set_weather(&snowfall(7), 0.0, 0.0).unwrap();
    c.set_shelters(&[roof(1), roof(2)]).unwrap();
    c.set_ground_grid(Some(grid(4))).unwrap();
    c.set_weather(&Weather { temperature_c: 5.0, wind: Wind::of(4.0, 200.0), ..Weather::default() }, 1200.0, 300.0)
        .unwrap();
    [900.0, 1800.0, 4000.0].into_iter().for_each(|t| m.at(&mut c, t));
    c.accumulate(3.0).unwrap();
    let next_s = c.time_s() + 1.0;
    m.at(&mut c, next_s);
}

fn wet_ground(m: &mut Moments) {
    let mut c = context();
    let mut ground = grid(3);
    ground.classes = (0..ground.heights_m.len()).map(|i| SurfaceClass::ALL[i % SurfaceClass::ALL.len()]).collect();
    c.set_ground_grid(Some(ground)).unwrap();
    c.set_shelters(&[roof(3)]).unwrap();
    c.set_weather(&rainfall(4), 0.0, 0.0).unwrap();
    c.set_weather(&Weather::default(), 2000.0, 120.0).unwrap();
    [700.0, 2500.0, 9000.0].into_iter().for_each(|t| m.at(&mut c, t));
}

fn tiles(m: &mut Moments) {
    // An Earth-centred world, whose axes lie askew to those of the tiles.
    let origin = Place { latitude_deg: 50.0, longitude_deg: 8.5, altitude_m: 100.0 };
    let world = WorldFrame { kind: WorldKind::Ecef, origin, geoid_height_m: 47.8, ..WorldFrame::default() };
    let mut c = context_of(ContextDesc {
        world,
        ground: GroundModel::Simulated,
        lying_snow: LyingSnowModel::Simulated,
        ..ContextDesc::default()
    });
    let mut tiles = Tiles::default();
    tiles.set_terrain_at(&mut c, Place { altitude_m: 147.8, ..origin }.to_ecef());
    tiles.set_tile(&mut c, [0, 0], 1);
    tiles.set_tile(&mut c, [-1, 0], 2);
    c.set_weather(&rainfall(3), 0.0, 0.0).unwrap();
    m.at(&mut c, 600.0);
    tiles.dig(&mut c, 5);
    m.at(&mut c, 1500.0);
    tiles.remove_one(&mut c);
    m.at(&mut c, 2400.0);
}

fn field(mode: WindFieldMode) -> WindFieldDesc {
    let floor_center = DVec3::new(0.0, 0.0, -1.0);
    WindFieldDesc { floor_center, cell_m: DVec3::splat(2.0), cells: [16, 12, 8], mode, ..WindFieldDesc::default() }
}

fn steady_wind(m: &mut Moments) {
    let mut c = context();
    c.set_weather(&snowfall(20), 0.0, 0.0).unwrap();
    c.set_ground_grid(Some(grid(4))).unwrap();
    c.set_shelters(&[roof(1)]).unwrap();
    c.set_wind_field(Some(&field(WindFieldMode::Steady)), 0.0).unwrap();
    [30.0, 60.0, 120.0, 180.0].into_iter().for_each(|t| m.at(&mut c, t));
    let at = |i: u32| DVec3::new(f64::from(i) - 8.0, 1.0, 2.0);
    m.answers((0..16).flat_map(|i| c.wind_at(at(i), 180.0).unwrap().velocity_m_s.to_array()));
}

fn running_wind(m: &mut Moments) {
    let mut c = context();
    c.set_weather(&Weather { wind: Wind::of(9.0, 250.0), ..Weather::default() }, 0.0, 0.0).unwrap();
    let van = Shelter { velocity_m_s: DVec3::new(2.0, 0.0, 0.0), ..roof(2) };
    c.set_shelters(&[roof(0), van]).unwrap();
    c.set_wind_field(Some(&field(WindFieldMode::Running)), 0.0).unwrap();
    [1.0, 5.0, 12.0].into_iter().for_each(|t| m.at(&mut c, t));
}

fn lightning(m: &mut Moments) {
    let mut c = context();
    let cell = StormCell { position: DVec3::new(3000.0, 500.0, 0.0), radius_m: 2000.0, flashes_per_minute: 8.0 };
    let masts = vec![DVec3::new(2500.0, 400.0, 80.0)];
    c.set_lightning(LightningSettings { cells: vec![cell], masts, ..LightningSettings::default() }).unwrap();
    let position = DVec3::new(50.0, 20.0, 0.0);
    let flash = FlashTrigger { time_s: 4.0, position, kind: FlashKind::ToGround, peak_ka: None, strokes: None };
    c.trigger_flash(&flash).unwrap();
    c.set_weather(&Weather { wind: Wind::of(8.0, 220.0), ..Weather::preset("thunderstorm").unwrap() }, 0.0, 0.0)
        .unwrap();
    m.at(&mut c, 60.0);
    let flashes = c.flashes_near(DVec3::ZERO, (0.0, 600.0), 20_000.0).unwrap();
    assert!(flashes.len() > 20, "{}", flashes.len());
    let numbers = |f: &welkin::lightning::FlashEvent| {
        let [x, y, z] = f.position.to_array();
        [f.time_s, f.peak_ka, x, y, z, f.distance_m, f.thunder_delay_s, f64::from(f.strokes)]
    };
    m.answers(flashes.iter().flat_map(numbers));
}

fn clouds(m: &mut Moments) {
    let mut c = context();
    c.set_weather(&Weather::preset("overcast").unwrap(), 0.0, 0.0).unwrap();
    let cover = (0..25).map(|i| (i % 5) as f32 * 0.25).collect();
    let map = CloudMap { first_m: [-2000.0; 2], cell_m: 1000.0, cells: [5, 5], base_m: [0.0, 12_000.0], cover };
    c.set_cloud_map(Some(map)).unwrap();
    c.set_weather(&Weather::preset("scattered").unwrap(), 600.0, 1800.0).unwrap();
    [300.0, 1500.0, 40_000.0].into_iter().for_each(|t| m.at(&mut c, t));
    let layers = c.conditions_at(DVec3::ZERO, 40_000.0).unwrap();
    m.answers([layers.visibility_m(), layers.air.rayleigh_scale_height_m]);
}

fn areas(m: &mut Moments) {
    let world =
        WorldFrame { axes: Axes::YUp, kind: WorldKind::Tangent, grid_bearing_deg: 30.0, ..WorldFrame::default() };
    let mut c = context_of(ContextDesc { world, ground: GroundModel::Simulated, ..ContextDesc::default() });
    c.set_weather(&Weather { wind: Wind::of(11.0, 265.0), ..Weather::default() }, 0.0, 0.0).unwrap();
    let area = |i: u32| RainArea {
        center_m: [400.0 * f64::from(i), 0.0, 700.0],
        shape: AreaShape::Ellipse([900.0, 600.0]),
        heading_deg: 40.0,
        rate_mm_h: 6.0 + f64::from(i),
        kind: if i == 1 { AreaRain::Showers } else { AreaRain::Rain },
        motion: if i == 2 { AreaMotion::Own([3.0, -1.0]) } else { AreaMotion::WithWind },
        ..RainArea::default()
    };
    c.set_rain_areas(&[area(0), area(1), area(2)]).unwrap();
    [200.0, 900.0].into_iter().for_each(|t| m.at(&mut c, t));
    let rates = (0..40).map(|i| c.rain_at(DVec3::new(200.0 * f64::from(i), 1.0, 0.0), 900.0).unwrap());
    m.answers(rates.flat_map(|r| [r.rate_mm_h]));
}

fn planets(m: &mut Moments) {
    let mut c = context();
    c.set_weather(&rainfall(1), 0.0, 0.0).unwrap();
    for (i, text) in
        [include_str!("../../examples/data/planet_dusty.toml"), include_str!("../../examples/data/planet_golden.toml")]
            .iter()
            .enumerate()
    {
        c.set_planet(&Planet::from_toml(text).unwrap()).unwrap();
        c.set_clock(Utc::from_calendar(2026, 6, 21, 9 + i as u32, 15, 0.0).unwrap(), c.time_s()).unwrap();
        let next_s = c.time_s() + 2000.0;
        m.at(&mut c, next_s);
    }
}

fn long_transitions(m: &mut Moments) {
    let mut c = context();
    let fog = Fog { kind: FogKind::Fog, top_m: Some(80.0), coverage: None, visibility_inside_m: None };
    let weathers = [
        Weather { visibility_m: 300.0, fog, ..Weather::default() },
        Weather {
            precipitation: Precipitation::of(PrecipitationKind::Drizzle, 0.6),
            wind: Wind::of(3.0, 10.0),
            ..Weather::default()
        },
        Weather { surface: Surface { snow_depth_m: 0.3, ..Surface::default() }, ..snowfall(11) },
        Weather { wind: Wind { gust_m_s: Some(25.0), ..Wind::of(15.0, 300.0) }, ..Weather::default() },
    ];
    for (i, weather) in weathers.iter().enumerate() {
        c.set_weather(weather, 20_000.0 * i as f64, 30_000.0).unwrap();
    }
    for t in [9_999.5, 33_333.3, 70_000.0, 250_000.0] {
        m.at(&mut c, t);
        let (wind, drift) = (c.wind_at(DVec3::Z * 30.0, t).unwrap(), c.wind_displacement(t).unwrap());
        let now = c.conditions_at(DVec3::ZERO, t).unwrap();
        let place = DVec3::new(4.0, 3.0, 0.0);
        let ground = c.ground_at(place).unwrap();
        let turned = DMat3::from_cols(wind.velocity_m_s, wind.mean_m_s, drift).to_cols_array();
        m.answers(turned.into_iter().chain([now.visibility_m(), ground.water_mm, ground.wetness]));
    }
}

/// A run with its name.
type Run = (&'static str, fn(&mut Moments));

const RUNS: [Run; 10] = [
    ("snow", snow),
    ("wet_ground", wet_ground),
    ("tiles", tiles),
    ("steady_wind", steady_wind),
    ("running_wind", running_wind),
    ("lightning", lightning),
    ("clouds", clouds),
    ("areas", areas),
    ("planets", planets),
    ("long_transitions", long_transitions),
];

#[test]
fn scripted_runs_end_in_the_states_that_are_committed() {
    let mut found = String::new();
    for (name, run) in RUNS {
        let mut moments = Moments::default();
        run(&mut moments);
        let hashes: Vec<_> = moments.0.iter().map(|hash| format!("{hash:016x}")).collect();
        writeln!(found, "{name} {}", hashes.join(" ")).unwrap();
    }
    if std::env::var_os("WELKIN_BLESS").is_some() {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/states/hashes.txt");
        std::fs::write(path, &found).unwrap();
        return;
    }
    let differ = |(pinned, found): (&str, &str)| (pinned != found).then(|| format!("{pinned}\n{found}"));
    let pinned = PINNED.replace('\r', "");
    let differences: Vec<_> = pinned.lines().zip(found.lines()).filter_map(differ).collect();
    assert!(differences.is_empty(), "committed, and found here:\n{}", differences.join("\n"));
    assert_eq!(pinned.lines().count(), RUNS.len());
}
