//! Solved wind field: air that flows around terrain and buildings.
//!
//! A [`FlowField`] is a box of cells. Its inputs are the outer wind, which blows in over its open sides, and the
//! obstacles that stand or move in it ([`FlowObstacles`]). [`FlowField::step`] advances it in time,
//! [`FlowField::settle`] advances it until it is steady, and [`FlowField::velocity_at`] returns the wind at any place.
//!
//! A context has a field if its host asks for one ([`WindFieldDesc`],
//! [`Context::set_wind_field`](crate::context::Context::set_wind_field)). `live.rs` moves the field with its place, and
//! sets the inflow by the weather's profile and gusts, and the obstacles by the host's terrain and boxes. `held.rs`
//! advances the field in steps that end at multiples of their length from time 0, saves it, and publishes its wind to
//! the world. Effects read the wind from the world ([`crate::wind`]); none calls this room.
//!
//! # Model
//!
//! Air of constant density with the velocity u: du/dt + (u . grad) u = -grad p + nu laplace u, div u = 0. p is the
//! pressure divided by the density. In weather the viscosity nu is 0 (Euler's equations).
//!
//! - Grid: staggered, with velocity at the centres of faces and pressure at the centres of cells (Harlow and Welch
//!   1965).
//! - Obstacles: each face has an open share, so air flows along slopes and past boxes that end within a cell. The flux
//!   through a face is its open share times its velocity (Ng, Min and Gibou 2009). If a moving obstacle closes the rest
//!   of the face, it pushes air with its own velocity (Batty, Bertails and Bridson 2007). Air slides along obstacles or
//!   sticks to them.
//! - Rough walls: air that slides along them feels the stress of the logarithmic law (`walls.rs`). Eddies smaller than
//!   a cell: Vreman's eddy viscosity (2004), and over the ground Prandtl's kappa u* z, which maintains the inflow's
//!   profile (`eddies.rs`). No constant is fitted.
//! - Advection ([`Scheme`]): by default half a step, a projection, a reflection (2 x projected - unprojected velocity),
//!   another half step and a projection (Zehnder et al. 2018). Each half step is cubic, limited to the range of the
//!   values it interpolates. The advecting wind is extrapolated to the middle of each half step. With the wind at the
//!   beginning of the half step, vortices would drift across the mean wind. Stam's and MacCormack's schemes are
//!   available too.
//! - Pressure ([`PressureMethod`]): conjugate gradients preconditioned by multigrid, or red-black over-relaxation. Both
//!   stop by the remaining divergence. The previous step's potential is subtracted first, so rounding errors are only
//!   those of the change.
//! - Sides ([`Side`]): walls, periodic, open. At an open side air leaves with the velocity that advection gives it;
//!   only the flux is balanced, for each separate body of air.
//!
//! # Error
//!
//! A name in the column of commands stands for `cargo test --lib flow -- --nocapture NAME`, with `WELKIN_ACCEPT=1` in
//! the environment where the column says "accept".
//!
//! | flow | found | command |
//! |---|---|---|
//! | lid-driven cavity, Re 100, 32^2, compared to Ghia et al. (1982) | 0.49 % of the lid's speed | `lid` |
//! | same cavity, 64^2 and 128^2; Re 1000, 128^2, compared to Botella and Peyret (1998) | 0.49 % and 0.54 %; 0.73 % | `lid`, accept |
//! | Taylor-Green vortices, 64^2: share of energy kept, CFL 1 and 4 | 0.994 and 0.994 | `probe taylor-green --n 64 --cfl 1` |
//! | same vortices, MacCormack's scheme | 0.769 and 0.455 | `probe taylor-green --n 64 --cfl 1 --scheme maccormack` |
//! | same vortices, Stam's scheme | 0.644 and 0.407 | `probe taylor-green --n 64 --cfl 1 --scheme semi-lagrangian` |
//! | shear layers, 64^2 compared to 128^2, CFL 1 and 4 | 0.4 % and 0.9 % | `shear` |
//! | vortex of 8 cells in radius, carried over 96 cells, CFL 1 and 4 | 1.3 % and 2.9 % of its speed | `whirl_drifts` |
//! | vortex that leaves the box, seen a vortex's width from the side | 5.3 % of its speed while it leaves, then less than 0.4 % | `vortex_leaves` |
//! | drag coefficient of a cube of 10 cells an edge, mean over 20 edges/U; reference 1.05 | 1.21 (16 % more) | `cube`, accept |
//! | cube on the floor of a turbulent channel: distance behind it, in edges, where the flow reattaches; reference 1.6 (Martinuzzi and Tropea 1993); 8 and 16 cells an edge | 2.84 and 1.94 | `floor`, accept |
//! | largest divergence times cell size over speed, hills and boxes | below the tolerance, 1e-4 by default | `no_air_is_made` |
//!
//! # Cost
//!
//! To reduce the residual to a tenth takes 1.0 V-cycles at 64^2 around a box. A V-cycle has the work of 9 sweeps over
//! the grid. Over-relaxation needs 11 times this work (`cargo test --lib flow -- --nocapture multigrid`). A step of the
//! default scheme takes two projections. Advection, sweeps and eddies compute four neighbouring values at a time
//! (`lanes.rs`, `halves.rs`), each by the same operations in the same order as a single value, so the bits do not
//! depend on this grouping. The cost grows only with the number of cells: twice the cells take 1.8 to 2 times as long
//! (`cargo bench --bench speed -- wind`). Memory: [`WindFieldDesc::bytes`], about 300 bytes a cell. The field runs on
//! one thread and without the GPU; every run gives the same bits.
//!
//! # Limits
//!
//! The field is stepped only on the CPU. Inside obstacles the wind is that of the air beside them down to a depth of
//! four cells, and 0 farther inside. Heat is not modelled.

mod advect;
mod desc;
mod eddies;
mod field;
mod halves;
mod held;
mod lanes;
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
