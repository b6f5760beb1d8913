//! Numbers in the bytes of a struct.

use welkin::capi::by_name::{NamedField, NamedKind, StructBytes};

/// Place and size of an element, bytes.
fn place(field: &NamedField, element: usize) -> (usize, usize) {
    let size = match field.kind {
        NamedKind::Integer(size) | NamedKind::Float(size) | NamedKind::Choice { bytes: size, .. } => size,
        NamedKind::Pointer | NamedKind::Struct(_) => 0,
    };
    (field.offset + element.min(field.count.saturating_sub(1)) * size, size)
}

/// Returns an element as a whole number; 0 for a pointer or a struct.
pub fn integer(bytes: &[u64], field: &NamedField, element: usize) -> u64 {
    let (at, size) = place(field, element);
    let mut word = [0; 8];
    if let Some(from) = bytemuck::cast_slice::<u64, u8>(bytes).get(at..at + size) {
        word[..size].copy_from_slice(from);
    }
    u64::from_le_bytes(word)
}

/// Writes an element as a whole number, of which the lowest bytes count.
pub fn set_integer(bytes: &mut StructBytes, field: &NamedField, element: usize, value: u64) {
    let (at, size) = place(field, element);
    if let Some(to) = bytemuck::cast_slice_mut::<u64, u8>(bytes).get_mut(at..at + size) {
        to.copy_from_slice(&value.to_le_bytes()[..size]);
    }
}

/// Returns an element as a number.
pub fn number(bytes: &[u64], field: &NamedField, element: usize) -> f64 {
    let word = integer(bytes, field, element);
    match field.kind {
        NamedKind::Float(4) => f64::from(f32::from_bits(word as u32)),
        NamedKind::Float(_) => f64::from_bits(word),
        _ => word as f64,
    }
}

/// Writes an element as a number; whole numbers are rounded and at least 0.
pub fn set_number(bytes: &mut StructBytes, field: &NamedField, element: usize, value: f64) {
    let word = match field.kind {
        NamedKind::Float(4) => u64::from((value as f32).to_bits()),
        NamedKind::Float(_) => value.to_bits(),
        _ => value.round() as u64,
    };
    set_integer(bytes, field, element, word);
}
