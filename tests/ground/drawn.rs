//! Wet surfaces in pictures: which become darker, which do not, and which stay unchanged.

use std::f64::consts::PI;

use glam::DVec3;
use welkin::{
    clouds::CloudModel,
    frame::{ColorSpace, Frame, Stages},
    ground::reference::{WATER_OUTSIDE, fresnel_water, wet_share},
    weather::{Surface, SurfaceState, Weather, Wind},
};
use welkin_support::textures::texture;

use crate::host::{Hit, Host, SIZE, ground, look, ray};

const EYE: DVec3 = DVec3::new(0.0, 0.0, 2.0);

/// A box of 2 m that stands 8 m before the eye.
fn with_box(d: DVec3, on_box: [f64; 3], on_ground: [f64; 3]) -> Hit {
    let (low, high) = (DVec3::new(-1.0, 8.0, -0.5) - EYE, DVec3::new(1.0, 10.0, 2.0) - EYE);
    let (a, b) = (low / d, high / d);
    let (near, far) = (a.min(b).max_element(), a.max(b).min_element());
    if near > 0.0 && near < far { Some((near, on_box)) } else { ground(EYE, d, on_ground) }
}

#[test]
fn dry_ground_is_drawn_bit_for_bit_as_without_the_stage() {
    let mut host = Host::new();
    let camera = look(EYE, 0.0, -10.0, 1.0);
    let world = |d| with_box(d, [900.0; 3], [1500.0, 1400.0, 1200.0]);
    for state in [None, Some(SurfaceState::Dry)] {
        state.into_iter().for_each(|s| host.ground_is(s));
        let all = host.shoot(camera, Stages::ALL, world);
        let passes = host.view.report().passes;
        assert_eq!(all, host.shoot(camera, Stages::ALL.without(Stages::SURFACE), world), "{state:?}");
        assert_eq!(host.view.report().passes, passes);
    }
    let alone = host.shoot(camera, Stages::SURFACE, world);
    assert_eq!((host.view.report().passes, alone[0][0]), (0, 0.0), "nothing is drawn, nothing is paid");
}

/// Still water has no slopes that show at its own height or from below. The wall reaches above the eye.
#[test]
fn walls_beside_calm_water_stay_as_they_are_in_a_breath_of_wind() {
    let mut host = Host::new();
    let mut under = |wind_m_s: f64| {
        let surface = Surface { state: Some(SurfaceState::StandingWater), ..Surface::default() };
        let weather = Weather { surface, wind: Wind::of(wind_m_s, 270.0), ..Weather::default() };
        host.context.set_weather(&weather, host.context.time_s(), 0.0).unwrap();
        let wall = |d: DVec3| (d.y > 0.0).then(|| (8.0 / d.y, [900.0; 3]));
        host.shoot(look(EYE, 0.0, 0.0, 0.8), Stages::SURFACE, wall)
    };
    let (calm, breath) = (under(0.0), under(0.1));
    for (i, (a, b)) in calm.iter().zip(&breath).enumerate() {
        assert!((0..3).all(|c| (a[c] - b[c]).abs() < 9.0), "pixel {i}: {a:?}, in wind {b:?}");
    }
}

#[test]
fn patches_darken_by_the_law_of_wet_albedo() {
    let mut host = Host::new();
    host.ground_is(SurfaceState::Wet);
    let light = host.context.scene_at(EYE, 0.0).unwrap().ground;
    let camera = look(EYE, 0.0, -90.0, 0.5);
    let total = |c: usize| light.sun_lux[c] * 40f64.to_radians().sin() + light.sky_lux[c];
    // The colour of soil, not of plants.
    let mut shown = |albedo: f64| {
        let luminance = [0, 1, 2].map(|c| albedo * total(c) / PI);
        let pixels = host.shoot(camera, Stages::SURFACE, |d| ground(EYE, d, luminance));
        pixels.iter().map(|p| f64::from(p[1])).sum::<f64>() / pixels.len() as f64 * PI / total(1)
    };
    // The reflection is the same over all of these albedos.
    let mirrored = shown(0.0);
    assert!((0.002..0.03).contains(&mirrored), "{mirrored}");
    for albedo in [0.1, 0.2, 0.3, 0.5, 0.8] {
        let sun = light.sun_lux[1] * 40f64.to_radians().sin() / total(1);
        let entering = 1.0 - sun * fresnel_water(50f64.to_radians().cos()) - (1.0 - sun) * WATER_OUTSIDE;
        let (got, want) = (shown(albedo) - mirrored, albedo * wet_share(albedo, entering));
        assert!((got / want - 1.0).abs() < 0.02, "albedo {albedo}: {got}, want {want}");
    }
}

#[test]
fn freezing_rain_leaves_an_even_gloss() {
    let mut host = Host::new();
    let set = |host: &mut Host, name: &str| {
        let weather = Weather { wind: welkin::weather::Wind::of(0.0, 0.0), ..Weather::preset(name).unwrap() };
        host.context.set_weather(&weather, host.context.time_s(), 0.0).unwrap();
    };
    let spread = |pixels: &[[f32; 4]]| {
        let mean = pixels.iter().map(|p| f64::from(p[1])).sum::<f64>() / pixels.len() as f64;
        let variance = pixels.iter().map(|p| (f64::from(p[1]) - mean).powi(2)).sum::<f64>() / pixels.len() as f64;
        (mean, variance.sqrt() / mean)
    };
    // From high enough to see puddles where there are any.
    let high = DVec3::new(0.0, 0.0, 15.0);
    let down = look(high, 0.0, -90.0, 0.9);
    let picture = |host: &mut Host, light: f64| host.shoot(down, Stages::SURFACE, |d| ground(high, d, [light; 3]));
    set(&mut host, "freezing_rain");
    assert_eq!(host.context.conditions_at(EYE, 0.0).unwrap().surface.wetness, 0.0);
    let (ice, even) = spread(&picture(&mut host, 2000.0));
    assert!((0.4..0.9).contains(&(ice / 2000.0)), "{ice}");
    assert!(spread(&picture(&mut host, 0.0)).0 > 0.0, "it mirrors the sky");
    set(&mut host, "heavy_rain");
    let (_, puddled) = spread(&picture(&mut host, 2000.0));
    assert!(even < 0.01 && puddled > 2.0 * even, "{even} {puddled}");
    set(&mut host, "freezing_rain");
    let roof = welkin::rain::Shelter {
        center_m: DVec3::new(0.0, 0.0, 8.0),
        axes: glam::DMat3::IDENTITY,
        half_size_m: DVec3::new(50.0, 50.0, 0.2),
        velocity_m_s: DVec3::ZERO,
        planes: welkin::rain::Planes::NONE,
    };
    host.context.set_shelters(&[roof]).unwrap();
    assert_eq!(spread(&picture(&mut host, 2000.0)), (2000.0, 0.0));
}

#[test]
fn walls_are_less_wet_and_undersides_dry() {
    let mut host = Host::new();
    host.ground_is(SurfaceState::Wet);
    let grey = [3000.0; 3];
    // Looking up at a ceiling 3 m above, level at a wall 6 m ahead, down at the ground.
    let ceiling = |d: DVec3| (d.z > 1e-6).then(|| (1.0 / d.z, grey));
    let wall = |d: DVec3| (d.y > 1e-6).then(|| (6.0 / d.y, grey));
    let left = |host: &mut Host, elevation, meet: &dyn Fn(DVec3) -> Hit| {
        let pixels = host.shoot(look(EYE, 0.0, elevation, 0.3), Stages::SURFACE, meet);
        f64::from(pixels[(SIZE.1 / 2 * SIZE.0 + SIZE.0 / 2) as usize][1]) / 3000.0
    };
    let above = left(&mut host, 45.0, &ceiling);
    let beside = left(&mut host, 0.0, &wall);
    let below = left(&mut host, -90.0, &|d| ground(EYE, d, [3000.0; 3]));
    assert_eq!(above, 1.0);
    assert!(beside < 0.97 && beside > 0.75 && below < 0.75, "{above} {beside} {below}");
}

#[test]
fn no_seam_runs_along_silhouettes() {
    let mut host = Host::new();
    host.ground_is(SurfaceState::StandingWater);
    let camera = look(EYE, 0.0, -8.0, 1.0);
    let bare = host.shoot(camera, Stages::SURFACE, |d| ground(EYE, d, [200.0; 3]));
    let boxed = host.shoot(camera, Stages::SURFACE, |d| with_box(d, [1.0; 3], [200.0; 3]));
    let mut compared = 0;
    for y in 0..SIZE.1 {
        for x in 0..SIZE.0 {
            let d = ray(&camera, x, y);
            if with_box(d, [1.0; 3], [200.0; 3]) != ground(EYE, d, [200.0; 3]) {
                continue;
            }
            let (a, b) = (bare[(y * SIZE.0 + x) as usize], boxed[(y * SIZE.0 + x) as usize]);
            assert!((a[1] - b[1]).abs() <= 0.01 * a[1], "{x} {y}: {a:?} {b:?}");
            compared += 1;
        }
    }
    assert!(compared > 4000 && bare != boxed);
    // The box's front is one wall, from its first column to its last.
    let row = (SIZE.1 / 2 + 4) * SIZE.0;
    let front: Vec<f32> = (0..SIZE.0)
        .filter(|x| with_box(ray(&camera, *x, SIZE.1 / 2 + 4), [1.0; 3], [200.0; 3]).is_some_and(|h| h.1[0] == 1.0))
        .map(|x| boxed[(row + x) as usize][1])
        .collect();
    assert!(front.len() >= 20 && front.iter().all(|v| (v - front[10]).abs() < 0.02), "{front:?}");
}

#[test]
fn sky_and_masked_pixels_stay_and_one_call_equals_the_stages_one_by_one() {
    let mut host = Host::new();
    host.ground_is(SurfaceState::StandingWater);
    let camera = look(EYE, 0.0, 0.0, 1.0);
    let world = |d| ground(EYE, d, [700.0, 600.0, 500.0]);
    let surface = host.shoot(camera, Stages::SURFACE, world);
    assert_eq!(surface[0], [0.0, 0.0, 0.0, 1.0], "sky");
    assert!(surface[(SIZE.0 * (SIZE.1 - 1)) as usize][0] != 700.0);
    let whole = host.shoot(camera, Stages::ALL.without(Stages::TONE), world);
    host.paint(&camera, world);
    host.next_frame();
    for stage in [Stages::PREPARE, Stages::BACKGROUND, Stages::SURFACE, Stages::MEDIUM] {
        host.record(camera, stage);
    }
    for (a, b) in whole.iter().zip(host.pixels()) {
        for c in 0..3 {
            // On a software driver each call interpolates smooth parts, within a thousandth of the value and of white.
            assert!((a[c] - b[c]).abs() <= 2e-3 * a[c].abs() + 1e-3, "{a:?} {b:?}");
        }
    }
    let mask = texture(&host.device, SIZE, wgpu::TextureFormat::R8Unorm, 1);
    let rows = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(SIZE.0), rows_per_image: None };
    let ones = vec![255u8; (SIZE.0 * SIZE.1) as usize];
    host.device.queue.write_texture(mask.as_image_copy(), &ones, rows, mask.size());
    host.paint(&camera, world);
    let frame = Frame { mask: Some(&mask), ..Frame::new(99, camera, &host.color, Some(&host.depth)) };
    host.view.record(&host.context, &frame, Stages::SURFACE).unwrap();
    assert_eq!(host.pixels()[(SIZE.0 * (SIZE.1 - 1)) as usize], [700.0, 600.0, 500.0, 1.0]);
}

#[test]
fn a_picture_of_display_colours_darkens_and_shines_too() {
    let mut host = Host::new();
    host.ground_is(SurfaceState::Wet);
    let mut shown = |camera, color| {
        host.paint(&camera, |d| ground(EYE, d, color));
        let mut frame = Frame::new(host.next_frame(), camera, &host.color, Some(&host.depth));
        frame.color_space = ColorSpace::DisplayLinear;
        host.view.record(&host.context, &frame, Stages::SURFACE).unwrap();
        host.pixels()[(SIZE.0 * SIZE.1 / 2 + SIZE.0 / 2) as usize][1]
    };
    let down = look(EYE, 0.0, -90.0, 0.5);
    let light = shown(down, [0.4; 3]) - shown(down, [0.0; 3]);
    assert!((0.45..0.75).contains(&(light / 0.4)), "{light}");
    let grazing = look(EYE, 320.0, -6.0, 0.1);
    assert!(shown(grazing, [0.0; 3]) > 3.0 * shown(down, [0.0; 3]));
}

#[test]
fn a_far_origin_leaves_the_picture() {
    let mut host = Host::new();
    // Mirrored clouds of a volume come from a map that is made over some frames.
    host.context.set_cloud_model(CloudModel::Deck);
    let mut rain = Weather::preset("heavy_rain").unwrap();
    rain.wind.speed_m_s = 0.0;
    rain.wind.gust_m_s = None;
    host.context.set_weather(&rain, 0.0, 0.0).unwrap();
    host.context.update(1e6).unwrap();
    let mut picture =
        |eye: DVec3| host.shoot(look(eye, 30.0, -25.0, 1.0), Stages::SURFACE, |d| ground(EYE, d, [50.0; 3]));
    let near = picture(EYE);
    for far in [DVec3::new(1e7, -1e7, 0.0), DVec3::new(0.0, 2e7, 0.0)] {
        let moved = picture(EYE + far);
        let differ = near.iter().zip(&moved).filter(|(a, b)| (a[1] - b[1]).abs() > 0.01 * a[1] + 0.5).count();
        assert!(differ < 15, "{differ} pixels differ");
    }
    assert!(picture(EYE + DVec3::new(3.0, 0.0, 0.0)) != near, "the pattern is the world's, not the camera's");
    assert_eq!(picture(EYE), near);
}
