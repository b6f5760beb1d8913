//! Captures: files of datagrams, and their packets as JSON.
//!
//! A capture has for each datagram its length as a little-endian 32-bit number, then its bytes.

use std::collections::BTreeSet;
use std::fmt::{self, Write as _};

use crate::json;
use crate::wire::{Direction, Family, Fault, Message, Order, Packet, Placed, Value, maritime};

/// Reason for refusing a capture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Truncated {
    /// Where the datagram's length stands, bytes.
    offset: usize,
    /// Bytes that follow the length.
    left: usize,
    /// Length that the file states; `None` if it ends inside of the number.
    length: Option<u32>,
}

impl fmt::Display for Truncated {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { offset, left, length } = self;
        match length {
            Some(length) => write!(f, "byte {offset}: a datagram of {length} bytes, but only {left} follow"),
            None => write!(f, "byte {offset}: the file ends inside of a datagram's length"),
        }
    }
}

impl std::error::Error for Truncated {}

/// Returns the datagrams of a capture.
///
/// # Errors
/// [`Truncated`] if the file ends inside of a datagram.
pub fn datagrams(file: &[u8]) -> Result<Vec<&[u8]>, Truncated> {
    let mut found = Vec::new();
    let mut rest = file;
    while !rest.is_empty() {
        let offset = file.len() - rest.len();
        let Some((length, after)) = rest.split_first_chunk() else {
            return Err(Truncated { offset, left: 0, length: None });
        };
        let length = u32::from_le_bytes(*length);
        let Some((datagram, after)) = after.split_at_checked(length as usize) else {
            return Err(Truncated { offset, left: after.len(), length: Some(length) });
        };
        found.push(datagram);
        rest = after;
    }
    Ok(found)
}

/// How to print a capture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Form {
    /// Whether to print the fields too that the captures' JSON leaves out.
    pub has_all_fields: bool,
    /// Whether to find the identifiers that the class library 4.0 writes one byte too early ([`maritime`]).
    pub reads_early_ids: bool,
}

/// Packets of a capture as JSON, and how many packets or datagrams were refused.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Decoded {
    /// The JSON.
    pub json: String,
    /// Number of refused packets.
    pub refused: usize,
}

/// Objects that the packets so far have named, by which early identifiers are recognised.
#[derive(Default)]
struct Named {
    regions: BTreeSet<u16>,
    entities: BTreeSet<u16>,
}

impl Named {
    fn note(&mut self, packet: &Packet) {
        match packet {
            Packet::EnvironmentalRegionControl(region) => self.regions.insert(region.region_id),
            Packet::EntityControl(entity) => self.entities.insert(entity.entity_id),
            _ => false,
        };
    }

    fn has(&self, scope: u8, id: u16) -> bool {
        match scope {
            1 => self.regions.contains(&id),
            2 => self.entities.contains(&id),
            _ => true,
        }
    }
}

/// Prints datagrams as JSON.
pub fn decode(datagrams: &[&[u8]], form: Form) -> Decoded {
    let mut named = Named::default();
    let mut out = Decoded { json: String::from("{"), refused: 0 };
    if let Some(first) = datagrams.iter().find_map(|bytes| Message::open(bytes).ok()) {
        let order = if first.order == Order::Little { "little" } else { "big" };
        let direction = if first.direction == Direction::ToIg { "host_to_ig" } else { "ig_to_host" };
        let version = first.version;
        let _ = write!(
            out.json,
            "\"cigi\": \"{version}\", \"byte_order\": \"{order}\", \"direction\": \"{direction}\",\n "
        );
    }
    out.json.push_str("\"datagrams\": [");
    for (index, bytes) in datagrams.iter().enumerate() {
        let comma = if index == 0 { "" } else { "," };
        let _ = write!(out.json, "{comma}\n  {{\"index\": {index}, \"length\": {}, \"packets\": [", bytes.len());
        match Message::open(bytes) {
            Ok(message) => out.packets(&message, &mut named, form),
            Err(fault) => out.refuse(fault, true),
        }
        out.json.push_str("]}");
    }
    out.json.push_str("]}\n");
    out
}

impl Decoded {
    fn refuse(&mut self, fault: Fault, is_first: bool) {
        let comma = if is_first { "" } else { "," };
        let _ = write!(self.json, "{comma}\n    {{\"refused\": {}}}", json::text(&fault.to_string()));
        self.refused += 1;
    }

    fn packets(&mut self, message: &Message<'_>, named: &mut Named, form: Form) {
        for (i, placed) in message.packets().enumerate() {
            match placed {
                Ok(placed) => {
                    self.json.push_str(if i == 0 { "\n    " } else { ",\n    " });
                    self.json.push_str(&packet_json(message, &placed, named, form));
                }
                Err(fault) => self.refuse(fault, i == 0),
            }
        }
    }
}

fn packet_json(message: &Message<'_>, placed: &Placed<'_>, named: &mut Named, form: Form) -> String {
    let family = message.version.family();
    let name =
        placed.packet.map_or_else(|| Packet::other_name(family, placed.id), |packet| packet.layout().name_in(family));
    let (offset, id, size) = (placed.offset, placed.id, placed.bytes.len());
    let mut out =
        format!("{{\"offset\": {offset}, \"id\": {id}, \"size\": {size}, \"name\": \"{name}\", \"fields\": {{");
    let mut fields: Vec<String> = Vec::new();
    let mut add = |name: &str, value: Value| fields.push(format!("\"{name}\": {}", json::value(value)));
    if let Some(packet) = placed.packet {
        named.note(&packet);
        let early = match packet {
            Packet::MaritimeSurfaceConditionsControl(sea) if form.reads_early_ids && family == Family::V4 => {
                let is_known = |id| named.has(sea.scope, id);
                Some((sea, maritime::meant_id(&sea, placed.bytes, message.version, message.order, is_known)))
            }
            _ => None,
        };
        packet.visit(family, &mut |field, value| {
            if !form.has_all_fields && !field.is_listed(family) {
                return;
            }
            match early {
                Some((_, id)) if field.name == "entity_or_region_id" => add(field.name, Value::Int(id.into())),
                _ => add(field.name, value),
            }
        });
        if let Some((sea, _)) = early {
            add("entity_or_region_id_at_byte_6", Value::Int(sea.entity_or_region_id.into()));
        }
    }
    out.push_str(&fields.join(", "));
    out.push_str("}}");
    out
}
