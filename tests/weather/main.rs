//! The weather from outside: reports, presets, what follows from them, how one becomes another, and what is accepted.

mod accepted;
mod drawn;
mod host;
mod logged;
mod random;
mod real_reports;
mod reports;
mod sea;
mod seams;
mod second_opinion;
