//! The air as a solved field: wind that goes round terrain and buildings.
//!
//! A [`FlowField`] is a box of cells. It is told the outer wind, which blows in over its open sides, and what stands or
//! moves in it ([`FlowObstacles`]); [`FlowField::step`] leads it on, [`FlowField::settle`] until it rests, and
//! [`FlowField::velocity_at`] answers for any place.
//!
//! A context holds one if its host asks for it ([`WindFieldDesc`],
//! [`Context::set_wind_field`](crate::context::Context::set_wind_field)). `live.rs` keeps it about its place: inflow
//! from the weather's profile and gusts, the host's terrain and boxes as obstacles. `held.rs` leads it on a step grid
//! that is anchored at time 0, saves it, and shows the world its wind, where effects find it ([`crate::wind`]): no
//! effect asks this room.
//!
//! # Model
//!
//! Air of constant density: du/dt + (u . grad) u = -grad p + nu laplace u, div u = 0 (Euler's equations where the
//! viscosity nu is 0, as in weather).
//!
//! - Grid: velocity in the middle of faces, pressure in the middle of cells (Harlow and Welch 1965).
//! - Obstacles: the open share of each face, so that air flows along slopes and past boxes that end within a cell (Ng,
//!   Min and Gibou 2009: the flux through a face is its open share times its velocity; what closes the rest and moves
//!   pushes air with its own, Batty, Bertails and Bridson 2007). Air slides along them or sticks to them.
//! - Rough walls: the stress of the logarithmic law on air that slides along them (`walls.rs`). Whirls below a cell:
//!   Vreman's eddy viscosity (2004), and over the ground Prandtl's kappa u* z, which keeps up the profile that comes in
//!   (`eddies.rs`). No constant is fitted.
//! - Carrying ([`Scheme`]): by default half a step, a projection, the mirror image at it, another half and a projection
//!   (Zehnder et al. 2018), each half cubic within the values that it came from. The wind that carries is led on to the
//!   middle of each half; with that of its beginning a whirl drifts across the mean wind. The sources' scheme and
//!   MacCormack's stand beside it.
//! - Pressure ([`PressureMethod`]): conjugate gradients led by multigrid, or red-black over-relaxation. Both stop by
//!   the divergence that stays. The potential of the step before is taken off first, so that rounding concerns the
//!   change alone.
//! - Sides ([`Side`]): walls, periodic, open. Air leaves an open side as it is carried there; only its flux is
//!   balanced, for each body of air that things part from the others.
//!
//! # Error
//!
//! | flow | found | command |
//! |---|---|---|
//! | lid-driven cavity, Re 100, 32^2, off Ghia et al. (1982) | 0.49 % of the lid's speed | `cargo test --lib flow -- --nocapture lid` |
//! | the same, 64^2 and 128^2; Re 1000, 128^2, off Botella and Peyret (1998) | 0.49 % and 0.54 %; 0.73 % | the same with `WELKIN_ACCEPT=1` |
//! | Taylor-Green whirls, 64^2: energy kept, CFL 1 and 4 | 0.994 and 0.994 | `probe taylor-green --n 64 --cfl 1` |
//! | the same by MacCormack's scheme | 0.769 and 0.455 | the same with `--scheme maccormack` |
//! | the same by the sources' scheme | 0.644 and 0.407 | the same with `--scheme semi-lagrangian` |
//! | shear layers, 64^2 from 128^2, CFL 1 and 4 | 0.4 % and 0.9 % | `cargo test --lib flow -- --nocapture shear` |
//! | a whirl 8 cells in radius, carried 96 cells, CFL 1 and 4 | 1.3 % and 2.9 % of its speed | `.. whirl_drifts` |
//! | a whirl that leaves, a whirl's width from the side | 5.3 % of its speed while it leaves, then less than 0.4 % | `.. what_leaves` |
//! | drag of a cube of 10 cells an edge, mean of 20 edges/U, off 1.05 | 1.21 (16 % more) | the same with `WELKIN_ACCEPT=1`: `.. cube` |
//! | cube on the floor of a turbulent channel: edges behind it where the flow comes back to the floor, off 1.6 (Martinuzzi and Tropea 1993); 8 and 16 cells an edge | 2.84 and 1.94 | .. `floor` |
//! | largest divergence times cell size over speed, hills and boxes | below the tolerance, 1e-4 by default | `.. no_air_is_made` |
//!
//! # Cost
//!
//! V-cycles for a tenth of the residual: 1.0 at 64^2 round a box, 9 sweeps of the grid each; over-relaxation needs 11
//! times the work there (`cargo test --lib flow -- --nocapture multigrid`). A step of the default scheme takes two
//! projections. It grows with the cells alone: twice the cells take 1.8 to 2 times as long
//! (`cargo bench --bench speed -- wind`). Memory: [`WindFieldDesc::bytes`], about 300 bytes a cell. One thread, no
//! device; the same bits on every run.
//!
//! # Not here yet
//!
//! No shader steps a field. Inside of things the answer is that of the air beside them. No heat.

mod advect;
mod desc;
mod eddies;
mod field;
mod held;
mod lattice;
mod live;
mod motion;
mod moving;
mod multigrid;
mod obstacles;
mod openings;
mod pressure;
pub mod probe;
mod projection;
mod saved;
mod settings;
mod sides;
#[cfg(test)]
mod tests;
mod turbulence;
mod walls;

pub use advect::Scheme;
pub use desc::{WindFieldDesc, WindFieldMode, WindFieldReport, WindWalls};
pub use field::FlowField;
pub(crate) use held::HeldFlow;
pub use obstacles::{FlowBox, FlowObstacles, Heights};
pub use pressure::{PressureMethod, Solved};
pub use settings::{FlowSettings, MAX_SPEED_M_S};
pub use sides::Side;
