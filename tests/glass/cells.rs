//! The cells: the same bits as their twin, at any frame rate, on any view; drops arrive at the rate of the flux.

use glam::{DVec2, DVec3};
use welkin::{
    frame::{FrameFlags, Stages},
    glass::{
        Pane, Reach, Windscreen, WiperArm,
        frost::Snowing,
        laws::volume_factor,
        reference::Cells,
        step::{StepConditions, Tables, VOLUME_UNIT_M3},
    },
    gpu::{Device, DeviceOptions},
    rain::RainSurface,
    rain::{drops::factor_in, sizes::DropSizes},
};

use crate::host::{Host, upright};

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
const SMALL: (u32, u32) = (64, 36);

fn glass(host: &Host) -> Cells {
    host.view.windscreen_cells().unwrap().expect("wet glass")
}

/// Returns the conditions of a step for the host's windscreen.
fn acting(rate_mm_h: f64) -> StepConditions {
    StepConditions {
        cell_m: 0.004,
        rain: DropSizes::of_rain(rate_mm_h, 1.0),
        exposed: 1.0,
        up: 0.0,
        approach_m_s: 20.0,
        airflow_m_s: 0.0,
        down: DVec2::new(0.0, -1.0),
        relative_humidity: 0.95,
        temperature_c: 15.0,
        snow: Snowing::default(),
        heat_w_m2: 0.0,
    }
}

/// Returns these conditions from the host's own weather, with the same bits.
pub fn acting_on(host: &Host, rate_mm_h: f64) -> StepConditions {
    let weather = host.context.conditions_at(DVec3::new(0.0, 0.0, 3.0), 0.0).unwrap();
    let rain = DropSizes::new(&weather.precipitation, factor_in(&weather.air, 0.0));
    StepConditions { rain, temperature_c: weather.air.temperature_c, ..acting(rate_mm_h) }
}

pub fn wiper(position: f64) -> WiperArm {
    WiperArm {
        pivot_m: [0.2, -0.05],
        length_m: 0.28,
        inner_radius_m: 0.06,
        parked_deg: 20.0,
        far_deg: 160.0,
        position,
        blade_width_m: 0.006,
    }
}

/// Returns a second wiper to the left of the first; their sectors overlap.
fn other_wiper(position: f64) -> WiperArm {
    WiperArm { pivot_m: [0.08, -0.04], length_m: 0.2, parked_deg: 150.0, far_deg: 15.0, ..wiper(position) }
}

#[test]
fn the_gpu_has_the_bits_of_the_twin() {
    for backends in [DeviceOptions::default().backends, wgpu::Backends::GL] {
        let options = DeviceOptions { backends, force_tier0: true, ..DeviceOptions::default() };
        has_the_bits_of_the_twin(Host::on(Device::headless(&options).unwrap(), FORMAT, SMALL, 80.0, 7));
    }
}

fn has_the_bits_of_the_twin(mut host: Host) {
    let screen = Windscreen { airflow_m_s: 3.0, ..upright() };
    host.view.set_windscreen(Some(&screen)).unwrap();
    let acts = StepConditions { airflow_m_s: 3.0, ..acting_on(&host, 80.0) };
    let mut tables = Tables::default();
    host.at(50.0, Stages::PREPARE, FrameFlags(0)).unwrap();
    let mut twin = Cells::declared(&tables.at((&acts, &Reach::ALL), 7, 3000, [100, 60], &[None; 2]));
    assert!(glass(&host) == twin, "the declared state");
    let (mut position, mut ran) = (0.0, false);
    for step in 3001..3120 {
        let next = if step < 3080 { 0.0 } else { f64::from(step - 3080) * 0.02 };
        let arms = [(step >= 3060).then(|| wiper(next)), (step >= 3070).then(|| other_wiper(next))];
        host.view.set_windscreen(Some(&Windscreen { arms, ..screen })).unwrap();
        host.at(f64::from(step) / 60.0, Stages::PREPARE, FrameFlags(0)).unwrap();
        let angle = |a: &WiperArm, p: f64| (a.parked_deg + (a.far_deg - a.parked_deg) * p).to_radians();
        let arms = arms.map(|arm| arm.map(|a| (a, [angle(&a, position), angle(&a, next)])));
        twin = twin.stepped(&tables.at((&acts, &Reach::ALL), 7, step.into(), [100, 60], &arms));
        position = next;
        ran = ran || twin.cells.iter().any(|c| c[2] & 0xffff > 0);
        if step % 8 == 0 {
            assert!(glass(&host) == twin, "step {step}");
        }
    }
    assert!(ran, "nothing ran: the test asks too little");
}

#[test]
fn drops_arrive_as_the_flux_says() {
    // Four seconds on 960 cm^2, from dry glass in saturated air, without gravity: nothing runs, nothing dries.
    let acts = StepConditions { relative_humidity: 1.0, down: DVec2::ZERO, ..acting(20.0) };
    let (mut tables, size) = (Tables::default(), [100, 60]);
    let mut cells = Cells::dry(size);
    for step in 0..240 {
        cells = cells.stepped(&tables.at((&acts, &Reach::ALL), 3, step, size, &[None; 2]));
    }
    let flux = acts.rain.on_surface(DVec3::Y, DVec3::Y * -20.0);
    let area_s = 0.4 * 0.24 * 4.0;
    let hits: u64 = cells.cells.iter().map(|c| u64::from(c[3] & 4095)).sum();
    let expected = flux.drops_per_m2_s * area_s;
    assert!((hits as f64 - expected).abs() < 4.0 * expected.sqrt() + 0.002 * expected, "{hits} of {expected}");
    let water = cells.water() as f64 * VOLUME_UNIT_M3;
    let due = flux.rate_mm_h / 3.6e6 * area_s;
    // The standard deviation of a drop's volume is about 15 times its mean.
    assert!((water / due - 1.0).abs() < 4.0 * 15.0 / expected.sqrt(), "{water} of {due} m^3, {hits} drops");
}

/// The report's counts agree with a query for a surface in the pane's place.
#[test]
fn drops_land_on_the_pane_as_the_query_for_such_a_surface_says() {
    let mut host = Host::new(FORMAT, SMALL, 12.0);
    for (k, (speed, tilt)) in [(0.0, 0.0f64), (8.0, 0.3), (25.0, 0.6)].into_iter().enumerate() {
        // The camera looks along y with z up; the pane leans back over it.
        let (sin, cos) = tilt.sin_cos();
        let corner = |x: f64, up: f64| DVec3::new(x, 0.6 * up * cos, -0.5 + 0.6 * up * sin);
        let corners = [corner(-0.4, -0.5), corner(0.4, -0.5), corner(0.4, 0.5), corner(-0.4, 0.5)];
        let velocity = DVec3::new(0.0, 0.0, -speed);
        let screen = Windscreen { pane: Pane::Quad(corners), velocity_m_s: velocity, ..Windscreen::default() };
        host.view.set_windscreen(Some(&screen)).unwrap();
        host.at(k as f64 / 60.0, Stages::PREPARE, FrameFlags(FrameFlags::CUT.0)).unwrap();
        let report = host.view.windscreen_report().unwrap().unwrap();
        let surface = RainSurface {
            position: DVec3::new(0.0, 0.0, 3.0),
            normal: DVec3::new(0.0, cos, sin),
            velocity_m_s: DVec3::new(0.0, speed, 0.0),
            area_m2: 0.8 * 0.6,
        };
        let asked = host.context.rain_on(&surface, k as f64 / 60.0).unwrap();
        assert!((report.drops_per_s - asked.drops_per_s).abs() <= 5e-3 * asked.drops_per_s, "{report:?} {asked:?}");
        assert!((report.water_mm_h - asked.rate_mm_h).abs() <= 5e-3 * asked.rate_mm_h, "{report:?} {asked:?}");
        assert!(speed == 0.0 || report.drops_per_s > 10.0, "{report:?}");
    }
}

#[test]
fn the_frame_rate_changes_nothing() {
    let maps = [15.0, 30.0, 60.0].map(|rate_hz| {
        let mut host = Host::new(FORMAT, SMALL, 120.0);
        let screen = Windscreen { arms: [Some(wiper(0.3)), None], airflow_m_s: -4.0, ..upright() };
        host.view.set_windscreen(Some(&screen)).unwrap();
        host.at(10.0, Stages::PREPARE, FrameFlags(0)).unwrap();
        host.run(10.0, 12.0, rate_hz);
        glass(&host)
    });
    assert!(maps[0] == maps[1] && maps[1] == maps[2]);
    assert!(maps[0].cells.iter().any(|c| c[2] & 0xffff > 0), "and something runs");
}

#[test]
fn views_of_a_seed_agree_and_seeds_differ() {
    let run = |seed| {
        let device = Device::headless(&DeviceOptions::default()).unwrap();
        let mut host = Host::on(device, FORMAT, SMALL, 30.0, seed);
        host.view.set_windscreen(Some(&upright())).unwrap();
        host.at(5.0, Stages::PREPARE, FrameFlags(0)).unwrap();
        host.run(5.0, 6.0, 20.0);
        glass(&host)
    };
    assert!(run(1) == run(1) && run(1) != run(2));
}

#[test]
fn a_cut_and_no_history_show_the_declared_state() {
    let mut host = Host::new(FORMAT, SMALL, 40.0);
    host.view.set_windscreen(Some(&upright())).unwrap();
    host.at(20.0, Stages::PREPARE, FrameFlags(0)).unwrap();
    host.run(20.0, 21.0, 30.0);
    let with_history = glass(&host);
    let mut other = Host::new(FORMAT, SMALL, 40.0);
    other.view.set_windscreen(Some(&upright())).unwrap();
    other.at(21.0, Stages::PREPARE, FrameFlags::NO_HISTORY).unwrap();
    assert!(glass(&other) != with_history);
    host.at(21.0, Stages::PREPARE, FrameFlags::CUT).unwrap();
    assert!(glass(&host) == glass(&other));
}

/// Water inside the sector that a blade has passed, in the middle of its reach.
fn in_sector(cells: &Cells, from_deg: f64, to_deg: f64) -> (u64, usize) {
    in_sector_of(&wiper(0.0), cells, from_deg, to_deg)
}

fn in_sector_of(arm: &WiperArm, cells: &Cells, from_deg: f64, to_deg: f64) -> (u64, usize) {
    let (mut water, mut count) = (0, 0);
    for (i, cell) in cells.cells.iter().enumerate() {
        let [x, y] = [i as u32 % cells.size[0], i as u32 / cells.size[0]].map(|n| (f64::from(n) + 0.5) * 0.004);
        let d = DVec2::new(x - arm.pivot_m[0], y - arm.pivot_m[1]);
        let angle = d.to_angle().to_degrees();
        if (0.1..arm.length_m - 0.03).contains(&d.length()) && (from_deg..to_deg).contains(&angle) {
            water += u64::from(cell[0]);
            count += 1;
        }
    }
    (water, count)
}

#[test]
fn a_blade_clears_what_it_passes_and_beads_come_back() {
    let mut host = Host::new(FORMAT, SMALL, 60.0);
    let screen = |position| Windscreen { arms: [Some(wiper(position)), None], ..upright() };
    host.view.set_windscreen(Some(&screen(0.0))).unwrap();
    host.at(30.0, Stages::PREPARE, FrameFlags(0)).unwrap();
    let (before, count) = in_sector(&glass(&host), 30.0, 150.0);
    assert!(before > 0 && count > 200, "{before} {count}");
    // One stroke in half a second, frames at 20 Hz.
    for i in 1..=10 {
        host.view.set_windscreen(Some(&screen(f64::from(i) / 10.0))).unwrap();
        host.at(30.0 + f64::from(i) / 20.0, Stages::PREPARE, FrameFlags(0)).unwrap();
    }
    let stroke = glass(&host);
    let report = host.view.windscreen_report().unwrap().unwrap();
    // The part that the blade passed last has had 0.1 s of rain.
    let (fresh, _) = in_sector(&stroke, 130.0, 155.0);
    assert!((fresh as f64) < 0.02 * before as f64, "{fresh} of {before}");
    let (after, _) = in_sector(&stroke, 30.0, 150.0);
    assert!((after as f64) < 0.1 * before as f64, "{after} of {before}");
    host.run(30.5, 36.5, 10.0);
    let (back, _) = in_sector(&glass(&host), 30.0, 150.0);
    assert!(back > 4 * after, "{back} after {after}");
    let later = host.view.windscreen_report().unwrap().unwrap();
    assert!(later.covered > report.covered && later.drops_per_s > 100.0);
}

#[test]
fn two_blades_clear_both_their_sectors() {
    let mut host = Host::new(FORMAT, SMALL, 60.0);
    let arm = |x, position| WiperArm { pivot_m: [x, -0.04], length_m: 0.2, ..wiper(position) };
    let screen = |p| Windscreen { arms: [Some(arm(0.08, p)), Some(arm(0.32, p))], ..upright() };
    host.view.set_windscreen(Some(&screen(0.0))).unwrap();
    host.at(30.0, Stages::PREPARE, FrameFlags(0)).unwrap();
    let sectors = |cells: &Cells| {
        // Parts of the pane that only one wiper reaches, and the rest.
        let own = [(0.08, 95.0, 155.0), (0.32, 25.0, 85.0)].map(|(x, a, b)| in_sector_of(&arm(x, 0.0), cells, a, b).0);
        (own, cells.water() - own[0] - own[1])
    };
    let (before, rest_before) = sectors(&glass(&host));
    for i in 1..=10 {
        host.view.set_windscreen(Some(&screen(f64::from(i) / 10.0))).unwrap();
        host.at(30.0 + f64::from(i) / 20.0, Stages::PREPARE, FrameFlags(0)).unwrap();
    }
    let (after, rest_after) = sectors(&glass(&host));
    for (after, before) in after.iter().zip(&before) {
        assert!(*before > 0 && (*after as f64) < 0.3 * *before as f64, "{after} of {before}");
    }
    assert!(rest_after > rest_before / 5, "and not what lies beyond: {rest_after} of {rest_before}");
}

#[test]
fn a_bead_beyond_the_critical_size_runs_and_leaves_a_lane_with_gaps() {
    let acts = StepConditions { exposed: 0.0, relative_humidity: 1.0, ..acting(20.0) };
    let (mut tables, size) = (Tables::default(), [40, 60]);
    let volume = |r: f64| (volume_factor() * r.powi(3) / VOLUME_UNIT_M3) as u32;
    let run = |r: f64, tables: &mut Tables| {
        // Small beads that touch no other, one a cell, and one that is larger.
        let mut cells = Cells::dry(size);
        cells.cells.fill([volume(8e-4), 0x8000_8000, 0, 1]);
        cells.cells[55 * 40 + 20][0] = volume(r);
        for step in 0..120 {
            cells = cells.stepped(&tables.at((&acts, &Reach::ALL), 3, step, size, &[None; 2]));
        }
        cells
    };
    let resting = run(2e-3, &mut tables);
    assert!(resting.cells[55 * 40 + 20][0] == volume(2e-3) && resting.cells.iter().all(|c| c[3] & 4095 == 1), "rests");
    let cells = run(3.4e-3, &mut tables);
    let lane: Vec<usize> = (0..cells.cells.len()).filter(|i| cells.cells[*i][3] & 4095 == 0).collect();
    let lowest = lane.iter().map(|i| i / 40).min().unwrap();
    assert!(lowest < 35, "it ran from row 55 to row {lowest}");
    // Cells above the bead: its lane.
    let behind: Vec<u32> = lane.iter().filter(|i| *i / 40 > lowest + 2).map(|i| cells.cells[*i][0]).collect();
    let mean = behind.iter().map(|v| f64::from(*v)).sum::<f64>() / behind.len() as f64;
    assert!(behind.len() > 15 && mean < 2.0 * f64::from(volume(8e-4)), "{} cells, {mean} units", behind.len());
    let clear = behind.iter().filter(|v| **v == 0).count();
    assert!(clear > behind.len() / 5, "{clear} clear ones of {}", behind.len());
}

#[test]
fn dry_glass_takes_no_pass_and_no_state() {
    let mut host = Host::new(FORMAT, SMALL, 0.0);
    host.paint();
    let painted = host.pixels();
    host.at(1.0, Stages::LENS, FrameFlags(0)).unwrap();
    let without = host.view.report().passes;
    host.view.set_windscreen(Some(&upright())).unwrap();
    for t in [2.0, 2.5, 2.51] {
        host.at(t, Stages::LENS, FrameFlags(0)).unwrap();
        assert_eq!(host.view.report().passes, without);
    }
    assert!(host.pixels() == painted && host.view.windscreen_cells().unwrap().is_none());
    let report = host.view.windscreen_report().unwrap().unwrap();
    assert!(report.drops_per_s == 0.0 && report.covered == 0.0 && report.state_time_s > 2.4);
}

#[test]
fn rain_ends_and_the_glass_dries() {
    let mut host = Host::new(FORMAT, SMALL, 30.0);
    host.view.set_windscreen(Some(&upright())).unwrap();
    host.at(1.0, Stages::PREPARE, FrameFlags(0)).unwrap();
    let dry = welkin::weather::Weather { relative_humidity: 0.2, temperature_c: 30.0, ..Default::default() };
    host.context.set_weather(&dry, 1.0, 0.0).unwrap();
    let mut windy = upright();
    windy.airflow_m_s = 30.0;
    host.view.set_windscreen(Some(&windy)).unwrap();
    host.at(1.1, Stages::PREPARE, FrameFlags(0)).unwrap();
    let wet = glass(&host).water();
    let mut last = wet;
    for i in 1..400 {
        host.at(1.1 + 0.5 * f64::from(i), Stages::PREPARE, FrameFlags(0)).unwrap();
        if i % 40 == 0 {
            let Some(cells) = host.view.windscreen_cells().unwrap() else { return };
            assert!(cells.water() < last || last == 0, "{} of {wet}", cells.water());
            last = cells.water();
        }
    }
    assert!(last < wet / 50, "{last} of {wet}");
}

#[test]
fn extremes_stay_finite() {
    for rate in [0.1, 500.0] {
        let mut host = Host::new(FORMAT, SMALL, rate);
        let mut screen = upright();
        let mut time_s = 0.0;
        for (i, dt) in [0.0, 0.0, 1e-9, 0.02, 0.4, 1.0, 10.0, 0.5, 1e6, 0.1, 0.0].into_iter().enumerate() {
            time_s += dt;
            screen.airflow_m_s = [0.0, 100.0, -100.0][i % 3];
            screen.velocity_m_s.z = [-400.0, 400.0, 0.0][i % 3];
            host.view.set_windscreen(Some(&screen)).unwrap();
            host.paint();
            host.at(time_s, Stages::ALL, FrameFlags(0)).unwrap();
            assert!(host.pixels().iter().flatten().all(|v| v.is_finite()));
            if let Some(cells) = host.view.windscreen_cells().unwrap() {
                let most = cells.cells.iter().map(|c| c[0]).max().unwrap();
                assert!(most < 500_000, "{most} units in a cell");
            }
            let report = host.view.windscreen_report().unwrap().unwrap();
            let step_behind = time_s - report.state_time_s;
            assert!((0.0..1.0).contains(&report.covered) && (-1e-6..0.02).contains(&step_behind), "{report:?}");
        }
    }
}
