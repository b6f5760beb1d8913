//! What the fuzzers run: the targets of `tests/fuzz`, which the tests replay on the committed corpora.
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
