//! The C functions of Welkin as a shared and a static library. A package of its own, so that both are linked from the
//! one compilation of the Rust library that Rust programs and the tests use.
pub use engine::capi;
