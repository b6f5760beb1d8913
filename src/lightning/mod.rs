//! Lightning: when and where it strikes, what it looks like, and the light and thunder that reach a place.
//!
//! A thunderstorm flashes a few times a minute. Most flashes stay in the cloud and make it glow. The others strike the
//! ground, some with several strokes in succession. Everything is a function of (seed, time, rate, storm cells): time
//! may run back and forth, and all views of a simulator see the same flash.
//!
//! # Model
//! * [`schedule`]: the flashes of a storm cell are a Poisson process, evenly spread in time. They are taken from a
//!   fixed stream of 60 candidates a minute for each cell. Each candidate has a random number u from 0 to 1 and becomes
//!   a flash if u < rate / 60, with the cell's rate in flashes a minute. A changing rate therefore adds and removes
//!   flashes, but moves none. Each flash stays in the cloud or goes to ground. It has one or more strokes, each with a
//!   peak current, and pauses between them.
//! * Storm cells: one in each square of 20 km x 20 km where the weather has thunder. Cells of the host
//!   ([`LightningSettings`]) replace them. A host may also trigger single flashes ([`FlashTrigger`]).
//! * [`channel`]: the path of a flash, from its charge (where the air has -12 degrees Celsius) down to the ground or
//!   through the cloud, with branches. Tall objects attract it, and a shelter in its path ends it. Thunder comes from
//!   its nearest point.
//! * [`light`]: the power per metre of the channel over time, W/m, and the light in a frame: the mean of that power
//!   over the time since the previous frame.
//! * Picture: a line of light in front of the host's picture. The host's objects hide it, and air and fog dim it as
//!   they dim these objects. The flash glows in air and rain (single scattering, Henyey-Greenstein, by equiangular
//!   quadrature) and on the clouds' base. A source of flux F, lm, in a cloud at the height d above the base gives the
//!   base the luminous exitance M(r) = s F d / (2 pi (r^2 + d^2)^(3/2)), lm/m^2, at the horizontal distance r. s is the
//!   share of the light that leaves through the base; the integral of M over the plane is s F.
//! * [`limit`]: fewer flashes for viewers whom flicker may harm.
//!
//! # Settings
//! [`LightningSettings`]: rate, cells, tall objects, the limit. Default: 3 flashes a minute in each cell of a
//! thunderstorm.
//!
//! # Cost
//! None without a storm: there is no pass, and the composition has no term for lightning. In a storm, finding that
//! there is no flash takes some 20 us a frame on the CPU. A flash costs a pass of some 1500 narrow quads and, in each
//! pixel, up to 8 sources with 4 samples each.
//!
//! # Error
//! The sum of a flash's light over its frames is the same at any frame rate: the computed light within 1e-5, the
//! luminance of the drawn pictures within 2 % (tests). [`light`] cites the measurements behind its figures. The figures
//! are means; the light of a single flash differs from them by a factor of about 2. The glow does not show the cloud's
//! structure.
//!
//! # What is not here
//! There is no `reference.rs`: flashes, channels and their light are computed on the CPU in f64, and shaders only draw
//! them. There is no `candidates.rs`: there is one way to draw a flash, and the plan never leaves it out.

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
