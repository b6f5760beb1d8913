//! OpenGL hosts on Apple's systems, where the graphics interface is Metal: always unsupported.

use crate::{
    capi::{boundary::objects::wk_device, opengl_structs::wk_opengl_host_desc},
    error::{Error, Result},
};

/// Fails: this system has no OpenGL hosts.
///
/// # Safety
/// No requirements; the signature is that of the other systems.
pub(in crate::capi) unsafe fn open(_: &wk_opengl_host_desc) -> Result<*mut wk_device> {
    Err(Error::unsupported("OpenGL hosts: on this system the graphics interface is Metal"))
}
