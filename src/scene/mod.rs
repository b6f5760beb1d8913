//! Cameras, depth conventions, world frames and the turning of the Earth under the stars: where things are.
//!
//! The host's coordinates stay its own; rooms obtain up, altitude, north and place only through
//! [`WorldFrame::frame_at`]. Positions are f64 in the host's frame, everything on the GPU is camera-relative.

mod camera;
pub mod celestial;
pub mod depth;
mod light;
pub(crate) mod time;
mod world;

pub use camera::Camera;
pub use depth::{ClipSpace, DepthKind, DepthMapping, DepthUniform, ViewRays};
pub(crate) use light::LightUniform;
pub use light::{HostLight, MAX_LIGHTS};
pub use time::Utc;
pub use world::{Axes, LocalFrame, Place, WorldFrame, WorldKind};
