//! Snow on the ground: independent of the steps of time, kept by a saved state, fast-forwarded, ploughed, compacted,
//! thawed into water, and drawn.

use std::time::Duration;

use glam::DVec3;
use welkin::{
    Status,
    context::{Context, ContextDesc, GivenDirection},
    frame::Stages,
    ground::{GroundModel, SurfaceClass},
    snowpack::{LyingSnowModel, SnowFriction, SnowStrip},
    weather::{Precipitation, PrecipitationKind, Surface, Weather, Wind},
};

use crate::{
    host::{Host, SIZE, ground, look, resealed},
    terrain::{NODES, grid, roof},
};

fn context(host: &Host, lying_snow: LyingSnowModel) -> Context {
    let desc = ContextDesc { lying_snow, ground: GroundModel::Simulated, seed: 7, ..ContextDesc::default() };
    let mut context = Context::new(host.device.clone(), host.context.shared().clone(), desc).unwrap();
    context.set_sun(Some(GivenDirection { azimuth_deg: 140.0, elevation_deg: 20.0 })).unwrap();
    context
}

/// Snow of this rate, mm/h, in a wind from the south-west.
fn snowfall(rate_mm_h: f64, temperature_c: f64, wind_m_s: f64) -> Weather {
    Weather {
        temperature_c,
        precipitation: Precipitation::of(PrecipitationKind::Snow, rate_mm_h),
        wind: Wind { gust_m_s: Some(wind_m_s), ..Wind::of(wind_m_s, 225.0) },
        ..Weather::default()
    }
}

/// A night's snow that drifts about a roof and a wall on the terrain, then a thaw.
fn night(host: &Host) -> Context {
    let mut context = context(host, LyingSnowModel::Simulated);
    context.set_shelters(&[roof([-12.0, 8.0, 4.0], [5.0, 4.0, 0.2]), roof([6.0, 10.0, 1.0], [0.2, 5.0, 1.0])]).unwrap();
    context.set_weather(&snowfall(3.0, -4.0, 3.0), 0.0, 0.0).unwrap();
    context.set_ground_grid(Some(grid())).unwrap();
    context.set_weather(&snowfall(2.0, -6.0, 12.0), 100.0, 60.0).unwrap();
    context.set_weather(&Weather { temperature_c: 6.0, ..snowfall(0.0, 6.0, 4.0) }, 1000.0, 60.0).unwrap();
    context
}

fn at(x: f64, y: f64) -> DVec3 {
    DVec3::new(x, y, 0.0)
}

#[test]
fn thirty_sixty_and_144_pictures_a_second_lay_the_same_snow() {
    let host = Host::new();
    let mut whole = night(&host);
    let mut by_rate = [30.0, 60.0, 144.0].map(|hz| (hz, night(&host)));
    for end in [130.0, 1300.0] {
        whole.update(end).unwrap();
        for (hz, context) in &mut by_rate {
            // Only a part of the time is updated at the frame rate; the steps end at their own times.
            let begin = (context.time_s() * *hz) as u64;
            let last = (end * *hz) as u64;
            let stride = if last - begin > 20_000 { 7 } else { 1 };
            (begin..=last).step_by(stride).try_for_each(|i| context.update(i as f64 / *hz)).unwrap();
            context.update(end).unwrap();
            assert_eq!(
                context.snow_at(at(3.0, 9.0)).unwrap(),
                whole.snow_at(at(3.0, 9.0)).unwrap(),
                "{hz} Hz to {end} s"
            );
            assert_eq!(context.state_hash().unwrap(), whole.state_hash().unwrap(), "{hz} Hz to {end} s");
        }
    }
    let mut in_parts = night(&host);
    while in_parts.update_within(1300.0, Duration::ZERO).unwrap() == Status::Pending {}
    assert_eq!(in_parts.state_hash().unwrap(), whole.state_hash().unwrap());
    let (open, porch) = (whole.snow_at(at(-3.0, 25.0)).unwrap(), whole.snow_at(at(-12.0, 8.0)).unwrap());
    assert!(open.depth_m > 0.002 && porch.mass_kg_m2 < 0.3 * open.mass_kg_m2, "{open:?} {porch:?}");
}

#[test]
fn a_saved_snow_goes_on_as_if_nothing_had_been() {
    let host = Host::new();
    let mut first = night(&host);
    first.update(777.5).unwrap();
    let saved = first.save().unwrap();
    let mut second = context(&host, LyingSnowModel::Simulated);
    second.load(&saved).unwrap();
    assert_eq!(second.state_hash().unwrap(), first.state_hash().unwrap());
    assert_eq!(second.snow_at(at(0.0, 5.0)).unwrap(), first.snow_at(at(0.0, 5.0)).unwrap());
    [&mut first, &mut second].into_iter().for_each(|c| c.update(2400.0).unwrap());
    assert_eq!(second.save().unwrap(), first.save().unwrap());
    assert_eq!(second.snow_balance(), first.snow_balance());
    let e = context(&host, LyingSnowModel::Reported).load(&saved).unwrap_err();
    assert!(e.status != Status::Ok && e.to_string().contains("lying_snow"), "{e}");
    let text = String::from_utf8(saved).unwrap();
    let broken = text.replacen("books = [", "books = [1", 1);
    let e = second.load(&resealed(&broken)).unwrap_err();
    assert!(text != broken && e.status == Status::Parse && e.to_string().contains("lying_snow must be"), "{e}");
}

#[test]
fn a_night_laid_fast_is_the_night_within_five_percent_and_says_so() {
    let host = Host::new();
    let night = |fast: bool| {
        let mut context = context(&host, LyingSnowModel::Simulated);
        context.set_ground_grid(Some(grid())).unwrap();
        context.set_shelters(&[roof([6.0, 10.0, 1.0], [0.2, 5.0, 1.0])]).unwrap();
        context.set_weather(&snowfall(2.0, -4.0, 9.0), 0.0, 0.0).unwrap();
        context.set_weather(&snowfall(0.3, 2.0, 6.0), 5.0 * 3600.0, 3600.0).unwrap();
        if fast {
            context.accumulate(8.0).unwrap()
        } else {
            context.update(8.0 * 3600.0).unwrap()
        }
        context
    };
    let (slow, fast) = (night(false), night(true));
    assert_eq!((slow.snow_fast_forwarded_s(), fast.snow_fast_forwarded_s()), (0.0, 8.0 * 3600.0));
    assert_ne!(slow.state_hash().unwrap(), fast.state_hash().unwrap());
    let far = DVec3::new(1e4, 1e4, 0.0);
    for place in [far, at(-15.0, 20.0), at(0.0, 10.0), at(12.0, 12.0)] {
        let (a, b) = (slow.snow_at(place).unwrap(), fast.snow_at(place).unwrap());
        println!(
            "at {place}: {:.2} and {:.2} kg/m^2, {:.4} and {:.4} m",
            a.mass_kg_m2, b.mass_kg_m2, a.depth_m, b.depth_m
        );
        assert!((b.mass_kg_m2 / a.mass_kg_m2 - 1.0).abs() < 0.05 && (b.depth_m / a.depth_m - 1.0).abs() < 0.05);
    }
    let mut bad = slow;
    for hours in [0.0, -1.0, 721.0, f64::NAN, f64::INFINITY] {
        let e = bad.accumulate(hours).unwrap_err();
        assert!(e.status == Status::InvalidArgument && e.to_string().starts_with("hours must be"), "{e}");
    }
    assert_eq!(bad.time_s(), 8.0 * 3600.0);
}

#[test]
fn a_plough_removes_the_mass_that_it_returns_and_wheels_press_tracks() {
    let host = Host::new();
    let mut context = context(&host, LyingSnowModel::Simulated);
    let strip =
        |points: &[[f64; 2]], width_m| SnowStrip { points: points.iter().map(|p| at(p[0], p[1])).collect(), width_m };
    let road = strip(&[[-15.0, 20.0], [0.0, 20.0], [15.0, 24.0]], 4.0);
    let e = context.take_snow(&road, 0.0).unwrap_err();
    assert!(e.status == Status::WrongOrder && e.to_string().contains("terrain"), "{e}");
    let surface = Surface { snow_depth_m: 0.2, ..Surface::default() };
    context.set_weather(&Weather { temperature_c: -5.0, surface, ..Weather::default() }, 0.0, 0.0).unwrap();
    context.set_ground_grid(Some(grid())).unwrap();
    context.update(60.0).unwrap();
    let before = context.snow_balance().unwrap();
    let open = context.snow_at(at(0.0, 15.0)).unwrap();
    let taken = context.take_snow(&road, 0.02).unwrap();
    let after = context.snow_balance().unwrap();
    assert!((before.lying_kg - after.lying_kg - taken).abs() < 1e-3 && (after.taken_kg - taken).abs() < 1e-3);
    // 30.5 m by 4 m by 18 cm of 250 kg/m^3.
    assert!((taken / (30.5 * 4.0 * (open.depth_m - 0.02) * open.density_kg_m3) - 1.0).abs() < 0.02, "{taken} kg");
    let cleared = context.snow_at(at(-6.0, 20.0)).unwrap();
    assert!(
        (cleared.depth_m - 0.02).abs() < 1e-4 && (cleared.surface.z - 0.004 * 20.0 - 0.02).abs() < 1e-3,
        "{cleared:?}"
    );
    let track = strip(&[[-10.0, 8.0], [-10.0, 2.0]], 2.0);
    context.press_snow(&track).unwrap();
    let pressed = context.snow_at(at(-10.0, 5.0)).unwrap();
    assert!((pressed.density_kg_m3 - 500.0).abs() < 1.0 && pressed.friction == SnowFriction::Packed, "{pressed:?}");
    assert!((pressed.mass_kg_m2 / open.mass_kg_m2 - 1.0).abs() < 1e-6 && open.friction == SnowFriction::Loose);
    let now = context.state_hash().unwrap();
    let bad = [
        (strip(&[[0.0, 1.0]], 1.0), 0.0, "strip.points.len must be in [2, 1024]"),
        (strip(&[[0.0, 1.0], [f64::NAN, 2.0]], 1.0), 0.0, "strip.points[1] must be finite"),
        (strip(&[[0.0, 1.0], [1.0, 2.0]], 0.0), 0.0, "strip.width_m must be in [0.01, 1000]"),
        (strip(&[[0.0, 1.0], [1.0, 2.0]], 1.0), f64::NAN, "left_m must be in [0, 100]"),
    ];
    for (strip, left_m, wanted) in bad {
        let e = context.take_snow(&strip, left_m).unwrap_err();
        assert!(e.status == Status::InvalidArgument && e.to_string().starts_with(wanted), "{e}");
    }
    assert_eq!(context.state_hash().unwrap(), now);
}

#[test]
fn a_thaw_wets_the_ground() {
    let host = Host::new();
    let mut context = context(&host, LyingSnowModel::Simulated);
    let surface = Surface { snow_depth_m: 0.05, ..Surface::default() };
    let thaw = |temperature_c| Weather { temperature_c, surface, wind: Wind::of(3.0, 180.0), ..Weather::default() };
    context.set_weather(&thaw(-5.0), 0.0, 0.0).unwrap();
    context.update(600.0).unwrap();
    assert_eq!(context.ground_water().unwrap().film_mm, 0.0);
    context.set_weather(&thaw(8.0), 600.0, 0.0).unwrap();
    context.update(4.0 * 3600.0).unwrap();
    let (water, snow) = (context.ground_water().unwrap(), context.snow_at(at(0.0, 0.0)).unwrap());
    assert!(water.film_mm > 0.01 && snow.wetness > 0.9 && snow.friction == SnowFriction::Slush, "{water:?} {snow:?}");
    let settled = context.update(60.0 * 3600.0).map(|()| context.snow_at(at(0.0, 0.0)).unwrap()).unwrap();
    assert_eq!((settled.depth_m, settled.friction), (0.0, SnowFriction::Bare));
}

fn brightness(pixels: &[[f32; 4]]) -> f64 {
    pixels.iter().map(|p| f64::from(p[1])).sum::<f64>() / pixels.len() as f64
}

#[test]
fn snow_whitens_ground_by_its_depth_but_no_water() {
    let mut host = Host::new();
    let eye = DVec3::new(0.0, 0.0, 2.0);
    let camera = look(eye, 0.0, -50.0, 0.6);
    let meet = |d| ground(eye, d, [2000.0, 1900.0, 1500.0]);
    let mut shown = |depth_m: f64| {
        let surface = Surface { snow_depth_m: depth_m, ..Surface::default() };
        let weather = Weather { temperature_c: -3.0, surface, wind: Wind::of(0.0, 0.0), ..Weather::default() };
        host.context.set_weather(&weather, host.context.time_s(), 0.0).unwrap();
        brightness(&host.shoot(camera, Stages::SURFACE, meet))
    };
    let depths = [0.0, 0.003, 0.01, 0.03, 0.1, 0.5];
    let bright = depths.map(&mut shown);
    println!("luminance by depth: {bright:?}");
    assert!(bright.windows(2).all(|w| w[1] > 1.02 * w[0] || w[1] > 0.97 * bright[5]), "{bright:?}");
    let light = host.context.scene_at(eye, 0.0).unwrap().ground;
    let level = light.sun_lux[1] * 40f64.to_radians().sin() + light.sky_lux[1];
    let albedo = bright[5] * std::f64::consts::PI / level;
    assert!((0.78..0.9).contains(&albedo), "albedo {albedo}");
    host.context.set_default_surface_class(SurfaceClass::Water);
    assert!((brightness(&host.shoot(camera, Stages::SURFACE, meet)) / 1900.0 - 1.0).abs() < 0.01);
}

#[test]
fn a_strong_wind_blows_loose_snow_into_the_air() {
    let host = Host::new();
    let mut context = context(&host, LyingSnowModel::Simulated);
    let surface = Surface { snow_depth_m: 0.3, ..Surface::default() };
    let windy = |speed| Weather { temperature_c: -8.0, surface, wind: Wind::of(speed, 270.0), ..Weather::default() };
    let mut visibility_m = |speed: f64| {
        context.set_weather(&windy(speed), context.time_s(), 0.0).unwrap();
        context.update(context.time_s() + 60.0).unwrap();
        context.conditions_at(DVec3::ZERO, context.time_s()).unwrap().visibility_m()
    };
    let (calm, storm) = (visibility_m(5.0), visibility_m(16.0));
    assert!(calm > 5000.0 && storm < 1000.0, "{calm} {storm}");
    assert!(visibility_m(5.0) > 5000.0, "it settles with the wind");
}

#[test]
fn the_snow_is_a_texture_for_the_hosts_own_materials() {
    let host = Host::new();
    let mut context = context(&host, LyingSnowModel::Simulated);
    context.set_ground_grid(Some(grid())).unwrap();
    assert!(context.ground_texture().unwrap().snow.is_none(), "before there is a state");
    let surface = Surface { snow_depth_m: 0.2, ..Surface::default() };
    context.set_weather(&Weather { temperature_c: -5.0, surface, ..Weather::default() }, 0.0, 0.0).unwrap();
    context.update(60.0).unwrap();
    let snow = context.ground_texture().unwrap().snow.expect("a texture of the snow");
    let texels = welkin::gpu::readback::rgba(&host.device, &snow).unwrap();
    let (texel, at) = (texels[5 * NODES[0] as usize + 7], context.snow_at(at(-13.0, 5.0)).unwrap());
    let wanted = [at.depth_m, at.density_kg_m3, at.wetness, at.albedo];
    assert!((0..4).all(|i| (f64::from(texel[i]) - wanted[i]).abs() <= 1e-3 * wanted[i]), "{texel:?} {wanted:?}");
    context
        .take_snow(&SnowStrip { points: vec![self::at(-20.0, 5.0), self::at(0.0, 5.0)], width_m: 3.0 }, 0.0)
        .unwrap();
    let again = context.ground_texture().unwrap().snow.expect("a texture of the snow");
    assert_eq!(again, snow);
    assert_eq!(welkin::gpu::readback::rgba(&host.device, &again).unwrap()[5 * NODES[0] as usize + 7][0], 0.0);
}

#[test]
fn an_overcast_sky_is_brighter_over_snow() {
    let host = Host::new();
    let lux = |depth_m: f64| {
        let mut context = context(&host, LyingSnowModel::Reported);
        let surface = Surface { snow_depth_m: depth_m, ..Surface::default() };
        context.set_weather(&Weather { surface, ..Weather::preset("overcast").unwrap() }, 0.0, 0.0).unwrap();
        context.scene_at(DVec3::ZERO, 0.0).unwrap().ground
    };
    let (bare, white) = (lux(0.0), lux(0.3));
    let more = white.total_lux / bare.total_lux;
    println!("an overcast sky gives {more:.2} times as much light over snow");
    // Back and forth between albedos of 0.2 or 0.82 and the clouds' own: (1 - 0.2 a) / (1 - 0.82 a).
    assert!((1.4..2.6).contains(&more), "{more}");
    assert!(white.adaptation_cd_m2 > more * bare.adaptation_cd_m2);
    // The snow also lights flakes from below.
    let albedo = |depth_m: f64| {
        let mut context = context(&host, LyingSnowModel::Simulated);
        let surface = Surface { snow_depth_m: depth_m, ..Surface::default() };
        context.set_weather(&Weather { temperature_c: -5.0, surface, ..Weather::default() }, 0.0, 0.0).unwrap();
        context.update(60.0).unwrap();
        context.scene_at(DVec3::ZERO, 60.0).unwrap().ground_albedo[1]
    };
    let (bare, white) = (albedo(0.0), albedo(0.3));
    assert!(bare == 0.15 && (0.85..0.89).contains(&white), "{bare} {white}");
}

#[test]
fn the_terrains_snow_is_drawn_where_it_lies() {
    let mut host = Host::new();
    let mut context = context(&host, LyingSnowModel::Simulated);
    let surface = Surface { snow_depth_m: 0.2, ..Surface::default() };
    context.set_weather(&Weather { temperature_c: -5.0, surface, ..Weather::default() }, 0.0, 0.0).unwrap();
    context.set_ground_grid(Some(grid())).unwrap();
    context.update(60.0).unwrap();
    let road = SnowStrip { points: vec![at(-3.0, 1.0), at(-3.0, 28.0)], width_m: 6.0 };
    context.take_snow(&road, 0.0).unwrap();
    host.view = welkin::frame::View::new(&context).unwrap();
    host.context = context;
    let eye = DVec3::new(-3.0, 12.0, 9.0);
    let camera = look(eye, 0.0, -90.0, 1.0);
    let pixels = host.shoot(camera, Stages::SURFACE, |d| ground(eye, d, [900.0; 3]));
    let row = &pixels[(SIZE.1 / 2 * SIZE.0) as usize..][..SIZE.0 as usize];
    let (side, middle) = (brightness(&row[..20]), brightness(&row[70..90]));
    assert!(side > 4.0 * middle && (middle / 900.0 - 1.0).abs() < 0.3, "{side} {middle}; {NODES:?}");
}

#[test]
fn the_walls_of_a_track_face_the_sun_and_away_from_it() {
    let mut host = Host::new();
    let mut context = context(&host, LyingSnowModel::Simulated);
    let surface = Surface { snow_depth_m: 0.6, ..Surface::default() };
    context.set_weather(&Weather { temperature_c: -5.0, surface, ..Weather::default() }, 0.0, 0.0).unwrap();
    context.set_ground_grid(Some(grid())).unwrap();
    context.update(60.0).unwrap();
    context.press_snow(&SnowStrip { points: vec![at(-10.0, 2.0), at(-10.0, 28.0)], width_m: 2.4 }).unwrap();
    let depths = [-14.0, -11.5, -10.0, -8.5, -6.0].map(|x| context.snow_at(at(x, 15.0)).unwrap().depth_m);
    host.view = welkin::frame::View::new(&context).unwrap();
    host.context = context;
    let eye = DVec3::new(-10.0, 15.0, 9.0);
    let camera = look(eye, 0.0, -90.0, 1.0);
    let pixels = host.shoot(camera, Stages::SURFACE, |d| ground(eye, d, [900.0; 3]));
    // Metres to the east of the track's middle, along the middle row.
    let row = &pixels[(SIZE.1 / 2 * SIZE.0) as usize..][..SIZE.0 as usize];
    let across_m = 2.0 * 9.0 * 0.5f64.tan() * f64::from(SIZE.0) / f64::from(SIZE.1);
    let shown = |east_m: f64| {
        let x = ((east_m / across_m + 0.5) * f64::from(SIZE.0)) as usize;
        brightness(&row[x - 1..x + 2])
    };
    let [open, sunny, floor, shady] = [-4.0, -1.5, 0.0, 1.5].map(shown);
    println!(
        "depths {depths:.2?} m; {open:.0} in the open, {sunny:.0}, {floor:.0} and {shady:.0} cd/m^2 across the track"
    );
    assert!(depths[2] < 0.7 * depths[0], "{depths:?}");
    // The sun stands in the south-east, so surfaces that face east are brighter.
    assert!(sunny > 1.05 * open && shady < 0.95 * open && (floor / open - 1.0).abs() < 0.1);
}
