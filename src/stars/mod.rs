//! The night sky: stars and planets as points of light, and the glow between them.
//!
//! On a clear night an eye sees some thousand stars, the planets, the band of the Milky Way, and a sky that is not
//! black even without moon and towns. This room computes the direction of each star and planet over a place at a time,
//! its light and colour, the share of the light that the air lets through, and which stars need no drawing.
//! [`Heavens::at`] gives the directions, `passes.rs` draws the points, and [`NightSky`] is the glow. Sun and moon
//! belong to the room of the sky.
//!
//! ```text
//! let heavens = Heavens::at(utc, &place, &settings)?;             // one matrix, aberration, planets
//! let night = NightSky::new(&heavens, altitude_m, zenith_depth, settings.airglow);
//! let floor = night.luminance(direction);                         // cd/m^2 a channel, moonless
//! let count = stars.prepare(&device, &settings, &view, format, depth)?;
//! stars.draw(&mut pass);                                          // adds radiance to the target
//! ```
//!
//! # Positions
//! [`catalogue()`] has 9096 stars (Yale Bright Star Catalogue), and the proper motions of 49 bright ones that move
//! noticeably. One matrix ([`crate::almanac::celestial::celestial_to_world`]) turns J2000.0 to (east, north, up):
//! precession (Lieske 1977), nutation (two terms) and sidereal time (Aoki et al. 1982), with UTC for UT1. Annual
//! aberration, 0.0057 degrees, is a vector added to each direction; it follows from the Earth's velocity, the
//! derivative of the Earth's position. Refraction lifts stars near the horizon (Saemundsson 1986). The planets follow
//! the series of Simon et al. 1994, with the magnitudes of Mallama and Hilton 2018.
//!
//! # Light
//! Magnitude 0 is 2.54e-6 lux (Allen 1973). The colour is that of a black body, for an eye that sees sunlight as white
//! ([`light`]). The air's transmittance is exp(-depth X) at each of the three wavelengths, with the air mass X by
//! Kasten and Young 1989. A star's radiance is its illuminance divided by the solid angle of a pixel. A cubic B-spline
//! spreads it over 4 by 4 pixels. The spline's weights add up to 1 wherever the star stands ([`reference::spline`]), so
//! that the light is the same at any resolution and does not flicker.
//!
//! # Glow
//! Airglow has 145 S10 at the zenith (Benn and Ellison 1998) and brightens towards the horizon by van Rhijn 1921.
//! Zodiacal light follows table 16 of Leinert et al. 1998. Starlight is what Pioneer 10 measured beyond the
//! interplanetary dust (Leinert et al. 1998, tables 37 and 38; [`starlight`]), interpolated by a disc of stars and dust
//! with the luminosity of Flynn et al. 2006 ([`galaxy`]). 1 S10, one star of magnitude 10 a square degree, is 8.34e-7
//! cd/m^2. The air dims all three and adds light that it scatters, computed from their mean over the sky's dome.
//!
//! # Settings
//! [`StarSettings`]: the host's own stars, the host's own rotation of the heavens, whether planets are drawn, and the
//! strength of the airglow.
//!
//! # Cost
//! A point takes 24 bytes on the GPU: 218 448 for the catalogue and planets. On the CPU a view keeps 76 bytes for each
//! star. A frame uploads the planets and the stars in the picture that are brighter than `StarView::faintest_lux`, some
//! hundreds, and draws each as a quad that lights at most 16 pixels. The glow is a sphere of 1421 corners, computed
//! again after six hours of simulated time. A frame draws the triangles that lie in the picture; a pixel costs as much
//! as one of an even sky. On the CPU a frame runs [`Heavens::at`], some 900 sines and cosines, and [`NightSky::new`],
//! which samples 32 directions. By day all of this is left out.
//!
//! # Error
//! `cargo test --lib stars -- --nocapture` prints these errors and fails where they are exceeded.
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
//! Left out are twinkling, glare in the eye, variable stars, the discs of planets (they are points up to the
//! magnification of strong binoculars), star clouds and dark clouds of the Milky Way that are smaller than the 4 to 10
//! degrees between Pioneer 10's directions, waves of the airglow, and its layer as seen from orbit.

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
pub(crate) use view::StarsView;
