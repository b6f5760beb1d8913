//! A host that casts rays: a plain and boxes, with the exact depth of each pixel.

use std::sync::Arc;

use glam::{DMat3, DVec2, DVec3};
use welkin::{
    context::{Context, ContextDesc, GivenDirection},
    frame::{Frame, Shared, Stages, View},
    gpu::{Device, DeviceOptions, readback},
    rain::{Planes, Shelter},
    scene::{Camera, DepthMapping, ViewRays},
    weather::{Precipitation, PrecipitationKind, Weather},
};

use crate::{coarse_sky::coarse_sky, textures::texture};

/// Distance of the near plane from the camera, m.
pub const NEAR_M: f64 = 0.1;

/// A device, a context in the default weather, and one view.
pub struct Host {
    pub device: Arc<Device>,
    pub context: Context,
    pub view: View,
    pub camera: Camera,
    pub size: (u32, u32),
    pub color: wgpu::Texture,
    depth: wgpu::Texture,
    pub boxes: Vec<Shelter>,
    /// Normal of the ground, which passes through the origin.
    pub normal: DVec3,
    /// Velocity of the camera, (east, north, up), m/s.
    pub velocity_m_s: DVec3,
    frames: u64,
}

/// Creates a box at rest in the axes of the world, from its centre and half its size, m.
pub fn upright(center: [f64; 3], half: [f64; 3]) -> Shelter {
    Shelter {
        center_m: DVec3::from(center),
        axes: DMat3::IDENTITY,
        half_size_m: DVec3::from(half),
        velocity_m_s: DVec3::ZERO,
        planes: Planes::NONE,
    }
}

/// Returns rain of this rate at a visibility of 20 km, in a wind from the west.
pub fn rain(rate_mm_h: f64, wind_m_s: f64) -> Weather {
    let mut weather = Weather {
        precipitation: Precipitation::of(PrecipitationKind::Rain, rate_mm_h),
        visibility_m: 20_000.0,
        ..Weather::default()
    };
    weather.wind.speed_m_s = wind_m_s;
    weather.wind.from_deg = 270.0;
    weather
}

impl Host {
    pub fn new(size: (u32, u32)) -> Self {
        let device = Device::headless(&DeviceOptions::default()).expect("a software driver is installed");
        Self::on(device, size)
    }

    pub fn on(device: Arc<Device>, size: (u32, u32)) -> Self {
        let shared = Arc::new(Shared::new(&device).unwrap());
        let desc = ContextDesc { sky: coarse_sky(), seed: 11, ..ContextDesc::default() };
        let mut context = Context::new(device.clone(), shared, desc).unwrap();
        context.set_sun(Some(GivenDirection { azimuth_deg: 140.0, elevation_deg: 40.0 })).unwrap();
        let view = View::new(&context).unwrap();
        let color = texture(&device, size, wgpu::TextureFormat::Rgba16Float, 1);
        let depth = texture(&device, size, wgpu::TextureFormat::R32Float, 1);
        let aspect = f64::from(size.0) / f64::from(size.1);
        let camera = Camera::look_to(DVec3::new(0.0, 0.0, 1.7), DVec3::Y, DVec3::Z, 0.9, aspect, NEAR_M);
        Self {
            device,
            context,
            view,
            camera,
            size,
            color,
            depth,
            boxes: Vec::new(),
            normal: DVec3::Z,
            velocity_m_s: DVec3::ZERO,
            frames: 0,
        }
    }

    /// Turns the camera to `forward` at a place, with a vertical field of view of 0.9 rad.
    pub fn look(&mut self, position: DVec3, forward: DVec3) {
        let aspect = f64::from(self.size.0) / f64::from(self.size.1);
        self.camera = Camera::look_to(position, forward.normalize(), DVec3::Z, 0.9, aspect, NEAR_M);
    }

    pub fn mapping() -> DepthMapping {
        DepthMapping { reversed: true, ..DepthMapping::default() }
    }

    pub fn rays(&self) -> ViewRays {
        ViewRays::new(&self.camera, &Self::mapping()).unwrap()
    }

    /// End of the ray through `ndc`, relative to the camera, m, and the normal there; `None` for the sky.
    pub fn cast(&self, ndc: DVec2) -> Option<(DVec3, DVec3)> {
        let ray = self.rays().view_ray(ndc);
        let (eye, d) = (self.camera.position + ray.origin, ray.direction);
        let (n, toward) = (self.normal, d.dot(self.normal));
        let mut best: Option<(f64, DVec3)> = (toward < -1e-9).then(|| (-eye.dot(n) / toward, n));
        for b in &self.boxes {
            let own = |v: DVec3| b.axes.transpose() * v / b.half_size_m;
            let (o, e) = (own(eye - b.center_m), own(d));
            let (mut near, mut far, mut axis) = (0.0f64, f64::INFINITY, 0);
            for i in 0..3 {
                let (a, c) = ((-1.0 - o[i]) / e[i], (1.0 - o[i]) / e[i]);
                if a.min(c) > near {
                    (near, axis) = (a.min(c), i);
                }
                far = far.min(a.max(c));
            }
            if far > near && near > 0.0 && best.is_none_or(|(t, _)| near < t) {
                best = Some((near, b.axes.col(axis) * -e[axis].signum()));
            }
        }
        best.map(|(t, n)| (ray.origin + d * t, n))
    }

    /// Uploads colour and depth. `paint` returns the radiance of a surface point (camera-relative) with its normal.
    pub fn draw(&self, paint: impl Fn(DVec3, DVec3) -> [f64; 3]) {
        let (w, h) = self.size;
        let rays = self.rays();
        let (mut colors, mut depths) = (Vec::new(), Vec::new());
        for y in 0..h {
            for x in 0..w {
                let ndc = DVec2::new(
                    (f64::from(x) + 0.5) / f64::from(w) * 2.0 - 1.0,
                    1.0 - (f64::from(y) + 0.5) / f64::from(h) * 2.0,
                );
                let hit = self.cast(ndc);
                let c = hit.map_or([0.0; 3], |(p, n)| paint(p, n));
                colors.extend(c.iter().chain(&[1.0]).map(|v| half::f16::from_f64(*v)));
                depths.push(hit.map_or(0.0, |(p, _)| rays.depth_at(p.length(), ndc) as f32));
            }
        }
        let bits: Vec<u16> = colors.iter().map(|v| v.to_bits()).collect();
        self.upload(&self.color, bytemuck::cast_slice(&bits), 8);
        self.upload(&self.depth, bytemuck::cast_slice(&depths), 4);
    }

    /// Uploads a black picture; the depth remains that of the last [`Host::draw`].
    pub fn paint_black(&self) {
        self.upload(&self.color, &vec![0; 8 * (self.size.0 * self.size.1) as usize], 8);
    }

    fn upload(&self, texture: &wgpu::Texture, bytes: &[u8], texel: u32) {
        self.device.queue.write_texture(
            texture.as_image_copy(),
            bytes,
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(texel * self.size.0), rows_per_image: None },
            texture.size(),
        );
    }

    pub fn record(&mut self, stages: Stages) -> welkin::Result<()> {
        self.frames += 1;
        self.record_again(stages)
    }

    /// Records with the number of the last frame, for a picture of the same moment in another view.
    pub fn record_again(&mut self, stages: Stages) -> welkin::Result<()> {
        let frame = Frame {
            camera_velocity_m_s: self.velocity_m_s,
            ..Frame::new(self.frames, self.camera, &self.color, Some(&self.depth))
        };
        self.view.record(&self.context, &frame, stages)
    }

    /// Returns the picture, row by row from the top.
    pub fn pixels(&self) -> Vec<[f32; 4]> {
        readback::rgba(&self.device, &self.color).unwrap()
    }
}
