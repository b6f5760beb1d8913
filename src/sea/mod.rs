//! The sea: waves that have the spectrum and the height that were asked for, queries of their surface, and its picture.
//!
//! The surface is a function of (seed, time, settings, the weather's timeline). All views and machines see the same
//! sea, and any time can be asked, past or future. Waves, laws and queries are in f64; tests compare the picture with
//! them.
//!
//! # Model
//! * [`spectrum`]: JONSWAP with the depth function of TMA. The height comes from the host, from the weather, or from
//!   one law of growth (Kahma and Calkoen 1992 by fetch and duration, capped by Pierson and Moskowitz 1964); the level
//!   of the spectrum is solved for it. [`spreading`] is Donelan and Banner's, for swells narrowed by Horvath's (2015)
//!   parameter.
//! * Waves longer than about a tenth of those at the peak are single waves on a fixed lattice of frequencies and
//!   directions, 250 to 310 at a time. They do not repeat.
//! * Shorter waves are in up to three square tiles of a fixed ladder, summed by Fourier transforms. They hold about
//!   0.6 % of the variance, and half of the slopes. They end where the mean square slope of all drawn waves reaches
//!   that of Cox and Munk (1954) for the wind, at the latest at 45 times the wave number at which they begin. Of
//!   shorter waves only the variance is known.
//! * Every wave has a fixed frequency, direction and phase and an amplitude that follows the spectrum: no random
//!   amplitudes, so the height holds for every seed; and no phase that the weather could move.
//! * [`SingleWave`]s of the host are added to the surface, after the spectrum.
//! * [`SeaIce`] dampens each wave by its frequency and length.
//! * [`SeaHull`]s raise wakes along their tracks: bow and stern waves by length, beam, draught and speed (Michell
//!   1898). They are carried on as rays, so that they bend where the hull turned. The hull's wash adds foam.
//! * [`SeaRegion`]s are water with a level or a share of the waves of its own, or places without water.
//! * Waves move the water sideways as well (Gerstner 1809), so crests are sharper than troughs; the mean level is
//!   corrected for it. A query solves for the particle that is at the place.
//!
//! [`dispersion`], [`slopes`], [`water`], [`foam`], [`shore`], [`wake`] and [`far`] have the laws of lengths and
//! speeds, slopes, light, whitecaps, shores, ships' wakes, ice and the horizon, each with its author.
//!
//! # Picture
//! The sea is an opaque thing in the host's depth. Its mesh is square rings around the camera on a lattice that is
//! fixed in the world (`mesh.rs`). A vertex sums the single waves and looks the tiles up, as far as the cells there
//! resolve them. Waves that the cells do not resolve are in the slopes of the pixels. Of waves that a pixel does not
//! resolve, only the covariances of the slopes are known. All slopes together have Cox and Munk's variance at every
//! distance (`shaders/sea/surface.wgsl`). Pixels mirror the sky with the mean reflectance of such slopes, sun and moon
//! by their distribution, and show the light out of the water (`shaders/sea/light.wgsl`). Foam is where waves are
//! compressed, and where they were 0.9 to 3.6 s ago: it stays with the water, thins, and breaks up into lace and, in
//! strong wind, streaks (`shaders/sea/foam.wgsl`). Phases are reduced in f64 about an anchor near the camera.
//!
//! # Settings
//! [`SeaSettings`]: level and tide, fetch, depth, source of the wave height, swells, single waves, ice, water. Without
//! settings there is no sea. Regions have a call of their own, since hulls move.
//!
//! # Cost
//! None without a query. A new time costs some milliseconds once (15 transforms of 128^2 in f64); a point at a time
//! that was asked before costs some microseconds. A weather that changes adds some milliseconds a time for its
//! spectrum. The sums of two times are kept: 7 MB. A view holds 2 MB of textures; nothing is worked out for it where no
//! sea is seen.
//!
//! # Error
//! Significant height within 1 % and mean level within 5 mm over 100 wave lengths square; variance of each half octave
//! of frequency exact, but for the strengthening by less than 1 % that narrow crests need to keep the height; the place
//! of a query within 1 mm. [`SeaPoint::height_error_m`] bounds the height. Heights 300 m to 5 km
//! apart correlate by at most 0.26 more than the spectrum's own do. Waves are linear: crests of steep seas are
//! some percent too low, and the surface's heights are hardly skewed.
//!
//! # What is not here
//! No shore: its laws are here, but the surface does not use them yet. Wakes are those of deep water. A lake has the
//! waves of the sea around it, as high as its region says; pictures show no lakes. There is no `candidates.rs`, because
//! there is one way to draw the sea; no `reference.rs`, because all that queries use is the f64 reference.

mod bins;
mod clarity;
pub mod dispersion;
mod drawn;
#[cfg(test)]
mod drawn_probe;
pub mod far;
mod fft;
pub mod foam;
mod foam_uniform;
mod growth;
mod held;
mod history;
mod hull;
mod ice;
mod lace;
mod lanes;
mod lattice;
mod mesh;
mod mode;
mod model;
mod outline;
mod passes;
pub mod probe;
mod regions;
mod seen;
mod seen_regions;
mod seen_wakes;
mod settings;
pub mod shore;
mod single;
pub mod slopes;
pub mod spectrum;
pub mod spreading;
mod surface;
#[cfg(test)]
mod tests;
mod tiles;
mod track;
mod turn;
mod uniform;
mod view;
pub mod wake;
mod wake_field;
pub mod water;

pub use clarity::WaterClarity;
pub(crate) use held::HeldSea;
pub use hull::{MAX_SEA_HULLS, SeaHull};
pub use ice::SeaIce;
pub use mode::SeaMode;
pub use model::SeaStatistics;
pub use outline::MAX_OUTLINE_CORNERS;
pub use regions::{MAX_SEA_REGIONS, SeaRegion, SeaRegionKind};
pub use settings::{MAX_SWELLS, MOST_STEEPNESS, SeaSettings, SeaSwell, Tide, WindSea};
pub use single::{MAX_SINGLE_WAVES, MOST_SINGLE_STEEPNESS, SingleWave, WaveScale};
pub use surface::SeaPoint;
pub(crate) use surface::SeaSurface;
pub(crate) use view::SeaView;
pub(crate) use wake_field::Wake;
