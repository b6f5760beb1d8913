//! The description of a scene: weather, lights, camera, images and the calls that draw it.

use std::sync::Arc;

use glam::{DMat4, DVec3, DVec4};
use welkin::{
    Result,
    context::Context,
    fog::Law,
    frame::{ColorSpace, Exposure, FrameFlags, Stages, ToneCurve},
    glass::Windscreen,
    gpu::Device,
    ground::GroundModel,
    rain::RainSettings,
    scene::{Camera, ClipSpace, DepthKind, DepthMapping, WorldFrame},
    sky::{SkySettings, sun::direction},
    weather::Weather,
};
use welkin_support::coarse_sky::coarse_sky;

use super::world::World;

/// Size of every picture, pixels.
pub const SIZE: (u32, u32) = (240, 135);

/// The host's mapping from distance to depth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Depth {
    /// Perspective: near is 1, infinity is 0.
    #[default]
    Reversed,
    /// Perspective: near is 0, 40 km is 1.
    Standard,
    /// As [`Depth::Standard`] with clip z from -1 to 1.
    OpenGl,
    /// The logarithm of clip w, written by the host's shader.
    Logarithmic,
    /// Parallel rays, 120 m x 67.5 m.
    Orthographic,
}

impl Depth {
    pub const ALL: [Self; 5] = [Self::Reversed, Self::Standard, Self::OpenGl, Self::Logarithmic, Self::Orthographic];

    pub fn mapping(self) -> DepthMapping {
        let kind = match self {
            Self::Logarithmic => DepthKind::Logarithmic { c: 1.0, far_m: 1e6 },
            Self::Orthographic => DepthKind::Orthographic,
            _ => DepthKind::Perspective,
        };
        let clip = if self == Self::OpenGl { ClipSpace::MinusOneToOne } else { ClipSpace::ZeroToOne };
        DepthMapping { kind, reversed: self == Self::Reversed, clip }
    }

    /// The projection matrix; `fov` is the vertical field of view, rad.
    fn projection(self, reversed: DMat4, fov: f64) -> DMat4 {
        let aspect = f64::from(SIZE.0) / f64::from(SIZE.1);
        let focal = 1.0 / (0.5 * fov).tan();
        let (near, far) = (0.5, 40_000.0);
        let (a, b) = (far / (near - far), near * far / (near - far));
        let columns = |z: DVec4, w: DVec4| DMat4::from_cols(DVec4::X * (focal / aspect), DVec4::Y * focal, z, w);
        match self {
            Self::Reversed => reversed,
            Self::Standard | Self::Logarithmic => columns(DVec4::new(0.0, 0.0, a, -1.0), DVec4::new(0.0, 0.0, b, 0.0)),
            Self::OpenGl => columns(DVec4::new(0.0, 0.0, 2.0 * a + 1.0, -1.0), DVec4::new(0.0, 0.0, 2.0 * b, 0.0)),
            Self::Orthographic => DMat4::from_cols(
                DVec4::X / 60.0,
                DVec4::Y / 33.75,
                DVec4::new(0.0, 0.0, -1.0 / 5000.0, 0.0),
                DVec4::new(0.0, 0.0, 0.0, 1.0),
            ),
        }
    }
}

/// Format of the host's colour image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Target {
    /// Scene-linear half floats.
    #[default]
    SceneLinear,
    /// Display-linear half floats.
    DisplayLinear,
    /// Display-encoded bytes that the hardware encodes.
    SrgbView,
    /// Display-encoded bytes.
    SrgbBytes,
}

impl Target {
    pub fn format(self) -> wgpu::TextureFormat {
        match self {
            Self::SceneLinear | Self::DisplayLinear => wgpu::TextureFormat::Rgba16Float,
            Self::SrgbView => wgpu::TextureFormat::Rgba8UnormSrgb,
            Self::SrgbBytes => wgpu::TextureFormat::Rgba8Unorm,
        }
    }

    pub fn space(self) -> ColorSpace {
        match self {
            Self::SceneLinear => ColorSpace::SceneLinear,
            Self::DisplayLinear => ColorSpace::DisplayLinear,
            Self::SrgbView | Self::SrgbBytes => ColorSpace::DisplaySrgb,
        }
    }
}

/// Normals that the host provides.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Normals {
    #[default]
    None,
    World,
    Eye,
}

/// Changes of the context other than weather and lights.
pub type Dress = fn(&Arc<Device>, &mut Context) -> Result<()>;

/// The scene of one picture. Lengths are in m, times in s, angles in degrees.
#[derive(Clone)]
pub struct Scene {
    pub name: String,
    /// Weathers, each with its start time and the duration of its change.
    pub weather: Vec<(Weather, f64, f64)>,
    /// Azimuth and elevation.
    pub sun: [f64; 2],
    pub moon: Option<[f64; 2]>,
    pub world: World,
    pub frame: WorldFrame,
    /// Camera position east, north and up of the world's origin.
    pub eye: DVec3,
    pub azimuth: f64,
    pub elevation: f64,
    pub height_of_view: f64,
    pub velocity_m_s: DVec3,
    pub depth: Depth,
    pub depth_format: wgpu::TextureFormat,
    /// Samples of colour and of depth.
    pub samples: [u32; 2],
    pub target: Target,
    pub bottom_left: bool,
    pub masked: bool,
    pub classes: bool,
    pub normals: Normals,
    /// The calls of each frame.
    pub calls: Vec<Stages>,
    /// Number of frames before the last one, and the time between frames.
    pub frames_before: u32,
    pub frame_s: f64,
    /// Time of the last frame.
    pub time_s: f64,
    pub flags: FrameFlags,
    pub rain: RainSettings,
    pub sky: SkySettings,
    pub tone: ToneCurve,
    pub exposure: Option<Exposure>,
    pub ground: GroundModel,
    pub law: Option<Law>,
    pub dress: Dress,
    pub windscreen: Option<fn(f64) -> Windscreen>,
    /// The rung of each part of `frame::PARTS`, instead of a plan.
    pub pinned: Option<[usize; 4]>,
    /// Adds a second view of the context, 50 degrees to the right, below the picture of the first.
    pub second_view: bool,
    /// Draws with OpenGL without compute shaders.
    pub tier_0: bool,
}

impl Scene {
    /// A clear day in the yard, drawn in one call without history.
    pub fn new(name: &str, weather: Weather) -> Self {
        Self {
            name: name.to_owned(),
            weather: vec![(weather, 0.0, 0.0)],
            sun: [140.0, 40.0],
            moon: None,
            world: World::Yard,
            frame: WorldFrame::default(),
            eye: DVec3::new(0.0, 0.0, 2.2),
            azimuth: 0.0,
            elevation: 2.0,
            height_of_view: 50.0,
            velocity_m_s: DVec3::ZERO,
            depth: Depth::Reversed,
            depth_format: wgpu::TextureFormat::Depth32Float,
            samples: [1, 1],
            target: Target::SceneLinear,
            bottom_left: false,
            masked: false,
            classes: false,
            normals: Normals::None,
            calls: vec![Stages::ALL],
            frames_before: 0,
            frame_s: 1.0 / 30.0,
            time_s: 10.0,
            flags: FrameFlags::NO_HISTORY,
            rain: RainSettings::default(),
            sky: coarse_sky(),
            tone: ToneCurve::default(),
            exposure: None,
            ground: GroundModel::default(),
            law: None,
            dress: |_, _| Ok(()),
            windscreen: None,
            pinned: None,
            second_view: false,
            tier_0: false,
        }
    }

    /// A scene with a weather preset.
    ///
    /// # Errors
    /// A name that is not a preset's.
    pub fn preset(name: &str, preset: &str) -> Result<Self> {
        Ok(Self::new(name, Weather::preset(preset)?))
    }

    /// The camera of the first view, turned to the right by `turn` degrees.
    pub fn camera(&self, turn: f64) -> Camera {
        let origin = self.origin();
        let to_world = self.frame.frame_at(origin).world_to_enu.transpose();
        let forward = direction(self.azimuth + turn, self.elevation);
        let up = if self.elevation.abs() > 80.0 { DVec3::Y } else { DVec3::Z };
        let aspect = f64::from(SIZE.0) / f64::from(SIZE.1);
        let fov = self.height_of_view.to_radians();
        let eye = origin + to_world * self.eye;
        let camera = Camera::look_to(eye, to_world * forward, to_world * up, fov, aspect, 0.1);
        Camera { projection: self.depth.projection(camera.projection, fov), ..camera }
    }

    /// The point from which `eye` is measured, in the host's coordinates.
    pub fn origin(&self) -> DVec3 {
        if self.frame.kind == welkin::scene::WorldKind::Ecef { self.frame.origin.to_ecef() } else { DVec3::ZERO }
    }
}
