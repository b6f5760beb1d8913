//! Flash: its kind, its place and time, and its strokes.

use glam::DVec2;

/// Most strokes: more have hardly been seen (26; Rakov and Uman 2003).
pub const MOST_STROKES: usize = 26;

/// Where a flash goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FlashKind {
    /// Within the cloud.
    InCloud,
    /// To the ground.
    ToGround,
}

impl FlashKind {
    /// Its name in the probe's answers.
    pub const fn name(self) -> &'static str {
        match self {
            Self::InCloud => "cloud",
            Self::ToGround => "ground",
        }
    }
}

/// One stroke of a flash.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Stroke {
    /// After the flash began, s.
    pub after_s: f64,
    /// Peak current, kA.
    pub peak_ka: f64,
}

/// A flash.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flash {
    /// Number of its own; seed of what chance decides of it.
    pub id: u64,
    /// When its first stroke comes, s of simulation time.
    pub time_s: f64,
    /// Where it goes.
    pub kind: FlashKind,
    /// Where it starts, m east and north.
    pub place_m: DVec2,
    pub(super) strokes: [Stroke; MOST_STROKES],
    pub(super) count: usize,
}

impl Flash {
    /// Its strokes in order; those of a flash in the cloud are the steps of its light.
    pub fn strokes(&self) -> &[Stroke] {
        &self.strokes[..self.count]
    }

    /// When the last stroke comes, s of simulation time.
    pub fn last_s(&self) -> f64 {
        self.time_s + self.strokes().last().map_or(0.0, |s| s.after_s)
    }

    /// Largest of its strokes' peak currents, kA.
    pub fn peak_ka(&self) -> f64 {
        self.strokes().iter().fold(0.0, |most, s| most.max(s.peak_ka))
    }
}
