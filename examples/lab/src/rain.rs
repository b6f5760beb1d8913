//! Draws and times every way to draw rain, and computes the truth: each drop in front of the camera by itself, in f64.
//!
//! Different methods put drops in different places, so pictures are compared as textures. In blocks of 20 x 20 pixels,
//! over several moments, the comparison uses the mean luminance and its standard deviation between pixels and between
//! patches of 4 x 4.

use std::{f64::consts::PI, sync::Arc, time::Instant};

use glam::{DMat3, DVec2, DVec3};
use welkin::candidates::Method as LibraryMethod;
use welkin::context::{Context, ContextDesc, GivenDirection, Scene};
use welkin::flow::WindFieldDesc;
use welkin::fog::{CONTRAST_THRESHOLD, koschmieder_extinction_per_m};
use welkin::frame::{Frame, Shared, Stages, View};
use welkin::gpu::{Device, readback};
use welkin::light::luminance;
use welkin::rain::{
    Classes, DropLight, Planes, RainModel, RainSettings, Shelter, cones, drops, lattice, light, sizes::DropSizes,
};
use welkin::scene::{Camera, HostLight};
use welkin::sky::SkySettings;
use welkin::snow::SnowSettings;
use welkin::weather::{Precipitation, PrecipitationKind, Weather, hydrometeors::snow_extinction_per_m};
use welkin::{Error, Result};
use welkin_support::brute_rain::Film;

use crate::candidates::{Candidate, Method};
use crate::scenes::RainScene;
use crate::source_lod::SourceLod;
use crate::timing::target;

/// Size of the pictures whose error is measured.
pub const SIZE: (u32, u32) = (320, 180);
/// Side of a block, and of a patch in it, pixels.
const BLOCK: u32 = 20;
const PATCH: u32 = 4;
/// Number of moments at which blocks are compared, and the time between them, s.
pub const MOMENTS: usize = 6;
const FOV: f64 = 0.9;
pub const EYE: DVec3 = DVec3::new(0.0, 0.0, 12.0);
/// Distance of the wall that hides the horizon, m ahead.
const WALL_M: f64 = 60.0;
/// Distance up to which the truth has drops.
const FAR_M: f64 = cones::BANDS_M[cones::CONES];
const NEAREST: (f64, f64) = (0.125, 0.25);
/// Smaller drops are never visible as drops, mm.
const DRAWN_FROM_MM: f64 = 0.5;
const HALF: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::R32Float;

/// A host with a scene's rain and one view.
pub struct Host {
    device: Arc<Device>,
    context: Context,
    view: View,
    scene: RainScene,
    size: (u32, u32),
    color: wgpu::Texture,
    depth: wgpu::Texture,
    painted: Vec<u8>,
    next: u64,
}

fn camera(size: (u32, u32)) -> Camera {
    Camera::look_to(EYE, DVec3::Y, DVec3::Z, FOV, f64::from(size.0) / f64::from(size.1), 0.1)
}

/// Focal length in pixels: the size in pixels of 1 m at a distance of 1 m.
pub fn focal(size: (u32, u32)) -> f64 {
    0.5 * f64::from(size.1) / (0.5 * FOV).tan()
}

impl Host {
    /// Creates the host of a scene for pictures of a size.
    pub fn new(device: &Arc<Device>, scene: &RainScene, size: (u32, u32)) -> Result<Self> {
        let shared = Arc::new(Shared::new(device)?);
        // Small tables, as the sky is not measured here.
        let sky = SkySettings { orders: 4, suns: 32, altitudes: 14, ..SkySettings::default() };
        let mut context = Context::new(device.clone(), shared, ContextDesc { sky, seed: 5, ..Default::default() })?;
        context.set_sun(Some(GivenDirection { azimuth_deg: scene.sun_azimuth_deg, elevation_deg: scene.sun_deg }))?;
        // Clear air except for the precipitation.
        let (kind, falling) = match scene.snow_c {
            Some(_) => (PrecipitationKind::Snow, snow_extinction_per_m(scene.rate_mm_h)),
            None => (PrecipitationKind::Rain, DropSizes::of_rain(scene.rate_mm_h, 1.0).extinction_per_m()),
        };
        let extinction = falling + koschmieder_extinction_per_m(20_000.0);
        let mut weather = Weather {
            precipitation: Precipitation::of(kind, scene.rate_mm_h),
            visibility_m: -CONTRAST_THRESHOLD.ln() / extinction,
            temperature_c: scene.snow_c.unwrap_or(Weather::default().temperature_c),
            ..Weather::default()
        };
        weather.wind.speed_m_s = scene.wind_m_s;
        weather.wind.from_deg = 270.0;
        context.set_weather(&weather, 0.0, 0.0)?;
        if scene.lamps {
            let lamp = |x: f64| HostLight {
                position_m: EYE + DVec3::new(x, 0.5, -0.8),
                direction: DVec3::Y,
                intensity_cd: [20_000.0, 19_000.0, 17_000.0],
                inner_deg: 15.0,
                outer_deg: 40.0,
            };
            context.set_lights(&[lamp(-0.9), lamp(0.9)])?;
        }
        let view = View::new(&context)?;
        let (color, depth) = (target(device, size, HALF), target(device, size, DEPTH));
        let mut this = Self {
            device: device.clone(),
            context,
            view,
            scene: *scene,
            size,
            color,
            depth,
            painted: Vec::new(),
            next: 0,
        };
        this.paint()?;
        Ok(this)
    }

    /// Draws a wall up to 3 degrees above the camera's horizon, dark in its left half and light in its right half, with
    /// sky above.
    fn paint(&mut self) -> Result<()> {
        let scene = self.scene()?;
        let lux = scene.ground.sky_lux;
        let f = focal(self.size);
        let (mut colors, mut depths) = (Vec::new(), Vec::new());
        for y in 0..self.size.1 {
            for x in 0..self.size.0 {
                let up = (0.5 * f64::from(self.size.1) - f64::from(y) - 0.5) / f;
                let wall = up < 3f64.to_radians().tan();
                let albedo = if x < self.size.0 / 2 { 0.02 } else { 0.6 };
                let texel = if wall { lux.map(|l| 0.5 * albedo * l / PI) } else { [0.0; 3] };
                let texel = texel.map(|v| half::f16::from_f64(v).to_bits());
                colors.extend([texel[0], texel[1], texel[2], half::f16::ONE.to_bits()]);
                depths.push(if wall { (0.1 / WALL_M) as f32 } else { 0.0 });
            }
        }
        self.painted = bytemuck::cast_slice(&colors).to_vec();
        self.upload(&self.depth, bytemuck::cast_slice(&depths), 4);
        Ok(())
    }

    fn upload(&self, texture: &wgpu::Texture, bytes: &[u8], texel: u32) {
        let row = Some(texel * self.size.0);
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: row, rows_per_image: None };
        self.device.queue.write_texture(texture.as_image_copy(), bytes, layout, texture.size());
    }

    /// The library's conditions at the camera.
    pub fn scene(&self) -> Result<Scene> {
        self.context.scene_at(EYE, self.context.time_s())
    }

    /// Sets how rain is drawn from now on.
    pub fn set(&mut self, settings: RainSettings) -> Result<()> {
        self.view.set_rain(settings)
    }

    /// Sets how snow is drawn from now on.
    pub fn set_snow(&mut self, settings: SnowSettings) -> Result<()> {
        self.view.set_snow(settings)
    }

    /// Sets boxes that shelter from precipitation.
    pub fn set_shelters(&mut self, boxes: &[Shelter]) -> Result<()> {
        self.context.set_shelters(boxes)
    }

    /// Velocity of the air at the camera.
    pub fn wind_m_s(&self) -> DVec3 {
        DVec3::X * self.scene.wind_m_s
    }

    /// Velocity of the camera.
    pub fn camera_m_s(&self) -> DVec3 {
        DVec3::Y * self.scene.driving_m_s
    }

    /// Size of its pictures.
    pub fn size(&self) -> (u32, u32) {
        self.size
    }

    /// Solves for the wind in a box of cells around the camera; precipitation is then integrated through it.
    pub fn solve_wind(&mut self, cells: [u32; 3]) -> Result<()> {
        let desc = WindFieldDesc { floor_center: EYE - DVec3::Z * EYE.z, cells, ..WindFieldDesc::default() };
        self.context.set_wind_field(Some(&desc), self.context.time_s())?;
        // From then on the wind is stepped every other second, which the timed frames do not reach.
        self.at((self.context.time_s() / 2.0).floor() * 2.0 + 2.0)
    }

    /// As [`Host::timed`], a sixtieth of a second later.
    pub fn timed_on(&mut self) -> Result<f64> {
        self.at(self.context.time_s() + 1.0 / 60.0)?;
        self.timed()
    }

    /// Moves to a time.
    pub fn at(&mut self, time_s: f64) -> Result<()> {
        self.context.update(time_s)
    }

    /// Draws a frame without sky and wet ground until the GPU has finished it, and returns the time, ms.
    pub fn timed(&mut self) -> Result<f64> {
        self.draw(Stages::PREPARE.with(Stages::MEDIUM).with(Stages::PARTICLES))
    }

    /// Draws a whole frame and returns its time, ms.
    pub fn frame(&mut self) -> Result<f64> {
        self.draw(Stages::ALL.without(Stages::TONE))
    }

    fn draw(&mut self, stages: Stages) -> Result<f64> {
        self.upload(&self.color, &self.painted, 8);
        self.device.wait()?;
        self.next += 1;
        let start = Instant::now();
        let mut frame = Frame::new(self.next, camera(self.size), &self.color, Some(&self.depth));
        frame.camera_velocity_m_s = DVec3::Y * self.scene.driving_m_s;
        self.view.record(&self.context, &frame, stages)?;
        self.device.wait()?;
        Ok(start.elapsed().as_secs_f64() * 1e3)
    }

    /// Luminances of the last picture.
    pub fn luminances(&self) -> Result<Vec<f64>> {
        let texels = readback::rgba(&self.device, &self.color)?;
        Ok(texels.iter().map(|t| luminance(&[0, 1, 2].map(|i| f64::from(t[i])))).collect())
    }

    /// Blocks of the scene by one candidate.
    ///
    /// # Errors
    /// GPU faults; a candidate that is not for rain.
    pub fn drawn_by(&mut self, candidate: &Candidate) -> Result<Blocks> {
        match candidate.method {
            Method::Library(LibraryMethod::Rain(settings)) => self.blocks(settings),
            Method::SourceLod(lod) => self.source(&lod),
            _ => Err(Error::range("candidate", "one of the rain", candidate.name)),
        }
    }

    fn blocks(&mut self, settings: RainSettings) -> Result<Blocks> {
        self.set(settings)?;
        self.pictures()
    }

    /// Blocks of pictures at several moments.
    pub fn pictures(&mut self) -> Result<Blocks> {
        let mut blocks = Blocks::new(self.size);
        self.moments(|host, _| {
            host.frame()?;
            blocks.add(&host.luminances()?);
            Ok(())
        })?;
        Ok(blocks)
    }

    /// Draws at several moments, the same for every candidate, so that different rain curtains pass.
    pub fn moments(&mut self, mut draw: impl FnMut(&mut Self, u64) -> Result<()>) -> Result<()> {
        let start = self.context.save()?;
        for i in 0..MOMENTS {
            self.at(self.context.time_s() + 7.3)?;
            draw(self, i as u64)?;
        }
        self.context.load(&start)
    }

    /// Luminances of the background of drops that are drawn up to `reach_m`, without the haze that stands for these
    /// drops.
    fn behind(&mut self, reach_m: f64) -> Result<Vec<f64>> {
        // A tent keeps the drops off, and Welkin still leaves out their haze.
        let tent = Shelter {
            center_m: EYE,
            axes: DMat3::IDENTITY,
            half_size_m: DVec3::splat(10.0 * lattice::REACH_M),
            velocity_m_s: DVec3::ZERO,
            planes: Planes::NONE,
        };
        self.context.set_shelters(&[tent])?;
        self.set(RainSettings { model: RainModel::Drops, ..RainSettings::default() })?;
        self.frame()?;
        let near = self.luminances()?;
        self.context.set_shelters(&[])?;
        self.set(RainSettings { model: RainModel::Veil, ..RainSettings::default() })?;
        self.frame()?;
        // Luminance is linear in the exponential of the optical depth left out.
        let hidden = Drops::new(self)?.hidden_per_m;
        let grown = |reach: f64| (hidden * reach).exp_m1();
        let more = grown(reach_m) / grown(lattice::HIDDEN_M);
        Ok(self.luminances()?.iter().zip(&near).map(|(v, n)| v + (n - v) * more).collect())
    }

    /// Blocks of pictures with these layers in front of the background, and the luminance shown as white.
    fn before(&mut self, reach_m: f64, layer: impl Fn(&Drops, u64) -> Vec<[f64; 2]>) -> Result<(Blocks, f64)> {
        let drops = Drops::new(self)?;
        let mut blocks = Blocks::new(self.size);
        let mut logs = 0.0;
        self.moments(|host, i| {
            let behind = host.behind(reach_m)?;
            let over = |(b, [light, cover]): (&f64, &[f64; 2])| b * (1.0 - cover) + light;
            let picture: Vec<f64> = behind.iter().zip(&layer(&drops, i)).map(over).collect();
            blocks.add(&picture);
            logs += picture.iter().map(|y| y.max(1e-9).ln()).sum::<f64>() / (picture.len() * MOMENTS) as f64;
            Ok(())
        })?;
        Ok((blocks, logs.exp() / 0.18))
    }

    /// Blocks of the truth, and white; another `seed` puts the drops elsewhere.
    pub fn truth(&mut self, seed: u64) -> Result<(Blocks, f64)> {
        let size = self.size;
        self.before(FAR_M, |drops, i| drops.all(size, seed.wrapping_mul(1000) + i))
    }

    /// Blocks of an older system's drops.
    fn source(&mut self, lod: &SourceLod) -> Result<Blocks> {
        let size = self.size;
        Ok(self.before(lod.reach_m, |drops, i| drops.source(size, lod, i))?.0)
    }
}

/// All drops in front of a camera.
struct Drops {
    /// Diameter (m), fall speed (m/s), number per cubic metre.
    classes: Vec<(f64, f64, f64)>,
    wind_m_s: DVec3,
    camera_m_s: DVec3,
    exposure_s: f64,
    light: DropLight,
    lamps: Vec<HostLight>,
    extinction_per_m: f64,
    hidden_per_m: f64,
    counted: Classes,
    rate_mm_h: f64,
}

impl Drops {
    fn new(host: &Host) -> Result<Self> {
        let scene = host.scene()?;
        let c = &scene.conditions;
        let factor = drops::factor_in(&c.air, c.air.station_altitude_m);
        let counted = Classes::new(&c.precipitation, factor, u32::MAX);
        let fall = host.context.rain_at(EYE, host.context.time_s())?.fall_velocity_m_s;
        Ok(Self {
            hidden_per_m: 0.5 * counted.extinction_per_m,
            classes: counted.flux.iter().map(|(d, v, flux)| (d * 1e-3, *v, flux / v)).collect(),
            wind_m_s: DVec3::new(fall.x, fall.y, 0.0),
            camera_m_s: DVec3::Y * host.scene.driving_m_s,
            exposure_s: RainSettings::default().shutter_s,
            extinction_per_m: c.fog.extinction_per_m + c.aerosol.extinction_per_m,
            lamps: host.context.lights().to_vec(),
            counted,
            rate_mm_h: host.scene.rate_mm_h,
            light: DropLight::of(&scene),
        })
    }

    /// Luminance of a drop at `p` relative to the camera.
    fn light_of(&self, p: DVec3) -> f64 {
        let d = p.normalize();
        let mut rgb = self.light.radiance(d).to_array();
        for lamp in &self.lamps {
            let to = EYE + p - lamp.position_m;
            let c = to.normalize().dot(lamp.direction.normalize());
            let (inner, outer) = (lamp.inner_deg.to_radians().cos(), lamp.outer_deg.to_radians().cos());
            let t = ((c - outer) / (inner - outer)).clamp(0.0, 1.0);
            let share = t * t * (3.0 - 2.0 * t) / to.length_squared().max(0.01);
            let beam = share * light::phase(-d.dot(to.normalize())) / (4.0 * PI);
            (0..3).for_each(|i| rgb[i] += lamp.intensity_cd[i] * beam);
        }
        luminance(&rgb)
    }

    /// Movement of a drop relative to the camera in half of the exposure.
    fn half(&self, speed_m_s: f64) -> DVec3 {
        (self.wind_m_s - DVec3::Z * speed_m_s - self.camera_m_s) * (0.5 * self.exposure_s)
    }

    /// Light and cover at every pixel from an older system's drops.
    fn source(&self, size: (u32, u32), lod: &SourceLod, seed: u64) -> Vec<[f64; 2]> {
        let mut sums = vec![[0.0f64; 2]; (size.0 * size.1) as usize];
        for drop in lod.drops(&self.counted, seed) {
            let (p, half) = (drop.position_m, self.half(self.classes[drop.id.1 as usize].1));
            if p.y > 0.1 && half.y.abs() < 0.6 * p.y {
                let share = (-self.extinction_per_m * p.length()).exp();
                self.deposit(&mut sums, size, (p, half, drop.diameter_m), share);
            }
        }
        layer(&sums)
    }

    /// Light and cover at every pixel from all drops. Their sizes, speeds and positions do not come from Welkin.
    fn all(&self, size: (u32, u32), seed: u64) -> Vec<[f64; 2]> {
        let film = Film {
            size,
            fov_rad: FOV,
            exposure_s: self.exposure_s,
            rate_mm_h: self.rate_mm_h,
            wind_m_s: self.wind_m_s,
            camera_m_s: self.camera_m_s,
            from_mm: DRAWN_FROM_MM,
            near_m: NEAREST,
            far_m: FAR_M,
        };
        let mut sums = vec![[0.0f64; 2]; (size.0 * size.1) as usize];
        for drop in film.drops(seed, 0.0) {
            let (p, half) = (drop.position_m, drop.velocity_m_s * (0.5 * self.exposure_s));
            let d = p.length();
            let t = ((d - NEAREST.0) / (NEAREST.1 - NEAREST.0)).clamp(0.0, 1.0);
            if p.y > 0.0 && d < FAR_M && t > 0.0 && half.y.abs() < 0.6 * p.y {
                let share = t * t * (3.0 - 2.0 * t) * (-self.extinction_per_m * d).exp();
                self.deposit(&mut sums, size, (p, half, drop.diameter_m), share);
            }
        }
        layer(&sums)
    }

    /// Spreads a drop's disc over the pixels it covers, moved along its path while the shutter is open.
    fn deposit(&self, sums: &mut [[f64; 2]], size: (u32, u32), (p, half, diameter): (DVec3, DVec3, f64), share: f64) {
        let f = focal(size);
        let to_pixel =
            |p: DVec3| DVec2::new(0.5 * f64::from(size.0) + f * p.x / p.y, 0.5 * f64::from(size.1) - f * p.z / p.y);
        let (a, b) = (to_pixel(p - half), to_pixel(p + half));
        let width = diameter * f / p.y;
        let across = (b - a).perp().normalize_or_zero() * width;
        let along = (2.0 * (b - a).length()).ceil().clamp(1.0, 2000.0) as u32;
        let beside = (2.0 * width).ceil().clamp(1.0, 64.0) as u32;
        // Away from the picture's centre, a disc that faces the camera is stretched.
        let area = 0.25 * PI * width * width * (p.length() / p.y) * share / f64::from(along * beside);
        let light = self.light_of(p);
        for i in 0..along {
            for j in 0..beside {
                let (s, t) = ((f64::from(i) + 0.5) / f64::from(along), (f64::from(j) + 0.5) / f64::from(beside) - 0.5);
                let at = a + (b - a) * s + across * t;
                if at.x >= 0.0 && at.y >= 0.0 && at.x < f64::from(size.0) && at.y < f64::from(size.1) {
                    let sum = &mut sums[at.y as usize * size.0 as usize + at.x as usize];
                    sum[0] += area * light;
                    sum[1] += area;
                }
            }
        }
    }
}

/// Converts sums of light and cover to the visible values, with drops in front of each other.
pub fn layer(sums: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let seen = |[light, cover]: &[f64; 2]| {
        let hidden = 1.0 - (-cover).exp();
        [if *cover > 0.0 { light / cover * hidden } else { 0.0 }, hidden]
    };
    sums.iter().map(seen).collect()
}

/// Means and deviations of the blocks of pictures.
pub struct Blocks {
    size: (u32, u32),
    /// For each block the mean, the deviation between pixels and that between patches, summed over pictures.
    sums: Vec<[f64; 3]>,
    pictures: usize,
    /// Luminances of the last picture.
    pub last: Vec<f64>,
}

fn deviation(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    (mean, (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / n).sqrt())
}

impl Blocks {
    /// Creates empty blocks for pictures of a size.
    pub fn new(size: (u32, u32)) -> Self {
        Self { size, sums: vec![[0.0; 3]; (size.0 / BLOCK * (size.1 / BLOCK)) as usize], pictures: 0, last: Vec::new() }
    }

    /// Adds a picture. Unchanging parts of the pictures (the wall's edge, the sky's gradient) contribute equally to the
    /// deviations of both sides.
    pub fn add(&mut self, picture: &[f64]) {
        let columns = self.size.0 / BLOCK;
        let at = |x: u32, y: u32| picture[(y * self.size.0 + x) as usize];
        for (i, sum) in self.sums.iter_mut().enumerate() {
            let (x0, y0) = (i as u32 % columns * BLOCK, i as u32 / columns * BLOCK);
            let pixels: Vec<f64> = (0..BLOCK * BLOCK).map(|k| at(x0 + k % BLOCK, y0 + k / BLOCK)).collect();
            let side = BLOCK / PATCH;
            let patch = |k: u32| {
                let (px, py) = (k % side * PATCH, k / side * PATCH);
                (0..PATCH * PATCH).map(|j| pixels[((py + j / PATCH) * BLOCK + px + j % PATCH) as usize]).sum::<f64>()
                    / f64::from(PATCH * PATCH)
            };
            let patches: Vec<f64> = (0..side * side).map(patch).collect();
            let (mean, fine) = deviation(&pixels);
            let values = [mean, fine, deviation(&patches).1];
            (0..3).for_each(|j| sum[j] += values[j]);
        }
        self.pictures += 1;
        self.last = picture.to_vec();
    }

    /// For each pixel, how much brighter its block is than in `other`, relative to that plus a hundredth of white.
    pub fn brighter(&self, other: &Self, white: f64) -> Vec<f64> {
        let mean = |b: &Self, i: usize| b.sums[i][0] / b.pictures as f64;
        let one = |i: usize| (mean(self, i) - mean(other, i)) / (mean(other, i).max(0.0) + 0.01 * white);
        let block = |k: u32| (k / self.size.0 / BLOCK * (self.size.0 / BLOCK) + k % self.size.0 / BLOCK) as usize;
        (0..self.size.0 * self.size.1).map(|k| one(block(k))).collect()
    }

    /// Error of each block: the largest difference of its three numbers from the truth, relative to the true mean plus
    /// a hundredth of white.
    pub fn errors(&self, truth: &Self, white: f64) -> Vec<f64> {
        let value = |b: &Self, i: usize, j: usize| b.sums[i][j] / b.pictures as f64;
        let one = |i: usize| {
            let worst = (0..3).map(|j| (value(self, i, j) - value(truth, i, j)).abs()).fold(0.0, f64::max);
            worst / (value(truth, i, 0).max(0.0) + 0.01 * white)
        };
        (0..self.sums.len()).map(one).collect()
    }
}
