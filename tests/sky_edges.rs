//! Cases in which sky models fail: unusual air, the horizon, twilight, the mirror plane, altitudes, teleports, changing
//! air.

use std::sync::Arc;

use welkin::gpu::{Device, DeviceOptions};
use welkin::sky::probe::{Answer, Probe, Question, Ray};
use welkin::sky::{Observer, Planet, SkyLibrary, SkyModel, SkySettings, SkyTables, SkyVolume, TablesProgress};

fn golden_planet() -> Planet {
    Planet::from_toml(include_str!("../examples/data/planet_golden.toml")).unwrap()
}

fn device() -> Arc<Device> {
    Device::headless(&DeviceOptions::default()).unwrap()
}

/// Coarse tables: these tests check the shape of the sky, not its exact values.
fn coarse(model: SkyModel) -> SkySettings {
    let base = SkySettings::with_model(model);
    SkySettings { suns: 40, altitudes: 12, zeniths: 9, azimuths: 6, rule_azimuths: 6, orders: 4, ..base }
}

fn sane(a: &Answer) -> bool {
    a.radiance.iter().all(|v| v.is_finite() && *v >= 0.0) && a.transmittance.iter().all(|v| (0.0..=1.0).contains(v))
}

#[test]
fn odd_media_give_neither_nan_nor_infinity_nor_less_than_nothing() {
    let base = golden_planet();
    let with = |f: &dyn Fn(&mut Planet)| {
        let mut p = base;
        f(&mut p);
        p
    };
    let none = with(&|p| *p = p.with_air_scaled(0.0));
    let ozone_only = with(&|p| {
        *p = p.with_air_scaled(0.0);
        p.absorption.extinction_per_m = [1e-5; 3];
    });
    let heights = [0.0, 0.01, 1.0, 1e6].map(|h| {
        with(&|p| {
            (p.rayleigh.scale_height_m, p.mie.scale_height_m) = (h, h);
        })
    });
    let shell = with(&|p| {
        p.top_radius_m = p.bottom_radius_m + 1e6;
        p.rayleigh.scale_height_m = 1e6;
    });
    let bright = with(&|p| {
        *p = p.with_air_scaled(100.0);
        p.ground_albedo = [1.0; 3];
        p.mie.scattering_per_m = p.mie.extinction_per_m;
        p.mie.asymmetry_g = 0.9999;
    });
    let mut media = vec![none, ozone_only, base.with_air_scaled(1e4), shell, bright];
    media.extend(heights);
    let device = device();
    for (i, planet) in media.iter().enumerate() {
        let others = if i < 3 { 3 } else { 1 };
        for model in [SkyModel::Directional, SkyModel::IsotropicTables, SkyModel::Table3d].into_iter().take(others) {
            let settings =
                SkySettings { suns: 16, altitudes: 8, zeniths: 5, azimuths: 4, rule_azimuths: 3, ..coarse(model) };
            let mut probe = Probe::new(&device, &settings, planet).unwrap();
            for altitude in [-100.0, 1.7, 5e4, 1e7] {
                for sun in [0.0f64, 91.0, 180.0] {
                    let mut rays = Vec::new();
                    for view in [0.0f64, 60.0, 89.99, 90.0, 90.01, 135.0, 157.2, 180.0] {
                        for distance in [0.0, 1e-3, 50.0, 1e5, 1e9] {
                            rays.push(Ray::at(view.to_radians(), 0.7, distance));
                        }
                    }
                    for q in [Question::Sky, Question::Aerial, Question::Ground] {
                        for (ray, a) in rays.iter().zip(probe.under_sun(q, altitude, sun.to_radians(), &rays).unwrap())
                        {
                            let fine = if q == Question::Ground {
                                a.radiance.iter().chain(&a.transmittance).all(|v| v.is_finite() && *v >= 0.0)
                            } else {
                                sane(&a)
                            };
                            assert!(fine, "{model:?} h {altitude} sun {sun} {q:?} {ray:?} {a:?}\n{planet:?}");
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn horizon_twilight_mirror_and_height_are_smooth() {
    let planet = golden_planet();
    let mut probe = Probe::new(&device(), &coarse(SkyModel::Directional), &planet).unwrap();
    // Sky and ground together hardly jump within 0.1 degrees of the horizon, checked in steps of 0.002.
    for altitude in [1.7f64, 2000.0, 12_000.0] {
        let horizon = 90.0 + (6.36e6 / (6.36e6 + altitude)).acos().to_degrees();
        let scan = |q, probe: &mut Probe| {
            let at = |i: i32| Ray::at((horizon + 0.002 * f64::from(i)).to_radians(), 0.5, 0.0);
            let rays: Vec<Ray> = (-50..=50).map(at).collect();
            probe.under_sun(q, altitude, 1.0, &rays).unwrap()
        };
        let sky = scan(Question::Sky, &mut probe);
        let ground = scan(Question::Ground, &mut probe);
        let sum: Vec<f32> = sky.iter().zip(&ground).map(|(a, b)| a.radiance[1] + b.radiance[1]).collect();
        let whole = sum.iter().fold(0.0f32, |m, v| m.max(*v));
        for (i, pair) in sum.windows(2).enumerate() {
            // At the edge the light of the whole air is followed by that of the ground: from 1.7 m this is ground 5 km
            // away (a dark line, as in nature), from high up ground in haze.
            let edge = (49..=51).contains(&i);
            let limit = match (edge, altitude < 10.0) {
                (true, true) => 0.85,
                (true, false) => 0.3,
                (false, true) => 0.1,
                (false, false) => 0.02,
            };
            assert!((pair[1] - pair[0]).abs() < limit * whole, "h {altitude} at {i}: {pair:?}");
        }
    }
    // Zenith light falls without a step for zenith angles of the sun from 85 to 105 degrees.
    let up = [Ray::at(0.0, 0.0, 0.0)];
    let mut last = f32::MAX;
    for tenth in 850..=1050 {
        let a = probe.under_sun(Question::Sky, 1.0, (f64::from(tenth) * 0.1).to_radians(), &up).unwrap()[0];
        assert!(a.radiance[1] < last, "sun {} {} {last}", f64::from(tenth) * 0.1, a.radiance[1]);
        last = a.radiance[1];
    }
    // The sky is symmetric about the vertical plane of the sun, and continuous across it.
    let around: Vec<Ray> = (0..=60).map(|i| Ray::at(1.3, (f64::from(i) - 30.0) * 0.002, 0.0)).collect();
    let seen = probe.under_sun(Question::Sky, 1.0, 1.4, &around).unwrap();
    for i in 0..=60 {
        assert!((seen[i].radiance[2] / seen[60 - i].radiance[2] - 1.0).abs() < 2e-3, "{i}");
        assert!(i == 0 || (seen[i].radiance[2] / seen[i - 1].radiance[2] - 1.0).abs() < 0.01, "{i}");
    }
    // From below the ground's level to space, the zenith darkens without a step.
    let heights: Vec<f64> = (0..60).map(|i| 1e7 * (f64::from(i) / 59.0).powi(8) - 100.0).collect();
    let mut last = f32::MAX;
    for h in heights {
        let a = probe.under_sun(Question::Sky, h, 0.8, &up).unwrap()[0];
        assert!(a.radiance[0] <= last * 1.001, "{h}");
        last = a.radiance[0];
    }
    assert_eq!(last, 0.0, "no air is above space");
}

#[test]
fn brute_force_converges_and_a_teleport_leaves_nothing() {
    let planet = golden_planet();
    let device = device();
    let rays: Vec<Ray> = [0.2f64, 0.8, 1.3, 1.5].map(|z| Ray::at(z, 0.6, 0.0)).to_vec();
    let mut last: Option<Vec<Answer>> = None;
    let mut gap = f32::MAX;
    for march_cells in [4, 16, 64, 256] {
        let settings = SkySettings { march_cells, ..coarse(SkyModel::BruteForce) };
        let mut probe = Probe::new(&device, &settings, &planet).unwrap();
        let seen = probe.under_sun(Question::Sky, 1.0, 1.45, &rays).unwrap();
        if let Some(last) = &last {
            let off = |(a, b): (&Answer, &Answer)| (a.radiance[0] / b.radiance[0] - 1.0).abs();
            let now = seen.iter().zip(last).map(off).fold(0.0f32, f32::max);
            assert!(now < gap * 0.7 || now < 1e-4, "{march_cells}: {now} after {gap}");
            gap = now;
        }
        last = Some(seen);
    }
    assert!(gap < 1e-3, "{gap}");
    let mut probe = Probe::new(&device, &coarse(SkyModel::Directional), &planet).unwrap();
    let fresh = probe.under_sun(Question::Sky, 12_000.0, 1.55, &rays).unwrap();
    probe.under_sun(Question::Sky, 1e6, 0.1, &rays).unwrap();
    assert_eq!(probe.under_sun(Question::Sky, 12_000.0, 1.55, &rays).unwrap(), fresh);
}

#[test]
fn a_changing_air_is_followed_by_parts_and_nothing_is_drawn_without_need() {
    let device = device();
    let settings = coarse(SkyModel::Directional);
    let mut tables = SkyTables::new(&device, &settings).unwrap();
    let mut volume = SkyVolume::new(&tables).unwrap();
    let planet = golden_planet();
    let mut hazy = planet;
    hazy.mie.extinction_per_m = [1e-4; 3];
    hazy.mie.scattering_per_m = [9e-5; 3];
    let observer = Observer::under_sun(&planet, 10.0, 1.2);
    let light = |tables: &SkyTables| tables.read_light().unwrap().irradiance(0.0, 0.4)[1];
    let mut frame = |tables: &mut SkyTables, planet: &Planet, share: f32| {
        let mut encoder = device.device.create_command_encoder(&Default::default());
        let progress = tables.update(&mut encoder, planet, share).unwrap();
        let drawn = volume.prepare(&mut encoder, tables, &observer).unwrap();
        device.submit_and_wait(encoder).unwrap();
        (progress, drawn)
    };
    assert_eq!(frame(&mut tables, &planet, 1.0 / 16.0).0.done, 1.0, "the first planet is shown at once");
    assert!(!frame(&mut tables, &planet, 1.0 / 16.0).1, "nothing changed, nothing is drawn");
    let before = light(&tables);
    let mut values = vec![before];
    let mut frames = 0;
    loop {
        let (progress, _) = frame(&mut tables, &hazy, 1.0 / 16.0);
        assert!(progress.work <= 1.0 / 16.0 + 1e-4, "{progress:?}");
        values.push(light(&tables));
        frames += 1;
        if progress.done >= 1.0 {
            break;
        }
        assert!(frames < 60);
    }
    assert!(frames >= 32, "16 frames to build, 16 to fade: {frames}");
    let mut fresh = SkyTables::new(&device, &settings).unwrap();
    frame(&mut fresh, &hazy, 1.0);
    let after = light(&fresh);
    assert!((after / before - 1.0).abs() > 0.02, "haze shows: {before} {after}");
    assert_eq!(*values.last().unwrap(), after, "it arrives where a fresh build is");
    let largest = values.windows(2).map(|w| (w[1] - w[0]).abs()).fold(0.0, f32::max);
    assert!(largest < (after - before).abs() / 12.0, "{values:?}");
}

/// A camera that has climbed by less than a thousandth of a scale height keeps the tables of its earlier altitude, and
/// draws the sky of its new one.
#[test]
fn a_climbing_observer_keeps_its_tables_and_sees_the_sky_of_its_altitude() {
    let device = device();
    let planet = golden_planet();
    let under = |altitude_m: f64, sun_deg: f64, exact: bool| Observer {
        exact,
        ..Observer::under_sun(&planet, altitude_m, f64::to_radians(sun_deg))
    };
    let probe = || Probe::new(&device, &coarse(SkyModel::Directional), &planet).unwrap();
    let (mut kept, mut exact) = (probe(), probe());
    let mut rays = Vec::new();
    for zenith_deg in [5.0, 60.0, 88.0, 89.9, 90.3, 95.0, 140.0] {
        for azimuth_deg in [0.0, 70.0, 180.0] {
            rays.push(Ray::at(f64::to_radians(zenith_deg), f64::to_radians(azimuth_deg), 3000.0));
        }
    }
    let mut worst = 0.0f32;
    for sun_deg in [30.0, 80.0, 90.5] {
        for from_m in [0.5, 2.0, 10.0, 400.0] {
            for question in [Question::Sky, Question::Aerial] {
                kept.ask(question, &under(from_m, sun_deg, true), &rays).unwrap();
                let higher_m = from_m + 0.99 * (0.05 + 0.3 * from_m).min(1.2);
                let seen = kept.ask(question, &under(higher_m, sun_deg, false), &rays).unwrap();
                let there = exact.ask(question, &under(higher_m, sun_deg, true), &rays).unwrap();
                for ((seen, there), ray) in seen.iter().zip(&there).zip(&rays) {
                    assert_eq!(seen.transmittance, there.transmittance, "{ray:?}");
                    for (a, b) in seen.radiance.iter().zip(there.radiance) {
                        let off = (a / b.max(1e-9) - 1.0).abs();
                        // At dusk the light near the horizon changes fastest, and coarse tables add to that.
                        let most = if sun_deg < 90.0 { 4e-3 } else { 9e-3 };
                        assert!(off < most, "{off} from {from_m} m under {sun_deg}, {question:?}: {ray:?}");
                        worst = worst.max(off);
                    }
                }
            }
        }
    }
    println!("kept tables are off by {worst:.1e} at most");
}

/// The sun moves in every frame while the camera climbs: tables are drawn ahead in slices and mixed, and the sky is
/// that of each frame's own sun.
#[test]
fn a_moving_sun_is_followed_by_slices_and_seen_where_it_stands() {
    let device = device();
    let planet = golden_planet();
    let probe = || Probe::new(&device, &coarse(SkyModel::Directional), &planet).unwrap();
    let (mut kept, mut exact) = (probe(), probe());
    let mut rays = Vec::new();
    for zenith_deg in [5.0, 60.0, 88.0, 95.0] {
        for azimuth_deg in [10.0, 90.0, 175.0] {
            rays.push(Ray::at(f64::to_radians(zenith_deg), f64::to_radians(azimuth_deg), 3000.0));
        }
    }
    for (from_deg, step_deg) in [(40.0, 0.05), (70.0, 0.05), (83.0, 0.05), (88.0, 0.004), (93.0, -0.004)] {
        let mut worst = 0.0f32;
        for i in 0..96 {
            let (sun_deg, altitude_m) = (from_deg + step_deg * f64::from(i), 10.0 + 0.05 * f64::from(i));
            let seen_by = |exact| Observer { exact, ..Observer::under_sun(&planet, altitude_m, sun_deg.to_radians()) };
            let question = if i % 2 == 0 { Question::Sky } else { Question::Aerial };
            let seen = kept.ask(question, &seen_by(false), &rays).unwrap();
            if i % 5 == 0 {
                let there = exact.ask(question, &seen_by(true), &rays).unwrap();
                for (seen, there) in seen.iter().zip(&there) {
                    let off = |c: usize| (seen.radiance[c] / there.radiance[c].max(1e-9) - 1.0).abs();
                    worst = (0..3).map(off).fold(worst, f32::max);
                }
            }
        }
        println!("sun from {from_deg} degrees by {step_deg} a frame: off by {worst:.1e} at most");
        assert!(worst < 4e-3, "{worst} from {from_deg} by {step_deg}");
    }
}

/// Runs frames until the finished tables are shown.
fn run(
    tables: &mut SkyTables,
    planet: &Planet,
    follow: &mut dyn FnMut(&mut SkyTables, &Planet) -> (TablesProgress, bool),
) -> Vec<(TablesProgress, bool)> {
    let mut all: Vec<(TablesProgress, bool)> = Vec::new();
    while all.last().is_none_or(|(p, _)| p.done < 1.0) {
        all.push(follow(tables, planet));
        assert!(all.len() < 200);
    }
    all
}

/// Counts the work of every frame on the tables of the default settings, on a device that draws nothing.
#[test]
fn a_frame_pays_a_slice_of_the_work_and_every_eighth_none() {
    let device = Device::headless(&DeviceOptions { backends: wgpu::Backends::NOOP, ..Default::default() }).unwrap();
    let mut tables = SkyTables::new(&device, &SkySettings::default()).unwrap();
    let mut volume = SkyVolume::new(&tables).unwrap();
    let share = 1.0 / 80.0;
    let mut follow = |tables: &mut SkyTables, planet: &Planet| {
        let mut encoder = device.device.create_command_encoder(&Default::default());
        let progress = tables.update(&mut encoder, planet, share).unwrap();
        let drawn = volume.prepare(&mut encoder, tables, &Observer::under_sun(planet, 10.0, 1.2)).unwrap();
        device.submit_and_wait(encoder).unwrap();
        (progress, drawn)
    };
    let planet = golden_planet();
    let (first, drawn) = follow(&mut tables, &planet);
    assert!(drawn && first.work > 0.0 && first.work < 1.0 / 16.0 && first.done == 0.0, "a draft at once: {first:?}");
    let refined = run(&mut tables, &planet, &mut follow);
    let works: Vec<f32> = refined.iter().map(|(p, _)| p.work).collect();
    let built = works.iter().rposition(|w| *w > 0.0).unwrap() + 1;
    assert!((works.iter().sum::<f32>() - 1.0).abs() < 1e-3 && (90..=98).contains(&built), "{built}: {works:?}");
    assert!(works[..built - 1].chunks(8).all(|c| c.iter().take(7).all(|w| *w > 0.9 * share && *w <= share + 1e-6)));
    assert!(works[..built].iter().skip(7).step_by(8).all(|w| *w == 0.0), "{works:?}");
    // The observer draws nothing during the build; it draws in the frame after, and the result fades in over 16 more.
    assert!(refined[..built].iter().all(|(_, drawn)| !drawn) && refined[built].1);
    assert_eq!(refined.len(), built + 1 + 16);
    assert!(refined.windows(2).all(|w| w[0].0.done <= w[1].0.done));
    // A large change of air begins with a draft of its tables, which costs as much a frame; a small change needs no
    // draft.
    let far = run(&mut tables, &planet.with_air_scaled(1.3), &mut follow);
    assert!(far.iter().all(|(p, _)| p.work <= share + 1e-6) && far[0].0.done == 0.0);
    assert!(far.len() > refined.len() + 16, "{} after {}", far.len(), refined.len());
    let near = run(&mut tables, &planet.with_air_scaled(1.31), &mut follow);
    assert_eq!((near.len(), near.iter().all(|(p, _)| p.work <= share + 1e-6)), (refined.len(), true));
    // An air far from the one that is being built ends that build.
    follow(&mut tables, &planet.with_air_scaled(1.32));
    let back = run(&mut tables, &planet, &mut follow);
    assert_eq!(back.len(), far.len());
    let builds = tables.builds();
    assert_eq!(builds, 4, "drafts, and what was given up, are not counted");
}

#[test]
fn tables_are_built_with_progress_can_be_aborted_and_come_back_from_disk() {
    let device = device();
    let settings = coarse(SkyModel::Directional);
    let directory = std::env::temp_dir().join(format!("welkin-sky-tables-{}", std::process::id()));
    let planet = golden_planet();
    let mut tables = SkyTables::new(&device, &settings).unwrap();
    let mut progress = Vec::new();
    let mut stop = |share: f32| {
        progress.push(share);
        progress.len() < 3
    };
    let e = tables.build(&planet, Some(&directory), &mut stop).unwrap_err();
    assert_eq!(e.status, welkin::Status::Aborted);
    assert!(progress.len() == 3 && tables.planet().is_none() && !directory.exists());
    let mut shares = Vec::new();
    let mut go = |share: f32| {
        shares.push(share);
        true
    };
    tables.build(&planet, Some(&directory), &mut go).unwrap();
    assert!(shares.len() >= 16 && shares.windows(2).all(|w| w[0] < w[1]) && shares.last() == Some(&1.0), "{shares:?}");
    let built = tables.read_light().unwrap().irradiance(100.0, 0.5);
    let mut again = SkyTables::new(&device, &settings).unwrap();
    let mut progress = Vec::new();
    let mut once = |share: f32| {
        progress.push(share);
        true
    };
    again.build(&planet, Some(&directory), &mut once).unwrap();
    assert_eq!((again.builds(), progress), (0, vec![1.0]), "a cached planet is not built");
    assert_eq!(again.read_light().unwrap().irradiance(100.0, 0.5), built);
    let rays = [Ray::at(0.3, 0.2, 0.0), Ray::at(1.5, 2.0, 0.0)];
    let ask =
        |t: SkyTables| Probe::with_tables(t, &planet).unwrap().under_sun(Question::Sky, 10.0, 1.3, &rays).unwrap();
    assert_eq!(ask(again), ask(tables), "bit for bit");
    std::fs::remove_dir_all(&directory).unwrap();
}

#[test]
fn observers_of_the_same_planet_share_its_tables() {
    let (device, settings) = (device(), coarse(SkyModel::Directional));
    let library = SkyLibrary::default();
    let make = || SkyTables::of_library(&library, &device, &settings).unwrap();
    let follow = |tables: &mut SkyTables, planet: &Planet, share: f32| {
        let mut encoder = device.device.create_command_encoder(&Default::default());
        let progress = tables.update(&mut encoder, planet, share).unwrap();
        device.submit_and_wait(encoder).unwrap();
        progress
    };
    let light = |t: &SkyTables| t.read_light().unwrap().irradiance(10.0, 0.5);
    let (planet, hazy) = (golden_planet(), golden_planet().with_air_scaled(1.3));
    let (mut a, mut b) = (make(), make());
    assert!(follow(&mut a, &planet, 0.1).work > 0.9 && follow(&mut b, &planet, 0.1).work == 0.0);
    assert_eq!((a.builds(), light(&a)), (1, light(&b)));
    // A change that both observers follow is built once, and both do parts of the work.
    let mut shares = [0.0f32; 2];
    for _ in 0..40 {
        shares[0] += follow(&mut a, &hazy, 0.1).work;
        shares[1] += follow(&mut b, &hazy, 0.1).work;
    }
    assert!((shares[0] + shares[1] - 1.0).abs() < 1e-3 && shares[0] > 0.3 && shares[1] > 0.3, "{shares:?}");
    let mut alone = SkyTables::new(&device, &settings).unwrap();
    follow(&mut alone, &hazy, 1.0);
    assert_eq!((a.builds(), light(&a), light(&b)), (2, light(&alone), light(&alone)));
    // If one observer gives up a build, the other continues it; if the last one gives it up, it ends.
    let thin = golden_planet().with_air_scaled(0.5);
    follow(&mut a, &thin, 0.1);
    follow(&mut b, &thin, 0.1);
    drop(a);
    assert!(follow(&mut b, &thin, 1.0).work > 0.5);
    assert_eq!(b.builds(), 3);
    drop(b);
    let mut later = make();
    assert!(follow(&mut later, &thin, 0.1).work > 0.9 && later.builds() == 1, "nothing outlives its users");
}

#[test]
fn threads_that_want_one_planet_build_it_once() {
    let (device, settings) = (device(), coarse(SkyModel::Directional));
    let library = SkyLibrary::default();
    let planet = golden_planet();
    // Keeps the shared tables alive after one thread has finished, until the next one asks the library for them.
    let keeper = SkyTables::of_library(&library, &device, &settings).unwrap();
    let all: Vec<SkyTables> = std::thread::scope(|scope| {
        let one = || {
            let mut tables = SkyTables::of_library(&library, &device, &settings).unwrap();
            let mut last = 0.0;
            let mut rising = |share: f32| std::mem::replace(&mut last, share) <= share;
            tables.build(&planet, None, &mut rising).unwrap();
            tables
        };
        let threads: Vec<_> = (0..4).map(|_| scope.spawn(one)).collect();
        threads.into_iter().map(|t| t.join().unwrap()).collect()
    });
    assert_eq!((keeper.builds(), all.len()), (1, 4));
    let light = |t: &SkyTables| t.read_light().unwrap().irradiance(10.0, 0.5);
    assert!(all.iter().all(|t| light(t) == light(&all[0])));
}

/// Tier 0 on OpenGL, where every table is built by the same passes, draws the same.
#[test]
fn opengl_draws_the_same() {
    let options = DeviceOptions { backends: wgpu::Backends::GL, force_tier0: true, ..Default::default() };
    let gl = Device::headless(&options).expect("an OpenGL driver: make setup installs one");
    let planet = Planet::earth();
    let settings = coarse(SkyModel::Directional);
    let mut probes = [gl, device()].map(|d| Probe::new(&d, &settings, &planet).unwrap());
    let mut rays = Vec::new();
    for view in [10.0f64, 70.0, 88.0, 92.0, 120.0] {
        rays.extend([0.1, 1.5, 3.0].map(|azimuth| Ray::at(view.to_radians(), azimuth, 5000.0)));
    }
    for (altitude, sun) in [(2.0, 0.5), (3000.0, 1.5), (2e5, 1.4)] {
        for question in [Question::Sky, Question::Aerial, Question::Irradiance, Question::Ground] {
            let [a, b] = probes.each_mut().map(|p| p.under_sun(question, altitude, sun, &rays).unwrap());
            for ((ray, a), b) in rays.iter().zip(a).zip(b) {
                for c in 0..3 {
                    let off = (a.radiance[c] - b.radiance[c]).abs() / b.radiance[c].max(1e-7);
                    let t = (a.transmittance[c] - b.transmittance[c]).abs();
                    assert!(off < 1e-3 && t < 1e-3, "{question:?} {altitude} {sun} {ray:?} {a:?} {b:?}");
                }
            }
        }
    }
}
