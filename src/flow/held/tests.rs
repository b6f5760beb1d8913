//! Tests of the wind field that a context holds: its dates, steps, moves and saved states, and the wind that the world
//! reads from it.

use std::time::{Duration, Instant};

use glam::{DMat3, DVec3, dvec3};

use super::*;
use crate::{
    almanac::sun::Utc,
    flow::{PressureMethod, Scheme, WindFieldMode, WindWalls},
    light::{Exposure, ToneCurve},
    planet::Planet,
    scene::WorldFrame,
    surroundings::{Planes, Shelter},
    weather::{Weather, Wind, derive},
    world::{Couplings, WorldDesc},
};

/// A world with a wind field, stepped as in a context.
struct Bench {
    world: World,
    flow: HeldFlow,
}

fn house(center_m: DVec3, velocity_m_s: DVec3) -> Shelter {
    let half_size_m = dvec3(8.0, 8.0, 6.0);
    Shelter { center_m, axes: DMat3::IDENTITY, half_size_m, velocity_m_s, planes: Planes::NONE }
}

fn weather(speed_m_s: f64) -> Weather {
    Weather { wind: Wind::of(speed_m_s, 270.0), ..Weather::default() }
}

fn small(mode: WindFieldMode) -> WindFieldDesc {
    WindFieldDesc { cells: [24, 16, 8], mode, ..WindFieldDesc::default() }
}

impl Bench {
    fn new(mode: WindFieldMode) -> Self {
        let made = WorldDesc {
            frame: WorldFrame::default(),
            planet: Planet::earth(),
            seed: 3,
            exposure: Exposure::default(),
            tone: ToneCurve::default(),
            utc_at_zero: Utc(1_782_036_000.0),
        };
        // These tests compute no light.
        let couplings = Couplings {
            dim: |_| Ok(()),
            cloud_over_areas: |_, _, _, _| Ok(None),
            night_lux: |_, _, _, _| Ok([0.0; 3]),
        };
        let weather = derive(&weather(8.0)).expect("a weather");
        let mut world = World::new(made, weather, couplings).expect("a world");
        world.set.shelters.push(house(dvec3(-10.0, 0.0, 6.0), DVec3::ZERO));
        let mut bench = Self { world, flow: HeldFlow::default() };
        bench.flow.set(&bench.world, Some(small(mode)), 0.0).expect("a field");
        bench
    }

    fn to(&mut self, time_s: f64) {
        self.world.keep_carried(time_s).expect("regions");
        self.world.time_s = time_s;
        while self.advance(Duration::ZERO) == Status::Pending {}
        self.world.forget_before(self.flow.stepped_to_s().unwrap_or(time_s));
    }

    fn advance(&mut self, most: Duration) -> Status {
        let led = self
            .flow
            .advance(&self.world, UpdateBudget { until_s: self.world.time_s, begun: Instant::now(), most })
            .expect("led");
        self.flow.publish(&mut self.world);
        led
    }

    fn saved(&self) -> toml::Table {
        let mut table = toml::Table::new();
        self.flow.save(&mut table).expect("saved");
        table
    }

    fn wind(&self, p: DVec3) -> DVec3 {
        self.world.wind_at(p, self.world.time_s).expect("a wind").velocity_m_s
    }

    fn report(&self) -> WindFieldReport {
        self.flow.report().expect("a field")
    }
}

#[test]
fn the_wind_of_a_field_is_the_weathers_at_its_sides_and_slow_behind_a_house() {
    for mode in [WindFieldMode::Running, WindFieldMode::Steady] {
        let mut bench = Bench::new(mode);
        bench.to(20.0);
        let [lee, beside, far] =
            [dvec3(2.0, 0.0, 3.0), dvec3(-10.0, 14.0, 3.0), dvec3(0.0, 0.0, 200.0)].map(|p| bench.wind(p));
        let at =
            |h: f64| bench.world.over().wind.at(20.0).at_height(&bench.world.timeline.at(20.0).wind, h).velocity_m_s;
        println!("{mode:?}: lee {lee:.2} beside {beside:.2} weather's {:.2}", at(3.0));
        assert!(lee.x < 0.5 * at(3.0).x && beside.x > at(3.0).x, "{mode:?}: {lee} {beside}");
        assert_eq!(far, at(200.0));
        // The wind is continuous across the sides of the field.
        for side in [dvec3(-48.0, 3.0, 5.0), dvec3(48.0, 3.0, 5.0), dvec3(5.0, 32.0, 5.0), dvec3(5.0, -3.0, 32.0)] {
            let [within, beyond] = [0.999, 1.001].map(|s| bench.wind(side * s));
            assert!((within - beyond).length() < 0.05, "{mode:?} {side}: {within} {beyond}");
        }
        // The solved field holds for its own time: for an earlier time the world returns the weather's wind.
        let past = bench.world.wind_at(dvec3(2.0, 0.0, 3.0), -100.0).expect("a wind").velocity_m_s;
        assert!(past.x > 2.0, "{past}");
    }
}

#[test]
fn a_field_that_rests_is_still_there_minutes_later() {
    let mut bench = Bench::new(WindFieldMode::Steady);
    let behind = dvec3(2.0, 0.0, 3.0);
    bench.to(50.0);
    let early = bench.wind(behind);
    for time_s in [100.0, 155.0, 1000.0 / 3.0, 350.0, 400.0, 459.0] {
        bench.to(time_s);
        let ahead = bench.world.wind_at(behind, time_s + 57.0).expect("a wind").velocity_m_s;
        let now = bench.wind(behind);
        println!("{time_s}: {now} {ahead} {early}");
        assert!(
            now.x < 0.3 * bench.wind(dvec3(2.0, 0.0, 200.0)).x && ahead.x < 0.3 * 8.0,
            "{time_s}: {now}, {ahead}, first {early}"
        );
    }
    assert!(bench.report().rests);
}

#[test]
fn channels_with_other_frame_rates_have_the_same_field_to_the_bit() {
    for mode in [WindFieldMode::Running, WindFieldMode::Steady] {
        let states = [1.0 / 30.0, 1.0 / 60.0, 0.7, 6.0].map(|frame_s: f64| {
            let mut bench = Bench::new(mode);
            bench.world.change_weather(derive(&weather(11.0)).expect("a weather"), 1.0, 3.0).expect("a change");
            let moved = WindFieldDesc { floor_center: dvec3(9.0, -4.5, 0.0), ..small(mode) };
            bench.flow.set(&bench.world, Some(moved), 3.3).expect("a move");
            for i in 1.. {
                let t = frame_s * f64::from(i);
                bench.to(t.min(6.0));
                if t >= 6.0 {
                    break;
                }
            }
            bench.saved()
        });
        assert!(states.iter().all(|s| *s == states[0]), "{mode:?}");
        assert!(states[0][KEY]["field"]["corner"] == toml::Value::try_from([-10, -9, 0]).expect("a value"));
    }
}

#[test]
fn a_loaded_field_goes_on_to_the_bit() {
    for mode in [WindFieldMode::Running, WindFieldMode::Steady] {
        let mut bench = Bench::new(mode);
        bench.world.set.shelters.push(house(dvec3(20.0, 12.0, 6.0), dvec3(-1.0, 0.5, 0.0)));
        bench.to(4.25);
        let mut table = bench.saved();
        let mut other = Bench::new(mode);
        other.world.set.shelters.push(house(dvec3(20.0, 12.0, 6.0), dvec3(-1.0, 0.5, 0.0)));
        other.world.time_s = 4.25;
        let mut loaded = HeldFlow::read(&other.world, &mut table).expect("a field");
        assert!(table.is_empty());
        other.flow.swap_in(&mut other.world, &mut loaded);
        assert_eq!(other.wind(dvec3(3.0, 1.0, 4.0)), bench.wind(dvec3(3.0, 1.0, 4.0)));
        assert_eq!(other.saved(), bench.saved());
        for t in [4.4, 6.0, 11.0] {
            bench.to(t);
            other.to(t);
            assert!(other.saved() == bench.saved(), "{mode:?} at {t} s");
        }
    }
}

/// The wind behind the house, and the state, of a field of a scheme and a method for the pressure after a few steps;
/// the state goes on as the field does.
fn led_by(scheme: Scheme, pressure: PressureMethod) -> (DVec3, toml::Table) {
    let desc = WindFieldDesc { scheme, pressure, ..small(WindFieldMode::Running) };
    let mut bench = Bench::new(WindFieldMode::Running);
    bench.flow.set(&bench.world, Some(desc), 0.0).expect("a field");
    bench.to(2.0);
    let state = bench.saved();
    let mut other = Bench::new(WindFieldMode::Running);
    other.world.time_s = 2.0;
    let mut loaded = HeldFlow::read(&other.world, &mut state.clone()).expect("a field");
    other.flow.swap_in(&mut other.world, &mut loaded);
    assert_eq!(other.flow.live.as_ref().map(|live| live.desc), Some(desc));
    [&mut bench, &mut other].into_iter().for_each(|bench| bench.to(4.0));
    assert!(other.saved() == bench.saved(), "{scheme:?} {pressure:?}");
    (bench.wind(dvec3(2.0, 0.0, 3.0)), state)
}

#[test]
fn each_scheme_and_method_gives_another_wind_and_the_state_names_it() {
    let usual = PressureMethod::default();
    let (wind, state) = led_by(Scheme::Reflection, usual);
    let field = |state: &toml::Table| state[KEY]["field"].as_table().expect("a field").clone();
    assert_eq!(field(&state)["solver"].as_str(), Some("reflection 1"));
    // States of the usual scheme and method name neither, as before there was a choice.
    let desc = field(&state)["desc"].as_table().expect("a desc").clone();
    assert!(!desc.contains_key("scheme") && !desc.contains_key("pressure"), "{desc}");
    for (scheme, pressure, solver) in [
        (Scheme::SemiLagrangian, usual, "semi-lagrangian 1"),
        (Scheme::MacCormack, PressureMethod::FIVE_SWEEPS, "maccormack 1"),
        (Scheme::Reflection, PressureMethod::FIVE_SWEEPS, "reflection 1"),
    ] {
        let (other, state) = led_by(scheme, pressure);
        println!("{scheme:?} {pressure:?}: {other:.3}, the usual {wind:.3}");
        assert_ne!(other, wind, "{scheme:?} {pressure:?}");
        assert_eq!(field(&state)["solver"].as_str(), Some(solver));
        let world = &Bench::new(WindFieldMode::Running).world;
        let broken = |change: fn(&mut toml::Table), sentence: &str| {
            let mut state = state.clone();
            change(state[KEY]["field"].as_table_mut().expect("a field"));
            let e = HeldFlow::read(world, &mut state).map(|_| ()).expect_err("a broken state");
            assert!(e.status == Status::Parse && e.to_string().contains(sentence), "{e}");
        };
        broken(|f| f["solver"] = "maccormack 9".into(), "must be of the solver");
        broken(
            |f| _ = f["desc"].as_table_mut().expect("a desc").insert("scheme".into(), "upwind".into()),
            "`semi-lagrangian`, `maccormack`, `reflection`",
        );
    }
}

#[test]
fn a_steady_field_rests_and_wakes_with_the_wind_or_a_house() {
    let mut bench = Bench::new(WindFieldMode::Steady);
    let mut slept_s = 0.0;
    while !{
        slept_s += 2.0;
        bench.to(slept_s);
        bench.report().rests
    } {
        assert!(slept_s < 120.0, "it does not rest");
    }
    println!("rests after {slept_s} s");
    let before = bench.world.solved_wind.as_ref().expect("a volume").revision();
    bench.to(slept_s + 30.0);
    // A resting field is neither stepped nor published again.
    assert_eq!(bench.world.solved_wind.as_ref().expect("a volume").revision(), before);
    bench.world.set.shelters[0].center_m.x += 4.0;
    bench.to(slept_s + 34.0);
    assert!(!bench.report().rests && bench.report().begun_s == 0.0);
    bench.to(slept_s + 120.0 - 30.0);
    let at = bench.world.time_s;
    bench.world.change_weather(derive(&weather(12.0)).expect("a weather"), at, 0.0).expect("a change");
    bench.to(at + 4.0);
    assert!(!bench.report().rests);
}

#[test]
fn a_long_leap_begins_the_field_anew_and_reports_it_and_a_short_one_does_not() {
    let mut bench = Bench::new(WindFieldMode::Running);
    bench.to(1.0);
    assert_eq!(bench.report().begun_s, 0.0);
    bench.to(10.0);
    assert_eq!((bench.report().begun_s, bench.report().time_s), (0.0, 10.0));
    bench.to(1000.3);
    assert_eq!((bench.report().begun_s, bench.report().time_s), (1000.0, 1000.0));
}

#[test]
fn a_field_comes_goes_and_follows_its_place_at_its_dates() {
    let mut bench = Bench::new(WindFieldMode::Running);
    let lee = dvec3(2.0, 0.0, 3.0);
    let desc = WindFieldDesc { floor_center: dvec3(12.0, 0.0, 0.0), ..small(WindFieldMode::Running) };
    bench.flow.set(&bench.world, Some(desc), 2.0).expect("a move");
    bench.flow.set(&bench.world, None, 4.0).expect("an end");
    let e = bench.flow.set(&bench.world, None, 3.9).expect_err("before the last");
    assert_eq!((e.status, e.field()), (Status::WrongOrder, Some("start_time_s")));
    bench.to(2.0);
    let before = bench.wind(lee);
    assert_eq!(bench.report().corner, dvec3(-48.0, -32.0, 0.0));
    bench.to(2.5);
    // The air keeps its place in the world: only the box of the field has moved.
    let after = bench.wind(lee);
    println!("before the move {before:.2}, after it {after:.2}");
    assert_eq!(bench.report().corner, dvec3(-36.0, -32.0, 0.0));
    assert!((after - before).length() < 1.0 && bench.report().begun_s == 0.0);
    bench.to(4.5);
    assert!(bench.flow.report().is_none() && bench.world.solved_wind.is_none() && bench.saved().is_empty());
}

#[test]
fn a_moving_box_pushes_the_air_ahead_of_it() {
    let run = |velocity: DVec3| {
        let mut bench = Bench::new(WindFieldMode::Running);
        bench.world.change_weather(derive(&weather(0.0)).expect("a weather"), 0.0, 0.0).expect("calm");
        for i in 0..=8 {
            let t = 0.5 * f64::from(i);
            bench.world.set.shelters[0] = house(dvec3(-20.0, 0.0, 6.0) + velocity * t, velocity);
            bench.to(t);
        }
        let at = bench.world.set.shelters[0].center_m;
        [
            bench.wind(at + dvec3(12.0, 0.0, -2.0)),
            bench.wind(at - dvec3(12.0, 0.0, 2.0)),
            bench.wind(at + dvec3(0.0, 14.0, 0.0)),
        ]
    };
    assert_eq!(run(DVec3::ZERO), [DVec3::ZERO; 3]);
    let [before, behind, beside] = run(dvec3(5.0, 0.0, 0.0));
    println!("before {before:.2} behind {behind:.2} beside {beside:.2}");
    assert!(before.x > 1.0 && behind.x > 1.0 && beside.x < 0.1, "{before} {behind} {beside}");
}

#[test]
fn bad_fields_and_states_are_refused_and_leave_the_one_that_runs() {
    let mut bench = Bench::new(WindFieldMode::Running);
    bench.to(1.0);
    let before = bench.saved();
    let good = small(WindFieldMode::Running);
    let large = WindFieldDesc { cells: [2048, 2048, 512], ..good };
    let e = bench.flow.set(&bench.world, Some(large), 2.0).expect_err("too large");
    assert_eq!((e.status, e.field()), (Status::InvalidArgument, Some("wind_field.cells")));
    for (desc, start_s) in [
        (WindFieldDesc { cell_m: DVec3::splat(f64::NAN), ..good }, 2.0),
        (WindFieldDesc { floor_center: DVec3::splat(1e13), ..good }, 2.0),
        (good, 0.5),
        (good, f64::NAN),
    ] {
        bench.flow.set(&bench.world, Some(desc), start_s).expect_err("refused");
    }
    assert_eq!(bench.saved(), before);
    let read = |change: fn(&mut toml::Table)| {
        let mut table = before.clone();
        change(table[KEY].as_table_mut().expect("a table")["field"].as_table_mut().expect("a field"));
        let e = HeldFlow::read(&bench.world, &mut table).map(|_| ()).expect_err("a broken state");
        assert_eq!(e.status, Status::Parse, "{e}");
    };
    read(|f| f["numbers"] = "AAAA".into());
    read(|f| f["solver"] = "another".into());
    read(|f| f["last_dt_s"] = (-1.0).into());
    read(|f| f["anchor_axes"] = toml::Value::try_from([2.0; 9]).expect("a value"));
    read(|f| f["desc"]["cells"] = toml::Value::try_from([4, 4, 4]).expect("a value"));
    read(|f| f["stood"] = toml::Value::try_from(["x", "0"]).expect("a value"));
}

#[test]
fn over_rough_ground_the_wind_keeps_its_profile_and_smooth_walls_do_not_slow_it() {
    let near = |walls: WindWalls| {
        let mut bench = Bench::new(WindFieldMode::Running);
        bench.world.set.shelters.clear();
        let desc = WindFieldDesc { walls, cell_m: dvec3(4.0, 4.0, 1.0), ..small(WindFieldMode::Running) };
        bench.flow.set(&bench.world, Some(desc), 0.0).expect("a field");
        bench.to(20.0);
        bench.wind(dvec3(20.0, 0.0, 0.5)).length()
    };
    let [rough, smooth] = [WindWalls::Rough, WindWalls::Smooth].map(near);
    let mut bench = Bench::new(WindFieldMode::Running);
    bench.world.time_s = 20.0;
    let comes = bench.wind(dvec3(20.0, 0.0, 0.5)).length();
    println!("comes with {comes:.2} m/s, rough {rough:.2} m/s, smooth {smooth:.2} m/s");
    assert!(rough < smooth && (rough / comes - 1.0).abs() < 0.2, "{rough} {smooth} {comes}");
}

/// Returns the root mean square of the vertical wind 24 m up in a field over open ground, from 31 s to 60 s, m/s.
fn upward_m_s(mode: WindFieldMode) -> f64 {
    let mut bench = Bench::new(mode);
    bench.world.set.shelters.clear();
    let desc = WindFieldDesc { cells: [32, 32, 12], ..small(mode) };
    bench.flow.set(&bench.world, Some(desc), 0.0).expect("a field");
    let (mut sum, mut count) = (0.0, 0.0);
    for second in 1..=60 {
        bench.to(f64::from(second));
        if second > 30 {
            for i in 0..16 {
                let place = dvec3(f64::from(i % 4) * 20.0 - 30.0, f64::from(i / 4) * 20.0 - 30.0, 24.0);
                sum += bench.wind(place).z.powi(2);
                count += 1.0;
            }
        }
    }
    (sum / count).sqrt()
}

#[test]
fn whirls_come_in_with_gusts_and_none_with_the_mean_wind() {
    let [running, steady] = [WindFieldMode::Running, WindFieldMode::Steady].map(upward_m_s);
    println!("upward {running:.3} m/s with gusts, {steady:.4} without");
    // Eddies of all lengths together have a vertical standard deviation of 1.25 u* = 0.69 m/s. The field resolves those
    // of 16 to 64 m, which have a part of that energy.
    assert!((0.2..0.5).contains(&running) && steady < 0.02, "{running} {steady}");
}

/// Checks that tiles give the same wind as a grid of the same heights, and that a pit dug in a tile changes it.
#[test]
fn tiles_stand_in_the_wind_as_a_grid_of_their_heights_does() {
    use crate::{
        surroundings::TerrainHeights,
        terrain::{Rows, Terrain, TerrainCells, TerrainDesc, TileKey},
    };
    // Two ridges that cross: the triangles of tiles and the bilinear grid are the same surface.
    let ridge = |x: i32| (-f64::from(x * x) / 60.0).exp();
    let hill = |x: i32, y: i32| (15.0 * ridge(x) + 10.0 * ridge(y)) as f32;
    let desc = TerrainDesc { cell_m: 6.0, tile_cells: 32, ..TerrainDesc::default() };
    let mut tiles = Terrain::new(desc, &WorldFrame::default()).unwrap();
    for key in [[-1, -1], [0, -1], [-1, 0], [0, 0]].map(|k: [i32; 2]| TileKey::new(k[0], k[1])) {
        let heights: Vec<f32> = tiles.rect(key).cells().map(|[x, y]| hill(x, y)).collect();
        tiles.set_tile(&TerrainCells { key, heights_m: Rows::of(&heights), ..TerrainCells::default() }).unwrap();
    }
    let heights = (-32..32).flat_map(|y| (-32..32).map(move |x| hill(x, y))).collect();
    let origin = dvec3(-192.0, -192.0, 0.0);
    let grid = TerrainHeights::new((origin, DMat3::IDENTITY), 6.0, [64, 64], heights);
    let speeds = |set: &dyn Fn(&mut World)| {
        let mut bench = Bench::new(WindFieldMode::Running);
        bench.world.set.shelters.clear();
        set(&mut bench.world);
        bench.to(2.0);
        bench.flow.live.as_ref().unwrap().field.numbers().flatten().copied().collect::<Vec<f32>>()
    };
    let of_tiles = speeds(&|world| world.set.tiles = Some(tiles.clone().into()));
    let of_grid = speeds(&|world| world.set.terrain = Some(grid.clone().into()));
    let off = of_tiles.iter().zip(&of_grid).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    assert!(off < 1e-2, "{off}");
    assert_ne!(speeds(&|_| {}), of_grid);
    let pit = vec![-8.0; 64];
    let mut dug = tiles.clone();
    dug.update(&TerrainCells { size: [8, 8], heights_m: Rows::of(&pit), ..TerrainCells::default() }).unwrap();
    let of_dug = speeds(&|world| world.set.tiles = Some(dug.clone().into()));
    assert_ne!(of_dug, of_tiles);
}
