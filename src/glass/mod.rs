//! Water on the windscreen: drops land on the glass that a host looks through, merge, run, are wiped, and bend the
//! picture behind them.
//!
//! **State.** The glass is a lattice of cells of 4 mm, at most one bead of water in each: its volume, its place inside
//! the cell, whether it runs; beside it how many drops have hit the cell since it was last cleared (the fine beads are
//! drawn from that number) and a thin film. Everything is an integer, and a step uses integer arithmetic only
//! (`shaders/glass/cells.wgsl`; the twin is [`mod@reference`]): the same seed and times give the same bits on every
//! driver. What needs physics in floating point, speeds, rates, retention, becomes tables of integers on the CPU once a
//! step ([`step`], from the laws in [`laws`]).
//!
//! **Snow** lies on the cells as whole units of its water: flakes land, blades take them away, heat melts them, and the
//! melt water is beads ([`frost`], `shaders/glass/settle.wgsl`).
//!
//! **Time.** Steps lie on a grid of 60 Hz anchored at simulation time 0, so the frame rate does not matter. After a
//! cut, at the first frame, and where more than [`MAX_STEPS`] would be due, the glass takes the declared state of that
//! moment, a pure function of (seed, time, rain): beads below the size at which they run. `NO_HISTORY` shows that state
//! always.
//!
//! **Cost.** Two passes over the lattice a step, a third where snow is or falls; two small copies of the picture and
//! one pass over it a frame; nothing without a windscreen or on dry glass. **Left out**: the splash of an impact, water
//! pushed ahead of a blade, drops farther apart than a cell seeing each other.
//!
//! No `held.rs`: the water belongs to a view's own window (`state.rs`). No `candidates.rs`: it is drawn in one way, and
//! no plan leaves it out.

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
