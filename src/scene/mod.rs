//! Cameras, depth conventions and world frames: where things are.
//!
//! The host's coordinates stay its own; rooms obtain up, altitude, north and place only through
//! [`WorldFrame::frame_at`]. Positions are f64 in the host's frame, everything on the GPU is camera-relative.

mod camera;
pub mod depth;
mod light;
mod turn;
mod world;

pub use camera::Camera;
pub use depth::{ClipSpace, DepthKind, DepthMapping, DepthUniform, ViewRays};
pub(crate) use light::{FlashLamp, LightUniform, MAX_FLASH_LAMPS};
pub use light::{HostLight, MAX_LIGHTS};
pub(crate) use turn::{angle_between, turn_x, turn_y, turn_z};
pub use world::{Axes, LocalFrame, Place, WorldFrame, WorldKind};
