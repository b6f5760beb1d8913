//! Counts of what a peer sent and this program did not take as it stood, by name.

use std::collections::BTreeMap;
use std::fmt;

use crate::wire::Fault;

/// What is counted. All parts are texts of the program, so a peer cannot make the list grow.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Note {
    /// Packet, or `datagram`.
    pub subject: &'static str,
    /// Field of the packet, or empty.
    pub field: &'static str,
    /// Act, and its reason.
    pub reason: &'static str,
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { subject, field, reason } = self;
        if field.is_empty() { write!(f, "{subject}: {reason}") } else { write!(f, "{subject}: {field}: {reason}") }
    }
}

/// Notes with their counts.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Notes(BTreeMap<Note, u64>);

impl Notes {
    /// Counts one.
    pub fn add(&mut self, subject: &'static str, field: &'static str, reason: &'static str) {
        *self.0.entry(Note { subject, field, reason }).or_default() += 1;
    }

    /// Counts a fault of a datagram or packet.
    pub fn add_fault(&mut self, fault: &Fault) {
        let (subject, reason) = match fault {
            Fault::Short { .. } => ("datagram", "dropped, it is too short for a message"),
            Fault::NotCigi => ("datagram", "dropped, its first packet is no IG Control of CIGI 3 or 4"),
            Fault::ByteOrder { .. } => ("datagram", "dropped, it does not say its byte order"),
            Fault::Size { .. } => ("datagram", "rest dropped, a packet's size does not fit"),
            Fault::PacketSize { name, .. } => (*name, "ignored, its size is wrong"),
            Fault::Misplaced { name } => (*name, "ignored, it does not belong there"),
            Fault::NoForm { name } => (*name, "not sent, the version has no such packet"),
            Fault::Full => ("message", "not sent in full, it is larger than a datagram"),
        };
        self.add(subject, "", reason);
    }

    /// Returns the notes with their counts, in the order of their names.
    pub fn iter(&self) -> impl Iterator<Item = (&Note, u64)> {
        self.0.iter().map(|(note, count)| (note, *count))
    }

    /// Returns how often something was counted.
    pub fn count(&self, subject: &str, field: &str) -> u64 {
        self.iter().filter(|(note, _)| note.subject == subject && note.field == field).map(|(_, count)| count).sum()
    }
}

/// Checks the numbers of one packet.
pub struct Checked<'a> {
    /// Where faults are counted.
    pub notes: &'a mut Notes,
    /// Name of the packet.
    pub packet: &'static str,
}

impl Checked<'_> {
    /// Returns a number within its range: the former value if it is not finite, the nearest end if it is outside.
    pub fn number(&mut self, field: &'static str, value: impl Into<f64>, former: f64, range: [f64; 2]) -> f64 {
        let value = value.into();
        if !value.is_finite() {
            self.notes.add(self.packet, field, "not finite, the former value stays");
            return former;
        }
        let [low, high] = range;
        if value < low || value > high {
            self.notes.add(self.packet, field, "out of range, the nearest end is taken");
        }
        // Widths divide: a negative zero would change the sign of what they divide.
        value.clamp(low, high) + 0.0
    }

    /// Returns an angle reduced to [0, 360), degrees, or the former value if it is not finite.
    pub fn azimuth(&mut self, field: &'static str, value: f32, former: f64) -> f64 {
        if value.is_finite() {
            // A tiny negative angle rounds to 360.
            f64::from(value).rem_euclid(360.0) % 360.0
        } else {
            self.number(field, value, former, [0.0, 0.0])
        }
    }
}
