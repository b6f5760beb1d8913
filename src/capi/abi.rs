//! Tables of the C interface for its tests. The tests compare the tables with those of a C compiler and with the
//! committed lists. Not part of the API.

use super::boundary::{
    call,
    layout::{self, FUNCTIONS, FieldKind, STRUCTS},
};

/// Text of the header, as it should be committed.
pub const HEADER: &str = include_str!(concat!(env!("OUT_DIR"), "/welkin.h"));

/// Returns the names of all exported functions.
pub fn functions() -> &'static [&'static str] {
    FUNCTIONS
}

/// Name of a field, its offset and its size, bytes.
pub type Span = (&'static str, usize, usize);

/// Returns every struct of the header: name, size in bytes, alignment in bytes, and fields.
pub fn structs() -> Vec<(&'static str, usize, usize, Vec<Span>)> {
    let fields =
        |s: &'static layout::StructInfo| s.fields.iter().map(|f| (f.name, f.offset, f.count * f.kind.size())).collect();
    STRUCTS.iter().map(|s| (s.name, s.size, s.align, fields(s))).collect()
}

/// Whether the header has a `WK_X_INIT` for the struct `name`.
pub fn has_init(name: &str) -> bool {
    STRUCTS.iter().any(|s| s.name == name && s.has_init)
}

/// Calls `wk_x_init` of the struct `name` on `bytes`, which are aligned for any struct, and returns the call's status.
pub fn init(name: &str, bytes: &mut [u64], struct_size: u32) -> i32 {
    assert!(struct_size as usize <= size_of_val(bytes), "the buffer holds the struct");
    // SAFETY: `bytes` is writable and holds `struct_size` bytes.
    unsafe { layout::init_by_name(name, bytes.as_mut_ptr().cast(), struct_size) }
}

/// Returns every float of every struct: struct, field, offset in bytes, whether it is 8 bytes wide, and element count.
pub fn floats() -> Vec<(&'static str, &'static str, usize, bool, usize)> {
    let mut found = Vec::new();
    for s in STRUCTS {
        for f in s.fields {
            if matches!(f.kind, FieldKind::F32 | FieldKind::F64) {
                found.push((s.name, f.name, f.offset, matches!(f.kind, FieldKind::F64), f.count));
            }
        }
    }
    found
}

/// Returns the status of the calling thread's last failed call, the one that wk_last_error_message and
/// wk_last_error_field describe; 0 before the first.
pub fn last_status() -> i32 {
    call::last_status()
}

/// Injects a panic into the next call of this thread that reaches a device.
pub fn panic_in_next_call() {
    call::inject(call::Injected::Panic);
}

/// Injects the loss of the device, as after a reset of the driver, into the next call of this thread that reaches a
/// device.
pub fn lose_in_next_call() {
    call::inject(call::Injected::Loss);
}

/// Injects a log message into the next call of this thread that reaches a device.
pub fn log_in_next_call() {
    call::inject(call::Injected::Message);
}

/// Returns every enumeration and every reserved field of every struct, from the struct's fourth field on: struct,
/// field, offset in bytes, and whether the field is 8 bytes wide.
pub fn constants() -> Vec<(&'static str, &'static str, usize, bool)> {
    let mut found = Vec::new();
    for s in STRUCTS {
        for f in s.fields.iter().skip(3) {
            match f.kind {
                FieldKind::Enum(info) => found.push((s.name, f.name, f.offset, info.wide)),
                FieldKind::U32 if f.name.starts_with("reserved") => found.push((s.name, f.name, f.offset, false)),
                _ => {}
            }
        }
    }
    found
}

/// Returns every integer of every struct except sizes, types and pointers: struct, field, offset in bytes, bytes of one
/// element, element count.
pub fn integers() -> Vec<(&'static str, &'static str, usize, usize, usize)> {
    let mut found = Vec::new();
    for s in STRUCTS {
        let tagged = s.fields.first().is_some_and(|f| f.name == "struct_size");
        for f in s.fields.iter().skip(if tagged { 3 } else { 0 }) {
            if !matches!(f.kind, FieldKind::F32 | FieldKind::F64 | FieldKind::Pointer | FieldKind::Struct(_)) {
                found.push((s.name, f.name, f.offset, f.kind.size(), f.count));
            }
        }
    }
    found
}
