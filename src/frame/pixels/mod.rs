//! Draws of the composition: how a picture is divided into draws, each with no more of the shader than its pixels need,
//! and the pipelines that are kept for them.
//!
//! A GPU branches over what a pixel does not show. A software driver takes both ways of every branch, and pays for each
//! step of the shader at each pixel. So the divisions below are for software drivers; the coarse grid serves both.
//!
//! | division | when it is used | where |
//! |---|---|---|
//! | one draw of all pixels | samples with depths of their own; a march through the air that has a pass of its own; until the pipelines of the others are compiled | [`composite`] |
//! | draws by what pixels show: sky, ground below the sky, the host's things | on software drivers ([`Caps::software`](crate::gpu::Caps)) | [`kinds`] |
//! | the coarse grid: sky, air and fog at every fourth pixel, interpolated between | on every device, where nothing in the weather changes from pixel to pixel, from 64 pixels a side on | [`even`] |
//!
//! Five caches keep what these are made of. To compile a pipeline takes tens of milliseconds, and to look for one among
//! all that are there longer than to record a draw.
//!
//! | cache | holds | belongs to |
//! |---|---|---|
//! | pipelines | one for each [`variant`], the 32 used last | a device ([`composite`]) |
//! | pipelines of the grid | those that draw it and look it up, the 32 used last | a device ([`composite`]) |
//! | pipelines of kinds | those that write which pixel is of which kind, the 8 used last | a device ([`composite`]) |
//! | draws | the draws of the last 4 calls of a frame, with their pipelines | a view ([`draws`]) |
//! | images | the grid, its cells and the kinds of a picture's size | a view ([`even`], [`kinds`]) |

pub(in crate::frame) mod composite;
pub(in crate::frame) mod draws;
pub(in crate::frame) mod even;
pub(in crate::frame) mod kinds;
pub(in crate::frame) mod pixel_kind;
pub(in crate::frame) mod variant;
