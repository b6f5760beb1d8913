//! The targets of `tests/support` for the fuzzers; the tests replay them on the committed corpora.

pub use welkin_support::fuzz::targets;
