//! Places of a value inside a packet: whole numbers, floats and groups of bits, in either byte order.

/// Order in which a sender writes the bytes of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// Least significant byte first.
    Little,
    /// Most significant byte first.
    Big,
}

impl Order {
    /// Returns the order of this machine.
    pub const fn native() -> Self {
        if cfg!(target_endian = "big") { Self::Big } else { Self::Little }
    }
}

/// Place of a value: its width and its offset from the packet's start, bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slot {
    /// The version has no such field.
    Absent,
    /// Bits of one byte: offset, lowest bit (0 is the least significant), number of bits.
    Bits(usize, u32, u32),
    /// Unsigned byte.
    U8(usize),
    /// Signed byte.
    I8(usize),
    /// Unsigned 16-bit number.
    U16(usize),
    /// Unsigned 32-bit number.
    U32(usize),
    /// IEEE 754 number of 32 bits.
    F32(usize),
    /// IEEE 754 number of 64 bits.
    F64(usize),
}

impl Slot {
    /// Returns the offset and the number of bytes, or `None` if the field is absent.
    pub const fn bytes(self) -> Option<(usize, usize)> {
        match self {
            Self::Absent => None,
            Self::Bits(offset, ..) | Self::U8(offset) | Self::I8(offset) => Some((offset, 1)),
            Self::U16(offset) => Some((offset, 2)),
            Self::U32(offset) | Self::F32(offset) => Some((offset, 4)),
            Self::F64(offset) => Some((offset, 8)),
        }
    }

    /// Returns the bits of the slot's bytes that belong to it: the mask for a group of bits, else 0xff.
    pub const fn mask(self) -> u8 {
        match self {
            Self::Bits(_, low, count) => (((1u16 << count) - 1) << low) as u8,
            _ => 0xff,
        }
    }

    /// Reads the raw bits. A slot that is absent, or that ends beyond `packet`, reads as 0.
    pub fn read(self, packet: &[u8], order: Order) -> u64 {
        let Some((offset, count)) = self.bytes() else { return 0 };
        let Some(bytes) = packet.get(offset..offset + count) else { return 0 };
        let append = |value: u64, byte: &u8| value << 8 | u64::from(*byte);
        let raw = match order {
            Order::Big => bytes.iter().fold(0, append),
            Order::Little => bytes.iter().rev().fold(0, append),
        };
        match self {
            Self::Bits(_, low, _) => (raw & u64::from(self.mask())) >> low,
            _ => raw,
        }
    }

    /// Writes raw bits; higher bits than the slot has are cut off. Does nothing if the slot is absent, or ends beyond
    /// `packet`.
    pub fn write(self, packet: &mut [u8], order: Order, raw: u64) {
        let Some((offset, count)) = self.bytes() else { return };
        let Some(bytes) = packet.get_mut(offset..offset + count) else { return };
        if let Self::Bits(_, low, _) = self {
            bytes[0] = bytes[0] & !self.mask() | (raw << low) as u8 & self.mask();
            return;
        }
        for (i, byte) in bytes.iter_mut().enumerate() {
            let shift = match order {
                Order::Little => i,
                Order::Big => count - 1 - i,
            };
            *byte = (raw >> (8 * shift)) as u8;
        }
    }
}

/// Value of a field, as JSON and the tests see it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// Switch.
    Bool(bool),
    /// Whole number.
    Int(i64),
    /// Number of 32 bits.
    F32(f32),
    /// Number of 64 bits.
    F64(f64),
}

/// Type of a packet's field.
pub trait Raw: Copy {
    /// Converts from the bits of a slot.
    fn from_raw(raw: u64) -> Self;
    /// Converts to the bits of a slot.
    fn to_raw(self) -> u64;
    /// Returns the value.
    fn value(self) -> Value;
}

impl Raw for bool {
    fn from_raw(raw: u64) -> Self {
        raw != 0
    }

    fn to_raw(self) -> u64 {
        self.into()
    }

    fn value(self) -> Value {
        Value::Bool(self)
    }
}

/// Implements [`Raw`] for whole numbers.
macro_rules! whole {
    ($($name:ty),+) => {$(
        impl Raw for $name {
            fn from_raw(raw: u64) -> Self {
                raw as Self
            }

            fn to_raw(self) -> u64 {
                self as u64
            }

            fn value(self) -> Value {
                Value::Int(self.into())
            }
        }
    )+};
}
whole!(i8, u8, u16, u32);

impl Raw for f32 {
    fn from_raw(raw: u64) -> Self {
        Self::from_bits(raw as u32)
    }

    fn to_raw(self) -> u64 {
        self.to_bits().into()
    }

    fn value(self) -> Value {
        Value::F32(self)
    }
}

impl Raw for f64 {
    fn from_raw(raw: u64) -> Self {
        Self::from_bits(raw)
    }

    fn to_raw(self) -> u64 {
        self.to_bits()
    }

    fn value(self) -> Value {
        Value::F64(self)
    }
}
