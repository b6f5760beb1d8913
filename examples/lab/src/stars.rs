//! Draws and times every way to draw the night sky, and computes the truth: every star and planet of the catalogue,
//! however faint, and the glow at every pixel, in f64.
//!
//! A star covers only a few pixels, so pictures are compared by their light: by the mean luminance of blocks of 20 x 20
//! pixels, and by the total light of the stars above the even night.

use std::{sync::Arc, time::Instant};

use glam::{DMat4, DVec3};
use welkin::Result;
use welkin::almanac::{Utc, celestial::direction};
use welkin::context::{Context, ContextDesc, GivenDirection, Scene};
use welkin::frame::{Frame, PARTS, Shared, Stages, View};
use welkin::gpu::{Device, readback};
use welkin::light::luminance;
use welkin::plan::{Budget, PartWish};
use welkin::scene::{Camera, ViewRays};
use welkin::stars::{
    Heavens, NightSky, StarPass, StarSettings, StarView, candidates::StarMethod, light::star_lux, reference,
    uniforms::planet_temperature_k,
};

use crate::picture::Picture;
use crate::scenes::StarScene;
use crate::timing::target;

/// Size of the pictures whose error is measured.
pub const SIZE: (u32, u32) = (320, 180);
/// Side of a block in them, pixels.
const BLOCK: u32 = 20;
/// 2026-01-18 22:00 UTC: Orion is in the south at 50 degrees north, longitude 10.
const CLOCK: Utc = Utc(1_768_773_600.0);
const EYE: DVec3 = DVec3::new(0.0, 0.0, 10.0);
/// Luminance of the value 1, chosen so that night lies where half floats are precise, cd/m^2.
const UNIT: f64 = 1e-5;
/// Frames until a plan has faded to the pinned rungs.
const SETTLED: u32 = 40;
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// A host with a night sky on the GPU.
pub struct Host {
    device: Arc<Device>,
    context: Context,
    view: View,
    color: wgpu::Texture,
    camera: Camera,
    points: StarPass,
    frame_id: u64,
}

impl Host {
    /// Creates the host of a scene for pictures of a size.
    ///
    /// # Errors
    /// GPU faults.
    pub fn new(device: &Arc<Device>, scene: &StarScene, size: (u32, u32)) -> Result<Self> {
        let mut context = Context::new(device.clone(), Arc::new(Shared::new(device)?), ContextDesc::default())?;
        context.set_clock(CLOCK, 0.0)?;
        let given = |azimuth_deg, elevation_deg| Some(GivenDirection { azimuth_deg, elevation_deg });
        context.set_sun(given(300.0, scene.sun_deg))?;
        context.set_moon(given(250.0, scene.moon_deg))?;
        context.build_sky(&mut |_| true)?;
        let toward = direction(150.0, 40.0);
        Ok(Self {
            device: device.clone(),
            view: View::new(&context)?,
            color: target(device, size, FORMAT),
            camera: Camera::look_to(EYE, toward, DVec3::Z, 1.0, f64::from(size.0) / f64::from(size.1), 0.1),
            points: StarPass::new(device),
            context,
            frame_id: 0,
        })
    }

    fn scene(&self) -> Result<Scene> {
        self.context.scene_at(EYE, 0.0)
    }

    fn heavens(&self) -> Result<Heavens> {
        Heavens::at(CLOCK, &self.scene()?.place, &StarSettings::default())
    }

    /// Configures the view for a method.
    fn set(&mut self, method: StarMethod) -> Result<()> {
        let without = StarSettings { stars: Some(Vec::new().into()), planets: false, ..StarSettings::default() };
        // The lab's own pass draws all points.
        let has_points = matches!(method, StarMethod::Visible | StarMethod::Even);
        self.context.set_stars(if has_points { StarSettings::default() } else { without })?;
        let mut wishes = vec![PartWish::default(); PARTS.len()];
        for (wish, part) in wishes.iter_mut().zip(PARTS) {
            wish.rung = Some(usize::from(part.name == "stars" && method == StarMethod::Even));
        }
        self.view.set_budget(Budget { wishes, ..Budget::default() })
    }

    /// Draws one frame and returns its time, ms.
    fn frame(&mut self, method: StarMethod) -> Result<f64> {
        self.frame_id += 1;
        let start = Instant::now();
        let frame = Frame { cd_m2_per_unit: UNIT, ..Frame::new(self.frame_id, self.camera, &self.color, None) };
        self.view.record(&self.context, &frame, Stages::BACKGROUND)?;
        if method == StarMethod::All {
            self.draw_all()?;
        }
        self.device.wait()?;
        Ok(start.elapsed().as_secs_f64() * 1e3)
    }

    /// Draws every star and planet over the picture.
    fn draw_all(&mut self) -> Result<()> {
        let (scene, heavens, rays) = (self.scene()?, self.heavens()?, self.rays()?);
        let view = self.star_view(&scene, &heavens, &rays, 1.0 / UNIT);
        self.points.prepare(&self.device, &StarSettings::default(), &view, FORMAT, None)?;
        let mut encoder = self.device.device.create_command_encoder(&Default::default());
        let attached = self.color.create_view(&Default::default());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("all stars"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &attached,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
            })],
            ..Default::default()
        });
        self.points.draw(&mut pass);
        drop(pass);
        self.device.submit(encoder);
        Ok(())
    }

    /// Time of a frame by a method, ms. Configures the view if the method has changed.
    ///
    /// # Errors
    /// GPU faults.
    pub fn timed(&mut self, method: StarMethod, is_first: bool) -> Result<f64> {
        if is_first {
            self.settle(method)?;
        }
        self.frame(method)
    }

    fn settle(&mut self, method: StarMethod) -> Result<()> {
        self.set(method)?;
        (0..SETTLED).try_for_each(|_| self.frame(method).map(|_| ()))
    }

    /// The picture by a method, cd/m^2.
    ///
    /// # Errors
    /// GPU faults.
    pub fn picture(&mut self, method: StarMethod) -> Result<Picture> {
        self.settle(method)?;
        let texels = readback::rgba(&self.device, &self.color)?;
        let texels = texels.iter().map(|t| [t[0], t[1], t[2]].map(|v| UNIT * f64::from(v))).collect();
        Ok(Picture { width: self.color.width(), height: self.color.height(), texels })
    }

    fn rays(&self) -> Result<ViewRays> {
        ViewRays::new(&self.camera, &Frame::new(1, self.camera, &self.color, None).depth_mapping)
    }

    /// All stars, in units of `scale` per cd/m^2.
    fn star_view<'a>(&self, scene: &Scene, heavens: &'a Heavens, rays: &'a ViewRays, scale: f64) -> StarView<'a> {
        let air = &scene.conditions.air;
        StarView {
            heavens,
            clip: self.camera.projection * DMat4::from_mat3(self.camera.rotation() * scene.world_to_enu.transpose()),
            rays,
            size: [self.color.width(), self.color.height()],
            y_sign: 1.0,
            zenith_depth: zenith_depth(scene),
            transmittance: 1.0,
            air_density: air.pressure_hpa / 1010.0 * 283.0 / (273.0 + air.temperature_c),
            horizon_deg: 0.0,
            scale,
            faintest_lux: 0.0,
        }
    }

    /// The truth, cd/m^2: the even night's picture with its night replaced by the one in f64. Also returns the even
    /// night's picture.
    ///
    /// # Errors
    /// GPU faults.
    pub fn truth(&mut self) -> Result<(Picture, Picture)> {
        let even = self.picture(StarMethod::Even)?;
        let (scene, heavens, rays) = (self.scene()?, self.heavens()?, self.rays()?);
        let glow = NightSky::new(&heavens, scene.place.altitude_m, zenith_depth(&scene), 1.0);
        let view = self.star_view(&scene, &heavens, &rays, 1.0);
        let from_clip = view.clip.inverse();
        let [width, height] = view.size;
        let mut truth = even.clone();
        for (i, texel) in truth.texels.iter_mut().enumerate() {
            let at = |i: u32, n: u32| 2.0 * (f64::from(i) + 0.5) / f64::from(n) - 1.0;
            let far = DVec3::new(at(i as u32 % width, width), -at(i as u32 / width, height), 0.5);
            let night = glow.luminance(from_clip.project_point3(far).normalize());
            (0..3).for_each(|k| texel[k] += night[k] - scene.night_floor_cd_m2[k]);
        }
        let stars = StarSettings::default();
        let catalogued =
            stars.stars().iter().map(|s| (s.direction_at(heavens.years), star_lux(s.magnitude, s.temperature_k)));
        let planets = heavens.planets.iter().map(|p| {
            let lux = star_lux(p.magnitude, planet_temperature_k(p.body));
            (p.direction, lux)
        });
        for (direction, lux) in catalogued.chain(planets) {
            if let Some(point) = reference::point(&view, direction, lux) {
                reference::add(&mut truth.texels, view.size, &point);
            }
        }
        Ok((truth, even))
    }
}

/// Vertical optical depths of a scene's air.
fn zenith_depth(scene: &Scene) -> [f64; 3] {
    let planet = &scene.planet;
    let column = |scale: f64| scale * (-scene.place.altitude_m.max(0.0) / scale).exp();
    let (gas, haze) = (&planet.rayleigh, &planet.mie);
    let ozone = &planet.absorption;
    std::array::from_fn(|i| {
        gas.scattering_per_m[i] * column(gas.scale_height_m)
            + haze.extinction_per_m[i] * column(haze.scale_height_m)
            + ozone.extinction_per_m[i] * ozone.half_width_m
    })
}

/// The means of a picture's blocks.
pub fn blocks(picture: &Picture) -> Picture {
    let (width, height) = (picture.width / BLOCK, picture.height / BLOCK);
    let mean = |i: u32| {
        let (x, y) = (i % width * BLOCK, i / width * BLOCK);
        let of = |k: u32| picture.texels[((y + k / BLOCK) * picture.width + x + k % BLOCK) as usize];
        let sum = (0..BLOCK * BLOCK).map(of).fold([0.0; 3], |sum, t| [0, 1, 2].map(|c| sum[c] + t[c]));
        sum.map(|v| v / f64::from(BLOCK * BLOCK))
    };
    Picture { width, height, texels: (0..width * height).map(mean).collect() }
}

/// Relative error of the total light of the stars above the even night.
pub fn flux_error(drawn: &Picture, truth: &Picture, even: &Picture) -> f64 {
    let light = |p: &Picture| p.texels.iter().zip(&even.texels).map(|(a, b)| luminance(a) - luminance(b)).sum::<f64>();
    (light(drawn) / light(truth) - 1.0).abs()
}
