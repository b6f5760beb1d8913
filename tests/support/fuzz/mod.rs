//! What fuzzing is made of: calls of the whole C interface at random, damaged texts, and what judges the answers. The
//! tests play it by their own dice, the fuzzers of `fuzz/` by inputs that reach new code.

pub mod calls;
pub mod dice;
pub mod judge;
pub mod structs;
pub mod targets;
pub mod texts;
