//! The weather through the public interface: reports, presets, the conditions they give, transitions, and the values
//! that are accepted.

mod accepted;
mod air;
mod drawn;
mod host;
mod logged;
mod random;
mod real_reports;
mod regions;
mod reports;
mod sea;
mod seams;
mod second_opinion;
