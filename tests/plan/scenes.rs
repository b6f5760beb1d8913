//! Seeded scenes: a host that draws hills and boxes by ray casting, under any weather, hour, height and field of view.

use std::sync::Arc;

use glam::DVec3;
use welkin::{
    clouds::CloudModel,
    context::{Context, ContextDesc, GivenDirection},
    frame::{Exposure, Frame, FrameFlags, Shared, Stages, View},
    gpu::{Device, DeviceOptions, readback},
    plan::{Budget, Plan},
    scene::Camera,
    weather::Weather,
};
use welkin_support::{coarse_sky::coarse_sky, textures::texture};

/// Size of the pictures.
pub const SIZE: (u32, u32) = (192, 108);

/// One scene as a host would set it up.
#[derive(Clone, Debug)]
pub struct PlanScene {
    pub name: String,
    pub weather: &'static str,
    pub sun_deg: f64,
    pub height_m: f64,
    pub pitch_deg: f64,
    pub fov_deg: f64,
    /// Greatest distance of anything in the host's world.
    pub far_m: f64,
    /// Whether precipitation is drawn too.
    pub particles: bool,
    pub has_depth: bool,
    pub tolerance: f64,
}

/// Number in [0, 1), evenly distributed: SplitMix64 of the seed and the number of the draw.
fn chance(seed: u64, draw: u64) -> f64 {
    let mut z = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(draw.wrapping_mul(0xd1b5_4a32_d192_ed03));
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}

impl PlanScene {
    pub fn seeded(seed: u64) -> Self {
        let names: Vec<&'static str> = Weather::preset_names().collect();
        let weather = names[seed as usize % names.len()];
        let u = |draw| chance(seed + 1, draw);
        let height_m = [2.0, 2.0, 30.0, 400.0, 3000.0, 11_000.0][(u(1) * 6.0) as usize];
        Self {
            name: format!("{weather} seed {seed}"),
            weather,
            sun_deg: -8.0 + 70.0 * u(2),
            height_m,
            pitch_deg: if height_m > 100.0 { -25.0 * u(3) } else { 12.0 * u(3) - 6.0 },
            fov_deg: 25.0 + 65.0 * u(4),
            far_m: if height_m > 100.0 { 60_000.0 } else { 40.0 * 1000f64.powf(u(5)) },
            particles: false,
            has_depth: u(6) > 0.15,
            tolerance: [0.005, 0.01, 0.02, 0.05][(u(7) * 4.0) as usize],
        }
    }

    /// A machine in a yard of 60 m, under a high sun.
    pub fn yard() -> Self {
        let (sun_deg, height_m, pitch_deg, fov_deg, far_m) = (40.0, 2.0, -10.0, 60.0, 60.0);
        Self { name: "yard".into(), sun_deg, height_m, pitch_deg, fov_deg, far_m, has_depth: true, ..Self::seeded(0) }
    }

    fn camera(&self) -> Camera {
        let (s, c) = self.pitch_deg.to_radians().sin_cos();
        let eye = DVec3::new(0.0, 0.0, self.height_m);
        let aspect = f64::from(SIZE.0) / f64::from(SIZE.1);
        Camera::look_to(eye, DVec3::new(0.0, c, s), DVec3::Z, self.fov_deg.to_radians(), aspect, 0.1)
    }

    /// Distance and albedo of what the host draws in a direction: a plain with ridges and posts, up to `far_m`.
    fn hit(&self, direction: DVec3) -> Option<(f64, f64)> {
        let ground = if direction.z < 0.0 { self.height_m / -direction.z } else { f64::INFINITY };
        let level = direction.truncate().length();
        let bearing = direction.x.atan2(direction.y);
        let mut nearest = (ground, 0.12 + 0.06 * (40.0 * bearing).sin());
        for (share, height, albedo) in [(0.15, 0.02, 0.3), (0.45, 0.05, 0.2), (0.95, 0.11, 0.08)] {
            let distance = share * self.far_m;
            let top = height * distance * (0.6 + 0.4 * (7.0 * bearing + 9.0 * share).sin());
            let at = self.height_m + direction.z / level * distance;
            if at <= top && distance / level < nearest.0 {
                nearest = (distance / level, albedo);
            }
        }
        (nearest.0 <= self.far_m.max(1.01 * self.height_m)).then_some(nearest)
    }
}

/// A device, a context and a view, with the host's pictures.
pub struct Bench {
    device: Arc<Device>,
    context: Context,
    pub view: View,
    pub plain: View,
    color: wgpu::Texture,
    depth: wgpu::Texture,
    time_s: f64,
    frame_id: u64,
    /// Luminance that the exposure shows as white, cd/m^2.
    white: f64,
    host: (Vec<[u16; 4]>, Vec<f32>),
}

impl Bench {
    pub fn new() -> Self {
        let device = Device::headless(&DeviceOptions::default()).expect("a software driver is installed");
        let shared = Arc::new(Shared::new(&device).unwrap());
        let mut context =
            Context::new(device.clone(), shared, ContextDesc { sky: coarse_sky(), ..Default::default() }).unwrap();
        // Other tests check what the planner does with clouds as a volume: one in this binary, and
        // tests/clouds/plan.rs.
        context.set_cloud_model(CloudModel::Deck);
        let (view, plain) = (View::new(&context).unwrap(), View::new(&context).unwrap());
        let color = texture(&device, SIZE, wgpu::TextureFormat::Rgba16Float, 1);
        let depth = texture(&device, SIZE, wgpu::TextureFormat::R32Float, 1);
        let host = (Vec::new(), Vec::new());
        Self { device, context, view, plain, color, depth, time_s: 0.0, frame_id: 0, white: 1.0, host }
    }

    /// Replaces the planned view by a new one, which has no history.
    pub fn start_anew(&mut self) {
        self.view = View::new(&self.context).unwrap();
    }

    /// Draws clouds as a volume in all later pictures.
    pub fn draw_volumes(&mut self) {
        self.context.set_cloud_model(CloudModel::Volume);
    }

    /// Sets the weather, the light and the host's picture of a scene, and builds the sky's tables for it completely.
    pub fn set(&mut self, shot: &PlanScene) {
        self.time_s += 10.0;
        let weather = Weather::preset(shot.weather).unwrap();
        self.context.set_weather(&weather, self.time_s, 0.0).unwrap();
        self.time_s += 1.0;
        self.context.update(self.time_s).unwrap();
        let sun = GivenDirection { azimuth_deg: 40.0, elevation_deg: shot.sun_deg };
        self.context.set_sun(Some(sun)).unwrap();
        let scene = self.context.scene_at(shot.camera().position, self.time_s).unwrap();
        self.white = 1.0 / Exposure::default().factor(scene.ground.adaptation_cd_m2);
        let lit = scene.ground.total_lux / std::f64::consts::PI / self.white;
        let to_world = shot.camera().rotation().transpose();
        let half = (0.5 * shot.fov_deg.to_radians()).tan();
        let aspect = f64::from(SIZE.0) / f64::from(SIZE.1);
        self.host = (Vec::new(), Vec::new());
        for y in 0..SIZE.1 {
            for x in 0..SIZE.0 {
                let ndc = |v: u32, n: u32| (f64::from(v) + 0.5) / f64::from(n) * 2.0 - 1.0;
                let seen = DVec3::new(ndc(x, SIZE.0) * aspect * half, -ndc(y, SIZE.1) * half, -1.0).normalize();
                let direction = to_world * seen;
                let (range, albedo) = shot.hit(direction).unwrap_or((f64::INFINITY, 0.0));
                // Reversed infinite depth: the near distance over the distance from the camera's plane.
                self.host.1.push((0.1 / (range * -seen.z)) as f32);
                let v = half::f16::from_f64(albedo * lit).to_bits();
                self.host.0.push([v, v, v, half::f16::ONE.to_bits()]);
            }
        }
    }

    /// Share of the pixels in which the host drew something.
    pub fn share_of_objects(&self) -> f64 {
        self.host.1.iter().filter(|d| **d > 0.0).count() as f64 / self.host.1.len() as f64
    }

    fn upload(&self) {
        let size = self.color.size();
        let put = |texture: &wgpu::Texture, bytes: &[u8], texel: u32| {
            let layout =
                wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(texel * SIZE.0), rows_per_image: None };
            self.device.queue.write_texture(texture.as_image_copy(), bytes, layout, size);
        };
        put(&self.color, bytemuck::cast_slice(&self.host.0), 8);
        put(&self.depth, bytemuck::cast_slice(&self.host.1), 4);
    }

    pub fn draw(&mut self, shot: &PlanScene, planned: bool, flags: FrameFlags) -> Vec<f64> {
        self.upload();
        self.frame_id += 1;
        let frame = Frame {
            cd_m2_per_unit: self.white,
            exposure: Some(Exposure::Factor(1.0 / self.white)),
            flags,
            ..Frame::new(self.frame_id, shot.camera(), &self.color, shot.has_depth.then_some(&self.depth))
        };
        let view = if planned { &mut self.view } else { &mut self.plain };
        // The stages whose parts a plan decides on.
        let stages = Stages::PREPARE.with(Stages::BACKGROUND).with(Stages::MEDIUM);
        let stages = if shot.particles { stages.with(Stages::PARTICLES) } else { stages };
        view.record(&self.context, &frame, stages).unwrap();
        let pixels = readback::rgba(&self.device, &self.color).unwrap();
        let luminance = |p: &[f32; 4]| 0.2126 * f64::from(p[0]) + 0.7152 * f64::from(p[1]) + 0.0722 * f64::from(p[2]);
        pixels.iter().map(luminance).collect()
    }

    /// Draws the picture with all parts.
    pub fn everything(&mut self, shot: &PlanScene) -> Vec<f64> {
        self.draw(shot, false, FrameFlags::NO_HISTORY)
    }

    /// Begins a change to the weather of a preset that takes `seconds`.
    pub fn change_to(&mut self, preset: &str, seconds: f64) {
        let weather = Weather::preset(preset).unwrap();
        self.context.set_weather(&weather, self.time_s, seconds).unwrap();
    }

    /// Advances the host's time.
    pub fn pass(&mut self, seconds: f64) {
        self.time_s += seconds;
        self.context.update(self.time_s).unwrap();
    }

    /// Draws `frames` frames with the planned view; returns the last picture and its plan.
    pub fn planned(&mut self, shot: &PlanScene, frames: u64) -> (Vec<f64>, Plan) {
        self.view.set_budget(Budget { tolerance: Some(shot.tolerance), ..Budget::default() }).unwrap();
        let mut picture = self.draw(shot, true, FrameFlags(0));
        for _ in 1..frames {
            picture = self.draw(shot, true, FrameFlags(0));
        }
        (picture, self.view.plan().clone())
    }

    /// Draws the picture of a host that sets no budget; returns its plan too.
    pub fn unplanned(&mut self, shot: &PlanScene) -> (Vec<f64>, Plan) {
        (self.draw(shot, true, FrameFlags(0)), self.view.plan().clone())
    }

    /// Draws a picture that may not depend on earlier ones.
    pub fn pure(&mut self, shot: &PlanScene) -> Vec<f64> {
        self.draw(shot, true, FrameFlags::NO_HISTORY)
    }

    /// Draws the picture with its parts at these rungs.
    pub fn pinned(&mut self, shot: &PlanScene, rungs: &[usize]) -> Vec<f64> {
        self.view.set_budget(Budget::pinned(rungs)).unwrap();
        self.draw(shot, true, FrameFlags(0))
    }
}
