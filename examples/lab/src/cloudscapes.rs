//! Draws and times every way to draw clouds. The truth marches every pixel in four times as many steps, through the
//! same field and light. Tests compare that light with photons (`src/clouds/drawn/probe.rs`).

use std::{sync::Arc, time::Instant};

use glam::{DMat4, DVec3};
use welkin::Result;
use welkin::almanac::celestial::direction;
use welkin::clouds::{CloudModel, CloudSettings, candidates::CloudMethod};
use welkin::context::{Context, ContextDesc, GivenDirection, LightAt};
use welkin::frame::{Frame, FrameFlags, Shared, Stages, View};
use welkin::gpu::{Device, readback};
use welkin::scene::Camera;
use welkin::weather::{CloudLayer, Weather};

use crate::picture::Picture;
use crate::scenes::CloudScene;
use crate::timing::target;

/// Size of the pictures whose error is measured.
pub const SIZE: (u32, u32) = (320, 180);
/// Fineness of the truth's march ([`CloudSettings::fineness`]).
const TRUE_FINENESS: f64 = 8.0;
/// Frames until each pixel has been marched.
const SETTLED: u32 = 17;
/// Luminance of the value 1, chosen so that daylight lies where half floats are precise, cd/m^2.
pub const UNIT: f64 = 1e3;
/// Vertical field of view, rad, and the pitch of cameras.
pub const FOV: f64 = 1.0;
const AZIMUTH_DEG: f64 = 60.0;
/// Rotation of the turning camera during timing, rad per frame.
const TURN_RAD: f64 = 2e-3;
/// Format of the pictures.
pub const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// A host with clouds on the GPU.
pub struct Host {
    device: Arc<Device>,
    context: Context,
    view: View,
    color: wgpu::Texture,
    camera: Camera,
    frame_id: u64,
    /// Saved state at time 0.
    start: Vec<u8>,
}

impl Host {
    /// Creates the host of a scene for pictures of a size; without clouds if the scene's cover is 0.
    ///
    /// # Errors
    /// GPU faults.
    pub fn new(device: &Arc<Device>, scene: &CloudScene, size: (u32, u32)) -> Result<Self> {
        let layer = (scene.cover > 0.0).then(|| CloudLayer::of(scene.kind, scene.cover, scene.base_m));
        let mut this = Self::under(device, layer, scene.sun_deg, size)?;
        this.look(scene.height_m, scene.pitch_deg, FOV);
        Ok(this)
    }

    /// Creates a host under a layer and with the sun at a given elevation, with the camera on the ground.
    ///
    /// # Errors
    /// GPU faults; a layer outside its ranges.
    pub fn under(device: &Arc<Device>, layer: Option<CloudLayer>, sun_deg: f64, size: (u32, u32)) -> Result<Self> {
        let mut context = Context::new(device.clone(), Arc::new(Shared::new(device)?), ContextDesc::default())?;
        context.set_sun(Some(GivenDirection { azimuth_deg: 150.0, elevation_deg: sun_deg }))?;
        context.set_weather(&Weather { clouds: layer.into_iter().collect(), ..Weather::default() }, 0.0, 0.0)?;
        context.build_sky(&mut |_| true)?;
        let aspect = f64::from(size.0) / f64::from(size.1);
        Ok(Self {
            device: device.clone(),
            view: View::new(&context)?,
            color: target(device, size, FORMAT),
            camera: Camera::look_to(DVec3::ZERO, DVec3::Y, DVec3::Z, FOV, aspect, 0.1),
            start: context.save()?,
            context,
            frame_id: 0,
        })
    }

    /// Places the camera at a height above the world's origin, with a pitch up or down.
    pub fn look(&mut self, height_m: f64, pitch_deg: f64, fov_rad: f64) {
        self.look_from(DVec3::Z * height_m, pitch_deg, fov_rad);
    }

    /// As [`Host::look`], from any position.
    pub fn look_from(&mut self, eye: DVec3, pitch_deg: f64, fov_rad: f64) {
        let aspect = f64::from(self.color.width()) / f64::from(self.color.height());
        self.camera = Camera::look_to(eye, direction(AZIMUTH_DEG, pitch_deg), DVec3::Z, fov_rad, aspect, 0.1);
    }

    /// Replaces the clouds by another layer at once.
    ///
    /// # Errors
    /// A layer outside its ranges.
    pub fn lay(&mut self, layer: CloudLayer) -> Result<()> {
        let now = self.context.time_s();
        self.context.set_weather(&Weather { clouds: vec![layer], ..Weather::default() }, now, 0.0)
    }

    /// Draws a frame that uses the history of the last one.
    ///
    /// # Errors
    /// GPU faults.
    pub fn next_frame(&mut self) -> Result<Picture> {
        self.frame(FrameFlags(0))?;
        self.texels()
    }

    /// Moves to a time, which may be earlier than the current one.
    ///
    /// # Errors
    /// A state that cannot be loaded.
    pub fn at(&mut self, time_s: f64) -> Result<()> {
        if time_s < self.context.time_s() {
            self.context.load(&self.start)?;
        }
        self.context.update(time_s)
    }

    /// The camera.
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// The texture it is drawn into.
    pub fn target(&self) -> &wgpu::Texture {
        &self.color
    }

    /// Light at the camera.
    ///
    /// # Errors
    /// None for a scene's camera.
    pub fn light(&self) -> Result<LightAt> {
        self.context.light_at(self.camera.position, self.context.time_s())
    }

    /// Radius of the planet, m.
    pub fn radius_m(&self) -> f64 {
        self.context.planet_radius_m()
    }

    /// Draws a single frame without history.
    ///
    /// # Errors
    /// GPU faults.
    pub fn still(&mut self) -> Result<()> {
        self.frame(FrameFlags::NO_HISTORY).map(|_| ())
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

    /// The last picture drawn, cd/m^2.
    ///
    /// # Errors
    /// GPU faults.
    pub fn texels(&self) -> Result<Picture> {
        let texels = readback::rgba(&self.device, &self.color)?;
        let texels = texels.iter().map(|t| [t[0], t[1], t[2]].map(|v| UNIT * f64::from(v))).collect();
        Ok(Picture { width: self.color.width(), height: self.color.height(), texels })
    }

    /// Time of a frame by a method while the camera turns, ms.
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

    /// The picture by a method, after it has settled, cd/m^2.
    ///
    /// # Errors
    /// GPU faults.
    pub fn picture(&mut self, method: &CloudMethod) -> Result<Picture> {
        self.set(method)?;
        (0..SETTLED).try_for_each(|_| self.frame(FrameFlags(0)).map(|_| ()))?;
        self.texels()
    }

    /// Draws the volume with these settings until it has settled.
    ///
    /// # Errors
    /// GPU faults.
    pub fn settle(&mut self, settings: CloudSettings) -> Result<()> {
        self.picture(&CloudMethod { model: CloudModel::Volume, settings }).map(|_| ())
    }

    /// Draws the truth.
    ///
    /// # Errors
    /// GPU faults.
    pub fn truth(&mut self) -> Result<Picture> {
        self.whole(CloudSettings { fineness: TRUE_FINENESS, square_side: 1, shafts: false })
    }

    /// Draws the volume with every pixel marched in one frame.
    ///
    /// # Errors
    /// GPU faults.
    pub fn whole(&mut self, settings: CloudSettings) -> Result<Picture> {
        self.set(&CloudMethod { model: CloudModel::Volume, settings })?;
        self.frame(FrameFlags::NO_HISTORY)?;
        self.texels()
    }
}
