//! The sea: waves with the spectrum and the height that the host asks for, queries of the surface, and the drawn
//! picture.
//!
//! The surface is a function of (seed, time, settings, the weather's timeline). All views and machines have the same
//! sea, and queries may ask for any time, past or future. Waves, laws and queries are in f64; tests compare the picture
//! with them.
//!
//! # Model
//! * [`spectrum`]: JONSWAP with the depth function of TMA. The height comes from the host, from the weather, or from
//!   one law of growth (Kahma and Calkoen 1992 by fetch and duration, capped by Pierson and Moskowitz 1964); the level
//!   of the spectrum is solved for this height. The spreading over directions ([`spreading`]) is Donelan and Banner's.
//!   For swells it is narrowed by Horvath's (2015) parameter.
//! * Waves longer than about a tenth of the wave length at the peak are single waves on a fixed lattice of frequencies
//!   and directions, 250 to 310 at a time. They do not repeat.
//! * Shorter waves are in up to three square tiles of a fixed ladder, summed by Fourier transforms. The tiles hold
//!   about 0.6 % of the variance, and half of the slopes. Their waves end where the mean square slope of all drawn
//!   waves reaches that of Cox and Munk (1954) for the wind, unless the settings give the height. They end at the
//!   latest at 45 times the wave number at which they begin, and at 560 1/m. Of shorter waves only the variance of the
//!   slopes is known.
//! * Every wave has a fixed frequency, direction and phase, and an amplitude that follows the spectrum. No amplitude is
//!   random, so every seed gives the same significant height. The weather moves no phase.
//! * [`SingleWave`]s of the host are added to the waves of the spectrum.
//! * [`SeaIce`] dampens each wave by its frequency and length.
//! * [`SeaHull`]s raise wakes along their tracks: bow and stern waves by length, beam, draught and speed (Michell
//!   1898). The waves travel as rays, so that wakes bend where the hull turned. The hull's wash adds foam.
//! * [`SeaRegion`]s are waters with their own level or their own share of the wave height, or places without water.
//! * Waves move the water sideways as well (Gerstner 1809), so crests are sharper than troughs; the mean level is
//!   corrected for this motion. A query solves for the particle that is at the queried place.
//!
//! The laws, each with its author, are in [`dispersion`] (lengths and speeds), [`slopes`], [`water`] (light), [`foam`]
//! (whitecaps), [`shore`], [`wake`] (ships' wakes) and [`far`] (ice and the horizon).
//!
//! # Picture
//! The sea is drawn as an opaque surface into the host's depth. Its mesh is square rings around the camera on a lattice
//! that is fixed in the world (`mesh.rs`). A vertex sums the single waves and looks the tiles up, as far as the mesh's
//! cells there resolve these waves. Waves that the cells do not resolve appear in the slopes of the pixels. Of waves
//! that a pixel does not resolve, only the covariances of the slopes are known. All slopes together have Cox and Munk's
//! variance at every distance (`shaders/sea/surface.wgsl`). Pixels mirror the sky with the mean reflectance of such
//! slopes, and sun and moon by the distribution of the slopes. They also show the light that comes out of the water
//! (`shaders/sea/light.wgsl`). Foam lies where the water is compressed, and where it was 0.9 to 3.6 s ago. Foam stays
//! with the water, thins, and breaks up into lace and, in strong wind, into streaks (`shaders/sea/foam.wgsl`). Phases
//! are reduced in f64 about an anchor near the camera.
//!
//! # Settings
//! [`SeaSettings`]: level and tide, fetch, depth, source of the wave height, swells, single waves, ice, water. Without
//! settings there is no sea. Regions and hulls have calls of their own, since hosts that move them set them again and
//! again.
//!
//! # Cost
//! There is no cost without a query. The first query of a time costs some milliseconds (15 transforms of 128^2 in f64).
//! Each further query of that time costs some microseconds. While the weather changes, each time costs some more
//! milliseconds for its spectrum. The sums of two times are kept: 7 MB. A view holds 1.3 MB on the GPU, and computes
//! nothing while no sea is seen.
//!
//! # Error
//! Over a square of 100 wave lengths the significant height is within 1 % and the mean level within 5 mm. The variance
//! of each half octave of frequency is exact, except for the strengthening that makes up for narrow crests: some 1 % or
//! less, more only in seas close to breaking, and never more than 6 %. The particle of a query is within 1 mm of the
//! queried place. [`SeaPoint::height_error_m`] bounds the error of the height. The correlation of heights 300 m to 5 km
//! apart differs by at most 0.26 from that of the spectrum itself. Waves are linear: crests of steep seas are some
//! percent too low, and the surface's heights are hardly skewed.
//!
//! # What is not here
//! No shore: its laws are here, but the surface does not use them yet. Wakes are those of deep water. A lake has the
//! waves of the sea around it, with the height that its region sets. Pictures show no lakes. There is no
//! `candidates.rs`, because there is one way to draw the sea. There is no `reference.rs`, because the f64 code of the
//! queries is the reference.

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
