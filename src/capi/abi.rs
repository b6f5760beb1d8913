//! Data that the tests of the binary interface compare with C's view and with the committed lists. Not part of the API.

use super::boundary::{
    call,
    layout::{self, FUNCTIONS, FieldKind, STRUCTS},
};

/// The header as it should be committed.
pub const HEADER: &str = include_str!(concat!(env!("OUT_DIR"), "/welkin.h"));

/// Every exported function.
pub fn functions() -> &'static [&'static str] {
    FUNCTIONS
}

/// A field's name, offset and size.
pub type Span = (&'static str, usize, usize);

/// Every struct of the header: name, size, alignment, and its fields' names, offsets and sizes.
pub fn structs() -> Vec<(&'static str, usize, usize, Vec<Span>)> {
    let fields =
        |s: &'static layout::StructInfo| s.fields.iter().map(|f| (f.name, f.offset, f.count * f.kind.size())).collect();
    STRUCTS.iter().map(|s| (s.name, s.size, s.align, fields(s))).collect()
}

/// Whether the header has a `WK_X_INIT` of the struct `name`.
pub fn has_init(name: &str) -> bool {
    STRUCTS.iter().any(|s| s.name == name && s.has_init)
}

/// Calls `wk_x_init` of the struct `name` on `bytes`, which are aligned for any struct.
pub fn init(name: &str, bytes: &mut [u64], struct_size: u32) -> i32 {
    assert!(struct_size as usize <= size_of_val(bytes), "the buffer holds the struct");
    // SAFETY: `bytes` is writable and holds `struct_size` bytes.
    unsafe { layout::init_by_name(name, bytes.as_mut_ptr().cast(), struct_size) }
}

/// Every float of every struct: struct, field, its offset, whether it is 8 bytes wide, element count.
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

/// Status of the calling thread's last failed call, of which wk_last_error_message and wk_last_error_field tell; 0
/// before the first.
pub fn last_status() -> i32 {
    call::last_status()
}

/// The next call of this thread that reaches a device panics there.
pub fn panic_in_next_call() {
    call::inject(call::Injected::Panic);
}

/// The next call of this thread that reaches a device finds it lost, as after a driver's reset.
pub fn lose_in_next_call() {
    call::inject(call::Injected::Loss);
}

/// The next call of this thread that reaches a device logs a message there.
pub fn log_in_next_call() {
    call::inject(call::Injected::Message);
}

/// Every enumeration and every reserved field of every struct: struct, field, offset, whether it is 8 bytes wide.
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

/// Every whole number of every struct but sizes, types and pointers: struct, field, offset, bytes of one, element
/// count.
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
