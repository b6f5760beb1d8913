//! The night sky in the pictures of a view.

use std::sync::Arc;

use glam::{DMat3, DMat4, DVec3};
use welkin::{
    almanac::{Utc, celestial::direction},
    clouds::CloudModel,
    context::{Context, GivenDirection},
    frame::{Frame, Shared, Stages, View},
    gpu::{Device, DeviceOptions, flat_texture, readback},
    light::luminance,
    scene::{Camera, DepthMapping, ViewRays},
    stars::{Heavens, Star, StarSettings, StarView, light::star_lux, reference},
    weather::Weather,
};
use welkin_support::frame_host::coarse;

/// A night without moon over 50 degrees north: the almanac of 2026-01-18 22:00 UTC at the origin's place.
const NIGHT: Utc = Utc(1_768_773_600.0);

/// A context and a view of it, with a target without depth.
pub struct Night {
    device: Arc<Device>,
    pub context: Context,
    view: View,
    color: wgpu::Texture,
    frame_id: u64,
    cd_m2_per_unit: f64,
}

impl Night {
    pub fn new(size: (u32, u32)) -> Self {
        let device = Device::headless(&DeviceOptions::default()).expect("a software driver is installed");
        Self::on(device, size, wgpu::TextureFormat::Rgba32Float)
    }

    fn on(device: Arc<Device>, size: (u32, u32), format: wgpu::TextureFormat) -> Self {
        let shared = Arc::new(Shared::new(&device).unwrap());
        let mut context = Context::new(device.clone(), shared, coarse()).unwrap();
        context.set_clock(NIGHT, 0.0).unwrap();
        context.set_moon(Some(GivenDirection { azimuth_deg: 0.0, elevation_deg: -60.0 })).unwrap();
        let view = View::new(&context).unwrap();
        let color = target(&device, size, format);
        Self { device, context, view, color, frame_id: 0, cd_m2_per_unit: 1.0 }
    }

    /// The picture, cd/m^2, of a camera that looks to an azimuth and elevation, degrees.
    pub fn picture(&mut self, camera: &Camera) -> Vec<[f32; 4]> {
        self.frame_id += 1;
        let mut frame = Frame::new(self.frame_id, *camera, &self.color, None);
        frame.cd_m2_per_unit = self.cd_m2_per_unit;
        self.view.record(&self.context, &frame, Stages::ALL.without(Stages::TONE)).unwrap();
        readback::rgba(&self.device, &self.color).unwrap()
    }

    fn without_stars(&mut self, without: bool) {
        let none = StarSettings { stars: Some(Vec::new().into()), planets: false, ..StarSettings::default() };
        self.context.set_stars(if without { none } else { StarSettings::default() }).unwrap();
    }
}

fn target(device: &Device, (width, height): (u32, u32), format: wgpu::TextureFormat) -> wgpu::Texture {
    use wgpu::TextureUsages as U;
    flat_texture(
        &device.device,
        "host",
        (width, height),
        format,
        U::RENDER_ATTACHMENT | U::TEXTURE_BINDING | U::COPY_SRC | U::COPY_DST,
    )
}

fn camera(azimuth_deg: f64, elevation_deg: f64) -> Camera {
    let toward = direction(azimuth_deg, elevation_deg);
    Camera::look_to(DVec3::new(0.0, 0.0, 10.0), toward, DVec3::Z, 1.0, 16.0 / 9.0, 0.1)
}

/// Light of a picture less that of another, lux: each pixel's luminance times its solid angle.
pub fn light(picture: &[[f32; 4]], less: &[[f32; 4]], camera: &Camera, (width, height): (u32, u32)) -> f64 {
    let focal = [camera.projection.x_axis.x, camera.projection.y_axis.y];
    let texel = |i: usize| {
        let at = [i as f64 % f64::from(width) + 0.5, (i as f64 / f64::from(width)).floor() + 0.5];
        let [x, y] = [2.0 * at[0] / f64::from(width) - 1.0, 1.0 - 2.0 * at[1] / f64::from(height)];
        let cosine = 1.0 / (1.0 + (x / focal[0]).powi(2) + (y / focal[1]).powi(2)).sqrt();
        let sr = 4.0 / (f64::from(width * height) * focal[0] * focal[1]) * cosine.powi(3);
        sr * luminance(&[0, 1, 2].map(|k| f64::from(picture[i][k]) - f64::from(less[i][k])))
    };
    (0..picture.len()).map(texel).sum()
}

/// Returns the expected result of `light`: the light of every star of the catalogue and of the planets in the picture,
/// after the air; and the camera's limit.
fn expected_light(night: &Night, camera: &Camera, (width, height): (u32, u32)) -> f64 {
    let scene = night.context.scene_at(camera.position, 0.0).unwrap();
    let settings = StarSettings::default();
    let heavens = Heavens::at(NIGHT, &scene.place, &settings).unwrap();
    let mapping = DepthMapping { reversed: true, ..Default::default() };
    let rays = ViewRays::new(camera, &mapping).unwrap();
    let column = |scale: f64, density: &[f64; 3]| density.map(|d| d * scale * (-10.0 / scale).exp());
    let planet = &scene.planet;
    let gas = column(planet.rayleigh.scale_height_m, &planet.rayleigh.scattering_per_m);
    let haze = column(planet.mie.scale_height_m, &planet.mie.extinction_per_m);
    let ozone = planet.absorption.extinction_per_m.map(|e| e * planet.absorption.half_width_m);
    let air = &scene.conditions.air;
    let view = StarView {
        heavens: &heavens,
        clip: camera.projection * DMat4::from_mat3(camera.rotation() * scene.world_to_enu.transpose()),
        rays: &rays,
        size: [width, height],
        y_sign: 1.0,
        zenith_depth: std::array::from_fn(|i| gas[i] + haze[i] + ozone[i]),
        transmittance: 1.0,
        air_density: air.pressure_hpa / 1010.0 * 283.0 / (273.0 + air.temperature_c),
        horizon_deg: 0.0,
        scale: 1.0,
        faintest_lux: welkin::stars::limits::threshold_lux(luminance(&scene.above_fog.sky_lux) / std::f64::consts::PI),
    };
    let points =
        settings.stars().iter().map(|s| (s.direction_at(heavens.years), star_lux(s.magnitude, s.temperature_k)));
    let planets = heavens.planets.iter().map(|p| {
        let temperature = welkin::stars::uniforms::planet_temperature_k(p.body);
        (p.direction, star_lux(p.magnitude, temperature))
    });
    points
        .chain(planets)
        .filter_map(|(direction, lux)| reference::point(&view, direction, lux))
        .map(|p| luminance(&p.light) * p.pixel_sr)
        .sum()
}

#[test]
fn stars_send_the_same_light_at_every_size_of_the_picture() {
    for size in [(320, 180), (640, 360), (1280, 720)] {
        let mut night = Night::new(size);
        let camera = camera(150.0, 40.0);
        let with = night.picture(&camera);
        night.without_stars(true);
        let without = night.picture(&camera);
        let (got, want) = (light(&with, &without, &camera, size), expected_light(&night, &camera, size));
        println!("{size:?}: {:.3} of {:.3} microlux", 1e6 * got, 1e6 * want);
        assert!((got / want - 1.0).abs() < 0.02, "{size:?}: {got} {want}");
    }
}

#[test]
fn opengl_shows_the_same_stars() {
    let options = DeviceOptions { backends: wgpu::Backends::GL, force_tier0: true, ..Default::default() };
    let device = Device::headless(&options).expect("an OpenGL driver: make setup installs one");
    let size = (160, 90);
    let camera = camera(150.0, 40.0);
    // OpenGL ES draws into half floats at most.
    let half = wgpu::TextureFormat::Rgba16Float;
    let vulkan = Device::headless(&DeviceOptions::default()).unwrap();
    let [here, there] = [vulkan, device].map(|device| {
        let mut night = Night::on(device, size, half);
        night.cd_m2_per_unit = 1e-3;
        let picture = night.picture(&camera);
        let mean = picture.iter().map(|p| f64::from(p[1])).sum::<f64>() / picture.len() as f64;
        let most = picture.iter().fold(0f32, |most, p| most.max(p[1]));
        [mean, f64::from(most)]
    });
    println!("mean and brightest pixel, mcd/m^2: {here:.6?}, with OpenGL {there:.6?}");
    assert!(here[1] > 10.0 * here[0], "there are stars");
    for (here, there) in here.into_iter().zip(there) {
        assert!((there / here - 1.0).abs() < 0.02, "{there} with OpenGL, {here} without");
    }
}

#[test]
fn the_light_of_stars_does_not_flicker_while_the_camera_turns() {
    let size = (320, 180);
    let mut night = Night::new(size);
    let mut of = |without: bool, i: u32| {
        night.without_stars(without);
        // A fifteenth of a pixel a step.
        let camera = camera(150.0 + 0.02 * f64::from(i), 40.0);
        (night.picture(&camera), camera)
    };
    let lights: Vec<f64> = (0..12)
        .map(|i| {
            let (with, camera) = of(false, i);
            let (without, _) = of(true, i);
            light(&with, &without, &camera, size)
        })
        .collect();
    for pair in lights.windows(2) {
        assert!((pair[1] / pair[0] - 1.0).abs() < 0.003, "{lights:?}");
    }
}

#[test]
fn by_day_in_fog_and_under_a_deck_there_are_no_stars() {
    let mut night = Night::new((160, 90));
    // Clouds as a volume have passes of their own.
    night.context.set_cloud_model(CloudModel::Deck);
    let camera = camera(150.0, 40.0);
    let same = |night: &mut Night, name: &str, is_same: bool| {
        night.without_stars(false);
        let with = night.picture(&camera);
        // One pass is the composition. Two draw the coarse grid if nothing in the picture is fine; otherwise one draws
        // the layer.
        assert_eq!(night.view.report().passes, if is_same { 3 } else { 2 }, "{name}");
        night.without_stars(true);
        let without = night.picture(&camera);
        assert_eq!(with == without, is_same, "{name}");
    };
    same(&mut night, "a clear night", false);
    let set = |night: &mut Night, metar: &str| {
        let weather = Weather::from_metar(metar).unwrap();
        night.context.set_weather(&weather.weather, 0.0, 0.0).unwrap();
    };
    set(&mut night, "EDDF 182150Z 00000KT 9999 OVC010 02/01 Q1013");
    same(&mut night, "under a deck", true);
    set(&mut night, "EDDF 182150Z 00000KT 0050 FG VV001 02/02 Q1013");
    same(&mut night, "in fog", true);
    set(&mut night, "EDDF 182150Z 00000KT CAVOK 02/M05 Q1013");
    same(&mut night, "clear again", false);
    night.context.set_sun(Some(GivenDirection { azimuth_deg: 140.0, elevation_deg: 2.0 })).unwrap();
    same(&mut night, "by day", true);
}

#[test]
fn a_hosts_own_stars_show_in_twilight_in_any_order() {
    let mut night = Night::new((160, 90));
    // Before the glow begins, the layer is drawn only for stars that are visible in the sky's light.
    night.context.set_sun(Some(GivenDirection { azimuth_deg: 330.0, elevation_deg: -3.5 })).unwrap();
    let star = |azimuth_deg, magnitude| Star {
        direction: direction(azimuth_deg, 40.0),
        motion: DVec3::ZERO,
        magnitude,
        temperature_k: 6000.0,
    };
    let (faint, bright) = (star(145.0, 6.0), star(155.0, -6.0));
    let mut picture = |stars: &[Star]| {
        let celestial_to_world = Some(DMat3::IDENTITY);
        let own =
            StarSettings { stars: Some(stars.into()), planets: false, celestial_to_world, ..StarSettings::default() };
        night.context.set_stars(own).unwrap();
        night.picture(&camera(150.0, 40.0))
    };
    let none = picture(&[]);
    let [first, last] = [picture(&[bright, faint]), picture(&[faint, bright])];
    assert!(first != none, "the bright star shows");
    assert!(first == last, "and it shows wherever it stands in the list");
}

#[test]
fn the_layer_of_stars_rests_while_nothing_moves() {
    let mut night = Night::new((160, 90));
    let first = night.picture(&camera(150.0, 40.0));
    assert_eq!(night.view.report().passes, 2, "the layer's pass and the composition's");
    let again = night.picture(&camera(150.0, 40.0));
    assert_eq!(night.view.report().passes, 1, "the layer is there");
    assert!(first == again);
    let turned = night.picture(&camera(151.0, 40.0));
    assert_eq!(night.view.report().passes, 2, "the camera turned");
    let back = night.picture(&camera(150.0, 40.0));
    assert!(turned != first && back == first);
    night.context.set_clock(Utc(NIGHT.0 + 60.0), 0.0).unwrap();
    let later = night.picture(&camera(150.0, 40.0));
    assert_eq!(night.view.report().passes, 2, "the heavens turned");
    assert!(later != first);
    // Another picture's size takes another layer.
    night.color = target(&night.device, (320, 180), wgpu::TextureFormat::Rgba32Float);
    night.picture(&camera(150.0, 40.0));
    assert_eq!(night.view.report().passes, 2);
}

/// Mean luminance of a small picture straight up, stars left out.
fn zenith(night: &mut Night) -> f64 {
    night.without_stars(true);
    let toward = Camera::look_to(DVec3::new(0.0, 0.0, 10.0), DVec3::Z, DVec3::Y, 0.3, 16.0 / 9.0, 0.1);
    let picture = night.picture(&toward);
    picture.iter().map(|p| luminance(&[p[0], p[1], p[2]].map(f64::from))).sum::<f64>() / picture.len() as f64
}

#[test]
fn a_moonless_zenith_is_as_dark_as_measured_and_dusk_comes_without_a_leap() {
    let mut night = Night::new((32, 18));
    // 21.0 to 22.1 mag/arcsec^2 (Patat 2003; Benn and Ellison 1998; Falchi et al. 2016).
    let magnitude = |cd_m2: f64| 12.58 - 2.5 * cd_m2.log10();
    for hours in 0..5 {
        night.context.set_clock(Utc(NIGHT.0 + 3600.0 * f64::from(hours)), 0.0).unwrap();
        let m = magnitude(zenith(&mut night));
        println!("zenith {m:.2} mag/arcsec^2");
        assert!((21.0..22.1).contains(&m), "{m}");
    }
    night.context.set_clock(NIGHT, 0.0).unwrap();
    let mut last = None;
    for i in 0..100 {
        let elevation_deg = -2.0 - 0.1 * f64::from(i);
        night.context.set_sun(Some(GivenDirection { azimuth_deg: 290.0, elevation_deg })).unwrap();
        let now = zenith(&mut night);
        if let Some(last) = last.replace(now) {
            let ratio: f64 = now / last;
            assert!((0.85..1.001).contains(&ratio), "{elevation_deg}: {last} to {now}");
        }
    }
}
