//! Draws of the composition: the division of a picture into draws, each with only the shader code that its pixels need,
//! and the pipelines kept for them.
//!
//! A GPU skips, by a branch, the shader steps that a pixel does not need. A software driver executes both sides of
//! every branch, and so pays for each step of the shader at every pixel. The division by kinds of pixels is therefore
//! for software drivers; the coarse grid serves both. There are three divisions:
//!
//! - *One draw of all pixels* ([`composite`]): on multisampled targets, in weather in which every pixel marches a ray,
//!   on a GPU for pictures without a coarse grid, and while the pipelines of the coarse grid are not compiled.
//! - *Draws by what pixels show* ([`kinds`]): sky, ground below the sky, the host's objects. On software drivers
//!   ([`Caps::software`](crate::gpu::Caps)).
//! - *The coarse grid* ([`even`]): sky, air and fog at every fourth pixel, interpolated in between. On every device,
//!   for weather that has neither detail from pixel to pixel nor fog in front of clouds, in pictures of at least 64
//!   pixels a side.
//!
//! Five caches keep what the draws need. Compiling a pipeline takes tens of milliseconds, and searching all of a
//! device's pipelines for one takes longer than recording a draw.
//!
//! | cache | holds | belongs to |
//! |---|---|---|
//! | pipelines | one for each [`variant`], the 96 last used | a device ([`composite`]) |
//! | grid pipelines | those that draw the grid or interpolate from it, the 96 last used | a device ([`composite`]) |
//! | kind pipelines | those that write the kind of each pixel, the 8 last used | a device ([`composite`]) |
//! | draws | the draws of the last 4 calls of a frame, with their pipelines | a view ([`draws`]) |
//! | images | the grid, its cells and the kinds, for one picture size | a view ([`even`], [`kinds`]) |

pub(in crate::frame) mod composite;
pub(in crate::frame) mod draws;
pub(in crate::frame) mod even;
pub(in crate::frame) mod kinds;
pub(in crate::frame) mod pixel_kind;
pub(in crate::frame) mod variant;
