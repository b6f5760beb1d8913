//! The night sky: stars and planets as points of light, and the glow between them.
//!
//! On a clear night an eye sees some thousand stars, the planets, the band of the Milky Way, and a sky that is not
//! black even without moon and towns. This room says where each of them stands over a place at a time, how much light
//! it sends and of which colour, what the air leaves of it, and which of them need no drawing. [`Heavens::at`] gives
//! the places, `passes.rs` draws the points, [`NightSky`] is the glow. The moon and the sun are the sky's.
//!
//! ```text
//! let heavens = Heavens::at(utc, &place, &settings)?;             // one matrix, aberration, planets
//! let night = NightSky::new(&heavens, altitude_m, zenith_depth, settings.airglow);
//! let floor = night.luminance(direction);                         // cd/m^2 a channel, moonless
//! let count = stars.prepare(&device, &settings, &view, format, depth)?;
//! stars.draw(&mut pass);                                          // adds radiance to the target
//! ```
//!
//! # Places
//! [`catalogue()`]: 9096 stars (Yale Bright Star Catalogue), and the proper motions of 49 bright ones that move most.
//! One matrix ([`crate::almanac::celestial::celestial_to_world`]) leads from J2000.0 to (east, north, up): precession
//! (Lieske 1977), nutation (two terms), sidereal time (Aoki et al. 1982), with UT1 as UTC. Annual aberration, 0.0057
//! degrees, is a vector added to each direction; the Earth's speed that it needs is the orbit's slope. Refraction lifts
//! what is low (Saemundsson 1986). Planets: the series of Simon et al. 1994, magnitudes by Mallama and Hilton 2018.
//!
//! # Light
//! Magnitude 0 is 2.54e-6 lux (Allen 1973); the colour is that of a black body to an eye for which sunlight is white
//! ([`light`]). The air takes exp(-depth X) at each of the three wavelengths, X by Kasten and Young 1989. What falls on
//! a pixel is the illuminance over the pixel's solid angle, spread by a cubic B-spline over 4 by 4 pixels, whose
//! weights add up to 1 wherever the star stands ([`reference::spline`]): the same light at any resolution, and no
//! flicker.
//!
//! # Glow
//! Airglow of 145 S10 at the zenith (Benn and Ellison 1998), brighter below by van Rhijn 1921; zodiacal light by table
//! 16 of Leinert et al. 1998; starlight as Pioneer 10 mapped it beyond the planets' dust (Leinert et al. 1998, tables
//! 37 and 38; [`starlight`]), between its places as a disc of stars and dust with the luminosity of Flynn et al. 2006
//! ([`galaxy`]). 1 S10, a star of magnitude 10 a square degree, is 8.34e-7 cd/m^2. The air dims all three and scatters
//! the dome's mean back.
//!
//! # Settings
//! [`StarSettings`]: a host's own stars, its own matrix, whether planets are drawn, the airglow.
//!
//! # Cost
//! 24 bytes a point on the CPU and the GPU: 218 448 for the catalogue and planets. A frame uploads those in the picture
//! that are brighter than `StarView::faintest_lux`, some hundreds, and draws each as 4 corners that light at most 16
//! pixels. The glow is a ball of 1421 corners, found anew after each six hours of simulated time, of which a frame
//! draws the triangles in the picture, with an even sky's work a pixel. On the CPU a frame pays for [`Heavens::at`],
//! some 900 sines and cosines, and for [`NightSky::new`], which looks in 32 directions. By day there is none of it.
//!
//! # Error
//! `cargo test --lib stars -- --nocapture` prints these and fails where they are exceeded.
//!
//! | what | against | worst |
//! |---|---|---|
//! | 12 stars, 5 places, 1950 to 2100 | ERFA (IAU 2006/2000A) | 0.005 degrees |
//! | planets, 1950 to 2100 | VSOP87 (libastro) | 0.03 degrees |
//! | planets' magnitudes | Skyfield (Mallama and Hilton 2018) | 0.03 |
//! | light of drawn stars, 320x180 to 1280x720 | their illuminance | 2 % |
//! | starlight, 869 places | Pioneer 10's map | 7.9 % (root mean square), 2 % of the whole |
//! | zenith of a moonless night | 20.9 to 22.1 mag/arcsec^2 measured | inside |
//!
//! Not in it: twinkling, glare in the eye, variable stars, the discs of planets (points up to the field of strong
//! binoculars), clouds and dark clouds of the Milky Way, airglow's waves and its layer as seen from orbit.

mod behind;
#[cfg(not(feature = "lab"))]
pub(crate) mod candidates;
#[cfg(feature = "lab")]
#[doc(hidden)]
pub mod candidates;
pub mod catalogue;
mod disc;
pub mod galaxy;
pub mod glow;
mod glow_pass;
mod held;
pub mod light;
pub mod limits;
mod orbits;
#[cfg(not(feature = "lab"))]
pub(crate) mod passes;
#[cfg(feature = "lab")]
#[doc(hidden)]
pub mod passes;
pub mod places;
pub mod planets;
pub mod reference;
pub mod settings;
pub mod starlight;
#[cfg(not(feature = "lab"))]
pub(crate) mod uniforms;
#[cfg(feature = "lab")]
#[doc(hidden)]
pub mod uniforms;
mod view;

pub(crate) use behind::NightBehind;
pub use catalogue::{Star, catalogue};
pub use glow::NightSky;
pub(crate) use held::{HeldStars, night_lux};
#[cfg(not(feature = "lab"))]
pub(crate) use passes::{StarDepth, StarPass};
#[cfg(feature = "lab")]
#[doc(hidden)]
pub use passes::{StarDepth, StarPass};
pub use places::Heavens;
pub use planets::{Body, PlanetPlace};
pub use settings::StarSettings;
#[cfg(not(feature = "lab"))]
pub(crate) use uniforms::StarView;
#[cfg(feature = "lab")]
#[doc(hidden)]
pub use uniforms::StarView;
pub(crate) use view::{LAND_ALBEDO, StarsView};
