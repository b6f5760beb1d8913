//! The table of offsets itself: fields fit their packets, do not share bits, and hold what their types hold; every
//! field of every packet reads back what was written, in both versions and byte orders.

use std::collections::BTreeSet;

use crate::common::{Random, named_bits};
use welkin_cigi_host::wire::{Family, Message, Order, Packet, Raw as _, Role, Slot, Value, Version, Writer};

const FAMILIES: [(Family, Version); 2] = [(Family::V3, Version::V3_3), (Family::V4, Version::V4_0)];

#[test]
fn fields_fit_their_packets_and_share_no_bit() {
    for (family, _) in FAMILIES {
        let mut ids = BTreeSet::new();
        for layout in Packet::LAYOUTS {
            let Some(header) = layout.header(family) else { continue };
            assert!(ids.insert(header.id), "{} has the number of another packet", layout.name);
            assert!(header.size % 8 == 0 && (family == Family::V4 || header.size < 256), "{}", layout.name);
            let mut taken = vec![0u8; header.size];
            for field in layout.fields.iter().filter(|field| field.role != Role::Child) {
                let slot = field.slot(family);
                let Some((offset, count)) = slot.bytes() else { continue };
                assert!(offset >= if family == Family::V3 { 2 } else { 4 }, "{}: {}", layout.name, field.name);
                assert!(offset + count <= header.size, "{}: {}", layout.name, field.name);
                assert_eq!(offset % count, 0, "{}: {} is not aligned", layout.name, field.name);
                for byte in &mut taken[offset..offset + count] {
                    assert_eq!(*byte & slot.mask(), 0, "{}: {} shares bits", layout.name, field.name);
                    *byte |= slot.mask();
                }
            }
            // A child's offsets stand where the coordinates of the top level stand.
            let places = |role| layout.fields.iter().filter(move |f| f.role == role).map(|f| f.slot(family));
            assert!(places(Role::Top).eq(places(Role::Child)), "{}", layout.name);
        }
        assert!(ids.len() >= 25, "{}", ids.len());
    }
}

/// Writes random bits into a slot and returns them as a field's type holds them.
fn fill(bytes: &mut [u8], slot: Slot, order: Order, random: &mut Random) {
    let raw = match slot {
        Slot::F32(_) => (random.between(-1e5, 1e5) as f32).to_raw(),
        Slot::F64(_) => random.between(-1e5, 1e5).to_raw(),
        _ => random.next(),
    };
    slot.write(bytes, order, raw);
}

#[test]
fn random_fields_of_every_packet_return_in_both_versions_and_orders() {
    let mut random = Random(0x5eed_0001);
    for (family, version) in FAMILIES {
        for order in [Order::Little, Order::Big] {
            for layout in Packet::LAYOUTS {
                let Some(header) = layout.header(family) else { continue };
                for _ in 0..200 {
                    let mut bytes = vec![0; header.size];
                    for field in layout.fields {
                        fill(&mut bytes, field.slot(family), order, &mut random);
                    }
                    let packet = Packet::read(family, header.id, &bytes, order).expect("a known packet");
                    let mut message = Writer::new(version, order);
                    let is_first = layout.name == "IG Control" || layout.name == "Start of Frame";
                    if !is_first {
                        message.push(welkin_cigi_host::wire::IgControl::default()).expect("room");
                    }
                    let start = message.bytes().len();
                    message.push(packet).expect("room");
                    let written = &message.bytes()[start..];
                    let again = Message::open(message.bytes()).expect("a message");
                    let again = again.packets().last().expect("a packet").expect("a good one");
                    if !is_first {
                        assert_eq!(again.packet, Some(packet), "{}", layout.name);
                        let mask = named_bits(&packet, family, header.size);
                        let header = if family == Family::V3 { 2 } else { 4 };
                        for i in header..bytes.len() {
                            assert_eq!(written[i] & mask[i], bytes[i] & mask[i], "{} byte {i}", layout.name);
                        }
                    }
                    let mut count = 0;
                    packet.visit(family, &mut |field, value| {
                        count += 1;
                        let raw = field.slot(family).read(&bytes, order);
                        let same = match value {
                            Value::Bool(on) => on == (raw != 0),
                            Value::Int(number) => number as u8 == raw as u8 && number.unsigned_abs() <= 0xffff_ffff,
                            Value::F32(number) => number.to_raw() == raw,
                            Value::F64(number) => number.to_raw() == raw,
                        };
                        assert!(same, "{}: {} {value:?} {raw}", layout.name, field.name);
                    });
                    assert!(count >= 2, "{}", layout.name);
                }
            }
        }
    }
}
