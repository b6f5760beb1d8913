//! A flash: its kind, place, time and strokes.

use glam::DVec2;

/// Largest number of strokes. Flashes with more than 26 have hardly been seen (Rakov and Uman 2003).
pub const MOST_STROKES: usize = 26;

/// Kind of a flash.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FlashKind {
    /// Stays within the cloud.
    InCloud,
    /// Strikes the ground.
    ToGround,
}

impl FlashKind {
    /// Returns the kind's name in the probe's answers.
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
    /// Time since the flash began, s.
    pub after_s: f64,
    /// Peak current, kA.
    pub peak_ka: f64,
}

/// A flash.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flash {
    /// Unique number, which is also the seed of its random properties.
    pub id: u64,
    /// Time of its first stroke, s of simulation time.
    pub time_s: f64,
    /// Kind of the flash.
    pub kind: FlashKind,
    /// Place on the map near which it starts, m east and north.
    pub place_m: DVec2,
    /// Strokes in order, of which the first `count` belong to the flash.
    pub(super) strokes: [Stroke; MOST_STROKES],
    /// Number of strokes.
    pub(super) count: usize,
}

impl Flash {
    /// Returns the flash's strokes in order. For a flash in the cloud they are the steps of its light.
    pub fn strokes(&self) -> &[Stroke] {
        &self.strokes[..self.count]
    }

    /// Returns the time of the last stroke, s of simulation time.
    pub fn last_s(&self) -> f64 {
        self.time_s + self.strokes().last().map_or(0.0, |s| s.after_s)
    }

    /// Returns the largest peak current of its strokes, kA.
    pub fn peak_ka(&self) -> f64 {
        self.strokes().iter().fold(0.0, |most, s| most.max(s.peak_ka))
    }
}
