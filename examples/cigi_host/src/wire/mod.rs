//! CIGI on the wire: datagrams to typed packets and back, in 3.0 to 3.3 and 4.0 and in both byte orders.
//!
//! A datagram is one message. Its first packet says the version and the byte order ([`Message::open`]). Each packet
//! says its size, so unknown ones are skipped. Nothing here reads beyond a packet, allocates for what a peer states, or
//! panics, whatever the bytes are.

mod layout;
pub mod maritime;
mod message;
mod names;
mod packets;
mod slot;

pub use layout::{Family, Field, Header, Layout, Role, Visitor};
pub use message::{Direction, Fault, MAX_DATAGRAM, Message, Packets, Placed, Version, Writer};
pub use packets::*;
pub use slot::{Order, Raw, Slot, Value};
