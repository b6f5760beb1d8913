//! Snow on the glass: the same bits as its twin; it gathers, wipers remove it, heat melts it, and it hides the picture.

use welkin::{
    frame::{FrameFlags, Stages},
    glass::{
        Reach, Windscreen, WiperArm,
        frost::Snowing,
        reference::{Cells, Snow},
        step::{StepConditions, Tables, VOLUME_UNIT_M3},
    },
    gpu::{Device, DeviceOptions},
    rain::drops::factor_in,
    weather::{Precipitation, PrecipitationKind, Weather},
};

use crate::{
    cells::{acting_on, wiper},
    host::{Host, upright},
};

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
const SMALL: (u32, u32) = (64, 36);
/// Cells of the upright pane.
const SIZE: [u32; 2] = [100, 60];

fn snowfall(rate_mm_h: f64, temperature_c: f64) -> Weather {
    let kind = if rate_mm_h > 0.0 { PrecipitationKind::Snow } else { PrecipitationKind::None };
    Weather {
        precipitation: Precipitation { kind, rate_mm_h, ..Default::default() },
        temperature_c,
        relative_humidity: 0.95,
        visibility_m: 1000.0,
        ..Weather::default()
    }
}

fn host(options: &DeviceOptions, rate_mm_h: f64, temperature_c: f64) -> Host {
    let mut host = Host::on(Device::headless(options).unwrap(), FORMAT, SMALL, 0.0, 7);
    host.context.set_weather(&snowfall(rate_mm_h, temperature_c), 0.0, 0.0).unwrap();
    host
}

/// Draws a host's glass over a range of time, half a second a frame.
fn run(host: &mut Host, screen: &Windscreen, [from_s, to_s]: [f64; 2]) {
    host.view.set_windscreen(Some(screen)).unwrap();
    let frames = ((to_s - from_s) / 0.5).round() as u32;
    for i in 0..=frames {
        host.at(from_s + 0.5 * f64::from(i), Stages::PREPARE, FrameFlags(0)).unwrap();
    }
}

fn snow_kg_m2(host: &Host) -> f64 {
    let report = host.view.windscreen_report().unwrap().unwrap();
    report.snow_m3 * 998.0 / (0.4 * 0.24)
}

#[test]
fn the_gpu_has_the_bits_of_the_twin() {
    for backends in [DeviceOptions::default().backends, wgpu::Backends::GL] {
        let options = DeviceOptions { backends, force_tier0: true, ..DeviceOptions::default() };
        let mut host = host(&options, 30.0, -2.0);
        let screen = Windscreen { heat_w_m2: 900.0, ..upright() };
        host.view.set_windscreen(Some(&screen)).unwrap();
        let weather = host.context.conditions_at(glam::DVec3::new(0.0, 0.0, 3.0), 0.0).unwrap();
        let snow = Snowing::new(&weather.precipitation, -2.0, factor_in(&weather.air, 0.0));
        let acts = StepConditions { heat_w_m2: 900.0, snow, ..acting_on(&host, 0.0) };
        let mut tables = Tables::default();
        host.at(50.0, Stages::PREPARE, FrameFlags(0)).unwrap();
        let numbers = tables.at((&acts, &Reach::ALL), 7, 3000, SIZE, &[None; 2]);
        let (mut water, mut snow) = (Cells::declared(&numbers), Snow::declared(&numbers));
        assert!(host.view.windscreen_snow().unwrap().unwrap() == snow, "the declared state");
        assert!(snow.cells.iter().any(|c| *c > 0));
        let mut position = 0.0;
        for step in 3001..3100 {
            let next = if step < 3060 { 0.0 } else { f64::from(step - 3060) * 0.02 };
            let arms = [(step >= 3050).then(|| wiper(next)), None];
            host.view.set_windscreen(Some(&Windscreen { arms, ..screen })).unwrap();
            host.at(f64::from(step) / 60.0, Stages::PREPARE, FrameFlags(0)).unwrap();
            let angle = |a: &WiperArm, p: f64| (a.parked_deg + (a.far_deg - a.parked_deg) * p).to_radians();
            let arms = arms.map(|arm| arm.map(|a| (a, [angle(&a, position), angle(&a, next)])));
            let numbers = tables.at((&acts, &Reach::ALL), 7, step.into(), SIZE, &arms);
            (water, snow) = (water.stepped_under(&numbers, Some(&snow)), snow.settled(&numbers));
            position = next;
            if step % 33 == 0 {
                assert!(host.view.windscreen_snow().unwrap().unwrap() == snow, "snow of step {step}");
                assert!(host.view.windscreen_cells().unwrap().unwrap() == water, "water of step {step}");
            }
        }
        assert!(water.water() > 0, "some has melted");
    }
}

#[test]
fn snow_gathers_as_the_flux_says_and_stays_in_the_cold() {
    let mut host = host(&DeviceOptions::default(), 5.0, -5.0);
    let screen = upright();
    run(&mut host, &screen, [0.0, 1.0]);
    let begun = snow_kg_m2(&host);
    run(&mut host, &screen, [1.0, 121.0]);
    let gathered = snow_kg_m2(&host) - begun;
    let acts = StepConditions {
        snow: Snowing::new(&host.context.conditions_at(glam::DVec3::Z, 0.0).unwrap().precipitation, -5.0, 1.0),
        ..acting_on(&host, 0.0)
    };
    let want = acts.snow.stays_m_s(0.0, 20.0) * 998.0 * 120.0;
    println!("{gathered:.4} kg/m^2 in two minutes, {want:.4} by the flux");
    // Thousands of flakes: their number varies by 2 %.
    assert!((gathered / want - 1.0).abs() < 0.1, "{gathered} {want}");
    // The snowfall ends: no flakes are added, and no snow is removed.
    host.context.set_weather(&snowfall(0.0, -5.0), 121.0, 0.0).unwrap();
    run(&mut host, &screen, [121.5, 123.0]);
    let before = snow_kg_m2(&host);
    let passes = host.view.report().passes;
    run(&mut host, &screen, [123.0, 183.0]);
    assert_eq!(snow_kg_m2(&host), before);
    assert!(host.view.report().passes <= passes);
}

#[test]
fn wipers_take_snow_and_heat_melts_it() {
    let mut host = host(&DeviceOptions::default(), 20.0, -1.0);
    run(&mut host, &upright(), [0.0, 90.0]);
    host.context.set_weather(&snowfall(0.0, -1.0), 90.0, 0.0).unwrap();
    let laid = snow_kg_m2(&host);
    let mut time_s = 90.5;
    for i in 0..=20 {
        let screen = Windscreen { arms: [Some(wiper(f64::from(i) / 20.0)), None], ..upright() };
        run(&mut host, &screen, [time_s, time_s]);
        time_s += 0.1;
    }
    let wiped = snow_kg_m2(&host);
    // The sector has (0.28^2 - 0.06^2) (140 degrees) / 2 of 0.096 m^2, a part of it outside of the pane.
    println!("{laid:.3} kg/m^2, {wiped:.3} after one stroke");
    assert!(wiped < 0.5 * laid && wiped > 0.05 * laid);
    let at = |host: &Host| host.view.windscreen_report().unwrap().unwrap().water_m3 / VOLUME_UNIT_M3;
    assert_eq!(at(&host), 0.0);
    let heated = Windscreen { heat_w_m2: 2500.0, ..upright() };
    run(&mut host, &heated, [time_s, time_s + 5.0]);
    assert!(at(&host) > 0.0, "melt water");
    run(&mut host, &heated, [time_s + 5.0, time_s + 300.0]);
    assert!(host.view.windscreen_snow().unwrap().is_none_or(|s| s.water_m3() == 0.0), "all has melted");
}

#[test]
fn snow_hides_the_picture_and_lets_its_light_through() {
    let mut host = host(&DeviceOptions::default(), 100.0, -5.0);
    run(&mut host, &upright(), [0.0, 60.0]);
    host.paint();
    let before = host.pixels();
    host.at(60.1, Stages::PREPARE.with(Stages::LENS), FrameFlags(0)).unwrap();
    let after = host.pixels();
    // The middle of the picture, which the pane covers.
    let spread = |p: &[[f32; 4]]| {
        let inside = |i: &usize| (16..48).contains(&(i % 64)) && (9..27).contains(&(i / 64));
        let green: Vec<f64> = (0..p.len()).filter(inside).map(|i| f64::from(p[i][1])).collect();
        let mean = green.iter().sum::<f64>() / green.len() as f64;
        (mean, (green.iter().map(|g| (g - mean).powi(2)).sum::<f64>() / green.len() as f64).sqrt())
    };
    let ((bright, varied), (lit, hidden)) = (spread(&before), spread(&after));
    println!("before {bright:.3} +- {varied:.3}, through snow {lit:.3} +- {hidden:.3}");
    assert!(hidden < 0.2 * varied, "{hidden} {varied}");
    assert!((0.2..0.8).contains(&(lit / bright)));
}
