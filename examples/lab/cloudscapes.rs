//! Draws and times every way to draw clouds. The truth is a march of every pixel in four times as many steps, through the same field and
//! light: how far that light is from photons is held by tests (`src/clouds/probe.rs`).

use std::{sync::Arc, time::Instant};

use glam::{DMat4, DVec3};
use welkin::Result;
use welkin::almanac::celestial::direction;
use welkin::clouds::{CloudModel, CloudSettings, candidates::CloudMethod};
use welkin::context::{Context, ContextDesc, GivenDirection};
use welkin::frame::{Frame, FrameFlags, Shared, Stages, View};
use welkin::gpu::{Device, readback};
use welkin::scene::Camera;
use welkin::weather::{CloudLayer, Weather};

use crate::picture::Picture;
use crate::scenes::CloudScene;
use crate::timing::target;

/// Size of the pictures whose error is measured.
pub const SIZE: (u32, u32) = (320, 180);
/// Steps of the truth ([`CloudSettings::fineness`]).
const TRUE_FINENESS: f64 = 8.0;
/// Frames until each pixel has been marched.
const SETTLED: u32 = 17;
/// Luminance of the value 1, so that a day lies where half floats are fine, cd/m^2.
const UNIT: f64 = 1e3;
/// Of a camera that turns while it is timed, rad a frame.
const TURN_RAD: f64 = 2e-3;
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// A sky on the GPU.
pub struct Host {
    device: Arc<Device>,
    context: Context,
    view: View,
    color: wgpu::Texture,
    camera: Camera,
    frame_id: u64,
}

impl Host {
    /// Of a scene, for pictures of a size.
    ///
    /// # Errors
    /// GPU faults.
    pub fn new(device: &Arc<Device>, scene: &CloudScene, size: (u32, u32)) -> Result<Self> {
        let mut context = Context::new(device.clone(), Arc::new(Shared::new(device)?), ContextDesc::default())?;
        context.set_sun(Some(GivenDirection { azimuth_deg: 150.0, elevation_deg: scene.sun_deg }))?;
        let layer = CloudLayer::of(scene.kind, scene.cover, scene.base_m);
        context.set_weather(&Weather { clouds: vec![layer], ..Weather::default() }, 0.0, 0.0)?;
        context.build_sky(&mut |_| true)?;
        let eye = DVec3::Z * scene.height_m;
        let aspect = f64::from(size.0) / f64::from(size.1);
        Ok(Self {
            device: device.clone(),
            view: View::new(&context)?,
            color: target(device, size, FORMAT),
            camera: Camera::look_to(eye, direction(60.0, scene.pitch_deg), DVec3::Z, 1.0, aspect, 0.1),
            context,
            frame_id: 0,
        })
    }

    fn set(&mut self, method: &CloudMethod) -> Result<()> {
        self.context.set_cloud_model(method.model);
        self.view.set_clouds(method.settings)
    }

    fn frame(&mut self, flags: FrameFlags) -> Result<f64> {
        self.frame_id += 1;
        let start = Instant::now();
        let frame = Frame { cd_m2_per_unit: UNIT, flags, ..Frame::new(self.frame_id, self.camera, &self.color, None) };
        self.view.record(&self.context, &frame, Stages::BACKGROUND.with(Stages::MEDIUM))?;
        self.device.wait()?;
        Ok(start.elapsed().as_secs_f64() * 1e3)
    }

    fn texels(&self) -> Result<Picture> {
        let texels = readback::rgba(&self.device, &self.color)?;
        let texels = texels.iter().map(|t| [t[0], t[1], t[2]].map(|v| UNIT * f64::from(v))).collect();
        Ok(Picture { width: self.color.width(), height: self.color.height(), texels })
    }

    /// Milliseconds of a frame by a method while the camera turns.
    ///
    /// # Errors
    /// GPU faults.
    pub fn timed(&mut self, method: &CloudMethod, is_first: bool) -> Result<f64> {
        if is_first {
            self.set(method)?;
            (0..SETTLED).try_for_each(|_| self.frame(FrameFlags(0)).map(|_| ()))?;
        }
        self.camera.view *= DMat4::from_rotation_z(TURN_RAD);
        self.frame(FrameFlags(0))
    }

    /// The picture by a method, once it has settled, cd/m^2.
    ///
    /// # Errors
    /// GPU faults.
    pub fn picture(&mut self, method: &CloudMethod) -> Result<Picture> {
        self.set(method)?;
        (0..SETTLED).try_for_each(|_| self.frame(FrameFlags(0)).map(|_| ()))?;
        self.texels()
    }

    /// The truth.
    ///
    /// # Errors
    /// GPU faults.
    pub fn truth(&mut self) -> Result<Picture> {
        self.whole(CloudSettings { fineness: TRUE_FINENESS, square_side: 1 })
    }

    /// The volume, every pixel marched in one frame.
    ///
    /// # Errors
    /// GPU faults.
    pub fn whole(&mut self, settings: CloudSettings) -> Result<Picture> {
        self.set(&CloudMethod { model: CloudModel::Volume, settings })?;
        self.frame(FrameFlags::NO_HISTORY)?;
        self.texels()
    }
}
