//! Messages: which version and byte order a datagram has, its packets one by one, and a writer.

use std::fmt;

use super::layout::Family;
use super::packets::{IgControl, Packet, StartOfFrame};
use super::slot::Order;

/// Largest UDP datagram over IPv4, bytes.
pub const MAX_DATAGRAM: usize = 65_507;

/// Versions of CIGI that differ on the wire.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Version {
    /// 3.0 and 3.1, which cannot be told apart.
    V3_0,
    /// 3.2.
    V3_2,
    /// 3.3, and any later minor version of 3.
    V3_3,
    /// 4.0, and any later minor version of 4.
    V4_0,
}

impl Version {
    /// Returns the family, which decides the offsets.
    pub const fn family(self) -> Family {
        match self {
            Self::V4_0 => Family::V4,
            _ => Family::V3,
        }
    }

    /// Returns the major and the minor version, as a packet states them.
    pub const fn numbers(self) -> [u8; 2] {
        match self {
            Self::V3_0 => [3, 0],
            Self::V3_2 => [3, 2],
            Self::V3_3 => [3, 3],
            Self::V4_0 => [4, 0],
        }
    }

    /// Returns the size that a packet of the table has in this version, bytes: as in the table, but for the first
    /// packets of 3.0, which end before the echo of the frame number.
    fn size(self, id: u16, size: usize) -> usize {
        let is_first = id == 1 || id == 101;
        if self == Self::V3_0 && is_first { 16 } else { size }
    }
}

impl fmt::Display for Version {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [major, minor] = self.numbers();
        write!(f, "{major}.{minor}")
    }
}

/// Reason for refusing a datagram or a packet in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// The datagram is too short for its first packet.
    Short {
        /// Its length, bytes.
        length: usize,
    },
    /// The first packet is neither IG Control nor Start of Frame, or the version is none of these.
    NotCigi,
    /// The first packet of 3.x does not say its byte order.
    ByteOrder {
        /// Number that should be 0x8000 or 0x0080.
        magic: u16,
    },
    /// A packet ends beyond the datagram, or is shorter than its header. What follows cannot be read.
    Size {
        /// Where the packet begins, bytes.
        offset: usize,
        /// Size that it states, bytes.
        size: usize,
    },
    /// A packet is shorter than its table, or its size is no multiple of 8.
    PacketSize {
        /// Name of the packet.
        name: &'static str,
        /// Size that it states, bytes.
        size: usize,
        /// Size by the table, bytes.
        needed: usize,
    },
    /// The first packet comes from the wrong side, or stands elsewhere than first.
    Misplaced {
        /// Name of the packet.
        name: &'static str,
    },
    /// A packet has no form in the version to write.
    NoForm {
        /// Name of the packet.
        name: &'static str,
    },
    /// The message would be larger than a datagram.
    Full,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Short { length } => write!(f, "datagram of {length} bytes: a message has at least 16"),
            Self::NotCigi => write!(f, "first packet: must be IG Control or Start of Frame of CIGI 3 or 4"),
            Self::ByteOrder { magic } => {
                write!(f, "byte swap magic: must be 0x8000 in either byte order, got {magic:#06x}")
            }
            Self::Size { offset, size } => {
                write!(f, "packet at byte {offset}: its size of {size} bytes does not fit the datagram")
            }
            Self::PacketSize { name, size, needed } => {
                write!(f, "{name}: size must be a multiple of 8 and at least {needed} bytes, got {size}")
            }
            Self::Misplaced { name } => write!(f, "{name}: does not belong at this place of a message"),
            Self::NoForm { name } => write!(f, "{name}: has no form in this version"),
            Self::Full => write!(f, "message: must be at most {MAX_DATAGRAM} bytes"),
        }
    }
}

impl std::error::Error for Fault {}

/// Side that sent a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Host to image generator: begins with IG Control.
    ToIg,
    /// Image generator to host: begins with Start of Frame.
    ToHost,
}

/// A datagram whose version and byte order are known.
#[derive(Clone, Copy, Debug)]
pub struct Message<'a> {
    /// Version of the sender.
    pub version: Version,
    /// Byte order of the sender.
    pub order: Order,
    /// Side that sent it.
    pub direction: Direction,
    bytes: &'a [u8],
}

/// A packet in a datagram.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placed<'a> {
    /// Where it begins, bytes from the datagram's start.
    pub offset: usize,
    /// Identifier.
    pub id: u16,
    /// Its bytes, header included.
    pub bytes: &'a [u8],
    /// What it says; `None` if no table has this identifier.
    pub packet: Option<Packet>,
}

impl<'a> Message<'a> {
    /// Finds version, byte order and direction from the first packet.
    ///
    /// # Errors
    /// [`Fault::Short`], [`Fault::NotCigi`], [`Fault::ByteOrder`].
    pub fn open(bytes: &'a [u8]) -> Result<Self, Fault> {
        let first: &[u8; 16] = bytes.first_chunk().ok_or(Fault::Short { length: bytes.len() })?;
        if first[2] == 3 {
            let direction = match first[0] {
                1 => Direction::ToIg,
                101 => Direction::ToHost,
                _ => return Err(Fault::NotCigi),
            };
            let order = match [first[6], first[7]] {
                [0x00, 0x80] => Order::Little,
                [0x80, 0x00] => Order::Big,
                other => return Err(Fault::ByteOrder { magic: u16::from_le_bytes(other) }),
            };
            let minor = if direction == Direction::ToIg { first[4] } else { first[5] } >> 4;
            let version = match minor {
                0 | 1 => Version::V3_0,
                2 => Version::V3_2,
                _ => Version::V3_3,
            };
            return Ok(Self { version, order, direction, bytes });
        }
        let direction = match [first[2], first[3], first[4]] {
            [0x00, 0x00, 4] => Direction::ToIg,
            [0xff, 0xff, 4] => Direction::ToHost,
            _ => return Err(Fault::NotCigi),
        };
        // The size of the first packet is 24 in either order, so one of its two bytes is 0.
        let order = if first[0] == 0 { Order::Big } else { Order::Little };
        Ok(Self { version: Version::V4_0, order, direction, bytes })
    }

    /// Returns the packets in their order.
    pub fn packets(&self) -> Packets<'a> {
        Packets { message: *self, offset: 0 }
    }
}

/// Packets of a message. Ends after the first whose size does not fit the datagram.
#[derive(Clone, Debug)]
pub struct Packets<'a> {
    message: Message<'a>,
    offset: usize,
}

impl<'a> Iterator for Packets<'a> {
    type Item = Result<Placed<'a>, Fault>;

    fn next(&mut self) -> Option<Self::Item> {
        let Message { version, order, direction, bytes } = self.message;
        let offset = self.offset;
        let rest = bytes.get(offset..).filter(|rest| !rest.is_empty())?;
        let header = rest.first_chunk().map(|header| read_header(version.family(), *header, order));
        let fits = header.filter(|header| (4..=rest.len()).contains(&header.size));
        let Some(super::Header { id, size }) = fits else {
            self.offset = bytes.len();
            return Some(Err(Fault::Size { offset, size: header.map_or(rest.len(), |header| header.size) }));
        };
        self.offset += size;
        let bytes = &rest[..size];
        let packet = Packet::read(version.family(), id, bytes, order);
        let layout = packet.map(|packet| packet.layout());
        let needed = layout.and_then(|l| l.header(version.family())).map_or(8, |header| version.size(id, header.size));
        let name = layout.map_or_else(|| Packet::other_name(version.family(), id), |layout| layout.name);
        if size < needed || size % 8 != 0 {
            return Some(Err(Fault::PacketSize { name, size, needed }));
        }
        let belongs = match packet {
            Some(Packet::IgControl(_)) => offset == 0 && direction == Direction::ToIg,
            Some(Packet::StartOfFrame(_)) => offset == 0 && direction == Direction::ToHost,
            _ => true,
        };
        Some(if belongs { Ok(Placed { offset, id, bytes, packet }) } else { Err(Fault::Misplaced { name }) })
    }
}

fn read_header(family: Family, bytes: [u8; 4], order: Order) -> super::Header {
    let two = |a, b| match order {
        Order::Little => u16::from_le_bytes([a, b]),
        Order::Big => u16::from_be_bytes([a, b]),
    };
    match family {
        Family::V3 => super::Header { id: bytes[0].into(), size: bytes[1].into() },
        Family::V4 => super::Header { id: two(bytes[2], bytes[3]), size: two(bytes[0], bytes[1]).into() },
    }
}

/// Writes messages of one version and byte order.
#[derive(Clone, Debug)]
pub struct Writer {
    version: Version,
    order: Order,
    bytes: Vec<u8>,
}

impl Writer {
    /// Creates an empty message.
    pub fn new(version: Version, order: Order) -> Self {
        Self { version, order, bytes: Vec::new() }
    }

    /// Empties the message for another one, which may have another version and byte order.
    pub fn restart(&mut self, version: Version, order: Order) {
        self.version = version;
        self.order = order;
        self.bytes.clear();
    }

    /// Appends a packet. Reserved bytes are 0. The first packets get the version and the sign of the byte order.
    ///
    /// # Errors
    /// [`Fault::NoForm`], [`Fault::Full`]; the message stays as it was.
    pub fn push(&mut self, packet: impl Into<Packet>) -> Result<(), Fault> {
        let packet = self.stamped(packet.into());
        let (family, layout) = (self.version.family(), packet.layout());
        let header = layout.header(family).ok_or(Fault::NoForm { name: layout.name })?;
        let size = self.version.size(header.id, header.size);
        let start = self.bytes.len();
        if start + size > MAX_DATAGRAM {
            return Err(Fault::Full);
        }
        self.bytes.resize(start + size, 0);
        let bytes = &mut self.bytes[start..];
        packet.write_fields(family, bytes, self.order);
        match family {
            Family::V3 => bytes[..2].copy_from_slice(&[header.id as u8, size as u8]),
            Family::V4 => {
                for (place, number) in [(0, size as u16), (2, header.id)] {
                    super::Slot::U16(place).write(bytes, self.order, number.into());
                }
            }
        }
        Ok(())
    }

    /// Returns the message so far.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    fn stamped(&self, packet: Packet) -> Packet {
        let [major_version, minor_version] = self.version.numbers();
        let byte_swap = 0x8000;
        match packet {
            Packet::IgControl(first) => IgControl { major_version, minor_version, byte_swap, ..first }.into(),
            Packet::StartOfFrame(first) => StartOfFrame { major_version, minor_version, byte_swap, ..first }.into(),
            other => other,
        }
    }
}
