//! Captures that the class libraries packed: every field equal to what the packer was given, and the same bytes when
//! they are written again.

use crate::common::{Capture, captures, named_bits};
use serde_json::Value;
use welkin_cigi_host::capture::{Decoded, Form, datagrams, decode};
use welkin_cigi_host::wire::{
    Fault, MAX_DATAGRAM, MaritimeSurfaceConditionsControl, Message, Order, Slot, Version, Writer, maritime,
};

const FORM: Form = Form { has_all_fields: false, reads_early_ids: true };

fn decoded(capture: &Capture, form: Form) -> Decoded {
    decode(&datagrams(&capture.bytes).expect("whole datagrams"), form)
}

fn parsed(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|e| panic!("{e}: {text}"))
}

#[test]
fn every_field_is_what_the_packer_was_given() {
    let captures = captures();
    assert_eq!(captures.len(), 44);
    let mut values = 0;
    for capture in &captures {
        let (ours, theirs) = (decoded(capture, FORM), parsed(&capture.json));
        assert_eq!(ours.refused, 0, "{}", capture.name);
        let printed = parsed(&ours.json);
        for key in ["cigi", "byte_order", "direction"] {
            assert_eq!(printed[key], theirs[key], "{}", capture.name);
        }
        let datagrams = |v: &Value| v["datagrams"].as_array().expect("datagrams").clone();
        assert_eq!(datagrams(&printed).len(), datagrams(&theirs).len(), "{}", capture.name);
        for (a, b) in datagrams(&printed).iter().zip(datagrams(&theirs)) {
            let packets = |v: &Value| v["packets"].as_array().expect("packets").clone();
            assert_eq!((&a["index"], &a["length"], packets(a).len()), (&b["index"], &b["length"], packets(&b).len()));
            for (a, b) in packets(a).iter().zip(packets(&b)) {
                let fields = b["fields"].as_object().expect("fields");
                assert_eq!(a["fields"].as_object().map(|f| f.len()), Some(fields.len()), "{}: {a}", capture.name);
                for (name, value) in fields {
                    assert_eq!(&a["fields"][name], value, "{}: {name} of {}", capture.name, b["name"]);
                    values += 1;
                }
                for key in ["offset", "id", "size", "name"] {
                    assert_eq!(a[key], b[key], "{}: {b}", capture.name);
                }
            }
        }
        // Not only the values: the same text.
        let from_datagrams = |text: &str| text[text.find(" \"datagrams\"").expect("datagrams")..].trim_end().to_owned();
        assert_eq!(from_datagrams(&ours.json), from_datagrams(&capture.json), "{}", capture.name);
    }
    assert!(values > 6000, "{values} values");
}

/// Writes each packet of a capture again, and returns the datagrams.
fn written(capture: &Capture) -> Vec<Vec<u8>> {
    let rewrite = |bytes: &&[u8]| {
        let message = Message::open(bytes).expect("a message");
        let mut writer = Writer::new(message.version, message.order);
        for placed in message.packets() {
            let packet = placed.expect("a packet").packet.expect("a known one");
            writer.push(packet).expect("room");
        }
        writer.bytes().to_vec()
    };
    datagrams(&capture.bytes).expect("whole datagrams").iter().map(rewrite).collect()
}

#[test]
fn packets_are_written_as_they_were_but_for_reserved_bits() {
    let captures = captures();
    let mut bytes_seen = 0;
    for capture in &captures {
        let name = &capture.name;
        for (old, new) in datagrams(&capture.bytes).expect("whole datagrams").iter().zip(written(capture)) {
            assert_eq!(old.len(), new.len(), "{name}");
            let message = Message::open(old).expect("a message");
            for placed in message.packets().map(|placed| placed.expect("a packet")) {
                let packet = placed.packet.expect("a known one");
                let mask = named_bits(&packet, message.version.family(), placed.bytes.len());
                let is_sea = packet.layout().name.starts_with("Maritime Surface Conditions Control");
                for (i, mask) in mask.iter().enumerate() {
                    let (was, is) = (placed.bytes[i], new[placed.offset + i]);
                    // The library's own place of a sea's number is the subject of the next test.
                    let is_early = is_sea && message.version == Version::V4_0 && (5..8).contains(&i);
                    assert!(is_early || was & mask == is & mask, "{name}: byte {i} of {}: {was} {is}", placed.id);
                    assert_eq!(is & !mask, 0, "{name}: byte {i} of {} is reserved", placed.id);
                    bytes_seen += 1;
                }
            }
        }
    }
    assert!(bytes_seen > 15_000, "{bytes_seen} bytes");
}

#[test]
fn the_number_of_a_regional_sea_is_written_at_byte_6() {
    let captures = captures();
    let moved: Vec<&Capture> = captures.iter().filter(|capture| capture.name.ends_with("-moved-id")).collect();
    assert_eq!(moved.len(), 4);
    for capture in moved {
        for (old, new) in datagrams(&capture.bytes).expect("whole datagrams").iter().zip(written(capture)) {
            let message = Message::open(old).expect("a message");
            for placed in message.packets().map(|placed| placed.expect("a packet")).filter(|placed| placed.id == 0x0c) {
                assert_eq!(placed.bytes, &new[placed.offset..placed.offset + 24], "{}", capture.name);
            }
        }
    }
    // Without the kind reading, the number is what stands at byte 6.
    let early = captures.iter().find(|c| c.name == "08-sea-state-5.v40-be").expect("the capture");
    let plain = parsed(&decoded(early, Form { reads_early_ids: false, ..FORM }).json);
    let sea = &plain["datagrams"][2]["packets"][1]["fields"];
    assert_eq!((&sea["entity_or_region_id"], sea.get("entity_or_region_id_at_byte_6")), (&Value::from(768), None));
}

#[test]
fn all_fields_are_printed_where_they_are_asked_for() {
    for capture in captures() {
        let all = parsed(&decoded(&capture, Form { has_all_fields: true, ..FORM }).json);
        let first = &all["datagrams"][0]["packets"][0]["fields"];
        let is_old = all["cigi"] == "3.3";
        assert_eq!(first.get("byte_swap").is_some(), is_old, "{}", capture.name);
        if is_old {
            assert_eq!(first["byte_swap"], 0x8000, "{}", capture.name);
        }
    }
}

#[test]
fn first_packets_of_older_versions_are_read_and_written() {
    let v3_0 = [1, 0x10, 3, 0, 5, 0, 0, 0x80, 4, 3, 2, 1, 0x14, 0x13, 0x12, 0x11];
    let mut v3_2 = [0; 24];
    v3_2[..20].copy_from_slice(&[
        1, 0x18, 3, 0, 0x25, 0, 0, 0x80, 4, 3, 2, 1, 0x14, 0x13, 0x12, 0x11, 0x24, 0x23, 0x22, 0x21,
    ]);
    for (bytes, version, echo) in [(&v3_0[..], Version::V3_0, 0), (&v3_2, Version::V3_2, 0x2122_2324)] {
        let message = Message::open(bytes).expect("a message");
        assert_eq!((message.version, message.order), (version, Order::Little));
        let placed = message.packets().next().expect("a packet").expect("a good one");
        let Some(welkin_cigi_host::wire::Packet::IgControl(first)) = placed.packet else { panic!("{placed:?}") };
        assert_eq!((first.host_frame_number, first.timestamp_10us), (0x0102_0304, 0x1112_1314));
        assert_eq!(first.last_ig_frame_number, echo);
        let mut writer = Writer::new(version, Order::Little);
        writer.push(first).expect("room");
        assert_eq!(writer.bytes(), bytes);
    }
}

#[test]
fn what_is_wrong_with_a_datagram_is_named() {
    let good = [1u8, 0x18, 3, 0, 0x31, 0, 0, 0x80, 4, 3, 2, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];
    let with = |change: &dyn Fn(&mut Vec<u8>)| {
        let mut bytes = good.to_vec();
        change(&mut bytes);
        match Message::open(&bytes) {
            Ok(message) => message.packets().filter_map(Result::err).map(|fault| fault.to_string()).collect::<Vec<_>>(),
            Err(fault) => vec![fault.to_string()],
        }
    };
    assert!(with(&|_| {}).is_empty());
    let cases: [(&dyn Fn(&mut Vec<u8>), &[&str]); 10] = [
        (&|b| b.truncate(15), &["datagram of 15 bytes"]),
        (&|b| b[2] = 9, &["must be IG Control or Start of Frame"]),
        (&|b| b[0] = 2, &["must be IG Control or Start of Frame"]),
        (&|b| b[6] = 1, &["byte swap magic: must be 0x8000", "0x8001"]),
        (&|b| b[1] = 32, &["packet at byte 0", "32 bytes"]),
        (&|b| b[1] = 0, &["packet at byte 0", "size of 0"]),
        (&|b| b[1] = 16, &["IG Control: size must be a multiple of 8 and at least 24 bytes, got 16"]),
        (
            &|b| b.extend([12, 48].iter().chain(&[0; 46])),
            &["Weather Control: size must be", "at least 56 bytes, got 48"],
        ),
        (&|b| b.extend([200, 9].iter().chain(&[0; 7])), &["Unknown packet: size must be a multiple of 8", "got 9"]),
        (&|b| b.extend(good), &["IG Control: does not belong at this place"]),
    ];
    for (change, named) in cases {
        let faults = with(change);
        assert!(named.iter().all(|name| faults.iter().any(|fault| fault.contains(name))), "{named:?}: {faults:?}");
    }
    // Longer than the table: the known part is read.
    assert!(with(&|b| b.extend([15, 16].iter().chain(&[0; 14]))).is_empty());
    let mut writer = Writer::new(Version::V3_3, Order::Little);
    let position = welkin_cigi_host::wire::EntityPosition::default();
    assert_eq!(writer.push(position), Err(Fault::NoForm { name: "Entity Position" }));
    let mut count = 0;
    let full = loop {
        match writer.push(welkin_cigi_host::wire::WaveControl::default()) {
            Ok(()) => count += 1,
            Err(fault) => break fault,
        }
    };
    assert_eq!((full, count), (Fault::Full, MAX_DATAGRAM / 32));
}

#[test]
fn a_number_written_a_byte_early_is_recognised_by_the_numbers_in_use() {
    let sea = MaritimeSurfaceConditionsControl { scope: 1, ..Default::default() };
    // What a sender writes for a number too early or in its place, and the number that is meant where these are named.
    let meant = |order: Order, number: u16, is_early: bool, named: &[u16]| {
        let mut bytes = [0u8; 24];
        let place = if is_early { 5 } else { 6 };
        Slot::U16(place).write(&mut bytes, order, number.into());
        let stated = Slot::U16(6).read(&bytes, order) as u16;
        let sea = MaritimeSurfaceConditionsControl { entity_or_region_id: stated, ..sea };
        maritime::meant_id(&sea, &bytes, Version::V4_0, order, |id| named.contains(&id))
    };
    for number in [1u16, 3, 255, 256, 300, 768, 0xff00, 0xffff] {
        for order in [Order::Little, Order::Big] {
            for is_early in [false, true] {
                assert_eq!(meant(order, number, is_early, &[number]), number, "{order:?} {is_early}");
            }
        }
        // Nothing named yet: what stands in its place is right but for multiples of 256 of a big-endian sender.
        let is_sure = !number.is_multiple_of(256);
        assert!(!is_sure || meant(Order::Big, number, false, &[]) == number);
        assert_eq!(meant(Order::Little, number, false, &[]), number);
        assert_eq!(meant(Order::Big, number, true, &[]), number);
    }
}
