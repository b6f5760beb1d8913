//! The thread's last failed call of the C interface: its message, and whether the field it names exists in the header.

use std::{
    collections::BTreeSet,
    ffi::{CStr, c_char},
    sync::LazyLock,
};

use welkin::capi::{abi, status::*};

/// Names that a host finds in the header: structs, fields and function parameters.
pub static PUBLIC: LazyLock<BTreeSet<&'static str>> = LazyLock::new(|| {
    let structs = abi::structs();
    let mut names: BTreeSet<&'static str> = structs.iter().map(|s| s.0).collect();
    names.extend(structs.into_iter().flat_map(|s| s.3.into_iter().map(|f| f.0)));
    for call in abi::HEADER.split("WK_API").skip(1) {
        let parameters = call.split(';').next().and_then(|call| call.split_once('(')).map_or("", |call| call.1);
        let words = |p: &'static str| p.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
        let is_name = |w: &&str| w.starts_with(|c: char| c.is_ascii_alphabetic());
        names.extend(parameters.split(',').filter_map(|p| words(p).rfind(is_name)));
    }
    names
});

fn text(get: extern "C" fn() -> *const c_char) -> String {
    // SAFETY: the functions promise a string.
    unsafe { CStr::from_ptr(get()) }.to_string_lossy().into_owned()
}

/// The calling thread's last message.
pub fn message() -> String {
    text(wk_last_error_message)
}

/// The field of the calling thread's last failed call.
pub fn field() -> String {
    text(wk_last_error_field)
}

/// The error in the field of the calling thread's last failed call, if any.
pub fn field_fault() -> Option<String> {
    let (field, message) = (field(), message());
    if field.is_empty() {
        let needed = abi::last_status() == WK_ERROR_INVALID_ARGUMENT;
        return needed.then(|| format!("no field: {message:?}"));
    }
    if !message.contains(&field) {
        return Some(format!("{field:?} is not in {message:?}"));
    }
    let mut names = field.split('.').map(|part| part.split('[').next().unwrap_or_default());
    names
        .find(|name| !PUBLIC.contains(name))
        .map(|name| format!("{name:?} of {field:?} is not in the header: {message:?}"))
}
