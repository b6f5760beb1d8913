//! Rainbow and fogbow: what drops send back of the sun's or the moon's light in two bows about the point opposite to
//! it.
//!
//! # Model
//! A ray that is reflected k times inside a drop leaves it turned by D = k pi + 2 i - 2 (k + 1) r, with sin i = b and
//! sin r = b / n for a ray that meets the drop at b radii from its middle (Descartes 1637). D has a least value, near
//! which many rays leave: 138 degrees for k = 1, 42 from the point opposite to the light, and 231 for k = 2, 51 from
//! that point. Between both is Alexander's dark band. Water bends blue more than red, so the primary bow is red outside
//! and the secondary inside. Light is a wave: the two rays of a direction interfere, and near the least turn their
//! light is Airy's (1838), wider the smaller the drop. [`mod@reference`] has that in f64, held against Mie's theory.
//! Over the sizes of drops, the wavelengths and the disc of the light a [`Table`] of the angle follows.
//!
//! The veil's smooth phase functions hold the light of both bows already. So the table has the bows less a smooth
//! function of the same sum over all directions: a bow moves light, and adds none. The composition adds it to what fog
//! and rain scatter once, which they work out for their own light; columns under rain areas likewise. It follows that
//! clouds, air and fog dim it as all else there.
//!
//! *Drops*: rain by its sizes ([`crate::falling::sizes`]), fog by droplets of 15 micrometres on the mean, whose bow is
//! white and wide. Snow, hail and dust make none. *Settings*: none. *Cost*: one look-up a pixel, and nothing where no
//! drops stand in direct light. The table is worked out for pictures that look at the bows. *Error*: within 0.2 degrees
//! and 15 % of Mie's theory. Drops count as spheres: those beyond 1 mm are flat in nature and leave the top of a bow
//! fainter. The light is that under the mean of clouds; none of it is in the cube map, where no fog is.
//!
//! No `passes.rs`: it draws in the composition. No `candidates.rs`: there is one way, too cheap to be left out. No
//! `held.rs`: no state.

mod drops;
pub mod reference;
mod table;
mod view;

pub use table::{ENTRIES, STEP_RAD, Table, phase_in};

pub(crate) use drops::{in_low_air, is_lit};
pub(crate) use view::BowView;
