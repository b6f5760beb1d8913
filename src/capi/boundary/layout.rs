//! Reading and writing of the header's structs, in the sizes of this and other versions and with extension chains.
//! Errors name every field as the header does.
//!
//! `build.rs` writes the tables of fields from the struct definitions, so no new field is forgotten: floats must be
//! finite, enumerations known, reserved fields zero.

use std::{ffi::c_void, fmt::Display};

use super::{call::guard, numbers::*};
use crate::error::{Error, Result, Status, listed};

/// Type of a field.
#[derive(Clone, Copy, Debug)]
#[allow(dead_code, reason = "the kinds that this version's structs do not use yet")]
pub(crate) enum FieldKind {
    U8,
    U16,
    U32,
    I32,
    U64,
    I64,
    F32,
    F64,
    Pointer,
    Enum(&'static EnumInfo),
    Struct(&'static StructInfo),
}

/// A field as the header declares it; `count` elements of `kind`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LayoutField {
    pub name: &'static str,
    /// Offset in the struct, bytes.
    pub offset: usize,
    pub kind: FieldKind,
    pub count: usize,
    /// Range that the field's documentation states, such as `[0, 1]`; empty if it states none.
    pub range: &'static str,
}

/// A struct as the header declares it.
#[derive(Debug)]
pub(crate) struct StructInfo {
    pub name: &'static str,
    pub size: usize,
    pub align: usize,
    /// Whether there is a `WK_X_INIT`; structs without struct_size, which are elements of arrays, have none.
    pub has_init: bool,
    pub fields: &'static [LayoutField],
}

/// An integer type with named values. If `flags` is set, any union of the values is accepted.
#[derive(Debug)]
pub(crate) struct EnumInfo {
    #[allow(dead_code, reason = "for those who debug, and the tests")]
    pub name: &'static str,
    pub flags: bool,
    /// Whether the type has 8 bytes, not 4.
    pub wide: bool,
    pub values: &'static [(&'static str, u64)],
}

/// A `repr(C)` struct of the header that begins with `struct_size`, `struct_type` and `next`, or is embedded in such a
/// struct.
///
/// # Safety
/// `INFO` describes `Self` correctly, `Self` has no implicit padding, and every bit pattern is a valid `Self`.
pub(crate) unsafe trait Layout: Copy + 'static {
    const INFO: &'static StructInfo;
    /// Struct with every field at its default.
    const DEFAULT: Self;
}

/// First fields of every tagged struct.
#[repr(C)]
#[derive(Clone, Copy)]
pub(crate) struct Head {
    pub struct_size: u32,
    pub struct_type: u32,
    pub next: *const c_void,
}

/// Largest size of a struct, bytes: a larger one is a mistake, not a future version.
const MAX_STRUCT_BYTES: usize = 64 * 1024;

#[allow(dead_code, clippy::all, clippy::undocumented_unsafe_blocks, reason = "written by build.rs")]
mod table {
    use super::*;
    include!(concat!(env!("OUT_DIR"), "/abi_table.rs"));
}
pub(crate) use table::*;

/// Returns `sizeof` as a `u32`, the type of `struct_size`.
pub(crate) const fn struct_size<T>() -> u32 {
    size_of::<T>() as u32
}

impl FieldKind {
    /// Returns the size of one element, bytes.
    pub(crate) fn size(self) -> usize {
        match self {
            Self::U8 => 1,
            Self::U16 => 2,
            Self::U32 | Self::I32 | Self::F32 | Self::Enum(EnumInfo { wide: false, .. }) => 4,
            Self::U64 | Self::I64 | Self::F64 | Self::Enum(_) => 8,
            Self::Pointer => size_of::<usize>(),
            Self::Struct(info) => info.size,
        }
    }
}

impl EnumInfo {
    /// Fails unless `value` is a named constant or, for flags, a union of named ones.
    pub(crate) fn check(&self, param: &dyn Display, value: u64) -> Result<()> {
        let known = if self.flags {
            value & !self.values.iter().fold(0, |all, v| all | v.1) == 0
        } else {
            self.values.iter().any(|v| v.1 == value)
        };
        if known {
            return Ok(());
        }
        let names = listed(&self.values.iter().map(|v| v.0).collect::<Vec<_>>());
        let rule = if self.flags { "a union of" } else { "one of" };
        let got = if self.flags { format!("{value:#x}") } else { value.to_string() };
        Err(Error::range(&param.to_string(), &format!("{rule} {names}"), got))
    }
}

/// Checks every field of the struct at `base` that lies within `upto`, the number of bytes that the caller gave.
///
/// # Safety
/// `base` points to `info.size` readable bytes.
unsafe fn check_fields(param: &dyn Display, base: *const u8, info: &'static StructInfo, upto: usize) -> Result<()> {
    for field in info.fields.iter().filter(|f| f.offset < upto) {
        for i in 0..field.count {
            // SAFETY: the table's offsets lie inside the struct.
            let element = unsafe { base.add(field.offset + i * field.kind.size()) };
            let name = FieldPath { param, field: field.name, index: (field.count > 1).then_some(i) };
            // SAFETY: as above, and reads are unaligned.
            unsafe { check_element(&name, element, field)? };
        }
    }
    Ok(())
}

/// Checks one element of a field.
///
/// # Safety
/// `element` points to an element of `field`'s kind.
unsafe fn check_element(name: &FieldPath<'_>, element: *const u8, field: &LayoutField) -> Result<()> {
    let float = match field.kind {
        // SAFETY: the caller's promise.
        FieldKind::F32 => f64::from(unsafe { element.cast::<f32>().read_unaligned() }),
        // SAFETY: the caller's promise.
        FieldKind::F64 => unsafe { element.cast::<f64>().read_unaligned() },
        // SAFETY: the caller's promise; the width is the type's.
        FieldKind::Enum(info) if info.wide => {
            return info.check(name, unsafe { element.cast::<u64>().read_unaligned() });
        }
        // SAFETY: as above.
        FieldKind::Enum(info) => return info.check(name, unsafe { element.cast::<u32>().read_unaligned() }.into()),
        // SAFETY: the caller's promise.
        FieldKind::Struct(info) => return unsafe { check_fields(name, element, info, info.size) },
        FieldKind::U32 if field.name.starts_with("reserved") => {
            // SAFETY: the caller's promise.
            let value = unsafe { element.cast::<u32>().read_unaligned() };
            return if value == 0 { Ok(()) } else { Err(Error::range(&name.to_string(), "0", value)) };
        }
        _ => return Ok(()),
    };
    if float.is_finite() {
        return Ok(());
    }
    let accepted = if field.range.is_empty() { "finite".into() } else { format!("finite and in {}", field.range) };
    Err(Error::range(&name.to_string(), &accepted, float))
}

/// Path of an element, as `frame.camera.position_m[2]`, formatted only when an error needs it.
struct FieldPath<'a> {
    param: &'a dyn Display,
    field: &'static str,
    index: Option<usize>,
}

impl Display for FieldPath<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}.{}", self.param, self.field)?;
        self.index.map_or(Ok(()), |i| write!(f, "[{i}]"))
    }
}

/// Fails if `p` cannot be read or written as a `T`: if it is NULL or misaligned.
pub(crate) fn check_pointer<T>(param: &dyn Display, p: *const T) -> Result<()> {
    if p.is_null() {
        return Err(Error::invalid(param.to_string(), "must not be NULL"));
    }
    if !p.is_aligned() {
        let align = align_of::<T>();
        return Err(Error::range(&param.to_string(), &format!("aligned to {align} bytes"), format_args!("{p:p}")));
    }
    Ok(())
}

/// Checks the pointer to an answer that may be NULL.
///
/// # Errors
/// If it is misaligned. A call checks all its pointers before it writes anything.
pub(in crate::capi) fn optional_out<T>(param: &dyn Display, p: *mut T) -> Result<Option<*mut T>> {
    if p.is_null() {
        return Ok(None);
    }
    check_pointer(param, p)?;
    Ok(Some(p))
}

/// Checks the head of a struct at `p` and returns the number of bytes that the caller gave.
///
/// # Safety
/// `p` is NULL or points to `struct_size` readable bytes.
unsafe fn head<T: Layout>(param: &dyn Display, p: *const T) -> Result<usize> {
    check_pointer(param, p)?;
    // SAFETY: every tagged struct begins with its size; the alignment was checked.
    let size = unsafe { p.cast::<u32>().read() } as usize;
    // SAFETY: `size` bytes are the caller's promise.
    unsafe { check_size(param, p.cast(), size, T::INFO)? };
    // SAFETY: `size` was found to hold the head.
    let found = unsafe { (*p.cast::<Head>()).struct_type };
    let wanted = expected_type::<T>();
    if found != wanted {
        let name = |t: u32| WK_STRUCT_TYPE.values.iter().find(|v| v.1 == u64::from(t)).map_or("no known type", |v| v.0);
        let accepted = format!("{} (start from {}_INIT)", name(wanted), T::INFO.name.to_uppercase());
        return Err(Error::range(&format!("{param}.struct_type"), &accepted, format!("{found} ({})", name(found))));
    }
    Ok(size)
}

/// Returns the first fields of a tagged struct.
pub(crate) fn head_of<T: Layout>(value: &T) -> Head {
    // SAFETY: every tagged struct begins with a head.
    unsafe { *std::ptr::from_ref(value).cast::<Head>() }
}

/// Returns the `struct_type` of a tagged struct.
fn expected_type<T: Layout>() -> u32 {
    head_of(&T::DEFAULT).struct_type
}

/// Checks a struct's size: the struct must end where a field of this version ends, or be larger with only zeros beyond
/// the fields of this version.
///
/// # Safety
/// `p` points to `size` readable bytes.
unsafe fn check_size(param: &dyn Display, p: *const u8, size: usize, info: &StructInfo) -> Result<()> {
    let ends = |f: &LayoutField| f.offset + f.count * f.kind.size();
    let refuse = |got: usize| {
        let accepted =
            format!("sizeof({}), which is {} (start from {}_INIT)", info.name, info.size, info.name.to_uppercase());
        Err(Error::range(&format!("{param}.struct_size"), &accepted, got))
    };
    let later = size > info.size && !size.is_multiple_of(info.align);
    if size < size_of::<Head>() || size > MAX_STRUCT_BYTES || later {
        return refuse(size);
    }
    if size <= info.size {
        return if info.fields.iter().any(|f| ends(f) == size) { Ok(()) } else { refuse(size) };
    }
    // SAFETY: the caller promises `size` bytes.
    let tail = unsafe { std::slice::from_raw_parts(p.add(info.size), size - info.size) };
    match tail.iter().position(|&b| b != 0) {
        None => Ok(()),
        Some(i) => {
            let rest = format!(
                "has a field beyond the {} bytes that this version of {} knows, and it is not 0 (byte {})",
                info.size,
                info.name,
                info.size + i
            );
            Err(Error::about(Status::Unsupported, param.to_string(), rest))
        }
    }
}

/// Reads a struct of this or another version. Fields that the caller's version lacks get their defaults; the others are
/// checked, and an error names the field.
///
/// # Safety
/// `p` is NULL or points to `struct_size` readable bytes.
pub(crate) unsafe fn read<T: Layout>(param: &dyn Display, p: *const T) -> Result<T> {
    // SAFETY: the caller's promise.
    let size = unsafe { head(param, p)? };
    let mut value = T::DEFAULT;
    let known = size.min(size_of::<T>());
    // SAFETY: `known` bytes are readable and fit; every bit pattern is a `T`.
    unsafe { std::ptr::copy_nonoverlapping(p.cast::<u8>(), (&raw mut value).cast::<u8>(), known) };
    // SAFETY: `value` is a whole `T`.
    unsafe { check_fields(param, (&raw const value).cast(), T::INFO, known)? };
    Ok(value)
}

/// Reads a struct as [`read`] does; NULL gives every default.
///
/// # Safety
/// As [`read`].
pub(crate) unsafe fn read_or_default<T: Layout>(param: &dyn Display, p: *const T) -> Result<T> {
    // SAFETY: the caller's promise.
    if p.is_null() { Ok(T::DEFAULT) } else { unsafe { read(param, p) } }
}

/// Walks an extension chain: every link must be one of `known`, each at most once.
///
/// # Safety
/// Every link is NULL or points to a struct that begins with a head.
pub(crate) unsafe fn check_chain(param: &dyn Display, first: *const c_void, known: &[wk_struct_type]) -> Result<()> {
    let mut link = first;
    let mut seen = [false; 32];
    // A cycle ends at its second visit of a struct.
    while !link.is_null() {
        check_pointer(&format!("{param}.next"), link.cast::<Head>())?;
        // SAFETY: not NULL, aligned, and the caller's promise.
        let head = unsafe { *link.cast::<Head>() };
        let Some(i) = known.iter().position(|&t| t == head.struct_type) else {
            let rest = format!("holds an extension of type {} that this call does not take", head.struct_type);
            return Err(Error::about(Status::Unsupported, format!("{param}.next"), rest));
        };
        if std::mem::replace(&mut seen[i], true) {
            let rest = format!("holds two extensions of type {}", head.struct_type);
            return Err(Error::invalid(format!("{param}.next"), rest));
        }
        link = head.next;
    }
    Ok(())
}

/// Reads the extension of type `T` from a checked chain, if the chain has it.
///
/// # Safety
/// As [`check_chain`], which has accepted the chain.
pub(crate) unsafe fn extension<T: Layout>(first: *const c_void) -> Result<Option<T>> {
    let mut link = first;
    while !link.is_null() {
        // SAFETY: the chain was checked.
        let head = unsafe { *link.cast::<Head>() };
        if head.struct_type == expected_type::<T>() {
            // SAFETY: the link's type says that the link is a `T`.
            return unsafe { read(&T::INFO.name, link.cast::<T>()) }.map(Some);
        }
        link = head.next;
    }
    Ok(None)
}

/// A checked struct for an answer; nothing is written before [`OutStruct::set`].
pub(crate) struct OutStruct<T: Layout> {
    at: *mut T,
    size: usize,
}

/// Checks the caller's struct for an answer: its size and type, and that it has no extension.
///
/// # Safety
/// `p` is NULL or points to `struct_size` writable bytes.
pub(crate) unsafe fn out_struct<T: Layout>(param: &dyn Display, p: *mut T) -> Result<OutStruct<T>> {
    // SAFETY: the caller's promise.
    let size = unsafe { head(param, p)? };
    // SAFETY: `head` has found at least a head there.
    let next = unsafe { (*p.cast::<Head>()).next };
    // SAFETY: the caller's promise.
    unsafe { check_chain(param, next, &[])? };
    Ok(OutStruct { at: p, size })
}

impl<T: Layout> OutStruct<T> {
    /// Writes the answer up to the size of the caller's version, and keeps the caller's head.
    pub(crate) fn set(self, value: &T) {
        let skip = size_of::<Head>();
        let known = self.size.min(size_of::<T>());
        let from = std::ptr::from_ref(value).cast::<u8>();
        // SAFETY: `size` writable bytes were promised to `out_struct`; the tail beyond `T` was zero and stays so.
        unsafe { std::ptr::copy_nonoverlapping(from.add(skip), self.at.cast::<u8>().add(skip), known - skip) };
    }
}

/// Fails unless `bytes` is the size of this, an earlier or a later version of `T`.
pub(crate) fn check_version_size<T: Layout>(param: &str, bytes: usize) -> Result<()> {
    let fits = T::INFO.fields.iter().any(|f| f.offset + f.count * f.kind.size() == bytes);
    let later = bytes > size_of::<T>() && bytes <= MAX_STRUCT_BYTES && bytes.is_multiple_of(align_of::<T>());
    if bytes >= size_of::<Head>() && (fits || later) {
        return Ok(());
    }
    Err(Error::range(param, &format!("sizeof({}), which is {}", T::INFO.name, size_of::<T>()), bytes))
}

/// Writes a whole struct in a version of `bytes` bytes: truncated, or with a zero tail.
///
/// # Safety
/// `place` points to `bytes` writable bytes, and `check_version_size` has accepted them.
pub(crate) unsafe fn write_version<T: Layout>(value: &T, place: *mut u8, bytes: usize) {
    let from = std::ptr::from_ref(value).cast::<u8>();
    // SAFETY: the caller's promise; every tagged struct begins with its size.
    unsafe {
        std::ptr::write_bytes(place, 0, bytes);
        std::ptr::copy_nonoverlapping(from, place, bytes.min(size_of::<T>()));
        place.cast::<u32>().write_unaligned(bytes as u32);
    }
}

/// Writes the default of a struct, as every `wk_x_init` does.
///
/// # Safety
/// `place` is NULL or points to `size` writable bytes.
pub(crate) unsafe fn init_struct<T: Layout>(function: &'static str, place: *mut T, size: u32) -> wk_status {
    guard(function, |_| {
        check_pointer(&"out", place)?;
        check_version_size::<T>("struct_size", size as usize)?;
        // SAFETY: the size was checked, and the bytes are the caller's promise.
        unsafe { write_version(&T::DEFAULT, place.cast(), size as usize) };
        Ok(Status::Ok)
    })
}
