//! A small host behind a windscreen.

use std::sync::Arc;

use glam::DVec3;
use welkin::{
    context::{Context, ContextDesc, GivenDirection},
    frame::{Frame, FrameFlags, Shared, Stages, View},
    glass::{Pane, Windscreen},
    gpu::{Device, DeviceOptions, readback},
    scene::Camera,
    weather::{Precipitation, PrecipitationKind, Weather},
};
use welkin_support::{coarse_sky::coarse_sky, textures::texture};

pub struct Host {
    pub device: Arc<Device>,
    pub context: Context,
    pub view: View,
    pub color: wgpu::Texture,
    pub frame_id: u64,
}

/// A coarse sky, built in an instant.
fn coarse(seed: u64) -> ContextDesc {
    ContextDesc { sky: coarse_sky(), seed, ..ContextDesc::default() }
}

pub fn camera() -> Camera {
    Camera::look_to(DVec3::new(0.0, 0.0, 3.0), DVec3::Y, DVec3::Z, 0.8, 16.0 / 9.0, 0.1)
}

pub fn rain(rate_mm_h: f64) -> Weather {
    let precipitation = Precipitation { kind: PrecipitationKind::Rain, rate_mm_h, ..Default::default() };
    Weather { precipitation, relative_humidity: 0.95, visibility_m: 3000.0, ..Weather::default() }
}

/// An upright pane of 0.4 m x 0.24 m, met by rain at 20 m/s.
pub fn upright() -> Windscreen {
    let corners = [(-0.2, -0.12), (0.2, -0.12), (0.2, 0.12), (-0.2, 0.12)];
    Windscreen {
        pane: Pane::Quad(corners.map(|(x, y)| DVec3::new(x, y, -0.3))),
        velocity_m_s: DVec3::new(0.0, 0.0, -20.0),
        ..Windscreen::default()
    }
}

impl Host {
    pub fn new(format: wgpu::TextureFormat, size: (u32, u32), rate_mm_h: f64) -> Self {
        Self::on(Device::headless(&DeviceOptions::default()).unwrap(), format, size, rate_mm_h, 7)
    }

    pub fn on(device: Arc<Device>, format: wgpu::TextureFormat, size: (u32, u32), rate_mm_h: f64, seed: u64) -> Self {
        let shared = Arc::new(Shared::new(&device).unwrap());
        let mut context = Context::new(device.clone(), shared, coarse(seed)).unwrap();
        context.set_sun(Some(GivenDirection { azimuth_deg: 140.0, elevation_deg: 40.0 })).unwrap();
        context.set_weather(&rain(rate_mm_h), 0.0, 0.0).unwrap();
        let view = View::new(&context).unwrap();
        let color = texture(&device, size, format, 1);
        Self { device, context, view, color, frame_id: 0 }
    }

    /// Fills the picture with bright and dark squares of 8 pixels, as on a chequerboard.
    pub fn paint(&self) {
        let (w, h) = (self.color.width(), self.color.height());
        let texel =
            |x: u32, y: u32| if (x / 8 + y / 8).is_multiple_of(2) { [200u8, 180, 90, 255] } else { [30, 40, 60, 255] };
        let bytes: Vec<u8> = (0..w * h).flat_map(|i| texel(i % w, i / w)).collect();
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * w), rows_per_image: None };
        self.device.queue.write_texture(self.color.as_image_copy(), &bytes, layout, self.color.size());
    }

    /// Records a frame at a simulation time.
    pub fn at(&mut self, time_s: f64, stages: Stages, flags: FrameFlags) -> welkin::Result<()> {
        self.context.update(time_s)?;
        self.frame_id += 1;
        let mut frame = Frame::new(self.frame_id, camera(), &self.color, None);
        frame.flags = flags;
        frame.color_space = welkin::frame::ColorSpace::DisplaySrgb;
        self.view.record(&self.context, &frame, stages)
    }

    /// Runs the glass from `from_s` to `until_s` at some frames a second.
    pub fn run(&mut self, from_s: f64, until_s: f64, rate_hz: f64) {
        let frames = ((until_s - from_s) * rate_hz).round() as u32;
        for i in 1..=frames {
            self.at(from_s + f64::from(i) / rate_hz, Stages::PREPARE, FrameFlags(0)).unwrap();
        }
    }

    pub fn pixels(&self) -> Vec<[f32; 4]> {
        readback::rgba(&self.device, &self.color).unwrap()
    }
}
