//! Copies between framebuffers, for images that wgpu cannot use itself: framebuffers of the host, renderbuffers and
//! multisampled images that are to be read, and multisampled images that are resolved.

use super::{api::Api, names::*};
use crate::error::{Error, Result, Status};

/// A framebuffer at one end of a copy.
#[derive(Clone, Copy, Debug)]
pub(super) struct BlitEnd {
    pub(super) framebuffer: u32,
    /// Whether the framebuffer is the host's own; its read and draw buffers are then restored after the copy.
    pub(super) hosts: bool,
}

/// Copies the buffers in `mask` from `source` to `destination`, the whole image texel by texel. Resolves or replicates
/// samples where the sample counts differ. Copies encoded values unchanged.
///
/// # Errors
/// [`Status::Unsupported`], with the name of OpenGL's error, if OpenGL refuses the copy.
pub(super) fn copy(
    api: &Api,
    source: BlitEnd,
    destination: BlitEnd,
    mask: u32,
    (width, height): (u32, u32),
) -> Result<()> {
    api.BindFramebuffer(READ_FRAMEBUFFER, source.framebuffer);
    api.BindFramebuffer(DRAW_FRAMEBUFFER, destination.framebuffer);
    // Both ends have the same encoding; desktop OpenGL decodes and encodes only with this switch on.
    let encoding = api.IsEnabled(FRAMEBUFFER_SRGB) != 0;
    api.Disable(FRAMEBUFFER_SRGB);
    api.Disable(SCISSOR_TEST);
    api.take_error();
    let reading = (source.hosts && mask & COLOR_BUFFER_BIT != 0).then(|| read_what_is_drawn(api, source));
    let drawing = (destination.hosts && mask & COLOR_BUFFER_BIT != 0).then(|| draw_to_one(api)).flatten();
    let (w, h) = (width as i32, height as i32);
    api.BlitFramebuffer(0, 0, w, h, 0, 0, w, h, mask, NEAREST);
    let error = api.take_error();
    if let Some(was) = reading {
        api.BindFramebuffer(READ_FRAMEBUFFER, source.framebuffer);
        api.ReadBuffer(was);
    }
    if let Some(was) = drawing {
        // SAFETY: the list has as many values as its length says.
        unsafe { api.DrawBuffers(was.len() as i32, was.as_ptr()) };
    }
    if encoding {
        api.Enable(FRAMEBUFFER_SRGB);
    }
    api.BindFramebuffer(FRAMEBUFFER, 0);
    api.take_error();
    if error == NO_ERROR {
        return Ok(());
    }
    let what = if mask & COLOR_BUFFER_BIT != 0 { "colour" } else { "depth" };
    Err(Error::new(
        Status::Unsupported,
        format!(
            "copying {what} from framebuffer {} to {} is refused by this context with {}",
            source.framebuffer,
            destination.framebuffer,
            spell(error)
        ),
    ))
}

/// Makes the bound read framebuffer read the buffer that it draws to; returns the previous read buffer.
fn read_what_is_drawn(api: &Api, source: BlitEnd) -> u32 {
    let was = api.uint(READ_BUFFER);
    let drawn_before = api.uint(DRAW_FRAMEBUFFER_BINDING);
    api.BindFramebuffer(DRAW_FRAMEBUFFER, source.framebuffer);
    let drawn = api.uint(DRAW_BUFFER0);
    api.BindFramebuffer(DRAW_FRAMEBUFFER, drawn_before);
    let drawn = if drawn == FRONT_AND_BACK { BACK } else { drawn };
    if drawn != was {
        api.ReadBuffer(drawn);
    }
    was
}

/// Makes the bound draw framebuffer draw to its first buffer only; returns the list to restore, if it changed.
fn draw_to_one(api: &Api) -> Option<[u32; 8]> {
    let count = api.uint(MAX_DRAW_BUFFERS).min(8) as usize;
    let mut was = [NONE; 8];
    for (i, buffer) in was.iter_mut().enumerate().take(count) {
        *buffer = api.uint(DRAW_BUFFER0 + i as u32);
    }
    if was[1..].iter().all(|b| *b == NONE) {
        return None;
    }
    // SAFETY: one value is passed.
    unsafe { api.DrawBuffers(1, was.as_ptr()) };
    Some(was)
}
