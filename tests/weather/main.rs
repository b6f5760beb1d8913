//! The weather from outside: reports, presets, what follows from them, how one becomes another, and what is accepted.

mod accepted;
#[path = "../support/coarse_sky.rs"]
mod coarse_sky;
mod drawn;
#[path = "../frame/host.rs"]
#[allow(dead_code, reason = "tests of frames use all of it")]
mod frame_host;
mod host;
mod logged;
mod random;
mod real_reports;
mod reports;
mod seams;
mod second_opinion;
#[path = "../support/textures.rs"]
mod textures;
