//! Lightning: when and where it strikes, how it looks, what light and thunder a place has of it.
//!
//! A thunderstorm flashes a few times a minute. Most flashes stay in the cloud and make it glow; the others strike the
//! ground, in some strokes one after the other. Everything is a function of (seed, time, rate, storm cells): time may
//! run back and forth, and all channels of a simulator see the same flash.
//!
//! # Model
//! * [`schedule`]: flashes of a storm come by chance, evenly in time (Poisson). Of a fixed stream of candidates, sixty
//!   a minute, each has a number of its own from 0 to 1; those below the rate over sixty a minute strike. So a rate
//!   that changes adds and takes flashes, and moves none. A flash stays in the cloud or goes to ground, has strokes
//!   with pauses between, each with a peak current.
//! * Storm cells: one in each square of 20 km where the weather has thunder, or the host's ([`LightningSettings`]). A
//!   host may trigger a flash of its own ([`FlashTrigger`]).
//! * [`channel`]: the way of a flash, from its charge (where the air has -12 degrees Celsius) down to the ground or
//!   through the cloud, with branches; what stands high draws it, and what stands in its way ends it. Thunder comes
//!   from its nearest point.
//! * [`light`]: watts of each metre over time, and what a frame has of them: the mean from the frame before it to its
//!   own time.
//! * Picture: a line of light before the host's picture, behind what the host drew and dimmed by air and fog as the
//!   host's things are; its glow in air and rain (single scattering, Henyey-Greenstein, by equiangular quadrature) and
//!   on the clouds' base. For a source of flux F in a cloud, d above its base, the base sends F s d / (2 pi (r^2 +
//!   d^2)^(3/2)) at distance r on the plane, s its share of the light: all of it together F s.
//! * [`limit`]: fewer flashes for viewers whom flicker may harm.
//!
//! # Settings
//! [`LightningSettings`]: rate, cells, tall things, the limit. Default: 3 flashes a minute and cell in a thunderstorm.
//!
//! # Cost
//! None without a storm: no pass, and the composition has no term for it. In a storm some 20 us on the CPU a frame to
//! find that there is no flash. A flash costs a pass of some 1500 narrow quads and, a pixel, up to 8 sources with 4
//! samples each.
//!
//! # Error
//! Frames of any rate add up to the same light within 1e-5 of it; drawn ones within 2 % (tests). Figures of light are
//! those of [`light`]; a single flash differs from the mean by a factor of 2 or so. The glow has no structure of the
//! cloud in it.
//!
//! # What is not here
//! No `reference.rs`: flashes, channels and their light are computed on the CPU, in f64; shaders draw them only. No
//! `candidates.rs`: a flash is drawn in one way, and no plan leaves it out.

pub mod channel;
mod flash;
mod glow;
mod held;
pub mod light;
pub mod limit;
mod passes;
mod query;
pub mod schedule;
pub mod settings;
mod sources;
mod storms;
mod strike;
mod trigger;
mod uniforms;
mod view;

pub use flash::FlashKind;
pub(crate) use held::HeldLightning;
pub use query::{FlashEvent, LightningLight, MOST_DISTANCE_M, MOST_EXPOSURE_S, MOST_SPAN_S};
pub(crate) use query::{events, light_at};
pub use settings::{LightningSettings, MAX_CELLS, MAX_MASTS, MAX_TRIGGERED, StormCell};
pub use trigger::FlashTrigger;
pub(crate) use view::LightningView;
