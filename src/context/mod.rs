//! A context: the weather, the time and the place that all views of a simulator share.
//!
//! Everything here is a function of (timeline, time, position): two contexts with the same timeline, seed and time
//! answer alike on every machine. The queries need no device and no frame.

mod scene;

use std::sync::Arc;

use glam::DVec3;

pub use scene::{Light, Scene};

use crate::{
    error::{Result, check_range},
    frame::{Exposure, Shared, ToneCurve},
    gpu::Device,
    scene::WorldFrame,
    sky::Planet,
};

/// How to make a context.
#[derive(Clone, Debug)]
pub struct ContextDesc {
    /// How the host's world lies on the planet.
    pub world: WorldFrame,
    /// Air, ground and sun. Default the Earth.
    pub planet: Planet,
    /// Seed of everything that chance decides.
    pub seed: u64,
    /// Exposure of frames that bring none.
    pub exposure: Exposure,
    /// From luminance to the display.
    pub tone: ToneCurve,
}

impl Default for ContextDesc {
    fn default() -> Self {
        Self {
            world: WorldFrame::default(),
            planet: Planet::earth(),
            seed: 0,
            exposure: Exposure::default(),
            tone: ToneCurve::default(),
        }
    }
}

/// A direction to a light, given by the host in place of the almanac.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GivenDirection {
    /// Degrees clockwise from true north, [-360, 360].
    pub azimuth_deg: f64,
    /// Degrees above the horizon, without refraction, [-90, 90].
    pub elevation_deg: f64,
}

impl GivenDirection {
    fn validate(&self, name: &str) -> Result<()> {
        check_range(&format!("{name}.azimuth_deg"), self.azimuth_deg, -360.0, 360.0, "deg")?;
        check_range(&format!("{name}.elevation_deg"), self.elevation_deg, -90.0, 90.0, "deg")
    }

    fn unit(&self) -> DVec3 {
        let (sa, ca) = self.azimuth_deg.to_radians().sin_cos();
        let (se, ce) = self.elevation_deg.to_radians().sin_cos();
        DVec3::new(sa * ce, ca * ce, se)
    }
}

/// The weather, the time and the place that all views of a simulator share.
pub struct Context {
    device: Arc<Device>,
    shared: Arc<Shared>,
    desc: ContextDesc,
    given_sun: Option<GivenDirection>,
    time_s: f64,
}

impl Context {
    /// Makes a context on `device`. Contexts of one device share `shared`.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field of `desc`.
    pub fn new(device: Arc<Device>, shared: Arc<Shared>, desc: ContextDesc) -> Result<Self> {
        desc.world.validate()?;
        desc.planet.check()?;
        desc.exposure.validate()?;
        Ok(Self { device, shared, desc, given_sun: None, time_s: 0.0 })
    }

    /// The device it was made on.
    pub fn device(&self) -> &Arc<Device> {
        &self.device
    }

    /// Pipelines and tables it shares with other contexts of the device.
    pub fn shared(&self) -> &Arc<Shared> {
        &self.shared
    }

    /// Exposure of frames that bring none.
    pub fn exposure(&self) -> Exposure {
        self.desc.exposure
    }

    /// From luminance to the display.
    pub fn tone_curve(&self) -> ToneCurve {
        self.desc.tone
    }

    /// Puts the sun where the host says; `None` returns it to the almanac.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the angle.
    pub fn set_sun(&mut self, sun: Option<GivenDirection>) -> Result<()> {
        if let Some(sun) = &sun {
            sun.validate("sun")?;
        }
        self.given_sun = sun;
        Ok(())
    }

    /// Simulation time, s.
    pub fn time_s(&self) -> f64 {
        self.time_s
    }
}
