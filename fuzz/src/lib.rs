//! The targets of `tests/fuzz` as a library for the fuzzers; the tests replay them on the committed corpora.
#![allow(dead_code)]

#[path = "../../tests/fuzz/calls.rs"]
mod calls;
#[path = "../../tests/fuzz/dice.rs"]
mod dice;
#[path = "../../tests/fuzz/judge.rs"]
mod judge;
#[path = "../../tests/support/refusals.rs"]
mod refusals;
#[path = "../../tests/fuzz/structs.rs"]
mod structs;
#[path = "../../tests/fuzz/targets.rs"]
pub mod targets;
#[path = "../../tests/fuzz/texts.rs"]
mod texts;
