//! Situations in which frames of other systems have faults: turning, teleports, far origins, time at rest, a sun in the
//! picture, banding, changing air.

use glam::DVec3;
use welkin::{
    context::GivenDirection,
    frame::{ColorSpace, Exposure, Frame, FrameFlags, Stages},
    scene::Camera,
    weather::{Aerosol, AerosolKind, Fog, FogKind, Weather},
};
use welkin_support::frame_host::{Host, SIZE};

const FLOAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
const DRAW: Stages = Stages(Stages::PREPARE.0 | Stages::BACKGROUND.0 | Stages::MEDIUM.0);

fn look(position: DVec3, azimuth_deg: f64, elevation_deg: f64) -> Camera {
    let forward = welkin::sky::sun::direction(azimuth_deg, elevation_deg);
    Camera::look_to(position, forward, DVec3::Z, 1.0, f64::from(SIZE.0) / f64::from(SIZE.1), 0.1)
}

fn shoot(host: &mut Host, id: u64, camera: Camera, flags: FrameFlags) -> Vec<[f32; 4]> {
    host.clear([0.0; 4], 0.0);
    let mut frame = Frame::new(id, camera, &host.color, Some(&host.depth));
    frame.exposure = Some(Exposure::Factor(1e-4));
    frame.cd_m2_per_unit = 1e4;
    frame.flags = flags;
    host.view.record(&host.context, &frame, DRAW).unwrap();
    host.pixels()
}

fn worst(a: &[[f32; 4]], b: &[[f32; 4]]) -> f32 {
    let of = |(p, q): (&[f32; 4], &[f32; 4])| (0..3).map(|c| (p[c] - q[c]).abs() / (q[c] + 0.01)).fold(0.0, f32::max);
    a.iter().zip(b).map(of).fold(0.0, f32::max)
}

#[test]
fn turning_the_camera_rebuilds_no_table() {
    let mut host = Host::new(FLOAT);
    shoot(&mut host, 0, look(DVec3::ZERO, 0.0, 5.0), FrameFlags(0));
    assert!(host.view.report().tables_rebuilt > 0, "the first frame builds");
    for id in 1..6 {
        shoot(&mut host, id, look(DVec3::ZERO, 60.0 * id as f64, 5.0), FrameFlags(0));
        assert_eq!(host.view.report().tables_rebuilt, 0);
    }
    shoot(&mut host, 9, look(DVec3::new(0.0, 0.0, 500.0), 0.0, 5.0), FrameFlags(0));
    assert!(host.view.report().tables_rebuilt > 0, "another altitude has another sky");
}

#[test]
fn standing_time_and_a_teleport_there_and_back_give_the_same_bits() {
    let mut host = Host::new(FLOAT);
    let here = look(DVec3::new(0.0, 0.0, 100.0), 120.0, 10.0);
    let first = shoot(&mut host, 1, here, FrameFlags(0));
    host.context.update(host.context.time_s()).unwrap();
    assert_eq!(shoot(&mut host, 2, here, FrameFlags(0)), first, "dt = 0 changes nothing");
    shoot(&mut host, 3, look(DVec3::new(5e4, 0.0, 9000.0), 20.0, -10.0), FrameFlags::CUT);
    assert_eq!(shoot(&mut host, 4, here, FrameFlags::CUT), first, "a teleport leaves no trace");
    assert_eq!(shoot(&mut host, 5, here, FrameFlags::NO_HISTORY), first);
}

#[test]
fn a_far_origin_does_not_change_the_picture() {
    let mut host = Host::new(FLOAT);
    let fog = Weather { visibility_m: 400.0, fog: Fog::of(FogKind::Fog), ..Weather::default() };
    host.context.set_weather(&fog, 0.0, 0.0).unwrap();
    let mut picture = |id, at: DVec3| {
        host.clear([0.3, 0.3, 0.3, 1.0], 1e-3);
        let frame = Frame::new(id, look(at, 40.0, -3.0), &host.color, Some(&host.depth));
        host.view.record(&host.context, &frame, DRAW).unwrap();
        host.pixels()
    };
    let near = picture(1, DVec3::new(0.0, 0.0, 2.0));
    let far = picture(2, DVec3::new(1e7, -1e7, 2.0));
    assert!(worst(&near, &far) < 1e-6, "{}", worst(&near, &far));
}

#[test]
fn the_sun_in_the_picture_stays_finite_and_is_where_the_almanac_says() {
    let mut host = Host::new(FLOAT);
    // From a jet and from space it is seen below the level of the eye, over a horizon that lies 3 and 20 degrees below
    // it.
    for (id, (height_m, elevation_deg)) in
        [(0.0, 70.0), (0.0, 10.0), (0.0, 1.0), (11e3, 0.2), (11e3, -2.0), (4e5, -15.0)].into_iter().enumerate()
    {
        host.context.set_sun(Some(GivenDirection { azimuth_deg: 200.0, elevation_deg })).unwrap();
        let camera = look(DVec3::Z * height_m, 200.0, elevation_deg);
        let picture = shoot(&mut host, id as u64, camera, FrameFlags(0));
        assert!(picture.iter().flatten().all(|v| v.is_finite() && *v >= -1e-3), "{elevation_deg}");
        let brightest = (0..picture.len()).max_by(|a, b| picture[*a][1].total_cmp(&picture[*b][1])).unwrap() as u32;
        let (x, y) = (brightest % SIZE.0, brightest / SIZE.0);
        // A pixel is 0.64 degrees here; refraction lifts the low sun by up to 0.4.
        let is_there = x.abs_diff(SIZE.0 / 2) <= 1 && y.abs_diff(SIZE.1 / 2) <= 1;
        assert!(is_there, "{elevation_deg} degrees from {height_m} m: {x} {y}");
        let [disc, beside] = [brightest, brightest + 8].map(|i| picture[i as usize][1]);
        assert!(disc > 20.0 * beside, "{elevation_deg} degrees from {height_m} m: a disc of {disc} in {beside}");
    }
}

#[test]
fn eight_bit_skies_do_not_band() {
    let mut host = Host::new(wgpu::TextureFormat::Rgba8Unorm);
    host.clear([0.0; 4], 0.0);
    let mut frame = Frame::new(1, look(DVec3::ZERO, 340.0, 35.0), &host.color, Some(&host.depth));
    frame.color_space = ColorSpace::DisplaySrgb;
    host.view.record(&host.context, &frame, DRAW).unwrap();
    let picture = host.pixels();
    // A smooth sky changes by a fraction of a step from pixel to pixel: without dither, runs of equal values would be
    // tens of pixels long.
    let mut longest = 0;
    for row in picture.chunks(SIZE.0 as usize) {
        let mut run = 1;
        for pair in row.windows(2) {
            run = if pair[0][2] == pair[1][2] { run + 1 } else { 1 };
            longest = longest.max(run);
        }
    }
    assert!(longest < 32, "{longest} equal pixels in a row");
}

#[test]
fn a_change_of_the_air_is_followed_without_a_jump_and_arrives() {
    let mut host = Host::new(FLOAT);
    let camera = look(DVec3::ZERO, 60.0, 8.0);
    let mean = |p: &[[f32; 4]]| p.iter().map(|v| f64::from(v[1])).sum::<f64>() / p.len() as f64;
    let before = mean(&shoot(&mut host, 0, camera, FrameFlags(0)));
    let haze = Weather { visibility_m: 6000.0, aerosol: Aerosol::of(AerosolKind::Haze), ..Weather::default() };
    host.context.set_weather(&haze, 0.0, 0.0).unwrap();
    let mut last = before;
    let mut steps = Vec::new();
    for id in 1..=48 {
        let now = mean(&shoot(&mut host, id, camera, FrameFlags(0)));
        steps.push((now - last).abs());
        last = now;
    }
    let fresh = mean(&shoot(&mut host, 99, camera, FrameFlags::NO_HISTORY));
    let whole = (fresh - before).abs();
    assert!(whole > 0.05 * before, "haze shows: {before} {fresh}");
    assert!((last - fresh).abs() < 0.01 * fresh, "it arrives: {last}, fresh {fresh}");
    let largest = steps.iter().copied().fold(0.0, f64::max);
    assert!(largest < whole / 8.0, "no step is more than an eighth of the change: {largest} of {whole}, {steps:?}");
}
