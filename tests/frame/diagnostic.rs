//! Diagnostic pictures: read back through their scale, they agree with queries and pictures.

use glam::{DVec2, DVec3};
use welkin::{
    fog::{FogLayer, Law, Patches},
    frame::{ColorSpace, Diagnostic, Exposure, Frame, FrameFlags, Stages, tone},
    plan::Budget,
    rain::{RainModel, RainSettings},
    scene::{Camera, DepthMapping, ViewRays},
    weather::{Fog, FogKind, Precipitation, PrecipitationKind, Surface, SurfaceState, Weather},
    wind::{WindGrid, WindGridKind},
};
use welkin_support::{
    depth_texture::depth_texture,
    frame_host::{Host, SIZE, camera, texture},
};

const HALF: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
const ALL: Stages = Stages::ALL;
/// The scale's colours, as the documentation has them.
const SCALE: [[f64; 3]; 6] =
    [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 1.0]];

/// Steps from the scale's lower end to a colour of it, of a target with linear numbers.
fn steps(pixel: [f32; 4]) -> f64 {
    let c = [0, 1, 2].map(|i| tone::srgb_encode(f64::from(pixel[i])));
    let off = |at: f64| {
        let i = (at as usize).min(4);
        let (a, b) = (SCALE[i], SCALE[i + 1]);
        (0..3).map(|k| (a[k] + (b[k] - a[k]) * (at - i as f64) - c[k]).powi(2)).sum::<f64>()
    };
    let best = (0..=5000).map(|i| f64::from(i) / 1000.0).min_by(|a, b| off(*a).total_cmp(&off(*b))).unwrap();
    assert!(off(best) < 1e-4, "{pixel:?} is no colour of the scale");
    best
}

fn rays(camera: &Camera) -> ViewRays {
    ViewRays::new(camera, &DepthMapping { reversed: true, ..Default::default() }).unwrap()
}

fn ndc(pixel: usize) -> DVec2 {
    let (x, y) = (pixel % SIZE.0 as usize, pixel / SIZE.0 as usize);
    DVec2::new((x as f64 + 0.5) / f64::from(SIZE.0) * 2.0 - 1.0, 1.0 - (y as f64 + 0.5) / f64::from(SIZE.1) * 2.0)
}

/// Draws a frame of a host whose depth is `depth`, or its own; both may be changed by `change`.
fn record(host: &mut Host, id: u64, stages: Stages, change: impl FnOnce(&mut Frame<'_>)) -> Vec<[f32; 4]> {
    let (color, depth) = (host.color.clone(), host.depth.clone());
    let mut frame = Frame::new(id, camera(), &color, Some(&depth));
    frame.flags = FrameFlags::NO_HISTORY;
    change(&mut frame);
    host.view.record(&host.context, &frame, stages).unwrap();
    host.pixels()
}

#[test]
fn distance_is_that_of_the_wall() {
    let mut host = Host::new(HALF);
    let rays = rays(&camera());
    for (id, depth) in [2e-1_f32, 1e-2, 2e-4, 5e-6, 5e-8, 0.0].into_iter().enumerate() {
        host.clear([5.0, 6.0, 7.0, 0.5], depth);
        let shown = record(&mut host, id as u64, ALL, |frame| frame.diagnostic = Diagnostic::Distance);
        for i in [0, 79, 45 * 160 + 80, 90 * 160 - 1] {
            let expected = rays.view_range(f64::from(depth), ndc(i)).max(1.0).log10().clamp(0.0, 5.0);
            assert!((steps(shown[i]) - expected).abs() < 0.01, "{depth}: {} {expected}", steps(shown[i]));
            assert_eq!(shown[i][3], 0.5, "the host's alpha stays");
        }
    }
}

/// Low over a plain, with a wall 800 m off.
fn low() -> (Camera, f32) {
    let camera = Camera::look_to(DVec3::new(0.0, 0.0, 20.0), DVec3::Y, DVec3::Z, 0.6, 160.0 / 90.0, 0.1);
    (camera, 0.1 / 800.0)
}

/// Returns optical depths by the picture and by the query, from a place of this easting to a wall at this distance,
/// over a grid of pixels.
fn optical_depths(host: &mut Host, id: u64, east_m: f64, wall_m: f32) -> Vec<(f64, f64)> {
    let (mut camera, depth) = (low().0, 0.1 / wall_m);
    camera.position.x = east_m;
    host.clear([5.0; 4], depth);
    let change = |frame: &mut Frame<'_>| (frame.camera, frame.diagnostic) = (camera, Diagnostic::OpticalDepth);
    let shown = record(host, id, ALL, change);
    let rays = rays(&camera);
    let compared = |i: usize| {
        let ray = rays.view_ray(ndc(i));
        let at = camera.position + ray.direction * rays.view_range(f64::from(depth), ndc(i));
        let through = host.context.between(camera.position, at, 0.0).unwrap().transmittance;
        (steps(shown[i]), -(0.2126 * through[0] + 0.7152 * through[1] + 0.0722 * through[2]).ln())
    };
    (5 * 160..46 * 160).step_by(37).map(compared).collect()
}

#[test]
fn optical_depth_is_that_of_the_query() {
    let mist = |visibility_m| Weather { visibility_m, relative_humidity: 0.9, ..Weather::default() };
    let layer = Weather { fog: Fog { top_m: Some(15.0), ..Fog::of(FogKind::Fog) }, ..mist(300.0) };
    // Near the eye rain has no curtains; what its drops hide there is counted too.
    let precipitation = Precipitation::of(PrecipitationKind::Rain, 200.0);
    let near = Weather { precipitation, ..mist(150.0) };
    for (name, weather, wall_m) in [
        ("clear", mist(30_000.0), 800.0),
        ("mist", mist(1500.0), 800.0),
        ("layer", layer, 800.0),
        ("near rain", near, 25.0),
    ] {
        let mut host = Host::new(HALF);
        host.context.set_weather(&weather, 0.0, 0.0).unwrap();
        let depths = optical_depths(&mut host, 1, 0.0, wall_m);
        for (got, expected) in &depths {
            let right = (got - expected.min(5.0)).abs() < 0.03 * expected + 0.01;
            assert!(right, "{name}: {got} {expected}");
        }
        let last = depths.last().unwrap().0;
        assert!(if name == "clear" { last < 0.15 } else { last > 0.2 }, "{name}: {last}");
    }
}

/// Patches of fog pass a place where the air hardly moves. They are delayed there, in pictures as in queries.
#[test]
fn fog_patches_are_delayed_where_the_wind_is_slow() {
    let mut host = Host::new(HALF);
    let mut weather = Weather {
        visibility_m: 600.0,
        fog: Fog { top_m: Some(80.0), ..Fog::of(FogKind::Patches) },
        ..Weather::default()
    };
    (weather.wind.speed_m_s, weather.wind.from_deg) = (5.0, 270.0);
    host.context.set_weather(&weather, 0.0, 0.0).unwrap();
    let nodes = [33, 33, 3];
    let (origin, cell_m) = (DVec3::new(-192.0, 20.0, -10.0), DVec3::new(12.0, 12.0, 30.0));
    let slow = |i: u32| {
        let at = DVec2::new(f64::from(i % 33), f64::from(i / 33 % 33)) - DVec2::splat(16.0);
        [if at.length() < 10.0 { 0.5 } else { 5.0 }, 0.0, 0.0]
    };
    let velocities_m_s = (0..33 * 33 * 3).map(slow).collect();
    let free = optical_depths(&mut host, 1, 0.0, 420.0);
    let grid = WindGrid { origin, cell_m, nodes, kind: WindGridKind::Whole, velocities_m_s };
    host.context.set_wind_grid(Some(grid)).unwrap();
    let held_up = optical_depths(&mut host, 2, 0.0, 420.0);
    for (got, expected) in &held_up {
        assert!((got - expected).abs() < 0.005, "{got} {expected}");
    }
    let changed = free.iter().zip(&held_up).filter(|(free, held)| (free.1 - held.1).abs() > 0.05).count();
    assert!(changed > held_up.len() / 20, "{changed} of {}", held_up.len());
    // A law of the host's has patches of its own.
    let patches = Patches { amount: 1.0, size_m: 200.0, seed: 3, drift_m: [0.0; 2] };
    let layer = FogLayer { patches: Some(patches), ..FogLayer::ground_fog(0.002, 80.0, 10.0) };
    host.context.set_fog_law(Some(Law::Layer(layer))).unwrap();
    let by_law = optical_depths(&mut host, 3, 0.0, 420.0);
    host.context.set_wind_grid(None).unwrap();
    let without_grid = optical_depths(&mut host, 4, 0.0, 420.0);
    assert!(by_law.iter().zip(&without_grid).all(|(a, b)| a.0 == b.0));
}

#[test]
fn optical_depth_of_rain_is_that_of_the_query_on_the_mean_over_its_curtains() {
    let mut host = Host::new(HALF);
    let precipitation = Precipitation::of(PrecipitationKind::Rain, 30.0);
    host.context.set_weather(&Weather { visibility_m: 3000.0, precipitation, ..Weather::default() }, 0.0, 0.0).unwrap();
    let (mut got, mut expected) = (0.0, 0.0);
    for id in 0..12 {
        for (a, b) in optical_depths(&mut host, id, 4000.0 * id as f64, 800.0) {
            (got, expected) = (got + a, expected + b);
        }
    }
    assert!((got / expected - 1.0).abs() < 0.03, "{}", got / expected);
}

/// Looks down at a level, paved plain 4 m below the eye.
fn yard(host: &Host) -> (Camera, wgpu::Texture) {
    let camera =
        Camera::look_to(DVec3::new(0.0, 0.0, 4.0), DVec3::new(0.0, 1.0, -0.3), DVec3::Z, 1.0, 160.0 / 90.0, 0.1);
    let rays = rays(&camera);
    let depths: Vec<f32> = (0..(SIZE.0 * SIZE.1) as usize)
        .map(|i| {
            let ray = rays.view_ray(ndc(i));
            let range = -4.0 / ray.direction.z;
            if ray.direction.z < -0.02 { rays.depth_at(range, ndc(i)) as f32 } else { 0.0 }
        })
        .collect();
    (camera, depth_texture(&host.device, SIZE, &depths))
}

#[test]
fn wetness_is_none_in_the_dry_and_some_in_the_wet() {
    let with = |state| Weather { surface: Surface { state: Some(state), ..Surface::default() }, ..Weather::default() };
    let mean = |weather: &Weather| {
        let mut host = Host::new(HALF);
        host.context.set_default_surface_class(welkin::ground::SurfaceClass::Paved);
        host.context.set_weather(weather, 0.0, 0.0).unwrap();
        host.clear([500.0; 4], 0.0);
        let (camera, depth) = yard(&host);
        host.depth = depth;
        let shown = record(&mut host, 1, ALL, |frame| {
            (frame.camera, frame.diagnostic) = (camera, Diagnostic::Wetness);
        });
        assert!(shown[..10 * 160].iter().all(|p| p[..3] == [0.0; 3]), "the sky is dry");
        shown[60 * 160..].iter().map(|p| steps(*p) / 5.0).sum::<f64>() / (30.0 * 160.0)
    };
    let [dry, wet, standing] =
        [SurfaceState::Dry, SurfaceState::Wet, SurfaceState::StandingWater].map(|state| mean(&with(state)));
    let drizzle = Precipitation::of(PrecipitationKind::Drizzle, 0.2);
    let drizzled = mean(&Weather { precipitation: drizzle, ..Weather::default() });
    // This drizzle covers 0.08 of the ground between the hollows with a film, and more at their edges.
    assert_eq!(dry, 0.0);
    assert!((0.05..0.2).contains(&drizzled) && wet > 0.98 && standing > 0.98, "{drizzled} {wet} {standing}");
}

#[test]
fn error_of_the_plan_is_that_of_the_pictures() {
    let mut host = Host::new(HALF);
    let fog = Weather { visibility_m: 1500.0, relative_humidity: 0.95, ..Weather::default() };
    host.context.set_weather(&fog, 0.0, 0.0).unwrap();
    let (camera, depth) = low();
    let stages = Stages::BACKGROUND.with(Stages::MEDIUM);
    let mut draw = |id, rungs: &[usize], diagnostic| {
        host.view.set_budget(Budget::pinned(rungs)).unwrap();
        host.clear([2000.0, 2000.0, 2000.0, 1.0], depth);
        record(&mut host, id, stages, |frame| {
            (frame.camera, frame.diagnostic) = (camera, diagnostic);
            frame.exposure = Some(Exposure::Factor(1e-4));
        })
    };
    let everything = draw(1, &[0, 0, 0, 0, 0], Diagnostic::None);
    assert!(draw(2, &[0, 0, 0, 0, 0], Diagnostic::PlanError).iter().all(|p| p[..3] == [0.0; 3]));
    let without_fog = draw(3, &[0, 1, 0, 0, 0], Diagnostic::None);
    let shown = draw(4, &[0, 1, 0, 0, 0], Diagnostic::PlanError);
    let luminance = |p: &[f32; 4]| (0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2]) as f64 * 1e-4;
    for i in [20 * 160 + 20, 45 * 160 + 80, 60 * 160 + 100] {
        let (a, b) = (luminance(&without_fog[i]), luminance(&everything[i]));
        let expected = ((a - b).abs() / (b + 0.01) * 1e4).log10();
        assert!(expected > 2.0, "{a} {b}");
        assert!((steps(shown[i]) - expected).abs() < 0.05, "{i}: {} {expected}", steps(shown[i]));
    }
}

#[test]
fn overdraw_is_none_without_rain_and_grows_with_it() {
    for model in [RainModel::Drops, RainModel::Cones] {
        let mut host = Host::new(HALF);
        host.view.set_rain(RainSettings { model, ..RainSettings::default() }).unwrap();
        let (camera, depth) = low();
        let mut mean = |id, rate| {
            let kind = if rate > 0.0 { PrecipitationKind::Rain } else { PrecipitationKind::None };
            let precipitation = Precipitation::of(kind, rate);
            host.context.set_weather(&Weather { precipitation, ..Weather::default() }, id as f64, 0.0).unwrap();
            host.context.update(id as f64 + 0.5).unwrap();
            host.clear([5.0; 4], depth);
            let change = |frame: &mut Frame<'_>| (frame.camera, frame.diagnostic) = (camera, Diagnostic::Overdraw);
            let shown = record(&mut host, id, ALL, change);
            shown.iter().map(|p| 4.0 * steps(*p)).sum::<f64>() / shown.len() as f64
        };
        let (none, some, more) = (mean(1, 0.0), mean(2, 0.5), mean(3, 50.0));
        assert_eq!(none, 0.0, "{model:?}");
        match model {
            RainModel::Cones => assert_eq!([some, more], [1.0; 2], "one draw over the whole picture"),
            _ => assert!(some > 0.02 && more > 1.5 * some, "{model:?}: {some} {more}"),
        }
    }
}

/// A wind that turns about a point and grows away from it, seen from above.
#[test]
fn wind_is_that_of_the_query_and_arrows_lie_along_it() {
    let mut host = Host::new(HALF);
    let nodes = [33, 33, 3];
    let origin = DVec3::new(-160.0, -160.0, -10.0);
    let cell_m = DVec3::splat(10.0);
    let turning = |i: u32| {
        let at = origin + cell_m * DVec3::new(f64::from(i % 33), f64::from(i / 33 % 33), 0.0);
        [-0.11 * at.y, 0.11 * at.x, 0.0].map(|v| v as f32)
    };
    let velocities_m_s = (0..33 * 33 * 3).map(turning).collect();
    let kind = WindGridKind::Whole;
    host.context.set_wind_grid(Some(WindGrid { origin, cell_m, nodes, kind, velocities_m_s })).unwrap();
    // The camera is not at the world's origin; the squares of arrows keep their places.
    let eye = DVec3::new(13.0, -21.0, 60.0);
    let down = Camera::look_to(eye, -DVec3::Z, DVec3::Y, 1.0, 160.0 / 90.0, 0.1);
    host.clear([5.0; 4], 0.1 / 60.0);
    let change = |frame: &mut Frame<'_>| (frame.camera, frame.diagnostic) = (down, Diagnostic::Wind);
    let shown = record(&mut host, 1, ALL, change);
    let rays = rays(&down);
    let (mut colours, mut pixels, mut ahead) = (0, 0, 0.0);
    for (i, pixel) in shown.iter().enumerate() {
        let range = rays.view_range(0.1 / 60.0, ndc(i));
        let at = eye + rays.view_ray(ndc(i)).direction * range;
        let wind = |at: DVec3| host.context.wind_at(at + DVec3::Z * 2.0, 0.0).unwrap().velocity_m_s.truncate();
        let found = steps(*pixel);
        if (0.01..4.99).contains(&found) {
            let asked = wind(at).length() / 4.0;
            assert!((found - asked).abs() < 0.03, "{at}: {found} {asked}");
            colours += 1;
            continue;
        }
        let side = (0.06 * range).log2().round().exp2();
        let middle = ((at.truncate() / side).floor() + 0.5) * side;
        let off = (at.truncate() - middle) / side;
        if wind(middle.extend(0.0)).length() > 1.0 {
            let along = wind(middle.extend(0.0)).normalize();
            assert!(off.perp_dot(along).abs() < 0.2 && off.dot(along).abs() < 0.42, "{at}: {off}, {along}");
            ahead += off.dot(along);
            pixels += 1;
        }
    }
    println!(
        "{colours} pixels of speed, {pixels} of arrows, whose middle lies {:.3} of a square ahead",
        ahead / f64::from(pixels)
    );
    assert!(colours > 11_000 && pixels > 500);
    assert!(ahead > 0.02 * f64::from(pixels), "arrows point the other way");
}

#[test]
fn the_call_with_the_numbers_stage_draws_it_and_others_draw_nothing() {
    let mut host = Host::new(HALF);
    let grey = [0.25, 0.5, 0.75, 1.0];
    host.clear(grey.map(f64::from), 1e-3);
    let change = |frame: &mut Frame<'_>| frame.diagnostic = Diagnostic::Distance;
    for stage in [Stages::PREPARE, Stages::BACKGROUND, Stages::SURFACE] {
        assert!(record(&mut host, 1, stage, change).iter().all(|p| *p == grey), "{stage:?}");
    }
    let shown = record(&mut host, 1, Stages::MEDIUM, change);
    assert!((steps(shown[45 * 160 + 80]) - 2.0).abs() < 0.01);
    let rest = Stages::PARTICLES.with(Stages::LENS).with(Stages::TONE);
    assert!(record(&mut host, 1, rest, change) == shown);
}

#[test]
fn a_diagnostic_picture_leaves_no_trace_in_the_next_frame() {
    let draw = |between: &[Diagnostic]| {
        let mut host = Host::new(HALF);
        host.view.set_rain(RainSettings { model: RainModel::Drops, ..RainSettings::default() }).unwrap();
        let precipitation = Precipitation::of(PrecipitationKind::Rain, 10.0);
        host.context.set_weather(&Weather { precipitation, ..Weather::default() }, 0.0, 0.0).unwrap();
        let (camera, depth) = low();
        for (id, diagnostic) in between.iter().enumerate() {
            host.clear([500.0; 4], depth);
            let change = |frame: &mut Frame<'_>| (frame.camera, frame.diagnostic) = (camera, *diagnostic);
            let _ = record(&mut host, id as u64, ALL, change);
        }
        host.clear([500.0; 4], depth);
        record(&mut host, 9, ALL, |frame| frame.camera = camera)
    };
    use Diagnostic::{Distance, OpticalDepth, Overdraw, PlanError, Wetness};
    assert!(draw(&[]) == draw(&[Distance, OpticalDepth, Wetness, PlanError, Overdraw]));
}

#[test]
fn the_picture_is_a_displays_in_every_target() {
    let expected = [0.0, 1.0, 0.0]; // 100 m
    for (space, format) in [
        (ColorSpace::DisplaySrgb, wgpu::TextureFormat::Rgba8Unorm),
        (ColorSpace::DisplaySrgb, wgpu::TextureFormat::Rgba8UnormSrgb),
        (ColorSpace::DisplayLinear, HALF),
    ] {
        let mut host = Host::new(format);
        host.clear([0.5; 4], 1e-3);
        let mask = texture(&host.device, wgpu::TextureFormat::R8Unorm, 1);
        let rows: Vec<u8> = (0..SIZE.0 * SIZE.1).map(|i| if i % SIZE.0 < 80 { 255 } else { 0 }).collect();
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(SIZE.0), rows_per_image: None };
        host.device.queue.write_texture(mask.as_image_copy(), &rows, layout, mask.size());
        let (color, depth, before) = (host.color.clone(), host.depth.clone(), host.pixels());
        let mut frame = Frame::new(1, camera(), &color, Some(&depth));
        (frame.mask, frame.color_space, frame.diagnostic) = (Some(&mask), space, Diagnostic::Distance);
        host.view.record(&host.context, &frame, ALL).unwrap();
        let shown = host.pixels();
        let middle = shown[45 * 160 + 81];
        assert!((0..3).all(|c| (middle[c] - expected[c]).abs() < 0.03), "{space:?} {format:?}: {middle:?}");
        assert_eq!(shown[45 * 160 + 10], before[45 * 160 + 10], "the masked half stays");
    }
}

#[test]
fn several_samples_show_the_first() {
    let host = Host::new(HALF);
    let (color, depth) = (texture(&host.device, HALF, 4), texture(&host.device, wgpu::TextureFormat::Depth32Float, 4));
    let mut host = Host { color, depth, ..host };
    host.clear([5.0; 4], 1e-3);
    let mut frame = Frame::new(1, camera(), &host.color, Some(&host.depth));
    frame.diagnostic = Diagnostic::Distance;
    host.view.record(&host.context, &frame, ALL).unwrap();
    let shown = crate::spaces::resolve(&host);
    assert!((steps(shown[45 * 160 + 80]) - 2.0).abs() < 0.01);
}
