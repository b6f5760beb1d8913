//! Checks of parameters other than tagged structs (those that begin with struct_size, struct_type and next): numbers,
//! enumerations, texts, buffers, lists.

use std::ffi::{CStr, c_char, c_void};

use super::{
    layout::{self, EnumInfo, Layout},
    numbers::wk_struct_type,
};
use crate::error::{Error, Result};

/// Largest number of positions or rays in one batch query. It bounds the time of one call.
pub(in crate::capi) const MAX_BATCH: usize = 65_536;

/// Checks a value of an enumeration.
///
/// # Errors
/// [`crate::Status::InvalidArgument`] naming the parameter and every accepted constant.
pub(in crate::capi) fn check_enum(param: &str, info: &EnumInfo, value: u32) -> Result<()> {
    info.check(&param, value.into())
}

/// Checks the pointer to an answer; nothing is written yet.
///
/// # Errors
/// If the pointer is NULL or misaligned.
pub(in crate::capi) fn out<T>(param: &str, p: *mut T) -> Result<*mut T> {
    layout::check_pointer(&param, p)?;
    Ok(p)
}

/// Reads three coordinates in the host's world. Whether they are a valid position is checked by the function that uses
/// them.
///
/// # Safety
/// `p` is NULL or points to three numbers.
///
/// # Errors
/// If `p` is NULL or misaligned.
pub(in crate::capi) unsafe fn position(param: &str, p: *const [f64; 3]) -> Result<[f64; 3]> {
    layout::check_pointer(&param, p)?;
    // SAFETY: checked, and the caller's promise.
    Ok(unsafe { p.read() })
}

/// Reads a NUL-terminated UTF-8 text.
///
/// # Safety
/// `p` is NULL or points to a NUL-terminated string that lives as long as `'a`.
///
/// # Errors
/// If `p` is NULL or the text is not UTF-8; the message names the first wrong byte.
pub(in crate::capi) unsafe fn text<'a>(param: &str, p: *const c_char) -> Result<&'a str> {
    layout::check_pointer(&param, p)?;
    // SAFETY: not NULL, and the caller's promise.
    unsafe { CStr::from_ptr(p) }
        .to_str()
        .map_err(|e| Error::invalid(param, format_args!("must be UTF-8; byte {} is not", e.valid_up_to())))
}

/// Reads a text that may be NULL.
///
/// # Safety
/// As [`text`].
///
/// # Errors
/// If the text is not UTF-8.
pub(in crate::capi) unsafe fn optional_text<'a>(param: &str, p: *const c_char) -> Result<Option<&'a str>> {
    // SAFETY: the caller's promise.
    if p.is_null() { Ok(None) } else { unsafe { text(param, p) }.map(Some) }
}

/// Returns a caller's contiguous array.
///
/// # Safety
/// `p` is NULL or points to `count` values that live as long as `'a`.
///
/// # Errors
/// If there are more values than `limit`, or if `count` is not 0 and `p` is NULL or misaligned.
pub(in crate::capi) unsafe fn slice<'a, T: Copy>(
    param: &str,
    p: *const T,
    count: Named,
    limit: usize,
) -> Result<&'a [T]> {
    let count = count.at_most(limit)?;
    if count == 0 {
        return Ok(&[]);
    }
    layout::check_pointer(&param, p)?;
    // SAFETY: checked, and the caller's promise.
    Ok(unsafe { std::slice::from_raw_parts(p, count) })
}

/// Returns a caller's contiguous array for answers, checked as [`slice`] does.
///
/// # Safety
/// `p` is NULL or points to `count` values that only this call touches while `'a` lasts.
///
/// # Errors
/// As [`slice`].
pub(in crate::capi) unsafe fn slice_mut<'a, T: Copy>(
    param: &str,
    p: *mut T,
    count: Named,
    limit: usize,
) -> Result<&'a mut [T]> {
    let count = count.at_most(limit)?;
    if count == 0 {
        return Ok(&mut []);
    }
    layout::check_pointer(&param, p)?;
    // SAFETY: checked, and the caller's promise.
    Ok(unsafe { std::slice::from_raw_parts_mut(p, count) })
}

/// Writes a state's bytes into the caller's buffer. `*out_size` gets their number, also if the buffer is too small;
/// with `capacity` 0 nothing else is written.
///
/// # Safety
/// `buffer` is NULL or has `capacity` bytes, `out_size` is NULL or writable; no one else uses either during the call.
///
/// # Errors
/// If `out_size` is NULL or misaligned, if `capacity` is not 0 and `buffer` is NULL, or if the buffer is too small.
pub(in crate::capi) unsafe fn answer_bytes(
    bytes: &[u8],
    buffer: *mut c_void,
    capacity: usize,
    out_size: *mut usize,
) -> Result<()> {
    let place = out("out_size", out_size)?;
    // SAFETY: the caller's promise.
    let room = unsafe { slice_mut("buffer", buffer.cast::<u8>(), Named("capacity", capacity), usize::MAX)? };
    // SAFETY: `place` was checked and is the caller's.
    unsafe { place.write(bytes.len()) };
    if capacity == 0 {
        return Ok(());
    }
    let Some(room) = room.get_mut(..bytes.len()) else {
        return Err(Error::range("capacity", &format!("at least {}", bytes.len()), capacity));
    };
    room.copy_from_slice(bytes);
    Ok(())
}

/// Name of a parameter in the header, and its value.
#[derive(Clone, Copy)]
pub(in crate::capi) struct Named<'a>(pub(in crate::capi) &'a str, pub(in crate::capi) usize);

impl Named<'_> {
    fn at_most(self, limit: usize) -> Result<usize> {
        if self.1 <= limit {
            return Ok(self.1);
        }
        Err(Error::range(self.0, &format!("at most {limit}"), self.1))
    }
}

/// A caller's list of structs.
pub(in crate::capi) struct List<'a> {
    pub(in crate::capi) name: &'a str,
    pub(in crate::capi) count: Named<'a>,
    /// Distance from one element to the next, bytes.
    pub(in crate::capi) stride: Named<'a>,
    /// Largest number of elements.
    pub(in crate::capi) limit: usize,
}

impl<'a> List<'a> {
    /// Builds the list of a function that has the parameters `name`, `count` and `stride`.
    pub(in crate::capi) fn parameters(name: &'a str, count: u32, stride: u32, limit: usize) -> Self {
        Self { name, count: Named("count", count as usize), stride: Named("stride", stride as usize), limit }
    }
}

/// Parameters of a caller's array of structs without struct_size: its first element, the number of elements, and the
/// distance from one to the next, bytes.
pub(in crate::capi) struct ListParameters<T> {
    pub(in crate::capi) first: *const T,
    pub(in crate::capi) count: u32,
    pub(in crate::capi) size: u32,
}

/// A caller's array to read, of structs without struct_size that lie `size` bytes apart.
pub(in crate::capi) struct Places<T> {
    first: *const T,
    size: usize,
}

impl<T: Copy> Places<T> {
    /// Checks the parameters of the array.
    ///
    /// # Errors
    /// If there are more elements than `limit`, the pointer is NULL or misaligned, or the size does not fit.
    pub(in crate::capi) fn new(
        param: &str,
        size_name: &str,
        first: *const T,
        count: u32,
        size: u32,
        limit: usize,
    ) -> Result<Self> {
        Named("count", count as usize).at_most(limit)?;
        if count > 0 {
            layout::check_pointer(&param, first)?;
            check_element_size::<T>(size_name, size)?;
        }
        Ok(Self { first, size: size as usize })
    }

    /// Returns a pointer to element `i`, which must exist.
    pub(in crate::capi) fn at(&self, i: usize) -> *const T {
        self.first.wrapping_byte_add(i * self.size)
    }
}

/// A caller's array to fill, of structs without struct_size that lie `size` bytes apart.
pub(in crate::capi) struct Room<T> {
    first: *mut T,
    capacity: usize,
    size: usize,
}

impl<T: Copy> Room<T> {
    /// Checks the parameters of the array.
    ///
    /// # Errors
    /// If the pointer is NULL or misaligned, or the size does not fit.
    pub(in crate::capi) fn new(param: &str, size_name: &str, first: *mut T, capacity: u32, size: u32) -> Result<Self> {
        if capacity > 0 {
            layout::check_pointer(&param, first.cast_const())?;
            check_element_size::<T>(size_name, size)?;
        }
        Ok(Self { first, capacity: capacity as usize, size: size as usize })
    }

    /// Checks that the buffer holds `count` elements.
    ///
    /// # Errors
    /// If the buffer holds fewer elements.
    pub(in crate::capi) fn check_capacity(&self, param: &str, count: usize) -> Result<()> {
        if count <= self.capacity {
            return Ok(());
        }
        Err(Error::range(param, &format!("at least {count}"), self.capacity))
    }

    /// Writes element `i`. If the caller's elements are of a later version, their additional bytes stay as they are.
    ///
    /// # Safety
    /// `i` is below the capacity, and the caller's buffer has that capacity.
    pub(in crate::capi) unsafe fn write(&self, i: usize, value: &T) {
        // SAFETY: the caller's promise.
        unsafe { self.first.wrapping_byte_add(i * self.size).write(*value) };
    }
}

/// Checks the caller's size of an array element. Within a major version a later version only appends fields, so a
/// larger size is accepted.
fn check_element_size<T>(name: &str, size: u32) -> Result<()> {
    let (least, align) = (size_of::<T>(), align_of::<T>());
    if (size as usize) >= least && (size as usize).is_multiple_of(align) {
        return Ok(());
    }
    Err(Error::range(name, &format!("at least {least} and a multiple of {align}"), size))
}

/// Reads a list of tagged structs, `stride` bytes apart. Each is checked under the name `name[i]` and passed to `take`.
///
/// # Safety
/// `p` is NULL or points to `count` structs, `stride` bytes apart, each with `struct_size` readable bytes.
///
/// # Errors
/// More structs than the limit, a pointer that is NULL or misaligned, a stride that does not fit, the first wrong
/// field, or the error of `take`. `take` has then seen the structs before the wrong one.
pub(in crate::capi) unsafe fn each<T: Layout>(
    list: &List<'_>,
    p: *const T,
    take: &mut dyn FnMut(usize, T) -> Result<()>,
) -> Result<()> {
    // SAFETY: the caller's promise.
    unsafe { each_with(list, p, &[], take) }
}

/// Reads a list as [`each`] does, where each struct may have extensions of the types in `known`.
///
/// # Safety
/// As [`each`]; every link of the structs' chains is NULL or points to a struct that begins with a head.
///
/// # Errors
/// As [`each`].
pub(in crate::capi) unsafe fn each_with<T: Layout>(
    list: &List<'_>,
    p: *const T,
    known: &[wk_struct_type],
    take: &mut dyn FnMut(usize, T) -> Result<()>,
) -> Result<()> {
    let (param, count, stride) = (list.name, list.count.at_most(list.limit)?, list.stride.1);
    if count == 0 {
        return Ok(());
    }
    if p.is_null() {
        return Err(Error::invalid(param, format_args!("must not be NULL where its count is {count}")));
    }
    let align = align_of::<T>();
    if stride < size_of::<layout::Head>() || !stride.is_multiple_of(align) {
        let accepted = format!("sizeof({}) of your header, a multiple of {align}", T::INFO.name);
        return Err(Error::range(list.stride.0, &accepted, stride));
    }
    for i in 0..count {
        // SAFETY: the caller promises `count` structs at this stride.
        let at = unsafe { p.cast::<u8>().add(i * stride) }.cast::<T>();
        layout::check_pointer(&Indexed(param, i), at)?;
        // SAFETY: `at` points to a struct of the list, which begins with its size.
        let size = unsafe { at.cast::<u32>().read() } as usize;
        if size > stride {
            let accepted = format!("at most the stride, {stride}");
            return Err(Error::range(&format!("{param}[{i}].struct_size"), &accepted, size));
        }
        // SAFETY: the caller's promise.
        let value = unsafe { layout::read(&Indexed(param, i), at)? };
        // SAFETY: as above.
        unsafe { layout::check_chain(&Indexed(param, i), layout::head_of(&value).next, known)? };
        take(i, value)?;
    }
    Ok(())
}

/// Name of an element, as `name[3]`, formatted only when an error needs it.
struct Indexed<'a>(&'a str, usize);

impl std::fmt::Display for Indexed<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}[{}]", self.0, self.1)
    }
}
