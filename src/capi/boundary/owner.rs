//! Owner of a device (Welkin itself or the host), and the steps that give a host its device back.

use crate::error::{Error, Result};

/// Owner of a device, as the boundary keeps it.
pub(in crate::capi) enum Host {
    /// Welkin's own device.
    Own,
    /// OpenGL context of the host, or one that shares objects with it.
    #[cfg(not(any(target_os = "macos", target_os = "ios")))]
    OpenGl(std::sync::Arc<crate::gpu::gl::GlHost>),
    /// Vulkan device of the host.
    #[cfg(not(any(target_os = "macos", target_os = "ios")))]
    Vulkan(Box<crate::gpu::vulkan::VulkanHost>),
}

impl Host {
    /// Whether GPU objects may only be released where the host's context can be entered.
    pub(in crate::capi) fn needs_context(&self) -> bool {
        match self {
            Self::Own => false,
            #[cfg(not(any(target_os = "macos", target_os = "ios")))]
            Self::OpenGl(_) => true,
            #[cfg(not(any(target_os = "macos", target_os = "ios")))]
            Self::Vulkan(_) => false,
        }
    }

    /// Checks that the host can have shaders of its own on this device.
    ///
    /// # Errors
    /// [`crate::Status::Unsupported`] about `param` on an own device: `what` is meant for the host's own shaders, and
    /// there are none.
    pub(in crate::capi) fn check_own_shaders(&self, param: &str, what: &str) -> Result<()> {
        match self {
            Self::Own => {
                let text = format!("{what} are for hosts that draw with OpenGL, Vulkan or wgpu themselves");
                Err(Error::unsupported(text).within(param))
            }
            #[cfg(not(any(target_os = "macos", target_os = "ios")))]
            Self::OpenGl(_) | Self::Vulkan(_) => Ok(()),
        }
    }

    /// Gives the host its device back.
    ///
    /// # Errors
    /// Anything that the host should know before it destroys its device.
    pub(in crate::capi) fn close(self) -> Result<()> {
        match self {
            Self::Own => Ok(()),
            #[cfg(not(any(target_os = "macos", target_os = "ios")))]
            Self::OpenGl(_) => Ok(()),
            #[cfg(not(any(target_os = "macos", target_os = "ios")))]
            Self::Vulkan(host) => host.close(),
        }
    }
}
