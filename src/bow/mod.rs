//! Rainbow and fogbow: two bows of sunlight or moonlight that drops send back, around the point opposite to the sun or
//! the moon (the antisolar point).
//!
//! # Model
//! A ray meets a drop at b radii from the drop's middle and is reflected k times inside it. The drop turns the ray by
//! D = k pi + 2 i - 2 (k + 1) r, where sin i = b, sin r = b / n, and n is the refractive index (Descartes 1637). D has
//! a minimum, and many rays leave near it. For k = 1 the minimum is 138 degrees: the primary bow, 42 degrees from the
//! antisolar point. For k = 2 it is 231 degrees: the secondary bow, 51 degrees from that point. Between the two lies
//! Alexander's dark band. Water bends blue more than red, so the primary bow is red on its outside and the secondary on
//! its inside.
//!
//! Light is a wave: the two rays that leave a drop in one direction interfere. Near the minimum their light follows
//! Airy (1838): the smaller the drop, the wider the bow. [`mod@reference`] computes this light in f64; tests compare it
//! with Mie's theory. A [`Table`] over the angle from the antisolar point sums this light over drop sizes, wavelengths
//! and the disc of the sun or the moon.
//!
//! The smooth phase functions of fog and rain already contain the light of both bows. The table therefore holds the
//! bows less a smooth function with the same sum over all directions: a bow moves light and adds none. The shaders
//! compute the single-scattered light of fog and rain before they apply the phase function. The composition adds this
//! light times the table's value, and the columns under rain areas do the same with their own light. Clouds, air and
//! fog in front of a bow therefore dim it like everything else there.
//!
//! * *Drops*: rain by its drop sizes ([`crate::falling::sizes`]); fog by droplets with a mean diameter of 15
//!   micrometres, whose bow is white and wide. Snow, hail and dust make no bow.
//! * *Settings*: none.
//! * *Cost*: one look-up per pixel, and nothing if no drops stand in direct light. The table is computed only for
//!   pictures whose field of view reaches the bows.
//! * *Error*: angle within 0.25 degrees, light within 15 % and width within 25 % of Mie's theory. Drops count as
//!   spheres; in nature drops beyond 1 mm are flat and leave the top of a bow fainter. The light on the drops is the
//!   mean under the clouds. A face of the cube map uses the tables of the frame that draws the face, so it may lack a
//!   bow that this frame's picture does not reach.
//!
//! The room has no `passes.rs`, because the composition draws the bows; no `candidates.rs`, because there is one way to
//! draw them, too cheap to be left out; and no `held.rs`, because a bow has no state.

mod drops;
pub mod reference;
mod table;
mod view;

pub use table::{ENTRIES, STEP_RAD, Table, phase_in};

pub(crate) use drops::{in_low_air, is_lit};
pub(crate) use view::BowView;
