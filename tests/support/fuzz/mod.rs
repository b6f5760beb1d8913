//! Building blocks of fuzzing: random calls of the whole C interface, damaged texts, and checks of the answers. The
//! tests drive it with seeded random numbers, the fuzzers of `fuzz/` with inputs that reach new code.

pub mod calls;
pub mod dice;
pub mod judge;
pub mod structs;
pub mod targets;
pub mod texts;
