//! Water on the windscreen: drops land on the glass through which a view looks, merge, run down, are wiped off, and
//! refract the picture behind them.
//!
//! **State.** The glass is a lattice of cells of 4 mm. A cell holds at most one bead of water, with its volume, its
//! position in the cell and whether it runs. It also has the number of drops that have hit it since it was last cleared
//! (fine beads are drawn from that number) and a thin film. All of this is integers, and a step uses integer arithmetic
//! only (`shaders/glass/cells.wgsl`; the twin is [`mod@reference`]). The same seed and times therefore give the same
//! bits on every driver. Physics in floating point, such as speeds, rates and retention, is turned into integer tables
//! on the CPU once a step ([`step`], from the laws in [`laws`]).
//!
//! **Snow** lies on the cells in whole units of its water. Flakes land, blades remove them, heat melts them, and the
//! meltwater forms beads ([`frost`], `shaders/glass/settle.wgsl`).
//!
//! **Time.** Steps lie on a grid of 60 Hz anchored at simulation time 0, so the frame rate does not matter. After a
//! cut, at the first frame, after a step back in time, and if more than [`MAX_STEPS`] would be due, the glass takes the
//! declared state of that time. This state is a pure function of the seed, the time and the conditions on the glass
//! then, and its beads are too small to run. A frame with `NO_HISTORY` always shows the declared state.
//!
//! **Cost.** Each step takes two passes over the lattice, and a third with snow on the glass or falling. Each frame
//! takes two small copies of the picture and one pass over it. There is no cost without a windscreen, or on dry glass
//! without mist.
//! **Left out**: the splash of an impact, water pushed ahead of a blade, and refraction between drops more than a cell
//! apart.
//!
//! There is no `held.rs`: the water belongs to a view's own window (`state.rs`). There is no `candidates.rs`: there is
//! one way to draw the water, and the plan never leaves the water out.

mod cell_passes;
pub mod frost;
mod geometry;
pub mod laws;
mod lens;
mod pane;
mod passes;
pub mod reach;
mod reach_pass;
pub mod reference;
mod state;
pub mod step;
mod view;
mod windscreen;

pub use geometry::{CELL_M, MAX_CELLS, Pane, Plane};
pub use reach::Reach;
pub use state::GlassReport;
pub use step::{MAX_STEPS, STEPS_PER_S};
pub(crate) use view::GlassView;
pub use windscreen::{MAX_ARMS, Windscreen, WiperArm};
