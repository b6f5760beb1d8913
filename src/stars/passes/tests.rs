use glam::{DMat4, DVec3};

use super::*;
use crate::{
    almanac::Utc,
    gpu::{DeviceOptions, readback, shader::assert_layout},
    light::luminance,
    scene::{Camera, ClipSpace, DepthKind, DepthMapping, Place, ViewRays},
    stars::{Heavens, catalogue, reference},
    tests::textures::texture,
};

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
const SIZES: [[u32; 2]; 3] = [[320, 180], [640, 360], [1280, 720]];

/// A star pass with its device, and the sky of one place and time.
struct Night {
    device: Arc<Device>,
    pass: StarPass,
    settings: StarSettings,
    heavens: Heavens,
}

impl Night {
    /// Creates a night with these stars, whose directions are (east, north, up).
    fn new(stars: Vec<Star>) -> Self {
        let device = Device::headless(&DeviceOptions::default()).expect("a software driver is installed");
        let place = Place { latitude_deg: 45.0, longitude_deg: 0.0, altitude_m: 0.0 };
        let heavens = Heavens::at(Utc(1.7e9), &place, &StarSettings::default()).unwrap();
        let catalogued = |s: Star| Star { direction: heavens.to_world.transpose() * s.direction, ..s };
        let stars = Some(stars.into_iter().map(catalogued).collect());
        let settings = StarSettings { stars, planets: false, ..Default::default() };
        Self { pass: StarPass::new(&device), device, settings, heavens }
    }

    /// Draws the stars and reads the picture back; `depth` is the host's depth.
    fn draw(&mut self, view: &StarView<'_>, depth: Option<StarDepth<'_>>) -> Vec<[f64; 3]> {
        let device = self.device.clone();
        let target = texture(&device, view.size.into(), FORMAT, 1);
        self.pass.prepare(&device, &self.settings, view, FORMAT, depth).unwrap();
        let mut encoder = device.device.create_command_encoder(&Default::default());
        let target_view = target.create_view(&Default::default());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &target_view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..Default::default()
        });
        self.pass.draw(&mut pass);
        drop(pass);
        device.submit_and_wait(encoder).unwrap();
        let read = readback::rgba(&device, &target).unwrap();
        read.into_iter().map(|p| [p[0], p[1], p[2]].map(f64::from)).collect()
    }
}

/// Creates a depth texture with the same depth in all pixels.
fn depth_of(device: &Device, size: [u32; 2], samples: u32, depth: f32) -> wgpu::TextureView {
    let view =
        texture(device, size.into(), wgpu::TextureFormat::Depth32Float, samples).create_view(&Default::default());
    let mut encoder = device.device.create_command_encoder(&Default::default());
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: &view,
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(depth), store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        }),
        ..Default::default()
    });
    device.submit(encoder);
    view
}

/// Returns 60 stars of magnitudes 0 to 5 and several colours, 10 to 40 degrees up and within 30 degrees of north.
fn sprinkled() -> Vec<Star> {
    let share = |i: u32, prime: u32| f64::from(i * prime % 61) / 61.0;
    let star = |i: u32| {
        let toward = crate::almanac::celestial::direction(-30.0 + 60.0 * share(i, 23), 10.0 + 30.0 * share(i, 37));
        Star { direction: toward, ..Star::new(0.0, 0.0, 5.0 * share(i, 17), 3000.0 + 9000.0 * share(i, 11)) }
    };
    (0..60).map(star).collect()
}

/// Creates a camera that looks 25 degrees above the northern horizon, turned to the left by `turn` rad.
fn camera(turn: f64, aspect: f64) -> Camera {
    let forward = crate::almanac::celestial::direction(-turn.to_degrees(), 25.0);
    Camera::look_to(DVec3::ZERO, forward, DVec3::Z, 50f64.to_radians(), aspect, 0.1)
}

fn rays(camera: &Camera) -> ViewRays {
    let mapping = DepthMapping { kind: DepthKind::Perspective, clip: ClipSpace::ZeroToOne, reversed: true };
    ViewRays::new(camera, &mapping).unwrap()
}

/// Creates a view in clear air without a limit of brightness.
fn view<'a>(heavens: &'a Heavens, camera: &Camera, rays: &'a ViewRays, size: [u32; 2]) -> StarView<'a> {
    StarView {
        heavens,
        clip: camera.projection * DMat4::from_mat3(camera.rotation()),
        rays,
        size,
        y_sign: 1.0,
        zenith_depth: [0.07, 0.11, 0.24],
        transmittance: 0.8,
        air_density: 1.0,
        horizon_deg: -0.5,
        scale: 3.0,
        faintest_lux: 0.0,
    }
}

/// Returns the sum of a picture's light: luminance times solid angle of each pixel.
fn light_of(picture: &[[f64; 3]], view: &StarView<'_>, camera: &Camera) -> f64 {
    let [width, height] = view.size.map(f64::from);
    let focal = [camera.projection.x_axis.x, camera.projection.y_axis.y];
    let texel = |i: usize| {
        let at = [i as f64 % width + 0.5, (i as f64 / width).floor() + 0.5];
        let ndc = [2.0 * at[0] / width - 1.0, 1.0 - 2.0 * at[1] / height];
        let cosine = 1.0 / (1.0 + (ndc[0] / focal[0]).powi(2) + (ndc[1] / focal[1]).powi(2)).sqrt();
        luminance(&picture[i]) * view.pixel_sr() * cosine.powi(3)
    };
    (0..picture.len()).map(texel).sum()
}

/// Returns the picture of the same stars by the reference, and the sum of its light.
fn expected(view: &StarView<'_>, stars: &[Star]) -> (Vec<[f64; 3]>, f64) {
    let mut picture = vec![[0.0; 3]; (view.size[0] * view.size[1]) as usize];
    let mut light = 0.0;
    for star in stars {
        let lux = crate::stars::light::star_lux(star.magnitude, star.temperature_k);
        if let Some(point) = reference::point(view, star.direction, lux) {
            reference::add(&mut picture, view.size, &point);
            light += luminance(&point.light) * point.pixel_sr;
        }
    }
    (picture, light)
}

#[test]
fn the_block_is_laid_out_as_the_shader_reads_it() {
    assert_layout!(
        "stars/points.wgsl",
        "StarUniform",
        StarUniform,
        [
            depth,
            clip,
            to_world,
            velocity,
            scale,
            zenith_depth,
            transmittance,
            size,
            pixel_sr,
            y_sign,
            faintest,
            air_density,
            horizon,
            pad
        ]
    );
    assert_eq!(size_of::<StarInstance>(), 24);
}

#[test]
fn stars_send_the_same_light_at_every_size_and_do_not_flicker_as_the_camera_turns() {
    let mut night = Night::new(sprinkled());
    let (heavens, settings) = (night.heavens, night.settings.clone());
    for size in SIZES {
        let aspect = f64::from(size[0]) / f64::from(size[1]);
        let mut lights = Vec::new();
        for step in 0..6 {
            // A pixel spans about 50 degrees divided by the picture's height; each step turns the camera by a sixth of
            // that.
            let turn = f64::from(step) / 6.0 * 50f64.to_radians() / f64::from(size[1]);
            let camera = camera(turn, aspect);
            let rays = rays(&camera);
            let y_sign = if step % 2 == 0 { 1.0 } else { -1.0 };
            let view = StarView { y_sign, ..view(&heavens, &camera, &rays, size) };
            let picture = night.draw(&view, None);
            let light = light_of(&picture, &view, &camera);
            let (twin, sum) = expected(&view, settings.stars());
            assert!((light / sum - 1.0).abs() < 0.02, "{size:?} {step}: {light} of {sum}");
            let brightest = twin.iter().map(luminance).fold(0.0, f64::max);
            let off = picture.iter().zip(&twin).map(|(a, b)| (luminance(a) - luminance(b)).abs()).fold(0.0, f64::max);
            assert!(off < 0.01 * brightest, "{size:?} {step}: off by {off} of {brightest}");
            lights.push(light);
        }
        let (least, most) = lights.iter().fold((f64::MAX, 0.0f64), |(a, b), l| (a.min(*l), b.max(*l)));
        println!("{size:?}: light varies by {:.3} %", 100.0 * (most / least - 1.0));
        assert!(most / least < 1.02, "{size:?}: {lights:?}");
    }
}

#[test]
fn what_the_host_has_drawn_hides_stars_whatever_its_samples() {
    let mut night = Night::new(sprinkled());
    let (heavens, size) = (night.heavens, SIZES[0]);
    let camera = camera(0.0, 16.0 / 9.0);
    let rays = rays(&camera);
    let view = view(&heavens, &camera, &rays, size);
    let sum = |picture: Vec<[f64; 3]>| picture.iter().map(luminance).sum::<f64>();
    let open = sum(night.draw(&view, None));
    assert!(open > 0.0);
    for samples in [1, 4] {
        for (depth, left) in [(0.0, 1.0), (0.01, 0.0)] {
            let texture = depth_of(&night.device, size, samples, depth);
            let seen = sum(night.draw(&view, Some(StarDepth { view: &texture, multisampled: samples > 1 })));
            assert!((seen / open - left).abs() < 1e-3, "{samples} {depth}: {seen} of {open}");
        }
    }
}

#[test]
fn faint_stars_planets_and_the_sky_below_cost_nothing() {
    let mut night = Night::new(sprinkled());
    let (device, heavens) = (night.device.clone(), night.heavens);
    let camera = camera(0.0, 16.0 / 9.0);
    let rays = rays(&camera);
    let all = view(&heavens, &camera, &rays, SIZES[0]);
    let faintest_lux = crate::stars::light::illuminance_lux(2.5);
    let some = StarView { faintest_lux, ..all };
    let count = |night: &mut Night, view: &StarView<'_>| {
        night.pass.prepare(&device, &night.settings, view, FORMAT, None).unwrap() as usize
    };
    let bright = sprinkled().iter().filter(|s| s.magnitude < 2.5).count();
    assert_eq!([count(&mut night, &all), count(&mut night, &some)], [60, bright]);
    assert_eq!(night.pass.bytes(), (66 * 24 + size_of::<StarUniform>()) as u64);
    let mut whole = StarPass::new(&device);
    // The pass prepares only stars of the catalogue in the picture and in a margin around it.
    let shown = whole.prepare(&device, &StarSettings::default(), &all, FORMAT, None).unwrap() as usize;
    let lux = |s: &Star| crate::stars::light::star_lux(s.magnitude, s.temperature_k);
    let direction = |s: &Star| s.direction_at(heavens.years);
    let sky = StarView { horizon_deg: -90.0, ..all };
    let seen = catalogue().iter().filter(|s| reference::point(&sky, direction(s), lux(s)).is_some()).count();
    assert!(shown >= seen && shown < seen + seen / 8 + 6, "{shown} of {seen}");
    assert_eq!(whole.bytes(), 218_448 + size_of::<StarUniform>() as u64);
    // Stars near the limit fade rather than vanish at once.
    let (picture, _) = expected(&some, night.settings.stars());
    let drawn = night.draw(&some, None);
    let off = picture.iter().zip(&drawn).map(|(a, b)| (luminance(a) - luminance(b)).abs()).fold(0.0, f64::max);
    assert!(off < 0.01 * picture.iter().map(luminance).fold(0.0, f64::max), "{off}");
    // With the horizon at 80 degrees the planet hides all stars.
    let below = night.draw(&StarView { horizon_deg: 80.0, ..all }, None);
    assert!(below.iter().all(|p| *p == [0.0; 3]));
    let bad = StarView { transmittance: 1.5, ..all };
    let e = night.pass.prepare(&device, &night.settings, &bad, FORMAT, None).unwrap_err();
    assert!(e.to_string().contains("transmittance must be in [0, 1]"), "{e}");
}

#[test]
fn planets_are_drawn_where_they_stand_and_only_if_asked_for() {
    let mut night = Night::new(vec![Star::new(0.0, -89.0, 20.0, 5000.0)]);
    night.settings.planets = true;
    let jupiter = night.heavens.planets[3];
    let forward = night.heavens.seen(jupiter.direction);
    let camera = Camera::look_to(DVec3::ZERO, forward, DVec3::Z, 0.2, 16.0 / 9.0, 0.1);
    let (heavens, rays) = (night.heavens, rays(&camera));
    let view = StarView { horizon_deg: -90.0, air_density: 0.0, ..view(&heavens, &camera, &rays, SIZES[0]) };
    let picture = night.draw(&view, None);
    let brightest =
        (0..picture.len()).max_by(|a, b| luminance(&picture[*a]).total_cmp(&luminance(&picture[*b]))).unwrap();
    let at = [brightest as u32 % 320, brightest as u32 / 320];
    assert!((159..=160).contains(&at[0]) && (89..=90).contains(&at[1]), "{at:?}");
    night.settings.planets = false;
    assert!(night.draw(&view, None).iter().all(|p| *p == [0.0; 3]));
}
