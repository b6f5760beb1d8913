//! OpenGL hosts on Apple's systems, where the graphics interface is Metal: refused by name.

use crate::{
    capi::{boundary::objects::wk_device, opengl_structs::wk_opengl_host_desc},
    error::{Error, Result},
};

/// # Safety
/// None is needed; as the other systems' function.
pub(in crate::capi) unsafe fn open(_: &wk_opengl_host_desc) -> Result<*mut wk_device> {
    Err(Error::unsupported("OpenGL hosts: on this system the graphics interface is Metal"))
}
