//! Lightning: when and where it strikes, as a function of seed, time and rate alone.
//!
//! # Model
//! * [`schedule`]: flashes of a storm come by chance, evenly in time (Poisson). Of a fixed stream of candidates, sixty a minute, each has a
//!   number of its own from 0 to 1; those below the rate over sixty a minute strike. So a rate that changes adds and takes flashes, and
//!   moves none. A flash stays in the cloud or goes to ground, has strokes with pauses between, each with a peak current.
//! * [`channel`]: the way of a flash, from its charge down to the ground or through the cloud, with branches; what stands high draws
//!   it. Thunder comes from its nearest point.
//!
//! Pictures do not show it yet.

pub mod channel;
pub mod probe;
pub mod schedule;
