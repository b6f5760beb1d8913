//! Reflections in water: the sky by Fresnel's law, and lamps at any distance.

use glam::{DVec2, DVec3};
use welkin::{
    context::GivenDirection,
    frame::Stages,
    ground::{
        SurfaceClass,
        reference::{fresnel_water, glitter, normal_quantile},
    },
    scene::{Camera, HostLight},
    weather::{CloudKind, CloudLayer, Surface, SurfaceState, Weather, Wind},
};

use crate::host::{Host, SIZE, ground, look, ray};

/// Returns a place in the middle of a puddle, deep enough that everything around it is under water.
fn puddle(host: &Host) -> DVec2 {
    let level = normal_quantile(1.0 - 0.3);
    let deep = |at: DVec2| host.context.hollows().depth(at) - level;
    (0..10_000)
        .map(|i| DVec2::new(f64::from(i % 100), f64::from(i / 100)) * 0.5)
        .max_by(|a, b| deep(*a).total_cmp(&deep(*b)))
        .unwrap()
}

#[test]
fn a_puddle_mirrors_the_sky_by_fresnels_law() {
    let mut host = Host::new();
    host.ground_is(SurfaceState::StandingWater);
    let at = puddle(&host);
    for (azimuth, elevation) in [(320.0, 75.0), (320.0, 45.0), (30.0, 30.0), (250.0, 20.0), (0.0, 10.0), (90.0, 5.0)] {
        let (sin, cos) = f64::to_radians(elevation).sin_cos();
        // A metre from the water's middle, looking down at it.
        let back = -welkin::sky::sun::direction(azimuth, 0.0) * cos + DVec3::Z * sin;
        let eye = at.extend(0.0) + back;
        let down = look(eye, azimuth, -elevation, 0.02);
        let mirrored = host.shoot(down, Stages::SURFACE, |d| ground(eye, d, [0.0; 3]));
        let up = look(eye, azimuth, elevation, 0.02);
        let sky = host.shoot(up, Stages::BACKGROUND, |_| None);
        let middle = (SIZE.1 / 2 * SIZE.0 + SIZE.0 / 2) as usize;
        let d = ray(&down, SIZE.0 / 2, SIZE.1 / 2);
        for c in 0..3 {
            let (got, want) = (mirrored[middle][c], fresnel_water(-d.z) as f32 * sky[middle][c]);
            assert!((got / want - 1.0).abs() < 0.03, "{elevation} deg, channel {c}: {got}, want {want}");
        }
    }
}

#[test]
fn an_overcast_sky_is_mirrored_as_the_deck() {
    let mut host = Host::new();
    let surface = Surface { state: Some(SurfaceState::StandingWater), ..Surface::default() };
    let clouds = vec![CloudLayer::of(CloudKind::Stratus, 1.0, 600.0)];
    let weather = Weather { surface, clouds, wind: Wind::of(0.0, 0.0), ..Weather::default() };
    host.context.set_weather(&weather, 0.0, 0.0).unwrap();
    let at = puddle(&host);
    let eye = at.extend(0.0) + DVec3::new(0.0, -0.8, 0.6);
    let elevation = 0.6f64.asin().to_degrees();
    let mirrored = host.shoot(look(eye, 0.0, -elevation, 0.02), Stages::SURFACE, |d| ground(eye, d, [0.0; 3]));
    let sky = host.shoot(look(eye, 0.0, elevation, 0.02), Stages::BACKGROUND, |_| None);
    let middle = (SIZE.1 / 2 * SIZE.0 + SIZE.0 / 2) as usize;
    let (got, want) = (mirrored[middle][1], fresnel_water(0.6) as f32 * sky[middle][1]);
    assert!((got / want - 1.0).abs() < 0.03, "{got}, want {want}");
}

#[test]
fn the_sun_in_a_puddle_is_bright_and_finite() {
    let mut host = Host::new();
    host.use_half_floats();
    host.ground_is(SurfaceState::StandingWater);
    let at = puddle(&host);
    for elevation in [1.0, 10.0, 40.0, 80.0] {
        host.context.set_sun(Some(GivenDirection { azimuth_deg: 0.0, elevation_deg: elevation })).unwrap();
        let (sin, cos) = f64::to_radians(elevation).sin_cos();
        let eye = at.extend(0.0) + DVec3::new(0.0, -cos, sin);
        let pixels = host.shoot(look(eye, 0.0, -elevation, 0.2), Stages::SURFACE, |d| ground(eye, d, [100.0; 3]));
        let brightest = pixels.iter().fold(0f32, |m, p| m.max(p[1]));
        assert!(pixels.iter().all(|p| p.iter().all(|v| v.is_finite() && *v >= 0.0)), "{elevation}");
        // Some drivers turn what is too bright into the largest half float instead of an infinity.
        assert!(brightest < 6.1e4, "{elevation}: {brightest}");
        assert!(brightest > 2e4, "the sun shines in the water at {elevation}: {brightest}");
    }
}

#[test]
fn a_rough_film_spreads_the_suns_light_and_keeps_its_sum() {
    // The mirrored lamp's light over all directions equals the reflected share of its illuminance. Here the lamp is
    // straight above, and the sum of L cos over a wide view downwards is F(0) E.
    let mut host = Host::new();
    host.ground_is(SurfaceState::Wet);
    host.context.set_sun(Some(GivenDirection { azimuth_deg: 0.0, elevation_deg: 90.0 })).unwrap();
    let eye = DVec3::new(0.0, 0.0, 2.0);
    let camera = look(eye, 0.0, -90.0, 2.2);
    let with_sun = host.shoot(camera, Stages::SURFACE, |d| ground(eye, d, [0.0; 3]));
    let lux = host.context.scene_at(eye, 0.0).unwrap().ground.sun_lux[1];
    let (mut sum, mut solid) = (0.0, 0.0);
    let scale = 2.0 * (1.1f64).tan() / f64::from(SIZE.1);
    for y in 0..SIZE.1 {
        for x in 0..SIZE.0 {
            let d = ray(&camera, x, y);
            // A pixel's solid angle is its area times cos^3.
            let angle = scale * scale * (-d.z).powi(3);
            sum += f64::from(with_sun[(y * SIZE.0 + x) as usize][1]) * -d.z * angle;
            solid += -d.z * angle;
        }
    }
    let want = fresnel_water(1.0) * lux;
    // The sky's own share, about 0.03 of a mean luminance of some thousand cd/m^2, is in the sum.
    let sky = 0.03 * host.context.scene_at(eye, 0.0).unwrap().ground.sky_lux[1] * solid / std::f64::consts::PI;
    assert!(((sum - sky) / want - 1.0).abs() < 0.15, "{} want {want}", sum - sky);
}

#[test]
fn rings_follow_time_and_rate() {
    let mut host = Host::new();
    let mut roughness = Vec::new();
    for (i, rate) in [0.0, 1.0, 5.0].into_iter().enumerate() {
        let mut weather = Weather::preset("rain").unwrap();
        weather.precipitation.rate_mm_h = rate;
        weather.wind = Wind::of(0.0, 0.0);
        weather.surface.state = Some(SurfaceState::StandingWater);
        host.context.set_weather(&weather, host.context.time_s(), 0.0).unwrap();
        host.context.update(f64::from(i as u32) + 0.3).unwrap();
        let at = puddle(&host);
        let eye = at.extend(0.0) + DVec3::new(0.0, -0.9, 0.7);
        let camera = look(eye, 0.0, -37.9, 0.4);
        let picture = |host: &mut Host| host.shoot(camera, Stages::SURFACE, |d| ground(eye, d, [0.0; 3]));
        let first = picture(&mut host);
        assert_eq!(first, picture(&mut host), "time stands");
        // Compares the light with that of water without rings in the next column; without rings the difference is 0.
        let differs = |a: &[f32; 4], b: &[f32; 4]| (a[1] - b[1]).abs() > 0.02 * a[1];
        let rough = first.windows(2).filter(|p| differs(&p[0], &p[1])).count();
        roughness.push(rough as f64 / first.len() as f64);
        host.context.update(host.context.time_s() + 0.1).unwrap();
        let moved = first.iter().zip(picture(&mut host)).filter(|(a, b)| differs(a, b)).count();
        assert_eq!(moved > 300, rate > 0.0, "{rate} mm/h: {moved}");
    }
    assert!(roughness[0] < 0.02 && roughness[2] > 3.0 * roughness[1] && roughness[1] > 0.01, "{roughness:?}");
}

/// Twins of `LAMP_RADIUS` and of the slope that wind gives to puddles.
const LAMP_RADIUS_M: f64 = 0.1;
const WIND_SLOPE_M_S: f64 = 8.0;

#[test]
fn a_lamp_shines_in_a_puddle_by_the_law_of_glitter_and_not_on_grass() {
    let mut host = Host::new();
    let surface = Surface { state: Some(SurfaceState::StandingWater), ..Surface::default() };
    let weather = Weather { surface, wind: Wind::of(WIND_SLOPE_M_S, 240.0), ..Weather::default() };
    host.context.set_weather(&weather, 0.0, 0.0).unwrap();
    host.context.set_sun(Some(GivenDirection { azimuth_deg: 0.0, elevation_deg: -40.0 })).unwrap();
    let at = puddle(&host);
    let eye = at.extend(0.0) + DVec3::new(0.0, -1.2, 0.9);
    // The lamp is placed where a mirror at the puddle's middle reflects it to the eye.
    let lamp = HostLight {
        position_m: at.extend(0.0) + DVec3::new(0.0, 4.0, 3.0),
        direction: DVec3::new(0.0, -4.0, -3.0),
        intensity_cd: [3000.0, 2000.0, 1000.0],
        inner_deg: 60.0,
        outer_deg: 80.0,
    };
    let camera = look(eye, 0.0, -(0.9f64 / 1.2).atan().to_degrees(), 0.12);
    let mut picture = |class: SurfaceClass, lamps: &[HostLight]| {
        host.context.set_default_surface_class(class);
        host.context.set_lights(lamps).unwrap();
        host.shoot(camera, Stages::SURFACE, |d| ground(eye, d, [0.0; 3]))
    };
    let dark = picture(SurfaceClass::Paved, &[]);
    let lit = picture(SurfaceClass::Paved, &[lamp]);
    let grass = picture(SurfaceClass::Vegetation, &[lamp]);
    assert!(grass.iter().all(|p| p[..3] == [0.0; 3]), "leaves mirror no lamp");
    // Cox & Munk's slopes for the open sea, of which puddles have 3 of 100 (src/ground/uniform.rs).
    let wind = host.context.scene_at(eye, 0.0).unwrap().conditions.wind.speed_m_s();
    let slope = (0.5 * 0.00512 * 0.03 * wind).sqrt();
    let pixel = 0.12 / f64::from(SIZE.1);
    let (mut brightest, mut compared) = (0f64, 0);
    for (x, y) in [(80, 45), (90, 45), (70, 40), (80, 55), (80, 35), (60, 50), (100, 60), (80, 20)] {
        let d = ray(&camera, x, y);
        let p = eye + d * (-eye.z / d.z);
        let to = lamp.position_m - p;
        let (to_lamp, to_eye) = (to.normalize(), -d);
        let facet = (to_eye + to_lamp).normalize();
        let disc = 0.25 * (LAMP_RADIUS_M / to.length() + pixel);
        let share = glitter(slope, disc * disc, DVec3::Z, facet, to_eye, to_lamp) * fresnel_water(facet.dot(to_eye));
        let i = (y * SIZE.0 + x) as usize;
        for c in 0..3 {
            let got = f64::from(lit[i][c] - dark[i][c]);
            let want = lamp.illuminance_lux(p)[c] * share;
            if want > 0.5 {
                assert!((got / want - 1.0).abs() < 0.03, "pixel {x} {y}, channel {c}: {got}, want {want}");
                compared += 1;
            }
            brightest = brightest.max(got);
        }
    }
    assert!(compared >= 9 && brightest > 100.0, "{compared} {brightest}");
}

/// Returns the luminance by the lamp's light alone, reflected by the ground, cd/m^2, pixel by pixel.
fn of_lamp(host: &mut Host, camera: Camera, lamp: HostLight) -> Vec<f64> {
    let eye = camera.position;
    let mut picture = |lamps: &[HostLight]| {
        host.context.set_lights(lamps).unwrap();
        host.shoot(camera, Stages::SURFACE, |d| ground(eye, d, [0.0; 3]))
    };
    let (dark, lit) = (picture(&[]), picture(&[lamp]));
    lit.iter().zip(&dark).map(|(a, b)| f64::from(a[1] - b[1])).collect()
}

#[test]
fn a_lamp_above_wet_paving_has_its_image_below_it_by_fresnels_law_and_none_on_dry() {
    let mut host = Host::new();
    host.ground_is(SurfaceState::StandingWater);
    host.context.set_sun(Some(GivenDirection { azimuth_deg: 0.0, elevation_deg: -40.0 })).unwrap();
    let at = puddle(&host).extend(0.0);
    for elevation in [65.0f64, 40.0, 25.0, 15.0] {
        let (sin, cos) = elevation.to_radians().sin_cos();
        // The water's middle mirrors the lamp; the eye is one metre from it, the lamp two.
        let eye = at + DVec3::new(0.0, -cos, sin);
        let position_m = at + 2.0 * DVec3::new(0.0, cos, sin);
        let lamp = HostLight {
            position_m,
            direction: -DVec3::Z,
            intensity_cd: [500.0; 3],
            inner_deg: 180.0,
            outer_deg: 180.0,
        };
        let fov = 0.25;
        let camera = look(eye, 0.0, -elevation, fov);
        host.ground_is(SurfaceState::StandingWater);
        let light = of_lamp(&mut host, camera, lamp);
        let (mut sum, mut place) = (0.0, [0.0; 2]);
        let pixel = 2.0 * (0.5 * fov).tan() / f64::from(SIZE.1);
        for (i, l) in light.iter().enumerate() {
            let (x, y) = (i as u32 % SIZE.0, i as u32 / SIZE.0);
            let off = ray(&camera, x, y).dot(ray(&camera, SIZE.0 / 2, SIZE.1 / 2));
            let lux = l * pixel * pixel * off.powi(3);
            sum += lux;
            place = [place[0] + lux * f64::from(x), place[1] + lux * f64::from(y)];
        }
        // A plane mirror gives the illuminance of a lamp three metres away, times Fresnel's reflectance.
        let want = lamp.intensity_cd[1] * fresnel_water(sin) / 9.0;
        assert!((sum / want - 1.0).abs() < 0.02, "{elevation}: {sum} lux, want {want}");
        // The image appears at the lamp's mirrored place below the ground: in the middle of the picture.
        let off = [place[0] / sum - f64::from(SIZE.0) / 2.0, place[1] / sum - f64::from(SIZE.1) / 2.0];
        assert!(off[0].abs() < 1.0 && off[1].abs() < 1.0, "{elevation}: {off:?}");
        host.ground_is(SurfaceState::Dry);
        assert!(of_lamp(&mut host, camera, lamp).iter().all(|l| *l == 0.0), "{elevation}: dry ground mirrors no lamp");
    }
    // In a film the image is long, and beside the lamp's direction there is none of its light.
    host.ground_is(SurfaceState::Wet);
    let eye = at + DVec3::new(0.0, -6.0, 2.0);
    let position_m = at + DVec3::new(0.0, 6.0, 2.0);
    let lamp =
        HostLight { position_m, direction: -DVec3::Z, intensity_cd: [500.0; 3], inner_deg: 180.0, outer_deg: 180.0 };
    let light = of_lamp(&mut host, look(eye, 0.0, -18.4, 0.8), lamp);
    let column = |x: usize| light.iter().skip(x).step_by(SIZE.0 as usize).sum::<f64>();
    let widest = (0..SIZE.0 as usize).max_by(|a, b| column(*a).total_cmp(&column(*b))).unwrap();
    assert!((78..=81).contains(&widest) && column(80) > 10.0 * column(5), "{widest}: {} {}", column(80), column(5));
}
