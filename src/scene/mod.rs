//! Cameras, depth conventions and world frames: the geometry between the host's world and the planet. The host's lamps
//! are here too.
//!
//! The host's coordinates stay as they are: rooms obtain up, altitude, north and place only through
//! [`WorldFrame::frame_at`]. Positions are f64 in the host's frame; everything on the GPU is relative to the camera.

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
pub use world::{Axes, Figure, LocalFrame, Place, WorldFrame, WorldKind};
