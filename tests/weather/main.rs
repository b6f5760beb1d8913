//! The weather from outside: reports, presets, what follows from them, how one becomes another, and what is accepted.

mod accepted;
mod drawn;
#[path = "../frame/host.rs"]
#[allow(dead_code, reason = "tests of frames use all of it")]
mod frame_host;
mod host;
mod random;
mod reports;
mod seams;
