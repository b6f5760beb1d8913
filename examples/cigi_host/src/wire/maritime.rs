//! The kind reading of Maritime Surface Conditions Control of 4.0.
//!
//! The class library 4.0 writes the identifier of the region or entity at byte 5, one byte too early, and its own
//! reader and Wireshark read it at byte 6. So a regional sea from such a host arrives under another number.

use super::{MaritimeSurfaceConditionsControl, Order, Slot, Version};

/// Returns the region or entity that the sender means.
///
/// A byte 5 that is not 0 shows a sender that writes too early, since the byte is reserved. Some numbers of such a
/// sender leave it 0: those below 256 of a big-endian sender look 256 times as large, and multiples of 256 of a
/// little-endian one look 256 times as small. `is_known` says whether the host has named a region or entity with a
/// number in this scope. A number that it has not named is taken for an early one: always of a big-endian sender, and
/// of a little-endian sender if the host has named the early one.
pub fn meant_id(
    sea: &MaritimeSurfaceConditionsControl,
    bytes: &[u8],
    version: Version,
    order: Order,
    is_known: impl Fn(u16) -> bool,
) -> u16 {
    let stated = sea.entity_or_region_id;
    if version != Version::V4_0 {
        return stated;
    }
    let early = Slot::U16(5).read(bytes, order) as u16;
    if Slot::U8(5).read(bytes, order) != 0 {
        return early;
    }
    let may_be_early = Slot::U8(7).read(bytes, order) == 0 && !is_known(stated);
    if may_be_early && (order == Order::Big || is_known(early)) { early } else { stated }
}
