//! Names of packets that no table has.

use super::{Family, Packet};

impl Packet {
    /// Returns the name of the packet with an identifier that no table has, for messages to a person.
    pub fn other_name(family: Family, id: u16) -> &'static str {
        match (family, id) {
            (Family::V3, 201..=255) | (Family::V4, 0x1000..=0xfffe) => "User-defined packet",
            (Family::V3, 3) => "Conformal Clamped Entity Control",
            (Family::V4, 0x0002) => "Conformal Clamped Entity Position",
            (Family::V3, 17) | (Family::V4, 0x0010) => "Sensor Control",
            (Family::V3, 18) | (Family::V4, 0x0011) => "Motion Tracker Control",
            (Family::V3, 19) | (Family::V4, 0x0012) => "Earth Reference Model Definition",
            (Family::V3, 20) => "Trajectory Definition",
            (Family::V4, 0x0013) => "Acceleration Control",
            (Family::V3, 22) | (Family::V4, 0x0015) => "Collision Detection Segment Definition",
            (Family::V3, 23) | (Family::V4, 0x0016) => "Collision Detection Volume Definition",
            (Family::V3, 25) | (Family::V4, 0x0018) => "Line of Sight Segment Request",
            (Family::V3, 26) | (Family::V4, 0x0019) => "Line of Sight Vector Request",
            (Family::V3, 27) | (Family::V4, 0x001a) => "Position Request",
            (Family::V3, 29..=35) | (Family::V4, 0x001c..=0x0024) => "Symbol packet",
            (Family::V4, 0x0026) => "Animation Control",
            _ => "Unknown packet",
        }
    }
}
